//! A session on a thread of its own.

use crate::screen::{Channel, Event};
use gapilib::script::world::Screen;
use gapilib::script::{Session, with_stack};
use pyo3::exceptions::PyRuntimeError;
use pyo3::prelude::*;
use pyo3::sync::MutexExt as _;
use std::io;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{self, Receiver, RecvTimeoutError, Sender};
use std::sync::{Arc, Mutex, PoisonError};
use std::thread::JoinHandle;
use std::time::Duration;

/// Stack of the thread in bytes: functions written in Modelica may call themselves a thousand deep.
const STACK: usize = 256 << 20;
/// How often the signals of the user are looked at.
const TICK: Duration = Duration::from_millis(20);
/// How many bytes are printed at once.
const LARGE: usize = 1 << 16;

type Work = Box<dyn FnOnce(&mut Session) + Send>;

/// The thread of a session; it ends with this value.
pub(crate) struct Worker {
    /// The process that it was made in: a forked one has no such thread.
    process: u32,
    /// `None` at its end.
    work: Option<Sender<Work>>,
    thread: Option<JoinHandle<()>>,
    /// While one work is done, another one waits.
    busy: Mutex<()>,
    events: Arc<Mutex<Receiver<Event>>>,
    finished: Sender<Event>,
    stop: Arc<AtomicBool>,
    progress: Option<Py<PyAny>>,
}

impl Worker {
    /// Starts the thread, on which `open` makes the session; `progress` is called with a label, the
    /// part that is done, the whole (0 where it is not known), and the best fitness.
    pub(crate) fn new(
        open: impl FnOnce(Box<dyn Screen>, Arc<AtomicBool>) -> io::Result<Session> + Send + 'static,
        progress: Option<Py<PyAny>>,
    ) -> PyResult<Worker> {
        let (work, jobs) = mpsc::channel::<Work>();
        let (events, received) = mpsc::channel();
        let (opened, is_open) = mpsc::channel();
        let stop = Arc::new(AtomicBool::new(false));
        let (screen, flag) = (Box::new(Channel(events.clone())), stop.clone());
        let live = move || {
            let mut session = match open(screen, flag) {
                Ok(session) => session,
                Err(error) => return drop(opened.send(Err(error))),
            };
            drop(opened.send(Ok(())));
            with_stack(STACK - (4 << 20), || jobs.into_iter().for_each(|job| job(&mut session)));
        };
        let thread = std::thread::Builder::new().name("gapilib".to_owned()).stack_size(STACK);
        let thread = thread.spawn(live)?;
        is_open.recv().map_err(|_| PyRuntimeError::new_err("the session did not start"))??;
        Ok(Worker {
            process: std::process::id(),
            work: Some(work),
            thread: Some(thread),
            busy: Mutex::new(()),
            events: Arc::new(Mutex::new(received)),
            finished: events,
            stop,
            progress,
        })
    }

    /// Stops the work that is being done.
    pub(crate) fn interrupt(&self) {
        self.stop.store(true, Ordering::SeqCst);
    }

