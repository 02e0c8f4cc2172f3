//! Texts for people: of assertions, and of functions that print (MLS §8.3.7, §12.9).

use super::build::{Builder, UNKNOWN_TEXT, message_text};
use super::function::prints;
use super::lowering::{Lowering, Target};
use super::model::{Assertion, Level, Part};
use crate::diag::Diagnostic;
use crate::eval::Function;
use crate::flatten::BaseType;
use crate::source::Span;
use crate::symbolic::Expr;
use crate::syntax::ast::{Arguments, BinaryOperator, Expression, ExpressionKind};
use std::sync::Arc;

/// The parts of a text: what is known when compiling, and numbers that are not.
pub(super) fn message_parts(
    lowering: &mut Lowering<'_, Builder<'_>>,
    e: Option<&Expression>,
) -> Vec<Part> {
    let mut parts = Vec::new();
    if let Some(e) = e {
        collect(lowering, e, &mut parts);
    }
    parts
}

fn collect(lowering: &mut Lowering<'_, Builder<'_>>, e: &Expression, parts: &mut Vec<Part>) {
    if let ExpressionKind::Binary { operator: BinaryOperator::Add, left, right } = &e.kind {
        collect(lowering, left, parts);
        collect(lowering, right, parts);
        return;
    }
    let text = message_text(lowering, Some(e));
    let part = match text.contains(UNKNOWN_TEXT) {
        true => number(lowering, e).unwrap_or_else(|| Part::Text(text.into())),
        false => Part::Text(text.into()),
    };
    parts.push(part);
}

/// `String(x)` of a number that is not known yet.
fn number(lowering: &mut Lowering<'_, Builder<'_>>, e: &Expression) -> Option<Part> {
    let ExpressionKind::Call { function, arguments } = &e.kind else { return None };
    let [argument] = arguments.positional.as_slice() else { return None };
    if function.as_ident()? != "String" || !arguments.named.is_empty() {
        return None;
    }
    let value = lowering.scalar(argument).ok()?;
    let variable = lowering.target.dae.pool.as_variable(value);
    match variable.map(|v| &lowering.target.dae.variable(v).base) {
        Some(BaseType::Boolean) => Some(Part::Boolean(value)),
        Some(BaseType::Real | BaseType::Integer) | None => Some(Part::Number(value)),
        Some(_) => None,
    }
}

impl Builder<'_> {
    /// A call of a function that prints to the screen; `None` for other calls. It is a message that
    /// is told wherever it is carried out.
    pub(super) fn printing(
        &mut self,
        call: &Expression,
        loops: &[(crate::name::Ident, Expr)],
    ) -> Result<Option<()>, Diagnostic> {
        let ExpressionKind::Call { function, arguments } = &call.kind else { return Ok(None) };
        let Some(user) = Target::function(self, &function.name()) else { return Ok(None) };
        if !prints(&user) {
            return Ok(None);
        }
        let mut lowering = Lowering::new(self);
        lowering.loops = loops.to_vec();
        lowering.live = true;
        if let Some(file) = nth(arguments, 1, "fileName")
            && !message_text(&mut lowering, Some(file)).is_empty()
        {
            return Ok(None);
        }
        let parts = message_parts(&mut lowering, nth(arguments, 0, "string"));
        let condition = self.dae.pool.constant(0.0);
        self.dae.assertions.push(Assertion::new(condition, parts, Level::Message, call.span));
        Ok(Some(()))
    }

    /// The call of a function in a when-clause for what it does: what it writes is written wherever
    /// the statement is carried out.
    pub(super) fn effect(
        &mut self,
        user: &Arc<Function>,
        arguments: &Arguments,
        span: Span,
        loops: &[(crate::name::Ident, Expr)],
    ) -> Result<(), Diagnostic> {
        self.written.clear();
        self.functions.may_write = true;
        let mut lowering = Lowering::new(self);
        lowering.loops = loops.to_vec();
        lowering.live = true;
        let called = lowering.user_call(user, arguments, span);
        self.functions.may_write = false;
        called?;
        let parts: Vec<Part> = self.written.drain(..).map(Part::Number).collect();
        if !parts.is_empty() {
            let condition = self.dae.pool.constant(0.0);
            self.dae.assertions.push(Assertion::new(condition, parts, Level::Effect, span));
        }
        Ok(())
    }
}

pub(super) fn nth<'a>(
    arguments: &'a Arguments,
    position: usize,
    name: &str,
) -> Option<&'a Expression> {
    let named = arguments.named.iter().find(|a| a.name.node == name).map(|a| &a.value);
    arguments.positional.get(position).or(named)
}

impl Assertion {
    /// An assertion of this text.
    pub fn new(condition: Expr, parts: Vec<Part>, level: Level, span: Span) -> Assertion {
        let known = |part: &Part| match part {
            Part::Text(text) => text.to_string(),
            _ => UNKNOWN_TEXT.to_owned(),
        };
        let message = parts.iter().map(known).collect::<String>().into();
        Assertion { condition, message, parts, level, span }
    }

    /// Visits every expression.
    pub fn for_each_expression(&mut self, mut visit: impl FnMut(&mut Expr)) {
        visit(&mut self.condition);
        for part in &mut self.parts {
            if let Part::Number(value) | Part::Boolean(value) = part {
                visit(value);
            }
        }
    }

    /// The numbers in its text.
    pub fn values(&self) -> Vec<Expr> {
        let value = |part: &Part| match part {
            Part::Number(value) | Part::Boolean(value) => Some(*value),
            Part::Text(_) => None,
        };
        self.parts.iter().filter_map(value).collect()
    }
}
