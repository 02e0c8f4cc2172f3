//! Rank 0's knowledge of the others: who they are, what they work on, how long it takes.

use super::chunk::Times;
use super::connection::Connection;
use super::message::{About, Order, Report, Work, decode, encode};
use super::simulation::Simulation;
use super::traffic::Traffic;
use crate::diag::Fault;
use crate::errors::RANKS_DIFFER;
use crate::problem::Portable;
use crate::{bail, fault};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError, TryLockError};
use std::time::Duration;

/// The shortest pause where no message has come, and the longest, in seconds: a process that waits
/// leaves its core to others. To look for a message takes Open MPI 3e-5 s, so that a core that simulates
/// loses 2 % of its time to the longest pauses; it lost 8 % to pauses of 5e-4 s.
const PAUSES: [f64; 2] = [2e-5, 2e-3];
/// The shortest pause of a process whose core has something else to do.
const SHORT: f64 = 1e-4;
/// A pause takes at most this part of what was waited before, so that a message is found late by no
/// more than that.
const LATE: f64 = 0.02;
/// What a new measurement of simulations counts in the mean.
const NEW: f64 = 0.2;

/// The other ranks, as rank 0 knows them.
pub struct Ranks {
    connection: Box<dyn Connection>,
    /// Rank k is at k − 1.
    others: Vec<About>,
    state: Mutex<State>,
    /// Set where the system asks another rank to end.
    stop: Mutex<Option<Arc<AtomicBool>>>,
}

/// What is under way.
#[derive(Default)]
pub(super) struct State {
    /// One for each thread of each other rank.
    pub lanes: Vec<Lane>,
    pub traffic: Traffic,
    /// Answers that have not been taken yet.
    pub arrived: Vec<Arrived>,
    /// The last message; its memory is used again.
    received: Vec<u8>,
    prepared: Vec<(u64, usize, Option<String>)>,
    next_ticket: u64,
    next_number: u64,
}

/// A thread of another rank.
pub(super) struct Lane {
    pub rank: usize,
    /// Chunks under way: the one that it works on, and one that waits for it.
    pub work: Vec<Sent>,
}

impl Lane {
    fn of(rank: usize) -> Lane {
        Lane { rank, work: Vec::with_capacity(2) }
    }

    /// Individuals under way.
    pub fn load(&self) -> usize {
        self.work.iter().map(|sent| sent.count).sum()
    }
}

/// A chunk under way.
#[derive(Debug, Clone, Copy)]
pub(super) struct Sent {
    pub(crate) ticket: u64,
    /// The first individual, and how many there are.
    pub first: usize,
    pub count: usize,
    at: f64,
    /// What sending it took.
    sending: f64,
    /// Whether the lane had nothing else to do, so that its answer tells what a message takes.
    alone: bool,
}

/// The answers to a chunk.
pub(super) struct Arrived {
    pub lane: usize,
    pub sent: Sent,
    /// What the simulations took; shorter where the work was cancelled.
    pub seconds: f64,
    pub simulations: Vec<Simulation>,
}

/// Simulators of one problem on all other ranks; they are forgotten when it is dropped.
pub struct Prepared {
    pub(super) ranks: Arc<Ranks>,
    number: u64,
    /// What one simulation takes.
    simulation: Mutex<Option<f64>>,
}

/// Waits longer and longer while nothing happens.
pub(super) struct Patience {
    waited: f64,
}

impl Patience {
    pub fn new() -> Patience {
        Patience { waited: 0.0 }
    }

    pub fn reset(&mut self) {
        self.waited = 0.0;
    }

    /// How long to wait this time.
    pub fn next(&mut self) -> Duration {
        let now = (LATE * self.waited).clamp(PAUSES[0], PAUSES[1]);
        self.waited += now;
        Duration::from_secs_f64(now)
    }

    /// How long a process waits whose core has something else to do.
    pub fn busy() -> Duration {
        Duration::from_secs_f64(PAUSES[1])
    }

    /// The same, where a processor has nothing left to do after these seconds.
    pub(crate) fn busy_until(seconds: f64) -> Duration {
        Duration::from_secs_f64((0.5 * seconds).clamp(SHORT, PAUSES[1]))
    }

    pub fn wait(&mut self) {
        std::thread::sleep(self.next());
    }
}

