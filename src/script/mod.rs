//! The script language: sessions that run `.mos` scripts statement by statement, and the commands
//! that scripts find.
//!
//! ```text
//!   text ──syntax::parse_script──▶ statements ──Session──▶ values, files, Transcript, RunStatus
//!                                       │
//!            eval (expressions, flow)  builtins (commands)  simulation (models)
//! ```

pub mod access;
pub mod builtins;
pub mod codes;
pub mod errors;
pub mod language;
pub mod models;
mod openmodelica;
mod options;
pub mod runs;
mod session;
pub mod world;

pub use access::permissions::Permissions;
pub use language::execution::RunStatus;
pub use language::messages::Messages;
pub use language::transcript::{Exchange, Transcript};
pub use options::{Dialect, Echo, Journaling, Options, Reporting, Strictness};
pub use session::Session;

pub use crate::eval::with_stack;
