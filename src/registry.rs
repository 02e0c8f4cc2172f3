//! Named choices a script may ask for: integrators, fitness functions, genetic operators, result
//! formats.

use crate::diag::{Fault, suggest};
use crate::{codes, fault};
use indexmap::IndexMap;

codes! {
    /// A name that is not in its table.
    UNKNOWN_CHOICE = "unknown-choice":
        "## What it means\n\nA method, operator or format was asked for by a name that is not in its table.\n\n## Example\n\n`simulateModel(\"M\", method=\"dasl\")`\n\n## What to do\n\nUse one of the names that the message lists.",
    /// An option that its choice does not have, or a value outside its domain.
    BAD_OPTION = "bad-option":
        "## What it means\n\nAn option is not known to what it was given to, or its value is outside the domain named in the message.\n\n## Example\n\n`tolerance = -1`\n\n## What to do\n\nCorrect the name or the value.",
}

/// One named choice: what the user writes, what it means, and how to make it.
pub struct Entry<T: ?Sized> {
    /// The name written in scripts, such as `"dassl"` in `method = "dassl"`.
    pub name: &'static str,
    /// Other names for the same choice.
    pub aliases: &'static [&'static str],
    /// One sentence for help and for the alternatives in error messages.
    pub summary: &'static str,
    /// Where the method is defined: a key of [`crate::bibliography`].
    pub reference: &'static str,
    /// Builds the object from the options the user gave; unknown options are an error.
    pub make: fn(&mut Options) -> Result<Box<T>, Fault>,
}

/// Finds an entry by name or alias, case not counted; `kind` names the table in the message.
pub fn find<'a, T: ?Sized>(
    kind: &str,
    table: &[&'a Entry<T>],
    name: &str,
) -> Result<&'a Entry<T>, Fault> {
    let same = |candidate: &str| candidate.eq_ignore_ascii_case(name);
    let found = table.iter().find(|e| same(e.name) || e.aliases.iter().any(|alias| same(alias)));
    found.copied().ok_or_else(|| {
        let names: Vec<&str> = table.iter().map(|entry| entry.name).collect();
        fault!(UNKNOWN_CHOICE, "unknown {kind} `{name}`")
            .help_if(suggest::did_you_mean(name, names.iter().copied()))
            .help(format!("known: {}", names.join(", ")))
    })
}

/// Options given by name, each taken once; what is left over is an error.
#[derive(Debug, Clone, Default)]
pub struct Options {
    numbers: IndexMap<String, f64>,
}

impl Options {
    /// Adds an option.
    pub fn set(&mut self, name: &str, value: f64) {
        self.numbers.insert(name.to_owned(), value);
    }

    /// Takes a number out, or the default; an error outside `domain`.
    pub fn take(
        &mut self,
        name: &str,
        domain: std::ops::RangeInclusive<f64>,
        default: f64,
    ) -> Result<f64, Fault> {
        let value = self.numbers.shift_remove(name).unwrap_or(default);
        if domain.contains(&value) {
            return Ok(value);
        }
        let (low, high) = (domain.start(), domain.end());
        Err(fault!(BAD_OPTION, "`{name}` is {value}, outside {low} to {high}"))
    }

    /// An error that names what nobody took.
    pub fn finish(self) -> Result<(), Fault> {
        match self.numbers.keys().next() {
            Some(name) => Err(fault!(BAD_OPTION, "unknown option `{name}`")),
            None => Ok(()),
        }
    }
}
