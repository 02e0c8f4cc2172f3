//! The functions and operators of the language (MLS §3.7, §10.3, §10.4): one entry each, with its
//! arguments, the rules for type, shape, unit and variability of its value, and what it means.
//!
//! The interpreter, the checks of classes, flattening and the lowering of equations and functions
//! read these entries; none of them has a list of names. The mathematical functions of scalars,
//! with values, derivatives and domains, are those of
//! [`symbolic::function`](crate::symbolic::function). A function of arrays says with a [`Plan`] how
//! its elements are made: values, sizes and equations all follow from it.

mod arrays;
pub mod errors;
mod matrices;
mod operators;
mod plan;
mod reductions;
mod rules;
mod scalars;
#[cfg(test)]
mod tests;
mod values;

pub(crate) use arrays::concatenation;
pub use operators::{Clocked, Operator, StateOperator, Temporal};
pub(crate) use plan::PlanOf;
pub use plan::{Argument, Element, Elements, Pick, Plan};
pub use reductions::Reduction;
pub(crate) use rules::ArgumentShapes;
pub use rules::{Known, ShapeRule, TypeRule, VariabilityRule};
pub use scalars::each;

use errors::{UNKNOWN_FUNCTION, WRONG_ARGUMENTS};

use crate::diag::Fault;
use crate::fault;
use crate::symbolic::function::{self as mathematical, FunctionId, UnitRule};
use crate::value::Value;
use rustc_hash::FxHashMap;
use std::sync::LazyLock;

/// A function or an operator of the language.
#[derive(Debug)]
pub struct Builtin {
    /// Its name.
    pub name: &'static str,
    /// Names of its arguments, where a call may use them.
    pub inputs: &'static [&'static str],
    /// The fewest arguments it takes.
    pub least: usize,
    /// The most arguments it takes.
    pub most: usize,
    /// What it means.
    pub meaning: Meaning,
    /// The type of its value.
    pub value_type: TypeRule,
    /// The sizes of its value.
    pub shape: ShapeRule,
    /// The unit of its value.
    pub unit: UnitRule,
    /// How its value varies.
    pub variability: VariabilityRule,
    /// The section of the MLS that defines it.
    pub section: &'static str,
}

/// What a call means.
#[derive(Debug, Clone, Copy)]
pub enum Meaning {
    /// A function of scalars, element by element where arguments are arrays (MLS §12.4.6).
    Mathematical(FunctionId),
    /// An array whose elements are made one by one from those of the arguments.
    Plan(PlanOf, Known),
    /// A scalar made of all elements of an array.
    Reduction(Reduction),
    /// What needs more than the values of its arguments.
    Operator(Operator),
}

const FAMILIES: &[&[Builtin]] =
    &[arrays::FUNCTIONS, matrices::FUNCTIONS, reductions::FUNCTIONS, operators::OPERATORS];

static MATHEMATICAL: LazyLock<Vec<Builtin>> = LazyLock::new(|| {
    mathematical::functions()
        .flat_map(|(id, function)| {
            let names = std::iter::once(&function.name).chain(function.aliases);
            names.map(move |name| Builtin::mathematical(name, id))
        })
        .collect()
});

/// Entries of the families win over the mathematical functions: `max` takes arrays too.
static BY_NAME: LazyLock<FxHashMap<&'static str, &'static Builtin>> = LazyLock::new(|| {
    let own = FAMILIES.iter().flat_map(|family| family.iter());
    MATHEMATICAL.iter().chain(own).map(|entry| (entry.name, entry)).collect()
});

/// The function or operator of this name.
pub fn find(name: &str) -> Option<&'static Builtin> {
    BY_NAME.get(name).copied()
}

/// The operator of this name.
pub fn operator(name: &str) -> Option<Operator> {
    match find(name)?.meaning {
        Meaning::Operator(operator) => Some(operator),
        _ => None,
    }
}

