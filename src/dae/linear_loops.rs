//! Linear loops in closed form: one or two iteration variables that the residuals contain linearly,
//! with coefficients free of them.
//!
//! ```text
//! one   a z + r = 0                    z = −r / a
//! two   a z + b w + r = 0              z = (b s − d r) / (a d − b c)
//!       c z + d w + s = 0              w = (c r − a s) / (a d − b c)
//! ```
//!
//! The divisor is zero only where the loop is singular: what was divided by before is not.

use super::model::Dae;
use super::sorted::{Assignment, LinearLoop, Loop};
use crate::symbolic::{Expr, Linear, Pool, VarId, linear_in, substitute};
use rustc_hash::FxHashMap;

/// Nodes of a residual beyond which a loop is left to iteration.
const MOST_NODES: usize = 20_000;

/// The solution of a torn loop, if it is so simple.
pub(super) fn solve_linear(dae: &mut Dae, torn: &Loop) -> Option<LinearLoop> {
    let residuals = residuals(&mut dae.pool, torn)?;
    let pool = &mut dae.pool;
    let values = match (&torn.iteration[..], &residuals[..]) {
        (&[z], &[residual]) => vec![one(pool, residual, z)?],
        (&[z, w], &[first, second]) => two(pool, [first, second], [z, w])?.to_vec(),
        _ => return None,
    };
    let solved = torn.iteration.iter().zip(values).zip(&torn.residuals);
    let mut assignments: Vec<Assignment> = solved
        .map(|((variable, value), (_, equation))| Assignment {
            variable: *variable,
            value,
            equation: *equation,
        })
        .collect();
    assignments.extend(&torn.assignments);
    Some(LinearLoop { unknowns: torn.iteration.clone(), assignments })
}

/// The residuals as expressions of the iteration variables.
fn residuals(pool: &mut Pool, torn: &Loop) -> Option<Vec<Expr>> {
    if torn.iteration.len() > 2 {
        return None;
    }
    let mut inner: FxHashMap<VarId, Expr> = FxHashMap::default();
    for assignment in &torn.assignments {
        let value = substitute(pool, assignment.value, &|v| inner.get(&v).copied());
        inner.insert(assignment.variable, value);
    }
    let mut residuals = Vec::new();
    for (residual, _) in &torn.residuals {
        residuals.push(substitute(pool, *residual, &|v| inner.get(&v).copied()));
    }
    (pool.reachable(&residuals).len() <= MOST_NODES).then_some(residuals)
}

fn one(pool: &mut Pool, residual: Expr, z: VarId) -> Option<Expr> {
    let linear = linear_in(pool, residual, z)?;
    let opposite = pool.neg(linear.rest);
    divided(pool, opposite, linear.coefficient)
}

fn two(pool: &mut Pool, residuals: [Expr; 2], [z, w]: [VarId; 2]) -> Option<[Expr; 2]> {
    let [(a, b, r), (c, d, s)] =
        [coefficients(pool, residuals[0], [z, w])?, coefficients(pool, residuals[1], [z, w])?];
    let mut cross = |a: Expr, d: Expr, b: Expr, c: Expr| {
        let (ad, bc) = (pool.mul(a, d), pool.mul(b, c));
        pool.sub(ad, bc)
    };
    let determinant = cross(a, d, b, c);
    let (upper, lower) = (cross(b, s, d, r), cross(c, r, a, s));
    Some([divided(pool, upper, determinant)?, divided(pool, lower, determinant)?])
}

fn coefficients(pool: &mut Pool, residual: Expr, [z, w]: [VarId; 2]) -> Option<(Expr, Expr, Expr)> {
    let Linear { coefficient: a, rest } = linear_in(pool, residual, z)?;
    if pool.depends_on(a, w) {
        return None;
    }
    let Linear { coefficient: b, rest } = linear_in(pool, rest, w)?;
    Some((a, b, rest))
}

/// A quotient whose divisor is not always zero.
fn divided(pool: &mut Pool, numerator: Expr, divisor: Expr) -> Option<Expr> {
    (pool.as_constant(divisor) != Some(0.0)).then(|| pool.div(numerator, divisor))
}
