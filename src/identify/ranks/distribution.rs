//! A population on all processors: the threads of this process and the lanes of the other ranks take
//! individuals from one queue.

use super::chunk;
use super::coordinator::{Arrived, Lane, Patience, Prepared, State};
use super::message::Work;
use super::simulation::{Batch, Simulation};
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::{Mutex, PoisonError};

/// The threads of this process that simulate.
pub struct Local<'a> {
    /// The threads.
    pub pool: &'a rayon::ThreadPool,
    /// How many of them simulate.
    pub threads: usize,
    /// Simulates one individual.
    pub simulate: &'a (dyn Fn(usize) -> Simulation + Sync),
}

/// Individuals that have no processor yet.
struct Queue {
    next: AtomicUsize,
    end: usize,
}

impl Queue {
    fn remaining(&self) -> usize {
        self.end.saturating_sub(self.next.load(Ordering::Relaxed))
    }

    fn take(&self, count: usize) -> Option<std::ops::Range<usize>> {
        let first = self.next.fetch_add(count, Ordering::Relaxed);
        (first < self.end).then(|| first..(first + count).min(self.end))
    }
}

/// Answers with their indices.
type Answers = Vec<(usize, Simulation)>;

impl Prepared {
    /// Simulates a batch; `None` where it was cancelled.
    pub fn distribute(
        &self,
        batch: &Batch<'_>,
        local: &Local<'_>,
        cancel: Option<&AtomicBool>,
    ) -> Option<Vec<Simulation>> {
        let is_cancelled = || cancel.is_some_and(|flag| flag.load(Ordering::Relaxed));
        let queue = Queue { next: AtomicUsize::new(0), end: batch.len() };
        let found: Mutex<Answers> = Mutex::new(Vec::with_capacity(batch.len()));
        let busy = AtomicUsize::new(local.threads);
        let leader = std::thread::current();
        let work = || {
            let mut own = Vec::new();
            let began = self.ranks.seconds();
            while !is_cancelled()
                && let Some(individuals) = queue.take(1)
            {
                own.extend(individuals.map(|k| (k, (local.simulate)(k))));
            }
            self.measured(own.len(), self.ranks.seconds() - began);
            found.lock().unwrap_or_else(PoisonError::into_inner).append(&mut own);
            busy.fetch_sub(1, Ordering::Relaxed);
            leader.unpark();
        };
        let mut remote = Vec::new();
        local.pool.in_place_scope(|scope| {
            for _ in 0..local.threads {
                scope.spawn(|_| work());
            }
            let Some(mut state) = self.ranks.free_state() else { return };
            if chunk::is_worth_distributing(&self.times(&state), batch.len(), local.threads) {
                let here = Here { threads: local.threads, busy: &busy };
                remote = self.hand_out(&mut state, batch, &queue, &here, &is_cancelled);
            } else {
                state.traffic.not_used();
            }
        });
        if is_cancelled() {
            return None;
        }
        let mut found = found.into_inner().unwrap_or_else(PoisonError::into_inner);
        found.append(&mut remote);
        Some(in_order(found, batch))
    }

    /// Gives chunks to lanes until none remains, and collects the answers.
    fn hand_out(
        &self,
        state: &mut State,
        batch: &Batch<'_>,
        queue: &Queue,
        here: &Here<'_>,
        is_cancelled: &dyn Fn() -> bool,
    ) -> Answers {
        let (mut answers, mut patience) = (Vec::new(), Patience::new());
        self.ranks.take_reports(state);
        // Answers that came too late for an earlier batch.
        state.arrived.clear();
        let mut under_way: Vec<u64> = Vec::new();
        loop {
            self.load(state, batch, queue, here, &mut under_way);
            if is_cancelled() {
                self.ranks.cancel(state);
                return answers;
            }
            if under_way.is_empty() {
                return answers;
            }
            match self.ranks.take_reports(state) {
                true => patience.reset(),
                false => {
                    let simulation = self.times(state).simulation.unwrap_or(0.0);
                    let idle = state.next_idle(simulation).unwrap_or(0.0);
                    here.wait(&mut patience, idle - self.ranks.seconds());
                }
            }
            for Arrived { sent, seconds, simulations, .. } in state.arrived.drain(..) {
                let Some(place) = under_way.iter().position(|own| *own == sent.ticket) else {
                    continue;
                };
                under_way.swap_remove(place);
                self.measured(simulations.len(), seconds);
                answers.extend((sent.first..sent.first + sent.count).zip(simulations));
            }
        }
    }

    /// Sends a chunk to each lane that has none, and to each that will have none before a message
    /// arrives.
    fn load(
        &self,
        state: &mut State,
        batch: &Batch<'_>,
        queue: &Queue,
        here: &Here<'_>,
        under_way: &mut Vec<u64>,
    ) {
        let processors = state.lanes.len() + here.threads;
        for lane in 0..state.lanes.len() {
            let remaining = queue.remaining();
            if remaining == 0 {
                return;
            }
            let times = self.times(state);
            let size = match state.lanes[lane].work.len() {
                0 => chunk::size(&times, remaining, processors),
                1 => {
                    let sent: usize = state.lanes.iter().map(Lane::load).sum();
                    let load = (state.lanes[lane].load(), remaining + sent);
                    chunk::ahead(&times, load, remaining, processors)
                }
                _ => 0,
            };
            if size == 0 {
                continue;
            }
            let Some(individuals) = queue.take(size) else { return };
            let work = part(batch, individuals.clone());
            under_way.push(self.send(state, lane, individuals.start, work));
        }
    }
}

/// The threads of this process while a population is distributed.
struct Here<'a> {
    threads: usize,
    /// How many of them still simulate.
    busy: &'a AtomicUsize,
}

impl Here<'_> {
    /// Waits for messages: seldom looking for them while this core simulates, until a thread has ended or
    /// another processor is about to have nothing to do.
    fn wait(&self, patience: &mut Patience, next_idle: f64) {
        if self.busy.load(Ordering::Relaxed) < self.threads {
            return patience.wait();
        }
        patience.reset();
        std::thread::park_timeout(Patience::busy_until(next_idle));
    }
}

fn part(batch: &Batch<'_>, individuals: std::ops::Range<usize>) -> Work {
    let n = batch.parameters;
    Work {
        ticket: 0,
        number: 0,
        values: batch.values[individuals.start * n..individuals.end * n].to_vec(),
        parameters: n,
        points: batch.points,
        asked: batch.asked,
        tolerance: batch.tolerance,
    }
}

fn in_order(found: Answers, batch: &Batch<'_>) -> Vec<Simulation> {
    let mut all: Vec<Simulation> = Vec::new();
    all.resize_with(batch.len(), Simulation::default);
    found.into_iter().for_each(|(place, answer)| all[place] = answer);
    all
}
