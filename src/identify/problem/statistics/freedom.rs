//! Degrees of freedom of standard errors where outputs have estimated standard deviations of their own.
//!
//! The variance of a parameter is a sum of contributions of the outputs, each with the few degrees of
//! freedom of its own standard deviation. The sum has about those of Satterthwaite:
//!
//! ```text
//! ν = (Σ vᵢ)² / Σ (vᵢ² / νᵢ)
//! ```
//!
//! The weights of the outputs are estimates as well, which adds to the variance; with the shares
//! fᵢ = vᵢ / Σ vᵢ it is larger by the factor of Meier:
//!
//! ```text
//! 1 + 4 Σ fᵢ (1 − fᵢ) / νᵢ
//! ```
//!
//! Where the covariance of m outputs is estimated from n instants, the parameters follow at most ℓ
//! degrees of freedom of a combination of outputs, and the errors of the others are covariates to it:
//! ν = n − ℓ − m + 1, and the variance is larger by n/ν (1 + (m − 1)/(ν − 1)) than that of the most likely
//! covariance.
//!
//! References: [Rao 1967](gapilib_base::bibliography#rao-1967) (covariates),
//! [Satterthwaite 1946](gapilib_base::bibliography#satterthwaite-1946);
//! [Meier 1953](gapilib_base::bibliography#meier-1953).

use crate::elementary;
use crate::fitness::JointGroup;
use crate::problem::{Problem, joint};
use crate::singular_values::SingularValues;
use nalgebra::{DMatrix, SymmetricEigen};

/// Less than one degree of freedom has no mean.
const LEAST: f64 = 1.0;
/// Points that are followed but for this part are followed: sensitivities have errors of about 1e-8.
const ROUNDING: f64 = 1e-6;
/// Singular values below this part of the largest are none.
const NULL: f64 = 1e-10;

/// How much standard errors and their quantiles have to account for.
pub(crate) struct Effective {
    /// The smallest degrees of freedom of a parameter.
    pub freedom: f64,
    /// What the variance of the residuals is multiplied with: an output that determines the parameters
    /// has residuals that are smaller than its errors by more than those of the others are.
    pub(crate) inflation: f64,
    /// Where some deviations are known: the root of what estimated variances are of unbiased ones, point
    /// by point, and 1 where they are known.
    pub(crate) reduction: Option<Vec<f64>>,
}

/// The directions in which parameters move the points.
pub(crate) struct Directions {
    found: SingularValues,
    /// Those that are not zero.
    along: Vec<usize>,
    /// Parameters that move any.
    count: usize,
}

impl Directions {
    /// Of weighted sensitivities, column by column; `None` where these are not finite, or there are fewer
    /// points than parameters.
    pub(crate) fn of(points: usize, columns: &[Vec<f64>]) -> Option<Directions> {
        if points < columns.len() || columns.iter().flatten().any(|value| !value.is_finite()) {
            return None;
        }
        let norm = |column: &Vec<f64>| column.iter().map(|v| v * v).sum::<f64>().sqrt();
        let used: Vec<(&Vec<f64>, f64)> = columns.iter().map(|own| (own, norm(own))).collect();
        let used: Vec<&(&Vec<f64>, f64)> = used.iter().filter(|(_, norm)| *norm > 0.0).collect();
        let matrix = DMatrix::from_fn(points, used.len(), |j, k| used[k].0[j] / used[k].1);
        let found = SingularValues::of(&matrix)?;
        let is_open = |d: &usize| found.s[*d] > NULL * found.largest();
        let along = (0..found.s.len()).filter(is_open).collect();
        Some(Directions { found, along, count: used.len() })
    }

    /// How far the parameters follow two points together.
    fn followed(&self, p: usize, q: usize) -> f64 {
        self.along.iter().map(|&d| self.found.u[(p, d)] * self.found.u[(q, d)]).sum()
    }

