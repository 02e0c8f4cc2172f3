//! Identification as scripts do it: the measured data, the evaluation of populations, and the
//! report at the end of a run.

use super::builtins::Failure;
use super::{Session, simulation, static_curve, tracing};
use crate::bail;
use crate::diag::{Diagnostic, Fault};
use crate::ga::Genomes;
use crate::identify::errors::{BAD_DATA, DATA_SIZES_DIFFER};
use crate::identify::{
    CompiledModel, Evaluator, FitPoint, Measurement, Outcome, Question, Recorder, Simulated, Study,
    Uncertainty, deviations,
};
use crate::mat;
use crate::plot::{self, Comparison, Figure};
use crate::source::Span;
use std::path::Path;

/// What a session knows of the identification that its scripts carry out.
#[derive(Default)]
pub(super) struct Identification {
    /// What was observed of the run.
    pub(super) recorder: Recorder,
    /// The evaluator of the last request, for the next generation, and the revision of the classes
    /// that it was made from.
    prepared: Option<(Request, u64, Evaluator)>,
    /// When the run began.
    started: Option<f64>,
    /// Whether measured data could not be read.
    pub(super) data_missing: bool,
    /// Runs reported so far.
    reported: usize,
}

/// The arguments of `Eval` but for the population.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Request {
    /// Where the model is; empty when it is loaded.
    pub(super) path: String,
    /// Its name, with a modification if wanted.
    pub(super) model: String,
    /// What varies and what is compared.
    pub(super) question: Question,
}

impl Session {
    /// The identification of this session; its report is made when the outermost script ends.
    pub(super) fn identification(&mut self) -> &mut Identification {
        let now = self.world.monotonic_seconds();
        self.at_end(report);
        let identification = self.extension::<Identification>();
        identification.started.get_or_insert(now);
        identification
    }

    /// Reads the matrices `names` of X and Y from a file.
    pub(super) fn read_measurement(
        &mut self,
        file: &str,
        names: &[String; 2],
    ) -> Result<Measurement, Fault> {
        let content = mat::read_named(file, &self.read_bytes(Path::new(file))?)?;
        let [x, y] = [content.column(&names[0])?, content.column(&names[1])?];
        let notes = [&x, &y].into_iter().flat_map(|column| column.about.notes.clone());
        let notes: Vec<String> = notes.collect();
        let [x, y] = [x.values, y.values];
        if x.len() != y.len() {
            bail!(
                DATA_SIZES_DIFFER,
                "`{}` of `{file}` has {} elements, but `{}` has {}",
                names[0],
                x.len(),
                names[1],
                y.len();
                help: "name the two matrices of one experiment"
            );
        }
        let pairs = x.into_iter().zip(y).filter(|(x, y)| x.is_finite() && y.is_finite());
        let (x, y): (Vec<f64>, Vec<f64>) = pairs.unzip();
        if x.is_empty() {
            bail!(BAD_DATA, "`{}` of `{file}` has no elements", names[0]);
        }
        self.note_data(&content, notes);
        Ok(Measurement { file: file.to_owned(), x, y })
    }

    /// Notes measured data. Data read after generations have been evaluated begin another run: the
    /// one before is reported.
    pub(super) fn measured(&mut self, measurement: Measurement) -> Result<(), Fault> {
        if !self.identification().recorder.history.generations.is_empty() {
            report_run(self)?;
        }
        let identification = self.identification();
        identification.recorder.measured(measurement);
        identification.data_missing = false;
        Ok(())
    }

    /// Simulates a population; the evaluator is kept for the next one.
    pub(super) fn evaluate_population(
        &mut self,
        request: Request,
        genomes: &Genomes,
    ) -> Result<Simulated, Failure> {
        let revision = self.classes.revision();
        let mut evaluator = match self.identification().prepared.take() {
            Some((known, at, evaluator)) if known == request && at == revision => evaluator,
            _ => self.prepare(&request)?,
        };
        let simulated = match self.journaled(&request, genomes)? {
            Some(known) => known,
            None => {
                let simulated = evaluator.evaluate(genomes)?;
                self.journal(&request, genomes, &simulated);
                simulated
            }
        };
        // Loading the model may have changed the classes.
        let revision = self.classes.revision();
        let identification = self.identification();
        identification.recorder.evaluated(evaluator.study(), evaluator.x(), genomes, &simulated);
        let (study, x) = (evaluator.study().clone(), evaluator.x().to_vec());
        identification.prepared = Some((request, revision, evaluator));
        self.trace_simulation((&study, &x), genomes, &simulated)?;
        self.show_run(&study, genomes);
        Ok(simulated)
    }

