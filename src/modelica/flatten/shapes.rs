//! Sizes of the values of expressions, found without their values (MLS §10.1): a size may depend on
//! variables whose values are not known at translation.

use super::balance::path;
use super::lookup::modification::Bound;
use crate::diag::Diagnostic;
use crate::flatten::expressions::local::Local;
use crate::flatten::ids::ScopeId;
use crate::flatten::instantiate::instance::MemberState;
use crate::flatten::instantiate::instantiation::Instantiation;
use crate::functions::{self, ArgumentShapes};
use crate::name::{Ident, Name};
use crate::source::{Span, Spanned};
use crate::syntax::ast::{
    Arguments, BinaryOperator, ComponentReference, Expression, ExpressionKind, ForIndex,
    NamedArgument, Subscript,
};
use crate::syntax::visit::{Rewrite, rewrite_expression};
use crate::value::Value;

/// Writes a number for every iterator: the sizes of an element do not depend on which.
struct Iterators<'a>(&'a [ForIndex]);

impl Rewrite for Iterators<'_> {
    fn expression(&mut self, expression: &mut Expression) {
        if let ExpressionKind::Reference(reference) = &expression.kind
            && let Some(name) = reference.as_ident()
            && self.0.iter().any(|index| name == index.name.node)
        {
            expression.kind = ExpressionKind::Integer(1);
            return;
        }
        rewrite_expression(self, expression);
    }
}

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
        match &e.kind {
            ExpressionKind::Real(_)
            | ExpressionKind::Integer(_)
            | ExpressionKind::Boolean(_)
            | ExpressionKind::String(_) => Some(Vec::new()),
            ExpressionKind::Reference(reference) => self.reference_shape(reference),
            ExpressionKind::Unary { operand, .. } => self.shape_of(operand),
            ExpressionKind::Binary { .. } => {
                let (first, operations) = e.chain();
                let first = self.shape_of(first)?;
                operations.into_iter().try_fold(first, |left, one| {
                    binary_shape(one.operator, left, self.shape_of(one.right)?)
                })
            }
            ExpressionKind::If { branches, otherwise } => self.choice_shape(branches, otherwise),
            ExpressionKind::Array(elements) => {
                let inner = match elements.first() {
                    Some(first) => self.shape_of(first)?,
                    None => Vec::new(),
                };
                Some(std::iter::once(elements.len()).chain(inner).collect())
            }
            ExpressionKind::ArrayIteration { element, indices } => {
                self.array_iteration_shape(element, indices)
            }
            ExpressionKind::Matrix(rows) => self.matrix_shape(rows),
            ExpressionKind::Range { .. } => self.value_shape(e),
            ExpressionKind::Subscripted { base, subscripts } => {
                let dims = self.shape_of(base)?;
                self.subscripted_shape(dims, subscripts)
            }
            ExpressionKind::Call { function, arguments } => {
                self.call_shape(&function.name(), arguments).or_else(|| self.value_shape(e))
            }
            _ => None,
        }
    }

    /// The sizes of the value, where it is known.
    fn value_shape(&mut self, e: &Expression) -> Option<Vec<usize>> {
        match self.flat_value(e).ok()? {
            Value::Array(array) => Some(array.dims),
            Value::Record(_) | Value::Tuple(_) => None,
            _ => Some(Vec::new()),
        }
    }

    fn reference_shape(&mut self, reference: &ComponentReference) -> Option<Vec<usize>> {
        if reference.as_ident().is_some_and(|name| name == "time") {
            return Some(Vec::new());
        }
        let at = *self.classes.tree.variable_of.get(&*path(reference))?;
        let dims = self.classes.tree.variables[at].0.dims.clone();
        let subscripts = reference.parts.last()?.subscripts.clone();
        self.subscripted_shape(dims, &subscripts)
    }

    fn subscripted_shape(
        &mut self,
        dims: Vec<usize>,
        subscripts: &[Subscript],
    ) -> Option<Vec<usize>> {
        let mut left = Vec::with_capacity(dims.len());
        for (at, size) in dims.iter().enumerate() {
            match subscripts.get(at) {
                None | Some(Subscript::All(_)) => left.push(*size),
                Some(Subscript::Index(index)) => {
                    let index = super::flat_expression::at_end(index, *size);
                    left.extend(self.shape_of(&index)?);
                }
            }
        }
        (subscripts.len() <= dims.len()).then_some(left)
    }

    fn array_iteration_shape(
        &mut self,
        element: &Expression,
        indices: &[ForIndex],
    ) -> Option<Vec<usize>> {
        let mut sizes = Vec::with_capacity(indices.len());
        for index in indices {
            sizes.push(*self.shape_of(index.range.as_ref()?)?.first()?);
        }
        // The last iterator is the outer one (MLS §10.4.1).
        sizes.reverse();
        sizes.extend(self.element_shape(element, indices)?);
        Some(sizes)
    }

    /// The sizes of an element that is computed for every value of iterators.
    pub(crate) fn element_shape(
        &mut self,
        element: &Expression,
        indices: &[ForIndex],
    ) -> Option<Vec<usize>> {
        let mut element = element.clone();
        Iterators(indices).expression(&mut element);
        self.shape_of(&element)
    }

    /// The sizes of the branches; where they differ, those of the branch that parameters choose.
    fn choice_shape(
        &mut self,
        branches: &[(Expression, Expression)],
        otherwise: &Expression,
    ) -> Option<Vec<usize>> {
        let values = branches.iter().map(|(_, value)| value).chain([otherwise]);
        let mut shapes: Vec<_> = values.filter_map(|value| self.shape_of(value)).collect();
        shapes.dedup();
        if shapes.len() <= 1 {
            return shapes.pop();
        }
        for (condition, value) in branches {
            match self.flat_value(condition).ok()? {
                Value::Boolean(true) => return self.shape_of(value),
                Value::Boolean(false) => {}
                _ => return None,
            }
        }
        self.shape_of(otherwise)
    }

    fn matrix_shape(&mut self, rows: &[Vec<Expression>]) -> Option<Vec<usize>> {
        let mut height = 0;
        let mut width = 0;
        for row in rows {
            let mut row_height = 1;
            width = 0;
            for element in row {
                match self.shape_of(element)?.as_slice() {
                    [] => width += 1,
                    [n] => {
                        row_height = *n;
                        width += 1;
                    }
                    [n, m] => {
                        row_height = *n;
                        width += m;
                    }
                    _ => return None,
                }
            }
            height += row_height;
        }
        Some(vec![height, width])
    }

    fn call_shape(&mut self, name: &Name, arguments: &Arguments) -> Option<Vec<usize>> {
        if !arguments.iterators.is_empty() {
            // A sum of arrays has their sizes (MLS §10.3.4.1), which its iterators may decide.
            let element = self.shape_of(arguments.positional.first()?);
            return element.is_none_or(|dims| dims.is_empty()).then(Vec::new);
        }
        if let Some(Some(function)) = self.functions.table.get(name).cloned() {
            return self.function_shape(&function, arguments);
        }
        let word = name.last().filter(|_| name.is_simple())?;
        let entry = functions::find(word.as_str())?;
        entry.shape_of(&mut Shapes { instantiation: self, arguments: &arguments.positional })
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

/// The sizes of arguments.
struct Shapes<'i, 'm, 'a> {
    instantiation: &'i mut Instantiation<'m>,
    arguments: &'a [Expression],
}

impl ArgumentShapes for Shapes<'_, '_, '_> {
    fn count(&self) -> usize {
        self.arguments.len()
    }

    fn dims(&mut self, at: usize) -> Option<Vec<usize>> {
        self.instantiation.shape_of(self.arguments.get(at)?)
    }

    fn number(&mut self, at: usize) -> Option<i64> {
        match self.instantiation.flat_value(self.arguments.get(at)?).ok()? {
            Value::Integer(number) => Some(number),
            _ => None,
        }
    }
}

/// The sizes of `left operator right` (MLS §10.6).
fn binary_shape(
    operator: BinaryOperator,
    left: Vec<usize>,
    right: Vec<usize>,
) -> Option<Vec<usize>> {
    if operator != BinaryOperator::Multiply {
        return Some(if left.is_empty() { right } else { left });
    }
    Some(match (left.as_slice(), right.as_slice()) {
        ([], _) => right,
        (_, []) => left,
        ([_], [_]) => Vec::new(),
        ([n, _], [_]) => vec![*n],
        ([_], [_, m]) => vec![*m],
        ([n, _], [_, m]) => vec![*n, *m],
        _ => return None,
    })
}
