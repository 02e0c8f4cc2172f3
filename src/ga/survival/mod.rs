//! Survival: who makes up the next generation.

mod elitism;

pub use elitism::elites_first;

use super::Genomes;
use crate::registry::Entry;

/// Puts the next generation together.
pub trait Survival: Send + Sync {
    /// The next generation from the ordered old one and the offspring.
    fn survive(&self, ordered: &Genomes, elites: usize, offspring: &Genomes) -> Genomes;
}

/// All ways of survival.
pub const SURVIVALS: &[&Entry<dyn Survival>] = &[&elitism::ENTRY];
