//! The reports of an identification by a script, one for each of its searches: when its outermost
//! script ends, or data are read that begin another run.

use super::identification::{Identification, Prepared};
use crate::diag::{Diagnostic, Fault};
use crate::ga::errors::BAD_POPULATION;
use crate::identify::errors::{EARLIER_RESULTS, SEVERAL_SEARCHES};
use crate::identify::problem::{
    Finding, FindingKind, NOISE_OF_FORMULAS, ScriptError, Severity, Solution,
};
use crate::identify::{Compared, Ending, Measurement, Model, ScriptSearch};
use crate::models::data_notes::DataNotes;
use crate::source::Span;
use crate::{Reporting, Session, fault};
use std::sync::Arc;

impl Session {
    /// The identification of this session; its report is made when the outermost script ends.
    pub(crate) fn identification(&mut self) -> &mut Identification {
        let now = self.world.monotonic_seconds();
        self.at_end(report);
        let identification = self.extension::<Identification>();
        identification.started.get_or_insert(now);
        identification
    }

    /// Notes measured data. Data read after several generations have been evaluated begin another run:
    /// the one before is reported.
    pub(crate) fn measured(&mut self, measurement: Measurement) -> Result<(), Fault> {
        if self.identification().recorder.begins_another_run() {
            let own = self.extension::<DataNotes>().split_off_measurement();
            report_run(self)?;
            self.extension::<DataNotes>().begin_run(own);
        }
        let identification = self.identification();
        identification.recorder.measured(measurement);
        identification.data_missing = false;
        Ok(())
    }

    /// The first error of the run that the script did not handle, at the statement that failed.
    fn unhandled_error(&mut self) -> Option<ScriptError> {
        let next = self.output.messages.next_number();
        let identification = self.extension::<Identification>();
        let from = std::mem::replace(&mut identification.first_message, next);
        let error = self.output.messages.first_unhandled(from)?;
        let calls = error.trace.iter().map(|frame| frame.span);
        let mut places = std::iter::once(error.span()).chain(calls);
        let name = |span: Span| self.sources.get(span.source).map(|source| source.name.clone());
        let is_script = |span: &Span| name(*span).is_some_and(|name| name.ends_with(".mos"));
        let span = places.find(is_script).unwrap_or_else(|| error.span());
        Some(ScriptError {
            file: name(span).as_deref().unwrap_or_default().to_owned(),
            line: self.sources.line_column(span).map_or(0, |place| place.line),
            message: error.message.clone(),
        })
    }
}

/// What remains to be done when the outermost script ends.
fn report(session: &mut Session) -> Result<(), Diagnostic> {
    report_run(session).map_err(|fault| fault.at(Span::NONE))?;
    if session.options.reporting != Reporting::Off {
        note_earlier_results(session);
    }
    Ok(())
}

/// The reports of a run, one of each of its searches: the table for people, and the files for
/// programs. Nothing of a search of which no individual was simulated successfully.
fn report_run(session: &mut Session) -> Result<(), Fault> {
    let interrupted = session.is_interrupted();
    let error = session.unhandled_error();
    let identification = session.extension::<Identification>();
    let started = identification.started.take();
    let searches = identification.recorder.begin_next();
    session.show_end(&searches);
    for search in &searches {
        session.report_if_all_failed((search, searches.len() == 1), interrupted);
    }
    if session.options.reporting == Reporting::Off {
        session.world.end_view();
        return Ok(());
    }
    let newest = searches.last().map_or(0, |search| search.generations_of_run[0]);
    let reported = reported(session, &searches);
    let before = session.world.monotonic_seconds() - started.unwrap_or_default();
    for number in reported {
        let search = &searches[number];
        let is_over = search.generations_of_run[1] < newest;
        let stopped = Stopped { interrupted, error: error.clone(), is_over };
        let seconds = if searches.len() == 1 { before } else { search.seconds };
        let number = [number + 1, searches.len()];
        report_search(session, (search, number), stopped, seconds)?;
    }
    session.extension::<DataNotes>().begin_run(Vec::new());
    session.world.end_view();
    Ok(())
}

/// What has stopped a run, if anything has.
struct Stopped {
    interrupted: bool,
    error: Option<ScriptError>,
    /// Whether the search had ended before.
    is_over: bool,
}

/// Searches of one run that have a report of their own; a script with more repeats a search for
/// samples, or compares other data in each generation.
const REPORTED: usize = 20;

/// The searches that are reported: the longest ones, and of equal ones the last.
fn reported(session: &mut Session, searches: &[ScriptSearch]) -> Vec<usize> {
    let mut longest: Vec<usize> = (0..searches.len()).collect();
    let generations = |k: usize| searches[k].observed.generations();
    longest.sort_by_key(|&k| (std::cmp::Reverse(generations(k)), std::cmp::Reverse(k)));
    longest.truncate(REPORTED);
    longest.sort_unstable();
    if searches.len() > REPORTED {
        let text = format!(
            "the script has compared {} different models or sets of measured points; {REPORTED} of \
             these searches are reported, those with the most generations and of these the last; \
             print what you need of the others",
            searches.len()
        );
        session.note(SEVERAL_SEARCHES, text);
    }
    longest
}

