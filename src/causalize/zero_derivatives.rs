//! Derivatives that only coefficients of zero stand before: a transistor without capacitances has
//! voltages with derivatives, but no states.
//!
//! ```text
//! c = 0,   i = c * der(v)      i = 0; v has no derivative if it stands nowhere else
//! ```
//!
//! A coefficient is zero if the equations of its variables say so, whatever parameters are set to.

use super::causalized::Alias;
use crate::lower::{Dae, Equation, Kind, used_variables};
use crate::symbolic::{Expr, Node, VarId, substitute};
use rustc_hash::{FxHashMap, FxHashSet};

/// Variables through which the value of a coefficient is followed.
const DEEPEST: usize = 20;

/// Drops the terms, then the derivatives that stand nowhere.
pub(super) fn drop_zero_derivatives(dae: &mut Dae, aliases: &[Option<Alias>]) {
    let derivatives: FxHashSet<VarId> = (0..dae.variables.len() as u32)
        .map(VarId)
        .filter(|v| matches!(dae.variable(*v).kind, Kind::Derivative(_)))
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
            if is_term && numbers.value(dae, factor, 0) == Some(0.0) {
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

/// What equations say that variables are.
struct Numbers {
    /// The other side of the equation that a variable makes a side of.
    given: FxHashMap<VarId, Expr>,
    known: FxHashMap<VarId, Option<f64>>,
}

impl Numbers {
    fn of(dae: &Dae) -> Numbers {
        let mut given = FxHashMap::default();
        for Equation { left, right, .. } in &dae.equations {
            for (side, other) in [(*left, *right), (*right, *left)] {
                if let Some(v) = dae.pool.as_variable(side)
                    && dae.is_solved_for(v)
                    && !dae.pool.depends_on(other, v)
                {
                    given.entry(v).or_insert(other);
                }
            }
        }
        Numbers { given, known: FxHashMap::default() }
    }

    fn value(&mut self, dae: &mut Dae, e: Expr, depth: usize) -> Option<f64> {
        if let Some(value) = dae.pool.as_constant(e) {
            return Some(value);
        }
        let mut numbers: FxHashMap<VarId, Expr> = FxHashMap::default();
        for v in dae.pool.variables(e) {
            if let Some(value) = self.value_of(dae, v, depth) {
                numbers.insert(v, dae.pool.constant(value));
            }
        }
        let replaced = substitute(&mut dae.pool, e, &|v| numbers.get(&v).copied());
        dae.pool.as_constant(replaced)
    }

    fn value_of(&mut self, dae: &mut Dae, v: VarId, depth: usize) -> Option<f64> {
        if let Some(known) = self.known.get(&v) {
            return *known;
        }
        let other = self.given.get(&v).copied().filter(|_| depth < DEEPEST)?;
        self.known.insert(v, None);
        let value = self.value(dae, other, depth + 1);
        self.known.insert(v, value);
        value
    }
}

/// Derivatives that no equation contains any more are no unknowns.
fn forget_unused(dae: &mut Dae, dropped: &FxHashSet<VarId>, aliases: &[Option<Alias>]) {
    let mut used = used_variables(dae);
    aliases.iter().flatten().for_each(|alias| used[alias.of.0 as usize] = true);
    for v in dropped.iter().filter(|v| !used[v.0 as usize]) {
        dae.variables[v.0 as usize].kind = Kind::Signal;
    }
}
