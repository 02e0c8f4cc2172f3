//! Problems written in files: read, run with checkpoints, report.
//!
//! The checkpoint is the journal of the run in the folder of the results: every answer of the
//! simulator, appended from time to time. A run that resumes asks the same questions again, is
//! answered from the journal as far as it goes, and so ends with the same bytes as a run that was
//! never interrupted. It is removed when the results have been written; that of a run that ended at a
//! limit is kept for one that continues with a higher limit.

mod build;
mod calibration;
mod constraint;
mod control;
mod covariance;
mod data;
mod deviation;
mod draft;
mod draft_subject;
mod driven;
mod dynamics;
mod enclosing_class;
mod estimate;
mod experiment;
mod failing;
pub(super) mod fault_codes;
mod file;
mod filtering;
mod flat;
mod former;
mod forms;
mod frequency_axis;
mod imported;
mod inference;
mod inputs;
mod interpolation;
mod invariants;
mod live;
mod matching;
mod misread;
mod noise;
mod noise_test;
mod operating_point;
pub(crate) mod operators;
mod own_fitness;
pub(crate) mod own_function;
mod parameters;
mod petab;
mod places;
mod record;
mod refusal;
mod relative;
mod rest;
mod run_journal;
mod search;
mod searches;
mod segments;
mod series;
mod set_file;
mod shards;
mod sigma;
mod spectrum;
mod time_axis;

use super::checkpoint::{self, Checkpoint};
use crate::Session;
use crate::diag::{Diagnostic, Fault};
use crate::fault;
use crate::fmi::ParameterSet;
use crate::fmi::archive::is_unit;
use crate::fmi::parameter_set::{Estimate, Parameter, ParameterValue};
use crate::identify::problem::{
    self as solving, EndingKind, Importance, ModelSimulator, Run, Simulate, Solution,
    SolvedParameter, SolvedSeries,
};
use crate::identify::ranks::{Ranks, Traffic};
use crate::models::imported::{note_messages, refuse_as_text};
use crate::registry::BAD_OPTION;
use crate::sim::TimeBudget;
use crate::source::{SourceId, Span};
use crate::value::RecordValue;
pub use draft::{Draft, Question, draft};
pub use draft_subject::DraftOptions;
pub use driven::{Driven, driven, note_outside};
pub use estimate::{EstimateOptions, Estimated, Shown, estimate};
pub use imported::{FollowedInputs, inputs_of};
pub use petab::petab;
pub use shards::{Division, read_shards};

use build::Built;
use data::Note;
use run_journal::{Journalled, discard, finished, open};
use search::Search;
use searches::{Change, Searched};
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// Files that not every run writes.
const OPTIONAL: [&str; 5] =
    ["bands.csv", "bootstrap.csv", "posterior.csv", "profiles.csv", "searches.csv"];
/// Seconds that each simulation for the report may take once the user has stopped the run.
const HURRY: f64 = 0.5;
/// The journal's file.
const JOURNAL: &str = "run.journal";

/// How a problem is run.
#[derive(Debug, Clone, Default)]
pub struct RunOptions {
    /// Go on from the checkpoint.
    pub resume: bool,
    /// Discard the checkpoint of an earlier run.
    pub fresh: bool,
    /// A file with settings that may be changed during the run.
    pub watch: Option<PathBuf>,
    /// Folder for the results within that of the world.
    pub folder: PathBuf,
    /// Profiles of the parameters after the fit.
    pub profile: bool,
    /// The next measurement after the fit.
    pub design: bool,
    /// Fits to resampled data after the fit.
    pub bootstrap: bool,
    /// Markov chains after the fit.
    pub posterior: bool,
    /// A sensitivity analysis before the fit, by name.
    pub sensitivity: Option<String>,
    /// Its base samples; 0 for the usual number.
    pub samples: usize,
    /// Ends the run after so many evaluations, whatever the problem says.
    pub evaluations: Option<u64>,
    /// Number of searches with different seeds; the best result is kept.
    pub searches: Option<usize>,
    /// Whether the study is divided into shards.
    pub division: Division,
}

