//! Models of a session: translated once, simulated many times with other parameters.

use super::continuation::Continued;
use super::retranslation::{self, Changed, Changes};
use crate::codegen::errors::{ASSERTION_FAILED, CHATTERING, UNDETERMINED};
use crate::codegen::{Access, Program};
use crate::diag::{At, Diagnostic, Fault, suggest};
use crate::flatten::{self, BaseType, Experiment, FlatModel, Variability};
use crate::name::Ident;
use crate::results::{ResultTable, Series, Values};
use crate::runtime::{LogMessage, System, Treated, Undetermined};
use crate::script::Session;
use crate::script::errors::{BAD_PARAMETER_VALUE, INTERRUPTED, SHARED_NAME, UNKNOWN_PARAMETER};
use crate::sim::{self, OutputGrid, Settings, Simulator, Statistics, Trajectory, Treatment};
use crate::source::Span;
use crate::value::Value;
use crate::{bail, causalize, fault, syntax};
use indexmap::IndexMap;
use regex::Regex;
use rustc_hash::{FxHashMap, FxHashSet};
use std::sync::Arc;
use std::sync::atomic::AtomicU64;

/// A model ready to be simulated.
#[derive(Debug)]
pub struct Translated {
    /// The class with its modification, as it was asked for.
    pub problem: String,
    /// The flat model.
    pub flat: FlatModel,
    /// The compiled model.
    pub program: Arc<Program>,
}

/// The translated models of a session.
#[derive(Default)]
pub(in crate::script) struct Models {
    known: FxHashMap<String, (u64, Arc<Translated>)>,
    last: Option<Current>,
    /// The warnings reported so far.
    told: FxHashSet<(Span, String)>,
    /// Where the last simulation ended.
    end: Option<End>,
}

/// The end of a simulation: what a later one may begin with.
#[derive(Debug, Clone)]
pub(in crate::script) struct End {
    /// Start and stop time, seconds.
    pub(in crate::script) span: (f64, f64),
    /// The states.
    pub(in crate::script) states: IndexMap<Arc<str>, f64>,
}

/// The model translated last, with the values that scripts gave to its parameters.
#[derive(Clone)]
pub(in crate::script) struct Current {
    model: Arc<Translated>,
    overrides: IndexMap<usize, f64>,
    changes: Changes,
    /// Values that the states have at the start in place of those of the initial equations.
    imported: IndexMap<Arc<str>, f64>,
}

impl Current {
    fn of(model: Arc<Translated>) -> Current {
        let (overrides, imported) = (IndexMap::new(), IndexMap::new());
        Current { model, overrides, changes: Changes::default(), imported }
    }
}

/// What a simulation is asked for; `None` where the model's experiment annotation, or else the
/// default, decides.
#[derive(Debug, Clone, Default)]
pub struct Wishes {
    /// Start time, seconds (0).
    pub start: Option<f64>,
    /// Stop time, seconds (1).
    pub stop: Option<f64>,
    /// Number of output intervals (500).
    pub intervals: Option<usize>,
    /// Length of an output interval, seconds; counts where `intervals` is not given.
    pub interval: Option<f64>,
    /// Relative tolerance (1e-4).
    pub tolerance: Option<f64>,
    /// Name of the integrator (`dassl`).
    pub method: Option<String>,
    /// Step of a fixed-step integrator, seconds.
    pub fixed_step: Option<f64>,
    /// Whether a simulation stops where events would follow each other without end.
    pub stops_at_chattering: bool,
    /// Which variables the results hold, by their names; all where nothing is said.
    pub only: Option<Regex>,
    /// Where the time reached is told, as the bits of an `f64`.
    pub reached: Option<Arc<AtomicU64>>,
}

/// A simulation that reached its end, or what was computed until it failed.
#[derive(Debug)]
pub struct Simulated {
    /// All variables.
    pub table: ResultTable,
    /// What it cost.
    pub statistics: Statistics,
}

impl Models {
    /// Forgets all models.
    pub(super) fn forget(&mut self) {
        self.known.clear();
        self.told.clear();
        self.last = None;
    }

