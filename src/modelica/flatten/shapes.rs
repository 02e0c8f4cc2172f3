//! Sizes of the values of expressions, found without their values (MLS §10.1): a size may depend on
//! variables whose values are not known at translation.

use super::balance::path;
use super::lookup::modification::Bound;
use crate::diag::Diagnostic;
use crate::flatten::expressions::local::Local;
use crate::flatten::ids::ScopeId;
use crate::flatten::instantiate::instance::MemberState;
use crate::flatten::instantiate::instantiation::Instantiation;
use crate::inference::{self, Sizes, SizesOfNames};
use crate::name::Ident;
use crate::source::{Span, Spanned};
use crate::syntax::ast::{
    Arguments, ComponentReference, Expression, ExpressionKind, ForIndex, NamedArgument, Subscript,
};
use crate::value::Value;

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

    /// The sizes of an element that is computed for every value of iterators.
    pub(crate) fn element_shape(
        &mut self,
        element: &Expression,
        indices: &[ForIndex],
    ) -> Option<Vec<usize>> {
        inference::element_sizes(self, element, indices).and_then(inference::all_known)
    }

    fn sizes(&mut self, sizes: &[Expression]) -> Option<Vec<usize>> {
        sizes
            .iter()
            .map(|size| match self.flat_value(size).ok()? {
                Value::Integer(n) => usize::try_from(n).ok(),
                _ => None,
            })
            .collect()
    }

    /// The sizes of the first output of a function, which may depend on those of its inputs; more
    /// dimensions of an argument than of its input are those of a call for each element.
    fn function_shape(
        &mut self,
        function: &crate::eval::Function,
        arguments: &Arguments,
    ) -> Option<Vec<usize>> {
        let output = function.outputs.first()?;
        let mut dims = Vec::new();
        for (input, argument) in function.inputs.iter().zip(&arguments.positional) {
            let given = self.shape_of(argument)?;
            if given.len() > input.dims.len() {
                dims = given[..given.len() - input.dims.len()].to_vec();
                break;
            }
        }
        for dim in &output.dims {
            let Subscript::Index(size) = dim else { return None };
            let size = self.with_arguments(function, arguments, size);
            dims.extend(self.sizes(&[size])?);
        }
        Some(dims)
    }

    /// An expression of a function's inputs with `size(input, i)` and scalar inputs replaced.
    fn with_arguments(
        &mut self,
        function: &crate::eval::Function,
        arguments: &Arguments,
        size: &Expression,
    ) -> Expression {
        let mut named = arguments.clone();
        for (input, argument) in function.inputs.iter().zip(&arguments.positional) {
            let name = Spanned { node: input.name, span: argument.span };
            named.named.push(NamedArgument { name, value: argument.clone() });
        }
        self.substituted(&named, size)
    }

    fn substituted(&mut self, arguments: &Arguments, e: &Expression) -> Expression {
        let value_of = |name: Ident| {
            arguments.named.iter().find(|a| a.name.node == name).map(|a| a.value.clone())
        };
        let kind = match &e.kind {
            ExpressionKind::Reference(reference) => {
                let found = reference.as_ident().and_then(value_of);
                return found.unwrap_or_else(|| e.clone());
            }
            ExpressionKind::Call { function, arguments: inner } => {
                let positional: Vec<Expression> =
                    inner.positional.iter().map(|a| self.substituted(arguments, a)).collect();
                if function.as_ident().is_some_and(|name| name == "size")
                    && let Some(dims) = positional.first().and_then(|array| self.shape_of(array))
                    && let Some(Expression { kind: ExpressionKind::Integer(at), .. }) =
                        positional.get(1)
                    && let Some(n) = usize::try_from(at - 1).ok().and_then(|at| dims.get(at))
                {
                    return Expression::new(ExpressionKind::Integer(*n as i64), e.span);
                }
                let inner = Arguments { positional, ..(**inner).clone() };
                ExpressionKind::Call { function: function.clone(), arguments: Box::new(inner) }
            }
            ExpressionKind::Binary { .. } => {
                let (first, operations) = e.chain();
                let first = self.substituted(arguments, first);
                return operations.into_iter().fold(first, |left, one| {
                    let right = self.substituted(arguments, one.right);
                    Expression::operation(one.operator, left, right, one.whole.span)
                });
            }
            ExpressionKind::Unary { operator, operand } => ExpressionKind::Unary {
                operator: *operator,
                operand: Box::new(self.substituted(arguments, operand)),
            },
            other => other.clone(),
        };
        Expression::new(kind, e.span)
    }
}

impl SizesOfNames for Instantiation<'_> {
    fn of_reference(&mut self, reference: &ComponentReference) -> Option<Sizes> {
        let at = *self.classes.tree.variable_of.get(&*path(reference))?;
        Some(self.classes.tree.variables[at].0.dims.iter().copied().map(Some).collect())
    }

    fn of_function(
        &mut self,
        function: &ComponentReference,
        arguments: &Arguments,
    ) -> Option<Option<Sizes>> {
        let function = self.functions.table.get(&function.name())?.clone()?;
        let sizes = self.function_shape(&function, arguments);
        Some(sizes.map(|sizes| sizes.into_iter().map(Some).collect()))
    }

    fn value(&mut self, e: &Expression) -> Option<Value> {
        self.flat_value(e).ok()
    }
}
