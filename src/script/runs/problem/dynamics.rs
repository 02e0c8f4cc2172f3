//! What happens before and after an experiment: a steady state before it, and delays of its
//! measurements. Both become part of the class around the model.

use super::enclosing_class::{EnclosingClass, own_name};
use super::file::{ColumnEntry, DelayEntry, ExperimentEntry, ProblemFile, Role};
use super::invariants::{self, invariants};
use crate::bail;
use crate::codegen::Program;
use crate::diag::{Fault, suggest};
use crate::identify::significant;
use crate::registry::BAD_OPTION;
use crate::symbolic::VarId;
use std::fmt::Write;
use std::sync::Arc;

/// Delays that are shorter than this part of the measured time are said to be slow: with 1e-3, a
/// simulation of one state took 4 ms, with 1e-4 40 ms (a decay, measured for 5.5 s).
const SHORT: f64 = 1e-3;

/// Says that short delays are slow.
pub(super) fn note_short_delays(
    file: &ProblemFile,
    entry: &ExperimentEntry,
    x: &[f64],
) -> Option<String> {
    let span = x.iter().copied().fold(f64::NEG_INFINITY, f64::max)
        - x.iter().copied().fold(f64::INFINITY, f64::min);
    let mut delays = entry.outputs.values().filter_map(|output| output.entry().delay);
    delays.find_map(|delay| {
        let DelayEntry::Parameter(name) = delay else { return None };
        let parameter = file.parameters.get(&name)?;
        let Role::Free { range: [min, _], .. } = parameter.role(&name).ok()? else { return None };
        (min < SHORT * span).then(|| {
            format!(
                "the range of the delay `{name}` begins at {}: steps are not longer than the delay, so \
                 that simulations with short delays are slow. Begin it at {} s or more, a thousandth \
                 of the measured time, unless shorter delays are possible",
                significant(min, 3),
                significant(SHORT * span, 2)
            )
        })
    })
}

/// Whether a parameter of the problem is a delay of measurements and not a parameter of the model.
pub(super) fn is_delay(file: &ProblemFile, name: &str) -> bool {
    let outputs = file.experiment.iter().flat_map(|experiment| experiment.outputs.values());
    let mut delays = outputs.filter_map(|output| output.entry().delay);
    delays.any(|delay| matches!(delay, DelayEntry::Parameter(own) if own == name))
}

/// The name in the class around the model of a delay that is a parameter.
pub(super) fn delay_name(name: &str) -> String {
    own_name("delay", name)
}

/// Declares the delayed variable of an output; its name, or that of the output itself where it is
/// not delayed.
///
/// # Errors
///
/// Negative delays, parameters that there are not, X other than time.
pub(super) fn delayed(
    file: &ProblemFile,
    y_name: &str,
    place: usize,
    entry: &ColumnEntry,
    x_name: &str,
    enclosing: &mut EnclosingClass,
) -> Result<String, Fault> {
    let Some(delay) = &entry.delay else { return Ok(y_name.to_owned()) };
    if x_name != "time" {
        bail!(BAD_OPTION, "`{y_name}` has a delay, but it is measured over \
                           `{x_name}`"; help: "use `time` as X");
    }
    let negative = |value: f64| {
        Fault::new(BAD_OPTION, format!("the delay of `{y_name}` can become {value}"))
            .help("a delay must not be negative: use 0 or more")
    };
    let arguments = match delay {
        DelayEntry::Seconds(seconds) if seconds.is_finite() && *seconds >= 0.0 => {
            format!("{seconds:e}")
        }
        DelayEntry::Seconds(seconds) => return Err(negative(*seconds)),
        DelayEntry::Parameter(name) => {
            let Some(parameter) = file.parameters.get(name) else {
                bail!(BAD_OPTION, "the delay of `{y_name}` is `{name}`, which is not in \
                                   `[parameters]`"; help: "add `{name} = {{ min = 0, max = 10 }}` to `[parameters]`")
            };
            match parameter.role(name)? {
                Role::Free { range: [min, max], .. } if min >= 0.0 => {
                    format!("{}, {max:e}", delay_name(name))
                }
                Role::Free { range: [min, _], .. } => return Err(negative(min)),
                Role::Fixed(value) => match value.number(name)? {
                    value if value >= 0.0 => format!("{value:e}"),
                    value => return Err(negative(value)),
                },
                Role::Tied(_) => {
                    bail!(BAD_OPTION, "the delay `{name}` is tied"; help: "use `min` and `max`, or `fixed`")
                }
            }
        }
    };
    let name = own_name(&format!("delayed output {}", place + 1), y_name);
    // Writing into a String cannot fail.
    _ = writeln!(enclosing.declarations, "  Real {name} = delay({y_name}, {arguments});");
    enclosing.elements.push((name.clone(), format!("the delayed {y_name}")));
    Ok(name)
}

/// The class around the model begins with all derivatives zero; sums of states that the equations
/// conserve keep the value of the start values, which the derivatives do not determine. Returns these
/// sums, as they are written.
///
/// # Errors
///
/// States whose initial values are given besides; models without states; sums that are conserved but not
/// found.
pub(super) fn steady(
    file: &ProblemFile,
    entry: &ExperimentEntry,
    (program, varied): (&Arc<Program>, &[VarId]),
    enclosing: &mut EnclosingClass,
) -> Result<Vec<String>, Fault> {
    let model = program.sorted();
    let given = file.parameters.iter().find(|(_, parameter)| parameter.initial);
    if let Some(name) = given.map(|(name, _)| name).or_else(|| entry.start.keys().next()) {
        bail!(BAD_OPTION, "the initial value of `{name}` cannot be chosen in a steady-state experiment"; help: "remove `steady_state` or the initial value");
    }
    if model.states.is_empty() {
        bail!(BAD_OPTION, "`{}` has no states, so `steady_state` has no meaning", file.model; help: "remove `steady_state`");
    }
    let invariants = invariants(model, varied);
    let all = invariants::count(program, varied);
    let known = invariants.as_ref().filter(|own| all.is_none_or(|all| all == own.len()));
    let Some(known) = known else {
        let all = suggest::counted(all.unwrap_or(0) as u64, "sum");
        bail!(BAD_OPTION, "the steady state is not determined: the equations conserve {all} of states that cannot be written down"; help: "write `start_time` and `rest = true`, which simulate until nothing changes");
    };
    let mut sums = Vec::new();
    enclosing.equations.push_str("initial equation\n");
    for (place, state) in model.states.iter().enumerate() {
        let name = model.dae.variables[state.0 as usize].name.to_string();
        if let Some(invariant) = known.iter().find(|own| own.pivot == place) {
            let [sum, start] = invariant.sides(model);
            _ = writeln!(enclosing.equations, "  {sum} = {start};");
            sums.push(format!("{sum} = {start}"));
        } else {
            _ = writeln!(enclosing.equations, "  der({name}) = 0;");
        }
        enclosing.release(&name, entry.places.at(&["data"]));
    }
    Ok(sums)
}
