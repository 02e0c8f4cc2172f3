//! What `modelDescription.xml` says, in FMI 2.0 and 3.0.

mod read;
mod rules;
mod schema;
mod sizes;
mod words;
mod write;

#[cfg(test)]
mod tests;

use crate::flatten::Experiment;
use crate::units::{self, Definitions};
pub use read::read;
pub(crate) use read::unit as read_unit;
pub use words::{Causality, DependencyKind, Initial, Kind, Variability};
pub(crate) use write::base_unit;
pub use write::write;

/// The major version of the standard.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Version {
    /// FMI 2.0.
    V2,
    /// FMI 3.0.
    #[default]
    V3,
}

impl Version {
    /// The version that `fmiVersion` says: of FMI 2 there is one, of FMI 3 later ones can be read as well.
    fn of_word(word: &str) -> Option<Version> {
        let numbers: Vec<&str> = word.split(['.', '-']).collect();
        match numbers[..] {
            ["2", "0", ..] => Some(Version::V2),
            ["3", minor, ..] if minor.parse::<u32>().is_ok() => Some(Version::V3),
            _ => None,
        }
    }
}

/// What a unit is, and whose: attributes that no simulation depends on.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct About {
    /// What it is, in few words.
    pub description: Option<String>,
    /// Who made it.
    pub author: Option<String>,
    /// The version of the model.
    pub model_version: Option<String>,
    /// Whose it is.
    pub copyright: Option<String>,
    /// Who may use it.
    pub license: Option<String>,
    /// The tool that made it.
    pub generation_tool: Option<String>,
    /// When it was made.
    pub generation_time: Option<String>,
}

/// A description.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Description {
    /// The version of the standard.
    pub version: Version,
    /// The name of the model in the tool that made the unit.
    pub model_name: String,
    /// `guid` in FMI 2.0, `instantiationToken` in FMI 3.0.
    pub token: String,
    /// What it is, and whose.
    pub about: About,
    /// Whether names have the form `a.b[1]`, `der(a.b)` (`variableNamingConvention`).
    pub has_structured_names: bool,
    /// Present if the importer may integrate it.
    pub model_exchange: Option<Interface>,
    /// Present if it integrates itself.
    pub co_simulation: Option<Interface>,
    /// Present if an external scheduler may run its partitions.
    pub scheduled_execution: Option<Interface>,
    /// The units of its variables.
    pub units: Vec<Unit>,
    /// The types that variables refer to.
    pub types: Vec<TypeDefinition>,
    /// What log messages may be about.
    pub log_categories: Vec<LogCategory>,
    /// What to simulate unless asked otherwise.
    pub experiment: DefaultExperiment,
    /// All variables; others refer to them by their places.
    pub variables: Vec<Variable>,
    /// What follows from what.
    pub structure: Structure,
    /// Number of event indicators as FMI 2.0 gives it; in FMI 3.0 they are part of the structure.
    pub event_indicators: usize,
}

/// What a unit is able to in one of its kinds. Attributes that a kind or version does not have are
/// as by default.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Interface {
    /// The name of its shared library without its ending.
    pub model_identifier: String,
    /// Whether it only works while another program is installed.
    pub needs_execution_tool: bool,
    /// Whether a process may have one instance alone.
    pub is_single_instance: bool,
    /// Whether states of it can be kept and restored.
    pub can_get_and_set_state: bool,
    /// Whether states of it can become bytes.
    pub can_serialize_state: bool,
    /// Whether it has derivatives along directions.
    pub provides_directional_derivatives: bool,
    /// Whether it has derivatives backwards (FMI 3.0).
    pub provides_adjoint_derivatives: bool,
    /// Model exchange: whether the end of every step must be reported to it.
    pub needs_completed_step: bool,
    /// Whether discrete states can be evaluated without an event (FMI 3.0).
    pub provides_evaluate_discrete_states: bool,
    /// Co-simulation: whether steps may differ in length.
    pub can_handle_variable_steps: bool,
    /// The length of its own steps, seconds (FMI 3.0).
    pub fixed_internal_step: Option<f64>,
    /// Highest order of derivatives of outputs that it gives.
    pub max_output_derivative_order: u32,
    /// Whether inputs have derivatives between communication points (FMI 2.0).
    pub can_interpolate_inputs: bool,
    /// Whether it may call back within a step (FMI 3.0).
    pub provides_intermediate_update: bool,
    /// Whether a step may end before the time asked for (FMI 3.0).
    pub might_return_early: bool,
    /// Whether a callback may end a step (FMI 3.0).
    pub can_return_early: bool,
    /// Whether events are handled by the importer's asking (FMI 3.0).
    pub has_event_mode: bool,
    /// The sources it is built of (FMI 2.0).
    pub source_files: Vec<String>,
}

