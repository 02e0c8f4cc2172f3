//! From the file to the problem: models are translated, data read.
//!
//! What an experiment sets beyond values of parameters (ties, initial values, inputs that follow
//! data) becomes a class around the model, so that it means what it means in Modelica.

use super::calibration::Calibration;
use super::data::{Note, Notes};
use super::enclosing_class::Base;
use super::file::{ExperimentEntry, OneOrMany, ProblemFile, Role};
use super::inputs::Undecided;
use super::misread::{self, Doubts};
use super::noise_test::{self, PREDICTION_STEPS};
use super::operators::{self, Named};
use super::segments::Segment;
use super::{experiment, imported, noise, operating_point, own_fitness, rest, set_file, spectrum};
use crate::Session;
use crate::diag::{At as _, Diagnostic, Fault, visible_line};
use crate::flatten::errors::UNKNOWN_CLASS;
use crate::fmi::import::Imported;
use crate::ga::optimizer::METHODS;
use crate::identify::Descriptions;
use crate::identify::fitness::{FITNESSES, Fitness};
use crate::identify::problem::inference::{Cause, ModelPredictions, Proposed, adjust};
use crate::identify::problem::{
    Experiment, Free, Inference, LIKELIHOOD, MakeSimulator, ModelSimulator, NOISE_OF_FORMULAS,
    Origins, Problem, Series, Sigma, Simulate, Stop, decide, likelihood,
};
use crate::mat::MatFile;
use crate::models::filter::UncertainStates;
use crate::registry::{self, BAD_OPTION, Options};
use crate::source::Span;
use crate::{bail, fault, results};
use indexmap::IndexMap;
use std::path::Path;
use std::sync::Arc;

/// Fitness functions whose scale is estimated unless sigma is given.
const SCALED: [&str; 4] = ["huber", "tukey", "mae", LOG_LIKELIHOOD];
/// The likelihood, which is also the objective where some sigmas are estimated.
const LOG_LIKELIHOOD: &str = "log_likelihood";

/// A problem with the experiments that are kept for validation.
pub(super) struct Built {
    pub problem: Problem,
    /// The experiments that are fitted, for drawing their curves.
    pub experiments: Vec<Experiment>,
    /// The uncertain states of each of these, where they are filtered.
    pub states: Vec<UncertainStates>,
    pub validation: Vec<(Experiment, Vec<Series>)>,
    /// The uncertain states of each of these.
    pub validation_states: Vec<UncertainStates>,
    /// The problem, its data, and every Modelica text that was read for it.
    pub origins: Origins,
    /// What should be known of the data.
    pub notes: Vec<Note>,
    /// What the file says about the parameters of the model.
    pub(crate) calibration: Option<Calibration>,
    /// What the data may mean otherwise.
    pub doubts: Doubts,
    /// The functional mock-up unit, where the model is one.
    pub unit: Option<Arc<Imported>>,
}

/// The data of an experiment and the parts of which it consists.
struct ExperimentData<'f> {
    entry: &'f ExperimentEntry,
    label: String,
    table: MatFile,
    /// The number of its rows.
    count: usize,
    segments: Vec<Segment>,
}

/// The experiments of a problem.
#[derive(Default)]
struct Experiments {
    fitted: Vec<Experiment>,
    /// The uncertain states of each of these.
    states: Vec<UncertainStates>,
    series: Vec<Series>,
    validation: Vec<(Experiment, Vec<Series>)>,
    /// The uncertain states of each of these.
    validation_states: Vec<UncertainStates>,
    rests: Vec<[Experiment; 2]>,
    /// Spectra at operating points at which nothing was measured.
    proposed: Vec<Proposed>,
    /// The relative error of simulated values.
    noise: f64,
    calibration: Option<Calibration>,
    undecided: Vec<Undecided>,
    /// The series with log-normal errors, and where that is written.
    logarithmic: Vec<(usize, Span)>,
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
) -> Result<Built, Vec<Diagnostic>> {
    let folder = path.parent().unwrap_or(Path::new(""));
    let around = session.world.read_problem(Some(folder.to_owned()));
    let built = build_in(session, file, folder);
    session.world.read_problem(around);
    built
}

