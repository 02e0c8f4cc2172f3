//! The search for the best parameters: generation by generation, with checkpoints, pauses, watched
//! settings and a limit of time, until a stop condition holds or the user interrupts it.

use super::control::Watched;
use super::live::{self, Live};
use crate::Session;
use crate::diag::Fault;
use crate::identify::problem::{self as solving, Run};
use crate::runs::checkpoint::Checkpoint;
use std::path::PathBuf;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

/// Seconds between two looks at the watched settings.
const LOOK: f64 = 0.2;

/// A search in progress.
pub(super) struct Search {
    pub run: Run,
    pub checkpoint: Checkpoint,
    watched: Option<Watched>,
    live: Live,
    /// What is set when the seconds of the stop conditions have passed.
    timer: Option<Arc<AtomicBool>>,
    /// Seconds that the run took before it was resumed.
    before: f64,
    /// The world's clock at the beginning, pauses not counted.
    started: f64,
    /// When the watched settings were looked at.
    looked: f64,
}

/// Why a search ended.
pub(super) struct Ending {
    pub reason: String,
    /// Whether the user has ended it.
    pub is_interrupted: bool,
}

impl Ending {
    fn of(reason: String) -> Ending {
        Ending { reason, is_interrupted: false }
    }

    fn by_user(reason: &str) -> Ending {
        Ending { reason: reason.to_owned(), is_interrupted: true }
    }
}

impl Search {
    /// Begins to search, or continues where the run was resumed; `watch` is a file of settings.
    pub(super) fn new(
        session: &Session,
        run: Run,
        checkpoint: Checkpoint,
        watch: Option<PathBuf>,
    ) -> Search {
        let mut search = Search {
            before: run.seconds,
            run,
            checkpoint,
            watched: watch.map(Watched::new),
            live: Live::default(),
            timer: None,
            started: 0.0,
            looked: f64::NEG_INFINITY,
        };
        search.set_timer(session, search.before);
        search.started = session.world.monotonic_seconds();
        search
    }

    /// Searches until it ends.
    ///
    /// # Errors
    ///
    /// A fault that every further evaluation would have as well.
    pub(super) fn run_to_end(&mut self, session: &mut Session) -> Result<Ending, Fault> {
        let ending = loop {
            if let Some(fault) = self.run.fault() {
                session.world.end_view();
                // It would fail again in the same way.
                let _ = session.world.remove(self.checkpoint.path());
                return Err(fault);
            }
            if let Some(ending) = self.step(session) {
                break ending;
            }
        };
        session.world.end_view();
        self.run.evaluation.cancel_by(None);
        self.checkpoint.secure(session, self.run.seconds);
        Ok(ending)
    }

    /// One generation; why the search ends, if it does.
    fn step(&mut self, session: &mut Session) -> Option<Ending> {
        if let Some(stop) = self.run.stop() {
            return Some(Ending::of(stop));
        }
        if session.world.is_interrupted() {
            let why = session.world.stop_reason().unwrap_or_else(|| "interrupted".to_owned());
            return Some(Ending::by_user(&format!(
                "{why}: these are the best values found so far"
            )));
        }
        let seconds = self.before + session.world.monotonic_seconds() - self.started;
        if let Some(watched) = self.watched.as_mut().filter(|_| seconds - self.looked > LOOK) {
            self.looked = seconds;
            watched.apply(session, &mut self.run);
        }
        if session.world.is_pause_requested() && self.pause(session, seconds) {
            let reason = "stopped by the user: these are the best values found so far";
            return Some(Ending::by_user(reason));
        }
        let Some(record) = self.run.step(seconds) else {
            let is_over = self.timer.as_ref().is_some_and(|flag| flag.load(Ordering::Relaxed));
            let is_over = is_over && !session.world.is_interrupted();
            return is_over.then(|| Ending::of(self.run.end_by_time()));
        };
        self.checkpoint.note(session, &solving::encode(&record), seconds);
        self.live.show(session, &self.run);
        None
    }

    /// Lets the user change the run; whether it is to end.
    fn pause(&mut self, session: &mut Session, seconds: f64) -> bool {
        let paused = session.world.monotonic_seconds();
        if live::pause(session, &mut self.run) {
            return true;
        }
        self.started += session.world.monotonic_seconds() - paused;
        self.set_timer(session, seconds);
        false
    }

    /// Lets simulations end when the user asks to or the seconds of the stop conditions have passed,
    /// of which so many are over.
    fn set_timer(&mut self, session: &Session, over: f64) {
        let left = self.run.problem.stop.seconds.map(|limit| limit - over);
        self.timer = left.and_then(|seconds| session.world.flag_after(seconds));
        let flag = self.timer.clone().or_else(|| session.world.interrupt_flag());
        self.run.evaluation.cancel_by(flag);
    }
}
