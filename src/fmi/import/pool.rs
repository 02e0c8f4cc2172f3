//! Processes in which a unit runs, as many as simulations run at once. One that ends, by a fault of the
//! unit or because it was too slow, costs its simulation; the next one gets a new process, unless no
//! simulation has ever returned.

use super::LogMessage;
use super::failure::{FailureClass, SimulationFailure};
use super::plan::Plan;
use super::worker::{Answer, Request};
use crate::Archive;
use crate::sim::{PortableSettings, Settings, Statistics, Trajectory};
use std::collections::BTreeSet;
use std::fmt;
use std::path::Path;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

/// Who runs units.
pub trait Host: Send + Sync {
    /// Whether the user allows to run the unit in this file.
    fn permits(&self, file: &Path) -> bool;
    /// Unpacks a unit for its processes.
    ///
    /// # Errors
    /// Why that is not possible, in one sentence.
    fn install(&self, archive: &Archive) -> Result<Box<dyn Start>, String>;
}

/// Starts processes for a unit.
pub trait Start: Send + Sync {
    /// A process that waits for requests.
    ///
    /// # Errors
    /// Why there is none, in one sentence.
    fn start(&self) -> Result<Box<dyn Process>, String>;
}

/// A process that simulates.
pub trait Process: Send {
    /// Sends a request.
    ///
    /// # Errors
    /// How the process ended.
    fn send(&mut self, request: &Request) -> Result<(), Ended>;
    /// Waits for the answer. Where the flag is set the process is asked to answer with what it has; where
    /// it does not, or so many seconds have passed, it is ended.
    ///
    /// # Errors
    /// How the process ended.
    fn answer(
        &mut self,
        cancel: Option<&AtomicBool>,
        seconds: Option<f64>,
    ) -> Result<Answer, Ended>;
}

/// How a process has ended.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Ended {
    /// By itself, in one sentence.
    Itself(String),
    /// Because a call of the unit did not return, in one sentence.
    Hung(String),
    /// It was cancelled.
    Cancelled,
    /// It took too long.
    TooSlow,
}

/// Seconds that a simulation may take beyond its budget, before its process is ended: what looks at the
/// clock between steps is faster.
const GRACE: f64 = 1.0;

/// After so many simulations whose calls did not return, and none that has ended otherwise, there are no
/// more: each costs the time that a call may take.
const MOST_HUNG: usize = 5;

/// Processes of one unit.
pub struct Pool {
    start: Box<dyn Start>,
    idle: Mutex<Vec<Worker>>,
    /// How the simulations hung that came before the first one that did not; `None` after that.
    hung: Mutex<Option<Vec<String>>>,
    messages: Mutex<Vec<LogMessage>>,
    next_plan: AtomicU64,
}

/// A process with the plans that it knows.
struct Worker {
    process: Box<dyn Process>,
    plans: BTreeSet<u64>,
}

/// A plan with its number.
#[derive(Debug, Clone)]
pub struct NumberedPlan {
    number: u64,
    plan: Arc<Plan>,
}

impl fmt::Debug for Pool {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Pool").finish_non_exhaustive()
    }
}

fn locked<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

impl Pool {
    /// Processes that are started when they are needed.
    pub fn new(start: Box<dyn Start>) -> Pool {
        Pool {
            start,
            idle: Mutex::default(),
            hung: Mutex::new(Some(Vec::new())),
            messages: Mutex::default(),
            next_plan: AtomicU64::new(0),
        }
    }

    /// A plan for simulations with these processes.
    pub fn plan(&self, plan: Plan) -> NumberedPlan {
        let number = self.next_plan.fetch_add(1, Ordering::Relaxed);
        NumberedPlan { number, plan: Arc::new(plan) }
    }

    /// What the unit has said since this was asked, each message once.
    pub fn take_messages(&self) -> Vec<LogMessage> {
        std::mem::take(&mut locked(&self.messages))
    }

    /// Simulates in a process that is idle, or in a new one.
    ///
    /// # Errors
    /// When and why the simulation failed; `out` has what was computed until then.
    pub fn simulate(
        &self,
        (plan, values): (&NumberedPlan, &[f64]),
        settings: &Settings,
        out: &mut Trajectory,
    ) -> Result<Statistics, SimulationFailure> {
        out.reset(plan.plan.observed.len());
        let failure = |ended: Ended| self.failure(settings.start, ended);
        self.refuse_hopeless().map_err(failure)?;
        let idle = locked(&self.idle).pop();
        let mut worker = match idle {
            Some(worker) => worker,
            None => {
                let process = self.start.start();
                let process = process.map_err(|why| failure(Ended::Itself(why)))?;
                Worker { process, plans: BTreeSet::new() }
            }
        };
        let answer = worker.simulate((plan, values), settings).map_err(failure)?;
        *locked(&self.hung) = None;
        // One that was cancelled takes no requests any more.
        if !settings.cancel.as_ref().is_some_and(|flag| flag.load(Ordering::Relaxed)) {
            locked(&self.idle).push(worker);
        }
        self.keep(answer.messages);
        out.replace(answer.time, answer.columns);
        answer.result
    }

    /// Refuses to simulate a unit that has done nothing but hang.
    fn refuse_hopeless(&self) -> Result<(), Ended> {
        match &*locked(&self.hung) {
            Some(all) if all.len() >= MOST_HUNG => Err(Ended::Itself(format!(
                "{}; after {MOST_HUNG} simulations that ended so, and no other, there are no more",
                all[0]
            ))),
            _ => Ok(()),
        }
    }

    /// What the end of a process means for its simulation.
    fn failure(&self, start: f64, ended: Ended) -> SimulationFailure {
        let (class, message) = match ended {
            Ended::Itself(message) => (FailureClass::Process, message),
            Ended::Hung(message) => {
                if let Some(all) = &mut *locked(&self.hung) {
                    all.push(message.clone());
                }
                (FailureClass::Process, message)
            }
            Ended::Cancelled => (FailureClass::Cancelled, "it was cancelled".to_owned()),
            Ended::TooSlow => (FailureClass::Time, "it takes more time than allowed".to_owned()),
        };
        SimulationFailure::new(start, class, message)
    }

    fn keep(&self, messages: Vec<LogMessage>) {
        /// A unit that says more is cut short.
        const MOST: usize = 100;
        let mut all = locked(&self.messages);
        for message in messages {
            if all.len() < MOST {
                message.add_to(&mut all);
            }
        }
    }
}

impl Worker {
    fn simulate(
        &mut self,
        (plan, values): (&NumberedPlan, &[f64]),
        settings: &Settings,
    ) -> Result<Answer, Ended> {
        if self.plans.insert(plan.number) {
            let plan = Request::Plan(plan.number, (*plan.plan).clone());
            self.process.send(&plan)?;
        }
        let request = Request::Simulate {
            plan: plan.number,
            values: values.to_vec(),
            settings: PortableSettings::of(settings),
        };
        self.process.send(&request)?;
        let seconds = settings.time_budget.map(|budget| budget.seconds + GRACE);
        self.process.answer(settings.cancel.as_deref(), seconds)
    }
}
