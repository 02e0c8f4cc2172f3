//! Trajectories in result files.

use super::{Args, Builtin, Failure, Family};
use crate::bail;
use crate::diag::Fault;
use crate::errors::BAD_ARGUMENT;
use crate::results::{self, ResultTable};
use crate::value::{ArrayValue, Elements, RealMatrix, Value};
use crate::world::Stamp;
use crate::{Dialect, Session};
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// The commands of Dymola.
pub(super) const FAMILY: Family = Family {
    packages: &["DymolaCommands.Trajectories"],
    dialect: Some(Dialect::Dymola),
    builtins: &[
        Builtin { header: READ_TRAJECTORY_SIZE, run: read_trajectory_size },
        Builtin { header: READ_TRAJECTORY_NAMES, run: read_trajectory_names },
        Builtin { header: READ_TRAJECTORY, run: read_trajectory },
        Builtin { header: EXIST_TRAJECTORY_NAMES, run: exist_trajectory_names },
        Builtin { header: INTERPOLATE_TRAJECTORY, run: interpolate_trajectory },
        Builtin { header: WRITE_TRAJECTORY, run: write_trajectory },
    ],
};

/// The commands of OpenModelica.
pub(super) const OPENMODELICA: Family = Family {
    packages: &["OpenModelica.Scripting"],
    dialect: Some(Dialect::OpenModelica),
    builtins: &[
        Builtin { header: READ_SIMULATION_RESULT, run: read_simulation_result },
        Builtin { header: READ_SIMULATION_RESULT_VARS, run: read_simulation_result_vars },
        Builtin { header: READ_SIMULATION_RESULT_SIZE, run: read_simulation_result_size },
        Builtin { header: CLOSE_SIMULATION_RESULT_FILE, run: close_simulation_result_file },
    ],
};

/// The result file read last, kept as long as it does not change.
#[derive(Default)]
struct LastRead(Option<(PathBuf, Option<Stamp>, Arc<ResultTable>)>);

/// The results in a file; without an ending, `.mat` is meant.
pub(super) fn table(session: &mut Session, name: &str) -> Result<Arc<ResultTable>, Fault> {
    let with_ending = format!("{name}.mat");
    let found = match session.world.find_current(Path::new(name))? {
        Some(found) => Some(found),
        None => session.world.find_current(Path::new(&with_ending))?,
    };
    let found = found.ok_or_else(|| session.world.missing_file(Path::new(name)))?;
    let stamp = session.world.stamp(&found);
    if let Some((path, known, table)) = &session.extension::<LastRead>().0
        && *path == found
        && *known == stamp
    {
        return Ok(table.clone());
    }
    let format = results::format_of_file(&found.to_string_lossy())?;
    let table = Arc::new(format.read(&session.world.read_bytes(&found)?)?);
    session.extension::<LastRead>().0 = Some((found, stamp, table.clone()));
    Ok(table)
}

fn columns(table: &ResultTable, names: &[String]) -> Result<RealMatrix, Fault> {
    let mut elements = Vec::with_capacity(names.len() * table.time.len());
    for name in names {
        elements.extend(table.column(name)?);
    }
    Ok(RealMatrix { rows: names.len(), columns: table.time.len(), elements })
}

const READ_TRAJECTORY_SIZE: &str = r#"
function readTrajectorySize "Number of time points in a result file."
  input String fileName;
  output Integer size;
end readTrajectorySize;
"#;

fn read_trajectory_size(session: &mut Session, mut args: Args) -> Result<Value, Failure> {
    let file: String = args.take("fileName")?;
    Ok((table(session, &file)?.time.len() as i64).into())
}

const READ_TRAJECTORY_NAMES: &str = r#"
function readTrajectoryNames "Names of the variables in a result file, Time first."
  input String fileName;
  output String names[:];
end readTrajectoryNames;
"#;

fn read_trajectory_names(session: &mut Session, mut args: Args) -> Result<Value, Failure> {
    let file: String = args.take("fileName")?;
    let table = table(session, &file)?;
    let series = table.series.iter().map(|series| series.name.clone());
    Ok(std::iter::once("Time".to_owned()).chain(series).collect::<Vec<String>>().into())
}

const READ_TRAJECTORY: &str = r#"
function readTrajectory "Reads trajectories from a result file, one row per signal."
  input String fileName;
  input String signals[:];
  input Integer rows "number of time points, as returned by readTrajectorySize";
  output Real trajectories[size(signals, 1), rows];
end readTrajectory;
"#;

fn read_trajectory(session: &mut Session, mut args: Args) -> Result<Value, Failure> {
    let file: String = args.take("fileName")?;
    let signals: Vec<String> = args.take("signals")?;
    let rows: i64 = args.take("rows")?;
    let table = table(session, &file)?;
    if rows != table.time.len() as i64 {
        bail!(
            BAD_ARGUMENT,
            "`{file}` has {} time points instead of {rows}", table.time.len();
            help: "get the number with `readTrajectorySize(\"{file}\")`"
        );
    }
    Ok(columns(&table, &signals)?.into())
}

const EXIST_TRAJECTORY_NAMES: &str = r#"
function existTrajectoryNames "Whether a result file contains the given variables."
  input String fileName;
  input String names[:];
  output Boolean result[size(names, 1)];
end existTrajectoryNames;
"#;

fn exist_trajectory_names(session: &mut Session, mut args: Args) -> Result<Value, Failure> {
    let file: String = args.take("fileName")?;
    let names: Vec<String> = args.take("names")?;
    let table = table(session, &file)?;
    let exists = |name: &String| table.column(name).is_ok();
    Ok(names.iter().map(exists).collect::<Vec<bool>>().into())
}

