//! What ranks say to each other.

use super::simulation::{Asked, Batch, Simulation};
use crate::problem::Portable;
use serde::{Deserialize, Serialize};

/// A rank, as it introduces itself.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct About {
    /// Tells its program from another version or build.
    pub version: String,
    /// The machine that it runs on.
    pub host: String,
    /// Threads that simulate.
    pub threads: usize,
}

/// From rank 0 to another one.
#[derive(Debug, Serialize, Deserialize)]
pub(super) enum Order {
    /// Make simulators, known by this number from now on.
    Prepare { number: u64, simulator: Portable },
    /// Simulate these individuals.
    Work(Work),
    /// Work up to this ticket is no longer needed.
    Cancel { ticket: u64 },
    /// These simulators are not needed any more.
    Forget { number: u64 },
    /// The job is over.
    End,
}

/// Individuals for a rank.
#[derive(Debug, Serialize, Deserialize)]
pub(super) struct Work {
    /// Tells the chunk from all others.
    pub(crate) ticket: u64,
    /// The simulators to use.
    pub number: u64,
    /// As in [`Batch`].
    pub values: Vec<f64>,
    pub parameters: usize,
    pub points: usize,
    pub asked: Asked,
    pub tolerance: f64,
}

impl Work {
    pub fn batch(&self) -> Batch<'_> {
        Batch {
            values: &self.values,
            parameters: self.parameters,
            points: self.points,
            asked: self.asked,
            tolerance: self.tolerance,
        }
    }
}

/// From another rank to rank 0.
#[derive(Debug, Serialize, Deserialize)]
pub(super) enum Report {
    /// It has started.
    Ready(About),
    /// The simulators of this number are ready, or why they cannot be made.
    Prepared { number: u64, refusal: Option<String> },
    /// Answers in the order of the work, and the seconds that they took; none where the work was
    /// cancelled.
    Done { ticket: u64, seconds: f64, simulations: Vec<Simulation> },
    /// The system has asked this rank to end.
    Stop,
}

/// A message as bytes. Numbers keep their bits.
pub(super) fn encode<T: Serialize>(message: &T) -> Vec<u8> {
    // Numbers, strings and lists of known length: nothing that could not be written.
    postcard::to_allocvec(message).unwrap_or_default()
}

/// `None` where the bytes are not such a message, as those of another version.
pub(super) fn decode<T: for<'de> Deserialize<'de>>(bytes: &[u8]) -> Option<T> {
    postcard::from_bytes(bytes).ok()
}
