//! A session on a thread of its own.

use crate::forked::{AtWork, Own};
use crate::screen::{Channel, Event};
use gapilib::world::Screen;
use gapilib::{Session, with_stack};
use pyo3::exceptions::PyRuntimeError;
use pyo3::prelude::*;
use pyo3::sync::MutexExt as _;
use std::io;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{self, Receiver, RecvTimeoutError, Sender};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
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
    /// A forked process has no such thread.
    link: Own<Link>,
    /// While one work is done, another one waits.
    busy: Mutex<()>,
    stop: Arc<AtomicBool>,
    progress: Option<Py<PyAny>>,
}

/// What the thread is given and what comes from it.
struct Link {
    work: Sender<Work>,
    thread: JoinHandle<()>,
    events: Mutex<Receiver<Event>>,
    finished: Sender<Event>,
}

impl Worker {
    /// Starts the thread, on which `open` makes the session; `progress` is called with a label, the
    /// part that is done, the whole (0 where it is not known), and the best fitness. `threads`: how
    /// many the session spreads its work over, all cores without.
    ///
    /// # Errors
    ///
    /// The session cannot be made; `RuntimeError` in a process that was forked during other work.
    pub(crate) fn new(
        py: Python<'_>,
        threads: Option<usize>,
        open: impl FnOnce(Box<dyn Screen>, Arc<AtomicBool>) -> io::Result<Session> + Send + 'static,
        progress: Option<Py<PyAny>>,
    ) -> PyResult<Worker> {
        let _at_work = AtWork::begin(py)?;
        let (work, jobs) = mpsc::channel::<Work>();
        let (events, received) = mpsc::channel();
        let (opened, is_open) = mpsc::channel();
        let stop = Arc::new(AtomicBool::new(false));
        let (screen, flag) = (Box::new(Channel(events.clone())), stop.clone());
        let live = move || {
            let session = own_threads(threads).and_then(|pool| Ok((pool, open(screen, flag)?)));
            let (_pool, mut session) = match session {
                Ok(session) => session,
                Err(error) => return drop(opened.send(Err(error))),
            };
            drop(opened.send(Ok(())));
            with_stack(STACK - (4 << 20), || jobs.into_iter().for_each(|job| job(&mut session)));
        };
        let thread = std::thread::Builder::new().name("gapilib".to_owned()).stack_size(STACK);
        let thread = thread.spawn(live)?;
        is_open.recv().map_err(|_| PyRuntimeError::new_err("the session did not start"))??;
        let link = Link { work, thread, events: Mutex::new(received), finished: events };
        Ok(Worker { link: Own::new(link), busy: Mutex::new(()), stop, progress })
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

    /// The same, with the errors that would have been printed: for callers that raise them.
    pub(crate) fn call_quietly<T: Send + 'static>(
        &self,
        py: Python<'_>,
        job: impl FnOnce(&mut Session) -> T + Send + 'static,
    ) -> PyResult<(T, String)> {
        let shown = Shown { prints: true, progress: self.progress.as_ref() };
        self.call_shown(py, &shown, job)
    }

    /// The same, of which this is shown.
    pub(crate) fn call_shown<T: Send + 'static>(
        &self,
        py: Python<'_>,
        shown: &Shown<'_>,
        job: impl FnOnce(&mut Session) -> T + Send + 'static,
    ) -> PyResult<(T, String)> {
        let Some(link) = self.link.get() else {
            return Err(PyRuntimeError::new_err(format!(
                "the session belongs to the process {}: make a session in each process, or start \
                 processes with the method \"spawn\"",
                self.link.process()
            )));
        };
        let _alone = self.busy.lock_py_attached(py).unwrap_or_else(PoisonError::into_inner);
        let at_work = AtWork::begin(py)?;
        self.stop.store(false, Ordering::SeqCst);
        let (answer, answered) = mpsc::channel();
        let finished = link.finished.clone();
        let work: Work = Box::new(move |session| {
            // Said also where the work panics, and last: the caller may fork then.
            let _done = Done(finished);
            let _at_work = at_work;
            drop(answer.send(job(session)));
        });
        let gone = || PyRuntimeError::new_err("the session has ended after an internal error");
        link.work.send(work).map_err(|_| gone())?;
        let mut errors = String::new();
        let interrupt = self.wait(py, (&link.events, shown), &mut errors);
        let answer = answered.recv().map_err(|_| gone());
        interrupt.and(answer).map(|answer| (answer, errors))
    }

    /// Shows what comes until the work is done, but for `errors`; what interrupted it meanwhile.
    fn wait(
        &self,
        py: Python<'_>,
        (events, shown): (&Mutex<Receiver<Event>>, &Shown<'_>),
        errors: &mut String,
    ) -> PyResult<()> {
        let mut interrupt = Ok(());
        let mut next = None;
        loop {
            let event = match next.take() {
                Some(event) => Ok(event),
                None => py.detach(|| locked(events).recv_timeout(TICK)),
            };
            let done = match event {
                Ok(Event::Done) | Err(RecvTimeoutError::Disconnected) => return interrupt,
                Ok(Event::Errors(text)) if text.starts_with("error") => {
                    errors.push_str(&text);
                    Ok(())
                }
                Ok(Event::Output(text)) => {
                    let (text, other) = more(events, text);
                    next = other;
                    shown.show(py, Event::Output(text))
                }
                Ok(event) => shown.show(py, event),
                Err(RecvTimeoutError::Timeout) => py.check_signals(),
            };
            if let Err(error) = done.and_then(|()| py.check_signals()) {
                self.stop.store(true, Ordering::SeqCst);
                interrupt = interrupt.and(Err(error));
            }
        }
    }
}

/// What a call shows while it works.
pub(crate) struct Shown<'a> {
    /// Whether what the session prints is printed.
    pub prints: bool,
    /// What is called with the progress.
    pub progress: Option<&'a Py<PyAny>>,
}

impl Shown<'_> {
    fn show(&self, py: Python<'_>, event: Event) -> PyResult<()> {
        match event {
            Event::Output(_) | Event::Errors(_) if !self.prints => Ok(()),
            Event::Output(text) => written(py, "stdout", &text),
            Event::Errors(text) => written(py, "stderr", &text),
            Event::Progress(progress) => match self.progress {
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
        if let Some(Link { work, thread, .. }) = self.link.take() {
            drop(work);
            // It has shown what is wrong already.
            let _ = thread.join();
        }
    }
}

/// Threads that the calling one, which is one of them, spreads its work over. Those that all threads of a
/// process share are not there in a forked one.
fn own_threads(count: Option<usize>) -> io::Result<rayon::ThreadPool> {
    // 0: all cores.
    let pool = rayon::ThreadPoolBuilder::new().num_threads(count.unwrap_or(0)).use_current_thread();
    let pool = pool.build().map_err(io::Error::other)?;
    // All have begun: what a thread locks when it begins is free when the process forks.
    pool.broadcast(|_| ());
    Ok(pool)
}

fn locked(events: &Mutex<Receiver<Event>>) -> MutexGuard<'_, Receiver<Event>> {
    events.lock().unwrap_or_else(PoisonError::into_inner)
}

/// What has been printed meanwhile, as one text: a notebook takes longer for a line than a script. And
/// the event after it.
fn more(events: &Mutex<Receiver<Event>>, mut text: String) -> (String, Option<Event>) {
    let events = locked(events);
    while text.len() < LARGE {
        match events.try_recv() {
            Ok(Event::Output(more)) => text.push_str(&more),
            Ok(event) => return (text, Some(event)),
            Err(_) => break,
        }
    }
    (text, None)
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
