//! Solves one equation for one variable.

use super::function;
use super::node::{Expr, Node, VarId};
use super::pool::Pool;
use rustc_hash::{FxHashMap, FxHashSet};

/// `coefficient * v + rest` with neither containing v.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Linear {
    /// The factor of the variable.
    pub coefficient: Expr,
    /// What is left with the variable at zero.
    pub rest: Expr,
}

/// The solution of an equation for a variable.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Solution {
    /// What the variable is equal to; does not contain it.
    pub value: Expr,
    /// What the solution divides by: where this is zero the equation may hold for every value.
    pub divisor: Expr,
    /// What it divides by where the variable stands below a fraction: `a / v = b` has no solution at
    /// all where `b` is zero, so that nothing is lost there.
    pub(crate) inverted: Expr,
    /// Whether it solves the equation everywhere: an inverse that a function declares may be one in
    /// a part of its range only.
    pub is_exact: bool,
}

/// `(coefficient * v + rest) / denominator` with none of them containing v.
#[derive(Debug, Clone, Copy)]
struct Fraction {
    coefficient: Expr,
    rest: Expr,
    denominator: Expr,
}

/// Takes an expression apart that is linear in `variable`; `None` if it is not, or not visibly.
pub(crate) fn linear_in(pool: &mut Pool, expr: Expr, variable: VarId) -> Option<Linear> {
    let Fraction { coefficient, rest, .. } = fraction_in(pool, expr, variable, |pool, a, b| {
        Fraction { coefficient: pool.div(a.coefficient, b), rest: pool.div(a.rest, b), ..a }
    })?;
    Some(Linear { coefficient, rest })
}

/// The same with what the variable is divided by apart: to multiply with it is always possible, to
/// divide by its inverse is not where it is zero.
fn with_denominator(pool: &mut Pool, expr: Expr, variable: VarId) -> Option<Fraction> {
    fraction_in(pool, expr, variable, |pool, a, b| Fraction {
        denominator: pool.mul(a.denominator, b),
        ..a
    })
}

/// Takes an expression apart; `divide` makes of a part what it is when it is divided.
fn fraction_in(
    pool: &mut Pool,
    expr: Expr,
    variable: VarId,
    divide: impl Fn(&mut Pool, Fraction, Expr) -> Fraction,
) -> Option<Fraction> {
    let (zero, one) = (pool.constant(0.0), pool.constant(1.0));
    let free = |rest: Expr| Fraction { coefficient: zero, rest, denominator: one };
    let mut parts: FxHashMap<Expr, Option<Fraction>> = FxHashMap::default();
    for node in pool.reachable_with(&[expr], variable) {
        let of =
            |operand: &Expr| parts.get(operand).copied().unwrap_or_else(|| Some(free(*operand)));
        let part = match pool.node(node).clone() {
            Node::Variable(v) if v == variable => {
                Some(Fraction { coefficient: one, rest: zero, denominator: one })
            }
            other => {
                let mut contains = false;
                other.for_each_operand(|operand| contains |= parts.contains_key(&operand));
                if !contains {
                    continue;
                }
                fraction_of(pool, &other, of, &divide)
            }
        };
        parts.insert(node, part);
    }
    parts.remove(&expr).unwrap_or_else(|| Some(free(expr)))
}

