//! The script language: sessions that run `.mos` scripts statement by statement, and the commands
//! that scripts find.
//!
//! ```text
//!   text ──syntax::parse_script──▶ statements ──Session──▶ values, files, Transcript, RunStatus
//!                                       │
//!            eval (expressions, flow)  builtins (commands)  simulation (models)
//! ```

mod along;
mod branching;
pub mod builtins;
mod callees;
pub mod checking;
mod checkpoint;
mod classes;
pub mod codes;
mod constants;
mod continuation;
mod declarations;
mod echo;
pub mod errors;
pub mod expectation;
mod files;
mod flat_text;
mod follow_up;
mod host;
mod identification;
mod journal;
mod libraries;
mod linearization;
mod log;
mod measured_units;
mod messages;
pub mod parsing;
mod permissions;
pub mod policy;
pub mod problem;
mod refinement;
mod resources;
mod retranslation;
mod scripts;
mod session;
pub mod simulation;
mod statements;
mod static_curve;
mod tracing;
mod transcript;
mod variables;
pub mod verification;
pub mod view;
mod watching;
pub mod world;

pub use messages::Messages;
pub use permissions::Permissions;
pub use session::{Dialect, Echo, Journaling, Options, RunStatus, Session, Strictness};
pub use transcript::{Exchange, Transcript};

pub use crate::eval::with_stack;
