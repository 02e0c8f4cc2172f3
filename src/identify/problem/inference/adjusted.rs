//! A problem with priors, constraints and data that are fitted by their logarithms.
//!
//! Everything is brought into the form of least squares, so that every method, every statistic and
//! the profiles take part: a prior is one more point, measured at its mean with its standard
//! deviation (the maximum a posteriori estimate), log-normal data are compared by their
//! logarithms, and a point that violates a constraint is refused before it is simulated.

use super::{Constraint, PortableConstraint};
use crate::diag::Fault;
use crate::fitness::Law;
use crate::problem::distributions::normal_below;
use crate::problem::{
    ErrorModel, Failed, FailureKind, LIKELIHOOD, Portable, Problem, Role, Series, Sigma, Simulate,
    likelihood,
};
use crate::registry::BAD_OPTION;
use crate::{bail, elementary, fault};
use serde::{Deserialize, Serialize};
use std::ops::Range;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

/// The experiment to which the points of priors belong.
const PRIOR: &str = "(prior)";

/// What is known of a parameter without the data.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub enum Distribution {
    /// Normal.
    Normal {
        /// Mean.
        mean: f64,
        /// Standard deviation.
        sd: f64,
    },
    /// The logarithm is normal.
    LogNormal {
        /// Median.
        median: f64,
        /// Exponential of the standard deviation of the logarithm: two thirds lie within the
        /// median divided and multiplied by it.
        factor: f64,
    },
    /// Of Laplace.
    Laplace {
        /// Median.
        median: f64,
        /// Mean absolute deviation from it.
        scale: f64,
    },
    /// The logarithm is of Laplace.
    LogLaplace {
        /// Median.
        median: f64,
        /// Exponential of the scale of the logarithm.
        factor: f64,
    },
    /// Uniform over the range, whatever the scale of the search.
    Uniform,
    /// The logarithm is uniform over the range.
    LogUniform,
}

/// The prior of a parameter.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Prior {
    /// The place of the parameter.
    pub parameter: usize,
    /// Its distribution.
    pub distribution: Distribution,
    /// What is added to -log L, as the density is one of another coordinate, or truncated.
    pub constant: f64,
}

/// What is added to a problem.
#[derive(Debug, Clone, Default)]
pub struct Adjustments {
    /// Priors.
    pub priors: Vec<Prior>,
    /// Constraints between parameters.
    pub constraints: Vec<Constraint>,
    /// Series whose data are log-normal.
    pub logarithmic: Vec<usize>,
}

impl Prior {
    /// What the point of this prior is compared with, and the scale of its density; `None` for a
    /// uniform one.
    pub fn point(&self) -> Option<(f64, f64)> {
        match self.distribution {
            Distribution::Normal { mean: centre, sd: scale }
            | Distribution::Laplace { median: centre, scale } => Some((centre, scale)),
            Distribution::LogNormal { median, factor }
            | Distribution::LogLaplace { median, factor } => {
                Some((elementary::ln(median), elementary::ln(factor)))
            }
            Distribution::Uniform | Distribution::LogUniform => None,
        }
    }

    /// Whether it is the logarithm that counts.
    pub fn is_logarithmic(&self) -> bool {
        matches!(
            self.distribution,
            Distribution::LogNormal { .. }
                | Distribution::LogLaplace { .. }
                | Distribution::LogUniform
        )
    }

    /// The density of its point.
    fn law(&self) -> Law {
        match self.distribution {
            Distribution::Laplace { .. } | Distribution::LogLaplace { .. } => Law::Laplace,
            _ => Law::Normal,
        }
    }

    /// The probability of values between two limits.
    pub fn probability(&self, limits: [f64; 2]) -> f64 {
        let Some((centre, scale)) = self.point() else { return 1.0 };
        let [low, high] = limits.map(|limit| {
            let own = if self.is_logarithmic() { elementary::ln(limit.max(0.0)) } else { limit };
            let u = (own - centre) / scale;
            match self.law() {
                Law::Laplace if u < 0.0 => 0.5 * elementary::exp(u),
                Law::Laplace => 1.0 - 0.5 * elementary::exp(-u),
                _ => normal_below(u),
            }
        });
        high - low
    }

    /// Centre and standard deviation.
    pub(crate) fn spread(&self) -> Option<(f64, f64)> {
        let (centre, scale) = self.point()?;
        let of_scale = if self.law() == Law::Laplace { std::f64::consts::SQRT_2 } else { 1.0 };
        Some((centre, of_scale * scale))
    }
}

/// What an adjustment cannot be made for, by its number among the parameters or series of the problem.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Cause {
    /// The prior of a parameter.
    Prior(usize),
    /// The log-normal errors of a series.
    Series(usize),
}

