//! The run that `gapi teach` shows: recorded to its end, or shown from what is recorded so far while
//! it continues.

use super::STACK;
use super::options::Global;
use super::output::Output;
use super::session;
use super::terminal::Terminal;
use super::world::SystemWorld;
use crate::script::access::faults::cannot;
use crate::script::{Echo, Options, Reporting, Session, with_stack};
use crate::source::Span;
use clap::{Args, ValueHint};
use gapilib_script::teach::Trace;
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{self, Receiver, RecvTimeoutError, Sender};
use std::thread::{Builder, Scope};
use std::time::Duration;

/// A run that takes longer is shown before its end.
const AT_ONCE: Duration = Duration::from_millis(700);

/// How often its trace is looked at until there is something to show.
const LOOK: Duration = Duration::from_millis(100);

/// What is run, and where its results go.
#[derive(Debug, Args)]
pub(super) struct RunArgs {
    /// A script (.mos), which is run first, or a trace written by `gapi run --trace`
    #[arg(value_name = "SCRIPT|TRACE", value_hint = ValueHint::FilePath)]
    pub input: PathBuf,
    /// Folder for the results and the trace of the run [default: one per script in `results`]
    #[arg(long, value_name = "DIR", value_hint = ValueHint::DirPath)]
    pub out: Option<PathBuf>,
    /// Overwrite the results of another problem in that folder
    #[arg(long)]
    pub overwrite: bool,
}

/// What changes a run: from which generation on, counted from 1, and the statement.
pub(super) type Change<'a> = (usize, &'a str);

/// How a script is run again.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Again<'a> {
    /// What is changed.
    pub change: Option<Change<'a>>,
    /// Which of the runs with different seeds it is, from 0; `None` where there is one.
    pub run: Option<usize>,
}

/// Why there is nothing to show.
pub(super) enum Trouble {
    /// The session has reported it.
    Reported(ExitCode),
    /// What is to be said.
    Message(String),
}

/// A script that is about to be run with a trace beside its results.
pub(super) struct Recording<'a> {
    session: Session,
    file: PathBuf,
    arguments: &'a RunArgs,
    again: Again<'a>,
}

impl<'a> Recording<'a> {
    /// Opens the session and the trace; `is_aside`: another screen is shown during the run.
    pub(super) fn new(
        arguments: &'a RunArgs,
        global: &Global,
        again: Again<'a>,
        is_aside: bool,
    ) -> Result<Recording<'a>, Trouble> {
        let output = output(arguments)?;
        let is_other = again.change.is_some() || again.run.is_some_and(|run| run > 0);
        let output = if is_other { output.within("what_if") } else { output };
        // It lies in the folder of results: a link in its place is not followed.
        let file = output.folder.join("run.trace");
        let world = world(global, output, is_aside)?;
        world.catch_interrupts();
        let reporting = if again.run.is_some() { Reporting::Off } else { Reporting::Usual };
        // A quiet session reports errors only.
        let options = Options { echo: Echo::Nothing, quiet: true, reporting, ..Options::default() };
        let mut session = session::open(global, world).with_options(options);
        session.use_stream(again.run.unwrap_or(0) as u64);
        let prepared = session.trace_to(&file).map_err(|fault| fault.at(Span::NONE));
        let prepared = prepared.and_then(|()| match again.change {
            Some((generation, statement)) => session.branch_at(generation, statement),
            None => Ok(()),
        });
        if let Err(error) = prepared {
            return Err(Trouble::Reported(session::failed(&mut session, vec![error])));
        }
        Ok(Recording { session, file, arguments, again })
    }

    /// Runs the script and reads the trace; the session remains.
    pub(super) fn run_to_end(self) -> Result<(Trace, Session), Trouble> {
        let Recording { mut session, file, arguments, again } = self;
        let status = session.run_file(&arguments.input);
        session.world.end_view();
        if status.code != 0 && !status.interrupted {
            return Err(Trouble::Reported(status.code.into()));
        }
        if session.branch_is_pending() {
            let generation = again.change.map_or(0, |(generation, _)| generation);
            return Err(Trouble::Message(format!("the run has no generation {generation}")));
        }
        Ok((read(&file, &arguments.input)?, session))
    }
}

fn world(global: &Global, output: Output, is_aside: bool) -> Result<SystemWorld, Trouble> {
    let mut terminal = Terminal::new(global.color, false);
    match is_aside {
        true => terminal.stand_aside(),
        false => terminal.show_progress_only(),
    }
    SystemWorld::for_results(terminal, output, None)
        .map_err(|error| Trouble::Message(error.to_string()))
}

/// What becomes of a run on its thread.
enum News {
    /// Its trace is in this file; the flag ends it.
    Begun(PathBuf, Arc<AtomicBool>),
    Ended(Result<Trace, Trouble>),
}

/// A run on a thread of its own.
pub(super) struct Running {
    news: Receiver<News>,
    genes: Sender<Vec<f64>>,
    curves: Receiver<Result<Vec<f64>, String>>,
    file: Option<PathBuf>,
    interrupt: Arc<AtomicBool>,
    has_ended: bool,
}

