//! The sizes of a value (MLS §10.1), found without the value: a size may depend on variables whose
//! values are not known at translation.

use super::operators::{Size, Sizes, result_sizes};
use crate::functions::{self, ArgumentShapes};
use crate::syntax::ast::{
    Arguments, ComponentReference, Expression, ExpressionKind, ForIndex, Subscript,
};
use crate::syntax::visit::{Rewrite, rewrite_expression};
use crate::value::Value;

/// What a caller knows of names.
pub(crate) trait SizesOfNames {
    /// The sizes of a variable, before the subscripts of the last part of the reference.
    fn of_reference(&mut self, reference: &ComponentReference) -> Option<Sizes>;
    /// The sizes of the first output of a declared function; `None` if none is declared.
    fn of_function(
        &mut self,
        function: &ComponentReference,
        arguments: &Arguments,
    ) -> Option<Option<Sizes>>;
    /// The value of an expression of constants and parameters, where a size may depend on it.
    fn value(&mut self, e: &Expression) -> Option<Value> {
        let _ = e;
        None
    }
}

/// The sizes, where all of them are known.
pub(crate) fn all_known(sizes: Sizes) -> Option<Vec<usize>> {
    sizes.into_iter().collect()
}

/// The sizes of an expression; `None` where its text does not show how many dimensions it has.
pub(crate) fn sizes_of<N: SizesOfNames>(names: &mut N, e: &Expression) -> Option<Sizes> {
    match &e.kind {
        ExpressionKind::Real(_)
        | ExpressionKind::Integer(_)
        | ExpressionKind::Boolean(_)
        | ExpressionKind::String(_) => Some(Vec::new()),
        ExpressionKind::Reference(reference) => {
            if reference.as_ident().is_some_and(|name| name == "time") {
                return Some(Vec::new());
            }
            let sizes = names.of_reference(reference)?;
            subscripted(names, sizes, &reference.parts.last()?.subscripts)
        }
        ExpressionKind::Unary { operand, .. } => sizes_of(names, operand),
        ExpressionKind::Binary { .. } => {
            let (first, operations) = e.chain();
            let first = sizes_of(names, first)?;
            operations.into_iter().try_fold(first, |left, one| {
                result_sizes(one.operator, left, sizes_of(names, one.right)?)
            })
        }
        ExpressionKind::If { branches, otherwise } => chosen(names, branches, otherwise),
        ExpressionKind::Array(elements) => {
            let inner = match elements.first() {
                Some(first) => sizes_of(names, first)?,
                None => Vec::new(),
            };
            Some(std::iter::once(Some(elements.len())).chain(inner).collect())
        }
        ExpressionKind::ArrayIteration { element, indices } => {
            let mut sizes = Vec::with_capacity(indices.len());
            for index in indices {
                sizes.push(*sizes_of(names, index.range.as_ref()?)?.first()?);
            }
            // The last iterator is the outer one (MLS §10.4.1).
            sizes.reverse();
            sizes.extend(element_sizes(names, element, indices)?);
            Some(sizes)
        }
        ExpressionKind::Matrix(rows) => matrix(names, rows),
        ExpressionKind::Range { .. } => match length_in_literals(e) {
            Some(length) => Some(vec![Some(length)]),
            None => Some(of_value(names, e).unwrap_or_else(|| vec![None])),
        },
        ExpressionKind::Subscripted { base, subscripts } => {
            let sizes = sizes_of(names, base)?;
            subscripted(names, sizes, subscripts)
        }
        ExpressionKind::Call { function, arguments } => {
            of_call(names, function, arguments).or_else(|| of_value(names, e))
        }
        _ => None,
    }
}

/// The length of a range such as `1:3`.
fn length_in_literals(range: &Expression) -> Option<usize> {
    let ExpressionKind::Range { start, step: None, stop } = &range.kind else { return None };
    match (&start.kind, &stop.kind) {
        (ExpressionKind::Integer(first), ExpressionKind::Integer(last)) => {
            usize::try_from(last.checked_sub(*first)?.checked_add(1)?.max(0)).ok()
        }
        _ => None,
    }
}

/// The sizes of the value, where it is known.
fn of_value<N: SizesOfNames>(names: &mut N, e: &Expression) -> Option<Sizes> {
    match names.value(e)? {
        Value::Array(array) => Some(array.dims.into_iter().map(Some).collect()),
        Value::Record(_) | Value::Tuple(_) => None,
        _ => Some(Vec::new()),
    }
}

fn subscripted<N: SizesOfNames>(
    names: &mut N,
    sizes: Sizes,
    subscripts: &[Subscript],
) -> Option<Sizes> {
    let mut left = Vec::with_capacity(sizes.len());
    for (at, size) in sizes.iter().enumerate() {
        match (subscripts.get(at), size) {
            (None | Some(Subscript::All(_)), _) => left.push(*size),
            (Some(Subscript::Index(index)), Some(size)) => {
                left.extend(sizes_of(names, &at_end(index, *size))?);
            }
            (Some(Subscript::Index(index)), None) => left.extend(sizes_of(names, index)?),
        }
    }
    (subscripts.len() <= sizes.len()).then_some(left)
}

/// The expression with `end` replaced by a size, where it is the whole of it.
pub(crate) fn at_end(e: &Expression, size: usize) -> Expression {
    let mut e = e.clone();
    replace_end(&mut e, size);
    e
}

