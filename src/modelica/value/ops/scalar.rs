//! Operators of two numbers, and what does not fit in their type.

use crate::diag::Fault;
use crate::value::errors::{DIVISION_BY_ZERO, DOMAIN_ERROR, INTEGER_OVERFLOW, REAL_OVERFLOW};
use crate::{bail, elementary, fault};

pub(crate) fn real_add(a: f64, b: f64) -> Result<f64, Fault> {
    representable("+", a, b, a + b)
}

pub(crate) fn real_subtract(a: f64, b: f64) -> Result<f64, Fault> {
    representable("-", a, b, a - b)
}

pub(crate) fn real_multiply(a: f64, b: f64) -> Result<f64, Fault> {
    representable("*", a, b, a * b)
}

/// `a / b` of two Reals; a fault if `b` is zero or the quotient exceeds the largest Real.
pub(crate) fn real_divide(a: f64, b: f64) -> Result<f64, Fault> {
    if b == 0.0 {
        bail!(DIVISION_BY_ZERO, "division of {a:?} by zero");
    }
    representable("/", a, b, a / b)
}

/// The result of an operator, a fault if it is infinite and neither operand is.
fn representable(symbol: &str, a: f64, b: f64, result: f64) -> Result<f64, Fault> {
    if result.is_infinite() && a.is_finite() && b.is_finite() {
        bail!(REAL_OVERFLOW, "{a:?} {symbol} {b:?} exceeds the largest Real, 1.8e308");
    }
    Ok(result)
}

/// `a ^ b` of two Reals; a fault where that is not a real number.
pub(crate) fn real_power(a: f64, b: f64) -> Result<f64, Fault> {
    if a == 0.0 && b < 0.0 {
        bail!(DIVISION_BY_ZERO, "zero to the negative power {b:?}");
    }
    if a < 0.0 && b.is_finite() && b.fract() != 0.0 {
        bail!(DOMAIN_ERROR, "the negative number {a:?} to the power {b:?} is not real");
    }
    representable("^", a, b, elementary::powf(a, b))
}

pub(crate) fn overflow(symbol: &str, a: i64, b: i64) -> Fault {
    fault!(INTEGER_OVERFLOW, "{a} {symbol} {b} does not fit in an Integer";
        help: "write one operand as a Real, such as `{a}.0`")
}
