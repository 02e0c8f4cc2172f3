//! Instants: which blocks are solved, times that are one, the clocks of samples, and what events do.

use crate::sim::EventOutcome;
pub use crate::sim::{AT_ONCE, same_time};

/// Which blocks are solved.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Stage {
    /// Those of the initial system.
    Initial,
    /// Those of events.
    Event,
    /// Those between events.
    Continuous,
}

/// The times of a `sample`.
#[derive(Debug, Clone, Copy, Default, serde::Serialize, serde::Deserialize)]
pub(super) struct Clock {
    start: f64,
    interval: f64,
    /// Number of the next time.
    next: f64,
}

impl Clock {
    /// From the first time that is not before `t`.
    pub(super) fn at(start: f64, interval: f64, t: f64) -> Clock {
        let mut clock = Clock { start, interval, next: 0.0 };
        if interval > 0.0 && t > start {
            clock.next = ((t - start) / interval).floor();
            if clock.time() < t && !same_time(clock.time(), t) {
                clock.next += 1.0;
            }
        }
        clock
    }

    /// The next time.
    pub(super) fn time(&self) -> f64 {
        match self.interval > 0.0 {
            true => self.start + self.next * self.interval,
            false => f64::INFINITY,
        }
    }

    /// Whether its next time has come; then the one after it is next.
    pub(super) fn is_due(&mut self, t: f64) -> bool {
        let due = self.time() <= t || same_time(self.time(), t);
        if due {
            self.next = (self.next + 1.0).max(((t - self.start) / self.interval).floor());
        }
        due
    }
}

/// Which relations may change.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Change {
    /// All.
    All,
    /// The first that does not have its value, as in Murty's method for complementary variables.
    First,
}

/// What two parts of one event did together.
pub fn either(a: EventOutcome, b: EventOutcome) -> EventOutcome {
    match (a, b) {
        (EventOutcome::Continue { y_changed: a }, EventOutcome::Continue { y_changed: b }) => {
            EventOutcome::Continue { y_changed: a || b }
        }
        _ => EventOutcome::Terminate,
    }
}