/// Adds priors, constraints and logarithms to a problem.
///
/// # Errors
///
/// Priors without known standard deviations or of impossible numbers, measured values that have
/// no logarithm.
pub fn adjust(problem: &mut Problem, added: Adjustments) -> Result<(), (Cause, Fault)> {
    let points = problem.n_points();
    let logarithmic = logarithms(problem, &added.logarithmic)?;
    let weighed: Vec<Prior> =
        added.priors.iter().copied().filter(|prior| prior.point().is_some()).collect();
    for prior in &weighed {
        let series = weighable(problem).and_then(|()| pseudo_series(problem, prior));
        let series = series.map_err(|fault| (Cause::Prior(prior.parameter), fault))?;
        problem.series.push(series);
    }
    if let Some(last) = weighed.last().filter(|_| ErrorModel::of(problem).is_likelihood()) {
        // The likelihood counts the points of the priors as well.
        let all = likelihood(&problem.series, problem.noise);
        let all = all.map_err(|(_, fault)| (Cause::Prior(last.parameter), fault))?;
        problem.objectives[0] = (LIKELIHOOD.to_owned(), all);
    }
    problem.inference.priors = added.priors;
    problem.inference.logarithmic = added.logarithmic;
    problem.inference.constraints.clone_from(&added.constraints);
    if weighed.is_empty() && added.constraints.is_empty() && logarithmic.is_empty() {
        return Ok(());
    }
    let shared =
        Arc::new(Shared { points, logarithmic, priors: weighed, constraints: added.constraints });
    let refuse: Box<dyn Fn() -> Result<Box<dyn Simulate>, Fault> + Send + Sync> =
        Box::new(|| Err(fault!(BAD_OPTION, "there is no simulator")));
    let inner = std::mem::replace(&mut problem.simulator, refuse);
    problem.simulator = Box::new(move || {
        Ok(Box::new(Adjusted { inner: inner()?, shared: Arc::clone(&shared) }) as Box<dyn Simulate>)
    });
    Ok(())
}

/// Refuses priors where the measured points have no weight of their own.
fn weighable(problem: &Problem) -> Result<(), Fault> {
    let (error_model, objective) = (ErrorModel::of(problem), &problem.objectives[0].0);
    if error_model == ErrorModel::OneVariance {
        bail!(
            BAD_OPTION,
            "a prior must be weighted against the data, but the standard deviations of the data \
             are unknown";
            help: "give `sigma` for every output, or `sigma = \"estimate\"`"
        );
    }
    if error_model == ErrorModel::Known && objective != "sum_of_squares" {
        bail!(BAD_OPTION, "`{objective}` cannot be weighted against a \
                           prior"; help: "minimize `sum_of_squares`");
    }
    Ok(())
}

/// The measured values of these series become logarithms; their points in the row of all.
fn logarithms(
    problem: &mut Problem,
    series: &[usize],
) -> Result<Vec<Range<usize>>, (Cause, Fault)> {
    let mut ranges = Vec::new();
    let mut first = 0;
    for (k, own) in problem.series.iter_mut().enumerate() {
        let range = first..first + own.x.len();
        first = range.end;
        if !series.contains(&k) {
            continue;
        }
        if let Some(place) = own.y.iter().position(|y| *y <= 0.0) {
            let fault = fault!(
                BAD_OPTION,
                "`{}` is log-normal, but {} was measured at {} = {}", own.y_name, own.y[place], own.x_name, own.x[place];
                help: "remove such points, or use a normal error"
            );
            return Err((Cause::Series(k), fault));
        }
        if matches!(own.sigma, Sigma::Formula(_)) {
            let fault = fault!(BAD_OPTION, "`{}` is log-normal, and its sigma is a formula", own.y_name; help: "give the standard deviation of the logarithm as a number");
            return Err((Cause::Series(k), fault));
        }
        own.y.iter_mut().for_each(|y| *y = elementary::ln(*y));
        own.y_name = format!("ln({})", own.y_name);
        own.y_unit = String::new();
        ranges.push(range);
    }
    Ok(ranges)
}

/// A prior as a measured point.
fn pseudo_series(problem: &Problem, prior: &Prior) -> Result<Series, Fault> {
    let name = &problem.parameters[prior.parameter].name;
    let point = prior.point().filter(|(mean, sd)| mean.is_finite() && sd.is_finite() && *sd > 0.0);
    let logarithm = prior.is_logarithmic();
    let Some((mean, sd)) = point else {
        bail!(BAD_OPTION, "the prior of `{name}` has no width or no centre"; help: "write `prior = {{ mean = 1, sd = 0.1 }}` or `prior = {{ median = 1, factor = 1.5 }}`, the factor above 1")
    };
    if logarithm && problem.parameters[prior.parameter].min <= 0.0 {
        bail!(BAD_OPTION, "the prior of `{name}` is one of its logarithm, but its range starts at \
                           {}", problem.parameters[prior.parameter].min; help: "give a positive minimum");
    }
    Ok(Series {
        role: Role::Prior,
        experiment: PRIOR.to_owned(),
        y_name: if logarithm { format!("ln({name})") } else { name.clone() },
        y_unit: String::new(),
        x_name: String::new(),
        x_unit: String::new(),
        file: String::new(),
        x: vec![0.0],
        y: vec![mean],
        weight: 1.0,
        relative: Vec::new(),
        sigma: Sigma::Given(vec![sd]),
        law: prior.law(),
        censored: Vec::new(),
        column: String::new(),
        x_column: String::new(),
        rows: Vec::new(),
        missing: Vec::new(),
        scaling: Default::default(),
        joint: None,
    })
}

