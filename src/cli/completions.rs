//! `gapi completions SHELL`: completions for the user's shell.

use super::terminal;
use clap::Args;
use std::process::ExitCode;

/// Arguments of `gapi completions`.
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  gapi completions bash > ~/.local/share/bash-completion/completions/gapi
  gapi completions zsh > ~/.zfunc/_gapi        a folder of fpath
  gapi completions fish > ~/.config/fish/completions/gapi.fish
  gapi completions powershell >> $PROFILE

Exit code: 0 on success, 2 for an unknown shell.")]
pub(super) struct CompletionsArgs {
    /// The shell
    pub shell: clap_complete::Shell,
}

/// Prints the completion script of a shell.
pub(super) fn completions(arguments: &CompletionsArgs, mut gapi: clap::Command) -> ExitCode {
    let mut script = Vec::new();
    clap_complete::generate(arguments.shell, &mut gapi, "gapi", &mut script);
    terminal::print(&String::from_utf8_lossy(&script));
    ExitCode::SUCCESS
}
