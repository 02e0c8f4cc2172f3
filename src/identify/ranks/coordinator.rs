//! Rank 0's knowledge of the others: who they are, what they work on, how long it takes.

use super::chunk::Times;
use super::connection::Connection;
use super::message::{About, Order, Report, Work, decode, encode};
use super::simulation::Simulation;
use super::traffic::Traffic;
use crate::diag::Fault;
use crate::identify::errors::RANKS_DIFFER;
use crate::identify::problem::Portable;
use crate::{bail, fault};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError, TryLockError};
use std::time::Duration;

/// The first pause where no message has come, and the longest, in seconds: a process that waits
/// leaves its core to others.
const PAUSES: [f64; 2] = [2e-5, 5e-4];
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
    /// Answers that nobody has taken yet.
    pub arrived: Vec<Arrived>,
    prepared: Vec<(u64, usize, Option<String>)>,
    next_ticket: u64,
    next_number: u64,
}

/// A thread of another rank.
pub(super) struct Lane {
    pub rank: usize,
    pub work: Option<Sent>,
}

/// A chunk under way.
#[derive(Debug, Clone, Copy)]
pub(super) struct Sent {
    pub ticket: u64,
    /// The first individual, and how many there are.
    pub first: usize,
    pub count: usize,
    at: f64,
    /// What sending it took.
    sending: f64,
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
pub(super) struct Patience(f64);

impl Patience {
    pub fn new() -> Patience {
        Patience(PAUSES[0])
    }

    pub fn reset(&mut self) {
        self.0 = PAUSES[0];
    }

    /// How long to wait this time.
    pub fn next(&mut self) -> Duration {
        let now = self.0;
        self.0 = (2.0 * now).min(PAUSES[1]);
        Duration::from_secs_f64(now)
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
        let mut patience = Patience::new();
        while known.iter().any(Option::is_none) {
            let Some((rank, bytes)) = connection.receive() else {
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
        let lanes = others.iter().enumerate().flat_map(|(k, about)| {
            (0..about.threads.max(1)).map(move |_| Lane { rank: k + 1, work: None })
        });
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
        while let Some((rank, bytes)) = self.connection.receive() {
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
        any
    }

    fn note_stop(&self) {
        let flag = self.stop.lock().unwrap_or_else(PoisonError::into_inner);
        flag.iter().for_each(|flag| flag.store(true, Ordering::SeqCst));
    }

    /// Nobody waits for the work that is under way.
    pub(super) fn cancel(&self, state: &State) {
        let order = encode(&Order::Cancel { ticket: state.next_ticket });
        let mut last = 0;
        for lane in state.lanes.iter().filter(|lane| lane.work.is_some()) {
            if lane.rank != last {
                self.connection.send(lane.rank, &order);
                last = lane.rank;
            }
        }
    }
}

impl State {
    /// Notes the answers to a chunk; what sending it has taken.
    fn done(&mut self, ticket: u64, seconds: f64, simulations: Vec<Simulation>, now: f64) -> f64 {
        let of = |lane: &Lane| lane.work.is_some_and(|sent| sent.ticket == ticket);
        let Some(lane) = self.lanes.iter().position(of) else { return 0.0 };
        let Some(sent) = self.lanes[lane].work.take() else { return 0.0 };
        self.traffic.answered(simulations.len(), now - sent.at - seconds);
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

    /// Gives a lane these individuals.
    pub(super) fn send(&self, state: &mut State, lane: usize, first: usize, mut work: Work) {
        let count = work.batch().len();
        work.number = self.number;
        work.ticket = state.next_ticket;
        state.next_ticket += 1;
        let (ticket, at) = (work.ticket, self.ranks.seconds());
        self.ranks.connection.send(state.lanes[lane].rank, &encode(&Order::Work(work)));
        let sending = self.ranks.seconds() - at;
        state.lanes[lane].work = Some(Sent { ticket, first, count, at, sending });
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
