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
    /// It did not end, as so many before it that the search ends.
    Hopeless,
}

impl FailureKind {
    /// All kinds, in the order of their numbers in the journal.
    pub const ALL: [FailureKind; 5] = [
        FailureKind::Model,
        FailureKind::Solver,
        FailureKind::Budget,
        FailureKind::Points,
        FailureKind::Hopeless,
    ];

    /// Its name in reports.
    pub fn name(self) -> &'static str {
        match self {
            FailureKind::Model => "model",
            FailureKind::Solver => "solver",
            FailureKind::Budget => "budget",
            FailureKind::Points => "points",
            FailureKind::Hopeless => "no end",
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
    /// When it failed, in simulated time; `None` where the whole simulation is of no use.
    pub at: Option<f64>,
}

impl Failed {
    /// A failure at no particular time.
    pub fn new(kind: FailureKind, cause: impl Into<String>, progress: f64) -> Failed {
        Failed { kind, cause: cause.into(), progress, at: None }
    }

    /// Worse than every success; among failures, the better the further they got.
    pub fn fitness(&self) -> f64 {
        FAILED_FITNESS * (2.0 - self.progress.clamp(0.0, 1.0))
    }
}

impl std::fmt::Display for Failed {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self.at {
            Some(time) => {
                // Six digits say when; the rest is the solver's.
                let time: f64 = format!("{time:.5e}").parse().unwrap_or(time);
                write!(f, "{} (at {time} s)", self.cause)
            }
            None => f.write_str(&self.cause),
        }
    }
}
