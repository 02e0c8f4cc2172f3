//! Functional mock-up units of files: read, allowed, and simulated.

use super::ranges::Range;
use super::simulation::{MOST_STEPS, Simulated, SimulationOptions, Unfinished, settings};
use super::typed::decimal_comma;
use crate::Session;
use crate::diag::{At, Fault, suggest};
use crate::errors::{BAD_FMU, FMU_MESSAGE, INTERRUPTED};
use crate::external::errors::EXTERNAL_REFUSED;
use crate::fmi::archive::{DESCRIPTION, is_unit};
use crate::fmi::description::{self, Causality, Description, Kind, Variable, Version};
use crate::fmi::import::{
    FailureClass, Imported, InterfaceKind, Layout, LogMessage, Place, Pool, Samples, Scalar,
    SimulationFailure, is_parameter, is_recorded, library_path, refusal, sources, unusable,
    why_not_set,
};
use crate::fmi::{Archive, FmuError};
use crate::identify::{ImportedModel, Model as _};
use crate::results::{ResultTable, Series, Values};
use crate::sim::{Settings, TimeBudget, Trajectory, same_time};
use crate::{bail, fault};
use std::io::Cursor;
use std::path::Path;
use std::sync::Arc;

/// The method of a simulation in which the unit integrates itself.
pub const CO_SIMULATION: &str = "co-simulation";

