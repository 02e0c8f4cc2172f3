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
}

impl LogMessage {
    /// The message with the names of variables in the place of their value references (FMI 2.0.5 §2.1.5):
    /// `#r12#` is the Real with the reference 12, and `##` is `#`. What is neither stays as it is.
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
            let message = LogMessage {
                is_problem: true,
                category: "logAll".to_owned(),
                text: text.to_owned(),
            };
            message.named(&description).text
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
