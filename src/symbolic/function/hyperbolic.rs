//! Hyperbolic functions.

use super::{Function, Value, real};

pub(super) const FUNCTIONS: &[Function] = &[
    real("sinh", Value::Unary(f64::sinh), |pool, x, _| pool.function("cosh", &[x[0]])),
    real("cosh", Value::Unary(f64::cosh), |pool, x, _| pool.function("sinh", &[x[0]])),
    real("tanh", Value::Unary(f64::tanh), |pool, x, _| {
        let (one, two) = (pool.constant(1.0), pool.constant(2.0));
        let tanh = pool.function("tanh", &[x[0]]);
        let square = pool.pow(tanh, two);
        pool.sub(one, square)
    }),
];
