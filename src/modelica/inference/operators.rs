//! What operators make of the types and sizes of their operands (MLS §3.4, §10.6).

use crate::syntax::ast::BinaryOperator;
use crate::value::ops::product_sizes;

/// The size of one dimension; `None` if it is not known.
pub(super) type Size = Option<usize>;

/// The sizes of a value: one of each dimension, none of a scalar.
pub(crate) type Sizes = Vec<Size>;

/// The type of the result of an operation.
pub(super) enum ResultType {
    Boolean,
    Real,
    /// That of both operands together, which are numbers or Strings.
    OfOperands,
}

/// Whether it compares its operands (MLS §3.5).
pub(crate) fn is_relation(operator: BinaryOperator) -> bool {
    use BinaryOperator::{Equal, Greater, GreaterEqual, Less, LessEqual, NotEqual};
    matches!(operator, Equal | NotEqual | Less | LessEqual | Greater | GreaterEqual)
}

/// Whether its operands are numbers (MLS §10.6), the sum of Strings aside.
pub(crate) fn is_arithmetic(operator: BinaryOperator) -> bool {
    !is_relation(operator) && !is_logical(operator)
}

/// Whether its operands are Boolean.
fn is_logical(operator: BinaryOperator) -> bool {
    matches!(operator, BinaryOperator::And | BinaryOperator::Or)
}

pub(super) fn result_type(operator: BinaryOperator) -> ResultType {
    use BinaryOperator as Op;
    match operator {
        _ if is_relation(operator) || is_logical(operator) => ResultType::Boolean,
        Op::Divide | Op::ElementwiseDivide | Op::Power | Op::ElementwisePower => ResultType::Real,
        _ => ResultType::OfOperands,
    }
}

/// The sizes of `left operator right`; `None` where they do not fit.
pub(super) fn result_sizes(operator: BinaryOperator, left: Sizes, right: Sizes) -> Option<Sizes> {
    use BinaryOperator as Op;
    if left.is_empty() && right.is_empty() {
        return Some(Vec::new());
    }
    match operator {
        Op::Add | Op::Subtract | Op::And | Op::Or => same(left, right),
        Op::ElementwiseAdd
        | Op::ElementwiseSubtract
        | Op::ElementwiseMultiply
        | Op::ElementwiseDivide
        | Op::ElementwisePower => with_every_element(left, right),
        Op::Multiply => product(left, right),
        Op::Divide => right.is_empty().then_some(left),
        Op::Power => match (left.as_slice(), right.as_slice()) {
            ([rows, columns], []) => one(*rows, *columns).map(|size| vec![size; 2]),
            _ => None,
        },
        _ => None,
    }
}

/// `*`: scaling, inner product, products with matrices (MLS §10.6.5).
fn product(left: Sizes, right: Sizes) -> Option<Sizes> {
    if left.is_empty() || right.is_empty() {
        return with_every_element(left, right);
    }
    let ((inner, other), sizes) = product_sizes(&left, &right)?;
    one(inner, other).map(|_| sizes)
}

/// A scalar goes with every element.
fn with_every_element(left: Sizes, right: Sizes) -> Option<Sizes> {
    match (left.is_empty(), right.is_empty()) {
        (true, _) => Some(right),
        (_, true) => Some(left),
        _ => same(left, right),
    }
}

/// The sizes that both are.
fn same(left: Sizes, right: Sizes) -> Option<Sizes> {
    if left.len() != right.len() {
        return None;
    }
    left.into_iter().zip(right).map(|(a, b)| one(a, b)).collect()
}

/// The size that both are.
fn one(a: Size, b: Size) -> Option<Size> {
    match (a, b) {
        (Some(a), Some(b)) => (a == b).then_some(Some(a)),
        _ => Some(a.or(b)),
    }
}
