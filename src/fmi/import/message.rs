//! A message of a unit.

use crate::Description;
use crate::description::{Kind, Version};
use serde::{Deserialize, Serialize};

/// A message of a unit.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct LogMessage {
    /// Whether the unit calls it a warning or an error.
    pub is_problem: bool,
    /// The category that the unit gives it.
    pub category: String,
    /// The text.
    pub text: String,
    /// Whether it is the last of more messages than are kept, which differ in numbers alone.
    pub is_last_of_many: bool,
}

/// Messages that differ in numbers alone and are kept: units say at which time a step was refused, and steps
/// are refused by the thousand.
const MOST_ALIKE: usize = 3;

impl LogMessage {
    /// Adds the message to others, each once; of warnings and errors that differ in numbers alone the first
    /// ones and the last one are kept.
    pub(super) fn add_to(self, all: &mut Vec<LogMessage>) {
        let is_of_kind =
            |own: &&LogMessage| own.is_problem == self.is_problem && own.category == self.category;
        if all.iter().filter(is_of_kind).any(|own| own.text == self.text) {
            return;
        }
        let words = |text: &str| text.replace(|c: char| c.is_ascii_digit(), "");
        let is_like = |own: &LogMessage| {
            self.is_problem && is_of_kind(&own) && words(&own.text) == words(&self.text)
        };
        let alike: Vec<usize> = (0..all.len()).filter(|at| is_like(&all[*at])).collect();
        let last = alike.last().filter(|_| alike.len() >= MOST_ALIKE);
        let is_last_of_many = self.is_last_of_many || last.is_some();
        last.into_iter().for_each(|at| drop(all.remove(*at)));
        all.push(LogMessage { is_last_of_many, ..self });
    }

    /// The message with the names of variables in the place of their value references (FMI 2.0.5 §2.1.5):
    /// `#r12#` is the Real with the reference 12, and `##` is `#`. What is neither stays as it is.
    #[cfg_attr(
        not(feature = "host"),
        allow(dead_code, reason = "units run with the feature alone")
    )]
    pub(super) fn named(self, description: &Description) -> LogMessage {
        if description.version != Version::V2 || !self.text.contains('#') {
            return self;
        }
        let mut text = String::with_capacity(self.text.len());
        let mut rest = self.text.as_str();
        while let Some((before, after)) = rest.split_once('#') {
            text.push_str(before);
            let (inner, beyond) = after.split_once('#').unwrap_or((after, ""));
            let name = variable(description, inner).filter(|_| inner.len() < after.len());
            rest = match name {
                Some(name) => {
                    text.push_str(name);
                    beyond
                }
                None => {
                    text.push('#');
                    after.strip_prefix('#').unwrap_or(after)
                }
            };
        }
        text.push_str(rest);
        LogMessage { text, ..self }
    }
}

/// The name of the variable that `r12` stands for.
#[cfg_attr(not(feature = "host"), allow(dead_code, reason = "units run with the feature alone"))]
fn variable<'d>(description: &'d Description, written: &str) -> Option<&'d str> {
    let is_kind = |kind: Kind| match written.chars().next() {
        Some('r') => kind == Kind::Float64,
        Some('i') => matches!(kind, Kind::Int32 | Kind::Enumeration),
        Some('b') => kind == Kind::Boolean,
        Some('s') => kind == Kind::String,
        _ => false,
    };
    let reference: u32 = written.get(1..)?.parse().ok()?;
    let mut all = description.variables.iter();
    let found = all.find(|own| own.reference == reference && is_kind(own.kind));
    found.map(|own| own.name.as_str())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::description::Variable;

    fn message(text: &str) -> LogMessage {
        let (category, text) = ("logAll".to_owned(), text.to_owned());
        LogMessage { is_problem: true, category, text, is_last_of_many: false }
    }

    #[test]
    fn of_messages_that_differ_in_numbers_the_first_and_the_last_are_kept() {
        let mut all = Vec::new();
        for time in [1, 1, 2, 3, 20, 100] {
            message(&format!("no value at t = {time}.5")).add_to(&mut all);
            message("dry").add_to(&mut all);
        }
        let kept: Vec<&str> = all.iter().map(|own| own.text.as_str()).collect();
        assert_eq!(
            kept,
            ["no value at t = 1.5", "dry", "no value at t = 2.5", "no value at t = 100.5"]
        );
        let last: Vec<bool> = all.iter().map(|own| own.is_last_of_many).collect();
        assert_eq!(last, [false, false, false, true]);
    }

    #[test]
    fn value_references_become_names() {
        let variable = |name: &str, kind, reference| Variable {
            name: name.to_owned(),
            kind,
            reference,
            ..Variable::default()
        };
        let variables =
            vec![variable("body.m", Kind::Float64, 1365), variable("mode", Kind::Enumeration, 2)];
        let named = |text: &str, version| {
            let description =
                Description { version, variables: variables.clone(), ..Description::default() };
            message(text).named(&description).text
        };
        for (text, expected) in [
            ("#r1365# must be positive (channel ##4)", "body.m must be positive (channel #4)"),
            ("#i2#, #b2#, #r7#", "mode, #b2#, #r7#"),
            ("50 % of #r1365#", "50 % of body.m"),
            ("no # here, #r1365", "no # here, #r1365"),
            ("ends with #", "ends with #"),
        ] {
            assert_eq!(named(text, Version::V2), expected);
            assert_eq!(named(text, Version::V3), text);
        }
    }
}
