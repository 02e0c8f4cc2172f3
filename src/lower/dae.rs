//! The system of equations: scalar, first order (MLS appendix B). Data only.

use super::build::UNKNOWN_TEXT;
use super::default_values::DefaultValues;
use super::events::Events;
use crate::bytecode::Functions;
use crate::diag::Diagnostic;
use crate::flatten::{BaseType, Experiment, Variability};
use crate::source::Span;
use crate::symbolic::{Expr, Pool, RelationOperator, VarId};
use crate::syntax::ast::CausalityPrefix;
use std::sync::Arc;

/// A scalar system: variables are numbered by their position.
#[derive(Debug, Clone, Default)]
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

/// The variables behind every `homotopy(actual, simplified)`, which reads
/// `if active then simplified + lambda*(actual - simplified) else actual` in the initial system and
/// `actual` in the other.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Homotopy {
    /// Whether there is something between the two, 0 or 1.
    pub active: VarId,
    /// How far the way is done, 0 to 1.
    pub lambda: VarId,
}

/// A scalar variable.
#[derive(Debug, Clone)]
pub struct Variable {
    /// Its name with subscripts, such as `pack.cell[2].V`.
    pub name: Arc<str>,
    /// Its part in the system.
    pub kind: Kind,
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
    /// Unit, empty if none.
    pub unit: Arc<str>,
    /// Unit for people, empty if none.
    pub display_unit: Arc<str>,
    /// The string behind the declaration.
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

/// How much a variable is wanted as a state (MLS §4.9.8), the least wanted first.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Default)]
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
    /// What two wishes for one variable come to: the stronger of those that are none.
    pub fn merged_with(self, other: StateSelect) -> StateSelect {
        match (self, other) {
            (StateSelect::Default, other) => other,
            (one, StateSelect::Default) => one,
            (one, other) => one.max(other),
        }
    }
}

/// What part a variable plays.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Kind {
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
}

/// `left = right`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Equation {
    /// Left side.
    pub left: Expr,
    /// Right side.
    pub right: Expr,
    /// Where it is written.
    pub span: Span,
    /// Whose equation it is, if of one instance.
    pub instance: Option<Instance>,
}

impl Equation {
    /// `left = right`, written at `span`; whose it is, is not known.
    pub fn new(left: Expr, right: Expr, span: Span) -> Equation {
        Equation { left, right, span, instance: None }
    }
}

/// Position of a path in [`Dae::instances`].
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Instance(pub u32);

/// What it means that a condition does not hold.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Level {
    /// The simulation ends (`AssertionLevel.error`).
    Error,
    /// The user is warned (`AssertionLevel.warning`).
    Warning,
    /// A function prints the text.
    Message,
    /// Functions write; the parts are their calls.
    Effect,
}

/// A part of a text for people.
#[derive(Debug, Clone, PartialEq)]
pub enum Part {
    /// Known when compiling.
    Text(Arc<str>),
    /// A number of this value.
    Number(Expr),
    /// `true` or `false`.
    Boolean(Expr),
}

/// `assert(condition, message, level)`, or a text that is printed.
#[derive(Debug, Clone, PartialEq)]
pub struct Assertion {
    /// Must hold; its relations are evaluated as they are.
    pub condition: Expr,
    /// The text for people as far as it is known when compiling.
    pub message: Arc<str>,
    /// The same in parts.
    pub parts: Vec<Part>,
    /// What a violation means.
    pub level: Level,
    /// Where it is written.
    pub span: Span,
}

/// A relation whose value changes at events only (MLS §8.5).
#[derive(Debug, Clone, Copy, PartialEq)]
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

/// Sizes of an argument.
#[derive(Debug, Clone, PartialEq, Eq, Hash)]
pub enum Shape {
    /// A scalar (no sizes) or an array.
    Array(Vec<usize>),
    /// A record: name and shape of its components.
    Record(Vec<(crate::name::Ident, Shape)>),
    /// A text, no scalar; `…` stands for what is not known when compiling.
    Text(Arc<str>),
}

impl Shape {
    /// Number of scalars.
    pub fn len(&self) -> usize {
        match self {
            Shape::Array(dims) => dims.iter().product(),
            Shape::Record(fields) => fields.iter().map(|(_, shape)| shape.len()).sum(),
            Shape::Text(_) => 0,
        }
    }

    /// Whether there are no scalars.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// The shape of an array of these; that of an array of records is a record of arrays.
    pub fn repeated(self, dims: &[usize]) -> Shape {
        match self {
            Shape::Array(own) => Shape::Array(dims.iter().copied().chain(own).collect()),
            Shape::Record(fields) => {
                let field = |(name, shape): (_, Shape)| (name, shape.repeated(dims));
                Shape::Record(fields.into_iter().map(field).collect())
            }
            Shape::Text(text) => Shape::Text(text),
        }
    }

    /// Whether it is a text, or a record with one.
    pub fn holds_text(&self) -> bool {
        match self {
            Shape::Array(_) => false,
            Shape::Record(fields) => fields.iter().any(|(_, shape)| shape.holds_text()),
            Shape::Text(_) => true,
        }
    }

    /// Makes all texts unknown.
    pub fn forget_texts(&mut self) {
        match self {
            Shape::Array(_) => {}
            Shape::Record(fields) => fields.iter_mut().for_each(|(_, s)| s.forget_texts()),
            Shape::Text(text) => *text = UNKNOWN_TEXT.into(),
        }
    }

    /// The shape of a value that may have either shape: texts that differ are not known. `None` if
    /// sizes or components differ.
    pub fn joined(&self, other: &Shape) -> Option<Shape> {
        match (self, other) {
            (Shape::Array(a), Shape::Array(b)) => (a == b).then(|| self.clone()),
            (Shape::Text(a), Shape::Text(b)) if a == b => Some(self.clone()),
            (Shape::Text(_), Shape::Text(_)) => Some(Shape::Text(UNKNOWN_TEXT.into())),
            (Shape::Record(a), Shape::Record(b)) if a.len() == b.len() => {
                let fields = a.iter().zip(b);
                let joined = |((name, a), (other, b)): (&(_, Shape), &(_, Shape))| {
                    let shape = a.joined(b)?;
                    (name == other).then_some((*name, shape))
                };
                fields.map(joined).collect::<Option<_>>().map(Shape::Record)
            }
            _ => None,
        }
    }
}

impl Dae {
    /// The variable of this number.
    pub fn variable(&self, id: VarId) -> &Variable {
        &self.variables[id.0 as usize]
    }

    /// Whether its value is found by the equations between events.
    pub fn is_unknown(&self, id: VarId) -> bool {
        matches!(self.variable(id).kind, Kind::Unknown | Kind::Derivative(_))
    }

    /// Whether its value is found by the equations, at events or between them.
    pub fn is_solved_for(&self, id: VarId) -> bool {
        self.is_unknown(id) || self.variable(id).kind == Kind::Discrete
    }
}
