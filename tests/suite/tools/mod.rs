//! The program as its users meet it: commands, sessions, files, prompts, pages and editors.

mod bad_input;
mod cli;
mod compat;
mod drafts;
mod faults;
mod formatting;
mod fuzzing;
mod grants;
mod guide;
mod hangup;
mod imports;
mod lessons;
mod limits;
mod linear;
mod lsp;
mod mat;
mod mcp;
mod page;
mod permissions;
mod plot;
mod repl;
mod script_fuzzing;
mod script_tests;
mod scripts;
mod session;
mod teach;
#[cfg(unix)]
mod terminal;
mod units;
