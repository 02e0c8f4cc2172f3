//! Watching a genetic algorithm think: a run of scripts is recorded first, as a trace of what the
//! functions of the paper were given and what they decided, and then walked through, forward and
//! back. Where a script calls none of them but operators by name, their calls are what is walked
//! through.
//!
//! [`Tracer`] writes the trace while the scripts run, [`Trace`] reads it, also what an interrupted
//! run has left. A [`TraceCursor`] stands at one [`Step`] of it; [`plain`] shows steps as text, [`page`]
//! makes a page of them all, [`picture`] a picture of one generation, [`screen`] a terminal's full
//! of each step. [`quiz`] asks before it tells. [`branches`] compares a run with what it would have
//! been, [`bands`] does so over many seeds.

pub mod bands;
pub mod branches;
mod changed_run;
pub mod errors;
mod event;
pub mod explain;
pub mod family;
mod file;
mod generation;
mod kept;
mod operation;
mod operation_table;
mod operation_text;
pub mod page;
pub mod picture;
mod place;
pub mod plain;
mod produced;
pub mod quiz;
#[cfg(test)]
mod sample;
mod scaling;
#[cfg(feature = "cli")]
pub mod screen;
mod step;
mod stop_test;
#[cfg(test)]
mod tests;
mod trace;
mod tracer;
mod walk;
mod words;

pub use event::{Event, ScriptLine, Subject};
pub use generation::{Generation, Origin};
pub use operation::{Action, Operation};
pub use step::Step;
pub use trace::Trace;
pub(crate) use tracer::{MutationCall, Tracer};
pub use walk::TraceCursor;
