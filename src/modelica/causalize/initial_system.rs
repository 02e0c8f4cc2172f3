//! The initial system (MLS §8.6): the equations, then the initial equations, then start values.
//!
//! What comes first goes first: an initial equation or fixed start value of which nothing is left to
//! be determined is kept as a check, to be fulfilled by the solution of the others. Start values
//! that are not fixed hold for states that nothing else determines.
//!
//! Unknown are also parameters with `fixed = false`, and `pre(v)` of discrete variables: it has the
//! start value of `v` unless initial equations say otherwise, and when-clauses without `initial()`
//! leave `v = pre(v)`.

use super::blt::incidence;
use super::causalized::{Alias, Block, CausalizedDae, Selection};
use super::event_system::{Numbered, Purpose, match_mixed, of_kind, sort_mixed, with_initial};
use crate::diag::Diagnostic;
use crate::fault;
use crate::flatten::{BaseType, Variability};
use crate::lower::{Dae, Equation, StateSelect, VariableKind};
use crate::symbolic::{VarId, substitute};

/// The initial system in solving order.
#[derive(Default)]
pub(super) struct InitialSystem {
    pub(super) blocks: Vec<Block>,
    /// What the solution must fulfil besides.
    pub(super) checks: Vec<Equation>,
    /// Discrete variables that blocks read before they write them.
    pub(super) iterated: Vec<VarId>,
}

impl Numbered {
    fn push(&mut self, equation: Equation, origin: usize) {
        self.equations.push(equation);
        self.origins.push(origin);
    }
}

impl CausalizedDae {
    /// Whether a state begins with its start value. Else initial equations, or start values of other
    /// variables, determine where it begins, and its own is a first guess.
    pub fn begins_with_start(&self, state: VarId) -> bool {
        let start = first_variable(&self.dae) + state.0 as usize;
        let assignments = self.initial_blocks.iter().flat_map(Block::assignments);
        assignments.map(|assignment| assignment.equation).any(|equation| equation == start)
    }
}

/// Sorts the initial system.
pub(super) fn sort_initial(
    dae: &mut Dae,
    states: &[VarId],
    selections: &[Selection],
    unknowns: &[VarId],
    aliases: &[Option<Alias>],
    purpose: Purpose,
) -> Result<InitialSystem, Diagnostic> {
    let mut all: Vec<VarId> = states.to_vec();
    all.extend(unknowns);
    let (fixed, free): (Vec<VarId>, Vec<VarId>) =
        all.iter().partition(|v| dae.variable(**v).fixed && is_continuous(dae, **v));
    all.extend(unknowns_at_start(dae, aliases));

    let mut system = model_equations(dae);
    let model = system.equations.len();
    let remembered = require(dae, &mut system, fixed, aliases);
    let required = system.equations.len();
    let taken = start_values_to_take(dae, states, selections, &free);
    // An initial equation of continuous variables determines a state rather than what a discrete
    // variable was before the start, on which these may depend by a table or a relation: the clarifiers
    // of WasteWater, fed by a table over time.
    let (first, states_from) = (first_variable(dae), required + remembered.len());
    for (v, of) in remembered.into_iter().chain(taken.iter().map(|v| (*v, *v))) {
        system.push(start_equation(dae, v, of), first + of.0 as usize);
    }
    with_initial(dae, &mut system.equations, 1.0);

    let graph = incidence(dae, &system.equations, &all);
    let matching = match_mixed(dae, &system.equations, &all, &graph, model);
    let is_used = |number: usize| matching.equation_to_unknown[number].is_some();
    let numbered = || system.equations.iter().copied().enumerate();
    let checks =
        numbered().take(required).skip(model).filter(|(n, _)| !is_used(*n)).map(|(_, e)| e);
    let checks = checks.collect();
    let mut used = Numbered::default();
    for (number, equation) in numbered().filter(|(n, _)| *n < model || is_used(*n)) {
        used.push(equation, system.origins[number]);
    }
    let held = taken.into_iter().enumerate().filter(|(n, _)| is_used(states_from + n));
    let held: Vec<VarId> = held.map(|(_, v)| v).collect();
    if required > model {
        warn_of_start_values(dae, &held);
    }
    let name = format!("the initial system of `{}`", dae.name);
    let sorted = sort_mixed(dae, &name, used, &all, purpose)?;
    Ok(InitialSystem { blocks: sorted.blocks, checks, iterated: sorted.iterated })
}

