//! Relative data: a series that is measured in arbitrary units.
//!
//! ```text
//!   yᵢ = s ŷᵢ + b + errorᵢ        ln yᵢ = ln ŷᵢ + ln s + errorᵢ   where errors are log-normal
//! ```
//!
//! Scale s and offset b are linear. Each simulation is compared with the data at the best of them,
//! which weighted least squares give (variable projection). With Φ their columns, and derivatives
//! D of the scaled simulation at fixed s and b, the derivatives are D − Φ (ΦᵀWΦ)⁻¹ΦᵀW D: since the
//! residuals are orthogonal to Φ, the gradient is exact, and JᵀWJ is what is left of the information
//! where s and b are parameters like others and are eliminated. Searches, standard errors and
//! profiles are those of that problem.
//!
//! Where series that share a scale have different estimated standard deviations, these and the scale
//! are found in turn.
//!
//! References: [Golub & Pereyra 1973](gapilib_base::bibliography#golub-pereyra-1973),
//! [Kaufman 1975](gapilib_base::bibliography#kaufman-1975).

use super::{Problem, joint};
use crate::elementary;
use crate::fitness::{JointGroup, Whitening};
use serde::{Deserialize, Serialize};

/// Growth of a scale that follows less than this part of what is left follows rounding.
const ROUNDING: f64 = 1e-14;
/// A column of which less than this part is independent of the others says nothing of its own.
const DEPENDENT: f64 = 1e-10;
/// What is left of a column below this part of its length is rounding.
const MADE_UP: f64 = 1e-11;
/// Standard deviations that change by less are those of the fit, and so often they are found at most:
/// each round leaves about 1/n of the distance.
const CONSTANT: f64 = 1e-13;
const ROUNDS: usize = 200;

/// An estimated scale of a series.
#[derive(Debug, Clone, PartialEq)]
pub struct Scale {
    /// Series with one name share it.
    pub name: String,
    /// Whether it may be negative.
    pub any_sign: bool,
}

/// What is estimated of the units of a series.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Scaling {
    /// The scale.
    pub scale: Option<Scale>,
    /// The offset: series with one name share it.
    pub offset: Option<String>,
}

impl Scaling {
    /// Whether nothing is estimated.
    pub fn is_empty(&self) -> bool {
        self.scale.is_none() && self.offset.is_none()
    }
}

/// A scale or an offset of relative data.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct SolvedCoefficient {
    /// Its name, where several series share it.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub name: String,
    /// Its value.
    pub value: f64,
    /// One standard deviation; `None` where infinite or unknown.
    #[serde(default)]
    pub deviation: Option<f64>,
}

/// The coefficients of one series.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub(crate) struct Own {
    pub scale: Option<usize>,
    pub offset: Option<usize>,
    /// Whether logarithms are compared.
    pub is_logarithmic: bool,
}

/// How a coefficient acts.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Kind {
    /// A scale.
    Scale,
    /// The logarithm of a scale, where logarithms are compared.
    Logarithm,
    /// An offset.
    Offset,
}

/// A scale or an offset.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Coefficient {
    pub name: String,
    pub kind: Kind,
    is_positive: bool,
}

/// Series whose coefficients are found together.
struct Block {
    points: Vec<usize>,
    coefficients: Vec<usize>,
    /// Groups of outputs with correlated errors; their points are places in those of the block.
    joints: Vec<JointGroup>,
    /// Whether their weights depend on what is left.
    is_mixed: bool,
}

/// What the series of a point has.
#[derive(Debug, Clone, Copy)]
struct Point {
    own: Own,
    /// The estimated standard deviation.
    deviation: Option<usize>,
    /// The group of outputs with correlated errors.
    joint: Option<usize>,
}

/// The series of a problem that are measured in arbitrary units.
pub(crate) struct Relative {
    coefficients: Vec<Coefficient>,
    blocks: Vec<Block>,
    series: Vec<Own>,
    points: Vec<Point>,
    /// Points of each estimated standard deviation.
    counts: Vec<f64>,
}

