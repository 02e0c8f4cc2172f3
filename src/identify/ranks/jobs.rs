//! Jobs that simulate step by step, such as the fits of a bootstrap and Markov chains: each runs on a
//! thread of this process, with a simulator here or with a lane of another rank.

use super::chunk;
use super::coordinator::{Arrived, Patience, Prepared, State};
use super::message::Work;
use super::remote::{Remote, Request};
use super::simulation::Simulation;
use crate::problem::Simulate;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::mpsc::{Receiver, Sender, channel};
use std::sync::{Mutex, PoisonError};

/// A job must simulate so much longer than a message takes, or its messages would slow it down.
const WORTH: f64 = 5.0;

/// Runs one job with a simulator.
pub type Job<'a, T> = &'a (dyn Fn(usize, &mut dyn Simulate) -> T + Sync);

/// The jobs that no thread has begun yet, and the results of the others.
struct Jobs<'a, T> {
    job: Job<'a, T>,
    next: AtomicUsize,
    results: Vec<Mutex<Option<T>>>,
}

impl<T: Send> Jobs<'_, T> {
    fn run(&self, simulator: &mut dyn Simulate) {
        loop {
            let number = self.next.fetch_add(1, Ordering::Relaxed);
            let Some(place) = self.results.get(number) else { return };
            let result = (self.job)(number, simulator);
            *place.lock().unwrap_or_else(PoisonError::into_inner) = Some(result);
        }
    }
}

impl Prepared {
    /// Runs `count` jobs with the simulators of this process and those of free lanes; `None` where
    /// the ranks are of no use, and then nothing was run.
    pub(crate) fn run_jobs<T: Send>(
        &self,
        count: usize,
        own: &[Mutex<Box<dyn Simulate>>],
        job: Job<'_, T>,
        (tolerance, cancel): (f64, Option<&AtomicBool>),
    ) -> Option<Vec<T>> {
        let mut state = self.ranks.free_state()?;
        self.ranks.take_reports(&mut state);
        state.arrived.clear();
        let lanes: Vec<usize> = self.useful_lanes(&state, count.saturating_sub(own.len()));
        if lanes.is_empty() {
            state.traffic.not_used();
            return None;
        }
        let results = (0..count).map(|_| Mutex::new(None)).collect();
        let jobs = Jobs { job, next: AtomicUsize::new(0), results };
        let (requests, asked) = channel::<Request>();
        std::thread::scope(|scope| {
            let jobs = &jobs;
            for simulator in own {
                scope.spawn(move || {
                    let mut simulator = simulator.lock().unwrap_or_else(PoisonError::into_inner);
                    jobs.run(simulator.as_mut());
                });
            }
            let mut answers: Vec<(usize, Sender<Simulation>)> = Vec::new();
            for lane in lanes {
                let (sender, receiver) = channel();
                answers.push((lane, sender));
                let mut remote = Remote::new(lane, requests.clone(), receiver, tolerance);
                scope.spawn(move || jobs.run(&mut remote));
            }
            drop(requests);
            self.pass_on(&mut state, &asked, &answers, cancel);
        });
        let taken =
            |result: Mutex<Option<T>>| result.into_inner().unwrap_or_else(PoisonError::into_inner);
        jobs.results.into_iter().map(taken).collect()
    }

    /// The free lanes, `most` at most; none where simulations are shorter than messages.
    fn useful_lanes(&self, state: &State, most: usize) -> Vec<usize> {
        let chunk::Times { simulation, message, .. } = self.times(state);
        if simulation.is_none_or(|simulation| simulation < WORTH * message) {
            return Vec::new();
        }
        let free = |lane: &usize| state.lanes[*lane].work.is_empty();
        (0..state.lanes.len()).filter(free).take(most).collect()
    }

    /// Passes on requests and answers until the last job has ended.
    fn pass_on(
        &self,
        state: &mut State,
        asked: &Receiver<Request>,
        answers: &[(usize, Sender<Simulation>)],
        cancel: Option<&AtomicBool>,
    ) {
        use std::sync::mpsc::RecvTimeoutError::Disconnected;
        let mut patience = Patience::new();
        loop {
            match asked.recv_timeout(patience.next()) {
                Ok(request) => {
                    patience.reset();
                    self.send(state, request.lane, 0, Work::from(request));
                }
                Err(Disconnected) => return,
                Err(_) => {}
            }
            if self.ranks.take_reports(state) {
                patience.reset();
            }
            for Arrived { lane, seconds, mut simulations, .. } in state.arrived.drain(..) {
                let waiting = answers.iter().find(|(own, _)| *own == lane);
                if let (Some((_, waiting)), Some(simulation)) = (waiting, simulations.pop()) {
                    self.measured(1, seconds);
                    // A job that waits is there.
                    _ = waiting.send(simulation);
                }
            }
            if cancel.is_some_and(|flag| flag.load(Ordering::Relaxed)) {
                return self.ranks.cancel(state);
            }
        }
    }
}

impl From<Request> for Work {
    fn from(request: Request) -> Work {
        Work {
            ticket: 0,
            number: 0,
            parameters: request.values.len(),
            values: request.values,
            points: request.points,
            asked: request.asked,
            tolerance: request.tolerance,
        }
    }
}
