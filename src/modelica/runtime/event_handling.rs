//! An event as the integrators see it: what is before and after its iteration.

use super::instants::either;
use super::system::System;
use crate::sim::{EventOutcome, Failure};

impl System {
    /// Handles the event at (t, y), after which nothing is solved.
    pub(super) fn pass_event(&mut self, t: f64, y: &mut [f64]) -> Result<EventOutcome, Failure> {
        let done = self.handle_from(t, y);
        self.loops.is_solved = false;
        done
    }

    /// Handles the event at (t, y).
    fn handle_from(&mut self, t: f64, y: &mut [f64]) -> Result<EventOutcome, Failure> {
        if self.program.acts_by_recordings_alone() {
            self.relations.is_at_start = false;
            self.registers.calls.next_instant();
            return Ok(EventOutcome::Continue {
                y_changed: self.inputs.advance(&self.program, &mut self.registers, t),
            });
        }
        self.load(t, y);
        self.relations.is_at_start = false;
        self.registers.calls.next_instant();
        self.relations.has_changed.fill(false);
        self.relations.has_effect = false;
        self.enter_event(t)?;
        let mut outcome = self.event(t)?;
        self.note_idle_relations();
        if self.improve_choices()? {
            outcome = either(outcome, EventOutcome::Continue { y_changed: true });
        }
        self.leave_event(outcome)?;
        self.prefer_present_values();
        self.note_open(t);
        self.reschedule();
        self.unload(y);
        Ok(outcome)
    }
}
