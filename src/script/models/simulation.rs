//! Models of a session: translated once, simulated many times with other parameters.

use super::changes::Changes;
use super::compiled::Current;
use super::final_state::FinalState;
use super::hardest::{Hardest, hardest};
use super::outside_ranges::warn_outside;
use super::places::{in_argument, placed, strings, where_named};
use super::stored::{Reads, Request};
pub use super::translated::Translated;
use super::translated::declarations;
use super::warnings::warn;
use crate::Session;
use crate::codegen::errors::{CHATTERING, UNDETERMINED};
use crate::codegen::{Access, Program};
use crate::diag::{At, Diagnostic, Fault, Severity};
use crate::errors::{
    BAD_PARAMETER_VALUE, INTERRUPTED, TRANSLATED_AGAIN, UNKNOWN_PARAMETER, VALUES_DROPPED,
};
use crate::flatten::{self, Experiment, FlatModel, Variability};
use crate::name::Name;
use crate::registry::BAD_OPTION;
use crate::results::{ResultTable, Series, Values};
use crate::runtime::{GivenStart, LogMessage, System, Treated, Undetermined};
use crate::sim::{self, OutputGrid, Settings, Simulator, Statistics, Trajectory, Treatment};
use crate::source::Span;
use crate::{bail, causalize, fault, syntax};
use indexmap::IndexMap;
use regex::Regex;
use rustc_hash::FxHashMap;
use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::AtomicU64;

/// What a simulation is asked for; `None` where the model's experiment annotation, or else the
/// default, decides.
#[derive(Debug, Clone, Default)]
pub struct SimulationOptions {
    /// Start time, seconds (0).
    pub start: Option<f64>,
    /// Stop time, seconds (1).
    pub stop: Option<f64>,
    /// Number of output intervals (500); as it was given, it may be negative.
    pub intervals: Option<i64>,
    /// Length of an output interval, seconds; counts where `intervals` is not given.
    pub interval: Option<f64>,
    /// Relative tolerance (1e-4).
    pub tolerance: Option<f64>,
    /// Name of the integrator (`dassl`).
    pub method: Option<String>,
    /// Whether a model that is linear between events is solved exactly, where no integrator is named.
    pub takes_exact_steps: bool,
    /// Step of a fixed-step integrator, seconds.
    pub fixed_step: Option<f64>,
    /// Whether a simulation stops where events would follow each other without end.
    pub stops_at_chattering: bool,
    /// Which variables the results hold, by their names; all where nothing is said.
    pub only: Option<Regex>,
    /// Whether [`Simulated::hardest`] is requested.
    pub counts_effort: bool,
    /// Where the time reached is written, as the bits of an `f64`.
    pub reached: Option<Arc<AtomicU64>>,
}

/// A simulation that failed, or was stopped.
#[derive(Debug)]
pub struct Unfinished {
    /// Why.
    pub why: Diagnostic,
    /// What was computed until then; `None` where it did not begin.
    pub until: Option<Box<Simulated>>,
}

impl Unfinished {
    /// Writes what was computed to a result file, in the form that it has there; why it ended, with where
    /// the results are.
    pub(crate) fn kept(
        self,
        session: &mut Session,
        path: &Path,
        form: impl FnOnce(&mut Session, ResultTable) -> ResultTable,
    ) -> Diagnostic {
        match self.until {
            None => self.why,
            Some(until) => {
                let table = form(session, until.table);
                session.world.write_unfinished(path, &table, self.why)
            }
        }
    }
}

impl From<Diagnostic> for Unfinished {
    fn from(why: Diagnostic) -> Unfinished {
        Unfinished { why, until: None }
    }
}

/// A simulation that reached its end, or what was computed until it failed.
#[derive(Debug)]
pub struct Simulated {
    /// All variables.
    pub table: ResultTable,
    /// What it cost.
    pub statistics: Statistics,
    /// What cost the most effort, if that was asked for.
    pub hardest: Option<Hardest>,
}

