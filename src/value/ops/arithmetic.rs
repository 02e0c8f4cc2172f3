//! `+ - * / ^` (MLS §10.6).

use super::elementwise::{added, divided, multiplied, subtracted};
use super::matrix;
use super::unsuitable;
use crate::diag::Fault;
use crate::elementary;
use crate::value::errors::{
    DIVISION_BY_ZERO, DOMAIN_ERROR, INTEGER_OVERFLOW, REAL_OVERFLOW, TYPE_MISMATCH,
};
use crate::value::{ArrayValue, Elements, Value};
use crate::{bail, fault};

/// `a + b` (MLS §10.6.2): numbers, arrays of equal sizes, Strings.
pub fn add(left: &Value, right: &Value) -> Result<Value, Fault> {
    match (left, right) {
        (Value::Real(a), Value::Real(b)) => real_add(*a, *b).map(Value::Real),
        (Value::Integer(a), Value::Integer(b)) => {
            a.checked_add(*b).map(Value::Integer).ok_or_else(|| overflow("+", *a, *b))
        }
        _ => match scalars(left, right) {
            Some((a, b)) => real_add(a, b).map(Value::Real),
            None => {
                same_rank("+", left, right)?;
                added("+", left, right)
            }
        },
    }
}

/// `a - b` (MLS §10.6.2)
pub fn subtract(left: &Value, right: &Value) -> Result<Value, Fault> {
    match (left, right) {
        (Value::Real(a), Value::Real(b)) => real_subtract(*a, *b).map(Value::Real),
        (Value::Integer(a), Value::Integer(b)) => {
            a.checked_sub(*b).map(Value::Integer).ok_or_else(|| overflow("-", *a, *b))
        }
        _ => match scalars(left, right) {
            Some((a, b)) => real_subtract(a, b).map(Value::Real),
            None => {
                same_rank("-", left, right)?;
                subtracted("-", left, right)
            }
        },
    }
}

/// `a * b` (MLS §10.6.4, §10.6.5): products of scalars, of a scalar and an array, scalar and matrix
/// products of vectors and matrices.
pub fn multiply(left: &Value, right: &Value) -> Result<Value, Fault> {
    match (left, right) {
        (Value::Real(a), Value::Real(b)) => real_multiply(*a, *b).map(Value::Real),
        (Value::Integer(a), Value::Integer(b)) => {
            a.checked_mul(*b).map(Value::Integer).ok_or_else(|| overflow("*", *a, *b))
        }
        (Value::Array(a), Value::Array(b)) => matrix::product(a, b),
        _ => match scalars(left, right) {
            Some((a, b)) => real_multiply(a, b).map(Value::Real),
            None => multiplied("*", left, right),
        },
    }
}

/// `a / b` (MLS §10.6.6): a number or an array by a number; always Real.
pub fn divide(left: &Value, right: &Value) -> Result<Value, Fault> {
    match (left, right) {
        (Value::Real(a), Value::Real(b)) => real_divide(*a, *b).map(Value::Real),
        (_, Value::Array(_)) => {
            Err(unsuitable("/", left, right).help("use `./` to divide by each element".to_owned()))
        }
        _ => match scalars(left, right) {
            Some((a, b)) => real_divide(a, b).map(Value::Real),
            None => divided("/", left, right),
        },
    }
}

/// `a ^ b` (MLS §10.6.8): a number to a number, always Real; a square matrix to an Integer that is
/// not negative.
pub fn power(left: &Value, right: &Value) -> Result<Value, Fault> {
    match (left, right) {
        (Value::Array(base), Value::Integer(exponent)) => matrix::power(base, *exponent),
        (Value::Array(_), _) | (_, Value::Array(_)) => Err(unsuitable("^", left, right)
            .help("use `.^` to raise each element to a power".to_owned())),
        _ => match scalars(left, right) {
            Some((base, exponent)) => real_power(base, exponent).map(Value::Real),
            None => Err(unsuitable("^", left, right)),
        },
    }
}

/// `-a` (MLS §10.6.1)
pub fn negate(value: &Value) -> Result<Value, Fault> {
    let negated = |value: i64| value.checked_neg().ok_or_else(|| overflow("-", 0, value));
    match value {
        Value::Real(value) => Ok(Value::Real(-value)),
        Value::Integer(value) => negated(*value).map(Value::Integer),
        Value::Array(ArrayValue { dims, elements }) => {
            let elements = match elements {
                Elements::Real(values) => Elements::Real(values.iter().map(|v| -v).collect()),
                Elements::Integer(values) => {
                    Elements::Integer(values.iter().map(|v| negated(*v)).collect::<Result<_, _>>()?)
                }
                _ => return Err(not_a_number("-", value)),
            };
            Ok(Value::Array(ArrayValue { dims: dims.clone(), elements }))
        }
        _ => Err(not_a_number("-", value)),
    }
}

/// `+a` (MLS §10.6.1)
pub fn plus(value: Value) -> Result<Value, Fault> {
    if value.is_numeric() { Ok(value) } else { Err(not_a_number("+", &value)) }
}

pub(super) fn real_add(a: f64, b: f64) -> Result<f64, Fault> {
    representable("+", a, b, a + b)
}

pub(super) fn real_subtract(a: f64, b: f64) -> Result<f64, Fault> {
    representable("-", a, b, a - b)
}

pub(super) fn real_multiply(a: f64, b: f64) -> Result<f64, Fault> {
    representable("*", a, b, a * b)
}

/// `a / b` of two Reals; a fault if `b` is zero or the quotient exceeds the largest Real.
pub fn real_divide(a: f64, b: f64) -> Result<f64, Fault> {
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
pub fn real_power(a: f64, b: f64) -> Result<f64, Fault> {
    if a == 0.0 && b < 0.0 {
        bail!(DIVISION_BY_ZERO, "zero to the negative power {b:?}");
    }
    if a < 0.0 && b.is_finite() && b.fract() != 0.0 {
        bail!(DOMAIN_ERROR, "the negative number {a:?} to the power {b:?} is not real");
    }
    representable("^", a, b, elementary::powf(a, b))
}

fn scalars(left: &Value, right: &Value) -> Option<(f64, f64)> {
    Some((left.as_real()?, right.as_real()?))
}

pub(super) fn overflow(symbol: &str, a: i64, b: i64) -> Fault {
    fault!(INTEGER_OVERFLOW, "{a} {symbol} {b} does not fit in an Integer";
        help: "write one operand as a Real, such as `{a}.0`")
}

fn same_rank(symbol: &str, left: &Value, right: &Value) -> Result<(), Fault> {
    if matches!(left, Value::Array(_)) == matches!(right, Value::Array(_)) {
        return Ok(());
    }
    Err(unsuitable(symbol, left, right)
        .help(format!("use `.{symbol}` to combine a scalar with each element of an array")))
}

fn not_a_number(symbol: &str, value: &Value) -> Fault {
    fault!(TYPE_MISMATCH, "`{symbol}` is not defined for {}", value.type_name())
}
