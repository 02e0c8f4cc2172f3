//! One experiment of a problem: its data, the class around the model, the compiled model and the
//! settings of its simulation.

use super::data::{self, Notes};
use super::enclosing_class::{Base, EnclosingClass};
use super::file::{self, ColumnEntry, ExperimentEntry, ProblemFile};
use super::series::Comparison;
use super::{dynamics, enclosing_class, inputs, parameters};
use crate::codegen::Program;
use crate::diag::{Diagnostic, Fault};
use crate::flatten::FlatModel;
use crate::identify::problem::{Experiment, Free, Series};
use crate::identify::{CompiledModel, Model};
use crate::mat::{Column, MatFile};
use crate::registry::BAD_OPTION;
use crate::script::Session;
use crate::script::models::simulation::{self, SimulationOptions};
use crate::script::models::static_curve;
use crate::sim::{Settings, TimeBudget};
use crate::source::Span;
use crate::{bail, fault};
use std::fmt::Write;
use std::sync::Arc;

/// The solver's tolerance where the problem gives none, and the coarsest that an annotation of the
/// model may ask for: least squares need simulation errors that are small against the residuals. Six
/// of 13 published fits need a finer tolerance than 1e-4; 1e-9 itself was chosen, not measured.
const TOLERANCE: f64 = 1e-9;

/// An experiment that was read.
pub(super) struct Built {
    pub experiment: Experiment,
    pub series: Vec<Series>,
    /// Whether its model has states, so that its results have the error of an integrator.
    pub has_states: bool,
    /// Its compiled model.
    pub program: Arc<Program>,
}

/// What an experiment is read from.
pub(super) struct Source<'a> {
    pub file: &'a ProblemFile,
    pub entry: &'a ExperimentEntry,
    pub number: usize,
    pub table: &'a MatFile,
    pub free: &'a [Free],
}

/// The independent variable of an experiment.
struct Abscissa {
    entry: ColumnEntry,
    /// The variable.
    name: String,
    column: Column,
    /// Times of inputs that follow the rows.
    time: Vec<f64>,
}

/// The model of an experiment in its class.
struct Class {
    name: String,
    /// The free parameters with their names in the class.
    parameters: Vec<(usize, String)>,
    /// The names of the outputs in the class.
    observed: Vec<String>,
    /// Whether X is a parameter of the class.
    is_driven: bool,
}

/// The name of an experiment.
pub(super) fn label(entry: &ExperimentEntry, number: usize) -> String {
    entry.name.clone().unwrap_or_else(|| format!("experiment {}", number + 1))
}

fn one(fault: Fault) -> Vec<Diagnostic> {
    vec![fault.at(Span::NONE)]
}