/// A unit of measurement.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Unit {
    /// As variables refer to it.
    pub name: String,
    /// What it is in base units of SI, if this is known.
    pub base: Option<BaseUnit>,
    /// Units for people.
    pub display_units: Vec<DisplayUnit>,
}

/// value in SI = factor · value + offset
#[derive(Debug, Clone, PartialEq)]
pub struct BaseUnit {
    /// Exponents of kg, m, s, A, K, mol, cd and rad.
    pub exponents: [i32; 8],
    /// Factor.
    pub factor: f64,
    /// Offset.
    pub offset: f64,
}

impl BaseUnit {
    /// That of a unit; `None` where an exponent is broken.
    pub(crate) fn of(unit: units::Unit) -> Option<BaseUnit> {
        let exponents = unit.dimension.exponents()?;
        Some(BaseUnit { exponents, factor: unit.factor, offset: unit.offset })
    }

    /// The unit; `None` where no value can be converted to it.
    pub(crate) fn unit(&self) -> Option<units::Unit> {
        const LARGEST: i32 = 1000;
        let BaseUnit { exponents, factor, offset } = *self;
        let is_usable = exponents.iter().all(|one| (-LARGEST..=LARGEST).contains(one))
            && factor.is_normal()
            && offset.is_finite();
        let dimension = || units::Dimension::new(exponents);
        is_usable.then(|| units::Unit { dimension: dimension(), factor, offset })
    }
}

/// The base units, in the order of [`BaseUnit::exponents`].
pub(crate) const BASE_UNITS: [&str; 8] = ["kg", "m", "s", "A", "K", "mol", "cd", "rad"];

/// value shown = factor · value + offset, of 1/value where it is inverse.
#[derive(Debug, Clone, PartialEq)]
pub struct DisplayUnit {
    /// Its name.
    pub name: String,
    /// Factor.
    pub factor: f64,
    /// Offset.
    pub offset: f64,
    /// Whether of the reciprocal (FMI 3.0).
    pub is_inverse: bool,
}

/// A type that variables refer to.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct TypeDefinition {
    /// Its name.
    pub name: String,
    /// Its predefined type.
    pub kind: Kind,
    /// What it is, in few words.
    pub description: Option<String>,
    /// Attributes of its variables that do not say otherwise.
    pub attributes: Attributes,
    /// The literals of an enumeration.
    pub items: Vec<Item>,
}

/// A literal of an enumeration.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Item {
    /// Its name.
    pub name: String,
    /// Its number.
    pub value: i64,
    /// What it is, in few words.
    pub description: Option<String>,
}

/// Attributes that types and variables have.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Attributes {
    /// What is measured.
    pub quantity: Option<String>,
    /// Unit.
    pub unit: Option<String>,
    /// Unit for people.
    pub display_unit: Option<String>,
    /// Whether it is a difference: conversion has no offset.
    pub is_relative: Option<bool>,
    /// Whether it may grow without limit, so that errors relative to it are none.
    pub is_unbounded: Option<bool>,
    /// Smallest value.
    pub min: Option<f64>,
    /// Largest value.
    pub max: Option<f64>,
    /// Typical magnitude.
    pub nominal: Option<f64>,
}

/// A kind of log messages.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct LogCategory {
    /// Its name.
    pub name: String,
    /// What it tells.
    pub description: Option<String>,
}

/// What to simulate, seconds.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct DefaultExperiment {
    /// First time.
    pub start: Option<f64>,
    /// Last time.
    pub stop: Option<f64>,
    /// Relative tolerance.
    pub tolerance: Option<f64>,
    /// Step, or distance of communication points.
    pub step: Option<f64>,
}

impl DefaultExperiment {
    /// What the annotation `experiment` of a model with this experiment would say.
    pub fn annotation(self) -> Experiment {
        let DefaultExperiment { start, stop, tolerance, step } = self;
        Experiment { start_time: start, stop_time: stop, interval: step, tolerance }
    }
}

/// A variable.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Variable {
    /// Its full name.
    pub name: String,
    /// By which functions refer to it: unique in FMI 3.0, for each base type in FMI 2.0, where aliases
    /// share it.
    pub reference: u32,
    /// What it is, in few words.
    pub description: Option<String>,
    /// Its predefined type.
    pub kind: Kind,
    /// Its part.
    pub causality: Causality,
    /// When it may change; with the default of its kind where nothing is said.
    pub variability: Variability,
    /// Where its first value comes from; with the default of the standard where nothing is said.
    pub initial: Option<Initial>,
    /// The type that gives attributes.
    pub declared_type: Option<String>,
    /// Sizes of an array (FMI 3.0).
    pub dimensions: Vec<Dimension>,
    /// Its own attributes.
    pub attributes: Attributes,
    /// Its start values as they are written; one for a scalar, for an array also one for all
    /// elements, none where nothing is said.
    pub start: Vec<String>,
    /// The place of the variable whose derivative it is.
    pub derivative_of: Option<usize>,
    /// Whether an event may set it, if it is a state.
    pub is_reinitialized: bool,
    /// Whether an input may be set several times at one time (FMI 3.0: by default).
    pub can_be_set_repeatedly: Option<bool>,
    /// Whether callbacks within a step may use it (FMI 3.0).
    pub has_intermediate_update: bool,
    /// The value reference of the variable whose previous value it is (FMI 3.0).
    pub previous: Option<u32>,
    /// Value references of the clocks at which it changes (FMI 3.0).
    pub clocks: Vec<u32>,
    /// Other names (FMI 3.0).
    pub aliases: Vec<VariableAlias>,
    /// When a clock ticks (FMI 3.0).
    pub clock: Option<ClockInterval>,
    /// Whether it is none of the model's and results need not have it (FMI 3.0): an annotation of this
    /// program says so.
    pub is_internal: bool,
}

