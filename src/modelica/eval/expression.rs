//! Expressions (MLS ch. 3).

use super::errors::{MISPLACED, WRONG_OUTPUTS};
use super::scalar::Scalar;
use super::{Evaluator, depth};
use crate::diag::{At, Diagnostic, Fault};
use crate::fault;
use crate::name::Name;
use crate::source::Span;
use crate::syntax::ast::{
    BinaryOperator, Expression, ExpressionKind, NamedArgument, Operation, UnaryOperator,
};
use crate::value::construct::{self, Range};
use crate::value::errors::{REAL_OVERFLOW, TYPE_MISMATCH};
use crate::value::{FunctionValue, Value, ops};

/// The sum, difference or product of two numbers beyond the largest Real; a quotient or a power without
/// a finite value is a fault in compiled functions too.
fn infinite(operator: BinaryOperator, a: &Value, b: &Value) -> Option<Value> {
    let (Value::Real(a), Value::Real(b)) = (a, b) else { return None };
    Some(Value::Real(match operator {
        BinaryOperator::Add | BinaryOperator::ElementwiseAdd => a + b,
        BinaryOperator::Subtract | BinaryOperator::ElementwiseSubtract => a - b,
        BinaryOperator::Multiply | BinaryOperator::ElementwiseMultiply => a * b,
        _ => return None,
    }))
}

