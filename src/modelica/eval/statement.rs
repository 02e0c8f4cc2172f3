//! Statements (MLS §11.2).

use super::deduction::Body;
use super::errors::{MISPLACED, MODEL_ONLY, WRONG_OUTPUTS};
use super::function::Target;
use super::{Evaluator, Flow};
use crate::diag::{Diagnostic, Fault};
use crate::fault;
use crate::source::Span;
use crate::syntax::ast::{
    ComponentReference, Expression, ExpressionKind, ForIndex, Statement, StatementKind,
};
use crate::value::Value;

impl Evaluator<'_> {
    /// Executes statements in order, until one leads elsewhere.
    pub(super) fn statements(&mut self, statements: &[Statement]) -> Result<Flow, Diagnostic> {
        for (at, statement) in statements.iter().enumerate() {
            let done = self.statement(statement);
            let flow = done.inspect_err(|error| self.leave_out(&statements[at + 1..], error))?;
            if flow != Flow::Next {
                return Ok(flow);
            }
        }
        Ok(Flow::Next)
    }

    fn statement(&mut self, statement: &Statement) -> Result<Flow, Diagnostic> {
        match &statement.kind {
            StatementKind::Assign { target, value } => {
                let done = self.assign_value(target, value, statement.span);
                done.inspect_err(|_| self.lose(std::slice::from_ref(statement)))?;
            }
            StatementKind::MultiAssign { targets, value } => {
                let done = self.assign_outputs(targets, value);
                done.inspect_err(|_| self.lose(std::slice::from_ref(statement)))?;
            }
            StatementKind::Call(call) => {
                self.check_interrupted(statement.span)?;
                self.outputs(call)?;
            }
            StatementKind::If { branches, otherwise } => {
                return self.if_statement(branches, otherwise);
            }
            StatementKind::For { indices, body } => {
                let done = self.for_statement(indices, body);
                return done.inspect_err(|error| self.leave_out(body, error));
            }
            StatementKind::While { condition, body } => {
                let done = self.while_statement(condition, body);
                return done.inspect_err(|error| self.leave_out(body, error));
            }
            // Every statement of a script is an event.
            StatementKind::When { branches } if self.scope.is_script() => {
                return self.if_statement(branches, &[]);
            }
            StatementKind::When { .. } => {
                let message = "`when` is allowed only in models and scripts";
                return Err(Fault::new(MODEL_ONLY, message).at(statement.span));
            }
            StatementKind::Break if self.scope.loops == 0 => {
                return Err(Fault::new(MISPLACED, "`break` outside a loop").at(statement.span));
            }
            StatementKind::Break => return Ok(Flow::Break),
            StatementKind::Return => return Ok(Flow::Return),
        }
        Ok(Flow::Next)
    }

    fn assign_value(
        &mut self,
        target: &ComponentReference,
        value: &Expression,
        span: Span,
    ) -> Result<(), Diagnostic> {
        self.begin_use(value);
        let new = match self.scalar(value) {
            Some(scalar) => scalar.into(),
            None => self.expression(value)?,
        };
        self.keep_status(target, &new);
        self.assign(target, new, span)
    }

    /// Statements of a script are not reached because of an error: what they would have assigned has no
    /// value, and the host learns which of its commands are not called.
    pub(super) fn leave_out(&mut self, statements: &[Statement], error: &Diagnostic) {
        self.lose(statements);
        if !self.scope.is_script() || !self.host.loses_failed() {
            return;
        }
        for call in calls(statements) {
            let ExpressionKind::Call { function, arguments } = &call.kind else { continue };
            let name = function.parts.last().map(|part| part.name);
            if name.is_some_and(|name| self.host.is_looked_at(name))
                && let Ok(Target::Builtin(header)) = self.target(function)
            {
                self.refuse(&header, arguments, error);
            }
        }
    }

    /// What statements of a script that failed or were not reached would have assigned: these variables
    /// have no value, whatever they had before.
    fn lose(&mut self, statements: &[Statement]) {
        if !self.scope.is_script() || !self.host.loses_failed() {
            return;
        }
        for target in targets(statements) {
            match self.scope.contains(target.parts[0].name) {
                true => self.scope.forget(target.parts[0].name),
                false => self.host.lose(target),
            }
        }
    }

    /// `(a, , b) := f(x)` (MLS §11.2.1.1)
    fn assign_outputs(
        &mut self,
        targets: &[Option<ComponentReference>],
        call: &Expression,
    ) -> Result<(), Diagnostic> {
        if !matches!(call.kind, ExpressionKind::Call { .. }) {
            let message = "only the outputs of a function call can be assigned to a list";
            return Err(Fault::new(WRONG_OUTPUTS, message).at(call.span));
        }
        self.begin_use(call);
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

    /// This value is going to be assigned or tested.
    pub(super) fn begin_use(&mut self, value: &Expression) {
        self.host.begin_use(value);
    }

    /// This value is assigned, which may say whether a command succeeded.
    fn keep_status(&mut self, target: &ComponentReference, value: &Value) {
        self.host.keep_status(target, value);
    }

    fn if_statement(
        &mut self,
        branches: &[(Expression, Vec<Statement>)],
        otherwise: &[Statement],
    ) -> Result<Flow, Diagnostic> {
        for (at, (condition, statements)) in branches.iter().enumerate() {
            let holds = self.condition(condition).inspect_err(|error| {
                let bodies = branches[at..].iter().map(|(_, statements)| statements);
                bodies.for_each(|statements| self.leave_out(statements, error));
                self.leave_out(otherwise, error);
            })?;
            if holds {
                return self.statements(statements);
            }
        }
        self.statements(otherwise)
    }

    fn for_statement(
        &mut self,
        indices: &[ForIndex],
        body: &[Statement],
    ) -> Result<Flow, Diagnostic> {
        let Some((index, inner)) = indices.split_first() else { return self.statements(body) };
        let range = self.iterated(index, Body::Statements(body))?;
        let watched = self.is_outermost_of_script();
        let depth = self.scope.iterators.len();
        self.scope.loops += 1;
        let result =
            self.iterations(range.count(), watched, index.name.span, |evaluator, iteration| {
                evaluator.scope.iterators.truncate(depth);
                evaluator.scope.iterators.push((index.name.node, range.get(iteration)));
                match inner {
                    [] => evaluator.statements(body),
                    inner => evaluator.for_statement(inner, body),
                }
            });
        self.scope.iterators.truncate(depth);
        self.scope.loops -= 1;
        result
    }

    fn iterations(
        &mut self,
        count: usize,
        watched: bool,
        span: Span,
        mut body: impl FnMut(&mut Self, usize) -> Result<Flow, Diagnostic>,
    ) -> Result<Flow, Diagnostic> {
        for iteration in 0..count {
            self.check_interrupted(span)?;
            if watched {
                self.host.loop_iteration(iteration, Some(count));
            }
            match body(self, iteration)? {
                Flow::Next => {}
                Flow::Break => return Ok(Flow::Next),
                Flow::Return => return Ok(Flow::Return),
            }
        }
        Ok(Flow::Next)
    }

    fn while_statement(
        &mut self,
        condition: &Expression,
        body: &[Statement],
    ) -> Result<Flow, Diagnostic> {
        let watched = self.is_outermost_of_script();
        self.scope.loops += 1;
        let result = self.while_iterations(condition, body, watched);
        self.scope.loops -= 1;
        result
    }

    fn while_iterations(
        &mut self,
        condition: &Expression,
        body: &[Statement],
        watched: bool,
    ) -> Result<Flow, Diagnostic> {
        let mut iteration = 0;
        while self.condition(condition)? {
            self.check_interrupted(condition.span)?;
            if watched {
                self.host.loop_iteration(iteration, None);
            }
            iteration += 1;
            match self.statements(body)? {
                Flow::Next => {}
                Flow::Break => return Ok(Flow::Next),
                Flow::Return => return Ok(Flow::Return),
            }
        }
        Ok(Flow::Next)
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

/// What statements assign to, in loops and branches too.
pub fn targets(statements: &[Statement]) -> Vec<&ComponentReference> {
    let mut all = Vec::new();
    for statement in simple_statements(statements) {
        match &statement.kind {
            StatementKind::Assign { target, .. } => all.push(target),
            StatementKind::MultiAssign { targets, .. } => all.extend(targets.iter().flatten()),
            _ => {}
        }
    }
    all
}

/// What statements call, as a statement or as the value that they assign.
fn calls(statements: &[Statement]) -> Vec<&Expression> {
    let mut all = Vec::new();
    for statement in simple_statements(statements) {
        match &statement.kind {
            StatementKind::Assign { value, .. } | StatementKind::MultiAssign { value, .. } => {
                all.push(value);
            }
            StatementKind::Call(call) => all.push(call),
            _ => {}
        }
    }
    all
}

/// The statements that are not loops or branches, in these too.
fn simple_statements(statements: &[Statement]) -> Vec<&Statement> {
    let mut all = Vec::new();
    for statement in statements {
        match &statement.kind {
            StatementKind::If { branches, otherwise } => {
                let bodies = branches.iter().map(|(_, body)| body).chain([otherwise]);
                all.extend(bodies.flat_map(|body| simple_statements(body)));
            }
            StatementKind::When { branches } => {
                all.extend(branches.iter().flat_map(|(_, body)| simple_statements(body)));
            }
            StatementKind::For { body, .. } | StatementKind::While { body, .. } => {
                all.extend(simple_statements(body));
            }
            _ => all.push(statement),
        }
    }
    all
}
