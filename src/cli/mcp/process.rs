//! A command of this program in a process of its own.

use crate::fmu;
use std::ffi::OsString;
use std::io::{self, Read};
use std::process::{Child, Stdio};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread::JoinHandle;
use std::time::{Duration, Instant};

/// How often it is looked whether a process has ended.
const TICK: Duration = Duration::from_millis(20);
/// Time for a process to save what it has computed, after which it is ended.
pub(super) const PATIENCE: Duration = Duration::from_secs(5);
/// Bytes of each stream that are kept; what comes after them is counted.
const MOST: u64 = 1 << 20;

/// Whether a call is to be stopped.
#[derive(Debug, Clone, Default)]
pub(super) struct Stop(Arc<AtomicBool>);

impl Stop {
    pub(super) fn ask(&self) {
        self.0.store(true, Ordering::SeqCst);
    }

    pub(super) fn is_asked(&self) -> bool {
        self.0.load(Ordering::SeqCst)
    }
}

/// What a process has left.
#[derive(Debug)]
pub(super) struct Ended {
    pub success: bool,
    /// Standard output, and after it standard error.
    pub text: String,
}

/// Runs a command until it ends or is stopped, which it is asked first, as by Ctrl-C.
///
/// # Errors
///
/// It cannot be started.
pub(super) fn run(arguments: &[OsString], stop: &Stop) -> io::Result<Ended> {
    let mut command = fmu::program();
    command.args(arguments).env("NO_COLOR", "1");
    command.env(crate::launcher::SWITCH, "0");
    command.stdin(Stdio::null()).stdout(Stdio::piped()).stderr(Stdio::piped());
    let mut child = command.spawn()?;
    let output = child.stdout.take().map(reader);
    let errors = child.stderr.take().map(reader);
    let mut asked: Option<Instant> = None;
    let status = loop {
        if let Some(status) = child.try_wait()? {
            break status;
        }
        match asked {
            None if stop.is_asked() => {
                end(&mut child);
                asked = Some(Instant::now());
            }
            Some(when) if when.elapsed() > PATIENCE => child.kill()?,
            _ => {}
        }
        std::thread::sleep(TICK);
    };
    let text = [output, errors].into_iter().flatten().map(text_of).collect();
    Ok(Ended { success: status.success(), text })
}

/// Reads a stream to its end, so that the process never waits for a reader.
fn reader(stream: impl Read + Send + 'static) -> JoinHandle<(Vec<u8>, u64)> {
    std::thread::spawn(move || {
        let (mut kept, mut stream) = (Vec::new(), stream);
        // A stream that breaks off has ended.
        _ = stream.by_ref().take(MOST).read_to_end(&mut kept);
        let left = io::copy(&mut stream, &mut io::sink()).unwrap_or(0);
        (kept, left)
    })
}

fn text_of(reader: JoinHandle<(Vec<u8>, u64)>) -> String {
    let (kept, left) = reader.join().unwrap_or_default();
    let text = String::from_utf8_lossy(&kept).into_owned();
    if left == 0 { text } else { format!("{text}\n({left} further bytes are not shown)\n") }
}

#[cfg(unix)]
fn end(child: &mut Child) {
    use rustix::process::{Pid, Signal, kill_process};
    let pid = i32::try_from(child.id()).ok().and_then(Pid::from_raw);
    // It has ended already.
    _ = pid.map(|pid| kill_process(pid, Signal::TERM));
}

#[cfg(not(unix))]
fn end(child: &mut Child) {
    // It has ended already.
    _ = child.kill();
}