    /// The model translated last.
    pub(in crate::script) fn last(&self) -> Option<&Arc<Translated>> {
        self.last.as_ref().map(|current| &current.model)
    }
}

/// Translates a model, `Class` or `Class(modification)`: at most once as long as no class changes.
/// It becomes the model that dotted names of scripts refer to.
///
/// # Errors
/// Everything that is wrong with it.
pub fn translate(session: &mut Session, problem: &str) -> Result<Arc<Translated>, Vec<Diagnostic>> {
    let model = translated(session, problem)?;
    look_at(session, &model);
    Ok(model)
}

/// Makes a translated model the one that dotted names of scripts refer to.
pub(in crate::script) fn look_at(session: &mut Session, model: &Arc<Translated>) {
    let is_last = session.models.last().is_some_and(|last| Arc::ptr_eq(last, model));
    if !is_last {
        session.models.last = Some(Current::of(model.clone()));
    }
}

/// As [`translate`]; the parameters have the values that the model gives them, whatever scripts set
/// before.
///
/// # Errors
/// Everything that is wrong with it.
pub fn translate_anew(
    session: &mut Session,
    problem: &str,
) -> Result<Arc<Translated>, Vec<Diagnostic>> {
    let model = translated(session, problem)?;
    session.models.last = Some(Current::of(model.clone()));
    Ok(model)
}

/// As [`translate`], without changing which model dotted names refer to.
///
/// # Errors
/// Everything that is wrong with it.
pub fn translated(
    session: &mut Session,
    problem: &str,
) -> Result<Arc<Translated>, Vec<Diagnostic>> {
    let revision = session.library_revision();
    if let Some((then, model)) = session.models.known.get(problem)
        && *then == revision
    {
        return Ok(model.clone());
    }
    let model = Arc::new(compiled(session, problem)?);
    // Flattening may have loaded packages, which is what the revision counts.
    let revision = session.library_revision();
    session.models.known.insert(problem.to_owned(), (revision, model.clone()));
    Ok(model)
}

/// A model, translated whether it has been or not.
pub(super) fn compiled(
    session: &mut Session,
    problem: &str,
) -> Result<Translated, Vec<Diagnostic>> {
    let flat = flat_model(session, problem)?;
    let sorted = causalize::causalize(&flat).map_err(|error| vec![error])?;
    let program = Program::compile(sorted).map_err(|error| vec![error])?;
    warn(session, program.warnings());
    Ok(Translated { problem: problem.to_owned(), flat, program })
}

/// Reports the warnings about a model that were not reported yet, whatever it was asked before.
fn warn(session: &mut Session, warnings: &[Diagnostic]) {
    for warning in warnings {
        if session.models.told.insert((warning.span(), warning.message.clone())) {
            session.report(warning.clone());
        }
    }
}

/// Flattens a model, `Class` or `Class(modification)`; packages that it needs are loaded.
///
/// # Errors
/// Everything that is wrong with it.
pub fn flat_model(session: &mut Session, problem: &str) -> Result<FlatModel, Vec<Diagnostic>> {
    flattened(session, problem).map(|flattened| flattened.model)
}

pub use crate::causalize::PASSES;

/// The system of a model after a pass of [`PASSES`] as text, in its own names; else the flat model.
///
/// # Errors
/// Everything that is wrong with it up to there.
pub fn dump(session: &mut Session, problem: &str, pass: &str) -> Result<String, Vec<Diagnostic>> {
    let flat = flat_model(session, problem)?;
    let system = causalize::dump(&flat, pass).map_err(|error| vec![error])?;
    Ok(system.unwrap_or_else(|| flat.to_string()))
}