/// Solves the problem in the file `path`; writes the results into the world's folder for them.
///
/// # Errors
///
/// Everything that is wrong with the problem; a run without any success; results that cannot be
/// written.
pub fn solve(
    session: &mut Session,
    path: &Path,
    options: &RunOptions,
) -> Result<Solution, Vec<Diagnostic>> {
    let one = |fault: Fault| vec![fault.at(Span::NONE)];
    refuse_as_text(path, "a problem file").map_err(one)?;
    let bytes = session.world.read_bytes(path).map_err(one)?;
    let text = String::from_utf8(bytes)
        .map_err(|_| one(fault!(BAD_OPTION, "`{}` is not valid UTF-8 text", path.display())))?;
    let source = session.sources.add(path.display().to_string(), text.as_str());
    let file = file::read(source, &text)
        .map_err(|error| vec![refusal::with_unread_columns(session, path, &text, error)])?;
    solve_stated(session, path, file, options)
}

/// What is wrong with the problem in the file `path`, whose text is this, and what may change its result:
/// what is said before a run.
pub fn check(
    session: &mut Session,
    path: &Path,
    (source, text): (SourceId, &str),
) -> Vec<Diagnostic> {
    let mut file = match file::read(source, text) {
        Ok(file) => file,
        Err(error) => return vec![refusal::with_unread_columns(session, path, text, error)],
    };
    let notes = match built_for(session, &mut file, path, &RunOptions::default()) {
        Ok(built) => built.notes,
        Err(errors) => return errors,
    };
    let place = file.context.places.at(&["experiment", "0", "data"]);
    notes.into_iter().filter_map(|note| note.warning(place)).collect()
}

/// The names that an entry of a problem may have where its text has an entry that there is not.
pub fn entries(text: &str) -> Vec<String> {
    let Err(error) = file::read(SourceId::NONE, text) else { return Vec::new() };
    let all = error.helps.iter().find_map(|help| help.strip_prefix(refusal::ENTRIES));
    let names = all.into_iter().flat_map(|all| all.split('`').skip(1).step_by(2));
    names.map(str::to_owned).collect()
}

/// The Modelica files and folders that the text of a problem names.
pub fn model_files(text: &str) -> Vec<PathBuf> {
    file::read(SourceId::NONE, text).map(|file| file.files).unwrap_or_default()
}

/// Solves the problem that a record `GAPILib.Problem` of a script holds.
///
/// # Errors
///
/// As [`solve`].
pub(crate) fn solve_record(
    session: &mut Session,
    record: &RecordValue,
    options: &RunOptions,
) -> Result<Solution, Vec<Diagnostic>> {
    let table = record::table(record).map_err(|fault| fault.at(Span::NONE));
    let file = table.and_then(file::of_table).map_err(|error| vec![error])?;
    solve_stated(session, Path::new("problem"), file, options)
}

fn solve_stated(
    session: &mut Session,
    path: &Path,
    mut file: file::ProblemFile,
    options: &RunOptions,
) -> Result<Solution, Vec<Diagnostic>> {
    let one = |fault: Fault| vec![fault.at(Span::NONE)];
    let built = built_for(session, &mut file, path, options)?;
    built.notes.iter().for_each(|note| note.say(session));
    let every =
        (file.checkpoint.generations, file.checkpoint.seconds.unwrap_or(checkpoint::SECONDS));
    if let Some(count) = file.searches.filter(|count| !(1..=searches::MOST).contains(count)) {
        let most = searches::MOST;
        let fault =
            fault!(BAD_OPTION, "`searches` is {count}"; help: "write a number from 1 to {most}");
        return Err(vec![fault.at(file.context.places.at(&["searches"]))]);
    }
    let options = RunOptions { searches: options.searches.or(file.searches), ..options.clone() };
    let method = file.context.places.at(&["method"]);
    let mut again = |session: &mut Session, change: Change<'_>| {
        // What is to be said of the problem has been said.
        let is_quiet = std::mem::replace(&mut session.options.quiet, true);
        let built = match change {
            Change::Seed(seed) => {
                file.seed = Some(seed);
                built_for(session, &mut file, path, &options)
            }
            Change::Entries(change) => {
                let mut changed = file.clone();
                change(&mut changed);
                built_for(session, &mut changed, path, &options)
            }
        };
        session.options.quiet = is_quiet;
        built.map_err(|errors| {
            let first = errors.first().map(|error| error.message.clone()).unwrap_or_default();
            fault!(BAD_OPTION, "the problem cannot be read again: {first}")
        })
    };
    let (mut why, unit) = (None, built.unit.clone());
    let solved = solve_built(session, (path, built), (&options, every), &mut again, &mut why);
    if let Some(unit) = unit {
        note_messages(session, &unit);
    }
    if solved.is_err() && matches!(why, Some(Cause::Failures(_))) {
        // Nothing was simulated: there is nothing to continue.
        let folder = session.world.output_dir().join(&options.folder);
        discard(session, &folder.join(JOURNAL));
    }
    solved.map_err(|fault| match why {
        Some(Cause::Failures(error)) => vec![error],
        Some(Cause::Method) => vec![fault.at(method)],
        None => one(fault),
    })
}

