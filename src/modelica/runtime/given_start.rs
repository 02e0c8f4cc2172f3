//! Simulations that begin where another one ended.

use super::state::GivenStart;
use super::system::System;
use crate::sim::Failure;

impl System {
    /// Lets every simulation from now on begin with these values.
    pub fn begin_with(&mut self, start: GivenStart) {
        let is_given = !(start.states.is_empty() && start.discrete.is_empty());
        self.given_start = is_given.then(|| Box::new(start));
    }

    /// Takes the given values at (t, y), where the model is initialized.
    pub(super) fn take_given_start(&mut self, t: f64, y: &mut [f64]) -> Result<(), Failure> {
        let Some(start) = self.given_start.take() else { return Ok(()) };
        // Conditions that become true here were true before: what they do is taken back.
        self.set_start(&start, y);
        let mut done = self.pass_event(t, y);
        if done.is_ok() {
            self.set_start(&start, y);
            done = self.pass_event(t, y);
        }
        self.given_start = Some(start);
        done.map(|_| ())
    }

    fn set_start(&mut self, start: &GivenStart, y: &mut [f64]) {
        for (state, value) in &start.states {
            y[*state] = *value;
        }
        self.set_discrete(&start.discrete);
    }
}
