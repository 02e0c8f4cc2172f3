//! One walk of statements (MLS §11.2), over what a [`Domain`] makes of them: values, expressions, or
//! the code of functions.
//!
//! The walk knows the order: sequences, branches, what `break` and `return` leave. A domain knows
//! what an assignment does, and what becomes of a condition that is not known while it walks:
//! branches of expressions are merged, in code it is a jump; values have none.
//!
//! ```text
//! statement ─walk▶ Domain::assign, call …          if ─▶ Domain::decide ─▶ Known(true): first branch
//!                                                                          Open(c): Domain::either(c)
//! ```

use crate::diag::Diagnostic;
use crate::source::Span;
use crate::syntax::ast::{ComponentReference, Expression, ForIndex, Statement, StatementKind};
use std::convert::Infallible;

/// Where execution continues after a statement; `C` is a condition that is not known yet.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Flow<C = Infallible> {
    /// With the next statement.
    Next,
    /// After the innermost loop (`break`, MLS §11.2.5).
    Break,
    /// At the end of the function (`return`, MLS §11.2.6).
    Return,
    /// After the innermost loop where a condition holds, else with the next statement.
    BreakIf(C),
}

/// What is known of the condition of a branch.
#[derive(Debug, Clone, Copy)]
pub(crate) enum Decision<C> {
    /// Its value.
    Known(bool),
    /// It is decided later.
    Open(C),
}

/// The branches of `if` or `when`: conditions with statements.
pub(crate) type Branches = [(Expression, Vec<Statement>)];

/// The variables that the outputs of a call are assigned to, as far as they are.
pub(crate) type Targets = [Option<ComponentReference>];

/// Why a statement after which the next one follows cannot be executed.
pub(crate) type Executed = Result<(), Diagnostic>;

/// How a statement ended, or why it cannot be executed.
pub(crate) type Done<D> = Result<Flow<<D as Domain>::Condition>, Diagnostic>;

/// What statements are made into.
pub(crate) trait Domain: Sized {
    /// A condition that is not known during the walk.
    type Condition: Copy;

