//! The initial system (MLS §8.6): the equations, the initial equations, and as many start values
//! as are needed to determine everything.
//!
//! Unknown are also parameters with `fixed = false`, and `pre(v)` of
//! discrete variables: it has the start value of `v` unless initial equations say otherwise, and
//! when-clauses without `initial()` leave `v = pre(v)`.

use super::blt::incidence;
use super::mixed::{of_kind, sort_mixed, with_initial};
use super::model::{Dae, Equation, Kind};
use super::sorted::{Alias, Block};
use crate::diag::Diagnostic;
use crate::flatten::BaseType;
use crate::graph::match_equations;
use crate::symbolic::{VarId, substitute};

/// Blocks of the initial system, and the variables that are read before they are written. Start
/// values that are `fixed` always hold; others hold where the equations leave a variable free.
pub(super) fn sort_initial(
    dae: &mut Dae,
    states: &[VarId],
    unknowns: &[VarId],
    aliases: &[Option<Alias>],
) -> Result<(Vec<Block>, Vec<VarId>), Diagnostic> {
    let previous = of_kind(dae, |kind| matches!(kind, Kind::Previous(_)));
    let mut all: Vec<VarId> = states.to_vec();
    all.extend(unknowns);
    all.extend(
        of_kind(dae, |kind| kind == Kind::Discrete)
            .into_iter()
            .filter(|v| aliases[v.0 as usize].is_none()),
    );
    all.extend(&previous);
    all.extend(of_kind(dae, |kind| matches!(kind, Kind::Solved | Kind::Delayed)));

    let mut equations = dae.equations.clone();
    equations.extend(&dae.initial_equations);
    equations.extend(&dae.events.equations);
    let mut origins: Vec<usize> = (0..equations.len()).collect();
    with_initial(dae, &mut equations, 1.0);
    let variables = equations.len();
    let mut push = |equations: &mut Vec<Equation>, variable: VarId, equation: Equation| {
        equations.push(equation);
        origins.push(variables + variable.0 as usize);
    };
    for delay in dae.events.delays.clone() {
        // Before the start everything was as it is at the start.
        let (left, right) = (dae.pool.variable(delay.variable), delay.argument);
        push(&mut equations, delay.variable, Equation { left, right, span: delay.span });
    }
    for (state, equation) in reinits(dae, aliases) {
        push(&mut equations, state, equation);
    }
    let mut free = Vec::new();
    for variable in states.iter().chain(unknowns) {
        match (dae.variable(*variable).fixed, states.binary_search(variable).is_ok()) {
            (true, _) => push(&mut equations, *variable, start_equation(dae, *variable, *variable)),
            (false, true) => free.push((*variable, *variable)),
            (false, false) => {}
        }
    }
    for variable in previous {
        let Kind::Previous(of) = dae.variable(variable).kind else { continue };
        if dae.variable(of).kind != Kind::Discrete {
            let (left, right) = (dae.pool.variable(variable), dae.pool.variable(of));
            push(&mut equations, of, Equation { left, right, span: dae.variable(of).span });
        } else if dae.variable(of).fixed {
            push(&mut equations, of, start_equation(dae, variable, of));
        } else {
            free.push((variable, of));
        }
    }
    let given = equations.len();
    for (variable, of) in free {
        push(&mut equations, of, start_equation(dae, variable, of));
    }
    let (equations, origins) = needed(dae, &equations, &origins, given, &all);
    let system = format!("the initial system of `{}`", dae.name);
    let sorted = sort_mixed(dae, &system, &equations, &origins, &all)?;
    Ok((sorted.blocks, sorted.lagged))
}

/// The first `given` equations and those of the others that determine something more.
fn needed(
    dae: &Dae,
    equations: &[Equation],
    origins: &[usize],
    given: usize,
    all: &[VarId],
) -> (Vec<Equation>, Vec<usize>) {
    // Equations are matched one after the other: one that finds no unknown adds nothing.
    let matching = match_equations(&incidence(dae, equations, all));
    let pairs = equations.iter().zip(origins).enumerate();
    pairs
        .filter(|(at, _)| *at < given || matching.equation_to_unknown[*at].is_some())
        .map(|(_, (equation, origin))| (*equation, *origin))
        .unzip()
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
            equations.push((state, Equation { left, right, span: reinit.span }));
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
    Equation { left, right: of.start.unwrap_or(default), span: of.span }
}
