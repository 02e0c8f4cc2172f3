//! Simulations with given values that return values: once, or once for each row of values.

use super::inputs;
use super::linearization::write_dslin;
use super::simulation::{Request, Simulable, is_model, result_path, to_simulate};
use super::{Args, Builtin, Failure, Family};
use crate::bail;
use crate::diag::Fault;
use crate::errors::BAD_ARGUMENT;
use crate::models::linearization::linearized;
use crate::models::simulation::Simulated;
use crate::results::ResultTable;
use crate::value::{ArrayValue, Elements, RealMatrix, Value, element_count};
use crate::{Dialect, Session};

/// The commands of this file.
pub(super) const FAMILY: Family = Family {
    packages: &["DymolaCommands.SimulatorAPI"],
    dialect: Some(Dialect::Dymola),
    builtins: &[
        Builtin { header: SIMULATE_EXTENDED_MODEL, run: simulate_extended_model },
        Builtin { header: SIMULATE_MULTI_EXTENDED_MODEL, run: simulate_multi_extended_model },
        Builtin { header: SIMULATE_MULTI_RESULTS_MODEL, run: simulate_multi_results_model },
    ],
};

/// What stands among the initial names where the models are linearized too.
pub(super) const LINEARIZE: &str = "linearize:";

const SIMULATE_EXTENDED_MODEL: &str = inputs::header!(
    "simulateExtendedModel",
    "Simulates a model with given parameter and start values and returns final values.",
    inputs::simulation!(),
    inputs::initial_names!(),
    r#"  input Real initialValues[:] = fill(0.0, 0) "their values";
  input String finalNames[:] = fill("", 0) "variables whose final values are returned";
  input Boolean autoLoad = true "has no effect: nothing is plotted";
  output Boolean ok;
  output Real finalValues[size(finalNames, 1)];
"#
);

fn simulate_extended_model(session: &mut Session, mut args: Args) -> Result<Value, Failure> {
    let request = Request::take(session, &mut args)?;
    let names: Vec<String> = args.take("initialNames")?;
    let values: Vec<f64> = args.take("initialValues")?;
    let finals: Vec<String> = args.take("finalNames")?;
    check_count(&names, values.len())?;
    let failed = || Value::Tuple(vec![false.into(), vec![f64::NAN; finals.len()].into()]);
    let Some(mut model) = to_simulate(session, &request.problem) else { return Ok(failed()) };
    let done = for_this_call(session, |session| {
        simulated(session, &mut model, &request, &names, &values)
    })?;
    let Some(simulated) = done else { return Ok(failed()) };
    Ok(Value::Tuple(vec![true.into(), last_values(&simulated.table, &finals)?.into()]))
}

const SIMULATE_MULTI_EXTENDED_MODEL: &str = inputs::header!(
    "simulateMultiExtendedModel",
    "Simulates a model once for each row of parameter and start values and returns final values.",
    inputs::simulation!(),
    inputs::initial_names!(),
    r#"  input Real initialValues[:, :] = fill(0.0, 0, 0) "one row for each simulation";
  input String finalNames[:] = fill("", 0) "variables whose final values are returned";
  output Boolean ok;
  output Real finalValues[size(initialValues, 1), size(finalNames, 1)] "NaN where a simulation failed";
"#
);

fn simulate_multi_extended_model(session: &mut Session, mut args: Args) -> Result<Value, Failure> {
    let request = Request::take(session, &mut args)?;
    let names: Vec<String> = args.take("initialNames")?;
    let values: RealMatrix = args.take("initialValues")?;
    let finals: Vec<String> = args.take("finalNames")?;
    let (ok, elements) = match names.iter().position(|name| name == LINEARIZE) {
        Some(at) => each_linearized(session, &request, (&names, &values), at, &finals)?,
        None => each_row(session, &request, &names, &values, finals.len(), |run| {
            last_values(&run.table, &finals)
        })?,
    };
    let (rows, columns) = (values.rows, finals.len());
    Ok(Value::Tuple(vec![ok.into(), RealMatrix { rows, columns, elements }.into()]))
}

const SIMULATE_MULTI_RESULTS_MODEL: &str = inputs::header!(
    "simulateMultiResultsModel",
    "Simulates a model once for each row of parameter and start values and returns trajectories.",
    inputs::simulation!(),
    inputs::initial_names!(),
    r#"  input Real initialValues[:, :] = fill(0.0, 0, 0) "one row for each simulation";
  input String resultNames[:] = fill("", 0) "variables whose trajectories are returned";
  output Boolean ok;
  output Real trajectories[:, :, :] "simulation, variable, point of the output grid; NaN where a simulation failed";
"#
);

