//! Identification: simulates whole populations, compares them with measured data, and says at the
//! end what was found and what the data cannot tell.

pub mod errors;
pub mod fitness;

mod outcome;
mod points;
mod recorder;
mod table;
mod uncertainty;

pub use outcome::{Correlated, FitPoint, Identified, Outcome};
pub use points::{Path, time_of};
pub use recorder::{Best, FitnessSource, Measurement, Quantity, Recorder, Study};
pub use uncertainty::{Uncertainty, uncertainty};
