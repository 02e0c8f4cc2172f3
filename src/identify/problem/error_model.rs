//! The standard deviations of the measurements: given, a formula of the output, or estimated.

use super::{Finding, FindingKind, Problem, Role, Series, Severity, joint};
use crate::diag::Fault;
use crate::fault;
use crate::fitness::{Concentrated, Deviation, Fitness};
use crate::registry::BAD_OPTION;
use serde::{Deserialize, Serialize};
use std::sync::Arc;

/// A deviation that is estimated is at least this many times the error of the simulation: a model
/// that passes through all points of a series would else be infinitely likely.
const FLOOR: f64 = 10.0;
/// The name of the likelihood among fitness functions.
pub const LIKELIHOOD: &str = "negative log-likelihood";
/// Fewer points than these have no deviation of their own to be estimated.
const FEW: usize = 3;

/// A formula for sigma.
#[derive(Clone)]
pub struct SigmaFormula {
    /// As it was written.
    pub text: String,
    /// Its value at a value of the output.
    pub value: Arc<dyn Fn(f64) -> f64 + Send + Sync>,
}

impl std::fmt::Debug for SigmaFormula {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "SigmaFormula({})", self.text)
    }
}

impl PartialEq for SigmaFormula {
    fn eq(&self, other: &SigmaFormula) -> bool {
        self.text == other.text
    }
}

/// The standard deviation of the errors of a series.
#[derive(Debug, Clone, PartialEq, Default)]
pub enum Sigma {
    /// Not known; all such series share one variance, weights apart.
    #[default]
    Unknown,
    /// Given for each point, and believed.
    Given(Vec<f64>),
    /// A formula of the output, and believed.
    Formula(SigmaFormula),
    /// A variable of the model, which parameters may change: the series of it follows with the
    /// [role](Role) of a deviation.
    Variable(String),
    /// Estimated with the parameters, one for each variable.
    Estimated,
    /// Estimated with the parameters, one for all series with this name.
    Shared(String),
    /// Estimated likewise, because nothing was said and one variance for all would mean nothing.
    Automatic,
}

impl Sigma {
    /// Whether the deviations are known.
    pub fn is_known(&self) -> bool {
        matches!(self, Sigma::Given(_) | Sigma::Formula(_) | Sigma::Variable(_))
    }

    /// Whether they are estimated.
    pub fn is_estimated(&self) -> bool {
        matches!(self, Sigma::Estimated | Sigma::Shared(_) | Sigma::Automatic)
    }

    /// Weights of the points where the output is `values`.
    pub fn weights(&self, values: &[f64], weight: f64) -> Vec<f64> {
        match self {
            Sigma::Unknown
            | Sigma::Estimated
            | Sigma::Shared(_)
            | Sigma::Automatic
            | Sigma::Variable(_) => vec![weight; values.len()],
            Sigma::Given(sigma) => sigma.iter().map(|sigma| weight / sigma).collect(),
            Sigma::Formula(formula) => {
                values.iter().map(|y| weight / (formula.value)(*y)).collect()
            }
        }
    }
}

/// What the deviations of a problem are, taken together.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum ErrorModel {
    /// Nothing is known: one variance for all points, weights apart, from the residuals.
    #[default]
    OneVariance,
    /// All deviations are known.
    Known,
    /// All are known or computed by the model; some computed, or not all errors normal.
    Computed,
    /// Some are estimated with the parameters.
    Estimated,
}

impl ErrorModel {
    /// That of a problem.
    pub fn of(problem: &Problem) -> ErrorModel {
        let series = &problem.series;
        if series.iter().any(|series| series.sigma.is_estimated()) {
            ErrorModel::Estimated
        } else if is_computed(series) {
            ErrorModel::Computed
        } else if !series.is_empty() && series.iter().all(|series| series.sigma.is_known()) {
            ErrorModel::Known
        } else {
            ErrorModel::OneVariance
        }
    }

    /// Whether the likelihood is what is minimized: the deviations change with the parameters, or it is
    /// not that of normal errors.
    pub fn is_likelihood(self) -> bool {
        matches!(self, ErrorModel::Computed | ErrorModel::Estimated)
    }
}

/// Whether the likelihood of series is not a sum of squares though no deviation is estimated.
fn is_computed(series: &[Series]) -> bool {
    let is_given = |own: &Series| own.joint.is_some() && !own.sigma.is_estimated();
    let is_other = |own: &Series| matches!(own.sigma, Sigma::Variable(_)) || !own.is_normal();
    series.iter().any(|own| is_other(own) || is_given(own))
}

