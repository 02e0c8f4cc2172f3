//! Collects equal terms of a sum.

use super::node::{Expr, Node};
use super::pool::Pool;
use indexmap::IndexMap;

/// The sum with equal terms collected: `a + 2 * b - a` becomes `2 * b`. Constants come last; terms
/// keep the order of their first occurrence. Only the outermost sum is looked at.
pub fn collect_terms(pool: &mut Pool, expr: Expr) -> Expr {
    let mut terms: IndexMap<Expr, f64> = IndexMap::new();
    let mut constant = 0.0;
    let mut pending = vec![(expr, 1.0f64)];
    let mut visits = 0;
    while let Some((term, factor)) = pending.pop() {
        visits += 1;
        if visits > MOST_VISITS || !factor.is_finite() {
            return expr;
        }
        match *pool.node(term) {
            Node::Constant(value) => constant += factor * value.0,
            Node::Neg(a) => pending.push((a, -factor)),
            Node::Add(a, b) => pending.extend([(b, factor), (a, factor)]),
            Node::Sub(a, b) => pending.extend([(b, -factor), (a, factor)]),
            Node::Mul(a, b) => match (pool.as_constant(a), pool.as_constant(b)) {
                (Some(value), None) => pending.push((b, factor * value)),
                (None, Some(value)) => pending.push((a, factor * value)),
                _ => *terms.entry(term).or_insert(0.0) += factor,
            },
            _ => *terms.entry(term).or_insert(0.0) += factor,
        }
    }
    if !constant.is_finite() || terms.values().any(|factor| !factor.is_finite()) {
        return expr;
    }
    let mut sum = pool.constant(0.0);
    for (term, factor) in terms {
        let factor = pool.constant(factor);
        let product = pool.mul(factor, term);
        sum = pool.add(sum, product);
    }
    let constant = pool.constant(constant);
    pool.add(sum, constant)
}

/// Longer sums stay as they are; a shared sum counts once for every path that leads to it.
const MOST_VISITS: usize = 10_000;