/// The same; paths of the file start from this folder.
fn build_in(
    session: &mut Session,
    file: &mut ProblemFile,
    folder: &Path,
) -> Result<Built, Vec<Diagnostic>> {
    let (mut notes, mut origins) = (Notes::default(), Origins::new());
    let Prepared { mut read, free, unit } =
        prepared(session, file, folder, (&mut notes, &mut origins))?;
    let file = &*file;
    if free.is_empty() {
        let fault = fault!(BAD_OPTION, "no parameter is estimated");
        let place = file.context.places.at(&["parameters"]);
        return Err(vec![fault.help("give one a range: `k = { min = 0.1, max = 10 }`").at(place)]);
    }
    if file.fitness.is_none() || is_one_of(file, &[LOG_LIKELIHOOD]) {
        decide(&mut read.series);
    }
    let Experiments {
        fitted,
        states,
        series,
        validation,
        validation_states,
        rests,
        proposed,
        noise,
        calibration,
        undecided,
        logarithmic,
    } = read;
    let objectives = objectives(session, file, &series, noise)?;
    let parameters = with_units(free, &fitted);
    // Made once here, so that what is wrong shows before the run.
    drop(ModelSimulator::new(&fitted).map_err(one)?);
    let experiments = fitted.clone();
    let cancel = session.world.interrupt_flag();
    let models = ModelPredictions { experiments: fitted.clone(), proposed };
    let inference = super::inference::inference(file, models, cancel.as_ref()).map_err(alone)?;
    let simulator = move || Ok(Box::new(ModelSimulator::new(&fitted)?) as Box<dyn Simulate>);
    let usual = if objectives.len() > 1 { "nsga2" } else { METHODS[0].name };
    let method = operators::method(session, file, usual, parameters.len())?;
    let parts = (parameters, series, objectives);
    let mut problem = assemble(file, parts, method, noise, Box::new(simulator)).map_err(alone)?;
    problem.descriptions = descriptions(&experiments, &problem.parameters, &inference);
    problem.inference = inference;
    adjusted(file, &mut problem, &logarithmic).map_err(alone)?;
    session.add_models_read(&mut origins, &mut 0);
    let notes = notes.into_notes();
    let noise = noise_test::Questions::of(file)
        .at(file.context.places.at(&[PREDICTION_STEPS]))
        .map_err(alone)?;
    let doubts = Doubts { undecided, readings: misread::all(&file.experiment), noise, rests };
    Ok(Built {
        problem,
        experiments,
        states,
        validation,
        validation_states,
        origins,
        notes,
        calibration,
        doubts,
        unit,
    })
}

/// The experiments of a problem, and its free parameters.
struct Prepared {
    read: Experiments,
    free: Vec<Free>,
    unit: Option<Arc<Imported>>,
}

/// An experiment that is filtered, with its uncertain states.
#[derive(Clone)]
pub(super) struct FilteredExperiment {
    pub experiment: Experiment,
    pub series: Vec<Series>,
    pub states: UncertainStates,
}

/// Experiments, the free parameters of their problem, and what should be known of the data.
type Filterable = (Vec<FilteredExperiment>, Vec<Free>, Vec<Note>);

/// The experiments of a problem with process noise, its free parameters, and notes.
///
/// # Errors
///
/// Everything that is wrong with the models or the data.
pub(super) fn filtered_experiments(
    session: &mut Session,
    file: &mut ProblemFile,
    path: &Path,
) -> Result<Filterable, Vec<Diagnostic>> {
    let folder = path.parent().unwrap_or(Path::new(""));
    let (mut notes, mut origins) = (Notes::default(), Origins::new());
    let around = session.world.read_problem(Some(folder.to_owned()));
    let made = prepared(session, file, folder, (&mut notes, &mut origins));
    session.world.read_problem(around);
    let Prepared { read, free, .. } = made?;
    Ok((with_states(read.fitted, read.states, read.series), free, notes.into_notes()))
}

/// Experiments with their uncertain states and their own of all series.
pub(super) fn with_states(
    experiments: Vec<Experiment>,
    states: Vec<UncertainStates>,
    series: Vec<Series>,
) -> Vec<FilteredExperiment> {
    let mut series = series.into_iter();
    let all = experiments.into_iter().zip(states).map(|(experiment, states)| {
        let series = series.by_ref().take(experiment.observations.len()).collect();
        FilteredExperiment { experiment, series, states }
    });
    all.collect()
}

