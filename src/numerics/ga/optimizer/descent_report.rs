//! What a descent of least squares reports: where it started, where it stands, how it ended.

use serde::{Deserialize, Serialize};

/// How a descent ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum DescentEnd {
    /// At a minimum: the test of Bates and Watts holds.
    Minimum,
    /// On the way to a minimum that another descent has reached: its residuals are those that the
    /// linear model about this minimum predicts. The report says where this minimum is.
    Joined,
    /// Its steps were used up, or the search ended before it did.
    StepLimit,
    /// No step reduces the sum of squares beyond the errors of the simulation.
    NoDescent,
    /// Nothing that is varied has an effect there.
    Flat,
    /// Its start could not be simulated.
    Failed,
}

impl DescentEnd {
    /// Whether the descent leads to a minimum.
    pub fn is_at_minimum(self) -> bool {
        matches!(self, DescentEnd::Minimum | DescentEnd::Joined)
    }
}

/// One descent.
#[derive(Debug, Clone, PartialEq)]
pub struct DescentReport {
    /// Where it started and where it ended, in the unit cube.
    pub start: Vec<f64>,
    /// Where it stands.
    pub end: Vec<f64>,
    /// The sum of squares there.
    pub objective: f64,
    /// How it ended.
    pub ending: DescentEnd,
    /// The relative offset there, where there are degrees of freedom.
    pub offset: Option<f64>,
    /// Steps tried.
    pub steps: u64,
    /// The number of the end: descents that ended at the same place share it; 0 is the best.
    pub group: usize,
}