/// Adds what must hold at the start: initial equations, initial values by `reinit` and those that are
/// fixed, first of what nothing else can determine: what discrete variables were before. Gives what discrete variables were before the start, where that is not fixed.
fn require(
    dae: &mut Dae,
    system: &mut Numbered,
    states: Vec<VarId>,
    aliases: &[Option<Alias>],
) -> Vec<Remembered> {
    let first = first_variable(dae);
    for (number, equation) in dae.initial_equations.iter().enumerate() {
        system.push(*equation, dae.equations.len() + number);
    }
    for (state, equation) in reinits(dae, aliases) {
        system.push(equation, first + state.0 as usize);
    }
    let (fixed, remembered) = previous_values(dae);
    for (v, of) in fixed.into_iter().chain(states.into_iter().map(|v| (v, v))) {
        system.push(start_equation(dae, v, of), first + of.0 as usize);
    }
    remembered
}

/// Number of the first variable among the origins of equations: after all equations.
fn first_variable(dae: &Dae) -> usize {
    dae.equations.len() + dae.initial_equations.len() + dae.events.equations.len()
}

/// What is unknown at the start alone, and discrete variables.
fn unknowns_at_start(dae: &Dae, aliases: &[Option<Alias>]) -> Vec<VarId> {
    let discrete = of_kind(dae, |kind| kind == VariableKind::Discrete).into_iter();
    let mut unknowns: Vec<VarId> = discrete.filter(|v| aliases[v.0 as usize].is_none()).collect();
    unknowns.extend(of_kind(dae, |kind| {
        matches!(kind, VariableKind::Previous(_) | VariableKind::Solved | VariableKind::Delayed)
    }));
    unknowns
}

/// The equations that hold always, and those of what is known later: `pre` of a continuous variable
/// is the variable, a delayed value is the value.
fn model_equations(dae: &mut Dae) -> Numbered {
    let mut system = Numbered::default();
    for (number, equation) in dae.equations.iter().enumerate() {
        system.push(*equation, number);
    }
    let events = dae.equations.len() + dae.initial_equations.len();
    for (number, equation) in dae.events.equations.iter().enumerate() {
        system.push(*equation, events + number);
    }
    let first = first_variable(dae);
    for delay in dae.events.delays.clone() {
        let (left, right) = (dae.pool.variable(delay.variable), delay.argument);
        let equation = Equation::new(left, right, delay.span);
        system.push(equation, first + delay.variable.0 as usize);
    }
    for transport in &dae.events.transports {
        for (variable, value) in transport.outputs() {
            let equation = Equation::new(dae.pool.variable(variable), value, transport.span());
            system.push(equation, first + variable.0 as usize);
        }
    }
    for previous in of_kind(dae, |kind| matches!(kind, VariableKind::Previous(_))) {
        let VariableKind::Previous(of) = dae.variable(previous).kind else { continue };
        if dae.variable(of).kind != VariableKind::Discrete {
            let (left, right) = (dae.pool.variable(previous), dae.pool.variable(of));
            let equation = Equation::new(left, right, dae.variable(of).span);
            system.push(equation, first + of.0 as usize);
        }
    }
    system
}

/// `pre(v)` and v.
type Remembered = (VarId, VarId);

/// `pre(v)` of discrete variables with v, those with fixed start values first.
fn previous_values(dae: &Dae) -> (Vec<Remembered>, Vec<Remembered>) {
    of_kind(dae, |kind| matches!(kind, VariableKind::Previous(_)))
        .into_iter()
        .filter_map(|v| match dae.variable(v).kind {
            VariableKind::Previous(of) if dae.variable(of).kind == VariableKind::Discrete => {
                Some((v, of))
            }
            _ => None,
        })
        .partition(|(_, of)| dae.variable(*of).fixed)
}