impl Evaluator<'_> {
    /// All outputs of a call; the one value of any other expression.
    pub(super) fn outputs(&mut self, expression: &Expression) -> Result<Vec<Value>, Diagnostic> {
        match &expression.kind {
            ExpressionKind::Call { function, arguments } => {
                self.call(function, arguments, expression.span)
            }
            _ => Ok(vec![self.expression(expression)?]),
        }
    }

    /// The value of an expression; of a call the first output.
    pub(super) fn expression(&mut self, expression: &Expression) -> Result<Value, Diagnostic> {
        match &expression.kind {
            ExpressionKind::Real(value) => real(*value).at(expression.span),
            ExpressionKind::Integer(value) => Ok(Value::Integer(*value)),
            ExpressionKind::Boolean(value) => Ok(Value::Boolean(*value)),
            ExpressionKind::String(text) => Ok(Value::String(text.clone())),
            ExpressionKind::Reference(reference) => self.reference(reference),
            ExpressionKind::End => self.end(expression.span),
            ExpressionKind::TypeName(name) => Ok(Value::TypeName(name.clone())),
            ExpressionKind::Code(text) => Ok(Value::VariableName(text.clone())),
            _ => {
                depth::check_nesting().at(expression.span)?;
                self.composite(expression)
            }
        }
    }

    fn composite(&mut self, expression: &Expression) -> Result<Value, Diagnostic> {
        let span = expression.span;
        match &expression.kind {
            ExpressionKind::Binary { .. } => {
                let (first, operations) = expression.chain();
                let first = self.expression(first)?;
                operations.iter().try_fold(first, |left, one| self.operation(left, one))
            }
            ExpressionKind::Unary { operator, operand } => self.unary(*operator, operand, span),
            ExpressionKind::Call { .. } => self.first_output(expression),
            ExpressionKind::If { branches, otherwise } => self.chosen(branches, otherwise),
            ExpressionKind::Range { start, step, stop } => {
                self.range(start, step.as_deref(), stop, span)?.into_value().at(span)
            }
            ExpressionKind::Guarded { name, condition, values } => {
                self.guarded(*name, condition, values)?.into_value().at(span)
            }
            ExpressionKind::Array(elements) => {
                let values = self.expressions(elements)?;
                construct::array(values).at(span)
            }
            ExpressionKind::ArrayIteration { element, indices } => {
                self.array_iteration(element, indices, span)
            }
            ExpressionKind::Matrix(rows) => self.matrix(rows, span),
            ExpressionKind::Tuple(elements) => self.tuple(elements, span),
            ExpressionKind::PartialApplication { function, named } => {
                self.partial_application(function, named)
            }
            ExpressionKind::Subscripted { base, subscripts } => {
                let base = self.expression(base)?;
                let indices = self.subscripts(subscripts, base.dims())?;
                base.part(&[crate::value::Step::Index(indices)]).at(span)
            }
            ExpressionKind::Field { base, name } => {
                self.expression(base)?.part(&[crate::value::Step::Field(*name)]).at(span)
            }
            _ => self.expression(expression),
        }
    }

    pub(super) fn expressions(
        &mut self,
        expressions: &[Expression],
    ) -> Result<Vec<Value>, Diagnostic> {
        expressions.iter().map(|expression| self.expression(expression)).collect()
    }

    /// A condition: a scalar Boolean.
    pub(super) fn condition(&mut self, expression: &Expression) -> Result<bool, Diagnostic> {
        self.host.begin_use(expression);
        let value = self.boolean(expression)?;
        if let Some(script) = self.host.script() {
            script.tested();
        }
        Ok(value)
    }

    fn boolean(&mut self, expression: &Expression) -> Result<bool, Diagnostic> {
        if let Some(Scalar::Boolean(value)) = self.scalar(expression) {
            return Ok(value);
        }
        match self.expression(expression)? {
            Value::Boolean(value) => Ok(value),
            other => Err(fault!(
                TYPE_MISMATCH,
                "a condition must be a Boolean, not a {}",
                other.type_name()
            )
            .at(expression.span)),
        }
    }

    fn first_output(&mut self, call: &Expression) -> Result<Value, Diagnostic> {
        let mut outputs = self.outputs(call)?;
        if outputs.is_empty() {
            let message = "expected a value, but the called function has no output";
            return Err(Fault::new(WRONG_OUTPUTS, message).at(call.span));
        }
        Ok(outputs.swap_remove(0))
    }

    fn end(&mut self, span: Span) -> Result<Value, Diagnostic> {
        match self.scope.ends.last() {
            Some(size) => Ok(Value::Integer(*size as i64)),
            None => Err(Fault::new(MISPLACED, "`end` is allowed only inside subscripts").at(span)),
        }
    }

    fn unary(
        &mut self,
        operator: UnaryOperator,
        operand: &Expression,
        span: Span,
    ) -> Result<Value, Diagnostic> {
        let value = self.expression(operand)?;
        match operator {
            UnaryOperator::Plus | UnaryOperator::ElementwisePlus => ops::plus(value).at(span),
            UnaryOperator::Minus | UnaryOperator::ElementwiseMinus => ops::negate(&value).at(span),
            UnaryOperator::Not => ops::not(&value).at(span),
        }
    }

    fn operation(&mut self, a: Value, one: &Operation<'_>) -> Result<Value, Diagnostic> {
        let (operator, span) = (one.operator, one.whole.span);
        match (operator, &a) {
            (BinaryOperator::And, Value::Boolean(false)) => return Ok(a),
            (BinaryOperator::Or, Value::Boolean(true)) => return Ok(a),
            _ => {}
        }
        let b = self.expression(one.right)?;
        match apply(operator, &a, &b) {
            Err(e) if e.code == REAL_OVERFLOW && self.host.overflows() => {
                infinite(operator, &a, &b).ok_or_else(|| e.at(span))
            }
            result => result
                .map_err(|fault| match self.is_scalar_product_beside_array(one, (&a, &b)) {
                    true => Fault::new(fault.code, fault.message).help(
                        "`*` of two vectors is their scalar product, a number: write `.*` to \
                         multiply element by element",
                    ),
                    false => fault,
                })
                .at(span),
        }
    }

    /// Whether a sum or difference of an array and a number fails for a number that is the product of
    /// two vectors.
    fn is_scalar_product_beside_array(
        &self,
        one: &Operation<'_>,
        (a, b): (&Value, &Value),
    ) -> bool {
        use BinaryOperator::{Add, Multiply, Subtract};
        let ExpressionKind::Binary { left, .. } = &one.whole.kind else { return false };
        let number = match (a.rank(), b.rank()) {
            (0, 1..) => &**left,
            (1.., 0) => one.right,
            _ => return false,
        };
        let ExpressionKind::Binary { operator: Multiply, left, right } = &number.kind else {
            return false;
        };
        let is_vector = |factor: &Expression| match &factor.kind {
            ExpressionKind::Reference(reference) => {
                let value = reference.as_ident().and_then(|name| self.scope.get(name));
                value.is_some_and(|value| value.rank() == 1)
            }
            ExpressionKind::Array(_) => true,
            _ => false,
        };
        matches!(one.operator, Add | Subtract) && (is_vector(left) || is_vector(right))
    }

    /// Only the chosen branch is evaluated (MLS §3.3).
    fn chosen(
        &mut self,
        branches: &[(Expression, Expression)],
        otherwise: &Expression,
    ) -> Result<Value, Diagnostic> {
        for (condition, value) in branches {
            if self.condition(condition)? {
                return self.expression(value);
            }
        }
        self.expression(otherwise)
    }

    pub(super) fn range(
        &mut self,
        start: &Expression,
        step: Option<&Expression>,
        stop: &Expression,
        span: Span,
    ) -> Result<Range, Diagnostic> {
        let start = self.expression(start)?;
        let step = step.map(|step| self.expression(step)).transpose()?;
        let stop = self.expression(stop)?;
        Range::new(&start, step.as_ref(), &stop).at(span)
    }

    fn matrix(&mut self, rows: &[Vec<Expression>], span: Span) -> Result<Value, Diagnostic> {
        let rows = rows.iter().map(|row| self.expressions(row)).collect::<Result<Vec<_>, _>>()?;
        construct::matrix(rows).at(span)
    }

    fn tuple(&mut self, elements: &[Option<Expression>], span: Span) -> Result<Value, Diagnostic> {
        let missing =
            || Fault::new(WRONG_OUTPUTS, "an output list with a gap is not a value").at(span);
        let values = elements
            .iter()
            .map(|element| self.expression(element.as_ref().ok_or_else(missing)?))
            .collect::<Result<Vec<_>, Diagnostic>>()?;
        Ok(Value::Tuple(values))
    }

    /// `function f(x = 1)` (MLS §12.4.2.1)
    pub(super) fn partial_application(
        &mut self,
        function: &Name,
        named: &[NamedArgument],
    ) -> Result<Value, Diagnostic> {
        let given = named
            .iter()
            .map(|argument| Ok((argument.name.node, self.expression(&argument.value)?)))
            .collect::<Result<Vec<_>, Diagnostic>>()?;
        let local = function.first().filter(|_| function.is_simple());
        if let Some(Value::Function(known)) = local.and_then(|ident| self.scope.get(ident)) {
            let mut known = known.clone();
            known.named.extend(given);
            return Ok(Value::Function(known));
        }
        Ok(Value::Function(FunctionValue { name: function.clone(), named: given }))
    }
}

