//! Merging modifications (MLS §7.2): outer modifiers override inner ones, element by element.

use super::errors::{DUPLICATE_ELEMENT, FINAL_OVERRIDE, NOT_SUPPORTED};
use super::instance::Context;
use crate::diag::Diagnostic;
use crate::fault;
use crate::name::Ident;
use crate::source::Span;
use crate::syntax::ast::{Argument, Binding, Expression, Modification};
use indexmap::IndexMap;

/// All that modifies one element, merged.
#[derive(Debug, Clone, Default)]
pub(super) struct Modifier {
    /// The value behind `=`, with the scope that it was written in.
    pub(super) binding: Option<Bound>,
    /// Modifiers of the element's own elements or attributes.
    pub(super) elements: IndexMap<Ident, Modifier>,
    /// Where the name of the element is written; unknown if several modifiers were merged.
    pub(super) span: Option<Span>,
    /// Whether a `final` forbids outer modifiers.
    pub(super) is_final: bool,
}

/// A value with the scope that it was written in.
#[derive(Debug, Clone)]
pub(super) struct Bound {
    /// The value; `None` for `= break`, which removes an inner one (MLS §7.2.7).
    pub(super) value: Option<Expression>,
    pub(super) context: Context,
    /// `each`: holds for every element of an array.
    pub(super) each: bool,
    /// For modifiers of arrays of components: the element of the value that is meant, one index a
    /// dimension, from 1.
    pub(super) indices: Vec<usize>,
}

impl Modifier {
    /// The modifier that a declaration's or an argument's modification writes.
    pub(super) fn new(
        modification: Option<&Modification>,
        each: bool,
        context: Context,
    ) -> Result<Modifier, Diagnostic> {
        let Some(modification) = modification else { return Ok(Modifier::default()) };
        let mut modifier = Modifier::of_each(&modification.arguments, each, context)?;
        modifier.binding = modification.binding.as_ref().map(|binding| {
            let value = match binding {
                Binding::Expression(value) => Some(value.clone()),
                Binding::Break(_) => None,
            };
            Bound { value, context, each, indices: Vec::new() }
        });
        Ok(modifier)
    }

    /// The modifier that stands in parentheses.
    pub(super) fn of_arguments(
        arguments: &[Argument],
        context: Context,
    ) -> Result<Modifier, Diagnostic> {
        Modifier::of_each(arguments, false, context)
    }

    /// As [`Modifier::of_arguments`], inside an argument that may be marked `each`.
    fn of_each(
        arguments: &[Argument],
        each: bool,
        context: Context,
    ) -> Result<Modifier, Diagnostic> {
        let mut merged = Modifier::default();
        for argument in arguments {
            let Argument::Element(element) = argument else {
                let Argument::Redeclaration(redeclaration) = argument else { continue };
                return Err(fault!(NOT_SUPPORTED, "redeclarations are not translated yet")
                    .at(redeclaration.span));
            };
            let each = each || element.each;
            let mut inner = Modifier::new(element.modification.as_ref(), each, context)?;
            inner.is_final = element.is_final;
            inner.span = Some(element.name.span);
            let mut parts = element.name.node.parts.iter().rev();
            let Some(last) = parts.next() else { continue };
            let mut entry = (*last, inner);
            for part in parts {
                let span = entry.1.span;
                let elements = [entry].into_iter().collect();
                entry = (*part, Modifier { elements, span, ..Modifier::default() });
            }
            let known = merged.elements.shift_remove(&entry.0).unwrap_or_default();
            if let Some(name) = known.conflict(&entry.1, entry.0) {
                return Err(fault!(DUPLICATE_ELEMENT, "`{name}` is modified twice";
                    help: "remove one of the two modifiers")
                .at(element.name.span));
            }
            merged.elements.insert(entry.0, known.overridden_by(entry.1, entry.0)?);
        }
        Ok(merged)
    }

    /// The element to which both modifiers give a value (MLS §7.2.4).
    fn conflict(&self, other: &Modifier, name: Ident) -> Option<Ident> {
        if self.binding.is_some() && other.binding.is_some() {
            return Some(name);
        }
        let inner = |(name, modifier): (&Ident, &Modifier)| {
            self.elements.get(name)?.conflict(modifier, *name)
        };
        other.elements.iter().find_map(inner)
    }

    /// This modifier with an outer one over it; `name` is the element's, for messages.
    pub(super) fn overridden_by(
        mut self,
        outer: Modifier,
        name: Ident,
    ) -> Result<Modifier, Diagnostic> {
        let changes = outer.binding.is_some() || !outer.elements.is_empty();
        if self.is_final && changes {
            return Err(fault!(FINAL_OVERRIDE, "`{name}` is final and cannot be modified")
                .at(outer.span.unwrap_or(Span::NONE)));
        }
        if outer.binding.is_some() {
            self.binding = outer.binding;
        }
        for (element, modifier) in outer.elements {
            let inner = self.elements.shift_remove(&element).unwrap_or_default();
            self.elements.insert(element, inner.overridden_by(modifier, element)?);
        }
        self.is_final |= outer.is_final;
        self.span = outer.span.or(self.span);
        Ok(self)
    }

    /// Takes the modifier of an element out.
    pub(super) fn take(&mut self, name: Ident) -> Modifier {
        self.elements.shift_remove(&name).unwrap_or_default()
    }

    /// The modifier of one element of an array of components: values written without `each` are
    /// arrays, and the element is picked from them.
    pub(super) fn at_element(&self, indices: &[usize]) -> Modifier {
        let picked = |bound: &Bound| {
            let mut bound = bound.clone();
            if !bound.each {
                bound.indices.extend(indices);
            }
            bound
        };
        Modifier {
            binding: self.binding.as_ref().map(picked),
            elements: self
                .elements
                .iter()
                .map(|(name, modifier)| (*name, modifier.at_element(indices)))
                .collect(),
            span: self.span,
            is_final: self.is_final,
        }
    }
}
