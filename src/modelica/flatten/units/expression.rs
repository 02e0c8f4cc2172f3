//! The dimensions of expressions.

use super::Units;
use crate::flatten::balance::path;
use crate::functions;
use crate::symbolic::function::UnitRule;
use crate::syntax::ast::{
    Arguments, BinaryOperator, ComponentReference, Expression, ExpressionKind, Operation,
    UnaryOperator,
};
use crate::units::Dimension;

const SECOND: Dimension = Dimension::new([0, 0, 1, 0, 0, 0, 0, 0]);

/// What an operator compares, as messages call it; `None` if its operands may differ.
pub(crate) fn compared(operator: BinaryOperator) -> Option<&'static str> {
    use BinaryOperator as B;
    match operator {
        B::Add | B::Subtract | B::ElementwiseAdd | B::ElementwiseSubtract => {
            Some("operands of the sum")
        }
        B::Equal | B::NotEqual | B::Less | B::LessEqual | B::Greater | B::GreaterEqual => {
            Some("sides of the relation")
        }
        _ => None,
    }
}

impl Units {
    /// That of a variable. `time` has none: ramps are written `rate*time` with the unit of the
    /// value.
    pub(crate) fn of_reference(&self, reference: &ComponentReference) -> Option<Dimension> {
        self.known.get(&*path(reference)).copied()
    }

    /// The dimension, where the units of all that matters are known.
    pub(crate) fn of_expression(&self, e: &Expression) -> Option<Dimension> {
        match &e.kind {
            ExpressionKind::Reference(reference) => self.of_reference(reference),
            ExpressionKind::Unary { operator: UnaryOperator::Not, .. } => None,
            ExpressionKind::Unary { operand, .. } => self.of_expression(operand),
            ExpressionKind::Binary { .. } => {
                let (first, operations) = e.chain();
                let first = self.of_expression(first);
                operations.iter().fold(first, |left, one| self.of_operation(left, one))
            }
            ExpressionKind::If { branches, otherwise } => {
                self.same(branches.iter().map(|(_, value)| value).chain([&**otherwise]))
            }
            ExpressionKind::Array(elements) => self.same(elements.iter()),
            ExpressionKind::Subscripted { base, .. } => self.of_expression(base),
            ExpressionKind::Call { function, arguments } => self.of_call(function, arguments),
            _ => None,
        }
    }

    /// The dimension that all have; `None` if one is not known or differs.
    fn same<'e>(&self, mut all: impl Iterator<Item = &'e Expression>) -> Option<Dimension> {
        let first = self.of_expression(all.next()?)?;
        all.all(|e| self.of_expression(e) == Some(first)).then_some(first)
    }

    /// The dimension of an operation on a left operand of a known one.
    pub(crate) fn of_operation(
        &self,
        one: Option<Dimension>,
        operation: &Operation<'_>,
    ) -> Option<Dimension> {
        use BinaryOperator as B;
        let right = operation.right;
        match operation.operator {
            // Whatever the other operand, it should measure the same.
            B::Add | B::Subtract | B::ElementwiseAdd | B::ElementwiseSubtract => {
                let other = self.of_expression(right);
                if one.is_some() && other.is_some() && one != other { None } else { one.or(other) }
            }
            B::Multiply | B::ElementwiseMultiply => one?.times(self.of_expression(right)?),
            B::Divide | B::ElementwiseDivide => one?.over(self.of_expression(right)?),
            B::Power | B::ElementwisePower => one?.power(number(right)?),
            _ => None,
        }
    }

    fn of_call(&self, function: &ComponentReference, arguments: &Arguments) -> Option<Dimension> {
        if !arguments.named.is_empty() || !arguments.iterators.is_empty() {
            return None;
        }
        let of = |at: usize| self.of_expression(arguments.positional.get(at)?);
        match functions::find(function.as_ident()?.as_str())?.unit {
            UnitRule::As(at) => of(at),
            UnitRule::Common => self.same(arguments.positional.iter()),
            UnitRule::Power(exponent) => of(0)?.power(exponent),
            UnitRule::Rate => of(0)?.over(SECOND),
            UnitRule::Unknown => None,
        }
    }
}

/// The value of a literal.
fn number(e: &Expression) -> Option<f64> {
    match &e.kind {
        ExpressionKind::Real(value) => Some(*value),
        ExpressionKind::Integer(value) => Some(*value as f64),
        ExpressionKind::Unary { operator: UnaryOperator::Minus, operand } => {
            number(operand).map(|value| -value)
        }
        _ => None,
    }
}