const INTERPOLATE_TRAJECTORY: &str = r#"
function interpolateTrajectory "Interpolates trajectories at given times, one row per signal."
  input String fileName;
  input String signals[:];
  input Real times[:];
  output Real values[size(signals, 1), size(times, 1)];
end interpolateTrajectory;
"#;

fn interpolate_trajectory(session: &mut Session, mut args: Args) -> Result<Value, Failure> {
    let file: String = args.take("fileName")?;
    let signals: Vec<String> = args.take("signals")?;
    let times: Vec<f64> = args.take("times")?;
    let table = table(session, &file)?;
    let mut elements = Vec::with_capacity(signals.len() * times.len());
    for signal in &signals {
        elements.extend(table.interpolate(signal, &times)?);
    }
    Ok(RealMatrix { rows: signals.len(), columns: times.len(), elements }.into())
}

/// The names that an input of type `VariableName[:]` is given: several or one.
pub(super) fn variable_names(args: &mut Args, input: &str) -> Result<Vec<String>, Fault> {
    match args.take::<Value>(input)? {
        Value::Array(ArrayValue { elements: Elements::String(names), .. }) => {
            Ok(names.iter().map(|name| name.to_string()).collect())
        }
        Value::VariableName(name) | Value::String(name) => Ok(vec![name.to_string()]),
        other => bail!(BAD_ARGUMENT, "`{input}` must be names, not {}", other.type_name()),
    }
}

const WRITE_TRAJECTORY: &str = r#"
function writeTrajectory "Writes trajectories to a result file."
  input String fileName;
  input String signals[:] "the first signal is Time";
  input Real values[:, size(signals, 1)] "one column per signal; equal times mark an event";
  output Boolean ok;
end writeTrajectory;
"#;

fn write_trajectory(session: &mut Session, mut args: Args) -> Result<Value, Failure> {
    let file: String = args.take("fileName")?;
    let signals: Vec<String> = args.take("signals")?;
    let values: RealMatrix = args.take("values")?;
    let is_time = |name: &String| name.eq_ignore_ascii_case("time");
    let Some(time) = signals.iter().position(is_time) else {
        bail!(BAD_ARGUMENT, "none of `signals` is `Time`");
    };
    if values.columns != signals.len() {
        let (columns, count) = (values.columns, signals.len());
        bail!(BAD_ARGUMENT, "`values` has {columns} columns for {count} signals");
    }
    let column = |at: usize| (0..values.rows).map(|row| values.row(row)[at]).collect();
    let mut table = ResultTable::new(column(time));
    table.time_name = "Time".to_owned();
    for (at, name) in signals.iter().enumerate().filter(|(at, _)| *at != time) {
        let values = results::Values::Trajectory(column(at));
        table.series.push(results::Series::new(name.as_str(), values));
    }
    table.check().map_err(|fault| Fault::new(BAD_ARGUMENT, fault.message))?;
    let file = trajectory_file(file);
    let format = results::format_of_file(&file)?;
    let written = session.world.write_results(Path::new(&file), format.as_ref(), &table);
    Ok(session.succeeded(written))
}

/// The file that `writeTrajectory` writes.
pub(super) fn trajectory_file(name: String) -> String {
    if name.contains('.') { name } else { format!("{name}.mat") }
}

const READ_SIMULATION_RESULT: &str = r#"
function readSimulationResult "Reads trajectories from a result file, one row per variable."
  input String filename;
  input VariableName variables[:];
  input Integer size = 0 "number of time points; 0 for all";
  output Real result[:, :];
end readSimulationResult;
"#;

fn read_simulation_result(session: &mut Session, mut args: Args) -> Result<Value, Failure> {
    let file: String = args.take("filename")?;
    let names = variable_names(&mut args, "variables")?;
    let size: i64 = args.take("size")?;
    let table = table(session, &file)?;
    if size != 0 && size != table.time.len() as i64 {
        bail!(BAD_ARGUMENT, "`{file}` has {} time points instead of {size}", table.time.len());
    }
    Ok(columns(&table, &names)?.into())
}

const READ_SIMULATION_RESULT_VARS: &str = r#"
function readSimulationResultVars "Names of the variables in a result file, sorted."
  input String fileName;
  input Boolean readParameters = true;
  input Boolean openmodelicaStyle = false;
  output String vars[:];
end readSimulationResultVars;
"#;

fn read_simulation_result_vars(session: &mut Session, mut args: Args) -> Result<Value, Failure> {
    let file: String = args.take("fileName")?;
    let with_parameters: bool = args.take("readParameters")?;
    let table = table(session, &file)?;
    let is_listed = |series: &&results::Series| {
        with_parameters || !matches!(series.values, results::Values::Constant(_))
    };
    let series = table.series.iter().filter(is_listed).map(|series| series.name.clone());
    let mut names: Vec<String> = std::iter::once("time".to_owned()).chain(series).collect();
    names.sort();
    Ok(names.into())
}

const READ_SIMULATION_RESULT_SIZE: &str = r#"
function readSimulationResultSize "Number of time points in a result file."
  input String fileName;
  output Integer sz;
end readSimulationResultSize;
"#;

fn read_simulation_result_size(session: &mut Session, args: Args) -> Result<Value, Failure> {
    read_trajectory_size(session, args)
}

const CLOSE_SIMULATION_RESULT_FILE: &str = r#"
function closeSimulationResultFile "Has no effect: each file is closed after reading."
  output Boolean success;
end closeSimulationResultFile;
"#;

fn close_simulation_result_file(_: &mut Session, _: Args) -> Result<Value, Failure> {
    Ok(true.into())
}