    /// Executes one statement, with what the domain does before and after each: [`execute`].
    fn statement(&mut self, statement: &Statement) -> Done<Self> {
        execute(self, statement)
    }
    /// `to := value`
    fn assign_value(&mut self, to: &ComponentReference, value: &Expression, at: Span) -> Executed;
    /// `(a, , b) := f(x)`
    fn assign_outputs(&mut self, targets: &Targets, call: &Expression) -> Executed;
    /// A call as a statement.
    fn call_statement(&mut self, call: &Expression) -> Executed;
    /// The condition of a branch.
    fn decide(&mut self, condition: &Expression) -> Result<Decision<Self::Condition>, Diagnostic>;
    /// The first where a condition holds, else the second.
    fn either(
        &mut self,
        condition: Self::Condition,
        first: impl FnOnce(&mut Self) -> Done<Self>,
        second: impl FnOnce(&mut Self) -> Done<Self>,
    ) -> Done<Self>;
    /// `for index loop`
    fn for_loop(&mut self, index: &ForIndex, body: Iteration<'_>) -> Done<Self>;
    /// `while condition loop`
    fn while_loop(&mut self, condition: &Expression, body: Iteration<'_>) -> Done<Self>;
    /// `when`
    fn when_statement(&mut self, branches: &Branches, span: Span) -> Done<Self>;
    /// `break`
    fn leave_loop(&mut self, _: Span) -> Done<Self> {
        Ok(Flow::Break)
    }
    /// `return`
    fn leave_function(&mut self, _: Span) -> Done<Self> {
        Ok(Flow::Return)
    }
    /// Statements are not executed because of an error.
    fn leave_out(&mut self, _: &[Statement], _: &Diagnostic) {}
}

/// Executes statements in order, until one leads elsewhere.
pub(crate) fn statements<D: Domain>(domain: &mut D, list: &[Statement]) -> Done<D> {
    let mut flow = Flow::Next;
    for (at, statement) in list.iter().enumerate() {
        let done = go_on(domain, flow, |domain| domain.statement(statement));
        flow = done.inspect_err(|error| domain.leave_out(&list[at + 1..], error))?;
        if matches!(flow, Flow::Break | Flow::Return) {
            break;
        }
    }
    Ok(flow)
}

/// Executes what follows, as far as a loop has not been left.
fn go_on<D: Domain>(
    domain: &mut D,
    flow: Flow<D::Condition>,
    next: impl FnOnce(&mut D) -> Done<D>,
) -> Done<D> {
    match flow {
        Flow::Next => next(domain),
        Flow::BreakIf(left) => domain.either(left, |_| Ok(Flow::Break), next),
        left => Ok(left),
    }
}

/// Executes one statement.
pub(crate) fn execute<D: Domain>(domain: &mut D, statement: &Statement) -> Done<D> {
    match &statement.kind {
        StatementKind::Assign { target, value } => {
            domain.assign_value(target, value, statement.span)?;
        }
        StatementKind::MultiAssign { targets, value } => {
            domain.assign_outputs(targets, value)?;
        }
        StatementKind::Call(call) => domain.call_statement(call)?,
        StatementKind::If { branches, otherwise } => {
            return if_statement(domain, branches, otherwise);
        }
        StatementKind::For { indices, body } => {
            let loops = Iteration { indices, statements: body, span: statement.span };
            let done = loops.execute(domain);
            return done.inspect_err(|error| domain.leave_out(body, error));
        }
        StatementKind::While { condition, body } => {
            let iteration = Iteration { indices: &[], statements: body, span: statement.span };
            let done = domain.while_loop(condition, iteration);
            return done.inspect_err(|error| domain.leave_out(body, error));
        }
        StatementKind::When { branches } => {
            return domain.when_statement(branches, statement.span);
        }
        StatementKind::Break => return domain.leave_loop(statement.span),
        StatementKind::Return => return domain.leave_function(statement.span),
    }
    Ok(Flow::Next)
}

/// Executes the first branch whose condition holds, or the statements otherwise.
pub(crate) fn if_statement<D: Domain>(
    domain: &mut D,
    branches: &Branches,
    otherwise: &[Statement],
) -> Done<D> {
    for (at, (condition, body)) in branches.iter().enumerate() {
        let decision = domain.decide(condition).inspect_err(|error| {
            branches[at..].iter().for_each(|(_, body)| domain.leave_out(body, error));
            domain.leave_out(otherwise, error);
        })?;
        match decision {
            Decision::Known(true) => return statements(domain, body),
            Decision::Known(false) => {}
            Decision::Open(condition) => {
                let rest = &branches[at + 1..];
                return domain.either(
                    condition,
                    |domain| statements(domain, body),
                    |domain| if_statement(domain, rest, otherwise),
                );
            }
        }
    }
    statements(domain, otherwise)
}

/// What a loop repeats: its statements, perhaps in loops over further indices.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Iteration<'s> {
    indices: &'s [ForIndex],
    /// The statements.
    pub statements: &'s [Statement],
    /// The place of the loop.
    pub span: Span,
}

impl Iteration<'_> {
    /// Executes it once.
    pub(crate) fn execute<D: Domain>(self, domain: &mut D) -> Done<D> {
        match self.indices.split_first() {
            None => statements(domain, self.statements),
            Some((index, indices)) => domain.for_loop(index, Iteration { indices, ..self }),
        }
    }

    /// Executes it as often as there is a next one, unless the loop is left.
    pub(crate) fn repeat<D: Domain>(
        self,
        domain: &mut D,
        mut next: impl FnMut(&mut D) -> Result<bool, Diagnostic>,
    ) -> Done<D> {
        let mut flow = Flow::Next;
        while next(domain)? {
            flow = go_on(domain, flow, |domain| self.execute(domain))?;
            match flow {
                Flow::Next | Flow::BreakIf(_) => {}
                Flow::Break => break,
                Flow::Return => return Ok(Flow::Return),
            }
        }
        Ok(Flow::Next)
    }
}