fn replace_end(e: &mut Expression, size: usize) {
    match &mut e.kind {
        ExpressionKind::End => e.kind = ExpressionKind::Integer(size as i64),
        ExpressionKind::Unary { operand, .. } => replace_end(operand, size),
        ExpressionKind::Binary { .. } => {
            let (first, operations) = e.chain_mut();
            replace_end(first, size);
            operations.into_iter().for_each(|one| replace_end(one.right, size));
        }
        ExpressionKind::Range { start, step, stop } => {
            replace_end(start, size);
            if let Some(step) = step {
                replace_end(step, size);
            }
            replace_end(stop, size);
        }
        ExpressionKind::Array(elements) => {
            elements.iter_mut().for_each(|element| replace_end(element, size));
        }
        _ => {}
    }
}

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

/// The sizes of an element that is computed for every value of iterators.
pub(crate) fn element_sizes<N: SizesOfNames>(
    names: &mut N,
    element: &Expression,
    indices: &[ForIndex],
) -> Option<Sizes> {
    let mut element = element.clone();
    Iterators(indices).expression(&mut element);
    sizes_of(names, &element)
}

/// The sizes of the branches; where they differ, those of the branch that parameters choose, or
/// those that are the same in all.
fn chosen<N: SizesOfNames>(
    names: &mut N,
    branches: &[(Expression, Expression)],
    otherwise: &Expression,
) -> Option<Sizes> {
    let values = branches.iter().map(|(_, value)| value).chain([otherwise]);
    let mut sizes: Vec<_> = values.filter_map(|value| sizes_of(names, value)).collect();
    sizes.dedup();
    if sizes.len() <= 1 {
        return sizes.pop();
    }
    for (condition, value) in branches {
        match names.value(condition) {
            Some(Value::Boolean(true)) => return sizes_of(names, value),
            Some(Value::Boolean(false)) => {}
            _ => return common(sizes),
        }
    }
    sizes_of(names, otherwise)
}

/// What all have: the number of dimensions, and the sizes that do not differ.
fn common(all: Vec<Sizes>) -> Option<Sizes> {
    let mut all = all.into_iter();
    let first = all.next()?;
    all.try_fold(first, |known, other| {
        let same = |(a, b): (Size, Size)| a.filter(|_| a == b);
        (known.len() == other.len()).then(|| known.into_iter().zip(other).map(same).collect())
    })
}

fn matrix<N: SizesOfNames>(names: &mut N, rows: &[Vec<Expression>]) -> Option<Sizes> {
    let (mut height, mut width) = (Some(0), Some(0));
    let plus = |sum: Size, size: Size| Some(sum? + size?);
    for row in rows {
        let mut row_height = Some(1);
        width = Some(0);
        for element in row {
            match sizes_of(names, element)?.as_slice() {
                [] => width = plus(width, Some(1)),
                [n] => {
                    row_height = *n;
                    width = plus(width, Some(1));
                }
                [n, m] => {
                    row_height = *n;
                    width = plus(width, *m);
                }
                _ => return None,
            }
        }
        height = plus(height, row_height);
    }
    Some(vec![height, width])
}

fn of_call<N: SizesOfNames>(
    names: &mut N,
    function: &ComponentReference,
    arguments: &Arguments,
) -> Option<Sizes> {
    if !arguments.iterators.is_empty() {
        // A sum of arrays has their sizes (MLS §10.3.4.1), which its iterators may decide.
        let element = element_sizes(names, arguments.positional.first()?, &arguments.iterators);
        return element.is_none_or(|sizes| sizes.is_empty()).then(Vec::new);
    }
    if let Some(declared) = names.of_function(function, arguments) {
        return declared;
    }
    let entry = functions::find(function.as_ident()?.as_str())?;
    let mut given = Given { names, arguments: &arguments.positional, open: false, ones: false };
    let exact = entry.shape_of(&mut given);
    if !given.open {
        return exact.map(|sizes| sizes.into_iter().map(Some).collect());
    }
    given.ones = true;
    entry.shape_of(&mut given).map(|sizes| vec![None; sizes.len()])
}

/// The sizes of arguments.
struct Given<'n, 'a, N> {
    names: &'n mut N,
    arguments: &'a [Expression],
    /// Whether a size that was asked for is not known.
    open: bool,
    /// Whether 1 stands for each size, so that only the number of dimensions counts.
    ones: bool,
}

impl<N: SizesOfNames> ArgumentShapes for Given<'_, '_, N> {
    fn count(&self) -> usize {
        self.arguments.len()
    }

    fn dims(&mut self, at: usize) -> Option<Vec<usize>> {
        let sizes = sizes_of(self.names, self.arguments.get(at)?)?;
        self.open |= sizes.contains(&None);
        let ones = self.ones;
        Some(sizes.into_iter().map(|size| size.filter(|_| !ones).unwrap_or(1)).collect())
    }

    fn number(&mut self, at: usize) -> Option<i64> {
        let argument = self.arguments.get(at)?;
        match argument.kind {
            ExpressionKind::Integer(number) => Some(number),
            _ => match self.names.value(argument)? {
                Value::Integer(number) => Some(number),
                _ => None,
            },
        }
    }

    fn size(&mut self, at: usize) -> Option<i64> {
        let size = self.number(at);
        self.open |= size.is_none();
        size.or(Some(1))
    }
}
