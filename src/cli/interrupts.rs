//! What Ctrl-C asks to stop: the latest of those that wait for it. Where none does, it ends the process.

use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{self, RecvTimeoutError};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::Duration;

/// How long the end may take after an interrupt.
const LOOK: Duration = Duration::from_millis(100);

/// The flags of those that wait, the latest last. A script may run again below a screen.
static WAITING: Mutex<Vec<Arc<AtomicBool>>> = Mutex::new(Vec::new());

fn waiting() -> MutexGuard<'static, Vec<Arc<AtomicBool>>> {
    WAITING.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Until it is dropped, Ctrl-C and the requests of the system to end set a flag.
pub(super) struct Caught(Arc<AtomicBool>);

impl Caught {
    /// Interrupts set this flag; a second one ends the process at once.
    pub(super) fn by(flag: &Arc<AtomicBool>) -> Caught {
        waiting().push(Arc::clone(flag));
        // It is set once. Without a handler Ctrl-C ends the process as it always did.
        let _ = ctrlc::set_handler(ask_to_stop);
        #[cfg(unix)]
        super::signals::catch(flag);
        Caught(Arc::clone(flag))
    }
}

impl Drop for Caught {
    fn drop(&mut self) {
        waiting().retain(|flag| !Arc::ptr_eq(flag, &self.0));
    }
}

fn ask_to_stop() {
    let latest = waiting().last().cloned();
    if latest.is_none_or(|flag| flag.swap(true, Ordering::SeqCst)) {
        #[allow(clippy::exit, reason = "the user asked twice, or nothing is there to be stopped")]
        std::process::exit(130);
    }
}

/// The answer to a question.
#[derive(Debug, PartialEq, Eq)]
pub(super) enum Answer {
    /// A line.
    Line(String),
    /// There is none: the input has ended.
    None,
    /// The flag was set.
    Interrupted,
}

/// Waits for a line of standard input, or until the flag is set.
pub(super) fn line_or(interrupt: &AtomicBool) -> Answer {
    let (tell, typed) = mpsc::channel();
    // A read continues after a signal: the thread stays in it.
    let read = move || {
        let mut line = String::new();
        let length = std::io::stdin().read_line(&mut line).unwrap_or(0);
        // Who asks no more was interrupted.
        let _ = tell.send((length > 0).then_some(line));
    };
    if std::thread::Builder::new().name("answer".to_owned()).spawn(read).is_err() {
        return Answer::None;
    }
    while !interrupt.load(Ordering::SeqCst) {
        match typed.recv_timeout(LOOK) {
            Ok(Some(line)) => return Answer::Line(line),
            Err(RecvTimeoutError::Timeout) => {}
            Ok(None) | Err(RecvTimeoutError::Disconnected) => return Answer::None,
        }
    }
    Answer::Interrupted
}
