//! Systems without unknowns: a step is a step of time.

use super::{Integrator, Problem};
use crate::sim::SimErrorKind;

/// Goes to the limit at once.
#[derive(Debug, Default)]
pub(in crate::sim) struct WithoutUnknowns {
    t: f64,
}

impl Integrator for WithoutUnknowns {
    fn is_explicit(&self) -> bool {
        false
    }

    fn restart(&mut self, _: &mut Problem, t: f64, _: &[f64]) -> Result<(), SimErrorKind> {
        self.t = t;
        Ok(())
    }

    fn step(&mut self, problem: &mut Problem, limit: f64) -> Result<(), SimErrorKind> {
        problem.may_continue()?;
        problem.note_step(limit - self.t);
        self.t = limit;
        Ok(())
    }

    fn time(&self) -> f64 {
        self.t
    }

    fn state(&self) -> &[f64] {
        &[]
    }

    fn interpolate(&self, _: f64, _: &mut [f64]) {}
}
