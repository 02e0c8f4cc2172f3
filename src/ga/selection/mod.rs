//! Selection: who becomes a parent.

mod tournament;
mod truncation;

pub use tournament::tournament;
pub use truncation::check_sizes;

use super::Mrg32k3a;
use crate::registry::Entry;

/// Chooses parents from an ordered population.
pub trait Selection: Send + Sync {
    /// Ranks (from 0, best first) of `n_parents` parents, in the order in which they mate.
    fn select(&self, n_individuals: usize, n_parents: usize, rng: &mut Mrg32k3a) -> Vec<usize>;
}

/// All ways of selection.
pub const SELECTIONS: &[&Entry<dyn Selection>] = &[&truncation::ENTRY];