    /// Simulates one individual once more, with the model and at the points of the last `Eval`: Y
    /// there, or why there is none. Nothing of it is counted or recorded.
    pub fn simulate_again(&mut self, genes: &[f64]) -> Result<Vec<f64>, String> {
        let Some((_, _, evaluator)) = &mut self.extension::<Identification>().prepared else {
            return Err("no model was simulated".to_owned());
        };
        let genomes = Genomes::new(genes.len(), genes.to_vec()).map_err(|fault| fault.message)?;
        let simulated = evaluator.evaluate(&genomes).map_err(|fault| fault.message)?;
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

    fn prepare(&mut self, request: &Request) -> Result<Evaluator, Failure> {
        self.load_model_of(request)?;
        let model = self.model_of(request)?;
        let threads = self.world.threads();
        Ok(Evaluator::new(&model, request.question.clone(), threads)?)
    }
}

impl Session {
    /// The model of a request; where X is an input of it, one that is driven by the points.
    fn model_of(&mut self, request: &Request) -> Result<CompiledModel, Failure> {
        let Question { x_name, x, .. } = &request.question;
        if static_curve::is_driven(self, &request.model, x_name)? {
            let typical = static_curve::typical(x);
            let class = static_curve::around(self, &request.model, (x_name, typical))?;
            let translated = simulation::translated(self, &class)?;
            return Ok(static_curve::model(&request.model, &translated, x_name)?);
        }
        let translated = simulation::translated(self, &request.model)?;
        Ok(CompiledModel::new(&request.model, translated.program.clone()))
    }
}

/// What remains to be done when the outermost script ends.
fn report(session: &mut Session) -> Result<(), Diagnostic> {
    report_run(session).map_err(|fault| fault.at(Span::NONE))
}

/// The report of a run: the table for people, and the files for programs. Nothing when no
/// individual was simulated successfully.
fn report_run(session: &mut Session) -> Result<(), Fault> {
    let seconds = session.world.monotonic_seconds();
    let interrupted = session.is_interrupted();
    let identification = session.extension::<Identification>();
    let started = identification.started.take().unwrap_or(seconds);
    let recorder = identification.recorder.begin_next();
    let evaluator = identification.prepared.as_mut().map(|(_, _, evaluator)| evaluator);
    let (uncertainty, evaluations) = what_the_data_tell(&recorder, evaluator);
    let Some(mut outcome) = Outcome::of(&recorder, uncertainty.as_ref(), evaluations) else {
        return Ok(());
    };
    outcome.interrupted = interrupted;
    outcome.wall_seconds = seconds - started;
    session.world.end_view();
    session.print(&outcome.table());
    write_files(session, &outcome)
}

fn what_the_data_tell(
    recorder: &Recorder,
    evaluator: Option<&mut Evaluator>,
) -> (Option<Uncertainty>, u64) {
    let (Some(best), Some(evaluator)) = (&recorder.best, evaluator) else { return (None, 0) };
    match recorder.measured_y() {
        Some(measured) if *evaluator.study() == best.study => {
            deviations(evaluator, best, measured).unwrap_or((None, 0))
        }
        _ => (None, 0),
    }
}

fn write_files(session: &mut Session, outcome: &Outcome) -> Result<(), Fault> {
    let identification = session.extension::<Identification>();
    identification.reported += 1;
    let run = identification.reported;
    let mut folder = session.world.output_dir();
    if run > 1 {
        folder.push(format!("run-{run}"));
    }
    let files = [
        ("result.json", outcome.to_json()),
        ("history.csv", outcome.history_csv()),
        ("fit.csv", outcome.fit_csv()),
        ("fit.svg", fit_figure(outcome).svg()),
        ("convergence.svg", convergence_figure(outcome).svg()),
    ];
    for (name, text) in files {
        session.write_file(&folder.join(name), text.as_bytes())?;
    }
    let place = format!("\n  written to {}\n", folder.display());
    session.print(&place);
    Ok(())
}

/// Measured and simulated points, and their residuals.
fn fit_figure(outcome: &Outcome) -> Figure {
    let column = |value: fn(&FitPoint) -> f64| outcome.fit.iter().map(value).collect::<Vec<f64>>();
    let [x, y] = &outcome.axes;
    plot::fit(&Comparison {
        title: &outcome.model,
        x_label: (&x.name, &x.unit),
        y_label: (&y.name, &y.unit),
        x: &column(|point| point.x),
        measured: &column(|point| point.measured),
        simulated: &column(|point| point.simulated),
        curve: (&[], &[]),
    })
}

fn convergence_figure(outcome: &Outcome) -> Figure {
    let best: Vec<f64> = outcome.history.iter().map(|generation| generation.best).collect();
    let mean: Vec<f64> = outcome.history.iter().map(|generation| generation.mean).collect();
    plot::convergence(&outcome.model, &best, &mean)
}