/// What a row of simulated points is compared with.
#[derive(Clone, Copy)]
pub(crate) struct Compared<'a> {
    pub measured: &'a [f64],
    /// Reciprocal standard deviations, as far as they are known.
    pub weights: &'a [f64],
    /// Whether the weights hold what is estimated of the standard deviations.
    pub are_final: bool,
}

/// The coefficients of one simulation.
#[derive(Debug, Clone)]
pub(crate) struct Scaled {
    /// Their values; 0 where they are not determined, or a scale would be negative.
    pub values: Vec<f64>,
    /// Which of them took part.
    pub is_active: Vec<bool>,
    /// What the points counted, and what made those of each block uncorrelated.
    weights: Vec<f64>,
    whitenings: Vec<Whitening>,
}

impl Relative {
    /// Those of a problem; `None` where it has none.
    pub fn of(problem: &Problem) -> Option<Relative> {
        if problem.series.iter().all(|series| series.scaling.is_empty()) {
            return None;
        }
        let mut coefficients: Vec<Coefficient> = Vec::new();
        let mut place = |own: Coefficient| {
            let known = coefficients.iter().position(|one| {
                one.name == own.name && (one.kind == Kind::Offset) == (own.kind == Kind::Offset)
            });
            known.unwrap_or_else(|| {
                coefficients.push(own);
                coefficients.len() - 1
            })
        };
        let groups = joint::groups(&problem.series);
        let mut deviations: Vec<&str> = Vec::new();
        let (mut all, mut counts) = (Vec::new(), Vec::new());
        for (number, series) in problem.series.iter().enumerate() {
            let is_logarithmic = problem.inference.logarithmic.contains(&number);
            let scale = series.scaling.scale.as_ref().map(|own| {
                let kind = if is_logarithmic { Kind::Logarithm } else { Kind::Scale };
                let is_positive = !own.any_sign && kind == Kind::Scale;
                place(Coefficient { name: own.name.clone(), kind, is_positive })
            });
            let offset = series.scaling.offset.as_ref().map(|name| {
                place(Coefficient { name: name.clone(), kind: Kind::Offset, is_positive: false })
            });
            let joint = series.joint.as_ref();
            let joint = joint.and_then(|own| groups.iter().position(|one| one.0 == own.group));
            let deviation = series.deviation().filter(|_| joint.is_none()).map(|name| {
                deviations.iter().position(|own| *own == name).unwrap_or_else(|| {
                    deviations.push(name);
                    counts.push(0.0);
                    deviations.len() - 1
                })
            });
            if let Some(deviation) = deviation {
                counts[deviation] += series.x.len() as f64;
            }
            all.push(Point { own: Own { scale, offset, is_logarithmic }, deviation, joint });
        }
        let sizes = problem.series.iter().map(|series| series.x.len());
        let points: Vec<Point> =
            all.iter().zip(sizes).flat_map(|(own, n)| std::iter::repeat_n(*own, n)).collect();
        let groups = groups.iter();
        let joints: Vec<JointGroup> = groups
            .map(|(_, members)| joint::group(&problem.series, members, problem.noise))
            .collect();
        let blocks = blocks((&points, &joints), coefficients.len());
        let series = all.into_iter().map(|own| own.own).collect();
        Some(Relative { coefficients, blocks, series, points, counts })
    }

    /// The coefficients of each series.
    pub fn series(&self) -> &[Own] {
        &self.series
    }

    /// Scales and offsets.
    pub fn coefficients(&self) -> &[Coefficient] {
        &self.coefficients
    }

    /// What a coefficient is multiplied with at a point.
    fn entry(&self, coefficient: usize, point: usize, row: &[f64]) -> f64 {
        let own = &self.points[point].own;
        match own.scale == Some(coefficient) && !own.is_logarithmic {
            true => row[point],
            false if [own.scale, own.offset].contains(&Some(coefficient)) => 1.0,
            false => 0.0,
        }
    }

