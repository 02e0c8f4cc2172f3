//! Limits of time and memory: a thread that watches the process, asks the run to stop, and ends the
//! process where the request is not checked, as in the loops of loading, flattening and compiling.

use super::live;
use super::memory;
use super::options::Limits;
use super::terminal;
use crate::budget::limit_instructions;
use crate::script::errors::LIMIT_REACHED;
use std::process::ExitCode;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex};
use std::time::{Duration, Instant};

/// Time between two looks.
const INTERVAL: Duration = Duration::from_millis(10);
/// How long a run may take to notice that it has to stop; commands of scripts and steps of
/// simulations look much more often than that.
const NOTICE: Duration = Duration::from_secs(2);
/// How long a run may take to notice that the user stops it: while it prepares, and once it has written
/// something. What cannot be cancelled then, as the writing of large files, must not cost the result.
const HEARD: [Duration; 2] = [Duration::from_secs(1), Duration::from_secs(15)];
/// How long it may take then to write what it has found.
const ENDING: Duration = Duration::from_secs(60);
/// A process that has grown to this multiple of its limit is not waited for.
const GROWTH: u64 = 2;
/// What is said of the default limit.
const DEFAULT: &str = ", three quarters of the available memory (change it with `--memory-limit`)";

/// How a run is asked to stop.
#[derive(Debug, Clone, Default)]
pub(super) struct Stopping {
    /// Set when it has to stop.
    pub flag: Arc<AtomicBool>,
    /// Why, where it was not the user who asked.
    pub reason: Arc<Mutex<Option<String>>>,
    /// Set when the run has seen the flag.
    pub noticed: Arc<AtomicBool>,
    /// Set when the run has begun to write: before, it prepares, and there is nothing to be lost.
    pub begun: Arc<AtomicBool>,
}

impl Stopping {
    fn ask(&self, reason: String) {
        if let Ok(mut place) = self.reason.lock() {
            *place = Some(reason);
        }
        self.flag.store(true, Ordering::SeqCst);
    }

    /// What was asked is over, and the next work begins.
    pub(super) fn forget(&self) {
        if let Ok(mut place) = self.reason.lock() {
            *place = None;
        }
        self.noticed.store(false, Ordering::SeqCst);
        self.begun.store(false, Ordering::SeqCst);
        self.flag.store(false, Ordering::SeqCst);
    }
}

/// Ends the watch when it is dropped.
#[derive(Debug)]
pub(super) struct Watch {
    over: Arc<AtomicBool>,
}

impl Drop for Watch {
    fn drop(&mut self) {
        self.over.store(true, Ordering::Relaxed);
    }
}

/// Watches a run that can be asked to stop, from `started` on. One that does not notice ends with
/// the process.
///
/// # Errors
/// A limit that cannot be watched; the message is printed.
pub(super) fn watch(
    limits: &Limits,
    started: Instant,
    stopping: Stopping,
) -> Result<Watch, ExitCode> {
    spawn(limits, move |limits, over| {
        let Some(message) = wait(&limits, started, over) else { return };
        stopping.ask(message.clone());
        let asked = Instant::now();
        while !over.load(Ordering::Relaxed) {
            let noticed = stopping.noticed.load(Ordering::Relaxed);
            let patience = if noticed { ENDING } else { NOTICE };
            if asked.elapsed() > patience || limits.memory_beyond(GROWTH) {
                end_process(&message);
            }
            std::thread::sleep(INTERVAL);
        }
    })
}

/// Ends the process where the user stops it and the run does not notice, as while models are compiled or
/// data are prepared: there is nothing to be saved then.
pub(super) fn end_unheard(stopping: Stopping) -> Watch {
    let watch = Watch { over: Arc::default() };
    let over = Arc::clone(&watch.over);
    let work = move || {
        let mut asked: Option<Instant> = None;
        while !over.load(Ordering::Relaxed) && !stopping.noticed.load(Ordering::Relaxed) {
            if stopping.flag.load(Ordering::Relaxed) {
                let asked = asked.get_or_insert_with(Instant::now);
                let is_limit = stopping.reason.lock().is_ok_and(|reason| reason.is_some());
                let has_begun = stopping.begun.load(Ordering::Relaxed);
                if asked.elapsed() > HEARD[usize::from(has_begun)] && !is_limit {
                    live::restore_terminal();
                    terminal::eprint("interrupted\n");
                    #[allow(clippy::exit, reason = "the thread that works does not listen")]
                    std::process::exit(130)
                }
            }
            std::thread::sleep(INTERVAL);
        }
    };
    // Without the thread, a second signal ends the process.
    let _ = std::thread::Builder::new().name("interrupts".to_owned()).spawn(work);
    watch
}

