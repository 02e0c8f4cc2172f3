//! Data that may be read wrongly. Where several estimates lie at ends of their ranges and the residuals
//! have a pattern, the cause is as often a column in another unit, or with the other sign, as a range
//! that is too narrow: that is said first, and short fits to changed columns can show it.

use super::range_notes;
use super::refit::{Fitted, Refit};
use super::{Finding, FindingKind, Run, Severity, Solution, SolvedSeries, Stop};
use crate::diag::{Fault, suggest};
use crate::ga::optimizer::METHODS;
use crate::ranks::Processors;
use crate::registry::{self, Options};
use crate::table::significant;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

/// Estimates at ends of their ranges that are no longer the matter of one range.
const SEVERAL: usize = 2;
/// A change explains the data far better where it leaves less than this part of the variance that the
/// fit left: random columns of 60 rows come to half of it.
const FAR_BETTER: f64 = 0.1;
/// Changes that leave up to this times as much as the best one are named beside it: the other sign of an
/// input is that of all outputs.
const AS_GOOD: f64 = 2.0;

/// A column that was read otherwise, and how well the model fits then.
pub struct Reading {
    /// What was changed, as the end of "with".
    pub words: String,
    /// The smallest coefficient of determination of all series after a short fit.
    pub r_squared: Option<f64>,
}

impl Solution {
    /// Whether columns are to be tried otherwise: data may be read wrongly, the fit is worse than a
    /// constant at an end of a range, or the residuals have a strong pattern.
    pub fn is_doubtful(&self) -> bool {
        let is_poor = self.findings.iter().any(|finding| finding.kind == FindingKind::PoorFit);
        self.may_be_misread() || is_poor && !self.at_ends().is_empty() || self.has_strong_pattern()
    }

    /// Whether the model does not describe the data within their noise, by the residuals of a series.
    pub(crate) fn has_strong_pattern(&self) -> bool {
        let is_strong = |own: &Finding| is_pattern(own) && own.severity == Severity::Serious;
        self.findings.iter().any(is_strong)
    }

