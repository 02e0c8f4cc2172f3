//! Conditions that equations say are always true or always false: the branch that is never taken is
//! left out before the structure is looked at.
//!
//! ```text
//! level = 0, height = 0, full = level >= height      p = p0
//! 0 = if full then p - p0 else q                     (p has no other equation)
//! ```
//!
//! A vessel without data of its ports has such equations: in all branches together its pressure and
//! its flow look as if both were determined.

use super::numbers::Numbers;
use crate::lower::{Dae, VariableKind};
use crate::symbolic::{Expr, Node, Substitution, VarId};
use rustc_hash::{FxHashMap, FxHashSet};

/// Puts numbers in the place of conditions; equations that give them these numbers stay.
pub(super) fn fold_conditions(dae: &mut Dae) {
    let conditions = conditions(dae);
    if conditions.is_empty() {
        return;
    }
    let mut numbers = Numbers::of(dae);
    let mut known: FxHashMap<VarId, Expr> = FxHashMap::default();
    for v in conditions {
        if let Some(value) = numbers.value_of(dae, v) {
            known.insert(v, dae.pool.constant(value));
        }
    }
    if known.is_empty() {
        return;
    }
    let replacement = |v: VarId| known.get(&v).copied();
    let mut substitution = Substitution::new(&replacement);
    let pool = &mut dae.pool;
    for equation in dae.equations.iter_mut().chain(&mut dae.initial_equations) {
        for side in [&mut equation.left, &mut equation.right] {
            if pool.as_variable(*side).is_none() {
                *side = substitution.apply(pool, *side);
            }
        }
    }
}

/// The discrete variables and the relations on which branches of equations depend, ascending.
fn conditions(dae: &Dae) -> Vec<VarId> {
    let sides: Vec<Expr> = dae.equations.iter().flat_map(|e| [e.left, e.right]).collect();
    let mut found: FxHashSet<VarId> = FxHashSet::default();
    for node in dae.pool.reachable(&sides) {
        let Node::If(condition, ..) = dae.pool.node(node) else { continue };
        found.extend(dae.pool.variables(*condition));
    }
    let is_kept =
        |v: &VarId| matches!(dae.variable(*v).kind, VariableKind::Discrete | VariableKind::Frozen);
    let mut found: Vec<VarId> = found.into_iter().filter(is_kept).collect();
    found.sort_unstable();
    found
}
