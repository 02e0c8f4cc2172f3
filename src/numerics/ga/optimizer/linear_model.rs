//! The linear model r + J p of the residuals about a point of the unit cube: Levenberg-Marquardt
//! steps within a trust region and the bounds, and the test of a minimum.
//!
//! J is reduced to its triangular factor R (J = Q R) once; everything else works on R and Qᵀr with a
//! singular value decomposition, never on JᵀJ.
//!
//! References: [Moré 1978](gapilib_base::bibliography#more-1978) (scaling, the parameter by the secular
//! equation); [Bates & Watts 1981](gapilib_base::bibliography#bates-watts-1981) (relative offset).

use crate::elementary;
use crate::singular_values::SingularValues;
use nalgebra::{DMatrix, DVector};

/// The radius may be missed by this, relative; Moré's choice.
const RADIUS: f64 = 0.1;
/// Newton iterations for the parameter; three are usual.
const ITERATIONS: usize = 20;
/// A step goes at most this part of the way to a bound, unless the bound is nearer than `AT`:
/// descents that jump onto a bound at once stay there (MGH17 from a random start).
const TOWARDS_BOUND: f64 = 0.9;
/// Directions are left out of a step below this part of the tolerance of the rank.
const NULL: f64 = 1e-3;
/// Genes nearer than this to a bound are on it; rounding leaves them beside it.
const ON_BOUND: f64 = 1e-13;
/// Genes nearer to a bound may step onto it.
const AT: f64 = 1e-3;

/// The model at a point.
pub(crate) struct LinearModel {
    /// R, at most as many rows as columns.
    factor: DMatrix<f64>,
    /// Qᵀr.
    right: DVector<f64>,
    /// Σ r².
    sum: f64,
    residuals: usize,
    gradient: DVector<f64>,
    /// Singular values relative to the largest that count as zero.
    rank_tolerance: f64,
    /// Whether a derivative is not known.
    blind: bool,
    /// Euclidean norms of the columns.
    pub(super) norms: Vec<f64>,
}

/// A step and what the model says of it.
pub(crate) struct Step {
    /// The step.
    pub(super) by: Vec<f64>,
    /// Its scaled length.
    pub(super) length: f64,
    /// The predicted reduction of the sum of squares.
    pub(super) reduction: f64,
    /// The parameter of Levenberg and Marquardt; 0 for a step of Gauss and Newton.
    pub(super) damping: f64,
    /// Genes that it moves freely.
    free: Vec<usize>,
}

/// How near a point is to a minimum.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Offset {
    /// The relative offset of Bates and Watts over the genes not held by bounds: the part of the
    /// residuals in the tangent plane over the part across it, each by its degrees of freedom.
    /// `None` where there are no degrees of freedom.
    pub relative: Option<f64>,
    /// The largest component of the step of Gauss and Newton, in the unit cube.
    pub step: f64,
    /// Directions that the data determine, of those that are not held by bounds.
    pub rank: usize,
    /// Genes held by bounds.
    pub held: usize,
    /// Whether a derivative is not known.
    pub(crate) blind: bool,
    /// Genes whose derivatives all vanish.
    pub flat: usize,
}

impl LinearModel {
    /// From residuals and their derivatives, residuals × genes; `rank_tolerance`: relative error of
    /// the derivatives.
    pub(crate) fn new(residuals: &[f64], jacobian: &[f64], n: usize, rank_tolerance: f64) -> Self {
        let m = residuals.len();
        let mut jacobian = DMatrix::from_row_slice(m, n, jacobian);
        let mut blind = false;
        for mut column in jacobian.column_iter_mut() {
            if column.iter().any(|value| !value.is_finite()) {
                column.fill(0.0);
                blind = true;
            }
        }
        let r = DVector::from_column_slice(residuals);
        let norms = jacobian.column_iter().map(|column| column.norm()).collect();
        let gradient = jacobian.tr_mul(&r);
        let qr = jacobian.qr();
        let mut right = r.clone();
        qr.q_tr_mul(&mut right);
        let factor = qr.unpack_r();
        let right = right.rows(0, factor.nrows()).into_owned();
        LinearModel {
            factor,
            right,
            sum: r.norm_squared(),
            residuals: m,
            gradient,
            rank_tolerance,
            blind,
            norms,
        }
    }

    /// The genes at `x` that no bound holds.
    fn free(&self, x: &[f64]) -> Vec<usize> {
        let held = |j: usize| {
            x[j] <= ON_BOUND && self.gradient[j] > 0.0
                || 1.0 - x[j] <= ON_BOUND && self.gradient[j] < 0.0
        };
        (0..x.len()).filter(|&j| self.norms[j] > 0.0 && !held(j)).collect()
    }

