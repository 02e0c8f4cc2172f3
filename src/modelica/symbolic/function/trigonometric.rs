//! Trigonometric functions and their inverses; angles in radians.

use super::{Domain, Function, Value, real};
use crate::symbolic::node::Expr;
use crate::symbolic::pool::Pool;

const UNIT_INTERVAL: Option<Domain> = Some(Domain {
    contains: |x| x[0].abs() <= 1.0,
    words: "the argument must lie between -1 and 1",
});

pub(super) const FUNCTIONS: &[Function] = &[
    real("sin", Value::Unary(crate::elementary::sin), |pool, x, _| pool.function("cos", &[x[0]])),
    real("cos", Value::Unary(crate::elementary::cos), |pool, x, _| {
        let sine = pool.function("sin", &[x[0]]);
        pool.neg(sine)
    }),
    real("tan", Value::Unary(crate::elementary::tan), |pool, x, _| {
        let (one, two) = (pool.constant(1.0), pool.constant(2.0));
        let tangent = pool.function("tan", &[x[0]]);
        let square = pool.pow(tangent, two);
        pool.add(one, square)
    }),
    Function {
        domain: UNIT_INTERVAL,
        ..real("asin", Value::Unary(crate::elementary::asin), |pool, x, _| {
            let one = pool.constant(1.0);
            let root = root_of_one_minus_square(pool, x[0]);
            pool.div(one, root)
        })
    },
    Function {
        domain: UNIT_INTERVAL,
        ..real("acos", Value::Unary(crate::elementary::acos), |pool, x, _| {
            let minus_one = pool.constant(-1.0);
            let root = root_of_one_minus_square(pool, x[0]);
            pool.div(minus_one, root)
        })
    },
    real("atan", Value::Unary(crate::elementary::atan), |pool, x, _| {
        let (one, two) = (pool.constant(1.0), pool.constant(2.0));
        let square = pool.pow(x[0], two);
        let divisor = pool.add(one, square);
        pool.div(one, divisor)
    }),
    Function {
        domain: Some(Domain {
            contains: |x| x[0] != 0.0 || x[1] != 0.0,
            words: "the arguments must not both be zero",
        }),
        ..real("atan2", Value::Binary(crate::elementary::atan2), |pool, x, which| {
            let two = pool.constant(2.0);
            let (a, b) = (pool.pow(x[0], two), pool.pow(x[1], two));
            let divisor = pool.add(a, b);
            let partial = pool.div(x[1 - which], divisor);
            if which == 0 { partial } else { pool.neg(partial) }
        })
    },
];

/// √(1 − x²) as √((1 − x)(1 + x)), which keeps its digits near ±1.
fn root_of_one_minus_square(pool: &mut Pool, x: Expr) -> Expr {
    let one = pool.constant(1.0);
    let (minus, plus) = (pool.sub(one, x), pool.add(one, x));
    let product = pool.mul(minus, plus);
    pool.function("sqrt", &[product])
}