/// A number as it is written.
fn real(value: f64) -> Result<Value, Fault> {
    match value.is_finite() {
        true => Ok(Value::Real(value)),
        false => Err(fault!(REAL_OVERFLOW, "the number exceeds the largest Real, 1.8e308";
            help: "use `Modelica.Constants.inf` for a limit that is never reached")),
    }
}

pub(super) fn apply(operator: BinaryOperator, a: &Value, b: &Value) -> Result<Value, Fault> {
    match operator {
        BinaryOperator::Add => ops::add(a, b),
        BinaryOperator::Subtract => ops::subtract(a, b),
        BinaryOperator::Multiply => ops::multiply(a, b),
        BinaryOperator::Divide => ops::divide(a, b),
        BinaryOperator::Power => ops::power(a, b),
        BinaryOperator::ElementwiseAdd => ops::elementwise_add(a, b),
        BinaryOperator::ElementwiseSubtract => ops::elementwise_subtract(a, b),
        BinaryOperator::ElementwiseMultiply => ops::elementwise_multiply(a, b),
        BinaryOperator::ElementwiseDivide => ops::elementwise_divide(a, b),
        BinaryOperator::ElementwisePower => ops::elementwise_power(a, b),
        BinaryOperator::Less => ops::less(a, b).map(Value::Boolean),
        BinaryOperator::LessEqual => ops::less_equal(a, b).map(Value::Boolean),
        BinaryOperator::Greater => ops::greater(a, b).map(Value::Boolean),
        BinaryOperator::GreaterEqual => ops::greater_equal(a, b).map(Value::Boolean),
        BinaryOperator::Equal => ops::equal(a, b).map(Value::Boolean),
        BinaryOperator::NotEqual => ops::not_equal(a, b).map(Value::Boolean),
        BinaryOperator::And => ops::and(a, b),
        BinaryOperator::Or => ops::or(a, b),
    }
}
