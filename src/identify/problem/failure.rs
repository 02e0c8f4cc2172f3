//! Failed simulations: individuals, not ends.

use crate::ga::FAILED_FITNESS;
use serde::{Deserialize, Serialize};

/// What kind of failure it was.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
pub enum FailureKind {
    /// The model refuses these values: an assertion, a logarithm of a negative number.
    Model,
    /// The solver did not get through: no convergence, steps too small.
    Solver,
    /// It took too many steps.
    Budget,
    /// It ended, but points are missing or not finite.
    Points,
}

impl FailureKind {
    /// All kinds, in the order of their numbers in the journal.
    pub const ALL: [FailureKind; 4] =
        [FailureKind::Model, FailureKind::Solver, FailureKind::Budget, FailureKind::Points];

    /// Its name in reports.
    pub fn name(self) -> &'static str {
        match self {
            FailureKind::Model => "model",
            FailureKind::Solver => "solver",
            FailureKind::Budget => "budget",
            FailureKind::Points => "points",
        }
    }
}

/// A failed simulation.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Failed {
    /// What kind.
    pub kind: FailureKind,
    /// Why, in one sentence.
    pub cause: String,
    /// How far it got, 0 to 1.
    pub progress: f64,
}

impl Failed {
    /// Worse than every success; among failures, the better the further they got.
    pub fn fitness(&self) -> f64 {
        FAILED_FITNESS * (2.0 - self.progress.clamp(0.0, 1.0))
    }
}
