//! Short calls that turn out to be long.
//!
//! A simulation of microseconds is made on the calling thread, which cannot look for Ctrl-C meanwhile. A
//! thread watches how long such calls last and cancels them, so that they are made again where the
//! calling thread is free.

use crate::forked::Own;
use std::io;
use std::sync::atomic::{AtomicBool, AtomicU32, AtomicU64, Ordering};
use std::sync::mpsc::{self, Receiver, Sender};
use std::sync::{Arc, LazyLock, Mutex, PoisonError, Weak};
use std::time::{Duration, Instant};

/// From when on a call is long, milliseconds: what a user takes for an immediate answer to Ctrl-C.
const LONG: u64 = 100;
/// How often the thread looks.
const TICK: Duration = Duration::from_millis(50);

static BEGIN: LazyLock<Instant> = LazyLock::new(Instant::now);

/// Where the thread of this process gets what it watches. The thread itself never locks it: a forked
/// process finds it free.
static THREAD: Mutex<Option<Own<Sender<Weak<Watched>>>>> = Mutex::new(None);

/// Calls of one simulator, one after the other.
pub(crate) struct Watched {
    /// The process whose thread watches.
    process: AtomicU32,
    /// When the present call began, milliseconds; 0 between two calls.
    begun: AtomicU64,
    late: Arc<AtomicBool>,
    /// Whether the last call was long.
    slow: AtomicBool,
}

impl Watched {
    pub(crate) fn new() -> Arc<Watched> {
        Arc::new(Watched {
            process: AtomicU32::new(0),
            begun: AtomicU64::new(0),
            late: Arc::new(AtomicBool::new(false)),
            slow: AtomicBool::new(false),
        })
    }

    /// Has the thread of this process watch it, which begins where there is none.
    ///
    /// # Errors
    ///
    /// There are no more threads to be had.
    pub(crate) fn watch(self: &Arc<Watched>, process: u32) -> io::Result<()> {
        if self.process.load(Ordering::Relaxed) == process {
            return Ok(());
        }
        let mut thread = THREAD.lock().unwrap_or_else(PoisonError::into_inner);
        if thread.as_ref().and_then(Own::get).is_none() {
            let (to, new) = mpsc::channel();
            std::thread::Builder::new().name("gapilib-watch".to_owned()).spawn(|| watch(new))?;
            *thread = Some(Own::new(to));
        }
        if let Some(to) = thread.as_ref().and_then(Own::get) {
            // The thread ends with the process.
            let _ = to.send(Arc::downgrade(self));
        }
        self.process.store(process, Ordering::Relaxed);
        Ok(())
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

    /// A call that was not watched has lasted so long.
    pub(crate) fn lasted(&self, duration: Duration) {
        self.slow.store(duration >= Duration::from_millis(LONG), Ordering::Relaxed);
    }
}

/// Milliseconds, from 1.
fn now() -> u64 {
    1 + u64::try_from(BEGIN.elapsed().as_millis()).unwrap_or(u64::MAX - 1)
}

fn watch(new: Receiver<Weak<Watched>>) {
    let mut all: Vec<Weak<Watched>> = Vec::new();
    loop {
        if all.is_empty() {
            match new.recv() {
                Ok(first) => all.push(first),
                Err(_) => return,
            }
        }
        std::thread::sleep(TICK);
        all.extend(new.try_iter());
        all.retain(|one| {
            one.upgrade().is_some_and(|one| {
                let begun = one.begun.load(Ordering::SeqCst);
                if begun != 0 && now() > begun + LONG {
                    one.late.store(true, Ordering::SeqCst);
                }
                true
            })
        });
    }
}
