//! Whether linear intervals hold: at their ends the sum of squares has risen by what the linear model
//! says.
//!
//! Reference: [Bates & Watts 1988](gapilib_base::bibliography#bates-watts-1988), chapter 6.

use super::{ErrorModel, Run, Solution, SolvedParameter, Statistics};
use crate::elementary;

/// The rise of the sum of squares may differ from the linear one by this factor: the interval is then
/// right to a fifth or so.
const FACTOR: f64 = 2.0;
/// Rises below this part of the one that the interval allows say nothing.
const NOTICEABLE: f64 = 0.1;
/// A linear interval is tested where the ranges of the others allow this part of the way to its ends.
const TESTED: f64 = 0.7;

impl Solution {
    /// Those of these parameters whose linear interval does not hold.
    pub(super) fn curved(
        &mut self,
        run: &Run,
        statistics: &Statistics,
        which: &[usize],
    ) -> Vec<usize> {
        if statistics.spread.robust
            || statistics.spread.freedom < 1.0
            || !statistics.repeated.is_empty()
        {
            return Vec::new();
        }
        // Where parameters stand at ends of their ranges, with these held.
        let Some(found) = statistics.tabulated() else { return Vec::new() };
        let n = self.parameters.len();
        let mut places = Vec::new();
        let mut parts = Vec::new();
        for &k in which {
            for side in [-1.0, 1.0] {
                let direction: Vec<f64> = (0..n)
                    .map(|j| {
                        let own = found.correlations[j * n + k] * found.standard_deviations[j];
                        if own.is_finite() { side * statistics.spread.quantile * own } else { 0.0 }
                    })
                    .collect();
                let (place, part) = self.within_ranges(&direction);
                places.push(place);
                parts.push(part);
            }
        }
        let rows = run.evaluation.simulate_all(&places);
        self.effort.simulations_for_statistics += rows.len() as u64;
        let allowed = elementary::powi(statistics.spread.quantile, 2) * statistics.spread.variance;
        // What a constraint forbids tells nothing of the model.
        let is_forbidden = |at: usize| {
            run.problem.inference.constraints.iter().any(|own| own.violation(&places[at]) > 0.0)
        };
        let holds = |at: usize| {
            if is_forbidden(at) {
                return true;
            }
            let expected = allowed * parts[at] * parts[at];
            let rise = match &rows[at] {
                Ok(row) => rise(run, statistics, row),
                Err(_) => f64::INFINITY,
            };
            let is_noticeable = rise.abs().max(expected) > NOTICEABLE * allowed;
            parts[at] >= TESTED
                && (!is_noticeable || rise <= FACTOR * expected && rise >= expected / FACTOR)
        };
        let fails = |number: &usize| !(holds(2 * number) && holds(2 * number + 1));
        (0..which.len()).filter(fails).map(|number| which[number]).collect()
    }

    /// The best values moved along a direction, as far as the ranges allow, and which part of it.
    fn within_ranges(&self, direction: &[f64]) -> (Vec<f64>, f64) {
        let mut part: f64 = 1.0;
        for (own, by) in self.parameters.iter().zip(direction) {
            let [min, max] = own.range;
            let room = if *by > 0.0 { max - own.value } else { min - own.value };
            // On a logarithmic scale a step is one of ratios.
            let (room, by) = match own.logarithmic {
                true => {
                    let end = if room > 0.0 { max } else { min };
                    (elementary::ln(end / own.value), by / own.value)
                }
                false => (room, *by),
            };
            if by != 0.0 && (room / by).abs() < part {
                part = (room / by).abs();
            }
        }
        let moved = |(own, by): (&SolvedParameter, &f64)| {
            let value = match own.logarithmic {
                true => own.value * elementary::exp(part * by / own.value),
                false => own.value + part * by,
            };
            value.clamp(own.range[0], own.range[1])
        };
        (self.parameters.iter().zip(direction).map(moved).collect(), part)
    }
}

/// By how much the weighted sum of squares of a simulation, as the statistics have it, or twice the
/// negative log-likelihood where that is not a sum of squares, exceeds that of the fit.
fn rise(run: &Run, statistics: &Statistics, row: &[f64]) -> f64 {
    let is_other = !run.problem.is_normal() || super::joint::is_joint(&run.problem.series);
    if ErrorModel::of(&run.problem) == ErrorModel::Computed || is_other {
        let least = run.observed.best.as_ref().map_or(f64::NAN, |best| best.fitness);
        return 2.0 * (run.evaluation.objective(&run.problem, row) - least);
    }
    let measured = run.problem.series.iter().flat_map(|series| &series.y);
    let points = measured.zip(row).zip(&statistics.weights);
    let square: f64 = points.map(|((m, s), w)| elementary::powi(w * (m - s), 2)).sum();
    square - statistics.residuals.iter().map(|r| r * r).sum::<f64>()
}