    /// What a point has without coefficients.
    fn rest(&self, point: usize, row: &[f64]) -> f64 {
        let own = &self.points[point].own;
        if own.scale.is_some() && !own.is_logarithmic { 0.0 } else { row[point] }
    }

    /// The columns of some coefficients of a block, as they count.
    fn counted(
        &self,
        block: &Block,
        which: &[usize],
        row: &[f64],
        (weights, whitening): (&[f64], &Whitening),
    ) -> Vec<Vec<f64>> {
        let column = |coefficient: &usize| -> Vec<f64> {
            let entry = |point: &usize| weights[*point] * self.entry(*coefficient, *point, row);
            let mut column: Vec<f64> = block.points.iter().map(entry).collect();
            whitening.apply(&mut column);
            column
        };
        which.iter().map(column).collect()
    }

    /// The best coefficients of a block with these weights.
    fn solve(
        &self,
        block: &Block,
        row: &[f64],
        measured: &[f64],
        (weights, whitening): (&[f64], &Whitening),
    ) -> Vec<f64> {
        let columns = self.counted(block, &block.coefficients, row, (weights, whitening));
        let right = |p: &usize| weights[*p] * (measured[*p] - self.rest(*p, row));
        let mut right: Vec<f64> = block.points.iter().map(right).collect();
        whitening.apply(&mut right);
        let is_positive = |c: &usize| self.coefficients[*c].is_positive;
        let bounded: Vec<bool> = block.coefficients.iter().map(is_positive).collect();
        least_squares(&columns, &right, &bounded)
    }

    /// The coefficients that fit a simulation best.
    pub fn fit(&self, row: &[f64], compared: Compared<'_>) -> Scaled {
        let Compared { measured, weights, are_final } = compared;
        let n = self.coefficients.len();
        let mut found = Scaled {
            values: vec![0.0; n],
            is_active: vec![false; n],
            weights: weights.to_vec(),
            whitenings: Vec::new(),
        };
        for block in &self.blocks {
            let (solved, whitening) = match are_final || !block.is_mixed {
                true => {
                    let mut whitening = Whitening::default();
                    let nothing = vec![0.0; block.points.len()];
                    block.joints.iter().for_each(|own| whitening.add(&own.scales(&nothing)));
                    (self.solve(block, row, measured, (weights, &whitening)), whitening)
                }
                false => self.fit_in_turn(block, row, compared, &mut found.weights),
            };
            let counted = (&found.weights[..], &whitening);
            let basis = Basis::of(self.counted(block, &block.coefficients, row, counted));
            found.whitenings.push(whitening);
            for ((c, value), is_independent) in
                block.coefficients.iter().zip(solved).zip(basis.is_independent)
            {
                found.values[*c] = value;
                let is_held = self.coefficients[*c].is_positive && value <= 0.0;
                found.is_active[*c] = is_independent && !is_held;
            }
        }
        found
    }

    /// The coefficients of a block and the standard deviations of what they leave, in turn.
    fn fit_in_turn(
        &self,
        block: &Block,
        row: &[f64],
        Compared { measured, weights: known, .. }: Compared<'_>,
        weights: &mut [f64],
    ) -> (Vec<f64>, Whitening) {
        let at_first: Vec<f64> = block.points.iter().map(|p| measured[*p]).collect();
        self.set_weights(block, &at_first, known, weights);
        let (mut solved, mut whitening) = (Vec::new(), Whitening::default());
        for _ in 0..ROUNDS {
            let next = self.solve(block, row, measured, (weights, &whitening));
            let moved = next.iter().zip(&solved).map(|(a, b): (&f64, &f64)| (a - b).abs());
            let moved = moved.fold(if solved.is_empty() { f64::NAN } else { 0.0 }, f64::max);
            let size = next.iter().fold(0.0, |most: f64, own| most.max(own.abs()));
            solved = next;
            let left = |p: &usize| {
                let parts = block.coefficients.iter().zip(&solved);
                let own = parts.map(|(c, v)| v * self.entry(*c, *p, row));
                measured[*p] - self.rest(*p, row) - own.sum::<f64>()
            };
            let left: Vec<f64> = block.points.iter().map(left).collect();
            let (change, correlations) = self.set_weights(block, &left, known, weights);
            whitening = correlations;
            if change < CONSTANT && moved <= CONSTANT * size {
                break;
            }
        }
        (solved, whitening)
    }

