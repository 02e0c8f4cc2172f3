//! The names of a session: variables, flags, imports, and the functions that names stand for.

use super::callees::Callees;
use crate::diag::Fault;
use crate::eval::Scope;
use crate::external::Random;
use crate::fault;
use crate::name::{Ident, Name};
use crate::syntax::ast::ComponentReference;
use crate::value::errors::TYPE_MISMATCH;
use crate::value::show::{Style, show};
use crate::value::{Elements, Value};
use indexmap::IndexMap;
use std::collections::{BTreeMap, HashMap};

/// Flags that scripts read before they set them, to set them back, and what they are until then.
const UNSET: &[(&str, bool)] = &[("Advanced.StoreProtectedVariables", true)];

/// First identifiers of dotted names that are flags rather than parts of a model.
const FLAG_ROOTS: &[&str] = &["Advanced", "Hidden", "Evaluate", "Design", "Check", "Dymola"];

/// What scripts have named.
pub(crate) struct Workspace {
    /// The variables of the scripts.
    pub variables: Scope,
    /// Functions that names stand for, looked up before.
    pub callees: Callees,
    /// The functions that commands were last said to be replaced by, by the commands' bare names.
    replacing: HashMap<Ident, Name>,
    /// The hidden state of `Modelica.Math.Random.Utilities.impureRandom`.
    pub random: Random,
    /// Flags such as `Advanced.StoreProtectedVariables`.
    flags: BTreeMap<String, Value>,
    /// What imports in scripts made visible: a name and what it stands for.
    imports: IndexMap<Ident, Name>,
    /// Packages whose content an import `P.*` made visible.
    open_packages: Vec<Name>,
}

impl Default for Workspace {
    fn default() -> Workspace {
        Workspace {
            variables: Scope::script(),
            callees: Callees::default(),
            replacing: HashMap::new(),
            random: Random::default(),
            flags: BTreeMap::new(),
            imports: IndexMap::new(),
            open_packages: Vec::new(),
        }
    }
}

/// Whether a reference names a flag.
fn is_flag(reference: &ComponentReference) -> bool {
    reference.parts.len() > 1 && FLAG_ROOTS.contains(&reference.parts[0].name.as_str())
}

impl Workspace {
    /// A function is called in place of a command; whether that was not said yet.
    pub(crate) fn replaces_newly(&mut self, command: Ident, function: &Name) -> bool {
        self.replacing.insert(command, function.clone()).as_ref() != Some(function)
    }

    /// The value of the flag of this name, if it was set.
    pub(crate) fn flag(&self, name: &str) -> Option<&Value> {
        self.flags.get(name)
    }

    /// The value of a flag, if the reference names one that was set, or one that has a value
    /// without that.
    pub(crate) fn flag_at(&self, reference: &ComponentReference) -> Option<Value> {
        if !is_flag(reference) {
            return None;
        }
        let name = reference.name().to_string();
        let unset = || UNSET.iter().find(|(flag, _)| *flag == name).map(|(_, on)| (*on).into());
        self.flag(&name).cloned().or_else(unset)
    }

    /// Whether a flag changes anything.
    pub(crate) fn has_effect(flag: &str) -> bool {
        UNSET.iter().any(|(known, _)| *known == flag)
    }

    /// Sets a flag; `false` if the name is not one of a flag.
    pub(crate) fn set_flag(&mut self, target: &ComponentReference, value: &Value) -> bool {
        let is_flag = is_flag(target);
        if is_flag {
            self.flags.insert(target.name().to_string(), value.clone());
        }
        is_flag
    }

    /// A name stands for another from here on.
    pub(crate) fn import(&mut self, alias: Ident, name: Name) {
        self.imports.insert(alias, name);
    }

    /// The content of a package is visible from here on.
    pub(crate) fn open_package(&mut self, package: Name) {
        self.open_packages.push(package);
    }

    /// What a name may denote: itself, and what the imports of the scripts make of it.
    pub(crate) fn candidates(&self, name: &Name) -> Vec<Name> {
        let mut all = vec![name.clone()];
        let Some(first) = name.first().filter(|_| !name.global) else { return all };
        if let Some(target) = self.imports.get(&first) {
            let parts = target.parts.iter().chain(&name.parts[1..]);
            all.push(Name::new(parts.copied()));
        }
        for package in &self.open_packages {
            all.push(Name::new(package.parts.iter().chain(&name.parts).copied()));
        }
        all
    }

    /// The variables whose names match a pattern, with values and if requested types, in alphabetic
    /// order.
    pub(crate) fn listing(&self, pattern: &str, types: bool) -> String {
        let matching = |name: &str| matches(pattern.as_bytes(), name.as_bytes());
        let mut variables: Vec<(&str, &Value)> = self
            .variables
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

    /// Forgets variables, flags and imports.
    pub(crate) fn clear(&mut self) {
        self.variables.clear();
        self.flags.clear();
        self.imports.clear();
        self.open_packages.clear();
        self.callees.clear();
    }
}

/// A variable that an assignment has made keeps its type: numbers stay numbers and strings stay
/// strings.
///
/// # Errors
/// The value is of another type than the one before.
pub fn check_type(name: Ident, before: Option<&Value>, value: &Value) -> Result<(), Fault> {
    match (before.and_then(base_type), base_type(value)) {
        (Some(old), Some(new)) if old != new => {
            Err(fault!(TYPE_MISMATCH, "`{name}` is a {old} and cannot become a {new}";
                help: "use another name, or redeclare it: `{new} {name}`"))
        }
        _ => Ok(()),
    }
}

/// The type of the values that a variable holds; `None` where nothing tells.
fn base_type(value: &Value) -> Option<&'static str> {
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
pub fn matches(pattern: &[u8], name: &[u8]) -> bool {
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