/// Refuses a unit where a text is expected.
///
/// # Errors
/// The path is that of a unit: what takes it instead.
pub(crate) fn refuse_as_text(path: &Path, expected: &str) -> Result<(), Fault> {
    if !is_unit(path) {
        return Ok(());
    }
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    bail!(
        BAD_FMU,
        "`{name}` is an FMU, not {expected}";
        help: "`gapi check {name}` shows what is in it, `gapi simulate {name}` simulates it, `gapi new DATA \
               --model {name}` drafts a fit of it; scripts take it by `importFMU(\"{name}\")`"
    )
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
    let bytes = session.world.read_bytes(path)?;
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
    let description = description::read(text).map_err(wrong)?;
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
    if let Some(why) = archive.file(&required).ok().and_then(unusable) {
        bail!(BAD_FMU, "`{name}`: `{required}` {why}"; help: "export it for this machine")
    }
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
    let has_resources = archive.files().any(|(path, _)| path.starts_with("resources/"));
    let Some(host) = session.world.fmu_host() else {
        bail!(BAD_FMU, "`{name}` cannot run here: FMUs need processes of their own";
            help: "use the program `gapi`")
    };
    if !host.permits(&session.world.absolute(path)) {
        // A name alone is that of the file itself, not of a link to it.
        let is_name = path.components().count() == 1;
        let is_link = is_name && session.world.is_link(path);
        let shown = if is_link { Path::new(".").join(path) } else { path.to_owned() };
        let shown = shown.display().to_string();
        let shown = if shown.contains(' ') { format!("\"{shown}\"") } else { shown };
        bail!(
            EXTERNAL_REFUSED,
            "`{name}` brings binary code, which is not run without permission";
            help: "if you trust it, allow it with `--allow-external={shown}`: the code can do whatever \
                   you can do on this machine"
        );
    }
    let start = host.install(&archive).map_err(|why| fault!(BAD_FMU, "`{name}`: {why}"))?;
    let pool = Pool::new(start);
    Ok(Arc::new(Imported { file: name, description, has_resources, kind, pool }))
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
        let binary = unit.description.find(name).filter(|own| own.kind == Kind::Binary);
        if binary.is_some() {
            bail!(BAD_FMU, "`{name}` of `{}` is Binary and cannot be set", unit.file);
        }
        if let Some(place) = self.place_of_text(unit, name)? {
            refuse_unless_settable(unit, name, place.variable)?;
            let text = text.trim().trim_matches('"').to_owned();
            return self.set_text(unit, place, text);
        }
        let place = self.place(unit, name)?;
        let variable = unit.variable(place);
        let types = unit.description.type_of(variable);
        let items = types.map_or(&[][..], |own| &own.items[..]);
        let text = text.trim();
        // `Mode.on` is a literal as Modelica writes it.
        let last = text.rsplit('.').next().filter(|_| text.parse::<f64>().is_err());
        let named = |name: &str| items.iter().find(|item| item.name == name);
        let value = match (text, named(text).or_else(|| last.and_then(named))) {
            (_, Some(item)) => item.value as f64,
            ("true", _) if variable.kind == Kind::Boolean => 1.0,
            ("false", _) if variable.kind == Kind::Boolean => 0.0,
            (number, _) => number.parse().map_err(|_| {
                let names: Vec<&str> = items.iter().map(|item| item.name.as_str()).collect();
                fault!(BAD_FMU, "`{name}` of `{}` cannot be `{text}`", unit.file).help(
                    match variable.kind {
                        Kind::Boolean => "write `true` or `false`".to_owned(),
                        _ if names.is_empty() => {
                            decimal_comma(number).unwrap_or_else(|| "write a number".to_owned())
                        }
                        _ => format!("its literals are {}", names.join(", ")),
                    },
                )
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
        let subject = format!("`{name}` of `{}`", unit.file);
        range(unit, unit.variable(place)).check(&subject, value)?;
        self.numbers.retain(|(known, _)| *known != place);
        self.numbers.push((place, value));
        Ok(())
    }

    /// Gives a String a value; other elements of its array keep theirs.
    fn set_text(&mut self, unit: &Imported, place: Place, text: String) -> Result<(), Fault> {
        let count = self.layout(unit)?.count(place.variable);
        let start = &unit.variable(place).start;
        let begin = |at| start.get(at).or_else(|| start.first()).cloned().unwrap_or_default();
        let known = self.strings.iter().position(|(variable, _)| *variable == place.variable);
        let at = known.unwrap_or_else(|| {
            self.strings.push((place.variable, (0..count).map(begin).collect()));
            self.strings.len() - 1
        });
        let all = &mut self.strings[at].1;
        all.resize(count, String::new());
        all[place.element] = text;
        Ok(())
    }

    fn place_of_text(&self, unit: &Imported, name: &str) -> Result<Option<Place>, Fault> {
        let layout = self.layout(unit)?;
        Ok(layout.strings().iter().find(|own| own.name == name).map(|own| own.place))
    }

    fn layout(&self, unit: &Imported) -> Result<Layout, Fault> {
        unit.layout(&self.numbers).map_err(|why| fault!(BAD_FMU, "`{}`: {why}", unit.file))
    }

    fn place(&self, unit: &Imported, name: &str) -> Result<Place, Fault> {
        let layout = self.layout(unit)?;
        if layout.strings().iter().any(|own| own.name == name) {
            bail!(BAD_FMU, "`{name}` of `{}` is a String, not a number", unit.file;
                help: "give it a text");
        }
        let all = || layout.scalars().iter().chain(layout.strings());
        let names = || all().map(|scalar| scalar.name.as_str());
        layout.find(name).ok_or_else(|| {
            fault!(BAD_FMU, "`{}` has no variable `{name}`", unit.file)
                .help_if(suggest::did_you_mean(name, names()))
        })
    }
}

/// What a variable takes.
fn range<'u>(unit: &'u Imported, variable: &Variable) -> Range<'u> {
    let own = unit.description.attributes_of(variable);
    let items = unit.description.type_of(variable).map_or(&[][..], |own| &own.items[..]);
    Range {
        limits: [own.min.unwrap_or(f64::NEG_INFINITY), own.max.unwrap_or(f64::INFINITY)],
        literals: items.iter().map(|item| (item.value as f64, item.name.as_str())).collect(),
    }
}