    /// Weights with the standard deviations that these differences of the points of a block have, and
    /// their correlations; how much the weights have changed.
    fn set_weights(
        &self,
        block: &Block,
        left: &[f64],
        known: &[f64],
        weights: &mut [f64],
    ) -> (f64, Whitening) {
        let mut squares = vec![0.0; self.counts.len()];
        let residuals = block.points.iter().zip(left).map(|(p, left)| known[*p] * left);
        let residuals: Vec<f64> = residuals.collect();
        for (p, residual) in block.points.iter().zip(&residuals) {
            if let Some(own) = self.points[*p].deviation {
                squares[own] += residual * residual;
            }
        }
        let mut change = 0.0f64;
        let mut set = |p: usize, sigma: f64| {
            let next = known[p] / sigma.max(f64::MIN_POSITIVE);
            change = change.max((next / weights[p] - 1.0).abs());
            weights[p] = next;
        };
        for p in &block.points {
            let Some(own) = self.points[*p].deviation else { continue };
            set(*p, (squares[own] / self.counts[own]).sqrt());
        }
        let mut whitening = Whitening::default();
        for joint in &block.joints {
            let scales = joint.scales(&residuals);
            whitening.add(&scales);
            for (member, at) in joint.rows.iter().flatten().filter(|_| joint.given.is_none()) {
                set(block.points[*at], scales.covariance[(*member, *member)].sqrt());
            }
        }
        (change, whitening)
    }

    /// Scales a row of simulated points.
    pub fn apply(&self, found: &Scaled, row: &mut [f64]) {
        let scaled = |point: usize| {
            let own = &self.points[point].own;
            let parts = [own.scale, own.offset].into_iter().flatten();
            let sum: f64 = parts.map(|c| found.values[c] * self.entry(c, point, row)).sum();
            self.rest(point, row) + sum
        };
        let all: Vec<f64> = (0..row.len()).map(scaled).collect();
        row.copy_from_slice(&all);
    }

    /// Derivatives of the scaled points with scales and offsets as they are.
    pub fn scale_derivatives(&self, found: &Scaled, derivatives: &mut [f64]) {
        let n = derivatives.len() / self.points.len();
        for (Point { own, .. }, row) in
            self.points.iter().zip(derivatives.chunks_exact_mut(n.max(1)))
        {
            if let Some(scale) = own.scale.filter(|_| !own.is_logarithmic) {
                row.iter_mut().for_each(|d| *d *= found.values[scale]);
            }
        }
    }

    /// Takes from derivatives of the scaled points what scales and offsets make up for; for each
    /// parameter, the part of the length of its column that is left. `row`: the points as simulated.
    pub fn project(&self, found: &Scaled, row: &[f64], derivatives: &mut [f64]) -> Vec<f64> {
        let n = derivatives.len() / self.points.len();
        let lengths = |derivatives: &[f64]| -> Vec<f64> {
            let square = |k: usize| -> f64 {
                let column = derivatives.iter().skip(k).step_by(n).zip(&found.weights);
                column.map(|(d, w)| elementary::powi(d * w, 2)).sum()
            };
            (0..n).map(|k| square(k).sqrt()).collect()
        };
        let before = lengths(derivatives);
        for (block, whitening) in self.blocks.iter().zip(&found.whitenings) {
            let active: Vec<usize> =
                block.coefficients.iter().copied().filter(|c| found.is_active[*c]).collect();
            let counted = (&found.weights[..], whitening);
            let basis = Basis::of(self.counted(block, &active, row, counted));
            for k in 0..n {
                let weighted = |p: &usize| found.weights[*p] * derivatives[p * n + k];
                let mut column: Vec<f64> = block.points.iter().map(weighted).collect();
                whitening.apply(&mut column);
                let parts = basis.solve(&column);
                for p in &block.points {
                    let own = active.iter().zip(&parts).map(|(c, v)| v * self.entry(*c, *p, row));
                    derivatives[p * n + k] -= own.sum::<f64>();
                }
            }
        }
        let share = |(after, before): (f64, f64)| if before > 0.0 { after / before } else { 1.0 };
        let shares: Vec<f64> = lengths(derivatives).into_iter().zip(before).map(share).collect();
        for (k, _) in shares.iter().enumerate().filter(|(_, share)| **share < MADE_UP) {
            derivatives.iter_mut().skip(k).step_by(n).for_each(|d| *d = 0.0);
        }
        shares
    }

