//! Integer literals where Reals are meant, written as Reals: `2.0*x`.

use super::parts::Apart;
use crate::flatten::{BaseType, FlatModel};
use crate::syntax::ast::{
    BinaryOperator, ComponentReference, Equation, EquationKind, Expression, ExpressionKind,
    Statement, StatementKind,
};
use crate::syntax::visit::{Rewrite, rewrite_equation, rewrite_expression, rewrite_statement};

/// Functions whose values are Integers.
const OF_INTEGERS: &[&str] = &["integer", "Integer", "size", "ndims"];

/// Functions whose value has the type of their arguments.
const AS_ARGUMENTS: &[&str] =
    &["abs", "min", "max", "sum", "product", "mod", "rem", "div", "pre", "noEvent", "smooth"];

/// Knows the types of the variables of a model.
#[derive(Clone, Copy)]
pub(super) struct Numbers<'m>(pub(super) &'m FlatModel);

impl Numbers<'_> {
    /// The expression with Real literals where Reals are calculated with; `is_real`: the whole is
    /// for a Real.
    pub(super) fn converted(self, e: &Expression, is_real: bool) -> Expression {
        let mut e = e.clone();
        let mut numbers = self;
        numbers.expression(&mut e);
        if is_real {
            make_real(&mut e);
        }
        e
    }

    pub(super) fn convert_equation(self, equation: &mut Equation) {
        let mut numbers = self;
        numbers.equation(equation);
    }

    pub(super) fn convert_statement(self, statement: &mut Statement) {
        let mut numbers = self;
        numbers.statement(statement);
    }

    fn is_real_reference(&self, reference: &ComponentReference) -> bool {
        if reference.as_ident().is_some_and(|name| name == "time") {
            return true;
        }
        let variable = self.0.variables.get(Apart::key(reference).as_str());
        variable.is_some_and(|variable| variable.base == BaseType::Real)
    }

    /// The operands of each operation on numbers are Reals where the result or one of them is.
    fn convert_chain(self, e: &mut Expression) {
        let (first, operations) = e.chain();
        let mut is_real = self.is_real(first);
        let mut convert = Vec::with_capacity(operations.len());
        for one in operations {
            let of_operands = is_real || self.is_real(one.right);
            let is_divided = matches!(one.operator, BinaryOperator::Divide | BinaryOperator::Power);
            let is_number = !matches!(one.operator, BinaryOperator::And | BinaryOperator::Or);
            is_real = is_divided || (of_operands && is_of_operands(one.operator));
            convert.push(is_number && (is_real || of_operands));
        }
        let (first, operations) = e.chain_mut();
        let mut is_inner = false;
        for (one, convert) in operations.into_iter().zip(convert).rev() {
            is_inner = convert || (is_inner && is_of_operands(one.operator));
            if is_inner {
                make_real(one.right);
            }
        }
        if is_inner {
            make_real(first);
        }
    }

    fn is_real(&self, e: &Expression) -> bool {
        match &e.kind {
            ExpressionKind::Real(_) => true,
            ExpressionKind::Reference(reference) => self.is_real_reference(reference),
            ExpressionKind::Binary { operator, .. } => match operator {
                BinaryOperator::Divide | BinaryOperator::Power => true,
                _ if is_of_operands(*operator) => {
                    e.operands_of(is_of_operands).any(|operand| self.is_real(operand))
                }
                _ => false,
            },
            ExpressionKind::Unary { operand, .. } => self.is_real(operand),
            ExpressionKind::If { branches, otherwise } => {
                self.is_real(otherwise) || branches.iter().any(|(_, value)| self.is_real(value))
            }
            ExpressionKind::Call { function, arguments } => {
                let name = function.name();
                let text = name.to_string();
                match self.0.functions.get(&name) {
                    Some(function) => function
                        .outputs
                        .first()
                        .is_some_and(|output| output.value_type == crate::eval::ValueType::Real),
                    None if AS_ARGUMENTS.contains(&text.as_str()) => {
                        arguments.positional.iter().any(|argument| self.is_real(argument))
                    }
                    None => !OF_INTEGERS.contains(&text.as_str()),
                }
            }
            _ => false,
        }
    }
}

impl Rewrite for Numbers<'_> {
    fn expression(&mut self, e: &mut Expression) {
        rewrite_expression(self, e);
        let is_real = self.is_real(e);
        match &mut e.kind {
            ExpressionKind::Binary { .. } => self.convert_chain(e),
            ExpressionKind::If { branches, otherwise } if is_real => {
                branches.iter_mut().for_each(|(_, value)| make_real(value));
                make_real(otherwise);
            }
            _ => {}
        }
    }

    /// Subscripts stay Integers.
    fn reference(&mut self, _: &mut ComponentReference) {}

    fn equation(&mut self, equation: &mut Equation) {
        rewrite_equation(self, equation);
        if let EquationKind::Equal { left, right } = &mut equation.kind
            && (self.is_real(left) || self.is_real(right))
        {
            make_real(left);
            make_real(right);
        }
    }

    fn statement(&mut self, statement: &mut Statement) {
        rewrite_statement(self, statement);
        if let StatementKind::Assign { target, value } = &mut statement.kind
            && self.is_real_reference(target)
        {
            make_real(value);
        }
    }
}

/// Whether the result is a Real where an operand is.
fn is_of_operands(operator: BinaryOperator) -> bool {
    matches!(operator, BinaryOperator::Add | BinaryOperator::Subtract | BinaryOperator::Multiply)
}

/// An Integer literal, perhaps with a sign, as a Real.
fn make_real(e: &mut Expression) {
    match &mut e.kind {
        ExpressionKind::Integer(value) => e.kind = ExpressionKind::Real(*value as f64),
        ExpressionKind::Unary { operand, .. } => make_real(operand),
        ExpressionKind::Array(elements) => elements.iter_mut().for_each(make_real),
        ExpressionKind::If { branches, otherwise } => {
            branches.iter_mut().for_each(|(_, value)| make_real(value));
            make_real(otherwise);
        }
        ExpressionKind::Binary { .. } => {
            let (first, operations) = e.chain_mut();
            for one in operations.into_iter().rev() {
                if !is_of_operands(one.operator) {
                    return;
                }
                make_real(one.right);
            }
            make_real(first);
        }
        _ => {}
    }
}