impl Ranks {
    /// Waits until every rank has said what it is.
    ///
    /// # Errors
    ///
    /// `ranks-differ` where one runs another version of the program.
    pub fn connect(connection: Box<dyn Connection>, own: &About) -> Result<Arc<Ranks>, Fault> {
        let mut known: Vec<Option<About>> = vec![None; connection.size().saturating_sub(1)];
        let (mut patience, mut bytes) = (Patience::new(), Vec::new());
        while known.iter().any(Option::is_none) {
            let Some(rank) = connection.receive(&mut bytes) else {
                patience.wait();
                continue;
            };
            match decode(&bytes) {
                Some(Report::Ready(about)) if about.version == own.version => {
                    known[rank - 1] = Some(about);
                }
                Some(Report::Ready(about)) => return Err(differs(rank, &about, own)),
                _ => return Err(unreadable(rank)),
            }
        }
        let others: Vec<About> = known.into_iter().flatten().collect();
        let lanes = others
            .iter()
            .enumerate()
            .flat_map(|(k, about)| (0..about.threads.max(1)).map(move |_| Lane::of(k + 1)));
        let state = State { lanes: lanes.collect(), ..State::default() };
        Ok(Arc::new(Ranks { connection, others, state: Mutex::new(state), stop: Mutex::default() }))
    }

    /// What messages have taken so far; `None` while a population is under way.
    pub fn traffic(&self) -> Option<Traffic> {
        self.free_state().map(|state| state.traffic)
    }

    /// Number of ranks, this one included.
    pub fn size(&self) -> usize {
        self.others.len() + 1
    }

    /// Makes equal simulators on all other ranks.
    ///
    /// # Errors
    ///
    /// `ranks-differ` where a rank cannot make them.
    pub fn prepare(self: &Arc<Ranks>, simulator: Portable) -> Result<Prepared, Fault> {
        let mut state = self.state();
        let number = state.next_number;
        state.next_number += 1;
        let order = encode(&Order::Prepare { number, simulator });
        (1..self.size()).for_each(|rank| self.connection.send(rank, &order));
        let prepared = Prepared { ranks: Arc::clone(self), number, simulation: Mutex::new(None) };
        let mut patience = Patience::new();
        let mut missing = self.size() - 1;
        let mut refused: Option<(usize, String)> = None;
        while missing > 0 {
            if !self.take_reports(&mut state) {
                patience.wait();
            }
            for (_, rank, refusal) in state.prepared.extract_if(.., |known| known.0 == number) {
                missing -= 1;
                refused = refused.or(refusal.map(|refusal| (rank, refusal)));
            }
        }
        drop(state);
        match refused {
            None => Ok(prepared),
            Some((rank, refusal)) => {
                let host = &self.others[rank - 1].host;
                bail!(RANKS_DIFFER, "rank {rank} on `{host}` cannot make the simulator: {refusal}")
            }
        }
    }

    /// The flag that is set where the system asks another rank to end.
    pub fn stop_by(&self, flag: Arc<AtomicBool>) {
        *self.stop.lock().unwrap_or_else(PoisonError::into_inner) = Some(flag);
    }

    /// Ends the service of all other ranks.
    pub fn end(&self) {
        let order = encode(&Order::End);
        (1..self.size()).for_each(|rank| self.connection.send(rank, &order));
    }

    pub(super) fn seconds(&self) -> f64 {
        self.connection.seconds()
    }

