//! Selection: who becomes a parent.

mod linear_ranking;
mod own;
mod roulette;
mod shuffle;
mod stochastic_universal;
mod tournament;
mod truncation;

pub use own::{Own, select_by};

pub(crate) use own::SIGNATURE;
pub use tournament::tournament;
pub use truncation::check_sizes;

use super::{Mrg32k3a, has_failed};
use crate::diag::Fault;
use crate::registry::Entry;

/// Chooses parents by their fitness, of which a smaller one is better.
pub trait Selection: Send + Sync {
    /// The places of `count` parents in `fitness`, which is not empty, in the order in which they
    /// mate: the first with the second, the third with the fourth.
    ///
    /// # Errors
    ///
    /// A user's function that failed or returned no probabilities.
    fn select(
        &self,
        fitness: &[f64],
        count: usize,
        rng: &mut Mrg32k3a,
    ) -> Result<Vec<usize>, Fault>;

    /// Whether all parents of a generation are drawn at once, because one draw depends on the
    /// others; otherwise they are drawn in pairs.
    fn draws_all_at_once(&self) -> bool {
        false
    }
}

/// All ways of selection.
pub(crate) const SELECTIONS: &[&Entry<dyn Selection>] = &[
    &tournament::ENTRY,
    &truncation::ENTRY,
    &roulette::ENTRY,
    &stochastic_universal::ENTRY,
    &linear_ranking::ENTRY,
    &shuffle::ENTRY,
];

/// Probabilities in proportion to how much better than the worst an individual is; where all are
/// equal, or have failed, each is as likely as the others.
///
/// Fitness is minimized, so that it cannot be the probability itself. The worst that has not failed
/// is the reference (windowing, [Goldberg 1989](gapilib_base::bibliography#goldberg-1989)).
fn proportionate(fitness: &[f64]) -> Vec<f64> {
    let succeeded = || fitness.iter().copied().filter(|&fitness| !has_failed(fitness));
    let worst = succeeded().fold(f64::NEG_INFINITY, f64::max);
    let best = succeeded().fold(f64::INFINITY, f64::min);
    // Also where the difference overflows: then the ratio would not be a number.
    let width = worst - best;
    if !(width > 0.0 && width.is_finite()) {
        let any = best.is_finite();
        let weight = |&fitness: &f64| f64::from(u8::from(!any || !has_failed(fitness)));
        return fitness.iter().map(weight).collect();
    }
    let weight = |&own: &f64| if has_failed(own) { 0.0 } else { (worst - own) / width };
    fitness.iter().map(weight).collect()
}

/// Running sums of weights, of which one is positive.
fn sums(weights: &[f64]) -> Vec<f64> {
    let mut sum = 0.0;
    let add = |weight: &f64| {
        sum += weight;
        sum
    };
    weights.iter().map(add).collect()
}

/// The place that a pointer at the fraction `u` of the sum of all weights, 0 < u < 1, points to.
fn pointed(sums: &[f64], u: f64) -> usize {
    let total = sums.last().copied().unwrap_or(0.0);
    let at = sums.partition_point(|sum| *sum <= u * total);
    // Rounding may move the pointer to the end, past the last one with a weight.
    if at < sums.len() { at } else { sums.partition_point(|sum| *sum < total) }
}

/// Spins a wheel for each of `count` parents.
fn spun(weights: &[f64], count: usize, rng: &mut Mrg32k3a) -> Vec<usize> {
    let sums = sums(weights);
    (0..count).map(|_| pointed(&sums, rng.uniform())).collect()
}

/// Puts them in a random order, each as likely as the others (Fisher and Yates).
fn shuffled(mut places: Vec<usize>, rng: &mut Mrg32k3a) -> Vec<usize> {
    for last in (1..places.len()).rev() {
        let other = (rng.uniform() * (last + 1) as f64) as usize;
        places.swap(last, other.min(last));
    }
    places
}
