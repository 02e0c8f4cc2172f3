//! Identification as scripts do it: the measured data, the evaluation of populations, and the
//! report at the end of a run.

use super::problem::fault_codes;
use super::tracing;
use crate::builtins::Failure;
use crate::diag::{Code, Diagnostic, Fault};
use crate::errors::INTERRUPTED;
use crate::ga::Genomes;
use crate::identify::errors::{BAD_DATA, DATA_SIZES_DIFFER, RANKS_IDLE};
use crate::identify::problem::{
    Finding, FindingKind, Fingerprint, NOISE_OF_FORMULAS, ScriptError, Severity, Solution,
};
use crate::identify::{
    CompiledModel, Ending, Evaluator, Measurement, Model as _, Quantity, Question, Recorder,
    Simulated, Study,
};
use crate::models::in_use::InUse;
use crate::models::translated::Translated;
use crate::models::uses::Uses;
use crate::models::{simulation, static_curve};
use crate::registry::BAD_OPTION;
use crate::source::Span;
use crate::{Reporting, Session};
use crate::{bail, mat, results};
use std::path::Path;
use std::sync::Arc;

/// Evaluators kept: a script may simulate several experiments in each generation.
const PREPARED: usize = 40;

/// What a session knows of the identification that its scripts carry out.
#[derive(Default)]
pub(crate) struct Identification {
    /// What was observed of the run.
    pub(crate) recorder: Recorder,
    /// The evaluators of the last requests, for the next generation; the latest is the last.
    prepared: Vec<Prepared>,
    /// What was viewed last: model, individuals, and how many generations there will be.
    pub(super) shown: Option<(Study, Genomes, u64)>,
    /// When the run began.
    started: Option<f64>,
    /// Whether measured data could not be read.
    pub(crate) data_missing: bool,
    /// Whether it was reported that nothing can be simulated.
    pub(super) is_hopeless: bool,
    /// Runs reported so far.
    reported: usize,
    /// The number of the first message of this run.
    first_message: usize,
    /// What was said of the data of this run.
    data_notes: Vec<String>,
    /// How many of these are older than the measurement read last.
    older_notes: usize,
}

/// An evaluator that is ready for the next population.
struct Prepared {
    /// With the model as it was in use.
    request: Request,
    /// What its model depends on.
    uses: Uses,
    /// The class that is simulated, which may be one around the model.
    class: String,
    evaluator: Evaluator,
}

/// The arguments of `Eval` but for the population.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Request {
    /// Where the model is; empty when it is loaded.
    pub(crate) path: String,
    /// Its name, with a modification if given.
    pub(crate) model: String,
    /// What varies and what is compared.
    pub(crate) question: Question,
}

impl Session {
    /// The identification of this session; its report is made when the outermost script ends.
    pub(crate) fn identification(&mut self) -> &mut Identification {
        let now = self.world.monotonic_seconds();
        self.at_end(report);
        let identification = self.extension::<Identification>();
        identification.started.get_or_insert(now);
        identification
    }

    /// Reads the matrices `names` of X and Y from a file.
    pub(crate) fn read_measurement(
        &mut self,
        file: &str,
        names: &[String; 2],
    ) -> Result<Measurement, Fault> {
        let content = results::read_data(file, &self.world.read_bytes(Path::new(file))?)?;
        let [x, y] = [content.column(&names[0])?, content.column(&names[1])?];
        let notes = [&x, &y].into_iter().flat_map(crate::mat::Column::notes);
        let mut notes: Vec<String> = notes.collect();
        notes.extend(fault_codes::codes(&names[1], &y));
        notes.extend(fault_codes::cut_off(&names[1], &y));
        let units = [x.about.unit, y.about.unit];
        let [x, y] = [x.values, y.values];
        if x.len() != y.len() {
            bail!(
                DATA_SIZES_DIFFER,
                "`{}` of `{file}` has {} elements, but `{}` has {}",
                names[0],
                x.len(),
                names[1],
                y.len();
                help: "give the names of two matrices of the same experiment"
            );
        }
        let pairs = x.into_iter().zip(y).filter(|(x, y)| x.is_finite() && y.is_finite());
        let (x, y): (Vec<f64>, Vec<f64>) = pairs.unzip();
        if x.is_empty() {
            bail!(BAD_DATA, "`{}` of `{file}` has no elements", names[0]);
        }
        let identification = self.extension::<Identification>();
        identification.older_notes = identification.data_notes.len();
        self.note_data(&content, notes);
        for ((name, unit), values) in names.iter().zip(&units).zip([&x, &y]) {
            self.column_measured((file, name), unit.as_deref(), values);
        }
        Ok(Measurement { file: file.to_owned(), x, y })
    }