/// Why a run has no result, where that has a place.
enum Cause {
    /// The method cannot begin.
    Method,
    /// All simulations failed.
    Failures(Diagnostic),
}

/// The problem, with what the options ask beyond its file.
fn built_for(
    session: &mut Session,
    file: &mut file::ProblemFile,
    path: &Path,
    options: &RunOptions,
) -> Result<Built, Vec<Diagnostic>> {
    let mut built = build::build(session, file, path)?;
    if options.design {
        built.problem.inference.design.get_or_insert_with(inference::usual_design);
    }
    if options.bootstrap {
        built.problem.inference.bootstrap.get_or_insert_with(inference::usual_bootstrap);
    }
    if options.posterior {
        built.problem.inference.posterior.get_or_insert_with(inference::usual_posterior);
    }
    if let Some(limit) = options.evaluations {
        built.problem.stop.evaluations = Some(limit);
    }
    Ok(built)
}

fn solve_built(
    session: &mut Session,
    (path, built): (&Path, Built),
    (options, every): (&RunOptions, (Option<u64>, f64)),
    again: &mut searches::Again<'_>,
    why: &mut Option<Cause>,
) -> Result<Solution, Fault> {
    let Built { problem, experiments, validation, origins, notes, calibration, doubts, .. } = built;
    let folder = session.world.output_dir().join(&options.folder);
    let mut run = prepared(session, problem, options, why)?;
    let importance = analysed(session, &run, &folder, options)?;
    let files = Journalled { folder: &folder, origins: &origins, every };
    searches::refuse_leftovers(session, &folder, options)?;
    let journal = (&*folder.join(JOURNAL), options.division.journal());
    let checkpoint = open(session, &mut run, journal, &files, options)?;
    let mut search = Search::new(session, run, checkpoint, options.watch.clone());
    let ending = search.run_to_end(session)?;
    let Search { run, checkpoint, .. } = search;
    let searched = searches::search_on(session, (run, ending), &files, options, again)?;
    let Searched { mut run, ending, all, seconds } = searched;
    let with = |found: Solution| Solution { importance: importance.clone(), ..found };
    let paths = (path, checkpoint.path(), folder.as_path());
    let keep =
        |session: &mut Session, run: &Run| shards::keep(session, run, paths, (&origins, options));
    *why = failing::none_simulated(&run, &experiments).map(Cause::Failures);
    let held_out = validated(&run, &validation, hurry(session))?;
    let mut solution = match Solution::of_search(&run, &ending.reason, held_out).map(with) {
        // The searches of this shard count, whatever became of the first one.
        Err(fault) if !ending.is_interrupted && options.searches > Some(1) => {
            keep(session, &run)?;
            return Err(fault);
        }
        solution => solution?,
    };
    // The results are shown before what cannot be written is reported.
    let kept = former::keep(session, &folder, &origins);
    write_quietly(session, &folder, &solution, seconds);
    solving::draw_curves(&experiments, &mut solution, &validation, hurry(session));
    if ending.is_interrupted {
        let why = why_stopped(session, "the search");
        solution = solution.without_statistics(&why).without_inference(&run);
    } else {
        let solved = |run: &Run| {
            Solution::of(run, &ending.reason, validated(run, &validation, None)?).map(with)
        };
        solution = with_statistics(session, &mut run, solution, &solved, all, options)?;
        doubts.settle(session, (&mut run, &mut solution), again)?;
        solving::draw_curves(&experiments, &mut solution, &validation, hurry(session));
    }
    let is_interrupted = ending.is_interrupted || session.world.is_interrupted();
    solution.calibrated = calibration.map(|calibration| calibration.model(&solution));
    print(session, &mut solution, notes);
    write(session, &folder, &solution, seconds).and(kept)?;
    if !is_interrupted {
        keep(session, &run)?;
        keep_finished(session, (&checkpoint, &folder), options, &solution);
    }
    close(session, (&checkpoint, &folder), is_interrupted);
    Ok(solution)
}