/// As [`flat_model`], with the local balance; warnings are reported.
pub(in crate::script) fn flattened(
    session: &mut Session,
    problem: &str,
) -> Result<flatten::Flattened, Vec<Diagnostic>> {
    let source = session.sources.add("problem", problem);
    let (name, modification) =
        syntax::parse_class_with_modification(source, problem).map_err(|error| vec![error])?;
    session.autoload(&name)?;
    loop {
        let resources = session.resources_for(&name);
        session.classes.library.set_resources(resources);
        let found = session
            .ask_library(|library| flatten::flatten_unbalanced(library, &name, &modification));
        // Functions that only other functions call are missed without an error.
        if session.load_wanted()? {
            continue;
        }
        let (flattened, imbalance) = found.map_err(|errors| {
            let errors = errors.into_iter().map(|error| session.with_misnamed_file(error, &name));
            errors.map(|error| placed(error, session.call)).collect::<Vec<_>>()
        })?;
        if let Some(imbalance) = imbalance {
            return Err(vec![causalize::explain_imbalance(&flattened.model, imbalance)]);
        }
        warn(session, &flattened.warnings);
        return Ok(flattened);
    }
}

/// Number of scalar unknowns of a model.
pub fn unknowns(flat: &FlatModel) -> usize {
    let is_unknown = |variable: &&flatten::Variable| {
        variable.variability >= Variability::Discrete
            && variable.causality != Some(syntax::ast::CausalityPrefix::Input)
    };
    flat.variables.values().filter(is_unknown).map(flatten::Variable::len).sum()
}

/// The diagnostic at the place of the call, if it has none of its own.
pub(super) fn placed(diagnostic: Diagnostic, call: Span) -> Diagnostic {
    if diagnostic.span().is_known() || !diagnostic.is_error() {
        return diagnostic;
    }
    let fault = Fault::new(diagnostic.code, diagnostic.message.clone());
    diagnostic.helps.iter().cloned().fold(fault, Fault::help).at(call)
}

/// The most intervals of an output: its columns are arrays of scripts, which have no more elements.
const MOST_INTERVALS: usize = crate::value::MAX_ELEMENTS - 1;

/// The settings that wishes, the experiment annotation and the defaults make together.
///
/// # Errors
/// An unknown method, or a number outside its domain.
pub fn settings(experiment: &Experiment, wishes: &Wishes) -> Result<Settings, Fault> {
    let defaults = Settings::default();
    let start = wishes.start.or(experiment.start_time).unwrap_or(defaults.start);
    let stop = wishes.stop.or(experiment.stop_time).unwrap_or(start + defaults.stop);
    if !(start.is_finite() && stop.is_finite() && start <= stop) {
        bail!(
            crate::registry::BAD_OPTION,
            "the simulation interval from {start} to {stop} is empty"
        );
    }
    let of_interval = |interval: f64| ((stop - start) / interval).round().max(1.0) as usize;
    let intervals = match (wishes.intervals, wishes.interval.or(experiment.interval)) {
        (Some(intervals), _) => Some(intervals),
        (None, Some(interval)) if interval > 0.0 => Some(of_interval(interval)),
        _ => None,
    };
    if intervals.is_some_and(|intervals| intervals > MOST_INTERVALS) {
        bail!(crate::registry::BAD_OPTION,
            "the output from {start} to {stop} has more than {MOST_INTERVALS} intervals";
            help: "use a longer `outputInterval` or a smaller `numberOfIntervals`");
    }
    let tolerance = wishes.tolerance.or(experiment.tolerance).unwrap_or(defaults.tolerance);
    if !(1e-14..=0.1).contains(&tolerance) {
        bail!(crate::registry::BAD_OPTION, "`tolerance` is {tolerance}, outside 1e-14 to 0.1");
    }
    let method = match &wishes.method {
        Some(name) => sim::find_integrator(name)?,
        None => defaults.method,
    };
    Ok(Settings {
        start,
        stop,
        output: intervals.map_or(defaults.output, OutputGrid::Intervals),
        tolerance,
        method,
        step: wishes.fixed_step.filter(|step| *step > 0.0),
        treats_chattering: !wishes.stops_at_chattering,
        ..Settings::default()
    })
}

