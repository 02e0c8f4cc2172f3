//! The initial system (MLS §8.6): the equations, the initial equations, and as many start values
//! of states as are needed to determine everything.

use super::blt::{incidence, sort_blocks};
use super::model::{Dae, Equation};
use super::sorted::Block;
use crate::diag::Diagnostic;
use crate::graph::match_equations;
use crate::symbolic::VarId;

/// Sorts the initial system. Start values that are `fixed` always hold; others hold where the
/// equations leave the state free.
pub(super) fn sort_initial(
    dae: &mut Dae,
    states: &[VarId],
    unknowns: &[VarId],
) -> Result<Vec<Block>, Diagnostic> {
    let mut all: Vec<VarId> = states.to_vec();
    all.extend(unknowns);
    let mut equations = dae.equations.clone();
    equations.extend(&dae.initial_equations);
    let (fixed, free): (Vec<VarId>, Vec<VarId>) =
        states.iter().partition(|state| dae.variable(**state).fixed);
    for state in fixed {
        let equation = start_equation(dae, state);
        equations.push(equation);
    }
    if dae.initial_equations.is_empty() {
        for state in free {
            let equation = start_equation(dae, state);
            equations.push(equation);
        }
    } else {
        complete(dae, &mut equations, &free, &all);
    }
    sort_blocks(dae, &equations, &all)
}

/// Adds the start values that raise the number of determined unknowns.
fn complete(dae: &mut Dae, equations: &mut Vec<Equation>, free: &[VarId], all: &[VarId]) {
    let mut determined = match_equations(&incidence(dae, equations, all)).len();
    for state in free {
        if determined == all.len() {
            return;
        }
        let equation = start_equation(dae, *state);
        equations.push(equation);
        let now = match_equations(&incidence(dae, equations, all)).len();
        if now == determined {
            equations.pop();
        }
        determined = now;
    }
}

fn start_equation(dae: &mut Dae, state: VarId) -> Equation {
    let left = dae.pool.variable(state);
    let zero = dae.pool.constant(0.0);
    let variable = dae.variable(state);
    Equation { left, right: variable.start.unwrap_or(zero), span: variable.span }
}
