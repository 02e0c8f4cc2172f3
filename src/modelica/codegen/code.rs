//! Pieces of compiled code: tapes with the registers of their results.

use super::machine_code::MachineCode;
use super::tape::Tape;
use crate::arithmetic::Register;
use crate::sim::Pattern;

/// A step of solving for all variables, the states (or nothing, at the start) given.
#[derive(Debug, Clone, serde::Serialize, serde::Deserialize)]
pub(crate) enum Step {
    Run(CompiledRun),
    Solve(CompiledLoop),
}

/// Assignments one after another.
#[derive(Debug, Clone, serde::Serialize, serde::Deserialize)]
pub(crate) struct CompiledRun {
    pub(crate) tape: Tape,
    #[serde(skip)]
    pub(crate) machine_code: MachineCode,
}

/// A torn loop with its Jacobian.
#[derive(Debug, Clone, serde::Serialize, serde::Deserialize)]
pub(crate) struct CompiledLoop {
    pub(crate) tape: Tape,
    pub(crate) unknowns: Vec<Register>,
    pub(crate) residuals: Vec<Register>,
    /// Where the entries of the Jacobian are that are not always zero.
    pub(crate) pattern: Pattern,
    /// These entries, by columns.
    pub(crate) jacobian: Vec<Register>,
    /// 1 once the tape has computed the residuals: what fails after that is a derivative.
    pub(crate) has_residuals: Register,
    pub(crate) block: u32,
    #[serde(skip)]
    pub(crate) machine_code: MachineCode,
}

/// A frozen relation, compiled.
#[derive(Debug, Clone, serde::Serialize, serde::Deserialize)]
pub(crate) struct CompiledRelation {
    pub(crate) register: Register,
    pub(crate) operator: crate::symbolic::RelationOperator,
    /// For a relation on time alone: the factor of time, and the register of the rest.
    pub(crate) time: Option<(f64, Register)>,
    /// Whether that rest changes at events.
    pub(crate) is_rescheduled: bool,
}

/// States chosen at run time, as registers.
#[derive(Debug, Clone, serde::Serialize, serde::Deserialize)]
pub(crate) struct CompiledSelection {
    /// The entries that are not always zero.
    pub(crate) jacobian: Outputs,
    /// Their rows and columns, by rows.
    pub(crate) places: Vec<(usize, usize)>,
    pub(crate) candidates: Vec<Register>,
    pub(crate) states: Vec<Register>,
    pub(crate) weights: Vec<Vec<Register>>,
    /// Places of the candidates that are states at first.
    pub(crate) chosen: Vec<usize>,
}

/// Code with the registers of its results.
#[derive(Debug, Clone, Default, serde::Serialize, serde::Deserialize)]
pub(crate) struct Outputs {
    pub(crate) tape: Tape,
    pub(crate) outputs: Vec<Register>,
    #[serde(skip)]
    pub(crate) machine_code: MachineCode,
}

/// Functions one after another that need nearly the same.
#[derive(Debug, Clone, serde::Serialize, serde::Deserialize)]
pub(crate) struct CrossingPart {
    /// The number of the first of them among the relations with crossing functions.
    pub(crate) first: usize,
    /// Both sides of each.
    pub(crate) code: Outputs,
}

impl CrossingPart {
    /// The number after the last of them.
    pub(crate) fn end(&self) -> usize {
        self.first + self.code.outputs.len() / 2
    }
}

/// What must hold at every step.
#[derive(Debug, Clone, serde::Serialize, serde::Deserialize)]
pub(crate) struct Assertions {
    pub(crate) each: Vec<LogAssertion>,
    /// The conditions of all.
    pub(crate) conditions: Outputs,
}

/// A message with the condition that must not hold.
#[derive(Debug, Clone, serde::Serialize, serde::Deserialize)]
pub(crate) struct LogAssertion {
    /// Its number among all assertions, those at events after the others.
    pub(crate) assertion: u32,
    pub(crate) condition: Outputs,
    /// The values in its text, computed where the condition does not hold.
    pub(crate) values: Outputs,
}
