//! Relations and logic (MLS §3.5).

use super::unsuitable;
use crate::diag::Fault;
use crate::fault;
use crate::value::array::sizes;
use crate::value::errors::{SIZE_MISMATCH, TYPE_MISMATCH};
use crate::value::{ArrayValue, Elements, Value};
use std::cmp::Ordering;

/// `a < b`
pub fn less(left: &Value, right: &Value) -> Result<bool, Fault> {
    Ok(order("<", left, right)? == Some(Ordering::Less))
}

/// `a <= b`
pub(crate) fn less_equal(left: &Value, right: &Value) -> Result<bool, Fault> {
    Ok(order("<=", left, right)?.is_some_and(Ordering::is_le))
}

/// `a > b`
pub(crate) fn greater(left: &Value, right: &Value) -> Result<bool, Fault> {
    Ok(order(">", left, right)? == Some(Ordering::Greater))
}

/// `a >= b`
pub(crate) fn greater_equal(left: &Value, right: &Value) -> Result<bool, Fault> {
    Ok(order(">=", left, right)?.is_some_and(Ordering::is_ge))
}

/// `a == b`
pub fn equal(left: &Value, right: &Value) -> Result<bool, Fault> {
    Ok(order("==", left, right)? == Some(Ordering::Equal))
}

/// `a <> b`
pub(crate) fn not_equal(left: &Value, right: &Value) -> Result<bool, Fault> {
    Ok(order("<>", left, right)? != Some(Ordering::Equal))
}

/// How two scalars of simple types compare: numbers by value (an Integer and a Real exactly),
/// Strings by their characters' codes, `false` before `true`, literals of one enumeration in order
/// of declaration, with an Integer by their numbers. `None` if one is not a number (NaN).
pub fn order(symbol: &str, left: &Value, right: &Value) -> Result<Option<Ordering>, Fault> {
    match (left, right) {
        (Value::Real(a), Value::Real(b)) => Ok(a.partial_cmp(b)),
        (Value::Integer(a), Value::Integer(b)) => Ok(Some(a.cmp(b))),
        (Value::Integer(a), Value::Real(b)) => Ok(compare_mixed(*a, *b)),
        (Value::Real(a), Value::Integer(b)) => Ok(compare_mixed(*b, *a).map(Ordering::reverse)),
        (Value::String(a), Value::String(b)) => Ok(Some(a.cmp(b))),
        (Value::Boolean(a), Value::Boolean(b)) => Ok(Some(a.cmp(b))),
        // In the functions of loaded classes literals are ordinals.
        (Value::Enumeration(a), Value::Integer(b)) => Ok(Some(a.ordinal.cmp(b))),
        (Value::Integer(a), Value::Enumeration(b)) => Ok(Some(a.cmp(&b.ordinal))),
        (Value::Enumeration(a), Value::Enumeration(b)) if a.definition == b.definition => {
            Ok(Some(a.ordinal.cmp(&b.ordinal)))
        }
        (Value::Array(_), _) | (_, Value::Array(_)) => Err(unsuitable(symbol, left, right)
            .help("a relation needs scalar operands; compare the elements in a loop".to_owned())),
        _ => Err(unsuitable(symbol, left, right)),
    }
}

/// Compares without rounding the Integer: 2^53 + 1 is greater than 2^53 as a Real.
fn compare_mixed(integer: i64, real: f64) -> Option<Ordering> {
    let rounded = integer as f64;
    match rounded.partial_cmp(&real)? {
        Ordering::Equal if rounded.abs() < 9.2e18 => Some(integer.cmp(&(real as i64))),
        other => Some(other),
    }
}

/// `not a`, element by element for arrays.
pub fn not(value: &Value) -> Result<Value, Fault> {
    match value {
        Value::Boolean(value) => Ok(Value::Boolean(!value)),
        Value::Array(ArrayValue { dims, elements: Elements::Boolean(values), .. }) => {
            let elements = Elements::Boolean(values.iter().map(|value| !value).collect());
            Ok(Value::Array(ArrayValue::new(dims.clone(), elements)))
        }
        other => Err(fault!(TYPE_MISMATCH, "`not` is not defined for {}", other.type_name())),
    }
}

/// `a and b`, element by element for arrays of equal sizes.
pub fn and(left: &Value, right: &Value) -> Result<Value, Fault> {
    logical("and", left, right, |a, b| a && b)
}

/// `a or b`, element by element for arrays of equal sizes.
pub fn or(left: &Value, right: &Value) -> Result<Value, Fault> {
    logical("or", left, right, |a, b| a || b)
}

fn logical(
    symbol: &str,
    left: &Value,
    right: &Value,
    operation: impl Fn(bool, bool) -> bool,
) -> Result<Value, Fault> {
    match (left, right) {
        (Value::Boolean(a), Value::Boolean(b)) => Ok(Value::Boolean(operation(*a, *b))),
        (
            Value::Array(ArrayValue { dims, elements: Elements::Boolean(a), .. }),
            Value::Array(ArrayValue { dims: others, elements: Elements::Boolean(b), .. }),
        ) => {
            if dims != others {
                return Err(fault!(
                    SIZE_MISMATCH,
                    "`{symbol}` needs arrays of equal sizes, not {} and {}",
                    sizes(dims),
                    sizes(others)
                ));
            }
            let elements =
                Elements::Boolean(a.iter().zip(b).map(|(a, b)| operation(*a, *b)).collect());
            Ok(Value::Array(ArrayValue::new(dims.clone(), elements)))
        }
        _ => Err(unsuitable(symbol, left, right)),
    }
}
