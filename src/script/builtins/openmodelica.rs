//! Models as OpenModelica's scripts handle them.

use super::built_models::{self, Executable};
use super::imported_units::{self, ImportedUnit};
use super::methods::with_method_of_ours;
use super::simflags::SimulationFlags;
use super::{Args, Builtin, Failure, Family};
use crate::diag::{At, Diagnostic, Fault};
use crate::errors::BAD_ARGUMENT;
use crate::fault;
use crate::flatten::Experiment;
use crate::models::simulation;
use crate::models::simulation::{SimulationOptions, Translated, Unfinished};
use crate::name::{Ident, Name};
use crate::openmodelica::flat_model::{flat_text, trivial_equations};
use crate::results::{ResultTable, Values};
use crate::runs::problem::{self, Driven};
use crate::value::{FromValue, RecordValue, Value, check_length};
use crate::{Dialect, Session};
use indexmap::IndexMap;
use regex::{Regex, RegexBuilder};
use std::path::Path;
use std::sync::Arc;

/// The commands of this file.
pub(super) const FAMILY: Family = Family {
    packages: &["OpenModelica.Scripting"],
    dialect: Some(Dialect::OpenModelica),
    builtins: &[
        Builtin { header: SIMULATE, run: simulate },
        Builtin { header: BUILD_MODEL, run: build_model },
        Builtin { header: TRANSLATE_MODEL, run: translate_model },
        Builtin { header: CHECK_MODEL, run: check_model },
        Builtin { header: INSTANTIATE_MODEL, run: instantiate_model },
        Builtin { header: VAL, run: val },
        Builtin { header: GET_PARAMETER_NAMES, run: get_parameter_names },
        Builtin { header: STRING_REPLACE, run: string_replace },
        Builtin { header: STRTOK, run: strtok },
        Builtin { header: STRING_TYPE_NAME, run: string_type_name },
        Builtin { header: STRING_VARIABLE_NAME, run: string_variable_name },
        Builtin { header: TYPE_NAME_STRINGS, run: type_name_strings },
        Builtin { header: SET_MODELICA_PATH, run: set_modelica_path },
    ],
};

const SIMULATE: &str = r#"
function simulate "Simulates a model. Defaults come from its experiment annotation."
  input TypeName className;
  input Real startTime = 0.0 "s" annotation(optional = true);
  input Real stopTime = 1.0 "s" annotation(optional = true);
  input Integer numberOfIntervals = 500 annotation(optional = true);
  input Real tolerance = 1e-6 "relative" annotation(optional = true);
  input String method = "dassl" annotation(optional = true);
  input String fileNamePrefix = "" "empty: the name of the class";
  input String options = "" "has no effect";
  input String outputFormat = "mat" "mat, csv, or empty for no file";
  input String variableFilter = ".*" "regular expression; selects the variables to store";
  input String cflags = "" "has no effect";
  input String simflags = "" "-override=name=value,… sets parameters and start values; also -overrideFile, -csvInput, -startTime, -stopTime, -stepSize, -tolerance, -s, -r";
  input String resimulateExecutable = "" "has no effect: a model is translated only once anyway";
  output Any simulationResults "resultFile, simulationOptions, messages";
end simulate;
"#;

fn simulate(session: &mut Session, mut args: Args) -> Result<Value, Failure> {
    let class: Name = args.take("className")?;
    let options = options(&mut args)?;
    let prefix: String = args.take("fileNamePrefix")?;
    let format: String = args.take("outputFormat")?;
    let flags: String = args.take("simflags")?;
    let given: String = args.take("variableFilter")?;
    let filter = filter_of(&given)?;
    let prefix = if prefix.is_empty() { class.to_string() } else { prefix };
    let file = format!("{prefix}_res.{format}");
    let mut failed = "Failed to build model";
    let done = flags_of(session, &flags).and_then(|flags| {
        if let Some(unit) = imported_units::unit_of(session, &class.to_string())? {
            return run_unit(session, unit, &options, flags, (&file, &filter));
        }
        let model = driven_model(session, &class.to_string(), &flags)?;
        failed = "Simulation execution failed for model";
        run(session, &model, &options, flags, (&file, &filter))
    });
    let messages = match &done {
        Ok(_) => String::new(),
        Err(_) => format!("{failed}: {class}"),
    };
    let (result_file, options) = match session.or_report_all(done) {
        Some((used, file)) => (session.world.absolute(file.as_ref()).display().to_string(), used),
        None => (String::new(), completed(&options, &Experiment::default())),
    };
    let options = shown(&options, &prefix, &format, &given, &flags);
    Ok(simulation_result([result_file, options, messages]))
}

