//! Sizes of the values of expressions, found without their values (MLS §10.1): a size may depend on
//! variables whose values are not known at translation.

use super::balance::path;
use super::errors::SIZE_MISMATCH;
use super::flat_expression::picked;
use super::lookup::modification::Bound;
use crate::diag::Diagnostic;
use crate::eval::Function;
use crate::fault;
use crate::flatten::expressions::local::Local;
use crate::flatten::ids::ScopeId;
use crate::flatten::instantiate::instance::MemberState;
use crate::flatten::instantiate::instantiation::Instantiation;
use crate::inference::{self, Sizes, SizesOfNames};
use crate::source::Span;
use crate::syntax::ast::{Arguments, ComponentReference, Expression, ExpressionKind, ForIndex};
use crate::value::Value;
use std::sync::Arc;

impl Instantiation<'_> {
    /// The sizes of the value that a binding gives; `None` where its text does not tell them.
    pub(crate) fn bound_shape(&mut self, bound: &Bound) -> Result<Option<Vec<usize>>, Diagnostic> {
        let Some(value) = &bound.value else { return Ok(None) };
        let value = self.part_of(value, bound)?;
        // Whether it may call impure functions is looked at with the value.
        let local = Local { impure: true, ..Local::default() };
        let resolved = self.resolve(&value, bound.context, &local)?;
        Ok(self.shape_of(&resolved))
    }

    /// The part of a value that belongs to one element of an array of components; without `each` the
    /// value must be an array (MLS §7.2.5). One value is that of every element, with a warning:
    /// libraries forget the word.
    pub(crate) fn part_of(
        &mut self,
        value: &Expression,
        bound: &Bound,
    ) -> Result<Expression, Diagnostic> {
        let required = bound.indices.len();
        let is_array = matches!(value.kind, ExpressionKind::Array(_));
        if required == 0 || is_array && required == 1 {
            return Ok(picked(value.clone(), &bound.indices));
        }
        let local = Local { impure: true, ..Local::default() };
        let whole = self.resolve(value, bound.context, &local)?;
        let Some(found) = self.types().rank_of(&whole).filter(|found| *found < required) else {
            return Ok(picked(value.clone(), &bound.indices));
        };
        let error = fault!(
            SIZE_MISMATCH,
            "a modifier of an array of components needs a value with at least {required} \
             dimensions, not {found}";
            help: "write `each` before the modifier to give every element the same value")
        .at(value.span);
        if found > 0 || self.classes.library.is_strict() {
            return Err(error);
        }
        self.warnings.add_once(error);
        Ok(value.clone())
    }

    /// The sizes of an array of components that are not variables and have no value.
    fn component_dims(
        &mut self,
        array: &Expression,
        context: ScopeId,
        local: &Local,
    ) -> Result<Option<Vec<usize>>, Diagnostic> {
        let ExpressionKind::Reference(reference) = &array.kind else { return Ok(None) };
        let Some((last, holders)) = reference.parts.split_last() else { return Ok(None) };
        let first = reference.parts[0].name;
        let is_plain = reference.parts.iter().all(|part| part.subscripts.is_empty());
        if !is_plain
            || reference.global
            || local.flat
            || local.get(first).is_some()
            || !self.classes.has_component(context, first)?
        {
            return Ok(None);
        }
        let mut node = self.classes.node_of(context);
        for part in holders {
            match self.member(node, part.name)?.map(MemberState::seen) {
                Some(MemberState::Single(next)) => node = next,
                _ => return Ok(None),
            }
        }
        Ok(match self.member(node, last.name)?.map(MemberState::seen) {
            Some(MemberState::Array(dims, _)) => Some(dims),
            _ => None,
        })
    }

    /// `size(x, i)` and `size(x)` where only the sizes of `x` are known; `None` for other calls.
    pub(crate) fn size_call(
        &mut self,
        name: &str,
        arguments: &Arguments,
        context: ScopeId,
        local: &Local,
        span: Span,
    ) -> Result<Option<Expression>, Diagnostic> {
        let Some(array) = arguments.positional.first() else { return Ok(None) };
        if !["size", "ndims"].contains(&name) || !arguments.named.is_empty() {
            return Ok(None);
        }
        let dims = match self.component_dims(array, context, local)? {
            Some(dims) => dims,
            None if !local.values => return Ok(None),
            None => {
                let plain = Local { values: false, ..local.clone() };
                let Ok(resolved) = self.resolve(array, context, &plain) else { return Ok(None) };
                let Some(dims) = self.shape_of(&resolved) else { return Ok(None) };
                dims
            }
        };
        let integer = |n: usize| Expression::new(ExpressionKind::Integer(n as i64), span);
        let value = match (name, arguments.positional.get(1)) {
            ("ndims", None) => integer(dims.len()),
            ("size", None) => Expression::new(
                ExpressionKind::Array(dims.into_iter().map(integer).collect()),
                span,
            ),
            ("size", Some(at)) => {
                let resolved = self.resolve(at, context, local)?;
                let Value::Integer(at) = self.flat_value(&resolved)? else { return Ok(None) };
                let found = usize::try_from(at - 1).ok().and_then(|at| dims.get(at).copied());
                match found {
                    Some(size) => integer(size),
                    None => return Ok(None),
                }
            }
            _ => return Ok(None),
        };
        Ok(Some(value))
    }

    /// The sizes of a resolved expression; `None` where its text does not tell them.
    pub(crate) fn shape_of(&mut self, e: &Expression) -> Option<Vec<usize>> {
        inference::sizes_of(self, e).and_then(inference::all_known)
    }

    /// The sizes that a resolved expression has beyond so many dimensions, if it has more.
    pub(crate) fn surplus_sizes(&mut self, e: &Expression, expected: usize) -> Option<Vec<usize>> {
        if self.types().rank_of(e).is_some_and(|rank| rank <= expected) {
            return None;
        }
        let dims = self.shape_of(e)?;
        (dims.len() > expected).then(|| dims[..dims.len() - expected].to_vec())
    }

    /// The sizes of an element that is computed for every value of iterators.
    pub(crate) fn element_shape(
        &mut self,
        element: &Expression,
        indices: &[ForIndex],
    ) -> Option<Vec<usize>> {
        inference::element_sizes(self, element, indices).and_then(inference::all_known)
    }
}

impl SizesOfNames for Instantiation<'_> {
    type Function = Function;

    fn of_reference(&mut self, reference: &ComponentReference) -> Option<Sizes> {
        let at = *self.classes.tree.variable_of.get(&*path(reference))?;
        Some(self.classes.tree.variables[at].0.dims.iter().copied().map(Some).collect())
    }

    fn function(&mut self, function: &ComponentReference) -> Option<Option<Arc<Function>>> {
        self.functions.table.get(&function.name()).cloned().flatten().map(Some)
    }

    fn value(&mut self, e: &Expression) -> Option<Value> {
        self.flat_value(e).ok()
    }
}
