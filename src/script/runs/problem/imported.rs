//! Experiments on functional mock-up units. Nothing is around a unit as a class is around a Modelica
//! model: what an experiment sets are values of its variables and samples of its inputs.

use super::data::Notes;
use super::driven::{InputColumns, no_column};
use super::dynamics;
use super::experiment::{Abscissa, Built, Source, Subject, time_budget};
use super::file::{ExperimentEntry, ProblemFile, Role, ValueEntry};
use super::inputs::{self, Declared, Times, Undecided};
use super::parameters::Setting;
use crate::Session;
use crate::bail;
use crate::diag::{At as _, Diagnostic, Fault, suggest};
use crate::errors::BAD_FMU;
use crate::fault;
use crate::flatten::BaseType;
use crate::fmi::archive::is_unit;
use crate::fmi::description::{Causality, Kind};
use crate::fmi::import::{Imported, InterfaceKind, Layout, Samples, is_parameter, why_not_set};
use crate::identify::{ImportedModel, Model};
use crate::models::imported::{self, Given};
use crate::models::variable_unit::VariableUnit;
use crate::registry::BAD_OPTION;
use crate::source::Span;
use std::path::Path;
use std::sync::Arc;

/// The unit that is the model of a problem, if it is one.
///
/// # Errors
///
/// What is wrong with it, at the place of the model.
pub(super) fn unit(
    session: &Session,
    file: &ProblemFile,
    folder: &Path,
) -> Result<Option<Arc<Imported>>, Vec<Diagnostic>> {
    if !is_unit(Path::new(&file.model)) {
        return Ok(None);
    }
    let methods = file.experiment.iter().map(|entry| entry.integrator.as_deref());
    let mut methods: Vec<bool> =
        methods.map(|method| method == Some(imported::CO_SIMULATION)).collect();
    methods.dedup();
    let place = file.context.places.at(&["model"]);
    let method = match methods.as_slice() {
        [false] | [] => None,
        [true] => Some(imported::CO_SIMULATION),
        _ => {
            let name = imported::CO_SIMULATION;
            let fault = fault!(
                BAD_OPTION,
                "some experiments have the integrator `{name}` and others \
                                            have not"
            )
            .help("write it in all experiments, or in none");
            return Err(vec![fault.at(place)]);
        }
    };
    let unit = imported::import(session, &folder.join(&file.model), method);
    unit.map(Some).map_err(|fault| vec![fault.at(place)])
}

/// Reads an experiment on a unit.
///
/// # Errors
///
/// Data and settings that are wrong, and what only a class around a model can do.
pub(super) fn build(
    source: &Source<'_>,
    (session, unit): (&Session, &Arc<Imported>),
    notes: &mut Notes,
) -> Result<Built, Vec<Diagnostic>> {
    let one = |error: Diagnostic| vec![error];
    let entry = source.entry;
    let abscissa = &source.abscissa(notes).at(entry.places.at(&["x"])).map_err(one)?;
    refuse_dynamics(source).map_err(one)?;
    let (given, parameters) = values(source, unit).map_err(one)?;
    let (samples, undecided) = follow(source, unit, abscissa, notes).map_err(one)?;
    let model =
        imported::model(unit, given, samples).at(entry.places.at(&["data"])).map_err(one)?;
    check_names(&model, entry, &abscissa.name).map_err(one)?;
    let free: Vec<String> = parameters.iter().map(|(_, name)| name.clone()).collect();
    let budget = time_budget(session, entry).map_err(one)?;
    let others = imported::other_starts(&model, &free, budget)
        .at(entry.places.at(&["data"]))
        .map_err(one)?;
    others.into_iter().for_each(|sentence| notes.warn(sentence));
    if let Some(sentence) = other_kind(unit) {
        notes.add(sentence);
    }
    if let Some(sentence) = fixed_steps(unit) {
        notes.add(sentence);
    }
    let model: Arc<dyn Model> = Arc::new(model);
    let annotated = unit.description.experiment.annotation();
    let stop = Some(annotated.stop_time);
    let subject = Subject { model, annotated, stop, parameters };
    let observed: Vec<String> = entry.all_outputs().map(|(name, _)| name.clone()).collect();
    let (experiment, series) = source.compare(session, subject, (abscissa, &observed), notes)?;
    let error = experiment.settings.tolerance;
    Ok(Built { undecided, ..Built::plain((experiment, series), error, None) })
}