/// Decides about the series without sigma: where sigmas of others are given, or units differ, they
/// are estimated, for a sum of squares of different units means nothing. Series with a weight of
/// their own are left as they are.
pub fn decide(series: &mut [Series]) {
    let open = |series: &Series| series.sigma == Sigma::Unknown && series.weight == 1.0;
    let mixed = series.iter().any(|series| series.sigma != Sigma::Unknown);
    if mixed || (units_differ(series) && series.iter().all(open)) {
        series.iter_mut().filter(|own| open(own)).for_each(|own| own.sigma = Sigma::Automatic);
    }
}

fn units_differ(series: &[Series]) -> bool {
    series.windows(2).any(|pair| pair[0].y_unit != pair[1].y_unit)
}

/// Says which deviations were estimated without being asked for.
pub fn decided(series: &[Series]) -> Option<Finding> {
    let own: Vec<&Series> = series.iter().filter(|own| own.sigma == Sigma::Automatic).collect();
    if own.is_empty() {
        return None;
    }
    let unit = |unit: &str| if unit.is_empty() { "1".to_owned() } else { unit.to_owned() };
    let names: Vec<String> =
        own.iter().map(|own| format!("{} in {}", own.label(), unit(&own.y_unit))).collect();
    let why = match own.len() == series.len() && units_differ(series) {
        true => "have different units",
        false => "are combined with series with a given sigma",
    };
    let sentence = format!(
        "{} {why}, and no sigma is given, so a sum of their squares would be meaningless. Their \
         standard deviations were estimated together with the parameters (`sigma = \"estimate\"`), so each output has its own weight; give `sigma` where it is known.",
        names.join(" and ")
    );
    let mut finding = Finding::new(FindingKind::ScaleOfOutputs, sentence);
    finding.severity = Severity::Information;
    finding.series = own.iter().map(|own| own.label()).collect();
    Some(finding)
}

/// The first point of each series.
fn firsts(series: &[Series]) -> Vec<usize> {
    let first = |next: &mut usize, own: &Series| {
        let first = *next;
        *next += own.y.len();
        Some(first)
    };
    series.iter().scan(0, first).collect()
}

/// The likelihood of series of which some deviations are computed by the model, or estimated, one for
/// each variable, or of which some errors are not normal.
///
/// # Errors
///
/// A variable with too few points for a deviation of its own, by its name.
pub fn likelihood(series: &[Series], noise: f64) -> Result<Box<dyn Fitness>, (String, Fault)> {
    let mut names: Vec<&str> = Vec::new();
    let (mut points, mut sizes) = (Vec::new(), Vec::<Vec<f64>>::new());
    let firsts = firsts(series);
    let joints = joint::groups(series);
    for (k, own) in series.iter().enumerate() {
        let group = own.deviation().filter(|_| own.joint.is_none()).map(|deviation| {
            names.iter().position(|name| *name == deviation).unwrap_or_else(|| {
                names.push(deviation);
                sizes.push(Vec::new());
                names.len() - 1
            })
        });
        if let Some(group) = group {
            // A limit alone says nothing about the size of errors.
            let is_measured = |point: &usize| own.censored.iter().all(|(of, _)| of != point);
            let weights = own.weights();
            let measured = (0..own.y.len()).filter(is_measured);
            sizes[group].extend(measured.map(|point| weights[point] * own.y[point]));
        }
        let computed = (k..series.len()).find(|of| series[*of].role == Role::Deviation(of - k));
        let in_joint = own.joint.as_ref().and_then(|joint| {
            let number = joints.iter().position(|(name, _)| *name == joint.group)?;
            Some(Deviation::Joint(number, joint.member))
        });
        points.extend((0..own.y.len()).map(|point| match (own.role, computed, group) {
            _ if let Some(joint) = in_joint => (own.law_of(point), joint),
            (Role::Deviation(back), ..) => {
                (series[k - back].law_of(point), Deviation::Of(firsts[k - back] + point))
            }
            (_, Some(computed), _) => {
                (own.law_of(point), Deviation::Computed(firsts[computed] + point))
            }
            (_, _, Some(group)) => (own.law_of(point), Deviation::Group(group)),
            _ => (own.law_of(point), Deviation::Given),
        }));
    }
    if let Some((name, values)) = names.iter().zip(&sizes).find(|(_, values)| values.len() < FEW) {
        let fault = fault!(
            BAD_OPTION,
            "the sigma of `{name}` cannot be estimated from {} point{}", values.len(), if values.len() == 1 { "" } else { "s" };
            help: "give it as a number; values beyond a limit do not count"
        );
        return Err(((*name).to_owned(), fault));
    }
    let floor = |values: &Vec<f64>| {
        let square = values.iter().map(|v| v * v).sum::<f64>() / values.len() as f64;
        (FLOOR * noise * square.sqrt()).max(1e-150)
    };
    let groups = joints.iter().map(|(_, members)| joint::group(series, members, FLOOR * noise));
    let all = Concentrated::new(points, sizes.iter().map(floor).collect());
    Ok(Box::new(all.with_joints(groups.collect())))
}
