//! `gapi verify`: a library against a collection of reference results.

mod cases;
mod report;

use super::options::{Global, seconds};
use super::pool::{self, Ended, Watch};
use super::session;
use super::terminal::{self, Terminal};
use crate::diag::{Diagnostic, Fault};
use crate::disk::list_named;
use crate::name::Name;
use crate::results::{self, Compared};
use crate::script::Session;
use crate::script::access::faults::cannot;
use crate::script::access::policy::Grant;
use crate::script::models::verification;
use crate::script::models::verification::{Reference, Stage, Stuck};
use crate::script::runs::view::Progress;
use crate::script::world::Screen as _;
use crate::source::Span;
use cases::Case;
use clap::{Args, ValueHint};
use report::{Outcome, Row};
use std::collections::BTreeSet;
use std::path::Path;
use std::path::PathBuf;
use std::process::ExitCode;
use std::sync::Mutex;
use std::time::Duration;

/// Arguments of `gapi verify`.
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  gapi verify --library ~/libraries --references ~/references
  gapi verify Decay.mo --references references --filter Decay --output table.json

A case is a folder NAME of the collection with NAME.csv and, optionally, comparisonSignals.txt; its
path below the collection is the name of the model. Or it is a file Library_Examples_Model.txt as
BuildingsPy writes them, with samples of all signals.

Exit code: 0 if every case that has a reference agrees, 1 otherwise.")]
pub(crate) struct VerifyArgs {
    /// Modelica files or package folders, in addition to those of --library
    #[arg(value_name = "FILE", value_hint = ValueHint::AnyPath)]
    pub files: Vec<PathBuf>,
    /// The collection of reference results
    #[arg(long, value_name = "DIR", value_hint = ValueHint::DirPath)]
    pub references: PathBuf,
    /// Only models whose names contain this string
    #[arg(long, value_name = "TEXT")]
    pub filter: Option<String>,
    /// Half width and half height of the tubes, relative to the range of the reference
    #[arg(long, value_name = "E", default_value_t = crate::results::TUBE_TOLERANCE)]
    pub tolerance: f64,
    /// Limit per case in seconds of CPU time, where the system tells that of a thread (Linux), so that
    /// other work on the machine does not count; else in seconds
    #[arg(long, value_name = "S", default_value_t = 60.0, value_parser = seconds)]
    pub budget: f64,
    /// Number of threads [default: all cores]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..))]
    pub threads: Option<u16>,
    /// Additional output file of the table (repeatable); the extension selects the format
    #[arg(long, short, value_name = "FILE.json|.csv", value_hint = ValueHint::FilePath)]
    pub output: Vec<PathBuf>,
}

/// Verifies all cases; succeeds if every one that has a reference agrees.
pub(super) fn verify(arguments: &VerifyArgs, global: &Global) -> ExitCode {
    let files: Vec<_> = global.library.iter().chain(&arguments.files).cloned().collect();
    let mut session = match session::with_files(global, &files) {
        Ok((session, _)) => session,
        Err(code) => return code,
    };
    let (references, filter) = (&arguments.references, arguments.filter.as_deref());
    if let Err(wrong) = load_named(&mut session, references) {
        return session::failed(&mut session, wrong);
    }
    let library = session.library();
    let classes = |name: &Name| match name.first() {
        Some(_) => library.children(name),
        None => library.roots().collect(),
    };
    let cases = match cases::find(references, filter, &classes) {
        Ok(cases) => cases,
        Err(error) => {
            let message = cannot("read", &arguments.references, &error).message;
            terminal::eprint(&format!("error: {message}\n"));
            return ExitCode::FAILURE;
        }
    };
    if cases.is_empty() {
        terminal::eprint(&no_cases(references, filter));
        return ExitCode::FAILURE;
    }
    let rows = run(&mut session, &cases, arguments, global);
    session.print(&report::table(&rows));
    for path in &arguments.output {
        session.world.grant(Grant::Named(path));
        if let Err(fault) = write(&mut session, path, &rows) {
            return session::failed(&mut session, vec![fault.at(Span::NONE)]);
        }
    }
    let all_good = rows.iter().all(|row| row.outcome.is_good());
    if all_good { ExitCode::SUCCESS } else { ExitCode::FAILURE }
}

fn no_cases(references: &Path, filter: Option<&str>) -> String {
    let named = filter.map_or(String::new(), |text| format!(" whose name contains `{text}`"));
    format!(
        "error: `{}` has no case{named}\n  = help: a case is a folder NAME with NAME.csv, or a file \
         Library_Examples_Model.txt with `time=[…]`, for a class of a library that is loaded\n",
        references.display()
    )
}

/// Loads the libraries that the collection is about, if they are found by name: what a folder or a
/// file in it is called begins with theirs; and those that they use.
fn load_named(session: &mut Session, references: &Path) -> Result<(), Vec<Diagnostic>> {
    let mut names = BTreeSet::new();
    // A folder that cannot be read is named where its cases are looked for.
    for entry in list_named(references).unwrap_or_default() {
        let is_letter = |c: char| c.is_ascii_alphanumeric();
        let name: String = entry.chars().take_while(|c| is_letter(*c)).collect();
        names.extend((!name.is_empty()).then_some(name));
    }
    for name in names {
        session.autoload(&Name::parse(&name))?;
    }
    session.load_used()
}