    /// Says something about the data that a script compares its models with: now and in the report.
    pub(crate) fn note_about_data(&mut self, code: Code, sentence: String) {
        let notes = &mut self.extension::<Identification>().data_notes;
        if !notes.contains(&sentence) {
            notes.push(sentence.clone());
        }
        self.note(code, sentence);
    }

    /// A number for the place in the scripts that a command was called from: the same whenever the
    /// script is read again.
    pub(crate) fn site_of_call(&self) -> u64 {
        let span = self.call_site();
        let mut site = Fingerprint::default();
        if let Some(source) = self.sources.get(span.source) {
            site.add(source.name.as_bytes());
        }
        site.add(&span.start.to_le_bytes());
        site.number()
    }

    /// Notes measured data. Data read after generations have been evaluated begin another run: the
    /// one before is reported.
    pub(crate) fn measured(&mut self, measurement: Measurement) -> Result<(), Fault> {
        if !self.identification().recorder.observed.history.generations.is_empty() {
            let identification = self.identification();
            let own = identification.data_notes.split_off(identification.older_notes);
            report_run(self)?;
            self.identification().data_notes = own;
        }
        let identification = self.identification();
        identification.recorder.measured(measurement);
        identification.data_missing = false;
        Ok(())
    }

    /// Simulates a population, whose individuals have numbers from the second value on; the evaluator
    /// is kept for the next one.
    pub(crate) fn evaluate_population(
        &mut self,
        request: Request,
        genomes: &Genomes,
    ) -> Result<(Simulated, u64), Failure> {
        let mut prepared = match self.take_prepared(&request)? {
            Some(prepared) => prepared,
            None => self.prepare(&request)?,
        };
        // From here on it is a request for the model with what was set by hand.
        let request = prepared.request.clone();
        let evaluator = &mut prepared.evaluator;
        let simulated = match self.journaled(&request, &evaluator.settings_text(), genomes)? {
            Some(known) => {
                if self.is_to_be_checked() {
                    check(evaluator, genomes, &known).inspect_err(|_| self.refuse_to_resume())?;
                }
                known
            }
            None => {
                evaluator.cancel_by(self.world.interrupt_flag());
                let simulated = evaluator.evaluate(genomes)?;
                if evaluator.is_cancelled() {
                    // The population is simulated again when the run is resumed.
                    return Err(Fault::new(INTERRUPTED, "interrupted").into());
                }
                self.journal(&request, &evaluator.settings_text(), genomes, &simulated);
                simulated
            }
        };
        let identification = self.identification();
        let recorder = &mut identification.recorder;
        let first = recorder.evaluated(evaluator.study(), evaluator.x(), genomes, &simulated);
        let (study, x) = (evaluator.study().clone(), evaluator.x().to_vec());
        let is_relative = evaluator.model().is_relative(&study.y.name);
        identification.prepared.push(prepared);
        let individuals = first..first + genomes.len() as u64;
        self.population_simulated(&study, individuals, is_relative);
        self.trace_simulation((&study, &x), genomes, &simulated)?;
        self.show_run(&study, genomes);
        self.stop_if_all_fail((&study, &x), genomes, &simulated)?;
        Ok((simulated, first))
    }

    /// Simulates one individual once more, with the model and at the points of the last `Eval`: Y
    /// there, or why there is none. Nothing of it is counted or recorded.
    pub fn simulate_again(&mut self, genes: &[f64]) -> Result<Vec<f64>, String> {
        let Some(last) = self.extension::<Identification>().prepared.last_mut() else {
            return Err("no model has been simulated".to_owned());
        };
        let genomes = Genomes::new(genes.len(), genes.to_vec()).map_err(|fault| fault.message)?;
        let simulated = last.evaluator.evaluate(&genomes).map_err(|fault| fault.message)?;
        match simulated.failures.first() {
            Some(Some(failed)) => Err(failed.to_string()),
            _ => Ok(simulated.rows),
        }
    }

    fn trace_simulation(
        &mut self,
        (study, x): (&Study, &[f64]),
        genomes: &Genomes,
        simulated: &Simulated,
    ) -> Result<(), Fault> {
        self.traced(|tracer, place| {
            let failed = simulated.failures.iter().enumerate();
            let failures =
                failed.filter_map(|(k, why)| Some((k as u32, why.as_ref()?.to_string())));
            let subject = tracing::subject(study);
            tracer.simulated(place, (&subject, x), genomes.values(), failures.collect());
        })
    }

