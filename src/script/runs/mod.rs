//! Runs of identifications: evaluated populations, journals and checkpoints, the live view, and
//! problem files.

mod all_failing;
pub(in crate::script) mod branching;
mod changing;
pub(in crate::script) mod checkpoint;
pub(in crate::script) mod identification;
pub mod journal;
pub mod problem;
pub(in crate::script) mod refinement;
mod reseeding;
pub(in crate::script) mod tracing;
pub mod view;
pub(in crate::script) mod watching;
