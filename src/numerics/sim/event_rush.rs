//! Events that follow each other without time to pass.

use super::SimErrorKind;

/// So many events in a row within the time below are chattering.
const MOST_EVENTS_AT_ONCE: u32 = 200;
/// Distance of events that count as one place in time, relative to the simulated interval.
const AT_ONCE: f64 = 1e-10;

/// How densely events follow each other.
pub(crate) struct EventRush {
    /// When the last one was.
    last: f64,
    /// Events in a row up to it that are one place in time.
    at_once: u32,
}

impl EventRush {
    pub(super) const NONE: EventRush = EventRush { last: f64::NEG_INFINITY, at_once: 0 };

    /// Whether they are near the end of what is allowed.
    pub(super) fn is_rush(&self) -> bool {
        self.at_once > MOST_EVENTS_AT_ONCE / 2
    }

    /// An event at `t` in a simulation of this length; an error if there are too many at once.
    pub(super) fn note(&mut self, t: f64, span: f64) -> Result<(), SimErrorKind> {
        let is_near = t - self.last <= AT_ONCE * span;
        self.at_once = if is_near { self.at_once + 1 } else { 0 };
        self.last = t;
        match self.at_once > MOST_EVENTS_AT_ONCE {
            true => Err(SimErrorKind::Chattering),
            false => Ok(()),
        }
    }
}
