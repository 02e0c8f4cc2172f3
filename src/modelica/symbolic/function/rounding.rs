//! Division with remainder and rounding: functions that jump (MLS §3.7.2).

use super::{Domain, Function, ResultType, UnitRule, Value, real, zero};
use crate::symbolic::node::Expr;
use crate::symbolic::pool::Pool;

/// The Integers up to this one are exact as Reals, in which models compute: no other Integer is rounded
/// to them.
pub(crate) const LARGEST_INTEGER: f64 = 9_007_199_254_740_991.0;
/// What results of Integers go through. It has no name that could be called.
pub(crate) const INTEGER_ARITHMETIC: &str = "Integer arithmetic";

fn exact(x: f64) -> f64 {
    // An Integer has no negative zero.
    if x.abs() <= LARGEST_INTEGER { x + 0.0 } else { f64::NAN }
}

const NONZERO_DIVISOR: Option<Domain> =
    Some(Domain { contains: |x| x[1] != 0.0, words: "the second argument must not be zero" });

pub(super) const FUNCTIONS: &[Function] = &[
    Function {
        domain: NONZERO_DIVISOR,
        ..jumping("div", Value::Binary(|x, y| (x / y).trunc() + 0.0), ResultType::AsArguments, zero)
    },
    Function {
        domain: NONZERO_DIVISOR,
        ..jumping(
            "mod",
            Value::Binary(|x, y| x - (x / y).floor() * y),
            ResultType::AsArguments,
            |pool, x, which| remainder_derivative(pool, "floor", x, which),
        )
    },
    Function {
        domain: NONZERO_DIVISOR,
        ..jumping(
            "rem",
            Value::Binary(|x, y| x - (x / y).trunc() * y),
            ResultType::AsArguments,
            |pool, x, which| remainder_derivative(pool, "div", x, which),
        )
    },
    jumping("ceil", Value::Unary(f64::ceil), ResultType::Real, zero),
    jumping("floor", Value::Unary(f64::floor), ResultType::Real, zero),
    jumping("integer", Value::Unary(f64::floor), ResultType::Integer, zero),
    Function {
        domain: Some(Domain {
            contains: |x| x[0].abs() <= LARGEST_INTEGER,
            words: "the result is beyond 9007199254740991, up to which models have exact Integers",
        }),
        result: ResultType::AsArguments,
        unit: UnitRule::As(0),
        section: "MLS §10.6",
        ..real(INTEGER_ARITHMETIC, Value::Unary(exact), |pool, _, _| pool.constant(1.0))
    },
];

const fn jumping(
    name: &'static str,
    value: Value,
    result: ResultType,
    derivative: fn(&mut Pool, &[Expr], usize) -> Expr,
) -> Function {
    Function {
        result,
        event_generating: true,
        section: "MLS §3.7.2",
        ..real(name, value, derivative)
    }
}

/// Of x − q y between the jumps of q, which is `floor(x / y)` or `div(x, y)`.
fn remainder_derivative(pool: &mut Pool, quotient: &str, x: &[Expr], which: usize) -> Expr {
    if which == 0 {
        return pool.constant(1.0);
    }
    let quotient = if quotient == "div" {
        pool.function("div", &[x[0], x[1]])
    } else {
        let ratio = pool.div(x[0], x[1]);
        pool.function(quotient, &[ratio])
    };
    pool.neg(quotient)
}
