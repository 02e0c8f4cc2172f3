//! Replaces variables by expressions.

use super::node::{Expr, Node, VarId};
use super::pool::Pool;
use rustc_hash::FxHashMap;

/// The expression with variables replaced all at once; `replacement` gives `None` for those that
/// stay.
pub fn substitute(
    pool: &mut Pool,
    expr: Expr,
    replacement: &dyn Fn(VarId) -> Option<Expr>,
) -> Expr {
    Substitution::new(replacement).apply(pool, expr)
}

/// The same for one expression after another; what they share is replaced once.
pub(crate) struct Substitution<'a> {
    replacement: &'a dyn Fn(VarId) -> Option<Expr>,
    successors: FxHashMap<Expr, Expr>,
}

impl<'a> Substitution<'a> {
    /// `replacement` gives `None` for variables that stay.
    pub(crate) fn new(replacement: &'a dyn Fn(VarId) -> Option<Expr>) -> Substitution<'a> {
        Substitution { replacement, successors: FxHashMap::default() }
    }

    /// The expression with its variables replaced.
    pub(crate) fn apply(&mut self, pool: &mut Pool, expr: Expr) -> Expr {
        let successors = &mut self.successors;
        for old in pool.reachable_unless(&[expr], |known| successors.contains_key(&known)) {
            let node = pool.node(old).clone();
            let new = match node {
                Node::Variable(variable) => (self.replacement)(variable).unwrap_or(old),
                _ => {
                    let mut changed = false;
                    node.for_each_operand(|operand| changed |= successors[&operand] != operand);
                    if changed { pool.rebuild(&node, |operand| successors[&operand]) } else { old }
                }
            };
            successors.insert(old, new);
        }
        successors[&expr]
    }
}
