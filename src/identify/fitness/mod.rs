//! Fitness functions: how far the simulation is from the measurement; smaller is better.

mod sum_of_squares;

pub use sum_of_squares::sum_of_squares;

use crate::registry::Entry;

/// Compares one simulation with the measurement.
pub trait Fitness: Send + Sync {
    /// Zero for equal series; [`FAILED_FITNESS`](crate::ga::FAILED_FITNESS) where a simulated
    /// value is not a number. Both slices have the same length.
    fn fitness(&self, simulated: &[f64], measured: &[f64]) -> f64;
}

/// All fitness functions.
pub const FITNESSES: &[&Entry<dyn Fitness>] = &[&sum_of_squares::ENTRY];
