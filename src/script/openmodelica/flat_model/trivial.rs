//! How many equations of a flat model say only what one variable is.

use super::parts::Apart;
use crate::flatten::{FlatModel, Variability};
use crate::syntax::ast::{
    BinaryOperator, CausalityPrefix, Equation, EquationKind, Expression, ExpressionKind,
    UnaryOperator,
};

/// Equations that equate a variable with another, with its negative, with a constant or with the
/// derivative of another, and the declaration equations of variables.
pub(crate) fn trivial_equations(model: &FlatModel) -> usize {
    let declared = model.variables.values().filter(|variable| {
        variable.variability > Variability::Parameter
            && variable.binding.is_some()
            && variable.causality != Some(CausalityPrefix::Input)
    });
    let declared: usize = declared.map(|variable| variable.len()).sum();
    let equations = Apart(model).equations(&model.equations);
    declared + equations.iter().filter(|equation| is_trivial(equation)).count()
}

fn is_trivial(equation: &Equation) -> bool {
    let EquationKind::Equal { left, right } = &equation.kind else { return false };
    let is_sum = |sum: &Expression, zero: &Expression| match &sum.kind {
        ExpressionKind::Binary { operator: BinaryOperator::Add, left, right } => {
            is_zero(zero) && is_variable(left) && is_variable(right)
        }
        _ => false,
    };
    let one_is_variable = is_variable(left) || is_variable(right);
    (one_is_variable && is_simple(left) && is_simple(right))
        || is_sum(left, right)
        || is_sum(right, left)
}

fn is_zero(e: &Expression) -> bool {
    matches!(e.kind, ExpressionKind::Integer(0) | ExpressionKind::Real(0.0))
}

fn is_variable(e: &Expression) -> bool {
    match &e.kind {
        ExpressionKind::Reference(_) => true,
        ExpressionKind::Unary { operator: UnaryOperator::Minus | UnaryOperator::Not, operand } => {
            is_variable(operand)
        }
        _ => false,
    }
}

fn is_simple(e: &Expression) -> bool {
    match &e.kind {
        ExpressionKind::Reference(_)
        | ExpressionKind::Real(_)
        | ExpressionKind::Integer(_)
        | ExpressionKind::Boolean(_)
        | ExpressionKind::String(_) => true,
        ExpressionKind::Unary { operand, .. } => is_simple(operand),
        ExpressionKind::Call { function, arguments } => {
            function.as_ident().is_some_and(|name| name == "der")
                && arguments.positional.iter().all(is_variable)
        }
        _ => false,
    }
}