    /// Has the session do something and waits for it, without the global lock; what it prints goes
    /// to `sys.stdout` and `sys.stderr`.
    ///
    /// # Errors
    ///
    /// What the user interrupted it with, such as `KeyboardInterrupt`: the session is as it was left.
    /// `RuntimeError` in a forked process.
    pub(crate) fn call<T: Send + 'static>(
        &self,
        py: Python<'_>,
        job: impl FnOnce(&mut Session) -> T + Send + 'static,
    ) -> PyResult<T> {
        let (answer, errors) = self.call_quietly(py, job)?;
        written(py, "stderr", &errors)?;
        Ok(answer)
    }

    /// The same, with the errors that would have been printed: for whoever raises them.
    pub(crate) fn call_quietly<T: Send + 'static>(
        &self,
        py: Python<'_>,
        job: impl FnOnce(&mut Session) -> T + Send + 'static,
    ) -> PyResult<(T, String)> {
        if self.process != std::process::id() {
            return Err(PyRuntimeError::new_err(format!(
                "the session belongs to the process {}: make a session in each process, or start \
                 processes with the method \"spawn\"",
                self.process
            )));
        }
        let _alone = self.busy.lock_py_attached(py).unwrap_or_else(PoisonError::into_inner);
        self.stop.store(false, Ordering::SeqCst);
        let (answer, answered) = mpsc::channel();
        let finished = self.finished.clone();
        let work: Work = Box::new(move |session| {
            // Said also where the work panics.
            let _done = Done(finished);
            drop(answer.send(job(session)));
        });
        let gone = || PyRuntimeError::new_err("the session has ended after an internal error");
        let sent = self.work.as_ref().map(|to| to.send(work));
        sent.ok_or_else(gone)?.map_err(|_| gone())?;
        let mut errors = String::new();
        let interrupt = self.wait(py, &mut errors);
        let answer = answered.recv().map_err(|_| gone());
        interrupt.and(answer).map(|answer| (answer, errors))
    }

    /// Shows what comes until the work is done, but for `errors`; what interrupted it meanwhile.
    fn wait(&self, py: Python<'_>, errors: &mut String) -> PyResult<()> {
        let mut interrupt = Ok(());
        let mut next = None;
        loop {
            let event = match next.take() {
                Some(event) => Ok(event),
                None => py.detach(|| self.events().recv_timeout(TICK)),
            };
            let shown = match event {
                Ok(Event::Done) | Err(RecvTimeoutError::Disconnected) => return interrupt,
                Ok(Event::Errors(text)) if text.starts_with("error") => {
                    errors.push_str(&text);
                    Ok(())
                }
                Ok(Event::Output(text)) => {
                    let (text, other) = self.more(text);
                    next = other;
                    written(py, "stdout", &text)
                }
                Ok(event) => self.show(py, event),
                Err(RecvTimeoutError::Timeout) => py.check_signals(),
            };
            if let Err(error) = shown.and_then(|()| py.check_signals()) {
                self.stop.store(true, Ordering::SeqCst);
                interrupt = interrupt.and(Err(error));
            }
        }
    }

    fn events(&self) -> std::sync::MutexGuard<'_, Receiver<Event>> {
        self.events.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// What has been printed meanwhile, as one text: a notebook takes longer for a line than a script.
    /// And the event behind it.
    fn more(&self, mut text: String) -> (String, Option<Event>) {
        let events = self.events();
        while text.len() < LARGE {
            match events.try_recv() {
                Ok(Event::Output(more)) => text.push_str(&more),
                Ok(event) => return (text, Some(event)),
                Err(_) => break,
            }
        }
        (text, None)
    }

    fn show(&self, py: Python<'_>, event: Event) -> PyResult<()> {
        match event {
            Event::Output(text) => written(py, "stdout", &text),
            Event::Errors(text) => written(py, "stderr", &text),
            Event::Progress(progress) => match &self.progress {
                Some(call) => {
                    let best = progress.best.filter(|best| best.is_finite());
                    call.call1(py, (progress.label, progress.done, progress.total, best)).map(drop)
                }
                None => Ok(()),
            },
            Event::Done => Ok(()),
        }
    }
}

impl Drop for Worker {
    /// Waits for the end of the session: what it has locked is free afterwards.
    fn drop(&mut self) {
        self.work = None;
        if self.process == std::process::id() {
            // It has shown what is wrong already.
            let _ = self.thread.take().map(JoinHandle::join);
        }
    }
}

/// Says at its end that a work is done.
struct Done(Sender<Event>);

impl Drop for Done {
    fn drop(&mut self) {
        let _ = self.0.send(Event::Done);
    }
}

/// Writes to `sys.stdout` or `sys.stderr`.
pub(crate) fn written(py: Python<'_>, stream: &str, text: &str) -> PyResult<()> {
    if text.is_empty() {
        return Ok(());
    }
    let stream = py.import("sys")?.getattr(stream)?;
    // A program without a console has none.
    if stream.is_none() {
        return Ok(());
    }
    stream.call_method1("write", (text,)).map(drop)
}
