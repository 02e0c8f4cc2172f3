//! Sampling: how random individuals are made.

mod latin_hypercube;
mod sobol;
mod uniform;

pub use latin_hypercube::latin_hypercube;
pub use sobol::{SOBOL_GENES, sobol};
pub use uniform::sample_uniform;

use super::{Gene, Genomes, Mrg32k3a};
use crate::registry::Entry;

/// Makes random individuals.
pub trait Sampling: Send + Sync {
    /// `count` random individuals within the ranges of `genes`.
    fn sample(&self, genes: &[Gene], count: usize, rng: &mut Mrg32k3a) -> Genomes;
}

/// All ways of sampling.
pub const SAMPLINGS: &[&Entry<dyn Sampling>] =
    &[&uniform::ENTRY, &latin_hypercube::ENTRY, &sobol::ENTRY];
