//! `gapi run SCRIPT`: runs a script.

use super::args::{Global, RunArgs};
use super::session;
use super::terminal::{self, Terminal};
use super::world::SystemWorld;
use crate::script::{Echo, Options, Session, Strictness, Transcript};
use crate::source::Span;
use std::path::Path;
use std::process::ExitCode;

/// Runs the script and returns its exit code.
pub(super) fn run(arguments: &RunArgs, global: &Global) -> ExitCode {
    let terminal = Terminal::new(global.color, arguments.quiet);
    let threads = arguments.threads.map(usize::from);
    let world = match SystemWorld::new(terminal, &arguments.out, threads) {
        Ok(world) => world,
        Err(error) => {
            terminal::eprint(&format!("error: the working directory cannot be read: {error}\n"));
            return ExitCode::FAILURE;
        }
    };
    world.catch_interrupts();
    let mut session = session::open(global, world).with_options(options(arguments));
    if arguments.transcript.is_some() {
        session.transcript = Some(Transcript::default());
    }
    if let Some(fault) = arguments.trace.as_deref().and_then(|path| session.trace_to(path).err()) {
        return session::failed(&mut session, vec![fault.at(Span::NONE)]);
    }
    let status = session.run_file(&arguments.script);
    match write_transcript(&mut session, arguments.transcript.as_deref()) {
        Ok(()) => ExitCode::from(status.code),
        Err(message) => {
            terminal::eprint(&message);
            ExitCode::from(status.code.max(1))
        }
    }
}

fn options(arguments: &RunArgs) -> Options {
    let strictness = match (arguments.strict, arguments.lenient) {
        (true, _) => Strictness::Strict,
        (_, true) => Strictness::Lenient,
        _ => Strictness::Usual,
    };
    Options { dialect: None, echo: Echo::Usual, strictness }
}

fn write_transcript(session: &mut Session, path: Option<&Path>) -> Result<(), String> {
    let (Some(path), Some(transcript)) = (path, &session.transcript) else { return Ok(()) };
    let text = transcript.to_string();
    session
        .world
        .write(path, text.as_bytes())
        .map_err(|error| format!("error: `{}` cannot be written: {error}\n", path.display()))
}
