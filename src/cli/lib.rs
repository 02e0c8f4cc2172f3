//! The command line: arguments in, exit code out. The only module that reads and writes files,
//! the clock, the environment and the terminal.

#![cfg_attr(
    not(feature = "lsp"),
    allow(dead_code, unused_imports, reason = "what only the parts that are left out use")
)]
#![cfg_attr(test, allow(clippy::disallowed_methods, reason = "expectations of tests"))]

// Modules and macros of lower crates, under the names that they have there.
pub(crate) use gapilib_base::{
    bail, budget, diag, elementary, fault, name, plot, registry, source,
};
pub(crate) use gapilib_fmi as fmi;
pub(crate) use gapilib_modelica::{codegen, external, flatten, format, functions, runtime, syntax};
pub(crate) use gapilib_numerics::{ga, results, sim};
pub(crate) use gapilib_script as script;
pub(crate) use gapilib_script::{lessons, packages};

mod args;
mod c_compiler;
mod cache_folder;
mod check;
mod compare;
mod comparison;
mod completions;
#[cfg(feature = "lsp")]
mod connection;
mod device;
mod disk;
mod effort;
pub mod embedding;
mod estimate;
mod explain;
mod export;
mod export_fmu;
mod fitted;
mod fmt;
mod fmu;
mod hangup;
mod help;
mod identify;
mod import;
mod interrupts;
mod journal;
mod launcher;
mod lesson;
mod limits;
mod linearize;
mod live;
mod lock;
#[cfg(feature = "lsp")]
pub mod lsp;
mod man;
#[cfg(feature = "lsp")]
mod mcp;
mod memory;
mod misplaced;
#[cfg(feature = "mpi")]
mod mpi;
mod named;
mod new;
mod numbers;
mod options;
mod output;
mod parsing;
mod pool;
mod repl;
mod report;
mod run;
mod scratch;
mod session;
#[cfg(unix)]
mod signals;
mod simulate;
mod teach;
mod teach_run;
mod teach_screen;
mod terminal;
mod test;
mod thread_time;
mod translations;
mod verify;
mod world;

use crate::script::with_stack;
use args::{Cli, Command};
use clap::{CommandFactory, Parser};
use std::process::ExitCode;

/// Stack of the thread that works, in bytes: functions written in Modelica may call themselves
/// a thousand deep.
const STACK: usize = 256 << 20;

/// Runs the command that the process was started with. Exit code 2 for a wrong command line; the
/// help of each command describes the other codes.
pub fn main() -> ExitCode {
    crate::budget::allow_long_calls();
    #[cfg(unix)]
    signals::survive_large_files();
    match launcher::launched() {
        None => command(),
        #[cfg(feature = "mpi")]
        Some(job) => mpi::join(job, command),
        #[cfg(not(feature = "mpi"))]
        Some(job) => launcher::refuse(job),
    }
}

fn command() -> ExitCode {
    match Cli::try_parse() {
        Ok(cli) => match misplaced::refusal(&cli.command) {
            None => on_large_stack(move || dispatch(&cli)),
            Some(text) => {
                terminal::eprint(&text);
                ExitCode::FAILURE
            }
        },
        Err(error) => ExitCode::from(terminal::print_usage(&misplaced::explained(error))),
    }
}

/// The other ranks, where this is rank 0 of an MPI job.
fn ranks() -> Option<std::sync::Arc<gapilib_identify::ranks::Ranks>> {
    #[cfg(feature = "mpi")]
    return mpi::ranks();
    #[cfg(not(feature = "mpi"))]
    None
}

/// Works on a thread with a large stack.
fn on_large_stack(work: impl FnOnce() -> ExitCode + Send + 'static) -> ExitCode {
    let work = move || with_stack(STACK - (4 << 20), work);
    let worker = std::thread::Builder::new().stack_size(STACK).spawn(work);
    match worker.map(std::thread::JoinHandle::join) {
        Ok(Ok(_)) if terminal::output_failed() => ExitCode::FAILURE,
        Ok(Ok(code)) => code,
        // The panic has said what happened.
        Ok(Err(_)) => ExitCode::from(101),
        Err(error) => {
            terminal::eprint(&format!("error: cannot start a thread: {error}\n"));
            ExitCode::FAILURE
        }
    }
}

