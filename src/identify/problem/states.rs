//! States of a model that data tell of.

use serde::{Deserialize, Serialize};

/// A state as a filter and a smoother have found it.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct SolvedState {
    /// The experiment.
    pub experiment: String,
    /// The variable and its unit.
    pub y: [String; 2],
    /// Time, the estimate from the measurements up to then and its standard deviation, the estimate from
    /// all measurements and its standard deviation.
    pub points: Vec<[f64; 5]>,
}
