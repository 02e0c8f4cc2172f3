//! Errors that commands answered with a status, such as the Boolean of `simulateModel`: a script
//! that tests the status has read them.

use crate::name::Ident;
use crate::syntax::ast::{ComponentReference, Expression};
use crate::syntax::visit::{Visit, walk_reference};
use crate::value::{Elements, Value};
use std::collections::HashMap;
use std::ops::Range;

/// Messages by their numbers.
type Numbers = Range<usize>;

/// What statuses stand for.
#[derive(Debug, Default)]
pub(crate) struct Statuses {
    own: Frame,
    /// Those of the callers of the function being executed, innermost last.
    callers: Vec<Frame>,
}

/// The statuses of a script, or of a function being executed.
#[derive(Debug, Default)]
struct Frame {
    /// The messages of the commands that answered negatively while the value was evaluated.
    answers: Vec<Numbers>,
    /// Those of the variables that the value being evaluated names.
    named: Vec<Numbers>,
    /// Those of the statuses that variables hold.
    of_variables: HashMap<Ident, Vec<Numbers>>,
    /// Those of the statuses in the arrays that iterators run through.
    of_iterators: HashMap<Ident, Vec<Numbers>>,
}

impl Statuses {
    /// A value is evaluated that is going to be assigned or tested.
    pub(crate) fn begin_use(&mut self, value: &Expression) {
        self.own.answers.clear();
        self.own.named.clear();
        self.own.name(value);
    }

    /// A command answered, with these messages on the way.
    pub(crate) fn answered(&mut self, answer: &Value, messages: Numbers) {
        if is_negative(answer) && !messages.is_empty() {
            self.own.answers.push(messages);
        }
    }

    /// An iterator takes the values of a range.
    pub(crate) fn iterates(&mut self, iterator: Ident, range: &Expression) {
        let own = &mut self.own;
        if own.of_variables.is_empty() && own.of_iterators.is_empty() {
            return;
        }
        let outer = std::mem::take(&mut own.named);
        own.name(range);
        let named = std::mem::replace(&mut own.named, outer);
        own.of_iterators.insert(iterator, named);
    }

    /// A variable is given the value that was evaluated.
    pub(crate) fn keep(&mut self, target: &ComponentReference, value: &Value) {
        let name = target.parts[0].name;
        if target.as_ident().is_some() {
            self.own.of_variables.remove(&name);
        }
        let all = self.used();
        if !all.is_empty() && (is_status(value) || is_negative(value)) {
            self.own.of_variables.entry(name).or_default().extend(all);
        }
    }

    /// The messages that belong to the value that was evaluated.
    pub(crate) fn used(&self) -> Vec<Numbers> {
        self.own.named.iter().chain(&self.own.answers).cloned().collect()
    }

    /// A function begins, which has variables of its own.
    pub(crate) fn begin_function(&mut self) {
        self.callers.push(std::mem::take(&mut self.own));
    }

    /// The function has ended: the statuses that its outputs hold are those of the call.
    pub(crate) fn end_function(&mut self, outputs: impl Iterator<Item = Ident>) {
        let caller = self.callers.pop().unwrap_or_default();
        let inner = std::mem::replace(&mut self.own, caller);
        let returned = outputs.filter_map(|output| inner.of_variables.get(&output));
        self.own.answers.extend(returned.flatten().cloned());
    }
}

impl Frame {
    /// Adds the statuses of the variables that an expression names.
    fn name(&mut self, value: &Expression) {
        if !self.of_variables.is_empty() || !self.of_iterators.is_empty() {
            self.expression(value);
        }
    }
}

impl Visit for Frame {
    fn reference(&mut self, reference: &ComponentReference) {
        walk_reference(self, reference);
        let name = reference.parts[0].name;
        let known = self.of_variables.get(&name).or_else(|| self.of_iterators.get(&name));
        self.named.extend(known.into_iter().flatten().cloned());
    }
}

/// Whether a value holds statuses: Booleans, one or several.
fn is_status(value: &Value) -> bool {
    match value {
        Value::Boolean(_) => true,
        Value::Array(array) => matches!(array.elements, Elements::Boolean(_)),
        _ => false,
    }
}

/// Whether an answer says that a command failed: `false`, or no text where one would name a result.
fn is_negative(answer: &Value) -> bool {
    match answer {
        Value::Boolean(value) => !value,
        Value::String(text) => text.is_empty(),
        Value::Array(array) => match &array.elements {
            Elements::String(strings) => strings.iter().all(|text| text.is_empty()),
            _ => false,
        },
        Value::Record(record) => record.fields.values().next().is_some_and(is_negative),
        Value::Tuple(values) => values.first().is_some_and(is_negative),
        _ => false,
    }
}