/// Simulates a model with the parameter values that scripts gave to it.
///
/// # Errors
/// A wish that cannot be fulfilled, or the failure in the model's words.
pub fn simulate(
    session: &mut Session,
    model: &Translated,
    wishes: &Wishes,
) -> Result<Simulated, Diagnostic> {
    let call = session.call;
    let mut settings = settings(&model.program.experiment(), wishes).at(call)?;
    settings.cancel = session.world.interrupt_flag();
    settings.reached = wishes.reached.clone();
    let (changed, mut system) = prepared(session, model)?;
    let model = changed.as_deref().unwrap_or(model);
    let mut trajectory = match &wishes.only {
        Some(only) => Trajectory::keeping(wanted_columns(model, only)),
        None => Trajectory::default(),
    };
    system.system.listen();
    let run = Simulator::new().run(&mut system, &settings, &mut trajectory);
    tell(session, &system.system);
    report_treatments(session, &system.system);
    report_undetermined(session, &system.system);
    let written = system.system.journal().carry_out(session).at(call);
    match run {
        Ok(statistics) => {
            written?;
            session.models.end = Some(end(model, &settings, &trajectory));
            let table = result_table(model, &system.system, trajectory, wishes.only.as_ref());
            Ok(Simulated { table, statistics })
        }
        Err(_) if session.world.interrupted() => {
            Err(Fault::new(INTERRUPTED, "interrupted").at(call))
        }
        Err(error) => Err(system.system.program().explain(&error)),
    }
}

/// What was done about relations that would have switched without end, once for each.
fn report_treatments(session: &mut Session, system: &System) {
    for Treated { time, treatment, span } in system.treated() {
        let words = match treatment {
            Treatment::Followed => {
                "this relation is chattering: it switches repeatedly while its sides are almost \
                 equal; it is evaluated between steps, without events"
            }
            Treatment::Slides => {
                "sliding mode: the solution slides along this \
                 relation, with the mean of both branches"
            }
            Treatment::Rests => {
                "impacts accumulate at this relation (Zeno behaviour); the solution stays at \
                 rest there"
            }
        };
        if session.models.told.insert((*span, words.to_owned())) {
            let message = format!("{words} (from t = {time})");
            session.report(Fault::new(CHATTERING, message).at(*span).warning());
        }
    }
}

/// The unknowns that equations which depend on each other leave open, once for each loop.
fn report_undetermined(session: &mut Session, system: &System) {
    for Undetermined { time, names, omitted, is_linear, span } in system.undetermined() {
        let mut names = names.join(", ");
        if omitted > 0 {
            names += &format!(" and {omitted} more");
        }
        let (words, help) = if is_linear {
            (
                format!(
                    "the equations do not determine {names}: their system is singular, and one \
                     of many solutions is used"
                ),
                "replace a redundant equation by one that determines these variables",
            )
        } else {
            (
                format!(
                    "the equations may not determine {names}: their Jacobian is singular, and \
                     the solution near the start values is used"
                ),
                "check whether one of the equations follows from the others",
            )
        };
        if session.models.told.insert((span, words.clone())) {
            let message = format!("{words} (from t = {time})");
            session.report(Fault::new(UNDETERMINED, message).help(help).at(span).warning());
        }
    }
}

/// What the model has told while it was simulated.
fn tell(session: &mut Session, system: &System) {
    let (told, omitted) = system.log_messages();
    for LogMessage { time, text, is_warning, span } in told {
        if is_warning {
            let message = format!("{text} (at t = {time})");
            session.report(Fault::new(ASSERTION_FAILED, message).at(span).warning());
        } else {
            session.print(&(text + "\n"));
        }
    }
    if omitted > 0 {
        session.print(&format!("... and {omitted} messages more\n"));
    }
}

/// The model as scripts changed it, if that needed another translation, and its system with all
/// values that scripts gave.
fn prepared(
    session: &mut Session,
    model: &Translated,
) -> Result<(Option<Arc<Translated>>, Continued), Diagnostic> {
    let call = session.call;
    let untouched = Continued { system: model.program.system(), states: Vec::new() };
    let Some(mut current) = session.models.last.take() else { return Ok((None, untouched)) };
    if !std::ptr::eq(&*current.model, model) {
        session.models.last = Some(current);
        return Ok((None, untouched));
    }
    let changed = match current.changes.is_empty() {
        true => Ok(current.model.clone()),
        false => session.changed_model(&current.model.clone(), &mut current.changes),
    };
    let system = changed.map(|changed| (with_values(&current, &changed), changed));
    session.models.last = Some(current);
    match system {
        Ok((system, changed)) => Ok((Some(changed), system.at(call)?)),
        Err(mut errors) => {
            let last = errors.pop();
            errors.into_iter().for_each(|error| session.report(error));
            Err(last.unwrap_or_else(|| Fault::new(BAD_PARAMETER_VALUE, "no model").at(call)))
        }
    }
}

