//! Sampling: how the first generation is drawn, and other random individuals.

mod halton;
mod latin_hypercube;
mod own;
mod sobol;
mod uniform;

pub use latin_hypercube::latin_hypercube;
pub(crate) use own::SIGNATURE;
pub use own::{Own, sample_by};
pub use sobol::sobol;

use super::{Gene, Genomes, Mrg32k3a};
use crate::diag::Fault;
use crate::registry::Entry;

/// Makes random individuals.
pub trait Sampling: Send + Sync {
    /// `count` random individuals within the ranges of `genes`.
    ///
    /// # Errors
    ///
    /// A user's function that failed or did not return genes.
    fn sample(&self, genes: &[Gene], count: usize, rng: &mut Mrg32k3a) -> Result<Genomes, Fault>;
}

/// All ways of sampling.
pub(crate) const SAMPLINGS: &[&Entry<dyn Sampling>] =
    &[&latin_hypercube::ENTRY, &uniform::ENTRY, &sobol::ENTRY, &halton::ENTRY];

/// Individuals of the unit cube in the ranges of the genes.
fn scaled(mut genomes: Genomes, genes: &[Gene]) -> Genomes {
    for k in 0..genomes.len() {
        for (value, gene) in genomes.row_mut(k).iter_mut().zip(genes) {
            *value = gene.at(*value);
        }
    }
    genomes
}
