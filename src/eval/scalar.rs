//! The quick way to scalar numbers and conditions: literals, local variables, arithmetic and
//! relations, without the detour over [`Value`]. Nothing with an effect is evaluated and nothing
//! fails: where anything else stands or a result is out of range, the general way is taken, which
//! gives the same values and the errors.

use super::{Evaluator, Scope};
use crate::syntax::ast::{BinaryOperator, Expression, ExpressionKind, UnaryOperator};
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

impl Evaluator<'_> {
    /// The value of an operator applied to scalars; `None` where the general way has to be taken.
    pub(super) fn scalar(&self, expression: &Expression) -> Option<Scalar> {
        match &expression.kind {
            ExpressionKind::Binary { .. } | ExpressionKind::Unary { .. } => {
                scalar(self.scope, expression, MAX_DEPTH)
            }
            _ => None,
        }
    }
}

pub(super) fn scalar(scope: &Scope, expression: &Expression, depth: usize) -> Option<Scalar> {
    match &expression.kind {
        ExpressionKind::Real(value) if value.is_finite() => Some(Scalar::Real(*value)),
        ExpressionKind::Integer(value) => Some(Scalar::Integer(*value)),
        ExpressionKind::Boolean(value) => Some(Scalar::Boolean(*value)),
        ExpressionKind::Reference(reference) => Scalar::of(scope.get(reference.as_ident()?)?),
        ExpressionKind::Binary { operator, left, right } => {
            let depth = depth.checked_sub(1)?;
            let a = scalar(scope, left, depth)?;
            binary(*operator, a, scalar(scope, right, depth)?)
        }
        ExpressionKind::Unary { operator, operand } => {
            unary(*operator, scalar(scope, operand, depth.checked_sub(1)?)?)
        }
        _ => None,
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
