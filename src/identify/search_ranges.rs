//! Which search a range belongs to: operators are given ranges and return individuals, and the search
//! that simulates these has the ranges.

use super::generation::key;
use super::script_search::ScriptSearch;
use crate::ga::Genomes;
use rustc_hash::FxHashSet;

/// Pairs of minima and maxima remembered; a script has one for each of its searches.
const REMEMBERED: usize = 40;
/// Individuals remembered of each; a population of the largest scripts has some thousands.
const INDIVIDUALS: usize = 10_000;

/// The ranges that operators were given.
#[derive(Debug, Clone, Default)]
pub(super) struct SearchRanges {
    /// Those given last are the last.
    given: Vec<Given>,
}

#[derive(Debug, Clone)]
struct Given {
    minima: Vec<f64>,
    maxima: Vec<f64>,
    /// The individuals that were made with them.
    made: FxHashSet<u64>,
    /// The number of generations of the run before they were given last.
    generation: u64,
}

impl SearchRanges {
    /// An operator that was given these ranges has made some individuals.
    pub fn given(&mut self, [minima, maxima]: [&[f64]; 2], made: &Genomes, generation: u64) {
        let same = |one: &Given| one.minima == minima && one.maxima == maxima;
        let mut own = match self.given.iter().position(same) {
            Some(place) => self.given.remove(place),
            None => Given {
                minima: minima.to_vec(),
                maxima: maxima.to_vec(),
                made: FxHashSet::default(),
                generation,
            },
        };
        if own.generation < generation || own.made.len() > INDIVIDUALS {
            own.made.clear();
        }
        own.generation = generation;
        own.made.extend(made.rows().map(key));
        self.given.push(own);
        if self.given.len() > REMEMBERED {
            self.given.remove(0);
        }
    }

    /// Gives a search the ranges that these individuals, its last generation, were made with: where
    /// a script has changed all of them since, as by rounding, the last ones that were given since
    /// the search began and that contain them.
    pub fn assign<'a>(
        &self,
        search: &mut ScriptSearch,
        individuals: impl Iterator<Item = &'a [f64]> + Clone,
    ) {
        let made = |own: &&Given| individuals.clone().any(|genes| own.made.contains(&key(genes)));
        let since = search.generations_of_run[0];
        let contain = |own: &&Given| {
            own.generation >= since && individuals.clone().all(|genes| own.contains(genes))
        };
        let all = || self.given.iter().rev();
        if let Some(own) = all().find(made).or_else(|| all().find(contain)) {
            search.extend_ranges(&own.minima, &own.maxima);
        }
    }
}

impl Given {
    fn contains(&self, genes: &[f64]) -> bool {
        let within = |k: usize| self.minima[k] <= genes[k] && genes[k] <= self.maxima[k];
        genes.len() == self.minima.len() && (0..genes.len()).all(within)
    }
}
