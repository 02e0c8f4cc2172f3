//! What a program does at events, as code.

use super::code::LogAssertion;
use super::registers::Registers;
use super::sequence::compile_outputs;
use crate::causalize::{Assignment, CausalizedDae};
use crate::codegen::events::{CompiledDelay, CompiledTransport, Events, Previous};
use crate::flatten::BaseType;
use crate::lower::{Equation, Level, Transport, VariableKind};
use crate::symbolic::{Expr, Pool, VarId, VariableCollection, linear_in};

/// Compiles what happens at events, but for [`Events::steps`] and [`Events::roundings`].
pub(super) fn compile_events(
    pool: &Pool,
    registers: &mut Registers,
    sorted: &CausalizedDae,
    sequence: &[Assignment],
) -> Events {
    let dae = &sorted.dae;
    let events = &dae.events;
    let delays = events.delays.iter().map(|delay| CompiledDelay {
        register: delay.variable.0,
        value: compile_outputs(pool, registers, sequence, &[delay.argument]),
        time: compile_outputs(pool, registers, &[], &[delay.time]),
    });
    let delays = delays.collect();
    let transports = events.transports.iter();
    let transports = transports.map(|t| compile_transport(pool, registers, sequence, t)).collect();
    let first = dae.assertions.len();
    let numbered = || events.assertions.iter().enumerate().map(|(at, a)| (first + at, a));
    let errors = || numbered().filter(|(_, assertion)| assertion.level == Level::Error);
    let mut outputs = |list: &[Expr]| compile_outputs(pool, registers, &[], list);
    let all = (0..dae.variables.len() as u32).map(VarId);
    let previous = all.clone().filter_map(|v| match dae.variable(v).kind {
        VariableKind::Previous(of) => {
            let discrete = dae.variable(of).kind == VariableKind::Discrete;
            let exact = dae.variable(of).base != BaseType::Real;
            let computed = !discrete && !sorted.states.contains(&of);
            Some(Previous { of, register: v.0, discrete, exact, computed })
        }
        _ => None,
    });
    let resolve = |v: VarId| match sorted.aliases[v.0 as usize] {
        Some(alias) => (alias.of, alias.negated),
        None => (v, false),
    };
    Events {
        previous: previous.collect(),
        iterated: sorted.iterated.clone(),
        discrete: all
            .filter(|v| dae.variable(*v).kind == VariableKind::Discrete)
            .filter(|v| sorted.aliases[v.0 as usize].is_none())
            .collect(),
        rounded: events.roundings.iter().map(|r| outputs(&[r.argument])).collect(),
        samples: events.samples.iter().map(|s| s.variable).collect(),
        since_start: events.samples.iter().map(|s| s.since_start).collect(),
        shows_samples: shows_samples(pool, sorted),
        clocks: outputs(&pairs(events.samples.iter().map(|s| (s.start, s.interval)))),
        reinitialized: events.reinits.iter().map(|r| resolve(r.state)).collect(),
        reinits: outputs(&pairs(events.reinits.iter().map(|r| (r.condition, r.value)))),
        assertions: outputs(&errors().map(|(_, a)| a.condition).collect::<Vec<_>>()),
        asserted: errors().map(|(at, a)| (at as u32, outputs(&a.values()))).collect(),
        log_assertions: numbered()
            .filter(|(_, assertion)| assertion.level != Level::Error)
            .map(|(at, assertion)| LogAssertion {
                assertion: at as u32,
                condition: outputs(&[assertion.condition]),
                values: outputs(&assertion.values()),
            })
            .collect(),
        terminations: outputs(&events.terminations.iter().map(|t| t.condition).collect::<Vec<_>>()),
        delays,
        transports,
        initial: events.initial,
        terminal: events.terminal,
        ..Events::default()
    }
}

fn compile_transport(
    pool: &Pool,
    registers: &mut Registers,
    sequence: &[Assignment],
    transport: &Transport,
) -> CompiledTransport {
    let (outputs, read, inputs, start) = match transport {
        Transport::Delay { variable, argument, time, longest, .. } => {
            (vec![*variable], vec![*time], vec![*argument], vec![*longest])
        }
        Transport::Pipe { outputs, inputs, position, positive, points, values, .. } => {
            let start = points.iter().chain(values).copied().collect();
            (outputs.to_vec(), vec![*position, *positive], inputs.to_vec(), start)
        }
    };
    CompiledTransport {
        outputs: outputs.iter().map(|v| v.0).collect(),
        read: compile_outputs(pool, registers, sequence, &read),
        inputs: compile_outputs(pool, registers, sequence, &inputs),
        start: compile_outputs(pool, registers, &[], &start),
    }
}

fn shows_samples(pool: &Pool, sorted: &CausalizedDae) -> bool {
    let dae = &sorted.dae;
    let is_shown = |e: &&Equation| match pool.as_variable(e.left) {
        Some(v) => !dae.variable(v).name.starts_with('$'),
        None => true,
    };
    let shown = dae.equations.iter().chain(&dae.events.equations).filter(is_shown);
    let mut variables = VariableCollection::new(pool);
    let mut any = false;
    for side in shown.flat_map(|e| [e.left, e.right]) {
        variables.add(side, |v| any |= dae.events.samples.iter().any(|s| s.variable == v));
    }
    any
}

fn pairs(list: impl Iterator<Item = (Expr, Expr)>) -> Vec<Expr> {
    list.flat_map(|(a, b)| [a, b]).collect()
}

/// `rate * time + rest` with a known rate that is not zero and a rest of parameters.
pub(super) fn linear_in_time(
    pool: &mut Pool,
    sorted: &CausalizedDae,
    e: Expr,
) -> Option<(f64, Expr)> {
    linear_with(pool, e, |v| matches!(sorted.dae.variable(v).kind, VariableKind::Parameter { .. }))
}

/// The same with a rest that changes at events only, as in `time >= pre(next)`: each event tells
/// when the next one is due.
pub(super) fn scheduled_in_time(
    pool: &mut Pool,
    sorted: &CausalizedDae,
    e: Expr,
) -> Option<(f64, Expr)> {
    linear_with(pool, e, |v| changes_at_events_only(sorted, v))
}

/// Whether a variable keeps its value between events.
pub(super) fn changes_at_events_only(sorted: &CausalizedDae, variable: VarId) -> bool {
    matches!(
        sorted.dae.variable(variable).kind,
        VariableKind::Parameter { .. }
            | VariableKind::Solved
            | VariableKind::Discrete
            | VariableKind::Previous(_)
    )
}

fn linear_with(
    pool: &mut Pool,
    e: Expr,
    may_be_in_rest: impl Fn(VarId) -> bool,
) -> Option<(f64, Expr)> {
    if pool.any_variable(e, |v| v != VarId(0) && !may_be_in_rest(v)) {
        return None;
    }
    let linear = linear_in(pool, e, VarId(0))?;
    let rate = pool.as_constant(linear.coefficient)?;
    (rate != 0.0).then_some((rate, linear.rest))
}
