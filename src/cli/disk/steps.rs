//! The system calls that change the disk, one by one, so that tests can make each of them fail.

use std::fs::File;
use std::io;

/// Precedes every call that changes the disk. `torn` leaves what the call may leave when it fails
/// half-way.
#[cfg(not(test))]
pub(super) fn step(_torn: impl FnOnce()) -> io::Result<()> {
    Ok(())
}

#[cfg(test)]
pub(super) fn step(torn: impl FnOnce()) -> io::Result<()> {
    failing::step(torn)
}

/// A file whose writes are steps.
pub(super) struct Stepwise<'f>(pub(super) &'f File);

impl io::Write for Stepwise<'_> {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        let half = || drop(io::Write::write(&mut &*self.0, &bytes[..bytes.len() / 2]));
        step(half)?;
        io::Write::write(&mut self.0, bytes)
    }

    fn flush(&mut self) -> io::Result<()> {
        io::Write::flush(&mut self.0)
    }
}

/// What tests ask for.
#[cfg(test)]
pub(super) mod failing {
    use std::cell::Cell;
    use std::io;

    /// What happens at the chosen step.
    #[derive(Debug, Clone, Copy, PartialEq, Eq)]
    pub(in crate::disk) enum Failure {
        /// The call fails; those after it do not.
        Fault,
        /// The process ends there: nothing reaches the disk any more.
        Crash,
    }

    /// The steps of this thread: how many were done, and which fails.
    #[derive(Debug, Clone, Copy, Default)]
    pub(in crate::disk) struct Plan {
        pub(in crate::disk) done: usize,
        pub(in crate::disk) fail_at: Option<(usize, Failure)>,
    }

    thread_local! {
        pub(in crate::disk) static PLAN: Cell<Plan> = const {
            Cell::new(Plan { done: 0, fail_at: None })
        };
    }

    /// Whether the process has ended as planned.
    pub(in crate::disk) fn has_crashed() -> bool {
        let plan = PLAN.get();
        plan.fail_at.is_some_and(|(at, how)| how == Failure::Crash && plan.done >= at)
    }

    pub(super) fn step(torn: impl FnOnce()) -> io::Result<()> {
        let mut plan = PLAN.get();
        plan.done += 1;
        PLAN.set(plan);
        let Some((at, how)) = plan.fail_at else { return Ok(()) };
        if plan.done == at {
            torn();
        }
        match plan.done == at || how == Failure::Crash && plan.done > at {
            true => Err(io::Error::new(io::ErrorKind::StorageFull, "no space left on device")),
            false => Ok(()),
        }
    }
}
