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
pub struct Statuses {
    /// The messages of the command called last, if its answer was negative.
    answer: Numbers,
    /// Those of the variables that the value being evaluated names.
    named: Vec<Numbers>,
    /// Those of the statuses that variables hold.
    of_variables: HashMap<Ident, Vec<Numbers>>,
}

impl Statuses {
    /// A value is evaluated that is going to be assigned or tested.
    pub fn begin_use(&mut self, value: &Expression) {
        self.answer = 0..0;
        self.named.clear();
        if !self.of_variables.is_empty() {
            self.expression(value);
        }
    }

    /// A command answered, with these messages on the way.
    pub fn answered(&mut self, answer: &Value, messages: Numbers) {
        self.answer = if is_negative(answer) { messages } else { 0..0 };
    }

    /// A variable is given the value that was evaluated.
    pub fn keep(&mut self, target: &ComponentReference, value: &Value) {
        let name = target.parts[0].name;
        if target.as_ident().is_some() {
            self.of_variables.remove(&name);
        }
        let all = self.used();
        if !all.is_empty() && (matches!(value, Value::Boolean(_)) || is_negative(value)) {
            self.of_variables.entry(name).or_default().extend(all);
        }
    }

    /// The messages that belong to the value that was evaluated.
    pub fn used(&self) -> Vec<Numbers> {
        let answer = Some(self.answer.clone()).filter(|answer| !answer.is_empty());
        self.named.iter().cloned().chain(answer).collect()
    }
}

impl Visit for Statuses {
    fn reference(&mut self, reference: &ComponentReference) {
        walk_reference(self, reference);
        let known = self.of_variables.get(&reference.parts[0].name);
        self.named.extend(known.into_iter().flatten().cloned());
    }
}

/// Whether an answer says that a command failed: `false`, or no text where one would name a result.
fn is_negative(answer: &Value) -> bool {
    match answer {
        Value::Boolean(value) => !value,
        Value::String(text) => text.is_empty(),
        Value::Array(array) => match &array.elements {
            Elements::String(texts) => texts.iter().all(|text| text.is_empty()),
            _ => false,
        },
        Value::Record(record) => record.fields.values().next().is_some_and(is_negative),
        Value::Tuple(values) => values.first().is_some_and(is_negative),
        _ => false,
    }
}
