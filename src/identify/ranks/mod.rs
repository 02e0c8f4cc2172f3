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
//! Reference: [Polychronopoulos & Kuck 1987](gapilib_base::bibliography#polychronopoulos-kuck-1987), guided
//! self-scheduling.

pub mod chunk;
mod connection;
mod coordinator;
mod distribution;
mod jobs;
mod message;
mod processors;
mod remote;
mod service;
mod simulation;
mod traffic;

pub use connection::Connection;
pub use coordinator::{Prepared, Ranks};
pub use distribution::Local;
pub use message::About;
pub use processors::Processors;
pub use service::{Service, serve};
pub use simulation::{Asked, Batch, Simulation, simulate};
pub use traffic::Traffic;
