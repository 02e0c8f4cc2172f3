//! State events: the first change of sign of a crossing function within a step.
//!
//! Every function has one of three signs, so that leaving zero is an event and so is reaching it.
//! The bracket of the first change is narrowed by secants of the functions that change within it,
//! tried a little beyond and a little before, and halved every third time. A function that changes
//! its sign twice within one step, or within one part of it where functions vary in time, is not
//! noticed.

use super::{Failure, Integrator, Problem};

/// The width to which an event is located, relative to the step.
const WIDTH: f64 = 1e-10;
/// Times to narrow a bracket; halving alone needs 3 · 34.
const MAX_TRIALS: usize = 120;

/// Crossing functions at both ends of a bracket, and their signs at the last event or step.
#[derive(Debug, Default)]
pub(super) struct CrossingSearch {
    signs: Vec<i8>,
    left: Vec<f64>,
    right: Vec<f64>,
    trial: Vec<f64>,
    /// One that changed its sign at the last event.
    last: Option<usize>,
}

fn sign(z: f64) -> i8 {
    i8::from(z > 0.0) - i8::from(z < 0.0)
}

impl CrossingSearch {
    pub(super) fn resize(&mut self, n_crossings: usize) {
        self.signs.resize(n_crossings, 0);
        self.last = None;
        for vector in [&mut self.left, &mut self.right, &mut self.trial] {
            vector.resize(n_crossings, 0.0);
        }
    }

    /// Takes the signs at (t, y) as those to be changed; whether they are others than before.
    pub(super) fn start(
        &mut self,
        problem: &mut Problem,
        t: f64,
        y: &[f64],
    ) -> Result<bool, Failure> {
        problem.system.crossings(t, y, &mut self.left)?;
        let changed = self.changed(&self.left);
        for (sign_of, z) in self.signs.iter_mut().zip(&self.left) {
            *sign_of = sign(*z);
        }
        Ok(changed)
    }

    /// The end of the bracket of the first event in (`a`, `b`], with y there; `None` if no sign
    /// changes, and then the search goes on from `b`. y must hold y(b).
    pub(super) fn first_event(
        &mut self,
        problem: &mut Problem,
        integrator: &dyn Integrator,
        (mut a, mut b): (f64, f64),
        y: &mut [f64],
    ) -> Result<Option<f64>, Failure> {
        if self.signs.is_empty() {
            return Ok(None);
        }
        problem.system.crossings(b, y, &mut self.right)?;
        if !self.changed(&self.right) {
            std::mem::swap(&mut self.left, &mut self.right);
            return Ok(None);
        }
        let width = WIDTH * (b - a);
        let resolution = 4.0 * f64::EPSILON * a.abs().max(b.abs());
        let width = width.max(resolution);
        for trial in 0..MAX_TRIALS {
            if b - a <= width {
                break;
            }
            let t = match trial % 3 {
                0 => self.earliest_secant(a, b) + 0.4 * width,
                1 => self.earliest_secant(a, b) - 0.4 * width,
                _ => 0.5 * (a + b),
            };
            let t = if t > a && t < b { t } else { 0.5 * (a + b) };
            integrator.interpolate(t, y);
            problem.system.crossings(t, y, &mut self.trial)?;
            if self.changed(&self.trial) {
                b = t;
                std::mem::swap(&mut self.right, &mut self.trial);
            } else {
                a = t;
                std::mem::swap(&mut self.left, &mut self.trial);
            }
        }
        integrator.interpolate(b, y);
        let mut signs = self.signs.iter().zip(&self.right);
        self.last = signs.position(|(old, z)| *old != sign(*z));
        Ok(Some(b))
    }

    /// A function that changed its sign at the last event.
    pub(super) fn last(&self) -> Option<usize> {
        self.last
    }

    fn changed(&self, z: &[f64]) -> bool {
        self.signs.iter().zip(z).any(|(old, z)| *old != sign(*z))
    }

    fn earliest_secant(&self, a: f64, b: f64) -> f64 {
        let ends = self.left.iter().zip(&self.right).zip(&self.signs);
        let changing = ends.filter(|((_, right), old)| **old != sign(**right));
        let roots = changing.map(|((left, right), _)| a + (b - a) * left / (left - right));
        roots.filter(|root| root.is_finite()).fold(b, f64::min)
    }
}
