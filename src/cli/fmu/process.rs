//! A process with a unit, as the one sees it that asks.

use super::worker::{ANSWERED, HUNG};
use crate::fmi::import::{Answer, Ended, LogMessage, Process, Request, receive, send};
use std::io::{BufRead as _, BufReader, Read as _};
use std::process::{Child, ChildStderr, ChildStdin, Command, ExitStatus, Stdio};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{Receiver, RecvTimeoutError, channel};
use std::sync::{Arc, Condvar, Mutex, PoisonError};
use std::time::{Duration, Instant};

/// How often a cancellation is looked for.
const TICK: Duration = Duration::from_millis(20);
/// How long what a process has printed at its end is waited for.
const LAST_WORDS: Duration = Duration::from_secs(1);
/// Lines that are kept of what a unit prints, and their length.
const MOST_LINES: usize = 50;
const LONGEST_LINE: u64 = 1000;

/// What a unit has printed.
#[derive(Debug, Default)]
struct Printed {
    lines: Vec<String>,
    /// The last one, also where it is not kept.
    last: String,
    /// For how many answers it is complete.
    answers: u64,
}

type Shared = Arc<(Mutex<Printed>, Condvar)>;

/// A process with a unit.
pub(super) struct WorkerProcess {
    child: Child,
    to: Option<ChildStdin>,
    answers: Receiver<Answer>,
    printed: Shared,
    /// Answers that were received.
    received: u64,
    listener: Option<std::thread::JoinHandle<()>>,
}

