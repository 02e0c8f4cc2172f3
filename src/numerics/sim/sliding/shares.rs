//! The shares with which a solution stays on its surfaces.
//!
//! With the rates ż_ic of the crossing functions in every mode c, the shares λ solve
//!
//! ```text
//! 0 = Σ_c w_c(λ) ż_ic        for every surface i
//! ```
//!
//! by Newton's method. What the integrator holds of the shares is as exact as its differences of y
//! are, divided by its step; these are as exact as y, and so is the time at which one leaves 0 … 1.

use super::slide::{Slide, weight, weight_by_share};
use super::within::SystemWithin;
use crate::sim::DenseLu;

/// Iterations for the shares; where one surface is concerned or the effects add up, one is enough.
const MAX_ITERATIONS: usize = 50;
/// Changes of the shares that end the iteration, and those that are not a solution.
const CONVERGED: f64 = 1e-12;
const FAR: f64 = 1e6;
/// Iterations for the eigenvalues of a matrix of at most five rows, some of each are needed.
const MAX_ROTATIONS: usize = 1000;
/// Length of the difference that gives the rate of z, relative to the time in which y changes.
const DIFFERENCE: f64 = 1e-7;

/// The shares at which the mean rates are zero, k rates given for one mode after the other; `None`
/// if there are none, or a surface would repel the solution.
pub(in crate::sim) fn balanced(rates: &[f64], k: usize) -> Option<Vec<f64>> {
    let mut shares = vec![0.5; k];
    for _ in 0..MAX_ITERATIONS {
        let (mut lu, mut residuals) = (DenseLu::new(k), vec![0.0; k]);
        let matrix = lu.matrix();
        for (mode, rates) in rates.chunks_exact(k).enumerate() {
            for (i, rate) in rates.iter().enumerate() {
                residuals[i] += weight(mode, &shares) * rate;
                for j in 0..k {
                    matrix[j * k + i] += weight_by_share(mode, &shares, j) * rate;
                }
            }
        }
        if (0..k).any(|i| matrix[i * k + i] >= 0.0) {
            return None;
        }
        lu.factorize().ok()?;
        lu.solve(&mut residuals);
        let change = residuals.iter().fold(0.0, |largest: f64, r| largest.max(r.abs()));
        shares.iter_mut().zip(&residuals).for_each(|(share, change)| *share -= change);
        if !change.is_finite() || change > FAR {
            return None;
        }
        if change < CONVERGED {
            break;
        }
    }
    Some(shares)
}

/// Whether solutions around the intersection of surfaces go to it: with layers as wide as `widths`,
/// shares around the balanced ones return to these, dλ/dt = (∂ż/∂λ)/ε. Fields that lead from one surface
/// to the next, none of which attracts by itself, may do so in a spiral.
pub(in crate::sim) fn attract(rates: &[f64], shares: &[f64], widths: &[f64]) -> bool {
    let k = shares.len();
    let jacobian = nalgebra::DMatrix::from_fn(k, k, |i, j| {
        let parts = rates.chunks_exact(k).enumerate();
        let derivative = parts.map(|(mode, rates)| weight_by_share(mode, shares, j) * rates[i]);
        derivative.sum::<f64>() / widths[i]
    });
    if !jacobian.iter().all(|entry| entry.is_finite()) {
        return false;
    }
    let schur = nalgebra::Schur::try_new(jacobian, f64::EPSILON, MAX_ROTATIONS);
    schur.is_some_and(|schur| schur.complex_eigenvalues().iter().all(|value| value.re < 0.0))
}

impl SystemWithin<'_> {
    /// The shares at (t, y within), or those that the integrator holds where the rates at hand do
    /// not tell them: what keeps the solution on a surface may go through algebraic unknowns.
    pub(super) fn exact_shares(&mut self, slide: &Slide, t: f64, y: &[f64]) -> Vec<f64> {
        let held = slide.shares(y);
        if held.is_empty() {
            return Vec::new();
        }
        let rates = self.rates_of_surfaces(slide, t);
        let found = rates.and_then(|rates| balanced(&rates, held.len()));
        found.unwrap_or_else(|| held.to_vec())
    }

    /// The rates of change of the crossing functions of all surfaces, one mode after the other.
    fn rates_of_surfaces(&mut self, slide: &Slide, t: f64) -> Option<Vec<f64>> {
        let n = self.system.n_differential();
        let k = slide.surfaces.len();
        let mut rates = Vec::with_capacity(slide.n_modes() * k);
        for mode in 0..slide.n_modes() {
            self.enter(slide, mode);
            self.system.rhs(t, &self.y, &mut self.out).ok()?;
            let magnitudes = self.y.iter().zip(&slide.nominal);
            let speeds = self.out.iter().zip(magnitudes).take(n);
            let relative = speeds.map(|(f, (y, nominal))| f.abs() / y.abs().max(*nominal));
            let ahead = DIFFERENCE / relative.fold(1.0 / slide.span, f64::max);
            self.system.crossings(t, &self.y, &mut self.z).ok()?;
            let kept = self.y.clone();
            self.y.iter_mut().zip(&self.out).take(n).for_each(|(y, f)| *y += ahead * f);
            let moved = self.system.crossings(t + ahead, &self.y, &mut self.z_moved);
            self.y = kept;
            moved.ok()?;
            let crossings = slide.surfaces.iter().map(|surface| surface.crossing);
            rates.extend(crossings.map(|at| (self.z_moved[at] - self.z[at]) / ahead));
        }
        rates.iter().all(|rate| rate.is_finite()).then_some(rates)
    }
}
