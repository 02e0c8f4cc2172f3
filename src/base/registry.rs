//! Named choices a script may ask for: integrators, fitness functions, genetic operators, result
//! formats.

use crate::diag::{Fault, suggest};
use crate::{codes, fault};
use indexmap::{IndexMap, IndexSet};
use std::ops::RangeInclusive;
use std::sync::Arc;

codes! {
    /// A name that is not in its table.
    UNKNOWN_CHOICE = "unknown-choice":
        "## What it means\n\nThe name of a method, operator or format is unknown.\n\n## Example\n\n`simulateModel(\"M\", method=\"dasl\")`\n\n## What to do\n\nUse one of the names that the message lists.",
    /// An option that its choice does not have, or a value outside its domain.
    BAD_OPTION = "bad-option":
        "## What it means\n\nAn option, an argument or an entry of a problem file is unknown, has the wrong form (a problem file is TOML), or its value is outside the range given in the message; or the settings cannot be used together, with these data or with this model.\n\n## Example\n\n`tolerance = -1`, or `G = [0.1, 20]` instead of `G = { min = 0.1, max = 20 }`\n\n## What to do\n\nCorrect the name, the form or the value at the position shown; the help of the message says what is expected there.",
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
    /// Builds the object from the options the user gave; what it does not take is an error for the
    /// caller to find with [`Options::finish`].
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

/// A function that the user wrote: numbers in, numbers out.
pub trait UserFunction: Send + Sync {
    /// Its outputs, one after the other, from its inputs, one after the other.
    ///
    /// # Errors
    ///
    /// The function failed, as by an assertion.
    fn call(&self, inputs: &[f64]) -> Result<Vec<f64>, Fault>;
}

/// Something of a table that the user has chosen within the settings of something else, such as
/// the crossover of a method.
#[derive(Clone)]
pub struct Choice {
    /// A name of the table, or that of a function of the user.
    pub name: String,
    /// Its settings.
    pub options: Options,
    /// The function of that name; `None` for an entry of the table.
    pub function: Option<Arc<dyn UserFunction>>,
}

impl Choice {
    /// A choice by name, without settings.
    pub fn named(name: &str) -> Choice {
        Choice { name: name.to_owned(), options: Options::default(), function: None }
    }

    /// A choice with its settings in one string: `sbx` or `sbx(eta = 5)`.
    ///
    /// # Errors
    ///
    /// `bad-option` for another form.
    pub fn parse(text: &str) -> Result<Choice, Fault> {
        let Some((name, settings)) = text.split_once('(') else {
            return Ok(Choice::named(text.trim()));
        };
        let wrong = || {
            fault!(BAD_OPTION, "`{text}` is not a name with settings")
                .help("write, for example, `sbx` or `sbx(eta = 5)`")
        };
        let settings = settings.trim_end().strip_suffix(')').ok_or_else(wrong)?;
        let mut choice = Choice::named(name.trim());
        for setting in settings.split(',').filter(|setting| !setting.trim().is_empty()) {
            let (name, value) = setting.split_once('=').ok_or_else(wrong)?;
            let value = value.trim().parse().map_err(|_| wrong())?;
            choice.options.set(name.trim(), value);
        }
        Ok(choice)
    }

    /// The name with the settings as given: `sbx(eta = 5)`.
    pub fn label(&self) -> String {
        let settings = self.options.numbers().map(|(name, value)| format!("{name} = {value}"));
        match settings.collect::<Vec<_>>().join(", ") {
            none if none.is_empty() => self.name.clone(),
            settings => format!("{}({settings})", self.name),
        }
    }
}

/// A number that an entry takes from its options.
#[derive(Debug, Clone, PartialEq)]
pub struct Setting {
    /// Its name.
    pub name: String,
    /// Its value where nothing is given.
    pub default: f64,
    /// The values that are accepted.
    pub domain: RangeInclusive<f64>,
}

/// The numbers that an entry takes from its options, found by making it.
pub fn settings<T: ?Sized>(entry: &Entry<T>) -> Vec<Setting> {
    let mut options = Options::default();
    // Without options every entry can be made; what it has asked for until an error counts as well.
    let _ = (entry.make)(&mut options);
    options.taken
}

/// The choices that an entry offers within its options.
pub fn choices<T: ?Sized>(entry: &Entry<T>) -> Vec<&'static str> {
    let mut options = Options::default();
    let _ = (entry.make)(&mut options);
    options.chosen
}

