//! Arguments of tools: what an assistant gives, checked.

use crate::script::world::normalized;
use serde_json::{Map, Value};
use std::path::{Path, PathBuf};

/// The arguments of a call.
pub(super) struct Arguments<'a>(&'a Map<String, Value>);

impl<'a> Arguments<'a> {
    /// Those that the tool has.
    ///
    /// # Errors
    ///
    /// They are no object, or have a name that the tool does not have.
    pub(super) fn of(
        given: &'a Value,
        known: &[&str],
        none: &'a Map<String, Value>,
    ) -> Result<Arguments<'a>, String> {
        let given = match given {
            Value::Null => none,
            Value::Object(given) => given,
            other => return Err(format!("the arguments are an object, not {other}")),
        };
        match given.keys().find(|name| !known.contains(&name.as_str())) {
            Some(name) => {
                Err(format!("there is no argument `{name}`: these are {}", known.join(", ")))
            }
            None => Ok(Arguments(given)),
        }
    }

    fn get(&self, name: &str) -> Option<&'a Value> {
        self.0.get(name).filter(|value| !value.is_null())
    }

    /// A string.
    pub(super) fn text(&self, name: &str) -> Result<Option<&'a str>, String> {
        let value = self.get(name);
        let text = value.map(|value| value.as_str().ok_or_else(|| format!("`{name}` is a string")));
        text.transpose()
    }

    /// A string that must be there.
    pub(super) fn required(&self, name: &str) -> Result<&'a str, String> {
        self.text(name)?.ok_or_else(|| format!("`{name}` is missing"))
    }

    /// Strings, or a single one.
    pub(super) fn strings(&self, name: &str) -> Result<Vec<&'a str>, String> {
        let wrong = || format!("`{name}` is a list of strings");
        match self.get(name) {
            None => Ok(Vec::new()),
            Some(Value::String(one)) => Ok(vec![one]),
            Some(Value::Array(all)) => {
                all.iter().map(|one| one.as_str().ok_or_else(wrong)).collect()
            }
            Some(_) => Err(wrong()),
        }
    }

    /// A number.
    pub(super) fn number(&self, name: &str) -> Result<Option<f64>, String> {
        let value = self.get(name);
        value.map(|value| value.as_f64().ok_or_else(|| format!("`{name}` is a number"))).transpose()
    }

    /// A whole number that is not negative.
    pub(super) fn count(&self, name: &str) -> Result<Option<u64>, String> {
        let wrong = || format!("`{name}` is a whole number");
        self.get(name).map(|value| value.as_u64().ok_or_else(wrong)).transpose()
    }

    /// Whether it is true.
    pub(super) fn flag(&self, name: &str) -> Result<bool, String> {
        match self.get(name) {
            None => Ok(false),
            Some(value) => value.as_bool().ok_or_else(|| format!("`{name}` is true or false")),
        }
    }

    /// Values by their names, as the command line takes them.
    pub(super) fn values(&self, name: &str) -> Result<Vec<(&'a str, String)>, String> {
        let Some(value) = self.get(name) else { return Ok(Vec::new()) };
        let Value::Object(all) = value else {
            return Err(format!("`{name}` is an object with values by their names"));
        };
        let one = |(key, value): (&'a String, &'a Value)| match value {
            Value::Number(_) | Value::Bool(_) => Ok((key.as_str(), value.to_string())),
            Value::String(text) => Ok((key.as_str(), text.clone())),
            _ => Err(format!("`{key}` of `{name}` is a number, true, false or a string")),
        };
        all.iter().map(one).collect()
    }
}

/// The folders whose files an assistant may name.
pub(super) struct Folders {
    /// The working folder, without links.
    pub working: PathBuf,
    /// Folders of libraries, without links.
    pub libraries: Vec<PathBuf>,
}

impl Folders {
    /// A file or folder that is there, in the working folder or in one of a library.
    ///
    /// # Errors
    ///
    /// It is not there, or lies elsewhere, also by a link.
    pub(super) fn input(&self, name: &str) -> Result<PathBuf, String> {
        let outside = || {
            format!(
                "`{name}` lies outside of the working folder {} and of the folders of libraries",
                self.working.display()
            )
        };
        // Whether there is something outside is not said, either.
        let named = normalized(&self.working.join(name));
        if !self.holds(&named) {
            return Err(outside());
        }
        let found = named.canonicalize();
        let found = found.map_err(|error| format!("`{name}` cannot be read: {error}"))?;
        if self.holds(&found) { Ok(found) } else { Err(outside()) }
    }

    fn holds(&self, path: &Path) -> bool {
        let mut all = std::iter::once(&self.working).chain(&self.libraries);
        all.any(|folder| path.starts_with(folder))
    }

    /// A folder for files that this program makes, in the working folder.
    ///
    /// # Errors
    ///
    /// It cannot be made, or a link leads out of the working folder.
    pub(super) fn output(&self, name: &str) -> Result<PathBuf, String> {
        let folder = self.working.join(name);
        let made = std::fs::create_dir_all(&folder).and_then(|()| folder.canonicalize());
        let made = made.map_err(|error| format!("`{name}` cannot be made: {error}"))?;
        match made.starts_with(&self.working) {
            true => Ok(made),
            false => Err(format!("`{name}` is a link out of the working folder")),
        }
    }

    /// A path as it is shown.
    pub(super) fn shown(&self, path: &Path) -> String {
        path.strip_prefix(&self.working).unwrap_or(path).display().to_string()
    }
}
