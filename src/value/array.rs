//! Arrays (MLS ch. 10): row-major, of one element type, stored unboxed.

use super::{EnumerationValue, RecordValue};
use std::sync::Arc;

/// An array of rank one or more.
#[derive(Debug, Clone, PartialEq)]
pub struct ArrayValue {
    /// Sizes of the dimensions; at least one. Their product is the number of elements.
    pub dims: Vec<usize>,
    /// The elements, last dimension fastest.
    pub elements: Elements,
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

impl ArrayValue {
    /// A vector.
    pub fn vector(elements: Elements) -> ArrayValue {
        ArrayValue { dims: vec![elements.len()], elements }
    }

    /// A matrix of Reals; `elements` row by row.
    pub fn matrix(rows: usize, columns: usize, elements: Vec<f64>) -> ArrayValue {
        debug_assert_eq!(rows * columns, elements.len());
        ArrayValue { dims: vec![rows, columns], elements: Elements::Real(elements) }
    }

    /// `Real[2, 3]`
    pub fn type_name(&self) -> String {
        let sizes: Vec<String> = self.dims.iter().map(usize::to_string).collect();
        format!("{}[{}]", self.elements.type_name(), sizes.join(", "))
    }
}

impl Elements {
    /// Number of elements.
    pub fn len(&self) -> usize {
        match self {
            Elements::Real(values) => values.len(),
            Elements::Integer(values) => values.len(),
            Elements::Boolean(values) => values.len(),
            Elements::String(values) => values.len(),
            Elements::Enumeration(values) => values.len(),
            Elements::Record(values) => values.len(),
        }
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
}
