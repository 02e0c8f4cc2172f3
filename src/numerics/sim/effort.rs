//! What makes a simulation work: whose errors limit its steps, and what causes its events.

/// Counts of a simulation, by unknown and by crossing function; empty unless requested.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Effort {
    /// Steps in whose error test an unknown had the largest part (`dassl`).
    pub unknowns: Vec<u64>,
    /// Events that a crossing function caused.
    pub crossings: Vec<u64>,
}

impl Effort {
    /// No count for so many unknowns and crossing functions.
    pub fn reset(&mut self, unknowns: usize, crossings: usize) {
        *self = Effort { unknowns: vec![0; unknowns], crossings: vec![0; crossings] };
    }

    /// Counts a step or an event; what is not among the known, such as the share of a sliding
    /// mode, is left out.
    pub fn count(counts: &mut [u64], at: Option<usize>) {
        if let Some(count) = at.and_then(|at| counts.get_mut(at)) {
            *count += 1;
        }
    }
}