    /// The step from `x` of at most `radius` in the scales and of at most `reach` in each gene, within the
    /// unit cube; `None` where no gene can move.
    pub(crate) fn step(
        &self,
        x: &[f64],
        (scales, reach): (&[f64], &[f64]),
        radius: f64,
    ) -> Option<Step> {
        let projected = self.projected_step(x, (scales, reach), radius)?;
        if projected.free.len() == self.free(x).len() {
            return Some(projected);
        }
        // Genes put on their limits may spoil more than the others make good; the sum of squares
        // always falls along the way to the step without limits.
        let shortened = self.shortened_step(x, (scales, reach), radius);
        Some(match shortened {
            Some(shortened) if shortened.reduction > projected.reduction => shortened,
            _ => projected,
        })
    }

    /// Genes that would leave the cube are put on their limits one set after the other.
    fn projected_step(
        &self,
        x: &[f64],
        (scales, reach): (&[f64], &[f64]),
        radius: f64,
    ) -> Option<Step> {
        let mut free = self.free(x);
        let mut by = DVector::zeros(x.len());
        let mut damping = 0.0;
        while !free.is_empty() {
            let decomposition = self.decompose(&free, scales)?;
            let right = -(&self.right + &self.factor * &by);
            let used: f64 = by.iter().zip(scales).map(|(p, d)| elementary::powi(p * d, 2)).sum();
            let left = (radius * radius - used).max(0.01 * radius * radius).sqrt();
            let (own, parameter) = damped(&decomposition, &right, left, self.rank_tolerance);
            damping = parameter;
            let mut blocked = Vec::new();
            for (column, &j) in free.iter().enumerate() {
                let step = own[column] / scales[j];
                let limit = limit(x[j], step, reach[j]);
                if step.abs() > limit.abs() {
                    blocked.push(j);
                    by[j] = limit;
                } else {
                    by[j] = step;
                }
            }
            if blocked.is_empty() {
                break;
            }
            free.retain(|j| !blocked.contains(j));
            free.iter().for_each(|&j| by[j] = 0.0);
        }
        Some(self.step_by(&by, scales, damping, free))
    }

    /// The step without limits as far as the first limit; genes that cannot move at all are left
    /// out.
    fn shortened_step(
        &self,
        x: &[f64],
        (scales, reach): (&[f64], &[f64]),
        radius: f64,
    ) -> Option<Step> {
        let mut free = self.free(x);
        while !free.is_empty() {
            let decomposition = self.decompose(&free, scales)?;
            let (own, damping) = damped(&decomposition, &-&self.right, radius, self.rank_tolerance);
            let mut by = DVector::zeros(x.len());
            let mut part = 1.0_f64;
            for (column, &j) in free.iter().enumerate() {
                by[j] = own[column] / scales[j];
                if by[j] != 0.0 {
                    part = part.min(limit(x[j], by[j], reach[j]) / by[j]);
                }
            }
            if part > 0.0 {
                return Some(self.step_by(&(by * part), scales, damping, free));
            }
            free.retain(|&j| by[j] == 0.0 || limit(x[j], by[j], reach[j]) != 0.0);
        }
        None
    }

    fn step_by(&self, by: &DVector<f64>, scales: &[f64], damping: f64, free: Vec<usize>) -> Step {
        let linear = &self.factor * by;
        let reduction = -(2.0 * self.gradient.dot(by) + linear.norm_squared());
        let length =
            by.iter().zip(scales).map(|(p, d)| elementary::powi(p * d, 2)).sum::<f64>().sqrt();
        Step { by: by.as_slice().to_vec(), length, reduction, damping, free }
    }

    /// The geodesic acceleration of a step; `gradient`: Jᵀ times the second derivative of the
    /// residuals in its direction.
    pub(crate) fn acceleration(
        &self,
        step: &Step,
        scales: &[f64],
        gradient: &DVector<f64>,
    ) -> Option<Vec<f64>> {
        let decomposition = self.decompose(&step.free, scales)?;
        // (JᵀJ + λD²) a = −Jᵀ r_vv, in the scaled genes.
        let own: Vec<f64> = step.free.iter().map(|&j| gradient[j] / scales[j]).collect();
        let along = &decomposition.v_t * DVector::from_vec(own);
        let smallest = NULL * self.rank_tolerance * decomposition.largest();
        let z = DVector::from_fn(along.len(), |i, _| {
            let s = decomposition.s[i];
            if s <= smallest { 0.0 } else { -along[i] / (s * s + step.damping) }
        });
        let scaled = decomposition.v_t.tr_mul(&z);
        let mut a = vec![0.0; scales.len()];
        for (column, &j) in step.free.iter().enumerate() {
            a[j] = scaled[column] / scales[j];
        }
        Some(a)
    }