/// The run before its first question.
fn prepared(
    session: &mut Session,
    problem: solving::Problem,
    options: &RunOptions,
    why: &mut Option<Cause>,
) -> Result<Run, Fault> {
    if let Some(file) = options.watch.as_ref().filter(|file| !session.world.exists(file)) {
        let name = file.display();
        session
            .print(&format!("there is no file `{name}` yet: its settings apply once it exists\n"));
    }
    *why = Some(Cause::Method);
    let mut run = Run::on(problem, &session.world.processors())?;
    *why = None;
    run.evaluation.cancel_by(session.world.interrupt_flag());
    run.evaluation.parts = options.division.parts();
    session.note_idle_ranks(run.evaluation.alone());
    Ok(run)
}

/// Keeps the journals of a run that ended at a limit, those of all its searches, for one with a higher
/// limit.
fn keep_finished(
    session: &mut Session,
    (checkpoint, folder): (&Checkpoint, &Path),
    options: &RunOptions,
    solution: &Solution,
) {
    if !options.division.is_whole() || solution.outcome.ending.kind != EndingKind::Budget {
        return;
    }
    let others =
        (2..=options.searches.unwrap_or(1)).map(|number| searches::journal(folder, number));
    let is_kept = std::iter::once(checkpoint.path().to_owned()).chain(others).all(|path| {
        let journal = session.world.read_bytes(&path);
        journal.is_ok_and(|bytes| {
            session.world.write_file(&finished(&path), &solving::without_times(&bytes)).is_ok()
        })
    });
    if is_kept {
        session.print("\n  continue from here with higher limits in `[stop]` and --resume\n");
    }
}

/// Adds these notes, which were said at the beginning of the run, and prints the solution.
fn print(session: &mut Session, solution: &mut Solution, notes: Vec<Note>) {
    let said = match session.world.is_one_screen() {
        true => notes.iter().map(|note| note.sentence.clone()).collect(),
        false => Vec::new(),
    };
    solution.add_notes(notes.into_iter().map(Note::finding).collect());
    session.print(&solution.text_after(&said));
}

/// Makes the solution of a run from its best point, and the statistics; where these are stopped, what was
/// found before.
fn with_statistics(
    session: &mut Session,
    run: &mut Run,
    found: Solution,
    solved: &dyn Fn(&Run) -> Result<Solution, Fault>,
    all: Vec<solving::SolvedSearch>,
    options: &RunOptions,
) -> Result<Solution, Fault> {
    run.evaluation.cancel_by(session.world.interrupt_flag());
    run.evaluation.show_by(session.world.status());
    let made = statistics(session, run, solved, all, options);
    run.evaluation.show("");
    run.evaluation.show_by(None);
    match made {
        Err(_) if session.world.is_interrupted() => {
            let why = why_stopped(session, "the statistics");
            Ok(found.without_statistics(&why).without_inference(run))
        }
        made => made,
    }
}

fn statistics(
    session: &mut Session,
    run: &mut Run,
    solved: &dyn Fn(&Run) -> Result<Solution, Fault>,
    all: Vec<solving::SolvedSearch>,
    options: &RunOptions,
) -> Result<Solution, Fault> {
    run.evaluation.show("minimum");
    solving::conclude(run);
    let mut solution = Solution::settled(run, solved)?;
    let searched = solution.fitness;
    if options.profile {
        solution = solution.with_profiles(run, solved)?;
    }
    solution.add_searches(all, searched);
    solution.add_inference(run)?;
    if session.world.is_interrupted() {
        let why = why_stopped(session, "the statistics");
        let sentence = format!("The report is not complete: {why}.");
        let finding = solving::Finding::new(solving::FindingKind::Missing, sentence);
        solution.findings.insert(0, finding);
    }
    Ok(solution)
}

