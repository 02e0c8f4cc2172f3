//! The commands that linearize models.

use super::methods::with_method_of_ours;
use super::openmodelica::{completed, options, shown, simulation_result, write_results};
use super::simflags::SimulationFlags;
use super::simulation::{Request, is_model};
use super::{Args, Builtin, Failure, Family};
use crate::diag::{At, Diagnostic, Fault};
use crate::flatten::Experiment;
use crate::models::exported::with_inputs_to_come;
use crate::models::linear::Linear;
use crate::models::linearization::linearized;
use crate::models::simulation;
use crate::models::simulation::SimulationOptions;
use crate::name::Name;
use crate::value::Value;
use crate::{Dialect, Session};
use nalgebra::DMatrix;
use std::fmt::Write as _;
use std::path::Path;

/// Dymola's command.
pub(super) const FAMILY: Family = Family {
    packages: &["DymolaCommands.SimulatorAPI"],
    dialect: Some(Dialect::Dymola),
    builtins: &[Builtin { header: LINEARIZE_MODEL, run: linearize_model }],
};

/// OpenModelica's command.
pub(super) const OPENMODELICA: Family = Family {
    packages: &["OpenModelica.Scripting"],
    dialect: Some(Dialect::OpenModelica),
    builtins: &[Builtin { header: LINEARIZE, run: linearize }],
};

const LINEARIZE_MODEL: &str = r#"
function linearizeModel "Simulates a model and linearizes it at the end; writes the matrices ABCD and nx."
  input String problem = "" "Class or Class(modification); empty: the model used last";
  input Real startTime = 0.0 "s" annotation(optional = true);
  input Real stopTime = 0.0 "s; default: the start time, without a simulation" annotation(optional = true);
  input Integer numberOfIntervals = 500 annotation(optional = true);
  input Real outputInterval = 0.0 annotation(optional = true);
  input String method = "Dassl" annotation(optional = true);
  input Real tolerance = 0.0001 "relative" annotation(optional = true);
  input Real fixedstepsize = 0.0 annotation(optional = true);
  input String resultFile = "dslin" ".mat is added if the name has no extension";
  output Boolean ok;
end linearizeModel;
"#;

fn linearize_model(session: &mut Session, mut args: Args) -> Result<Value, Failure> {
    let mut request = Request::take(session, &mut args)?;
    if !is_model(session, &request.problem) {
        return Ok(false.into());
    }
    request.options.stop = request.options.stop.or(request.options.start).or(Some(0.0));
    let linear = linearized(session, &request.options, &[]);
    let Some(linear) = session.or_report_all(linear) else { return Ok(false.into()) };
    let written = write_dslin(session, &linear_file(&request.file), &linear);
    Ok(session.succeeded(written))
}

/// The file of a linear model.
pub(super) fn linear_file(name: &str) -> String {
    if name.ends_with(".mat") { name.to_owned() } else { format!("{name}.mat") }
}

/// Writes the matrices of a linear model.
pub(super) fn write_dslin(session: &mut Session, file: &str, linear: &Linear) -> Result<(), Fault> {
    session.world.write_result_file(Path::new(file), &linear.to_mat()?)
}

const LINEARIZE: &str = r#"
function linearize "Simulates a model and linearizes it at the end; writes linearized_model.mo."
  input TypeName className;
  input Real startTime = 0.0 "s" annotation(optional = true);
  input Real stopTime = 1.0 "s" annotation(optional = true);
  input Integer numberOfIntervals = 500 annotation(optional = true);
  input Real stepSize = 0.002 "has no effect";
  input Real tolerance = 1e-6 "relative" annotation(optional = true);
  input String method = "dassl" annotation(optional = true);
  input String fileNamePrefix = "" "empty: the name of the class";
  input Boolean storeInTemp = false "has no effect";
  input Boolean noClean = false "has no effect";
  input String options = "" "has no effect";
  input String outputFormat = "mat";
  input String variableFilter = ".*" "has no effect";
  input String cflags = "" "has no effect";
  input String simflags = "" "-override=name=value,… sets parameters and start values";
  output Any linearizationResult "resultFile, simulationOptions, messages";
end linearize;
"#;

