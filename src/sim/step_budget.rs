//! How many steps a simulation may take: as long as it gets on, more than the first million.
//!
//! A model that switches ten thousand times a second needs millions of steps for its minutes, and
//! says so by its pace. A simulation that is stuck does not come to its end at any number of them.

use super::Settings;

/// What is allowed, and where that was last settled.
#[derive(Debug, Clone, Copy)]
pub struct StepBudget {
    /// Attempts of steps that may be made.
    pub allowed: u64,
    /// Time and attempts at which the pace was last looked at.
    since: (f64, u64),
}

impl StepBudget {
    /// Of a simulation that begins.
    pub fn new(settings: &Settings) -> StepBudget {
        StepBudget { allowed: settings.max_steps, since: (settings.start, 0) }
    }

    /// Behind a step to a time: half a budget more where the second half of the last is being used
    /// and the end is within reach at the pace at hand.
    pub fn extend(&mut self, settings: &Settings, t: f64, attempts: u64) {
        let (begin, before) = self.since;
        let half = settings.max_steps / 2;
        if attempts < before + half || settings.max_total_steps <= self.allowed {
            return;
        }
        let needed = (settings.stop - t) / (t - begin) * (attempts - before) as f64;
        if attempts as f64 + needed <= settings.max_total_steps as f64 {
            *self = StepBudget { allowed: self.allowed + half, since: (t, attempts) };
        }
    }
}
