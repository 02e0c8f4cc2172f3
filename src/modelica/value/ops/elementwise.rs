//! Element-wise operators `.+ .- .* ./ .^` (MLS §10.6.2 ff.) and the machinery they share with
//! the others: an operation of two scalars applied to arrays of equal sizes, or to a scalar and an
//! array.

use super::scalar::{overflow, real_add, real_divide, real_multiply, real_power, real_subtract};
use super::unsuitable;
use crate::diag::Fault;
use crate::fault;
use crate::value::array::{has_room, sizes};
use crate::value::errors::SIZE_MISMATCH;
use crate::value::{ArrayValue, Elements, Value, check_length};
use std::cell::Cell;
use std::sync::Arc;

/// `a .+ b`; also joins Strings.
pub(crate) fn elementwise_add(left: &Value, right: &Value) -> Result<Value, Fault> {
    added(".+", left, right)
}

pub(crate) fn added(symbol: &str, left: &Value, right: &Value) -> Result<Value, Fault> {
    if left.is_text() && right.is_text() {
        return join(left, right);
    }
    numeric(symbol, left, right, real_add, |a, b| {
        a.checked_add(b).ok_or_else(|| overflow("+", a, b))
    })
}

/// `a .- b`
pub(crate) fn elementwise_subtract(left: &Value, right: &Value) -> Result<Value, Fault> {
    subtracted(".-", left, right)
}

pub(crate) fn subtracted(symbol: &str, left: &Value, right: &Value) -> Result<Value, Fault> {
    numeric(symbol, left, right, real_subtract, |a, b| {
        a.checked_sub(b).ok_or_else(|| overflow("-", a, b))
    })
}

/// `a .* b`
pub(crate) fn elementwise_multiply(left: &Value, right: &Value) -> Result<Value, Fault> {
    multiplied(".*", left, right)
}

pub(crate) fn multiplied(symbol: &str, left: &Value, right: &Value) -> Result<Value, Fault> {
    numeric(symbol, left, right, real_multiply, |a, b| {
        a.checked_mul(b).ok_or_else(|| overflow("*", a, b))
    })
}

/// `a ./ b`, always Real.
pub(crate) fn elementwise_divide(left: &Value, right: &Value) -> Result<Value, Fault> {
    divided("./", left, right)
}

pub(crate) fn divided(symbol: &str, left: &Value, right: &Value) -> Result<Value, Fault> {
    real(symbol, left, right, real_divide)
}

/// `a .^ b`, always Real.
pub(crate) fn elementwise_power(left: &Value, right: &Value) -> Result<Value, Fault> {
    real(".^", left, right, real_power)
}

/// Applies `on_reals`, or `on_integers` where both sides are Integer.
pub(crate) fn numeric(
    symbol: &str,
    left: &Value,
    right: &Value,
    on_reals: impl Fn(f64, f64) -> Result<f64, Fault>,
    on_integers: impl Fn(i64, i64) -> Result<i64, Fault>,
) -> Result<Value, Fault> {
    match (integers(left), integers(right)) {
        (Some(a), Some(b)) => {
            let (dims, values) = zip(symbol, left, right, a, b, on_integers)?;
            Ok(match dims {
                None => Value::Integer(values[0]),
                Some(dims) => Value::Array(ArrayValue::new(dims, Elements::Integer(values))),
            })
        }
        _ => real(symbol, left, right, on_reals),
    }
}

/// Applies `operation` to the operands as Reals.
fn real(
    symbol: &str,
    left: &Value,
    right: &Value,
    operation: impl Fn(f64, f64) -> Result<f64, Fault>,
) -> Result<Value, Fault> {
    let (Some(a), Some(b)) = (left.as_reals(), right.as_reals()) else {
        return Err(unsuitable(symbol, left, right));
    };
    let (dims, values) = zip(symbol, left, right, &a, &b, operation)?;
    Ok(match dims {
        None => Value::Real(values[0]),
        Some(dims) => Value::Array(ArrayValue::new(dims, Elements::Real(values))),
    })
}

fn join(left: &Value, right: &Value) -> Result<Value, Fault> {
    let (a, b) = (strings(left), strings(right));
    let all = Cell::new(0usize);
    let concatenated = |a: Arc<str>, b: Arc<str>| -> Result<Arc<str>, Fault> {
        all.set(all.get().saturating_add(a.len()).saturating_add(b.len()));
        check_length(all.get())?;
        Ok([&*a, &*b].concat().into())
    };
    let (dims, mut values) = zip("+", left, right, &a, &b, concatenated)?;
    Ok(match dims {
        None => Value::String(values.remove(0)),
        Some(dims) => Value::Array(ArrayValue::new(dims, Elements::String(values))),
    })
}

/// The Integers of a scalar or array.
fn integers(value: &Value) -> Option<&[i64]> {
    match value {
        Value::Integer(value) => Some(std::slice::from_ref(value)),
        Value::Array(ArrayValue { elements: Elements::Integer(values), .. }) => Some(values),
        _ => None,
    }
}

fn strings(value: &Value) -> Vec<Arc<str>> {
    match value {
        Value::String(text) => vec![text.clone()],
        Value::Array(ArrayValue { elements: Elements::String(strings), .. }) => strings.clone(),
        _ => Vec::new(),
    }
}

/// The sizes of an elementwise result, `None` for a scalar, and its elements.
type Zipped<R> = (Option<Vec<usize>>, Vec<R>);

fn zip<T: Clone, R>(
    symbol: &str,
    left: &Value,
    right: &Value,
    a: &[T],
    b: &[T],
    operation: impl Fn(T, T) -> Result<R, Fault>,
) -> Result<Zipped<R>, Fault> {
    let apply = |(x, y): (&T, &T)| operation(x.clone(), y.clone());
    match (left, right) {
        (Value::Array(left), Value::Array(right)) => {
            same_sizes(symbol, left, right)?;
            has_room(a.len(), &left.dims)?;
            let values = a.iter().zip(b).map(apply).collect::<Result<_, _>>()?;
            Ok((Some(left.dims.clone()), values))
        }
        (Value::Array(array), _) => {
            has_room(a.len(), &array.dims)?;
            let values = a.iter().map(|x| apply((x, &b[0]))).collect::<Result<_, _>>()?;
            Ok((Some(array.dims.clone()), values))
        }
        (_, Value::Array(array)) => {
            has_room(b.len(), &array.dims)?;
            let values = b.iter().map(|y| apply((&a[0], y))).collect::<Result<_, _>>()?;
            Ok((Some(array.dims.clone()), values))
        }
        _ => Ok((None, vec![apply((&a[0], &b[0]))?])),
    }
}

fn same_sizes(symbol: &str, left: &ArrayValue, right: &ArrayValue) -> Result<(), Fault> {
    if left.dims == right.dims {
        return Ok(());
    }
    Err(fault!(
        SIZE_MISMATCH,
        "`{symbol}` needs arrays of equal sizes, not {} and {}",
        sizes(&left.dims),
        sizes(&right.dims)
    ))
}
