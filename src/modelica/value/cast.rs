//! Between values and Rust's types: an Integer becomes a Real where one is expected, and nothing
//! else changes its type by itself.

use super::errors::TYPE_MISMATCH;
use super::{ArrayValue, Elements, RecordValue, Value};
use crate::bail;
use crate::diag::Fault;
use crate::name::Name;
use std::borrow::Cow;
use std::sync::Arc;

/// What a value can be turned into.
pub trait FromValue: Sized {
    /// Converts the value to this type; a fault that says what was expected otherwise.
    fn from_value(value: Value) -> Result<Self, Fault>;
}

/// A matrix of Reals, row by row.
#[derive(Debug, Clone, PartialEq)]
pub struct RealMatrix {
    /// Number of rows.
    pub rows: usize,
    /// Number of columns.
    pub columns: usize,
    /// `rows * columns` elements, row by row.
    pub elements: Vec<f64>,
}

impl RealMatrix {
    /// The elements of row `row`, counted from 0.
    pub fn row(&self, row: usize) -> &[f64] {
        &self.elements[row * self.columns..(row + 1) * self.columns]
    }
}

impl Value {
    /// Number of dimensions; 0 for a scalar.
    pub fn rank(&self) -> usize {
        match self {
            Value::Array(array) => array.rank(),
            _ => 0,
        }
    }

    /// Sizes of the dimensions; empty for a scalar.
    pub fn dims(&self) -> &[usize] {
        match self {
            Value::Array(array) => &array.dims,
            _ => &[],
        }
    }

    /// The number, if it is a scalar number.
    pub fn as_real(&self) -> Option<f64> {
        match self {
            Value::Real(value) => Some(*value),
            Value::Integer(value) => Some(*value as f64),
            _ => None,
        }
    }

    /// The numbers of a scalar or an array of numbers, row-major.
    pub fn as_reals(&self) -> Option<Cow<'_, [f64]>> {
        match self {
            Value::Real(value) => Some(Cow::Borrowed(std::slice::from_ref(value))),
            Value::Integer(value) => Some(Cow::Owned(vec![*value as f64])),
            Value::Array(array) => array.elements.as_reals(),
            _ => None,
        }
    }

    /// Whether it is a number or an array of numbers.
    pub(crate) fn is_numeric(&self) -> bool {
        match self {
            Value::Real(_) | Value::Integer(_) => true,
            Value::Array(array) => {
                matches!(array.elements, Elements::Real(_) | Elements::Integer(_))
            }
            _ => false,
        }
    }

    /// Whether it is a String or an array of Strings.
    pub fn is_text(&self) -> bool {
        match self {
            Value::String(_) => true,
            Value::Array(array) => matches!(array.elements, Elements::String(_)),
            _ => false,
        }
    }

    /// The numbers of a vector `[n]`, a row `[1, n]` or a column `[n, 1]`: the GAPILib functions
    /// take either form. A single number counts as a vector of one.
    pub fn as_vector(&self) -> Result<Vec<f64>, Fault> {
        let is_vector = match self.dims() {
            [] | [_] => true,
            [rows, columns] => *rows == 1 || *columns == 1,
            _ => false,
        };
        match self.as_reals() {
            Some(values) if is_vector => Ok(values.into_owned()),
            _ => bail!(TYPE_MISMATCH, "expected a vector of Reals, got {}", self.type_name()),
        }
    }

    /// The same value with its Integers as Reals.
    pub(crate) fn promoted(self) -> Value {
        match self {
            Value::Integer(value) => Value::Real(value as f64),
            Value::Array(ArrayValue { dims, elements, marks }) => {
                Value::Array(ArrayValue { dims, elements: elements.promoted(), marks })
            }
            other => other,
        }
    }
}

impl Elements {
    /// The numbers, if they are numbers.
    pub fn as_reals(&self) -> Option<Cow<'_, [f64]>> {
        match self {
            Elements::Real(values) => Some(Cow::Borrowed(values)),
            Elements::Integer(values) => {
                Some(Cow::Owned(values.iter().map(|value| *value as f64).collect()))
            }
            _ => None,
        }
    }
}

