//! How many steps a simulation may take: as long as it gets on, more than the first million.
//!
//! A model that switches ten thousand times a second needs millions of steps for its minutes, and
//! says so by its pace. A simulation that is stuck does not come to its end at any number of them.

/// What is allowed, and where that was last extended.
#[derive(Debug, Clone, Copy)]
pub struct StepBudget {
    /// Attempts of steps that may be made.
    pub allowed: u64,
    /// By how many they are extended.
    half: u64,
    /// The most in all.
    most: u64,
    /// Time and attempts at which the pace was last looked at.
    since: (f64, u64),
}

impl StepBudget {
    /// Of a simulation that begins at a time, with steps that it may take in any case and at most.
    pub fn new(start: f64, max_steps: u64, max_total_steps: u64) -> StepBudget {
        let (half, most) = (max_steps / 2, max_total_steps);
        StepBudget { allowed: max_steps, half, most, since: (start, 0) }
    }

    /// After a step to the time t: half a budget more where the second half of the last is being
    /// used and the end, `stop`, is within reach at the pace at hand.
    pub fn extend(&mut self, t: f64, stop: f64, attempts: u64) {
        let (begin, before) = self.since;
        if attempts < before + self.half || self.most <= self.allowed {
            return;
        }
        let needed = (stop - t) / (t - begin) * (attempts - before) as f64;
        if attempts as f64 + needed <= self.most as f64 {
            self.allowed += self.half;
            self.since = (t, attempts);
        }
    }
}
