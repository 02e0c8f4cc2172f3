//! Sensitivities in steps of the BDF: the staggered corrector.
//!
//! In the differences, y is followed by m vectors s = dy/dp. Predictor, change of the step length
//! and interpolation treat all alike. When y has passed its error test at the new time, the same
//! formula is solved for each s,
//!
//! ```text
//! c (f_y s + f_p) − ψ − d = 0 for the states,   g_y s + g_p = 0 for the others
//! ```
//!
//! which is linear: with the factors that y was found with, iterations converge as fast as those
//! factors are right, and with a Jacobian of the new point the first one is exact. Along many
//! directions one solution with new factors is cheaper than two or more with old ones. The error of a
//! step is the largest of those of y and of every s; an s has the weights of y, over the magnitude of
//! its parameter.
//!
//! References: [Feehery, Tolsma & Barton 1997](gapilib_base::bibliography#feehery-tolsma-barton-1997);
//! [Hindmarsh et al. 2005](gapilib_base::bibliography#hindmarsh-2005).

use super::{Bdf, NEWTON_TOLERANCE, ROUNDING, alpha};
use crate::sim::integrators::Problem;
use crate::sim::norm::weighted_rms;
use crate::sim::{Sensitive, SimErrorKind};

/// Iterations with one matrix.
const MAX_ITERATIONS: usize = 4;
/// Iterations that shrink less than this are not worth making.
const SLOWEST: f64 = 0.7;
/// A new factorization costs as much as this many solutions at most. Measured with networks of 75 states
/// (SalazarCavazos_MBoC2020: 6 directions are 15 % dearer with it, 5 of the 8 states of
/// Boehm_JProteomeRes2014 15 % cheaper); a dense one costs n / 3.
const FACTORIZATION: usize = 10;

impl Bdf {
    /// Weights of the tested derivatives, direction by direction.
    pub(crate) fn set_direction_weights(&mut self, problem: &Problem, tolerance: f64) {
        let (n, tested) = (self.n, self.norms.weights.len());
        self.norms.magnitudes.resize(problem.system.n_directions(), 1.0);
        if self.norms.magnitudes.is_empty() {
            return;
        }
        problem.system.directions(&mut self.norms.magnitudes);
        self.norms.direction_weights.resize(self.norms.magnitudes.len() * tested, 0.0);
        let blocks = self.differences[0][n..].chunks_exact(n).zip(&self.norms.magnitudes);
        let weights = self.norms.direction_weights.chunks_exact_mut(tested.max(1));
        for ((s, magnitude), weights) in blocks.zip(weights) {
            for ((weight, s), nominal) in weights.iter_mut().zip(s).zip(problem.nominal) {
                *weight = tolerance * s.abs().max(nominal / magnitude);
            }
        }
    }

    /// The largest norm of the derivatives along one direction in a vector of all unknowns, of each
    /// the first `tested`.
    pub(crate) fn norm_of_directions(&self, vector: &[f64], tested: usize) -> f64 {
        let weights = self.norms.direction_weights.chunks_exact(self.norms.weights.len().max(1));
        let blocks = vector[self.n..].chunks_exact(self.n.max(1)).zip(weights);
        blocks.map(|(s, weights)| weighted_rms(s, &weights[..tested])).fold(0.0, f64::max)
    }

    /// First differences of the derivatives of the states.
    pub(crate) fn start_directions(
        &mut self,
        problem: &mut Problem,
        t: f64,
    ) -> Result<(), SimErrorKind> {
        let n = self.n;
        if self.rhs.len() == n {
            return Ok(());
        }
        problem.sensitivity_rhs(t, &self.differences[0], &mut self.rhs[n..])?;
        let blocks =
            self.differences[1][n..].chunks_exact_mut(n).zip(self.rhs[n..].chunks_exact(n));
        for (difference, rhs) in blocks {
            let states = difference.iter_mut().zip(rhs).take(self.n_differential);
            states.for_each(|(difference, rhs)| *difference = self.h * rhs);
        }
        Ok(())
    }

    /// Solves the corrector for all s at `t_new`, where y is.
    pub(crate) fn correct_directions(
        &mut self,
        problem: &mut Problem,
        t_new: f64,
    ) -> Result<(), SimErrorKind> {
        if self.rhs.len() == self.n {
            return Ok(());
        }
        let is_direct = self.norms.magnitudes.len() >= (self.n / 3).min(FACTORIZATION);
        if !is_direct && self.iterate_directions(problem, t_new, false)? {
            return Ok(());
        }
        let c = self.h / alpha(self.order);
        self.iteration.evaluate(problem, t_new, &self.y[..self.n])?;
        self.iteration.factorize(problem, c)?;
        self.convergence.rate = 1.0;
        if is_direct {
            return match self.improve_directions(problem, t_new)? {
                true => Ok(()),
                false => Err(SimErrorKind::NotFinite),
            };
        }
        match self.iterate_directions(problem, t_new, true)? {
            true => Ok(()),
            false => Err(SimErrorKind::StepSize),
        }
    }

    /// Iterates with the factors at hand; whether that converged.
    fn iterate_directions(
        &mut self,
        problem: &mut Problem,
        t_new: f64,
        is_exact: bool,
    ) -> Result<bool, SimErrorKind> {
        let mut last = f64::INFINITY;
        for iteration in 1..=MAX_ITERATIONS {
            if !self.improve_directions(problem, t_new)? {
                return Ok(false);
            }
            let norm = self.norm_of_directions(&self.delta, self.norms.weights.len());
            let rate = norm / last;
            let rest = if iteration == 1 { norm } else { norm * rate / (1.0 - rate).max(0.1) };
            if rest <= NEWTON_TOLERANCE || (is_exact && norm <= ROUNDING && iteration > 1) {
                return Ok(true);
            }
            if rate > SLOWEST {
                return Ok(false);
            }
            last = norm;
        }
        Ok(false)
    }

    /// One iteration for all s with the factors at hand; the changes are in `delta`. Nothing is changed
    /// where one is not finite, which is the answer.
    fn improve_directions(
        &mut self,
        problem: &mut Problem,
        t_new: f64,
    ) -> Result<bool, SimErrorKind> {
        let (n, c) = (self.n, self.h / alpha(self.order));
        problem.sensitivity_rhs(t_new, &self.y, &mut self.rhs[n..])?;
        let known = self.psi[n..].chunks_exact(n).zip(self.correction[n..].chunks_exact(n));
        let blocks = self.delta[n..].chunks_exact_mut(n).zip(self.rhs[n..].chunks_exact(n));
        for ((delta, rhs), (psi, correction)) in blocks.zip(known) {
            delta.copy_from_slice(rhs);
            let states = delta.iter_mut().zip(psi.iter().zip(correction));
            for (delta, (psi, correction)) in states.take(self.n_differential) {
                *delta = c * *delta - psi - correction;
            }
        }
        self.iteration.solve_all(problem.nominal, &mut self.delta[n..]);
        if !self.delta[n..].iter().all(|delta| delta.is_finite()) {
            return Ok(false);
        }
        let pairs = self.y[n..].iter_mut().zip(&self.delta[n..]);
        pairs.for_each(|(s, delta)| *s += delta);
        let pairs = self.correction[n..].iter_mut().zip(&self.delta[n..]);
        pairs.for_each(|(d, delta)| *d += delta);
        Ok(true)
    }
}