    fn state(&self) -> MutexGuard<'_, State> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// The state, if no other work is being distributed.
    pub(super) fn free_state(&self) -> Option<MutexGuard<'_, State>> {
        match self.state.try_lock() {
            Ok(state) => Some(state),
            Err(TryLockError::Poisoned(state)) => Some(state.into_inner()),
            Err(TryLockError::WouldBlock) => None,
        }
    }

    /// Notes all reports that have come; whether there were any.
    pub(super) fn take_reports(&self, state: &mut State) -> bool {
        let mut any = false;
        let mut bytes = std::mem::take(&mut state.received);
        while let Some(rank) = self.connection.receive(&mut bytes) {
            let began = self.seconds();
            any = true;
            match decode(&bytes) {
                Some(Report::Done { ticket, seconds, simulations }) => {
                    let sending = state.done(ticket, seconds, simulations, began);
                    state.traffic.handled(sending + self.seconds() - began);
                }
                Some(Report::Prepared { number, refusal }) => {
                    state.prepared.push((number, rank, refusal));
                }
                Some(Report::Stop) => self.note_stop(),
                // Versions were compared: there is nothing else.
                Some(Report::Ready(_)) | None => {}
            }
        }
        state.received = bytes;
        any
    }

    fn note_stop(&self) {
        let flag = self.stop.lock().unwrap_or_else(PoisonError::into_inner);
        flag.iter().for_each(|flag| flag.store(true, Ordering::SeqCst));
    }

    /// The work that is under way is no longer needed.
    pub(super) fn cancel(&self, state: &State) {
        let order = encode(&Order::Cancel { ticket: state.next_ticket });
        let mut last = 0;
        for lane in state.lanes.iter().filter(|lane| !lane.work.is_empty()) {
            if lane.rank != last {
                self.connection.send(lane.rank, &order);
                last = lane.rank;
            }
        }
    }
}

impl State {
    /// When the first lane with work will have none, in seconds of the connection's clock, where one
    /// simulation takes so many.
    pub(super) fn next_idle(&self, simulation: f64) -> Option<f64> {
        let end = |lane: &Lane| Some(lane.work.first()?.at + lane.load() as f64 * simulation);
        self.lanes.iter().filter_map(end).min_by(f64::total_cmp)
    }

    /// Notes the answers to a chunk; what sending it has taken.
    fn done(&mut self, ticket: u64, seconds: f64, simulations: Vec<Simulation>, now: f64) -> f64 {
        let place = |lane: &Lane| lane.work.iter().position(|sent| sent.ticket == ticket);
        let found = self.lanes.iter().enumerate().find_map(|(k, lane)| Some((k, place(lane)?)));
        let Some((lane, place)) = found else { return 0.0 };
        let sent = self.lanes[lane].work.remove(place);
        if sent.alone {
            self.traffic.answered(simulations.len(), now - sent.at - seconds);
        } else {
            self.traffic.waited(simulations.len());
        }
        self.arrived.push(Arrived { lane, sent, seconds, simulations });
        sent.sending
    }
}

impl Prepared {
    /// Measured times.
    pub(super) fn times(&self, state: &State) -> Times {
        let simulation = *self.simulation.lock().unwrap_or_else(PoisonError::into_inner);
        let Traffic { message, handling, .. } = state.traffic;
        Times { simulation, message, handling }
    }

    /// Notes what some simulations took.
    pub(super) fn measured(&self, simulations: usize, seconds: f64) {
        if simulations == 0 {
            return;
        }
        let own = seconds / simulations as f64;
        let mut known = self.simulation.lock().unwrap_or_else(PoisonError::into_inner);
        *known = Some(known.map_or(own, |known| known + NEW * (own - known)));
    }

    /// Gives a lane these individuals; the ticket of the answer.
    pub(super) fn send(&self, state: &mut State, lane: usize, first: usize, mut work: Work) -> u64 {
        let count = work.batch().len();
        work.number = self.number;
        work.ticket = state.next_ticket;
        state.next_ticket += 1;
        let (ticket, at) = (work.ticket, self.ranks.seconds());
        self.ranks.connection.send(state.lanes[lane].rank, &encode(&Order::Work(work)));
        let sending = self.ranks.seconds() - at;
        let work = &mut state.lanes[lane].work;
        work.push(Sent { ticket, first, count, at, sending, alone: work.is_empty() });
        ticket
    }
}

impl Drop for Prepared {
    fn drop(&mut self) {
        let order = encode(&Order::Forget { number: self.number });
        (1..self.ranks.size()).for_each(|rank| self.ranks.connection.send(rank, &order));
    }
}

fn differs(rank: usize, about: &About, own: &About) -> Fault {
    fault!(
        RANKS_DIFFER,
        "rank {rank} on `{}` runs gapi {}, but rank 0 on `{}` runs gapi {}",
        about.host,
        about.version,
        own.host,
        own.version;
        help: "start the same program on all machines"
    )
}

fn unreadable(rank: usize) -> Fault {
    fault!(
        RANKS_DIFFER,
        "rank {rank} sends messages that this version cannot read";
        help: "start the same program on all machines"
    )
}
