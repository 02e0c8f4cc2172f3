//! Numbers of compiled functions as values of the interpreter, and back.

use crate::eval::ValueType;
use crate::value::{ArrayValue, Elements, EnumerationValue, Value};

/// Integers beyond are not exact as numbers.
const MAX_INTEGER: u64 = 1 << 53;

/// The number that a scalar is.
fn number(value: &Value) -> Option<f64> {
    match value {
        Value::Real(value) => Some(*value),
        Value::Integer(value) => Some(*value as f64),
        Value::Boolean(value) => Some(f64::from(u8::from(*value))),
        Value::Enumeration(value) => Some(value.ordinal as f64),
        _ => None,
    }
}

/// Appends the numbers of a scalar or of an array; `None` if it has none, or Integers that are not
/// exact as such.
pub(super) fn append_numbers(value: &Value, numbers: &mut Vec<f64>) -> Option<()> {
    let is_exact = |value: &i64| value.unsigned_abs() <= MAX_INTEGER;
    match value {
        Value::Array(array) => match &array.elements {
            Elements::Real(values) => numbers.extend(values),
            Elements::Integer(values) if values.iter().all(is_exact) => {
                numbers.extend(values.iter().map(|value| *value as f64));
            }
            Elements::Boolean(values) => {
                numbers.extend(values.iter().map(|value| f64::from(u8::from(*value))));
            }
            Elements::Enumeration(values) => {
                numbers.extend(values.iter().map(|value| value.ordinal as f64));
            }
            Elements::Integer(_) | Elements::String(_) | Elements::Record(_) => return None,
        },
        Value::Integer(value) if !is_exact(value) => return None,
        scalar => numbers.push(number(scalar)?),
    }
    Some(())
}

/// A scalar, where there are no sizes, or an array of a type; `None` if that is not of numbers.
pub(super) fn value_of(numbers: &[f64], dims: &[usize], expected: &ValueType) -> Option<Value> {
    let elements = match expected {
        ValueType::Real => Elements::Real(numbers.to_vec()),
        ValueType::Integer => Elements::Integer(numbers.iter().map(|x| *x as i64).collect()),
        ValueType::Boolean => Elements::Boolean(numbers.iter().map(|x| *x != 0.0).collect()),
        ValueType::Enumeration(definition) => {
            let literal =
                |x: &f64| EnumerationValue { definition: definition.clone(), ordinal: *x as i64 };
            Elements::Enumeration(numbers.iter().map(literal).collect())
        }
        _ => return None,
    };
    match dims.is_empty() {
        true => (elements.len() == 1).then(|| elements.get(0)),
        false => Some(Value::Array(ArrayValue::new(dims.to_vec(), elements))),
    }
}
