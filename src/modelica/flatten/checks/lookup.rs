//! What names of classes mean as the classes are declared (MLS §5.3), whatever modifications may
//! make of them: simple names (§5.3.1), those with dots (§5.3.2), global (§5.3.3) and imported
//! ones (§5.3.4, §13.2).

use crate::flatten::library::{ClassId, Library};
use crate::flatten::lookup::types::Predefined;
use crate::name::{Ident, Name};
use crate::syntax::ast::{ClassSpecifier, ImportKind};
use rustc_hash::FxHashSet;
use std::sync::Arc;

/// What the name of a type means.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Type {
    /// A class of the library.
    Class(ClassId),
    /// A predefined type (MLS §4.9).
    Predefined(Predefined),
}

/// Classes whose inherited elements were searched already: a class that extends itself ends there.
type Visited = FxHashSet<ClassId>;

/// The most base classes in which a name is searched.
const MAX_BASES: usize = 10_000;

impl Library {
    /// What a name means in the text of a class.
    pub fn meaning(&self, scope: Option<ClassId>, name: &Name) -> Option<Type> {
        self.meaning_with(scope, name, &mut Visited::default())
    }

    fn meaning_with(
        &self,
        scope: Option<ClassId>,
        name: &Name,
        visited: &mut Visited,
    ) -> Option<Type> {
        let (first, rest) = name.parts.split_first()?;
        let predefined = Predefined::named(*first).filter(|_| rest.is_empty());
        if let Some(reserved) = predefined.filter(|predefined| predefined.is_reserved()) {
            return Some(Type::Predefined(reserved));
        }
        let found = match scope {
            Some(scope) if !name.global => self.simple(scope, *first, visited),
            _ => self.root(*first),
        };
        let Some(mut class) = found else { return predefined.map(Type::Predefined) };
        for part in rest {
            class = self.member(class, *part, &mut Visited::default())?;
        }
        Some(Type::Class(class))
    }

    /// A simple name: declared, inherited or imported by the class or by one that encloses it.
    fn simple(&self, scope: ClassId, name: Ident, visited: &mut Visited) -> Option<ClassId> {
        let mut scope = Some(scope);
        while let Some(id) = scope {
            let found = self.member(id, name, visited).or_else(|| self.imported(id, name));
            if found.is_some() {
                return found;
            }
            let class = self.class(id);
            if class.definition.encapsulated {
                break;
            }
            scope = class.parent;
        }
        self.root(name)
    }

    /// A class that another declares or inherits.
    fn member(&self, class: ClassId, name: Ident, visited: &mut Visited) -> Option<ClassId> {
        let class = self.fork(class);
        if let Some(own) = self.class(class).child(name) {
            return Some(own);
        }
        if visited.len() >= MAX_BASES || !visited.insert(class) {
            return None;
        }
        self.declared_bases(class).iter().find_map(|base| self.member(*base, name, visited))
    }

    /// The classes that a class extends, or that it is short for; unknown ones left out.
    pub(crate) fn declared_bases(&self, class: ClassId) -> Arc<[ClassId]> {
        self.bases_once(class, || self.find_bases(class))
    }

    fn find_bases(&self, class: ClassId) -> Vec<ClassId> {
        let found = self.class(class);
        // What the class itself inherits does not count (MLS §5.6.1.4).
        let mut own: Visited = [class].into_iter().collect();
        let mut class_of = |scope, name: &Name| match self.meaning_with(scope, name, &mut own) {
            Some(Type::Class(base)) if base != class => Some(base),
            _ => None,
        };
        match &found.definition().specifier {
            ClassSpecifier::Short(short) => {
                class_of(found.parent, &short.target.name).into_iter().collect()
            }
            _ => found
                .extends
                .iter()
                .filter_map(|extends| class_of(Some(class), &extends.base.name))
                .collect(),
        }
    }

    fn imported(&self, class: ClassId, name: Ident) -> Option<ClassId> {
        let global = |name: &Name| match self.meaning(None, name) {
            Some(Type::Class(found)) => Some(found),
            _ => None,
        };
        let imports = self.class(class).imports();
        let named = imports.iter().find_map(|import| match import {
            ImportKind::Qualified(target) if target.last() == Some(name) => global(target),
            ImportKind::Renaming(own, target) if *own == name => global(target),
            ImportKind::Group(package, names) if names.contains(&name) => {
                global(&package.child(name))
            }
            _ => None,
        });
        named.or_else(|| {
            imports.iter().find_map(|import| match import {
                ImportKind::Unqualified(package) => global(&package.child(name)),
                _ => None,
            })
        })
    }
}
