//! Models linearized through their exact Jacobian.
//!
//! ```text
//!   ẋ = f(t, x, v),  0 = g(t, x, v)      A = ∂f/∂x − ∂f/∂v (∂g/∂v)⁻¹ ∂g/∂x
//! ```
//!
//! Models with inputs or outputs at the top level are refused: the matrices B, C and D would need
//! slopes that are not compiled.

use super::openmodelica::simulation_result;
use super::simulation::{Request, translated_model};
use super::{Args, Builtin, Failure, Family};
use crate::compile::System;
use crate::diag::{At, Diagnostic, Fault};
use crate::fault;
use crate::mat::{self, Matrix};
use crate::name::Name;
use crate::script::errors::BAD_ARGUMENT;
use crate::script::simulation::{self, Translated, Wishes, state_names};
use crate::script::{Dialect, Session};
use crate::sim::{DaeSystem, Failure as Evaluation};
use crate::value::Value;
use nalgebra::DMatrix;
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
  input Real stopTime = 0.0 "s; default: the start, without a simulation" annotation(optional = true);
  input Integer numberOfIntervals = 500 annotation(optional = true);
  input Real outputInterval = 0.0 annotation(optional = true);
  input String method = "Dassl" annotation(optional = true);
  input Real tolerance = 0.0001 "relative" annotation(optional = true);
  input Real fixedstepsize = 0.0 annotation(optional = true);
  input String resultFile = "dslin" "without an ending, .mat is added";
  output Boolean ok;
end linearizeModel;
"#;

fn linearize_model(session: &mut Session, mut args: Args) -> Result<Value, Failure> {
    let mut request = Request::take(session, &mut args)?;
    let Some(model) = translated_model(session, &request.problem) else { return Ok(false.into()) };
    request.wishes.stop = request.wishes.stop.or(request.wishes.start).or(Some(0.0));
    let linear = linearized(session, &model, &request.wishes);
    let Some(linear) = session.or_report_all(linear) else { return Ok(false.into()) };
    let file = match request.file.ends_with(".mat") {
        true => request.file,
        false => request.file + ".mat",
    };
    let written = write_dslin(session, &file, &linear);
    Ok(session.succeeded(written))
}

fn write_dslin(session: &mut Session, file: &str, linear: &Linear) -> Result<(), Fault> {
    let order = linear.states.len();
    let elements: Vec<f64> = linear.a.iter().copied().collect();
    let matrices = [
        ("ABCD", Matrix::from_columns(order, order, elements)),
        ("nx", Matrix::from_rows(&[vec![order as f64]])),
    ];
    let bytes = mat::write_v4(matrices.iter().map(|(name, matrix)| (*name, matrix)))?;
    session.write_file(Path::new(file), &bytes)
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
    let wishes = super::openmodelica::wishes(&mut args)?;
    let flags: String = args.take("simflags")?;
    let done = translated_and_linearized(session, &class, &wishes, &flags);
    let (file, messages) = match done {
        Ok(()) => (session.world.absolute(Path::new(FILE)).display().to_string(), String::new()),
        Err(errors) => {
            let messages = errors.iter().map(|error| format!("{}\n", error.message)).collect();
            session.or_report_all::<()>(Err(errors));
            (String::new(), messages)
        }
    };
    Ok(simulation_result([file, String::new(), messages]))
}

const FILE: &str = "linearized_model.mo";

fn translated_and_linearized(
    session: &mut Session,
    class: &Name,
    wishes: &Wishes,
    flags: &str,
) -> Result<(), Vec<Diagnostic>> {
    let model = simulation::translate(session, &class.to_string())?;
    let at = session.call_site();
    let before = session.current_values();
    let set = super::openmodelica::set_overrides(session, flags).at(at);
    let linear =
        set.map_err(|error| vec![error]).and_then(|()| linearized(session, &model, wishes));
    session.restore_values(before);
    let linear = linear?;
    let written = session.write_file(Path::new(FILE), linear.as_model(class).as_bytes());
    written.at(at).map_err(|error| vec![error])
}

/// A linearized model.
struct Linear {
    states: Vec<String>,
    /// The states at the point of linearization.
    x0: Vec<f64>,
    a: DMatrix<f64>,
}

