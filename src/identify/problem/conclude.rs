//! What follows the search, at its best point: deviations given as formulas are taken at the
//! simulated values, and the solver's tolerance is held against the errors of the data. Where the
//! best point moves, the fit is repeated from there by least squares.

use super::checks::rms;
use super::minimum_test::is_at_minimum;
use super::run::Cause;
use super::{
    Best, ErrorModel, Finding, FindingKind, Problem, Run, Series, Severity, Sigma, curvature, held,
    limits, saddle,
};
use crate::diag::Fault;
use crate::elementary;
use crate::fitness::{Fitness, median_deviation};
use crate::table::significant;

/// The tolerance is divided by this.
const TIGHTER: f64 = 100.0;
/// Predictions may move by this part of a standard deviation.
const PART: f64 = 0.1;
/// Tightened at most so often: from 1e-3 to 1e-11.
const TIMES: usize = 4;
/// No solver is asked for less.
const SMALLEST: f64 = 1e-13;
/// A fit that is worse by more than this at a finer tolerance was one to data made at the coarse.
const WORSE: f64 = 1.1;
/// Repetitions with deviations taken at the last fit.
const REWEIGHTED: usize = 20;
/// Deviations that change by less than this are those of the fit.
const SETTLED: f64 = 1e-7;

/// Concludes a run: call it once, before [`Solution::of`](super::Solution::of). What cannot be done
/// becomes a finding; the best point is never lost.
pub fn conclude(run: &mut Run) {
    // Another driver may conclude a run in progress.
    run.conclusion = super::Conclusion::default();
    let done = saddle::leave(run)
        .and_then(|()| reweigh(run))
        .and_then(|()| rescale(run))
        .map(|()| limits::finish(run))
        .map(|()| curvature::finish(run))
        .and_then(|()| held::finish(run))
        .and_then(|()| tolerance(run));
    if let Err(fault) = done {
        let sentence = format!("The fit could not be repeated: {}.", fault.message);
        run.conclusion.findings.push(Finding::new(FindingKind::Missing, sentence));
    }
}

/// Weights at the simulated values, where sigma is a formula; repeated until they stay.
fn reweigh(run: &mut Run) -> Result<(), Fault> {
    let is_formula = |series: &Series| matches!(series.sigma, Sigma::Formula(_));
    if !run.problem.series.iter().any(is_formula) || run.evaluation.scales().is_none() {
        return Ok(());
    }
    for _ in 0..REWEIGHTED {
        let Some(best) = run.observed.best.clone() else { return Ok(()) };
        let Ok(simulated) = run.evaluation.simulate(&best.values) else { return Ok(()) };
        let weights = weights_at(&run.problem, &simulated);
        if weights.iter().any(|weight| !weight.is_finite() || *weight <= 0.0) {
            let sentence = "The formula of a sigma is not positive at the fit: sigma is \
                            evaluated at the measured values instead.";
            run.conclusion.findings.push(Finding::new(FindingKind::ErrorModel, sentence));
            return Ok(());
        }
        let pairs = weights.iter().zip(run.evaluation.weights());
        let change = pairs.fold(0.0, |most: f64, (new, old)| most.max((new / old - 1.0).abs()));
        run.evaluation.reweigh(&run.problem, weights);
        run.refit()?;
        if change < SETTLED {
            break;
        }
    }
    Ok(())
}

/// The scale of a robust fitness, estimated at the best point as the median absolute residual,
/// and the fit with it; repeated until it stays.
fn rescale(run: &mut Run) -> Result<(), Fault> {
    if run.problem.objectives.len() != 1 {
        return Ok(());
    }
    let (mut last, mut estimated): (f64, Option<Box<dyn Fitness>>) = (0.0, None);
    for _ in 0..REWEIGHTED {
        let Some(best) = run.observed.best.clone() else { return Ok(()) };
        let Ok(simulated) = run.evaluation.simulate(&best.values) else { return Ok(()) };
        let residuals = weighted(run, &simulated);
        let freedom = residuals.len().saturating_sub(best.values.len()).max(1);
        // Residuals of a fit are smaller than the errors.
        let correction = (residuals.len() as f64 / freedom as f64).sqrt();
        let scale = correction * median_deviation(&residuals);
        let known = estimated.as_ref().unwrap_or(&run.problem.objectives[0].1).with_scale(scale);
        let Some(known) = known.filter(|_| scale > 0.0) else { return Ok(()) };
        let before = std::mem::replace(&mut run.problem.objectives[0].1, known);
        estimated.get_or_insert(before);
        run.refit()?;
        if (scale / last - 1.0).abs() < SETTLED {
            break;
        }
        last = scale;
    }
    Ok(())
}

/// The residuals in units of their weights.
fn weighted(run: &Run, simulated: &[f64]) -> Vec<f64> {
    run.evaluation.standard_residuals(&run.problem, simulated)
}

fn weights_at(problem: &Problem, simulated: &[f64]) -> Vec<f64> {
    let mut rest = simulated;
    let mut weights = Vec::with_capacity(simulated.len());
    for series in &problem.series {
        let (own, others) = rest.split_at(series.y.len());
        weights.extend(match series.sigma {
            Sigma::Formula(_) => series.weights_at(own),
            _ => series.weights(),
        });
        rest = others;
    }
    weights
}

/// Residuals smaller than this part of the data are not noise of measurements, for which a finer
/// solver would be worth its time: most instruments read fewer than seven digits. Chosen on one
/// simulated problem (a tank at tolerance 1e-8, where 1e-8 let it repeat the fit), not measured on
/// more.
const WITHOUT_NOISE: f64 = 1e-7;