fn linearize(session: &mut Session, mut args: Args) -> Result<Value, Failure> {
    let class: Name = args.take("className")?;
    let options = options(&mut args)?;
    let prefix: String = args.take("fileNamePrefix")?;
    let format: String = args.take("outputFormat")?;
    let filter: String = args.take("variableFilter")?;
    let flags: String = args.take("simflags")?;
    let prefix = if prefix.is_empty() { class.to_string() } else { prefix };
    let file = format!("{prefix}_res.{format}");
    let done = translated_and_linearized(session, &class, &options, &flags, &file);
    let (file, used, messages) = match done {
        Ok(used) => {
            let file = session.world.absolute(Path::new(&file)).display().to_string();
            (file, used, String::new())
        }
        Err(errors) => {
            let messages = errors.iter().map(|error| format!("{}\n", error.message)).collect();
            session.or_report_all::<()>(Err(errors));
            (String::new(), completed(&options, &Experiment::default()), messages)
        }
    };
    let options = shown(&used, &prefix, &format, &filter, &flags);
    Ok(simulation_result([file, options, messages]))
}

pub(super) const FILE: &str = "linearized_model.mo";

/// Writes the results to `file` and the linear model to its own; the settings used.
fn translated_and_linearized(
    session: &mut Session,
    class: &Name,
    options: &SimulationOptions,
    flags: &str,
    file: &str,
) -> Result<SimulationOptions, Vec<Diagnostic>> {
    let name = class.to_string();
    let model = with_inputs_to_come(session, |session| simulation::translate(session, &name))?;
    let at = session.call_site();
    let flags = SimulationFlags::parse(flags).at(at).map_err(|error| vec![error])?;
    let options = flags.applied_to(completed(options, &model.program.experiment()));
    let options = with_method_of_ours(session, options);
    let before = session.models.current.clone();
    let set = flags.apply(session).at(at);
    let linear = set.map_err(|error| vec![error]).and_then(|()| linearized(session, &options, &[]));
    session.models.current = before;
    let linear = linear?;
    let text = as_model(&linear, class).at(at).map_err(|error| vec![error])?;
    let written = write_results(session, &linear.results, file)
        .and_then(|()| session.world.write_result_file(Path::new(FILE), text.as_bytes()));
    written.at(at).map_err(|error| vec![error])?;
    Ok(options)
}

/// The model as Modelica.
fn as_model(linear: &Linear, class: &Name) -> Result<String, Fault> {
    let [a, b, c, d] = linear.matrices()?;
    let [x, u, y] = &linear.names;
    let (n, m, p) = (x.len(), u.len(), y.len());
    let mut text = format!(
        "model linearized_model \"{class}\"\n  parameter Integer n = {n} \"number of states\";\n  \
         parameter Integer m = {m} \"number of inputs\";\n  parameter Integer p = {p} \"number of \
         outputs\";\n  parameter Real x0[n] = {};\n  parameter Real u0[m] = {};\n",
        vector(&linear.x0),
        vector(&linear.u0)
    );
    let matrices =
        [("A", ["n", "n"], a), ("B", ["n", "m"], b), ("C", ["p", "n"], c), ("D", ["p", "m"], d)];
    for (name, [rows, columns], values) in matrices {
        let value = match values.is_empty() {
            true => format!("zeros({rows}, {columns})"),
            false => matrix(values),
        };
        let _ = writeln!(text, "  parameter Real {name}[{rows}, {columns}] = {value};");
    }
    text += "  Real x[n](start = x0);\n  input Real u[m];\n  output Real y[p];\n";
    for (letter, names) in [("x", x), ("u", u), ("y", y)] {
        for (at, name) in names.iter().enumerate() {
            let name = name.replace('\'', "\"");
            let _ = writeln!(text, "  Real '{letter}_{name}' = {letter}[{}];", at + 1);
        }
    }
    text += "equation\n  der(x) = A * x + B * u;\n  y = C * x + D * u;\nend linearized_model;\n";
    Ok(text)
}

fn vector(values: &[f64]) -> String {
    match values {
        [] => "zeros(0)".to_owned(),
        values => format!("{{{}}}", numbers(values.iter())),
    }
}

fn matrix(values: &DMatrix<f64>) -> String {
    let rows: Vec<String> = values.row_iter().map(|row| numbers(row.iter())).collect();
    format!("[{}]", rows.join("; "))
}

fn numbers<'v>(values: impl Iterator<Item = &'v f64>) -> String {
    values.map(|value| number(*value)).collect::<Vec<_>>().join(", ")
}

/// The shortest text that reads back; a whole number without a point.
fn number(value: f64) -> String {
    match value.abs() {
        size if size != 0.0 && !(1e-5..1e15).contains(&size) => format!("{value:e}"),
        _ => format!("{value}"),
    }
}