/// Translates a model, `Class` or `Class(modification)`: at most once as long as none of its classes
/// changes.
/// It becomes the model that dotted names of scripts refer to.
///
/// ```
/// use gapilib_identify::problem::{Experiment, ModelSimulator, Observation, Simulate as _};
/// use gapilib_identify::{CompiledModel, Model as _};
/// use gapilib_script::Session;
/// use gapilib_script::models::simulation::translate;
/// use gapilib_script::world::MemoryWorld;
/// use std::sync::Arc;
///
/// let mut session = Session::new(Box::new(MemoryWorld::new()));
/// let classes = "model Decay
///   parameter Real k = 1;
///   Real x(start = 1, fixed = true);
/// equation
///   der(x) = -k*x;
/// end Decay;";
/// session.load_text("Decay.mo", classes).unwrap();
/// let translated = translate(&mut session, "Decay").unwrap();
/// let model = CompiledModel::new("Decay", translated.program.clone());
/// assert_eq!(model.parameters()[0].name, "k");
///
/// // Simulated again and again with other values of `k`: x at two time points.
/// let experiment = Experiment {
///     name: String::new(),
///     settings: model.settings(),
///     model: Arc::new(model),
///     deviations: 0,
///     second_attempt: true,
///     x_name: "time".to_owned(),
///     observations: vec![Observation { y_name: "x".to_owned(), x: vec![0.5, 1.0] }],
///     parameters: vec![(0, "k".to_owned())],
/// };
/// let mut simulator = ModelSimulator::new(&[experiment]).unwrap();
/// let mut x = [0.0; 2];
/// simulator.simulate(&[2.0], &mut x).unwrap();
/// assert!((x[1] - (-2.0f64).exp()).abs() < 1e-3);
/// ```
///
/// # Errors
/// Everything that is wrong with it.
pub fn translate(session: &mut Session, problem: &str) -> Result<Arc<Translated>, Vec<Diagnostic>> {
    let model = translated(session, problem)?;
    look_at(session, &model);
    Ok(model)
}

/// Makes a translated model the one that dotted names of scripts refer to. What was set by hand stays
/// with a model that was translated again because its classes or files have changed.
pub(crate) fn look_at(session: &mut Session, model: &Arc<Translated>) {
    match session.models.current.take() {
        Some(current) if Arc::ptr_eq(&current.model, model) => {
            session.models.current = Some(current);
        }
        Some(current) if current.model.problem == model.problem => carry(session, current, model),
        Some(current) => {
            leave(session, &current);
            session.models.refer_anew_to(model);
            note_dropped(session, model);
        }
        None => session.models.refer_anew_to(model),
    }
}

/// Another model takes the place of the current one, or the model is translated again.
fn leave(session: &mut Session, before: &Current) {
    session.models.leave(before);
    if !before.imported.is_empty() {
        let message = format!(
            "the start values imported for `{}` hold no longer: simulations begin as their model \
             says; the imported times stay",
            before.model.problem
        );
        session.note(VALUES_DROPPED, message);
    }
}

/// Sets again what was set by hand.
fn carry(session: &mut Session, before: Current, model: &Arc<Translated>) {
    let values = before.set_by_hand();
    let what = match before.model.files == model.files {
        true => "the classes of",
        false => "the files read by",
    };
    let mut now = Current { model: model.clone(), ..before };
    now.changes.forget_model();
    let is_there = |name: &str| model.program.find_parameter(name).is_ok();
    let lost: Vec<String> =
        now.overrides.keys().filter(|name| !is_there(name)).map(|name| name.to_string()).collect();
    now.overrides.retain(|name, _| is_there(name));
    session.models.current = Some(now);
    let problem = &model.problem;
    if !values.is_empty() {
        let message = format!(
            "{what} `{problem}` have changed: it is translated again, and what was set by \
             hand is set again: {}",
            values.join(", ")
        );
        session.note(TRANSLATED_AGAIN, message);
    }
    if !lost.is_empty() {
        let gone = lost.join(", ");
        let fault = fault!(UNKNOWN_PARAMETER, "`{problem}` has these parameters no longer: {gone}";
            help: "their values, set by hand before, have no effect");
        session.report(fault.at(session.call_site()).warning());
    }
}

/// Says that what was set by hand before another model took the place of this one does not hold.
fn note_dropped(session: &mut Session, model: &Translated) {
    let Some(values) = session.models.take_left(&model.problem) else { return };
    let message = format!(
        "`{}` starts from the values of its classes: what was set by hand before another model was in \
         use does not hold: {}",
        model.problem,
        values.join(", ")
    );
    session.note(VALUES_DROPPED, message);
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
    if let Some(before) = session.models.current.take() {
        leave(session, &before);
    }
    session.models.take_left(&model.problem);
    session.models.refer_anew_to(&model);
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
    if let Some((uses, model)) = session.models.get(problem)
        && session.is_unchanged(uses)
    {
        return Ok(model.clone());
    }
    let model = Arc::new(found_or_compiled(session, problem)?);
    let uses = session.uses_of(&model.roots, &model.files);
    session.models.keep(uses, &model);
    Ok(model)
}

