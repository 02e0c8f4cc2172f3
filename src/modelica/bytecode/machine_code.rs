//! Functions that run often become machine code.
//!
//! A function is interpreted until that took as long as its translation takes. Machine code works on
//! the same frame as the interpreter and has every result in it at once, so that either continues
//! where the other stopped: machine code leaves every instruction that fails to the interpreter. Both give the same bits and take the same from the budget.

#![allow(unsafe_code, reason = "machine code made at run time can only be called so")]

use crate::jit::Executable;
use std::ffi::c_void;
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

/// What runs next.
#[derive(Clone, Copy)]
pub(super) enum Next<'a> {
    /// The interpreter, whatever comes.
    Everything,
    /// The interpreter for so many instructions: then the function is translated.
    AtMost(u64),
    /// Machine code as far as it can.
    MachineCode(&'a Translated),
}

impl MachineCode {
    /// What runs next of a function of so many instructions, which is translated so.
    pub(super) fn next(
        &self,
        length: usize,
        translated: impl FnOnce() -> Option<Translated>,
    ) -> Next<'_> {
        if self.translated.get().is_none() {
            let often = OFTEN * (length as u64).max(SHORT);
            let interpreted = self.interpreted.load(Ordering::Relaxed);
            if interpreted < often {
                return Next::AtMost(often - interpreted);
            }
        }
        let translated = self.translated.get_or_init(translated).as_ref();
        translated.map_or(Next::Everything, Next::MachineCode)
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

/// What the machine code is called as: the frame, what stands for no value, the budget, the number of
/// the first instruction, and what [`direct_calls`](super::direct_calls) needs; the number of the
/// instruction that it leaves to the interpreter.
type Entry = unsafe extern "C" fn(*mut f64, f64, *mut u64, u64, *mut c_void) -> u64;

/// A function in memory of its own.
pub(super) struct Translated {
    entry: Entry,
    layout: Layout,
    _code: Executable,
}

/// What the machine code of a function expects of its frame.
#[derive(Debug, Clone, Copy)]
pub(super) struct Layout {
    /// How many numbers it has.
    pub(super) frame: usize,
    /// Of how many parts each.
    pub(super) parts: usize,
    /// Whether constants must be in it.
    pub(super) reads_constants: bool,
}

impl Translated {
    /// The function that begins at an address of the code, for such frames.
    ///
    /// # Safety
    /// It has the signature of [`Entry`], reads and writes no more than such a frame and the budget, and
    /// hands what it is given last to nothing but [`direct_calls::call`](super::direct_calls::call) for
    /// numbers of so many parts.
    pub(super) unsafe fn new(code: Executable, address: *const u8, layout: Layout) -> Translated {
        // SAFETY: the caller promises the signature; the code lives as long as the result, which keeps
        // it.
        let entry = unsafe { std::mem::transmute::<*const u8, Entry>(address) };
        Translated { entry, layout, _code: code }
    }

    /// Whether constants must be in its frame.
    pub(super) fn reads_constants(&self) -> bool {
        self.layout.reads_constants
    }

    /// Asserts that a frame of so many numbers of so many parts has the registers of the function.
    pub(super) fn check(&self, frame: usize, parts: usize) {
        assert!(self.layout.frame <= frame, "the frame has the registers of the function");
        assert_eq!(self.layout.parts, parts, "the numbers are those it was translated for");
    }

    /// Runs the function on a frame from an instruction on; the number of the instruction that it leaves
    /// to the interpreter.
    ///
    /// # Safety
    /// The frame is as [`Translated::check`] asks for, the context that of
    /// [`direct_calls`](super::direct_calls) for this frame, or null.
    pub(super) unsafe fn enter(
        &self,
        at: usize,
        frame: *mut f64,
        unassigned: f64,
        budget: *mut u64,
        context: *mut c_void,
    ) -> usize {
        // SAFETY: the frame is as large as the code takes it to be, of numbers whose parts are
        // contiguous.
        let left = unsafe { (self.entry)(frame, unassigned, budget, at as u64, context) };
        left as usize
    }
}

#[cfg(all(test, feature = "jit"))]
#[path = "machine_code_tests.rs"]
mod tests;
