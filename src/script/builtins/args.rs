//! Arguments of a command, taken by name.

use crate::bail;
use crate::diag::Fault;
use crate::eval::Function;
use crate::name::Name;
use crate::script::errors::BAD_ARGUMENT;
use crate::value::{ArrayValue, Elements, Value};
use std::sync::Arc;

/// The text that stands for an argument that was not given (see [`Args::optional`]).
pub(super) const NOT_GIVEN: &str = "<default>";

/// The arguments of one call, complete and in the order of the header.
pub struct Args {
    header: Arc<Function>,
    values: Vec<Option<Value>>,
}

/// A matrix of Reals, row by row.
#[derive(Debug, Clone, PartialEq)]
pub struct Matrix {
    /// Number of rows.
    pub rows: usize,
    /// Number of columns.
    pub columns: usize,
    /// The elements, row by row.
    pub elements: Vec<f64>,
}

impl Matrix {
    /// The matrix as a value.
    pub fn into_value(self) -> Value {
        Value::Array(ArrayValue::matrix(self.rows, self.columns, self.elements))
    }
}

/// A type that an argument can be taken as.
pub trait FromValue: Sized {
    /// What is expected, in Modelica's words.
    const EXPECTED: &'static str;
    /// The value as this type; `None` if it is of another one.
    fn from_value(value: Value) -> Option<Self>;
}

impl Args {
    /// The arguments of a call of `header`.
    pub(super) fn new(header: Arc<Function>, values: Vec<Value>) -> Args {
        Args { header, values: values.into_iter().map(Some).collect() }
    }

    /// The command's name.
    pub fn command(&self) -> &'static str {
        self.header.name.last().map_or("", |name| name.as_str())
    }

    /// The names of the inputs, in order.
    pub fn names(&self) -> impl Iterator<Item = &'static str> {
        self.header.inputs.iter().map(|input| input.name.as_str())
    }

    /// The argument of this name; an error if it is of another type.
    pub fn take<T: FromValue>(&mut self, name: &str) -> Result<T, Fault> {
        let value = self.take_value(name);
        let type_name = value.type_name();
        match T::from_value(value) {
            Some(taken) => Ok(taken),
            None => bail!(
                BAD_ARGUMENT,
                "`{name}` of `{}` must be {}, not {type_name}",
                self.command(),
                T::EXPECTED
            ),
        }
    }

    /// An argument of an input marked `annotation(optional = true)` in the header: `None` if the
    /// call does not give it.
    pub fn optional<T: FromValue>(&mut self, name: &str) -> Result<Option<T>, Fault> {
        let value = self.take_value(name);
        if matches!(&value, Value::String(text) if &**text == NOT_GIVEN) {
            return Ok(None);
        }
        self.put_back(name, value);
        self.take(name).map(Some)
    }

    fn position(&self, name: &str) -> Option<usize> {
        self.header.inputs.iter().position(|input| input.name == *name)
    }

    fn take_value(&mut self, name: &str) -> Value {
        let position = self.position(name);
        debug_assert!(position.is_some(), "`{name}` is not in the header of `{}`", self.command());
        position.and_then(|at| self.values.get_mut(at)?.take()).unwrap_or(Value::nothing())
    }

    fn put_back(&mut self, name: &str, value: Value) {
        if let Some(slot) = self.position(name).and_then(|at| self.values.get_mut(at)) {
            *slot = Some(value);
        }
    }
}

impl FromValue for Value {
    const EXPECTED: &'static str = "a value";
    fn from_value(value: Value) -> Option<Value> {
        Some(value)
    }
}

impl FromValue for f64 {
    const EXPECTED: &'static str = "a Real";
    fn from_value(value: Value) -> Option<f64> {
        match value {
            Value::Real(value) => Some(value),
            Value::Integer(value) => Some(value as f64),
            _ => None,
        }
    }
}

impl FromValue for i64 {
    const EXPECTED: &'static str = "an Integer";
    fn from_value(value: Value) -> Option<i64> {
        match value {
            Value::Integer(value) => Some(value),
            Value::Enumeration(value) => Some(value.ordinal),
            _ => None,
        }
    }
}

impl FromValue for bool {
    const EXPECTED: &'static str = "a Boolean";
    fn from_value(value: Value) -> Option<bool> {
        match value {
            Value::Boolean(value) => Some(value),
            _ => None,
        }
    }
}

impl FromValue for Arc<str> {
    const EXPECTED: &'static str = "a String";
    fn from_value(value: Value) -> Option<Arc<str>> {
        match value {
            Value::String(text) | Value::VariableName(text) => Some(text),
            Value::TypeName(name) => Some(name.to_string().into()),
            _ => None,
        }
    }
}

impl FromValue for String {
    const EXPECTED: &'static str = "a String";
    fn from_value(value: Value) -> Option<String> {
        Arc::<str>::from_value(value).map(|text| text.to_string())
    }
}

impl FromValue for Name {
    const EXPECTED: &'static str = "a class name";
    fn from_value(value: Value) -> Option<Name> {
        match value {
            Value::TypeName(name) => Some(name),
            Value::String(text) | Value::VariableName(text) => Some(Name::parse(&text)),
            _ => None,
        }
    }
}

impl FromValue for Vec<f64> {
    const EXPECTED: &'static str = "a vector of Reals";
    fn from_value(value: Value) -> Option<Vec<f64>> {
        match value {
            Value::Array(ArrayValue { dims, elements }) if is_row(&dims) => reals(elements),
            _ => None,
        }
    }
}

impl FromValue for Vec<i64> {
    const EXPECTED: &'static str = "a vector of Integers";
    fn from_value(value: Value) -> Option<Vec<i64>> {
        match value {
            Value::Array(ArrayValue { dims, elements }) if is_row(&dims) => match elements {
                Elements::Integer(values) => Some(values),
                Elements::Real(values) if values.is_empty() => Some(Vec::new()),
                _ => None,
            },
            _ => None,
        }
    }
}

impl FromValue for Vec<String> {
    const EXPECTED: &'static str = "a vector of Strings";
    fn from_value(value: Value) -> Option<Vec<String>> {
        match value {
            Value::Array(ArrayValue { dims, elements }) if dims.len() == 1 => match elements {
                Elements::String(texts) => Some(texts.iter().map(|t| t.to_string()).collect()),
                Elements::Real(values) if values.is_empty() => Some(Vec::new()),
                _ => None,
            },
            Value::VariableName(text) => Some(vec![text.to_string()]),
            Value::Tuple(values) => values.into_iter().map(String::from_value).collect(),
            _ => None,
        }
    }
}

impl FromValue for Matrix {
    const EXPECTED: &'static str = "a matrix of Reals";
    fn from_value(value: Value) -> Option<Matrix> {
        match value {
            Value::Array(ArrayValue { dims, elements }) => match *dims {
                [rows, columns] => {
                    reals(elements).map(|elements| Matrix { rows, columns, elements })
                }
                _ => None,
            },
            _ => None,
        }
    }
}

/// Whether the sizes are those of a vector or of a matrix with one row, which GAPILib's scripts
/// use for vectors.
fn is_row(dims: &[usize]) -> bool {
    matches!(dims, [_] | [1, _])
}

fn reals(elements: Elements) -> Option<Vec<f64>> {
    match elements {
        Elements::Real(values) => Some(values),
        Elements::Integer(values) => Some(values.into_iter().map(|v| v as f64).collect()),
        _ => None,
    }
}
