//! The script language: statements, expressions and calls of a session, scripts that run scripts,
//! and what is shown of them.

mod callees;
mod commands;
pub(crate) mod compiled_functions;
mod constants;
mod declarations;
pub mod echo;
pub(crate) mod execution;
pub mod expectation;
mod expressions;
pub(crate) mod follow_up;
mod host;
pub mod log;
mod lookup;
pub mod messages;
pub mod output;
pub(crate) mod parsed_scripts;
pub mod parsing;
pub mod script_checks;
mod script_files;
mod script_search;
mod scripts;
mod statements;
pub(crate) mod statuses;
pub mod transcript;
mod variables;
pub mod workspace;
