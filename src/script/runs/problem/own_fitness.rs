//! Fitness functions that are written in Modelica: any function of the simulated and the measured
//! points, and of their weights if it has such an input.

use super::own_function::{Around, OwnFunction, function};
use crate::Session;
use crate::diag::{Diagnostic, Fault};
use crate::ga::FAILED_FITNESS;
use crate::identify::fitness::Fitness;
use crate::identify::problem::Series;
use crate::registry::{BAD_OPTION, UserFunction};
use crate::source::Span;

/// The output of the model around the function.
const OUTPUT: &str = "gapi_fitness";

/// A compiled function.
pub(super) struct OwnFitness(OwnFunction);

/// Whether a function of this name is loaded.
pub(super) fn is_function(session: &mut Session, name: &str) -> bool {
    matches!(function(session, name), Ok(Some(_)))
}

/// Compiles the function `name` for the measured points of `series`.
///
/// # Errors
///
/// A function with other inputs, or one that models cannot call.
pub(super) fn compiled(
    session: &mut Session,
    name: &str,
    series: &[Series],
) -> Result<OwnFitness, Vec<Diagnostic>> {
    let one = |fault: Fault| vec![fault.at(Span::NONE)];
    let found = function(session, name).map_err(|diagnostic| vec![diagnostic])?;
    let inputs = found.map_or(0, |function| function.inputs.len());
    let list = |values: &mut dyn Iterator<Item = f64>| {
        values.map(|value| format!("{value:e}")).collect::<Vec<_>>().join(", ")
    };
    let measured = list(&mut series.iter().flat_map(|series| series.y.iter().copied()));
    let weights = list(&mut series.iter().flat_map(Series::weights));
    let arguments = match inputs {
        2 => format!("gapi_simulated, {{{measured}}}"),
        3 => format!("gapi_simulated, {{{measured}}}, {{{weights}}}"),
        _ => return Err(one(wrong_inputs(name, inputs))),
    };
    let n: usize = series.iter().map(|series| series.y.len()).sum();
    let body = format!(
        "  parameter Real gapi_simulated[{n}] = zeros({n});\n  output Real {OUTPUT} = {name}({arguments});\n"
    );
    let inputs = (1..=n).map(|k| format!("gapi_simulated[{k}]")).collect();
    let outputs = vec![OUTPUT.to_owned()];
    let around = Around { purpose: "fitness", name, body, inputs, outputs };
    OwnFunction::compiled(session, around).map(OwnFitness)
}

fn wrong_inputs(name: &str, inputs: usize) -> Fault {
    let fault =
        Fault::new(BAD_OPTION, format!("the fitness function `{name}` has {inputs} inputs"));
    fault.help(
        "declare `input Real simulated[:]`, `input Real measured[:]` and, optionally, \
                `input Real weights[:]`",
    )
}

impl Fitness for OwnFitness {
    fn fitness(&self, simulated: &[f64], _measured: &[f64], _weights: &[f64]) -> f64 {
        if simulated.iter().any(|value| !value.is_finite()) {
            return FAILED_FITNESS;
        }
        // A function that fails has rated nothing; it counts as a failed simulation.
        let value = self.0.call(simulated).ok().map(|outputs| outputs[0]);
        value.filter(|value| *value < FAILED_FITNESS).unwrap_or(FAILED_FITNESS)
    }

    fn least_squares(&self, _measured: &[f64], _weights: &[f64]) -> Option<Vec<f64>> {
        None
    }
}