fn write(session: &mut Session, path: &Path, rows: &[Row]) -> Result<(), Fault> {
    let is_csv = path.extension().is_some_and(|extension| extension == "csv");
    let text = if is_csv { report::csv(rows) } else { report::json(rows) };
    session.world.permit_file(path);
    session.world.write_file(path, text.as_bytes())
}

/// The cases whose work has ended, and how far all of it is.
struct Board {
    rows: Vec<Option<Row>>,
    terminal: Terminal,
    progress: Progress,
}

fn run(session: &mut Session, cases: &[Case], arguments: &VerifyArgs, global: &Global) -> Vec<Row> {
    let library = verification::library(session);
    let board = Mutex::new(Board {
        rows: cases.iter().map(|_| None).collect(),
        terminal: Terminal::new(global.color, false),
        progress: Progress {
            label: "case".to_owned(),
            total: cases.len() as u64,
            ..Progress::default()
        },
    });
    let job = |case: &Case| {
        let (library, case, tolerance) = (library.clone(), case.clone(), arguments.tolerance);
        Box::new(move |watch: &Watch| {
            let (table, signals) = match reference(&case)? {
                Some((table, signals)) => (Some(table), signals),
                None => (None, Vec::new()),
            };
            let is_sampled = case.is_sampled();
            let reference = table.as_ref().map(|table| Reference {
                table,
                signals: &signals,
                tolerance,
                is_sampled,
            });
            let enter = &mut |stage| watch.enter(stage);
            let class = Name::parse(&case.model);
            let verified = verification::verify(&library, &class, reference, &watch.cancel, enter);
            Ok(verified.map(|compared| (reference.is_some(), compared)))
        }) as Box<dyn FnOnce(&Watch) -> Judged + Send>
    };
    let budget = Duration::from_secs_f64(arguments.budget);
    let threads = arguments.threads.map_or_else(|| session.world.threads(), usize::from);
    pool::work(cases, threads, budget, job, |index, watch, ended| {
        let row = row(&cases[index], watch, ended);
        let mut board = board.lock().expect("no panic under the lock");
        let Board { rows, terminal, progress } = &mut *board;
        progress.done += 1;
        progress.failures += u64::from(!row.outcome.is_good());
        terminal.progress(progress);
        rows[index] = Some(row);
    });
    let board = board.into_inner().expect("no panic under the lock");
    board.rows.into_iter().flatten().collect()
}

/// Whether there was a reference, and the comparison with it; or where the model got stuck; or why
/// the reference cannot be read.
type Judged = Result<Result<(bool, Vec<Compared>), Stuck>, Fault>;

/// The reference of a case and the signals to compare.
fn reference(case: &Case) -> Result<Option<(results::ResultTable, Vec<String>)>, Fault> {
    let Some(path) = &case.reference else { return Ok(None) };
    let read = |path: &Path| super::named::read(path).map_err(|error| cannot("read", path, &error));
    if case.is_sampled() {
        let table = results::read_sampled(&String::from_utf8_lossy(&read(path)?))?;
        return Ok(table.map(|table| {
            let signals = results::signals_to_compare(&table, None);
            (table, signals)
        }));
    }
    let table = results::format_of_file(&path.to_string_lossy())?.read(&read(path)?)?;
    let list = case.signals.as_deref().map(read).transpose()?;
    let list = list.as_deref().map(String::from_utf8_lossy);
    let signals = results::signals_to_compare(&table, list.as_deref());
    Ok(Some((table, signals)))
}

fn row(case: &Case, watch: &Watch, ended: Ended<Judged>) -> Row {
    let stopped = |code: &str| Outcome::Failed {
        stage: watch.stage().unwrap_or(Stage::Flatten).name(),
        code: code.to_owned(),
        reason: String::new(),
    };
    let outcome = match ended {
        Ended::Done(Ok(Ok((true, compared)))) => Outcome::of(&compared),
        Ended::Done(Ok(Ok((false, _)))) => Outcome::Unjudged,
        Ended::Done(Ok(Err(stuck))) => failed(&stuck),
        Ended::Done(Err(fault)) => Outcome::BadReference { reason: fault.message.clone() },
        Ended::Panicked => stopped("panic"),
        Ended::TimedOut => stopped("timeout"),
    };
    Row {
        model: case.model.clone(),
        outcome,
        compile_seconds: watch.seconds(Stage::Flatten, Stage::Simulate),
        simulate_seconds: watch.seconds(Stage::Simulate, Stage::Compare),
    }
}

fn failed(stuck: &Stuck) -> Outcome {
    let first = stuck.errors.first();
    Outcome::Failed {
        stage: stuck.stage.name(),
        code: first.map_or(String::new(), |error| error.code.slug.to_owned()),
        reason: first.map_or(String::new(), |error| error.message.clone()),
    }
}