    /// Loads the file or folder that the model of a request is in.
    pub(super) fn load_model_of(&mut self, request: &Request) -> Result<(), Failure> {
        let path = Path::new(&request.path);
        if !request.path.is_empty() && !self.has_loaded(path) {
            self.load_path(path)?;
        }
        Ok(())
    }

    /// Says why other ranks take no part, if that is so.
    pub(super) fn note_idle_ranks(&mut self, reason: Option<&str>) {
        if let Some(reason) = reason {
            let text = format!("the other ranks take no part in the simulations, because {reason}");
            self.note(RANKS_IDLE, text);
        }
    }

    /// Measured X in the unit of the model; `None` where they are in it.
    fn x_in_unit_of(&mut self, question: &Question, model: &CompiledModel) -> Option<Vec<f64>> {
        let name = question.x_name.clone();
        let unit = match name.as_str() {
            "" | "time" => "s".to_owned(),
            name => model.unit(name)?,
        };
        let is_relative = model.is_relative(&name);
        let quantity = Quantity { name, unit };
        self.in_unit_of(&question.x, model.name(), (&quantity, is_relative))
    }

    /// Measured values in the unit of the variable that a request compares them with.
    pub(super) fn measured_in_unit_of(
        &mut self,
        request: &Request,
        measured: &[f64],
    ) -> Result<Option<Vec<f64>>, Failure> {
        let prepared = match self.take_prepared(request)? {
            Some(prepared) => prepared,
            None => self.prepare(request)?,
        };
        let study = prepared.evaluator.study().clone();
        let is_relative = prepared.evaluator.model().is_relative(&study.y.name);
        self.identification().prepared.push(prepared);
        Ok(self.in_unit_of(measured, &study.model, (&study.y, is_relative)))
    }

    /// Refuses times that count from a date, and notes those that begin far after the simulation.
    fn check_times(&mut self, question: &Question, model: &CompiledModel) -> Result<(), Fault> {
        let Question { x_name, x, .. } = question;
        let low = x.iter().copied().fold(f64::INFINITY, f64::min);
        let high = x.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        let start = model.settings().start;
        if !(x_name.is_empty() || x_name == "time") || start > low / 2.0 || low >= high {
            return Ok(());
        }
        let calendar = mat::calendar(x);
        if let Some(calendar) = calendar.filter(|calendar| calendar.is_certain) {
            bail!(
                BAD_DATA,
                "the measured times begin at {low}: these are {}, but the simulation begins at \
                 {start} s", calendar.name;
                help: "count the times from the first one, in seconds, as in `Xexp := (Xexp .- \
                       Xexp[1])*{}`", calendar.seconds
            );
        }
        let stamps = x.chunk_by(|a, b| a == b);
        let (pairs, others): (Vec<&[f64]>, Vec<&[f64]>) = stamps.partition(|own| own.len() > 1);
        if let Some(pair) = pairs.first().filter(|_| !others.is_empty()) {
            self.note_about_data(mat::errors::DATA_NOTE, format!(
                "time stamps such as {} are in several consecutive rows: all are kept; the first is \
                 compared with the value just before a jump at that time, the others with the value \
                 just after it; if a row was recorded twice, remove one",
                pair[0]
            ));
        }
        if low - start > high - low {
            let days = calendar.map_or(String::new(), |days| {
                let mat::Calendar { name, seconds, .. } = days;
                format!("; if they are {name}, write `Xexp := (Xexp .- Xexp[1])*{seconds}`")
            });
            self.note_about_data(mat::errors::DATA_NOTE, format!(
                "the measured times begin at {low} s and last {} s, but the simulation begins at \
                 {start} s; if the initial values are those of {low} s, give the model \
                 `annotation(experiment(StartTime = {low}))`, or count the times from the first one{days}",
                high - low
            ));
        }
        Ok(())
    }

