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

use super::Problem;
use crate::elementary;
use serde::{Deserialize, Serialize};

/// A column of which less than this part is independent of the others says nothing of its own.
const DEPENDENT: f64 = 1e-10;
/// What is left of a column below this part of its length is rounding.
const MADE_UP: f64 = 1e-11;
/// Standard deviations that change by less are those of the fit, and so often they are found at most:
/// each round leaves about 1/n of the distance.
const CONSTANT: f64 = 1e-14;
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
    /// Whether their weights depend on what is left.
    is_mixed: bool,
}

/// The series of a problem that are measured in arbitrary units.
pub(crate) struct Relative {
    coefficients: Vec<Coefficient>,
    blocks: Vec<Block>,
    series: Vec<Own>,
    /// For each point, what its series has, and the estimated standard deviation.
    points: Vec<(Own, Option<usize>)>,
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
    /// What the points counted.
    weights: Vec<f64>,
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
            let deviation = series.deviation().map(|name| {
                deviations.iter().position(|own| *own == name).unwrap_or_else(|| {
                    deviations.push(name);
                    counts.push(0.0);
                    deviations.len() - 1
                })
            });
            if let Some(deviation) = deviation {
                counts[deviation] += series.x.len() as f64;
            }
            all.push((Own { scale, offset, is_logarithmic }, deviation));
        }
        let sizes = problem.series.iter().map(|series| series.x.len());
        let points: Vec<(Own, Option<usize>)> =
            all.iter().zip(sizes).flat_map(|(own, n)| std::iter::repeat_n(*own, n)).collect();
        let blocks = blocks(&points, coefficients.len());
        let series = all.into_iter().map(|own| own.0).collect();
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
        let own = &self.points[point].0;
        match own.scale == Some(coefficient) && !own.is_logarithmic {
            true => row[point],
            false if [own.scale, own.offset].contains(&Some(coefficient)) => 1.0,
            false => 0.0,
        }
    }

    /// What a point has without coefficients.
    fn rest(&self, point: usize, row: &[f64]) -> f64 {
        let own = &self.points[point].0;
        if own.scale.is_some() && !own.is_logarithmic { 0.0 } else { row[point] }
    }

    /// Columns of some coefficients of a block, as they count.
    fn basis(&self, block: &Block, which: &[usize], row: &[f64], weights: &[f64]) -> Basis {
        let column = |coefficient: &usize| -> Vec<f64> {
            let entry = |point: &usize| weights[*point] * self.entry(*coefficient, *point, row);
            block.points.iter().map(entry).collect()
        };
        Basis::of(which.iter().map(column).collect())
    }

    /// The best coefficients of a block with these weights.
    fn solve(&self, block: &Block, row: &[f64], measured: &[f64], weights: &[f64]) -> Vec<f64> {
        let right: Vec<f64> = block
            .points
            .iter()
            .map(|p| weights[*p] * (measured[*p] - self.rest(*p, row)))
            .collect();
        let of = |which: &[usize]| self.basis(block, which, row, weights).solve(&right);
        let places = |keep: &dyn Fn(usize) -> bool| -> Vec<usize> {
            (0..block.coefficients.len()).filter(|k| keep(*k)).collect()
        };
        let named = |places: &[usize]| -> Vec<usize> {
            places.iter().map(|k| block.coefficients[*k]).collect()
        };
        let bounded = |k: usize| self.coefficients[block.coefficients[k]].is_positive;
        let mut found = of(&block.coefficients);
        if (0..found.len()).all(|k| !bounded(k) || found[k] > 0.0) {
            return found;
        }
        // Non-negative least squares: scales enter one by one, the one first whose growth helps most.
        let mut inside = places(&|k| !bounded(k));
        found = vec![0.0; block.coefficients.len()];
        let fill = |found: &mut Vec<f64>, inside: &[usize]| {
            let own = of(&named(inside));
            found.fill(0.0);
            inside.iter().zip(own).for_each(|(k, value)| found[*k] = value);
        };
        fill(&mut found, &inside);
        for _ in 0..3 * block.coefficients.len() {
            let residual = self.residual(block, &found, (row, weights), &right);
            let pull = |k: usize| -> f64 {
                let c = block.coefficients[k];
                let parts = block.points.iter().zip(&residual);
                let own = |p: &usize| weights[*p] * self.entry(c, *p, row);
                let size: f64 = block.points.iter().map(|p| own(p) * own(p)).sum();
                let along: f64 = parts.map(|(p, r)| own(p) * r).sum();
                if size > 0.0 { along / size.sqrt() } else { 0.0 }
            };
            let least = CONSTANT * residual.iter().map(|r| r * r).sum::<f64>().sqrt();
            let outside = places(&|k| !inside.contains(&k));
            let next = outside.into_iter().map(|k| (k, pull(k))).filter(|own| own.1 > least);
            let Some((next, _)) = next.max_by(|a, b| a.1.total_cmp(&b.1)) else { break };
            inside.push(next);
            fill(&mut found, &inside);
            while let Some(at) = inside.iter().position(|k| bounded(*k) && found[*k] <= 0.0) {
                inside.remove(at);
                fill(&mut found, &inside);
            }
        }
        found
    }

    /// What coefficients leave of the right side.
    fn residual(
        &self,
        block: &Block,
        values: &[f64],
        (row, weights): (&[f64], &[f64]),
        right: &[f64],
    ) -> Vec<f64> {
        let one = |(p, b): (&usize, &f64)| {
            let parts = block.coefficients.iter().zip(values);
            b - weights[*p] * parts.map(|(c, v)| v * self.entry(*c, *p, row)).sum::<f64>()
        };
        block.points.iter().zip(right).map(one).collect()
    }

    /// The coefficients that fit a simulation best.
    pub fn fit(&self, row: &[f64], compared: Compared<'_>) -> Scaled {
        let Compared { measured, weights, are_final } = compared;
        let n = self.coefficients.len();
        let mut found =
            Scaled { values: vec![0.0; n], is_active: vec![false; n], weights: weights.to_vec() };
        for block in &self.blocks {
            let mut solved;
            if are_final || !block.is_mixed {
                solved = self.solve(block, row, measured, weights);
            } else {
                solved = Vec::new();
                self.set_weights(block, measured, weights, &mut found.weights);
                for _ in 0..ROUNDS {
                    solved = self.solve(block, row, measured, &found.weights);
                    let left = |p: &usize| {
                        let parts = block.coefficients.iter().zip(&solved);
                        let own = parts.map(|(c, v)| v * self.entry(*c, *p, row));
                        measured[*p] - self.rest(*p, row) - own.sum::<f64>()
                    };
                    let left: Vec<f64> = block.points.iter().map(left).collect();
                    let mut all = vec![0.0; row.len()];
                    block.points.iter().zip(left).for_each(|(p, r)| all[*p] = r);
                    if self.set_weights(block, &all, weights, &mut found.weights) < CONSTANT {
                        break;
                    }
                }
            }
            let basis = self.basis(block, &block.coefficients, row, &found.weights);
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

    /// Weights with the standard deviations that these differences have; how much they have changed.
    fn set_weights(&self, block: &Block, left: &[f64], known: &[f64], weights: &mut [f64]) -> f64 {
        let mut squares = vec![0.0; self.counts.len()];
        for p in &block.points {
            if let Some(own) = self.points[*p].1 {
                squares[own] += elementary::powi(known[*p] * left[*p], 2);
            }
        }
        let mut change = 0.0f64;
        for p in &block.points {
            let Some(own) = self.points[*p].1 else { continue };
            let sigma = (squares[own] / self.counts[own]).sqrt().max(f64::MIN_POSITIVE);
            let next = known[*p] / sigma;
            change = change.max((next / weights[*p] - 1.0).abs());
            weights[*p] = next;
        }
        change
    }

    /// Scales a row of simulated points.
    pub fn apply(&self, found: &Scaled, row: &mut [f64]) {
        let scaled = |point: usize| {
            let own = &self.points[point].0;
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
        for ((own, _), row) in self.points.iter().zip(derivatives.chunks_exact_mut(n.max(1))) {
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
        for block in &self.blocks {
            let active: Vec<usize> =
                block.coefficients.iter().copied().filter(|c| found.is_active[*c]).collect();
            let basis = self.basis(block, &active, row, &found.weights);
            for k in 0..n {
                let weighted = |p: &usize| found.weights[*p] * derivatives[p * n + k];
                let column: Vec<f64> = block.points.iter().map(weighted).collect();
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

/// Points whose coefficients depend on each other: they share some, or a standard deviation.
fn blocks(points: &[(Own, Option<usize>)], count: usize) -> Vec<Block> {
    let mut names: Vec<usize> = (0..count).collect();
    let merge = |names: &mut Vec<usize>, a: usize, b: usize| {
        let (to, from) = (names[a], names[b]);
        names.iter_mut().filter(|own| **own == from).for_each(|own| *own = to);
    };
    let mut by_deviation: Vec<(usize, usize)> = Vec::new();
    for (own, deviation) in points {
        let Some(first) = own.scale.or(own.offset) else { continue };
        if let Some(offset) = own.offset {
            merge(&mut names, first, offset);
        }
        let Some(deviation) = deviation else { continue };
        match by_deviation.iter().find(|known| known.0 == *deviation) {
            Some((_, other)) => merge(&mut names, first, *other),
            None => by_deviation.push((*deviation, first)),
        }
    }
    let mut roots = names.clone();
    roots.sort_unstable();
    roots.dedup();
    let block = |root: usize| {
        let coefficients: Vec<usize> = (0..count).filter(|c| names[*c] == root).collect();
        let has = |own: &Own| own.scale.or(own.offset).is_some_and(|c| names[c] == root);
        let deviations: Vec<Option<usize>> =
            points.iter().filter(|own| has(&own.0)).map(|own| own.1).collect();
        // Points without a scale tell of the standard deviation that they share.
        let is_meant = |(own, deviation): &(Own, Option<usize>)| {
            has(own) || deviation.is_some() && deviations.contains(deviation)
        };
        let is_mixed = deviations.windows(2).any(|pair| pair[0] != pair[1]);
        let points = (0..points.len()).filter(|p| is_meant(&points[*p])).collect();
        Block { points, coefficients, is_mixed }
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
