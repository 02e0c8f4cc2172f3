//! States that are preferred although nothing differentiates them: `stateSelect =
//! StateSelect.prefer` of the pressure and the enthalpy of a medium in a volume, whose mass and
//! energy are differentiated.
//!
//! ```text
//! der(m) = q,  m = V*d(p, h)          states m            p, h by iteration at every step
//! der(U) = Q,  U = m*(h - p/d)               p, h         der(m) = V*d', without
//! ```
//!
//! With derivatives of their own, such variables are constrained by the states that there are, and
//! index reduction decides by `stateSelect` (MLS §4.9.7.1). What does not become a state then
//! gets none, and nothing does where a constraint may jump at events.

use super::causalized::Alias;
use super::dummy_derivatives::{Chains, HighestBlock, inverse};
use crate::flatten::{BaseType, Variability};
use crate::lower::{Dae, Equation, StateSelect, VariableKind, derivative_of};
use crate::symbolic::VarId;
use rustc_hash::{FxHashMap, FxHashSet};

/// Unknowns that are preferred as states and not differentiated.
pub(super) fn preferred(dae: &Dae, aliases: &[Option<Alias>]) -> Vec<VarId> {
    let differentiated: FxHashSet<VarId> = dae
        .variables
        .iter()
        .filter_map(|variable| match variable.kind {
            VariableKind::Derivative(of) => Some(of),
            _ => None,
        })
        .collect();
    let is_preferred = |v: &VarId| {
        let variable = dae.variable(*v);
        variable.state_select >= StateSelect::Prefer
            && variable.kind == VariableKind::Unknown
            && variable.base == BaseType::Real
            && variable.variability == Variability::Continuous
            && aliases[v.0 as usize].is_none()
            && !differentiated.contains(v)
    };
    match differentiated.is_empty() {
        true => Vec::new(),
        false => (0..dae.variables.len() as u32).map(VarId).filter(is_preferred).collect(),
    }
}

/// Gives variables derivatives that no equation has.
pub(super) fn declare_derivatives(
    dae: &mut Dae,
    aliases: &mut Vec<Option<Alias>>,
    variables: &[VarId],
) {
    for v in variables {
        let derivative = derivative_of(dae.variable(*v), *v);
        dae.variables.push(derivative);
        aliases.push(None);
    }
}

/// Blocks that decide together about preferred states: what constrains the pressure of a volume leads
/// to its mass, which another block determines.
pub(super) fn joined(
    dae: &Dae,
    chains: &Chains,
    mut blocks: Vec<HighestBlock>,
    preferred: &[VarId],
) -> Vec<HighestBlock> {
    if preferred.is_empty() {
        return blocks;
    }
    let eq_to_origin = inverse(&chains.eq_to_derivative);
    let var_to_origin = inverse(&chains.var_to_derivative);
    let column: FxHashMap<VarId, usize> =
        chains.variables.iter().enumerate().map(|(at, v)| (*v, at)).collect();
    let mut block_of = vec![None; chains.variables.len()];
    for (at, (_, variables)) in blocks.iter().enumerate() {
        variables.iter().for_each(|v| block_of[*v] = Some(at));
    }
    let mut is_joined = vec![false; blocks.len()];
    let mut all = Vec::new();
    for variable in preferred {
        let mut waiting: Vec<usize> = column.get(variable).copied().into_iter().collect();
        waiting = waiting.iter().filter_map(|v| chains.var_to_derivative[*v]).collect();
        let mut together = (Vec::new(), Vec::new());
        while let Some(variable) = waiting.pop() {
            let Some(block) = block_of[variable].filter(|block| !is_joined[*block]) else {
                continue;
            };
            is_joined[block] = true;
            let (equations, variables) = std::mem::take(&mut blocks[block]);
            for equation in equations.iter().filter(|e| eq_to_origin[**e].is_some()) {
                let Equation { left, right, .. } = dae.equations[chains.equations[*equation]];
                for side in [left, right] {
                    let used = dae.pool.variables(side);
                    let columns = used.iter().filter_map(|v| column.get(v).copied());
                    waiting.extend(columns.filter(|v| var_to_origin[*v].is_some()));
                }
            }
            together.0.extend(equations);
            together.1.extend(variables);
        }
        all.push(together);
    }
    all.extend(blocks);
    all.retain(|(_, variables)| !variables.is_empty());
    all
}
