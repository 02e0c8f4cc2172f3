//! Calls of a unit: which one is running, and how they fail.

use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Mutex, MutexGuard, PoisonError};

/// How a call failed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Severity {
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
pub(crate) struct CallError {
    /// The function.
    pub function: &'static str,
    /// How.
    pub severity: Severity,
}

impl CallError {
    /// Whether the instance cannot be used any more.
    pub(crate) fn is_final(self) -> bool {
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

/// Which call is running, for a thread that looks for one that does not return. Calls are short: what each of
/// them costs is one write at its begin and one at its end.
#[derive(Debug, Default)]
pub struct CallWatch {
    /// The functions, by their numbers.
    names: Mutex<Vec<&'static str>>,
    /// How many calls have begun, times [`NAMES`], plus 1 and the number of the function that runs now; plus 0
    /// where none runs.
    calls: AtomicU64,
}

/// More than there are functions.
const NAMES: u64 = 256;

impl CallWatch {
    fn names(&self) -> MutexGuard<'_, Vec<&'static str>> {
        self.names.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// The number of a function.
    pub(super) fn number_of(&self, function: &'static str) -> u64 {
        let mut names = self.names();
        let at = names.iter().position(|name| *name == function).unwrap_or_else(|| {
            names.push(function);
            names.len() - 1
        });
        (at as u64).min(NAMES - 2)
    }

    /// A call of the function of this number begins. One thread calls.
    pub(super) fn enter(&self, function: u64) {
        let count = self.calls.load(Ordering::Relaxed) / NAMES + 1;
        self.calls.store(count * NAMES + 1 + function, Ordering::Relaxed);
    }

    /// It has returned.
    pub(super) fn leave(&self) {
        let calls = self.calls.load(Ordering::Relaxed);
        self.calls.store(calls - calls % NAMES, Ordering::Relaxed);
    }

    /// The number of the call that runs now, and its function.
    pub fn running(&self) -> Option<(u64, &'static str)> {
        let calls = self.calls.load(Ordering::Relaxed);
        let function = (calls % NAMES).checked_sub(1)?;
        Some((calls / NAMES, self.names().get(function as usize).copied()?))
    }
}

#[cfg(test)]
mod tests {
    use super::CallWatch;

    #[test]
    fn the_call_that_runs_has_its_number_and_its_name() {
        let watch = CallWatch::default();
        let [one, other] = ["one", "other"].map(|name| watch.number_of(name));
        assert_eq!(watch.number_of("one"), one);
        assert_eq!(watch.running(), None);
        watch.enter(other);
        assert_eq!(watch.running(), Some((1, "other")));
        watch.leave();
        assert_eq!(watch.running(), None);
        watch.enter(one);
        assert_eq!(watch.running(), Some((2, "one")));
    }
}
