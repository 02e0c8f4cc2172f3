//! What happens at events (MLS §8.3.5, §8.5). Data only.

use super::equation::{Assertion, Equation};
use crate::source::Span;
use crate::symbolic::{Expr, VarId};
use std::sync::Arc;

/// The part of a system that acts at events alone.
#[derive(Debug, Clone, Default, serde::Serialize, serde::Deserialize)]
pub struct Events {
    /// `v = …` for every variable of kind
    /// [`VariableKind::Discrete`](super::VariableKind::Discrete): the left side
    /// is the variable.
    pub equations: Vec<Equation>,
    /// `floor` of what varies continuously.
    pub(crate) roundings: Vec<Rounding>,
    /// `sample(start, interval)`.
    pub samples: Vec<Sample>,
    /// Recorded inputs.
    pub(crate) recordings: Vec<Recording>,
    /// `delay(argument, time)`.
    pub delays: Vec<Delay>,
    /// `delay` by a time that varies, and `spatialDistribution`.
    pub(crate) transports: Vec<Transport>,
    /// `reinit(x, value)` in when-clauses.
    pub(crate) reinits: Vec<Reinit>,
    /// Assertions in when-clauses.
    pub assertions: Vec<Assertion>,
    /// `terminate(message)` in when-clauses.
    pub(crate) terminations: Vec<Termination>,
    /// The variable that is 1 during initialization, if `initial()` is used.
    pub initial: Option<VarId>,
    /// The variable that is 1 at the end, if `terminal()` is used.
    pub terminal: Option<VarId>,
}

/// `variable = floor(argument)`, which jumps at events only (MLS §3.7.2).
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Rounding {
    /// The variable that holds the value.
    pub variable: VarId,
    /// What is rounded down.
    pub argument: Expr,
    /// Where it is written.
    pub span: Span,
}

/// `sample(start, interval)`: a variable that is 1 at the times start + i·interval, i = 0, 1, …
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Sample {
    /// The variable.
    pub variable: VarId,
    /// First time, made of parameters.
    pub start: Expr,
    /// Whether that counts from the start of the simulation, as the ticks of clocks do.
    pub(crate) since_start: bool,
    /// Distance of the times, made of parameters.
    pub interval: Expr,
    /// Where it is written.
    pub span: Span,
}

/// Recorded inputs with the same knots. Between two knots such an input is
/// `value + rate*(time - since)`.
#[derive(Debug, Clone, PartialEq, serde::Serialize, serde::Deserialize)]
pub(crate) struct Recording {
    /// Times at which an input jumps or bends, seconds, ascending; two at one time are before and
    /// after a jump.
    pub knots: Arc<[f64]>,
    /// The variable that holds the time of the last knot, where an input is linear between knots.
    pub since: Option<VarId>,
    /// The inputs.
    pub tracks: Vec<Track>,
}

/// The samples of one input.
#[derive(Debug, Clone, PartialEq, serde::Serialize, serde::Deserialize)]
pub(crate) struct Track {
    /// The variable that holds the sample of the last knot.
    pub value: VarId,
    /// The variable that holds the rate from there to the next knot; none for an input that is
    /// held.
    pub rate: Option<VarId>,
    /// A sample for each knot.
    pub samples: Arc<[f64]>,
}

/// `variable = delay(argument, time)` (MLS §3.7.4.1).
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize, serde::Deserialize)]
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

/// Values that come out of something later than they go in.
#[derive(Debug, Clone, PartialEq, serde::Serialize, serde::Deserialize)]
pub(crate) enum Transport {
    /// `variable = delay(argument, time, longest)` (MLS §3.7.4.1).
    Delay {
        /// The variable that holds the value.
        variable: VarId,
        /// What is delayed.
        argument: Expr,
        /// By how much, seconds.
        time: Expr,
        /// By how much at most, made of parameters, seconds.
        longest: Expr,
        /// Where it is written.
        span: Span,
    },
    /// `(out0, out1) = spatialDistribution(in0, in1, x, positiveVelocity, initialPoints,
    /// initialValues)` (MLS §3.7.4.2).
    Pipe {
        /// The variables that hold the values at the places 0 and 1.
        outputs: [VarId; 2],
        /// What flows in there.
        inputs: [Expr; 2],
        /// How far the content has moved, in lengths of the pipe.
        position: Expr,
        /// Whether it flows from 0 to 1.
        positive: Expr,
        /// Places of the first content, from 0 to 1, made of parameters.
        points: Vec<Expr>,
        /// The content there, made of parameters.
        values: Vec<Expr>,
        /// Where it is written.
        span: Span,
    },
}

impl Transport {
    /// The variables that hold its values, and what these are at the start.
    pub(crate) fn outputs(&self) -> Vec<(VarId, Expr)> {
        match self {
            Transport::Delay { variable, argument, .. } => vec![(*variable, *argument)],
            Transport::Pipe { outputs, values, .. } => {
                let ends = values.first().into_iter().chain(values.last());
                outputs.iter().copied().zip(ends.copied()).collect()
            }
        }
    }

    /// Where it is written.
    pub(crate) fn span(&self) -> Span {
        match self {
            Transport::Delay { span, .. } | Transport::Pipe { span, .. } => *span,
        }
    }

    fn for_each_expression(&mut self, mut visit: impl FnMut(&mut Expr)) {
        match self {
            Transport::Delay { argument, time, longest, .. } => {
                [argument, time, longest].into_iter().for_each(visit);
            }
            Transport::Pipe { inputs, position, positive, points, values, .. } => {
                inputs.iter_mut().for_each(&mut visit);
                [position, positive].into_iter().for_each(&mut visit);
                points.iter_mut().chain(values).for_each(visit);
            }
        }
    }
}

/// `reinit(state, value)`, executed when the condition becomes true.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize, serde::Deserialize)]
pub(crate) struct Reinit {
    /// The state as written.
    pub state: VarId,
    /// When.
    pub condition: Expr,
    /// Its new value.
    pub value: Expr,
    /// Where it is written.
    pub span: Span,
}

/// `terminate(message)`, executed when the condition becomes true; its message is an assertion's.
#[derive(Debug, Clone, PartialEq, serde::Serialize, serde::Deserialize)]
pub(crate) struct Termination {
    /// When.
    pub condition: Expr,
    /// Where it is written.
    pub span: Span,
}

impl Events {
    /// Visits every expression.
    pub(crate) fn for_each_expression(&mut self, mut visit: impl FnMut(&mut Expr)) {
        for equation in &mut self.equations {
            visit(&mut equation.left);
            visit(&mut equation.right);
        }
        self.roundings.iter_mut().for_each(|r| visit(&mut r.argument));
        self.delays.iter_mut().for_each(|d| visit(&mut d.argument));
        self.transports.iter_mut().for_each(|transport| transport.for_each_expression(&mut visit));
        for reinit in &mut self.reinits {
            visit(&mut reinit.condition);
            visit(&mut reinit.value);
        }
        self.assertions.iter_mut().for_each(|a| a.for_each_expression(&mut visit));
        self.terminations.iter_mut().for_each(|t| visit(&mut t.condition));
    }
}
