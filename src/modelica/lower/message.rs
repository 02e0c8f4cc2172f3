//! Messages: of assertions, and of functions that print (MLS §8.3.7, §12.9).

use super::builder::Builder;
use super::equation::{Assertion, Level};
use super::errors::NOT_SUPPORTED;
use super::events::Termination;
use super::expressions::{FunctionCalls, Lowered, Lowering, StringPart};
use super::expressions::{message_parts, message_text, nth};
use super::function::{confirms, fails, prints};
use super::loops::LoopVariable;
use super::shape::UNKNOWN_TEXT;
use crate::diag::Diagnostic;
use crate::eval::Function;
use crate::fault;
use crate::source::Span;
use crate::symbolic::{Expr, Node, RelationOperator};
use crate::syntax::ast::{
    Arguments, Comment, Expression, ExpressionKind, Statement, StatementKind,
};
use std::sync::Arc;

/// What is printed ends its line once, whether or not the text does.
fn end_line(parts: &mut [StringPart<Expr>]) {
    if let Some(StringPart::Text(last)) = parts.last_mut() {
        *last = last.trim_end_matches('\n').into();
    }
}

impl Builder<'_> {
    /// A call of a function that prints to the screen, or ends the simulation with a message, and which of
    /// both; `None` for other calls.
    pub(super) fn printing(
        &mut self,
        call: &Expression,
        loops: &[LoopVariable<Expr>],
    ) -> Result<Option<Level>, Diagnostic> {
        let ExpressionKind::Call { function, arguments } = &call.kind else { return Ok(None) };
        let Some(user) = FunctionCalls::function(self, &function.name()) else { return Ok(None) };
        let level = match (prints(&user), fails(&user)) {
            (true, _) => Level::Message,
            (_, true) => Level::Error,
            _ => return Ok(None),
        };
        let mut lowering = Lowering::new(self);
        lowering.loops = loops.to_vec();
        lowering.live = true;
        if let Some(file) = nth(arguments, 1, "fileName")
            && !message_text(&mut lowering, Some(file)).is_empty()
        {
            return Ok(None);
        }
        let mut parts = message_parts(&mut lowering, nth(arguments, 0, "string"));
        end_line(&mut parts);
        let condition = self.dae.pool.constant(0.0);
        self.dae.assertions.push(Assertion::new(condition, parts, level, call.span));
        Ok(Some(level))
    }

    /// The parts of a message; what it reads need not hold where its condition does.
    pub(super) fn parts_of_message(
        &mut self,
        message: Option<&Expression>,
        loops: &[LoopVariable<Expr>],
    ) -> Vec<StringPart<Expr>> {
        self.without_assertions(|own| {
            let mut lowering = Lowering::new(own);
            lowering.loops = loops.to_vec();
            lowering.live = true;
            message_parts(&mut lowering, message)
        })
    }

    /// `terminate(message)` where a guard holds: the simulation ends, and says why.
    pub(super) fn terminate(
        &mut self,
        arguments: &Arguments,
        guard: Expr,
        span: Span,
        loops: &[LoopVariable<Expr>],
    ) {
        let mut parts = vec![StringPart::Text("the model ends the simulation: ".into())];
        parts.extend(self.parts_of_message(nth(arguments, 0, "message"), loops));
        let condition = self.dae.pool.not(guard);
        let message = Assertion::new(condition, parts, Level::Message, span);
        self.dae.events.assertions.push(message);
        self.dae.events.terminations.push(Termination { condition: guard, span });
    }

    /// Says when a function prints that is called as an equation (not allowed by MLS §12.3, but the
    /// standard library does it).
    pub(super) fn warn_of_telling(&mut self, name: &str, span: Span) {
        let warning = fault!(NOT_SUPPORTED, "`{name}` is called outside of when-clauses: it prints \
            once at the start, or whenever its branch of an if-equation begins to be taken";
            help: "call it in a when-clause, such as `when initial()`");
        self.dae.warnings.push(warning.at(span).warning());
    }

    /// The value of a call that writes and confirms it, assigned where statements are executed;
    /// `None` for other expressions.
    pub(super) fn confirmed(
        &mut self,
        value: &Expression,
        loops: &[LoopVariable<Expr>],
    ) -> Result<Option<Expr>, Diagnostic> {
        let ExpressionKind::Call { function, arguments } = &value.kind else { return Ok(None) };
        let Some(user) = FunctionCalls::function(self, &function.name()) else { return Ok(None) };
        if !confirms(&user) {
            return Ok(None);
        }
        self.effect(&user, arguments, value.span, loops)?;
        Ok(Some(self.dae.pool.constant(1.0)))
    }

    /// The call of a function without use of its value: what it asserts must hold, and where it
    /// `acts`, in when-clauses and initial sections, what it writes is written.
    pub(super) fn call_statement(
        &mut self,
        call: &Expression,
        loops: &[LoopVariable<Expr>],
        acts: bool,
    ) -> Result<(), Diagnostic> {
        let ExpressionKind::Call { function, arguments } = &call.kind else {
            return Err(fault!(NOT_SUPPORTED, "this is not a call").at(call.span));
        };
        if acts && self.printing(call, loops)?.is_some() {
            return Ok(());
        }
        let name = function.name();
        let Some(user) = FunctionCalls::function(self, &name) else {
            return Err(fault!(NOT_SUPPORTED, "`{name}(…)` as a statement here").at(call.span));
        };
        if acts && prints(&user) && self.has_numbers(nth(arguments, 0, "string"), loops) {
            return self.writing(call, loops);
        }
        if acts {
            return self.effect(&user, arguments, call.span, loops);
        }
        if user.impure {
            return Err(fault!(NOT_SUPPORTED, "the impure function `{name}` is called outside of \
                when-clauses and initial sections";
                help: "call it in a when-clause, such as `when initial()`")
            .at(call.span));
        }
        let mut lowering = Lowering::new(self);
        lowering.loops = loops.to_vec();
        let outputs = lowering.user_call(&user, arguments, call.span)?;
        self.unused(&outputs, call.span);
        Ok(())
    }

    /// Unused outputs: their calls are made for what they assert.
    pub(super) fn unused(&mut self, outputs: &[Lowered<Expr>], span: Span) {
        let mut scalars = Vec::new();
        outputs.iter().for_each(|output| output.append_scalars(&mut scalars));
        let pool = &self.dae.pool;
        let is_call = |e: &Expr| matches!(pool.node(*e), Node::Call { .. });
        if let Some(call) = scalars.into_iter().find(is_call) {
            self.assert_call(call, span);
        }
    }

    /// The call of a function that has no other value.
    pub(super) fn assert_call(&mut self, call: Expr, span: Span) {
        let holds = self.dae.pool.relation(RelationOperator::Equal, call, call);
        self.dae.assertions.push(Assertion::new(holds, Vec::new(), Level::Error, span));
    }

    /// The call of a function at an instant: what it writes is written whenever the statement is
    /// executed.
    fn effect(
        &mut self,
        user: &Arc<Function>,
        arguments: &Arguments,
        span: Span,
        loops: &[LoopVariable<Expr>],
    ) -> Result<(), Diagnostic> {
        self.calls.written.clear();
        self.calls.functions.may_write = true;
        let mut lowering = Lowering::new(self);
        lowering.loops = loops.to_vec();
        lowering.live = true;
        let called = lowering.user_call(user, arguments, span);
        self.calls.functions.may_write = false;
        let outputs = called?;
        if !user.impure && self.calls.written.is_empty() {
            self.unused(&outputs, span);
        }
        self.carry_out(span);
        Ok(())
    }

    /// Whether numbers of the simulation are in a text.
    fn has_numbers(&mut self, text: Option<&Expression>, loops: &[LoopVariable<Expr>]) -> bool {
        let mut lowering = Lowering::new(self);
        lowering.loops = loops.to_vec();
        lowering.live = true;
        message_text(&mut lowering, text).contains(UNKNOWN_TEXT)
    }

    /// A call that writes a string with numbers of the simulation to a file: it is a function of
    /// what it reads, which composes the string when it is executed.
    fn writing(
        &mut self,
        call: &Expression,
        loops: &[LoopVariable<Expr>],
    ) -> Result<(), Diagnostic> {
        let kind = StatementKind::Call(call.clone());
        let statement = Statement { kind, comment: Comment::default(), span: call.span };
        self.calls.written.clear();
        self.calls.functions.may_write = true;
        let called = self.call_of_statement(&statement, &loops.to_vec());
        self.calls.functions.may_write = false;
        called?;
        self.carry_out(call.span);
        Ok(())
    }

    /// A call that writes is executed at the place of its statement.
    fn carry_out(&mut self, span: Span) {
        let parts: Vec<_> = self.calls.written.drain(..).map(StringPart::Numbered).collect();
        if !parts.is_empty() {
            let condition = self.dae.pool.constant(0.0);
            self.dae.assertions.push(Assertion::new(condition, parts, Level::Effect, span));
        }
    }
}

impl Assertion {
    /// An assertion of this text.
    pub fn new(
        condition: Expr,
        parts: Vec<StringPart<Expr>>,
        level: Level,
        span: Span,
    ) -> Assertion {
        let known = |part: &StringPart<Expr>| match part {
            StringPart::Text(text) => text.to_string(),
            _ => UNKNOWN_TEXT.to_owned(),
        };
        let message = parts.iter().map(known).collect::<String>().into();
        Assertion { condition, message, parts, level, span }
    }

    /// Visits every expression.
    pub(crate) fn for_each_expression(&mut self, mut visit: impl FnMut(&mut Expr)) {
        visit(&mut self.condition);
        self.parts.iter_mut().flat_map(StringPart::scalars_mut).for_each(visit);
    }

    /// The values in its text.
    pub fn values(&self) -> Vec<Expr> {
        self.parts.iter().flat_map(StringPart::scalars).copied().collect()
    }
}
