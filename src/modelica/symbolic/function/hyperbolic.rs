//! Hyperbolic functions.

use super::{Function, Value, real};

pub(super) const FUNCTIONS: &[Function] = &[
    Function {
        overflows: true,
        ..real("sinh", Value::Unary(crate::elementary::sinh), |pool, x, _| {
            pool.function("cosh", &[x[0]])
        })
    },
    Function {
        overflows: true,
        ..real("cosh", Value::Unary(crate::elementary::cosh), |pool, x, _| {
            pool.function("sinh", &[x[0]])
        })
    },
    real("tanh", Value::Unary(crate::elementary::tanh), |pool, x, _| {
        let (one, two) = (pool.constant(1.0), pool.constant(2.0));
        let tanh = pool.function("tanh", &[x[0]]);
        let square = pool.pow(tanh, two);
        pool.sub(one, square)
    }),
];
