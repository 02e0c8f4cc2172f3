//! In place of machine code where the feature `jit` is left out: functions are always interpreted.

use super::code::{Code, Functions};

/// The machine code that a function never gets.
#[derive(Debug, Clone, Default)]
pub(crate) struct MachineCode;

/// What is interpreted next.
#[derive(Debug, PartialEq, Eq)]
pub(super) enum Next {
    /// Whatever comes.
    Everything,
    /// So many instructions: then the function is translated.
    AtMost(u64),
}

impl MachineCode {
    /// Runs nothing.
    pub(super) fn run<T>(
        &self,
        _: (&Functions, &Code),
        _: &mut usize,
        _: &mut [T],
        _: f64,
        _: &mut u64,
    ) -> Next {
        Next::Everything
    }

    /// Counts nothing.
    pub(super) fn count(&self, _: u64) {}
}
