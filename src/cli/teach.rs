//! `gapi teach SCRIPT`: a run of the genetic algorithm, step by step.

use super::args::{Global, TeachArgs};
use super::session;
use super::teach_screen;
use super::terminal::{self, Terminal};
use super::world::SystemWorld;
use crate::script::{Echo, Options};
use crate::source::Span;
use crate::teach::{Trace, Walk, page, plain};
use std::io::IsTerminal as _;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

/// Runs the script, or reads the trace, and shows its steps.
pub(super) fn teach(arguments: &TeachArgs, global: &Global) -> ExitCode {
    let is_script = arguments.input.extension().is_some_and(|extension| extension == "mos");
    let file = match is_script {
        true => match record(arguments, global) {
            Ok(file) => file,
            Err(code) => return code,
        },
        false => arguments.input.clone(),
    };
    let read = std::fs::read(&file).map_err(|error| error.to_string());
    let trace = read.and_then(|bytes| Trace::read(&bytes).map_err(|fault| fault.message));
    match trace {
        Ok(trace) => match &arguments.html {
            Some(page) => write_page(trace, page, is_script.then_some(&arguments.out)),
            None => show(Walk::new(trace), arguments, global),
        },
        Err(message) => {
            terminal::eprint(&format!("error: `{}`: {message}\n", file.display()));
            ExitCode::FAILURE
        }
    }
}

/// Runs the script with a trace beside its results.
fn record(arguments: &TeachArgs, global: &Global) -> Result<PathBuf, ExitCode> {
    let terminal = Terminal::new(global.color, true);
    let world = SystemWorld::new(terminal, &arguments.out, None).map_err(|error| {
        terminal::eprint(&format!("error: the working directory cannot be read: {error}\n"));
        ExitCode::FAILURE
    })?;
    world.catch_interrupts();
    let options = Options { echo: Echo::Nothing, ..Options::default() };
    let mut session = session::open(global, world).with_options(options);
    let file = arguments.out.join("run.trace");
    if let Err(fault) = session.trace_to(&file) {
        return Err(session::failed(&mut session, vec![fault.at(Span::NONE)]));
    }
    let status = session.run_file(&arguments.input);
    if status.code == 0 || status.interrupted { Ok(file) } else { Err(status.code.into()) }
}

/// Writes the page of a trace; the report of the run lies in the folder `results`.
fn write_page(trace: Trace, file: &Path, results: Option<&PathBuf>) -> ExitCode {
    let report =
        results.and_then(|folder| std::fs::read_to_string(folder.join("result.json")).ok());
    let text = page::page(trace, report.as_deref());
    match std::fs::write(file, text) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            terminal::eprint(&format!("error: `{}` cannot be written: {error}\n", file.display()));
            ExitCode::FAILURE
        }
    }
}

/// On the screen of a terminal; as text where there is none.
fn show(mut walk: Walk, arguments: &TeachArgs, global: &Global) -> ExitCode {
    if !walk.go_to(arguments.generation - 1) {
        let has = walk.trace().generations.len();
        terminal::eprint(&format!("error: the run has {has} generations\n"));
        return ExitCode::FAILURE;
    }
    if !arguments.plain && std::io::stdout().is_terminal() && std::io::stdin().is_terminal() {
        let colour = Terminal::new(global.color, true).colour();
        return match teach_screen::walk_through(walk, colour) {
            Ok(()) => ExitCode::SUCCESS,
            Err(error) => {
                terminal::eprint(&format!("error: the terminal cannot be drawn on: {error}\n"));
                ExitCode::FAILURE
            }
        };
    }
    let last = arguments.generation + arguments.count - 1;
    loop {
        terminal::print(&format!("{}\n", plain::step(&walk)));
        if !walk.forward() || walk.number() >= last {
            break;
        }
    }
    terminal::print(&plain::summary(&walk));
    ExitCode::SUCCESS
}