/// Which of two kinds a unit is simulated by, and how the other one is chosen.
fn other_kind(unit: &Imported) -> Option<String> {
    let description = &unit.description;
    description.model_exchange.as_ref().and(description.co_simulation.as_ref())?;
    Some(match unit.kind {
        InterfaceKind::CoSimulation => format!(
            "`{}` is simulated by co-simulation, as `integrator` says; without it by model exchange",
            unit.file
        ),
        _ => format!(
            "`{}` is simulated by model exchange, where errors of integration are controlled here; if the data are \
             those of a co-simulation, write `integrator = \"co-simulation\"` in all experiments",
            unit.file
        ),
    })
}

/// What fixed steps of a unit do to a fit: events lie on them. The reference unit `BouncingBall` has steps
/// of 0.001 s; a fit of its co-simulation takes a hundred times the simulations of one of its model exchange,
/// and finds no minimum.
fn fixed_steps(unit: &Imported) -> Option<String> {
    let own = unit.description.co_simulation.as_ref()?;
    let step = own.fixed_internal_step.filter(|_| unit.kind == InterfaceKind::CoSimulation)?;
    let remedy = match unit.description.model_exchange.is_some() {
        true => "model exchange, which it offers too, has no such jumps: leave out `integrator`",
        false => "export it for model exchange, or with smaller steps",
    };
    Some(format!(
        "`{}` integrates itself with steps of {step} s: where it has events its results jump when parameters \
         change, and there may be no intervals; {remedy}",
        unit.file
    ))
}

/// Refuses what becomes a part of the class around a Modelica model.
fn refuse_dynamics(source: &Source<'_>) -> Result<(), Diagnostic> {
    let entry = source.entry;
    let delayed = entry.all_outputs().find(|(_, column)| column.delay.is_some());
    let (what, place) = if entry.steady_state {
        ("steady_state", entry.places.at(&["steady_state"]))
    } else if let Some((name, _)) = delayed {
        ("delay", entry.places.at(&["outputs", name, "delay"]))
    } else if entry.segments.is_some() {
        ("segments", entry.places.at(&["segments"]))
    } else {
        return Ok(());
    };
    let fault = fault!(
        BAD_OPTION,
        "`{what}` of {} needs the equations of the model, which an FMU does not show", source.label;
        help: "remove it, or use the Modelica model that the FMU was made of"
    );
    Err(fault.at(place))
}

/// The values that an experiment gives, and the free parameters.
fn values(
    source: &Source<'_>,
    unit: &Imported,
) -> Result<(Given, Vec<(usize, String)>), Diagnostic> {
    let Source { file, entry, label, segment, free, .. } = *source;
    let setting =
        Setting { file, entry, label, segment, free, of_deviations: &[], of_any_deviation: &[] };
    let (mut given, mut names) = (Given::default(), Vec::new());
    for (name, parameter) in &file.parameters {
        let place = file.context.places.parameter(name);
        match parameter.role(name).at(place)? {
            Role::Free { .. } if dynamics::is_delay(file, name) => {}
            Role::Free { .. } => {
                names.push((setting.free_place(name, parameter).at(place)?, name.clone()));
            }
            Role::Fixed(value) => set(&mut given, unit, name, &value).at(place)?,
            Role::Tied(_) => {
                let fault = fault!(
                    BAD_OPTION,
                    "`{name}` is tied, which an FMU cannot be: its \
                                                parameters are numbers"
                );
                return Err(fault.help("estimate it, or give it a value with `fixed`").at(place));
            }
        }
    }
    let values = entry.set.values.iter().map(|own| ("set", own));
    for (table, (name, value)) in values.chain(entry.start.iter().map(|own| ("start", own))) {
        let place = entry.places.at(&[table, name]);
        if file.parameters.contains_key(name) {
            let fault = fault!(BAD_OPTION, "`{name}` is set both in {label} and in `[parameters]`";
                help: "remove one of the two");
            return Err(fault.at(place));
        }
        set(&mut given, unit, name, value).at(place)?;
    }
    let layout = unit.layout(&given.numbers);
    let layout =
        layout.map_err(|why| fault!(BAD_FMU, "{why}").at(file.context.places.at(&["model"])))?;
    for (_, name) in &names {
        check_free(unit, &layout, name).at(file.context.places.parameter(name))?;
    }
    Ok((given, names))
}

