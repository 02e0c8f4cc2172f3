//! The system of equations: scalar, first order (MLS appendix B). Data only.

use super::equation::{Assertion, Equation, Level};
use super::events::Events;
use super::string_part::StringPart;
use crate::bytecode::Functions;
use crate::diag::Diagnostic;
use crate::flatten::{BaseType, Experiment, Variability};
use crate::source::Span;
use crate::symbolic::{Expr, Pool, RelationOperator, VarId};
use crate::syntax::ast::CausalityPrefix;
use std::sync::Arc;

/// A scalar system: variables are numbered by their position.
#[derive(Debug, Clone, Default, serde::Serialize, serde::Deserialize)]
pub struct Dae {
    /// Name of the class.
    pub name: String,
    /// All expressions.
    pub pool: Pool,
    /// All variables; [`VarId`] is the position. The first is time.
    pub variables: Vec<Variable>,
    /// Equations of the simulation.
    pub equations: Vec<Equation>,
    /// Equations of the initial system alone.
    pub initial_equations: Vec<Equation>,
    /// Full paths of the instances whose equations these are; that of the model itself is empty.
    pub instances: Vec<Arc<str>>,
    /// What must hold.
    pub assertions: Vec<Assertion>,
    /// Functions that expressions call.
    pub functions: Arc<Functions>,
    /// Relations that switch at events only.
    pub relations: Vec<Relation>,
    /// What else happens at events.
    pub events: Events,
    /// Values that constants and parameters have by default, once these are in order.
    pub defaults: DefaultValues,
    /// What leads from the simplified expressions of `homotopy` to the actual ones.
    pub homotopy: Option<Homotopy>,
    /// The `experiment` annotation.
    pub experiment: Experiment,
    /// What deserves a warning.
    pub warnings: Vec<Diagnostic>,
}

/// The variables of every `homotopy(actual, simplified)`, which reads
/// `if active then simplified + lambda*(actual - simplified) else actual` in the initial system and
/// `actual` in the other.
#[derive(Debug, Clone, Copy, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
pub struct Homotopy {
    /// Whether there is something between the two, 0 or 1.
    pub active: VarId,
    /// How far the way is done, 0 to 1.
    pub lambda: VarId,
}

/// A scalar variable.
#[derive(Debug, Clone, serde::Serialize, serde::Deserialize)]
pub struct Variable {
    /// Its name with subscripts, such as `pack.cell[2].V`.
    pub name: Arc<str>,
    /// Its part in the system.
    pub kind: VariableKind,
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
    /// A difference, whose unit converts without an offset.
    pub is_relative: bool,
    /// Unit, empty if none.
    pub unit: Arc<str>,
    /// Unit for people, empty if none.
    pub(crate) display_unit: Arc<str>,
    /// The description string of the declaration.
    pub description: Arc<str>,
    /// Value of a parameter; `None` for unknowns.
    pub binding: Option<Expr>,
    /// Attribute `start`.
    pub start: Option<Expr>,
    /// Attribute `fixed`.
    pub fixed: bool,
    /// Attribute `min`.
    pub min: Option<Expr>,
    /// Attribute `max`.
    pub max: Option<Expr>,
    /// Attribute `nominal`.
    pub nominal: Option<Expr>,
    /// Attribute `stateSelect`.
    pub state_select: StateSelect,
    /// Where it is declared.
    pub span: Span,
}

/// How much a variable is preferred as a state (MLS §4.9.8), the least preferred first.
#[derive(
    Debug,
    Clone,
    Copy,
    PartialEq,
    Eq,
    PartialOrd,
    Ord,
    Default,
    serde::Serialize,
    serde::Deserialize,
)]
pub enum StateSelect {
    /// Only if nothing else is left.
    Never,
    /// Rather not.
    Avoid,
    /// If it is differentiated in the model.
    #[default]
    Default,
    /// Rather than those of `Default`.
    Prefer,
    /// Before all others.
    Always,
}

impl StateSelect {
    /// Combines two `stateSelect` attributes of one variable: the stronger one wins.
    pub(crate) fn merged_with(self, other: StateSelect) -> StateSelect {
        match (self, other) {
            (StateSelect::Default, other) => other,
            (one, StateSelect::Default) => one,
            (one, other) => one.max(other),
        }
    }
}

