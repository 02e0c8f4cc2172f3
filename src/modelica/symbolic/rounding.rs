//! Conditions up to rounding errors.
//!
//! ```text
//! abs(a + b - 1) < eps     a + b = 1 + 2 eps, because a and b were rounded
//! ```
//!
//! No tool promises the order in which a sum is computed, and so its last digits: who asserts
//! something of it means it up to that (Higham, *Accuracy and Stability of Numerical Algorithms*,
//! §3.3, running error analysis).

use super::function;
use super::node::{Expr, Node, RelationOperator};
use super::pool::Pool;
use rustc_hash::FxHashMap;

/// Roundings that a variable or the value of a function may contain.
const ROUNDINGS: f64 = 8.0;

/// A condition that holds where this one does, and where it fails by no more than what sums and
/// differences in its relations are rounded by.
pub(crate) fn up_to_rounding(pool: &mut Pool, condition: Expr) -> Expr {
    let mut lenient: FxHashMap<Expr, Expr> = FxHashMap::default();
    for node in pool.reachable(&[condition]) {
        let of = |operand: Expr| lenient.get(&operand).copied().unwrap_or(operand);
        let found = match *pool.node(node) {
            Node::And(a, b) => pool.and(of(a), of(b)),
            Node::Or(a, b) => pool.or(of(a), of(b)),
            Node::Relation(operator, a, b) => nearly(pool, node, operator, (a, b)),
            _ => continue,
        };
        lenient.insert(node, found);
    }
    lenient.get(&condition).copied().unwrap_or(condition)
}

/// A relation that also holds where its sides differ by no more than rounding errors.
fn nearly(
    pool: &mut Pool,
    relation: Expr,
    operator: RelationOperator,
    (a, b): (Expr, Expr),
) -> Expr {
    if !is_computed(pool, a) && !is_computed(pool, b) {
        return relation;
    }
    let (small, large) = match operator {
        RelationOperator::Less | RelationOperator::LessEqual => (a, b),
        RelationOperator::Greater | RelationOperator::GreaterEqual => (b, a),
        RelationOperator::Equal | RelationOperator::NotEqual => return relation,
    };
    let excess = pool.sub(small, large);
    let bound = bound(pool, excess);
    let nearly = pool.relation(RelationOperator::LessEqual, excess, bound);
    pool.or(relation, nearly)
}

/// Whether there is a sum or difference in an expression, where digits are lost.
fn is_computed(pool: &Pool, e: Expr) -> bool {
    let mut nodes = pool.reachable(&[e]).into_iter();
    nodes.any(|node| matches!(pool.node(node), Node::Add(..) | Node::Sub(..)))
}

/// By how much an expression may be wrong.
fn bound(pool: &mut Pool, e: Expr) -> Expr {
    let mut bounds: FxHashMap<Expr, Expr> = FxHashMap::default();
    for node in pool.reachable(&[e]) {
        let of = |operand: Expr| bounds.get(&operand).copied();
        let found = bound_of(pool, node, of);
        bounds.insert(node, found);
    }
    bounds[&e]
}

fn bound_of(pool: &mut Pool, e: Expr, of: impl Fn(Expr) -> Option<Expr>) -> Expr {
    let zero = pool.constant(0.0);
    let of = |operand: Expr| of(operand).unwrap_or(zero);
    match pool.node(e).clone() {
        Node::Constant(_) => zero,
        Node::Neg(a) => of(a),
        Node::Add(a, b) | Node::Sub(a, b) => {
            let rounded = rounded(pool, e, 1.0);
            let both = pool.add(of(a), of(b));
            pool.add(both, rounded)
        }
        Node::Mul(a, b) => {
            let (size_a, size_b) = (size(pool, a), size(pool, b));
            let (from_a, from_b) = (pool.mul(size_b, of(a)), pool.mul(size_a, of(b)));
            let rounded = rounded(pool, e, 1.0);
            let both = pool.add(from_a, from_b);
            pool.add(both, rounded)
        }
        Node::Div(a, b) => {
            let (own, below) = (size(pool, e), size(pool, b));
            let from_b = pool.mul(own, of(b));
            let both = pool.add(of(a), from_b);
            let both = pool.div(both, below);
            let rounded = rounded(pool, e, 1.0);
            pool.add(both, rounded)
        }
        Node::If(condition, a, b) => pool.if_then_else(condition, of(a), of(b)),
        Node::Apply(id, arguments) if Some(id) == function::find("abs") => of(arguments.first()),
        _ => rounded(pool, e, ROUNDINGS),
    }
}

fn size(pool: &mut Pool, e: Expr) -> Expr {
    pool.function("abs", &[e])
}

fn rounded(pool: &mut Pool, e: Expr, times: f64) -> Expr {
    let size = size(pool, e);
    let unit = pool.constant(times * f64::EPSILON);
    pool.mul(unit, size)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::symbolic::VarId;
    use crate::symbolic::evaluate::evaluate;

    /// Whether |a + b - 1| < limit, literally and up to rounding.
    fn holds(a: f64, b: f64, limit: f64) -> (bool, bool) {
        let mut pool = Pool::default();
        let (x, y) = (pool.variable(VarId(0)), pool.variable(VarId(1)));
        let (one, limit) = (pool.constant(1.0), pool.constant(limit));
        let sum = pool.add(x, y);
        let difference = pool.sub(sum, one);
        let size = pool.function("abs", &[difference]);
        let literal = pool.relation(RelationOperator::Less, size, limit);
        let nearly = up_to_rounding(&mut pool, literal);
        let value = |e: Expr| evaluate(&pool, e, &[a, b][..]) != 0.0;
        (value(literal), value(nearly))
    }

    #[test]
    fn sums_are_meant_up_to_rounding() {
        let eps = f64::EPSILON;
        assert_eq!(holds(0.25, 0.75, eps), (true, true));
        assert_eq!(holds(0.25, 0.75 + 2.0 * eps, eps), (false, true));
        assert_eq!(holds(0.25, 0.75 + 1e-13, eps), (false, false));
        assert_eq!(holds(0.25, 0.75 + 1e-3 + 4.0 * eps, 1e-3), (false, true));
        assert_eq!(holds(0.25, 0.75 + 1.001e-3, 1e-3), (false, false));
    }

    #[test]
    fn comparisons_without_arithmetic_stay_as_they_are() {
        let mut pool = Pool::default();
        let (x, zero) = (pool.variable(VarId(0)), pool.constant(0.0));
        let literal = pool.relation(RelationOperator::Greater, x, zero);
        assert_eq!(up_to_rounding(&mut pool, literal), literal);
    }
}