/// The parts of a node from the parts of its operands.
fn fraction_of(
    pool: &mut Pool,
    node: &Node,
    of: impl Fn(&Expr) -> Option<Fraction>,
    divide: impl Fn(&mut Pool, Fraction, Expr) -> Fraction,
) -> Option<Fraction> {
    let is_free = |pool: &Pool, part: Fraction| pool.as_constant(part.coefficient) == Some(0.0);
    match node {
        Node::Neg(a) => {
            let a = of(a)?;
            Some(Fraction { coefficient: pool.neg(a.coefficient), rest: pool.neg(a.rest), ..a })
        }
        Node::Add(a, b) => {
            let (a, b) = with_one_denominator(pool, of(a)?, of(b)?);
            let coefficient = pool.add(a.coefficient, b.coefficient);
            Some(Fraction { coefficient, rest: pool.add(a.rest, b.rest), ..a })
        }
        Node::Sub(a, b) => {
            let (a, b) = with_one_denominator(pool, of(a)?, of(b)?);
            let coefficient = pool.sub(a.coefficient, b.coefficient);
            Some(Fraction { coefficient, rest: pool.sub(a.rest, b.rest), ..a })
        }
        Node::Mul(a, b) => {
            let (a, b) = (of(a)?, of(b)?);
            let (factor, other) = if is_free(pool, a) {
                (a.rest, b)
            } else if is_free(pool, b) {
                (b.rest, a)
            } else {
                return None;
            };
            let coefficient = pool.mul(factor, other.coefficient);
            Some(Fraction { coefficient, rest: pool.mul(factor, other.rest), ..other })
        }
        Node::Div(a, b) => {
            let (a, b) = (of(a)?, of(b)?);
            if !is_free(pool, b) {
                return None;
            }
            Some(divide(pool, a, b.rest))
        }
        Node::If(condition, a, b) => {
            let (c, a, b) = (of(condition)?, of(a)?, of(b)?);
            if !is_free(pool, c) {
                return None;
            }
            Some(Fraction {
                coefficient: pool.if_then_else(c.rest, a.coefficient, b.coefficient),
                rest: pool.if_then_else(c.rest, a.rest, b.rest),
                denominator: pool.if_then_else(c.rest, a.denominator, b.denominator),
            })
        }
        _ => None,
    }
}

/// Two terms over one denominator. What does not contain the variable takes that of the other; two
/// that contain it and are divided by different things are divided.
fn with_one_denominator(pool: &mut Pool, a: Fraction, b: Fraction) -> (Fraction, Fraction) {
    if a.denominator == b.denominator {
        return (a, b);
    }
    let is_free = |pool: &Pool, part: Fraction| pool.as_constant(part.coefficient) == Some(0.0);
    match (is_free(pool, a), is_free(pool, b)) {
        (true, _) => (over(pool, a, b.denominator), b),
        (false, true) => {
            let b = over(pool, b, a.denominator);
            (a, b)
        }
        (false, false) => (divided(pool, a), divided(pool, b)),
    }
}

/// A term without the variable over another denominator.
fn over(pool: &mut Pool, term: Fraction, denominator: Expr) -> Fraction {
    let term = divided(pool, term);
    Fraction { rest: pool.mul(term.rest, denominator), denominator, ..term }
}

fn divided(pool: &mut Pool, term: Fraction) -> Fraction {
    Fraction {
        coefficient: pool.div(term.coefficient, term.denominator),
        rest: pool.div(term.rest, term.denominator),
        denominator: pool.constant(1.0),
    }
}

/// Solves `left = right` for `variable` if it occurs linearly, or if inverting sums, products,
/// quotients, `exp`, `log` and user functions with declared inverses from the outside in isolates
/// it. `None` otherwise: nothing is solved that could have a second solution or lose one.
pub fn solve(pool: &mut Pool, left: Expr, right: Expr, variable: VarId) -> Option<Solution> {
    let one = pool.constant(1.0);
    let (left_has, right_has) = (pool.depends_on(left, variable), pool.depends_on(right, variable));
    let (mut side, other) = match (left_has, right_has) {
        (false, false) => return None,
        (true, false) => (left, right),
        (false, true) => (right, left),
        (true, true) => (pool.sub(left, right), pool.constant(0.0)),
    };
    let mut moved = Solution { value: other, divisor: one, inverted: one, is_exact: true };
    let (mut containing, mut may_be_linear) = (None, true);
    loop {
        if may_be_linear && let Some(fraction) = with_denominator(pool, side, variable) {
            if pool.as_constant(fraction.coefficient) == Some(0.0) {
                return None;
            }
            let multiplied = pool.mul(moved.value, fraction.denominator);
            let difference = pool.sub(multiplied, fraction.rest);
            let value = pool.div(difference, fraction.coefficient);
            let divisor = pool.mul(moved.divisor, fraction.coefficient);
            return Some(Solution { value, divisor, ..moved });
        }
        // A term of a sum is linear only where the sum is.
        may_be_linear = !matches!(pool.node(side), Node::Neg(_) | Node::Add(..) | Node::Sub(..));
        let containing = containing.get_or_insert_with(|| nodes_with(pool, side, variable));
        (side, moved) = peel(pool, side, moved, containing)?;
    }
}