impl Source<'_> {
    /// Reads the experiment.
    ///
    /// # Errors
    ///
    /// What is wrong with its data, its class or its settings.
    pub(super) fn build(
        &self,
        session: &mut Session,
        notes: &mut Notes,
    ) -> Result<Built, Vec<Diagnostic>> {
        let name = label(self.entry, self.number);
        let abscissa = self.abscissa(notes);
        let abscissa = abscissa.map_err(|fault| vec![fault.at(self.entry.places.x)])?;
        let class = self.class(session, &name, &abscissa, notes)?;
        let translated = simulation::translated(session, &class.name)?;
        let program = translated.program.clone();
        self.check(session, &abscissa.name, &class, &translated)?;
        parameters::note_computed(&class.parameters, &translated, notes);
        let compiled = match class.is_driven {
            true => {
                static_curve::model(&self.file.model, &translated, &abscissa.name).map_err(one)?
            }
            false => CompiledModel::new(&self.file.model, program.clone()),
        };
        let model: Arc<dyn Model> = Arc::new(compiled);
        let (entry, table) = (self.entry, self.table);
        let mut comparison = Comparison {
            experiment: &name,
            entry,
            table,
            model: &*model,
            x_name: &abscissa.name,
            x: Vec::new(),
        };
        let unit = comparison.unit(&abscissa.name);
        let about = (table, &mut *notes);
        let x = data::in_unit(&abscissa.column, &abscissa.name, &unit, &abscissa.entry, about);
        comparison.x = x.map_err(one)?.values;
        let settings = self.settings(session, &program, &abscissa.name, &comparison.x);
        let settings = settings.map_err(one)?;
        let (observations, series) =
            comparison.outputs(&class.observed, notes).map_err(|e| vec![e])?;
        if observations.is_empty() {
            return Err(one(fault!(BAD_OPTION, "{name} has no outputs to compare")));
        }
        let has_states = !program.sorted().states.is_empty();
        let experiment = Experiment {
            name,
            model,
            settings,
            second_attempt: true,
            x_name: abscissa.name,
            observations,
            parameters: class.parameters,
        };
        Ok(Built { experiment, series, has_states, program })
    }

    /// Refuses names that the model does not have, and values that it cannot be given.
    fn check(
        &self,
        session: &mut Session,
        x_name: &str,
        class: &Class,
        model: &simulation::Translated,
    ) -> Result<(), Vec<Diagnostic>> {
        let (file, places) = (self.file, &self.entry.places);
        let outputs = self.entry.outputs.keys().map(|name| (name.as_str(), places.column(name)));
        let names: Vec<(&str, Span)> = [(x_name, places.x)].into_iter().chain(outputs).collect();
        parameters::check_variables(&names, model).map_err(|error| vec![error])?;
        parameters::check_free(file, &class.parameters, model).map_err(|error| vec![error])?;
        parameters::check_initial(session, file, self.entry, model)
    }

    fn abscissa(&self, notes: &mut Notes) -> Result<Abscissa, Fault> {
        let (given, table) = (self.entry.x.as_ref(), self.table);
        let entry = given.map_or_else(|| ColumnEntry::named(None), file::Column::entry);
        let name = match &entry.variable {
            Some(variable) => variable.clone(),
            // A bare name is both the column and, where nothing else is said, the variable.
            None => entry.column.clone().unwrap_or_else(|| "time".to_owned()),
        };
        notes.about(table, if table.is_table() { table.warnings.clone() } else { Vec::new() });
        let column = data::column(table, &entry, &name, notes)?;
        notes.about(table, column.missing.clone());
        notes.about(table, column.order(entry.column.as_deref().unwrap_or(&name)));
        let time = data::as_time(&name, &column, &entry, (table, notes))?;
        Ok(Abscissa { entry, name, column, time })
    }

    /// The class around the model, loaded.
    fn class(
        &self,
        session: &mut Session,
        name: &str,
        x: &Abscissa,
        notes: &mut Notes,
    ) -> Result<Class, Vec<Diagnostic>> {
        let (file, entry) = (self.file, self.entry);
        let base = Base::of(&file.model, file.places.model).map_err(|error| vec![error])?;
        let here = (self.number, entry.places.data);
        let mut enclosing = EnclosingClass::default();
        let setting = parameters::Setting { file, entry, experiment: name, free: self.free };
        let parameters = setting.parameters(&mut enclosing).map_err(|error| vec![error])?;
        note_used_twice(entry, notes);
        let mut is_driven = false;
        if x.name != "time" || !entry.inputs.is_empty() {
            // What the experiment sets may shape the model: sizes, conditions.
            let class = enclosing.load(session, &base, here)?;
            let flat = simulation::flattened(session, &class)?.model;
            is_driven = drive(entry, &flat, (&x.name, &x.column.values), &mut enclosing);
            let times = (x.name.as_str(), x.time.as_slice());
            inputs::inputs(entry, self.table, times, &flat, &mut enclosing, notes)
                .map_err(|error| vec![error])?;
        }
        let mut observed = Vec::new();
        for (y_name, wanted) in entry.all_outputs() {
            let place = observed.len();
            let delayed = dynamics::delayed(file, y_name, place, &wanted, &x.name, &mut enclosing);
            let delayed = delayed.map_err(|fault| vec![fault.at(entry.places.column(y_name))])?;
            observed.push(delayed);
        }
        if entry.steady_state {
            let class = enclosing.load(session, &base, here)?;
            let plain = simulation::translated(session, &class)?.program.clone();
            dynamics::steady(file, entry, plain.sorted(), &mut enclosing).map_err(one)?;
        }
        let name = enclosing.load(session, &base, here)?;
        Ok(Class { name, parameters, observed, is_driven })
    }

    fn settings(
        &self,
        session: &Session,
        program: &Program,
        x_name: &str,
        x: &[f64],
    ) -> Result<Settings, Fault> {
        let (entry, annotated) = (self.entry, program.experiment());
        let tolerance = annotated.tolerance.map_or(TOLERANCE, |tolerance| tolerance.min(TOLERANCE));
        let options = SimulationOptions {
            stop: stop_time(entry, x_name, x, annotated.stop_time),
            tolerance: entry.tolerance.or(Some(tolerance)),
            method: entry.integrator.clone(),
            ..SimulationOptions::default()
        };
        let mut settings = simulation::settings(&annotated, &options)?;
        limit(session, entry, &mut settings)?;
        Ok(settings)
    }
}