fn report_search(
    session: &mut Session,
    (search, number): (&ScriptSearch, [usize; 2]),
    Stopped { interrupted, error, is_over }: Stopped,
    seconds: f64,
) -> Result<(), Fault> {
    let began = session.world.monotonic_seconds();
    let Some(best) = search.best() else {
        note_unknown_best(session, search);
        return Ok(());
    };
    let (processors, probe) = (session.world.processors(), session.options.probe);
    let (models, noise) = models_of(session, best.compared);
    let compared: Vec<_> = best
        .compared
        .iter()
        .zip(&models)
        .filter_map(|(one, model)| {
            let study = one.study.clone();
            let is_relative = model.as_ref().is_some_and(|own| own.is_relative(&study.y.name));
            Some((one.measured.clone()?, study, is_relative))
        })
        .collect();
    let ending =
        Ending { number, search, models, noise, processors, probe, interrupted, is_over, error };
    let Some(mut solution) = ending.solution() else { return Ok(()) };
    session.world.end_view();
    for (measured, study, is_relative) in compared {
        session.compared(&measured, &study.model, (&study.y, is_relative));
    }
    let notes = session.extension::<DataNotes>().all().to_vec();
    solution.findings.extend(notes.iter().cloned().map(about_data));
    let seconds = seconds + session.world.monotonic_seconds() - began;
    let said = if session.world.is_one_screen() { notes } else { Vec::new() };
    let timed = |text: String| format!("{text}  {:<12} {seconds:.2} s\n", "time");
    let [shown, whole] = [solution.text_after(&said), solution.text()].map(timed);
    session.print_report(&shown, &whole, &solution.brief());
    write_files(session, &solution, seconds)
}

/// The models of these series, where they are at hand, and the largest relative error of their
/// simulations.
fn models_of(session: &mut Session, all: &[Compared]) -> (Vec<Option<Arc<dyn Model>>>, f64) {
    let prepared = &session.extension::<Identification>().prepared;
    let own = |compared: &Compared| {
        let is_its = |prepared: &&Prepared| {
            let evaluator = &prepared.evaluator;
            *evaluator.study() == compared.study && evaluator.x() == compared.x
        };
        prepared.iter().rev().find(is_its)
    };
    let found: Vec<Option<&Prepared>> = all.iter().map(own).collect();
    let noise = found.iter().flatten().map(|own| own.evaluator.noise());
    let noise = noise.fold(NOISE_OF_FORMULAS, f64::max);
    let model = |own: &Prepared| own.evaluator.model().clone();
    (found.iter().map(|own| own.map(model)).collect(), noise)
}

/// Says why a search that has simulated generations has no report: its best individual is not known.
fn note_unknown_best(session: &mut Session, search: &ScriptSearch) {
    let failures = &search.observed.failures;
    let simulated = search.evaluations - failures.count;
    if !search.evolves || simulated == 0 || session.is_interrupted() {
        return;
    }
    if search.observed.trace.iter().all(Vec::is_empty) {
        let cause = failures.main_cause().map_or(String::new(), |(cause, count)| {
            format!("; {count} simulations failed: {cause}")
        });
        let fault = fault!(
            BAD_POPULATION,
            "the search of {} has no result: all individuals have the fitness of a failed \
             simulation{cause}", search.models();
            help: "correct the model that fails, or omit it in the sum"
        );
        return session.report(fault.at(Span::NONE));
    }
    let text = format!(
        "there is no report of {simulated} simulations: the individuals that were sorted are not \
         those that `Eval` has simulated, and their fitness is not the sum of squares of these; \
         sort what is simulated, in its order"
    );
    session.note(BAD_POPULATION, text);
}

/// Says that the results of a further search are of an earlier run: they are not removed.
fn note_earlier_results(session: &mut Session) {
    let run = session.extension::<Identification>().reported;
    let folder = session.world.output_dir().join(format!("run-{}", run + 1));
    if run > 0 && session.world.exists(&folder.join("result.json")) {
        let text = format!("`{}` has results of an earlier run", folder.display());
        session.note(EARLIER_RESULTS, text);
    }
}

fn about_data(sentence: String) -> Finding {
    Finding::new(FindingKind::Data, sentence).severity(Severity::Information)
}

/// Writes the files of a run into the folder of the results; those of further runs of the session
/// into folders within it.
fn write_files(session: &mut Session, solution: &Solution, seconds: f64) -> Result<(), Fault> {
    let identification = session.extension::<Identification>();
    identification.reported += 1;
    let run = identification.reported;
    let mut folder = session.world.output_dir();
    if run > 1 {
        folder.push(format!("run-{run}"));
    }
    super::problem::write(session, &folder, solution, seconds)
}
