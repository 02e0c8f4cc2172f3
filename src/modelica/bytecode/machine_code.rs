//! Functions that run often become machine code.
//!
//! A function is interpreted until that took as long as its translation takes. Machine code works on
//! the same frame as the interpreter and has every result in it at once, so that either goes on where
//! the other stopped: machine code leaves calls, and every instruction that fails, to the
//! interpreter. Both give the same bits and take the same from the budget.

#![allow(unsafe_code, reason = "machine code made at run time can only be called so")]

use super::code::{Code, Functions};
use super::number::Number;
use super::translation::translate;
use crate::jit::{self, Effort, Executable};
use std::sync::OnceLock;
use std::sync::atomic::{AtomicU64, Ordering};

/// A function is translated when so many times its instructions were interpreted.
const OFTEN: u64 = 1_000;
/// Shorter functions are as if they had so many instructions: making memory executable takes time.
const SHORT: u64 = 100;
/// Instructions beyond which the time of a translation matters more than the best code.
const LONG: usize = 3_000;
/// Longer functions are not translated: the time that it takes is more than linear.
const LONGEST: usize = 100_000;

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
    /// Runs as much as machine code can; says what the interpreter does then.
    pub(super) fn run<T: Number>(
        &self,
        (functions, code): (&Functions, &Code),
        at: &mut usize,
        frame: &mut [T],
        unassigned: f64,
        budget: &mut u64,
    ) -> Next {
        let often = OFTEN * (code.instructions.len() as u64).max(SHORT);
        if self.translated.get().is_none() {
            let interpreted = self.interpreted.load(Ordering::Relaxed);
            if interpreted < often {
                return Next::AtMost(often - interpreted);
            }
        }
        let translated = self.translated.get_or_init(|| Translated::new(functions, code, T::PARTS));
        if let Some(translated) = translated {
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
struct Translated {
    entry: Entry,
    /// How many numbers its frame has, of how many parts each.
    frame: usize,
    parts: usize,
    _code: Executable,
}

impl Translated {
    fn new(functions: &Functions, code: &Code, parts: usize) -> Option<Translated> {
        let length = code.instructions.len();
        if jit::is_interpreted() || length > LONGEST || !functions.is_valid(code) {
            return None;
        }
        let effort = if length <= LONG { Effort::Best } else { Effort::Quick };
        let mut executable = jit::Code::new(effort)?;
        let translated = |target, context: &mut _| translate((code, parts), target, context);
        let id = executable.define("function", translated)?;
        let executable = executable.finish()?;
        let address = executable.address(id)?;
        // SAFETY: the function was declared with the signature of `Entry` and lives as long as the
        // code, which the result keeps.
        let entry = unsafe { std::mem::transmute::<*const u8, Entry>(address) };
        Some(Translated { entry, frame: code.frame as usize, parts, _code: executable })
    }

    fn call<T: Number>(
        &self,
        at: usize,
        frame: &mut [T],
        unassigned: f64,
        budget: &mut u64,
    ) -> usize {
        assert!(self.frame <= frame.len(), "the frame has the registers of the function");
        assert_eq!(self.parts, T::PARTS, "the numbers are those it was translated for");
        let frame = frame.as_mut_ptr().cast();
        // SAFETY: the code reads and writes the registers of its frame, as parts of numbers that lie
        // one behind the other: those that instructions name were checked when it was translated,
        // those that offsets lead to are checked by it.
        let left = unsafe { (self.entry)(frame, unassigned, budget, at as u64) };
        left as usize
    }
}

#[cfg(test)]
#[path = "machine_code_tests.rs"]
mod tests;
