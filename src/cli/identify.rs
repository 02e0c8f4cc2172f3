//! `gapi identify`: solves a problem that is written in a file.

use super::args::{Global, IdentifyArgs};
use super::output::Output;
use super::session;
use super::terminal::{self, Terminal};
use super::world::SystemWorld;
use crate::script::problem::{RunOptions, solve};
use std::process::ExitCode;

/// Solves the problem.
pub(super) fn identify(arguments: &IdentifyArgs, global: &Global) -> ExitCode {
    let mut terminal = Terminal::new(global.color, arguments.quiet);
    if arguments.plain {
        terminal.forbid_view();
    }
    let output = Output::of(
        "gapi identify",
        &arguments.problem,
        arguments.out.as_deref(),
        arguments.overwrite,
    );
    let output = match output {
        Ok(output) => output,
        Err(message) => {
            terminal::eprint(&format!("error: {message}\n"));
            return ExitCode::from(2);
        }
    };
    let threads = arguments.threads.map(usize::from);
    let world = match SystemWorld::for_results(terminal, output, threads) {
        Ok(world) => world,
        Err(error) => {
            terminal::eprint(&format!("error: the working directory cannot be read: {error}\n"));
            return ExitCode::FAILURE;
        }
    };
    world.catch_interrupts();
    let mut session = session::open(global, world);
    let options = RunOptions {
        resume: arguments.resume,
        fresh: arguments.fresh,
        watch: arguments.watch.clone(),
        profile: arguments.profile,
        design: arguments.design,
        sensitivity: arguments.sensitivity.clone(),
        samples: arguments.samples.unwrap_or(0) as usize,
        evaluations: arguments.evaluations,
        ..RunOptions::default()
    };
    match solve(&mut session, &arguments.problem, &options) {
        Ok(_) if session.is_interrupted() => ExitCode::from(130),
        Ok(_) => ExitCode::SUCCESS,
        Err(errors) => session::failed(&mut session, errors),
    }
}
