//! Calls of a unit: which one is running, and how they fail.

use std::sync::{Mutex, MutexGuard, PoisonError};

/// How a call failed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Severity {
    /// The library does not have the function.
    Missing,
    /// Nothing can be computed with these values.
    Discard,
    /// It makes no instance.
    NoInstance,
    /// The instance cannot go on.
    Error,
    /// No instance of this process can go on.
    Fatal,
    /// It asks to be called again and again.
    Endless,
    /// It ends steps again and again where they begin.
    NoProgress,
    /// It says that a step has ended at a time outside the step.
    Outside {
        /// The time that it says, seconds.
        reached: f64,
        /// The beginning of the step and its end, seconds.
        step: (f64, f64),
    },
}

/// A call that failed.
#[derive(Debug, Clone, Copy, PartialEq)]
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
            Severity::NoInstance => write!(f, "`{function}` of the FMU makes no instance"),
            Severity::Error => write!(f, "`{function}` of the FMU reports an error"),
            Severity::Fatal => write!(f, "`{function}` of the FMU reports a fatal error"),
            Severity::Endless => {
                write!(f, "the iteration of `{function}` at an event does not end")
            }
            Severity::NoProgress => {
                write!(f, "`{function}` of the FMU returns early again and again, at one time")
            }
            Severity::Outside { reached, step: (from, to) } => write!(
                f,
                "`{function}` of the FMU says that its step from {from} s to {to} s ended at \
                 {reached} s"
            ),
        }
    }
}

/// Which call is running, for a thread that looks for one that does not return.
#[derive(Debug, Default)]
pub struct CallWatch(Mutex<Calls>);

#[derive(Debug, Default)]
struct Calls {
    /// How many have begun.
    count: u64,
    /// The function that runs now.
    running: Option<&'static str>,
}

impl CallWatch {
    fn calls(&self) -> MutexGuard<'_, Calls> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// A call of a function begins.
    pub(super) fn enter(&self, function: &'static str) {
        let mut calls = self.calls();
        calls.count += 1;
        calls.running = Some(function);
    }

    /// It has returned.
    pub(super) fn leave(&self) {
        self.calls().running = None;
    }

    /// The number of the call that runs now, and its function.
    pub fn running(&self) -> Option<(u64, &'static str)> {
        let calls = self.calls();
        calls.running.map(|function| (calls.count, function))
    }
}
