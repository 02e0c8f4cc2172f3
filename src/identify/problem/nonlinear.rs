//! Whether linear intervals hold: at their ends the sum of squares has risen by what the linear model
//! says, or it has not. Where not, the interval is that of the profile likelihood.
//!
//! The points looked at are those where a parameter stands at an end of its interval and the others
//! at their best for it, by the linear model; of an interval that goes beyond the search range, as
//! far as the range allows.
//!
//! Reference: [Bates & Watts 1988](crate::bibliography#bates-watts-1988), chapter 6.

use super::notes::undetermined;
use super::profile::{Known, Profile, profiles};
use super::{Finding, FindingKind, Run, Severity, Solution, SolvedParameter, Statistics, Verdict};
use crate::diag::Fault;
use crate::elementary;
use crate::identify::table::significant;

/// The rise of the sum of squares may differ from the linear one by this factor: the interval is then
/// right to a fifth or so.
const FACTOR: f64 = 2.0;
/// Rises below this part of the one that the interval allows say nothing.
const TOLD: f64 = 0.1;
/// Intervals whose ends differ by less than this part of their width are the same.
const SAME: f64 = 0.1;
/// Residuals below this many times the error of the simulation come from the simulation.
const FROM_THE_SOLVER: f64 = 100.0;

impl Solution {
    /// Tests the linear intervals and takes profiles for those that do not hold.
    ///
    /// # Errors
    ///
    /// Those of least squares.
    pub(super) fn check_linear_intervals(
        &mut self,
        run: &Run,
        statistics: &Statistics,
    ) -> Result<(), Fault> {
        if statistics.robust || statistics.freedom < 1.0 || !statistics.repeated.is_empty() {
            return Ok(());
        }
        if is_without_noise(run, statistics) {
            return Ok(());
        }
        let curved = self.curved(run, statistics);
        if curved.is_empty() {
            return Ok(());
        }
        let values: Vec<f64> = self.parameters.iter().map(|own| own.value).collect();
        let half = |p: &SolvedParameter| p.interval.map(|[low, high]| 0.5 * (high - low));
        let reach: Vec<Option<f64>> = self.parameters.iter().map(half).collect();
        let others = self.other_places();
        let known = Known { best: &values, reach: &reach, others: &others, is_shared: false };
        let Some(found) = profiles(&run.problem, &run.evaluation, &known, &curved)? else {
            return Ok(());
        };
        self.simulations_for_statistics += found.simulations;
        for (&k, profile) in curved.iter().zip(&found.profiles) {
            self.adopt(k, profile, statistics.quantile);
        }
        Ok(())
    }

    /// Parameters whose linear interval does not hold.
    fn curved(&mut self, run: &Run, statistics: &Statistics) -> Vec<usize> {
        // Where parameters stand at ends of their ranges, with these held.
        let held = statistics.at_bounds.as_ref().map(|own| &own.held);
        let Some(found) = held.or(statistics.uncertainty.as_ref()) else { return Vec::new() };
        let n = self.parameters.len();
        let is_grouped = |k: usize| {
            statistics.non_identifiable.iter().any(|group| group.parameters.contains(&k))
        };
        let is_linear = |k: &usize| {
            let deviation = found.standard_deviations[*k];
            deviation.is_finite() && self.parameters[*k].interval.is_some() && !is_grouped(*k)
        };
        let which: Vec<usize> = (0..n).filter(is_linear).collect();
        let mut places = Vec::new();
        let mut parts = Vec::new();
        for &k in &which {
            for side in [-1.0, 1.0] {
                let direction: Vec<f64> = (0..n)
                    .map(|j| {
                        let own = found.correlations[j * n + k] * found.standard_deviations[j];
                        if own.is_finite() { side * statistics.quantile * own } else { 0.0 }
                    })
                    .collect();
                let (place, part) = self.within_ranges(&direction);
                places.push(place);
                parts.push(part);
            }
        }
        let rows = run.evaluation.simulate_all(&places);
        self.simulations_for_statistics += rows.len() as u64;
        let allowed = elementary::powi(statistics.quantile, 2) * statistics.variance;
        let smallest = statistics.residuals.iter().map(|r| r * r).sum::<f64>();
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
                Ok(row) => square(run, statistics, row) - smallest,
                Err(_) => f64::INFINITY,
            };
            let is_told = rise.abs().max(expected) > TOLD * allowed;
            !is_told || rise <= FACTOR * expected && rise >= expected / FACTOR
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

