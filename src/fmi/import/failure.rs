//! How a simulation of a unit fails.

use crate::sim::Statistics;
use serde::{Deserialize, Serialize};

/// Why a simulation failed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum FailureClass {
    /// The unit makes no instance.
    Instance,
    /// The unit reports an error.
    Unit,
    /// The solver did not get through.
    Solver,
    /// More steps than allowed.
    Steps,
    /// More time on the clock than allowed.
    Time,
    /// It was cancelled.
    Cancelled,
    /// Nothing tells how derivatives continue.
    Derivatives,
    /// The process of the unit ended, or a call of it did not.
    Process,
    /// Calls did not end in so many simulations that no other is worth its time.
    Hopeless,
}

/// A failed simulation.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct SimulationFailure {
    /// The time reached, seconds.
    pub time: f64,
    /// Why.
    pub class: FailureClass,
    /// Why, in one sentence without the time.
    pub message: String,
    /// What it cost until then.
    pub statistics: Box<Statistics>,
}

impl SimulationFailure {
    /// A failure before any cost.
    pub fn new(time: f64, class: FailureClass, message: String) -> SimulationFailure {
        SimulationFailure { time, class, message, statistics: Box::default() }
    }
}
