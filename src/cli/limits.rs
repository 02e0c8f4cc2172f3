//! Limits of time and memory: a thread that watches the run and asks it to stop.

use super::args::Freedom;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, OnceLock};
use std::time::{Duration, Instant};

/// Why the run has to stop.
pub(super) type Reason = Arc<OnceLock<String>>;

/// Watches the process if it has limits; sets the flag and the reason when one is reached.
///
/// # Errors
/// A limit of memory where the system does not tell how much is taken.
pub(super) fn watch(
    freedom: &Freedom,
    flag: Arc<AtomicBool>,
    reason: Reason,
) -> Result<(), String> {
    let (time, memory) = (freedom.time_limit, freedom.memory_limit);
    if time.is_none() && memory.is_none() {
        return Ok(());
    }
    if memory.is_some() && taken_memory().is_none() {
        return Err("`--memory-limit` works on Linux only".to_owned());
    }
    let started = Instant::now();
    let watching = move || loop {
        std::thread::sleep(Duration::from_millis(10));
        let late = time.filter(|limit| started.elapsed().as_secs_f64() > *limit);
        let large = memory.filter(|limit| taken_memory() > Some(u64::from(*limit)));
        let message = match (late, large) {
            (Some(limit), _) => format!("the limit of time is reached: {limit} s"),
            (_, Some(limit)) => format!("the limit of memory is reached: {limit} MiB"),
            _ => continue,
        };
        let _ = reason.set(message);
        flag.store(true, Ordering::SeqCst);
        return;
    };
    std::thread::Builder::new()
        .name("limits".to_owned())
        .spawn(watching)
        .map(|_| ())
        .map_err(|error| format!("the limits cannot be watched: {error}"))
}

/// Resident memory of this process in MiB.
fn taken_memory() -> Option<u64> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let line = status.lines().find(|line| line.starts_with("VmRSS:"))?;
    let kib: u64 = line.split_whitespace().nth(1)?.parse().ok()?;
    Some(kib / 1024)
}
