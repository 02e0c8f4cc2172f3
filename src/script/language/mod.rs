//! The script language: statements, expressions and calls of a session, scripts that run scripts,
//! and what is shown of them.

pub mod callees;
mod constants;
mod declarations;
pub mod echo;
pub mod execution;
pub mod expectation;
pub(crate) mod follow_up;
mod host;
pub mod log;
pub mod messages;
pub mod output;
pub(crate) mod parsed_scripts;
pub mod parsing;
pub mod script_checks;
mod scripts;
mod statements;
pub(crate) mod statuses;
pub mod transcript;
mod variables;
pub mod workspace;
