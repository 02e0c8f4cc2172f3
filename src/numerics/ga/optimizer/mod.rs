//! Optimizers with the ask/tell interface: each proposes candidates and receives their objective
//! values. It keeps no clock, no file and no thread, so that the same seed and the same answers
//! give the same questions: a run is replayed from its recorded answers.
//!
//! Genes lie in the unit cube; what they stand for (a range, its logarithm) is the caller's
//! business. The method of the paper alone works in the ranges of the genes.

mod breeding;
mod cma_es;
mod descent_report;
mod descents;
mod exchange;
mod gapilib2006;
mod genetic;
mod islands;
mod levenberg_marquardt;
mod linear_model;
mod lshade;
mod multistart;
mod nelder_mead;
mod nsga2;
mod polish;

pub use descent_report::{DescentEnd, DescentReport};
pub use descents::reached;
pub use exchange::Scale;
pub use levenberg_marquardt::MINIMUM;
pub use linear_model::Offset;
pub use nsga2::{Survivor, non_dominated, survivors};
pub use polish::Polished;

use super::{Gene, Genomes, Mrg32k3a, has_failed};
use crate::diag::Fault;
use crate::fault;
use crate::registry::{BAD_OPTION, Entry};

/// A search in progress.
pub trait Optimizer: Send {
    /// Fills `batch`, which is empty, with the individuals to evaluate next. It stays empty when
    /// the search has converged and asks nothing more.
    fn ask(&mut self, batch: &mut Genomes);
    /// The answers to the last question, one for each individual in its order.
    fn tell(&mut self, batch: &Genomes, answers: &Answers<'_>);
    /// What the answers to the last question must hold besides the objectives.
    fn required(&self) -> Required {
        Required::Objectives
    }
    /// The descents by least squares so far, in their order.
    fn descents(&self) -> Vec<DescentReport> {
        Vec::new()
    }
    /// What it is doing, in one word.
    fn phase(&self) -> &'static str;
    /// Changes a setting during the search.
    ///
    /// # Errors
    ///
    /// `bad-option` where the method has no such setting or the value is outside its domain.
    fn change(&mut self, setting: &str, value: f64) -> Result<(), Fault> {
        Err(fault!(BAD_OPTION, "`{setting}` cannot be changed to {value} during the run"))
    }
    /// Why the search cannot continue: an operator of the user has failed. Nothing is asked any
    /// more.
    fn fault(&self) -> Option<&Fault> {
        None
    }
    /// The ranges of the genes have changed by this map: a gene at u is now at `offset + scale u`.
    fn rescale(&mut self, _gene: usize, _offset: f64, _scale: f64) {}
}

/// What the answers to a request must contain of each individual; each kind contains the ones
/// before it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Required {
    /// Its objectives.
    Objectives,
    /// Its weighted residuals.
    Residuals,
    /// Their derivatives by the genes.
    Jacobians,
}

/// How good the individuals of one question are; smaller is better.
#[derive(Debug, Clone, Copy)]
pub struct Answers<'a> {
    /// Objectives, individual by individual; [`FAILED_FITNESS`](super::FAILED_FITNESS) or more for a failed one.
    pub objectives: &'a [f64],
    /// Objectives of one individual, at least 1.
    pub n_objectives: usize,
    /// Residuals, individual by individual, whose sum of squares is minimized; empty unless asked
    /// for. NaN for a failed individual.
    pub residuals: &'a [f64],
    /// Derivatives of the residuals by the genes, individual by individual, residuals × genes;
    /// empty unless asked for. NaN where there are none.
    pub jacobians: &'a [f64],
}

impl Answers<'_> {
    /// The first objective of individual `k`.
    pub fn fitness(&self, k: usize) -> f64 {
        self.objectives[k * self.n_objectives]
    }

    /// The answers about the individuals `first..end` out of `count`.
    fn part(&self, first: usize, end: usize, count: usize) -> Answers<'_> {
        let cut = |all: &'_ [f64]| {
            let n = all.len() / count.max(1);
            first * n..end * n
        };
        Answers {
            objectives: &self.objectives[cut(self.objectives)],
            n_objectives: self.n_objectives,
            residuals: &self.residuals[cut(self.residuals)],
            jacobians: &self.jacobians[cut(self.jacobians)],
        }
    }
}

