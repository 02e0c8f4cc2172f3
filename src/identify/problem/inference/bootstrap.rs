//! The bootstrap: the fit is repeated with resampled data, and the spread of the
//! estimates gives intervals that hold where the linear ones do not.
//!
//! Residuals (centred, inflated for the degrees of freedom, drawn within their series), normal
//! noise (parametric), or cases (points drawn with replacement within their series). Intervals by
//! percentiles, their reflection (basic), or bias-corrected and accelerated (BCa), with the
//! acceleration of the infinitesimal jackknife. Every replicate has a substream of random numbers
//! of its own, so that threads do not matter. A resumed run recomputes it, with the same result.
//!
//! References: [Efron & Tibshirani 1993](gapilib_base::bibliography#efron-tibshirani-1993), chapters 9,
//! 13 and 14; [Davison & Hinkley 1997](gapilib_base::bibliography#davison-hinkley-1997), chapter 6.

use super::Local;
use super::least_squares::Data;
use crate::diag::Fault;
use crate::elementary;
use crate::ga::Mrg32k3a;
use crate::problem::distributions::{normal_below, normal_quantile};
use crate::problem::joint::is_joint;
use crate::problem::{ErrorModel, Problem, Role, Run, Simulate, other_shards};
use crate::table::significant;
use serde::{Deserialize, Serialize};
use std::sync::atomic::{AtomicUsize, Ordering};

/// The stream of random numbers, far from those of the search.
const STREAM: u64 = 1_000_003;
/// With more failed replicates than this share the rest is a selection, not a sample.
const FAILED: f64 = 0.05;

/// Where more of the replicates than this stand at an end of the range, their quantiles say nothing
/// (Andrews 2000).
const AT_BOUNDS: f64 = 0.025;

/// What is resampled.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Resampling {
    /// Residuals.
    Residuals,
    /// Normal noise.
    Parametric,
    /// Points.
    Cases,
}

/// How intervals follow from the replicates.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum IntervalKind {
    /// Bias-corrected and accelerated.
    Bca,
    /// Percentiles.
    Percentile,
    /// Percentiles reflected at the estimate.
    Basic,
}

/// What is asked.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BootstrapSettings {
    /// Replicates.
    pub samples: usize,
    /// What is drawn.
    pub resampling: Resampling,
    /// The intervals.
    pub interval: IntervalKind,
}

/// The answer.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct Bootstrap {
    /// What was drawn.
    pub resampling: Resampling,
    /// The kind of interval.
    pub interval: IntervalKind,
    /// Replicates that were fitted.
    pub samples: usize,
    /// Replicates whose fit failed.
    pub failed: usize,
    /// For each parameter.
    pub parameters: Vec<Bootstrapped>,
    /// The estimates of every replicate, in `bootstrap.csv`.
    #[serde(skip)]
    pub estimates: Vec<Vec<f64>>,
}

/// What the bootstrap says about a parameter.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct Bootstrapped {
    /// Its name.
    pub name: String,
    /// Standard deviation of the replicates.
    pub sd: f64,
    /// Mean of the replicates less the estimate.
    pub bias: f64,
    /// The 95 % interval.
    pub interval: [f64; 2],
    /// The share of the replicates at an end of the search range.
    #[serde(default)]
    pub(crate) at_bounds: f64,
}

/// Why there is none with deviations that change with the parameters, which the fits hold.
const OF_COMPUTED: &str = "There is no bootstrap where the model computes the standard deviations, or \
     where errors are not normal: the profiles and the posterior tell how well the parameters are known.";

/// Residuals are drawn one by one.
const OF_JOINT: &str = "There is no bootstrap where the errors of outputs are correlated: the profiles \
     and the posterior tell how well the parameters are known.";

