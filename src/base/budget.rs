//! How much work functions may take: recursion whose cost is exponential, and loops without end, end
//! by this limit wherever they are run. And whether there is memory for what is about to be allocated.

use std::sync::atomic::{AtomicU64, Ordering};

/// Most instructions of one call from outside, unless [`limit_instructions`] says otherwise: some
/// tenths of a second.
pub(crate) const DEFAULT_INSTRUCTIONS: u64 = 20_000_000;

/// The same for simulations started from the command line: the multipoles of a borehole
/// with four pipes (IBPSA) take 400 million, half a second.
pub(crate) const LONG_CALL_INSTRUCTIONS: u64 = 1_000_000_000;
/// Statements of the interpreter in place of so many instructions.
const INSTRUCTIONS_A_STATEMENT: u64 = 5;

static LIMIT: AtomicU64 = AtomicU64::new(DEFAULT_INSTRUCTIONS);
static STEPS: AtomicU64 = AtomicU64::new(DEFAULT_INSTRUCTIONS / INSTRUCTIONS_A_STATEMENT);

/// Says how many instructions one call of a function may take, in the whole process: the person who
/// starts the program knows whether a function that takes longer is worth it.
pub fn limit_instructions(limit: u64) {
    LIMIT.store(limit, Ordering::Relaxed);
    STEPS.store(limit / INSTRUCTIONS_A_STATEMENT, Ordering::Relaxed);
}

/// Lets one call take [`LONG_CALL_INSTRUCTIONS`]; what is done at translation keeps its limit.
pub fn allow_long_calls() {
    LIMIT.store(LONG_CALL_INSTRUCTIONS, Ordering::Relaxed);
}

/// The most instructions of one call of a function.
pub fn instruction_limit() -> u64 {
    LIMIT.load(Ordering::Relaxed)
}

/// The most statements and iterations of loops that the interpreter runs in one call of a simulation.
pub fn statement_limit() -> u64 {
    instruction_limit() / INSTRUCTIONS_A_STATEMENT
}

/// The most statements and iterations of loops that the interpreter runs to find the values that one model
/// needs at translation: one takes as long as some instructions of compiled functions.
pub fn step_limit() -> u64 {
    STEPS.load(Ordering::Relaxed)
}

/// What a function says that exceeds the limit.
pub fn exceeded() -> String {
    format!("more than {} instructions", in_millions(instruction_limit()))
}

/// What can be done about it.
pub const REMEDY: &str =
    "check the end conditions of its loops and its recursion, or raise `--instruction-limit`";

/// A number in words where it is a whole number of millions.
pub fn in_millions(number: u64) -> String {
    match number {
        1_000_000.. if number.is_multiple_of(1_000_000) => {
            format!("{} million", number / 1_000_000)
        }
        _ => number.to_string(),
    }
}

/// Whether the system has memory for so many bytes. It is asked right before they are taken, so that
/// what is too large ends with an error and does not end the process.
pub fn has_memory(bytes: usize) -> bool {
    #[cfg(feature = "failures")]
    if memory_requests::fails() {
        return false;
    }
    Vec::<u8>::new().try_reserve_exact(bytes).is_ok()
}

/// Requests for memory on this thread, of which tests make one fail.
#[cfg(feature = "failures")]
pub mod memory_requests {
    use std::cell::Cell;

    thread_local! {
        static DONE: Cell<usize> = const { Cell::new(0) };
        static FAIL_AT: Cell<usize> = const { Cell::new(0) };
    }

    /// Works with the request of this number, from 1 on, failing; how many there were.
    pub fn failing_at<T>(number: usize, work: impl FnOnce() -> T) -> (T, usize) {
        DONE.set(0);
        FAIL_AT.set(number);
        let result = work();
        FAIL_AT.set(0);
        (result, DONE.get())
    }

    pub(super) fn fails() -> bool {
        DONE.set(DONE.get() + 1);
        DONE.get() == FAIL_AT.get()
    }
}
