//! `gapi identify`: solves a problem that is written in a file.

use super::args::{Global, IdentifyArgs};
use super::comparison;
use super::output::Output;
use super::terminal::{self, Terminal};
use super::world::SystemWorld;
use super::{limits, session};
use crate::identify::problem::Solution;
use crate::script::access::policy::Grant;
use crate::script::runs::problem::{RunOptions, grant_inputs, solve};
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::time::Instant;

/// How a run ended.
pub(super) enum Ended {
    Solved(Box<Solution>),
    Not(ExitCode),
}

/// Solves the problem, or several and compares them.
pub(super) fn identify(arguments: &IdentifyArgs, global: &Global) -> ExitCode {
    if !arguments.others.is_empty() {
        return comparison::identify_all(arguments, global);
    }
    match solve_one(arguments, global, (&arguments.problem, Path::new("")), Instant::now()) {
        Ended::Solved(_) => ExitCode::SUCCESS,
        Ended::Not(code) => code,
    }
}

/// Solves one problem into its folder below `results`, or into `folder` within the one that is wanted.
/// The limit of time counts from `started`.
pub(super) fn solve_one(
    arguments: &IdentifyArgs,
    global: &Global,
    (problem, folder): (&Path, &Path),
    started: Instant,
) -> Ended {
    let mut terminal = Terminal::new(global.color, arguments.quiet);
    if arguments.plain {
        terminal.forbid_view();
    }
    let wanted = arguments.out.as_ref().map(|out| out.join(folder));
    let output = Output::of("gapi identify", problem, wanted.as_deref(), arguments.overwrite);
    let output = match output {
        Ok(output) => output,
        Err(message) => {
            terminal::eprint(&format!("error: {message}\n"));
            return Ended::Not(ExitCode::from(2));
        }
    };
    let threads = arguments.threads.map(usize::from);
    let world = match SystemWorld::for_results(terminal, output, threads) {
        Ok(world) => world,
        Err(error) => {
            terminal::eprint(&format!("error: {error}\n"));
            return Ended::Not(ExitCode::FAILURE);
        }
    };
    world.catch_interrupts();
    let _watch = match limits::watch(&arguments.limits, started, world.stopping()) {
        Ok(watch) => watch,
        Err(code) => return Ended::Not(code),
    };
    let mut session = session::open(global, world);
    let options = RunOptions {
        resume: arguments.resume,
        fresh: arguments.fresh,
        watch: arguments.watch.clone(),
        folder: PathBuf::new(),
        profile: arguments.profile,
        design: arguments.design,
        bootstrap: arguments.bootstrap,
        posterior: arguments.posterior,
        sensitivity: arguments.sensitivity.clone(),
        samples: arguments.samples.unwrap_or(0) as usize,
        evaluations: arguments.evaluations,
    };
    grant_inputs(&mut session, problem);
    if let Some(file) = &arguments.watch {
        session.world.grant(Grant::Read(file));
    }
    match solve(&mut session, problem, &options) {
        Ok(_) if session.is_interrupted() => Ended::Not(session::stopped(&mut session)),
        Ok(solution) => Ended::Solved(Box::new(solution)),
        Err(errors) => Ended::Not(session::failed(&mut session, errors)),
    }
}