/// The system of a model, with the values of the current one.
fn with_values(current: &Current, model: &Translated) -> Result<Continued, Fault> {
    let mut system = model.program.system();
    for (parameter, value) in &current.overrides {
        let name = &current.model.program.parameters()[*parameter].name;
        system.set_parameter(model.program.find_parameter(name)?, *value)?;
    }
    let names = state_names(model);
    let states =
        names.enumerate().filter_map(|(at, name)| Some((at, *current.imported.get(name)?)));
    Ok(Continued { states: states.collect(), system })
}

/// The next simulations begin with the states and parameters that a result has at a time.
///
/// # Errors
/// A state that the result does not have.
pub fn begin_with(
    session: &mut Session,
    model: &Translated,
    result: &ResultTable,
    time: f64,
) -> Result<(), Fault> {
    let mut states = IndexMap::new();
    for name in state_names(model) {
        states.insert(name.clone(), result.interpolate(name, &[time])?[0]);
    }
    for parameter in model.program.parameters() {
        if let Ok(values) = result.interpolate(&parameter.name, &[time]) {
            session.set_parameter(&parameter.name, values[0])?;
        }
    }
    session.import_states(states);
    Ok(())
}

/// The names of the states, in their order.
pub(in crate::script) fn state_names(model: &Translated) -> impl Iterator<Item = &Arc<str>> {
    let sorted = model.program.sorted();
    sorted.states.iter().map(|state| &sorted.dae.variable(*state).name)
}

fn end(model: &Translated, settings: &Settings, trajectory: &Trajectory) -> End {
    let variables = model.program.variables();
    let names = variables.iter().enumerate().map(|(at, variable)| (&*variable.name, at));
    let numbers: FxHashMap<&str, usize> = names.collect();
    let last = |name: &Arc<str>| {
        let Access::Observed { column, negated } = variables[*numbers.get(&**name)?].access else {
            return None;
        };
        let sign = if negated { -1.0 } else { 1.0 };
        Some((name.clone(), sign * trajectory.column(column).last()?))
    };
    let stop = trajectory.time().last().copied().unwrap_or(settings.stop);
    End { span: (settings.start, stop), states: state_names(model).filter_map(last).collect() }
}

/// Which columns hold a variable that is wanted.
fn wanted_columns(model: &Translated, only: &Regex) -> Vec<bool> {
    let mut wanted = Vec::new();
    for variable in model.program.variables() {
        if let Access::Observed { column, .. } = variable.access {
            if wanted.len() <= column {
                wanted.resize(column + 1, false);
            }
            wanted[column] |= only.is_match(&variable.name);
        }
    }
    wanted
}

/// The variables of a simulation that are wanted. Aliases have their own values where not all are.
fn result_table(
    model: &Translated,
    system: &System,
    mut trajectory: Trajectory,
    only: Option<&Regex>,
) -> ResultTable {
    let mut table = ResultTable::new(trajectory.time().to_vec());
    let mut series_of_column: FxHashMap<usize, (usize, bool)> = FxHashMap::default();
    for (index, variable) in model.program.variables().iter().enumerate() {
        if only.is_some_and(|only| !only.is_match(&variable.name)) {
            continue;
        }
        let values = match variable.access {
            Access::Time => continue,
            Access::Constant(value) => Values::Constant(value),
            Access::Parameter => match system.value(index) {
                Some(value) => Values::Constant(value),
                None => continue,
            },
            Access::Observed { column, negated } => match series_of_column.get(&column) {
                Some((of, sign)) if only.is_none() => {
                    Values::Alias { of: *of, negated: *sign != negated }
                }
                Some((of, sign)) => table.series[*of].values.clone().with_sign(*sign != negated),
                None => {
                    series_of_column.insert(column, (table.series.len(), negated));
                    Values::Trajectory(trajectory.take_column(column)).with_sign(negated)
                }
            },
        };
        table.series.push(Series {
            name: variable.name.to_string(),
            unit: variable.unit.to_string(),
            description: variable.description.to_string(),
            values,
        });
    }
    table
}

