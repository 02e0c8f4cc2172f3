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
/// more: each costs the time that a call or a simulation may take.
const MOST_HUNG: usize = 5;
/// After so many in a row, in a unit that others have simulated, a search ends: where half of all individuals
/// hang, it is one in a million that these do by chance.
const MOST_HUNG_IN_A_ROW: usize = 20;

/// Processes of one unit.
pub struct Pool {
    start: Box<dyn Start>,
    idle: Mutex<Vec<Worker>>,
    hung: Mutex<Hung>,
    messages: Mutex<Vec<LogMessage>>,
    next_plan: AtomicU64,
}

/// Simulations whose calls did not return.
#[derive(Default)]
struct Hung {
    /// How many came since the last one that did.
    in_a_row: usize,
    /// How the first of these ended.
    first: String,
    /// Whether any simulation has ended otherwise.
    has_returned: bool,
}

impl Hung {
    /// One more; whether it is one too many.
    fn add(&mut self, message: &str) -> bool {
        if self.in_a_row == 0 {
            message.clone_into(&mut self.first);
        }
        self.in_a_row += 1;
        self.in_a_row >= if self.has_returned { MOST_HUNG_IN_A_ROW } else { MOST_HUNG }
    }

    /// What is said of one too many.
    fn sentence(&self) -> String {
        let Hung { in_a_row, first, has_returned } = self;
        match has_returned {
            true => format!("{first}; {in_a_row} simulations in a row ended so"),
            false => format!(
                "{first}; after {in_a_row} simulations that ended so, and no other, there are no more"
            ),
        }
    }
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
            hung: Mutex::default(),
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
        self.refuse_hopeless(settings.start)?;
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
        *locked(&self.hung) = Hung { has_returned: true, ..Hung::default() };
        // One that was cancelled takes no requests any more.
        if !settings.cancel.as_ref().is_some_and(|flag| flag.load(Ordering::Relaxed)) {
            locked(&self.idle).push(worker);
        }
        self.keep(answer.messages);
        out.replace(answer.time, answer.columns);
        answer.result
    }

    /// Refuses to simulate a unit that has done nothing but hang.
    fn refuse_hopeless(&self, start: f64) -> Result<(), SimulationFailure> {
        let hung = locked(&self.hung);
        match !hung.has_returned && hung.in_a_row >= MOST_HUNG {
            true => Err(SimulationFailure::new(start, FailureClass::Hopeless, hung.sentence())),
            false => Ok(()),
        }
    }

    /// What the end of a process means for its simulation.
    fn failure(&self, start: f64, ended: Ended) -> SimulationFailure {
        let is_hung = matches!(ended, Ended::Hung(_) | Ended::TooSlow);
        let (class, message) = match ended {
            Ended::Itself(message) | Ended::Hung(message) => (FailureClass::Process, message),
            Ended::Cancelled => (FailureClass::Cancelled, "it was cancelled".to_owned()),
            // What looks at the clock between steps has not come to it.
            Ended::TooSlow => (FailureClass::Time, "it takes more time than allowed".to_owned()),
        };
        let mut hung = locked(&self.hung);
        match is_hung && hung.add(&message) {
            true => SimulationFailure::new(start, FailureClass::Hopeless, hung.sentence()),
            false => SimulationFailure::new(start, class, message),
        }
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::import::InterfaceKind;
    use std::collections::VecDeque;

    /// What the simulations come to, one after the other: whether they end.
    #[derive(Clone)]
    struct Script(Arc<Mutex<VecDeque<Result<(), Ended>>>>);

    impl Start for Script {
        fn start(&self) -> Result<Box<dyn Process>, String> {
            Ok(Box::new(self.clone()))
        }
    }

    impl Process for Script {
        fn send(&mut self, _: &Request) -> Result<(), Ended> {
            Ok(())
        }

        fn answer(&mut self, _: Option<&AtomicBool>, _: Option<f64>) -> Result<Answer, Ended> {
            let next = locked(&self.0).pop_front();
            next.unwrap_or(Err(Ended::Cancelled)).map(|()| Answer {
                time: Vec::new(),
                columns: Vec::new(),
                result: Ok(Statistics::default()),
                messages: Vec::new(),
            })
        }
    }

    /// The classes of the failures, `None` of what did not fail, and the last message.
    fn failures(ends: &[(usize, Result<(), Ended>)]) -> (Vec<Option<FailureClass>>, String) {
        let all = ends.iter().flat_map(|(count, end)| std::iter::repeat_n(end.clone(), *count));
        let pool = Pool::new(Box::new(Script(Arc::new(Mutex::new(all.clone().collect())))));
        let plan = pool.plan(Plan {
            kind: InterfaceKind::CoSimulation,
            numbers: Vec::new(),
            strings: Vec::new(),
            varied: Vec::new(),
            inputs: Vec::new(),
            observed: Vec::new(),
            differentiates: false,
        });
        let mut last = String::new();
        let classes = all.map(|_| {
            let mut out = Trajectory::default();
            let failure = pool.simulate((&plan, &[]), &Settings::default(), &mut out).err()?;
            last = failure.message;
            Some(failure.class)
        });
        (classes.collect(), last)
    }

    #[test]
    fn simulations_that_do_not_end_are_counted_in_a_row() {
        let slow = || Err(Ended::TooSlow);
        let hung = || Err(Ended::Hung("a call has not returned".to_owned()));
        let is_hopeless = |class: &Option<FailureClass>| *class == Some(FailureClass::Hopeless);
        // The unit has not simulated anything yet.
        let (classes, last) = failures(&[(2, hung()), (4, slow())]);
        assert_eq!(
            classes.iter().map(is_hopeless).collect::<Vec<_>>(),
            [false, false, false, false, true, true]
        );
        assert!(last.starts_with("a call has not returned; after 5 simulations"), "{last}");
        // It has, and does again.
        let (classes, _) = failures(&[(1, Ok(())), (19, slow()), (1, Ok(())), (19, slow())]);
        assert!(!classes.iter().any(is_hopeless));
        let (classes, last) = failures(&[(1, Ok(())), (20, slow()), (1, Ok(()))]);
        assert_eq!(classes.iter().position(is_hopeless), Some(20));
        assert_eq!(classes.last(), Some(&None));
        assert_eq!(last, "it takes more time than allowed; 20 simulations in a row ended so");
        // A crash is not a hang.
        let (classes, _) = failures(&[(30, Err(Ended::Itself("signal 11".to_owned())))]);
        assert!(!classes.iter().any(is_hopeless));
    }
}
