//! MPI jobs: rank 0 runs the command, the others simulate for it.

use super::args::{Cli, Command};
use super::launcher::{self, Launched};
use super::options::Limits;
use super::signals;
use super::{limits, terminal};
use clap::Parser as _;
use gapilib_identify::ranks::{About, Connection, Ranks, Service, serve};
use mpi::Threading;
use mpi::topology::SimpleCommunicator;
use mpi::traits::{Communicator as _, Destination as _, Equivalence as _, Source as _};
use std::collections::VecDeque;
use std::process::ExitCode;
use std::sync::atomic::AtomicBool;
use std::sync::{Arc, LazyLock, Mutex, OnceLock, PoisonError};
use std::time::{Duration, Instant};

/// The other ranks, once they are known.
static RANKS: OnceLock<Arc<Ranks>> = OnceLock::new();

/// The other ranks, where this is rank 0 of a job.
pub(super) fn ranks() -> Option<Arc<Ranks>> {
    RANKS.get().cloned()
}

/// Joins the job: runs `command` on rank 0, and serves it on the others.
pub(super) fn join(job: Launched, command: impl FnOnce() -> ExitCode) -> ExitCode {
    let refused = |message: &str| {
        terminal::eprint(&format!("error: {message}\n"));
        ExitCode::FAILURE
    };
    launcher::keep_to_this_machine();
    let Some((universe, threading)) = mpi::initialize_with_threading(Threading::Serialized) else {
        return refused("MPI is already initialized");
    };
    if threading < Threading::Serialized {
        return refused("this MPI library does not support threads (MPI_THREAD_SERIALIZED)");
    }
    let world = universe.world();
    // The library of another launcher finds each process alone.
    if world.size() == 1 {
        return launcher::refuse(job);
    }
    let link = Link { size: world.size() as usize, inbox: Mutex::default() };
    let code = match world.rank() {
        0 => lead(link, command),
        _ => {
            follow(&link);
            ExitCode::SUCCESS
        }
    };
    // Ends MPI, together with the other ranks.
    drop(universe);
    code
}

fn lead(link: Link, command: impl FnOnce() -> ExitCode) -> ExitCode {
    match Ranks::connect(Box::new(link), &about(1)) {
        Ok(ranks) => {
            let ranks = RANKS.get_or_init(|| ranks);
            RankOptions::here().warn_of_binding();
            let code = command();
            ranks.end();
            code
        }
        Err(fault) => {
            terminal::eprint(&format!("error[{}]: {}\n", fault.code.slug, fault.message));
            fault.helps.iter().for_each(|help| terminal::eprint(&format!("  help: {help}\n")));
            // Ranks that run another program understand no message: the job cannot end in order.
            SimpleCommunicator::world().abort(1)
        }
    }
}

fn follow(link: &Link) {
    let stop = Arc::new(AtomicBool::new(false));
    signals::catch_all(&stop);
    let RankOptions { threads, limits, .. } = RankOptions::here();
    // The time is that of rank 0, which saves what it has found before it ends all ranks.
    let limits = Limits { time_limit: None, ..limits };
    let _in_order = InOrder;
    match limits::enforce(&limits) {
        Ok(_watch) => {
            serve(&Service {
                connection: link,
                about: about(threads),
                clock: seconds,
                stop: &stop,
            });
        }
        // Rank 0 would wait for this one.
        Err(_) => SimpleCommunicator::world().abort(2),
    }
}

/// A rank that panics ends the job: rank 0 would wait for its answers.
struct InOrder;

impl Drop for InOrder {
    fn drop(&mut self) {
        if std::thread::panicking() {
            SimpleCommunicator::world().abort(101);
        }
    }
}

/// The options of a rank on the command line; they are the same for all, and rank 0 reports what is
/// wrong with them.
struct RankOptions {
    threads: usize,
    limits: Limits,
    quiet: bool,
}

impl RankOptions {
    fn here() -> RankOptions {
        let (threads, limits, quiet) = match Cli::try_parse().map(|cli| cli.command) {
            Ok(Command::Run(own)) => (own.threads, own.freedom.limits, own.quiet),
            Ok(Command::Identify(own)) => (own.threads, own.limits, own.quiet),
            _ => (None, Limits::default(), true),
        };
        RankOptions { threads: threads.map_or(1, usize::from), limits, quiet }
    }

