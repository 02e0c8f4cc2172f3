//! From the file to the problem: models are translated, data read.
//!
//! What an experiment sets beyond values of parameters (ties, initial values, inputs that follow
//! data) becomes a class around the model, so that it means what it means in Modelica.

use super::data::{self, Notes};
use super::file::{ColumnEntry, ExperimentEntry, OneOrMany, ProblemFile, Role};
use super::operators::{self, Named};
use super::{dynamics, inputs, own_fitness, sigma};
use crate::bail;
use crate::diag::{Diagnostic, Fault, visible_line};
use crate::fault;
use crate::flatten::FlatModel;
use crate::ga::optimizer::METHODS;
use crate::identify::fitness::{FITNESSES, Fitness};
use crate::identify::problem::inference::adjust;
use crate::identify::problem::{
    Experiment, Free, Inference, ModelSimulator, NOISE_OF_FORMULAS, Observation, Origins, Problem,
    Series, Sigma, Simulate, Stop, decide, likelihood,
};
use crate::identify::{CompiledModel, Model};
use crate::mat::{self, MatFile};
use crate::registry::{self, BAD_OPTION, Options};
use crate::script::Session;
use crate::script::models::simulation;
use crate::script::models::simulation::Wishes;
use crate::script::models::static_curve;
use crate::sim::{Settings, TimeBudget};
use crate::source::Span;
use crate::syntax::ast::ExpressionKind;
use crate::units::in_words;
use indexmap::IndexMap;
use std::fmt::Write;
use std::path::Path;
use std::sync::Arc;

/// Fitness functions whose scale is estimated unless sigma is given.
const ROBUST: [&str; 3] = ["huber", "tukey", "mae"];

/// A problem with the experiments that are kept for validation.
pub(super) struct Built {
    pub problem: Problem,
    /// The experiments that are fitted, for drawing their curves.
    pub experiments: Vec<Experiment>,
    pub validation: Vec<(Experiment, Vec<Series>)>,
    /// The problem, its data, and every Modelica text that was read for it.
    pub origins: Origins,
    /// What should be known of the data.
    pub notes: Vec<String>,
}

/// Something that a class around the model must hold.
#[derive(Default)]
pub(super) struct Around {
    pub(super) modifications: Vec<String>,
    pub(super) declarations: String,
    /// A section of initial equations, or nothing.
    pub(super) equations: String,
}

/// Builds the problem.
///
/// # Errors
///
/// Everything that is wrong with the models, the data or the settings.
pub(super) fn build(
    session: &mut Session,
    file: &mut ProblemFile,
    path: &Path,
    text: &str,
) -> Result<Built, Vec<Diagnostic>> {
    let one = |fault: Fault| vec![fault.at(Span::NONE)];
    let folder = path.parent().unwrap_or(Path::new("")).to_owned();
    let mut loaded = Vec::new();
    for models in &file.files {
        loaded.extend(session.load_path(&folder.join(models))?);
    }
    if file.model.is_empty() {
        file.model = only_class(&loaded).map_err(one)?;
    }
    let file = &*file;
    let mut notes = Notes::default();
    let free = free_parameters(file).map_err(one)?;
    let mut origins = Origins::new();
    origins.add("the problem", text.as_bytes());
    let (mut experiments, mut series, mut validation) = (Vec::new(), Vec::new(), Vec::new());
    let mut noise: f64 = NOISE_OF_FORMULAS;
    for (number, entry) in file.experiment.iter().enumerate() {
        let data = folder.join(&entry.data);
        let bytes = session.read_bytes(&data).map_err(one)?;
        origins.add(format!("`{}`", entry.data.display()), &bytes);
        let table = mat::read_named(&data.to_string_lossy(), &bytes).map_err(one)?;
        let built = experiment(session, file, (entry, number), &table, &free, &mut notes)?;
        let (experiment, own, has_states) = built;
        if has_states {
            noise = noise.max(experiment.settings.tolerance);
        }
        if entry.validation {
            validation.push((experiment, own));
        } else {
            experiments.push(experiment);
            series.extend(own);
        }
    }
    if experiments.is_empty() {
        return Err(one(fault!(BAD_OPTION, "there is no experiment to fit")
            .help("add a table `[[experiment]]`")));
    }
    if file.fitness.is_none() {
        decide(&mut series);
    }
    let objectives = objectives(session, file, &series, noise)?;
    let parameters = with_units(free, &experiments);
    // Made once here, so that what is wrong shows before the run.
    drop(ModelSimulator::new(&experiments).map_err(one)?);
    let fitted = experiments.clone();
    let inference = super::inference::inference(file, &experiments).map_err(one)?;
    let simulator = move || Ok(Box::new(ModelSimulator::new(&experiments)?) as Box<dyn Simulate>);
    let usual = if objectives.len() > 1 { "nsga2" } else { METHODS[0].name };
    let method = operators::method(session, file, usual, parameters.len())?;
    let parts = (parameters, series, objectives);
    let mut problem = assemble(file, parts, method, noise, Box::new(simulator)).map_err(one)?;
    problem.inference = inference;
    let adjustments = super::inference::adjustments(file, &problem.parameters).map_err(one)?;
    adjust(&mut problem, adjustments).map_err(one)?;
    problem.text = text.to_owned();
    let notes = notes.into_sentences();
    session.add_models_read(&mut origins, &mut 0);
    Ok(Built { problem, experiments: fitted, validation, origins, notes })
}