fn set(given: &mut Given, unit: &Imported, name: &str, value: &ValueEntry) -> Result<(), Fault> {
    match value {
        ValueEntry::Truth(value) => given.set(unit, name, f64::from(u8::from(*value))),
        ValueEntry::Text(text) => given.add(unit, name, text),
        ValueEntry::Number(_) => given.set(unit, name, value.number(name)?),
    }
}

/// Refuses, before the first simulation, what cannot be estimated.
fn check_free(unit: &Imported, layout: &Layout, name: &str) -> Result<(), Fault> {
    let Some(place) = layout.find(name) else {
        let parameters =
            layout.scalars().iter().filter(|own| is_parameter(unit.variable(own.place)));
        let names: Vec<&str> = parameters.map(|own| own.name.as_str()).collect();
        return Err(fault!(BAD_FMU, "`{}` has no parameter `{name}`", unit.file)
            .help_if(suggest::did_you_mean(name, names.iter().copied()))
            .help(format!("its parameters are {}", suggest::listed(&names))));
    };
    let variable = unit.variable(place);
    if let Some(why) = why_not_set(variable) {
        bail!(BAD_FMU, "`{name}` of `{}` {why} and cannot be estimated", unit.file);
    }
    if !variable.kind.is_float() {
        bail!(BAD_FMU, "`{name}` of `{}` is {} and cannot be estimated: only real numbers can",
            unit.file, variable.kind.word();
            help: "give it a value, `{name} = {{ fixed = … }}`, and compare the fits of several \
                   problem files with different values");
    }
    Ok(())
}

/// Refuses variables that the unit does not have.
fn check_names(
    model: &ImportedModel,
    entry: &ExperimentEntry,
    x_name: &str,
) -> Result<(), Diagnostic> {
    for name in entry.outputs.keys() {
        check_name(model, name, entry.places.at(&["outputs", name]))?;
    }
    check_name(model, x_name, entry.places.at(&["x"])).map_err(|error| entry.about_x(error))
}

fn check_name(model: &ImportedModel, name: &str, place: Span) -> Result<(), Diagnostic> {
    if name == "time" || model.layout().find(name).is_some() {
        return Ok(());
    }
    let known = model.layout().scalars().iter().map(|scalar| scalar.name.as_str());
    let fault = fault!(BAD_FMU, "`{}` has no variable `{name}`", model.name());
    Err(fault.help_if(suggest::did_you_mean(name, known)).at(place))
}

/// Samples of the inputs of an experiment.
fn follow(
    source: &Source<'_>,
    unit: &Imported,
    abscissa: &Abscissa,
    notes: &mut Notes,
) -> Result<(Vec<Samples>, Vec<Undecided>), Diagnostic> {
    let times =
        Times { name: &abscissa.name, values: &abscissa.time, origin: source.segment.origin };
    samples(source.entry, (unit, source.table), &times, notes)
}