    /// How near `x` is to a minimum.
    pub(crate) fn offset(&self, x: &[f64]) -> Offset {
        let free = self.free(x);
        let flat = self.norms.iter().filter(|norm| **norm == 0.0).count();
        let held = x.len() - free.len() - flat;
        let none = Offset { relative: None, step: 0.0, rank: 0, held, blind: self.blind, flat };
        let Some(found) = self.decompose(&free, &self.norms) else { return none };
        let along = found.u.tr_mul(&self.right);
        let smallest = self.rank_tolerance * found.largest();
        let (mut inside, mut rank) = (0.0, 0);
        let mut z = DVector::zeros(found.s.len());
        for (i, &s) in found.s.iter().enumerate() {
            if s > smallest {
                rank += 1;
                inside += along[i] * along[i];
                z[i] = along[i] / s;
            }
        }
        let scaled = found.v_t.tr_mul(&z);
        let step = free.iter().zip(scaled.iter()).map(|(&j, p)| (p / self.norms[j]).abs());
        let across = (self.sum - inside).max(0.0);
        let freedom = self.residuals.saturating_sub(rank);
        let relative = (freedom > 0 && rank > 0)
            .then(|| (inside / rank as f64).sqrt() / (across / freedom as f64).sqrt());
        Offset { relative, step: step.fold(0.0, f64::max), rank, ..none }
    }

    /// Length of J (a − b) over the genes.
    pub(crate) fn distance(&self, a: &[f64], b: &[f64]) -> f64 {
        let between = DVector::from_fn(a.len(), |j, _| a[j] - b[j]);
        (&self.factor * between).norm()
    }

    /// For some of the genes, columns scaled.
    fn decompose(&self, free: &[usize], scales: &[f64]) -> Option<SingularValues> {
        if free.is_empty() {
            return None;
        }
        let mut columns = self.factor.select_columns(free);
        for (mut column, &j) in columns.column_iter_mut().zip(free) {
            column /= scales[j];
        }
        SingularValues::of(&columns)
    }
}

/// The scaled step of at most `radius` towards the solution, and its parameter λ: the root of
/// ‖p(λ)‖ = radius by Newton's method on its reciprocal.
fn damped(
    found: &SingularValues,
    right: &DVector<f64>,
    radius: f64,
    rank_tolerance: f64,
) -> (DVector<f64>, f64) {
    let c = found.u.tr_mul(right);
    // What derivatives cannot tell from zero is left out of steps of Gauss and Newton alone: a
    // scale that was once much larger makes columns small that still matter (Eckerle4).
    let smallest = NULL * rank_tolerance * found.largest();
    let at = |damping: f64| {
        DVector::from_fn(c.len(), |i, _| {
            let s = found.s[i];
            if s <= smallest { 0.0 } else { s * c[i] / (s * s + damping) }
        })
    };
    let mut damping = 0.0;
    let mut z = at(damping);
    for _ in 0..ITERATIONS {
        let length = z.norm();
        if length <= (1.0 + RADIUS) * radius {
            break;
        }
        // d‖z‖/dλ = −Σ z² / (s² + λ) / ‖z‖
        let decrease: f64 = (0..c.len())
            .filter(|&i| found.s[i] > smallest)
            .map(|i| z[i] * z[i] / (found.s[i] * found.s[i] + damping))
            .sum();
        damping += (length / radius - 1.0) * length * length / decrease;
        z = at(damping);
    }
    (found.v_t.tr_mul(&z), damping)
}

/// The longest step of a gene at `x` in the direction of `step`.
fn limit(x: f64, step: f64, reach: f64) -> f64 {
    let room = if step > 0.0 { 1.0 - x } else { x };
    let own = if room <= AT { room } else { TOWARDS_BOUND * room };
    own.min(reach).max(0.0).copysign(step)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Of a gene that the residuals hardly depend on, the scale allows a step across its range.
    #[test]
    fn no_gene_moves_farther_than_its_reach() {
        let model = LinearModel::new(&[1.0, 1.0], &[10.0, 0.0, 0.0, 1e-3], 2, 1e-9);
        let scales = [10.0, 1e-3];
        let far = model.step(&[0.5, 0.5], (&scales, &[1.0, 1.0]), 5.0).unwrap();
        let near = model.step(&[0.5, 0.5], (&scales, &[1.0, 0.2]), 5.0).unwrap();
        assert!(far.by[1] < -0.4, "{:?}", far.by);
        assert!((near.by[1] + 0.2).abs() < 1e-12 && near.by[0] < -0.05, "{:?}", near.by);
    }
}
