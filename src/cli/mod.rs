//! The command line: arguments in, exit code out. The only module that reads and writes files,
//! the clock, the environment and the terminal.

mod args;
mod completions;
mod explain;
mod run;
mod terminal;
mod world;

use args::{Cli, Command};
use clap::Parser;
use std::process::ExitCode;

/// Runs the command that the process was started with. Exit code 2 for a wrong command line; what
/// the other codes mean stands in the help of each command.
pub fn main() -> ExitCode {
    let cli = Cli::parse();
    match &cli.command {
        Command::Run(arguments) => run::run(arguments, &cli.global),
        Command::Explain(arguments) => explain::explain(arguments),
        Command::Completions(arguments) => completions::completions(arguments),
        Command::Simulate(_) | Command::Check(_) | Command::Flatten(_) => ExitCode::from(2),
    }
}
