//! The predefined types and their attributes (MLS §4.9).

use crate::name::{Ident, Name};
use crate::value::EnumerationDefinition;
use std::sync::{Arc, LazyLock};

/// A type that the language defines.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Predefined {
    /// `Real`
    Real,
    /// `Integer`
    Integer,
    /// `Boolean`
    Boolean,
    /// `String`
    String,
    /// An enumeration, predefined or of the library.
    Enumeration(Arc<EnumerationDefinition>),
}

static STATE_SELECT: LazyLock<Arc<EnumerationDefinition>> =
    LazyLock::new(|| enumeration("StateSelect", &["never", "avoid", "default", "prefer", "always"]));
static ASSERTION_LEVEL: LazyLock<Arc<EnumerationDefinition>> =
    LazyLock::new(|| enumeration("AssertionLevel", &["warning", "error"]));

fn enumeration(name: &str, literals: &[&str]) -> Arc<EnumerationDefinition> {
    Arc::new(EnumerationDefinition {
        name: Name::from(Ident::new(name)),
        literals: literals.iter().map(|literal| Ident::new(literal)).collect(),
    })
}

impl Predefined {
    /// The predefined type of this name.
    pub(super) fn named(name: Ident) -> Option<Predefined> {
        Some(match name.as_str() {
            "Real" => Predefined::Real,
            "Integer" => Predefined::Integer,
            "Boolean" => Predefined::Boolean,
            "String" => Predefined::String,
            "StateSelect" => Predefined::Enumeration(STATE_SELECT.clone()),
            "AssertionLevel" => Predefined::Enumeration(ASSERTION_LEVEL.clone()),
            _ => return None,
        })
    }

    /// Its name.
    pub(super) fn name(&self) -> Name {
        match self {
            Predefined::Real => Ident::new("Real").into(),
            Predefined::Integer => Ident::new("Integer").into(),
            Predefined::Boolean => Ident::new("Boolean").into(),
            Predefined::String => Ident::new("String").into(),
            Predefined::Enumeration(definition) => definition.name.clone(),
        }
    }

    /// The attributes with what type each has, in the order of MLS §4.9.
    pub(super) fn attributes(&self) -> &'static [(&'static str, AttributeType)] {
        use AttributeType::{Boolean, Own, StateSelect, String};
        match self {
            Predefined::Real => &[
                ("quantity", String),
                ("unit", String),
                ("displayUnit", String),
                ("min", Own),
                ("max", Own),
                ("start", Own),
                ("fixed", Boolean),
                ("nominal", Own),
                ("unbounded", Boolean),
                ("stateSelect", StateSelect),
            ],
            Predefined::Integer | Predefined::Enumeration(_) => &[
                ("quantity", String),
                ("min", Own),
                ("max", Own),
                ("start", Own),
                ("fixed", Boolean),
            ],
            Predefined::Boolean | Predefined::String => {
                &[("quantity", String), ("start", Own), ("fixed", Boolean)]
            }
        }
    }
}

/// The type of an attribute.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum AttributeType {
    /// That of the variable.
    Own,
    /// `String`
    String,
    /// `Boolean`
    Boolean,
    /// `StateSelect`
    StateSelect,
}