/// The title as it may stand in files and on terminals.
fn title(file: &ProblemFile) -> String {
    match &file.title {
        Some(title) => visible_line(title),
        None => format!("Identification of {}", file.model),
    }
}

/// The fitness functions by name: those of the program, else functions written in Modelica.
fn objectives(
    session: &mut Session,
    file: &ProblemFile,
    series: &[Series],
    noise: f64,
) -> Result<Vec<Objective>, Vec<Diagnostic>> {
    if series.iter().any(|series| series.sigma.is_estimated()) {
        return likelihood_alone(file, series, noise).map_err(|fault| vec![fault.at(Span::NONE)]);
    }
    let names = match &file.fitness {
        None => vec![FITNESSES[0].name.to_owned()],
        Some(OneOrMany::One(name)) => vec![name.clone()],
        Some(OneOrMany::Many(names)) => names.clone(),
        Some(OneOrMany::Set(entry)) => vec![entry.name.clone()],
    };
    let settings = match &file.fitness {
        Some(OneOrMany::Set(entry)) => entry.settings.clone(),
        _ => IndexMap::new(),
    };
    let sigmas_are_known = series.iter().all(|series| series.sigma.is_known());
    let one = |fault: Fault| vec![fault.at(Span::NONE)];
    let mut objectives = Vec::new();
    for name in names {
        let entry = registry::find("fitness function", FITNESSES, &name);
        if entry.is_err() && own_fitness::is_function(session, &name) {
            let own = own_fitness::compiled(session, &name, series)?;
            objectives.push((name, Box::new(own) as Box<dyn Fitness>));
            continue;
        }
        let entry = entry.map_err(one)?;
        let mut options = Options::default();
        if sigmas_are_known && ROBUST.contains(&entry.name) {
            options.set("scale", 1.0);
        }
        settings.iter().for_each(|(name, value)| options.set(name, *value));
        let made = (entry.make)(&mut options).map_err(one)?;
        options.finish().map_err(one)?;
        objectives.push((entry.name.to_owned(), made));
    }
    Ok(objectives)
}

