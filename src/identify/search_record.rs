//! What is observed of a search, whether a method of the program or a script chooses the
//! individuals: its generations, the best individual so far, and why simulations failed.

use crate::ga::{History, has_failed, order};
use indexmap::IndexMap;

/// Different causes of failure kept apart.
const CAUSES: usize = 50;
/// The cause under which all further ones are counted.
const OTHER_CAUSES: &str = "other causes";
/// Individuals kept for the figures.
const KEPT: usize = 4000;

/// The best individual.
#[derive(Debug, Clone, PartialEq)]
pub struct Best {
    /// Values of the estimated parameters.
    pub values: Vec<f64>,
    /// Its first objective.
    pub fitness: f64,
}

/// What was observed of a search so far.
#[derive(Debug, Clone, Default)]
pub struct SearchRecord {
    /// One record for each generation.
    pub history: History,
    /// The best individual so far.
    pub best: Option<Best>,
    /// The values of the best individual of each generation; empty where all of it failed.
    pub trace: Vec<Vec<f64>>,
    /// Individuals of all generations.
    pub individuals: u64,
    /// Evenly chosen ones: values and fitness.
    pub kept: Vec<(Vec<f64>, f64)>,
    /// Every n-th individual is kept; 0 as 1.
    keep_every: u64,
    /// Individuals whose simulation failed.
    pub failures: Failures,
}

/// Simulations that failed.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Failures {
    /// Their number.
    pub count: u64,
    /// Why they failed, and how many for each cause.
    pub causes: IndexMap<String, u64>,
}

impl Failures {
    /// Counts a failed simulation; the cause under which it is counted.
    pub(crate) fn note<'a>(&mut self, cause: &'a str) -> &'a str {
        self.note_several(cause, 1)
    }

    fn note_several<'a>(&mut self, cause: &'a str, number: u64) -> &'a str {
        self.count += number;
        let room = self.causes.len() < CAUSES || self.causes.contains_key(cause);
        let cause = if room { cause } else { OTHER_CAUSES };
        *self.causes.entry(cause.to_owned()).or_insert(0) += number;
        cause
    }

    /// Counts those of another part as well.
    pub(crate) fn add(&mut self, others: &Failures) {
        for (cause, number) in &others.causes {
            self.note_several(cause, *number);
        }
    }

    /// The cause of most failures, and of how many.
    pub fn main_cause(&self) -> Option<(&str, u64)> {
        let most = self.causes.iter().rev().max_by_key(|(_, count)| **count);
        most.map(|(cause, count)| (cause.as_str(), *count))
    }
}

impl SearchRecord {
    /// Number of generations.
    pub fn generations(&self) -> u64 {
        self.history.generations.len() as u64
    }

    /// A generation with this fitness ends; `values` are those of an individual, and `counts` says
    /// whether it can become the best one. Returns whether there is a new best individual.
    pub(crate) fn generation(
        &mut self,
        fitness: &[f64],
        values: impl Fn(usize) -> Vec<f64>,
        counts: impl FnOnce(usize) -> bool,
    ) -> bool {
        self.history.record(fitness);
        let best = self.best.as_ref().map_or(f64::INFINITY, |best| best.fitness);
        let leading = order(fitness).first().copied().filter(|&k| !has_failed(fitness[k]));
        let better = leading.filter(|&k| fitness[k] < best && counts(k));
        if let Some(k) = better {
            self.best = Some(Best { values: values(k), fitness: fitness[k] });
        }
        self.trace.push(leading.map_or_else(Vec::new, &values));
        for (k, &fitness) in fitness.iter().enumerate() {
            self.keep(|| values(k), fitness);
        }
        better.is_some()
    }

    /// The last generation was none: before it, this individual was the best.
    pub(crate) fn take_back(&mut self, best: Option<Best>) {
        self.best = best;
        self.history.generations.pop();
        self.trace.pop();
    }

    /// Keeps every n-th individual, n doubled when there are too many.
    fn keep(&mut self, values: impl FnOnce() -> Vec<f64>, fitness: f64) {
        let every = self.keep_every.max(1);
        if self.individuals.is_multiple_of(every) {
            self.kept.push((values(), fitness));
        }
        self.individuals += 1;
        if self.kept.len() >= KEPT {
            let mut number = 0;
            self.kept.retain(|_| {
                number += 1;
                number % 2 == 1
            });
            self.keep_every = 2 * every;
        }
    }
}
