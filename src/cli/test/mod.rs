//! `gapi test`: scripts compared with what is recorded of them.

mod judgement;
mod junit;
mod wording;

use super::disk;
use super::options::{Freedom, Global};
use super::parsing::scripts;
use super::run::without_folders;
use super::scratch::{Output, ScratchWorld};
use super::terminal::{self, Terminal};
use super::world::SystemWorld;
use super::{limits, session};
use crate::script::language::expectation::{Line, Tolerance, difference, embedded, shown};
use crate::script::world::Screen as _;
use crate::script::{Dialect, Echo, Exchange, Options, Transcript};
use clap::{Args, ValueHint};
use judgement::{Counts, Judged, judged, summary};
use std::io;
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::time::Instant;

/// Arguments of `gapi test`.
#[derive(Debug, Args)]
#[command(after_help = "\
A script is compared with the transcript NAME.mos.snap next to it, or with the lines between `// \
                        Result:` and `// endResult` in it. Files that it writes are kept in memory.

Examples:
  gapi test scripts
  gapi test tests/my.mos --accept
  gapi test --review
  gapi test --junit report.xml

Exit code: 0 if all agree, 1 if one does not or has no reference, 2 for an invalid command line.")]
pub(in crate::cli) struct TestArgs {
    /// Scripts, or folders with scripts
    #[arg(default_value = ".", value_hint = ValueHint::AnyPath)]
    pub paths: Vec<PathBuf>,
    /// Overwrite the transcripts
    #[arg(long, conflicts_with = "review")]
    pub accept: bool,
    /// Ask for each difference whether to accept the new transcript
    #[arg(long)]
    pub review: bool,
    /// Write a JUnit report for build servers
    #[arg(long, value_name = "FILE", value_hint = ValueHint::FilePath)]
    pub junit: Option<PathBuf>,
    /// Permissions of scripts
    #[command(flatten)]
    pub freedom: Freedom,
}

/// How a path in the folder of the script begins, which embedded results leave out.
const START: &str = "<start>/";

/// How a script did.
enum Verdict {
    /// With this number of statements compared one by one.
    Agrees(usize),
    /// The transcript was written.
    Accepted,
    /// There is nothing to compare with.
    Unrecorded,
    /// The comparison, and for an embedded result what each statement did.
    Differs(Vec<Line>, Vec<Judged>),
    Failed(String),
}

/// Runs the scripts; exit code 1 unless all agree with what is recorded.
pub(super) fn test(arguments: &TestArgs, global: &Global) -> ExitCode {
    let terminal = Terminal::new(global.color, false);
    let found = scripts(&arguments.paths);
    let mut results = Vec::with_capacity(found.len());
    for path in found {
        let verdict = examined(&path, arguments, global)
            .unwrap_or_else(|error| Verdict::Failed(error.to_string()));
        terminal::print(&line(&path, &verdict, terminal.colour()));
        let verdict = match (verdict, arguments.review) {
            (verdict @ (Verdict::Differs(..) | Verdict::Unrecorded), true) => {
                reviewed(&path, verdict, arguments, global)
            }
            (verdict, _) => verdict,
        };
        results.push((path, verdict));
    }
    let good = |verdict: &Verdict| matches!(verdict, Verdict::Agrees(_) | Verdict::Accepted);
    let wrong = results.iter().filter(|(_, verdict)| !good(verdict)).count();
    let count = results.len();
    terminal::print(&format!("{count} scripts, {} agree, {wrong} do not\n", count - wrong));
    let counts = Counts::of_all(&results);
    if counts.total() > 0 {
        terminal::print(&format!("{counts}\n"));
    }
    if let Some(file) = &arguments.junit
        && let Err(error) = disk::write_named(file, junit::report(&results).as_bytes())
    {
        terminal::eprint(&format!("error: cannot write `{}`: {error}\n", file.display()));
        return ExitCode::FAILURE;
    }
    if wrong == 0 { ExitCode::SUCCESS } else { ExitCode::FAILURE }
}

/// Where the transcript of a script is.
fn recorded(path: &Path) -> PathBuf {
    let mut name = path.as_os_str().to_owned();
    name.push(".snap");
    PathBuf::from(name)
}