/// Estimated deviations have one objective: the likelihood.
fn likelihood_alone(
    file: &ProblemFile,
    series: &[Series],
    noise: f64,
) -> Result<Vec<Objective>, Fault> {
    let known = |name: &String| {
        registry::find("fitness function", FITNESSES, name)
            .is_ok_and(|entry| ["sum_of_squares", "log_likelihood"].contains(&entry.name))
    };
    let allowed = match &file.fitness {
        None => true,
        Some(OneOrMany::One(name)) => known(name),
        Some(OneOrMany::Many(_) | OneOrMany::Set(_)) => false,
    };
    if !allowed {
        bail!(
            BAD_OPTION,
            "`sigma = \"estimate\"` minimises the negative log-likelihood and cannot be combined \
             with another fitness";
            help: "remove `fitness`, or give sigmas as numbers"
        );
    }
    Ok(vec![("negative log-likelihood".to_owned(), likelihood(series, noise)?)])
}

/// The solver's tolerance where the problem gives none, and the coarsest that an annotation of the
/// model may ask for: least squares need simulation errors that are small against the residuals. Six
/// of 13 published fits need a finer tolerance than 1e-4; 1e-9 itself was chosen, not measured.
const TOLERANCE: f64 = 1e-9;

type Objective = (String, Box<dyn Fitness>);

fn assemble(
    file: &ProblemFile,
    (parameters, series, objectives): (Vec<Free>, Vec<Series>, Vec<Objective>),
    (name, method): Named,
    noise: f64,
    simulator: Box<dyn Fn() -> Result<Box<dyn Simulate>, Fault> + Send + Sync>,
) -> Result<Problem, Fault> {
    let parameters = on_its_scale(file, name, method.in_natural_units(), parameters)?;
    let stop = &file.stop;
    let stop = Stop {
        generations: stop.generations,
        evaluations: stop.evaluations,
        seconds: stop.seconds,
        target: stop.target,
        stagnation: stop.stagnation,
    };
    Ok(Problem {
        title: title(file),
        model: file.model.clone(),
        text: String::new(),
        parameters,
        series,
        objectives,
        method_name: name.to_owned(),
        method,
        polish: file.method.polish.unwrap_or(true),
        seed: file.seed.unwrap_or([12345.0; 6]),
        stop,
        noise,
        inference: Inference::default(),
        simulator,
    })
}

/// A method that searches natural units has no logarithmic scale.
fn on_its_scale(
    file: &ProblemFile,
    method: &str,
    natural: bool,
    mut parameters: Vec<Free>,
) -> Result<Vec<Free>, Fault> {
    if !natural {
        return Ok(parameters);
    }
    for (name, entry) in &file.parameters {
        if entry.scale.as_deref().is_some_and(|scale| scale.starts_with("log")) {
            bail!(
                BAD_OPTION,
                "`{name}` has a logarithmic scale, but `{method}` searches on a linear scale, as \
                 published";
                help: "remove `scale`, or use `genetic`"
            );
        }
    }
    parameters.iter_mut().for_each(|free| free.logarithmic = false);
    Ok(parameters)
}

/// The free parameters, those of single experiments once for each.
fn free_parameters(file: &ProblemFile) -> Result<Vec<Free>, Fault> {
    let mut free = Vec::new();
    for (name, entry) in &file.parameters {
        let Role::Free { range, logarithmic } = entry.role(name)? else { continue };
        let unit = entry.unit.clone().unwrap_or_default();
        let one = |name: String| Free::new(name, unit.clone(), range, logarithmic, entry.start);
        if entry.per_experiment {
            for (number, experiment) in file.experiment.iter().enumerate() {
                if !experiment.validation {
                    free.push(one(format!("{name}@{}", label(experiment, number)))?);
                }
            }
        } else {
            free.push(one(name.clone())?);
        }
    }
    Ok(free)
}

fn with_units(mut free: Vec<Free>, experiments: &[Experiment]) -> Vec<Free> {
    for (place, parameter) in free.iter_mut().enumerate() {
        for experiment in experiments.iter().filter(|_| parameter.unit.is_empty()) {
            let known = experiment.parameters.iter().find(|(own, _)| *own == place);
            let Some((_, name)) = known else { continue };
            let own = experiment.model.parameters().into_iter().find(|p| p.name == *name);
            parameter.unit = own.map_or_else(String::new, |own| own.unit);
            break;
        }
    }
    free
}

