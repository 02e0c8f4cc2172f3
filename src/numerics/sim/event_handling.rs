//! What follows from an event: slides that end or go on, and whether the integrator restarts.

use super::run::{After, Run};
use super::{EventOutcome, Events, Failure, SimErrorKind};

impl Run<'_> {
    /// Handles the event at `t`, where y is; records both sides of it. An event that a change of
    /// sign announced, but that the variables do not confirm, comes from the error of the
    /// interpolation: the integrator restarts from the variables then.
    pub(super) fn handle_event(
        &mut self,
        t: f64,
        by_sign_change: bool,
    ) -> Result<After, SimErrorKind> {
        self.t = t;
        let settings = self.problem.settings;
        let span = settings.stop - settings.start;
        self.rush.note(t, span)?;
        match self.record() {
            // Located past the zero of a root, where the branch before the event has no value.
            Err(SimErrorKind::Evaluation(Failure::Domain { .. })) if by_sign_change => {}
            recorded => recorded?,
        }
        if by_sign_change {
            self.look_before_event();
        }
        let was_constrained = self.problem.system.is_constrained();
        let (surfaces, contacts) = self.end_slide();
        let crossing = if by_sign_change { self.crossings.last() } else { None };
        self.problem.system.crossed(crossing, span);
        let mut outcome = self.event_with_contacts(&contacts)?;
        if by_sign_change {
            self.watch.note_jump(self.y);
        }
        if was_constrained && outcome != EventOutcome::Terminate {
            outcome = self.continue_after_event(surfaces, contacts)?;
        }
        while self.recorder.points.next().is_some_and(|point| point <= t) {
            self.advance_output();
        }
        match outcome {
            EventOutcome::Terminate => return Ok(After::Terminated),
            _ if was_constrained => {}
            EventOutcome::Continue { y_changed: true } | EventOutcome::Again => {
                if !self.keep_past()? {
                    self.restart()?;
                }
            }
            EventOutcome::Continue { y_changed: false } => {
                let confirmed = self.start_crossings()?;
                if confirmed || !by_sign_change {
                    self.problem.statistics.continued += 1;
                    return Ok(After::Resume);
                }
                self.restart_integrator()?;
            }
        }
        Ok(After::Restarted)
    }
}
