//! Functional mock-up units of files: read, allowed, and simulated.

use super::simulation::{MOST_STEPS, Simulated, SimulationOptions, settings};
use crate::Session;
use crate::diag::{Fault, suggest};
use crate::errors::{BAD_FMU, BAD_PARAMETER_VALUE, FMU_MESSAGE};
use crate::external::errors::EXTERNAL_REFUSED;
use crate::flatten::Experiment;
use crate::fmi::archive::DESCRIPTION;
use crate::fmi::description::{self, Description, Kind};
use crate::fmi::import::{
    FailureClass, Imported, InterfaceKind, LogMessage, Place, Pool, Samples, SimulationFailure,
    is_parameter, is_triggered, library_path, refusal, sources, why_not_set,
};
use crate::fmi::{Archive, FmuError};
use crate::identify::{ImportedModel, Model as _};
use crate::results::{ResultTable, Series, Values};
use crate::sim::Trajectory;
use crate::{bail, fault};
use std::io::Cursor;
use std::path::Path;
use std::sync::Arc;

/// The method of a simulation in which the unit integrates itself.
pub const CO_SIMULATION: &str = "co-simulation";

/// Whether a path, or the model of a problem, is the file of a unit.
pub fn is_unit(path: &Path) -> bool {
    path.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("fmu"))
}

/// What a unit says of itself, with its archive.
pub struct UnitFile {
    /// The name of the file.
    pub name: String,
    /// The files in it.
    pub archive: Archive,
    /// The description.
    pub description: Description,
}

/// Reads a unit; nothing of it runs.
///
/// # Errors
///
/// Files that cannot be read, archives and descriptions that are not those of a unit.
pub fn read(session: &Session, path: &Path) -> Result<UnitFile, Fault> {
    let bytes = session.read_bytes(path)?;
    let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
    let wrong = |error: FmuError| {
        let fault = fault!(BAD_FMU, "`{name}` is not an FMU that can be used: {error}");
        fault.help(match error {
            FmuError::Description { .. } => {
                "correct it there, or ask the tool that has made it for an FMU that follows FMI 2.0.5 or 3.0.2"
            }
            _ => "ask the tool that has made it for an FMU of version 2.0 or 3.0",
        })
    };
    let archive = Archive::read(Cursor::new(bytes)).map_err(wrong)?;
    let text = archive.file(DESCRIPTION).map_err(wrong)?;
    let text = String::from_utf8_lossy(text);
    let description = description::read(&text).map_err(wrong)?;
    Ok(UnitFile { name, archive, description })
}

/// The kind in which a unit is simulated: the one that is asked for, else model exchange where it has
/// that, because the integrators of this program control their errors.
///
/// # Errors
///
/// A kind that it does not have; clocks; a unit without a binary for this machine.
pub fn kind(file: &UnitFile, method: Option<&str>) -> Result<InterfaceKind, Fault> {
    let UnitFile { name, archive, description } = file;
    let has = (description.model_exchange.is_some(), description.co_simulation.is_some());
    let kind = match (method == Some(CO_SIMULATION), has) {
        (true, (_, true)) | (false, (false, true)) => InterfaceKind::CoSimulation,
        (false, (true, _)) => InterfaceKind::ModelExchange,
        (true, (true, false)) => bail!(
            BAD_FMU,
            "`{name}` is made for model exchange, not for co-simulation";
            help: "leave out the method `{CO_SIMULATION}`"
        ),
        (_, (false, false)) if description.scheduled_execution.is_none() => bail!(
            BAD_FMU,
            "`{name}` says neither `ModelExchange` nor `CoSimulation`";
            help: "export it for model exchange or co-simulation"
        ),
        (_, (false, false)) => InterfaceKind::ScheduledExecution,
    };
    let clock = description.variables.iter().find(|own| own.kind == Kind::Clock);
    if let Some(clock) = clock.filter(|_| kind != InterfaceKind::ScheduledExecution) {
        bail!(
            BAD_FMU,
            "`{name}` has the clock `{}`; FMUs with clocks are simulated here by scheduled \
             execution alone", clock.name;
            help: "export it for scheduled execution, or without clocks, with events at times instead"
        );
    }
    let required =
        library_path(description, kind).map_err(|why| fault!(BAD_FMU, "`{name}`: {why}"))?;
    if archive.file(&required).is_err() {
        let sources = sources(archive, description, kind);
        if sources.map_err(|why| fault!(BAD_FMU, "`{name}`: {why}"))?.is_none() {
            return Err(no_binary(file, &required));
        }
    }
    Ok(kind)
}