/// Reads models and data.
fn prepared(
    session: &mut Session,
    file: &mut ProblemFile,
    folder: &Path,
    (notes, origins): (&mut Notes, &mut Origins),
) -> Result<Prepared, Vec<Diagnostic>> {
    load_models(session, file, folder)?;
    let unit = imported::unit(session, file, folder)?;
    if unit.is_none() {
        check_class(session, file)?;
    } else {
        let bytes = session
            .world
            .read_bytes(&folder.join(&file.model))
            .at(file.context.places.at(&["model"]))
            .map_err(alone)?;
        origins.add(format!("`{}`", file.model), &bytes);
    }
    set_file::read(session, file, unit.as_deref(), folder, (notes, origins))?;
    let file = &*file;
    origins.add_problem(&file.table());
    let data = data_of(session, file, folder, (notes, origins))?;
    let mut free = free_parameters(file, &data).map_err(alone)?;
    let model = (file, unit.as_ref());
    let read = experiments(session, model, &data, &free, notes)?;
    noise::set_ranges(file, (&read.fitted, &read.series), &mut free).map_err(alone)?;
    Ok(Prepared { read, free, unit })
}

/// Adds priors, constraints and logarithms.
fn adjusted(
    file: &ProblemFile,
    problem: &mut Problem,
    logarithmic: &[(usize, Span)],
) -> Result<(), Diagnostic> {
    let series = logarithmic.iter().map(|own| own.0).collect();
    let seed = crate::ga::Mrg32k3a::new(&problem.seed).map(drop);
    seed.at(file.context.places.at(&["seed"]))?;
    let adjustments = super::inference::adjustments(file, &problem.parameters, series)?;
    let free: Vec<String> = problem.parameters.iter().map(|own| own.name.clone()).collect();
    adjust(problem, adjustments).map_err(|(cause, fault)| {
        fault.at(match cause {
            Cause::Series(series) => {
                let own = logarithmic.iter().find(|own| own.0 == series);
                own.map_or(Span::NONE, |own| own.1)
            }
            Cause::Prior(parameter) => {
                let name = free[parameter].split('@').next().unwrap_or_default();
                file.context.places.at(&["parameters", name, "prior"])
            }
        })
    })
}

fn one(fault: Fault) -> Vec<Diagnostic> {
    vec![fault.at(Span::NONE)]
}

fn alone(error: Diagnostic) -> Vec<Diagnostic> {
    vec![error]
}

/// Loads the Modelica files of the problem; the only class of them is its model where it names none.
fn load_models(
    session: &mut Session,
    file: &mut ProblemFile,
    folder: &Path,
) -> Result<(), Vec<Diagnostic>> {
    let mut loaded = Vec::new();
    for (number, models) in file.files.iter().enumerate() {
        let place = file.context.places.at(&["files", &number.to_string()]);
        let own = session.load_path(&folder.join(models));
        let placed = |errors: Vec<Diagnostic>| -> Vec<Diagnostic> {
            errors.into_iter().map(|own| own.or_at(place)).collect()
        };
        loaded.extend(own.map_err(placed)?);
    }
    if file.model.is_empty() {
        file.model = only_class(&loaded).at(file.context.places.at(&["files"])).map_err(alone)?;
    }
    Ok(())
}

/// Refuses a model whose class is not loaded, at its place.
fn check_class(session: &mut Session, file: &ProblemFile) -> Result<(), Vec<Diagnostic>> {
    let base =
        Base::of(&file.model, file.context.places.text(&["model"])).map_err(|error| vec![error])?;
    if session.find_class(&base.class)? {
        return Ok(());
    }
    let place = file.context.places.at(&["model"]);
    let name = base.class.to_string();
    let fault = match name.strip_suffix(".mo") {
        Some(class) => fault!(UNKNOWN_CLASS, "there is no class `{name}`")
            .help(format!("write the name of the class, `{class}`, and the file in `files`")),
        None => session.classes.unknown_class(&base.class).help(
            "name the file or folder that defines it: `files = [\"Model.mo\"]`, from the folder of \
             the problem file",
        ),
    };
    Err(vec![fault.at(place)])
}

