//! The quick way to scalar numbers and conditions: literals, local variables, arithmetic and
//! relations, without the detour over [`Value`](crate::value::Value). Nothing with an effect is
//! evaluated and nothing fails: where anything else stands or a result is out of range, the general
//! way is taken, which gives the same values and the errors.

use super::scalar::{MAX_DEPTH, Scalar, binary, unary};
use super::{Evaluator, Scope};
use crate::syntax::ast::{Expression, ExpressionKind};

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