    /// Takes the interval of a profile in place of the linear one, where they differ.
    pub(super) fn adopt(&mut self, k: usize, profile: &Profile, factor: f64) {
        let own = &mut self.parameters[k];
        let [min, max] = own.range;
        if profile.cut.iter().any(Option::is_some) {
            return;
        }
        let [low, high] = profile.interval;
        let interval = [low.unwrap_or(min), high.unwrap_or(max)];
        let Some(linear) = own.interval else { return };
        let width = interval[1] - interval[0];
        let is_same = |a: f64, b: f64| (a - b).abs() <= SAME * width;
        if is_same(linear[0], interval[0]) && is_same(linear[1], interval[1]) {
            return;
        }
        let bounded = low.is_some() && high.is_some();
        own.interval = Some(interval);
        own.by_profile = true;
        // Where a derivative vanishes, the standard error is one of rounding.
        own.deviation = own.deviation.filter(|deviation| *deviation < max - min);
        let deviation = match own.logarithmic && own.value > 0.0 && interval[0] > 0.0 {
            true => 0.5 * elementary::ln(interval[1] / interval[0]) * own.value / factor,
            false => 0.5 * width / factor,
        };
        let is_identifiable = bounded && own.is_narrow(deviation, factor);
        own.verdict = Some(match is_identifiable {
            true => Verdict::Identifiable,
            false => Verdict::PracticallyNonIdentifiable,
        });
        own.determined = Some(is_identifiable);
        let name = own.name.clone();
        let [a, b, c, d] =
            [interval[0], interval[1], linear[0], linear[1]].map(|end| significant(end, 4));
        let sentence = format!(
            "The model is strongly nonlinear in {name} near the fit: its 95 % interval {a} .. \
             {b} comes from its profile likelihood. The linearized interval, {c} .. {d}, is not \
             valid."
        );
        // What was said of the linear interval.
        let is_about = |finding: &Finding| {
            finding.kind == FindingKind::PracticallyNonIdentifiable
                && finding.parameters == [name.clone()]
        };
        self.findings.retain(|finding| !is_about(finding));
        let finding = Finding::new(FindingKind::Interval, sentence)
            .severity(Severity::Information)
            .parameters([name.as_str()]);
        self.findings.push(finding);
        if !is_identifiable {
            let sentence = undetermined(&self.parameters[k]);
            let finding = Finding::new(FindingKind::PracticallyNonIdentifiable, sentence);
            self.findings.push(finding.parameters([name.as_str()]));
        }
    }
}

/// Whether the residuals may be those of the solver, which tell nothing of intervals.
fn is_without_noise(run: &Run, statistics: &Statistics) -> bool {
    let measured = run.problem.series.iter().flat_map(|series| &series.y);
    let size: f64 =
        measured.zip(&statistics.weights).map(|(y, w)| elementary::powi(w * y, 2)).sum();
    let square: f64 = statistics.residuals.iter().map(|r| r * r).sum();
    !statistics.believed && square.sqrt() <= FROM_THE_SOLVER * run.problem.noise * size.sqrt()
}

/// The weighted sum of squares of a simulation, as the statistics have it.
fn square(run: &Run, statistics: &Statistics, row: &[f64]) -> f64 {
    let measured = run.problem.series.iter().flat_map(|series| &series.y);
    let points = measured.zip(row).zip(&statistics.weights);
    points.map(|((m, s), w)| elementary::powi(w * (m - s), 2)).sum()
}
