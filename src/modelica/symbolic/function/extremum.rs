//! Minimum and maximum of two numbers (MLS §10.3.4).

use super::{Function, ResultType, UnitRule, Value, real};
use crate::symbolic::node::{Expr, RelationOperator};
use crate::symbolic::pool::Pool;

pub(super) const FUNCTIONS: &[Function] = &[
    Function {
        result: ResultType::AsArguments,
        unit: UnitRule::Common,
        section: "MLS §10.3.4",
        is_kinked: true,
        ..real("min", Value::Binary(min), |pool, x, which| {
            chosen(pool, RelationOperator::LessEqual, x, which)
        })
    },
    Function {
        result: ResultType::AsArguments,
        unit: UnitRule::Common,
        section: "MLS §10.3.4",
        is_kinked: true,
        ..real("max", Value::Binary(max), |pool, x, which| {
            chosen(pool, RelationOperator::GreaterEqual, x, which)
        })
    },
];

/// Not `f64::min`, which hides a NaN.
fn min(x: f64, y: f64) -> f64 {
    if y < x || y.is_nan() { y } else { x }
}

fn max(x: f64, y: f64) -> f64 {
    if y > x || y.is_nan() { y } else { x }
}

/// 1 for the argument that is the value, 0 for the other.
fn chosen(pool: &mut Pool, first_wins: RelationOperator, x: &[Expr], which: usize) -> Expr {
    let condition = pool.relation(first_wins, x[0], x[1]);
    let (one, zero) = (pool.constant(1.0), pool.constant(0.0));
    if which == 0 {
        pool.if_then_else(condition, one, zero)
    } else {
        pool.if_then_else(condition, zero, one)
    }
}
