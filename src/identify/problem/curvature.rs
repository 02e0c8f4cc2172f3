//! Minima at which the first derivatives of the model vanish or jump, such as p = 0 of a model that
//! depends on p² or |p|: the linear model is no guide there, so that neither least squares nor the
//! test of Bates and Watts come to an end. The second derivatives of the sum of squares, from
//! differences of its gradient, do both: damped Newton steps, and the test that the Hessian matrix
//! is positive definite and the step left lies within a thousandth of a standard error.
//!
//! Reference: [Nocedal & Wright 2006](gapilib_base::bibliography#nocedal-wright-2006), §2.1 and §3.4.

use super::limits::along;
use super::minimum_test::is_at_minimum;
use super::run::Cause;
use super::{Best, Run};
use crate::elementary;
use crate::ga::optimizer::MINIMUM;
use nalgebra::{DMatrix, DVector, SymmetricEigen};

/// Parameters at most: each step takes two Jacobians for each.
const MOST: usize = 12;
/// Newton steps at most.
const STEPS: usize = 12;
/// Differences reach so far in the search range: the second where derivatives jump nearby.
const REACH: [f64; 2] = [1e-3, 1e-5];
/// Eigenvalues below this part of the largest are zero.
const ZERO: f64 = 1e-9;
/// Parts of a step that are tried.
const PARTS: [f64; 6] = [1.0, 0.5, 0.2, 0.05, 0.01, 0.001];
/// Genes nearer to a bound than this are on it.
const ON_BOUND: f64 = 1e-9;

/// The sum of squares about a point of the unit cube, to second order, over the parameters that no
/// bound holds.
struct Curvature {
    free: Vec<usize>,
    /// Half the gradient.
    gradient: DVector<f64>,
    /// Half the Hessian matrix.
    eigen: SymmetricEigen<f64, nalgebra::Dyn>,
    /// The variance of the residuals.
    variance: f64,
}

impl Curvature {
    /// What a Newton step gains, in units of what moves the parameters by a standard error; `None`
    /// where the Hessian matrix is not positive definite.
    fn offset(&self) -> Option<f64> {
        let values = &self.eigen.eigenvalues;
        if values.min() <= ZERO * values.max() {
            return None;
        }
        let along = self.eigen.eigenvectors.tr_mul(&self.gradient);
        let gain: f64 = along.iter().zip(values.iter()).map(|(g, l)| g * g / l).sum();
        Some((gain / (self.free.len() as f64 * self.variance)).sqrt())
    }

    /// The Newton step, with the moduli of the eigenvalues so that it descends.
    fn step(&self) -> DVector<f64> {
        let values = &self.eigen.eigenvalues;
        let least = (ZERO * values.amax()).max(f64::MIN_POSITIVE);
        let along = self.eigen.eigenvectors.tr_mul(&self.gradient);
        let scaled = DVector::from_fn(along.len(), |k, _| -along[k] / values[k].abs().max(least));
        &self.eigen.eigenvectors * scaled
    }
}

/// Goes to a minimum that the linear model cannot find, if the best point lies beside one. Only where
/// the search has converged.
pub fn finish(run: &mut Run) {
    if run.cause() != Cause::Converged || run.problem.parameters.len() > MOST {
        return;
    }
    let is_at_limit =
        run.observed.best.as_ref().is_some_and(|best| along(&run.problem, &best.values).is_some());
    if is_at_limit {
        return;
    }
    let Some((false, simulations)) = is_at_minimum(run) else { return };
    run.conclusion.simulations += simulations;
    for reach in REACH {
        for _ in 0..STEPS {
            let Some(best) = run.observed.best.clone() else { return };
            let Some(found) = about(run, &best.values, reach) else { return };
            run.conclusion.simulations += found.1;
            if found.0.offset().is_some_and(|offset| offset <= MINIMUM) {
                run.conclusion.by_curvature = Some(reach);
                return;
            }
            let Some(lower) = lower(run, &best, &found.0) else { break };
            run.observed.best = Some(lower);
        }
    }
}

/// The offset at the best point, if [`finish`] has found it a minimum and it still is one, and the
/// simulations of the test.
pub fn offset(run: &Run, values: &[f64]) -> Option<(f64, u64)> {
    let reach = run.conclusion.by_curvature?;
    let (found, simulations) = about(run, values, reach)?;
    found.offset().filter(|offset| *offset <= MINIMUM).map(|offset| (offset, simulations))
}

