//! Merging modifications (MLS §7.2) and redeclarations (MLS §7.3): outer modifiers override inner
//! ones, element by element.

use crate::diag::Diagnostic;
use crate::fault;
use crate::flatten::errors::{DUPLICATE_ELEMENT, FINAL_OVERRIDE, UNKNOWN_ELEMENT};
use crate::flatten::ids::ScopeId;
use crate::flatten::library::ClassId;
use crate::name::Ident;
use crate::source::Span;
use crate::syntax::ast::{
    Argument, Binding, ClassElement, ComponentClause, ComponentDeclaration, ElementRedeclaration,
    Expression, ExpressionKind, Modification, RedeclaredElement,
};
use crate::syntax::print;
use indexmap::IndexMap;
use std::sync::Arc;

/// All that modifies one element, merged.
#[derive(Debug, Clone, Default)]
pub(crate) struct Modifier {
    /// The value after `=`, with the scope that it was written in.
    pub binding: Option<Bound>,
    /// Modifiers of the element's own elements or attributes.
    pub elements: IndexMap<Ident, Modifier>,
    /// Modifiers of single elements of an array, by their subscripts. Modelica has no text for them:
    /// they come from names with subscripts in modifications that are built as trees.
    pub of_elements: IndexMap<Vec<usize>, Modifier>,
    /// Where the name of the element is written; unknown if several modifiers were merged.
    pub span: Option<Span>,
    /// Whether a `final` forbids outer modifiers.
    pub is_final: bool,
    /// What replaces the element.
    pub redeclaration: Option<Redeclaration>,
}

/// What an element is redeclared as.
#[derive(Debug, Clone)]
pub(crate) struct Redeclaration {
    pub replacement: Replacement,
    /// The scope that it was written in.
    pub context: ScopeId,
    /// The inner redeclaration that this one stands over, which a class extends may extend.
    pub over: Option<Box<Redeclaration>>,
    /// What modifies the element besides the modifiers of this redeclaration and of those that it
    /// stands over.
    pub plain: Box<Modifier>,
}

/// The text of a redeclaration.
#[derive(Debug, Clone)]
pub(crate) enum Replacement {
    /// A short class in a modification.
    Class(Arc<ClassElement>),
    /// A class among the elements of a class.
    Element(ClassId),
    /// A component, in a modification or among the elements.
    Component(Arc<ComponentClause>),
}

/// A value with the scope that it was written in.
#[derive(Debug, Clone)]
pub(crate) struct Bound {
    /// The value; `None` for `= break`, which removes an inner one (MLS §7.2.7).
    pub value: Option<Expression>,
    pub context: ScopeId,
    /// `each`: holds for every element of an array.
    pub each: bool,
    /// How many arrays of components, the outermost first, have `each` and no element picked yet.
    pub(crate) each_left: usize,
    /// For modifiers of arrays of components: the element of the value that is meant, one index a
    /// dimension, from 1.
    pub indices: Vec<usize>,
    /// Whether it is part of the class of a component, as in `model B = A(p = 1)`: all elements of an
    /// array of components of the class have it, without `each`.
    pub of_class: bool,
}

impl Modifier {
    /// The modifier that a declaration's or an argument's modification writes.
    pub(crate) fn new(
        modification: Option<&Modification>,
        each: usize,
        context: ScopeId,
    ) -> Result<Modifier, Diagnostic> {
        let Some(modification) = modification else { return Ok(Modifier::default()) };
        let mut modifier = Modifier::of_each(&modification.arguments, each, context)?;
        modifier.binding = modification.binding.as_ref().map(|binding| {
            let value = match binding {
                Binding::Expression(value) => Some(value.clone()),
                Binding::Break(_) => None,
            };
            let indices = Vec::new();
            Bound { value, context, each: each > 0, each_left: each, indices, of_class: false }
        });
        Ok(modifier)
    }

    /// The modifier in parentheses.
    pub(crate) fn of_arguments(
        arguments: &[Argument],
        context: ScopeId,
    ) -> Result<Modifier, Diagnostic> {
        Modifier::of_each(arguments, 0, context)
    }

