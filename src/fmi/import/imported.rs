//! A unit that was read, with the processes in which it runs.

use super::layout::{Layout, Place};
use super::plan::InterfaceKind;
use super::pool::Pool;
use crate::Description;
use crate::description::{Causality, Initial, Variability, Variable};

/// A unit that was read, with the processes in which it runs.
#[derive(Debug)]
pub struct Imported {
    /// The name of its file.
    pub file: String,
    /// What it says of itself.
    pub description: Description,
    /// Whether it brings files beside its library.
    pub has_resources: bool,
    /// Who integrates.
    pub kind: InterfaceKind,
    /// Where it runs.
    pub pool: Pool,
}

impl Imported {
    /// Its scalars; `given` are values of structural parameters.
    ///
    /// # Errors
    /// Sizes of arrays that are not known.
    pub fn layout(&self, given: &[(Place, f64)]) -> Result<Layout, String> {
        Layout::of(&self.description, given)
    }

    /// The variable of a scalar.
    pub fn variable(&self, place: Place) -> &Variable {
        &self.description.variables[place.variable]
    }
}

/// Whether a variable is a parameter, a structural one included.
pub fn is_parameter(variable: &Variable) -> bool {
    matches!(variable.causality, Causality::Parameter | Causality::StructuralParameter)
}

/// Why a value cannot be given to a variable before the initialization, as the end of a sentence.
pub fn why_not_set(variable: &Variable) -> Option<&'static str> {
    if variable.variability == Variability::Constant {
        return Some("is a constant of the FMU");
    }
    match variable.causality {
        Causality::Parameter | Causality::StructuralParameter | Causality::Input => None,
        Causality::CalculatedParameter => Some("follows from other parameters of the FMU"),
        _ => match variable.initial {
            Some(Initial::Exact) => None,
            Some(Initial::Approx) => {
                Some("has a start value that the FMU uses as a first guess only")
            }
            _ => Some("is computed by the FMU"),
        },
    }
}
