//! Levenberg and Marquardt's method for a square system that Newton's method does not solve.
//!
//! ```text
//! (JᵀJ + μ I) h = −Jᵀ F        μ smaller after a good step, larger after a bad one
//! ```
//!
//! in equations scaled by the largest entry of their row and unknowns scaled by their magnitude.
//! The smallest of many solutions is taken, counted from the guess.
//!
//! Reference: [Nocedal & Wright 2006](gapilib_base::bibliography#nocedal-wright-2006), chapter 10.

use crate::elementary;
use crate::sim::{DenseLu, Equations, Failure};

const MAX_ITERATIONS: usize = 200;
/// Scaled residuals below this part of their row of the Jacobian are zero.
const SOLVED: f64 = 1e-10;
/// Scaled steps below this end the search.
const LAST_STEP: f64 = 1e-14;

/// There is no solution, or none that can be reached.
#[derive(Debug)]
pub(crate) struct NoSolution;

/// The workspace for systems of one size.
#[derive(Debug, Clone)]
pub struct LeastSquares {
    n: usize,
    lu: DenseLu,
    /// By columns.
    jacobian: Vec<f64>,
    normal: Vec<f64>,
    residual: Vec<f64>,
    trial_residual: Vec<f64>,
    trial: Vec<f64>,
    step: Vec<f64>,
    gradient: Vec<f64>,
    row_scale: Vec<f64>,
}

impl LeastSquares {
    pub fn new(n: usize) -> LeastSquares {
        let zeros = vec![0.0; n];
        LeastSquares {
            n,
            lu: DenseLu::new(n),
            jacobian: vec![0.0; n * n],
            normal: vec![0.0; n * n],
            residual: zeros.clone(),
            trial_residual: zeros.clone(),
            trial: zeros.clone(),
            step: zeros.clone(),
            gradient: zeros.clone(),
            row_scale: zeros,
        }
    }

    /// Improves x until it solves the system; on failure x is the best that was found.
    pub fn solve(
        &mut self,
        equations: &mut dyn Equations,
        x: &mut [f64],
        nominal: &[f64],
    ) -> Result<(), NoSolution> {
        self.linearize(equations, x, nominal, true)?;
        equations.residual(x, &mut self.residual).map_err(|_: Failure| NoSolution)?;
        self.residual.iter_mut().zip(&self.row_scale).for_each(|(f, scale)| *f *= scale);
        let mut size = square(&self.residual);
        let mut mu = 1e-3 * (0..self.n).map(|i| self.normal[i * self.n + i]).fold(0.0, f64::max);
        let mut growth = 2.0;
        for _ in 0..MAX_ITERATIONS {
            if !size.is_finite() {
                return Err(NoSolution);
            }
            if self.is_solved() {
                return Ok(());
            }
            self.find_step(mu)?;
            if self.step.iter().all(|h| h.abs() <= LAST_STEP) {
                return Err(NoSolution);
            }
            for i in 0..self.n {
                self.trial[i] = x[i] + self.step[i] * scale_of(x[i], nominal[i]);
            }
            let after = match equations.residual(&self.trial, &mut self.trial_residual) {
                Ok(()) => {
                    let scaled = self.trial_residual.iter_mut().zip(&self.row_scale);
                    scaled.for_each(|(f, scale)| *f *= scale);
                    square(&self.trial_residual)
                }
                Err(_) => f64::INFINITY,
            };
            let steps = self.step.iter().zip(&self.gradient);
            let promised: f64 = steps.map(|(h, g)| h * (mu * h - g)).sum();
            let gain = (size - after) / promised;
            if gain > 0.0 && after < size {
                x.copy_from_slice(&self.trial);
                std::mem::swap(&mut self.residual, &mut self.trial_residual);
                size = after;
                self.linearize(equations, x, nominal, false)?;
                mu *= (1.0 - elementary::powi(2.0 * gain - 1.0, 3)).max(1.0 / 3.0);
                growth = 2.0;
            } else {
                mu *= growth;
                growth *= 2.0;
            }
        }
        Err(NoSolution)
    }

