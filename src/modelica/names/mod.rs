//! Lookup of names (MLS §5.3): simple names (§5.3.1), names with dots (§5.3.2), global names (§5.3.3)
//! and imported ones (§5.3.4, §13.2).
//!
//! The rules are written here, once. What a class declares or inherits under a name is answered by a view
//! of the classes that implements [`Names`]: classes as they are declared, classes of an instance with
//! all that modifies them, and classes as earlier versions of libraries had them.

use crate::diag::suggest;
use crate::name::{Ident, Name};
use crate::syntax::ast::ImportKind;

/// A view of classes in which names are looked up.
pub(crate) trait Names {
    /// A class in whose text names are written.
    type Class: Copy;
    /// What a name means.
    type Meaning;
    /// Why a lookup fails; [`std::convert::Infallible`] where it cannot.
    type Fault;

    /// What a class declares or inherits under a name.
    ///
    /// # Errors
    /// What the view finds wrong with the class.
    fn element(&mut self, class: Self::Class, name: Ident) -> Lookup<Self>;

    /// The import clauses of a class.
    fn imports(&self, class: Self::Class) -> &[ImportKind];

    /// The class around another one whose names that one sees: none for an encapsulated class.
    fn around(&self, class: Self::Class) -> Option<Self::Class>;

    /// What a name means at the top level.
    ///
    /// # Errors
    /// What the view finds wrong.
    fn top(&mut self, name: Ident) -> Lookup<Self>;

    /// What a name means inside what another name means: nothing, if a meaning is the end of a path.
    ///
    /// # Errors
    /// What the view finds wrong.
    fn inside(&mut self, _of: Self::Meaning, _name: Ident) -> Lookup<Self> {
        Ok(None)
    }

    /// What a name means that an unqualified import takes from a package.
    ///
    /// # Errors
    /// What the view finds wrong.
    fn imported_from(&mut self, package: &Name, name: Ident) -> Lookup<Self> {
        self.global(&package.child(name))
    }

    /// A simple name: declared, inherited or imported by a class or by one that encloses it.
    ///
    /// # Errors
    /// What the view finds wrong.
    fn simple(&mut self, class: Option<Self::Class>, name: Ident) -> Lookup<Self> {
        let mut class = class;
        while let Some(scope) = class {
            if let Some(found) = self.element(scope, name)? {
                return Ok(Some(found));
            }
            if let Some(found) = self.imported(scope, name)? {
                return Ok(Some(found));
            }
            class = self.around(scope);
        }
        self.top(name)
    }

    /// What the import clauses of a class give to a name, the named imports first.
    ///
    /// # Errors
    /// What the view finds wrong.
    fn imported(&mut self, class: Self::Class, name: Ident) -> Lookup<Self> {
        let Imported { named, packages } = Imported::by(self.imports(class), name);
        for target in named {
            if let Some(found) = self.global(&target)? {
                return Ok(Some(found));
            }
        }
        for package in packages {
            if let Some(found) = self.imported_from(&package, name)? {
                return Ok(Some(found));
            }
        }
        Ok(None)
    }

    /// A name with dots, looked up at the top level.
    ///
    /// # Errors
    /// What the view finds wrong.
    fn global(&mut self, name: &Name) -> Lookup<Self> {
        let Some((first, rest)) = name.parts.split_first() else { return Ok(None) };
        let found = self.top(*first)?;
        self.followed(found, rest)
    }

    /// The rest of a name with dots, inside what its first part means.
    ///
    /// # Errors
    /// What the view finds wrong.
    fn followed(&mut self, first: Option<Self::Meaning>, rest: &[Ident]) -> Lookup<Self> {
        let mut found = first;
        for part in rest {
            let Some(of) = found else { return Ok(None) };
            found = self.inside(of, *part)?;
        }
        Ok(found)
    }
}

/// What a lookup finds.
pub(crate) type Lookup<N> = Result<Option<<N as Names>::Meaning>, <N as Names>::Fault>;

/// What import clauses may give to a name.
struct Imported {
    /// The full names that named imports give to it.
    named: Vec<Name>,
    /// The packages from which everything is imported.
    packages: Vec<Name>,
}

impl Imported {
    fn by(imports: &[ImportKind], name: Ident) -> Imported {
        let (mut named, mut packages) = (Vec::new(), Vec::new());
        for import in imports {
            match import {
                ImportKind::Qualified(target) if target.last() == Some(name) => {
                    named.push(target.clone());
                }
                ImportKind::Renaming(own, target) if *own == name => named.push(target.clone()),
                ImportKind::Group(package, names) if names.contains(&name) => {
                    named.push(package.child(name));
                }
                ImportKind::Unqualified(package) => packages.push(package.clone()),
                _ => {}
            }
        }
        Imported { named, packages }
    }
}

/// The full name nearest to one that means nothing, as a help. `candidates` are the names in a package;
/// of the empty name those in scope.
pub(crate) fn suggestion(
    name: &Name,
    mut candidates: impl FnMut(&Name) -> Vec<Ident>,
) -> Option<String> {
    let mut name = name.clone();
    while let Some(last) = name.last() {
        let package = name.parent();
        let known = candidates(&package);
        if known.is_empty() && !package.parts.is_empty() {
            // The package is not there either.
            name = package;
            continue;
        }
        let near = suggest::nearest(last.as_str(), known.iter().map(|known| known.as_str()))?;
        return Some(format!("did you mean `{}`?", package.child(Ident::new(near))));
    }
    None
}