/// The record that simulations return.
pub(super) fn simulation_result(strings: [String; 3]) -> Value {
    let names = ["resultFile", "simulationOptions", "messages"].map(Ident::new);
    let fields = names.into_iter().zip(strings.map(Value::from));
    Value::Record(RecordValue {
        type_name: Name::parse("SimulationResult"),
        fields: fields.collect::<IndexMap<Ident, Value>>(),
    })
}

/// The names that are stored: those that an expression matches as a whole.
fn filter_of(expression: &str) -> Result<Regex, Fault> {
    let whole = format!("^(?:{expression})$");
    RegexBuilder::new(&whole).size_limit(1 << 20).build().map_err(|_| {
        fault!(BAD_ARGUMENT, "`variableFilter` is not a valid regular expression: `{expression}`")
    })
}

const BUILD_MODEL: &str = r#"
function buildModel "Translates a model; no files are written, this program simulates it."
  input TypeName className;
  input Real startTime = 0.0 "s" annotation(optional = true);
  input Real stopTime = 1.0 "s" annotation(optional = true);
  input Integer numberOfIntervals = 500 annotation(optional = true);
  input Real tolerance = 1e-6 "relative" annotation(optional = true);
  input String method = "dassl" annotation(optional = true);
  input String fileNamePrefix = "" "empty: the name of the class";
  input String options = "";
  input String outputFormat = "mat";
  input String variableFilter = ".*";
  input String cflags = "";
  input String simflags = "";
  output String buildModelResults[2] "names of the program and of its init file, for use with `system` and `setInitXmlStartValue`; empty if translation fails";
end buildModel;
"#;

fn build_model(session: &mut Session, mut args: Args) -> Result<Value, Failure> {
    let class: Name = args.take("className")?;
    let prefix: String = args.take("fileNamePrefix")?;
    let prefix = if prefix.is_empty() { class.to_string() } else { prefix };
    let (requested, format) = (options(&mut args)?, args.take("outputFormat")?);
    let filter = filter_of(&args.take::<String>("variableFilter")?)?;
    let flags = args.take("simflags")?;
    let done = simulation::translate_anew(session, &class.to_string());
    let Some(model) = session.or_report_all(done) else {
        built_models::refuse(session, &prefix, class.to_string());
        return Ok(vec![String::new(), String::new()].into());
    };
    let classes = session.uses_of(&model.roots, &Default::default());
    let program = Executable { model, classes, options: requested, format, filter, flags };
    let init_file = built_models::keep(session, &prefix, program);
    Ok(vec![prefix, init_file].into())
}

pub(super) fn options(args: &mut Args) -> Result<SimulationOptions, Failure> {
    Ok(SimulationOptions {
        start: args.optional("startTime")?,
        stop: args.optional("stopTime")?,
        intervals: args.optional("numberOfIntervals")?,
        tolerance: args.optional("tolerance")?,
        method: args.optional("method")?,
        ..SimulationOptions::default()
    })
}

/// The settings of a simulation: what is given, what the experiment annotation says, and what is
/// the default in OpenModelica.
pub(super) fn completed(options: &SimulationOptions, experiment: &Experiment) -> SimulationOptions {
    let start = options.start.or(experiment.start_time).unwrap_or(0.0);
    let stop = options.stop.or(experiment.stop_time).unwrap_or(start + 1.0);
    let interval = experiment.interval.filter(|interval| *interval != 0.0);
    let intervals = match interval {
        Some(interval) if interval > 0.0 => {
            Some(((stop - start) / interval).round().max(1.0) as i64)
        }
        // What is wrong with it is said when the simulation begins.
        Some(_) => None,
        None => Some(500),
    };
    SimulationOptions {
        start: Some(start),
        stop: Some(stop),
        intervals: options.intervals.or(intervals),
        tolerance: options.tolerance.or(experiment.tolerance).or(Some(1e-6)),
        ..options.clone()
    }
}

/// The ending of the format that is written to no file.
const NO_FILE: &str = ".empty";

