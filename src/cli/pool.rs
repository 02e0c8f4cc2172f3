//! Many cases on few threads, each within its time.

use super::thread_time::ThreadTime;
use crate::script::models::verification::Stage;
use crate::script::with_stack;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::{Arc, Mutex, OnceLock, mpsc};
use std::thread;
use std::time::{Duration, Instant};

/// Stack of a case, bytes.
const STACK: usize = 128 << 20;

/// Waiting time for a case that was asked to end, before the next one begins.
const GRACE: Duration = Duration::from_secs(5);

/// How often the time of a case is looked at.
const LOOK: Duration = Duration::from_millis(50);

/// A case that waits instead of working ends after so many times its limit.
const WAITING: u32 = 10;

/// Who works on a case, and how far the work is.
#[derive(Default)]
pub(super) struct Watch {
    /// The time of the thread that works.
    time: OnceLock<ThreadTime>,
    /// The stages entered, and the time of the thread then.
    entered: Mutex<Vec<(Stage, Duration)>>,
    /// Whether the work is cancelled.
    pub cancel: Arc<AtomicBool>,
}

/// How the work on a case ended.
pub(super) enum Ended<T> {
    /// It gave a result.
    Done(T),
    /// It panicked.
    Panicked,
    /// It took longer than it may.
    TimedOut,
}

impl Watch {
    /// Notes that a stage begins now.
    pub(super) fn enter(&self, stage: Stage) {
        let now = self.elapsed();
        self.entered.lock().expect("no panic under the lock").push((stage, now));
    }

    /// The time that the work has taken.
    fn elapsed(&self) -> Duration {
        self.time.get().map_or(Duration::ZERO, ThreadTime::elapsed)
    }

    /// The stage that the work is in.
    pub(super) fn stage(&self) -> Option<Stage> {
        self.entered.lock().expect("no panic under the lock").last().map(|(stage, _)| *stage)
    }

    /// Seconds from the beginning of one stage to that of another; `None` unless both began.
    pub(super) fn seconds(&self, from: Stage, to: Stage) -> Option<f64> {
        let entered = self.entered.lock().expect("no panic under the lock");
        let begin = |sought| Some(entered.iter().find(|(stage, _)| *stage == sought)?.1);
        Some(begin(to)?.saturating_sub(begin(from)?).as_secs_f64())
    }
}

/// Works on every case, at most `threads` at a time, and gives each end to `done` as it comes: the
/// number of the case, the watch, the end.
pub(super) fn work<C, T>(
    cases: &[C],
    threads: usize,
    budget: Duration,
    job: impl Fn(&C) -> Box<dyn FnOnce(&Watch) -> T + Send> + Sync,
    done: impl Fn(usize, &Watch, Ended<T>) + Sync,
) where
    C: Sync,
    T: Send + 'static,
{
    let next = AtomicUsize::new(0);
    thread::scope(|scope| {
        for _ in 0..threads {
            scope.spawn(|| {
                loop {
                    let index = next.fetch_add(1, Ordering::Relaxed);
                    let Some(case) = cases.get(index) else { break };
                    let watch = Arc::new(Watch::default());
                    let ended = within(budget, &watch, job(case));
                    done(index, &watch, ended);
                }
            });
        }
    });
}

fn within<T: Send + 'static>(
    budget: Duration,
    watch: &Arc<Watch>,
    job: Box<dyn FnOnce(&Watch) -> T + Send>,
) -> Ended<T> {
    let (sender, receiver) = mpsc::channel();
    let shared = watch.clone();
    let worker = move || {
        shared.time.get_or_init(ThreadTime::of_this_thread);
        let result = with_stack(STACK - (4 << 20), || job(&shared));
        // The receiver is gone if it took too long.
        let _ = sender.send(result);
    };
    if thread::Builder::new().stack_size(STACK).spawn(worker).is_err() {
        return Ended::Panicked;
    }
    let began = Instant::now();
    loop {
        match receiver.recv_timeout(LOOK.min(budget)) {
            Ok(result) => return Ended::Done(result),
            Err(mpsc::RecvTimeoutError::Disconnected) => return Ended::Panicked,
            Err(mpsc::RecvTimeoutError::Timeout) => {}
        }
        if watch.elapsed() >= budget || began.elapsed() >= budget.saturating_mul(WAITING) {
            watch.cancel.store(true, Ordering::Relaxed);
            // What cannot be asked to end is left alone.
            let _ = receiver.recv_timeout(GRACE);
            return Ended::TimedOut;
        }
    }
}
