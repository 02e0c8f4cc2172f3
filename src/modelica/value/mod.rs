//! Values of expressions in scripts and functions (MLS ch. 3, 10). They know no places: their
//! operations return [`Fault`](crate::diag::Fault)s.

mod array;
mod cast;
pub mod construct;
pub mod errors;
mod external_object;
pub mod format;
mod index;
mod marks;
pub mod ops;
mod path;
mod record;
pub mod show;

#[cfg(test)]
mod tests;

pub use array::{ArrayValue, Elements, MAX_ELEMENTS, check_length, element_count, sizes};
pub use cast::{FromValue, RealMatrix};
pub use external_object::ExternalObject;
pub use index::Index;
pub use marks::Marks;
pub use path::Step;
pub use record::RecordValue;

use crate::name::{Ident, Name};
use std::sync::Arc;

/// A value: what variables of scripts and arguments of functions hold.
///
/// ```
/// use gapilib_modelica::value::{FromValue, Value};
///
/// let row = Value::reals(vec![1.0, 2.5]);
/// assert_eq!(row.type_name(), "Real[2]");
/// assert_eq!(row.dims(), [2]);
/// assert_eq!(row.as_reals().as_deref(), Some(&[1.0, 2.5][..]));
/// // An Integer becomes a Real where one is asked for.
/// assert_eq!(f64::from_value(Value::Integer(3)).ok(), Some(3.0));
/// ```
#[derive(Debug, Clone, PartialEq)]
pub enum Value {
    /// `Real`
    Real(f64),
    /// `Integer`
    Integer(i64),
    /// `Boolean`
    Boolean(bool),
    /// `String`
    String(Arc<str>),
    /// A literal of an enumeration.
    Enumeration(EnumerationValue),
    /// An array of any rank of scalars or records.
    Array(ArrayValue),
    /// A record.
    Record(RecordValue),
    /// A class's name, for arguments of type `TypeName`.
    TypeName(Name),
    /// A variable's name as written, for arguments of type `VariableName`.
    VariableName(Arc<str>),
    /// A function, perhaps with some arguments given (MLS §12.4.2).
    Function(FunctionValue),
    /// An external object.
    External(ExternalObject),
    /// The outputs of a call: none, or several. Never one.
    Tuple(Vec<Value>),
}

/// A literal of an enumeration.
#[derive(Debug, Clone, PartialEq)]
pub struct EnumerationValue {
    /// The enumeration and all its literals.
    pub definition: Arc<EnumerationDefinition>,
    /// Which literal, from 1 (as `Integer(e)` gives it).
    pub ordinal: i64,
}

/// An enumeration type. The same literals in the same order make the same type (MLS §6.7).
#[derive(Debug, Clone, serde::Serialize, serde::Deserialize)]
pub struct EnumerationDefinition {
    /// Its full name.
    pub name: Name,
    /// Its literals in order.
    pub literals: Vec<Ident>,
    /// Their description strings, empty where they have none; none at all where no class declares them.
    pub descriptions: Vec<String>,
}

impl PartialEq for EnumerationDefinition {
    fn eq(&self, other: &EnumerationDefinition) -> bool {
        self.literals == other.literals
    }
}

impl EnumerationValue {
    /// The literal of a number, from 1, of the same enumeration.
    pub(crate) fn of_number(&self, ordinal: i64) -> Option<EnumerationValue> {
        let known = 1..=self.definition.literals.len() as i64;
        known
            .contains(&ordinal)
            .then(|| EnumerationValue { definition: self.definition.clone(), ordinal })
    }

    /// The literal's own name.
    pub fn literal(&self) -> &'static str {
        let at = usize::try_from(self.ordinal - 1).ok();
        at.and_then(|at| self.definition.literals.get(at)).map_or("?", |ident| ident.as_str())
    }
}

impl std::fmt::Display for EnumerationValue {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{}.{}", self.definition.name, self.literal())
    }
}

/// A function as a value.
#[derive(Debug, Clone, PartialEq)]
pub struct FunctionValue {
    /// Its full name.
    pub name: Name,
    /// Arguments given already.
    pub named: Vec<(Ident, Value)>,
}

impl Value {
    /// A string value.
    pub fn string(text: impl Into<Arc<str>>) -> Value {
        Value::String(text.into())
    }

    /// A vector of Reals.
    pub fn reals(values: Vec<f64>) -> Value {
        Value::Array(ArrayValue::vector(Elements::Real(values)))
    }

    /// No value: the result of a call without outputs.
    pub fn nothing() -> Value {
        Value::Tuple(Vec::new())
    }

    /// What kind of value it is, in Modelica's words, for messages: `Real`, `Integer[2, 3]`.
    pub fn type_name(&self) -> String {
        match self {
            Value::Real(_) => "Real".into(),
            Value::Integer(_) => "Integer".into(),
            Value::Boolean(_) => "Boolean".into(),
            Value::String(_) => "String".into(),
            Value::Enumeration(value) => value.definition.name.to_string(),
            Value::Array(array) => array.type_name(),
            Value::Record(record) => record.type_name.to_string(),
            Value::TypeName(_) => "TypeName".into(),
            Value::VariableName(_) => "VariableName".into(),
            Value::Function(_) => "function".into(),
            Value::External(object) => object.class.to_string(),
            Value::Tuple(values) if values.is_empty() => "no value".into(),
            Value::Tuple(_) => "several values".into(),
        }
    }
}