/// The type of the annotation of internal variables.
const INTERNAL: &str = "gapilib.internal";

/// Another name of a variable.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct VariableAlias {
    /// The name.
    pub name: String,
    /// What it is, in few words.
    pub description: Option<String>,
    /// Unit for people.
    pub display_unit: Option<String>,
}

/// When a clock ticks: the attributes of `Clock` as they are written.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct ClockInterval {
    /// `intervalVariability`: `constant`, `fixed`, `tunable`, `changing`, `countdown`, `triggered`.
    pub variability: String,
    /// Seconds between ticks.
    pub decimal: Option<f64>,
    /// Seconds before the first.
    pub shift: Option<f64>,
    /// Ticks per second of the resolution, and in its units interval and shift.
    pub resolution: Option<u64>,
    /// Interval in units of the resolution.
    pub counter: Option<u64>,
    /// First tick in units of the resolution.
    pub shift_counter: Option<u64>,
    /// Whether it can be made a rational number.
    pub supports_fraction: bool,
    /// Which of several clocks comes first.
    pub priority: Option<u32>,
    /// Whether it may tick more often than asked.
    pub can_be_deactivated: bool,
}

/// The size of a dimension.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Dimension {
    /// A number.
    Fixed(u64),
    /// The value of the variable of this value reference.
    Variable(u32),
}

/// What follows from what.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Structure {
    /// Outputs.
    pub outputs: Vec<Unknown>,
    /// Derivatives of the continuous states, in the order of these.
    pub derivatives: Vec<Unknown>,
    /// Clocked states (FMI 3.0).
    pub clocked_states: Vec<Unknown>,
    /// What initialization determines.
    pub initial_unknowns: Vec<Unknown>,
    /// Event indicators (FMI 3.0).
    pub event_indicators: Vec<Unknown>,
}

/// A variable that is computed from others.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Unknown {
    /// Its place.
    pub variable: usize,
    /// The places of those it is computed from, each with the kind of its dependence; `None` where
    /// it may depend on all.
    pub dependencies: Option<Vec<(usize, DependencyKind)>>,
}

impl Description {
    /// What the names of its units and display units stand for, as far as it says.
    pub fn unit_definitions(&self) -> Definitions {
        let mut all = Definitions::default();
        for own in &self.units {
            let base = own.base.as_ref().and_then(BaseUnit::unit);
            base.iter().for_each(|base| all.add(&own.name, *base));
            let Some(base) = units::written(&own.name).or(base) else { continue };
            let is_usable = |one: &&DisplayUnit| {
                !one.is_inverse && one.factor.is_normal() && one.offset.is_finite()
            };
            let shown = own.display_units.iter().filter(is_usable);
            for one in shown {
                let offset = base.offset - base.factor * one.offset / one.factor;
                let shown = units::Unit { factor: base.factor / one.factor, offset, ..base };
                all.add(&one.name, shown);
            }
        }
        all
    }

    /// The variable of this name.
    pub fn find(&self, name: &str) -> Option<&Variable> {
        self.variables.iter().find(|variable| variable.name == name)
    }

    /// The type that a variable refers to.
    pub fn type_of(&self, variable: &Variable) -> Option<&TypeDefinition> {
        let name = variable.declared_type.as_deref()?;
        self.types.iter().find(|one| one.name == name)
    }

    /// The attributes of a variable, those of its type included.
    pub fn attributes_of(&self, variable: &Variable) -> Attributes {
        let own = variable.attributes.clone();
        let Some(declared) = self.type_of(variable).map(|one| &one.attributes) else { return own };
        Attributes {
            quantity: own.quantity.or_else(|| declared.quantity.clone()),
            unit: own.unit.or_else(|| declared.unit.clone()),
            display_unit: own.display_unit.or_else(|| declared.display_unit.clone()),
            is_relative: own.is_relative.or(declared.is_relative),
            is_unbounded: own.is_unbounded.or(declared.is_unbounded),
            min: own.min.or(declared.min),
            max: own.max.or(declared.max),
            nominal: own.nominal.or(declared.nominal),
        }
    }
}
