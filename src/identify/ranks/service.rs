//! What every rank but the first does: it waits for orders, and its threads simulate.

use super::connection::Connection;
use super::coordinator::Patience;
use super::message::{About, Order, Report, Work, decode, encode};
use super::simulation::{Simulation, simulate};
use crate::diag::Fault;
use crate::problem::{Portable, Simulate, unpacked};
use std::collections::BTreeMap;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{Receiver, Sender, channel};
use std::sync::{Arc, Mutex, PoisonError};
use std::thread::ScopedJoinHandle;

/// What a rank needs to serve.
pub struct Service<'a> {
    /// Where orders come from.
    pub connection: &'a dyn Connection,
    /// What it says of itself.
    pub about: About,
    /// The clock for budgets of time.
    pub clock: fn() -> f64,
    /// Set where the system asks the process to end.
    pub stop: &'a AtomicBool,
}

/// One simulator for each thread.
type Simulators = Arc<Vec<Mutex<Box<dyn Simulate>>>>;

/// Work for a thread.
struct Task {
    work: Work,
    simulators: Simulators,
    cancel: Arc<AtomicBool>,
}

/// Serves until rank 0 ends it.
///
/// # Panics
///
/// Where a thread panics that simulates: no other thread would answer in its place.
pub fn serve(service: &Service<'_>) {
    let (tasks, waiting) = channel::<Task>();
    let (finished, reports) = channel::<Report>();
    let waiting = Mutex::new(waiting);
    service.send(&Report::Ready(service.about.clone()));
    std::thread::scope(|scope| {
        let thread = |place: usize| {
            let (waiting, finished) = (&waiting, finished.clone());
            scope.spawn(move || work_on(place, waiting, &finished, service.connection))
        };
        let threads: Vec<_> = (0..service.about.threads.max(1)).map(thread).collect();
        let mut rank = Rank {
            service,
            simulators: BTreeMap::new(),
            cancel: Arc::default(),
            last_cancelled: None,
            tasks,
            under_way: 0,
            received: Vec::new(),
        };
        rank.run(&reports, &|| threads.iter().any(ScopedJoinHandle::is_finished));
        // Without a sender of tasks the threads end.
    });
}

struct Rank<'a> {
    service: &'a Service<'a>,
    simulators: BTreeMap<u64, Simulators>,
    /// Ends the simulations under way.
    cancel: Arc<AtomicBool>,
    /// Work with tickets below is not begun.
    last_cancelled: Option<u64>,
    tasks: Sender<Task>,
    /// Tasks that were not reported yet.
    under_way: usize,
    /// The last message; its memory is used again.
    received: Vec<u8>,
}

/// Orders that have come.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Taken {
    None,
    Some,
    /// The last of all.
    End,
}

impl Service<'_> {
    fn send(&self, report: &Report) {
        self.connection.send(0, &encode(report));
    }
}

