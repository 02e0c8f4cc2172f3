//! Signals by which systems end processes: cluster schedulers and service managers send SIGTERM, a
//! terminal that is closed sends SIGHUP. They end a run like Ctrl-C, with its checkpoint.

use signal_hook::consts::{SIGHUP, SIGTERM, SIGXFSZ};
use signal_hook::flag;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

/// Sets the flag at these signals; at a second one the process ends at once.
pub(super) fn catch(interrupt: &Arc<AtomicBool>) {
    for signal in [SIGTERM, SIGHUP] {
        // `nohup` keeps a run going.
        if !is_ignored(signal) {
            // Where they cannot be caught they end the process as they always did.
            let _ = flag::register_conditional_shutdown(signal, 130, Arc::clone(interrupt));
            let _ = flag::register(signal, Arc::clone(interrupt));
        }
    }
}

/// Sets the flag at every request to end, Ctrl-C included.
#[cfg(feature = "mpi")]
pub(super) fn catch_all(interrupt: &Arc<AtomicBool>) {
    catch(interrupt);
    // Where it cannot be caught it ends the process as it always did.
    let _ = flag::register(signal_hook::consts::SIGINT, Arc::clone(interrupt));
}

/// Ctrl-C in the terminal does not end this process.
pub(super) fn survive_interrupts() {
    // Where it cannot be caught it ends the process as it always did.
    let _ = flag::register(signal_hook::consts::SIGINT, Arc::default());
}

/// A write that exceeds the limit on the size of files fails with a message of its own, where the
/// system would end the process.
pub(super) fn survive_large_files() {
    // Where it cannot be caught it ends the process as it always did.
    let _ = flag::register(SIGXFSZ, Arc::default());
}

/// Whether the process was started so that a terminal that is closed does not end it (`nohup`).
pub(super) fn ignores_hangup() -> bool {
    is_ignored(SIGHUP)
}

/// Whether the process was started with the signal ignored, as far as the system tells.
fn is_ignored(signal: i32) -> bool {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let mask = status.lines().find_map(|line| line.strip_prefix("SigIgn:"));
    let mask = mask.and_then(|mask| u64::from_str_radix(mask.trim(), 16).ok()).unwrap_or(0);
    mask >> (signal - 1) & 1 == 1
}