fn flags_of(session: &Session, flags: &str) -> Result<SimulationFlags, Vec<Diagnostic>> {
    let parsed = SimulationFlags::parse(flags).at(session.call_site());
    parsed.map_err(|error| vec![error])
}

/// The model, whose inputs follow the columns of a file if the flags name one: linearly between its
/// rows, as OpenModelica's programs do.
///
/// # Errors
/// Everything that is wrong with the model, or the file has no column of an input.
pub(super) fn driven_model(
    session: &mut Session,
    class: &str,
    flags: &SimulationFlags,
) -> Result<Arc<Translated>, Vec<Diagnostic>> {
    let Some(file) = &flags.csv_input else { return simulation::translate(session, class) };
    let at = session.call_site();
    let placed =
        |errors: Vec<Diagnostic>| errors.into_iter().map(|one| one.or_at(at)).collect::<Vec<_>>();
    let driven = problem::driven(session, class, Path::new(file), Some("linear"));
    simulation::translate(session, &driven.map_err(placed)?.class)
}

/// Simulates and writes the results; the settings used, and the file.
pub(super) fn run(
    session: &mut Session,
    model: &Arc<Translated>,
    options: &SimulationOptions,
    mut flags: SimulationFlags,
    (file, filter): (&str, &Regex),
) -> Result<(SimulationOptions, String), Vec<Diagnostic>> {
    let at = session.call_site();
    let one = |error: Diagnostic| vec![error];
    built_models::preset(session, &mut flags).at(at).map_err(one)?;
    flags.read_override_files(session).at(at).map_err(one)?;
    simulation::look_at(session, model);
    let options = completed(options, &model.program.experiment());
    let own_filter = flags.filter.as_deref().map(filter_of).transpose().at(at).map_err(one)?;
    let filter = own_filter.as_ref().unwrap_or(filter);
    let file = flags.result_file(file);
    let file = file.as_str();
    let before = session.models.current.clone();
    let set = flags.apply(session).at(at);
    let applied = with_method_of_ours(session, flags.applied_to(options.clone()));
    let done =
        set.map_err(Unfinished::from).and_then(|()| simulation::simulate(session, model, &applied));
    session.models.current = before;
    match done {
        Ok(done) => {
            let table = recorded(done.table, filter);
            write_results(session, &table, file).at(at).map_err(one)?;
            Ok((options, file.to_owned()))
        }
        Err(unfinished) => Err(one(kept(session, unfinished, (file, filter)))),
    }
}

/// Keeps what a simulation has computed until it failed, unless no file is asked for.
fn kept(
    session: &mut Session,
    unfinished: Unfinished,
    (file, filter): (&str, &Regex),
) -> Diagnostic {
    match file.ends_with(NO_FILE) {
        true => unfinished.why,
        false => unfinished.kept(session, file.as_ref(), |_, table| recorded(table, filter)),
    }
}

/// The results that the file of a simulation holds.
fn recorded(mut table: ResultTable, filter: &Regex) -> ResultTable {
    Driven::without_own_inputs(&mut table);
    if filter.as_str() != "^(?:.*)$" {
        table = table.only(|name| filter.is_match(name));
    }
    if table.time.len() == 1 {
        begun_and_ended(&mut table);
    }
    table
}

/// Simulates an imported unit and writes the results; the settings used, and the file.
fn run_unit(
    session: &mut Session,
    mut unit: ImportedUnit,
    options: &SimulationOptions,
    mut flags: SimulationFlags,
    (file, filter): (&str, &Regex),
) -> Result<(SimulationOptions, String), Vec<Diagnostic>> {
    let at = session.call_site();
    let one = |error: Diagnostic| vec![error];
    flags.read_override_files(session).at(at).map_err(one)?;
    if let Some(inputs) = &flags.csv_input {
        unit.follow(session, inputs).map_err(one)?;
    }
    let mut values = flags.values();
    values.try_for_each(|(name, value)| unit.set_text(name, value)).at(at).map_err(one)?;
    let options = completed(options, &unit.experiment());
    let applied = with_method_of_ours(session, flags.applied_to(options.clone()));
    let file = flags.result_file(file);
    let done = unit.simulate(session, &applied);
    let done = done.map_err(|unfinished| one(kept(session, unfinished, (&file, filter))))?;
    let table = done.table.only(|name| filter.is_match(name));
    write_results(session, &table, &file).at(at).map_err(one)?;
    Ok((options, file))
}

