//! A compiled model: immutable, shared by any number of systems.

use super::code::{Assertions, CrossingPart};
use super::events::Events;
use super::registers::Registers;
use super::tape::Tape;
use crate::arithmetic::Register;
use crate::causalize::{Assignment, CausalizedDae};
use crate::codegen::code::{CompiledRelation, CompiledSelection, LogAssertion, Outputs, Step};
use crate::flatten::{BaseType, Variability};
use crate::lower::VariableKind;
use crate::sim::{Linearity, Pattern};
use crate::symbolic::{Expr, VarId};
use crate::syntax::ast::CausalityPrefix;
use std::sync::{Arc, OnceLock};

/// A parameter that can be set between simulations.
#[derive(Debug, Clone, serde::Serialize, serde::Deserialize)]
pub struct ParameterInfo {
    /// Its full name.
    pub name: Arc<str>,
    /// Unit, empty if none.
    pub unit: Arc<str>,
    /// The description string of its declaration.
    pub description: Arc<str>,
    /// Predefined type; values are numbers (Boolean 0 or 1, enumerations by ordinal).
    pub base: BaseType,
    /// Attribute `min`; `-∞` without.
    pub min: f64,
    /// Attribute `max`; `∞` without.
    pub max: f64,
    /// Its default value; NaN if it cannot be computed.
    pub default: f64,
    /// Whether it stands directly in the class.
    pub top_level: bool,
    /// Its variable in the equations.
    pub variable: VarId,
}

/// A scalar variable of the model, aliases, parameters and constants included.
#[derive(Debug, Clone, serde::Serialize, serde::Deserialize)]
pub struct VariableInfo {
    /// Its full name.
    pub name: Arc<str>,
    /// Unit, empty if none.
    pub unit: Arc<str>,
    /// A difference, whose unit converts without an offset.
    pub is_relative: bool,
    /// Unit for people, empty if none.
    pub(crate) display_unit: Arc<str>,
    /// The description string of its declaration.
    pub description: Arc<str>,
    /// Predefined type.
    pub base: BaseType,
    /// When it may change.
    pub variability: Variability,
    /// `input` or `output`.
    pub causality: Option<CausalityPrefix>,
    /// Whether it stands directly in the class.
    pub top_level: bool,
    /// Whether it is protected.
    pub protected: bool,
    /// Where its value is found.
    pub access: Access,
    pub(crate) variable: VarId,
}

impl VariableInfo {
    /// Whether its value does not change during a simulation.
    pub fn is_known(&self) -> bool {
        self.variability <= Variability::Parameter
    }

    /// Whether it is an output of the model itself.
    pub fn is_output(&self) -> bool {
        self.causality == Some(CausalityPrefix::Output)
    }
}

/// Where the value of a variable is found.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize, serde::Deserialize)]
pub enum Access {
    /// It is the simulated time.
    Time,
    /// A number.
    Constant(f64),
    /// A parameter: ask [`System::value`](crate::runtime::System::value).
    Parameter,
    /// A column of the observed variables (when all are observed), with its sign.
    Observed {
        /// Which column.
        column: usize,
        /// Whether the variable has the opposite sign.
        negated: bool,
    },
}

/// The relations inside `noEvent` of a program, collected at the first request.
#[derive(Debug, Default)]
pub(super) struct Literal {
    pub(super) differences: OnceLock<Option<Differences>>,
    pub(super) program: OnceLock<Option<Arc<Program>>>,
}

/// Computes left − right of every relation, from the registers of the unknowns and parameters.
#[derive(Debug)]
pub(crate) struct Differences {
    pub(crate) registers: Registers,
    pub(crate) code: Outputs,
}

/// Variables that nothing reads and that may have no value.
#[derive(Debug, serde::Serialize, serde::Deserialize)]
pub(crate) struct Unread {
    /// Ascending.
    pub(crate) variables: Vec<VarId>,
    /// Their values.
    pub(crate) values: Outputs,
}

/// A compiled model.
#[derive(Debug, serde::Serialize, serde::Deserialize)]
pub struct Program {
    pub(crate) sorted: CausalizedDae,
    pub(crate) registers: Registers,
    /// Everything in solving order, iteration variables of loops given.
    pub(crate) sequence: Vec<Assignment>,
    pub(super) parameters: Vec<ParameterInfo>,
    pub(super) variables: Vec<VariableInfo>,
    pub(crate) observed: Vec<VarId>,
    /// Of these, those that are computed for results alone and may have no value.
    pub(crate) unread: Unread,
    pub(crate) initial_steps: Vec<Step>,
    /// Both sides of what initial values must fulfil besides.
    pub(crate) initial_checks: Vec<Outputs>,
    pub(crate) steps: Vec<Step>,
    pub(crate) selections: Vec<CompiledSelection>,
    pub(crate) observe: Outputs,
    pub(crate) assertions: Assertions,
    /// Warnings: they do not end a simulation.
    pub(crate) log_assertions: Vec<LogAssertion>,
    pub(crate) events: Events,
    /// Whether equations contain the derivatives of recorded inputs, which jump at every knot.
    pub(crate) reads_rates: bool,
    pub(crate) continuous: Continuous,
    pub(crate) switching: Switching,
    pub(crate) values: Values,
    /// What became of its relations inside `noEvent`.
    #[serde(skip)]
    pub(super) literal: Literal,
}

