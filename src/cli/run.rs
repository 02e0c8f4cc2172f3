//! `gapi run SCRIPT`: runs a script.

use super::options::{Freedom, Global, seconds};
use super::output::Output;
use super::terminal::{self, Terminal};
use super::world::SystemWorld;
use super::{limits, parsing, session};
use crate::script::access::faults::cannot;
use crate::script::access::policy::Grant;
use crate::script::{Echo, Journaling, Options, Session, Strictness, Transcript};
use crate::source::Span;
use clap::{Args, ValueHint};
use gapilib_identify::Probe;
use std::path::Path;
use std::path::PathBuf;
use std::process::ExitCode;
use std::time::Instant;

/// Arguments of `gapi run`.
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  gapi run scripts/GAPILib.mos
  gapi run scripts/twin/GAPILib.mos --out twin --threads 1
  gapi run my.mos --transcript my.txt --quiet --strict
  gapi run my.mos --resume              resume after Ctrl-C, a crash or a power failure
  gapi run --parse-only scripts

Exit code: 0 on success, 1 on an error that the script did not handle, 2 for an invalid command \
                        line, 130 if interrupted.")]
pub(super) struct RunArgs {
    /// The script (.mos)
    #[arg(value_hint = ValueHint::FilePath, required_unless_present = "parse_only")]
    pub script: Option<PathBuf>,
    /// Folder for results and figures [default: one per script in `results`]
    #[arg(long, value_name = "DIR", value_hint = ValueHint::DirPath)]
    pub out: Option<PathBuf>,
    /// Overwrite the results of another problem in that folder
    #[arg(long)]
    pub overwrite: bool,
    /// Number of threads [default: all cores]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..))]
    pub threads: Option<u16>,
    /// Write each statement with its result to a file
    #[arg(long, value_name = "FILE", value_hint = ValueHint::FilePath)]
    pub transcript: Option<PathBuf>,
    /// Resume an interrupted run from the checkpoint in the output folder
    #[arg(long)]
    pub resume: bool,
    /// Seconds between two checkpoints
    #[arg(long, value_name = "SECONDS", default_value = "2", value_parser = seconds)]
    pub checkpoint: f64,
    /// Show a progress bar instead of the live view (which otherwise appears after one second on a terminal)
    #[arg(long)]
    pub plain: bool,
    /// Record the steps of the genetic algorithm, for `gapi teach`
    #[arg(long, value_name = "FILE", value_hint = ValueHint::FilePath)]
    pub trace: Option<PathBuf>,
    /// Skip the final least-squares fit that starts from the best individual
    #[arg(long)]
    pub(crate) no_probe: bool,
    /// Compute profile likelihoods at the minimum: intervals that are also valid for strongly nonlinear models
    #[arg(long, conflicts_with = "no_probe")]
    pub profile: bool,
    /// Show only errors and what the script prints
    #[arg(long, short)]
    pub quiet: bool,
    /// Echo statements and results as Dymola or omc would
    #[arg(long, conflicts_with = "quiet")]
    pub echo: bool,
    /// Stop at the first error
    #[arg(long, conflicts_with = "lenient")]
    pub strict: bool,
    /// Always exit with code 0
    #[arg(long)]
    pub lenient: bool,
    /// Only parse the scripts in these files and folders
    #[arg(long, value_name = "PATH", num_args = 1.., conflicts_with = "script")]
    pub(crate) parse_only: Vec<PathBuf>,
    /// Permissions of scripts
    #[command(flatten)]
    pub freedom: Freedom,
}

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
        session.output.transcript = Some(Transcript::default());
    }
    let trace = arguments.trace.as_deref();
    trace.into_iter().for_each(|path| session.world.permit_file(path));
    if let Some(fault) = trace.and_then(|path| session.trace_to(path).err()) {
        return session::failed(&mut session, vec![fault.at(Span::NONE)]);
    }
    session.world.grant_script(script);
    if session::lists_permissions(&mut session, global) {
        return ExitCode::SUCCESS;
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
    let (Some(path), Some(transcript)) = (path, &session.output.transcript) else { return Ok(()) };
    let text = without_folders(&transcript.to_string(), start, &session.world.output_dir());
    session
        .world
        .write(&start.join(path), text.as_bytes())
        .map_err(|error| format!("error: {}\n", cannot("write", path, &error).message))
}

/// A transcript does not say where it was made.
pub(super) fn without_folders(text: &str, start: &Path, output: &Path) -> String {
    let output = crate::script::world::normalized(output);
    let text = text.replace(&*output.to_string_lossy(), "<output>");
    match start.parent() {
        Some(_) => text.replace(&*start.to_string_lossy(), "<start>"),
        None => text,
    }
}
