//! How deep evaluation may nest: counted in calls and in bytes of the thread's stack, so that
//! endless recursion is an error and not a crash.

use super::errors::RECURSION_LIMIT;
use crate::diag::Fault;
use crate::fault;
use std::cell::Cell;

/// The most calls of functions inside each other.
pub(crate) const MAX_CALLS: usize = 1000;

/// What evaluation may use of the stack unless [`with_stack`] says otherwise: the stacks of
/// secondary threads have 2 MiB.
const DEFAULT_BYTES: usize = 1 << 20;

thread_local! {
    static BASE: Cell<Option<usize>> = const { Cell::new(None) };
    static BYTES: Cell<usize> = const { Cell::new(DEFAULT_BYTES) };
    static CALLS: Cell<usize> = const { Cell::new(0) };
}

/// Runs `work` with evaluation allowed to use this many bytes of the current thread's stack. The
/// caller knows that the thread has them.
pub fn with_stack<T>(bytes: usize, work: impl FnOnce() -> T) -> T {
    let before = BYTES.replace(bytes);
    let result = work();
    BYTES.set(before);
    result
}

/// Marks the outermost evaluation on this thread until it is dropped.
pub(super) struct Entry {
    outermost: bool,
}

impl Entry {
    pub(super) fn new() -> Entry {
        let outermost = BASE.get().is_none();
        if outermost {
            BASE.set(Some(stack_address()));
        }
        Entry { outermost }
    }
}

impl Drop for Entry {
    fn drop(&mut self) {
        if self.outermost {
            BASE.set(None);
        }
    }
}

/// Counts a call until it is dropped.
pub(super) struct Call;

impl Call {
    pub(super) fn new(name: &impl std::fmt::Display) -> Result<Call, Fault> {
        let calls = CALLS.get();
        // Less than all, so that it is a call that has no room and not an expression in it.
        if calls >= MAX_CALLS || !has_room(BYTES.get() / 8 * 7) {
            return Err(fault!(
                RECURSION_LIMIT,
                "the calls of `{name}` are nested too deeply";
                help: "check the condition that ends the recursion"
            ));
        }
        CALLS.set(calls + 1);
        Ok(Call)
    }
}

impl Drop for Call {
    fn drop(&mut self) {
        CALLS.set(CALLS.get().saturating_sub(1));
    }
}

/// Whether an expression may nest one level deeper.
pub(super) fn check_nesting() -> Result<(), Fault> {
    if has_room(BYTES.get()) {
        return Ok(());
    }
    Err(Fault::new(RECURSION_LIMIT, "the expression is nested too deeply"))
}

fn has_room(bytes: usize) -> bool {
    BASE.get().is_none_or(|base| base.abs_diff(stack_address()) < bytes)
}

#[inline(never)]
fn stack_address() -> usize {
    let marker = 0u8;
    std::ptr::from_ref(std::hint::black_box(&marker)).addr()
}
