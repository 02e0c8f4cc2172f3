//! Units of compiled models: a program of this compiler, its description, and the shared library
//! that simulates such programs.
//!
//! ```text
//! modelDescription.xml            what importers read
//! binaries/PLATFORM/NAME.so       the runtime of units, the same in all of them
//! resources/model.gapi            the program
//! ```

mod content;
mod structure;
mod units;
mod variables;

pub use content::{Content, Exported, FILE, Place, Setter, ValueKind};

use crate::archive::DESCRIPTION;
use crate::codegen::Program;
use crate::description::{
    self, About, DefaultExperiment, Description, Interface, LogCategory, Version,
};
use crate::diag::Fault;
use crate::lower::errors::NOT_SUPPORTED;
use crate::{Archive, fault};
use sha2::{Digest, Sha256};
use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;
pub(crate) use units::base;
use variables::Table;

/// What a unit offers.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Kinds {
    /// The importer integrates.
    pub model_exchange: bool,
    /// It integrates itself.
    pub co_simulation: bool,
}

/// A compiled model with what its variables are to others.
pub struct Model<'p> {
    /// The program.
    pub program: &'p Arc<Program>,
    /// The class, with its modification.
    pub name: &'p str,
    /// Its name in the unit.
    pub unit_name: &'p str,
    /// Its description string.
    pub description: Option<&'p str>,
    /// Its inputs by their names: a continuous one is a state whose derivative is zero, with the
    /// parameter that holds its start value; another one is recorded and held.
    pub inputs: BTreeMap<String, Input>,
    /// Parameters that hold the start values of variables, by the names of these.
    pub starts: BTreeMap<String, String>,
    /// Parameters that are not the model's own.
    pub hidden: BTreeSet<String>,
    /// Constants and parameters of type String: a model has to be translated again for another value.
    pub strings: BTreeMap<String, Text>,
    /// What variables measure, by their names.
    pub quantities: BTreeMap<String, String>,
    /// Values of parameters that are not those of the model, by their positions.
    pub values: BTreeMap<usize, f64>,
}

impl Model<'_> {
    /// The value that a parameter begins with.
    fn value(&self, parameter: usize) -> f64 {
        let set = self.values.get(&parameter).copied();
        set.unwrap_or_else(|| self.program.parameters()[parameter].default)
    }

    /// The value of a parameter that importers may set: one with a value of its own, which does not follow
    /// from those of others.
    fn own_value(&self, parameter: usize) -> Option<f64> {
        let follows = || self.program.follows_from_parameters(parameter);
        let is_own = self.values.contains_key(&parameter) || !follows();
        Some(self.value(parameter)).filter(|value| is_own && value.is_finite())
    }
}

/// A constant of type String.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Text {
    /// Its value.
    pub value: String,
    /// What it is, in few words.
    pub description: Option<String>,
}

/// How an input is set.
#[derive(Debug, Clone, PartialEq)]
pub enum Input {
    /// As a state.
    State {
        /// The parameter that holds its start value.
        parameter: String,
        /// This value.
        start: f64,
    },
    /// As a recorded input that begins with this value.
    Recorded(f64),
}

/// The platform of this program: the names of its folders in units of FMI 2.0 and 3.0, and the ending of
/// its shared libraries; `None` for one that the standard does not name.
pub fn platform() -> Option<(&'static str, &'static str, &'static str)> {
    let is_arm = cfg!(target_arch = "aarch64");
    if !is_arm && !cfg!(target_arch = "x86_64") {
        return None;
    }
    if cfg!(target_os = "linux") {
        return Some(match is_arm {
            true => ("aarch64-linux", "aarch64-linux", "so"),
            false => ("linux64", "x86_64-linux", "so"),
        });
    }
    if cfg!(target_os = "macos") {
        return Some(match is_arm {
            true => ("aarch64-darwin", "aarch64-darwin", "dylib"),
            false => ("darwin64", "x86_64-darwin", "dylib"),
        });
    }
    (cfg!(target_os = "windows") && !is_arm).then_some(("win64", "x86_64-windows", "dll"))
}

/// What a unit consists of.
pub struct Unit {
    /// What importers read.
    pub description: Description,
    /// What the runtime reads.
    pub content: Content,
}

impl Unit {
    /// The unit of a model.
    ///
    /// # Errors
    /// The model does what only the simulator of this program can, with the place.
    pub fn new(model: &Model, version: Version, kinds: Kinds) -> Result<Unit, Fault> {
        let table = Table::new(model, version, kinds)?;
        let Some(mut content) = Content::new(model, table.exported(), table.states.clone()) else {
            return Err(fault!(
                NOT_SUPPORTED,
                "`{}` cannot be exported: it calls functions in C, or is too large", model.name;
                help: "write the function in Modelica"
            ));
        };
        let too_large = || fault!(NOT_SUPPORTED, "`{}` is too large to be exported", model.name);
        content.token = token(&content.to_bytes().ok_or_else(too_large)?);
        let description = describe(model, version, kinds, &table, &content);
        Ok(Unit { description, content })
    }

