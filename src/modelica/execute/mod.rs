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
pub enum Decision<C> {
    /// Its value.
    Known(bool),
    /// It is decided later.
    Open(C),
}

/// The branches of `if` or `when`: conditions with statements.
pub type Branches = [(Expression, Vec<Statement>)];

/// How a statement ended, or why it cannot be executed.
pub type Done<D> = Result<Flow<<D as Domain>::Condition>, Diagnostic>;

/// What statements are made into.
pub trait Domain: Sized {
    /// A condition that is not known during the walk.
    type Condition: Copy;

    /// Executes one statement, with what the domain does before and after each: [`execute`].
    fn statement(&mut self, statement: &Statement) -> Done<Self> {
        execute(self, statement)
    }
    /// `target := value`
    fn assign_value(
        &mut self,
        target: &ComponentReference,
        value: &Expression,
        span: Span,
    ) -> Result<(), Diagnostic>;
    /// `(a, , b) := f(x)`
    fn assign_outputs(
        &mut self,
        targets: &[Option<ComponentReference>],
        call: &Expression,
        span: Span,
    ) -> Result<(), Diagnostic>;
    /// A call as a statement.
    fn call_statement(&mut self, call: &Expression, span: Span) -> Result<(), Diagnostic>;
    /// The condition of a branch.
    fn decide(&mut self, condition: &Expression) -> Result<Decision<Self::Condition>, Diagnostic>;
    /// The first where a condition holds, else the second.
    fn either(
        &mut self,
        condition: Self::Condition,
        first: impl FnOnce(&mut Self) -> Done<Self>,
        second: impl FnOnce(&mut Self) -> Done<Self>,
    ) -> Done<Self>;
    /// `for index loop statements`, of which `body` executes one iteration.
    fn for_loop(
        &mut self,
        index: &ForIndex,
        statements: &[Statement],
        body: impl FnMut(&mut Self) -> Done<Self>,
    ) -> Done<Self>;
    /// `while condition loop`, of which `body` executes one iteration.
    fn while_loop(
        &mut self,
        condition: &Expression,
        span: Span,
        body: impl FnMut(&mut Self) -> Done<Self>,
    ) -> Done<Self>;
    /// `when`
    fn when_statement(&mut self, branches: &Branches, span: Span) -> Done<Self>;
    /// `break`
    fn leave_loop(&mut self, span: Span) -> Done<Self> {
        let _ = span;
        Ok(Flow::Break)
    }
    /// `return`
    fn leave_function(&mut self, span: Span) -> Done<Self> {
        let _ = span;
        Ok(Flow::Return)
    }
    /// Statements are not executed because of an error.
    fn leave_out(&mut self, statements: &[Statement], error: &Diagnostic) {
        let _ = (statements, error);
    }
}

/// Executes statements in order, until one leads elsewhere.
pub fn statements<D: Domain>(domain: &mut D, list: &[Statement]) -> Done<D> {
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
pub fn execute<D: Domain>(domain: &mut D, statement: &Statement) -> Done<D> {
    match &statement.kind {
        StatementKind::Assign { target, value } => {
            domain.assign_value(target, value, statement.span)?;
        }
        StatementKind::MultiAssign { targets, value } => {
            domain.assign_outputs(targets, value, statement.span)?;
        }
        StatementKind::Call(call) => domain.call_statement(call, statement.span)?,
        StatementKind::If { branches, otherwise } => {
            return if_statement(domain, branches, otherwise);
        }
        StatementKind::For { indices, body } => {
            let done = for_statement(domain, indices, body);
            return done.inspect_err(|error| domain.leave_out(body, error));
        }
        StatementKind::While { condition, body } => {
            let done =
                domain.while_loop(condition, statement.span, |domain| statements(domain, body));
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
pub fn if_statement<D: Domain>(
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

fn for_statement<D: Domain>(domain: &mut D, indices: &[ForIndex], body: &[Statement]) -> Done<D> {
    match indices.split_first() {
        None => statements(domain, body),
        Some((index, inner)) => {
            domain.for_loop(index, body, |domain| for_statement(domain, inner, body))
        }
    }
}

/// Executes iterations in order, until there are no more or one leaves the loop. `next` gives what
/// an iteration begins with.
pub fn iterate<D: Domain, I>(
    domain: &mut D,
    mut next: impl FnMut(&mut D) -> Result<Option<I>, Diagnostic>,
    mut body: impl FnMut(&mut D, I) -> Done<D>,
) -> Done<D> {
    let mut flow = Flow::Next;
    while let Some(iteration) = next(domain)? {
        flow = go_on(domain, flow, |domain| body(domain, iteration))?;
        match flow {
            Flow::Next | Flow::BreakIf(_) => {}
            Flow::Break => break,
            Flow::Return => return Ok(Flow::Return),
        }
    }
    Ok(Flow::Next)
}