/// The bootstrap; `None` where it is refused.
pub fn bootstrap(
    run: &Run,
    settings: &BootstrapSettings,
    local: &Local,
    refusals: &mut Vec<String>,
) -> Result<Option<Bootstrap>, Fault> {
    let (problem, evaluation) = (&run.problem, &run.evaluation);
    if let Some(why) = refused(problem) {
        refusals.push(why.to_owned());
        return Ok(None);
    }
    let measured: Vec<f64> = problem.series.iter().flat_map(|series| series.y.clone()).collect();
    let source = Mrg32k3a::new(&problem.seed)?.stream(STREAM);
    let begun = AtomicUsize::new(0);
    let job = |number: usize, simulator: &mut dyn Simulate| {
        let begun = 1 + begun.fetch_add(1, Ordering::Relaxed);
        evaluation.show(&format!("bootstrap: fit {begun} of {}", settings.samples));
        let mut rng = source.substream(number as u64);
        let (data, scales) = drawn(problem, settings.resampling, local, &measured, &mut rng);
        let data = Data {
            parameters: &problem.parameters,
            measured: &data,
            scales: &scales,
            relative: evaluation.relative(),
            noise: problem.noise,
        };
        data.fit(simulator, &local.values).filter(|fit| fit.converged).map(|fit| fit.values)
    };
    let fits = evaluation.each_part("bootstrap", &local.values, settings.samples, job);
    let Some(fits) = fits else {
        refusals.push(other_shards("bootstrap"));
        return Ok(None);
    };
    if evaluation.is_cancelled() {
        return Ok(None);
    }
    let estimates: Vec<Vec<f64>> = fits.into_iter().flatten().collect();
    let failed = settings.samples - estimates.len();
    if failed as f64 > FAILED * settings.samples as f64 {
        refusals.push(format!(
            "There is no bootstrap: {failed} of {} fits to resampled data did not reach a minimum.",
            settings.samples
        ));
        return Ok(None);
    }
    let one = |k: usize| {
        let values = estimates.iter().map(|values| values[k]).collect();
        bootstrapped(problem, settings, local, (k, values))
    };
    let parameters = (0..local.values.len()).map(one).collect();
    Ok(Some(Bootstrap {
        resampling: settings.resampling,
        interval: settings.interval,
        samples: estimates.len(),
        failed,
        parameters,
        estimates,
    }))
}

/// Why there is none.
fn refused(problem: &Problem) -> Option<&'static str> {
    if is_joint(&problem.series) {
        return Some(OF_JOINT);
    }
    let is_computed = ErrorModel::of(problem) == ErrorModel::Computed || !problem.is_normal();
    is_computed.then_some(OF_COMPUTED)
}

/// What the replicates say about a parameter.
fn bootstrapped(
    problem: &Problem,
    settings: &BootstrapSettings,
    local: &Local,
    (k, mut values): (usize, Vec<f64>),
) -> Bootstrapped {
    let mean = values.iter().sum::<f64>() / values.len() as f64;
    let square: f64 = values.iter().map(|value| elementary::powi(value - mean, 2)).sum();
    values.sort_by(f64::total_cmp);
    let free = &problem.parameters[k];
    let is_at = |value: &&f64| **value <= free.min || **value >= free.max;
    Bootstrapped {
        at_bounds: values.iter().filter(is_at).count() as f64 / values.len() as f64,
        name: free.name.clone(),
        sd: (square / (values.len() as f64 - 1.0)).sqrt(),
        bias: mean - local.values[k],
        interval: interval(settings.interval, &values, local.values[k], acceleration(local, k)),
    }
}

/// Data of one replicate and their scales.
fn drawn(
    problem: &Problem,
    resampling: Resampling,
    local: &Local,
    measured: &[f64],
    rng: &mut Mrg32k3a,
) -> (Vec<f64>, Vec<f64>) {
    let (mut data, mut scales) = (measured.to_vec(), local.scales.clone());
    let inflate = (local.scales.len() as f64 / local.freedom).sqrt();
    let mut first = 0;
    for series in &problem.series {
        let n = series.x.len();
        let own = first..first + n;
        first += n;
        let pick = |rng: &mut Mrg32k3a| ((rng.uniform() * n as f64) as usize).min(n - 1);
        let mean = local.residuals[own.clone()].iter().sum::<f64>() / n as f64;
        // A prior is one point whose distribution is known: it is drawn from that.
        let resampling =
            if series.role == Role::Prior { Resampling::Parametric } else { resampling };
        match resampling {
            Resampling::Residuals => {
                for place in own.clone() {
                    let residual = local.residuals[own.start + pick(rng)] - mean;
                    data[place] = local.simulated[place] + inflate * residual / local.scales[place];
                }
            }
            Resampling::Parametric => {
                for place in own {
                    let error =
                        local.variance_of_points.sqrt() * rng.normal() / local.scales[place];
                    data[place] = local.simulated[place] + error;
                }
            }
            Resampling::Cases => {
                let mut counts = vec![0.0; n];
                (0..n).for_each(|_| counts[pick(rng)] += 1.0);
                for (place, count) in own.zip(counts) {
                    scales[place] *= f64::sqrt(count);
                }
            }
        }
    }
    (data, scales)
}