/// `new` as a replacement of `old`: an Integer becomes Real where `old` is Real, and the literal of
/// that number where `old` is of an enumeration; a different type or different sizes are a fault.
pub(crate) fn like(old: &Value, new: Value) -> Result<Value, Fault> {
    let converted = match (old, &new) {
        (Value::Real(_), Value::Integer(_)) => new.promoted(),
        (Value::Enumeration(old), Value::Integer(ordinal)) => match old.of_number(*ordinal) {
            Some(literal) => Value::Enumeration(literal),
            None => new,
        },
        (Value::Array(before), Value::Array(array))
            if matches!(before.elements, Elements::Real(_))
                && matches!(array.elements, Elements::Integer(_)) =>
        {
            new.promoted()
        }
        _ => new,
    };
    let same_type = match (old, &converted) {
        (Value::Array(a), Value::Array(b)) => {
            a.elements.is_empty()
                || b.elements.is_empty()
                || a.elements.type_name() == b.elements.type_name()
        }
        (a, b) => a.type_name() == b.type_name(),
    };
    if !same_type {
        bail!(
            TYPE_MISMATCH,
            "cannot assign a value of type {} to one of type {}",
            converted.type_name(),
            old.type_name()
        );
    }
    if old.dims() != converted.dims() && !old.dims().contains(&0) {
        bail!(
            super::errors::SIZE_MISMATCH,
            "cannot assign an array with the sizes {} to one with the sizes {}",
            super::array::sizes(converted.dims()),
            super::array::sizes(old.dims())
        );
    }
    Ok(converted)
}

fn mismatch(expected: &str, got: &Value) -> Fault {
    Fault::new(TYPE_MISMATCH, format!("expected {expected}, got {}", got.type_name()))
}

impl FromValue for Value {
    fn from_value(value: Value) -> Result<Value, Fault> {
        Ok(value)
    }
}

impl FromValue for f64 {
    fn from_value(value: Value) -> Result<f64, Fault> {
        value.as_real().ok_or_else(|| mismatch("a Real", &value))
    }
}

impl FromValue for i64 {
    fn from_value(value: Value) -> Result<i64, Fault> {
        match value {
            Value::Integer(value) => Ok(value),
            Value::Real(value) => bail!(TYPE_MISMATCH, "expected an Integer, got the Real {value}";
                help: "`/` gives Reals also for Integers: use `div(a, b)` for the Integer quotient, or \
                       `integer(x)` for the largest Integer not above `x`"),
            other => Err(mismatch("an Integer", &other)),
        }
    }
}

impl FromValue for usize {
    fn from_value(value: Value) -> Result<usize, Fault> {
        match &value {
            Value::Integer(count) => usize::try_from(*count).map_err(|_| {
                let message = format!("expected a nonnegative Integer, got {count}");
                Fault::new(super::errors::DOMAIN_ERROR, message)
            }),
            other => Err(mismatch("an Integer", other)),
        }
    }
}

impl FromValue for bool {
    fn from_value(value: Value) -> Result<bool, Fault> {
        match value {
            Value::Boolean(value) => Ok(value),
            other => Err(mismatch("a Boolean", &other)),
        }
    }
}

impl FromValue for Arc<str> {
    fn from_value(value: Value) -> Result<Arc<str>, Fault> {
        match value {
            Value::String(text) | Value::VariableName(text) => Ok(text),
            other => Err(mismatch("a String", &other)),
        }
    }
}

impl FromValue for String {
    fn from_value(value: Value) -> Result<String, Fault> {
        Arc::<str>::from_value(value).map(|text| text.to_string())
    }
}

impl FromValue for Name {
    fn from_value(value: Value) -> Result<Name, Fault> {
        match value {
            Value::TypeName(name) => Ok(name),
            other => Err(mismatch("the name of a class", &other)),
        }
    }
}

impl FromValue for RecordValue {
    fn from_value(value: Value) -> Result<RecordValue, Fault> {
        match value {
            Value::Record(record) => Ok(record),
            other => Err(mismatch("a record", &other)),
        }
    }
}

