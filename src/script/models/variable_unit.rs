//! The units of variables.

use crate::fmi::description::Variable;
use crate::fmi::import::Imported;
use crate::units::Definitions;

/// The unit of a variable of a model.
#[derive(Debug, Clone, Default, PartialEq)]
pub(crate) struct VariableUnit {
    /// Empty where the model gives none.
    pub(crate) symbol: String,
    /// Whether the variable is a difference, whose unit converts without an offset.
    pub(crate) is_relative: bool,
    /// What names stand for that are not known, where the model says so.
    pub(crate) definitions: Definitions,
}

impl VariableUnit {
    /// That of time.
    pub(crate) fn second() -> VariableUnit {
        VariableUnit { symbol: "s".to_owned(), ..VariableUnit::default() }
    }

    /// That of a variable of a functional mock-up unit.
    pub(crate) fn of_imported(unit: &Imported, variable: &Variable) -> VariableUnit {
        let own = unit.description.attributes_of(variable);
        VariableUnit {
            symbol: own.unit.unwrap_or_default(),
            is_relative: own.is_relative.unwrap_or(false),
            definitions: unit.description.unit_definitions(),
        }
    }

    /// Sentences about names of units that the description defines otherwise than they are known.
    pub(crate) fn contradictions(&self, names: [&str; 2]) -> Vec<String> {
        let said = |name: &str| self.definitions.contradiction(name, "the FMU");
        names.into_iter().filter_map(said).collect()
    }
}