    /// Points less what the parameters follow of them; `count`: how many they are.
    fn left(&self, points: &[usize], count: f64) -> f64 {
        let followed: f64 = points.iter().map(|&j| self.followed(j, j)).sum();
        (count - followed).max(LEAST)
    }

    /// Whether the parameters follow these points wherever they are.
    pub(crate) fn follow(&self, points: &[usize]) -> bool {
        points.iter().all(|&j| 1.0 - self.followed(j, j) < ROUNDING)
    }

    /// What points contribute to the variance of a parameter.
    fn variance(&self, k: usize, points: &[usize]) -> f64 {
        let SingularValues { u, v_t, s, .. } = &self.found;
        let part =
            |j: usize| -> f64 { self.along.iter().map(|&d| v_t[(d, k)] * u[(j, d)] / s[d]).sum() };
        points.iter().map(|&j| elementary::powi(part(j), 2)).sum()
    }
}

/// Of `freedom` degrees in all; `columns`: weighted sensitivities.
pub fn effective(problem: &Problem, columns: &[Vec<f64>], freedom: f64) -> Effective {
    let all_alike = Effective { freedom, inflation: 1.0, reduction: None };
    if freedom <= 0.0 {
        return all_alike;
    }
    if let Some(found) = of_covariances(problem, columns, freedom) {
        return found;
    }
    let members: Vec<Vec<usize>> = match problem.series.iter().all(|own| own.deviation().is_some())
    {
        true => groups(problem).into_iter().map(|(_, points)| points).collect(),
        false => Vec::new(),
    };
    let points = problem.n_points();
    let Some(directions) = Directions::of(points, columns).filter(|_| members.len() > 1) else {
        return all_alike;
    };
    let own: Vec<f64> =
        members.iter().map(|points| directions.left(points, points.len() as f64)).collect();
    let mut effective = all_alike;
    for k in 0..directions.count {
        let plain: Vec<f64> = members.iter().map(|points| directions.variance(k, points)).collect();
        let sizes = members.iter().map(Vec::len).zip(&own);
        let true_ones: Vec<f64> =
            plain.iter().zip(sizes).map(|(v, (n, own))| v * n as f64 / own).collect();
        let all: f64 = true_ones.iter().sum();
        let squares: f64 = true_ones.iter().zip(&own).map(|(v, own)| v * v / own).sum();
        effective.freedom = effective.freedom.min((all * all / squares).max(LEAST));
        let believed = plain.iter().sum::<f64>() * points as f64 / freedom;
        let of_weights = |(v, own): (&f64, &f64)| v / all * (1.0 - v / all) / own;
        let weights = 1.0 + 4.0 * true_ones.iter().zip(&own).map(of_weights).sum::<f64>();
        effective.inflation = effective.inflation.max(all * weights / believed);
    }
    effective
}

/// The groups whose covariances are estimated.
fn covariances(problem: &Problem) -> Vec<JointGroup> {
    let all = joint::groups(&problem.series).into_iter();
    let estimated = |own: &(&str, Vec<usize>)| problem.series[own.1[0]].sigma.is_estimated();
    let own = all.filter(estimated);
    own.map(|(_, members)| joint::group(&problem.series, &members, 0.0)).collect()
}

/// The same where covariances of outputs are estimated; `None` where none is.
fn of_covariances(problem: &Problem, columns: &[Vec<f64>], freedom: f64) -> Option<Effective> {
    let all = covariances(problem);
    let points = columns.first()?.len();
    let directions = Directions::of(points, columns).filter(|_| !all.is_empty())?;
    let mut effective = Effective { freedom, inflation: 1.0, reduction: None };
    for own in &all {
        let (left, factor) = of_covariance(own, &directions);
        effective.freedom = effective.freedom.min(left);
        effective.inflation = effective.inflation.max(factor * freedom / points as f64);
    }
    Some(effective)
}