impl Rank<'_> {
    /// `has_lost_one` says whether a thread has ended: while there may be tasks only a panic does that.
    fn run(&mut self, reports: &Receiver<Report>, has_lost_one: &dyn Fn() -> bool) {
        let mut patience = Patience::new();
        let mut has_asked = false;
        loop {
            match self.take_orders() {
                Taken::End => return self.cancel.store(true, Ordering::Relaxed),
                Taken::Some => patience.reset(),
                Taken::None => {}
            }
            if self.service.stop.load(Ordering::Relaxed) && !has_asked {
                has_asked = true;
                self.service.send(&Report::Stop);
            }
            // A core that simulates is not disturbed by looking for messages often.
            let is_idle = self.under_way < self.service.about.threads.max(1);
            let pause = if is_idle { patience.next() } else { Patience::busy() };
            match reports.recv_timeout(pause) {
                Ok(report) => {
                    self.under_way -= 1;
                    patience.reset();
                    // What has come is begun first: rank 0 may be slow to receive.
                    if self.take_orders() == Taken::End {
                        return self.cancel.store(true, Ordering::Relaxed);
                    }
                    self.service.send(&report);
                }
                Err(_) if has_lost_one() => return self.cancel.store(true, Ordering::Relaxed),
                Err(_) => {}
            }
        }
    }

    /// Obeys all orders that have come.
    fn take_orders(&mut self) -> Taken {
        let mut taken = Taken::None;
        let mut bytes = std::mem::take(&mut self.received);
        while self.service.connection.receive(&mut bytes).is_some() {
            taken = Taken::Some;
            match decode(&bytes) {
                Some(Order::End) => return Taken::End,
                Some(order) => self.obey(order),
                // Versions were compared: there is nothing else.
                None => {}
            }
        }
        self.received = bytes;
        taken
    }

    fn obey(&mut self, order: Order) {
        match order {
            Order::Prepare { number, simulator } => {
                let made = self.simulators_of(simulator);
                let refusal = made.as_ref().err().map(|fault| fault.message.clone());
                self.simulators.extend(made.ok().map(|made| (number, made)));
                self.service.send(&Report::Prepared { number, refusal });
            }
            Order::Work(work) => self.begin(work),
            Order::Cancel { ticket } => {
                self.last_cancelled = Some(ticket);
                self.cancel.store(true, Ordering::Relaxed);
                self.cancel = Arc::default();
            }
            Order::Forget { number } => _ = self.simulators.remove(&number),
            Order::End => {}
        }
    }

    fn simulators_of(&self, simulator: Portable) -> Result<Simulators, Fault> {
        let bytes = encode(&simulator);
        let mut all = vec![Mutex::new(unpacked(simulator, self.service.clock)?)];
        for _ in 1..self.service.about.threads {
            let Some(simulator) = decode(&bytes) else { break };
            all.push(Mutex::new(unpacked(simulator, self.service.clock)?));
        }
        Ok(Arc::new(all))
    }

    fn begin(&mut self, work: Work) {
        let is_cancelled = self.last_cancelled.is_some_and(|last| work.ticket < last);
        let known = self.simulators.get(&work.number).filter(|_| !is_cancelled);
        let Some(simulators) = known.cloned() else {
            let none = Report::Done { ticket: work.ticket, seconds: 0.0, simulations: Vec::new() };
            return self.service.send(&none);
        };
        let task = Task { work, simulators, cancel: Arc::clone(&self.cancel) };
        self.under_way += 1;
        // The threads live as long as the sender.
        _ = self.tasks.send(task);
    }
}

/// A thread: simulates one task after the other.
fn work_on(
    place: usize,
    waiting: &Mutex<Receiver<Task>>,
    finished: &Sender<Report>,
    connection: &dyn Connection,
) {
    loop {
        let task = waiting.lock().unwrap_or_else(PoisonError::into_inner).recv();
        let Ok(task) = task else { return };
        let began = connection.seconds();
        let simulations = simulated(place, &task);
        let seconds = connection.seconds() - began;
        let report = Report::Done { ticket: task.work.ticket, seconds, simulations };
        if finished.send(report).is_err() {
            return;
        }
    }
}

fn simulated(place: usize, task: &Task) -> Vec<Simulation> {
    let simulator = &task.simulators[place % task.simulators.len()];
    let mut simulator = simulator.lock().unwrap_or_else(PoisonError::into_inner);
    let batch = task.work.batch();
    simulator.scale_tolerance(batch.tolerance);
    simulator.cancel_by(Some(Arc::clone(&task.cancel)));
    let mut all = Vec::with_capacity(batch.len());
    for individual in 0..batch.len() {
        if task.cancel.load(Ordering::Relaxed) {
            return Vec::new();
        }
        all.push(simulate(simulator.as_mut(), &batch, individual));
    }
    // What was cancelled in the middle is no answer.
    if task.cancel.load(Ordering::Relaxed) { Vec::new() } else { all }
}
