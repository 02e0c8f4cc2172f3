//! One generation, put together from the events of a trace.

use super::event::ScriptLine;
use super::operation::Operation;

/// How an individual came into its generation.
#[derive(Debug, Clone, PartialEq)]
pub enum Origin {
    /// An elite of the generation before, unaltered.
    Elite {
        /// Its index there.
        from: usize,
    },
    /// A child of two parents of the generation before.
    Child {
        /// The parent whose genes stand before the first crossing point: its index there.
        parent: usize,
        /// The parent of the exchanged genes.
        mate: usize,
        /// Which genes mutated afterwards, from 0.
        mutated: Vec<usize>,
    },
    /// Drawn at random.
    Random,
    /// The script set its genes in its own way.
    Script,
}

/// The mutation of a generation.
#[derive(Debug, Clone, PartialEq)]
pub struct Mutated {
    /// Where it was called.
    pub place: ScriptLine,
    /// Elites and children before it, row by row.
    pub before: Vec<f64>,
    /// The same after it.
    pub after: Vec<f64>,
    /// One number for each gene.
    pub numbers: Vec<f64>,
    /// The state of the generator before the last draw, which usually gave these numbers.
    pub seed: Option<[f64; 6]>,
    /// Number of elites, which stay.
    pub elites: usize,
    /// The probability that a gene mutates.
    pub factor: f64,
    /// Lower ends of the search ranges.
    pub minima: Vec<f64>,
    /// Upper ends of the search ranges.
    pub maxima: Vec<f64>,
}

/// The crossover of a generation.
#[derive(Debug, Clone, PartialEq)]
pub struct Crossed {
    /// Where it was called.
    pub place: ScriptLine,
    /// Number of parents.
    pub parents: usize,
    /// Number of elites.
    pub elites: usize,
    /// The crossing points.
    pub points: Vec<usize>,
    /// Elites and children, row by row.
    pub rows: Vec<f64>,
}

impl Crossed {
    /// Which of `n_genes` genes the parents exchange: after an even number of points they are back
    /// in place.
    pub(crate) fn exchanged(&self, n_genes: usize) -> Vec<bool> {
        let points = |j: usize| self.points.iter().filter(|&&point| point <= j).count();
        (0..n_genes).map(|j| points(j) % 2 == 1).collect()
    }
}

/// The order of a generation.
#[derive(Debug, Clone, PartialEq)]
pub struct Sorted {
    /// Where it was called.
    pub place: ScriptLine,
    /// Indices of the individuals, best first.
    pub order: Vec<usize>,
    /// Number of parents.
    pub parents: usize,
    /// Number of elites.
    pub elites: usize,
}

/// Random numbers that were drawn in one call.
#[derive(Debug, Clone, PartialEq)]
pub struct Drawn {
    /// Where it was called.
    pub place: ScriptLine,
    /// The state of the generator before them.
    pub seed: [f64; 6],
    /// The numbers.
    pub numbers: Vec<f64>,
}

/// How far a generation had come when an operator was called by name.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Part {
    /// Nothing was simulated yet.
    Opening,
    /// It was simulated.
    Simulated,
    /// `Fit_Order` had sorted it.
    Sorted,
    /// `Cross` had made children.
    Crossed,
    /// `Mutation` had changed them.
    Mutated,
}

/// A call of an operator by name within a generation.
#[derive(Debug, Clone, PartialEq)]
pub struct Called {
    /// When.
    pub part: Part,
    /// What.
    pub operation: Operation,
}

