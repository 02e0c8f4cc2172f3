//! Outputs that are measured at the same instants with correlated errors.

use super::Series;
use crate::fitness::JointGroup;
use nalgebra::DMatrix;
use serde::{Deserialize, Serialize};

/// That the errors of a series are correlated with those of others at the same instants.
#[derive(Debug, Clone, PartialEq)]
pub struct Joint {
    /// Series with one name belong together.
    pub group: String,
    /// The number of its output in the group.
    pub member: usize,
    /// Its correlations with all outputs of the group; `None` where the covariance is estimated.
    pub correlations: Option<Vec<f64>>,
}

/// The covariance of correlated errors at the best point.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct SolvedCovariance {
    /// The experiments.
    pub experiments: Vec<String>,
    /// The outputs.
    pub outputs: Vec<String>,
    /// Whether it was estimated.
    pub estimated: bool,
    /// Root mean squares of the standard deviations.
    pub sigmas: Vec<f64>,
    /// Correlations, row by row.
    pub correlations: Vec<Vec<f64>>,
    /// Instants.
    pub rows: usize,
    /// Instants at which not all outputs were measured.
    pub incomplete: usize,
}

/// The groups of series with correlated errors: names and their series in the order of the outputs.
pub(crate) fn groups(series: &[Series]) -> Vec<(&str, Vec<usize>)> {
    let mut all: Vec<(&str, Vec<usize>)> = Vec::new();
    for (number, own) in series.iter().enumerate() {
        let Some(joint) = &own.joint else { continue };
        match all.iter_mut().find(|known| known.0 == joint.group) {
            Some((_, members)) => members.push(number),
            None => all.push((&joint.group, vec![number])),
        }
    }
    all
}

/// The instants of a group.
pub(crate) fn group(series: &[Series], members: &[usize], noise: f64) -> JointGroup {
    let joint = |number: &usize| series[*number].joint.as_ref();
    // Outputs that were not measured have no series.
    let size_of = |own: &Joint| own.correlations.as_ref().map_or(own.member + 1, Vec::len);
    let size = members.iter().filter_map(joint).map(size_of).max().unwrap_or(1);
    let row_of = |own: &Joint| own.correlations.clone().map(|row| (own.member, row));
    let given: Option<Vec<(usize, Vec<f64>)>> =
        members.iter().filter_map(joint).map(row_of).collect();
    let given = given.map(|rows| {
        let mut matrix = DMatrix::identity(size, size);
        for (a, row) in rows {
            row.iter().enumerate().for_each(|(b, value)| {
                matrix[(a, b)] = *value;
                matrix[(b, a)] = *value;
            });
        }
        matrix
    });
    let firsts: Vec<usize> = series
        .iter()
        .scan(0, |next, own| {
            let first = *next;
            *next += own.x.len();
            Some(first)
        })
        .collect();
    let (mut keys, mut rows) = (Vec::new(), Vec::<Vec<(usize, usize)>>::new());
    let mut squares = vec![[0.0; 2]; size];
    for number in members {
        let (own, Some(joint)) = (&series[*number], joint(number)) else { continue };
        let weights = own.weights();
        for (k, (x, y)) in own.x.iter().zip(&own.y).enumerate() {
            let row = own.rows.get(k).copied().unwrap_or(k);
            let key = (own.experiment.as_str(), row, x.to_bits());
            let at = keys.iter().position(|known| *known == key).unwrap_or_else(|| {
                keys.push(key);
                rows.push(Vec::new());
                keys.len() - 1
            });
            rows[at].push((joint.member, firsts[*number] + k));
            let weighted = weights[k] * y;
            squares[joint.member][0] += weighted * weighted;
            squares[joint.member][1] += 1.0;
        }
    }
    rows.iter_mut().for_each(|row| row.sort_unstable());
    let floor = |[square, count]: [f64; 2]| (noise * (square / count).sqrt()).max(1e-150);
    JointGroup { size, given, rows, floor: squares.into_iter().map(floor).collect() }
}

/// How many numbers of covariances are estimated.
pub(crate) fn estimated(series: &[Series]) -> usize {
    let of = |(_, members): (&str, Vec<usize>)| {
        let own = members.iter().map(|k| &series[*k]);
        let estimated = own.filter(|own| own.sigma.is_estimated());
        let size = estimated.filter_map(|own| own.joint.as_ref()).map(|own| own.member + 1).max();
        size.map_or(0, |size| size * (size + 1) / 2)
    };
    groups(series).into_iter().map(of).sum()
}

/// Whether covariances are given or estimated.
pub(crate) fn is_joint(series: &[Series]) -> bool {
    series.iter().any(|own| own.joint.is_some())
}

/// The covariances of a fit; `weights`: reciprocal standard deviations, `correlations`: those of each
/// group.
pub(crate) fn solved(
    series: &[Series],
    weights: &[f64],
    correlations: &[DMatrix<f64>],
) -> Vec<SolvedCovariance> {
    let one = |((_, members), correlations): ((&str, Vec<usize>), &DMatrix<f64>)| {
        let own = group(series, &members, 0.0);
        let mut squares = vec![[0.0; 2]; own.size];
        for (member, point) in own.rows.iter().flatten() {
            squares[*member][0] += 1.0 / (weights[*point] * weights[*point]);
            squares[*member][1] += 1.0;
        }
        let of = |member: usize| {
            let is_own =
                |k: &&usize| series[**k].joint.as_ref().is_some_and(|joint| joint.member == member);
            members.iter().find(is_own).map(|k| series[*k].y_name.clone()).unwrap_or_default()
        };
        let mut experiments: Vec<String> =
            members.iter().map(|k| series[*k].experiment.clone()).collect();
        experiments.dedup();
        let there: Vec<usize> = (0..own.size).filter(|k| squares[*k][1] > 0.0).collect();
        let sigma = |k: &usize| (squares[*k][0] / squares[*k][1]).sqrt();
        let row = |a: &usize| there.iter().map(|b| correlations[(*a, *b)]).collect();
        SolvedCovariance {
            outputs: there.iter().map(|k| of(*k)).collect(),
            estimated: series[members[0]].sigma.is_estimated(),
            sigmas: there.iter().map(sigma).collect(),
            correlations: there.iter().map(row).collect(),
            rows: own.rows.len(),
            incomplete: own.rows.iter().filter(|row| row.len() < there.len()).count(),
            experiments,
        }
    };
    groups(series).into_iter().zip(correlations).map(one).collect()
}
