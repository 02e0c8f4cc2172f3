//! Definitions of units that a file brings along (`UnitDefinitions` of FMI, `Units` of SSP).

use super::{Unit, written};
use std::collections::BTreeMap;

/// Relative difference of factors that are the same but for the digits that a file writes.
const WRITTEN: f64 = 1e-5;

/// Units by their names, as a file defines them.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Definitions(BTreeMap<String, Unit>);

impl Definitions {
    /// Adds a unit; the first one of a name counts.
    pub fn add(&mut self, name: &str, unit: Unit) {
        self.0.entry(name.trim().to_owned()).or_insert(unit);
    }

    /// The definition of the file.
    pub fn defined(&self, name: &str) -> Option<Unit> {
        self.0.get(name.trim()).copied()
    }

    /// What a name stands for: the unit that is known by it, else that of the file.
    pub fn find(&self, name: &str) -> Option<Unit> {
        written(name).or_else(|| self.defined(name))
    }

    /// A sentence about a name that the file defines otherwise than it is known; `whose` is the file.
    pub fn contradiction(&self, name: &str, whose: &str) -> Option<String> {
        let (known, defined) = (written(name)?, self.defined(name)?);
        if known.is_near(defined, WRITTEN) {
            return None;
        }
        Some(format!(
            "{whose} defines the unit `{name}` as {}; it is used as {}",
            defined.in_words(),
            known.in_words()
        ))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_that_are_not_known_are_those_of_the_file() {
        let unit = |name: &str, factor: f64| Unit { factor, ..written(name).expect("a unit") };
        let mut own = Definitions::default();
        own.add("hp", unit("W", 745.7));
        own.add("bar", unit("Pa", 1000.0));
        own.add("deg", unit("rad", 0.017_453_3));
        own.add("degC", Unit { offset: 273.0, ..unit("K", 1.0) });
        assert_eq!(own.find("hp").map(|unit| unit.factor), Some(745.7));
        assert_eq!(own.find("bar").map(|unit| unit.factor), Some(1e5));
        assert_eq!(own.find("ox"), None);
        let said = |name: &str| own.contradiction(name, "the FMU");
        assert_eq!((said("hp"), said("deg"), said("W")), (None, None, None));
        assert_eq!(
            said("bar").as_deref(),
            Some(
                "the FMU defines the unit `bar` as 1000 kg/(m.s2); it is used as 100000 kg/(m.s2)"
            )
        );
        assert!(said("degC").is_some_and(|text| text.contains("1 K from 273 K on; it is")));
    }
}
