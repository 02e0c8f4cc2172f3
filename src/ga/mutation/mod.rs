//! Mutation: random changes of genes.

mod polynomial;
mod uniform;

pub use polynomial::polynomial;
pub use uniform::{check_factor, mutate_uniform};

use super::{Gene, Genomes};
use crate::registry::Entry;

/// Changes genes at random.
pub trait Mutation: Send + Sync {
    /// Changes `genomes` in place. `numbers` are uniform in 0 < u < 1, one for each gene of each
    /// individual, row by row.
    fn mutate(&self, genomes: &mut Genomes, genes: &[Gene], factor: f64, numbers: &[f64]);
}

/// All ways of mutation.
pub const MUTATIONS: &[&Entry<dyn Mutation>] = &[&uniform::ENTRY];
