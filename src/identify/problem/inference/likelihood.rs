//! The likelihood of a fit with normal errors.

use crate::elementary;
use crate::problem::explicit::Explicit;
use crate::problem::joint::{self, is_joint};
use crate::problem::{ErrorModel, Problem, Role, Run, Series, likelihood};
use serde::{Deserialize, Serialize};
use std::f64::consts::TAU;

/// The likelihood of a fit.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Likelihood {
    /// Logarithm of the largest likelihood.
    pub log: f64,
    /// Measured points.
    pub points: usize,
    /// Estimated quantities: parameters, and the standard deviation where it is not given.
    pub estimated: usize,
    /// Whether the standard deviations of the measurements are given.
    pub(crate) known_sigma: bool,
    /// Whether all errors are normal with one variance that is estimated: then ratios of likelihoods
    /// follow the F distribution for linear models, with few points as well.
    #[serde(default)]
    pub(crate) one_variance: bool,
}

/// The sum of the logarithms of log-normal data: what the density of a value is less than that of its
/// logarithm.
fn logarithms(problem: &Problem) -> f64 {
    let own = problem.inference.logarithmic.iter();
    let own = own.filter_map(|k| problem.series.get(*k));
    // A limit has a probability, not a density.
    let measured = |series: &'_ Series| {
        let all = (0..series.y.len()).filter(|k| series.censored.iter().all(|own| own.0 != *k));
        all.map(|k| series.y[k]).sum::<f64>()
    };
    own.map(measured).sum()
}

/// -log L of the data alone where errors are not normal.
fn of_data(problem: &Problem, simulated: &[f64]) -> Option<f64> {
    if problem.is_normal() && !is_joint(&problem.series) {
        return None;
    }
    let is_prior = |series: &&Series| series.role == Role::Prior;
    let data: Vec<Series> = problem.series.iter().filter(|own| !is_prior(own)).cloned().collect();
    let fitness = likelihood(&data, problem.noise).ok()?;
    let measured: Vec<f64> = data.iter().flat_map(|series| series.y.clone()).collect();
    let weights: Vec<f64> = data.iter().flat_map(Series::weights).collect();
    Some(fitness.fitness(&simulated[..measured.len()], &measured, &weights))
}

/// What -log L has beside the objective: densities of log-normal data are those of the values, and
/// densities of priors those of the coordinates in which they are given.
pub fn beside(problem: &Problem) -> f64 {
    let priors = problem.inference.priors.iter();
    logarithms(problem) + priors.map(|prior| prior.constant).sum::<f64>()
}

impl Likelihood {
    /// The likelihood at the best point; `None` where the fitness is not a sum of squares.
    pub(super) fn of(run: &Run, values: &[f64]) -> Option<Likelihood> {
        let problem = &run.problem;
        run.evaluation.scales()?;
        let simulated = run.evaluation.simulate(values).ok()?;
        let weights = run.evaluation.error_weights(problem, &simulated);
        let data = || problem.series.iter().filter(|series| series.is_data());
        let all = problem.series.iter();
        let all = all.flat_map(|series| series.y.iter().map(|y| (*y, series.is_data())));
        let measured: Vec<(f64, f64)> = all
            .zip(simulated.iter().zip(&weights))
            .filter(|((_, is_data), _)| *is_data)
            .map(|((y, _), (s, weight))| (weight * (y - s), *weight))
            .collect();
        let n = measured.len() as f64;
        let square: f64 = measured.iter().map(|(r, _)| r * r).sum();
        let of_weights: f64 = measured.iter().map(|(_, weight)| elementary::ln(*weight)).sum();
        let error_model = ErrorModel::of(problem);
        let of_joint = |own: &&Series| own.joint.is_none();
        let mut names: Vec<&str> = data().filter(of_joint).filter_map(Series::deviation).collect();
        names.sort_unstable();
        names.dedup();
        let (of_residuals, deviations) = match error_model {
            ErrorModel::OneVariance => (0.5 * n * (elementary::ln(square / n) + 1.0), 1),
            ErrorModel::Known | ErrorModel::Computed => (0.5 * square, 0),
            ErrorModel::Estimated => {
                (0.5 * square, names.len() + joint::estimated(&problem.series))
            }
        };
        let log = match of_data(problem, &simulated) {
            Some(negative) => -negative,
            None => of_weights - of_residuals - 0.5 * n * elementary::ln(TAU),
        } - logarithms(problem);
        let relative = Explicit::without_columns(&run.evaluation, values);
        let estimated = values.len() + deviations + relative.map_or(0, |own| own.count());
        let known_sigma = matches!(error_model, ErrorModel::Known | ErrorModel::Computed);
        let is_one = match error_model {
            ErrorModel::OneVariance => true,
            ErrorModel::Estimated => {
                names.len() == 1 && data().all(|own| own.deviation().is_some())
            }
            ErrorModel::Known | ErrorModel::Computed => false,
        };
        let is_plain = problem.is_normal()
            && !is_joint(&problem.series)
            && problem.series.iter().all(Series::is_data);
        let one_variance = is_one && is_plain;
        let points = measured.len();
        let found = Likelihood { log, points, estimated, known_sigma, one_variance };
        log.is_finite().then_some(found)
    }
}