/// A model that an earlier process has translated, or this one does.
fn found_or_compiled(session: &mut Session, problem: &str) -> Result<Translated, Vec<Diagnostic>> {
    let Some(request) = Request::new(session, problem) else { return compiled(session, problem) };
    if let Some(model) = request.find(session, problem) {
        return Ok(model);
    }
    let model = compiled(session, problem);
    match &model {
        Ok(model) => request.keep(session, model),
        Err(_) => session.output.overheard = None,
    }
    model
}

/// The flat model of a translated one.
///
/// # Errors
/// Its files have changed since, and something is wrong with them.
pub(crate) fn flat_model_of<'m>(
    session: &mut Session,
    model: &'m Translated,
) -> Result<&'m FlatModel, Vec<Diagnostic>> {
    if let Some(flat) = model.flat.get() {
        return Ok(flat);
    }
    let flat = flat_model(session, &model.problem)?;
    Ok(model.flat.get_or_init(|| flat))
}

/// A flat model with more equations is given back before its program is made, and made again on
/// demand: it takes a third of the memory of a translation.
const MOST_KEPT: usize = 10_000;

/// A model, translated whether it has been or not.
pub(super) fn compiled(
    session: &mut Session,
    problem: &str,
) -> Result<Translated, Vec<Diagnostic>> {
    session.classes.model_files = Reads::default();
    let flat = flat_model(session, problem)?;
    let roots = session.classes.library.uses();
    let named = strings(&flat);
    let sorted = causalize::causalize(&flat).map_err(|error| {
        let errors = by_text(session, &flat.name, error).into_iter();
        errors
            .map(|error| session.classes.in_users_terms(where_named(error, &named)))
            .collect::<Vec<_>>()
    })?;
    let one = |error: Diagnostic| vec![session.classes.in_users_terms(where_named(error, &named))];
    let (declarations, flat) = (declarations(&flat), Some(flat));
    let flat = flat.filter(|flat| flat.equations.len() <= MOST_KEPT);
    let program = Program::compile(sorted).map_err(one)?;
    warn(session, program.warnings());
    let model = match flat {
        Some(flat) => Translated::new(problem, flat, program),
        None => Translated::without_flat_model(problem, declarations, program),
    };
    Ok(Translated { roots, files: session.classes.model_files.last_answers(), ..model })
}

