//! What messages take: measured while they are used, and forgotten while they are not.

/// Times before any was measured, in seconds.
const MESSAGE: f64 = 2e-4;
const HANDLING: f64 = 1e-5;
/// What a new measurement counts in the mean, and what one that is longer: a disturbance lengthens many,
/// and nothing shortens one.
const NEW: f64 = 0.2;
const LONGER: f64 = 0.05;

/// Messages that other ranks have answered.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Traffic {
    /// Seconds from the sending of a chunk to its results, less the simulations; a mean of the last.
    pub message: f64,
    /// Seconds that rank 0 works for each message; a mean of the last.
    pub handling: f64,
    /// Chunks that were answered.
    pub chunks: u64,
    /// Simulations in them.
    pub simulations: u64,
}

impl Default for Traffic {
    fn default() -> Traffic {
        Traffic { message: MESSAGE, handling: HANDLING, chunks: 0, simulations: 0 }
    }
}

impl Traffic {
    /// A chunk was answered, so many seconds after its simulations alone would have been.
    pub(super) fn answered(&mut self, simulations: usize, message: f64) {
        // Cancelled simulations took time as well, which is not counted.
        if simulations > 0 {
            let weight = if message > self.message { LONGER } else { NEW };
            self.message += weight * (message.max(0.0) - self.message);
            self.chunks += 1;
            self.simulations += simulations as u64;
        }
    }

    /// A chunk was answered that had waited for another one, so that its message cost no time.
    pub(super) fn waited(&mut self, simulations: usize) {
        if simulations > 0 {
            self.chunks += 1;
            self.simulations += simulations as u64;
        }
    }

    /// What rank 0 worked for a message, from the sending to the answer.
    pub(super) fn handled(&mut self, seconds: f64) {
        let weight = if seconds > self.handling { LONGER } else { NEW };
        self.handling += weight * (seconds - self.handling);
    }

    /// Messages were not worth their time, so that none was measured: if that came from a disturbance,
    /// it is forgotten after some populations, and they are tried again.
    pub(super) fn not_used(&mut self) {
        let excess = (self.message - MESSAGE).max(0.0);
        self.message -= NEW * excess;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_disturbance_is_forgotten() {
        let mut traffic = Traffic::default();
        // A machine that stood still for five seconds.
        traffic.answered(1, 5.0);
        assert!(traffic.message > 0.2, "{traffic:?}");
        let populations = (1..100).find(|_| {
            traffic.not_used();
            traffic.message < 2.0 * MESSAGE
        });
        assert!(populations.is_some_and(|count| (20..60).contains(&count)), "{populations:?}");
        // What is quicker than assumed stays so.
        let quick = Traffic { message: 1e-6, ..Traffic::default() };
        let mut same = quick;
        same.not_used();
        assert_eq!(same, quick);
    }

    #[test]
    fn cancelled_work_says_nothing_of_messages() {
        let mut traffic = Traffic::default();
        traffic.answered(0, 30.0);
        assert_eq!(traffic, Traffic::default());
        traffic.answered(5, MESSAGE);
        assert_eq!((traffic.chunks, traffic.simulations), (1, 5));
    }
}
