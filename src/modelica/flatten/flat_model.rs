//! The flat model: variables and equations without classes. Data only.
//!
//! Arrays of components are taken apart (`c[2].x`), arrays of predefined types stay arrays
//! (`c[2].x` of size 3 is one variable). In every expression a [`ast::ComponentReference`] is either
//! the full path of a [`Variable`] (literal subscripts in all parts but the last; any subscripts on
//! the last),
//! `time`, or a loop variable; function names are full names of [`FlatModel::functions`] or of
//! intrinsics (MLS §3.7, §10.3). Enumeration literals are replaced by
//! [`ast::ExpressionKind::Integer`] ordinals.

use super::recorded::RecordedInput;
use crate::eval::Function;
use crate::external::Resources;
pub use crate::inference::Variability;
use crate::name::Name;
use crate::source::Span;
use crate::syntax::ast::{self, CausalityPrefix, Expression, Statement};
use crate::value::EnumerationDefinition;
use indexmap::IndexMap;
use rustc_hash::FxBuildHasher;
use std::ops::Range;
use std::sync::Arc;

/// A flat model.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct FlatModel {
    /// Full name of the class, with its modification if there was one.
    pub name: String,
    /// The class's string.
    pub description: Option<Arc<str>>,
    /// Variables by flat name, in order of declaration.
    pub variables: IndexMap<Arc<str>, Variable, FxBuildHasher>,
    /// Equations, loops kept, branches on parameters chosen, connections resolved.
    pub equations: Vec<ast::Equation>,
    /// Initial equations.
    pub initial_equations: Vec<ast::Equation>,
    /// Algorithm sections.
    pub algorithms: Vec<Vec<Statement>>,
    /// Initial algorithm sections.
    pub initial_algorithms: Vec<Vec<Statement>>,
    /// Whose equations and algorithms these are; those of connections belong to none.
    pub parts: Vec<Part>,
    /// Functions called, directly and indirectly, by full name.
    pub functions: IndexMap<Name, Arc<Function>>,
    /// Inputs whose values are recorded samples: they have no binding.
    pub recorded: Vec<RecordedInput>,
    /// The files that it may use.
    pub resources: Resources,
    /// The `experiment` annotation.
    pub experiment: Experiment,
    /// Whether what the specification forbids is an error though libraries do it.
    pub strict: bool,
    /// Where the class is defined.
    pub span: Option<Span>,
}

/// What an instance of a class contributes to a flat model.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Part {
    /// Its full path, empty for the model itself.
    pub instance: Arc<str>,
    /// Variables of enclosing instances that its `outer output` components are (MLS §17.3.5).
    pub outputs: Vec<Arc<str>>,
    /// Positions in [`FlatModel::equations`].
    pub equations: Range<usize>,
    /// Positions in [`FlatModel::initial_equations`].
    pub initial_equations: Range<usize>,
    /// Positions in [`FlatModel::algorithms`].
    pub algorithms: Range<usize>,
}

/// The `experiment` annotation (MLS §18.4): `None` where it says nothing.
#[derive(Debug, Clone, Copy, PartialEq, Default, serde::Serialize, serde::Deserialize)]
pub struct Experiment {
    /// `StartTime`, seconds.
    pub start_time: Option<f64>,
    /// `StopTime`, seconds.
    pub stop_time: Option<f64>,
    /// `Interval`, seconds.
    pub interval: Option<f64>,
    /// `Tolerance`, relative.
    pub tolerance: Option<f64>,
}

/// A variable of a flat model.
#[derive(Debug, Clone, PartialEq)]
pub struct Variable {
    /// Its full path, such as `pack.cell[2].V`.
    pub name: Arc<str>,
    /// Its predefined type.
    pub base: BaseType,
    /// Sizes of its dimensions; empty for a scalar.
    pub dims: Vec<usize>,
    /// When it may change.
    pub variability: Variability,
    /// `input` or `output`, of top-level components only.
    pub causality: Option<CausalityPrefix>,
    /// Whether it is an input of its instance, or of a connector of it.
    pub is_input: bool,
    /// `final`, here or on a component that holds it, or on its binding.
    pub is_final: bool,
    /// Whether it is protected or lies in a protected component.
    pub protected: bool,
    /// `annotation(Evaluate = …)`.
    pub evaluate: bool,
    /// `annotation(absoluteValue = false)` (MLS §18): a difference, whose unit converts without the
    /// offset between the zeros of scales.
    pub is_relative: bool,
    /// Whether it is a structural parameter (an array size, a chosen branch, a condition).
    pub structural: bool,
    /// Whether the component stands directly in the class that was flattened.
    pub top_level: bool,
    /// Attributes by name (`start`, `fixed`, `min`, `max`, `nominal`, `unit`, `displayUnit`,
    /// `quantity`, `stateSelect`).
    pub attributes: IndexMap<&'static str, Attribute>,
    /// The binding: an equation for a variable, the value of a parameter.
    pub binding: Option<Expression>,
    /// Its description string.
    pub description: Option<Arc<str>>,
    /// Where it is declared.
    pub span: Span,
}

/// The value of an attribute.
#[derive(Debug, Clone, PartialEq)]
pub struct Attribute {
    /// A scalar, which with an array holds for `each` element, or an array of the same size.
    pub value: Expression,
    /// Whether the model set it `final`.
    pub is_final: bool,
}

/// The predefined type of a variable.
#[derive(Debug, Clone, PartialEq, serde::Serialize, serde::Deserialize)]
pub enum BaseType {
    /// `Real`
    Real,
    /// `Integer`
    Integer,
    /// `Boolean`
    Boolean,
    /// `String`
    String,
    /// An enumeration
    Enumeration(Arc<EnumerationDefinition>),
    /// A class that extends `ExternalObject` (MLS §12.9.7), by its full name: its value is what
    /// the call of its constructor in the binding returns.
    ExternalObject(Name),
    /// `Clock` (MLS §16.3): it has no value, it ticks.
    Clock,
}

impl Variable {
    /// Whether a user may set it between runs without compiling again: a parameter that is not
    /// final, not `Evaluate = true` and did not shape the model.
    pub fn is_tunable(&self) -> bool {
        self.variability == Variability::Parameter
            && !self.is_final
            && !self.evaluate
            && !self.structural
    }

    /// Number of scalars.
    pub fn len(&self) -> usize {
        self.dims.iter().product()
    }

    /// Whether it is an array of size zero.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }
}
