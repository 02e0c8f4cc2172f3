//! Arrays (MLS ch. 10): row-major, of one element type, stored unboxed.

use super::errors::{ARRAY_TOO_LARGE, STRING_TOO_LONG, TYPE_MISMATCH};
use super::{EnumerationValue, Marks, RecordValue, Value};
use crate::budget::has_memory;
use crate::diag::Fault;
use crate::{bail, fault};
use std::sync::Arc;

/// The most elements that an array may have.
pub const MAX_ELEMENTS: usize = 1 << 24;

/// An array of rank one or more.
#[derive(Debug, Clone, PartialEq)]
pub struct ArrayValue {
    /// Sizes of the dimensions; at least one. Their product is the number of elements.
    pub dims: Vec<usize>,
    /// The elements, last dimension fastest.
    pub elements: Elements,
    /// What a host knows its rows by.
    pub marks: Marks,
}

/// The elements of an array, all of one type.
#[derive(Debug, Clone, PartialEq)]
pub enum Elements {
    /// `Real`
    Real(Vec<f64>),
    /// `Integer`
    Integer(Vec<i64>),
    /// `Boolean`
    Boolean(Vec<bool>),
    /// `String`
    String(Vec<Arc<str>>),
    /// An enumeration
    Enumeration(Vec<EnumerationValue>),
    /// A record
    Record(Vec<RecordValue>),
}

/// Runs the same expression for whichever vector of elements there is.
macro_rules! for_elements {
    ($elements:expr, $values:ident => $body:expr) => {
        match $elements {
            Elements::Real($values) => $body,
            Elements::Integer($values) => $body,
            Elements::Boolean($values) => $body,
            Elements::String($values) => $body,
            Elements::Enumeration($values) => $body,
            Elements::Record($values) => $body,
        }
    };
}

/// Makes elements of the same variant from whichever vector of elements there is.
macro_rules! map_elements {
    ($elements:expr, $values:ident => $body:expr) => {
        match $elements {
            Elements::Real($values) => Elements::Real($body),
            Elements::Integer($values) => Elements::Integer($body),
            Elements::Boolean($values) => Elements::Boolean($body),
            Elements::String($values) => Elements::String($body),
            Elements::Enumeration($values) => Elements::Enumeration($body),
            Elements::Record($values) => Elements::Record($body),
        }
    };
}

impl ArrayValue {
    /// An array of these sizes, whose product is the number of elements.
    pub fn new(dims: Vec<usize>, elements: Elements) -> ArrayValue {
        ArrayValue { dims, elements, marks: Marks::default() }
    }

    /// Number of rows, which are vectors along the last dimension, and their size.
    pub(super) fn rows(&self) -> (usize, usize) {
        let size = self.dims.last().copied().unwrap_or(1);
        (self.elements.len() / size.max(1), size)
    }

    /// A single element is no longer what it was.
    pub(crate) fn unmark(&mut self, offset: usize) {
        self.marks.assign(self.rows(), &[offset], &Marks::default());
    }

    /// A vector.
    pub fn vector(elements: Elements) -> ArrayValue {
        ArrayValue::new(vec![elements.len()], elements)
    }

    /// A matrix of Reals; `elements` row by row.
    pub fn matrix(rows: usize, columns: usize, elements: Vec<f64>) -> ArrayValue {
        debug_assert_eq!(rows * columns, elements.len());
        ArrayValue::new(vec![rows, columns], Elements::Real(elements))
    }

    /// An array of these sizes with the same value everywhere (MLS §10.3.3 `fill`). `value` is
    /// a scalar or a record.
    pub fn filled(dims: Vec<usize>, value: &Value) -> Result<ArrayValue, Fault> {
        let count = element_count(&dims)?;
        Ok(ArrayValue::new(dims, Elements::repeated(value, count)?))
    }

    /// Number of dimensions, at least one.
    pub fn rank(&self) -> usize {
        self.dims.len()
    }

    /// `Real[2, 3]`
    pub fn type_name(&self) -> String {
        format!("{}{}", self.elements.type_name(), sizes(&self.dims))
    }
}

fn picked<T: Clone>(values: &[T], offsets: impl Iterator<Item = usize>) -> Vec<T> {
    offsets.map(|offset| values[offset].clone()).collect()
}

/// `[2, 3]`: sizes as messages show them.
pub fn sizes(dims: &[usize]) -> String {
    let sizes: Vec<String> = dims.iter().map(usize::to_string).collect();
    format!("[{}]", sizes.join(", "))
}