/// One generation: who was simulated, how good they are, and what became of them.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Generation {
    /// Whether nothing was simulated: operators were called on individuals that the script made.
    pub is_call: bool,
    /// Whether individuals were simulated that no selection, crossover or mutation follows: the
    /// script searches in another way, or tries single values.
    pub is_evaluation: bool,
    /// The calls of operators by name; where there is nothing else, all the rest is empty, but for
    /// the number of genes.
    pub operations: Vec<Called>,
    /// The random numbers drawn before it was simulated and after the one before was mutated: the
    /// initial population, or its random completion.
    pub drawn: Vec<Drawn>,
    /// Number of genes of each individual.
    pub n_genes: usize,
    /// The genes, row by row, in the order of the simulation.
    pub genes: Vec<f64>,
    /// How each individual came here.
    pub origins: Vec<Origin>,
    /// Where they were simulated.
    pub simulated: ScriptLine,
    /// Why simulations failed: indices from 0.
    pub failures: Vec<(usize, String)>,
    /// Their fitness, if it is known; smaller is better.
    pub fitness: Vec<f64>,
    /// How often they were compared with measurements once more: with others, perhaps.
    pub(crate) more_ratings: usize,
    /// Where it was computed.
    pub rated: Option<ScriptLine>,
    /// Simulated Y of the best individual at every measured point; empty where it is not known.
    pub(crate) best_simulated: Vec<f64>,
    /// Their order.
    pub sorted: Option<Sorted>,
    /// The crossover.
    pub crossed: Option<Crossed>,
    /// The mutation.
    pub mutated: Option<Mutated>,
}

impl Generation {
    /// Number of individuals.
    pub fn len(&self) -> usize {
        self.genes.len().checked_div(self.n_genes).unwrap_or(0)
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.genes.is_empty()
    }

    /// How far it has come.
    pub(super) fn part(&self) -> Part {
        match (&self.sorted, &self.crossed, &self.mutated) {
            (_, _, Some(_)) => Part::Mutated,
            (_, Some(_), None) => Part::Crossed,
            (Some(_), None, None) => Part::Sorted,
            (None, None, None) => Part::Simulated,
        }
    }

    /// Whether it begins with individuals that were drawn at random.
    pub(super) fn is_drawn(&self) -> bool {
        !self.is_call
            && !self.drawn.is_empty()
            && self.origins.contains(&Origin::Random)
            && !self.has_parents()
    }

    /// The numbers that were drawn last, one for each gene; `None` where there were fewer.
    pub(super) fn numbers_of_genes(&self) -> Option<Vec<f64>> {
        let numbers: Vec<f64> =
            self.drawn.iter().flat_map(|drawn| &drawn.numbers).copied().collect();
        let first = numbers.len().checked_sub(self.genes.len())?;
        Some(numbers[first..].to_vec())
    }

    /// Whether some of them came out of the generation before.
    pub(crate) fn has_parents(&self) -> bool {
        let is_offspring =
            |origin: &Origin| matches!(origin, Origin::Elite { .. } | Origin::Child { .. });
        self.origins.iter().any(is_offspring)
    }

    /// The genes of individual `k`, from 0.
    pub fn genome(&self, k: usize) -> &[f64] {
        &self.genes[k * self.n_genes..(k + 1) * self.n_genes]
    }

    /// Why the simulation of individual `k` failed.
    pub fn failure(&self, k: usize) -> Option<&str> {
        self.failures.iter().find(|(at, _)| *at == k).map(|(_, cause)| cause.as_str())
    }

    /// The best individual and its fitness.
    pub fn best(&self) -> Option<(usize, f64)> {
        let order = crate::ga::order(&self.fitness);
        let k = order.into_iter().find(|&k| k < self.len())?;
        Some((k, self.fitness[k]))
    }

    /// The ranks of all individuals, from 0; by fitness where nothing sorted them.
    pub fn order(&self) -> Vec<usize> {
        let order = match &self.sorted {
            Some(sorted) => sorted.order.clone(),
            // `Cross` alone is given individuals that are sorted already.
            None if self.is_call => (0..self.len()).collect(),
            None => crate::ga::order(&self.fitness),
        };
        // A script may have judged others than those of this generation.
        order.into_iter().filter(|&k| k < self.len()).collect()
    }

