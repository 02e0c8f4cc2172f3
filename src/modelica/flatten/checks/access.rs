//! What names with dots may lead through (MLS §4.1, §5.3.2, §5.3.3).

use super::scope::Scope;
use super::visible_elements::{Found, element, protected};
use super::{imports, names};
use crate::diag::Diagnostic;
use crate::fault;
use crate::flatten::errors::{ILLEGAL_ACCESS, ILLEGAL_IMPORT};
use crate::flatten::library::BaseProperty;
use crate::name::Name;
use crate::source::Span;
use crate::syntax::ast::{Restriction, VariabilityPrefix, Visibility};

/// Checks every name with dots that a class writes.
pub(crate) fn check(class: Scope<'_>, errors: &mut Vec<Diagnostic>) {
    for written in names::of(class) {
        let unclear = unqualified(class, &written.name, written.span);
        errors.extend(unclear.or_else(|| path(class, &written)));
    }
}

/// A name that only unqualified imports make visible: one public element of one package
/// (MLS §5.3.1).
fn unqualified(class: Scope<'_>, name: &Name, span: Span) -> Option<Diagnostic> {
    let first = *name.parts.first().filter(|_| !name.global)?;
    for scope in std::iter::successors(Some(class), |scope| scope.around()) {
        if element(scope, first).is_some() || imports::names(scope, first) {
            return None;
        }
        let packages = imports::unqualified_packages(scope);
        let holders: Vec<_> = packages
            .iter()
            .filter_map(|package| Some((package, element(*package, first)?)))
            .collect();
        let is_public = |found: &Found| found.visibility == Visibility::Public;
        let public: Vec<_> = holders.iter().filter(|(_, found)| is_public(found)).collect();
        match (public.as_slice(), holders.as_slice()) {
            ([(a, _), (b, _), ..], _) if a.class != b.class => {
                return Some(
                    fault!(ILLEGAL_IMPORT, "`{first}` is imported from both `{}` and `{}`",
                        a.name(), b.name();
                        help: "import the intended one by name")
                    .at(span),
                );
            }
            ([], [(package, _), ..]) => {
                return Some(protected(first, *(*package), span));
            }
            ([], []) => {}
            _ => return None,
        }
    }
    None
}

/// What is wrong with a name whose first part means a class.
fn path(class: Scope<'_>, written: &names::Written) -> Option<Diagnostic> {
    let names::Written { name, span, .. } = written;
    let span = *span;
    let (first, rest) = name.parts.split_first()?;
    let start = Name { global: name.global, parts: vec![*first] };
    if !name.global && names::is_component(class, *first) {
        return None;
    }
    let mut inside = class.class_named(&start)?;
    let mut prefix = start;
    for part in rest {
        // A base may lie in a partial package, as in version 4.0.0 of the standard library: nothing
        // of that package becomes part of a model.
        if inside.definition().partial && !class.definition().partial && !written.is_base {
            return Some(
                fault!(ILLEGAL_ACCESS, "`{name}` accesses an element of `{}`, which is \
                    partial", inside.name();
                    help: "extend it and access the class that extends it")
                .at(span)
                .warning(),
            );
        }
        prefix = prefix.child(*part);
        let next = class.class_named(&prefix);
        let found = element(inside, *part).or_else(|| next.map(Found::in_own_file))?;
        if found.visibility == Visibility::Protected {
            return Some(protected(*part, inside, span));
        }
        if !found.encapsulated && !is_package_like(inside) {
            return Some(
                fault!(ILLEGAL_ACCESS, "`{name}` accesses an element of `{}`, which is not a \
                    package",
                    inside.name();
                    help: "declare `{part}` encapsulated, or move it into a package")
                .at(span)
                .warning(),
            );
        }
        inside = next?;
    }
    None
}

/// Whether a class contains only what a package may contain.
fn is_package_like(class: Scope<'_>) -> bool {
    if class.restriction() == Restriction::Package {
        return true;
    }
    let has_more = |class: Scope<'_>| {
        let only_constants = class.components().all(|component| {
            component.clause.type_prefixes.variability == Some(VariabilityPrefix::Constant)
        });
        !only_constants || class.sections().iter().any(super::restrictions::is_behaviour)
    };
    class.first(BaseProperty::NoPackage, has_more).is_none()
}