/// Names what a unit has instead of a binary for this machine.
fn no_binary(file: &UnitFile, required: &str) -> Fault {
    let UnitFile { name, archive, .. } = file;
    let is_binary = |path: &&str| path.starts_with("binaries/");
    let others: Vec<&str> = archive.files().map(|(path, _)| path).filter(is_binary).collect();
    let there = match others.is_empty() {
        false => format!("it has {}", suggest::listed(&others)),
        true => "it has no binaries at all, and does not say what it is compiled of".to_owned(),
    };
    fault!(BAD_FMU, "`{name}` has no `{required}`, which this machine requires: {there}";
        help: "export it for this machine, or with its sources in C")
}

/// A unit that is ready to run.
///
/// # Errors
///
/// As [`read`] and [`kind`]; a unit that the user has not allowed.
pub fn import(
    session: &Session,
    path: &Path,
    method: Option<&str>,
) -> Result<Arc<Imported>, Fault> {
    let file = read(session, path)?;
    let kind = kind(&file, method)?;
    let UnitFile { name, archive, description } = file;
    let Some(host) = session.world.fmu_host() else {
        bail!(BAD_FMU, "`{name}` cannot run here: FMUs need processes of their own";
            help: "use the program `gapi`")
    };
    if !host.permits(&name) {
        bail!(
            EXTERNAL_REFUSED,
            "`{name}` brings binary code, which is not run without permission";
            help: "if you trust it, allow it with `--allow-external={name}`: the code can do whatever \
                   you can do on this machine"
        );
    }
    let start = host.install(&archive).map_err(|why| fault!(BAD_FMU, "`{name}`: {why}"))?;
    Ok(Arc::new(Imported { file: name, description, kind, pool: Pool::new(start) }))
}

/// What its description says of the experiment.
pub fn experiment(description: &Description) -> Experiment {
    let own = &description.experiment;
    Experiment {
        start_time: own.start,
        stop_time: own.stop,
        interval: own.step,
        tolerance: own.tolerance,
    }
}

/// Values in place of start values.
#[derive(Debug, Clone, Default)]
pub struct Given {
    /// Numbers.
    pub numbers: Vec<(Place, f64)>,
    /// Values of String variables.
    pub strings: Vec<(usize, Vec<String>)>,
}

impl Given {
    /// Adds a value that is written as text: a number, `true`, `false`, a literal of an enumeration,
    /// or a text.
    ///
    /// # Errors
    ///
    /// Names that the unit does not have, values that it does not take.
    pub fn add(&mut self, unit: &Imported, name: &str, text: &str) -> Result<(), Fault> {
        let variables = &unit.description.variables;
        let is_text = |kind| matches!(kind, Kind::String | Kind::Binary);
        let of_text = variables.iter().position(|one| one.name == name && is_text(one.kind));
        if let Some(at) = of_text {
            let variable = &variables[at];
            if variable.kind == Kind::Binary {
                bail!(BAD_FMU, "`{name}` of `{}` is Binary and cannot be set", unit.file);
            }
            refuse_unless_settable(unit, name, at)?;
            let text = text.trim().trim_matches('"').to_owned();
            self.strings.retain(|(place, _)| *place != at);
            self.strings.push((at, vec![text]));
            return Ok(());
        }
        let place = self.place(unit, name)?;
        let variable = unit.variable(place);
        let types = unit.description.type_of(variable);
        let literal = types.and_then(|own| own.items.iter().find(|item| item.name == text.trim()));
        let value = match (text.trim(), literal) {
            (_, Some(item)) => item.value as f64,
            ("true", _) => 1.0,
            ("false", _) => 0.0,
            (number, _) => number.parse().map_err(|_| {
                fault!(BAD_FMU, "`{name}` of `{}` cannot be `{text}`", unit.file)
                    .help("write a number, `true`, `false`, or a literal of its enumeration")
            })?,
        };
        self.set(unit, name, value)
    }

    /// Adds a number.
    ///
    /// # Errors
    ///
    /// As [`add`](Given::add).
    pub fn set(&mut self, unit: &Imported, name: &str, value: f64) -> Result<(), Fault> {
        let place = self.place(unit, name)?;
        refuse_unless_settable(unit, name, place.variable)?;
        if let Some(why) = refusal(unit.variable(place).kind, value) {
            bail!(BAD_FMU, "`{name}` of `{}` {why}", unit.file);
        }
        check_range(unit, name, place, value)?;
        self.numbers.retain(|(known, _)| *known != place);
        self.numbers.push((place, value));
        Ok(())
    }

    fn place(&self, unit: &Imported, name: &str) -> Result<Place, Fault> {
        let layout = unit.layout(&self.numbers);
        let layout = layout.map_err(|why| fault!(BAD_FMU, "`{}`: {why}", unit.file))?;
        let names = || layout.scalars().iter().map(|scalar| scalar.name.as_str());
        layout.find(name).ok_or_else(|| {
            fault!(BAD_FMU, "`{}` has no variable `{name}`", unit.file)
                .help_if(suggest::did_you_mean(name, names()))
        })
    }
}