/// A simulation that ends where it begins has two rows, the beginning and the end.
fn begun_and_ended(table: &mut ResultTable) {
    table.time.push(table.time[0]);
    for series in &mut table.series {
        if let Values::Trajectory(values) = &mut series.values {
            values.extend(values.last().copied());
        }
    }
}

/// Writes the results of a simulation, which `val` and `plot` look at from now on.
pub(super) fn write_results(
    session: &mut Session,
    table: &ResultTable,
    file: &str,
) -> Result<(), Fault> {
    if file.ends_with(NO_FILE) {
        return Ok(());
    }
    let format = crate::results::format_of_file(file)?;
    session.world.write_results(file.as_ref(), format.as_ref(), table)?;
    super::last_results::note_results(session, file);
    Ok(())
}

/// The settings of a simulation as `simulationOptions` has them.
pub(super) fn shown(
    options: &SimulationOptions,
    prefix: &str,
    format: &str,
    filter: &str,
    flags: &str,
) -> String {
    let number = |value: Option<f64>| value.map_or(String::new(), |v| format!("{v:?}"));
    format!(
        "startTime = {}, stopTime = {}, numberOfIntervals = {}, tolerance = {}, method = '{}', \
         fileNamePrefix = '{prefix}', options = '', outputFormat = '{format}', \
         variableFilter = '{filter}', cflags = '', simflags = '{flags}'",
        number(options.start),
        number(options.stop),
        options.intervals.map_or(String::new(), |count| count.to_string()),
        number(options.tolerance),
        options.method.as_deref().unwrap_or("dassl"),
    )
}

const TRANSLATE_MODEL: &str = r#"
function translateModel "Translates a model; the other inputs have no effect."
  input TypeName className;
  input Real startTime = 0.0 "has no effect";
  input Real stopTime = 1.0 "has no effect";
  input Integer numberOfIntervals = 500 "has no effect";
  input Real tolerance = 1e-6 "has no effect";
  input String method = "dassl" "has no effect";
  input String fileNamePrefix = "" "has no effect";
  input String options = "" "has no effect";
  input String outputFormat = "mat" "has no effect";
  input String variableFilter = ".*" "has no effect";
  input String cflags = "" "has no effect";
  input String simflags = "" "has no effect";
  output Boolean success;
end translateModel;
"#;

fn translate_model(session: &mut Session, mut args: Args) -> Result<Value, Failure> {
    let class: Name = args.take("className")?;
    let done = simulation::translate(session, &class.to_string());
    Ok(session.or_report_all(done).is_some().into())
}

const CHECK_MODEL: &str = r#"
function checkModel "Checks whether a model is balanced and can be translated; returns a text."
  input TypeName className;
  output String result "empty if the check fails";
end checkModel;
"#;

fn check_model(session: &mut Session, mut args: Args) -> Result<Value, Failure> {
    let class: Name = args.take("className")?;
    let done = simulation::translated(session, &class.to_string());
    let Some(model) = session.or_report_all(done) else { return Ok("".into()) };
    let flat = simulation::flat_model_of(session, &model);
    let Some(flat) = session.or_report_all(flat) else { return Ok("".into()) };
    let unknowns = model.unknowns();
    Ok(format!(
        "Check of {class} completed successfully.\n\
         Class {class} has {unknowns} equation(s) and {unknowns} variable(s).\n\
         {} of these are trivial equation(s).",
        trivial_equations(flat)
    )
    .into())
}

const INSTANTIATE_MODEL: &str = r#"
function instantiateModel "The flat Modelica code of a model."
  input TypeName className;
  output String result "empty if it cannot be flattened";
end instantiateModel;
"#;

fn instantiate_model(session: &mut Session, mut args: Args) -> Result<Value, Failure> {
    let class: Name = args.take("className")?;
    let flat = simulation::flat_model(session, &class.to_string());
    Ok(session.or_report_all(flat).map_or(String::new(), |flat| flat_text(&flat)).into())
}

const VAL: &str = r#"
function val "The value of a variable at a time of the last simulation."
  input VariableName var;
  input Any timePoint = 0.0 "s; a number or a vector";
  input String fileName = "" "empty: the file of the last simulation";
  output Any valAtTime "a Real, or a vector with one value per time point";
end val;
"#;

