//! One experiment of a problem: its data, the class around the model, the compiled model and the
//! settings of its simulation.

use super::data::{self, Notes};
use super::enclosing_class::EnclosingClass;
use super::file::{self, ColumnEntry, ExperimentEntry, ProblemFile, Role};
use super::series::Comparison;
use super::{dynamics, inputs};
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
use crate::syntax::ast::ExpressionKind;
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
        Ok(Built { experiment, series, has_states })
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
        let mut enclosing = EnclosingClass::default();
        let parameters =
            set_parameters(file, entry, name, self.free, &mut enclosing).map_err(one)?;
        let is_driven = drive(session, file, entry, (&x.name, &x.column.values), &mut enclosing)?;
        let parts = (entry, self.table, (x.name.as_str(), x.time.as_slice()));
        follow(session, file, parts, &mut enclosing, notes)?;
        let mut observed = Vec::new();
        for (place, (y_name, wanted)) in entry.outputs.iter().enumerate() {
            let wanted = wanted.entry();
            let delayed = dynamics::delayed(file, y_name, place, &wanted, &x.name, &mut enclosing);
            observed.push(delayed.map_err(one)?);
        }
        if entry.steady_state {
            let class = enclosing.load(session, &file.model, self.number)?;
            let plain = simulation::translated(session, &class)?.program.clone();
            dynamics::steady(file, entry, plain.sorted(), &mut enclosing).map_err(one)?;
        }
        let name = enclosing.load(session, &file.model, self.number)?;
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

/// What the parameters of the file mean in one experiment: modifications, and the free ones with
/// their names in the class.
fn set_parameters(
    file: &ProblemFile,
    entry: &ExperimentEntry,
    experiment: &str,
    free: &[Free],
    enclosing: &mut EnclosingClass,
) -> Result<Vec<(usize, String)>, Fault> {
    let mut places = Vec::new();
    for (number, (name, parameter)) in file.parameters.iter().enumerate() {
        let initial = parameter.initial;
        let delay = dynamics::is_delay(file, name);
        let value = match parameter.role(name)? {
            Role::Free { .. } => {
                let full = if parameter.per_experiment {
                    format!("{name}@{experiment}")
                } else {
                    name.clone()
                };
                let Some(place) = free.iter().position(|free| free.name == full) else {
                    bail!(BAD_OPTION, "`{name}` is estimated separately for each experiment, but \
                                       {experiment} has no value for \
                                       it"; help: "fix it there with `set`")
                };
                if !initial && !delay {
                    places.push((place, name.clone()));
                    continue;
                }
                let own = match delay {
                    true => dynamics::delay_name(number),
                    false => format!("gapi_initial_{number}"),
                };
                let middle = free[place].value(0.5);
                _ = writeln!(enclosing.declarations, "  parameter Real {own} = {middle:e};");
                places.push((place, own.clone()));
                if delay {
                    continue;
                }
                own
            }
            Role::Fixed(_) | Role::Tied(_) if delay => continue,
            Role::Fixed(value) => format!("{value:e}"),
            Role::Tied(expression) => expression,
        };
        enclosing.modifications.push(match initial {
            true => format!("{name}(start = {value}, fixed = true)"),
            false => format!("{name} = {value}"),
        });
    }
    for (name, value) in &entry.set {
        if file.parameters.contains_key(name) {
            bail!(BAD_OPTION, "`{name}` is set both in {experiment} and in \
                               `[parameters]`"; help: "remove one of the two");
        }
        enclosing.modifications.push(format!("{name} = {value:e}"));
    }
    let start = |(name, value): (&String, &f64)| format!("{name}(start = {value:e}, fixed = true)");
    enclosing.modifications.extend(entry.start.iter().map(start));
    Ok(places)
}

/// Ties X to a parameter of the class where it is an input of the model that nothing else drives.
fn drive(
    session: &mut Session,
    file: &ProblemFile,
    entry: &ExperimentEntry,
    (x_name, x): (&str, &[f64]),
    enclosing: &mut EnclosingClass,
) -> Result<bool, Vec<Diagnostic>> {
    let is_bound = entry.inputs.contains_key(x_name) || entry.set.contains_key(x_name);
    if is_bound || !static_curve::is_driven(session, &file.model, x_name)? {
        return Ok(false);
    }
    let typical = static_curve::typical(x);
    let driver = static_curve::DRIVER;
    enclosing.modifications.push(format!("{x_name} = {driver}"));
    _ = writeln!(enclosing.declarations, "  parameter Real {driver} = {typical:e};");
    Ok(true)
}

/// Lets inputs follow their columns. Where one of these has a unit, that of the model is looked up in
/// the flat model.
fn follow(
    session: &mut Session,
    file: &ProblemFile,
    (entry, table, x): (&ExperimentEntry, &MatFile, (&str, &[f64])),
    enclosing: &mut EnclosingClass,
    notes: &mut Notes,
) -> Result<(), Vec<Diagnostic>> {
    let flat = match inputs::have_units(entry, table) {
        true => Some(simulation::flattened(session, &file.model)?.model),
        false => None,
    };
    let unit = |name: &str| flat.as_ref().map_or_else(String::new, |flat| unit_in(flat, name));
    let followed = inputs::inputs(entry, table, x, &unit, enclosing, notes);
    followed.map_err(|wrong| vec![wrong])
}

/// The unit of a variable; empty where it has none.
pub(super) fn unit_in(flat: &FlatModel, name: &str) -> String {
    let unit = flat.variables.get(name).and_then(|variable| variable.attributes.get("unit"));
    match unit.map(|unit| &unit.value.kind) {
        Some(ExpressionKind::String(unit)) => unit.to_string(),
        _ => String::new(),
    }
}
