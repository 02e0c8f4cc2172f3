//! Mutation: random changes of genes.

mod gaussian;
mod non_uniform;
mod own;
mod polynomial;
mod uniform;

pub use own::{Own, mutate_by};

pub(crate) use own::SIGNATURE;
pub use uniform::{check_factor, mutate_uniform};

use super::{Gene, Mrg32k3a};
use crate::diag::Fault;
use crate::registry::Entry;

/// A genome that is mutated in place.
pub struct Child<'a> {
    /// The genome.
    pub genome: &'a mut [f64],
    /// The genes with their ranges.
    pub genes: &'a [Gene],
    /// The probability that a gene changes.
    pub rate: f64,
    /// How far the run has come.
    pub course: Course,
}

impl Child<'_> {
    /// Replaces each gene with the probability of the child; `change` gives the new value.
    fn change(self, rng: &mut Mrg32k3a, mut change: impl FnMut(f64, &Gene, &mut Mrg32k3a) -> f64) {
        for (value, gene) in self.genome.iter_mut().zip(self.genes) {
            if rng.uniform() < self.rate {
                *value = change(*value, gene, rng);
            }
        }
    }
}

/// Changes genes at random.
pub trait Mutation: Send + Sync {
    /// Changes each gene with the probability of the child, within its range.
    ///
    /// # Errors
    ///
    /// A user's function that failed or did not return genes.
    fn mutate(&self, child: Child, rng: &mut Mrg32k3a) -> Result<(), Fault>;
}

/// How far a run is, for mutations that change with it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Course {
    /// Generations bred before.
    pub generation: u64,
    /// Generations that the run is to have, where that is known.
    pub planned: Option<f64>,
}

/// Generations that a run is taken to have where nothing is known of it.
const USUAL_GENERATIONS: f64 = 100.0;

impl Course {
    /// The part of the run that is over, 0 to 1.
    pub fn fraction(&self) -> f64 {
        self.of(self.planned.unwrap_or(USUAL_GENERATIONS))
    }

    /// The part of so many generations that is over, 0 to 1.
    fn of(&self, generations: f64) -> f64 {
        (self.generation as f64 / generations.max(1.0)).min(1.0)
    }
}

/// All ways of mutation.
pub(crate) const MUTATIONS: &[&Entry<dyn Mutation>] =
    &[&polynomial::ENTRY, &gaussian::ENTRY, &uniform::ENTRY, &non_uniform::ENTRY];