    /// The derivatives of all points by the coefficients that took part, column by column.
    pub fn columns(&self, found: &Scaled, row: &[f64]) -> Vec<(usize, Vec<f64>)> {
        let active = (0..self.coefficients.len()).filter(|c| found.is_active[*c]);
        let column = |c: usize| (0..row.len()).map(|p| self.entry(c, p, row)).collect();
        active.map(|c| (c, column(c))).collect()
    }
}

/// The coefficients of columns that are nearest to `right`, some of which are not negative.
fn least_squares(columns: &[Vec<f64>], right: &[f64], bounded: &[bool]) -> Vec<f64> {
    let fitted = |which: &[usize]| {
        let own = which.iter().map(|k| columns[*k].clone()).collect();
        let values = Basis::of(own).solve(right);
        let mut all = vec![0.0; columns.len()];
        which.iter().zip(values).for_each(|(k, value)| all[*k] = value);
        all
    };
    let is_allowed = |k: usize, value: f64| !bounded[k] || value > 0.0;
    let all: Vec<usize> = (0..columns.len()).collect();
    let mut found = fitted(&all);
    if found.iter().enumerate().all(|(k, value)| is_allowed(k, *value)) {
        return found;
    }
    // Scales enter one by one, the one first whose growth helps most.
    let mut inside: Vec<usize> = all.iter().copied().filter(|k| !bounded[*k]).collect();
    found = fitted(&inside);
    for _ in 0..3 * columns.len() {
        let left = |(j, b): (usize, &f64)| {
            b - columns.iter().zip(&found).map(|(column, value)| value * column[j]).sum::<f64>()
        };
        let left: Vec<f64> = right.iter().enumerate().map(left).collect();
        let pull = |k: usize| -> f64 {
            let size = dot(&columns[k], &columns[k]).sqrt();
            if size > 0.0 { dot(&columns[k], &left) / size } else { 0.0 }
        };
        let least = ROUNDING * dot(&left, &left).sqrt();
        let outside = all.iter().filter(|k| !inside.contains(k));
        let next = outside.map(|k| (*k, pull(*k))).filter(|own| own.1 > least);
        let Some((next, _)) = next.max_by(|a, b| a.1.total_cmp(&b.1)) else { break };
        inside.push(next);
        found = fitted(&inside);
        while let Some(at) = inside.iter().position(|k| !is_allowed(*k, found[*k])) {
            inside.remove(at);
            found = fitted(&inside);
        }
    }
    found
}

