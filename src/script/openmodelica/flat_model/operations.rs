//! Operators and constructors of arrays, applied to scalars that were taken apart.

use crate::source::Span;
use crate::syntax::ast::{BinaryOperator, Expression, ExpressionKind, UnaryOperator};

/// Scalars that one expression may have.
pub(super) const MAX_SCALARS: usize = 1 << 16;

/// Operators and operands that the scalars of one expression may have together: products of
/// matrices grow with every factor.
const MAX_NODES: usize = 1 << 18;

/// The sizes of an expression and its scalars, row-major.
#[derive(Debug, Clone)]
pub(super) struct Parts {
    pub dims: Vec<usize>,
    pub scalars: Vec<Expression>,
}

impl Parts {
    pub(super) fn scalar(e: Expression) -> Parts {
        Parts { dims: Vec::new(), scalars: vec![e] }
    }

    pub(super) fn map(self, each: impl FnMut(Expression) -> Expression) -> Parts {
        Parts { dims: self.dims, scalars: self.scalars.into_iter().map(each).collect() }
    }

    /// Parts of equal sizes side by side, in a new first dimension.
    pub(super) fn stacked(rows: Vec<Parts>) -> Option<Parts> {
        let inner = rows.first()?.dims.clone();
        if rows.iter().any(|row| row.dims != inner) {
            return None;
        }
        let dims = [vec![rows.len()], inner].concat();
        let scalars: Vec<Expression> = rows.into_iter().flat_map(|row| row.scalars).collect();
        (scalars.len() <= MAX_SCALARS).then_some(Parts { dims, scalars })
    }
}

/// How many operators and operands an expression has, at least.
fn nodes(e: &Expression) -> usize {
    let inner = match &e.kind {
        ExpressionKind::Binary { .. } => e.operands().map(|operand| 1 + nodes(operand)).sum(),
        ExpressionKind::Unary { operand, .. } => nodes(operand),
        ExpressionKind::If { branches, otherwise } => {
            let branch = |(condition, value): &(_, _)| nodes(condition) + nodes(value);
            branches.iter().map(branch).sum::<usize>() + nodes(otherwise)
        }
        ExpressionKind::Call { arguments, .. } => arguments.positional.iter().map(nodes).sum(),
        _ => 0,
    };
    1 + inner
}

fn weight(parts: &Parts) -> usize {
    parts.scalars.iter().map(nodes).sum()
}

pub(super) fn filled(dims: Vec<usize>, value: Expression) -> Option<Parts> {
    let count = dims.iter().try_fold(1usize, |all, size| all.checked_mul(*size))?;
    (count <= MAX_SCALARS && count.saturating_mul(nodes(&value)) <= MAX_NODES)
        .then(|| Parts { dims, scalars: vec![value; count] })
}

pub(super) fn transposed(parts: Parts) -> Option<Parts> {
    let [rows, columns] = *parts.dims.as_slice() else { return None };
    let at = |k: usize| parts.scalars[(k % rows) * columns + k / rows].clone();
    Some(Parts { dims: vec![columns, rows], scalars: (0..rows * columns).map(at).collect() })
}

/// An operator of scalars; two Integers are calculated, as subscripts of loops written out need.
pub(super) fn operation(operator: BinaryOperator, a: Expression, b: Expression) -> Expression {
    if let (ExpressionKind::Integer(a), ExpressionKind::Integer(b)) = (&a.kind, &b.kind) {
        let value = match operator {
            BinaryOperator::Add => a.checked_add(*b),
            BinaryOperator::Subtract => a.checked_sub(*b),
            BinaryOperator::Multiply => a.checked_mul(*b),
            _ => None,
        };
        if let Some(value) = value {
            return Expression::new(ExpressionKind::Integer(value), Span::NONE);
        }
    }
    let span = a.span;
    Expression::operation(operator, a, b, span)
}

pub(super) fn binary(operator: BinaryOperator, a: Parts, b: Parts) -> Option<Parts> {
    use BinaryOperator as Op;
    if !is_small(operator, &a, &b) {
        return None;
    }
    match (a.dims.as_slice(), b.dims.as_slice()) {
        (one, other) if one == other && (one.is_empty() || is_by_element(operator)) => {
            let pairs = a.scalars.into_iter().zip(b.scalars);
            let scalars = pairs.map(|(a, b)| operation(of_scalars(operator), a, b)).collect();
            Some(Parts { dims: b.dims, scalars })
        }
        ([], _) if is_with_scalar(operator) => {
            let a = a.scalars.into_iter().next()?;
            Some(b.map(|b| operation(of_scalars(operator), a.clone(), b)))
        }
        (_, []) if is_with_scalar(operator) || operator == Op::Divide => {
            let b = b.scalars.into_iter().next()?;
            Some(a.map(|a| operation(of_scalars(operator), a, b.clone())))
        }
        _ if operator == Op::Multiply => product(&a, &b),
        _ => None,
    }
}