/// The most bytes that a string may have.
pub(crate) const MAX_BYTES: usize = 1 << 28;

/// A fault if a string of so many bytes is longer than 2^28 bytes, which no string of a script or model may be.
pub fn check_length(bytes: usize) -> Result<(), Fault> {
    match bytes {
        // It is put together, and then copied to where it is shared; allocators round up.
        0..=MAX_BYTES if is_available(2 * bytes + bytes / 2) => Ok(()),
        0..=MAX_BYTES => bail!(STRING_TOO_LONG, "there is no memory for a string of {bytes} bytes"),
        _ => {
            bail!(STRING_TOO_LONG, "a string of {bytes} bytes is too long; {MAX_BYTES} is the most")
        }
    }
}

/// Sizes in bytes from which on the system is asked for the memory before it is used: what is smaller
/// is not what exhausts it.
const LARGE: usize = 1 << 20;

/// Whether the system has so many bytes. It is asked right before they are taken, so that an array
/// or a string that a script asks for ends with an error and not the process.
fn is_available(bytes: usize) -> bool {
    bytes < LARGE || has_memory(bytes)
}

/// A fault if there is no memory for so many elements.
pub(crate) fn has_room(count: usize, dims: &[usize]) -> Result<(), Fault> {
    // The largest elements, strings, take two words.
    match is_available(count.saturating_mul(16)) {
        true => Ok(()),
        false => bail!(ARRAY_TOO_LARGE, "there is no memory for an array {}", sizes(dims)),
    }
}

/// The number of elements of an array of these sizes; a fault if that is more than
/// [`MAX_ELEMENTS`], or more than there is memory for.
pub fn element_count(dims: &[usize]) -> Result<usize, Fault> {
    let count = dims.iter().try_fold(1usize, |product, size| product.checked_mul(*size));
    match count {
        Some(count) if count <= MAX_ELEMENTS => has_room(count, dims).map(|()| count),
        _ => bail!(ARRAY_TOO_LARGE, "an array with the sizes {} is too large", sizes(dims)),
    }
}

impl Elements {
    /// Number of elements.
    pub fn len(&self) -> usize {
        for_elements!(self, values => values.len())
    }

    /// Whether there is none.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// The element type's name.
    pub fn type_name(&self) -> String {
        match self {
            Elements::Real(_) => "Real".into(),
            Elements::Integer(_) => "Integer".into(),
            Elements::Boolean(_) => "Boolean".into(),
            Elements::String(_) => "String".into(),
            Elements::Enumeration(values) => {
                values.first().map_or("enumeration".into(), |v| v.definition.name.to_string())
            }
            Elements::Record(values) => {
                values.first().map_or("record".into(), |v| v.type_name.to_string())
            }
        }
    }

    /// The element at this offset, counted from 0.
    ///
    /// # Panics
    /// If there is no such element: callers check subscripts first.
    pub fn get(&self, offset: usize) -> Value {
        match self {
            Elements::Real(values) => Value::Real(values[offset]),
            Elements::Integer(values) => Value::Integer(values[offset]),
            Elements::Boolean(values) => Value::Boolean(values[offset]),
            Elements::String(values) => Value::String(values[offset].clone()),
            Elements::Enumeration(values) => Value::Enumeration(values[offset].clone()),
            Elements::Record(values) => Value::Record(values[offset].clone()),
        }
    }

    /// Overwrites the element at this offset, counted from 0. Integer values become Real in an
    /// array of Reals; any other difference of type is a fault.
    ///
    /// # Panics
    /// If there is no such element: callers check subscripts first.
    pub fn set(&mut self, offset: usize, value: Value) -> Result<(), Fault> {
        match (self, value) {
            (Elements::Real(values), Value::Real(value)) => values[offset] = value,
            (Elements::Real(values), Value::Integer(value)) => values[offset] = value as f64,
            (Elements::Integer(values), Value::Integer(value)) => values[offset] = value,
            (Elements::Boolean(values), Value::Boolean(value)) => values[offset] = value,
            (Elements::String(values), Value::String(value)) => values[offset] = value,
            (Elements::Enumeration(values), Value::Enumeration(value))
                if values[offset].definition == value.definition =>
            {
                values[offset] = value;
            }
            // In the functions of loaded classes literals are ordinals.
            (Elements::Enumeration(values), Value::Integer(ordinal))
                if (1..=values[offset].definition.literals.len() as i64).contains(&ordinal) =>
            {
                values[offset].ordinal = ordinal;
            }
            (Elements::Record(values), Value::Record(value))
                if values[offset].type_name == value.type_name =>
            {
                values[offset] = value;
            }
            (elements, value) => {
                bail!(
                    TYPE_MISMATCH,
                    "cannot assign a value of type {} to an element of an array of {}",
                    value.type_name(),
                    elements.type_name()
                )
            }
        }
        Ok(())
    }

