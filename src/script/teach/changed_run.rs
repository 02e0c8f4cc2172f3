//! A run and what it would have been, as data of a page: the curves of both, and the changed
//! populations beside those of the run.

use super::branches::Branches;
use super::page::{curve, rounded};
use super::trace::Trace;
use serde_json::{Value, json};

/// Bytes of the changed populations on a page, which has 2.3 MB of the run's own.
const MOST: usize = 500_000;
/// Bytes of one gene or fitness in six digits.
const PER_NUMBER: usize = 10;

/// What a run would have been with a change.
#[derive(Debug, Clone)]
pub struct WhatIf {
    /// The changed run.
    pub trace: Trace,
    /// The generation of the change, from 1.
    pub generation: usize,
    /// The change: a statement.
    pub statement: String,
}

impl WhatIf {
    /// What the page has of it: `populations` are those from the generation of the change on, as far
    /// as there is room.
    pub(super) fn data(&self, original: &Trace) -> Value {
        let (generation, change) = (self.generation, self.statement.as_str());
        let branches = Branches { original, changed: &self.trace, generation, change };
        json!({
            "generation": self.generation,
            "statement": self.statement,
            "curve": curve(&self.trace.generations),
            "populations": self.populations(original),
            "verdict": branches.verdict(),
        })
    }

    fn populations(&self, original: &Trace) -> Vec<Value> {
        let mut room = MOST;
        // A page that steps through fewer generations uses fewer of these.
        let kept = super::kept::kept(&original.generations, super::page::MOST_DATA);
        let later = kept.numbers.into_iter().filter(|at| *at + 1 >= self.generation);
        let fitting = later.map_while(|at| {
            let generation = self.trace.generations.get(at)?;
            let numbers = generation.genes.len() + generation.fitness.len();
            room = room.checked_sub(numbers * PER_NUMBER)?;
            Some(json!({
                "number": at + 1,
                "n": generation.n_genes,
                "genes": rounded(&generation.genes),
                "fitness": rounded(&generation.fitness),
                "order": generation.order(),
                "parents": generation.sorted.as_ref().map(|sorted| sorted.parents),
                "factor": generation.mutated.as_ref().map(|mutated| mutated.factor),
            }))
        });
        fitting.collect()
    }
}