    /// Launchers bind ranks to cores, Open MPI up to two of them to one core each.
    fn warn_of_binding(&self) {
        let cores = std::thread::available_parallelism().map_or(usize::MAX, usize::from);
        if self.threads > cores && !self.quiet {
            let (threads, s) = (self.threads, if cores == 1 { "" } else { "s" });
            terminal::eprint(&format!(
                "warning: this rank may use {cores} core{s}, but is to have {threads} threads\n  \
                 help: start it with `mpirun --bind-to none`, or with as many cores for each rank \
                 as it has threads\n"
            ));
        }
    }
}

fn about(threads: usize) -> About {
    let host = mpi::environment::processor_name().unwrap_or_default();
    About { version: version(), host, threads }
}

/// Version and checksum of the program: messages are understood by the same build alone.
fn version() -> String {
    let name = env!("CARGO_PKG_VERSION");
    let program = std::env::current_exe().and_then(std::fs::read);
    let mut checksum = flate2::Crc::new();
    checksum.update(&program.unwrap_or_default());
    format!("{name} (build {:08x})", checksum.sum())
}

fn seconds() -> f64 {
    static STARTED: LazyLock<Instant> = LazyLock::new(Instant::now);
    STARTED.elapsed().as_secs_f64()
}

/// Looks at a message under way without a pause: most messages have passed before the system would wake
/// this thread again.
const LOOKS: u32 = 20;
/// The first pause between two later ones; each is twice the one before. A rank that has sent its results
/// waits until rank 0 looks for them, and would keep its core from the thread that simulates.
const NAP: Duration = Duration::from_micros(10);
const DOUBLINGS: u32 = 7;

/// Waits before the next look at a message under way.
fn pause(looks: &mut u32) {
    match looks.checked_sub(LOOKS) {
        None => std::hint::spin_loop(),
        Some(late) => std::thread::sleep(NAP * (1 << late.min(DOUBLINGS))),
    }
    *looks += 1;
}

/// The messages of `MPI_COMM_WORLD`. One thread calls MPI at a time.
struct Link {
    size: usize,
    /// What arrived while something was sent.
    inbox: Mutex<VecDeque<(usize, Vec<u8>)>>,
}

impl Connection for Link {
    fn size(&self) -> usize {
        self.size
    }

    /// Two ranks may send to each other at once: while the other one does not receive, this one does.
    fn send(&self, rank: usize, message: &[u8]) {
        let mut inbox = self.inbox.lock().unwrap_or_else(PoisonError::into_inner);
        let world = SimpleCommunicator::world();
        let other = world.process_at_rank(rank as i32);
        mpi::request::scope(|scope| {
            let mut request = other.immediate_send(scope, message);
            let mut looks = 0;
            while let Err(pending) = request.test() {
                request = pending;
                let mut message = Vec::new();
                match arrived(&world, &mut message) {
                    Some(rank) => inbox.push_back((rank, message)),
                    None => pause(&mut looks),
                }
            }
        });
    }

    fn receive(&self, message: &mut Vec<u8>) -> Option<usize> {
        let mut inbox = self.inbox.lock().unwrap_or_else(PoisonError::into_inner);
        let Some((rank, waiting)) = inbox.pop_front() else {
            return arrived(&SimpleCommunicator::world(), message);
        };
        *message = waiting;
        Some(rank)
    }

    fn seconds(&self) -> f64 {
        seconds()
    }
}

/// The library's own waiting gives the core away for a whole time slice, or keeps it from the thread
/// that simulates.
fn arrived(world: &SimpleCommunicator, bytes: &mut Vec<u8>) -> Option<usize> {
    let (message, status) = world.any_process().immediate_matched_probe()?;
    bytes.resize(usize::try_from(status.count(u8::equivalent_datatype())).ok()?, 0);
    mpi::request::scope(|scope| {
        let mut request = message.immediate_matched_receive_into(scope, &mut bytes[..]);
        let mut looks = 0;
        while let Err(pending) = request.test() {
            request = pending;
            pause(&mut looks);
        }
    });
    Some(status.source_rank() as usize)
}
