//! What is said where no individual could be simulated: the most frequent cause with its equation,
//! its time and the estimated values.

use crate::diag::{Diagnostic, Fault};
use crate::identify::problem::{Experiment, Run, diagnosed};
use crate::registry::BAD_OPTION;

/// Values that are shown.
const SHOWN: usize = 8;

/// Why a run has no result, if its simulations have failed and the model shows where.
pub(super) fn none_simulated(run: &Run, experiments: &[Experiment]) -> Option<Diagnostic> {
    if run.observed.best.is_some() {
        return None;
    }
    let (cause, count) = run.observed.failures.causes.iter().max_by_key(|cause| cause.1)?;
    let values = run.examples.get(cause)?;
    let (found, time) = diagnosed(experiments, values)?;
    let message = format!(
        "none of the first {} individuals could be simulated; {count} times: {}",
        run.evaluations(),
        found.message
    );
    let shown = run.problem.parameters.iter().zip(values).take(SHOWN);
    let shown: Vec<String> =
        shown.map(|(free, value)| format!("{} = {}", free.name, short(*value))).collect();
    let more = if values.len() > SHOWN { ", …" } else { "" };
    let fault = Fault::new(BAD_OPTION, message)
        .help(format!("this is the message for {}{more}", shown.join(", ")));
    let fault = found.helps.iter().cloned().fold(fault, Fault::help);
    let fault = match first_point(experiments).filter(|first| time < *first) {
        Some(first) => fault.help(format!(
            "the data begin at {first} s, the simulation at {} s: if the model does not hold \
             before, write `start_time = {first}` in the experiment",
            experiments[0].settings.start
        )),
        None => fault.help("correct the model or the search ranges"),
    };
    Some(fault.at(found.span()))
}

/// The first time at which something was measured.
fn first_point(experiments: &[Experiment]) -> Option<f64> {
    let over_time = experiments.iter().filter(|experiment| experiment.x_name == "time");
    let points = over_time.flat_map(|experiment| &experiment.observations);
    points.flat_map(|points| points.x.iter().copied()).min_by(f64::total_cmp)
}

fn short(value: f64) -> String {
    let text = format!("{value:.3e}");
    text.parse::<f64>().map_or(text, |value| value.to_string())
}