/// What the integrator evaluates: right-hand sides, residuals, and their Jacobian.
#[derive(Debug, Clone, serde::Serialize, serde::Deserialize)]
pub(crate) struct Continuous {
    /// The same where all algebraic unknowns of the integrator are given.
    pub(crate) integrated: Vec<Assignment>,
    /// What must be zero there.
    pub(crate) residuals: Vec<Expr>,
    /// The unknowns of the integrator: states, then [`Continuous::iteration`].
    pub(crate) unknowns: Vec<VarId>,
    /// The algebraic ones.
    pub(crate) iteration: Vec<VarId>,
    /// Of these, how many at the end are in the sequence as well.
    pub(crate) n_auxiliary: usize,
    pub(crate) rhs: Outputs,
    pub(crate) jacobian: Outputs,
    pub(crate) pattern: Pattern,
    /// What is known of the right-hand side if it is affine between events.
    pub(crate) linearity: Option<Linearity>,
}

/// Relations with their crossing functions.
#[derive(Debug, Clone, serde::Serialize, serde::Deserialize)]
pub(crate) struct Switching {
    pub(crate) relations: Vec<CompiledRelation>,
    /// Both sides of every relation, from the registers of the variables.
    pub(crate) relation_sides: Vec<Outputs>,
    /// The part of [`CompiledRelation::time`] that parameters make.
    pub(crate) time_rests: Tape,
    /// The same for rests that change at events; `None` where there are none.
    pub(crate) rescheduled_rests: Option<Tape>,
    pub(crate) crossings: Outputs,
    /// The same for a few of them at a time.
    pub(crate) crossing_parts: Vec<CrossingPart>,
    /// Whether these depend on time otherwise than through states and unknowns of loops.
    pub(crate) crossings_vary_in_time: bool,
    /// How fast they oscillate in time by themselves, in radians per second.
    pub(crate) oscillations: Outputs,
    /// The relations that have crossing functions.
    pub(crate) crossing_relations: Vec<usize>,
    /// For every block that is solved at once, the relations in it.
    pub(crate) relations_of_blocks: Vec<Vec<usize>>,
    /// The relations in torn loops that are solved between events, ascending.
    pub(crate) relations_of_loops: Vec<usize>,
    /// For every relation, whether only functions of the relations follow from it at events.
    pub(crate) memoryless: Vec<bool>,
}

/// Code for single values: parameters, start values, nominal values.
#[derive(Debug, Clone, serde::Serialize, serde::Deserialize)]
pub(crate) struct Values {
    /// Every parameter's own tape, in order.
    pub(crate) parameter_tapes: Vec<(VarId, Tape)>,
    /// Start value of every unknown that has one.
    pub(crate) starts: Vec<(VarId, Tape)>,
    /// Parameters that the initial system determines.
    pub(crate) solved: Vec<VarId>,
    pub(crate) nominals: Vec<(VarId, Tape, Register)>,
}

impl Program {
    /// Number of crossing functions of relations and roundings.
    pub(crate) fn n_crossings(&self) -> usize {
        self.switching.crossings.outputs.len() - self.switching.crossing_relations.len()
    }

    /// Whether recorded inputs alone change at events: there is nothing to iterate.
    pub(crate) fn acts_by_recordings_alone(&self) -> bool {
        self.events.is_empty()
            && self.switching.relations.is_empty()
            && self.events.roundings.is_empty()
            && self.steps.iter().all(|step| matches!(step, Step::Run(_)))
            && self.selections.is_empty()
    }

    /// Whether the right-hand side calls functions whose derivatives jump where there is no event.
    pub(crate) fn has_kinks(&self) -> bool {
        let tape = &self.continuous.rhs.tape;
        let mut functions = tape.code.iter().filter_map(|own| own.function());
        functions.any(|function| function.is_kinked)
            || tape.calls.iter().any(|call| self.sorted.dae.functions.has_kinks(call.function))
    }

    /// Whether a mean of values of a variable is a value of it.
    pub(crate) fn has_means(&self, variable: VarId) -> bool {
        let variable = self.sorted.dae.variable(variable);
        variable.base == BaseType::Real && variable.kind != VariableKind::Discrete
    }
}

/// Equations, initial equations and those of events.
pub(crate) fn number_of_equations(sorted: &CausalizedDae) -> usize {
    let dae = &sorted.dae;
    dae.equations.len() + dae.initial_equations.len() + dae.events.equations.len()
}
