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
/// Singular values below this part of the largest are none.
const NULL: f64 = 1e-10;

/// How much standard errors and their quantiles have to account for.
pub(crate) struct Effective {
    /// The smallest degrees of freedom of a parameter.
    pub freedom: f64,
    /// What the variance of the residuals is multiplied with: an output that determines the parameters
    /// has residuals that are smaller than its errors by more than those of the others are.
    pub(crate) inflation: f64,
}

/// Of `freedom` degrees in all; `columns`: weighted sensitivities.
pub fn effective(problem: &Problem, columns: &[Vec<f64>], freedom: f64) -> Effective {
    if let Some(found) = of_covariances(problem, columns, freedom) {
        return found;
    }
    let groups = groups(problem);
    let count = groups.iter().max().map_or(0, |most| most + 1);
    let points = groups.len();
    let finite = columns.iter().flatten().all(|value| value.is_finite());
    let all_alike = Effective { freedom, inflation: 1.0 };
    if count < 2 || points < columns.len() || !finite || freedom <= 0.0 {
        return all_alike;
    }
    let norms: Vec<f64> =
        columns.iter().map(|column| column.iter().map(|v| v * v).sum::<f64>().sqrt()).collect();
    let used: Vec<usize> = (0..columns.len()).filter(|&k| norms[k] > 0.0).collect();
    let scaled = DMatrix::from_fn(points, used.len(), |j, k| columns[used[k]][j] / norms[used[k]]);
    let Some(found) = SingularValues::of(&scaled) else { return all_alike };
    let along: Vec<usize> =
        (0..found.s.len()).filter(|&d| found.s[d] > NULL * found.largest()).collect();
    let in_group = |g: usize| (0..points).filter(|&j| groups[j] == g).collect::<Vec<usize>>();
    let members: Vec<Vec<usize>> = (0..count).map(in_group).collect();
    // Points less what the parameters follow of them.
    let own_freedom = |places: &Vec<usize>| -> f64 {
        let leverage = |j: &usize| -> f64 {
            along.iter().map(|&d| elementary::powi(found.u[(*j, d)], 2)).sum()
        };
        let followed: f64 = places.iter().map(leverage).sum();
        (places.len() as f64 - followed).max(LEAST)
    };
    let own: Vec<f64> = members.iter().map(own_freedom).collect();
    // What each group contributes to the variance of a parameter, and the least degrees of freedom.
    let part = |k: usize, j: usize| -> f64 {
        along.iter().map(|&d| found.v_t[(d, k)] * found.u[(j, d)] / found.s[d]).sum()
    };
    let mut effective = all_alike;
    for k in 0..used.len() {
        let variance = |places: &Vec<usize>| -> f64 {
            places.iter().map(|&j| elementary::powi(part(k, j), 2)).sum()
        };
        let plain: Vec<f64> = members.iter().map(variance).collect();
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

/// The same where covariances of outputs are estimated; `None` where none is.
fn of_covariances(problem: &Problem, columns: &[Vec<f64>], freedom: f64) -> Option<Effective> {
    let all = joint::groups(&problem.series).into_iter();
    let estimated = |own: &(&str, Vec<usize>)| problem.series[own.1[0]].sigma.is_estimated();
    let all: Vec<JointGroup> = all
        .filter(estimated)
        .map(|(_, members)| joint::group(&problem.series, &members, 0.0))
        .collect();
    let points = columns.first()?.len();
    let is_finite = columns.iter().flatten().all(|value| value.is_finite());
    if all.is_empty() || !is_finite || points < columns.len() || freedom <= 0.0 {
        return None;
    }
    let norm = |column: &Vec<f64>| column.iter().map(|v| v * v).sum::<f64>().sqrt();
    let used: Vec<&Vec<f64>> = columns.iter().filter(|column| norm(column) > 0.0).collect();
    let scaled = DMatrix::from_fn(points, used.len(), |j, k| used[k][j] / norm(used[k]));
    let found = SingularValues::of(&scaled)?;
    let along: Vec<usize> =
        (0..found.s.len()).filter(|&d| found.s[d] > NULL * found.largest()).collect();
    let mut effective = Effective { freedom, inflation: 1.0 };
    for own in &all {
        // What the parameters follow of each combination of outputs.
        let mut followed = DMatrix::<f64>::zeros(own.size, own.size);
        for row in &own.rows {
            for ((a, p), (b, q)) in row.iter().flat_map(|a| row.iter().map(move |b| (a, b))) {
                let parts = along.iter().map(|&d| found.u[(*p, d)] * found.u[(*q, d)]);
                followed[(*a, *b)] += parts.sum::<f64>();
            }
        }
        let most = SymmetricEigen::new(followed).eigenvalues.max();
        let n = own.count() / own.size as f64;
        let others = own.size as f64 - 1.0;
        let left = (n - most - others).max(LEAST);
        effective.freedom = effective.freedom.min(left);
        // Errors of one output tell of those of another as covariates do.
        let factor = n / left * (1.0 + others / (left - 1.0).max(LEAST));
        effective.inflation = effective.inflation.max(factor * freedom / points as f64);
    }
    Some(effective)
}

/// The number of the standard deviation of each point: series with one name share it. Empty where not all
/// are estimated.
fn groups(problem: &Problem) -> Vec<usize> {
    let mut names: Vec<&str> = Vec::new();
    let mut groups = Vec::new();
    for series in &problem.series {
        let Some(deviation) = series.deviation() else { return Vec::new() };
        let known = names.iter().position(|name| *name == deviation);
        let group = known.unwrap_or(names.len());
        if known.is_none() {
            names.push(deviation);
        }
        groups.extend(std::iter::repeat_n(group, series.x.len()));
    }
    groups
}
