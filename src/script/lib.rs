//! The script language: sessions that run `.mos` scripts statement by statement, and the commands
//! that scripts find.
//!
//! ```text
//!   text ──syntax::parse_script──▶ statements ──Session──▶ values, files, Transcript, RunStatus
//!                                       │
//!            eval (expressions, flow)  builtins (commands)  simulation (models)
//! ```

#![cfg_attr(
    not(feature = "cli"),
    allow(dead_code, unused_imports, reason = "what only the parts that are left out use")
)]
#![cfg_attr(test, allow(clippy::disallowed_methods, reason = "expectations of tests"))]

// Modules and macros of lower crates, under the names that they have there.
pub(crate) use gapilib_base::{
    bail, codes, diag, elementary, fault, name, page, plot, registry, source, units,
};
pub(crate) use gapilib_fmi as fmi;
pub(crate) use gapilib_identify as identify;
pub(crate) use gapilib_modelica::{
    causalize, codegen, eval, external, flatten, functions, lower, runtime, symbolic, syntax, value,
};
pub(crate) use gapilib_numerics::{frequency, ga, kramers_kronig, mat, results, sim};

pub mod access;
pub mod builtins;
pub mod codes;
pub mod errors;
pub mod language;
pub mod lessons;
pub mod models;
mod openmodelica;
mod options;
pub mod packages;
pub mod runs;
mod session;
pub mod teach;
pub mod world;

pub use access::permissions::Permissions;
pub use language::execution::RunStatus;
pub use language::messages::Messages;
pub use language::transcript::{Exchange, Transcript};
pub use options::{Dialect, Echo, Journaling, Options, Reporting, Strictness};
pub use session::Session;

pub use crate::eval::with_stack;