    /// What the verdicts on the parameters assume although the residuals contradict it.
    pub(crate) fn assumption(&self) -> Option<&'static str> {
        match () {
            () if self.may_be_misread() => Some("if the data are read correctly"),
            () if self.has_strong_pattern() => Some("if the model is right"),
            () => None,
        }
    }

    /// Whether it was said that data may be read wrongly.
    pub fn may_be_misread(&self) -> bool {
        self.findings.iter().any(|finding| finding.kind == FindingKind::Misread)
    }

    /// The parameters at ends of their ranges.
    pub(crate) fn at_ends(&self) -> Vec<&str> {
        let at_ends = self.parameters.iter().filter(|own| own.at_bound);
        at_ends.map(|own| own.name.as_str()).collect()
    }

    /// Whether the residuals of a series have a pattern, or its fit is worse than a constant.
    pub fn has_pattern(&self) -> bool {
        self.findings.iter().any(is_pattern)
    }

    /// Says first that columns may be read wrongly, where several estimates lie at ends.
    pub(super) fn doubt_columns(&mut self) {
        let at_ends = self.at_ends();
        if at_ends.len() < SEVERAL || !self.has_pattern() {
            return;
        }
        let torn = self.findings.iter().filter(|own| is_pattern(own)).flat_map(|own| &own.series);
        let mut torn: Vec<&str> = torn.map(String::as_str).collect();
        torn.dedup();
        let sentence = format!(
            "{} lie at ends of their ranges, and the residuals of {} are not random: first check how the \
             data are read, that is the unit of {}, and unit and sign of the columns of outputs and \
             inputs. Until then neither the ranges nor the intervals say anything.",
            suggest::listed(&at_ends),
            torn.join(", "),
            abscissas(&self.series)
        );
        let finding = Finding::new(FindingKind::Misread, sentence).severity(Severity::Serious);
        let finding = finding.parameters(at_ends);
        self.findings.insert(0, finding);
    }

    /// Adds what was said of the data when they were read. Where the fit has a pattern, what may be the
    /// cause of it comes first.
    pub fn add_notes(&mut self, notes: Vec<Finding>) {
        let is_cause = |own: &Finding| self.has_pattern() && own.severity > Severity::Information;
        let (mut first, last): (Vec<_>, Vec<_>) = notes.into_iter().partition(is_cause);
        first.append(&mut self.findings);
        first.extend(last);
        self.findings = first;
    }

    /// The smallest coefficient of determination of the series.
    fn smallest_r_squared(&self) -> Option<f64> {
        smallest(&self.series)
    }

    /// Whether one of these readings explains the data far better.
    pub fn is_explained_by(&self, readings: &[Reading]) -> bool {
        let best = best_of(readings);
        // A fit that is worse than a constant explains nothing, however bad the other one is.
        let is_better = |own: f64| best > 0.0 && 1.0 - best < FAR_BETTER * (1.0 - own);
        self.smallest_r_squared().is_some_and(is_better)
    }

    /// Says how well the model fits columns that are read otherwise.
    pub fn add_readings(&mut self, readings: &[Reading]) {
        let known = readings.iter().filter_map(|reading| Some((reading, reading.r_squared?)));
        let Some(own) = self.smallest_r_squared() else { return };
        let (best, is_better) = (best_of(readings), self.is_explained_by(readings));
        if is_better && self.may_be_misread() {
            self.findings.iter_mut().for_each(range_notes::leave_out_remedy);
        } else if is_better {
            // With one parameter at an end, another unit may explain no more than a wider range.
            let sentence = "The data may also be read wrongly.";
            let finding = Finding::new(FindingKind::Misread, sentence).severity(Severity::Serious);
            let is_range = |own: &&Finding| own.kind == FindingKind::AtBound;
            let place = self.findings.iter().take_while(is_range).count();
            self.findings.insert(place, finding);
        }
        let own_finding = self.findings.iter_mut().find(|own| own.kind == FindingKind::Misread);
        // That none is better proves nothing: a short fit may miss the minimum, and two columns may be
        // read wrongly at once.
        let Some(finding) = own_finding.filter(|_| is_better) else { return };
        let good = known.filter(|(_, found)| 1.0 - found <= AS_GOOD * (1.0 - best));
        let words: Vec<String> =
            good.map(|(own, r)| format!("{} (R² {})", own.words, significant(r, 4))).collect();
        finding.sentence += &format!(
            " A short fit explains the data far better with {}; as they are, R² is {}.",
            words.join(", or with "),
            significant(own, 3)
        );
    }
}

fn best_of(readings: &[Reading]) -> f64 {
    readings.iter().filter_map(|own| own.r_squared).fold(f64::NEG_INFINITY, f64::max)
}

pub(super) fn is_pattern(finding: &Finding) -> bool {
    let is_kind = matches!(finding.kind, FindingKind::Autocorrelation | FindingKind::PoorFit);
    // Two outputs with errors in common have no pattern each.
    is_kind && finding.series.len() == 1
}

fn abscissas(series: &[SolvedSeries]) -> String {
    let column = |own: &SolvedSeries| match own.x_column.is_empty() {
        true => format!("`{}`", own.x[0]),
        false => format!("the column `{}`", own.x_column),
    };
    let mut names: Vec<String> = series.iter().map(column).collect();
    names.sort();
    names.dedup();
    names.join(", ")
}

fn smallest(series: &[SolvedSeries]) -> Option<f64> {
    series.iter().filter_map(|own| own.r_squared).min_by(f64::total_cmp)
}

