//! Recorded inputs: samples outside of the equations, which see the values of the segment at hand.
//!
//! ```text
//! held     u = value
//! linear   u = value + rate*(time - since)
//! ```
//!
//! `value`, `rate` and `since` are constant between knots and known, so that index reduction finds
//! u' = rate, and that the right-hand side is linear in time where it is linear in u.

use super::build::scalar_of_nothing;
use super::dae::{Dae, VariableKind};
use super::equation::Equation;
use super::events::{Recording, Track};
use crate::flatten::{RecordedInput, Variability};
use crate::source::Span;
use crate::symbolic::{Expr, VarId};

/// Lets inputs follow their samples.
pub(super) fn follow(dae: &mut Dae, recorded: &[(VarId, &RecordedInput)]) {
    let mut rest: Vec<_> = recorded.to_vec();
    while let Some((_, first)) = rest.first().copied() {
        let (same, others): (Vec<_>, Vec<_>) =
            rest.into_iter().partition(|(_, input)| input.times == first.times);
        rest = others;
        let recording = recording(dae, &same);
        dae.events.recordings.push(recording);
    }
}

/// The inputs with the same times.
fn recording(dae: &mut Dae, inputs: &[(VarId, &RecordedInput)]) -> Recording {
    let times = &inputs[0].1.times;
    let kept: Vec<usize> = (0..times.len()).filter(|at| is_knot(inputs, *at)).collect();
    let of = |all: &[f64]| kept.iter().map(|at| all[*at]).collect();
    let is_linear = inputs.iter().any(|(_, input)| !input.is_held);
    let since = is_linear.then(|| signal(dae, "since", inputs[0].0));
    let mut tracks = Vec::new();
    for (variable, input) in inputs {
        let value = signal(dae, "value", *variable);
        let rate = (!input.is_held).then(|| signal(dae, "rate", *variable));
        let mut right = dae.pool.variable(value);
        if let Some((rate, since)) = rate.zip(since) {
            let moved = change_since(dae, rate, since);
            right = dae.pool.add(right, moved);
        }
        let left = dae.pool.variable(*variable);
        let span = dae.variable(*variable).span;
        let equation = Equation::new(left, right, span);
        match dae.variable(*variable).kind {
            VariableKind::Discrete => dae.events.equations.push(equation),
            _ => dae.equations.push(equation),
        }
        tracks.push(Track { value, rate, samples: of(&input.values) });
    }
    Recording { knots: of(times), since, tracks }
}

/// `rate*(time - since)`
fn change_since(dae: &mut Dae, rate: VarId, since: VarId) -> Expr {
    let [rate, since, time] = [rate, since, VarId(0)].map(|v| dae.pool.variable(v));
    let passed = dae.pool.sub(time, since);
    dae.pool.mul(rate, passed)
}

/// Whether an input jumps or bends at a sample. The first one begins the recording.
fn is_knot(inputs: &[(VarId, &RecordedInput)], at: usize) -> bool {
    let is_bent = |input: &RecordedInput| {
        let value = input.values[at];
        let before = input.values[at - 1];
        let next = if input.is_held { None } else { input.values.get(at + 1) };
        value != before || next.is_some_and(|next| *next != value)
    };
    at == 0 || inputs.iter().any(|(_, input)| is_bent(input))
}

/// A variable that the simulation sets.
fn signal(dae: &mut Dae, what: &str, of: VarId) -> VarId {
    let id = VarId(dae.variables.len() as u32);
    let name = format!("${what}({})", dae.variable(of).name);
    let mut variable = scalar_of_nothing(&name, VariableKind::Signal, Span::NONE);
    variable.base = dae.variable(of).base.clone();
    variable.variability = Variability::Discrete;
    dae.variables.push(variable);
    id
}