    /// The archive, with the runtime for this platform.
    ///
    /// # Errors
    /// The platform has no name in the standard, or the archive would be too large.
    pub fn archive(&self, runtime: &[u8]) -> Result<Archive, Fault> {
        let of_platform = platform().ok_or_else(|| {
            fault!(NOT_SUPPORTED, "the standard has no name for the platform of this program")
        })?;
        let (two, three, ending) = of_platform;
        let folder = match self.description.version {
            Version::V2 => two,
            Version::V3 => three,
        };
        let interfaces = [&self.description.model_exchange, &self.description.co_simulation];
        let name = interfaces.into_iter().flatten().map(|own| own.model_identifier.as_str());
        let name = name.take(1).collect::<String>();
        let mut archive = Archive::new();
        archive.insert(DESCRIPTION, description::write(&self.description));
        archive.insert(format!("binaries/{folder}/{name}.{ending}"), runtime);
        let content = self.content.to_bytes().ok_or_else(|| {
            fault!(NOT_SUPPORTED, "`{}` is too large to be exported", self.description.model_name)
        })?;
        archive.insert(format!("resources/{FILE}"), content);
        Ok(archive)
    }
}

/// A token that follows from bytes, in the form of a GUID.
fn token(bytes: &[u8]) -> String {
    let digest = Sha256::digest(bytes);
    let hex: String = digest.iter().take(16).map(|byte| format!("{byte:02x}")).collect();
    let parts = [&hex[..8], &hex[8..12], &hex[12..16], &hex[16..20], &hex[20..]];
    format!("{{{}}}", parts.join("-"))
}

/// The name of a class as an identifier in C.
pub fn identifier(name: &str) -> String {
    let class = name.split('(').next().unwrap_or(name).trim();
    let letters = class.chars().map(|c| if c.is_ascii_alphanumeric() { c } else { '_' });
    let identifier: String = letters.collect();
    match identifier.starts_with(|c: char| c.is_ascii_digit()) {
        true => format!("_{identifier}"),
        false => identifier,
    }
}

/// Kinds of messages, each with what it is.
pub(crate) const LOG_CATEGORIES: &[(&str, &str)] = &[
    ("logStatusError", "Why a function has returned an error"),
    ("logStatusWarning", "Warnings of the model: assertions of level warning"),
    ("logEvents", "Events that were handled"),
];

fn describe(
    model: &Model,
    version: Version,
    kinds: Kinds,
    table: &Table,
    content: &Content,
) -> Description {
    let program = model.program;
    let interface = Interface {
        model_identifier: identifier(model.unit_name),
        can_get_and_set_state: true,
        can_serialize_state: program.has_snapshots(),
        provides_directional_derivatives: !program.has_past(),
        provides_adjoint_derivatives: version == Version::V3 && !program.has_past(),
        ..Interface::default()
    };
    let exchange = Interface {
        needs_completed_step: program.checks_steps() || program.has_past(),
        ..interface.clone()
    };
    let co_simulation = Interface {
        can_handle_variable_steps: true,
        has_event_mode: version == Version::V3,
        might_return_early: version == Version::V3,
        ..interface
    };
    let experiment = program.experiment();
    let category = |(name, description): &(&str, &str)| LogCategory {
        name: (*name).to_owned(),
        description: Some((*description).to_owned()),
    };
    let start = experiment.start_time.unwrap_or(0.0);
    Description {
        version,
        model_name: model.unit_name.to_owned(),
        token: content.token.clone(),
        about: About {
            description: model.description.map(str::to_owned),
            generation_tool: Some(concat!("gapilib ", env!("CARGO_PKG_VERSION")).to_owned()),
            ..About::default()
        },
        has_structured_names: table.has_structured_names(),
        model_exchange: kinds.model_exchange.then_some(exchange),
        co_simulation: kinds.co_simulation.then_some(co_simulation),
        units: units::units(table.variables.iter().map(|(variable, _)| variable)),
        types: variables::enumerations(program, table),
        log_categories: LOG_CATEGORIES.iter().map(category).collect(),
        experiment: DefaultExperiment {
            start: Some(start),
            stop: Some(experiment.stop_time.unwrap_or(start + 1.0)),
            tolerance: Some(content.tolerance),
            step: experiment.interval.filter(|step| *step > 0.0),
        },
        variables: table.variables.iter().map(|(variable, _)| variable.clone()).collect(),
        structure: structure::structure(program, table, version),
        event_indicators: if version == Version::V2 { table.n_indicators } else { 0 },
        ..Description::default()
    }
}