/// Watches a command that has nothing to write when it is stopped: the process ends at once.
///
/// # Errors
/// As [`watch`].
pub(super) fn enforce(limits: &Limits) -> Result<Watch, ExitCode> {
    let started = Instant::now();
    spawn(limits, move |limits, over| {
        if let Some(message) = wait(&limits, started, over) {
            end_process(&message);
        }
    })
}

/// A thread for the work, if there is a limit; machine code is left out if that is asked for.
fn spawn(
    limits: &Limits,
    work: impl FnOnce(Watched, &AtomicBool) + Send + 'static,
) -> Result<Watch, ExitCode> {
    if limits.interpret {
        crate::codegen::interpret();
        crate::sim::interpret();
    }
    if let Some(millions) = limits.instruction_limit {
        limit_instructions(u64::from(millions) * 1_000_000);
    }
    let watch = Watch { over: Arc::default() };
    let refused = |message: &str| {
        terminal::eprint(&format!("error: {message}\n"));
        ExitCode::from(2)
    };
    if limits.memory_limit.is_some() && memory::taken().is_none() {
        return Err(refused("`--memory-limit` works on Linux only"));
    }
    let limits = Watched::of(limits);
    if limits.limits.time_limit.is_none() && limits.limits.memory_limit.is_none() {
        return Ok(watch);
    }
    let over = Arc::clone(&watch.over);
    let thread = std::thread::Builder::new().name("limits".to_owned());
    match thread.spawn(move || work(limits, &over)) {
        Ok(_) => Ok(watch),
        Err(error) => Err(refused(&format!("the limits cannot be monitored: {error}"))),
    }
}

/// Waits until a limit is reached; `None` if the watch is over before.
fn wait(watched: &Watched, started: Instant, over: &AtomicBool) -> Option<String> {
    let limits = &watched.limits;
    while !over.load(Ordering::Relaxed) {
        if let Some(seconds) = limits.time_limit
            && started.elapsed().as_secs_f64() > seconds
        {
            return Some(format!("the time limit is reached: {seconds} s"));
        }
        if let Some(mebibytes) = limits.memory_limit
            && watched.memory_beyond(1)
        {
            let whose = if watched.is_default { DEFAULT } else { "" };
            return Some(format!("the memory limit is reached: {mebibytes} MiB{whose}"));
        }
        std::thread::sleep(INTERVAL);
    }
    None
}

/// The limits that are watched.
struct Watched {
    limits: Limits,
    /// Whether the limit of memory is a share of what there is, and not one that was asked for.
    is_default: bool,
}

impl Watched {
    /// What was asked for, and the default limit of memory where none was.
    fn of(limits: &Limits) -> Watched {
        let is_default = limits.memory_limit.is_none();
        let memory_limit = limits.memory_limit.or_else(memory::default_limit);
        Watched { limits: Limits { memory_limit, ..limits.clone() }, is_default }
    }

    /// Whether the process takes more memory than a multiple of its limit. There is no multiple of
    /// nearly all there is.
    fn memory_beyond(&self, factor: u64) -> bool {
        let factor = if self.is_default { 1 } else { factor };
        let limit = self.limits.memory_limit;
        limit.is_some_and(|limit| memory::taken() > Some(factor * u64::from(limit)))
    }
}

fn end_process(message: &str) -> ! {
    live::restore_terminal();
    terminal::eprint(&format!("error[{}]: {message}\n", LIMIT_REACHED.slug));
    #[allow(clippy::exit, reason = "the thread that works does not listen")]
    std::process::exit(1)
}

#[cfg(all(test, target_os = "linux"))]
mod tests {
    use super::*;

    fn limits(memory_limit: Option<u32>) -> Limits {
        Limits { time_limit: None, memory_limit, interpret: false, instruction_limit: None }
    }

    #[test]
    fn memory_is_limited_by_default() {
        let watched = Watched::of(&limits(None));
        let machine = std::fs::read_to_string("/proc/meminfo").expect("Linux tells");
        let total = machine.split_whitespace().nth(1).expect("MemTotal").parse::<u64>();
        let total = total.expect("a number of kibibytes") / 1024;
        let limit = watched.limits.memory_limit.expect("a limit");
        assert!(watched.is_default && limit > 0 && u64::from(limit) <= total / 4 * 3, "{limit}");
        // A process that has more than such a limit reports that it was not requested.
        let reached = Watched { limits: limits(Some(1)), is_default: true };
        let message = wait(&reached, Instant::now(), &AtomicBool::new(false)).expect("reached");
        assert!(message.contains("1 MiB, three quarters of the available memory"), "{message}");
        let asked = Watched::of(&limits(Some(1)));
        let message = wait(&asked, Instant::now(), &AtomicBool::new(false)).expect("reached");
        assert!(message.ends_with("1 MiB"), "{message}");
    }
}