impl WorkerProcess {
    /// Starts it.
    pub(super) fn start(mut command: Command) -> Result<WorkerProcess, String> {
        let program = command.get_program().to_string_lossy().into_owned();
        let cannot = |why: String| format!("`{program}` cannot be started for it: {why}");
        let command = command.stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::piped());
        let mut child = command.spawn().map_err(|error| cannot(error.to_string()))?;
        let (to, from, errors) = (child.stdin.take(), child.stdout.take(), child.stderr.take());
        let (Some(from), Some(errors)) = (from, errors) else {
            return Err(cannot("it has no streams".to_owned()));
        };
        let (sender, answers) = channel();
        std::thread::spawn(move || {
            let mut from = BufReader::new(from);
            while let Ok(Some(answer)) = receive(&mut from) {
                if sender.send(answer).is_err() {
                    return;
                }
            }
        });
        let printed = Shared::default();
        let heard = printed.clone();
        let listener = Some(std::thread::spawn(move || listen(errors, &heard)));
        Ok(WorkerProcess { child, to, answers, printed, received: 0, listener })
    }

    /// Ends the process; how it has ended by itself.
    fn end(&mut self) -> Ended {
        self.to = None;
        let status = self.ended().or_else(|| {
            let _ = self.child.kill();
            self.child.wait().ok()
        });
        // Its last line tells more, but a process that it has started may hold the stream open.
        let begin = Instant::now();
        let is_listening = || self.listener.as_ref().is_some_and(|own| !own.is_finished());
        while is_listening() && begin.elapsed() < LAST_WORDS {
            std::thread::sleep(TICK);
        }
        let printed = self.printed.0.lock().unwrap_or_else(PoisonError::into_inner);
        let last = printed.last.clone();
        if status.and_then(|status| status.code()) == Some(i32::from(HUNG)) {
            return Ended::Hung(last);
        }
        let words = status.map_or_else(|| "its process has ended".to_owned(), described);
        Ended::Itself(match last.is_empty() {
            false => format!("{words}; it printed last: {last}"),
            true => words,
        })
    }

    /// How the process has ended, where it does so by itself.
    fn ended(&mut self) -> Option<ExitStatus> {
        let begin = Instant::now();
        while begin.elapsed() < LAST_WORDS {
            if let Ok(Some(status)) = self.child.try_wait() {
                return Some(status);
            }
            std::thread::sleep(TICK);
        }
        None
    }

    /// What was printed for the answers received so far: it comes by another stream, perhaps later.
    fn take_printed(&self) -> Vec<LogMessage> {
        let printed = self.printed.0.lock().unwrap_or_else(PoisonError::into_inner);
        let is_missing = |printed: &mut Printed| printed.answers < self.received;
        let waited = self.printed.1.wait_timeout_while(printed, LAST_WORDS, is_missing);
        let (mut printed, _) = waited.unwrap_or_else(PoisonError::into_inner);
        let message = |text| LogMessage {
            is_problem: false,
            category: "printed".to_owned(),
            text,
            is_last_of_many: false,
        };
        printed.lines.drain(..).map(message).collect()
    }

    fn kill(&mut self) {
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

impl Process for WorkerProcess {
    fn send(&mut self, request: &Request) -> Result<(), Ended> {
        let sent = self.to.as_mut().is_some_and(|to| send(to, request).is_ok());
        if sent { Ok(()) } else { Err(self.end()) }
    }

    fn answer(
        &mut self,
        cancel: Option<&AtomicBool>,
        seconds: Option<f64>,
    ) -> Result<Answer, Ended> {
        let begin = Instant::now();
        let mut cancelled: Option<Instant> = None;
        loop {
            match self.answers.recv_timeout(TICK) {
                Ok(mut answer) => {
                    self.received += 1;
                    answer.messages.extend(self.take_printed());
                    return Ok(answer);
                }
                Err(RecvTimeoutError::Disconnected) => return Err(self.end()),
                Err(RecvTimeoutError::Timeout) => {}
            }
            if cancelled.is_none() && cancel.is_some_and(|flag| flag.load(Ordering::Relaxed)) {
                // The end of the requests.
                self.to = None;
                cancelled = Some(Instant::now());
            }
            let is_ignored = cancelled.is_some_and(|since| since.elapsed() > LAST_WORDS);
            let is_late = seconds.is_some_and(|most| begin.elapsed().as_secs_f64() > most);
            if is_ignored || is_late {
                self.kill();
                return Err(if is_ignored { Ended::Cancelled } else { Ended::TooSlow });
            }
        }
    }
}

impl Drop for WorkerProcess {
    /// Without requests a process ends by itself, but not one that is in a call that does not return.
    fn drop(&mut self) {
        self.to = None;
        self.kill();
    }
}

/// Keeps the first lines of what a unit prints, and reads on so that it is not held up.
fn listen(from: ChildStderr, printed: &Shared) {
    let mut from = BufReader::new(from);
    let mut line = Vec::new();
    loop {
        line.clear();
        let read = (&mut from).take(LONGEST_LINE).read_until(b'\n', &mut line);
        if !read.is_ok_and(|count| count > 0) {
            return;
        }
        let text = String::from_utf8_lossy(&line).trim().to_owned();
        let (text, is_answered) = match text.strip_suffix(ANSWERED) {
            Some(text) => (text.to_owned(), true),
            None => (text, false),
        };
        let mut heard = printed.0.lock().unwrap_or_else(PoisonError::into_inner);
        if !text.is_empty() {
            heard.last.clone_from(&text);
            if heard.lines.len() < MOST_LINES {
                heard.lines.push(text);
            }
        }
        if is_answered {
            heard.answers += 1;
            printed.1.notify_all();
        }
    }
}

/// How a process has ended, in one sentence.
fn described(status: ExitStatus) -> String {
    #[cfg(unix)]
    if let Some(signal) = std::os::unix::process::ExitStatusExt::signal(&status) {
        let name = match signal {
            4 => " (illegal instruction)",
            6 => " (abort)",
            7 => " (bus error)",
            8 => " (arithmetic exception)",
            9 => " (killed)",
            11 => " (segmentation fault)",
            _ => "",
        };
        return format!("its process was ended by signal {signal}{name}");
    }
    match status.code() {
        Some(code) => format!("it ended its process with exit code {code}"),
        None => "its process has ended".to_owned(),
    }
}
