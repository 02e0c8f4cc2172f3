//! What the name of a type means: a class, or a predefined type.

use crate::flatten::ids::ScopeId;
use crate::name::Ident;

/// What the name of a type means.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Type {
    /// A class in its enclosing scope.
    Class(ScopeId),
    /// A predefined type (MLS §4.9).
    Predefined(Predefined),
}

/// The predefined types.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Predefined {
    Real,
    Integer,
    Boolean,
    String,
    /// `StateSelect` (MLS §4.9.7.1).
    StateSelect,
    /// `AssertionLevel` (MLS §8.3.7).
    AssertionLevel,
    /// `ExternalObject` (MLS §12.9.7).
    ExternalObject,
    /// `Clock` (MLS §16.3).
    Clock,
}

impl Predefined {
    pub(crate) fn named(name: Ident) -> Option<Predefined> {
        match name.as_str() {
            "Real" => Some(Predefined::Real),
            "Integer" => Some(Predefined::Integer),
            "Boolean" => Some(Predefined::Boolean),
            "String" => Some(Predefined::String),
            "StateSelect" => Some(Predefined::StateSelect),
            "AssertionLevel" => Some(Predefined::AssertionLevel),
            "ExternalObject" => Some(Predefined::ExternalObject),
            "Clock" => Some(Predefined::Clock),
            _ => None,
        }
    }

    /// Whether no class can have its name (MLS §4.9).
    pub(crate) fn is_reserved(self) -> bool {
        use Predefined::{Boolean, Integer, Real, String};
        matches!(self, Real | Integer | Boolean | String)
    }
}

/// The attributes of the predefined types (MLS §4.9).
pub const ATTRIBUTES: [&str; 10] = [
    "quantity",
    "unit",
    "displayUnit",
    "min",
    "max",
    "start",
    "fixed",
    "nominal",
    "unbounded",
    "stateSelect",
];