impl Linear {
    fn as_model(&self, class: &Name) -> String {
        let order = self.states.len();
        let row = |values: Vec<f64>| {
            values.iter().map(|value| format!("{value:?}")).collect::<Vec<_>>().join(", ")
        };
        let rows: Vec<String> =
            (0..order).map(|i| row(self.a.row(i).iter().copied().collect())).collect();
        let names: Vec<String> = self.states.iter().map(|name| format!("\"{name}\"")).collect();
        let (matrix, start) = match order {
            0 => ("zeros(0, 0)".to_owned(), "zeros(0)".to_owned()),
            _ => (format!("[{}]", rows.join(";\n    ")), format!("{{{}}}", row(self.x0.clone()))),
        };
        format!(
            "model linearized_model \"{class}, linearized\"\n  parameter Integer n = {order} \
             \"number of states\";\n  parameter Real x0[n] = {start};\n  parameter Real A[n, n] =\n    \
             {matrix};\n  Real x[n](start = x0) \"deviations: {}\";\nequation\n  der(x) = A*x;\n\
             end linearized_model;\n",
            names.join(", ").replace('"', "")
        )
    }
}

fn linearized(
    session: &mut Session,
    model: &Translated,
    wishes: &Wishes,
) -> Result<Linear, Vec<Diagnostic>> {
    let at = session.call_site();
    let has_port = |variable: &&crate::flatten::Variable| variable.causality.is_some();
    if let Some(port) = model.flat.variables.values().find(has_port) {
        let fault = fault!(
            BAD_ARGUMENT,
            "`{}` has the input or output `{}`: only models without them are linearized",
            model.problem, port.name;
            help: "write a model that contains this one and gives its inputs values"
        );
        return Err(vec![fault.at(at)]);
    }
    let done = simulation::simulate(session, model, wishes).map_err(|error| vec![error])?;
    let time = done.table.time.last().copied().unwrap_or(0.0);
    let states: Vec<String> = state_names(model).map(|name| name.to_string()).collect();
    let last = |name: &String| {
        Ok::<f64, Fault>(done.table.column(name)?.last().copied().unwrap_or(f64::NAN))
    };
    let x0: Result<Vec<f64>, Fault> = states.iter().map(last).collect();
    let x0 = x0.at(at).map_err(|error| vec![error])?;
    let mut system = session.system_with_values(model).map_err(|error| vec![error])?;
    match jacobian(&mut system, time, &x0) {
        Ok(Some(a)) => Ok(Linear { states, x0, a }),
        Ok(None) => {
            let message = format!("the algebraic equations of `{}` are singular", model.problem);
            Err(vec![Fault::new(BAD_ARGUMENT, message).at(at)])
        }
        Err(_) => {
            let message = format!("the slopes of `{}` cannot be computed there", model.problem);
            Err(vec![Fault::new(BAD_ARGUMENT, message).at(at)])
        }
    }
}

/// ∂ẋ/∂x; `None` where the algebraic equations are singular.
fn jacobian(
    system: &mut System,
    time: f64,
    x0: &[f64],
) -> Result<Option<DMatrix<f64>>, Evaluation> {
    system.solve_loops(false);
    let (n, m) = (system.n_differential(), system.n_algebraic());
    let mut y = vec![0.0; n + m];
    system.initialize(time, &mut y)?;
    y[..n].copy_from_slice(x0);
    system.handle_event(time, &mut y)?;
    let pattern = system.pattern().clone();
    let mut values = vec![0.0; pattern.rows.len()];
    system.jacobian(time, &y, &mut values)?;
    let mut whole = DMatrix::zeros(n + m, n + m);
    for column in 0..n + m {
        for entry in pattern.column(column) {
            whole[(pattern.rows[entry], column)] = values[entry];
        }
    }
    if m == 0 {
        return Ok(Some(whole));
    }
    let (f_x, f_v) = (whole.view((0, 0), (n, n)), whole.view((0, n), (n, m)));
    let (g_x, g_v) = (whole.view((n, 0), (m, n)), whole.view((n, n), (m, m)));
    let Some(v_x) = g_v.into_owned().lu().solve(&g_x.into_owned()) else { return Ok(None) };
    Ok(Some(f_x - f_v * v_x))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::script::world::MemoryWorld;

    #[test]
    fn the_jacobian_of_a_system_with_a_loop_is_reduced() {
        let mut session = Session::new(Box::new(MemoryWorld::new()));
        let model = "model M Real x(start = 1, fixed = true); Real v(start = 1); \
                     equation v + v^3 = 2*x; der(x) = -v; end M;";
        assert!(session.load_text("m", model).is_ok());
        let translated = simulation::translate(&mut session, "M").expect("a model");
        let wishes = Wishes { stop: Some(0.0), ..Wishes::default() };
        let linear = linearized(&mut session, &translated, &wishes).expect("linear");
        // v = 1 at x = 1, dv/dx = 2/(1 + 3 v²) = 1/2
        assert!((linear.a[(0, 0)] + 0.5).abs() < 1e-9, "{}", linear.a);
    }
}