/// The trajectories lie on the grid of the output intervals, so that all have the same points.
fn simulate_multi_results_model(session: &mut Session, mut args: Args) -> Result<Value, Failure> {
    let request = Request::take(session, &mut args)?;
    let names: Vec<String> = args.take("initialNames")?;
    let values: RealMatrix = args.take("initialValues")?;
    let results: Vec<String> = args.take("resultNames")?;
    let Some(model) = to_simulate(session, &request.problem) else {
        return Ok(Value::Tuple(vec![false.into(), cube([values.rows, results.len(), 0], vec![])]));
    };
    let grid = request.grid(&model)?;
    let points = grid.len();
    element_count(&[values.rows, results.len(), points])?;
    let (ok, elements) =
        each_row(session, &request, &names, &values, results.len() * points, |run| {
            let mut all = Vec::with_capacity(results.len() * points);
            for name in &results {
                all.extend(run.table.interpolate(name, &grid)?);
            }
            Ok(all)
        })?;
    Ok(Value::Tuple(vec![ok.into(), cube([values.rows, results.len(), points], elements)]))
}

fn cube(dims: [usize; 3], elements: Vec<f64>) -> Value {
    Value::Array(ArrayValue::new(dims.to_vec(), Elements::Real(elements)))
}

fn check_count(names: &[String], values: usize) -> Result<(), Fault> {
    if names.len() != values {
        let counted = |count: usize, noun: &str| match count {
            1 => format!("1 {noun}"),
            count => format!("{count} {noun}s"),
        };
        let (names, given) = (counted(names.len(), "name"), counted(values, "value"));
        bail!(BAD_ARGUMENT, "`initialNames` has {names}, but `initialValues` {given}");
    }
    Ok(())
}

/// Simulates with values that hold for one call: the next simulations begin from those before it.
fn for_this_call<T>(session: &mut Session, work: impl FnOnce(&mut Session) -> T) -> T {
    let before = session.models.current.clone();
    let done = work(session);
    session.models.current = before;
    done
}

/// Simulates once for each row; what a failed simulation would have given is NaN.
fn each_row(
    session: &mut Session,
    request: &Request,
    names: &[String],
    values: &RealMatrix,
    expected: usize,
    take: impl Fn(&Simulated) -> Result<Vec<f64>, Fault>,
) -> Result<(bool, Vec<f64>), Failure> {
    check_count(names, values.columns)?;
    let mut all = Vec::with_capacity(values.rows * expected);
    let Some(mut model) = to_simulate(session, &request.problem) else {
        all.resize(values.rows * expected, f64::NAN);
        return Ok((false, all));
    };
    let mut ok = true;
    for row in 0..values.rows {
        let done = for_this_call(session, |session| {
            simulated(session, &mut model, request, names, values.row(row))
        })?;
        match done {
            Some(run) => all.extend(take(&run)?),
            None => {
                ok = false;
                all.resize(all.len() + expected, f64::NAN);
            }
        }
    }
    Ok((ok, all))
}

/// Simulates with these values; `None` if it failed, which has been reported.
fn simulated(
    session: &mut Session,
    model: &mut Simulable,
    request: &Request,
    names: &[String],
    values: &[f64],
) -> Result<Option<Simulated>, Failure> {
    // Each row rewrites the file: that of the row before does not replace it.
    session.world.expect_file(&result_path(&request.file));
    for (name, value) in names.iter().zip(values) {
        model.set(session, name, *value)?;
    }
    let done = model.run(session, &request.options, &request.file);
    Ok(session.or_report_all(done))
}

fn last_values(table: &ResultTable, names: &[String]) -> Result<Vec<f64>, Fault> {
    let last = |name: &String| Ok(table.column(name)?.last().copied().unwrap_or(f64::NAN));
    names.iter().map(last).collect()
}

/// The file of the linear model of this number.
pub(super) fn linear_file(number: f64) -> String {
    format!("dslin{number}.mat")
}

/// Linearizes at the end of the simulation of each row; the number in column `at` is that of the
/// file `dslin<number>.mat` that holds the linear model.
fn each_linearized(
    session: &mut Session,
    request: &Request,
    (names, values): (&[String], &RealMatrix),
    at: usize,
    finals: &[String],
) -> Result<(bool, Vec<f64>), Failure> {
    check_count(names, values.columns)?;
    let mut all = Vec::with_capacity(values.rows * finals.len());
    let (mut ok, mut options) = (true, request.options.clone());
    options.stop = options.stop.or(options.start).or(Some(0.0));
    let is_translated = is_model(session, &request.problem);
    for row in 0..values.rows {
        let numbers = values.row(row);
        let others = names.iter().zip(numbers).enumerate().filter(|(column, _)| *column != at);
        let done = match is_translated {
            true => for_this_call(session, |session| {
                let set = others.into_iter().map(|(_, (name, value))| (name, *value));
                set.into_iter().try_for_each(|(name, value)| session.set_parameter(name, value))?;
                let linear = linearized(session, &options, &[]);
                Ok::<_, Fault>(session.or_report_all(linear))
            })?,
            false => None,
        };
        match done {
            Some(linear) => {
                let file = linear_file(numbers[at]);
                let written = write_dslin(session, &file, &linear);
                ok &= session.or_report(written).is_some();
                all.extend(last_values(&linear.results, finals)?);
            }
            None => {
                ok = false;
                all.resize(all.len() + finals.len(), f64::NAN);
            }
        }
    }
    Ok((ok, all))
}