    /// Whether every residual is small beside what its equation changes with the unknowns here:
    /// one that only vanishes far away never is.
    fn is_solved(&self) -> bool {
        self.residual.iter().enumerate().all(|(row, f)| {
            let entries = self.jacobian.iter().skip(row).step_by(self.n);
            let largest = entries.fold(0.0, |a: f64, b| a.max(b.abs()));
            f.abs() <= SOLVED * if largest > 0.0 { largest } else { 1.0 }
        })
    }

    /// The scaled Jacobian and JᵀJ at x.
    fn linearize(
        &mut self,
        equations: &mut dyn Equations,
        x: &[f64],
        nominal: &[f64],
        rescale: bool,
    ) -> Result<(), NoSolution> {
        let n = self.n;
        equations.jacobian(x, &mut self.jacobian).map_err(|_| NoSolution)?;
        for (column, entries) in self.jacobian.chunks_exact_mut(n).enumerate() {
            entries.iter_mut().for_each(|entry| *entry *= scale_of(x[column], nominal[column]));
        }
        if rescale {
            for (row, scale) in self.row_scale.iter_mut().enumerate() {
                let largest =
                    self.jacobian.iter().skip(row).step_by(n).fold(0.0, |a: f64, b| a.max(b.abs()));
                *scale = if largest > 0.0 { 1.0 / largest } else { 1.0 };
            }
        }
        for column in self.jacobian.chunks_exact_mut(n) {
            column.iter_mut().zip(&self.row_scale).for_each(|(entry, scale)| *entry *= scale);
        }
        for i in 0..n {
            for j in 0..=i {
                let a = &self.jacobian[i * n..(i + 1) * n];
                let b = &self.jacobian[j * n..(j + 1) * n];
                let product: f64 = a.iter().zip(b).map(|(a, b)| a * b).sum();
                self.normal[i * n + j] = product;
                self.normal[j * n + i] = product;
            }
        }
        Ok(())
    }

    /// The step for a damping, and the gradient JᵀF.
    fn find_step(&mut self, mu: f64) -> Result<(), NoSolution> {
        for (gradient, column) in self.gradient.iter_mut().zip(self.jacobian.chunks_exact(self.n)) {
            *gradient = column.iter().zip(&self.residual).map(|(a, f)| a * f).sum();
        }
        self.lu.matrix().copy_from_slice(&self.normal);
        for i in 0..self.n {
            self.lu.matrix()[i * self.n + i] += mu.max(f64::MIN_POSITIVE);
        }
        self.lu.factorize().map_err(|_| NoSolution)?;
        self.step.iter_mut().zip(&self.gradient).for_each(|(h, g)| *h = -g);
        self.lu.solve(&mut self.step);
        Ok(())
    }
}

fn scale_of(x: f64, nominal: f64) -> f64 {
    x.abs().max(nominal)
}

fn square(f: &[f64]) -> f64 {
    f.iter().map(|f| f * f).sum()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::elementary::powi;

    /// Radiation of a small surface that takes up `heat`: `1.2e-23 (T⁴ − 293⁴) = heat`.
    struct Radiation {
        heat: f64,
    }

    impl Equations for Radiation {
        fn residual(&mut self, x: &[f64], out: &mut [f64]) -> Result<(), Failure> {
            out[0] = 1.2e-23 * (powi(x[0], 4) - powi(293.0, 4)) - self.heat;
            Ok(())
        }

        fn jacobian(&mut self, x: &[f64], out: &mut [f64]) -> Result<(), Failure> {
            out[0] = 4.8e-23 * powi(x[0], 3);
            Ok(())
        }
    }

    /// The derivative is 10¹⁴ times that at the start: rounding leaves residuals that are large
    /// beside the latter.
    #[test]
    fn a_solution_far_away_is_one() {
        let mut x = [293.0];
        let mut equations = Radiation { heat: 12.5 };
        assert!(LeastSquares::new(1).solve(&mut equations, &mut x, &[1.0]).is_ok());
        assert!((1.2e-23 * powi(x[0], 4) - 12.5).abs() < 1e-7, "{x:?}");
    }

    #[test]
    fn a_residual_that_vanishes_nowhere_is_none() {
        let mut x = [293.0];
        let mut equations = Radiation { heat: -12.5 };
        assert!(LeastSquares::new(1).solve(&mut equations, &mut x, &[1.0]).is_err());
    }
}