/// The literals of the enumeration of a variable with their numbers; none for other types.
pub(crate) fn literals(unit: &Imported, variable: &Variable) -> Vec<(f64, String)> {
    let items = unit.description.type_of(variable).map_or(&[][..], |own| &own.items[..]);
    items.iter().map(|item| (item.value as f64, item.name.clone())).collect()
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
/// Settings that make no sense, and why the simulation failed, with what was computed until then.
pub fn simulate(
    session: &mut Session,
    model: &ImportedModel,
    options: &SimulationOptions,
) -> Result<Simulated, Unfinished> {
    let call = session.call_site();
    let unit = model.unit_of().clone();
    let own_method = options.method.as_deref() == Some(CO_SIMULATION);
    let options = SimulationOptions {
        method: options.method.clone().filter(|_| !own_method),
        ..options.clone()
    };
    let mut settings = settings(&unit.description.experiment.annotation(), &options).at(call)?;
    settings.cancel = session.world.interrupt_flag();
    settings.reached.clone_from(&options.reached);
    settings.max_total_steps = MOST_STEPS;
    let only = options.only.as_ref();
    let scalars = model.layout().scalars().iter();
    let scalars = scalars.filter(|scalar| is_recorded(unit.variable(scalar.place)));
    let kept = scalars.filter(|scalar| only.is_none_or(|only| only.is_match(&scalar.name)));
    let mut kept: Vec<&Scalar> = kept.collect();
    kept.sort_by_key(|scalar| !is_parameter(unit.variable(scalar.place)));
    // What gives arrays their sizes is as it was set.
    let is_structural =
        |scalar: &&Scalar| unit.variable(scalar.place).causality == Causality::StructuralParameter;
    let (structural, kept): (Vec<&Scalar>, Vec<&Scalar>) =
        kept.into_iter().partition(is_structural);
    let names: Vec<String> = kept.iter().map(|scalar| scalar.name.clone()).collect();
    let plan = model.planned(&[], &names).at(call)?;
    let mut out = Trajectory::default();
    let run = unit.pool.simulate((&plan, &[]), &settings, &mut out);
    note_messages(session, &unit);
    let (statistics, why) = match run {
        Ok(statistics) => (statistics, None),
        Err(failure) => (*failure.statistics, Some(why(session, &unit, failure).at(call))),
    };
    let why = match why {
        Some(why) if out.is_empty() => return Err(Unfinished::from(why)),
        why => why,
    };
    if let Some(sentence) = different_starts(model, (&kept, &out)) {
        session.note(FMU_MESSAGE, sentence);
    }
    let table = result_table(model, (&structural, &kept), out);
    let stop = if why.is_none() { settings.stop } else { f64::NEG_INFINITY };
    note_ends(session, (&unit, stop), &table);
    let simulated = Simulated { table, statistics, hardest: None };
    match why {
        None => Ok(simulated),
        Some(why) => Err(Unfinished { why, until: Some(Box::new(simulated)) }),
    }
}

/// Why a simulation ended early.
fn why(session: &Session, unit: &Imported, failure: SimulationFailure) -> Fault {
    let SimulationFailure { time, class, message, .. } = failure;
    if session.world.is_interrupted() {
        return fault!(INTERRUPTED, "interrupted");
    }
    let at = match class {
        // Where it was then is not known.
        FailureClass::Process | FailureClass::Hopeless | FailureClass::Instance => String::new(),
        _ => format!(" at {time} s"),
    };
    let fault = fault!(BAD_FMU, "the simulation of `{}` failed{at}: {message}", unit.file);
    let is_refused = class == FailureClass::Instance;
    fault.help_if(is_refused.then(|| no_instance(unit)))
}

/// What can be done where a unit makes no instance.
fn no_instance(unit: &Imported) -> String {
    let Description { token, version, .. } = &unit.description;
    let attribute = match version {
        Version::V2 => "guid",
        Version::V3 => "instantiationToken",
    };
    let missing = match unit.has_resources {
        true => "",
        false => "; it has no folder `resources`, which its library may need",
    };
    format!(
        "its library may be of another export than its `modelDescription.xml`, which has the \
         {attribute} `{token}`{missing}; export the FMU again, and do not pack its parts by hand"
    )
}

/// Notes where a unit has ended its simulation early, and values that are not finite.
fn note_ends(session: &mut Session, (unit, stop): (&Imported, f64), table: &ResultTable) {
    let file = &unit.file;
    if let Some(last) = table.time.last().filter(|last| **last < stop && !same_time(**last, stop)) {
        let sentence = format!("`{file}` ended the simulation at {last} s, before {stop} s");
        session.note(FMU_MESSAGE, sentence);
    }
    let mut found: Vec<String> = table
        .series
        .iter()
        .filter_map(|series| {
            let Values::Trajectory(values) = &series.values else { return None };
            let at = values.iter().position(|value| !value.is_finite())?;
            Some(format!("`{}` is {} from {} s on", series.name, values[at], table.time[at]))
        })
        .collect();
    if !found.is_empty() {
        let more = and_more(&mut found);
        let sentence = format!("`{file}` gives no numbers: {}{more}", found.join(", "));
        session.note(FMU_MESSAGE, sentence);
    }
}

/// Keeps the first of several, and says how many more there are.
fn and_more(all: &mut Vec<String>) -> String {
    let more = all.len().saturating_sub(MOST_NAMED);
    all.truncate(MOST_NAMED);
    if more > 0 { format!(" and {more} more") } else { String::new() }
}

/// How many variables a note names.
const MOST_NAMED: usize = 3;
/// Relative difference of values that are the same but for the digits of a description, or for those of
/// single precision, of which there are seven.
const WRITTEN: f64 = 1e-6;

/// The parameters that a unit starts with other values than its description says, in a sentence. A
/// simulation without steps tells.
///
/// # Errors
/// Variables that the unit does not have.
pub(crate) fn other_starts(
    model: &ImportedModel,
    free: &[String],
    time_budget: Option<TimeBudget>,
) -> Result<Option<String>, Fault> {
    let unit = model.unit_of();
    let is_set = |scalar: &&Scalar| {
        let variable = unit.variable(scalar.place);
        variable.causality == Causality::Parameter && !free.contains(&scalar.name)
    };
    let scalars: Vec<&Scalar> = model.layout().scalars().iter().filter(is_set).collect();
    let names: Vec<String> = scalars.iter().map(|scalar| scalar.name.clone()).collect();
    let plan = model.planned(&[], &names)?;
    let settings = Settings { max_total_steps: 0, time_budget, ..model.settings() };
    let mut out = Trajectory::default();
    // It fails for the lack of steps, after its first row.
    let _ = unit.pool.simulate((&plan, &[]), &settings, &mut out);
    Ok(different_starts(model, (&scalars, &out)))
}

/// The same of a simulation.
fn different_starts(
    model: &ImportedModel,
    (scalars, out): (&[&Scalar], &Trajectory),
) -> Option<String> {
    // A unit that makes no instance has no first row; the run says why.
    if out.is_empty() {
        return None;
    }
    let unit = model.unit_of();
    let mut others = Vec::new();
    for (column, scalar) in scalars.iter().enumerate() {
        let own = *out.column(column).first()?;
        let said = model.start(scalar.place);
        let has_start = !unit.variable(scalar.place).start.is_empty();
        let agrees = own == said || (own - said).abs() <= WRITTEN * own.abs().max(said.abs());
        if is_parameter(unit.variable(scalar.place)) && has_start && !agrees {
            others.push(format!("{} = {own} in the place of {said}", scalar.name));
        }
    }
    if others.is_empty() {
        return None;
    }
    let more = and_more(&mut others);
    Some(format!(
        "`{}` computes with other values than its description says: {}{more}; set those that you mean",
        unit.file,
        others.join(", ")
    ))
}

/// The results of structural parameters, and of what was recorded in this order; parameters are constant.
fn result_table(
    model: &ImportedModel,
    (structural, recorded): (&[&Scalar], &[&Scalar]),
    mut out: Trajectory,
) -> ResultTable {
    let mut table = ResultTable::new(out.time().to_vec());
    let constant = |scalar: &&Scalar| Values::Constant(model.start(scalar.place));
    let mut all: Vec<(&Scalar, Values)> =
        structural.iter().map(|scalar| (*scalar, constant(scalar))).collect();
    for (column, scalar) in recorded.iter().enumerate() {
        let values = out.take_column(column);
        let is_constant = is_parameter(model.unit_of().variable(scalar.place));
        let values = match values.first().filter(|_| is_constant) {
            Some(value) => Values::Constant(*value),
            None => Values::Trajectory(values),
        };
        all.push((*scalar, values));
    }
    table.series.extend(all.into_iter().map(|(scalar, values)| Series {
        name: scalar.name.clone(),
        unit: model.unit(&scalar.name).unwrap_or_default(),
        description: model.description(&scalar.name).unwrap_or_default(),
        values,
    }));
    table
}

/// Notes what a unit has said, each message once.
pub(crate) fn note_messages(session: &mut Session, unit: &Imported) {
    for LogMessage { category, text, is_last_of_many, .. } in unit.pool.take_messages() {
        let category = if category.is_empty() { "message" } else { category.as_str() };
        let more = match is_last_of_many {
            true => "; it said so more often, with other numbers",
            false => "",
        };
        session.note(FMU_MESSAGE, format!("`{}` says ({category}): {text}{more}", unit.file));
    }
}
