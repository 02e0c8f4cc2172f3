//! Identification as scripts do it: what a session knows of the run, the measured data, and the
//! evaluators of models.

use super::problem::fault_codes;
use crate::Session;
use crate::builtins::Failure;
use crate::diag::Fault;
use crate::ga::Genomes;
use crate::identify::errors::{BAD_DATA, DATA_SIZES_DIFFER};
use crate::identify::problem::Fingerprint;
use crate::identify::{
    CompiledModel, Evaluator, Measurement, Model as _, Quantity, Question, Recorder, Study,
};
use crate::models::data_notes::DataNotes;
use crate::models::in_use::InUse;
use crate::models::translated::Translated;
use crate::models::uses::Uses;
use crate::models::{simulation, static_curve};
use crate::{bail, mat, results};
use rustc_hash::FxHashMap;
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
    pub(super) prepared: Vec<Prepared>,
    /// What was viewed last.
    pub(super) shown: Option<Shown>,
    /// How often models of these names were found changed.
    changed_models: FxHashMap<String, u32>,
    /// When the run began.
    pub(super) started: Option<f64>,
    /// Whether measured data could not be read.
    pub(crate) data_missing: bool,
    /// Whether it was reported that nothing can be simulated.
    pub(super) is_hopeless: bool,
    /// Runs reported so far.
    pub(super) reported: usize,
    /// The number of the first message of this run.
    pub(super) first_message: usize,
}

/// What was viewed of a search.
pub(super) struct Shown {
    pub(super) study: Study,
    pub(super) x: Vec<f64>,
    pub(super) genomes: Genomes,
    /// How many generations there will be; 0 where not known.
    pub(super) generations: u64,
}

/// An evaluator that is ready for the next population.
pub(super) struct Prepared {
    /// With the model as it was in use.
    pub(super) request: Request,
    /// What its model depends on.
    uses: Uses,
    /// Whether the model was found changed since: it answers no request any more, but is reported.
    is_outdated: bool,
    /// The class that is simulated, which may be one around the model.
    class: String,
    pub(super) evaluator: Evaluator,
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
        let count = x.len();
        let pairs = x.into_iter().zip(y).filter(|(x, y)| x.is_finite() && y.is_finite());
        let (x, y): (Vec<f64>, Vec<f64>) = pairs.unzip();
        if x.is_empty() && count > 0 {
            bail!(
                BAD_DATA,
                "of the {count} rows of `{}` and `{}` in `{file}`, none has two finite numbers",
                names[0], names[1];
                help: "check the names of the matrices, and the file for missing values"
            );
        }
        if x.is_empty() {
            bail!(BAD_DATA, "`{}` of `{file}` has no elements", names[0]);
        }
        self.extension::<DataNotes>().begin_measurement();
        self.note_data(&content, notes);
        for ((name, unit), values) in names.iter().zip(&units).zip([&x, &y]) {
            self.column_measured((file, name), unit.as_deref(), values);
        }
        Ok(Measurement { file: file.to_owned(), x, y })
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

    /// Loads the file or folder that the model of a request is in, unless its classes are those that
    /// are loaded.
    pub(super) fn load_model_of(&mut self, request: &Request) -> Result<(), Failure> {
        match request.path.is_empty() {
            true => Ok(()),
            false => Ok(self.load_path_once(Path::new(&request.path))?),
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

    pub(super) fn prepare(
        &mut self,
        request: &Request,
        in_use: &InUse,
    ) -> Result<Prepared, Failure> {
        let request = Request { model: in_use.shown.clone(), ..request.clone() };
        let (translated, is_driven) = self.translated_for(&request, in_use)?;
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
            self.extension::<Identification>().recorder.measured_over(&question.x, &x);
            question.x = x;
        }
        let processors = self.world.processors();
        let changes = &self.extension::<Identification>().changed_models;
        let changes = changes.get(&request.model).copied().unwrap_or(0);
        let evaluator =
            Evaluator::on(Arc::new(model), question, &processors)?.of_changed_model(changes);
        self.note_idle_ranks(evaluator.alone());
        let roots = static_curve::without_class_around(&translated.roots);
        let (uses, class) = (self.uses_of(&roots, &translated.files), translated.problem.clone());
        Ok(Prepared { request, uses, is_outdated: false, class, evaluator })
    }

    /// The evaluator of this request, if it is at hand and neither the classes of its model, the files
    /// that it reads nor what was set by hand have changed since.
    pub(super) fn take_prepared(&mut self, request: &Request, in_use: &InUse) -> Option<Prepared> {
        let is_it = |known: &Prepared| {
            !known.is_outdated
                && known.request.model == in_use.shown
                && known.request.path == request.path
                && known.request.question == request.question
        };
        let prepared = &mut self.extension::<Identification>().prepared;
        if let Some(place) = prepared.iter().position(is_it) {
            let known = prepared.remove(place);
            if self.is_unchanged(&known.uses) {
                return Some(known);
            }
            let identification = self.extension::<Identification>();
            *identification.changed_models.entry(known.request.model.clone()).or_insert(0) += 1;
            identification.prepared.insert(place, Prepared { is_outdated: true, ..known });
        }
        let prepared = &mut self.extension::<Identification>().prepared;
        if prepared.len() >= PREPARED {
            prepared.remove(0);
        }
        None
    }

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
        self.extension::<Identification>().prepared.last().map(|prepared| prepared.class.clone())
    }
}