/// Variables whose start values hold where nothing else determines them, the preferred first:
/// those that the model prefers as states and gives a start value, be they states or not (a tank
/// begins with its level, not with no mass); states, and instead of those chosen at run time the candidates, those chosen at first before the
/// others; among these the ones with a start value of their own.
fn start_values_to_take(
    dae: &Dae,
    states: &[VarId],
    selections: &[Selection],
    free: &[VarId],
) -> Vec<VarId> {
    let chosen =
        |v: &VarId| selections.iter().any(|s| s.chosen.iter().any(|at| s.candidates[*at] == *v));
    let offered = |v: &VarId| match states.binary_search(v) {
        Ok(_) => selections.iter().all(|s| !s.states.contains(v)),
        Err(_) => selections.iter().any(|s| s.candidates.contains(v)) || is_preferred(dae, *v),
    };
    let mut taken: Vec<VarId> = free.iter().copied().filter(offered).collect();
    let is_candidate = |v: &VarId| states.binary_search(v).is_err();
    taken.sort_by_key(|v| {
        let variable = dae.variable(*v);
        (!is_preferred(dae, *v), is_candidate(v) && !chosen(v), variable.start.is_none())
    });
    taken
}

/// Whether a model prefers a variable as a state and says where it begins.
fn is_preferred(dae: &Dae, v: VarId) -> bool {
    let variable = dae.variable(v);
    let is_chosen = matches!(variable.state_select, StateSelect::Prefer | StateSelect::Always);
    is_chosen && variable.start.is_some() && is_continuous(dae, v)
}

fn is_continuous(dae: &Dae, v: VarId) -> bool {
    let variable = dae.variable(v);
    variable.base == BaseType::Real && variable.variability == Variability::Continuous
}

/// A model that says something about its start but not enough deserves a warning.
fn warn_of_start_values(dae: &mut Dae, held: &[VarId]) {
    let Some(first) = held.first() else { return };
    let shown: Vec<String> =
        held.iter().take(6).map(|v| format!("`{}`", dae.variable(*v).name)).collect();
    let more = if held.len() > 6 { ", …" } else { "" };
    let warning = fault!(
        crate::lower::errors::MISSING_INITIAL_CONDITION,
        "the initial equations of `{}` do not determine all states; the start values of {}{more} \
         are used as fixed",
        dae.name,
        shown.join(", ");
        help: "set `fixed = true` for these variables, or write initial equations for them"
    );
    let span = dae.variable(*first).span;
    dae.warnings.push(warning.at(span).warning());
}

/// `reinit(x, e)` under `when initial()` is the initial equation `x = e`.
fn reinits(dae: &mut Dae, aliases: &[Option<Alias>]) -> Vec<(VarId, Equation)> {
    let Some(initial) = dae.events.initial else { return Vec::new() };
    let mut equations = Vec::new();
    for reinit in dae.events.reinits.clone() {
        let one = dae.pool.constant(1.0);
        let start = |v: VarId| (v == initial).then_some(one);
        let condition = substitute(&mut dae.pool, reinit.condition, &start);
        if dae.pool.as_constant(condition).is_some_and(|value| value != 0.0) {
            let alias = aliases[reinit.state.0 as usize];
            let state = alias.map_or(reinit.state, |alias| alias.of);
            let mut left = dae.pool.variable(state);
            if alias.is_some_and(|alias| alias.negated) {
                left = dae.pool.neg(left);
            }
            let right = substitute(&mut dae.pool, reinit.value, &start);
            equations.push((state, Equation::new(left, right, reinit.span)));
        }
    }
    equations
}

/// `variable = start`, where `of` has the start value.
fn start_equation(dae: &mut Dae, variable: VarId, of: VarId) -> Equation {
    let left = dae.pool.variable(variable);
    let default = match dae.variable(of).base {
        BaseType::Enumeration(_) => 1.0,
        _ => 0.0,
    };
    let default = dae.pool.constant(default);
    let of = dae.variable(of);
    Equation::new(left, of.start.unwrap_or(default), of.span)
}
