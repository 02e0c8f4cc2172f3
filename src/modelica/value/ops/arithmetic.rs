//! `+ - * / ^` (MLS §10.6).

use super::elementwise::{added, divided, multiplied, subtracted};
use super::scalar::{overflow, real_add, real_divide, real_multiply, real_power, real_subtract};
use super::{matrix, unsuitable};
use crate::diag::Fault;
use crate::fault;
use crate::value::errors::TYPE_MISMATCH;
use crate::value::{ArrayValue, Elements, Value};

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
pub(crate) fn negate(value: &Value) -> Result<Value, Fault> {
    let negated = |value: i64| value.checked_neg().ok_or_else(|| overflow("-", 0, value));
    match value {
        Value::Real(value) => Ok(Value::Real(-value)),
        Value::Integer(value) => negated(*value).map(Value::Integer),
        Value::Array(ArrayValue { dims, elements, .. }) => {
            let elements = match elements {
                Elements::Real(values) => Elements::Real(values.iter().map(|v| -v).collect()),
                Elements::Integer(values) => {
                    Elements::Integer(values.iter().map(|v| negated(*v)).collect::<Result<_, _>>()?)
                }
                _ => return Err(not_a_number("-", value)),
            };
            Ok(Value::Array(ArrayValue::new(dims.clone(), elements)))
        }
        _ => Err(not_a_number("-", value)),
    }
}

/// `+a` (MLS §10.6.1)
pub fn plus(value: Value) -> Result<Value, Fault> {
    if value.is_numeric() { Ok(value) } else { Err(not_a_number("+", &value)) }
}

fn scalars(left: &Value, right: &Value) -> Option<(f64, f64)> {
    Some((left.as_real()?, right.as_real()?))
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
