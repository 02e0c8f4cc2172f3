//! Where explicit steps of systems that are not stiff begin and end: see
//! [`nonstiff`](super::integrators::nonstiff).

use super::SimErrorKind;
use super::run::{After, Run};

impl Run<'_> {
    /// Takes explicit steps from here on, if they suit.
    pub(crate) fn begin_explicit_steps(&mut self) {
        let Some((nonstiff, distance)) = self.nonstiff.take() else { return };
        let problem = &mut self.problem;
        problem.statistics.jacobian_evaluations += 1;
        let start = (self.t, &self.y[..]);
        let suits = nonstiff.suits(&mut *problem.system, start, problem.nominal, distance);
        self.patience = suits.ok().flatten();
        if self.patience.is_some() {
            let method = nonstiff.method(self.problem.settings.tolerance, distance);
            (self.integrator, self.is_explicit) = (method, true);
        }
    }

    /// Ends explicit steps where they have become too short.
    pub(crate) fn watch_explicit_steps(&mut self) -> Result<(), SimErrorKind> {
        let Some(patience) = &mut self.patience else { return Ok(()) };
        if patience.is_exhausted(self.problem.statistics.attempts(), self.t)
            && !self.problem.system.is_constrained()
        {
            self.end_explicit_steps()?;
        }
        Ok(())
    }

    /// Continues with the implicit method.
    pub(crate) fn end_explicit_steps(&mut self) -> Result<After, SimErrorKind> {
        self.patience = None;
        // In a slide the implicit method has taken over already.
        if !self.problem.system.is_constrained() {
            std::mem::swap(&mut self.integrator, &mut self.implicit);
        }
        self.is_explicit = false;
        self.restart()?;
        Ok(After::Restarted)
    }
}