fn examined(path: &Path, arguments: &TestArgs, global: &Global) -> io::Result<Verdict> {
    let bytes = super::named::read(path)?;
    let (script, _) = crate::script::language::parsing::text(&bytes);
    let snap = recorded(path);
    let expected = super::named::read_text(&snap).ok();
    if let (None, Some(expected)) = (&expected, embedded(&script)) {
        let mut ran = Ran::new(path, &arguments.freedom, global, true)?;
        for one in &mut ran.exchanges {
            one.printed = wording::reduced(&one.printed);
        }
        let printed = wording::reduced(&ran.printed.replace(START, ""));
        return Ok(match difference(&wording::reduced(&expected), &printed, Tolerance::EMBEDDED) {
            None => Verdict::Agrees(ran.exchanges.len()),
            Some(lines) => {
                let judged = judged(&lines, &ran.exchanges);
                Verdict::Differs(lines, judged)
            }
        });
    }
    let ran = Ran::new(path, &arguments.freedom, global, false)?;
    let lines =
        expected.map(|expected| difference(&expected, &ran.transcript, Tolerance::TRANSCRIPT));
    match lines {
        Some(None) => Ok(Verdict::Agrees(0)),
        _ if arguments.accept => {
            disk::write_named(&snap, ran.transcript.as_bytes())?;
            Ok(Verdict::Accepted)
        }
        Some(Some(lines)) => Ok(Verdict::Differs(lines, Vec::new())),
        None => Ok(Verdict::Unrecorded),
    }
}

/// What a script printed and its transcript.
struct Ran {
    printed: String,
    exchanges: Vec<Exchange>,
    transcript: String,
}

impl Ran {
    fn new(path: &Path, freedom: &Freedom, global: &Global, embedded: bool) -> io::Result<Ran> {
        let disk = SystemWorld::new(Terminal::new(global.color, true), "results".as_ref(), None)?;
        let _watch = limits::watch(&freedom.limits, Instant::now(), disk.stopping())
            .map_err(|_| io::Error::other("the limits cannot be watched"))?;
        let (folder, name) = (path.parent().unwrap_or(Path::new("")), path.file_name());
        let name = name.ok_or_else(|| io::Error::other("a script has a name"))?;
        let printed = Output::default();
        let world = ScratchWorld::new(disk, folder, Output::clone(&printed));
        let options = freedom.options();
        let dialect = options.dialect.or(embedded.then_some(Dialect::OpenModelica));
        let echo = if embedded { Echo::Everything } else { Echo::Usual };
        let mut session =
            session::open(global, world).with_options(Options { dialect, echo, ..options });
        // What scripts translate in folders of their own, nobody translates again.
        session.storage = None;
        let start = session.world.current_dir();
        session.output.transcript = Some(Transcript::default());
        let status = session.run_file(Path::new(name));
        let transcript = session.output.transcript.take().unwrap_or_default();
        let text = without_folders(&transcript.to_string(), &start, &start.join("results"));
        let printed = printed.lock().map_or(String::new(), |printed| printed.clone());
        Ok(Ran {
            printed: without_folders(&printed, &start, &start.join("results")),
            transcript: format!("{text}[exit code {}]\n", status.code),
            exchanges: transcript.exchanges,
        })
    }
}

fn line(path: &Path, verdict: &Verdict, colour: bool) -> String {
    let (word, code, rest) = match verdict {
        Verdict::Agrees(_) => ("ok", "32", String::new()),
        Verdict::Accepted => ("accepted", "33", String::new()),
        Verdict::Unrecorded => ("new", "33", "  nothing is recorded: --accept\n".to_owned()),
        Verdict::Differs(lines, judged) => {
            ("differs", "31", shown(lines, colour) + &summary(judged))
        }
        Verdict::Failed(message) => ("failed", "31", format!("  {message}\n")),
    };
    let word = match colour {
        true => format!("\x1b[{code}m{word:8}\x1b[0m"),
        false => format!("{word:8}"),
    };
    format!("{word} {}\n{rest}", path.display())
}

/// Asks whether the new transcript is right.
fn reviewed(path: &Path, verdict: Verdict, arguments: &TestArgs, global: &Global) -> Verdict {
    let Ok(ran) = Ran::new(path, &arguments.freedom, global, false) else { return verdict };
    if matches!(verdict, Verdict::Unrecorded) {
        terminal::print(&ran.transcript);
    }
    terminal::print("accept this transcript? [y/N] ");
    let mut answer = String::new();
    let read = io::stdin().read_line(&mut answer);
    let accepted = read.is_ok() && answer.trim().eq_ignore_ascii_case("y");
    match accepted && disk::write_named(&recorded(path), ran.transcript.as_bytes()).is_ok() {
        true => Verdict::Accepted,
        false => verdict,
    }
}