    fn prepare(&mut self, request: &Request) -> Result<Prepared, Failure> {
        self.load_model_of(request)?;
        let in_use = self.in_use(&request.model, &request.question.parameters)?;
        let request = Request { model: in_use.shown.clone(), ..request.clone() };
        let (translated, is_driven) = self.translated_for(&request, &in_use)?;
        let model = match is_driven {
            true => static_curve::model(&request.model, &translated, &request.question.x_name)?,
            false => CompiledModel::new(&request.model, translated.program.clone()),
        };
        let mut values = Vec::new();
        for (name, value) in in_use.values() {
            values.push((translated.program.find_parameter(name)?, value));
        }
        let model = model.with_values(values);
        let mut question = request.question.clone();
        self.check_times(&question, &model)?;
        if let Some(x) = self.x_in_unit_of(&question, &model) {
            self.identification().recorder.measured_over(&question.x, &x);
            question.x = x;
        }
        let processors = self.world.processors();
        let evaluator = Evaluator::on(Arc::new(model), question, &processors)?;
        self.note_idle_ranks(evaluator.alone());
        let roots = static_curve::without_class_around(&translated.roots);
        let (uses, class) = (self.classes.sources.uses(&roots), translated.problem.clone());
        Ok(Prepared { request, uses, class, evaluator })
    }

    /// The evaluator of this request, if it is at hand and neither the classes of its model nor what
    /// was set by hand have changed since.
    fn take_prepared(&mut self, request: &Request) -> Result<Option<Prepared>, Failure> {
        let in_use = self.in_use(&request.model, &request.question.parameters)?;
        let is_it = |known: &Prepared| {
            known.request.model == in_use.shown
                && known.request.path == request.path
                && known.request.question == request.question
        };
        let prepared = &mut self.identification().prepared;
        if let Some(place) = prepared.iter().position(is_it) {
            let known = prepared.remove(place);
            return Ok(self.classes.sources.are_unchanged(&known.uses).then_some(known));
        }
        if prepared.len() >= PREPARED {
            prepared.remove(0);
        }
        Ok(None)
    }
}

/// The first individual, which is the best where elites are kept, and another one are computed
/// again: if a bit differs, the earlier run was that of another model.
fn check(evaluator: &mut Evaluator, genomes: &Genomes, known: &Simulated) -> Result<(), Failure> {
    let mut site = Fingerprint::default();
    site.add_numbers(genomes.values());
    let rows = [0, site.number() as usize % genomes.len().max(1)];
    let points = known.rows.len() / genomes.len().max(1);
    for row in rows.into_iter().filter(|row| *row < genomes.len()) {
        let one = Genomes::new(genomes.row(row).len(), genomes.row(row).to_vec())?;
        let now = evaluator.evaluate(&one)?;
        let before = &known.rows[row * points..(row + 1) * points];
        let differs =
            |(a, b): (&f64, &f64)| a.to_bits() != b.to_bits() && !(a.is_nan() && b.is_nan());
        if before.len() != now.rows.len() || before.iter().zip(&now.rows).any(differs) {
            bail!(
                BAD_OPTION,
                "the run cannot be resumed: individual {} now gives a different simulation \
                 result", row + 1;
                help: "restore the model, its libraries and tables, the settings of the \
                       simulation, the program and the machine, or start again without `--resume`"
            );
        }
    }
    Ok(())
}

impl Session {
    /// The model of a request; where X is an input of it, one that is driven by the points.
    fn translated_for(
        &mut self,
        request: &Request,
        in_use: &InUse,
    ) -> Result<(Arc<Translated>, bool), Failure> {
        let Question { x_name, x, .. } = &request.question;
        let is_driven = static_curve::is_driven(self, &in_use.problem, x_name)?;
        let class = match is_driven {
            true => {
                static_curve::around(self, &in_use.problem, (x_name, static_curve::typical(x)))?
            }
            false => in_use.problem.clone(),
        };
        Ok((simulation::translated(self, &class)?, is_driven))
    }

    /// The class of the last `Eval`.
    pub(super) fn class_evaluated(&mut self) -> Option<String> {
        self.identification().prepared.last().map(|prepared| prepared.class.clone())
    }
}

impl Session {
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
    let identification = session.extension::<Identification>();
    let Some(best) = recorder.best() else { return Ok(()) };
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
    let notes = std::mem::take(&mut session.extension::<Identification>().data_notes);
    solution.findings.extend(notes.iter().cloned().map(about_data));
    let now = session.world.monotonic_seconds();
    let seconds = now - started.unwrap_or(now);
    let said = if session.world.is_one_screen() { notes } else { Vec::new() };
    let timed = |text: String| format!("{text}  {:<12} {seconds:.2} s\n", "time");
    let [shown, whole] = [solution.text_after(&said), solution.text()].map(timed);
    session.print_report(&shown, &whole, &solution.brief());
    write_files(session, &solution, seconds)
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