/// The nodes of an expression that contain a variable.
fn nodes_with(pool: &Pool, expr: Expr, variable: VarId) -> FxHashSet<Expr> {
    let mut found = FxHashSet::default();
    for node in pool.reachable_with(&[expr], variable) {
        let mut contains = pool.as_variable(node) == Some(variable);
        pool.node(node).for_each_operand(|operand| contains |= found.contains(&operand));
        if contains {
            found.insert(node);
        }
    }
    found
}

/// Moves the outermost operation of `side` to the other side, which is the value of `moved`.
fn peel(
    pool: &mut Pool,
    side: Expr,
    moved: Solution,
    containing: &FxHashSet<Expr>,
) -> Option<(Expr, Solution)> {
    let other = moved.value;
    let has = |a: Expr, b: Expr| (containing.contains(&a), containing.contains(&b));
    let (inner, value) = match *pool.node(side) {
        Node::Neg(a) => (a, pool.neg(other)),
        Node::Add(a, b) => match has(a, b) {
            (true, false) => (a, pool.sub(other, b)),
            (false, true) => (b, pool.sub(other, a)),
            _ => return None,
        },
        Node::Sub(a, b) => match has(a, b) {
            (true, false) => (a, pool.add(other, b)),
            (false, true) => (b, pool.sub(a, other)),
            _ => return None,
        },
        Node::Mul(a, b) => {
            let (inner, factor) = match has(a, b) {
                (true, false) => (a, b),
                (false, true) => (b, a),
                _ => return None,
            };
            let divisor = pool.mul(moved.divisor, factor);
            return Some((inner, Solution { value: pool.div(other, factor), divisor, ..moved }));
        }
        Node::Div(a, b) => match has(a, b) {
            (true, false) => (a, pool.mul(other, b)),
            (false, true) => {
                let inverted = pool.mul(moved.inverted, other);
                return Some((b, Solution { value: pool.div(a, other), inverted, ..moved }));
            }
            _ => return None,
        },
        Node::Apply(id, arguments) if Some(id) == function::find("exp") => {
            (arguments.first(), pool.function("log", &[other]))
        }
        Node::Apply(id, arguments) if Some(id) == function::find("log") => {
            (arguments.first(), pool.function("exp", &[other]))
        }
        Node::Call { function, output: 0, arguments } => {
            let (inner, value, is_exact) = inverted(pool, function, arguments, other, containing)?;
            let is_exact = moved.is_exact && is_exact;
            return Some((inner, Solution { value, is_exact, ..moved }));
        }
        _ => return None,
    };
    Some((inner, Solution { value, ..moved }))
}

/// The argument of a call that holds the variable, its value by the declared inverse of the function,
/// and whether that is exact; `None` if several hold it.
fn inverted(
    pool: &mut Pool,
    function: u32,
    arguments: Expr,
    value: Expr,
    containing: &FxHashSet<Expr>,
) -> Option<(Expr, Expr, bool)> {
    let entries = pool.entries(arguments).to_vec();
    let mut holding = (0..entries.len()).filter(|at| containing.contains(&entries[*at]));
    let (at, None) = (holding.next()?, holding.next()) else { return None };
    let inverse = pool.inverse(function, u32::try_from(at).ok()?)?.clone();
    let given: Vec<Expr> = inverse
        .arguments
        .iter()
        .map(|source| source.map_or(value, |input| entries[input as usize]))
        .collect();
    Some((entries[at], pool.call(inverse.function, 0, &given), inverse.is_exact))
}