/// The default limit of memory, for commands that read what is foreign and have no options for limits.
fn default_limits(command: &Command) -> Result<Option<limits::Watch>, ExitCode> {
    let is_limited = matches!(
        command,
        Command::Teach(_)
            | Command::Lesson(_)
            | Command::New(_)
            | Command::Report(_)
            | Command::Journal(_)
            | Command::Compare(_)
            | Command::Estimate(_)
            | Command::Verify(_)
            | Command::Fmt(_)
    );
    is_limited.then(|| limits::enforce(&options::Limits::default())).transpose()
}

fn dispatch(cli: &Cli) -> ExitCode {
    let lists = matches!(
        cli.command,
        Command::Run(_)
            | Command::Identify(_)
            | Command::Simulate(_)
            | Command::Linearize(_)
            | Command::ExportFmu(_)
            | Command::Check(_)
            | Command::Flatten(_)
            | Command::Repl(_)
    );
    if cli.global.show_permissions && !lists {
        terminal::eprint(
            "error: `--show-permissions` lists what `run`, `identify`, `simulate`, `linearize`, `export-fmu`, \
             `check`, `flatten` and `repl` permit\n",
        );
        return ExitCode::from(2);
    }
    let _watch = match default_limits(&cli.command) {
        Ok(watch) => watch,
        Err(code) => return code,
    };
    match &cli.command {
        Command::Run(arguments) => run::run(arguments, &cli.global),
        Command::Teach(arguments) => teach::teach(arguments, &cli.global),
        Command::Lesson(arguments) => lesson::lesson(arguments, &cli.global),
        Command::Identify(arguments) if !arguments.others.is_empty() => {
            comparison::identify_all(arguments, &cli.global)
        }
        Command::Identify(arguments) => identify::identify(arguments, &cli.global),
        Command::Estimate(arguments) => estimate::states(arguments, &cli.global),
        Command::New(arguments) => new::new(arguments, &cli.global),
        Command::Import(arguments) => import::import(arguments, &cli.global),
        Command::Export(arguments) => export::export(arguments, &cli.global),
        Command::Test(arguments) => test::test(arguments, &cli.global),
        Command::Repl(arguments) => repl::repl(arguments, &cli.global),
        Command::Help(arguments) => help::help(arguments, &Cli::command()),
        Command::Explain(arguments) => explain::explain(arguments),
        Command::Completions(arguments) => completions::completions(arguments, Cli::command()),
        Command::Man(arguments) => man::man(arguments, Cli::command()),
        Command::Simulate(arguments) => simulate::simulate(arguments, &cli.global),
        Command::Linearize(arguments) => linearize::linearize(arguments, &cli.global),
        Command::ExportFmu(arguments) => export_fmu::export_fmu(arguments, &cli.global),
        Command::Check(arguments) => check::check(arguments, &cli.global),
        Command::Fmt(arguments) => fmt::fmt(arguments),
        #[cfg(feature = "lsp")]
        Command::Lsp(arguments) => connection::lsp(arguments, &cli.global),
        #[cfg(feature = "lsp")]
        Command::Mcp(arguments) => mcp::mcp(arguments, &cli.global),
        Command::Journal(arguments) => journal::journal(arguments),
        Command::Report(arguments) => report::report(arguments, &cli.global),
        Command::Compare(arguments) => compare::compare(arguments, &cli.global),
        Command::Verify(arguments) => verify::verify(arguments, &cli.global),
        Command::Flatten(arguments) => check::flatten(arguments, &cli.global),
        Command::FmuWorker(arguments) => fmu::worker(arguments),
    }
}
