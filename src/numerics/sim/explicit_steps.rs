//! Where explicit steps from sample to sample begin and end: see [`sampled`](super::integrators::sampled).

use super::SimErrorKind;
use super::simulator::{After, Run};

impl Run<'_> {
    /// Takes explicit steps from here on, if they suit.
    pub(crate) fn begin_explicit_steps(&mut self) {
        let Some((sampled, distance)) = self.sampled.take() else { return };
        let problem = &mut self.problem;
        problem.statistics.jacobian_evaluations += 1;
        let start = (self.t, &self.y[..]);
        let suits = sampled.suits(&mut *problem.system, start, problem.nominal, distance);
        self.patience = suits.ok().flatten();
        if self.patience.is_some() {
            (self.integrator, self.is_explicit) = (&mut sampled.method, true);
        }
    }

    /// Ends explicit steps where they have become too short.
    pub(crate) fn watch_explicit_steps(&mut self) -> Result<(), SimErrorKind> {
        let Some(patience) = self.patience else { return Ok(()) };
        let time = self.t - self.problem.settings.start;
        if patience.is_exhausted(self.problem.statistics.attempts(), time)
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