/// Why a run was stopped before this ended.
fn why_stopped(session: &Session, what: &str) -> String {
    match session.world.stop_reason() {
        Some(reason) => format!("{reason}, before {what} ended"),
        None => format!("the user stopped the run before {what} ended"),
    }
}

/// Writes what the search has found before the statistics, which may take long. What cannot be
/// written now is reported when all is written.
fn write_quietly(session: &mut Session, folder: &Path, solution: &Solution, seconds: f64) {
    for (name, text) in files_of(session, solution, seconds) {
        let _ = session.world.write_file(&folder.join(name), text.as_bytes());
    }
}

/// Removes the checkpoint of a run that came to its end.
fn close(session: &mut Session, (checkpoint, folder): (&Checkpoint, &Path), is_interrupted: bool) {
    if let Some(why) = checkpoint.broken() {
        session.report_fault(fault!(BAD_OPTION, "the checkpoint could not be written: {why}"));
    }
    if is_interrupted {
        session.print("\n  resume the run from here with --resume\n");
        return;
    }
    discard(session, checkpoint.path());
    // Those of an earlier run that made more searches, too.
    for number in 2.. {
        let journal = searches::journal(folder, number);
        if !session.world.exists(&journal) {
            break;
        }
        discard(session, &journal);
    }
}

/// The sensitivity analysis that was asked for, printed and written.
fn analysed(
    session: &mut Session,
    run: &Run,
    folder: &Path,
    options: &RunOptions,
) -> Result<Option<Importance>, Fault> {
    let Some(name) = &options.sensitivity else { return Ok(None) };
    let analysis = solving::analysis(name)?;
    let found = analysis.importance(&run.problem, &run.evaluation, options.samples)?;
    if session.world.is_interrupted() {
        session.print(
            "\nThe sensitivity analysis was not made: the run was stopped before it ended.\n",
        );
        return Ok(None);
    }
    let Some(found) = found else {
        session.print("\nOther shards compute the rest of the sensitivity analysis.\n");
        return Ok(None);
    };
    session.print(&found.text());
    session.world.write_safely(&folder.join("sensitivity.csv"), found.csv().as_bytes())?;
    Ok(Some(found))
}

/// What a simulation for the report may take once the user has stopped the run.
fn hurry(session: &Session) -> Option<TimeBudget> {
    let clock = session.world.clock().filter(|_| session.world.is_interrupted())?;
    Some(TimeBudget { seconds: HURRY, clock })
}

/// The experiments kept for validation, at the best values; `hurry`: what each may take.
fn validated(
    run: &Run,
    validation: &[(solving::Experiment, Vec<solving::Series>)],
    hurry: Option<TimeBudget>,
) -> Result<Vec<SolvedSeries>, Fault> {
    let Some(best) = &run.observed.best else { return Ok(Vec::new()) };
    let mut solved = Vec::new();
    for (experiment, series) in validation {
        let mut experiment = experiment.clone();
        if hurry.is_some() {
            experiment.settings.time_budget = hurry;
        }
        let mut simulator = ModelSimulator::new(std::slice::from_ref(&experiment))?;
        let mut row = vec![f64::NAN; series.iter().map(|series| series.x.len()).sum()];
        // A simulation that fails shows as NaN; that is the result of the validation.
        if simulator.simulate(&best.values, &mut row).is_err() && hurry.is_some() {
            continue;
        }
        let mut rest = row.as_slice();
        for series in series {
            let (own, others) = rest.split_at(series.x.len());
            if series.is_data() {
                let mut own = own.to_vec();
                run.evaluation.scale_as_fitted(&best.values, series, &mut own);
                solved.push(SolvedSeries::new(series, &own));
            }
            rest = others;
        }
    }
    Ok(solved)
}

