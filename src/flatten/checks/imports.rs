//! Import clauses (MLS §13.2).

use super::scope::Scope;
use crate::diag::Diagnostic;
use crate::fault;
use crate::flatten::errors::ILLEGAL_IMPORT;
use crate::name::{Ident, Name};
use crate::source::Span;
use crate::syntax::ast::{Element, Import, ImportKind, Restriction};
use rustc_hash::FxHashMap;

/// Checks the import clauses of a class.
pub(super) fn check(class: Scope<'_>, errors: &mut Vec<Diagnostic>) {
    let mut named: FxHashMap<Ident, (Name, Span)> = FxHashMap::default();
    for (_, element) in class.elements() {
        let Element::Import(import) = element else { continue };
        errors.extend(from_other_than_package(class, import));
        for (name, target) in names(&import.kind) {
            let known = named.insert(name, (target.clone(), import.span));
            if let Some((other, first)) = known
                && other != target
            {
                errors.push(
                    fault!(ILLEGAL_IMPORT, "`{}` imports two things as `{name}`", class.name();
                        help: "give one of them another name, `import Other = A.B;`")
                    .at(import.span)
                    .related(first, "the other import"),
                );
            }
        }
    }
}

/// The names that an import declares and what they mean; none for an unqualified one.
fn names(kind: &ImportKind) -> Vec<(Ident, Name)> {
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

/// What is imported by its name is a package or an element of one, or a class at the top level;
/// what is imported from is a package.
fn from_other_than_package(class: Scope<'_>, import: &Import) -> Option<Diagnostic> {
    let global = |name: &Name| Name { global: true, parts: name.parts.clone() };
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
    (!is_package(found)).then(|| {
        fault!(ILLEGAL_IMPORT, "`{}` is a {}, and only packages can be imported from",
            found.name(), super::word(found.restriction());
            help: "move what is imported into a package")
        .at(import.span)
    })
}

/// Old libraries write `class` for package.
fn is_package(class: Scope<'_>) -> bool {
    matches!(class.restriction(), Restriction::Package | Restriction::Class)
}