fn label(entry: &ExperimentEntry, number: usize) -> String {
    entry.name.clone().unwrap_or_else(|| format!("experiment {}", number + 1))
}

type OneExperiment = (Experiment, Vec<Series>, bool);

fn experiment(
    session: &mut Session,
    file: &ProblemFile,
    (entry, number): (&ExperimentEntry, usize),
    table: &MatFile,
    free: &[Free],
    notes: &mut Notes,
) -> Result<OneExperiment, Vec<Diagnostic>> {
    let one = |fault: Fault| vec![fault.at(Span::NONE)];
    let name = label(entry, number);
    let x_entry =
        entry.x.as_ref().map_or_else(|| ColumnEntry::named(None), super::file::Column::entry);
    let x_name = match &x_entry.variable {
        Some(variable) => variable.clone(),
        // A bare name is both the column and, where nothing else is said, the variable.
        None => x_entry.column.clone().unwrap_or_else(|| "time".to_owned()),
    };
    notes.about(table, if table.is_table() { table.warnings.clone() } else { Vec::new() });
    let x_column = data::column(table, &x_entry, &x_name, notes).map_err(one)?;
    notes.about(table, x_column.missing.clone());
    notes.about(table, x_column.order(x_entry.column.as_deref().unwrap_or(&x_name)));
    let time = data::as_time(&x_name, &x_column, &x_entry, (table, notes)).map_err(one)?;
    let mut around = Around::default();
    let parameters = settle(file, entry, &name, free, &mut around).map_err(one)?;
    let is_driven = drive(session, file, entry, (&x_name, &x_column.values), &mut around)?;
    let parts = (entry, table, (x_name.as_str(), time.as_slice()));
    follow(session, file, parts, &mut around, notes)?;
    let mut observed = Vec::new();
    for (place, (y_name, wanted)) in entry.outputs.iter().enumerate() {
        let wanted = wanted.entry();
        let delayed = dynamics::delayed(file, y_name, place, &wanted, &x_name, &mut around);
        observed.push(delayed.map_err(one)?);
    }
    if entry.steady_state {
        let class = class_of(session, file, number, &around)?;
        let plain = simulation::translated(session, &class)?.program.clone();
        dynamics::steady(file, entry, plain.sorted(), &mut around).map_err(one)?;
    }
    let class = class_of(session, file, number, &around)?;
    let translated = simulation::translated(session, &class)?;
    let program = translated.program.clone();
    let has_states = !program.sorted().states.is_empty();
    let compiled = match is_driven {
        true => static_curve::model(&file.model, &translated, &x_name).map_err(one)?,
        false => CompiledModel::new(&file.model, program.clone()),
    };
    let model: Arc<dyn Model> = Arc::new(compiled);
    let unit = |name: &str| {
        if name == "time" { "s".to_owned() } else { model.unit(name).unwrap_or_default() }
    };
    let x = data::in_unit(&x_column, &x_name, &unit(&x_name), &x_entry, (table, notes));
    let x = x.map_err(one)?.values;
    let wishes = Wishes {
        stop: stop_time(entry, &x_name, &x, program.experiment().stop_time),
        tolerance: entry.tolerance.or(program
            .experiment()
            .tolerance
            .map_or(Some(TOLERANCE), |annotated| Some(annotated.min(TOLERANCE)))),
        method: entry.integrator.clone(),
        ..Wishes::default()
    };
    let mut settings = simulation::settings(&program.experiment(), &wishes).map_err(one)?;
    limit(session, entry, &mut settings).map_err(one)?;
    let (mut observations, mut series) = (Vec::new(), Vec::new());
    for ((y_name, wanted), observed) in entry.outputs.iter().zip(observed) {
        let wanted = wanted.entry();
        let y = data::column(table, &wanted, y_name, notes).map_err(one)?;
        let measured = data::in_unit(&y, y_name, &unit(y_name), &wanted, (table, notes));
        let measured = measured.map_err(one)?;
        if measured.factor != 1.0
            && let Some(super::file::SigmaEntry::Number(sigma)) = &wanted.sigma
        {
            notes.add(format!(
                "the sigma column {sigma} of `{y_name}` is in {}",
                in_words(&unit(y_name))
            ));
        }
        let factor =
            data::sigma_factor(table, wanted.sigma.as_ref(), &unit(y_name), measured.factor);
        let y_about = y.about;
        let y = measured.values;
        data::same_length([&x_name, y_name], [x.len(), y.len()]).map_err(one)?;
        let sigma = sigma::sigma(wanted.sigma.as_ref(), y_name, table, factor, y.len());
        let mut sigma = sigma.map_err(one)?;
        let whole = |row: &usize| x.get(*row).is_some_and(|x| x.is_finite()) && y[*row].is_finite();
        let (rows, missing): (Vec<usize>, Vec<usize>) = (0..y.len()).partition(whole);
        if let Sigma::Given(values) = &mut sigma {
            if values.len() != y.len() {
                return Err(one(fault!(
                    BAD_OPTION,
                    "the sigma of `{y_name}` in {name} has {} rows, but `{y_name}` has {}",
                    values.len(),
                    y.len()
                )));
            }
            *values = rows.iter().map(|row| values[*row]).collect();
            values.iter().try_for_each(|value| sigma::positive(y_name, *value)).map_err(one)?;
        }
        let x: Vec<f64> = rows.iter().map(|row| x[*row]).collect();
        let y: Vec<f64> = rows.iter().map(|row| y[*row]).collect();
        if x.is_empty() {
            return Err(one(fault!(BAD_OPTION, "`{y_name}` of {name} has no points")));
        }
        let weight = wanted.weight.unwrap_or(1.0) * entry.weight.unwrap_or(1.0);
        if !(weight.is_finite() && weight > 0.0) {
            return Err(one(fault!(BAD_OPTION, "the weight of `{y_name}` in {name} is {weight}")));
        }
        series.push(Series {
            experiment: name.clone(),
            y_name: y_name.clone(),
            y_unit: data::shown_unit(&unit(y_name), &wanted, &y_about),
            x_name: x_name.clone(),
            x_unit: unit(&x_name),
            file: entry.data.display().to_string(),
            x: x.clone(),
            y,
            weight,
            sigma,
            column: wanted.column.clone().unwrap_or_else(|| y_name.clone()),
            rows: rows.iter().map(|row| row + 1).collect(),
            missing: missing.iter().map(|row| row + 1).collect(),
        });
        observations.push(Observation { y_name: observed, x });
    }
    if observations.is_empty() {
        return Err(one(fault!(BAD_OPTION, "{name} has no outputs to compare")));
    }
    let experiment = Experiment {
        name,
        model,
        settings,
        second_attempt: true,
        x_name,
        observations,
        parameters,
    };
    Ok((experiment, series, has_states))
}

