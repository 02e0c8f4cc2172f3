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
    let mut successors: FxHashMap<Expr, Expr> = FxHashMap::default();
    for old in pool.reachable(&[expr]) {
        let node = pool.node(old).clone();
        let new = match node {
            Node::Variable(variable) => replacement(variable).unwrap_or(old),
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