/// An error of an equation of a class. What a check of its text has to say of the same place tells why,
/// such as types that do not match.
fn by_text(session: &mut Session, class: &str, error: Diagnostic) -> Vec<Diagnostic> {
    let (class, at) = (Name::parse(class), error.span());
    let found = session.ask_library(|library| Ok(flatten::check(library, &class)));
    let is_same = |one: &Diagnostic| one.severity == Severity::Error && one.span() == at;
    let found: Vec<Diagnostic> = found.unwrap_or_default().into_iter().filter(is_same).collect();
    if found.is_empty() { vec![error] } else { found }
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
pub(crate) fn flattened(
    session: &mut Session,
    problem: &str,
) -> Result<flatten::Flattened, Vec<Diagnostic>> {
    let source = session.sources.add("problem", problem);
    let (name, modification) = syntax::parse_class_with_modification(source, problem)
        .map_err(|error| vec![in_argument(error, source, session.call_site())])?;
    session.autoload(&name)?;
    loop {
        let resources = session.resources_for(&name);
        session.classes.library.set_resources(resources);
        session.classes.library.forget_uses();
        let found = session
            .ask_library(|library| flatten::flatten_unbalanced(library, &name, &modification));
        // Functions that only other functions call are missed without an error.
        if session.load_requested()? {
            continue;
        }
        let (mut flattened, imbalance) = found.map_err(|errors| {
            let errors = errors.into_iter().map(|error| {
                let error = session.classes.with_misnamed_file(error, &name);
                session.classes.in_users_terms(error)
            });
            let call = session.call_site();
            errors.map(|error| in_argument(placed(error, call), source, call)).collect::<Vec<_>>()
        })?;
        if let Some(enclosing) = session.classes.enclosing_named(&name) {
            enclosing.model.clone_into(&mut flattened.model.name);
            enclosing.recorded.clone_into(&mut flattened.model.recorded);
        }
        if let Some(imbalance) = imbalance {
            let explained = causalize::explain_imbalance(&flattened.model, imbalance);
            return Err(vec![session.classes.in_users_terms(explained)]);
        }
        warn(session, &flattened.warnings);
        return Ok(flattened);
    }
}

/// The most intervals of an output: its columns are arrays of scripts, which have no more elements.
const MOST_INTERVALS: usize = crate::value::MAX_ELEMENTS - 1;

/// The settings that options, the experiment annotation and the defaults make together.
///
/// # Errors
/// An unknown method, or a number outside its domain.
pub fn settings(experiment: &Experiment, options: &SimulationOptions) -> Result<Settings, Fault> {
    let defaults = Settings::default();
    let (start, stop) = limits(experiment, options, &defaults)?;
    let intervals = intervals(experiment, options, stop - start)?;
    let tolerance = options.tolerance.or(experiment.tolerance).unwrap_or(defaults.tolerance);
    if !is_tolerance(tolerance) {
        let outside = fault!(BAD_OPTION, "`tolerance` is {tolerance}, outside 1e-14 to 0.1");
        return Err(annotated(outside, "Tolerance", options.tolerance.is_none()));
    }
    if let Some(step) = options.fixed_step.filter(|step| !(*step >= 0.0 && step.is_finite())) {
        bail!(BAD_OPTION, "the fixed step is {step} s, which is not positive";
            help: "give a positive step, or none for the length of an output interval");
    }
    let method = match &options.method {
        Some(name) => sim::find_integrator(name)?,
        None => defaults.method,
    };
    Ok(Settings {
        start,
        stop,
        output: intervals.map_or(defaults.output, OutputGrid::Intervals),
        tolerance,
        method,
        takes_exact_steps: options.takes_exact_steps && options.method.is_none(),
        step: options.fixed_step.filter(|step| *step > 0.0),
        treats_chattering: !options.stops_at_chattering,
        ..Settings::default()
    })
}

/// The first and the last time.
fn limits(
    experiment: &Experiment,
    options: &SimulationOptions,
    defaults: &Settings,
) -> Result<(f64, f64), Fault> {
    let start = options.start.or(experiment.start_time).unwrap_or(defaults.start);
    let stop = options.stop.or(experiment.stop_time).unwrap_or(start + defaults.stop);
    for (what, time) in [("start", start), ("stop", stop)] {
        if !time.is_finite() {
            bail!(BAD_OPTION, "the {what} time is {time}, which is not a finite number";
                help: "give a finite {what} time");
        }
    }
    if start > stop {
        let empty = fault!(
            BAD_OPTION, "the stop time, {stop} s, lies before the start time, {start} s";
            help: "choose a stop time that is not before the start time"
        );
        let is_annotated = options.stop.is_none() && experiment.stop_time.is_some();
        return Err(annotated(empty, "StopTime", is_annotated));
    }
    Ok((start, stop))
}

/// The number of output intervals in a time, if something is said about it.
fn intervals(
    experiment: &Experiment,
    options: &SimulationOptions,
    duration: f64,
) -> Result<Option<usize>, Fault> {
    let interval = options.interval.or(experiment.interval);
    let count = match (options.intervals, interval) {
        (Some(count), _) => match usize::try_from(count) {
            Ok(count) => count,
            Err(_) => bail!(BAD_OPTION, "the number of output intervals is {count}";
                help: "give a positive number, or none for the default"),
        },
        // What Dymola and OpenModelica write where nothing is set.
        (None, None | Some(0.0)) => return Ok(None),
        (None, Some(interval)) if interval > 0.0 => (duration / interval).round().max(1.0) as usize,
        (None, Some(interval)) => {
            let negative = fault!(
                BAD_OPTION, "the output interval is {interval} s, which is not positive";
                help: "give a positive output interval, or a number of intervals"
            );
            return Err(annotated(negative, "Interval", options.interval.is_none()));
        }
    };
    if count > MOST_INTERVALS {
        bail!(BAD_OPTION, "the output over {duration} s has more than {MOST_INTERVALS} intervals";
            help: "use a longer `outputInterval` or a smaller `numberOfIntervals`");
    }
    Ok(Some(count))
}

/// A wrong setting, which the annotation `experiment` of the model may have said.
fn annotated(fault: Fault, name: &str, is_annotated: bool) -> Fault {
    match is_annotated {
        true => fault.help(format!(
            "it is `{name}` in the `experiment` annotation of the model: correct it there, or \
             give another value for this simulation"
        )),
        false => fault,
    }
}

/// Whether solvers can keep this tolerance.
pub(crate) fn is_tolerance(tolerance: f64) -> bool {
    (1e-14..=0.1).contains(&tolerance)
}

/// An interactive simulation may take so many steps as long as it gets on.
pub(super) const MOST_STEPS: u64 = 1_000_000_000;

/// Simulates a model with the parameter values that scripts gave to it.
///
/// # Errors
/// A wish that cannot be fulfilled, or the failure in the model's words with what was computed until
/// then.
pub fn simulate(
    session: &mut Session,
    model: &Translated,
    options: &SimulationOptions,
) -> Result<Simulated, Unfinished> {
    let call = session.call_site();
    let mut settings = settings(&model.program.experiment(), options).at(call)?;
    settings.cancel = session.world.interrupt_flag();
    settings.reached = options.reached.clone();
    settings.max_total_steps = MOST_STEPS;
    settings.counts_effort = options.counts_effort;
    let (changed, mut system) = prepared(session, model)?;
    let model = changed.as_deref().unwrap_or(model);
    let mut trajectory = match &options.only {
        Some(only) => Trajectory::keeping(recorded_columns(model, only)),
        None => Trajectory::default(),
    };
    system.listen();
    let mut simulator = Simulator::new();
    let run = simulator.run(&mut system, &settings, &mut trajectory);
    report_log(session, &system);
    report_treatments(session, &system);
    report_undetermined(session, &system);
    report_notices(session, &system);
    warn_outside(session, model, &system, &trajectory, settings.tolerance);
    let written = system.journal().carry_out(session).at(call);
    let why = match run {
        Ok(_) => {
            written?;
            let span = (settings.start, settings.stop);
            let end = FinalState::of(model, &system, &trajectory, span);
            session.models.end = Some(end);
            None
        }
        Err(_) if session.world.is_interrupted() => {
            Some(Fault::new(INTERRUPTED, "interrupted").at(call))
        }
        Err(error) => Some(system.explain(&error)),
    };
    let has_begun = !trajectory.is_empty();
    let hardest = settings.counts_effort.then(|| hardest(session, &system, simulator.effort()));
    let table = result_table(model, &system, trajectory, options.only.as_ref());
    let simulated = Simulated { table, statistics: *simulator.statistics(), hardest };
    match why {
        None => Ok(simulated),
        Some(why) => Err(Unfinished { why, until: has_begun.then(|| Box::new(simulated)) }),
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
        if session.models.is_new_warning(*span, words) {
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
        if session.models.is_new_warning(span, &words) {
            let message = format!("{words} (from t = {time})");
            session.report(Fault::new(UNDETERMINED, message).help(help).at(span).warning());
        }
    }
}

/// The warnings of functions, each once.
fn report_notices(session: &mut Session, system: &System) {
    for warning in system.notices() {
        let place = warning.labels.first().map_or(Span::NONE, |label| label.span);
        if session.models.is_new_warning(place, &warning.message) {
            session.report(warning);
        }
    }
}

/// The log messages of the simulation.
fn report_log(session: &mut Session, system: &System) {
    let (messages, omitted) = system.log_messages();
    for LogMessage { time, text, warning, span } in messages {
        match warning {
            Some(code) => {
                let message = format!("{text} (at t = {time})");
                session.report(Fault::new(*code, message).at(*span).warning());
            }
            None => session.print_of_script(&format!("{text}\n")),
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
) -> Result<(Option<Arc<Translated>>, System), Diagnostic> {
    let call = session.call_site();
    let untouched = || model.program.system();
    let last = session.models.last().filter(|last| std::ptr::eq(&***last, model)).cloned();
    let Some(last) = last else { return Ok((None, untouched())) };
    if let Some(current) = &session.models.current {
        current.check_set().at(call)?;
    }
    let changed = session.shaped_model(&last)?;
    match &session.models.current {
        Some(current) => Ok((Some(changed.clone()), with_values(current, &changed).at(call)?)),
        None => Ok((None, untouched())),
    }
}

/// The system of a model, with the values of the current one.
fn with_values(current: &Current, model: &Translated) -> Result<System, Fault> {
    let mut system = model.program.system();
    for (name, value) in &current.overrides {
        system.set_parameter(model.program.find_parameter(name)?, *value)?;
    }
    let value = |name: &Arc<str>| current.imported.get(name).copied();
    let states = model.state_names().enumerate();
    let states = states.filter_map(|(at, name)| Some((at, value(name)?))).collect();
    let variables = model.program.variables().iter().enumerate();
    let discrete = variables.filter(|(_, v)| v.variability == Variability::Discrete);
    let discrete = discrete.filter_map(|(at, v)| Some((at, value(&v.name)?))).collect();
    system.begin_with(GivenStart { states, discrete });
    Ok(system)
}

/// Which columns hold a variable that is recorded.
fn recorded_columns(model: &Translated, only: &Regex) -> Vec<bool> {
    let mut recorded = Vec::new();
    for variable in model.program.variables() {
        if let Access::Observed { column, .. } = variable.access {
            if recorded.len() <= column {
                recorded.resize(column + 1, false);
            }
            recorded[column] |= only.is_match(&variable.name);
        }
    }
    recorded
}

/// The variables of a simulation that are recorded. Aliases have their own values where not all
/// are.
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
    /// Puts a variant of the model translated last, or of what scripts changed it to, in its place;
    /// its parameters have the values that scripts gave. `None`: it stays as it is.
    /// Who puts back the one before takes it back.
    pub(crate) fn vary_current(
        &mut self,
        variant: impl FnOnce(&Translated, &FlatModel) -> Result<Option<Translated>, Diagnostic>,
    ) -> Result<Arc<Translated>, Vec<Diagnostic>> {
        let (call, one) = (self.call_site(), |error: Diagnostic| vec![error]);
        let Some(mut current) = self.models.current.clone() else {
            return Err(vec![no_model().at(call)]);
        };
        let changed = match current.changes.is_empty() {
            true => current.model.clone(),
            false => self.changed_model(&current.model.clone(), &mut current.changes)?,
        };
        let flat = flat_model_of(self, &changed)?;
        let model = variant(&changed, flat).map_err(one)?.map_or(changed, Arc::new);
        current.model = model.clone();
        current.changes = Changes::default();
        self.models.current = Some(current);
        Ok(model)
    }

    /// A system in which the parameters of the model translated last, or of what scripts changed it
    /// to, have their values.
    pub(super) fn parameters_of(&mut self, model: &Arc<Translated>) -> Result<System, Diagnostic> {
        let call = self.call_site();
        let mut system = match &self.models.current {
            Some(current) => with_values(current, model).at(call)?,
            None => model.program.system(),
        };
        let computed = system.evaluate_parameters();
        computed.map_err(|_| {
            let problem = &model.problem;
            fault!(BAD_PARAMETER_VALUE, "the values of the parameters of `{problem}` cannot be \
                                         computed";
                help: "simulate the model: the message says which")
            .at(call)
        })?;
        Ok(system)
    }

    /// The model translated last as scripts changed it, translated again if need be.
    pub(super) fn shaped_model(
        &mut self,
        last: &Arc<Translated>,
    ) -> Result<Arc<Translated>, Diagnostic> {
        self.shaped_or_errors(last).map_err(|mut errors| {
            let last = errors.pop();
            errors.into_iter().for_each(|error| self.report(error));
            let call = self.call_site();
            last.unwrap_or_else(|| Fault::new(BAD_PARAMETER_VALUE, "no model").at(call))
        })
    }

    /// As [`Session::shaped_model`], with all that is wrong where it cannot be translated.
    pub(super) fn shaped_or_errors(
        &mut self,
        last: &Arc<Translated>,
    ) -> Result<Arc<Translated>, Vec<Diagnostic>> {
        let Some(mut current) = self.models.current.take() else { return Ok(last.clone()) };
        let changed = match current.changes.is_empty() {
            true => Ok(current.model.clone()),
            false => self.changed_model(&current.model.clone(), &mut current.changes),
        };
        self.models.current = Some(current);
        changed
    }

    /// The model with these changes, translated again if need be.
    fn changed_model(
        &mut self,
        model: &Arc<Translated>,
        changes: &mut Changes,
    ) -> Result<Arc<Translated>, Vec<Diagnostic>> {
        if let Some(known) = changes.model() {
            return Ok(known.clone());
        }
        let changed = Arc::new(compiled(self, &changes.problem(model, &IndexMap::new())?)?);
        changes.keep_model(changed.clone());
        Ok(changed)
    }
}

fn no_model() -> Fault {
    fault!(crate::errors::NO_TRANSLATED_MODEL, "no model has been translated";
        help: "call `translateModel(\"Package.Model\")` first")
}
