//! What a program does at events, as code.

use super::program::Notice;
use super::program::{Outputs, Step};
use super::sequence::compile_outputs;
use super::tape::Register;
use super::tape_builder::Registers;
use crate::causalize::{Assignment, CausalizedDae};
use crate::flatten::BaseType;
use crate::lower::{Equation, Kind, Level};
use crate::symbolic::{Expr, Pool, VarId, VariableCollection, linear_in};

/// The part of a program that acts at events alone.
#[derive(Debug, Clone, Default)]
pub(crate) struct Events {
    /// Solves for discrete variables as well; empty if there are none.
    pub(crate) steps: Vec<Step>,
    /// Variables with their previous values.
    pub(crate) previous: Vec<Previous>,
    /// Discrete variables that solving reads before it writes them.
    pub(crate) lagged: Vec<VarId>,
    /// All discrete variables.
    pub(crate) discrete: Vec<VarId>,
    pub(crate) roundings: Vec<CompiledRounding>,
    /// Arguments of the roundings, from the registers of the variables.
    pub(crate) rounded: Vec<Outputs>,
    /// The variables that are 1 when a sample is due.
    pub(crate) samples: Vec<VarId>,
    /// Whether variables of the model show samples that are due, not only conditions of
    /// when-clauses.
    pub(crate) shows_samples: bool,
    /// First time and interval of every sample, one after the other.
    pub(crate) clocks: Outputs,
    /// The states that `reinit` sets, and whether with the opposite sign.
    pub(crate) reinitialized: Vec<(VarId, bool)>,
    /// Condition and value of every `reinit`, one after the other.
    pub(crate) reinits: Outputs,
    /// Conditions of the assertions at events.
    pub(crate) assertions: Outputs,
    /// Their numbers among all.
    pub(crate) asserted: Vec<u32>,
    /// Warnings and texts that are printed.
    pub(crate) notices: Vec<Notice>,
    /// Conditions of `terminate`.
    pub(crate) terminations: Outputs,
    pub(crate) delays: Vec<CompiledDelay>,
    /// The variable that is 1 during initialization.
    pub(crate) initial: Option<VarId>,
    /// The variable that is 1 at the end.
    pub(crate) terminal: Option<VarId>,
}

/// A variable with its previous value.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Previous {
    pub(crate) of: VarId,
    pub(crate) register: Register,
    /// Whether event iteration goes on until both are equal.
    pub(crate) discrete: bool,
    /// Whether every difference counts, not only one that is more than rounding.
    pub(crate) exact: bool,
    /// Whether it must be computed from the states before an event.
    pub(super) computed: bool,
}

/// A rounding, compiled.
#[derive(Debug, Clone, Copy)]
pub(crate) struct CompiledRounding {
    pub(crate) register: Register,
    /// For an argument that is linear in time: its slope, and the register of the rest.
    pub(crate) time: Option<(f64, Register)>,
}

/// `register = delay(value, time)`
#[derive(Debug, Clone)]
pub(crate) struct CompiledDelay {
    pub(crate) register: Register,
    /// The expression, from states and values of events.
    pub(crate) value: Outputs,
    /// The delay, from parameters.
    pub(crate) time: Outputs,
}

impl Events {
    /// Whether anything can happen at an event beside relations that switch.
    pub(crate) fn is_empty(&self) -> bool {
        self.steps.is_empty()
            && self.reinitialized.is_empty()
            && self.samples.is_empty()
            && self.delays.is_empty()
            && self.initial.is_none()
            && self.terminal.is_none()
            && self.assertions.outputs.is_empty()
            && self.notices.is_empty()
            && self.terminations.outputs.is_empty()
    }

    /// Whether previous values of algebraic variables are needed.
    pub(crate) fn need_left_limits(&self) -> bool {
        self.previous.iter().any(|previous| previous.computed)
    }
}

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
    let first = dae.assertions.len();
    let numbered = || events.assertions.iter().enumerate().map(|(at, a)| (first + at, a));
    let errors = || numbered().filter(|(_, assertion)| assertion.level == Level::Error);
    let mut outputs = |list: &[Expr]| compile_outputs(pool, registers, &[], list);
    let all = (0..dae.variables.len() as u32).map(VarId);
    let previous = all.clone().filter_map(|v| match dae.variable(v).kind {
        Kind::Previous(of) => {
            let discrete = dae.variable(of).kind == Kind::Discrete;
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
        lagged: sorted.lagged.clone(),
        discrete: all
            .filter(|v| dae.variable(*v).kind == Kind::Discrete)
            .filter(|v| sorted.aliases[v.0 as usize].is_none())
            .collect(),
        rounded: events.roundings.iter().map(|r| outputs(&[r.argument])).collect(),
        samples: events.samples.iter().map(|s| s.variable).collect(),
        shows_samples: shows_samples(pool, sorted),
        clocks: outputs(&pairs(events.samples.iter().map(|s| (s.start, s.interval)))),
        reinitialized: events.reinits.iter().map(|r| resolve(r.state)).collect(),
        reinits: outputs(&pairs(events.reinits.iter().map(|r| (r.condition, r.value)))),
        assertions: outputs(&errors().map(|(_, a)| a.condition).collect::<Vec<_>>()),
        asserted: errors().map(|(at, _)| at as u32).collect(),
        notices: numbered()
            .filter(|(_, assertion)| assertion.level != Level::Error)
            .map(|(at, assertion)| {
                let values = std::iter::once(assertion.condition).chain(assertion.values());
                Notice { assertion: at as u32, code: outputs(&values.collect::<Vec<_>>()) }
            })
            .collect(),
        terminations: outputs(&events.terminations.iter().map(|t| t.condition).collect::<Vec<_>>()),
        delays,
        initial: events.initial,
        terminal: events.terminal,
        ..Events::default()
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

/// `slope * time + rest` with a known slope that is not zero and a rest of parameters.
pub(super) fn linear_in_time(
    pool: &mut Pool,
    sorted: &CausalizedDae,
    e: Expr,
) -> Option<(f64, Expr)> {
    let varies =
        |v: VarId| v != VarId(0) && !matches!(sorted.dae.variable(v).kind, Kind::Parameter { .. });
    if pool.any_variable(e, varies) {
        return None;
    }
    let linear = linear_in(pool, e, VarId(0))?;
    let slope = pool.as_constant(linear.coefficient)?;
    (slope != 0.0).then_some((slope, linear.rest))
}
