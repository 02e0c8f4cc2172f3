//! In place of machine code where the feature `jit` is left out: tapes are always interpreted.

use super::memory::Memory;
use crate::arithmetic::Register;
use crate::codegen::tape::Tape;

/// The machine code that a tape never gets.
#[derive(Debug, Clone, Default)]
pub(crate) struct MachineCode {}

impl MachineCode {
    /// The tape must be run.
    pub(crate) fn run(&self, _: &Tape, _: &[Register], _: &mut Memory, _: &mut [f64]) -> bool {
        false
    }

    /// The tape must be run.
    pub(crate) fn run_in_place(&self, _: &Tape, _: [&[Register]; 2], _: &mut Memory) -> bool {
        false
    }
}
