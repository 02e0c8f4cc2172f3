//! Many cases on few threads, each within its time.

use super::{Failure, Progress, Stage};
use gapilib::with_stack;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Arc, Mutex, mpsc};
use std::thread;
use std::time::Duration;

/// Threads that judge cases.
const THREADS: usize = 2;

/// Stack of a case, bytes.
const STACK: usize = 128 << 20;

/// How the work on a case ended.
#[derive(Debug, Clone)]
pub(crate) enum Ended {
    /// It gave a result.
    Judged(Result<(), Failure>),
    /// It panicked in a stage.
    Panicked(Stage),
    /// It took longer than it may, the last part of it in a stage.
    TimedOut(Stage),
}

/// Runs a job for every case and returns how each ended, in order. A job that does not end in time
/// is told to cancel, and left alone.
pub(crate) fn judge_all<C: Sync>(
    cases: &[C],
    job: impl Fn(&C) -> Job + Sync,
    seconds: f64,
) -> Vec<Ended> {
    let budget = std::env::var("GAPILIB_BUDGET").ok().and_then(|text| text.parse().ok());
    let budget = Duration::from_secs_f64(budget.unwrap_or(seconds));
    let next = AtomicUsize::new(0);
    let ended = Mutex::new(vec![Ended::TimedOut(Stage::Load); cases.len()]);
    thread::scope(|scope| {
        for _ in 0..THREADS {
            scope.spawn(|| {
                while let Some(case) = {
                    let index = next.fetch_add(1, Ordering::Relaxed);
                    cases.get(index).map(|case| (index, case))
                } {
                    let outcome = within(budget, job(case.1));
                    ended.lock().expect("no panic under the lock")[case.0] = outcome;
                }
            });
        }
    });
    ended.into_inner().expect("no panic under the lock")
}

/// Work that can be cancelled.
pub(crate) type Job = Box<dyn FnOnce(&Progress) -> Result<(), Failure> + Send>;

fn within(budget: Duration, job: Job) -> Ended {
    let progress = Arc::new(Progress::default());
    let (sender, receiver) = mpsc::channel();
    let shared = progress.clone();
    let worker = move || {
        let result = with_stack(STACK - (4 << 20), || job(&shared));
        // Nobody listens any more if it took too long.
        let _ = sender.send(result);
    };
    let started = thread::Builder::new().stack_size(STACK).spawn(worker);
    started.expect("a thread can be started");
    match receiver.recv_timeout(budget) {
        Ok(result) => Ended::Judged(result),
        Err(mpsc::RecvTimeoutError::Disconnected) => Ended::Panicked(progress.stage()),
        Err(mpsc::RecvTimeoutError::Timeout) => {
            progress.cancel();
            Ended::TimedOut(progress.stage())
        }
    }
}