impl Session {
    /// Gives a parameter of the model translated last a value, by its full name.
    ///
    /// # Errors
    /// A name that is no parameter, or one that cannot be set without translating again.
    pub fn set_parameter(&mut self, name: &str, value: f64) -> Result<(), Fault> {
        let Some(current) = &mut self.models.last else {
            bail!(
                crate::script::errors::NO_TRANSLATED_MODEL,
                "`{name}` refers to a component of a model, but no model has been translated";
                help: "call `translateModel(\"Package.Model\")` first"
            )
        };
        match current.model.program.find_parameter(name) {
            Ok(index) => {
                check_value(&current.model, index, value)?;
                current.overrides.insert(index, value);
                Ok(())
            }
            Err(_) => {
                match retranslation::change(&mut current.changes, &current.model, name, value) {
                    Some(Changed::Structure) => {
                        let problem = current.model.problem.clone();
                        self.note_structural(name, &problem);
                        Ok(())
                    }
                    Some(Changed::Start) => Ok(()),
                    None => Err(not_tunable(&current.model, name)),
                }
            }
        }
    }

    /// The model translated last and the values that it has, to be restored.
    pub(in crate::script) fn current_values(&self) -> Option<Current> {
        self.models.last.clone()
    }

    /// Puts a variant of the model translated last, or of what scripts changed it to, in its place;
    /// its parameters have the values that scripts gave. `None`: it stays as it is.
    /// [`Session::restore_values`] takes it back.
    pub(super) fn vary_current(
        &mut self,
        variant: impl FnOnce(&Translated) -> Result<Option<Translated>, Diagnostic>,
    ) -> Result<Arc<Translated>, Vec<Diagnostic>> {
        let (call, one) = (self.call, |error: Diagnostic| vec![error]);
        let Some(mut current) = self.models.last.clone() else {
            return Err(vec![no_model().at(call)]);
        };
        let changed = match current.changes.is_empty() {
            true => current.model.clone(),
            false => self.changed_model(&current.model.clone(), &mut current.changes)?,
        };
        let model = variant(&changed).map_err(one)?.map_or(changed, Arc::new);
        let mut overrides = IndexMap::new();
        for (at, value) in &current.overrides {
            let name = &current.model.program.parameters()[*at].name;
            let found = model.program.find_parameter(name).at(call).map_err(one)?;
            overrides.insert(found, *value);
        }
        let imported = current.imported;
        let changes = Changes::default();
        self.models.last = Some(Current { model: model.clone(), overrides, changes, imported });
        Ok(model)
    }

    /// Takes back what was set since.
    pub(in crate::script) fn restore_values(&mut self, before: Option<Current>) {
        self.models.last = before;
    }

    /// A system of the model with the values that scripts gave to it.
    pub(super) fn system_with_values(&mut self, model: &Translated) -> Result<System, Diagnostic> {
        Ok(prepared(self, model)?.1.system)
    }

    /// Where the last simulation ended.
    pub(in crate::script) fn last_end(&self) -> Option<&End> {
        self.models.end.as_ref()
    }

    /// Gives the states of the model translated last values at the start of its next simulations,
    /// whatever its initial equations say; none to take them back.
    pub(in crate::script) fn import_states(&mut self, states: IndexMap<Arc<str>, f64>) {
        if let Some(current) = &mut self.models.last {
            current.imported = states;
        }
    }

