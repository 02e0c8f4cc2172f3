//! An event and those that follow it at the same time, each with its row of results.

use super::run::Run;
use super::{EventOutcome, Events, SimErrorKind};

impl Run<'_> {
    /// Lets the system handle an event and those that follow it at the same time.
    pub(crate) fn whole_event(&mut self, t: f64) -> Result<EventOutcome, SimErrorKind> {
        let mut outcome = self.event(t)?;
        while outcome == EventOutcome::Again {
            outcome = match self.event(t)? {
                EventOutcome::Continue { .. } => EventOutcome::Continue { y_changed: true },
                other => other,
            };
        }
        Ok(outcome)
    }

    /// Lets the system handle an event and records the values after it.
    fn event(&mut self, t: f64) -> Result<EventOutcome, SimErrorKind> {
        let outcome = self.problem.system.handle_event(t, self.y);
        let outcome = outcome.map_err(SimErrorKind::Evaluation)?;
        if !self.y.iter().all(|y| y.is_finite()) {
            return Err(SimErrorKind::NotFinite);
        }
        if self.problem.system.remembers() {
            self.remember_now(t)?;
        }
        self.check()?;
        self.record()?;
        Ok(outcome)
    }
}