/// The degrees of freedom of an estimated covariance, and by what the variances of parameters are larger
/// than with the most likely one.
fn of_covariance(own: &JointGroup, directions: &Directions) -> (f64, f64) {
    // What the parameters follow of each combination of outputs.
    let mut followed = DMatrix::<f64>::zeros(own.size, own.size);
    for row in &own.rows {
        for ((a, p), (b, q)) in row.iter().flat_map(|a| row.iter().map(move |b| (a, b))) {
            followed[(*a, *b)] += directions.followed(*p, *q);
        }
    }
    let most = SymmetricEigen::new(followed).eigenvalues.max();
    let n = own.count() / own.size as f64;
    let others = own.size as f64 - 1.0;
    let left = (n - most - others).max(LEAST);
    // Errors of one output tell of those of another as covariates do.
    (left, n / left * (1.0 + others / (left - 1.0).max(LEAST)))
}

/// Points whose deviations are one estimate.
struct Estimate {
    points: Vec<usize>,
    freedom: f64,
    /// By what the variance of errors is larger than its most likely value.
    factor: f64,
}

/// The same where some deviations are estimated, and others known: these have no part in the sums of
/// Satterthwaite and Meier. `shares`: what each point counts.
pub fn effective_of_some(problem: &Problem, columns: &[Vec<f64>], shares: &[f64]) -> Effective {
    let all: Vec<usize> = (0..shares.len()).collect();
    let mut reduction = vec![1.0; shares.len()];
    let mut effective = Effective { freedom: f64::INFINITY, inflation: 1.0, reduction: None };
    let Some(directions) = Directions::of(all.len(), columns) else {
        return Effective { reduction: Some(reduction), ..effective };
    };
    let estimates = estimates(problem, shares, &directions);
    for own in &estimates {
        own.points.iter().for_each(|point| reduction[*point] = own.factor.sqrt().recip());
    }
    let mut reduced = columns.to_vec();
    for column in &mut reduced {
        column.iter_mut().zip(&reduction).for_each(|(value, factor)| *value *= factor);
    }
    let directions = Directions::of(all.len(), &reduced).unwrap_or(directions);
    for k in 0..directions.count {
        let whole = directions.variance(k, &all);
        let part = |own: &Estimate| (directions.variance(k, &own.points) / whole, own.freedom);
        let parts: Vec<(f64, f64)> = estimates.iter().map(part).collect();
        let squares: f64 = parts.iter().map(|(share, freedom)| share * share / freedom).sum();
        effective.freedom = effective.freedom.min(squares.recip().max(LEAST));
        let of_weights = parts.iter().map(|(share, freedom)| share * (1.0 - share) / freedom);
        effective.inflation = effective.inflation.max(1.0 + 4.0 * of_weights.sum::<f64>());
    }
    Effective { reduction: Some(reduction), ..effective }
}

/// The estimated deviations and covariances of a problem.
fn estimates(problem: &Problem, shares: &[f64], directions: &Directions) -> Vec<Estimate> {
    let of_joint = |own: JointGroup| {
        let (freedom, factor) = of_covariance(&own, directions);
        let points = own.rows.iter().flatten().map(|(_, point)| *point).collect();
        Estimate { points, freedom, factor }
    };
    let single = |(_, points): (&str, Vec<usize>)| {
        let count: f64 = points.iter().map(|j| shares[*j]).sum();
        let freedom = directions.left(&points, count);
        Estimate { points, freedom, factor: count / freedom }
    };
    let joints = covariances(problem).into_iter().map(of_joint);
    joints.chain(groups(problem).into_iter().map(single)).collect()
}

/// The points of each estimated standard deviation that belongs to no covariance: series with one name
/// share it.
fn groups(problem: &Problem) -> Vec<(&str, Vec<usize>)> {
    let (mut all, mut first) = (Vec::<(&str, Vec<usize>)>::new(), 0);
    for series in &problem.series {
        let own = first..first + series.x.len();
        first = own.end;
        let Some(name) = series.deviation().filter(|_| series.joint.is_none()) else { continue };
        match all.iter_mut().find(|known| known.0 == name) {
            Some((_, points)) => points.extend(own),
            None => all.push((name, own.collect())),
        }
    }
    all
}