impl FromValue for Vec<f64> {
    fn from_value(value: Value) -> Result<Vec<f64>, Fault> {
        value.as_vector()
    }
}

impl FromValue for Vec<i64> {
    fn from_value(value: Value) -> Result<Vec<i64>, Fault> {
        match value {
            Value::Array(ArrayValue { dims, elements: Elements::Integer(values), .. })
                if dims.len() == 1 =>
            {
                Ok(values)
            }
            other if is_empty_vector(&other) => Ok(Vec::new()),
            other => Err(mismatch("a vector of Integers", &other)),
        }
    }
}

impl FromValue for Vec<bool> {
    fn from_value(value: Value) -> Result<Vec<bool>, Fault> {
        match value {
            Value::Array(ArrayValue { dims, elements: Elements::Boolean(values), .. })
                if dims.len() == 1 =>
            {
                Ok(values)
            }
            other if is_empty_vector(&other) => Ok(Vec::new()),
            other => Err(mismatch("a vector of Booleans", &other)),
        }
    }
}

impl FromValue for Vec<Arc<str>> {
    fn from_value(value: Value) -> Result<Vec<Arc<str>>, Fault> {
        match value {
            Value::Array(ArrayValue { dims, elements: Elements::String(values), .. })
                if dims.len() == 1 =>
            {
                Ok(values)
            }
            other if is_empty_vector(&other) => Ok(Vec::new()),
            other => Err(mismatch("a vector of Strings", &other)),
        }
    }
}

impl FromValue for Vec<String> {
    fn from_value(value: Value) -> Result<Vec<String>, Fault> {
        let strings = Vec::<Arc<str>>::from_value(value)?;
        Ok(strings.iter().map(|text| text.to_string()).collect())
    }
}

impl FromValue for RealMatrix {
    fn from_value(value: Value) -> Result<RealMatrix, Fault> {
        match (value.dims(), value.as_reals()) {
            ([rows, columns], Some(elements)) => {
                Ok(RealMatrix { rows: *rows, columns: *columns, elements: elements.into_owned() })
            }
            _ => Err(mismatch("a matrix of Reals", &value)),
        }
    }
}

/// `{}` has no element that could tell its type.
fn is_empty_vector(value: &Value) -> bool {
    value.dims() == [0]
}

impl From<f64> for Value {
    fn from(value: f64) -> Value {
        Value::Real(value)
    }
}

impl From<i64> for Value {
    fn from(value: i64) -> Value {
        Value::Integer(value)
    }
}

impl From<bool> for Value {
    fn from(value: bool) -> Value {
        Value::Boolean(value)
    }
}

impl From<&str> for Value {
    fn from(text: &str) -> Value {
        Value::string(text)
    }
}

impl From<String> for Value {
    fn from(text: String) -> Value {
        Value::string(text)
    }
}

impl From<Arc<str>> for Value {
    fn from(text: Arc<str>) -> Value {
        Value::String(text)
    }
}

impl From<Vec<f64>> for Value {
    fn from(values: Vec<f64>) -> Value {
        Value::reals(values)
    }
}

impl From<Vec<i64>> for Value {
    fn from(values: Vec<i64>) -> Value {
        Value::Array(ArrayValue::vector(Elements::Integer(values)))
    }
}

impl From<Vec<bool>> for Value {
    fn from(values: Vec<bool>) -> Value {
        Value::Array(ArrayValue::vector(Elements::Boolean(values)))
    }
}

impl From<Vec<Arc<str>>> for Value {
    fn from(values: Vec<Arc<str>>) -> Value {
        Value::Array(ArrayValue::vector(Elements::String(values)))
    }
}

impl From<Vec<String>> for Value {
    fn from(values: Vec<String>) -> Value {
        values.into_iter().map(Arc::from).collect::<Vec<Arc<str>>>().into()
    }
}

impl From<RealMatrix> for Value {
    fn from(matrix: RealMatrix) -> Value {
        Value::Array(ArrayValue::matrix(matrix.rows, matrix.columns, matrix.elements))
    }
}

impl From<RecordValue> for Value {
    fn from(record: RecordValue) -> Value {
        Value::Record(record)
    }
}
