//! Statements (MLS §11.2), executed with values.

use super::Evaluator;
use super::endless_loop::endless;
use super::errors::{MISPLACED, MODEL_ONLY, WRONG_OUTPUTS};
use super::function::Target;
use super::iteration::Body;
use crate::diag::{Diagnostic, Fault};
use crate::execute::{
    Branches, Decision, Domain, Done, Executed, Flow, Iteration, Targets, if_statement,
};
use crate::fault;
use crate::source::Span;
use crate::syntax::ast::{
    ComponentReference, Expression, ExpressionKind, ForIndex, Statement, simple_statements, targets,
};
use crate::value::Value;
use std::convert::Infallible;

/// Every condition has a value.
impl Domain for Evaluator<'_> {
    type Condition = Infallible;

    fn assign_value(
        &mut self,
        to: &ComponentReference,
        value: &Expression,
        span: Span,
    ) -> Executed {
        let done = self.value_to_assign(to, value);
        let done = done.and_then(|new| self.assign(to, new, span));
        done.inspect_err(|_| self.lose([to]))
    }

    /// `(a, , b) := f(x)` (MLS §11.2.1.1)
    fn assign_outputs(&mut self, targets: &Targets, call: &Expression) -> Executed {
        let done = self.assign_each(targets, call);
        done.inspect_err(|_| self.lose(targets.iter().flatten()))
    }

    fn call_statement(&mut self, call: &Expression) -> Executed {
        self.host.check_interrupted(call.span)?;
        self.outputs(call).map(|_| ())
    }

    fn decide(&mut self, condition: &Expression) -> Result<Decision<Infallible>, Diagnostic> {
        self.condition(condition).map(Decision::Known)
    }

    fn either(
        &mut self,
        condition: Infallible,
        _: impl FnOnce(&mut Self) -> Done<Self>,
        _: impl FnOnce(&mut Self) -> Done<Self>,
    ) -> Done<Self> {
        match condition {}
    }

    fn for_loop(&mut self, index: &ForIndex, body: Iteration<'_>) -> Done<Self> {
        let range = self.iterated(index, Body::Statements(body.statements))?;
        let watched = self.is_outermost_of_script();
        let depth = self.scope.iterators.len();
        self.scope.loops += 1;
        let mut iterations = 0..range.count();
        let result = body.repeat(self, |evaluator| {
            let Some(iteration) = iterations.next() else { return Ok(false) };
            evaluator.host.check_interrupted(index.name.span)?;
            if watched && let Some(script) = evaluator.host.script() {
                script.loop_iteration(iteration, Some(range.count()));
            }
            evaluator.scope.iterators.truncate(depth);
            evaluator.scope.iterators.push((index.name.node, range.get(iteration)));
            Ok(true)
        });
        self.scope.iterators.truncate(depth);
        self.scope.loops -= 1;
        result
    }

    fn while_loop(&mut self, condition: &Expression, body: Iteration<'_>) -> Done<Self> {
        let watched = self.is_outermost_of_script();
        self.scope.loops += 1;
        let mut iteration = 0;
        let result = body.repeat(self, |evaluator| {
            if !evaluator.condition(condition)? {
                return Ok(false);
            }
            evaluator.host.check_interrupted(condition.span)?;
            if watched && iteration == 0 {
                let simple = simple_statements(body.statements);
                let warning = endless(condition, &simple, &targets(body.statements));
                warning.into_iter().for_each(|warning| evaluator.host.warn(warning));
            }
            if watched && let Some(script) = evaluator.host.script() {
                script.loop_iteration(iteration, None);
            }
            iteration += 1;
            Ok(true)
        });
        self.scope.loops -= 1;
        result
    }

    /// Every statement of a script is an event.
    fn when_statement(&mut self, branches: &Branches, span: Span) -> Done<Self> {
        match self.scope.is_script() {
            true => if_statement(self, branches, &[]),
            false => {
                let message = "`when` is allowed only in models and scripts";
                Err(Fault::new(MODEL_ONLY, message).at(span))
            }
        }
    }

    fn leave_loop(&mut self, span: Span) -> Done<Self> {
        match self.scope.loops {
            0 => Err(Fault::new(MISPLACED, "`break` outside a loop").at(span)),
            _ => Ok(Flow::Break),
        }
    }

    /// Statements of a script are not reached because of an error: what they would have assigned has no
    /// value, and the host learns which of its commands are not called.
    fn leave_out(&mut self, statements: &[Statement], error: &Diagnostic) {
        self.lose(targets(statements));
        if !self.loses_failed() {
            return;
        }
        // As a statement, or as the value that it assigns.
        for call in simple_statements(statements).into_iter().filter_map(Statement::value) {
            let ExpressionKind::Call { function, arguments } = &call.kind else { continue };
            let name = function.parts.last().map(|part| part.name);
            let mut is_looked_at =
                |name| self.host.script().is_some_and(|script| script.is_looked_at(name));
            if name.is_some_and(&mut is_looked_at)
                && let Ok(Target::Builtin(header)) = self.target(function)
            {
                self.refuse(&header, arguments, error);
            }
        }
    }
}

impl Evaluator<'_> {
    fn value_to_assign(
        &mut self,
        target: &ComponentReference,
        value: &Expression,
    ) -> Result<Value, Diagnostic> {
        self.host.begin_use(value);
        let new = match self.scalar(value) {
            Some(scalar) => scalar.into(),
            None => self.expression(value)?,
        };
        self.keep_status(target, &new);
        Ok(new)
    }

    /// What statements of a script that failed or were not reached would have assigned: these variables
    /// have no value, whatever they had before.
    fn lose<'t>(&mut self, targets: impl IntoIterator<Item = &'t ComponentReference>) {
        if !self.loses_failed() {
            return;
        }
        for target in targets {
            if self.scope.contains(target.parts[0].name) {
                self.scope.forget(target.parts[0].name);
            } else if let Some(script) = self.host.script() {
                script.lose(target);
            }
        }
    }

    fn loses_failed(&mut self) -> bool {
        self.scope.is_script() && self.host.script().is_some_and(|script| script.loses_failed())
    }

    fn assign_each(&mut self, targets: &Targets, call: &Expression) -> Executed {
        if !matches!(call.kind, ExpressionKind::Call { .. }) {
            let message = "only the outputs of a function call can be assigned to a list";
            return Err(Fault::new(WRONG_OUTPUTS, message).at(call.span));
        }
        self.host.begin_use(call);
        let outputs = self.outputs(call)?;
        if outputs.len() < targets.len() {
            let fault = fault!(
                WRONG_OUTPUTS,
                "the call requests {} results, but the function has {}",
                targets.len(),
                count(outputs.len())
            );
            return Err(fault.at(call.span));
        }
        for (target, value) in targets.iter().zip(outputs) {
            if let Some(target) = target {
                self.keep_status(target, &value);
                self.assign(target, value, target.span)?;
            }
        }
        Ok(())
    }

    /// This value is assigned, which may say whether a command succeeded.
    fn keep_status(&mut self, target: &ComponentReference, value: &Value) {
        if let Some(script) = self.host.script() {
            script.keep_status(target, value);
        }
    }

    fn is_outermost_of_script(&self) -> bool {
        self.scope.is_script() && self.scope.loops == 0
    }
}

fn count(outputs: usize) -> String {
    match outputs {
        0 => "no output".into(),
        1 => "one output".into(),
        n => format!("{n} outputs"),
    }
}
