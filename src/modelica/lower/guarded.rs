//! Branches that are not evaluated: those of if-expressions whose condition is false (MLS §3.3),
//! and the right operand of `and` and `or` where the left one decides, as in C.
//!
//! Relations are evaluated outside of the branches in which they stand, to find their events. Where
//! that could fail, their sides are evaluated under the conditions of these branches only.

use super::builder::Builder;
use crate::symbolic::{Expr, Node, Pool};
use rustc_hash::FxHashSet;

/// The most nodes that are looked at in search of one that may fail.
const MOST_NODES: usize = 1000;

impl Builder<'_> {
    /// What is lowered from here on is in a branch, up to [`Builder::leave_branch`].
    pub(super) fn enter_branch(&mut self, condition: Expr, holds: bool) {
        let condition = match holds {
            true => condition,
            false => self.dae.pool.not(condition),
        };
        self.execution.branches.push(condition);
    }

    pub(super) fn leave_branch(&mut self) {
        self.execution.branches.pop();
    }

    /// The sides of a relation, which are 0 and 1 where its branch is not taken, if one may fail.
    pub(super) fn guarded_sides(&mut self, a: Expr, b: Expr) -> [Expr; 2] {
        let pool = &mut self.dae.pool;
        let conditions = self.execution.guards.iter().chain(&self.execution.branches);
        let mut sides = [a, b];
        if conditions.clone().next().is_none() || !sides.iter().any(|side| may_fail(pool, *side)) {
            return sides;
        }
        for condition in conditions.rev() {
            for (side, otherwise) in sides.iter_mut().zip([0.0, 1.0]) {
                let otherwise = pool.constant(otherwise);
                *side = pool.if_then_else(*condition, *side, otherwise);
            }
        }
        sides
    }

    /// `a and b`, or `a or b`, where b is evaluated only if a does not decide and b may fail.
    pub(super) fn connective(&mut self, is_and: bool, a: Expr, b: Expr) -> Expr {
        let pool = &mut self.dae.pool;
        match (is_and, may_fail(pool, b)) {
            (true, false) => pool.and(a, b),
            (false, false) => pool.or(a, b),
            (true, true) => {
                let decided = pool.constant(0.0);
                pool.if_then_else(a, b, decided)
            }
            (false, true) => {
                let decided = pool.constant(1.0);
                pool.if_then_else(a, decided, b)
            }
        }
    }
}

/// Whether an expression may have no value: it divides, or calls a function that is not defined
/// everywhere. Branches in it have conditions of their own.
fn may_fail(pool: &Pool, e: Expr) -> bool {
    let mut pending = vec![e];
    let mut seen = FxHashSet::default();
    while let Some(e) = pending.pop() {
        if !seen.insert(e) {
            continue;
        }
        if seen.len() > MOST_NODES {
            return false;
        }
        let node = pool.node(e);
        let constant = |e: &Expr| pool.as_constant(*e);
        match node {
            Node::Div(_, divisor) if constant(divisor).is_none() => return true,
            Node::Pow(_, n) if constant(n).is_none_or(|n| n < 0.0 || n.fract() != 0.0) => {
                return true;
            }
            Node::Apply(function, _) if function.get().domain.is_some() => return true,
            Node::Call { .. } | Node::CallDerivative { .. } | Node::Solution { .. } => return true,
            Node::If(condition, ..) => pending.push(*condition),
            _ => node.for_each_operand(|operand| pending.push(operand)),
        }
    }
    false
}
