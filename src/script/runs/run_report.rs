//! The report of an identification by a script: when its outermost script ends, or data are read that
//! begin another run.

use super::identification::{Identification, Prepared};
use crate::diag::{Diagnostic, Fault};
use crate::ga::errors::BAD_POPULATION;
use crate::identify::problem::{
    Finding, FindingKind, NOISE_OF_FORMULAS, ScriptError, Severity, Solution,
};
use crate::identify::{Ending, Measurement, Recorder};
use crate::models::data_notes::DataNotes;
use crate::source::Span;
use crate::{Reporting, Session};

impl Session {
    /// The identification of this session; its report is made when the outermost script ends.
    pub(crate) fn identification(&mut self) -> &mut Identification {
        let now = self.world.monotonic_seconds();
        self.at_end(report);
        let identification = self.extension::<Identification>();
        identification.started.get_or_insert(now);
        identification
    }

    /// Notes measured data. Data read after generations have been evaluated begin another run: the
    /// one before is reported.
    pub(crate) fn measured(&mut self, measurement: Measurement) -> Result<(), Fault> {
        if !self.identification().recorder.observed.history.generations.is_empty() {
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
    report_run(session).map_err(|fault| fault.at(Span::NONE))
}

/// The report of a run: the table for people, and the files for programs. Nothing when no
/// individual was simulated successfully.
fn report_run(session: &mut Session) -> Result<(), Fault> {
    let interrupted = session.is_interrupted();
    let error = session.unhandled_error();
    let (processors, probe) = (session.world.processors(), session.options.probe);
    let identification = session.extension::<Identification>();
    let started = identification.started.take();
    let recorder = identification.recorder.begin_next();
    session.show_end(&recorder);
    session.report_if_all_failed(&recorder, interrupted);
    if session.options.reporting == Reporting::Off {
        session.world.end_view();
        return Ok(());
    }
    let Some(best) = recorder.best() else {
        note_unknown_best(session, &recorder);
        return Ok(());
    };
    let identification = session.extension::<Identification>();
    let mut noise = NOISE_OF_FORMULAS;
    let mut models = Vec::new();
    for compared in best.compared {
        let own = |prepared: &&mut Prepared| {
            prepared.evaluator.study() == &compared.study && prepared.evaluator.x() == compared.x
        };
        let own = identification.prepared.iter_mut().rev().find(own);
        models.push(own.map(|own| {
            noise = noise.max(own.evaluator.noise());
            own.evaluator.model().clone()
        }));
    }
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
        Ending { recorder: &recorder, models, noise, processors, probe, interrupted, error };
    let Some(mut solution) = ending.solution() else { return Ok(()) };
    session.world.end_view();
    for (measured, study, is_relative) in compared {
        session.compared(&measured, &study.model, (&study.y, is_relative));
    }
    let notes = session.extension::<DataNotes>().take();
    solution.findings.extend(notes.iter().cloned().map(about_data));
    let now = session.world.monotonic_seconds();
    let seconds = now - started.unwrap_or(now);
    let said = if session.world.is_one_screen() { notes } else { Vec::new() };
    let timed = |text: String| format!("{text}  {:<12} {seconds:.2} s\n", "time");
    let [shown, whole] = [solution.text_after(&said), solution.text()].map(timed);
    session.print_report(&shown, &whole, &solution.brief());
    write_files(session, &solution, seconds)
}

/// Says why a run that has simulated generations has no report: its best individual is not known.
fn note_unknown_best(session: &mut Session, recorder: &Recorder) {
    let simulated = recorder.evaluations - recorder.observed.failures;
    if recorder.evolves && simulated > 0 && !session.is_interrupted() {
        let text = format!(
            "there is no report of {simulated} simulations: the individuals that were sorted are not \
             those that `Eval` has simulated, and their fitness is not the sum of squares of these; \
             sort what is simulated, in its order"
        );
        session.note(BAD_POPULATION, text);
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