/// What a search starts from.
#[derive(Debug, Clone)]
pub struct Setup {
    /// The genes with the ranges in which the method of the paper works; the others use 0..1.
    pub genes: Vec<Gene>,
    /// What the fractions of the genes mean, where that is known: genes of like terms are exchanged.
    pub scales: Vec<Scale>,
    /// Number of objectives.
    pub n_objectives: usize,
    /// Evaluations that the whole run may take, where known: some methods plan with it.
    pub budget: Option<u64>,
    /// A point of the unit cube to include, if there is one.
    pub start: Option<Vec<f64>>,
    /// Relative error of the simulated values.
    pub noise: f64,
    /// Root of the sum of squares of the measured values, weighted as the residuals are.
    pub size: f64,
    /// The random numbers of the run.
    pub rng: Mrg32k3a,
}

/// A way to search.
pub trait Method: Send + Sync {
    /// Begins a search.
    ///
    /// # Errors
    ///
    /// Settings that do not fit the problem, such as more parents than individuals.
    fn start(&self, setup: Setup) -> Result<Box<dyn Optimizer>, Fault>;
    /// Whether genes are in their own ranges instead of the unit cube.
    fn in_natural_units(&self) -> bool {
        false
    }
    /// Whether it needs residuals, so that only sums of squares can be minimized.
    fn needs_residuals(&self) -> bool {
        false
    }
    /// Whether its result is worth to be refined by a local method.
    fn can_be_polished(&self) -> bool {
        true
    }
    /// The operators that were chosen in place of the usual ones: kinds, and names with settings.
    fn operators(&self) -> Vec<(&'static str, String)> {
        Vec::new()
    }
    /// Whether it handles several objectives at once.
    fn handles_several_objectives(&self) -> bool {
        false
    }
}

/// All methods; the first is the default.
pub const METHODS: &[&Entry<dyn Method>] = &[
    &genetic::ENTRY,
    &gapilib2006::ENTRY,
    &lshade::ENTRY,
    &cma_es::ENTRY,
    &levenberg_marquardt::ENTRY,
    &nelder_mead::ENTRY,
    &multistart::ENTRY,
    &nsga2::ENTRY,
];

/// Residuals below this many times the error of the simulation come from the simulation.
pub const FROM_THE_SOLVER: f64 = 100.0;

/// Derivatives are as wrong as the simulation, or somewhat more: steps that change the residuals by less
/// than this many times its error are steps of errors.
const ERRORS: f64 = 10.0;

/// The test of a minimum at a point of the unit cube from the weighted residuals there and their
/// derivatives (residuals × genes); `noise` and `size` as in [`Setup`].
pub fn test_minimum(
    point: &[f64],
    residuals: &[f64],
    jacobian: &[f64],
    [noise, size]: [f64; 2],
) -> (Offset, bool) {
    let accuracy = levenberg_marquardt::Accuracy { noise, size };
    let tolerance = accuracy.rank_tolerance();
    let model = linear_model::LinearModel::new(residuals, jacobian, point.len(), tolerance);
    let offset = model.offset(point);
    let length = residuals.iter().map(|r| r * r).sum::<f64>().sqrt();
    let error = noise * size;
    // What the step to the minimum of the linear model would change of the residuals.
    let freedom = residuals.len().saturating_sub(offset.rank).max(1) as f64;
    let part = |own: f64| (own * (offset.rank as f64 / freedom).sqrt()).min(1.0);
    let moved = offset.relative.map(|own| part(own) * length);
    // Residuals of the size of the errors of the simulation: a change of this size is not noticeable.
    let is_noticeable =
        length > FROM_THE_SOLVER * error || moved.is_none_or(|moved| moved > ERRORS * error);
    let is_near = length <= error || !is_noticeable;
    let is_exact = length == 0.0 || !offset.blind && offset.rank > 0 && is_near;
    (offset, is_exact || levenberg_marquardt::is_minimum(&offset, length, accuracy, MINIMUM))
}

/// A key that orders fitness with NaN last.
fn key(fitness: f64) -> f64 {
    if fitness.is_nan() { f64::INFINITY } else { fitness }
}

#[cfg(test)]
use super::{FAILED_FITNESS, hypervolume};
#[cfg(test)]
use crate::registry::Options;
#[cfg(test)]
mod multimodal_tests;
#[cfg(test)]
pub(crate) mod problems;
#[cfg(test)]
mod tests;
