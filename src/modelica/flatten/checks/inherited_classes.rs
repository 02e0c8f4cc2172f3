//! Classes that a class declares and inherits under one name (MLS §7.1): they must be the same, or
//! the own one a redeclaration or an extension (MLS §7.3.1).

use super::scope::Scope;
use crate::diag::Diagnostic;
use crate::fault;
use crate::flatten::errors::DUPLICATE_ELEMENT;
use crate::syntax::ast::{ClassElement, ClassSpecifier, Element};
use crate::syntax::print;

/// Checks the classes that a class itself declares.
pub(crate) fn check(class: Scope<'_>, errors: &mut Vec<Diagnostic>) {
    // The standard library has 30 such classes: it is reported only in strict conformance checks.
    if !class.library.is_strict() {
        return;
    }
    let is_derived = class.elements().any(|(_, element)| matches!(element, Element::Extends(_)));
    if !is_derived {
        return;
    }
    for (_, nested) in class.class_elements() {
        let extends =
            matches!(&nested.class.specifier, ClassSpecifier::Long(l) if l.class_extends.is_some());
        if !nested.prefixes.redeclare && !extends {
            errors.extend(another(class, nested));
        }
    }
}

/// An inherited class of the same name with other contents.
fn another(class: Scope<'_>, nested: &ClassElement) -> Option<Diagnostic> {
    let name = nested.class.name;
    let own = class.own_class(name.node)?;
    let inherited = class.lineage().skip(1).find_map(|base| base.own_class(name.node))?;
    if inherited.class == own.class || is_same(own, inherited) {
        return None;
    }
    Some(
        fault!(DUPLICATE_ELEMENT, "`{}` declares a class `{}` and inherits another one",
            class.name(), name.node;
            help: "rename it, or write `redeclare` before it if the inherited one is replaceable")
        .at(name.span)
        .related(inherited.definition().name.span, "the inherited one"),
    )
}

/// Whether two classes have the same text.
fn is_same(one: Scope<'_>, other: Scope<'_>) -> bool {
    print::dense_class(one.definition()) == print::dense_class(other.definition())
}