/// As for parameters of models: a value outside the range that its variable declares, or that no literal
/// of its enumeration has, is not computed with.
fn check_range(unit: &Imported, name: &str, place: Place, value: f64) -> Result<(), Fault> {
    let variable = unit.variable(place);
    let own = unit.description.attributes_of(variable);
    let (min, max) = (own.min.unwrap_or(f64::NEG_INFINITY), own.max.unwrap_or(f64::INFINITY));
    if !(min..=max).contains(&value) {
        bail!(
            BAD_PARAMETER_VALUE,
            "`{name}` of `{}` is {value}, outside its range from {min} to {max}", unit.file;
            help: "the range is that of the unit's description"
        );
    }
    let items = unit.description.type_of(variable).map_or(&[][..], |own| &own.items[..]);
    if items.is_empty() || items.iter().any(|item| item.value as f64 == value) {
        return Ok(());
    }
    let literals: Vec<&str> = items.iter().map(|item| &*item.name).collect();
    Err(fault!(BAD_PARAMETER_VALUE, "`{name}` of `{}` cannot be {value}", unit.file)
        .help(format!("its values are {}", literals.join(", "))))
}

fn refuse_unless_settable(unit: &Imported, name: &str, variable: usize) -> Result<(), Fault> {
    match why_not_set(&unit.description.variables[variable]) {
        None => Ok(()),
        Some(why) => Err(fault!(BAD_FMU, "`{name}` {why} and cannot be set").help(
            "set parameters, inputs, and variables whose description says `initial=\"exact\"`",
        )),
    }
}

/// A unit with what is given.
///
/// # Errors
///
/// Arrays whose sizes are not known.
pub fn model(
    unit: &Arc<Imported>,
    given: Given,
    inputs: Vec<Samples>,
) -> Result<ImportedModel, Fault> {
    let model = ImportedModel::new(unit.clone(), given.numbers, given.strings, inputs);
    model.map_err(|why| fault!(BAD_FMU, "`{}`: {why}", unit.file))
}

/// Simulates a unit; what it says becomes notes.
///
/// # Errors
///
/// Settings that make no sense, and why the simulation failed.
pub fn simulate(
    session: &mut Session,
    model: &ImportedModel,
    options: &SimulationOptions,
) -> Result<Simulated, Fault> {
    let unit = model.unit_of().clone();
    let own_method = options.method.as_deref() == Some(CO_SIMULATION);
    let options = SimulationOptions {
        method: options.method.clone().filter(|_| !own_method),
        ..options.clone()
    };
    let mut settings = settings(&experiment(&unit.description), &options)?;
    settings.cancel = session.world.interrupt_flag();
    settings.reached.clone_from(&options.reached);
    settings.max_total_steps = MOST_STEPS;
    let only = options.only.as_ref();
    let scalars = model.layout().scalars().iter();
    let scalars = scalars.filter(|scalar| !is_triggered(unit.variable(scalar.place)));
    let kept = scalars.filter(|scalar| only.is_none_or(|only| only.is_match(&scalar.name)));
    let (parameters, recorded): (Vec<_>, Vec<_>) =
        kept.partition(|scalar| is_parameter(unit.variable(scalar.place)));
    let names: Vec<String> = recorded.iter().map(|scalar| scalar.name.clone()).collect();
    let plan = model.planned(&[], &names)?;
    let mut out = Trajectory::default();
    let run = unit.pool.simulate((&plan, &[]), &settings, &mut out);
    note_messages(session, &unit);
    let statistics = run.map_err(|failure| {
        let SimulationFailure { time, class, message } = failure;
        let at = match class {
            // Where it was then is not known.
            FailureClass::Process => String::new(),
            _ => format!(" at {time} s"),
        };
        fault!(BAD_FMU, "the simulation of `{}` failed{at}: {message}", unit.file)
    })?;
    let mut table = ResultTable::new(out.time().to_vec());
    let parameters = parameters.into_iter().map(|own| (own, None));
    let recorded = recorded.into_iter().enumerate().map(|(column, own)| (own, Some(column)));
    for (scalar, column) in parameters.chain(recorded) {
        let variable = unit.variable(scalar.place);
        table.series.push(Series {
            name: scalar.name.clone(),
            unit: model.unit(&scalar.name).unwrap_or_default(),
            description: variable.description.clone().unwrap_or_default(),
            values: match column {
                Some(column) => Values::Trajectory(out.take_column(column)),
                None => Values::Constant(model.start(scalar.place)),
            },
        });
    }
    Ok(Simulated { table, statistics, hardest: None })
}

/// Notes what a unit has said, each message once.
pub fn note_messages(session: &mut Session, unit: &Imported) {
    for LogMessage { category, text, .. } in unit.pool.take_messages() {
        let category = if category.is_empty() { "message" } else { category.as_str() };
        session.note(FMU_MESSAGE, format!("`{}` says ({category}): {text}", unit.file));
    }
}
