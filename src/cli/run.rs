//! `gapi run SCRIPT`: runs a script.

use super::args::{Global, RunArgs};
use super::output::Output;
use super::terminal::{self, Terminal};
use super::world::SystemWorld;
use super::{limits, parsing, session};
use crate::identify::Probe;
use crate::script::access::policy::Grant;
use crate::script::{Echo, Journaling, Options, Session, Strictness, Transcript};
use crate::source::Span;
use std::path::Path;
use std::process::ExitCode;
use std::time::Instant;

/// Runs the script and returns its exit code.
pub(super) fn run(arguments: &RunArgs, global: &Global) -> ExitCode {
    let Some(script) = &arguments.script else {
        return parsing::parse_only(&arguments.parse_only);
    };
    let mut terminal = Terminal::new(global.color, arguments.quiet);
    if arguments.plain {
        terminal.forbid_view();
    }
    let output = Output::of("gapi run", script, arguments.out.as_deref(), arguments.overwrite);
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
            terminal::eprint(&format!("error: {error}\n"));
            return ExitCode::FAILURE;
        }
    };
    world.catch_interrupts();
    let limits = &arguments.freedom.limits;
    let _watch = match limits::watch(limits, Instant::now(), world.stopping()) {
        Ok(watch) => watch,
        Err(code) => return code,
    };
    let mut session = session::open(global, world).with_options(options(arguments));
    let start = session.world.current_dir();
    if let Some(file) = &arguments.transcript {
        session.world.grant(Grant::Named(&start.join(file)));
        session.transcript = Some(Transcript::default());
    }
    if let Some(fault) = arguments.trace.as_deref().and_then(|path| session.trace_to(path).err()) {
        return session::failed(&mut session, vec![fault.at(Span::NONE)]);
    }
    let status = session.run_file(script);
    match write_transcript(&mut session, arguments.transcript.as_deref(), &start) {
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
    let echo = if arguments.echo { Echo::Everything } else { Echo::Usual };
    let seconds = arguments.checkpoint;
    let journaling =
        if arguments.resume { Journaling::Resume(seconds) } else { Journaling::Fresh(seconds) };
    let probe = match (arguments.no_probe, arguments.profile) {
        (true, _) => Probe::Off,
        (false, true) => Probe::Profiles,
        (false, false) => Probe::LeastSquares,
    };
    let quiet = arguments.quiet;
    Options { echo, strictness, quiet, journaling, probe, ..arguments.freedom.options() }
}

fn write_transcript(
    session: &mut Session,
    path: Option<&Path>,
    start: &Path,
) -> Result<(), String> {
    let (Some(path), Some(transcript)) = (path, &session.transcript) else { return Ok(()) };
    let text = without_folders(&transcript.to_string(), start, &session.world.output_dir());
    session
        .world
        .write(&start.join(path), text.as_bytes())
        .map_err(|error| format!("error: `{}` cannot be written: {error}\n", path.display()))
}

/// A transcript does not tell where it was made.
pub(super) fn without_folders(text: &str, start: &Path, output: &Path) -> String {
    let output = crate::script::world::normalized(output);
    let text = text.replace(&*output.to_string_lossy(), "<output>");
    match start.parent() {
        Some(_) => text.replace(&*start.to_string_lossy(), "<start>"),
        None => text,
    }
}
