//! What happens at events, compiled. Data only.

use super::code::{LogAssertion, Outputs, Step};
use crate::arithmetic::Register;
use crate::symbolic::VarId;

/// The part of a program that acts at events alone.
#[derive(Debug, Clone, Default, serde::Serialize, serde::Deserialize)]
pub(crate) struct Events {
    /// Solves for discrete variables as well; empty if there are none.
    pub(crate) steps: Vec<Step>,
    /// Variables with their previous values.
    pub(crate) previous: Vec<Previous>,
    /// Discrete variables that solving reads before it writes them.
    pub(crate) iterated: Vec<VarId>,
    /// All discrete variables.
    pub(crate) discrete: Vec<VarId>,
    pub(crate) roundings: Vec<CompiledRounding>,
    /// Arguments of the roundings, from the registers of the variables.
    pub(crate) rounded: Vec<Outputs>,
    /// The variables that are 1 when a sample is due.
    pub(crate) samples: Vec<VarId>,
    /// Which of them count from the start of the simulation.
    pub(crate) since_start: Vec<bool>,
    /// Whether variables of the model show samples that are due, not only conditions of
    /// when-clauses.
    pub(crate) shows_samples: bool,
    /// First time and interval of every sample, one after the other.
    pub(crate) clocks: Outputs,
    /// The states that `reinit` sets, and whether with the opposite sign.
    pub(crate) reinitialized: Vec<(VarId, bool)>,
    /// Condition and value of every `reinit`, one after the other.
    pub(crate) reinits: Outputs,
    /// Conditions of the assertions at events.
    pub(crate) assertions: Outputs,
    /// Their numbers among all, and the values in their messages.
    pub(crate) asserted: Vec<(u32, Outputs)>,
    /// Warnings and printed messages.
    pub(crate) log_assertions: Vec<LogAssertion>,
    /// Conditions of `terminate`.
    pub(crate) terminations: Outputs,
    pub(crate) delays: Vec<CompiledDelay>,
    pub(crate) transports: Vec<CompiledTransport>,
    /// The variable that is 1 during initialization.
    pub(crate) initial: Option<VarId>,
    /// The variable that is 1 at the end.
    pub(crate) terminal: Option<VarId>,
}

/// A variable with its previous value.
#[derive(Debug, Clone, Copy, serde::Serialize, serde::Deserialize)]
pub(crate) struct Previous {
    pub(crate) of: VarId,
    pub(crate) register: Register,
    /// Whether event iteration continues until both are equal.
    pub(crate) discrete: bool,
    /// Whether every difference counts, not only one that is more than rounding.
    pub(crate) exact: bool,
    /// Whether it must be computed from the states before an event.
    pub(in crate::codegen) computed: bool,
}

/// A rounding, compiled.
#[derive(Debug, Clone, Copy, serde::Serialize, serde::Deserialize)]
pub(crate) struct CompiledRounding {
    pub(crate) register: Register,
    /// For an argument that is linear in time: its rate, and the register of the rest.
    pub(crate) time: Option<(f64, Register)>,
}

/// `register = delay(value, time)`
#[derive(Debug, Clone, serde::Serialize, serde::Deserialize)]
pub(crate) struct CompiledDelay {
    pub(crate) register: Register,
    /// The expression, from states and values of events.
    pub(crate) value: Outputs,
    /// The delay, from parameters.
    pub(crate) time: Outputs,
}

/// A variable delay, or the content of a pipe.
#[derive(Debug, Clone, serde::Serialize, serde::Deserialize)]
pub(crate) struct CompiledTransport {
    /// Where the value of a delay, or those at both ends of a pipe, are written.
    pub(crate) outputs: Vec<Register>,
    /// The delay time; or the position, and whether the velocity is positive.
    pub(crate) read: Outputs,
    /// What goes in.
    pub(crate) inputs: Outputs,
    /// From parameters: the longest delay; or points, and values of a first content.
    pub(crate) start: Outputs,
}

impl CompiledTransport {
    /// Whether it is the content of a pipe.
    pub(crate) fn is_pipe(&self) -> bool {
        self.outputs.len() == 2
    }
}

impl Events {
    /// Whether anything can happen at an event beside relations that switch.
    pub(crate) fn is_empty(&self) -> bool {
        self.steps.is_empty()
            && self.reinitialized.is_empty()
            && self.samples.is_empty()
            && self.delays.is_empty()
            && self.transports.is_empty()
            && self.initial.is_none()
            && self.terminal.is_none()
            && self.assertions.outputs.is_empty()
            && self.log_assertions.is_empty()
            && self.terminations.outputs.is_empty()
    }

    /// Whether previous values of algebraic variables are needed.
    pub(crate) fn need_left_limits(&self) -> bool {
        self.previous.iter().any(|previous| previous.computed)
    }
}