    /// A script variable with the name of a parameter of the model translated last gives the
    /// parameter its value too; said once for each name.
    pub(in crate::script) fn share_with_model(
        &mut self,
        name: Ident,
        value: &Value,
    ) -> Result<(), Fault> {
        let Some(current) = &self.models.last else { return Ok(()) };
        let model = current.model.clone();
        let declared = model.flat.variables.get(name.as_str());
        let is_parameter =
            declared.is_some_and(|v| v.top_level && v.variability == Variability::Parameter);
        if !is_parameter {
            return Ok(());
        }
        let is_tunable = model.program.find_parameter(name.as_str()).is_ok();
        let number = value.as_real().or(match value {
            Value::Boolean(value) => Some(f64::from(*value)),
            _ => None,
        });
        let set = match number {
            Some(number) if is_tunable => self.set_parameter(name.as_str(), number).map(|()| true),
            Some(number) => Ok(self.set_parameter(name.as_str(), number).is_ok()),
            None => Ok(false),
        };
        let consequence = match set? {
            true => "the parameter is set as well".to_owned(),
            false => {
                format!("the parameter keeps its value: {}", not_tunable(&model, name.as_str()))
            }
        };
        if self.shared.insert(name) {
            let problem = &model.problem;
            self.note(
                SHARED_NAME,
                format!("`{name}` is also a parameter of `{problem}`: {consequence}"),
            );
        }
        Ok(())
    }

    /// The value that a parameter of the model translated last has, or `None` if the model has no
    /// such parameter.
    pub(super) fn parameter_value(&self, name: &str) -> Option<f64> {
        let current = self.models.last.as_ref()?;
        let index = current.model.program.find_parameter(name).ok()?;
        let default = current.model.program.parameters()[index].default;
        Some(current.overrides.get(&index).copied().unwrap_or(default))
    }
}

fn no_model() -> Fault {
    fault!(crate::script::errors::NO_TRANSLATED_MODEL, "no model has been translated";
        help: "call `translateModel(\"Package.Model\")` first")
}

fn check_value(model: &Translated, index: usize, value: f64) -> Result<(), Fault> {
    let parameter = &model.program.parameters()[index];
    let name = &parameter.name;
    if value.is_nan() {
        bail!(BAD_PARAMETER_VALUE, "`{name}` cannot be NaN");
    }
    if value.fract() != 0.0 && parameter.base != BaseType::Real {
        bail!(BAD_PARAMETER_VALUE, "`{name}` needs a whole number, but the value is {value}");
    }
    let domain = match (parameter.min.is_finite(), parameter.max.is_finite()) {
        (true, true) => format!("outside {} to {}", parameter.min, parameter.max),
        (true, false) => format!("less than {}", parameter.min),
        _ => format!("more than {}", parameter.max),
    };
    if value < parameter.min || value > parameter.max {
        bail!(
            BAD_PARAMETER_VALUE,
            "`{name}` is {value}, {domain}, outside the range declared in the model";
            help: "choose another value, or change `min` and `max` in the model"
        );
    }
    Ok(())
}

/// A modification of an element at some depth: `a(b(c = …))`.
fn nested_modification(name: &str) -> String {
    let parts: Vec<&str> = name.split('.').collect();
    format!("{} = …{}", parts.join("("), ")".repeat(parts.len() - 1))
}

/// Why a name cannot be assigned in the model.
fn not_tunable(model: &Translated, name: &str) -> Fault {
    let problem = &model.problem;
    match model.flat.variables.get(name) {
        Some(variable) if variable.variability <= Variability::Parameter => {
            let reason = match () {
                () if variable.variability == Variability::Constant => "it is a constant",
                () if variable.is_final => "it is final",
                () if variable.structural || variable.evaluate => {
                    "it is a structural parameter, evaluated at translation"
                }
                () => "it is an array or not a number",
            };
            fault!(BAD_PARAMETER_VALUE, "`{name}` of `{problem}` cannot be set: {reason}";
                help: "set it by a modification, `{problem}({})`", nested_modification(name))
        }
        Some(_) => fault!(UNKNOWN_PARAMETER, "`{name}` of `{problem}` is not a parameter";
            help: "the equations determine its value; set the parameters that it depends on"),
        None => {
            let names = model.program.parameters().iter().map(|parameter| &*parameter.name);
            let own = name.strip_prefix(problem.as_str()).and_then(|rest| rest.strip_prefix('.'));
            let own = own.filter(|own| model.program.find_parameter(own).is_ok());
            fault!(UNKNOWN_PARAMETER, "`{problem}` has no parameter `{name}`")
                .help_if(own.map(|own| format!("write `{own}`, without the name of the model")))
                .help_if(suggest::did_you_mean(name, names))
        }
    }
}