    /// Overwrites the elements at these offsets, counted from 0, with as many others.
    ///
    /// # Panics
    /// If there is no such element: callers check subscripts first.
    pub(super) fn scatter(&mut self, offsets: &[usize], new: Elements) -> Result<(), Fault> {
        match (self, new) {
            (Elements::Real(values), Elements::Real(new)) => {
                for (offset, value) in offsets.iter().zip(new) {
                    values[*offset] = value;
                }
            }
            (values, new) => {
                for (from, offset) in offsets.iter().enumerate() {
                    values.set(*offset, new.get(from))?;
                }
            }
        }
        Ok(())
    }

    /// `count` times the same scalar or record.
    pub fn repeated(value: &Value, count: usize) -> Result<Elements, Fault> {
        Ok(match value {
            Value::Real(value) => Elements::Real(vec![*value; count]),
            Value::Integer(value) => Elements::Integer(vec![*value; count]),
            Value::Boolean(value) => Elements::Boolean(vec![*value; count]),
            Value::String(value) => Elements::String(vec![value.clone(); count]),
            Value::Enumeration(value) => Elements::Enumeration(vec![value.clone(); count]),
            Value::Record(value) => Elements::Record(vec![value.clone(); count]),
            other => bail!(
                TYPE_MISMATCH,
                "a value of type {} cannot be an element of an array",
                other.type_name()
            ),
        })
    }

    /// The elements at these offsets, counted from 0, in this order.
    pub(crate) fn gathered(&self, offsets: impl Iterator<Item = usize>) -> Elements {
        map_elements!(self, values => picked(values, offsets))
    }

    /// The elements `start..start + count`.
    pub fn slice(&self, start: usize, count: usize) -> Elements {
        map_elements!(self, values => values[start..start + count].to_vec())
    }

    /// Appends one element as [`Elements::append`] does.
    ///
    /// # Errors
    ///
    /// It is of another type.
    pub fn push(&mut self, value: &Value) -> Result<(), Fault> {
        match (&mut *self, value) {
            (Elements::Real(values), Value::Real(value)) => values.push(*value),
            (Elements::Integer(values), Value::Integer(value)) => values.push(*value),
            (_, value) => return self.append(Elements::repeated(value, 1)?),
        }
        Ok(())
    }

    /// Appends elements of the same type; Integers become Real on either side if the other is.
    pub fn append(&mut self, more: Elements) -> Result<(), Fault> {
        match (&mut *self, more) {
            (Elements::Real(values), Elements::Real(more)) => values.extend(more),
            (Elements::Real(values), Elements::Integer(more)) => {
                values.extend(more.iter().map(|value| *value as f64));
            }
            (Elements::Integer(values), Elements::Integer(more)) => values.extend(more),
            (Elements::Integer(values), Elements::Real(more)) => {
                let mut reals: Vec<f64> = values.iter().map(|value| *value as f64).collect();
                reals.extend(more);
                *self = Elements::Real(reals);
            }
            (Elements::Boolean(values), Elements::Boolean(more)) => values.extend(more),
            (Elements::String(values), Elements::String(more)) => values.extend(more),
            (Elements::Enumeration(values), Elements::Enumeration(more)) => values.extend(more),
            (Elements::Record(values), Elements::Record(more)) => values.extend(more),
            (elements, more) if elements.is_empty() => *elements = more,
            (_, more) if more.is_empty() => {}
            (elements, more) => {
                return Err(fault!(
                    TYPE_MISMATCH,
                    "elements of types {} and {} cannot be mixed in an array",
                    elements.type_name(),
                    more.type_name()
                ));
            }
        }
        Ok(())
    }

    /// The same elements, Integers as Reals.
    pub(crate) fn promoted(self) -> Elements {
        match self {
            Elements::Integer(values) => {
                Elements::Real(values.into_iter().map(|value| value as f64).collect())
            }
            other => other,
        }
    }

    /// No element, of the same type.
    pub(crate) fn none_of_type(&self) -> Elements {
        map_elements!(self, _values => Vec::new())
    }
}
