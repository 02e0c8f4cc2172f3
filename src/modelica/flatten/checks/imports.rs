//! Import clauses (MLS §13.2).

use super::scope::Scope;
use super::unknown::is_certain;
use super::visible_elements::{self, element};
use crate::diag::Diagnostic;
use crate::fault;
use crate::flatten::errors::ILLEGAL_IMPORT;
use crate::flatten::library::Library;
use crate::flatten::unknown;
use crate::name::{Ident, Name};
use crate::source::Span;
use crate::syntax::ast::{Element, Import, ImportKind, Restriction, Visibility};
use rustc_hash::FxHashMap;

/// Checks the import clauses of a class.
pub(crate) fn check(class: Scope<'_>, errors: &mut Vec<Diagnostic>) {
    let mut named: FxHashMap<Ident, (Name, Span)> = FxHashMap::default();
    for (_, element) in class.elements() {
        let Element::Import(import) = element else { continue };
        errors.extend(from_other_than_package(class, import));
        for (name, target) in named_by(&import.kind) {
            errors.extend(protected(class, &target, import.span));
            let known = named.insert(name, (target.clone(), import.span));
            if let Some((other, first)) = known
                && other != target
            {
                errors.push(
                    fault!(ILLEGAL_IMPORT, "`{}` imports two elements under the name \
                        `{name}`", class.name();
                        help: "rename one of them, `import Other = A.B;`")
                    .at(import.span)
                    .related(first, "the other import"),
                );
            }
        }
    }
}

/// What an import names that does not exist, and the part of the name that is not found. What a library
/// that is read in parts may have is left out.
pub(crate) fn missing(library: &Library, import: &ImportKind) -> Vec<(Name, usize)> {
    let targets: Vec<Name> = match import {
        ImportKind::Qualified(name)
        | ImportKind::Renaming(_, name)
        | ImportKind::Unqualified(name) => vec![name.clone()],
        ImportKind::Group(package, names) => {
            names.iter().map(|name| package.child(*name)).collect()
        }
    };
    let not_found = |target: Name| {
        let parts = library.parts_of_reference(None, &target);
        let at = parts.iter().position(Option::is_none)?;
        is_certain(library, &parts[..at]).then_some((target, at))
    };
    targets.into_iter().filter_map(not_found).collect()
}

/// The diagnostic for one of them in a class.
pub(crate) fn unknown(class: Scope<'_>, target: &Name, span: Span) -> Diagnostic {
    let relative = Name { global: false, parts: target.parts.clone() };
    let full = || {
        let package = class.class_named(&relative.parent())?;
        let name = target.last().filter(|name| element(package, *name).is_some())?;
        Some(package.name().child(name))
    };
    unknown::import(target, full(), class.library.suggestion(None, target), span)
}

/// Warns of imports of what does not exist: a model that does not use them can be simulated.
pub(crate) fn warn_of_missing(class: Scope<'_>, errors: &mut Vec<Diagnostic>) {
    for (_, element) in class.elements() {
        let Element::Import(import) = element else { continue };
        let missing = missing(class.library, &import.kind);
        errors.extend(
            missing.iter().map(|(target, _)| unknown(class, target, import.span).warning()),
        );
    }
}

/// The names that an import declares and what they mean; none for an unqualified one.
fn named_by(kind: &ImportKind) -> Vec<(Ident, Name)> {
    match kind {
        ImportKind::Qualified(target) => {
            target.last().into_iter().map(|name| (name, target.clone())).collect()
        }
        ImportKind::Renaming(name, target) => vec![(*name, target.clone())],
        ImportKind::Unqualified(_) => Vec::new(),
        ImportKind::Group(package, names) => {
            names.iter().map(|name| (*name, package.child(*name))).collect()
        }
    }
}

/// Whether an import of a class declares a name.
pub(crate) fn names(class: Scope<'_>, name: Ident) -> bool {
    let imports = class.library.class(class.class).imports();
    imports.iter().flat_map(named_by).any(|(own, _)| own == name)
}

/// The packages from which a class imports everything.
pub(crate) fn unqualified_packages(class: Scope<'_>) -> Vec<Scope<'_>> {
    let imports = class.library.class(class.class).imports();
    let packages = imports.iter().filter_map(|import| match import {
        ImportKind::Unqualified(package) => Some(global(package)),
        _ => None,
    });
    packages.filter_map(|package| class.class_named(&package)).collect()
}

fn global(name: &Name) -> Name {
    Name { global: true, parts: name.parts.clone() }
}

/// An import of a protected element.
fn protected(class: Scope<'_>, target: &Name, span: Span) -> Option<Diagnostic> {
    let package = class.class_named(&global(&target.parent()))?;
    let name = target.last()?;
    let found = element(package, name)?;
    (found.visibility == Visibility::Protected)
        .then(|| visible_elements::protected(name, package, span))
}

/// What is imported by its name is a package or an element of one, or a class at the top level;
/// what is imported from is a package.
fn from_other_than_package(class: Scope<'_>, import: &Import) -> Option<Diagnostic> {
    let package = match &import.kind {
        ImportKind::Qualified(target) | ImportKind::Renaming(_, target) => {
            if class.class_named(&global(target)).is_some_and(is_package) {
                return None;
            }
            target.parent()
        }
        ImportKind::Unqualified(package) | ImportKind::Group(package, _) => package.clone(),
    };
    if package.parts.is_empty() {
        return None;
    }
    let found = class.class_named(&global(&package))?;
    // Literals are imported from their enumeration; the specification speaks of packages alone.
    (!is_package(found) && !found.is_enumeration()).then(|| {
        fault!(ILLEGAL_IMPORT, "cannot import from `{}`: it is a {}, not a package",
            found.name(), found.restriction().keyword();
            help: "move the imported element into a package")
        .at(import.span)
    })
}

/// Old libraries write `class` for package.
fn is_package(class: Scope<'_>) -> bool {
    matches!(class.restriction(), Restriction::Package | Restriction::Class)
}