/// Samples of the inputs that follow columns.
fn samples(
    entry: &ExperimentEntry,
    (unit, table): (&Imported, &crate::mat::MatFile),
    times: &Times<'_>,
    notes: &mut Notes,
) -> Result<(Vec<Samples>, Vec<Undecided>), Diagnostic> {
    let layout = unit.layout(&[]);
    let layout = layout.map_err(|why| fault!(BAD_FMU, "{why}").at(Span::NONE))?;
    let declared = |name: &str| declared(unit, &layout, name);
    let (all, undecided) = inputs::recorded(entry, table, times, &declared, notes)?;
    let varying = all.iter().filter(|one| !one.is_held());
    let varying: Vec<String> = varying.map(|one| format!("`{}`", one.name)).collect();
    if unit.kind == InterfaceKind::CoSimulation && !varying.is_empty() {
        notes.add(during_steps(unit, &varying.join(", ")));
    }
    let sampled = all.iter().filter_map(|one| {
        Some(Samples {
            place: layout.find(&one.name)?,
            times: one.samples().iter().map(|(time, _)| *time).collect(),
            values: one.samples().iter().map(|(_, value)| *value).collect(),
            is_held: one.is_held(),
        })
    });
    Ok((sampled.collect(), undecided))
}

/// What the inputs of co-simulation are during a step.
fn during_steps(unit: &Imported, names: &str) -> String {
    let own = unit.description.co_simulation.as_ref();
    match own.is_some_and(|own| own.can_interpolate_inputs) {
        true => format!(
            "co-simulation: the FMU gets values and derivatives of the inputs {names} at the beginning of \
             each step, and follows them during the step"
        ),
        false => format!(
            "co-simulation: during a step the inputs {names} are constant, at their mean over the step; \
             shorter steps, or model exchange where the FMU has it, follow them closer"
        ),
    }
}

/// The names of the inputs that are numbers.
fn input_names(unit: &Imported, layout: &Layout) -> Vec<String> {
    let is_input = |place| unit.variable(place).causality == Causality::Input;
    let scalars = layout.scalars().iter().filter(|scalar| is_input(scalar.place));
    scalars.map(|scalar| scalar.name.clone()).collect()
}

/// An input as the description has it.
fn declared(unit: &Imported, layout: &Layout, name: &str) -> Result<Declared, Fault> {
    let names = input_names(unit, layout);
    let names: Vec<&str> = names.iter().map(String::as_str).collect();
    let place = layout.find(name).filter(|_| names.contains(&name)).ok_or_else(|| {
        let fault = fault!(BAD_FMU, "`{}` has no input `{name}`", unit.file);
        let fault = fault.help_if(suggest::did_you_mean(name, names.iter().copied()));
        match names.is_empty() {
            true => fault.help("it has no inputs"),
            false => fault.help(format!("its inputs are {}", suggest::listed(&names))),
        }
    })?;
    let variable = unit.variable(place);
    Ok(Declared {
        base: match variable.kind {
            Kind::Boolean | Kind::Clock => BaseType::Boolean,
            kind if kind.is_float() => BaseType::Real,
            _ => BaseType::Integer,
        },
        unit: VariableUnit::of_imported(unit, variable),
        literals: imported::literals(unit, variable),
    })
}

/// Inputs of a unit that follow a file in a simulation.
pub struct FollowedInputs {
    /// Their samples.
    pub samples: Vec<Samples>,
    /// The first and the last time of the data.
    pub span: (f64, f64),
}

/// Lets the inputs of a unit follow the columns of a file that have their names.
///
/// # Errors
///
/// Files that cannot be read, without a column of time or of an input.
pub fn inputs_of(
    session: &mut Session,
    unit: &Imported,
    (path, interpolation): (&Path, Option<&str>),
) -> Result<FollowedInputs, Diagnostic> {
    let layout = unit.layout(&[]);
    let layout = layout.map_err(|why| fault!(BAD_FMU, "{why}").at(Span::NONE))?;
    let mut columns = InputColumns::read(session, path).at(Span::NONE)?;
    let names = input_names(unit, &layout);
    let is_real =
        |name: &str| layout.find(name).is_none_or(|place| unit.variable(place).kind.is_float());
    let entry = columns.entry(&names, interpolation, &is_real);
    let entry =
        entry.ok_or_else(|| no_column(&unit.file, &names, &columns.table).at(Span::NONE))?;
    let (table, notes) = (&columns.table, &mut columns.notes);
    let times = Times { name: "time", values: &columns.time, origin: columns.origin };
    let (samples, _) = samples(&entry, (unit, table), &times, notes)?;
    let span = columns.span();
    columns.tell(session);
    Ok(FollowedInputs { samples, span })
}