impl Running {
    /// Begins the run. It ends, and what it has said is printed, when this is dropped.
    pub(super) fn begin<'scope>(
        scope: &'scope Scope<'scope, '_>,
        arguments: &'scope RunArgs,
        global: &'scope Global,
    ) -> Result<Running, Trouble> {
        let (tell, news) = mpsc::channel();
        let (genes, asked) = mpsc::channel::<Vec<f64>>();
        let (answer, curves) = mpsc::channel();
        let work = move || {
            let ended =
                Recording::new(arguments, global, Again::default(), true).and_then(|recording| {
                    let flag = recording.session.world.interrupt_flag().unwrap_or_default();
                    let _ = tell.send(News::Begun(recording.file.clone(), flag));
                    recording.run_to_end()
                });
            let (ended, session) = match ended {
                Ok((trace, session)) => (Ok(trace), Some(session)),
                Err(trouble) => (Err(trouble), None),
            };
            // Who asks no more has left.
            let _ = tell.send(News::Ended(ended));
            let Some(mut session) = session else { return };
            while let Ok(genes) = asked.recv() {
                let _ = answer.send(session.simulate_again(&genes));
            }
        };
        Builder::new()
            .stack_size(STACK)
            .spawn_scoped(scope, move || with_stack(STACK - (4 << 20), work))
            .map_err(|error| Trouble::Message(format!("cannot start a thread: {error}")))?;
        let interrupt = Arc::default();
        Ok(Running { news, genes, curves, file: None, interrupt, has_ended: false })
    }

    /// The whole trace of a run that ends soon, else what there is as soon as it has this
    /// generation, from 1.
    pub(super) fn first(&mut self, generation: usize) -> Result<Trace, Trouble> {
        let mut patience = AT_ONCE;
        loop {
            match self.news.recv_timeout(patience) {
                Ok(News::Begun(file, flag)) => (self.file, self.interrupt) = (Some(file), flag),
                Ok(News::Ended(trace)) => {
                    self.has_ended = true;
                    return trace;
                }
                Err(RecvTimeoutError::Timeout) => {
                    if let Some(trace) =
                        self.file.as_deref().and_then(|file| so_far(file, generation))
                    {
                        return Ok(trace);
                    }
                    patience = LOOK;
                }
                Err(RecvTimeoutError::Disconnected) => {
                    return Err(Trouble::Message("the run has ended without a result".to_owned()));
                }
            }
        }
    }

    /// The whole trace, once when the run has ended, or why there is none.
    pub(super) fn ended(&mut self) -> Option<Result<Trace, Trouble>> {
        match self.news.try_recv() {
            Ok(News::Ended(trace)) => {
                self.has_ended = true;
                Some(trace)
            }
            _ => None,
        }
    }

    /// Whether the run has ended.
    pub(super) fn has_ended(&self) -> bool {
        self.has_ended
    }

    /// The flag that ends the run.
    pub(super) fn interrupt(&self) -> Arc<AtomicBool> {
        Arc::clone(&self.interrupt)
    }

    /// The curve of an individual, or why there is none.
    pub(super) fn curve(&self, genes: &[f64]) -> Result<Vec<f64>, String> {
        if !self.has_ended {
            return Err("the run continues: try again when it has ended".to_owned());
        }
        let asked = self.genes.send(genes.to_vec()).ok().and_then(|()| self.curves.recv().ok());
        asked.unwrap_or_else(|| Err("the run has failed".to_owned()))
    }
}

impl Drop for Running {
    fn drop(&mut self) {
        if !self.has_ended {
            self.interrupt.store(true, Ordering::SeqCst);
        }
    }
}

/// What a trace has so far, without the generation that is at work, if it has this generation.
fn so_far(file: &Path, generation: usize) -> Option<Trace> {
    let mut trace = Trace::read(&super::named::read(file).ok()?).ok()?;
    trace.generations.pop();
    trace.cut = false;
    (trace.generations.len() >= generation).then_some(trace)
}

/// Reads a trace; messages name the file that the user has given, `input`.
pub(super) fn read(file: &Path, input: &Path) -> Result<Trace, Trouble> {
    let read = super::named::read(file).map_err(|error| cannot("read", input, &error).message);
    read.and_then(|bytes| {
        Trace::read(&bytes).map_err(|fault| {
            let helps: String = fault.helps.iter().map(|help| format!("\nhelp: {help}")).collect();
            format!("`{}`: {}{helps}", input.display(), fault.message)
        })
    })
    .map_err(Trouble::Message)
}

/// The folder of the run.
pub(super) fn output(arguments: &RunArgs) -> Result<Output, Trouble> {
    let (folder, overwrite) = (arguments.out.as_deref(), arguments.overwrite);
    Output::of("gapi teach", &arguments.input, folder, overwrite).map_err(Trouble::Message)
}
