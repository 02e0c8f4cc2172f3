//! Terminals that are closed while a command uses them: the window, the connection, the pane of a
//! multiplexer. Their device reports a hang-up from then on, and a reader gets empty reads for
//! ever, as fast as the processor can.

use std::io::IsTerminal as _;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;

/// Time between two looks of the watch.
const LOOK: Duration = Duration::from_millis(250);
/// How long a run may take to notice that it has to stop.
const NOTICE: Duration = Duration::from_millis(1500);

/// What standard input has.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Input {
    /// Nothing so far.
    Silent,
    /// Something to read.
    Ready,
    /// It is a terminal that was closed.
    Closed,
}

/// Waits for a key, or for the end of the terminal, no longer than this.
#[cfg(unix)]
pub(super) fn wait(longest: Duration) -> Input {
    use rustix::event::{PollFd, PollFlags, Timespec, poll};
    let input = std::io::stdin();
    let mut watched = [PollFd::new(&input, PollFlags::IN)];
    let tv_sec = longest.as_secs().try_into().unwrap_or(i64::MAX);
    let timeout = Timespec { tv_sec, tv_nsec: longest.subsec_nanos().into() };
    if poll(&mut watched, Some(&timeout)).is_err() {
        // A signal came first.
        return Input::Silent;
    }
    let found = watched[0].revents();
    match found.intersects(PollFlags::HUP | PollFlags::ERR | PollFlags::NVAL) {
        true => Input::Closed,
        false if found.contains(PollFlags::IN) => Input::Ready,
        false => Input::Silent,
    }
}

/// Waits for a key; here a process ends with its terminal.
#[cfg(not(unix))]
pub(super) fn wait(longest: Duration) -> Input {
    match ratatui::crossterm::event::poll(longest) {
        Ok(true) => Input::Ready,
        _ => Input::Silent,
    }
}

/// Whether the terminal on standard input was closed.
pub(super) fn is_closed() -> bool {
    wait(Duration::ZERO) == Input::Closed
}

/// Asks a run to stop when its terminal is closed, as the signal SIGHUP does, which not every terminal
/// sends; one that does not notice ends with the process. A run that was started to outlive its terminal
/// (`nohup`) continues. `noticed` is set when the run has seen that it has to stop.
pub(super) fn watch(interrupt: &Arc<AtomicBool>, noticed: Arc<AtomicBool>) {
    if cfg!(not(unix)) || !std::io::stdin().is_terminal() || outlives_terminal() {
        return;
    }
    let flag = Arc::downgrade(interrupt);
    let look = move || {
        while !is_closed() {
            std::thread::sleep(LOOK);
            if flag.strong_count() == 0 {
                return;
            }
        }
        if let Some(flag) = flag.upgrade() {
            flag.store(true, Ordering::SeqCst);
        }
        std::thread::sleep(NOTICE);
        if flag.strong_count() > 0 && !noticed.load(Ordering::SeqCst) {
            #[allow(clippy::exit, reason = "the terminal for a message is gone")]
            std::process::exit(130);
        }
    };
    // Without the thread, the signal alone ends the run.
    let _ = std::thread::Builder::new().name("hang-up".to_owned()).spawn(look);
}

/// Whether the process was started to continue without its terminal.
fn outlives_terminal() -> bool {
    #[cfg(unix)]
    return super::signals::ignores_hangup();
    #[cfg(not(unix))]
    false
}
