//! What happens at events (MLS §8.3.5, §8.5). Data only.

use super::equation::{Assertion, Equation};
use crate::source::Span;
use crate::symbolic::{Expr, VarId};
use std::sync::Arc;

/// The part of a system that acts at events alone.
#[derive(Debug, Clone, Default)]
pub struct Events {
    /// `v = …` for every variable of kind [`Kind::Discrete`](super::Kind::Discrete): the left side
    /// is the variable.
    pub equations: Vec<Equation>,
    /// `floor` of what varies continuously.
    pub roundings: Vec<Rounding>,
    /// `sample(start, interval)`.
    pub samples: Vec<Sample>,
    /// `delay(argument, time)`.
    pub delays: Vec<Delay>,
    /// `reinit(x, value)` in when-clauses.
    pub reinits: Vec<Reinit>,
    /// Assertions in when-clauses.
    pub assertions: Vec<Assertion>,
    /// `terminate(message)` in when-clauses.
    pub terminations: Vec<Termination>,
    /// The variable that is 1 during initialization, if `initial()` is used.
    pub initial: Option<VarId>,
    /// The variable that is 1 at the end, if `terminal()` is used.
    pub terminal: Option<VarId>,
}

/// `variable = floor(argument)`, which jumps at events only (MLS §3.7.2).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Rounding {
    /// The variable that holds the value.
    pub variable: VarId,
    /// What is rounded down.
    pub argument: Expr,
    /// Where it is written.
    pub span: Span,
}

/// `sample(start, interval)`: a variable that is 1 at the times start + i·interval, i = 0, 1, …
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sample {
    /// The variable.
    pub variable: VarId,
    /// First time, made of parameters.
    pub start: Expr,
    /// Whether that counts from the start of the simulation, as the ticks of clocks do.
    pub since_start: bool,
    /// Distance of the times, made of parameters.
    pub interval: Expr,
    /// Where it is written.
    pub span: Span,
}

/// `variable = delay(argument, time)` (MLS §3.7.4.1).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Delay {
    /// The variable that holds the value.
    pub variable: VarId,
    /// What is delayed.
    pub argument: Expr,
    /// By how much, made of parameters, seconds.
    pub time: Expr,
    /// Where it is written.
    pub span: Span,
}

/// `reinit(state, value)`, carried out when the condition holds.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Reinit {
    /// The state as written.
    pub state: VarId,
    /// When.
    pub condition: Expr,
    /// Its new value.
    pub value: Expr,
    /// Where it is written.
    pub span: Span,
}

/// `terminate(message)`, carried out when the condition holds.
#[derive(Debug, Clone, PartialEq)]
pub struct Termination {
    /// When.
    pub condition: Expr,
    /// The text for people.
    pub message: Arc<str>,
    /// Where it is written.
    pub span: Span,
}

impl Events {
    /// Visits every expression.
    pub fn for_each_expression(&mut self, mut visit: impl FnMut(&mut Expr)) {
        for equation in &mut self.equations {
            visit(&mut equation.left);
            visit(&mut equation.right);
        }
        self.roundings.iter_mut().for_each(|r| visit(&mut r.argument));
        self.delays.iter_mut().for_each(|d| visit(&mut d.argument));
        for reinit in &mut self.reinits {
            visit(&mut reinit.condition);
            visit(&mut reinit.value);
        }
        self.assertions.iter_mut().for_each(|a| a.for_each_expression(&mut visit));
        self.terminations.iter_mut().for_each(|t| visit(&mut t.condition));
    }
}