fn val(session: &mut Session, mut args: Args) -> Result<Value, Failure> {
    let name: String = args.take("var")?;
    let time: Value = args.take("timePoint")?;
    let file: String = args.take("fileName")?;
    let file = match file.as_str() {
        "" | "<default>" => super::last_results::last_results(session)?.ok_or_else(|| {
            fault!(BAD_ARGUMENT, "`{name}` has no value: no model has been simulated")
        })?,
        _ => file,
    };
    let table = super::results::table(session, &file)?;
    if time.rank() == 0 {
        return Ok(table.interpolate(&name, &[f64::from_value(time)?])?[0].into());
    }
    Ok(table.interpolate(&name, &Vec::<f64>::from_value(time)?)?.into())
}

const GET_PARAMETER_NAMES: &str = r#"
function getParameterNames "Names of the parameters of a model, in order of declaration."
  input TypeName class_;
  output String parameters[:];
end getParameterNames;
"#;

fn get_parameter_names(session: &mut Session, mut args: Args) -> Result<Value, Failure> {
    let class: Name = args.take("class_")?;
    let flat = simulation::flat_model(session, &class.to_string());
    let Some(flat) = session.or_report_all(flat) else { return Ok(Vec::<String>::new().into()) };
    let is_parameter = |variable: &&crate::flatten::Variable| {
        variable.top_level && variable.variability == crate::flatten::Variability::Parameter
    };
    let names = flat.variables.values().filter(is_parameter).map(|v| v.name.to_string());
    Ok(names.collect::<Vec<String>>().into())
}

const STRING_REPLACE: &str = r#"
function stringReplace "Replaces occurrences of one string in another."
  input String str;
  input String source;
  input String target;
  output String res;
end stringReplace;
"#;

fn string_replace(_: &mut Session, mut args: Args) -> Result<Value, Failure> {
    let (text, source, target): (String, String, String) =
        (args.take("str")?, args.take("source")?, args.take("target")?);
    if source.is_empty() {
        return Ok(text.into());
    }
    let grown = text.matches(&source).count().saturating_mul(target.len());
    check_length(text.len().saturating_add(grown))?;
    Ok(text.replace(&source, &target).into())
}

const STRTOK: &str = r#"
function strtok "The parts of a string between separators, without empty parts."
  input String string;
  input String token "the separator characters";
  output String strings[:];
end strtok;
"#;

fn strtok(_: &mut Session, mut args: Args) -> Result<Value, Failure> {
    let (text, token): (String, String) = (args.take("string")?, args.take("token")?);
    let parts = text.split(|c| token.contains(c)).filter(|part| !part.is_empty());
    Ok(parts.map(str::to_owned).collect::<Vec<String>>().into())
}

const STRING_TYPE_NAME: &str = r#"
function stringTypeName "Converts a string to a class name."
  input String str;
  output TypeName cl;
end stringTypeName;
"#;

fn string_type_name(_: &mut Session, mut args: Args) -> Result<Value, Failure> {
    Ok(Value::TypeName(Name::parse(&args.take::<String>("str")?)))
}

const STRING_VARIABLE_NAME: &str = r#"
function stringVariableName "Converts a string to a variable name."
  input String str;
  output VariableName cl;
end stringVariableName;
"#;

fn string_variable_name(_: &mut Session, mut args: Args) -> Result<Value, Failure> {
    Ok(Value::VariableName(args.take("str")?))
}

const TYPE_NAME_STRINGS: &str = r#"
function typeNameStrings "The parts of a class name."
  input TypeName cl;
  output String out[:];
end typeNameStrings;
"#;

fn type_name_strings(_: &mut Session, mut args: Args) -> Result<Value, Failure> {
    let name: Name = args.take("cl")?;
    Ok(name.parts.iter().map(|part| part.to_string()).collect::<Vec<String>>().into())
}

const SET_MODELICA_PATH: &str = r#"
function setModelicaPath "Folders whose packages can be loaded by name, separated by colons."
  input String modelicaPath;
  output Boolean success;
end setModelicaPath;
"#;

fn set_modelica_path(session: &mut Session, mut args: Args) -> Result<Value, Failure> {
    let path: String = args.take("modelicaPath")?;
    let folders: Vec<&str> = path.split(':').filter(|folder| !folder.is_empty()).collect();
    folders.into_iter().for_each(|folder| session.add_library_dir(folder.as_ref()));
    Ok(true.into())
}
