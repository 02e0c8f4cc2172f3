//! Forked processes. A child has the memory of its parent and only the thread that forked: what
//! another thread had locked at that moment stays locked, what it was making is never finished.
//!
//! So threads are counted while they work in the library. A child whose parent had none at work finds
//! every lock free; any other one is refused before it waits for ever.

use pyo3::exceptions::PyRuntimeError;
use pyo3::prelude::*;
use std::sync::atomic::{AtomicU32, AtomicUsize, Ordering};

/// The process that imported the module, and those forked from it that are sound; the count is theirs.
static PROCESS: AtomicU32 = AtomicU32::new(0);
static AT_WORK: AtomicUsize = AtomicUsize::new(0);

/// A thread at work in the library until this is dropped: after everything that it has locked.
pub(crate) struct AtWork {
    process: u32,
}

impl AtWork {
    /// Work begins. Who calls it has the global lock, so that no other thread forks meanwhile.
    ///
    /// # Errors
    ///
    /// `RuntimeError` in a process that was forked while a thread of its parent was at work.
    pub(crate) fn begin(_: Python<'_>) -> PyResult<AtWork> {
        let process = std::process::id();
        if PROCESS.load(Ordering::SeqCst) != process {
            if AT_WORK.load(Ordering::SeqCst) != 0 {
                return Err(PyRuntimeError::new_err(
                    "this process was forked while another thread was at work in gapilib, and would \
                     wait for that thread for ever: start processes with the method \"spawn\" or \
                     \"forkserver\", or fork while gapilib does nothing",
                ));
            }
            PROCESS.store(process, Ordering::SeqCst);
        }
        AT_WORK.fetch_add(1, Ordering::SeqCst);
        Ok(AtWork { process })
    }

    /// The process: the system is asked for it once a call.
    pub(crate) fn process(&self) -> u32 {
        self.process
    }
}

impl Drop for AtWork {
    fn drop(&mut self) {
        AT_WORK.fetch_sub(1, Ordering::SeqCst);
    }
}

/// Something with threads of this process: in a forked one it is left as it is, because its end would
/// wait for threads that are not there.
pub(crate) struct Own<T> {
    process: u32,
    /// `None` at its end.
    value: Option<T>,
}

impl<T> Own<T> {
    pub(crate) fn new(value: T) -> Own<T> {
        Own { process: std::process::id(), value: Some(value) }
    }

    /// The process that it was made in.
    pub(crate) fn process(&self) -> u32 {
        self.process
    }

    /// It, in the process that it was made in.
    pub(crate) fn get(&self) -> Option<&T> {
        self.value.as_ref().filter(|_| self.process == std::process::id())
    }

    /// It, to be ended; once, in the process that it was made in.
    pub(crate) fn take(&mut self) -> Option<T> {
        if self.process == std::process::id() { self.value.take() } else { None }
    }
}

impl<T> Drop for Own<T> {
    fn drop(&mut self) {
        if self.process != std::process::id() {
            std::mem::forget(self.value.take());
        }
    }
}
