//! Least squares from a near minimum: Levenberg-Marquardt with bounds, in the scaled parameters of
//! the search, for fits that are made many times (bootstrap).
//!
//! Reference: [Nielsen 1999](gapilib_base::bibliography#nielsen-1999); the end is that of
//! [Bates & Watts 1981](gapilib_base::bibliography#bates-watts-1981), the relative offset.

use crate::problem::relative::{Compared, Relative, Scaled};
use crate::problem::{Free, Simulate};
use nalgebra::{DMatrix, DVector};

/// The fit ends when the Gauss-Newton step would move the simulation by less than this many
/// standard errors: the estimate then differs by a hundredth of its standard error.
const OFFSET: f64 = 1e-2;
/// Steps at most; warm-started fits of the problems tried ended after at most 12.
const STEPS: usize = 60;
/// Damping beyond which a step is nothing.
const MOST_DAMPING: f64 = 1e12;

/// Data of one fit.
pub struct Data<'a> {
    pub parameters: &'a [Free],
    pub measured: &'a [f64],
    /// What differences are multiplied with; 0 leaves a point out.
    pub scales: &'a [f64],
    /// Scales and offsets that each simulation gets before it is compared.
    pub relative: Option<&'a Relative>,
    /// Relative error of the simulation.
    pub noise: f64,
}

/// The end of a fit.
pub struct Fit {
    pub values: Vec<f64>,
    pub converged: bool,
}

impl Data<'_> {
    /// The minimum near `start`; `None` where it cannot be simulated.
    pub fn fit(&self, simulator: &mut dyn Simulate, start: &[f64]) -> Option<Fit> {
        let mut u: Vec<f64> =
            self.parameters.iter().zip(start).map(|(free, value)| free.fraction(*value)).collect();
        let mut residuals = self.residuals(simulator, &u)?;
        let mut damping = 1e-3;
        for _ in 0..STEPS {
            let jacobian = self.jacobian(simulator, &u, &residuals)?;
            let gradient = jacobian.tr_mul(&residuals);
            // At a bound with the descent outward, a parameter stands still.
            let free: Vec<usize> = (0..u.len())
                .filter(|&k| {
                    !(u[k] <= 0.0 && gradient[k] > 0.0 || u[k] >= 1.0 && gradient[k] < 0.0)
                })
                .collect();
            if free.is_empty() || self.offset(&jacobian, &residuals, &free) < OFFSET {
                return Some(Fit { values: self.values(&u), converged: true });
            }
            let gram = jacobian.tr_mul(&jacobian);
            loop {
                if let Some(next) = damped(&gram, &gradient, &free, &u, damping)
                    && let Some(found) = self.residuals(simulator, &next)
                    && found.norm_squared() < residuals.norm_squared()
                {
                    (u, residuals) = (next, found);
                    damping = (damping / 9.0).max(1e-12);
                    break;
                }
                damping *= 11.0;
                if damping > MOST_DAMPING {
                    return Some(Fit { values: self.values(&u), converged: false });
                }
            }
        }
        Some(Fit { values: self.values(&u), converged: false })
    }

    fn values(&self, u: &[f64]) -> Vec<f64> {
        self.parameters.iter().zip(u).map(|(free, u)| free.value(*u)).collect()
    }

    fn residuals(&self, simulator: &mut dyn Simulate, u: &[f64]) -> Option<DVector<f64>> {
        let mut row = vec![f64::NAN; self.measured.len()];
        simulator.simulate(&self.values(u), &mut row).ok()?;
        if let Some(relative) = self.relative {
            relative.apply(&self.scaled(relative, &row), &mut row);
        }
        Some(self.weighted(&row))
    }

    fn scaled(&self, relative: &Relative, row: &[f64]) -> Scaled {
        let (measured, weights) = (self.measured, self.scales);
        relative.fit(row, Compared { measured, weights, are_final: true })
    }

    fn weighted(&self, row: &[f64]) -> DVector<f64> {
        let points = row.iter().zip(self.measured).zip(self.scales);
        DVector::from_iterator(row.len(), points.map(|((s, m), w)| w * (s - m)))
    }

    /// Exact where the simulator has sensitivities, else one-sided differences into the range.
    fn jacobian(
        &self,
        simulator: &mut dyn Simulate,
        u: &[f64],
        residuals: &DVector<f64>,
    ) -> Option<DMatrix<f64>> {
        let (points, n) = (self.measured.len(), u.len());
        let values = self.values(u);
        let (mut out, mut flat) = (vec![f64::NAN; points], vec![f64::NAN; points * n]);
        if simulator.sensitivities(&values, &mut out, &mut flat).ok()? {
            if let Some(relative) = self.relative {
                let scaled = self.scaled(relative, &out);
                relative.scale_derivatives(&scaled, &mut flat);
                relative.project(&scaled, &out, &mut flat);
            }
            let unit: Vec<f64> = self
                .parameters
                .iter()
                .zip(&values)
                .map(|(free, value)| free.derivative(*value))
                .collect();
            let entry = |j: usize, k: usize| self.scales[j] * flat[j * n + k] * unit[k];
            return Some(DMatrix::from_fn(points, n, entry));
        }
        // Errors of the simulation and of the difference are alike.
        let step = self.noise.sqrt().clamp(1e-8, 1e-2);
        let mut jacobian = DMatrix::zeros(points, n);
        for k in 0..n {
            let side = if u[k] > 0.5 { -step } else { step };
            let mut beside = u.to_vec();
            beside[k] += side;
            let found = self.residuals(simulator, &beside)?;
            jacobian.set_column(k, &((found - residuals) / side));
        }
        Some(jacobian)
    }

    /// How far the Gauss-Newton step would move the simulation, in standard errors.
    fn offset(&self, jacobian: &DMatrix<f64>, residuals: &DVector<f64>, free: &[usize]) -> f64 {
        let own = jacobian.select_columns(free);
        let points = self.scales.iter().filter(|scale| **scale > 0.0).count();
        let freedom = points.saturating_sub(free.len()).max(1) as f64;
        let q = own.qr().q();
        let tangential = q.tr_mul(residuals).norm_squared();
        let normal = (residuals.norm_squared() - tangential).max(f64::MIN_POSITIVE);
        ((tangential / free.len() as f64) / (normal / freedom)).sqrt()
    }
}

/// The damped step, cut at the bounds; `None` where nothing moves.
fn damped(
    gram: &DMatrix<f64>,
    gradient: &DVector<f64>,
    free: &[usize],
    u: &[f64],
    damping: f64,
) -> Option<Vec<f64>> {
    let largest = gram.diagonal().max().max(f64::MIN_POSITIVE);
    let matrix = DMatrix::from_fn(free.len(), free.len(), |a, b| {
        let entry = gram[(free[a], free[b])];
        if a == b { entry + damping * entry.max(1e-12 * largest) } else { entry }
    });
    let right = DVector::from_iterator(free.len(), free.iter().map(|&k| -gradient[k]));
    let step = matrix.cholesky()?.solve(&right);
    let mut next = u.to_vec();
    for (part, &k) in step.iter().zip(free) {
        next[k] = (u[k] + part).clamp(0.0, 1.0);
    }
    (next != u).then_some(next)
}