/// Reads the data of all experiments, and cuts them where that is requested.
fn data_of<'f>(
    session: &mut Session,
    file: &'f ProblemFile,
    folder: &Path,
    (notes, origins): (&mut Notes, &mut Origins),
) -> Result<Vec<ExperimentData<'f>>, Vec<Diagnostic>> {
    let mut all = Vec::new();
    for (number, entry) in file.experiment.iter().enumerate() {
        let data = folder.join(&entry.data);
        let there = |fault: Fault| vec![fault.at(entry.places.at(&["data"]))];
        let bytes = session.world.read_bytes(&data).map_err(there)?;
        origins.add(format!("`{}`", entry.data.display()), &bytes);
        let table = results::read_data(&data.to_string_lossy(), &bytes).map_err(there)?;
        let cut = experiment::rows((entry, number), &table, notes);
        let (count, segments) = cut.map_err(alone)?;
        let label = entry.label(number);
        all.push(ExperimentData { entry, label, table, count, segments });
    }
    Ok(all)
}

fn experiments(
    session: &mut Session,
    (file, unit): (&ProblemFile, Option<&Arc<Imported>>),
    data: &[ExperimentData<'_>],
    free: &[Free],
    notes: &mut Notes,
) -> Result<Experiments, Vec<Diagnostic>> {
    let mut all = Experiments { noise: NOISE_OF_FORMULAS, ..Experiments::default() };
    let parts = data.iter().flat_map(|own| own.segments.iter().map(move |part| (own, part)));
    for (number, (own, segment)) in parts.enumerate() {
        let (entry, label) = (own.entry, own.label.as_str());
        let rows = segment.rows.clone().map(|rows| own.table.rows(rows, own.count));
        let table = rows.as_ref().unwrap_or(&own.table);
        let source = experiment::Source { file, entry, label, segment, number, table, free };
        if !file.noise.is_empty() && (unit.is_some() || entry.spectrum.is_some()) {
            return Err(vec![no_noise(unit.is_some()).at(file.context.places.at(&["noise"]))]);
        }
        let built = match (unit, &entry.spectrum) {
            (Some(unit), None) => imported::build(&source, (session, unit), notes)?,
            (None, None) => source.build(session, notes)?,
            (None, Some(own)) => spectrum::build(&source, own, session, notes)?,
            (Some(_), Some(_)) => {
                return Err(vec![no_spectrum().at(entry.places.at(&["spectrum"]))]);
            }
        };
        all.noise = all.noise.max(built.error);
        if let Some(program) = &built.program {
            all.calibration.get_or_insert_with(|| Calibration::of(file, program));
        }
        if entry.validation {
            super::covariance::refuse_kept(entry).map_err(alone)?;
            all.validation.push((built.experiment, built.series));
            all.validation_states.push(built.states);
            continue;
        }
        all.rests.extend(rest::both(entry, &built.experiment));
        all.fitted.push(built.experiment);
        all.states.push(built.states);
        let first = all.series.len();
        all.series.extend(built.series);
        if entry.spectrum.is_some() {
            all.proposed.extend(operating_point::spectra(&source, session, first)?);
        }
        let laws = super::inference::error_laws(entry).map_err(alone)?;
        for (number, own) in laws.iter().enumerate() {
            let series = &mut all.series[first + number];
            super::inference::distribute(series, own).map_err(alone)?;
            super::relative::check(file, entry, series, own.is_logarithmic).map_err(alone)?;
            all.logarithmic.extend(own.is_logarithmic.then_some((first + number, own.place)));
        }
        super::covariance::correlate(file, (entry, label), &mut all.series[first..])
            .map_err(alone)?;
        for own in built.undecided {
            if !all.undecided.contains(&own) {
                all.undecided.push(own);
            }
        }
    }
    operating_point::check(file).map_err(alone)?;
    if all.fitted.is_empty() {
        let (what, remedy) = match all.validation.is_empty() {
            true => ("there is no experiment to fit", "add a table `[[experiment]]`"),
            false => ("all experiments are for validation", "remove `validation` from one of them"),
        };
        return Err(one(fault!(BAD_OPTION, "{what}").help(remedy)));
    }
    let logarithmic: Vec<usize> = all.logarithmic.iter().map(|own| own.0).collect();
    super::covariance::check_all(file, &all.series).map_err(alone)?;
    let kept: Vec<&Series> = all.validation.iter().flat_map(|own| &own.1).collect();
    super::relative::check_all(file, (&mut all.series, &logarithmic), &kept).map_err(alone)?;
    Ok(all)
}

fn no_noise(is_unit: bool) -> Fault {
    let what = if is_unit { "FMUs" } else { "spectra" };
    fault!(BAD_OPTION, "process noise of {what} is not supported")
        .help("fit the Modelica model to measurements over time")
}

fn no_spectrum() -> Fault {
    fault!(BAD_OPTION, "spectra of FMUs are not supported")
        .help("fit the Modelica model that the FMU was exported from")
}

/// The title as it is allowed in files and on terminals.
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
    let is_computed = |own: &Series| {
        matches!(own.sigma, Sigma::Variable(_)) || !own.is_normal() || own.joint.is_some()
    };
    if series.iter().any(|own| own.sigma.is_estimated() || is_computed(own)) {
        return likelihood_alone(file, series, noise).map_err(alone);
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
    let mut objectives = Vec::new();
    for (number, name) in names.into_iter().enumerate() {
        let place = file.context.places.at(&["fitness", &number.to_string()]);
        let one = |fault: Fault| vec![fault.at(place)];
        let entry = registry::find("fitness function", FITNESSES, &name);
        if entry.is_err() && own_fitness::is_function(session, &name) {
            let own = own_fitness::compiled(session, &name, series)?;
            objectives.push((name, Box::new(own) as Box<dyn Fitness>));
            continue;
        }
        let entry = entry.map_err(one)?;
        let mut options = Options::default();
        if sigmas_are_known && SCALED.contains(&entry.name) {
            options.set("scale", 1.0);
        }
        settings.iter().for_each(|(name, value)| options.set(name, *value));
        let made = (entry.make)(&mut options).map_err(one)?;
        options.finish().map_err(one)?;
        objectives.push((entry.name.to_owned(), made));
    }
    Ok(objectives)
}

/// Whether a problem names one fitness function, without settings, and it is one of these.
fn is_one_of(file: &ProblemFile, known: &[&str]) -> bool {
    let is_known = |name: &String| {
        registry::find("fitness function", FITNESSES, name)
            .is_ok_and(|entry| known.contains(&entry.name))
    };
    match &file.fitness {
        Some(OneOrMany::One(name)) => is_known(name),
        // A record has a vector of them.
        Some(OneOrMany::Many(names)) => matches!(names.as_slice(), [name] if is_known(name)),
        None | Some(OneOrMany::Set(_)) => false,
    }
}

/// Deviations that are estimated or that the model computes, and errors that are not normal, have one
/// objective: the likelihood.
fn likelihood_alone(
    file: &ProblemFile,
    series: &[Series],
    noise: f64,
) -> Result<Vec<Objective>, Diagnostic> {
    if file.fitness.is_some() && !is_one_of(file, &["sum_of_squares", LOG_LIKELIHOOD]) {
        let fault = fault!(
            BAD_OPTION,
            "a sigma that is estimated or computed by the model, a `covariance`, and an `error` that is \
             not normal minimize the negative log-likelihood and cannot be combined with another fitness";
            help: "remove `fitness`, or give sigmas as numbers and errors that are normal"
        );
        return Err(fault.at(file.context.places.at(&["fitness"])));
    }
    let likelihood = likelihood(series, noise).map_err(|(name, fault)| {
        let has_it = |entry: &&ExperimentEntry| entry.outputs.contains_key(&name);
        let entry = file.experiment.iter().find(has_it);
        fault.at(entry.map_or(Span::NONE, |own| own.places.at(&["outputs", &name, "sigma"])))
    })?;
    Ok(vec![(LIKELIHOOD.to_owned(), likelihood)])
}

type Objective = (String, Box<dyn Fitness>);

fn assemble(
    file: &ProblemFile,
    (parameters, series, objectives): (Vec<Free>, Vec<Series>, Vec<Objective>),
    (name, method): Named,
    noise: f64,
    simulator: MakeSimulator,
) -> Result<Problem, Diagnostic> {
    let parameters = on_its_scale(file, name, method.in_natural_units(), parameters)?;
    let stop = &file.stop;
    if let Some(seconds) = stop.seconds.filter(|seconds| seconds.is_nan() || *seconds <= 0.0) {
        let fault = fault!(
            BAD_OPTION,
            "`seconds` of the stop conditions is {seconds}; it must be positive"
        );
        return Err(fault.at(file.context.places.at(&["stop", "seconds"])));
    }
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
        text: file.context.text.clone(),
        descriptions: Descriptions::default(),
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

/// What the models describe everything as that is measured, estimated or predicted.
fn descriptions(experiments: &[Experiment], free: &[Free], inference: &Inference) -> Descriptions {
    let mut descriptions = Descriptions::default();
    for experiment in experiments {
        let measured = experiment.observations.iter().map(|own| own.y_name.as_str());
        // An initial value is that of a variable.
        let estimated = free.iter().filter_map(|free| free.name.split('@').next());
        let predicted = inference.band_variables.iter().map(String::as_str);
        let names = measured.chain(estimated).chain(predicted).chain([experiment.x_name.as_str()]);
        descriptions.add(experiment.model.as_ref(), names);
    }
    descriptions
}

/// A method that searches natural units has no logarithmic scale.
fn on_its_scale(
    file: &ProblemFile,
    method: &str,
    natural: bool,
    mut parameters: Vec<Free>,
) -> Result<Vec<Free>, Diagnostic> {
    if !natural {
        return Ok(parameters);
    }
    for (name, entry) in &file.parameters {
        if entry.scale.as_deref().is_some_and(|scale| scale.starts_with("log")) {
            let fault = fault!(
                BAD_OPTION,
                "`{name}` has a logarithmic scale, but `{method}` searches on a linear scale, as \
                 published";
                help: "remove `scale`, or use `genetic`"
            );
            return Err(fault.at(file.context.places.at(&["parameters", name, "scale"])));
        }
    }
    parameters.iter_mut().for_each(|free| free.logarithmic = false);
    Ok(parameters)
}

/// The free parameters: those of single experiments once for each, initial values once for each part.
fn free_parameters(
    file: &ProblemFile,
    data: &[ExperimentData<'_>],
) -> Result<Vec<Free>, Diagnostic> {
    let mut free: Vec<Free> = Vec::new();
    for (name, entry) in &file.parameters {
        let place = file.context.places.parameter(name);
        let Role::Free { range, logarithmic } = entry.role(name).at(place)? else { continue };
        let unit = entry.unit.clone().unwrap_or_default();
        let fitted = data.iter().filter(|own| !own.entry.validation);
        let mut names: Vec<String> = fitted
            .flat_map(|own| own.segments.iter().map(|part| part.free_name(name, entry, &own.label)))
            .collect();
        if !entry.per_experiment && names.is_empty() {
            names.push(name.clone());
        }
        for name in names {
            if !free.iter().any(|known| known.name == name) {
                let own = Free::new(name, unit.clone(), range, logarithmic, entry.start);
                free.push(own.at(place)?);
            }
        }
    }
    free.extend(noise::free(file)?);
    Ok(free)
}

fn with_units(mut free: Vec<Free>, experiments: &[Experiment]) -> Vec<Free> {
    for (place, parameter) in free.iter_mut().enumerate() {
        for experiment in experiments.iter().filter(|_| parameter.unit.is_empty()) {
            let known = experiment.parameters.iter().find(|(own, _)| *own == place);
            let Some((_, name)) = known else { continue };
            let own = experiment.model.parameters().into_iter().find(|p| p.name == *name);
            parameter.unit = own.map_or_else(String::new, |own| own.unit);
            if parameter.unit.is_empty() {
                // An initial value has the unit of its variable.
                let variable = parameter.name.split_once('@').map_or(&*parameter.name, |(v, _)| v);
                parameter.unit = experiment.model.unit(variable).unwrap_or_default();
            }
            break;
        }
    }
    free
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
