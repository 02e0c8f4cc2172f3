//! What names of a class meant in the versions of the libraries that it was written for: full names
//! in those libraries, which may no longer have such classes.

use super::conversion_rules::Conversions;
use super::{Class, ClassId, Library};
use crate::name::{Ident, Name};
use crate::names::Names;
use crate::syntax::ast::{ClassSpecifier, Extends, ImportKind};
use std::convert::Infallible;

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

/// The classes at a depth of the search.
struct OldClasses<'a> {
    names: OldNames<'a>,
    /// The class whose inherited elements do not count: its base classes are looked up.
    own: Option<ClassId>,
    depth: usize,
}

impl Names for OldClasses<'_> {
    type Class = ClassId;
    type Meaning = Meaning;
    type Fault = Infallible;

    fn element(&mut self, class: ClassId, name: Ident) -> Result<Option<Meaning>, Infallible> {
        Ok(self.names.member(class, name, self.own != Some(class), self.depth))
    }

    fn imports(&self, class: ClassId) -> &[ImportKind] {
        &self.names.class(class).imports
    }

    fn around(&self, class: ClassId) -> Option<ClassId> {
        let class = self.names.class(class);
        class.parent.filter(|_| !class.definition.encapsulated)
    }

    fn top(&mut self, name: Ident) -> Result<Option<Meaning>, Infallible> {
        if self.names.conversions.iter().any(|(library, _)| *library == name) {
            return Ok(Some(Meaning::Old(name.into())));
        }
        Ok(self.names.library.roots.get(&name).copied().map(Meaning::Own))
    }

    fn inside(&mut self, of: Meaning, name: Ident) -> Result<Option<Meaning>, Infallible> {
        Ok(match of {
            Meaning::Old(package) => Some(Meaning::Old(package.child(name))),
            Meaning::Own(class) => self.names.member(class, name, true, self.depth + 1),
        })
    }

    fn global(&mut self, name: &Name) -> Result<Option<Meaning>, Infallible> {
        Ok(self.names.found(None, name, true, self.depth + 1))
    }

    fn imported_from(
        &mut self,
        package: &Name,
        name: Ident,
    ) -> Result<Option<Meaning>, Infallible> {
        let full = package.child(name);
        if self.names.is_known(&full) { self.global(&full) } else { Ok(None) }
    }
}

impl<'a> OldNames<'a> {
    fn class(self, id: ClassId) -> &'a Class {
        self.library.read(id)
    }

    /// What the name of a class means in a class.
    pub(super) fn meaning(self, scope: ClassId, name: &Name) -> Option<Meaning> {
        self.found(Some(scope), name, true, 0)
    }

    /// What a name means in a class; what that class itself inherits counts if `inherited`.
    fn found(
        self,
        scope: Option<ClassId>,
        name: &Name,
        inherited: bool,
        depth: usize,
    ) -> Option<Meaning> {
        let (first, rest) = name.parts.split_first().filter(|_| depth <= MAX_DEPTH)?;
        let scope = scope.filter(|_| !name.global);
        let own = scope.filter(|_| !inherited);
        let mut classes = OldClasses { names: self, own, depth };
        let Ok(found) = classes.simple(scope, *first);
        let Ok(found) = classes.followed(found, rest);
        found
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