/// What a run took, and in a job of several ranks what their messages took.
fn timing(seconds: f64, ranks: Option<Arc<Ranks>>) -> String {
    let mut text = format!("{{\n  \"wall_seconds\": {seconds:.3}");
    if let Some((ranks, traffic)) = ranks.and_then(|ranks| Some((ranks.size(), ranks.traffic()?))) {
        let Traffic { message, handling, chunks, simulations } = traffic;
        text += &format!(
            ",\n  \"ranks\": {ranks},\n  \"messages\": {chunks},\n  \"distributed_simulations\": \
             {simulations},\n  \"message_seconds\": {message:.2e},\n  \"handling_seconds\": \
             {handling:.2e}"
        );
    }
    text + "\n}\n"
}

/// Writes the files of a solution. What differs between equal runs, the time, is in a separate
/// file.
pub(super) fn write(
    session: &mut Session,
    folder: &Path,
    solution: &Solution,
    seconds: f64,
) -> Result<(), Fault> {
    let files = files_of(session, solution, seconds);
    for name in OPTIONAL.iter().filter(|name| !files.iter().any(|(own, _)| own == *name)) {
        discard(session, &folder.join(name));
    }
    // What can be written is: one file that is too large must not take the others with it.
    let (mut missing, mut why) = (Vec::new(), None);
    for (name, text) in files {
        if let Err(fault) = session.world.write_safely(&folder.join(&name), text.as_bytes()) {
            missing.push(name);
            why.get_or_insert(fault);
        }
    }
    match why {
        None => {
            let here = session.world.current_dir();
            let shown = folder.strip_prefix(&here).unwrap_or(folder).display().to_string();
            let text = format!("\n  written to {shown}\n");
            session.print_report(&text, &text, "");
        }
        Some(mut fault) => {
            let (missing, folder) = (missing.join(", "), folder.display());
            fault.message =
                format!("{missing} could not be written to `{folder}`: {}", fault.message);
            return Err(fault.help(
                "free disk space or choose another folder with `--out`; the results of the run \
                 are shown above",
            ));
        }
    }
    Ok(())
}

/// The files of a solution with their names.
fn files_of(session: &Session, solution: &Solution, seconds: f64) -> Vec<(String, String)> {
    let mut files: Vec<(String, String)> = [
        ("result.json", solution.to_json()),
        ("history.csv", solution.history_csv()),
        ("fit.csv", solution.fit_csv()),
        ("individuals.csv", solution.individuals_csv()),
        ("report.html", solution.html()),
        ("convergence.svg", solution.convergence_figure().svg()),
        ("timing.json", timing(seconds, session.world.ranks())),
    ]
    .map(|(name, text)| (name.to_owned(), text))
    .into();
    files.push(("parameters.ssv".to_owned(), parameter_set(solution).to_xml()));
    // A unit is not a class that others could extend.
    if !is_unit(Path::new(&solution.subject.model)) {
        files.push(("Calibrated.mo".to_owned(), solution.modelica()));
        files.push(("calibrated.mos".to_owned(), solution.script()));
    }
    files.extend(solution.fit_figures().into_iter().map(|(name, figure)| (name, figure.svg())));
    files
        .extend(solution.inferred.tables().into_iter().map(|(name, text)| (name.to_owned(), text)));
    if solution.profiles.is_some() {
        files.push(("profiles.csv".to_owned(), solution.profiles_csv()));
    }
    if !solution.outcome.searches.is_empty() {
        files.push(("searches.csv".to_owned(), solution.searches_csv()));
    }
    files
}

/// The estimates that all experiments share, with their intervals, as a file of SSP.
fn parameter_set(solution: &Solution) -> ParameterSet {
    let shared = solution.parameters.iter().filter(|own| !own.name.contains('@'));
    let parameter = |own: &SolvedParameter| Parameter {
        name: own.name.clone(),
        value: ParameterValue::Number(own.value),
        unit: Some(own.unit.clone()).filter(|unit| !unit.is_empty()),
        estimate: (own.interval.is_some() || own.deviation.is_some())
            .then_some(Estimate { interval: own.interval, deviation: own.deviation }),
    };
    let name = solution.subject.title.clone();
    let parameters = shared.map(parameter).collect();
    ParameterSet { name, parameters, ..ParameterSet::default() }
}

#[cfg(test)]
mod tests;
