//! Derivatives that have only coefficients of zero: a transistor without capacitances has
//! voltages with derivatives, but no states.
//!
//! ```text
//! c = 0,   i = c * der(v)      i = 0; v has no derivative if it stands nowhere else
//! ```
//!
//! A coefficient is zero if the equations of its variables say so, whatever parameters are set to.

use super::causalized::Alias;
use super::numbers::Numbers;
use crate::lower::{Dae, Equation, VariableKind, used_variables};
use crate::symbolic::{Expr, Node, VarId};
use rustc_hash::{FxHashMap, FxHashSet};

/// Drops the terms, then the derivatives that stand nowhere.
pub(super) fn drop_zero_derivatives(dae: &mut Dae, aliases: &[Option<Alias>]) {
    let derivatives: FxHashSet<VarId> = (0..dae.variables.len() as u32)
        .map(VarId)
        .filter(|v| matches!(dae.variable(*v).kind, VariableKind::Derivative(_)))
        .filter(|v| aliases[v.0 as usize].is_none())
        .collect();
    let mut numbers = Numbers::of(dae);
    let mut dropped = FxHashSet::default();
    for at in 0..dae.equations.len() {
        let Equation { left, right, .. } = dae.equations[at];
        for side in [left, right] {
            let found: Vec<VarId> = contained(dae, side, &derivatives);
            if found.is_empty() {
                continue;
            }
            let changed = without_zeros(dae, side, &derivatives, &mut numbers);
            if changed != side {
                dropped.extend(found);
                let equation = &mut dae.equations[at];
                let place = if side == left { &mut equation.left } else { &mut equation.right };
                *place = changed;
            }
        }
    }
    if !dropped.is_empty() {
        forget_unused(dae, &dropped, aliases);
    }
}

fn contained(dae: &Dae, e: Expr, derivatives: &FxHashSet<VarId>) -> Vec<VarId> {
    dae.pool.variables(e).into_iter().filter(|v| derivatives.contains(v)).collect()
}

/// The expression without products of zeros and derivatives.
fn without_zeros(
    dae: &mut Dae,
    e: Expr,
    derivatives: &FxHashSet<VarId>,
    numbers: &mut Numbers,
) -> Expr {
    let mut zeros: FxHashSet<Expr> = FxHashSet::default();
    for node in dae.pool.reachable(&[e]) {
        let Node::Mul(a, b) = *dae.pool.node(node) else { continue };
        for (factor, other) in [(a, b), (b, a)] {
            let is_term = contained(dae, factor, derivatives).is_empty()
                && !contained(dae, other, derivatives).is_empty();
            if is_term && numbers.value(dae, factor) == Some(0.0) {
                zeros.insert(node);
            }
        }
    }
    let mut successors: FxHashMap<Expr, Expr> = FxHashMap::default();
    let zero = dae.pool.constant(0.0);
    for old in dae.pool.reachable(&[e]) {
        let new = match zeros.contains(&old) {
            true => zero,
            false => {
                let node = dae.pool.node(old).clone();
                let mut changed = false;
                node.for_each_operand(|operand| changed |= successors[&operand] != operand);
                match changed {
                    true => dae.pool.rebuild(&node, |operand| successors[&operand]),
                    false => old,
                }
            }
        };
        successors.insert(old, new);
    }
    successors[&e]
}

/// Derivatives that no equation contains any more are not unknowns.
fn forget_unused(dae: &mut Dae, dropped: &FxHashSet<VarId>, aliases: &[Option<Alias>]) {
    let mut used = used_variables(dae);
    aliases.iter().flatten().for_each(|alias| used[alias.of.0 as usize] = true);
    for v in dropped.iter().filter(|v| !used[v.0 as usize]) {
        dae.variables[v.0 as usize].kind = VariableKind::Signal;
    }
}