struct Shared {
    /// Points that the model simulates.
    points: usize,
    logarithmic: Vec<Range<usize>>,
    priors: Vec<Prior>,
    constraints: Vec<Constraint>,
}

/// [`Shared`] as another process can read it.
#[derive(Serialize, Deserialize)]
struct PortableAdjustments {
    points: usize,
    logarithmic: Vec<Range<usize>>,
    priors: Vec<Prior>,
    constraints: Vec<PortableConstraint>,
}

/// The simulator `inner` with the adjustments that another process has written.
///
/// # Errors
///
/// `bad-option` where these are not such bytes.
pub(crate) fn adjusted_from(
    inner: Box<dyn Simulate>,
    bytes: &[u8],
) -> Result<Box<dyn Simulate>, Fault> {
    let read: PortableAdjustments = postcard::from_bytes(bytes)
        .map_err(|error| fault!(BAD_OPTION, "the adjustments cannot be read: {error}"))?;
    let PortableAdjustments { points, logarithmic, priors, constraints } = read;
    let constraints = constraints.into_iter().map(Constraint::from).collect();
    let shared = Arc::new(Shared { points, logarithmic, priors, constraints });
    Ok(Box::new(Adjusted { inner, shared }))
}

/// A simulator with priors after its points.
struct Adjusted {
    inner: Box<dyn Simulate>,
    shared: Arc<Shared>,
}

impl Shared {
    /// Refuses values that violate a constraint, the nearer to it the better.
    fn check(&self, parameters: &[f64]) -> Result<(), Failed> {
        for constraint in &self.constraints {
            let violation = constraint.violation(parameters);
            if violation > 0.0 {
                let cause = format!("the constraint `{}` does not hold", constraint.text);
                return Err(Failed::new(FailureKind::Model, cause, 0.5 / (1.0 + violation)));
            }
        }
        Ok(())
    }

    fn finish(&self, parameters: &[f64], out: &mut [f64]) -> Result<(), Failed> {
        for range in &self.logarithmic {
            for value in &mut out[range.clone()] {
                if *value <= 0.0 {
                    let cause = "a simulated value of log-normal data is not positive";
                    return Err(Failed::new(FailureKind::Points, cause, 1.0));
                }
                *value = elementary::ln(*value);
            }
        }
        for (value, prior) in out[self.points..].iter_mut().zip(&self.priors) {
            let own = parameters[prior.parameter];
            *value = if prior.is_logarithmic() { elementary::ln(own) } else { own };
        }
        Ok(())
    }
}

impl Shared {
    fn to_bytes(&self) -> Result<Vec<u8>, String> {
        let portable = |own: &Constraint| {
            own.portable().ok_or_else(|| format!("the constraint `{}` is a function", own.text))
        };
        let form = PortableAdjustments {
            points: self.points,
            logarithmic: self.logarithmic.clone(),
            priors: self.priors.clone(),
            constraints: self.constraints.iter().map(portable).collect::<Result<_, _>>()?,
        };
        postcard::to_allocvec(&form).map_err(|error| error.to_string())
    }
}

impl Simulate for Adjusted {
    fn simulate(&mut self, parameters: &[f64], out: &mut [f64]) -> Result<(), Failed> {
        self.shared.check(parameters)?;
        self.inner.simulate(parameters, &mut out[..self.shared.points])?;
        self.shared.finish(parameters, out)
    }

    fn sensitivities(
        &mut self,
        parameters: &[f64],
        out: &mut [f64],
        derivatives: &mut [f64],
    ) -> Result<bool, Failed> {
        self.shared.check(parameters)?;
        let (n, points) = (parameters.len(), self.shared.points);
        let (own, rest) = derivatives.split_at_mut(points * n);
        if !self.inner.sensitivities(parameters, &mut out[..points], own)? {
            return Ok(false);
        }
        for range in &self.shared.logarithmic {
            for place in range.clone() {
                own[place * n..(place + 1) * n].iter_mut().for_each(|d| *d /= out[place]);
            }
        }
        for (row, prior) in rest.chunks_exact_mut(n).zip(&self.shared.priors) {
            row.fill(0.0);
            row[prior.parameter] =
                if prior.is_logarithmic() { 1.0 / parameters[prior.parameter] } else { 1.0 };
        }
        self.shared.finish(parameters, out)?;
        Ok(true)
    }

    fn sensitivity_refusal(&self) -> Option<&str> {
        self.inner.sensitivity_refusal()
    }

    fn scale_tolerance(&mut self, factor: f64) {
        self.inner.scale_tolerance(factor);
    }

    fn portable(&self) -> Result<Portable, String> {
        let inner = Box::new(self.inner.portable()?);
        Ok(Portable::Adjusted { inner, adjustments: self.shared.to_bytes()? })
    }

    fn cancel_by(&mut self, flag: Option<Arc<AtomicBool>>) {
        self.inner.cancel_by(flag);
    }
}
