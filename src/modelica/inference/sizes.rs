//! The sizes of a value (MLS §10.1), found without the value: a size may depend on variables whose
//! values are not known at translation.

use super::operators::{Size, Sizes, result_sizes};
use crate::functions::{self, ArgumentShapes};
use crate::name::Ident;
use crate::syntax::ast::{
    Arguments, ComponentReference, Expression, ExpressionKind, ForIndex, Subscript,
};
use crate::syntax::visit::{Rewrite, rewrite_expression};
use crate::value::Value;
use crate::value::construct::Range;
use std::sync::Arc;

/// A declared function, as far as the sizes of its first output follow from it.
pub(crate) trait DeclaredSizes {
    /// The name of an input at a position, and how many dimensions it has.
    fn input(&self, at: usize) -> Option<(Ident, usize)>;
    /// The declared sizes of the first output.
    fn output(&self) -> Option<&[Subscript]>;
}

/// What a caller knows of names.
pub(crate) trait SizesOfNames {
    type Function: DeclaredSizes;

    /// The sizes of a variable, before the subscripts of the last part of the reference.
    fn of_reference(&mut self, reference: &ComponentReference) -> Option<Sizes>;
    /// A declared function, if its sizes are of interest; `None` if none is declared.
    fn function(&mut self, function: &ComponentReference) -> Option<Option<Arc<Self::Function>>>;
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
        ExpressionKind::ArrayIteration { element, indices } => iterated(names, element, indices),
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

/// The sizes of an array constructor with iterators.
fn iterated<N: SizesOfNames>(
    names: &mut N,
    element: &Expression,
    indices: &[ForIndex],
) -> Option<Sizes> {
    let mut sizes = Vec::with_capacity(indices.len());
    for index in indices {
        sizes.push(*sizes_of(names, index.range.as_ref()?)?.first()?);
    }
    // The last iterator is the outer one (MLS §10.4.1).
    sizes.reverse();
    sizes.extend(element_sizes(names, element, indices)?);
    Some(sizes)
}

/// The length of a range such as `1:3` or `0:0.1:1`.
fn length_in_literals(range: &Expression) -> Option<usize> {
    let ExpressionKind::Range { start, step, stop } = &range.kind else { return None };
    let literal = |e: &Expression| match e.kind {
        ExpressionKind::Integer(number) => Some(Value::Integer(number)),
        ExpressionKind::Real(number) => Some(Value::Real(number)),
        _ => None,
    };
    let step = match step {
        Some(step) => Some(literal(step)?),
        None => None,
    };
    Range::new(&literal(start)?, step.as_ref(), &literal(stop)?).ok().map(|range| range.count())
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
        if function.as_ident().is_some_and(|name| name == "array") {
            return iterated(names, arguments.positional.first()?, &arguments.iterators);
        }
        // A sum of arrays has their sizes (MLS §10.3.4.1), which its iterators may decide.
        let element = element_sizes(names, arguments.positional.first()?, &arguments.iterators);
        return element.is_none_or(|sizes| sizes.is_empty()).then(Vec::new);
    }
    if let Some(declared) = names.function(function) {
        return of_declared(names, &*declared?, arguments);
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

/// The sizes of the first output of a declared function; more dimensions of an argument than its
/// input has are those of a call for each element (MLS §12.4.6).
fn of_declared<N: SizesOfNames>(
    names: &mut N,
    function: &N::Function,
    arguments: &Arguments,
) -> Option<Sizes> {
    let inputs = (0..).map_while(|at| function.input(at)).collect::<Vec<_>>();
    let mut given: Vec<_> = inputs.iter().copied().zip(&arguments.positional).collect();
    for argument in &arguments.named {
        let input = inputs.iter().find(|(name, _)| *name == argument.name.node);
        given.extend(input.map(|input| (*input, &argument.value)));
    }
    let mut outer = None;
    for ((_, rank), argument) in &given {
        let sizes = sizes_of(names, argument)?;
        let surplus = sizes.len().checked_sub(*rank)?;
        if surplus > 0 && outer.is_none() {
            outer = Some(sizes[..surplus].to_vec());
        }
    }
    let mut sizes = outer.unwrap_or_default();
    for size in function.output()? {
        sizes.push(match size {
            Subscript::All(_) => None,
            Subscript::Index(size) => {
                let mut size = size.clone();
                GivenInputs { names, given: &given }.expression(&mut size);
                integer(names, &size).and_then(|size| usize::try_from(size).ok())
            }
        });
    }
    Some(sizes)
}

/// Writes the arguments for the inputs of a function, and numbers for their sizes.
struct GivenInputs<'n, 'a, N> {
    names: &'n mut N,
    given: &'a [((Ident, usize), &'a Expression)],
}

impl<N: SizesOfNames> Rewrite for GivenInputs<'_, '_, N> {
    fn expression(&mut self, e: &mut Expression) {
        if let ExpressionKind::Reference(reference) = &e.kind
            && let Some(name) = reference.as_ident()
            && let Some((_, value)) = self.given.iter().find(|((input, _), _)| *input == name)
        {
            *e = (*value).clone();
            return;
        }
        rewrite_expression(self, e);
        if let ExpressionKind::Call { function, arguments } = &e.kind
            && function.as_ident().is_some_and(|name| name == "size")
            && let [array, at] = arguments.positional.as_slice()
            && let ExpressionKind::Integer(at) = at.kind
            && let Some(sizes) = sizes_of(self.names, array)
            && let Some(Some(size)) = usize::try_from(at - 1).ok().and_then(|at| sizes.get(at))
        {
            e.kind = ExpressionKind::Integer(*size as i64);
        }
    }
}

/// The value of an expression that is an Integer, where it is known.
fn integer<N: SizesOfNames>(names: &mut N, e: &Expression) -> Option<i64> {
    match e.kind {
        ExpressionKind::Integer(number) => Some(number),
        _ => match names.value(e)? {
            Value::Integer(number) => Some(number),
            _ => None,
        },
    }
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
        integer(self.names, self.arguments.get(at)?)
    }

    fn size(&mut self, at: usize) -> Option<i64> {
        let size = self.number(at);
        self.open |= size.is_none();
        size.or(Some(1))
    }
}
