//! Survival (replacement): who makes up the next generation.

mod crowding;
mod elitism;
mod generational;
mod own;
mod plus;

pub use elitism::elites_first;
pub(crate) use own::SIGNATURE;
pub use own::{Own, survivors_by};

use super::{Gene, Genomes};
use crate::diag::Fault;
use crate::registry::Entry;

/// Individuals with their fitness.
#[derive(Debug, Clone, Copy)]
pub struct Rated<'a> {
    /// Their genes.
    pub genomes: &'a Genomes,
    /// Their fitness, of which a smaller one is better.
    pub fitness: &'a [f64],
}

/// A generation and its offspring.
#[derive(Debug, Clone, Copy)]
pub struct Brood<'a> {
    /// The generation.
    pub old: Rated<'a>,
    /// How many generations each of it has survived.
    pub ages: &'a [u64],
    /// Its offspring; the two children of a pair stand side by side.
    pub offspring: Rated<'a>,
    /// The parents of each of the offspring: places in the generation.
    pub parents: &'a [[usize; 2]],
    /// The ranges, for distances.
    pub genes: &'a [Gene],
}

/// One that lives on.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Survivor {
    /// This one of the old generation.
    Old(usize),
    /// This one of the offspring.
    Offspring(usize),
}

/// Sizes of the next generation.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Sizes {
    /// Individuals of a generation.
    pub population: usize,
    /// Individuals that pass on unaltered, where the way of survival has those.
    pub elites: usize,
}

/// Puts the next generation together.
pub trait Survival: Send + Sync {
    /// How many offspring a generation has.
    fn n_offspring(&self, sizes: Sizes) -> usize {
        sizes.population
    }

    /// The next generation.
    ///
    /// # Errors
    ///
    /// A user's function that failed or did not return numbers.
    fn survivors(&self, brood: &Brood<'_>, sizes: Sizes) -> Result<Vec<Survivor>, Fault>;

    /// Whether the number of elites counts.
    fn has_elites(&self) -> bool {
        false
    }

    /// Whether the population can be resized during a run.
    fn can_resize(&self) -> bool {
        true
    }

    /// Whether offspring are compared with their own parents.
    fn needs_parents(&self) -> bool {
        false
    }

    /// The selection that goes with it where the user has chosen none.
    fn usual_selection(&self) -> &'static str {
        "tournament"
    }
}

/// All ways of survival.
pub(crate) const SURVIVALS: &[&Entry<dyn Survival>] =
    &[&elitism::ENTRY, &generational::ENTRY, &plus::ENTRY, &crowding::ENTRY];

impl Brood<'_> {
    /// The genes of a survivor.
    pub fn genome(&self, survivor: Survivor) -> &[f64] {
        match survivor {
            Survivor::Old(k) => self.old.genomes.row(k),
            Survivor::Offspring(k) => self.offspring.genomes.row(k),
        }
    }

    /// The fitness of a survivor.
    pub fn fitness(&self, survivor: Survivor) -> f64 {
        match survivor {
            Survivor::Old(k) => self.old.fitness[k],
            Survivor::Offspring(k) => self.offspring.fitness[k],
        }
    }

    /// The best of these, each genome with its fitness once, best first; of equals the earlier.
    fn best(&self, mut candidates: Vec<Survivor>, count: usize) -> Vec<Survivor> {
        let key = |one: Survivor| match self.fitness(one) {
            fitness if fitness.is_nan() => f64::INFINITY,
            fitness => fitness,
        };
        candidates.sort_by(|a, b| key(*a).total_cmp(&key(*b)));
        let mut best: Vec<Survivor> = Vec::with_capacity(count);
        for one in candidates {
            let is_last = |last: &Survivor| {
                self.fitness(*last) == self.fitness(one) && self.genome(*last) == self.genome(one)
            };
            if best.len() < count && !best.last().is_some_and(is_last) {
                best.push(one);
            }
        }
        best
    }

    fn offspring(&self) -> impl Iterator<Item = Survivor> {
        (0..self.offspring.fitness.len()).map(Survivor::Offspring)
    }
}

#[cfg(test)]
mod tests;