/// Whether the language has a function or an operator of this name.
pub fn is_builtin(name: &str) -> bool {
    find(name).is_some()
}

/// Names of all functions and operators that have a value in scripts and functions, in a fixed
/// order.
pub fn names() -> impl Iterator<Item = &'static str> {
    let own = || FAMILIES.iter().flat_map(|family| family.iter());
    let scalars = MATHEMATICAL.iter().filter(move |f| !own().any(|own| own.name == f.name));
    own().chain(scalars).filter(|entry| !entry.is_model_only()).map(|entry| entry.name)
}

/// The value of a call with positional arguments.
///
/// # Errors
///
/// There is no such function, it is an operator, or the arguments are outside its domain.
pub fn call(name: &str, arguments: &[Value]) -> Result<Value, Fault> {
    match find(name) {
        Some(entry) => entry.value(arguments),
        None => Err(fault!(UNKNOWN_FUNCTION, "there is no function `{name}`")),
    }
}

impl Builtin {
    fn mathematical(name: &'static str, id: FunctionId) -> Builtin {
        let function = id.get();
        Builtin {
            name,
            inputs: &[],
            least: function.arity(),
            most: function.arity(),
            meaning: Meaning::Mathematical(id),
            value_type: function.result.into(),
            shape: ShapeRule::Elementwise,
            unit: function.unit,
            variability: VariabilityRule::OfArguments,
            section: function.section,
        }
    }

    /// An entry of one argument with a value of the same type and sizes; what differs is changed
    /// by the row.
    const fn new(name: &'static str, meaning: Meaning, section: &'static str) -> Builtin {
        Builtin {
            name,
            inputs: &[],
            least: 1,
            most: 1,
            meaning,
            value_type: TypeRule::As(0),
            shape: ShapeRule::As(0),
            unit: UnitRule::Unknown,
            variability: VariabilityRule::OfArguments,
            section,
        }
    }

    /// An entry of an array function.
    const fn planned(
        name: &'static str,
        (least, most): (usize, usize),
        plan: PlanOf,
        known: Known,
    ) -> Builtin {
        let entry = Builtin::new(name, Meaning::Plan(plan, known), "MLS §10.3");
        Builtin { least, most, shape: ShapeRule::Planned, ..entry }
    }

    /// Whether it is the operator with two outputs.
    pub(crate) fn is_spatial_distribution(&self) -> bool {
        matches!(self.meaning, Meaning::Operator(Operator::InTime(Temporal::SpatialDistribution)))
    }

    /// Whether it has a meaning in models only.
    pub(crate) fn is_model_only(&self) -> bool {
        matches!(self.meaning, Meaning::Operator(Operator::InTime(_)))
    }

    /// Whether functions may not call it (MLS §12.2).
    pub(crate) fn is_forbidden_in_functions(&self) -> bool {
        let is_name =
            matches!(self.meaning, Meaning::Operator(Operator::InTime(Temporal::InstanceName)));
        self.is_model_only() && !is_name
    }

    /// Whether it is a function of numbers (MLS §3.7.1, §3.7.3), which no other type has.
    pub(crate) fn is_numeric(&self) -> bool {
        matches!(self.meaning, Meaning::Mathematical(_))
    }

    /// Refuses a wrong number of arguments.
    ///
    /// # Errors
    ///
    /// The number is not within its bounds.
    pub fn check_count(&self, given: usize) -> Result<(), Fault> {
        if (self.least..=self.most).contains(&given) {
            return Ok(());
        }
        let expected = match (self.least, self.most) {
            (0, 0) => "no arguments".to_owned(),
            (1, 1) => "one argument".to_owned(),
            (least, most) if least == most => format!("{least} arguments"),
            (least, usize::MAX) => format!("at least {least} arguments"),
            (least, most) => format!("{least} to {most} arguments"),
        };
        Err(fault!(WRONG_ARGUMENTS, "`{}` takes {expected}, not {given}", self.name))
    }
}
