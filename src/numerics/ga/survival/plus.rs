//! (μ + λ) selection: a generation of μ and its λ `offspring` compete, the best μ survive. Of
//! individuals with the same genes one survives.
//!
//! Reference: [Beyer & Schwefel 2002](gapilib_base::bibliography#beyer-schwefel-2002).

use super::{Brood, Sizes, Survival, Survivor};
use crate::diag::Fault;
use crate::registry::Entry;

/// The table entry.
pub(crate) const ENTRY: Entry<dyn Survival> = Entry {
    name: "mu_plus_lambda",
    aliases: &["plus", "mu+lambda"],
    summary: "the best of the generation and its `offspring` (0: as many as the population)",
    reference: "beyer-schwefel-2002",
    make: |options| {
        Ok(Box::new(Plus { offspring: options.take_whole("offspring", 0.0..=1e6, 0.0)? }))
    },
};

struct Plus {
    /// 0 for as many as the population.
    offspring: usize,
}

impl Survival for Plus {
    fn n_offspring(&self, sizes: Sizes) -> usize {
        if self.offspring == 0 { sizes.population } else { self.offspring }
    }

    fn survivors(&self, brood: &Brood<'_>, sizes: Sizes) -> Result<Vec<Survivor>, Fault> {
        let old = (0..brood.old.fitness.len()).map(Survivor::Old);
        Ok(brood.best(old.chain(brood.offspring()).collect(), sizes.population))
    }
}
