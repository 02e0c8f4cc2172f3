//! Short calls that turn out to be long.
//!
//! A simulation of microseconds is made on the calling thread, which cannot look for Ctrl-C meanwhile. A
//! thread watches how long such calls last and cancels them, so that they are made again where the
//! calling thread is free.

use std::io;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::{Arc, LazyLock, Mutex, PoisonError, Weak};
use std::time::{Duration, Instant};

/// From when on a call is long, milliseconds: what a user takes for an immediate answer to Ctrl-C.
const LONG: u64 = 100;
/// How often the thread looks.
const TICK: Duration = Duration::from_millis(50);

static BEGIN: LazyLock<Instant> = LazyLock::new(Instant::now);
static ALL: Mutex<All> = Mutex::new(All { process: 0, watched: Vec::new() });

/// What the thread of this process watches. It ends when nothing is left.
struct All {
    /// A forked process has the memory, but not the thread.
    process: u32,
    watched: Vec<Weak<Watched>>,
}

/// Calls of one simulator, one after the other.
pub(crate) struct Watched {
    /// When the present call began, milliseconds; 0 between two calls.
    begun: AtomicU64,
    late: Arc<AtomicBool>,
    /// Whether the last call was long.
    slow: AtomicBool,
}

impl Watched {
    pub(crate) fn new() -> io::Result<Arc<Watched>> {
        let watched = Arc::new(Watched {
            begun: AtomicU64::new(0),
            late: Arc::new(AtomicBool::new(false)),
            slow: AtomicBool::new(false),
        });
        let mut all = ALL.lock().unwrap_or_else(PoisonError::into_inner);
        if all.process != std::process::id() {
            *all = All { process: std::process::id(), watched: Vec::new() };
        }
        if all.watched.is_empty() {
            std::thread::Builder::new().name("gapilib-watch".to_owned()).spawn(watch)?;
        }
        all.watched.push(Arc::downgrade(&watched));
        Ok(watched)
    }

    /// Whether the next call is likely to be long.
    pub(crate) fn is_slow(&self) -> bool {
        self.slow.load(Ordering::Relaxed)
    }

    /// A call begins; the flag that cancels it.
    pub(crate) fn begin(&self) -> Arc<AtomicBool> {
        self.late.store(false, Ordering::SeqCst);
        self.begun.store(now(), Ordering::SeqCst);
        self.late.clone()
    }

    /// The call has ended; whether it was cancelled.
    pub(crate) fn end(&self) -> bool {
        self.begun.store(0, Ordering::SeqCst);
        let late = self.late.load(Ordering::SeqCst);
        self.slow.store(late, Ordering::Relaxed);
        late
    }

    /// A call that nobody watched has lasted so long.
    pub(crate) fn lasted(&self, duration: Duration) {
        self.slow.store(duration >= Duration::from_millis(LONG), Ordering::Relaxed);
    }
}

/// Milliseconds, from 1.
fn now() -> u64 {
    1 + u64::try_from(BEGIN.elapsed().as_millis()).unwrap_or(u64::MAX - 1)
}

fn watch() {
    loop {
        std::thread::sleep(TICK);
        let mut all = ALL.lock().unwrap_or_else(PoisonError::into_inner);
        all.watched.retain(|one| {
            one.upgrade().is_some_and(|one| {
                let begun = one.begun.load(Ordering::SeqCst);
                if begun != 0 && now() > begun + LONG {
                    one.late.store(true, Ordering::SeqCst);
                }
                true
            })
        });
        if all.watched.is_empty() {
            return;
        }
    }
}