/// Simulates the best point with the tolerance divided by 100; where predictions move by more than
/// a tenth of a standard deviation of the data, or the search has ended where errors of the
/// simulation hide the minimum, the fit is repeated there, until neither is so.
fn tolerance(run: &mut Run) -> Result<(), Fault> {
    let Some(first) = run.observed.best.clone() else { return Ok(()) };
    let (noise, mut factor) = (run.problem.noise, 1.0);
    let Ok(mut coarse) = run.evaluation.simulate(&first.values) else { return Ok(()) };
    let allowed = errors(run, &coarse);
    let without_noise = rms(&allowed) <= WITHOUT_NOISE * rms(&coarse);
    if without_noise && ErrorModel::of(&run.problem) == ErrorModel::OneVariance {
        return Ok(());
    }
    let (mut moved, mut most) = (false, 0.0f64);
    let mut is_minimum = at_minimum(run);
    for _ in 0..TIMES {
        let next = factor / TIGHTER;
        if noise * next < SMALLEST {
            break;
        }
        let Some(best) = run.observed.best.clone() else { break };
        run.evaluation.scale_tolerance(next);
        run.conclusion.simulations += 1;
        let fine = run.evaluation.simulate(&best.values);
        let shift = fine.as_ref().map_or(0.0, |fine| shift(&coarse, fine, &allowed, run));
        if shift <= PART && (is_minimum || fine.is_err()) {
            run.evaluation.scale_tolerance(factor);
            run.conclusion.resolved = fine.is_ok() && coarse != fine.unwrap_or_default();
            break;
        }
        (moved, most, factor) = (true, most.max(shift), next);
        run.problem.noise = noise * factor;
        run.refit()?;
        let Some(best) = &run.observed.best else { break };
        let Ok(again) = run.evaluation.simulate(&best.values) else { break };
        coarse = again;
        is_minimum = at_minimum(run);
    }
    if !moved {
        return Ok(());
    }
    let worse = run.observed.best.as_ref().is_some_and(|best| best.fitness > WORSE * first.fitness);
    // Data that a coarse simulation has made.
    let made =
        worse && first.fitness > 0.0 && ErrorModel::of(&run.problem) == ErrorModel::OneVariance;
    if made || most <= PART && !is_minimum {
        run.evaluation.scale_tolerance(1.0);
        run.problem.noise = noise;
        run.conclusion.resolved = false;
        run.observed.best = Some(first);
        return Ok(());
    }
    let finding = coarse_solver(run, &first, [noise, noise * factor], most);
    run.conclusion.findings.push(finding);
    Ok(())
}

/// Whether nothing better is to be had from a finer solver: the best point is a minimum, or that
/// cannot be tested, or the search was ended before it came to one.
fn at_minimum(run: &mut Run) -> bool {
    let is_at_limit = run
        .observed
        .best
        .as_ref()
        .is_some_and(|b| limits::along(&run.problem, &b.values).is_some());
    let is_known = run.conclusion.by_curvature.is_some() || !run.conclusion.held.is_empty();
    if run.cause() != Cause::Converged || is_known || is_at_limit {
        return true;
    }
    let Some((is_minimum, simulations)) = is_at_minimum(run) else { return true };
    run.conclusion.simulations += simulations;
    is_minimum
}

/// Standard deviation of each point: the given or estimated one, else that of the residuals.
fn errors(run: &Run, simulated: &[f64]) -> Vec<f64> {
    let weights = run.evaluation.error_weights(&run.problem, simulated);
    let square: f64 = weighted(run, simulated).iter().map(|r| r * r).sum();
    let size = match ErrorModel::of(&run.problem) {
        ErrorModel::OneVariance => (square / simulated.len() as f64).sqrt(),
        _ => 1.0,
    };
    weights.iter().map(|weight| size / weight).collect()
}

/// The largest root mean square of a series' movement in units of its errors.
fn shift(coarse: &[f64], fine: &[f64], errors: &[f64], run: &Run) -> f64 {
    let (mut first, mut most) = (0, 0.0f64);
    for series in &run.problem.series {
        let n = series.y.len();
        let part = |j: usize| {
            elementary::powi((coarse[j] - fine[j]) / errors[j].max(f64::MIN_POSITIVE), 2)
        };
        most = most.max(((first..first + n).map(part).sum::<f64>() / n as f64).sqrt());
        first += n;
    }
    most
}

fn coarse_solver(run: &Run, first: &Best, [before, after]: [f64; 2], moved: f64) -> Finding {
    let fitted = run.evaluation.scales().is_some();
    let values = |values: &[f64]| {
        let pairs = run.problem.parameters.iter().zip(values);
        let one = |(free, value): (&super::Free, &f64)| {
            format!("{} = {}", free.name, significant(*value, 6))
        };
        pairs.map(one).collect::<Vec<_>>().join(", ")
    };
    let best = run.observed.best.as_ref().map_or(&first.values, |best| &best.values);
    let consequence = match fitted {
        true => format!(
            "The fit was repeated with the tolerance {}: {} instead of {}",
            significant(after, 2),
            values(best),
            values(&first.values)
        ),
        false => "This fitness does not allow least squares from there".to_owned(),
    };
    let trouble = match moved > PART {
        true => format!(
            "is too coarse for these data: with a finer one the simulated points move by {} standard \
             deviations of the data",
            significant(moved, 2)
        ),
        false => "causes errors that hide the minimum".to_owned(),
    };
    Finding::new(
        FindingKind::SolverTolerance,
        format!(
            "The tolerance {} of the solver {trouble}. {consequence}. Set `tolerance = {}` in the \
             experiment.",
            significant(before, 2),
            significant(after, 2)
        ),
    )
    .severity(if fitted { Severity::Information } else { Severity::Serious })
    .statistic(moved, PART)
}
