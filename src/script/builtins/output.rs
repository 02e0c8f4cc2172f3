//! Which variables result files hold: `experimentSetupOutput` and
//! `Advanced.StoreProtectedVariables`.

use super::{Args, Builtin, Failure, Family};
use crate::codegen::VariableInfo;
use crate::models::simulation::Translated;
use crate::results::ResultTable;
use crate::syntax::ast::CausalityPrefix;
use crate::value::Value;
use crate::{Dialect, Session};
use std::collections::HashSet;

/// The commands of this file.
pub(super) const FAMILY: Family = Family {
    packages: &["DymolaCommands.SimulatorAPI"],
    dialect: Some(Dialect::Dymola),
    builtins: &[
        Builtin { header: EXPERIMENT_SETUP_OUTPUT, run: experiment_setup_output },
        Builtin { header: EXPERIMENT_GET_OUTPUT, run: experiment_get_output },
    ],
};

/// The kinds of variables that are stored; parameters always are.
#[derive(Debug, Clone, Copy)]
struct Kinds {
    states: bool,
    derivatives: bool,
    inputs: bool,
    outputs: bool,
    auxiliaries: bool,
    /// Whether the values before and after events are stored besides those of the output grid.
    events: bool,
    /// Whether the values at the stop time alone are stored.
    only_stop_time: bool,
    /// What is said about the format and the log, which have no effect: textual, doublePrecision,
    /// equidistant, debug.
    idle: [bool; 4],
}

impl Default for Kinds {
    fn default() -> Kinds {
        Kinds {
            states: true,
            derivatives: true,
            inputs: true,
            outputs: true,
            auxiliaries: true,
            events: true,
            only_stop_time: false,
            idle: [false, false, true, false],
        }
    }
}

const EXPERIMENT_SETUP_OUTPUT: &str = r#"
function experimentSetupOutput "Selects the kinds of variables in the result files of the next simulations; parameters are always included."
  input Boolean textual = false "has no effect: the file extension selects the format";
  input Boolean doublePrecision = false "has no effect: results are in double precision";
  input Boolean states = true;
  input Boolean derivatives = true;
  input Boolean inputs = true;
  input Boolean outputs = true;
  input Boolean auxiliaries = true;
  input Boolean equidistant = true "has no effect: results are equidistant, with events";
  input Boolean events = true "false: only the points of the output grid";
  input Boolean onlyStopTime = false "true: only the values at the stop time";
  input Boolean debug = false "has no effect";
  output Boolean ok;
end experimentSetupOutput;
"#;

fn experiment_setup_output(session: &mut Session, mut args: Args) -> Result<Value, Failure> {
    let kinds = Kinds {
        states: args.take("states")?,
        derivatives: args.take("derivatives")?,
        inputs: args.take("inputs")?,
        outputs: args.take("outputs")?,
        auxiliaries: args.take("auxiliaries")?,
        events: args.take("events")?,
        only_stop_time: args.take("onlyStopTime")?,
        idle: [
            args.take("textual")?,
            args.take("doublePrecision")?,
            args.take("equidistant")?,
            args.take("debug")?,
        ],
    };
    *session.extension::<Kinds>() = kinds;
    Ok(true.into())
}

const EXPERIMENT_GET_OUTPUT: &str = r#"
function experimentGetOutput "The settings of experimentSetupOutput: textual, doublePrecision, states, derivatives, inputs, outputs, auxiliaries, equidistant, events, debug."
  output Boolean settings[10];
end experimentGetOutput;
"#;

fn experiment_get_output(session: &mut Session, _: Args) -> Result<Value, Failure> {
    let kinds = *session.extension::<Kinds>();
    let [textual, double, equidistant, debug] = kinds.idle;
    let Kinds { states, derivatives, inputs, outputs, auxiliaries, events, .. } = kinds;
    let all = [
        textual,
        double,
        states,
        derivatives,
        inputs,
        outputs,
        auxiliaries,
        equidistant,
        events,
        debug,
    ];
    Ok(all.to_vec().into())
}

/// The variables and rows of a simulation that its result file is to hold; `grid`: the times of
/// the output grid.
pub(super) fn stored(
    session: &mut Session,
    model: &Translated,
    table: &ResultTable,
    grid: &[f64],
) -> ResultTable {
    let kinds = *session.extension::<Kinds>();
    let hides = session.workspace.flag("Advanced.StoreProtectedVariables") == Some(&false.into());
    let states: HashSet<&str> = model.state_names().map(|name| &**name).collect();
    let variables = model.program.variables().iter();
    let protected: HashSet<&str> =
        variables.clone().filter(|variable| variable.protected).map(|v| &*v.name).collect();
    let is_stored = |variable: &VariableInfo| {
        let name = &*variable.name;
        if hides && protected.contains(differentiated(name).unwrap_or(name)) {
            return false;
        }
        match variable.causality {
            _ if variable.is_known() => true,
            Some(CausalityPrefix::Input) => kinds.inputs,
            Some(CausalityPrefix::Output) => kinds.outputs,
            _ if states.contains(name) => kinds.states,
            _ if differentiated(name).is_some() => kinds.derivatives,
            _ => kinds.auxiliaries,
        }
    };
    let left_out: HashSet<&str> =
        variables.filter(|variable| !is_stored(variable)).map(|variable| &*variable.name).collect();
    let mut stored = match left_out.is_empty() {
        true => table.clone(),
        false => table.only(|name| !left_out.contains(name)),
    };
    match grid.last().filter(|_| kinds.only_stop_time) {
        Some(stop) => stored.keep_times(&[*stop]),
        None if !kinds.events => stored.keep_times(grid),
        None => {}
    }
    stored
}

/// The variable of which a name is the derivative, of whatever order.
fn differentiated(name: &str) -> Option<&str> {
    let inner = name.strip_prefix("der(")?.strip_suffix(')')?;
    Some(differentiated(inner).unwrap_or(inner))
}
