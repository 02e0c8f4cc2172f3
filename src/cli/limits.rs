//! Limits of time and memory: a thread that watches the process, asks the run to stop, and ends the
//! process where nobody listens, as in the loops of loading, flattening and compiling.

use super::args::Limits;
use super::live;
use super::terminal;
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
/// How long it may take then to write what it has found.
const ENDING: Duration = Duration::from_secs(60);
/// A process that has grown to this multiple of its limit is not waited for.
const GROWTH: u64 = 2;

/// How a run is asked to stop.
#[derive(Debug, Clone, Default)]
pub(super) struct Stopping {
    /// Set when it has to stop.
    pub(super) flag: Arc<AtomicBool>,
    /// Why, where it was not the user who asked.
    pub(super) reason: Arc<Mutex<Option<String>>>,
    /// Set when the run has seen the flag.
    pub(super) noticed: Arc<AtomicBool>,
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

/// A thread for the work, if there is a limit.
fn spawn(
    limits: &Limits,
    work: impl FnOnce(Limits, &AtomicBool) + Send + 'static,
) -> Result<Watch, ExitCode> {
    let watch = Watch { over: Arc::default() };
    if limits.time_limit.is_none() && limits.memory_limit.is_none() {
        return Ok(watch);
    }
    let refused = |message: &str| {
        terminal::eprint(&format!("error: {message}\n"));
        ExitCode::from(2)
    };
    if limits.memory_limit.is_some() && taken_memory().is_none() {
        return Err(refused("`--memory-limit` works on Linux only"));
    }
    let (limits, over) = (limits.clone(), Arc::clone(&watch.over));
    let thread = std::thread::Builder::new().name("limits".to_owned());
    match thread.spawn(move || work(limits, &over)) {
        Ok(_) => Ok(watch),
        Err(error) => Err(refused(&format!("the limits cannot be watched: {error}"))),
    }
}

/// Waits until a limit is reached; `None` if the watch is over before.
fn wait(limits: &Limits, started: Instant, over: &AtomicBool) -> Option<String> {
    while !over.load(Ordering::Relaxed) {
        if let Some(seconds) = limits.time_limit
            && started.elapsed().as_secs_f64() > seconds
        {
            return Some(format!("the limit of time is reached: {seconds} s"));
        }
        if let Some(mebibytes) = limits.memory_limit
            && limits.memory_beyond(1)
        {
            return Some(format!("the limit of memory is reached: {mebibytes} MiB"));
        }
        std::thread::sleep(INTERVAL);
    }
    None
}

impl Limits {
    /// Whether the process takes more memory than a multiple of its limit.
    fn memory_beyond(&self, factor: u64) -> bool {
        self.memory_limit.is_some_and(|limit| taken_memory() > Some(factor * u64::from(limit)))
    }
}

fn end_process(message: &str) -> ! {
    live::restore_terminal();
    terminal::eprint(&format!("error[{}]: {message}\n", LIMIT_REACHED.slug));
    #[allow(clippy::exit, reason = "the thread that works does not listen")]
    std::process::exit(1)
}

/// Resident memory of this process in MiB.
fn taken_memory() -> Option<u64> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let line = status.lines().find(|line| line.starts_with("VmRSS:"))?;
    let kib: u64 = line.split_whitespace().nth(1)?.parse().ok()?;
    Some(kib / 1024)
}
