//! What names of a class meant in the versions of the libraries that it was written for: full names
//! in those libraries, which may no longer have such classes.

use super::conversion_rules::Conversions;
use super::{Class, ClassId, Library};
use crate::name::{Ident, Name};
use crate::syntax::ast::{ClassSpecifier, Extends, ImportKind};

/// The deepest chain of classes that stand for each other that is followed.
const MAX_DEPTH: usize = 20;

/// What a name meant.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) enum Meaning {
    /// A class of a library that is converted, by its old full name.
    Old(Name),
    /// A class that is loaded.
    Own(ClassId),
}

/// Finds meanings in the classes as they are written.
#[derive(Clone, Copy)]
pub(super) struct OldNames<'a> {
    pub(super) library: &'a Library,
    pub(super) conversions: &'a Conversions,
}

impl<'a> OldNames<'a> {
    fn class(self, id: ClassId) -> &'a Class {
        self.library.read(id)
    }

    /// What the name of a class means in a class.
    pub(super) fn meaning(self, scope: ClassId, name: &Name) -> Option<Meaning> {
        self.found(Some(scope), name, true, 0)
    }

    fn found(
        self,
        scope: Option<ClassId>,
        name: &Name,
        inherited: bool,
        depth: usize,
    ) -> Option<Meaning> {
        let (first, rest) = name.parts.split_first()?;
        if depth > MAX_DEPTH {
            return None;
        }
        let mut scope = scope.filter(|_| !name.global);
        let mut inherited = inherited;
        while let Some(at) = scope {
            let class = self.class(at);
            if let Some(member) = self.member(at, *first, inherited, depth) {
                return self.inner(member, rest, depth);
            }
            if let Some(full) = self.imported(class, *first) {
                return self.found(None, &joined(&full, rest), true, depth + 1);
            }
            inherited = true;
            scope = class.parent.filter(|_| !class.definition.encapsulated);
        }
        if self.conversions.iter().any(|(library, _)| library == first) {
            return Some(Meaning::Old(Name::new(name.parts.iter().copied())));
        }
        let root = self.library.roots.get(first).copied()?;
        self.inner(Meaning::Own(root), rest, depth)
    }

    /// What an import of a class brings under a name.
    fn imported(self, class: &Class, name: Ident) -> Option<Name> {
        class.imports.iter().find_map(|import| match import {
            ImportKind::Qualified(full) => (full.last() == Some(name)).then(|| full.clone()),
            ImportKind::Renaming(alias, full) => (*alias == name).then(|| full.clone()),
            ImportKind::Group(package, names) => names.contains(&name).then(|| package.child(name)),
            ImportKind::Unqualified(package) => {
                let full = package.child(name);
                self.is_known(&full).then_some(full)
            }
        })
    }

    /// Whether there is a class of a full name, converted where that must be; rules may also be about
    /// a class that another one of the library inherits.
    fn is_known(self, full: &Name) -> bool {
        let rules = self.conversions.iter().find(|(library, _)| full.first() == Some(*library));
        if rules.is_some_and(|(_, rules)| rules.mentions(full)) {
            return true;
        }
        let new = rules.and_then(|(_, rules)| rules.class(full));
        self.library.find(new.as_ref().unwrap_or(full)).is_some()
    }

    /// What a class declares or inherits under a name.
    fn member(self, id: ClassId, name: Ident, inherited: bool, depth: usize) -> Option<Meaning> {
        if let Some(child) = self.class(id).child(name) {
            return Some(Meaning::Own(child));
        }
        match inherited {
            true => self.inherited(id, name, depth),
            false => None,
        }
    }

    /// What a class inherits under a name.
    fn inherited(self, id: ClassId, name: Ident, depth: usize) -> Option<Meaning> {
        if depth > MAX_DEPTH {
            return None;
        }
        self.bases(id, depth + 1).into_iter().find_map(|base| match base {
            Meaning::Own(base) if base == id => None,
            Meaning::Own(base) => self.member(base, name, true, depth + 1),
            Meaning::Old(base) => {
                let full = base.child(name);
                self.is_known(&full).then_some(Meaning::Old(full))
            }
        })
    }

    fn inner(self, mut found: Meaning, path: &[Ident], depth: usize) -> Option<Meaning> {
        for part in path {
            found = match found {
                Meaning::Old(package) => Meaning::Old(package.child(*part)),
                Meaning::Own(id) => self.member(id, *part, true, depth + 1)?,
            };
        }
        Some(found)
    }

    /// What a class extends or is short for.
    fn bases(self, id: ClassId, depth: usize) -> Vec<Meaning> {
        let class = self.class(id);
        if let ClassSpecifier::Short(short) = &class.definition.specifier {
            let found = self.found(class.parent, &short.target.name, true, depth + 1);
            return found.into_iter().collect();
        }
        let extends: &[Extends] = &class.extends;
        let found = |one: &Extends| self.found(Some(id), &one.base.name, false, depth + 1);
        extends.iter().filter_map(found).chain(self.replaced_at(id, depth)).collect()
    }

    /// The inherited class that `redeclare model extends M` replaces and extends (MLS §7.3.1).
    pub(super) fn replaced(self, id: ClassId) -> Option<Meaning> {
        self.replaced_at(id, 0)
    }

    fn replaced_at(self, id: ClassId, depth: usize) -> Option<Meaning> {
        let class = self.class(id);
        let ClassSpecifier::Long(long) = &class.definition.specifier else { return None };
        long.class_extends.as_ref()?;
        let (parent, name) = (class.parent?, class.name.last()?);
        self.inherited(parent, name, depth)
    }

    /// The old classes that a class of the user comes from: inheritance ends at the library
    /// (MLS §18.8.3).
    pub(super) fn old_bases(self, meaning: &Meaning) -> Vec<Name> {
        let mut found = Vec::new();
        self.collect_bases(meaning, 0, &mut found);
        found
    }

    fn collect_bases(self, meaning: &Meaning, depth: usize, found: &mut Vec<Name>) {
        match meaning {
            Meaning::Old(name) => found.push(name.clone()),
            Meaning::Own(id) if depth < MAX_DEPTH => {
                for base in self.bases(*id, 0) {
                    self.collect_bases(&base, depth + 1, found);
                }
            }
            Meaning::Own(_) => {}
        }
    }

    /// The type of a component that a class declares or inherits from classes of the user.
    pub(super) fn component(self, id: ClassId, name: Ident) -> Option<Meaning> {
        self.declared_component(id, name, 0)
    }

    fn declared_component(self, id: ClassId, name: Ident, depth: usize) -> Option<Meaning> {
        if let Some((_, clause, _)) = self.class(id).component_element(name) {
            return self.meaning(id, &clause.type_specifier.name);
        }
        if depth > MAX_DEPTH {
            return None;
        }
        self.bases(id, 0).into_iter().find_map(|base| match base {
            Meaning::Own(base) => self.declared_component(base, name, depth + 1),
            Meaning::Old(_) => None,
        })
    }

    /// Whether a class declares or inherits such a component from classes of the user.
    pub(super) fn has_component(self, id: ClassId, name: Ident) -> bool {
        self.declares_component(id, name, 0)
    }

    fn declares_component(self, id: ClassId, name: Ident, depth: usize) -> bool {
        self.class(id).component_element(name).is_some()
            || depth < MAX_DEPTH
                && self.bases(id, 0).into_iter().any(|base| match base {
                    Meaning::Own(base) => self.declares_component(base, name, depth + 1),
                    Meaning::Old(_) => false,
                })
    }
}

fn joined(name: &Name, rest: &[Ident]) -> Name {
    Name::new(name.parts.iter().chain(rest).copied())
}