/// What a simulation may cost.
fn limit(session: &Session, entry: &ExperimentEntry, settings: &mut Settings) -> Result<(), Fault> {
    if let Some(steps) = entry.max_steps {
        (settings.max_steps, settings.max_total_steps) = (steps, steps);
    }
    let Some(seconds) = entry.max_seconds else { return Ok(()) };
    if seconds.is_nan() || seconds <= 0.0 {
        bail!(BAD_OPTION, "`max_seconds` is {seconds}; it must be positive");
    }
    // Where there is no clock, nothing is late.
    settings.time_budget = session.world.clock().map(|clock| TimeBudget { seconds, clock });
    Ok(())
}

/// Over time, the simulation goes as far as it was measured.
fn stop_time(
    entry: &ExperimentEntry,
    x_name: &str,
    x: &[f64],
    annotated: Option<f64>,
) -> Option<f64> {
    let last = x.iter().copied().filter(|x| x.is_finite()).fold(f64::NEG_INFINITY, f64::max);
    match entry.stop_time {
        None if x_name == "time" && last.is_finite() => Some(annotated.unwrap_or(last).max(last)),
        wanted => wanted,
    }
}

/// Columns that are both an input and an output: the one follows from the other.
fn note_used_twice(entry: &ExperimentEntry, notes: &mut Notes) {
    for (input, column) in &entry.inputs {
        let column = column.entry().column.unwrap_or_else(|| input.clone());
        let same = |(name, own): &(&String, ColumnEntry)| {
            own.column.as_ref().unwrap_or(name).as_str() == column
        };
        if let Some((output, _)) = entry.all_outputs().find(same) {
            notes.add(format!(
                "the column `{column}` is both the input `{input}` and the output `{output}`"
            ));
        }
    }
}

/// Ties X to a parameter of the class where it is an input of the model that nothing else drives.
fn drive(
    entry: &ExperimentEntry,
    flat: &FlatModel,
    (x_name, x): (&str, &[f64]),
    enclosing: &mut EnclosingClass,
) -> bool {
    let is_bound = entry.inputs.contains_key(x_name) || entry.set.contains_key(x_name);
    if is_bound || !static_curve::is_open_input(flat, x_name) {
        return false;
    }
    let typical = static_curve::typical(x);
    let driver = static_curve::DRIVER;
    let place = entry.places.x;
    enclosing.bind(x_name, enclosing_class::reference(driver, place), place);
    _ = writeln!(enclosing.declarations, "  parameter Real {driver} = {typical:e};");
    enclosing.elements.push((driver.to_owned(), x_name.to_owned()));
    true
}