    /// As [`Modifier::of_arguments`], inside arguments so many of which are marked `each`.
    fn of_each(
        arguments: &[Argument],
        each: usize,
        context: ScopeId,
    ) -> Result<Modifier, Diagnostic> {
        let mut merged = Modifier::default();
        for argument in arguments {
            let element = match argument {
                Argument::Element(element) => element,
                Argument::Redeclaration(redeclaration) => {
                    merged.add_redeclaration(redeclaration, each, context)?;
                    continue;
                }
            };
            let each = each + usize::from(element.each);
            let mut inner = Modifier::new(element.modification.as_ref(), each, context)?;
            inner.is_final = element.is_final;
            inner.span = Some(element.name.span);
            let mut parts = element.name.node.parts.iter().rev();
            let Some(last) = parts.next() else { continue };
            let mut entry = inner.named(*last);
            for part in parts {
                let span = entry.1.span;
                let elements = [entry].into_iter().collect();
                entry = Modifier { elements, span, ..Modifier::default() }.named(*part);
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

    /// The modifier with the name of the element that it belongs to: that of the array, where the
    /// name has subscripts.
    fn named(self, name: Ident) -> (Ident, Modifier) {
        let Some((array, indices)) = name.subscripted() else { return (name, self) };
        let span = self.span;
        let of_elements = [(indices, self)].into_iter().collect();
        (array, Modifier { of_elements, span, ..Modifier::default() })
    }

    fn add_redeclaration(
        &mut self,
        element: &ElementRedeclaration,
        each: usize,
        context: ScopeId,
    ) -> Result<(), Diagnostic> {
        let each = each + usize::from(element.each);
        let (name, replacement, mut modifier, is_final) = match &element.element {
            RedeclaredElement::Class(class) => {
                let replacement = Replacement::Class(Arc::new((**class).clone()));
                (class.class.name, replacement, Modifier::default(), class.prefixes.is_final)
            }
            RedeclaredElement::Component(clause) => {
                let Some(component) = clause.components.first() else { return Ok(()) };
                // The values that the redeclaration gives are those of an outer modifier.
                let modifier = Modifier::new(component.modification.as_ref(), each, context)?;
                let replacement = Replacement::Component(Arc::new((**clause).clone()));
                (component.name, replacement, modifier, clause.prefixes.is_final)
            }
        };
        modifier.redeclaration = Some(Redeclaration::new(replacement, context));
        modifier.is_final = is_final;
        modifier.span = Some(name.span);
        let known = self.elements.shift_remove(&name.node).unwrap_or_default();
        if known.redeclaration.is_some() || known.conflict(&modifier, name.node).is_some() {
            return Err(fault!(DUPLICATE_ELEMENT, "`{}` is modified twice", name.node;
                help: "remove one of the two modifiers")
            .at(name.span));
        }
        self.elements.insert(name.node, known.overridden_by(modifier, name.node)?);
        Ok(())
    }

    /// Adds the redeclaration of a component by an element of a class.
    pub(crate) fn redeclare_component(
        &mut self,
        clause: &ComponentClause,
        component: &ComponentDeclaration,
        context: ScopeId,
    ) -> Result<(), Diagnostic> {
        let mut modifier = Modifier::new(component.modification.as_ref(), 0, context)?;
        let one = ComponentClause { components: vec![component.clone()], ..clause.clone() };
        let replacement = Replacement::Component(Arc::new(one));
        modifier.redeclaration = Some(Redeclaration::new(replacement, context));
        modifier.span = Some(component.name.span);
        self.elements.insert(component.name.node, modifier);
        Ok(())
    }

    /// Adds a redeclaration of a class.
    pub(crate) fn redeclare(&mut self, name: Ident, redeclaration: Redeclaration, span: Span) {
        let entry = self.elements.entry(name).or_default();
        entry.redeclaration = Some(redeclaration);
        entry.span = Some(span);
    }

    /// Whether both are written alike, wherever they stand.
    pub(crate) fn is_same(&self, other: &Modifier) -> bool {
        let elements = || {
            self.elements.iter().all(|(name, modifier)| {
                other.elements.get(name).is_some_and(|other| modifier.is_same(other))
            })
        };
        let of_elements = self.of_elements.is_empty() && other.of_elements.is_empty();
        let is_as_long = self.elements.len() == other.elements.len();
        self.has_same_binding(other) && is_as_long && of_elements && elements()
    }

    /// Whether both give the same value, and neither another declaration.
    pub(crate) fn has_same_binding(&self, other: &Modifier) -> bool {
        let value = |one: &Modifier| {
            one.binding.as_ref().map(|bound| bound.value.as_ref().map(print::expression))
        };
        let is_redeclared = self.redeclaration.is_some() || other.redeclaration.is_some();
        value(self) == value(other) && !is_redeclared
    }

    /// Where it is written, or the first of the modifiers in it.
    fn place(&self) -> Option<Span> {
        let mut inner = self.elements.values().chain(self.of_elements.values());
        self.span.or_else(|| inner.find_map(Modifier::place))
    }

    /// Whether it changes nothing.
    pub(crate) fn is_empty(&self) -> bool {
        let has_parts = !self.elements.is_empty() || !self.of_elements.is_empty();
        self.binding.is_none() && !has_parts && self.redeclaration.is_none()
    }

    /// The element to which both modifiers give a value (MLS §7.2.4).
    fn conflict(&self, other: &Modifier, name: Ident) -> Option<Ident> {
        if self.binding.is_some() && other.binding.is_some() {
            return Some(name);
        }
        let inner = |(name, modifier): (&Ident, &Modifier)| {
            self.elements.get(name)?.conflict(modifier, *name)
        };
        let of_element = |(indices, modifier): (&Vec<usize>, &Modifier)| {
            self.of_elements.get(indices)?.conflict(modifier, name)
        };
        let found = other.elements.iter().find_map(inner);
        found.or_else(|| other.of_elements.iter().find_map(of_element))
    }

    /// This modifier with an outer one over it; `name` is the element's, for messages.
    pub(crate) fn overridden_by(
        mut self,
        mut outer: Modifier,
        name: Ident,
    ) -> Result<Modifier, Diagnostic> {
        let changes = !outer.is_empty();
        if self.is_final && changes {
            let error = fault!(FINAL_OVERRIDE, "`{name}` is final and cannot be modified";
                help: "remove this value, or `final` where it is declared")
            .at(outer.place().or(self.span).unwrap_or(Span::NONE));
            return Err(match self.span {
                Some(place) if place != error.span() => error.related(place, "declared final here"),
                _ => error,
            });
        }
        match (self.redeclaration.take(), outer.redeclaration.take()) {
            (inner, Some(redeclaration)) => {
                if let Some(inner) = &inner {
                    self = (*inner.plain).clone();
                }
                self.redeclaration = Some(redeclaration.standing_over(inner, &self, name)?);
            }
            (Some(mut inner), None) => {
                *inner.plain = inner.plain.overridden_by(outer.clone(), name)?;
                self.redeclaration = Some(inner);
            }
            (None, None) => {}
        }
        if outer.binding.is_some() {
            self.binding = outer.binding;
        }
        for (element, modifier) in outer.elements {
            let inner = self.elements.shift_remove(&element).unwrap_or_default();
            self.elements.insert(element, inner.overridden_by(modifier, element)?);
        }
        for (indices, modifier) in outer.of_elements {
            let inner = self.of_elements.shift_remove(&indices).unwrap_or_default();
            self.of_elements.insert(indices, inner.overridden_by(modifier, name)?);
        }
        self.is_final |= outer.is_final;
        self.span = outer.span.or(self.span);
        Ok(self)
    }

    /// The same as a part of the class that it modifies.
    #[must_use]
    pub(crate) fn of_class(mut self) -> Modifier {
        self.mark_of_class();
        self
    }

    fn mark_of_class(&mut self) {
        if let Some(bound) = &mut self.binding {
            bound.of_class = true;
        }
        self.elements.values_mut().for_each(Modifier::mark_of_class);
    }

    /// The modifier of one element of an array of components, whose name is that of the array: values
    /// written without `each` are arrays, and the element is picked from them. What modifies this
    /// element alone stands over what modifies all.
    pub(crate) fn at_element(
        &self,
        indices: &[usize],
        name: Ident,
    ) -> Result<Modifier, Diagnostic> {
        let mut picked = self.picked(indices);
        let own = picked.of_elements.shift_remove(indices);
        picked.of_elements.clear();
        match own {
            Some(own) => picked.overridden_by(own, name),
            None => Ok(picked),
        }
    }

    /// The value that it gives to its element, or to an attribute of it.
    pub(crate) fn value_of(&self, attribute: Option<&str>) -> Option<&Bound> {
        match attribute {
            None => self.binding.as_ref(),
            Some(attribute) => {
                let (_, modifier) = self.elements.iter().find(|(name, _)| **name == attribute)?;
                modifier.binding.as_ref()
            }
        }
    }

    /// `each` is about one array: in one within it, an array constructor is a value for all elements.
    fn picked(&self, indices: &[usize]) -> Modifier {
        let picked = |bound: &Bound| {
            let mut bound = bound.clone();
            let is_whole = match bound.each_left {
                0 => bound.each && !bound.value.as_ref().is_some_and(constructs_array),
                _ => true,
            };
            bound.each_left = bound.each_left.saturating_sub(usize::from(!indices.is_empty()));
            if !is_whole && !std::mem::take(&mut bound.of_class) {
                bound.indices.extend(indices);
            }
            bound
        };
        Modifier {
            binding: self.binding.as_ref().map(picked),
            elements: self
                .elements
                .iter()
                .map(|(name, modifier)| (*name, modifier.picked(indices)))
                .collect(),
            of_elements: self.of_elements.clone(),
            span: self.span,
            is_final: self.is_final,
            redeclaration: self.redeclaration.clone(),
        }
    }

    /// The modifiers of single elements; a fault where an array of these sizes has no such element.
    pub(crate) fn check_elements(&self, name: Ident, dims: &[usize]) -> Result<(), Diagnostic> {
        let fits = |indices: &[usize]| {
            indices.len() == dims.len()
                && indices.iter().zip(dims).all(|(at, size)| (1..=*size).contains(at))
        };
        let Some((indices, modifier)) = self.of_elements.iter().find(|(at, _)| !fits(at)) else {
            return Ok(());
        };
        let numbers =
            |list: &[usize]| list.iter().map(usize::to_string).collect::<Vec<_>>().join(",");
        let sizes = match dims {
            [] => "it is not an array".to_owned(),
            dims => format!("it is `{name}[{}]`", numbers(dims)),
        };
        Err(fault!(UNKNOWN_ELEMENT, "`{name}` has no element `[{}]`: {sizes}", numbers(indices))
            .at(modifier.place().unwrap_or(Span::NONE)))
    }
}

/// Whether an expression is an array by its form.
fn constructs_array(value: &Expression) -> bool {
    matches!(value.kind, ExpressionKind::Array(_) | ExpressionKind::ArrayIteration { .. })
}

impl Redeclaration {
    /// This redeclaration and those that it stands over, the innermost first.
    pub(crate) fn innermost_first(&self) -> impl Iterator<Item = &Redeclaration> {
        let chain = std::iter::successors(Some(self), |one| one.over.as_deref());
        chain.collect::<Vec<_>>().into_iter().rev()
    }

    /// A redeclaration of an element that nothing else modifies.
    pub(crate) fn new(replacement: Replacement, context: ScopeId) -> Redeclaration {
        Redeclaration { replacement, context, over: None, plain: Box::default() }
    }

    /// This redeclaration of an element that has been redeclared before, maybe, and is modified
    /// besides. The modifiers of the inner redeclaration belong to it alone: for further ones, those
    /// of the original declaration or of a constraining clause hold (MLS §7.3.2).
    fn standing_over(
        mut self,
        inner: Option<Redeclaration>,
        plain: &Modifier,
        name: Ident,
    ) -> Result<Redeclaration, Diagnostic> {
        self.over = match (self.over.take(), inner) {
            (Some(mut over), Some(inner)) => {
                over.put_under(inner);
                Some(over)
            }
            (over, inner) => over.or(inner.map(Box::new)),
        };
        *self.plain = plain.clone().overridden_by(*self.plain, name)?;
        Ok(self)
    }

    fn put_under(&mut self, inner: Redeclaration) {
        match &mut self.over {
            Some(over) => over.put_under(inner),
            None => self.over = Some(Box::new(inner)),
        }
    }
}