/// What a simulation may cost.
fn limit(session: &Session, entry: &ExperimentEntry, settings: &mut Settings) -> Result<(), Fault> {
    if let Some(steps) = entry.max_steps {
        settings.max_steps = steps;
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
fn settle(
    file: &ProblemFile,
    entry: &ExperimentEntry,
    experiment: &str,
    free: &[Free],
    around: &mut Around,
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
                _ = writeln!(around.declarations, "  parameter Real {own} = {middle:e};");
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
        around.modifications.push(match initial {
            true => format!("{name}(start = {value}, fixed = true)"),
            false => format!("{name} = {value}"),
        });
    }
    for (name, value) in &entry.set {
        if file.parameters.contains_key(name) {
            bail!(BAD_OPTION, "`{name}` is set both in {experiment} and in \
                               `[parameters]`"; help: "remove one of the two");
        }
        around.modifications.push(format!("{name} = {value:e}"));
    }
    let start = |(name, value): (&String, &f64)| format!("{name}(start = {value:e}, fixed = true)");
    around.modifications.extend(entry.start.iter().map(start));
    Ok(places)
}

/// Ties X to a parameter of the class where it is an input of the model that nothing else drives.
fn drive(
    session: &mut Session,
    file: &ProblemFile,
    entry: &ExperimentEntry,
    (x_name, x): (&str, &[f64]),
    around: &mut Around,
) -> Result<bool, Vec<Diagnostic>> {
    let is_bound = entry.inputs.contains_key(x_name) || entry.set.contains_key(x_name);
    if is_bound || !static_curve::is_driven(session, &file.model, x_name)? {
        return Ok(false);
    }
    let typical = static_curve::typical(x);
    let driver = static_curve::DRIVER;
    around.modifications.push(format!("{x_name} = {driver}"));
    _ = writeln!(around.declarations, "  parameter Real {driver} = {typical:e};");
    Ok(true)
}

/// Lets inputs follow their columns. Where one of these has a unit, that of the model is looked up in
/// the flat model.
fn follow(
    session: &mut Session,
    file: &ProblemFile,
    (entry, table, x): (&ExperimentEntry, &MatFile, (&str, &[f64])),
    around: &mut Around,
    notes: &mut Notes,
) -> Result<(), Vec<Diagnostic>> {
    let flat = match inputs::have_units(entry, table) {
        true => Some(simulation::flattened(session, &file.model)?.model),
        false => None,
    };
    let unit = |name: &str| flat.as_ref().map_or_else(String::new, |flat| unit_in(flat, name));
    let followed = inputs::inputs(entry, table, x, &unit, around, notes);
    followed.map_err(|fault| vec![fault.at(Span::NONE)])
}

/// The unit of a variable; empty where it has none.
pub(super) fn unit_in(flat: &FlatModel, name: &str) -> String {
    let unit = flat.variables.get(name).and_then(|variable| variable.attributes.get("unit"));
    match unit.map(|unit| &unit.value.kind) {
        Some(ExpressionKind::String(unit)) => unit.to_string(),
        _ => String::new(),
    }
}

/// The class of the files where a problem names none.
pub(super) fn only_class(loaded: &[crate::name::Name]) -> Result<String, Fault> {
    match loaded {
        [only] => Ok(only.to_string()),
        [] => {
            bail!(BAD_OPTION, "the problem does not name a \
                               model"; help: "write `model = \"Class\"` and list its file in `files`")
        }
        several => {
            let names: Vec<String> = several.iter().map(ToString::to_string).collect();
            bail!(
                BAD_OPTION,
                "the files contain several classes: {}", names.join(", ");
                help: "select one: `model = \"{}\"`", names[0]
            )
        }
    }
}

/// The class to translate: the model itself, or one around it.
fn class_of(
    session: &mut Session,
    file: &ProblemFile,
    number: usize,
    around: &Around,
) -> Result<String, Vec<Diagnostic>> {
    if around.modifications.is_empty() && around.declarations.is_empty() {
        return Ok(file.model.clone());
    }
    let (class, inner) = match file.model.split_once('(') {
        Some((class, inner)) => (class.trim(), inner.trim_end().strip_suffix(')').unwrap_or(inner)),
        None => (file.model.trim(), ""),
    };
    let own = std::iter::once(inner.trim()).filter(|inner| !inner.is_empty());
    let all: Vec<&str> = own.chain(around.modifications.iter().map(String::as_str)).collect();
    let name = format!("GAPILibExperiment{}", number + 1);
    let text = format!(
        "model {name}\n  extends {class}(\n    {});\n{}{}end {name};\n",
        all.join(",\n    "),
        around.declarations,
        around.equations
    );
    session.load_text(&format!("experiment {} of the problem", number + 1), &text)?;
    Ok(name)
}
