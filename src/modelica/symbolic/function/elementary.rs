//! Exponential, logarithms, square root, absolute value, sign.

use super::{Domain, Function, ResultType, UnitRule, Value, real, zero};

const POSITIVE: Option<Domain> =
    Some(Domain { contains: |x| x[0] > 0.0, words: "the argument must be positive" });

pub(super) const FUNCTIONS: &[Function] = &[
    Function {
        result: ResultType::AsArguments,
        unit: UnitRule::As(0),
        section: "MLS §3.7.1",
        is_kinked: true,
        ..real("abs", Value::Unary(f64::abs), |pool, x, _| pool.function("sign", &[x[0]]))
    },
    Function {
        result: ResultType::Integer,
        section: "MLS §3.7.1",
        is_kinked: true,
        ..real("sign", Value::Unary(sign), zero)
    },
    Function {
        domain: Some(Domain {
            contains: |x| x[0] >= 0.0,
            words: "the argument must not be negative",
        }),
        unit: UnitRule::Power(0.5),
        section: "MLS §3.7.1",
        ..real("sqrt", Value::Unary(f64::sqrt), |pool, x, _| {
            let half = pool.constant(0.5);
            let root = pool.function("sqrt", &[x[0]]);
            pool.div(half, root)
        })
    },
    Function {
        overflows: true,
        ..real("exp", Value::Unary(crate::elementary::exp), |pool, x, _| {
            pool.function("exp", &[x[0]])
        })
    },
    Function {
        aliases: &["ln"],
        domain: POSITIVE,
        ..real("log", Value::Unary(crate::elementary::ln), |pool, x, _| {
            let one = pool.constant(1.0);
            pool.div(one, x[0])
        })
    },
    Function {
        domain: POSITIVE,
        ..real("log10", Value::Unary(crate::elementary::log10), |pool, x, _| {
            let factor = pool.constant(std::f64::consts::LOG10_E);
            pool.div(factor, x[0])
        })
    },
];

/// 1, 0 or -1; `f64::signum` has no zero.
fn sign(x: f64) -> f64 {
    if x > 0.0 {
        1.0
    } else if x < 0.0 {
        -1.0
    } else {
        x
    }
}
