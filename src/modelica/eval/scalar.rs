//! Scalar numbers and conditions without the detour over [`Value`]. Nothing fails: where a result
//! is out of range there is none.

use crate::syntax::ast::{BinaryOperator, UnaryOperator};
use crate::value::Value;

/// Operators inside each other; deeper ones are left to the general way, which guards the stack.
pub(super) const MAX_DEPTH: usize = 24;

/// A scalar.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Scalar {
    Real(f64),
    Integer(i64),
    Boolean(bool),
}

impl Scalar {
    /// A scalar value; `None` of any other.
    pub(super) fn of(value: &Value) -> Option<Scalar> {
        match value {
            Value::Real(value) => Some(Scalar::Real(*value)),
            Value::Integer(value) => Some(Scalar::Integer(*value)),
            Value::Boolean(value) => Some(Scalar::Boolean(*value)),
            _ => None,
        }
    }

    fn real(self) -> Option<f64> {
        match self {
            Scalar::Real(value) => Some(value),
            Scalar::Integer(value) => Some(value as f64),
            Scalar::Boolean(_) => None,
        }
    }
}

impl From<Scalar> for Value {
    fn from(scalar: Scalar) -> Value {
        match scalar {
            Scalar::Real(value) => Value::Real(value),
            Scalar::Integer(value) => Value::Integer(value),
            Scalar::Boolean(value) => Value::Boolean(value),
        }
    }
}

pub(super) fn unary(operator: UnaryOperator, operand: Scalar) -> Option<Scalar> {
    match (operator, operand) {
        (UnaryOperator::Minus, Scalar::Real(value)) => Some(Scalar::Real(-value)),
        (UnaryOperator::Minus, Scalar::Integer(value)) => value.checked_neg().map(Scalar::Integer),
        (UnaryOperator::Not, Scalar::Boolean(value)) => Some(Scalar::Boolean(!value)),
        (UnaryOperator::Plus, Scalar::Real(_) | Scalar::Integer(_)) => Some(operand),
        _ => None,
    }
}

pub(super) fn binary(operator: BinaryOperator, a: Scalar, b: Scalar) -> Option<Scalar> {
    use BinaryOperator as Op;
    if let (Scalar::Integer(a), Scalar::Integer(b)) = (a, b) {
        let integer = match operator {
            Op::Add => a.checked_add(b),
            Op::Subtract => a.checked_sub(b),
            Op::Multiply => a.checked_mul(b),
            _ => None,
        };
        if let Some(value) = integer {
            return Some(Scalar::Integer(value));
        }
        return relation(operator, a.cmp(&b));
    }
    if let (Scalar::Real(a), Scalar::Real(b)) = (a, b)
        && let Some(result) = a.partial_cmp(&b).and_then(|order| relation(operator, order))
    {
        return Some(result);
    }
    let (a, b) = (a.real()?, b.real()?);
    let real = match operator {
        Op::Add => a + b,
        Op::Subtract => a - b,
        Op::Multiply => a * b,
        Op::Divide if b != 0.0 => a / b,
        _ => return None,
    };
    real.is_finite().then_some(Scalar::Real(real))
}

fn relation(operator: BinaryOperator, order: std::cmp::Ordering) -> Option<Scalar> {
    Some(Scalar::Boolean(match operator {
        BinaryOperator::Less => order.is_lt(),
        BinaryOperator::LessEqual => order.is_le(),
        BinaryOperator::Greater => order.is_gt(),
        BinaryOperator::GreaterEqual => order.is_ge(),
        _ => return None,
    }))
}
