//! Identification: simulates whole populations, compares them with measured data, and says at the
//! end what was found and what the data cannot tell.

#![cfg_attr(test, allow(clippy::disallowed_methods, reason = "expectations of tests"))]

// Modules and macros of lower crates, under the names that they have there.
pub(crate) use gapilib_base::{
    bail, codes, diag, elementary, fault, page, plot, registry, singular_values, source, units,
};
pub(crate) use gapilib_fmi as fmi;
pub(crate) use gapilib_modelica::{codegen, runtime};
pub(crate) use gapilib_numerics::{frequency, ga, results, sim};

pub mod errors;
pub mod fitness;
pub mod problem;
pub mod ranks;

mod descriptions;
mod evaluation;
#[cfg(test)]
mod evaluation_tests;
mod generation;
mod imported;
mod model;
mod objective;
mod plan;
mod points;
mod pointwise;
mod probe;
#[cfg(test)]
mod problems;
mod program;
mod recorder;
mod report;
mod script_search;
mod search_ranges;
mod search_record;
mod seeds;
mod simulators;
mod spectrum;
mod study;
mod table;
mod uncertainty;

pub use descriptions::Descriptions;
pub use evaluation::{Evaluator, Question, Simulated};
pub use generation::Tally;
pub use imported::ImportedModel;
pub use model::{Instance, Model, Parameter, PortableModel, Spectrum};
pub use objective::Objective;
pub use points::{Path, time_of};
pub use probe::{Ending, Probe};
pub use program::CompiledModel;
pub use recorder::Recorder;
pub use script_search::{ScriptBest, ScriptSearch};
pub use search_record::{Failures, SearchRecord};
pub use spectrum::{FREQUENCY, PARTS, SpectrumModel};
pub use study::{Compared, Measurement, Quantity, Study};
pub use table::significant;
pub use uncertainty::{Uncertainty, uncertainty};
pub(crate) use uncertainty::{error_of_combination, uncertainty_given};
