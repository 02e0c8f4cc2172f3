//! Clocks and clocked equations (MLS chapter 16): they become equations at events.
//!
//! While expressions are lowered, every clocked operator leaves a variable for its value and an
//! [`Occurrence`] (`operators`, `when`). When all equations are there, they are partitioned by
//! clocks (`partitions`, MLS §16.7), the intervals of all partitions are inferred from those that
//! are given (`intervals`, MLS §16.7.5), continuous equations in clocked partitions are discretized
//! by their solver method (`solver_methods`, MLS §16.8), and every clocked variable gets the equation
//! `v = if tick then … else pre(v)` (`assignments`), where `tick` is a Boolean that is true in one
//! round of the event iteration (`ticks`):
//!
//! ```text
//! previous(u), sample(u)                    pre(u): the value before the event
//! hold, subSample, superSample, shiftSample,
//! backSample, noClock                       the variable, which keeps its value between ticks
//! ```

mod assignments;
mod clocked_equation;
mod conversion;
mod intervals;
mod machine_equations;
mod operators;
mod partitioning;
mod partitions;
mod recognition;
mod solver_methods;
mod state_machines;
mod state_operators;
mod state_outputs;
mod ticks;
mod when;

use super::equation::{Assertion, Equation};
use crate::source::Span;
use crate::symbolic::{Expr, VarId};
use conversion::Conversion;
use state_machines::StateMachines;
use std::sync::Arc;

pub(super) use recognition::is_clock;

/// What was found while expressions were lowered.
#[derive(Debug, Default)]
pub(super) struct Clocks {
    occurrences: Vec<Occurrence>,
    /// Equations of variables made for arguments: they are in no when-clause and no branch.
    equations: Vec<Equation>,
    /// Equations in clocked when-clauses, with their clocks.
    on_clock: Vec<(VarId, Equation)>,
    /// Assertions and calls in clocked when-clauses, with their clocks.
    asserted: Vec<(VarId, Assertion)>,
    machines: StateMachines,
}

impl Clocks {
    /// Whether nothing is clocked.
    fn is_empty(&self) -> bool {
        self.occurrences.is_empty() && self.on_clock.is_empty() && self.machines.states.is_empty()
    }
}

/// A clocked operator in an expression.
#[derive(Debug, Clone)]
struct Occurrence {
    /// Stands for its value in the expression.
    variable: VarId,
    operator: Operator,
    span: Span,
}

#[derive(Debug, Clone)]
enum Operator {
    /// `previous(u)`
    Previous(VarId),
    /// `sample(u, clock)`, u being a variable that is not clocked.
    Sample(VarId, Option<VarId>),
    /// `hold(u)`
    Hold(VarId),
    /// What leads from one clock to another, of clocks or of clocked variables.
    Convert(VarId, Conversion),
    /// `interval(u)`, with the scalars of u.
    Interval(Vec<Expr>),
    /// `firstTick(u)`, with the scalars of u.
    FirstTick(Vec<Expr>),
    /// A clock that begins a partition.
    Clock(Base),
}

/// What a clock constructor says (MLS §16.3).
#[derive(Debug, Clone, PartialEq)]
enum Base {
    /// `Clock()`
    Inferred,
    /// `Clock(intervalCounter, resolution)` of numbers.
    Rational(conversion::Rational),
    /// `Clock(intervalCounter, resolution)` of a clocked variable.
    Counted(VarId, i64),
    /// `Clock(interval)` of a parameter expression, seconds.
    Real(Expr),
    /// `Clock(interval)` of a clocked variable, seconds.
    Variable(VarId),
    /// `Clock(condition, startInterval)`: a discrete variable, seconds.
    Event(VarId, Expr),
    /// `Clock(c, solverMethod)`: ticks as c does.
    Solver(Arc<str>),
}
