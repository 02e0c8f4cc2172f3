//! `gapi completions SHELL`: completions for the user's shell.

use super::args::Cli;
use super::terminal;
use clap::Args;
use clap::CommandFactory;
use std::process::ExitCode;

/// Arguments of `gapi completions`.
#[derive(Debug, Args)]
#[command(after_help = "\
Example:
  gapi completions bash > ~/.local/share/bash-completion/completions/gapi")]
pub(super) struct CompletionsArgs {
    /// The shell
    pub shell: clap_complete::Shell,
}

/// Prints the completion script of a shell.
pub(super) fn completions(arguments: &CompletionsArgs) -> ExitCode {
    let mut script = Vec::new();
    clap_complete::generate(arguments.shell, &mut Cli::command(), "gapi", &mut script);
    terminal::print(&String::from_utf8_lossy(&script));
    ExitCode::SUCCESS
}
