//! Variables, flags and dotted names of a session.

use crate::diag::{Diagnostic, Fault};
use crate::fault;
use crate::name::{Ident, Name};
use crate::script::builtins::component_names;
use crate::script::errors::NO_WINDOW;
use crate::script::{Dialect, Session};
use crate::syntax::{self, ast::ComponentReference};
use crate::value::errors::TYPE_MISMATCH;
use crate::value::show::{Style, show};
use crate::value::{Elements, Value};

/// First identifiers of dotted names that are flags rather than parts of a model.
const FLAG_ROOTS: &[&str] = &["Advanced", "Hidden", "Evaluate", "Design", "Check", "Dymola"];

/// Classes whose components are completed.
const MAX_COMPLETED: usize = 500;

impl Session {
    /// The value of a flag, if the reference names one that was set.
    pub(super) fn flag(&self, reference: &ComponentReference) -> Option<Value> {
        if self.flags.is_empty() || reference.parts.len() < 2 {
            return None;
        }
        self.flags.get(&reference.name().to_string()).cloned()
    }

    /// Sets a flag; `false` if the name is not one of a flag.
    pub(in crate::script) fn set_flag(
        &mut self,
        target: &ComponentReference,
        value: &Value,
    ) -> bool {
        let is_flag = target.parts.len() > 1 && FLAG_ROOTS.contains(&target.parts[0].name.as_str());
        if is_flag {
            self.flags.insert(target.name().to_string(), value.clone());
        }
        is_flag
    }

    /// A variable that an assignment has made keeps its kind in Dymola's dialect: numbers stay
    /// numbers and texts stay texts.
    pub(super) fn check_kind(
        &self,
        name: Ident,
        before: Option<&Value>,
        value: &Value,
    ) -> Result<(), Fault> {
        let (Some(old), Some(new)) = (before.and_then(kind), kind(value)) else { return Ok(()) };
        if old == new || self.dialect != Dialect::Dymola {
            return Ok(());
        }
        Err(fault!(TYPE_MISMATCH, "`{name}` is a {old} and cannot become a {new}";
            help: "use another name, or redeclare it: `{new} {name}`"))
    }

    /// The variables whose names match a pattern, with values and if wanted types, in alphabetic
    /// order.
    pub(in crate::script) fn listing(&self, pattern: &str, types: bool) -> String {
        let matching = |name: &str| matches(pattern.as_bytes(), name.as_bytes());
        let mut variables: Vec<(&str, &Value)> = self
            .scope
            .iter()
            .map(|(name, value)| (name.as_str(), value))
            .filter(|(name, _)| matching(name))
            .collect();
        variables.sort_by_key(|(name, _)| *name);
        let line = |(name, value): (&str, &Value)| {
            let shown = show(value, Style::Dymola);
            match types {
                true => format!("{} {name} = {shown};\n", value.type_name()),
                false => format!("{name} = {shown};\n"),
            }
        };
        variables.into_iter().map(line).collect()
    }

    /// All variables with types and values.
    pub fn listed_variables(&self) -> String {
        self.listing("*", true)
    }

    /// What can be typed: variables, classes, and the parameters and variables of the model
    /// translated last.
    pub fn names_to_complete(&self) -> Vec<String> {
        let variables = self.scope.iter().map(|(name, _)| name.as_str().to_owned());
        let classes = self.classes.read_names();
        let mut names: Vec<String> = variables.chain(classes.iter().map(Name::to_string)).collect();
        for class in classes.iter().take(MAX_COMPLETED) {
            let Some(definition) = self.classes.library.definition(class) else { continue };
            let components = component_names(&definition).into_iter();
            names.extend(components.map(|component| format!("{class}.{component}")));
        }
        if let Some(model) = self.last_model() {
            names.extend(model.flat.variables.keys().map(|name| name.to_string()));
        }
        names.extend(crate::functions::names().map(str::to_owned));
        names
    }

    /// The value of an expression; `name` stands in diagnostics.
    ///
    /// # Errors
    /// What is wrong with it.
    pub fn value_of(&mut self, name: &str, text: &str) -> Result<Value, Diagnostic> {
        let source = self.sources.add(name, text);
        let expression = syntax::parse_expression(source, text)?;
        self.evaluate(&expression)
    }

    /// The text of a loaded class, or of one that can be.
    pub fn declaration(&mut self, name: &str) -> Option<String> {
        let name = Name::parse(name);
        if !self.class_exists(&name) {
            return None;
        }
        let class = self.library().definition(&name)?;
        Some(syntax::print::class(&class))
    }

    /// Says once that a command has no effect because there is no window.
    pub(in crate::script) fn no_effect(&mut self, command: &'static str) {
        if self.windowless.insert(command) {
            self.note(NO_WINDOW, format!("`{command}` has no effect here"));
        }
    }
}

/// What kind of values a variable holds; `None` where nothing tells.
fn kind(value: &Value) -> Option<&'static str> {
    match value {
        Value::Real(_) | Value::Integer(_) => Some("Real"),
        Value::Boolean(_) => Some("Boolean"),
        Value::String(_) => Some("String"),
        Value::Array(array) if array.elements.is_empty() => None,
        Value::Array(array) => match array.elements {
            Elements::Real(_) | Elements::Integer(_) => Some("Real"),
            Elements::Boolean(_) => Some("Boolean"),
            Elements::String(_) => Some("String"),
            _ => None,
        },
        _ => None,
    }
}

/// Whether a name matches a pattern in which `*` stands for any characters and `?` for one.
fn matches(pattern: &[u8], name: &[u8]) -> bool {
    let (mut p, mut n, mut star) = (0, 0, None);
    while n < name.len() {
        match pattern.get(p) {
            Some(b'*') => {
                star = Some((p, n));
                p += 1;
            }
            Some(c) if *c == b'?' || *c == name[n] => {
                p += 1;
                n += 1;
            }
            _ => match star {
                Some((at, from)) => {
                    star = Some((at, from + 1));
                    p = at + 1;
                    n = from + 1;
                }
                None => return false,
            },
        }
    }
    pattern[p..].iter().all(|c| *c == b'*')
}

#[cfg(test)]
mod tests {
    use super::matches;

    #[test]
    fn patterns_match_as_in_file_names() {
        for (pattern, name, expected) in [
            ("*", "", true),
            ("N_*", "N_Cycle", true),
            ("*e?", "Besten", true),
            ("*e?", "Beste", false),
            ("a*b*c", "aXbYbc", true),
            ("a", "ab", false),
        ] {
            assert_eq!(matches(pattern.as_bytes(), name.as_bytes()), expected, "{pattern} {name}");
        }
    }
}