/// Points whose coefficients depend on each other: they share some, a standard deviation or a
/// covariance.
fn blocks((points, joints): (&[Point], &[JointGroup]), count: usize) -> Vec<Block> {
    let mut names: Vec<usize> = (0..count).collect();
    let merge = |names: &mut Vec<usize>, a: usize, b: usize| {
        let (to, from) = (names[a], names[b]);
        names.iter_mut().filter(|own| **own == from).for_each(|own| *own = to);
    };
    let shared = |own: &Point| [(0, own.deviation), (1, own.joint)];
    let mut known: Vec<((usize, Option<usize>), usize)> = Vec::new();
    for point in points {
        let Some(first) = point.own.scale.or(point.own.offset) else { continue };
        if let Some(offset) = point.own.offset {
            merge(&mut names, first, offset);
        }
        for key in shared(point).into_iter().filter(|key| key.1.is_some()) {
            match known.iter().find(|own| own.0 == key) {
                Some((_, other)) => merge(&mut names, first, *other),
                None => known.push((key, first)),
            }
        }
    }
    let mut roots = names.clone();
    roots.sort_unstable();
    roots.dedup();
    let block = |root: usize| {
        let coefficients: Vec<usize> = (0..count).filter(|c| names[*c] == root).collect();
        let has = |own: &Own| own.scale.or(own.offset).is_some_and(|c| names[c] == root);
        let scaled: Vec<&Point> = points.iter().filter(|point| has(&point.own)).collect();
        // Points without a scale tell of the standard deviation that they share.
        let is_meant = |point: &Point| {
            let is_same = |own: &&Point| {
                let pairs = shared(own).into_iter().zip(shared(point));
                pairs.into_iter().any(|(a, b)| a == b && a.1.is_some())
            };
            has(&point.own) || scaled.iter().any(is_same)
        };
        let meant: Vec<usize> = (0..points.len()).filter(|p| is_meant(&points[*p])).collect();
        let is_own = |number: &usize| meant.iter().any(|p| points[*p].joint == Some(*number));
        let within = |number: usize| joints[number].within(&meant);
        let joints: Vec<JointGroup> = (0..joints.len()).filter(is_own).map(within).collect();
        let is_mixed = scaled.windows(2).any(|pair| pair[0].deviation != pair[1].deviation)
            || joints.iter().any(|own| own.given.is_none());
        Block { points: meant, coefficients, joints, is_mixed }
    };
    roots.into_iter().map(block).collect()
}

/// Orthonormal vectors that span columns, by Gram and Schmidt, each step twice.
struct Basis {
    vectors: Vec<Vec<f64>>,
    /// The upper triangle: columns in terms of the vectors; of dependent ones nothing.
    triangle: Vec<Vec<f64>>,
    is_independent: Vec<bool>,
}

impl Basis {
    fn of(columns: Vec<Vec<f64>>) -> Basis {
        let mut basis =
            Basis { vectors: Vec::new(), triangle: Vec::new(), is_independent: Vec::new() };
        for mut column in columns {
            let length = dot(&column, &column).sqrt();
            let mut parts = vec![0.0; basis.vectors.len()];
            for _ in 0..2 {
                for (vector, part) in basis.vectors.iter().zip(&mut parts) {
                    let own = dot(vector, &column);
                    column.iter_mut().zip(vector).for_each(|(c, v)| *c -= own * v);
                    *part += own;
                }
            }
            let left = dot(&column, &column).sqrt();
            let is_independent = left > DEPENDENT * length;
            basis.is_independent.push(is_independent);
            if is_independent {
                column.iter_mut().for_each(|c| *c /= left);
                basis.vectors.push(column);
                parts.push(left);
                basis.triangle.push(parts);
            }
        }
        basis
    }

    /// The combination of the columns that is nearest to `right`; dependent columns take no part.
    fn solve(&self, right: &[f64]) -> Vec<f64> {
        let mut rest = right.to_vec();
        let mut along = Vec::with_capacity(self.vectors.len());
        for vector in &self.vectors {
            let own = dot(vector, &rest);
            rest.iter_mut().zip(vector).for_each(|(r, v)| *r -= own * v);
            along.push(own);
        }
        for k in (0..along.len()).rev() {
            let known: f64 = (k + 1..along.len()).map(|l| self.triangle[l][k] * along[l]).sum();
            along[k] = (along[k] - known) / self.triangle[k][k];
        }
        let mut found = along.into_iter();
        let one = |is_independent: &bool| {
            if *is_independent { found.next().unwrap_or(0.0) } else { 0.0 }
        };
        self.is_independent.iter().map(one).collect()
    }
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}