/// The smallest coefficient of determination of the series of a problem after a fit, and the
/// simulations that it took: `evaluations` from starts all over the ranges, then least squares from the
/// best of these, from `estimate` and from the middle of the ranges. In a house with two capacities, of
/// which the times are in hours, 200 evaluations alone end far from the minimum.
///
/// # Errors
///
/// Those of the simulators' maker.
pub fn short_fit(
    mut problem: super::Problem,
    (evaluations, estimate): (u64, &[f64]),
    processors: &Processors,
    cancel: Option<Arc<AtomicBool>>,
) -> Result<(Option<f64>, u64), Fault> {
    let method = registry::find("method", METHODS, "multistart")?;
    problem.method = (method.make)(&mut Options::default())?;
    problem.stop = Stop { evaluations: Some(evaluations), ..Stop::default() };
    let mut run = Run::on(problem, processors)?;
    run.evaluation.cancel_by(cancel);
    while run.stop().is_none() && run.step(0.0).is_some() {}
    let found = run.observed.best.as_ref().map(|best| best.values.clone());
    let middle = run.problem.parameters.iter().map(|free| free.value(0.5)).collect();
    let starts: Vec<Vec<f64>> = found.iter().cloned().chain([estimate.to_vec(), middle]).collect();
    let (fitted, simulations) = best_fit(&run, &starts)?;
    let simulations = run.simulations + simulations;
    let best = fitted.or(found);
    let Some(row) = best.and_then(|values| run.evaluation.simulate(&values).ok()) else {
        return Ok((None, simulations));
    };
    let mut rest = &row[..];
    let solved = run.problem.series.iter().map(|own| {
        let (simulated, others) = rest.split_at(own.x.len());
        rest = others;
        SolvedSeries::new(own, simulated)
    });
    Ok((smallest(&solved.collect::<Vec<_>>()), simulations))
}

/// An output of which all values are multiplied by a factor.
pub type Scale<'a> = (&'a str, f64);

/// How well a problem may explain its data with each of these scales of an output: the largest coefficient
/// of determination at `count` points all over the ranges, the smallest of all series. These are the
/// simulations that it takes: other scales need none. The result is followed by their number.
///
/// # Errors
///
/// Those of the simulators' maker.
pub fn promises(
    problem: super::Problem,
    (scales, count): (&[Scale<'_>], usize),
    processors: &Processors,
    cancel: Option<Arc<AtomicBool>>,
) -> Result<(Vec<f64>, u64), Fault> {
    // Multiples of the golden ratio are spread over an interval, those of its multiples over a cube.
    const GOLDEN: f64 = 0.618_033_988_749_894_9;
    let mut run = Run::on(problem, processors)?;
    run.evaluation.cancel_by(cancel);
    let fraction = |k: usize, step: f64| ((k + 1) as f64 * step).fract();
    let point = |k: usize| {
        let steps = (1..).map(|own| f64::from(own) * GOLDEN);
        let free = run.problem.parameters.iter().zip(steps);
        free.map(|(own, step)| own.value(fraction(k, step))).collect::<Vec<f64>>()
    };
    let points: Vec<Vec<f64>> = (0..count).map(point).collect();
    let rows: Vec<Vec<f64>> =
        run.evaluation.simulate_all(&points).into_iter().filter_map(Result::ok).collect();
    let of_scale = |(name, factor): &Scale<'_>| {
        let of_row = |row: &Vec<f64>| {
            let mut rest = &row[..];
            let series = run.problem.series.iter().map(|own| {
                let (simulated, others) = rest.split_at(own.x.len());
                rest = others;
                let factor = if own.y_name == *name { *factor } else { 1.0 };
                explained(own.y.iter().map(|y| factor * y), simulated)
            });
            series.fold(f64::INFINITY, f64::min)
        };
        rows.iter().map(of_row).fold(f64::NEG_INFINITY, f64::max)
    };
    Ok((scales.iter().map(of_scale).collect(), count as u64))
}

/// The coefficient of determination.
fn explained(measured: impl Iterator<Item = f64> + Clone, simulated: &[f64]) -> f64 {
    let mean = measured.clone().sum::<f64>() / simulated.len().max(1) as f64;
    let square = |value: f64| value * value;
    let total: f64 = measured.clone().map(|y| square(y - mean)).sum();
    let rest: f64 = measured.zip(simulated).map(|(y, own)| square(y - own)).sum();
    1.0 - rest / total
}

/// The best values of least squares from these starts, and the simulations that they took; `None` where
/// the objective is no sum of squares.
fn best_fit(run: &Run, starts: &[Vec<f64>]) -> Result<(Option<Vec<f64>>, u64), Fault> {
    let Some(mut refit) = Refit::new(&run.problem, &run.evaluation) else { return Ok((None, 0)) };
    let mut best: Option<Fitted> = None;
    for start in starts {
        if refit.is_cancelled() {
            break;
        }
        let fitted = refit.from(start, None)?;
        best = best.into_iter().chain(fitted).min_by(|a, b| a.1.total_cmp(&b.1));
    }
    Ok((best.map(|(values, _)| values), refit.simulations))
}
