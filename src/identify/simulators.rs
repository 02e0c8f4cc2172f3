//! Simulators on the threads of this process and on other ranks. What comes out does not depend on
//! how many there are.

use crate::diag::Fault;
use crate::problem::Simulate;
use crate::ranks::{Batch, Local, Prepared, Processors, Simulation, simulate};
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

/// One simulator for each thread of this process, and those of other ranks.
pub(crate) struct Simulators {
    workers: Vec<Mutex<Box<dyn Simulate>>>,
    /// The threads besides the caller's; `None` where the caller's works alone.
    pool: Option<rayon::ThreadPool>,
    /// The simulators of other ranks.
    others: Option<Prepared>,
    /// Why there are none although there are ranks.
    alone: Option<String>,
    cancel: Option<Arc<AtomicBool>>,
    /// What the tolerance of the settings is multiplied with.
    tolerance: f64,
}

impl Simulators {
    /// Makes a simulator for each thread of this process and for those of other ranks.
    ///
    /// # Errors
    ///
    /// Those of the maker; `ranks-differ` where a rank cannot make the simulator.
    pub(crate) fn on(
        processors: &Processors,
        make: impl Fn() -> Result<Box<dyn Simulate>, Fault>,
    ) -> Result<Simulators, Fault> {
        let threads = processors.threads.max(1);
        let workers: Vec<Mutex<Box<dyn Simulate>>> =
            (0..threads).map(|_| make().map(Mutex::new)).collect::<Result<_, Fault>>()?;
        let (others, alone) = processors.prepare(|| locked(&workers[0]).portable())?;
        // The caller's thread gives work to the other ranks where there are some.
        let helpers = if others.is_some() { threads } else { threads - 1 };
        let pool = rayon::ThreadPoolBuilder::new().num_threads(helpers);
        // Where no more threads are to be had, as in browsers, the caller's works alone.
        let pool = if helpers == 0 { None } else { pool.build().ok() };
        Ok(Simulators { workers, pool, others, alone, cancel: None, tolerance: 1.0 })
    }

    /// Why other ranks take no part, in words that follow on "because".
    pub(crate) fn alone(&self) -> Option<&str> {
        self.alone.as_deref()
    }

    /// From now on simulations end when the flag is set.
    pub(crate) fn cancel_by(&mut self, flag: Option<Arc<AtomicBool>>) {
        self.workers.iter().for_each(|worker| locked(worker).cancel_by(flag.clone()));
        self.cancel = flag;
    }

    /// What ends simulations when it is set.
    pub(crate) fn cancel(&self) -> Option<&Arc<AtomicBool>> {
        self.cancel.as_ref()
    }

    /// Whether simulations were cancelled; what was answered then is not used.
    pub(crate) fn is_cancelled(&self) -> bool {
        self.cancel.as_ref().is_some_and(|flag| flag.load(Ordering::Relaxed))
    }

    /// What the tolerance of the settings is multiplied with.
    pub(crate) fn tolerance(&self) -> f64 {
        self.tolerance
    }

    /// From now on simulators solve with the tolerance of the settings times this.
    pub(crate) fn scale_tolerance(&mut self, factor: f64) {
        self.workers.iter().for_each(|worker| locked(worker).scale_tolerance(factor));
        self.tolerance = factor;
    }

    /// The simulator of the caller's thread.
    pub(crate) fn own(&self) -> MutexGuard<'_, Box<dyn Simulate>> {
        locked(&self.workers[0])
    }

    /// Simulates a batch on all threads and ranks, and makes something of each simulation. Where
    /// they were cancelled, they have failed.
    pub(crate) fn simulate<T: Send>(
        &self,
        batch: &Batch<'_>,
        then: impl Fn(Simulation) -> T + Sync,
    ) -> Vec<T> {
        let one = |individual: usize, worker: &mut dyn Simulate| {
            worker.scale_tolerance(batch.tolerance);
            let found = simulate(worker, batch, individual);
            worker.scale_tolerance(self.tolerance);
            found
        };
        let (Some(others), Some(pool)) = (&self.others, &self.pool) else {
            return self.spread(batch.len(), |individual, worker| then(one(individual, worker)));
        };
        let of_thread = |individual: usize| {
            let place = rayon::current_thread_index().unwrap_or(0) % self.workers.len();
            one(individual, locked(&self.workers[place]).as_mut())
        };
        let local = Local { pool, threads: self.workers.len(), simulate: &of_thread };
        let found = others.distribute(batch, &local, self.cancel.as_deref());
        let found = found.unwrap_or_else(|| vec![Simulation::cancelled(batch); batch.len()]);
        found.into_iter().map(then).collect()
    }

    /// Runs a job for every number below `count` on all threads and ranks, each with a simulator of
    /// its own.
    pub(crate) fn each<T: Send>(
        &self,
        count: usize,
        job: impl Fn(usize, &mut dyn Simulate) -> T + Sync,
    ) -> Vec<T> {
        let of_ranks = self.others.as_ref().and_then(|others| {
            let how = (self.tolerance, self.cancel.as_deref());
            others.run_jobs(count, &self.workers, &job, how)
        });
        of_ranks.unwrap_or_else(|| self.spread(count, job))
    }

    /// The same on the threads of this process.
    fn spread<T: Send>(
        &self,
        count: usize,
        job: impl Fn(usize, &mut dyn Simulate) -> T + Sync,
    ) -> Vec<T> {
        let next = AtomicUsize::new(0);
        let work = |worker: &Mutex<Box<dyn Simulate>>| {
            let (mut worker, mut done) = (locked(worker), Vec::new());
            loop {
                let number = next.fetch_add(1, Ordering::Relaxed);
                if number >= count {
                    return done;
                }
                done.push((number, job(number, worker.as_mut())));
            }
        };
        let work = &work;
        let mut shares: Vec<Vec<(usize, T)>> = self.workers.iter().map(|_| Vec::new()).collect();
        let mut pairs = self.workers.iter().zip(&mut shares);
        let own = pairs.next();
        // The caller's thread works too: it has begun long before another one is awake.
        let work_own = || own.into_iter().for_each(|(worker, done)| *done = work(worker));
        match self.pool.as_ref().filter(|_| count > 1) {
            Some(pool) => pool.in_place_scope(|scope| {
                for (worker, done) in pairs {
                    scope.spawn(move |_| *done = work(worker));
                }
                work_own();
            }),
            None => work_own(),
        }
        let mut all: Vec<(usize, T)> = shares.into_iter().flatten().collect();
        all.sort_unstable_by_key(|(number, _)| *number);
        all.into_iter().map(|(_, done)| done).collect()
    }
}

fn locked(worker: &Mutex<Box<dyn Simulate>>) -> MutexGuard<'_, Box<dyn Simulate>> {
    worker.lock().unwrap_or_else(PoisonError::into_inner)
}