/// Whether the result has no more operators and operands than one may have: scalars are written
/// for every element, rows for every column, and columns for every row.
fn is_small(operator: BinaryOperator, a: &Parts, b: &Parts) -> bool {
    let (of_a, of_b) = match (a.dims.as_slice(), b.dims.as_slice()) {
        ([], []) => return true,
        ([], _) => (b.scalars.len(), 1),
        (_, []) => (1, a.scalars.len()),
        _ if operator == BinaryOperator::Multiply => {
            (*b.dims.get(1).unwrap_or(&1), if a.dims.len() == 2 { a.dims[0] } else { 1 })
        }
        _ => (1, 1),
    };
    let (a, b) = (weight(a).saturating_mul(of_a), weight(b).saturating_mul(of_b));
    a.saturating_add(b) <= MAX_NODES
}

/// Products of vectors and matrices (MLS §10.6.5).
fn product(a: &Parts, b: &Parts) -> Option<Parts> {
    let ((rows, n), (m, columns)) = match (a.dims.as_slice(), b.dims.as_slice()) {
        ([n], [m]) => ((1, *n), (*m, 1)),
        ([rows, n], [m]) => ((*rows, *n), (*m, 1)),
        ([n], [m, columns]) => ((1, *n), (*m, *columns)),
        ([rows, n], [m, columns]) => ((*rows, *n), (*m, *columns)),
        _ => return None,
    };
    if n != m || n == 0 {
        return None;
    }
    let entry = |i: usize, j: usize| {
        let terms = (0..n).map(|k| {
            let (left, right) = (&a.scalars[i * n + k], &b.scalars[k * columns + j]);
            operation(BinaryOperator::Multiply, left.clone(), right.clone())
        });
        terms.reduce(|a, b| operation(BinaryOperator::Add, a, b))
    };
    let all = (0..rows).flat_map(|i| (0..columns).map(move |j| (i, j)));
    let scalars = all.map(|(i, j)| entry(i, j)).collect::<Option<Vec<_>>>()?;
    let outer = |parts: &Parts, kept: std::ops::Range<usize>| parts.dims[kept].to_vec();
    let dims = [outer(a, 0..a.dims.len() - 1), outer(b, 1..b.dims.len())].concat();
    Some(Parts { dims, scalars })
}

fn is_by_element(operator: BinaryOperator) -> bool {
    use BinaryOperator as Op;
    matches!(operator, Op::Add | Op::Subtract) || of_scalars(operator) != operator
}

fn is_with_scalar(operator: BinaryOperator) -> bool {
    operator == BinaryOperator::Multiply || of_scalars(operator) != operator
}

/// `.*` as `*`: the same of scalars.
fn of_scalars(operator: BinaryOperator) -> BinaryOperator {
    use BinaryOperator as Op;
    match operator {
        Op::ElementwiseAdd => Op::Add,
        Op::ElementwiseSubtract => Op::Subtract,
        Op::ElementwiseMultiply => Op::Multiply,
        Op::ElementwiseDivide => Op::Divide,
        Op::ElementwisePower => Op::Power,
        other => other,
    }
}

/// The values of a range of Integers.
pub(super) fn counted(start: i64, step: i64, stop: i64) -> Option<Vec<i64>> {
    let count = stop.checked_sub(start)?.checked_div(step)?.saturating_add(1).max(0);
    let is_possible = usize::try_from(count).is_ok_and(|count| count <= MAX_SCALARS);
    is_possible.then(|| (0..count).map(|at| start + at * step).collect())
}

/// The value of an expression of Integer literals.
pub(super) fn integer(e: &Expression) -> Option<i64> {
    match &e.kind {
        ExpressionKind::Integer(value) => Some(*value),
        ExpressionKind::Unary { operand, operator: UnaryOperator::Minus } => {
            integer(operand)?.checked_neg()
        }
        ExpressionKind::Binary { operator, left, right } => {
            match operation(*operator, (**left).clone(), (**right).clone()).kind {
                ExpressionKind::Integer(value) => Some(value),
                _ => None,
            }
        }
        _ => None,
    }
}
