//! Simulations on several processes: the ranks of an MPI job, or whatever else passes messages.
//!
//! Rank 0 runs the script or the optimizer. It sends the compiled model to every other rank once,
//! and then parts of populations, as long as there are individuals and ranks without work: dynamic
//! self-scheduling with chunks whose size follows from measured times ([`chunk`]). Its own threads
//! take individuals from the same queue. Every result has its index, so that what comes out does
//! not depend on the number of ranks.
//!
//! ```text
//! rank 0                                     rank k
//! Ranks::connect  ◀────── Ready ───────────  serve
//! Ranks::prepare  ─────── Prepare ────────▶  a simulator for each thread
//!                 ◀────── Prepared ────────
//! distribute      ─────── Work ───────────▶  a thread simulates the chunk
//!                 ◀────── Done ────────────
//!                 ─────── Cancel, End ────▶
//! ```
//!
//! Reference: [Polychronopoulos & Kuck 1987](crate::bibliography#polychronopoulos-kuck-1987), guided
//! self-scheduling.

pub mod chunk;
mod coordinator;
mod distribution;
mod jobs;
mod message;
mod remote;
mod service;
mod simulation;

pub use coordinator::{Prepared, Ranks};
pub use distribution::Local;
pub use message::About;
pub use service::{Service, serve};
pub use simulation::{Asked, Batch, Simulation, simulate};

use super::problem::Portable;
use crate::diag::Fault;
use std::sync::Arc;

/// Passes messages between processes, which are numbered from 0.
pub trait Connection: Send + Sync {
    /// Number of processes.
    fn size(&self) -> usize;
    /// Sends a message; returns when the bytes may be reused. Messages between two processes arrive
    /// in their order.
    fn send(&self, rank: usize, message: &[u8]);
    /// The next message that has arrived, and who sent it.
    fn receive(&self) -> Option<(usize, Vec<u8>)>;
    /// Seconds since an arbitrary moment.
    fn seconds(&self) -> f64;
}

/// What simulates: threads of this process, and other ranks where there are any.
#[derive(Clone)]
pub struct Processors {
    /// Threads of this process.
    pub threads: usize,
    /// The other ranks.
    pub ranks: Option<Arc<Ranks>>,
}

impl Processors {
    /// Threads of this process alone.
    pub fn threads(threads: usize) -> Processors {
        Processors { threads, ranks: None }
    }

    /// Makes simulators on the other ranks, if there are any; otherwise why not, where there are
    /// ranks.
    ///
    /// # Errors
    ///
    /// Those of [`Ranks::prepare`].
    pub(super) fn prepare(
        &self,
        simulator: impl FnOnce() -> Result<Portable, String>,
    ) -> Result<(Option<Prepared>, Option<String>), Fault> {
        let Some(ranks) = self.ranks.as_ref().filter(|ranks| ranks.size() > 1) else {
            return Ok((None, None));
        };
        match simulator() {
            Ok(portable) => Ok((Some(ranks.prepare(portable)?), None)),
            Err(reason) => Ok((None, Some(reason))),
        }
    }
}