/// Options given by name, each taken once; what is left over is an error.
#[derive(Clone, Default)]
pub struct Options {
    numbers: IndexMap<String, f64>,
    choices: IndexMap<String, Choice>,
    /// What was asked for, in its order.
    taken: Vec<Setting>,
    /// The choices that were asked for.
    chosen: Vec<&'static str>,
}

impl Options {
    /// The numbers, in the order in which they were added.
    pub fn numbers(&self) -> impl Iterator<Item = (&str, f64)> {
        self.numbers.iter().map(|(name, value)| (name.as_str(), *value))
    }

    /// Adds an option.
    pub fn set(&mut self, name: &str, value: f64) {
        self.numbers.insert(name.to_owned(), value);
    }

    /// Adds a choice from a table.
    pub fn choose(&mut self, name: &str, choice: Choice) {
        self.choices.insert(name.to_owned(), choice);
    }

    /// Takes a number out, or the default; an error outside `domain`.
    pub fn take(
        &mut self,
        name: &str,
        domain: RangeInclusive<f64>,
        default: f64,
    ) -> Result<f64, Fault> {
        let value = self.numbers.shift_remove(name).unwrap_or(default);
        let (low, high) = (*domain.start(), *domain.end());
        let contains = domain.contains(&value);
        self.taken.push(Setting { name: name.to_owned(), default, domain });
        if contains {
            return Ok(value);
        }
        Err(fault!(BAD_OPTION, "`{name}` is {value}, outside {low} to {high}"))
    }

    /// Takes a whole number out, or the default.
    pub fn take_whole(
        &mut self,
        name: &str,
        domain: RangeInclusive<f64>,
        default: f64,
    ) -> Result<usize, Fault> {
        let value = self.take(name, domain, default)?;
        if value.fract() != 0.0 {
            return Err(fault!(BAD_OPTION, "`{name}` is {value}, which is not a whole number"));
        }
        Ok(value as usize)
    }

    /// Takes a choice out, if one was given.
    pub fn take_choice(&mut self, name: &'static str) -> Option<Choice> {
        self.chosen.push(name);
        self.choices.shift_remove(name)
    }

    /// An error that names the first option that was not read.
    pub fn finish(self) -> Result<(), Fault> {
        let Some(name) = self.numbers.keys().chain(self.choices.keys()).next() else {
            return Ok(());
        };
        let known = self.taken.iter().map(|setting| setting.name.as_str());
        // A setting may also be a choice: a number or a name.
        let known: IndexSet<&str> = known.chain(self.chosen.iter().copied()).collect();
        let fault = fault!(BAD_OPTION, "unknown option `{name}`")
            .help_if(suggest::did_you_mean(name, known.iter().copied()));
        Err(match known.is_empty() {
            true => fault.help("there are no options"),
            false => {
                fault.help(format!("known: {}", known.into_iter().collect::<Vec<_>>().join(", ")))
            }
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_choice_is_a_name_with_settings() {
        for (text, label) in [
            ("sbx", "sbx"),
            (" sbx ( eta = 5 , probability=1 ) ", "sbx(eta = 5, probability = 1)"),
            ("My.own()", "My.own"),
        ] {
            assert_eq!(Choice::parse(text).map(|choice| choice.label()), Ok(label.to_owned()));
        }
        for text in ["sbx(eta)", "sbx(eta = 5", "sbx(eta = many)"] {
            assert_eq!(
                Choice::parse(text).map(|choice| choice.label()).unwrap_err().code,
                BAD_OPTION
            );
        }
    }

    #[test]
    fn what_is_not_known_or_not_in_its_domain_is_refused() {
        let mut options = Options::default();
        options.set("etta", 3.0);
        options.set("rate", f64::NAN);
        assert_eq!(options.take("eta", 0.0..=1000.0, 15.0), Ok(15.0));
        assert!(options.take("rate", 0.0..=1.0, 0.5).unwrap_err().message.contains("NaN"));
        let fault = options.finish().unwrap_err();
        assert_eq!(fault.message, "unknown option `etta`");
        assert_eq!(fault.helps, ["did you mean `eta`?", "known: eta, rate"]);
    }
}
