//! Calls of functions that machine code makes itself, without returning to the interpreter.
//!
//! Machine code calls [`call`], which does what the machine does at an instruction that calls. The
//! stack may move meanwhile: machine code continues on the frame that it is given back. Where there is
//! none, either the call failed, which the machine knows, or it is left to the machine.

#![allow(unsafe_code, reason = "machine code hands over its frame as a pointer")]

use super::code::Functions;
use super::machine_code::Translated;
use crate::arithmetic::Number;
use std::ffi::c_void;

/// A call that a function requests.
#[derive(Debug, PartialEq)]
pub(super) struct Call {
    /// The function that is called.
    pub(super) function: u32,
    /// The first register of the arguments.
    pub(super) arguments: u32,
    /// The first register of the results.
    pub(super) results: u32,
}

/// What makes calls of functions for machine code.
pub(super) trait MakesCalls<T> {
    /// Makes a call by the instruction `at`, with a frame of so many registers at `base`; whether it has
    /// its results. If not, it failed or is to be made as by the interpreter.
    fn make_call(
        &mut self,
        functions: &Functions,
        call: &Call,
        at: u32,
        frame: (usize, usize),
        stack: &mut Vec<T>,
    ) -> bool;

    /// What registers hold that nothing was assigned to.
    fn unassigned(&self) -> f64;

    /// What is left of the budget.
    fn budget_mut(&mut self) -> &mut u64;
}

/// What machine code calls to make a call: [`call`] for a kind of number.
pub(super) type MakeCall<T> = unsafe extern "C" fn(*mut c_void, *mut T, u64, u64, u64) -> *mut T;

/// What machine code needs to call other functions.
struct Context<M, T> {
    machine: *mut M,
    functions: *const Functions,
    stack: *mut Vec<T>,
}

/// A call as machine code hands it over: numbers of at most 32 bits in pairs.
#[derive(Debug, Clone, Copy)]
pub(super) struct Packed {
    /// The function and the number of the instruction.
    pub(super) function_and_place: u64,
    /// The first registers of the arguments and of the results.
    pub(super) registers: u64,
}

impl Packed {
    /// The call by the instruction `at`.
    pub(super) fn new(call: &Call, at: u32) -> Packed {
        let pair = |high: u32, low: u32| u64::from(high) << 32 | u64::from(low);
        Packed {
            function_and_place: pair(call.function, at),
            registers: pair(call.arguments, call.results),
        }
    }

    /// The call, and the number of the instruction.
    fn unpacked(self) -> (Call, u32) {
        let parts = |pair: u64| ((pair >> 32) as u32, pair as u32);
        let (function, at) = parts(self.function_and_place);
        let (arguments, results) = parts(self.registers);
        (Call { function, arguments, results }, at)
    }
}

/// Runs the machine code of a function whose frame begins at `base`, from the instruction `at` on; the
/// number of the instruction that it leaves to the machine.
pub(super) fn run<M: MakesCalls<T>, T: Number>(
    translated: &Translated,
    (machine, functions): (&mut M, &Functions),
    stack: &mut Vec<T>,
    (base, at): (usize, usize),
) -> usize {
    let unassigned = machine.unassigned();
    translated.check(stack.len().saturating_sub(base), T::PARTS);
    let machine: *mut M = machine;
    let stack: *mut Vec<T> = stack;
    let mut context = Context { machine, functions, stack };
    // SAFETY: the stack has the whole frame, as was just checked. Until machine code returns, the machine
    // and the stack are used by it and by `call` alone, which it calls with this context.
    unsafe {
        let frame = (*stack).as_mut_ptr().add(base).cast();
        let budget = (*machine).budget_mut();
        translated.enter(at, frame, unassigned, budget, (&raw mut context).cast())
    }
}

/// Calls a function for machine code whose frame has so many registers; where that frame is then.
///
/// # Safety
/// The context is that of [`run`] for such a machine and such numbers, or null; the frame is in its
/// stack.
pub(super) unsafe extern "C" fn call<M: MakesCalls<T>, T: Number>(
    context: *mut c_void,
    frame: *mut T,
    function_and_place: u64,
    registers: u64,
    size: u64,
) -> *mut T {
    // SAFETY: the caller promises what the context is, and uses what it points to no more until this
    // returns.
    let Some(context) = (unsafe { context.cast::<Context<M, T>>().as_ref() }) else {
        return std::ptr::null_mut();
    };
    // SAFETY: as above.
    let (machine, functions, stack) =
        unsafe { (&mut *context.machine, &*context.functions, &mut *context.stack) };
    // SAFETY: the frame is in the stack.
    let base = unsafe { frame.cast_const().offset_from(stack.as_ptr()) } as usize;
    let (call, at) = Packed { function_and_place, registers }.unpacked();
    match machine.make_call(functions, &call, at, (base, size as usize), stack) {
        // SAFETY: the stack only grows.
        true => unsafe { stack.as_mut_ptr().add(base) },
        false => std::ptr::null_mut(),
    }
}