/// Skewness of the influence of the points on a parameter, by six.
fn acceleration(local: &Local, k: usize) -> f64 {
    let Some(covariance) = local.information.covariance() else { return 0.0 };
    let influence = |(j, residual): (usize, &f64)| {
        let row = local.jacobian.row(j);
        let part: f64 = (0..row.len()).map(|l| covariance[(k, l)] * row[l]).sum();
        part * residual
    };
    let all: Vec<f64> = local.residuals.iter().enumerate().map(influence).collect();
    let square: f64 = all.iter().map(|u| u * u).sum();
    let cube: f64 = all.iter().map(|u| u * u * u).sum();
    if square > 0.0 { cube / (6.0 * elementary::powf(square, 1.5)) } else { 0.0 }
}

/// The 95 % interval of ordered replicates.
fn interval(kind: IntervalKind, ordered: &[f64], estimate: f64, acceleration: f64) -> [f64; 2] {
    let ends = [0.025, 0.975];
    match kind {
        IntervalKind::Percentile => ends.map(|p| quantile(ordered, p)),
        IntervalKind::Basic => {
            let [low, high] = ends.map(|p| quantile(ordered, p));
            [2.0 * estimate - high, 2.0 * estimate - low]
        }
        IntervalKind::Bca => {
            let n = ordered.len() as f64;
            let below = ordered.iter().filter(|value| **value < estimate).count() as f64;
            let bias = normal_quantile((below / n).clamp(0.5 / n, 1.0 - 0.5 / n));
            ends.map(|p| {
                let z = bias + normal_quantile(p);
                quantile(ordered, normal_below(bias + z / (1.0 - acceleration * z)))
            })
        }
    }
}

/// The quantile of ordered values, linear between them (type 7 of Hyndman and Fan).
pub fn quantile(ordered: &[f64], p: f64) -> f64 {
    let place = p.clamp(0.0, 1.0) * (ordered.len() - 1) as f64;
    let low = place.floor() as usize;
    let high = (low + 1).min(ordered.len() - 1);
    ordered[low] + (place - low as f64) * (ordered[high] - ordered[low])
}

impl Bootstrap {
    /// In words.
    pub(super) fn sentences(&self) -> Vec<String> {
        let drawn = match self.resampling {
            Resampling::Residuals => "resampled residuals",
            Resampling::Parametric => "newly drawn normal noise",
            Resampling::Cases => "resampled points",
        };
        let kind = match self.interval {
            IntervalKind::Bca => "bias-corrected and accelerated, BCa",
            IntervalKind::Percentile => "percentiles",
            IntervalKind::Basic => "basic",
        };
        let failed =
            if self.failed == 0 { String::new() } else { format!(", {} fits failed", self.failed) };
        let mut sentences =
            vec![format!("{} fits to {drawn}, 95 % intervals ({kind}){failed}:", self.samples)];
        sentences.extend(self.parameters.iter().map(|p| {
            if p.at_bounds > AT_BOUNDS {
                return format!(
                    "{} has no interval: {} % of the fits end at an end of its search range, where \
                     the bootstrap is not valid. Its profile likelihood is",
                    p.name,
                    significant(100.0 * p.at_bounds, 3)
                );
            }
            let [low, high] = p.interval.map(|end| significant(end, 4));
            format!(
                "{} in {low} to {high}, standard deviation {}, bias {}",
                p.name,
                significant(p.sd, 2),
                significant(p.bias, 2)
            )
        }));
        sentences
    }

    /// `bootstrap.csv`: the estimates of all replicates.
    pub fn csv(&self) -> String {
        crate::table::table_csv(self.parameters.iter().map(|p| p.name.as_str()), &self.estimates)
    }
}

#[cfg(test)]
mod tests;