/// What part a variable plays.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize, serde::Deserialize)]
pub enum VariableKind {
    /// `time`
    Time,
    /// Known when compiling.
    Constant(f64),
    /// Known before the simulation; `tunable` if a user may set it.
    Parameter {
        /// Whether a user may set it without compiling again.
        tunable: bool,
    },
    /// A parameter that the initial system determines (`fixed = false`).
    Solved,
    /// To be solved for.
    Unknown,
    /// The derivative of another variable.
    Derivative(VarId),
    /// To be solved for at events, constant between them.
    Discrete,
    /// The value that another variable had before the event iteration in progress (`pre`).
    Previous(VarId),
    /// The value of a relation or rounding, which changes at events only.
    Frozen,
    /// The past value of an expression (`delay`).
    Delayed,
    /// Set by the simulation: `initial()`, `terminal()`, `sample(…)`.
    Signal,
    /// A `String`, which equations cannot use.
    Text,
    /// A `Clock`, which has no value.
    Clock,
}

/// A relation whose value changes at events only (MLS §8.5).
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Relation {
    /// The variable that holds its value.
    pub variable: VarId,
    /// How the sides compare.
    pub operator: RelationOperator,
    /// Left side.
    pub left: Expr,
    /// Right side.
    pub right: Expr,
    /// Where it is written.
    pub span: Span,
}

impl Dae {
    /// The variable of this number.
    pub fn variable(&self, id: VarId) -> &Variable {
        &self.variables[id.0 as usize]
    }

    /// An assertion by its number: those at events follow the others.
    pub fn assertion(&self, number: u32) -> Option<&Assertion> {
        self.assertions.iter().chain(&self.events.assertions).nth(number as usize)
    }

    /// Whether its value is found by the equations between events.
    pub fn is_unknown(&self, id: VarId) -> bool {
        matches!(self.variable(id).kind, VariableKind::Unknown | VariableKind::Derivative(_))
    }

    /// Adds a variable that the model does not declare.
    pub(super) fn declare_variable(&mut self, variable: Variable) -> VarId {
        let id = VarId(self.variables.len() as u32);
        self.variables.push(variable);
        id
    }

    /// Whether an expression is made of parameters and numbers alone.
    pub(super) fn is_parametric(&self, a: Expr) -> bool {
        let varies = |v: VarId| {
            !matches!(self.variable(v).kind, VariableKind::Parameter { .. } | VariableKind::Solved)
        };
        !self.pool.any_variable(a, varies)
    }

    /// Whether an expression may vary between events.
    pub(super) fn varies(&self, a: Expr) -> bool {
        self.pool.any_variable(a, |v| self.is_varying(v))
    }

    /// Whether a variable changes between events.
    pub(super) fn is_varying(&self, v: VarId) -> bool {
        matches!(
            self.variable(v).kind,
            VariableKind::Time
                | VariableKind::Unknown
                | VariableKind::Derivative(_)
                | VariableKind::Delayed
                | VariableKind::Text
        )
    }

    /// Assertions in a branch hold only where it is taken, and are looked at only there.
    pub(super) fn guard_assertions(&mut self, from: usize, condition: Expr) {
        let holds = self.pool.constant(1.0);
        for assertion in self.assertions.iter_mut().skip(from) {
            assertion.condition = self.pool.if_then_else(condition, assertion.condition, holds);
        }
    }

    /// Assertions read since `from` hold at events, where the guard does.
    pub(super) fn move_assertions(&mut self, from: usize, guard: Expr) {
        self.guard_assertions(from, guard);
        for mut assertion in self.assertions.split_off(from) {
            if assertion.level == Level::Effect {
                // Calls are executed only where their statement is.
                let zero = self.pool.constant(0.0);
                for part in &mut assertion.parts {
                    if let StringPart::Numbered(call) = part {
                        *call = self.pool.if_then_else(assertion.condition, zero, *call);
                    }
                }
            }
            self.events.assertions.push(assertion);
        }
    }

    /// Whether its value is found by the equations, at events or between them.
    pub(crate) fn is_solved_for(&self, id: VarId) -> bool {
        self.is_unknown(id) || self.variable(id).kind == VariableKind::Discrete
    }
}

/// A value for every variable, NaN where there is none.
#[derive(Debug, Clone, Default, serde::Serialize, serde::Deserialize)]
pub struct DefaultValues {
    pub(super) values: Vec<f64>,
}

impl DefaultValues {
    /// The value of a variable, NaN where it has none.
    pub(crate) fn get(&self, variable: VarId) -> f64 {
        self.values.get(variable.0 as usize).copied().unwrap_or(f64::NAN)
    }

    /// With no value for variables declared later.
    pub(crate) fn grow(&mut self, n: usize) {
        self.values.resize(n, f64::NAN);
    }

    pub(crate) fn set(&mut self, variable: VarId, value: f64) {
        self.values[variable.0 as usize] = value;
    }
}
