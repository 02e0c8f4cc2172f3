//! Calls of a unit: which one is running, and how they fail.

use std::sync::atomic::{AtomicU64, Ordering};

/// How a call failed.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Severity {
    /// The library does not have the function.
    Missing,
    /// Nothing can be computed with these values.
    Discard,
    /// The instance cannot go on.
    Error,
    /// No instance of this process can go on.
    Fatal,
    /// It asks to be called again and again.
    Endless,
}

/// A call that failed.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct CallError {
    /// The function.
    pub function: &'static str,
    /// How.
    pub severity: Severity,
}

impl CallError {
    /// Whether the instance cannot be used any more.
    pub fn is_final(self) -> bool {
        self.severity != Severity::Discard
    }
}

impl std::fmt::Display for CallError {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let CallError { function, severity } = self;
        match severity {
            Severity::Missing => write!(f, "the FMU has no function `{function}`"),
            Severity::Discard => write!(f, "`{function}` of the FMU refuses these values"),
            Severity::Error => write!(f, "`{function}` of the FMU reports an error"),
            Severity::Fatal => write!(f, "`{function}` of the FMU reports a fatal error"),
            Severity::Endless => {
                write!(f, "the iteration of `{function}` at an event does not end")
            }
        }
    }
}

/// Counts calls when they begin and when they end: as long as the number is odd and does not change,
/// one has not returned.
#[derive(Debug, Default)]
pub struct CallWatch(AtomicU64);

impl CallWatch {
    /// A call begins.
    pub(super) fn enter(&self) {
        self.0.fetch_add(1, Ordering::Relaxed);
    }

    /// It has returned.
    pub(super) fn leave(&self) {
        self.0.fetch_add(1, Ordering::Relaxed);
    }

    /// The number of the call that runs now.
    pub fn running(&self) -> Option<u64> {
        Some(self.0.load(Ordering::Relaxed)).filter(|count| count % 2 == 1)
    }
}
