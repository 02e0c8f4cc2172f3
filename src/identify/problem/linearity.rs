//! Whether linear intervals hold. The 95 % interval of a parameter ends where the sum of squares, the other
//! parameters fitted again, has risen to its limit. A linear interval is right where it ends there, too:
//! the sum is taken at its ends, first with the others where the linear model puts them, and then after
//! a fit from there. The first is an upper bound alone: along a curved valley it rises as the linear
//! model says, while the fits rise by half of that.
//!
//! Reference: [Bates & Watts 1988](gapilib_base::bibliography#bates-watts-1988), chapter 6.

use super::refit::Refit;
use super::{Failed, Run, Solution, SolvedParameter, Statistics};
use crate::diag::Fault;
use crate::elementary;

/// A linear interval may end beside that of the profile by this part of its half-width. On 12 points of
/// A exp(-k t) + c, where the rise of the sum had been compared without fits, and within a factor of 2,
/// such intervals of c contained the true value in 83 % of 150 data sets, and in 45 % of 58 with twice
/// the noise.
const BESIDE: f64 = 0.1;
/// A fit that would lower the sum by less than this part of the rise is not made: what the linear model at
/// the end predicts of it is right to a small part of that.
const SMALL: f64 = 0.05;
/// Where the sum has risen by more than this times what the linear model says before a fit, no fit is
/// made: the model is curved.
const CURVED: f64 = 2.0;
/// A linear interval is tested where the ranges of the others allow this part of the way to its ends.
const TESTED: f64 = 0.7;

/// An end of a linear interval, or as much of the way there as the ranges of the others allow.
struct LinearEnd {
    /// Values of all parameters, where the linear model puts them.
    values: Vec<f64>,
    /// The part of the way.
    part: f64,
}

/// Compares sums of squares at the ends of linear intervals with those of the linear model.
struct LinearityTest<'a> {
    run: &'a Run,
    refit: Refit<'a>,
    /// The least sum of squares, and its rise to the 95 % limit.
    searched: f64,
    rise: f64,
    /// Simulations that the fits may take. Ends beyond are judged without fits.
    budget: u64,
}

impl LinearityTest<'_> {
    /// The rise of a sum of squares as a part of what the linear model says.
    fn share(&self, sum: f64, end: &LinearEnd) -> f64 {
        (sum - self.searched) / (self.rise * end.part * end.part)
    }

    /// Whether the interval of parameter `k` holds at this end, where this was simulated.
    fn holds(
        &mut self,
        k: usize,
        end: &LinearEnd,
        row: &Result<Vec<f64>, Failed>,
    ) -> Result<bool, Fault> {
        let problem = &self.run.problem;
        // What a constraint forbids tells nothing of the model.
        if problem.inference.constraints.iter().any(|own| own.violation(&end.values) > 0.0) {
            return Ok(true);
        }
        let Ok(row) = row else { return Ok(false) };
        let [least, most] = [1.0 - BESIDE, 1.0 + BESIDE].map(|side| elementary::powi(side, 2));
        let sum = self.run.evaluation.searched_sum(problem, row);
        let straight = self.share(sum, end);
        if end.part < TESTED || !(least..=CURVED).contains(&straight) {
            return Ok(false);
        }
        if self.refit.simulations >= self.budget {
            return Ok(true);
        }
        let sum = self.refit.fall(&end.values, row, &[k]).map(|fall| sum - fall);
        let small = |fitted: f64| straight - self.share(fitted, end) <= SMALL;
        let sum = match sum.filter(|sum| small(*sum)) {
            Some(sum) => Some(sum),
            None => self.refit.roughly(&end.values, &[k])?.map(|(_, sum)| sum),
        };
        Ok(sum.is_some_and(|sum| (least..=most).contains(&self.share(sum, end))))
    }
}

impl Solution {
    /// Those of these parameters whose linear interval does not hold.
    ///
    /// # Errors
    ///
    /// Those of least squares.
    pub(super) fn curved(
        &mut self,
        run: &Run,
        statistics: &Statistics,
        which: &[usize],
    ) -> Result<Vec<usize>, Fault> {
        let is_tested = !statistics.spread.robust
            && statistics.spread.freedom >= 1.0
            && statistics.repeated.is_empty();
        let refit = Refit::new(&run.problem, &run.evaluation).filter(|_| is_tested);
        let Some(refit) = refit else { return Ok(Vec::new()) };
        let searched = statistics.searched;
        let rise = statistics.limit_of_squares() - searched;
        let mut test = LinearityTest { run, refit, searched, rise, budget: Solution::budget(run) };
        let ends = |k: usize| [0, 1].map(|side| self.linear_end(statistics, k, side));
        let ends: Vec<[Option<LinearEnd>; 2]> = which.iter().map(|&k| ends(k)).collect();
        let known = ends.iter().flatten().flatten();
        let places: Vec<Vec<f64>> = known.map(|end| end.values.clone()).collect();
        let mut rows = run.evaluation.simulate_all(&places).into_iter();
        let mut curved = Vec::new();
        for (&k, ends) in which.iter().zip(&ends) {
            let mut holds = true;
            for end in ends {
                let own = end.as_ref().and_then(|end| Some((end, rows.next()?)));
                holds = match own {
                    Some((end, row)) => holds && test.holds(k, end, &row)?,
                    None => false,
                };
            }
            if !holds {
                curved.push(k);
            }
        }
        self.effort.simulations_for_statistics += places.len() as u64 + test.refit.simulations;
        Ok(curved)
    }

    /// The lower or the upper end of the linear interval of parameter `k`; where parameters stand at ends
    /// of their ranges, with these held.
    fn linear_end(&self, statistics: &Statistics, k: usize, side: usize) -> Option<LinearEnd> {
        let found = statistics.tabulated()?;
        let n = self.parameters.len();
        let errors = statistics.reach(k)?[side] / found.standard_deviations[k];
        let errors = if side == 0 { -errors } else { errors };
        let by = |j: usize| {
            let own = found.correlations[j * n + k] * found.standard_deviations[j];
            if own.is_finite() { errors * own } else { 0.0 }
        };
        let direction: Vec<f64> = (0..n).map(by).collect();
        let (values, part) = self.within_ranges(&direction);
        Some(LinearEnd { values, part }).filter(|_| errors.is_finite())
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
