//! Identification: simulates whole populations, compares them with measured data, and says at the
//! end what was found and what the data cannot tell.

pub mod errors;
pub mod fitness;
pub mod problem;

mod evaluation;
#[cfg(test)]
mod evaluation_tests;
mod model;
mod outcome;
mod points;
#[cfg(test)]
mod problems;
mod program;
mod recorder;
mod report;
mod sensitivity;
mod table;
mod uncertainty;

pub use evaluation::{Evaluator, FailedSimulation, Question, Simulated};
pub use model::{Instance, Model, Parameter};
pub use outcome::{Correlated, FitPoint, Identified, Outcome};
pub use points::{Path, time_of};
pub use program::CompiledModel;
pub use recorder::{Best, FitnessSource, Measurement, Quantity, Recorder, Study};
pub use sensitivity::deviations;
pub use uncertainty::{Uncertainty, uncertainty, uncertainty_given};