/// The best of some parts of the Newton step, if it is better.
fn lower(run: &mut Run, best: &Best, found: &Curvature) -> Option<Best> {
    let step = found.step();
    let parameters = &run.problem.parameters;
    let place = |part: &f64| {
        let mut values = best.values.clone();
        for (&k, by) in found.free.iter().zip(step.iter()) {
            let at = parameters[k].fraction(values[k]) + part * by;
            values[k] = parameters[k].value(at.clamp(0.0, 1.0));
        }
        values
    };
    let places: Vec<Vec<f64>> = PARTS.iter().map(place).collect();
    run.conclusion.simulations += places.len() as u64;
    let rows = run.evaluation.simulate_all(&places);
    let rated = places.into_iter().zip(rows).filter_map(|(values, row)| {
        let fitness = run.evaluation.objective(&run.problem, &row.ok()?);
        Some(Best { values, fitness })
    });
    let lowest = rated.min_by(|a, b| a.fitness.total_cmp(&b.fitness))?;
    (lowest.fitness < best.fitness).then_some(lowest)
}

/// Gradient and Hessian matrix at `values`, by central differences of the gradient over `reach`; `None`
/// where something cannot be simulated or nothing is free. Also the simulations.
fn about(run: &Run, values: &[f64], reach: f64) -> Option<(Curvature, u64)> {
    let parameters = &run.problem.parameters;
    let at = |k: usize| parameters[k].fraction(values[k]);
    let (here, mut simulations) = gradients(run, &[values.to_vec()])?;
    let (gradient, square) = here.into_iter().next()?;
    let is_held = |k: usize| {
        at(k) <= ON_BOUND && gradient[k] > 0.0 || 1.0 - at(k) <= ON_BOUND && gradient[k] < 0.0
    };
    let free: Vec<usize> = (0..values.len()).filter(|&k| !is_held(k)).collect();
    let freedom = run.problem.n_points().saturating_sub(free.len());
    if free.is_empty() || freedom == 0 {
        return None;
    }
    let ends = |k: usize| [(at(k) - reach).max(0.0), (at(k) + reach).min(1.0)];
    let moved = |k: usize, to: f64| {
        let mut moved = values.to_vec();
        moved[k] = parameters[k].value(to);
        moved
    };
    let places: Vec<Vec<f64>> =
        free.iter().flat_map(|&k| ends(k).map(|end| moved(k, end))).collect();
    let (around, took) = gradients(run, &places)?;
    simulations += took;
    let n = free.len();
    let entry = |a: usize, b: usize| {
        let [low, high] = ends(free[b]);
        (around[2 * b + 1].0[free[a]] - around[2 * b].0[free[a]]) / (high - low)
    };
    let hessian = DMatrix::from_fn(n, n, |a, b| 0.5 * (entry(a, b) + entry(b, a)));
    if hessian.iter().any(|value| !value.is_finite()) {
        return None;
    }
    let found = Curvature {
        gradient: DVector::from_iterator(n, free.iter().map(|&k| gradient[k])),
        eigen: SymmetricEigen::new(hessian),
        variance: square / freedom as f64,
        free,
    };
    Some((found, simulations))
}

/// Half a gradient and the sum of squares.
type Gradient = (Vec<f64>, f64);

/// Half the gradients of the sum of squares by the fractions of the ranges, and the sums.
fn gradients(run: &Run, places: &[Vec<f64>]) -> Option<(Vec<Gradient>, u64)> {
    let mut simulations = 0;
    let one = |(values, found): (&Vec<f64>, Result<super::Linearization, _>)| {
        let found = found.ok()?;
        simulations += found.simulations;
        let residuals = run.evaluation.residuals(&run.problem, &found.simulated);
        let jacobian = run.evaluation.weighted(&run.problem, values, &found);
        let n = values.len();
        let mut gradient = vec![0.0; n];
        for (row, residual) in jacobian.chunks_exact(n).zip(&residuals) {
            gradient.iter_mut().zip(row).for_each(|(g, j)| *g += j * residual);
        }
        let square = residuals.iter().map(|r| elementary::powi(*r, 2)).sum();
        Some((gradient, square))
    };
    let found = run.evaluation.linearize(&run.problem, places);
    let all: Option<Vec<_>> = places.iter().zip(found).map(one).collect();
    Some((all?, simulations))
}
