//! A call of an operator by name, such as `Op_Crossover`: what it was given and what it returned.
//! What the operator did in between is not recorded, so that it may be a function of the script as
//! well.

use super::place::ScriptLine;
use serde::{Deserialize, Serialize};

/// A call of an operator by name.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Operation {
    /// Where it was called.
    pub place: ScriptLine,
    /// The operator with its settings, as the script names it.
    pub operator: String,
    /// Whether it is a function of the script.
    pub is_own: bool,
    /// Number of genes of each individual; 0 for a selection, which knows the fitness only.
    pub n_genes: u32,
    /// What went in and what came out.
    pub action: Action,
}

/// What went into an operator and what came out; genes are given row by row.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub enum Action {
    /// `Op_Sampling`.
    Sampling {
        /// The individuals that it returned.
        sampled: Vec<f64>,
        /// Lower ends of the search ranges.
        minima: Vec<f64>,
        /// Upper ends of the search ranges.
        maxima: Vec<f64>,
    },
    /// `Op_Selection`.
    Selection {
        /// The fitness of all individuals.
        fitness: Vec<f64>,
        /// The rows of the parents, from 0, in the order that it returned.
        places: Vec<u32>,
    },
    /// `Op_Crossover`.
    Crossover {
        /// The parents; rows 0 and 1 mate, 2 and 3, a last one without partner with row 0.
        parents: Vec<f64>,
        /// One child for each parent.
        children: Vec<f64>,
    },
    /// `Op_Mutation`.
    Mutation {
        /// The individuals before.
        before: Vec<f64>,
        /// The same after it.
        after: Vec<f64>,
        /// Number of first rows that are not changed.
        elites: u32,
        /// `F_Mut`, the probability that a gene mutates.
        factor: f64,
    },
    /// `Op_Survival`.
    Survival {
        /// The old generation.
        old: Vec<f64>,
        /// Its fitness.
        fitness: Vec<f64>,
        /// The offspring.
        offspring: Vec<f64>,
        /// Its fitness.
        fitness_offspring: Vec<f64>,
        /// Who lives on, in the order of the next generation: rows of the old generation from 0,
        /// those of the offspring counted on from there.
        survivors: Vec<u32>,
    },
}

/// What kind of operator a step is about.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum OperationKind {
    /// Samples individuals.
    Sampling,
    /// Selects parents.
    Selection,
    /// Makes children of parents.
    Crossover,
    /// Changes genes.
    Mutation,
    /// Selects survivors.
    Survival,
}

impl OperationKind {
    /// What a step of this kind is called.
    pub fn title(self) -> &'static str {
        match self {
            OperationKind::Sampling => "sampling",
            OperationKind::Selection => "selection",
            OperationKind::Crossover => "crossover",
            OperationKind::Mutation => "mutation",
            OperationKind::Survival => "survivor selection",
        }
    }

    /// The command of the script.
    pub fn command(self) -> &'static str {
        match self {
            OperationKind::Sampling => "Op_Sampling",
            OperationKind::Selection => "Op_Selection",
            OperationKind::Crossover => "Op_Crossover",
            OperationKind::Mutation => "Op_Mutation",
            OperationKind::Survival => "Op_Survival",
        }
    }
}

impl Operation {
    /// What kind of operator was called.
    pub fn kind(&self) -> OperationKind {
        match self.action {
            Action::Sampling { .. } => OperationKind::Sampling,
            Action::Selection { .. } => OperationKind::Selection,
            Action::Crossover { .. } => OperationKind::Crossover,
            Action::Mutation { .. } => OperationKind::Mutation,
            Action::Survival { .. } => OperationKind::Survival,
        }
    }

    /// The rows that have a step: one for the call; for each pair of parents and for each individual
    /// that may mutate one of its own. A call on no individuals is a step as well.
    pub(super) fn rows_of_steps(&self) -> Vec<usize> {
        let rows: Vec<usize> = match &self.action {
            Action::Crossover { parents, .. } => (0..self.count(parents)).step_by(2).collect(),
            Action::Mutation { before, elites, .. } => {
                (*elites as usize..self.count(before)).collect()
            }
            _ => vec![0],
        };
        if rows.is_empty() { vec![0] } else { rows }
    }

    /// Number of individuals.
    pub(super) fn count(&self, genes: &[f64]) -> usize {
        genes.len().checked_div(self.n_genes as usize).unwrap_or(0)
    }

    /// The genes of a row.
    pub(super) fn row<'a>(&self, genes: &'a [f64], row: usize) -> &'a [f64] {
        genes.chunks_exact((self.n_genes as usize).max(1)).nth(row).unwrap_or_default()
    }

    /// Whether sizes and rows agree: those of a damaged file need not.
    pub(super) fn is_whole(&self) -> bool {
        let n = self.n_genes as usize;
        let fits = |genes: &[f64]| n > 0 && genes.len().is_multiple_of(n);
        match &self.action {
            Action::Sampling { sampled, minima, maxima } => {
                fits(sampled) && minima.len() == n && maxima.len() == n
            }
            Action::Selection { fitness, places } => {
                n == 0 && places.iter().all(|&place| (place as usize) < fitness.len())
            }
            Action::Crossover { parents, children } => {
                fits(parents) && parents.len() == children.len()
            }
            Action::Mutation { before, after, .. } => fits(before) && before.len() == after.len(),
            Action::Survival { old, fitness, offspring, fitness_offspring, survivors } => {
                let count = fitness.len() + fitness_offspring.len();
                fits(old)
                    && fits(offspring)
                    && self.count(old) == fitness.len()
                    && self.count(offspring) == fitness_offspring.len()
                    && survivors.iter().all(|&one| (one as usize) < count)
            }
        }
    }
}
