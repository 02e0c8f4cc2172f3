//! Rules of the language that a class keeps or breaks by itself, whatever is made of it.
//!
//! [`check`] follows a class to all classes that take part in it and checks each by its text and by
//! what the names in it mean, before anything is instantiated. What depends on modifications is
//! left to instantiation. Names that mean nothing are reported by [`check_class`] alone: instantiation
//! finds those of what it makes.

mod access;
mod arguments;
mod behaviour;
mod clocks;
mod compatibility;
mod connections;
mod connectors;
mod declared_types;
mod elements;
mod imports;
mod inherited_classes;
mod inputs;
mod lineage;
mod modifications;
mod names;
mod operators;
mod participants;
mod prefixes;
mod restrictions;
pub(super) mod scope;
mod types;
mod unknown;
mod usage;
mod variability;
mod visible_elements;

use super::library::{ClassId, Library};
use crate::diag::Diagnostic;
use scope::Scope;

/// What is wrong with a class and with those that take part in it; the errors of one class
/// follow each other.
pub(crate) fn check(library: &Library, class: ClassId) -> Vec<Diagnostic> {
    let mut errors = Vec::new();
    for class in participants::of(Scope { library, class }) {
        check_one(class, &mut errors);
    }
    judged(library, errors)
}

/// The imports of what does not exist, in a class and those that take part in it.
pub(crate) fn missing_imports(library: &Library, class: ClassId) -> Vec<Diagnostic> {
    let mut warnings = Vec::new();
    for class in participants::of(Scope { library, class }) {
        imports::warn_of_missing(class, &mut warnings);
    }
    warnings
}

/// What is wrong with one class, whatever takes part in it, names that mean nothing included.
pub(crate) fn check_class(library: &Library, class: ClassId) -> Vec<Diagnostic> {
    let mut errors = Vec::new();
    let class = Scope { library, class };
    unknown::check(class, &mut errors);
    check_rules(class, &mut errors);
    types::check_with_values(class, &mut errors);
    judged(library, errors)
}

/// Warnings are errors for a library that is to conform in all.
fn judged(library: &Library, found: Vec<Diagnostic>) -> Vec<Diagnostic> {
    match library.is_strict() {
        true => found.into_iter().map(Diagnostic::error).collect(),
        false => found,
    }
}

fn check_one(class: Scope<'_>, errors: &mut Vec<Diagnostic>) {
    check_rules(class, errors);
    imports::warn_of_missing(class, errors);
    types::check(class, errors);
}

/// The rules that are the same for a class by itself and for one that takes part in a model.
fn check_rules(class: Scope<'_>, errors: &mut Vec<Diagnostic>) {
    elements::check(class, errors);
    restrictions::check(class, errors);
    connectors::check(class, errors);
    operators::check(class, errors);
    prefixes::check(class, errors);
    imports::check(class, errors);
    behaviour::check(class, errors);
    connections::check(class, errors);
    access::check(class, errors);
    modifications::check(class, errors);
    inherited_classes::check(class, errors);
    usage::check(class, errors);
}
