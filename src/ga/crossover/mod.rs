//! Crossover: how parents make children.

mod one_point;
mod sbx;

pub use one_point::{check_points, cross_adjacent};
pub use sbx::sbx;

use super::Genomes;
use crate::registry::Entry;

/// Makes children from parents.
pub trait Crossover: Send + Sync {
    /// One child for each parent, parents in the order in which they mate; `points` are the
    /// crossing points of the run.
    fn cross(&self, parents: &Genomes, points: &[usize]) -> Genomes;
}

/// All ways of crossover.
pub const CROSSOVERS: &[&Entry<dyn Crossover>] = &[&one_point::ENTRY];
