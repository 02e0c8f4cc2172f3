//! The initial system (MLS §8.6): the equations, then the initial equations, then start values.
//!
//! What comes first goes first: an initial equation or fixed start value of which nothing is left to
//! be determined is kept as a check, to be fulfilled by the solution of the others. Start values
//! that are not fixed hold for states that nothing else determines.

use super::blt::{incidence, sort_blocks};
use super::model::{Dae, Equation};
use super::sorted::{Block, Selection};
use crate::diag::Diagnostic;
use crate::fault;
use crate::flatten::{BaseType, Variability};
use crate::graph::match_equations;
use crate::symbolic::VarId;

/// The initial system in solving order.
pub(super) struct Initial {
    pub(super) blocks: Vec<Block>,
    /// What the solution must fulfil besides.
    pub(super) checks: Vec<Equation>,
}

/// Sorts the initial system.
pub(super) fn sort_initial(
    dae: &mut Dae,
    states: &[VarId],
    selections: &[Selection],
    unknowns: &[VarId],
) -> Result<Initial, Diagnostic> {
    let mut all: Vec<VarId> = states.to_vec();
    all.extend(unknowns);
    let mut equations = dae.equations.clone();
    let model = equations.len();
    equations.extend(&dae.initial_equations);
    let (fixed, free): (Vec<VarId>, Vec<VarId>) =
        all.iter().partition(|v| dae.variable(**v).fixed && is_continuous(dae, **v));
    fixed.iter().for_each(|v| equations.push(start_equation(dae, *v)));
    let required = equations.len();
    let taken = start_values_to_take(dae, states, selections, &free);
    taken.iter().for_each(|v| equations.push(start_equation(dae, *v)));

    let matching = match_equations(&incidence(dae, &equations, &all));
    let is_used = |number: usize| matching.equation_to_unknown[number].is_some();
    let numbered = || equations.iter().copied().enumerate();
    let checks =
        numbered().take(required).skip(model).filter(|(n, _)| !is_used(*n)).map(|(_, e)| e);
    let checks = checks.collect();
    let used: Vec<Equation> =
        numbered().filter(|(n, _)| *n < model || is_used(*n)).map(|(_, e)| e).collect();
    let held: Vec<VarId> =
        taken.into_iter().enumerate().filter(|(n, _)| is_used(required + n)).map(|t| t.1).collect();
    if required > model {
        warn_of_start_values(dae, &held);
    }
    Ok(Initial { blocks: sort_blocks(dae, &used, &all)?, checks })
}

/// Variables whose start values hold where nothing else determines them, the most wanted first:
/// states, and instead of those chosen at run time the candidates, those chosen at first before the
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
        Err(_) => selections.iter().any(|s| s.candidates.contains(v)),
    };
    let mut taken: Vec<VarId> = free.iter().copied().filter(offered).collect();
    let is_candidate = |v: &VarId| states.binary_search(v).is_err();
    taken.sort_by_key(|v| (is_candidate(v) && !chosen(v), dae.variable(*v).start.is_none()));
    taken
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
        super::errors::MISSING_INITIAL_CONDITION,
        "the initial equations of `{}` leave states free; the start values of {}{more} are taken as fixed",
        dae.name,
        shown.join(", ");
        help: "give these variables `fixed = true`, or write initial equations for them"
    );
    let span = dae.variable(*first).span;
    dae.warnings.push(warning.at(span).warning());
}

fn start_equation(dae: &mut Dae, state: VarId) -> Equation {
    let left = dae.pool.variable(state);
    let zero = dae.pool.constant(0.0);
    let variable = dae.variable(state);
    Equation { left, right: variable.start.unwrap_or(zero), span: variable.span }
}
