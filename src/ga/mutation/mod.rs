//! Mutation: random changes of genes.

mod gaussian;
mod non_uniform;
mod own;
mod polynomial;
mod uniform;

pub use own::{Own, SIGNATURE, mutate_by};
pub use uniform::{check_factor, mutate_uniform};

use super::{Gene, Mrg32k3a};
use crate::diag::Fault;
use crate::registry::Entry;

/// Changes genes at random.
pub trait Mutation: Send + Sync {
    /// Changes each gene of `genome` with the probability `rate`, within the ranges of `genes`.
    ///
    /// # Errors
    ///
    /// A user's function that failed or returned what are no genes.
    fn mutate(
        &self,
        genome: &mut [f64],
        genes: &[Gene],
        rate: f64,
        course: Course,
        rng: &mut Mrg32k3a,
    ) -> Result<(), Fault>;
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
pub const MUTATIONS: &[&Entry<dyn Mutation>] =
    &[&polynomial::ENTRY, &gaussian::ENTRY, &uniform::ENTRY, &non_uniform::ENTRY];
