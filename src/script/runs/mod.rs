//! Runs of identifications: evaluated populations, journals and checkpoints, the live view, and
//! problem files.

mod all_failing;
pub(crate) mod branching;
mod changing;
pub(crate) mod checkpoint;
mod evaluation;
pub(crate) mod identification;
mod interaction;
pub mod journal;
pub mod problem;
pub(crate) mod refinement;
mod reseeding;
mod run_report;
pub(crate) mod tracing;
pub mod view;
pub(crate) mod watching;
