//! `gapi completions SHELL`: completions for the user's shell.

use super::args::{Cli, CompletionsArgs};
use super::terminal;
use clap::CommandFactory;
use std::process::ExitCode;

/// Prints the completion script of a shell.
pub(super) fn completions(arguments: &CompletionsArgs) -> ExitCode {
    let mut script = Vec::new();
    clap_complete::generate(arguments.shell, &mut Cli::command(), "gapi", &mut script);
    terminal::print(&String::from_utf8_lossy(&script));
    ExitCode::SUCCESS
}