    /// The numbers that placed the genes of individual `k`, which completes this generation at
    /// random; `None` where as many were not drawn for those who do.
    pub(crate) fn random_numbers(&self, k: usize) -> Option<Vec<f64>> {
        let random = |origin: &&Origin| **origin == Origin::Random;
        let before = self.origins.get(..k)?.iter().filter(random).count();
        let all = self.origins.iter().filter(random).count();
        let numbers: Vec<f64> =
            self.drawn.iter().flat_map(|drawn| &drawn.numbers).copied().collect();
        let own = before * self.n_genes..(before + 1) * self.n_genes;
        (numbers.len() == all * self.n_genes).then(|| numbers.get(own).map(<[f64]>::to_vec))?
    }

    /// What replaces individual `k` of the generation before: its copy as elite, or its first
    /// child.
    pub fn successor(&self, k: usize) -> Option<usize> {
        let copy = |origin: &Origin| matches!(origin, Origin::Elite { from } if *from == k);
        let child =
            |origin: &Origin| matches!(origin, Origin::Child { parent, .. } if *parent == k);
        let origins = &self.origins;
        origins.iter().position(copy).or_else(|| origins.iter().position(child))
    }

    /// How the individuals of `next` came out of this generation.
    pub(super) fn origins_of(&self, next: &[f64]) -> Vec<Origin> {
        let n = self.n_genes.max(1);
        let order = self.order();
        next.chunks_exact(n).enumerate().map(|(k, row)| self.origin(k, row, &order)).collect()
    }

    fn origin(&self, k: usize, row: &[f64], order: &[usize]) -> Origin {
        let n = self.n_genes;
        let produced = match (&self.mutated, &self.crossed) {
            (Some(mutated), _) => &mutated.after,
            (None, Some(crossed)) => &crossed.rows,
            (None, None) => return Origin::Script,
        };
        let Some(crossed) = &self.crossed else { return Origin::Script };
        match produced.chunks_exact(n).nth(k) {
            None => Origin::Random,
            Some(made) if made != row => Origin::Script,
            Some(_) if k < crossed.elites => match order.get(k) {
                Some(&from) => Origin::Elite { from },
                None => Origin::Script,
            },
            Some(_) => self.child(k, crossed, order),
        }
    }

    fn child(&self, k: usize, crossed: &Crossed, order: &[usize]) -> Origin {
        let rank = k - crossed.elites;
        let mate = mate(rank, crossed.parents);
        let (Some(&parent), Some(&mate)) = (order.get(rank), order.get(mate)) else {
            return Origin::Script;
        };
        Origin::Child { parent, mate, mutated: self.mutated_genes(k) }
    }

    /// Which genes of row `k` of the mutation were replaced.
    pub(crate) fn mutated_genes(&self, k: usize) -> Vec<usize> {
        let Some(mutated) = self.mutated.as_ref().filter(|mutated| k >= mutated.elites) else {
            return Vec::new();
        };
        let numbers = mutated.numbers.chunks_exact(self.n_genes).nth(k).unwrap_or_default();
        let replaced = |(j, u): (usize, &f64)| (*u < mutated.factor).then_some(j);
        numbers.iter().enumerate().filter_map(replaced).collect()
    }
}

/// Who mates with the parent of this rank: adjacent ranks, an odd last one with the first.
pub(crate) fn mate(rank: usize, parents: usize) -> usize {
    match rank % 2 {
        1 => rank - 1,
        _ if rank + 1 < parents => rank + 1,
        _ => 0,
    }
}

/// Those who take part in one crossover, by rank from 0.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Mating {
    /// Two parents, or a single one without a partner.
    pub(crate) parents: Vec<usize>,
    /// Two children; one where the last parent mates with the first, or where there is one parent.
    pub(crate) children: Vec<usize>,
}

/// The crossover of the parent of this rank, the first of its pair.
pub(crate) fn mating(rank: usize, parents: usize) -> Mating {
    match mate(rank, parents) {
        mate if mate == rank => Mating { parents: vec![rank], children: vec![rank] },
        mate if mate < rank => Mating { parents: vec![rank, mate], children: vec![rank] },
        mate => Mating { parents: vec![rank, mate], children: vec![rank, mate] },
    }
}
