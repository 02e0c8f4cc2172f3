//! Arguments of a command, taken by name.

use crate::diag::Fault;
use crate::eval::Function;
use crate::value::{FromValue, Value};
use std::sync::Arc;

/// The text that stands for an argument that was not given (see [`Args::optional`]).
pub(super) const NOT_GIVEN: &str = "<default>";

/// The arguments of one call, complete and in the order of the header.
pub struct Args {
    header: Arc<Function>,
    values: Vec<Option<Value>>,
}

impl Args {
    /// The arguments of a call of `header`.
    pub fn new(header: Arc<Function>, values: Vec<Value>) -> Args {
        Args { header, values: values.into_iter().map(Some).collect() }
    }

    /// The command's name.
    pub fn command(&self) -> &'static str {
        self.header.name.last().map_or("", |name| name.as_str())
    }

    /// What the header says the command does.
    pub fn description(&self) -> &str {
        self.header.description.as_deref().unwrap_or_default()
    }

    /// The names of the inputs, in order.
    pub fn names(&self) -> impl Iterator<Item = &'static str> {
        self.header.inputs.iter().map(|input| input.name.as_str())
    }

    /// The argument of this name; an error if it is of another type.
    pub fn take<T: FromValue>(&mut self, name: &str) -> Result<T, Fault> {
        T::from_value(self.take_value(name)).map_err(|mut fault| {
            fault.message = format!("`{name}` of `{}`: {}", self.command(), fault.message);
            fault
        })
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

    /// Gives back an argument that was only looked at.
    pub(super) fn put_back(&mut self, name: &str, value: Value) {
        if let Some(slot) = self.position(name).and_then(|at| self.values.get_mut(at)) {
            *slot = Some(value);
        }
    }
}
