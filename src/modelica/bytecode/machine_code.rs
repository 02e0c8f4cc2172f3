//! Functions that run often become machine code.
//!
//! A function is interpreted until that took as long as its translation takes. Machine code works on
//! the same frame as the interpreter and has every result in it at once, so that either continues
//! where the other stopped: machine code leaves calls, and every instruction that fails, to the
//! interpreter. Both give the same bits and take the same from the budget.

#![allow(unsafe_code, reason = "machine code made at run time can only be called so")]

use crate::arithmetic::Number;
use crate::jit::Executable;
use std::sync::OnceLock;
use std::sync::atomic::{AtomicU64, Ordering};

/// A function is translated after its instructions were interpreted this many times.
const OFTEN: u64 = 1_000;
/// Shorter functions are as if they had so many instructions: making memory executable takes time.
const SHORT: u64 = 100;

/// The machine code of a function for one kind of number, once it has run often.
#[derive(Default)]
pub(crate) struct MachineCode {
    interpreted: AtomicU64,
    translated: OnceLock<Option<Translated>>,
}

/// What is interpreted next.
#[derive(Debug, PartialEq, Eq)]
pub(super) enum Next {
    /// Whatever comes.
    Everything,
    /// So many instructions: then the function is translated.
    AtMost(u64),
}

impl MachineCode {
    /// Runs as much as machine code can, of a function of so many instructions which is translated so;
    /// says what the interpreter does then.
    pub(super) fn run<T: Number>(
        &self,
        (length, translated): (usize, impl FnOnce() -> Option<Translated>),
        at: &mut usize,
        frame: &mut [T],
        unassigned: f64,
        budget: &mut u64,
    ) -> Next {
        let often = OFTEN * (length as u64).max(SHORT);
        if self.translated.get().is_none() {
            let interpreted = self.interpreted.load(Ordering::Relaxed);
            if interpreted < often {
                return Next::AtMost(often - interpreted);
            }
        }
        if let Some(translated) = self.translated.get_or_init(translated) {
            *at = translated.call(*at, frame, unassigned, budget);
        }
        Next::Everything
    }

    /// Counts instructions that were interpreted.
    pub(super) fn count(&self, instructions: u64) {
        self.interpreted.fetch_add(instructions, Ordering::Relaxed);
    }
}

impl Clone for MachineCode {
    fn clone(&self) -> MachineCode {
        MachineCode::default()
    }
}

impl std::fmt::Debug for MachineCode {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("MachineCode")
            .field("interpreted", &self.interpreted)
            .finish_non_exhaustive()
    }
}

/// What the machine code is called as: the frame, what stands for no value, the budget and the number
/// of the first instruction; the number of the instruction that it leaves to the interpreter.
type Entry = unsafe extern "C" fn(*mut f64, f64, *mut u64, u64) -> u64;

/// A function in memory of its own.
pub(super) struct Translated {
    entry: Entry,
    /// How many numbers its frame has, of how many parts each.
    frame: usize,
    parts: usize,
    _code: Executable,
}

impl Translated {
    /// The function that begins at an address of the code, for frames of so many numbers of so many
    /// parts.
    ///
    /// # Safety
    /// It has the signature of [`Entry`], and reads and writes no more than such a frame and the budget.
    pub(super) unsafe fn new(
        code: Executable,
        address: *const u8,
        (frame, parts): (usize, usize),
    ) -> Translated {
        // SAFETY: the caller promises the signature; the code lives as long as the result, which keeps
        // it.
        let entry = unsafe { std::mem::transmute::<*const u8, Entry>(address) };
        Translated { entry, frame, parts, _code: code }
    }

    /// Runs the function on a frame from an instruction on; the number of the instruction that it leaves
    /// to the interpreter.
    pub(super) fn call<T: Number>(
        &self,
        at: usize,
        frame: &mut [T],
        unassigned: f64,
        budget: &mut u64,
    ) -> usize {
        assert!(self.frame <= frame.len(), "the frame has the registers of the function");
        assert_eq!(self.parts, T::PARTS, "the numbers are those it was translated for");
        let frame = frame.as_mut_ptr().cast();
        // SAFETY: the frame is as large as the code takes it to be, of numbers whose parts are
        // contiguous.
        let left = unsafe { (self.entry)(frame, unassigned, budget, at as u64) };
        left as usize
    }
}

#[cfg(all(test, feature = "jit"))]
#[path = "machine_code_tests.rs"]
mod tests;
