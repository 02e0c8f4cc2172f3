//! Names of classes as these are declared (MLS §5.3), whatever modifications may make of them.

use crate::flatten::library::{ClassId, Library};
use crate::flatten::lookup::types::Predefined;
use crate::name::{Ident, Name};
use crate::names::Names;
use crate::syntax::ast::{ClassSpecifier, ImportKind};
use rustc_hash::FxHashSet;
use std::convert::Infallible;
use std::sync::Arc;

/// What the name of a type means.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Type {
    /// A class of the library.
    Class(ClassId),
    /// A predefined type (MLS §4.9).
    Predefined(Predefined),
}

/// Classes whose inherited elements were searched already: a class that extends itself ends there.
type Visited = FxHashSet<ClassId>;

/// The most base classes in which a name is searched.
const MAX_BASES: usize = 10_000;

/// The classes of a library by themselves.
struct DeclaredClasses<'a, 'v> {
    library: &'a Library,
    visited: &'v mut Visited,
}

impl Names for DeclaredClasses<'_, '_> {
    type Class = ClassId;
    type Meaning = Type;
    type Fault = Infallible;

    fn element(&mut self, class: ClassId, name: Ident) -> Result<Option<Type>, Infallible> {
        Ok(self.library.member(class, name, self.visited).map(Type::Class))
    }

    fn imports(&self, class: ClassId) -> &[ImportKind] {
        self.library.class(class).imports()
    }

    fn around(&self, class: ClassId) -> Option<ClassId> {
        self.library.around(class)
    }

    fn top(&mut self, name: Ident) -> Result<Option<Type>, Infallible> {
        let predefined = || Predefined::named(name).map(Type::Predefined);
        Ok(self.library.root(name).map(Type::Class).or_else(predefined))
    }

    fn inside(&mut self, of: Type, name: Ident) -> Result<Option<Type>, Infallible> {
        let Type::Class(class) = of else { return Ok(None) };
        let found = self.library.member(class, name, &mut Visited::default());
        Ok(found.map(Type::Class))
    }

    fn global(&mut self, name: &Name) -> Result<Option<Type>, Infallible> {
        Ok(self.library.meaning(None, name))
    }
}

impl Library {
    /// The class around another one whose names that one sees.
    pub(in crate::flatten) fn around(&self, class: ClassId) -> Option<ClassId> {
        let class = self.class(class);
        class.parent.filter(|_| !class.definition.encapsulated)
    }

    /// What a name means in the text of a class.
    pub(crate) fn meaning(&self, scope: Option<ClassId>, name: &Name) -> Option<Type> {
        self.meaning_without(scope, name, &mut Visited::default())
    }

    /// What the name of a base class means in a class: what the class itself inherits does not count
    /// (MLS §5.6.1.4).
    pub(crate) fn meaning_of_base(&self, class: ClassId, name: &Name) -> Option<Type> {
        self.meaning_without(Some(class), name, &mut [class].into_iter().collect())
    }

    /// What a name means, without what the classes in `visited` inherit.
    fn meaning_without(
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
        let mut classes = DeclaredClasses { library: self, visited };
        let Ok(found) = classes.simple(scope.filter(|_| !name.global), *first);
        let Ok(found) = classes.followed(found, rest);
        found
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

    /// The inherited class that `model extends M` extends and replaces (MLS §7.3.1).
    pub(crate) fn replaced_class(&self, class: ClassId) -> Option<ClassId> {
        let found = self.class(class);
        let (parent, name) = (found.parent?, found.name.last()?);
        let bases = self.declared_bases(parent);
        let inherited = |base: &ClassId| self.member(*base, name, &mut Visited::default());
        bases.iter().filter(|_| found.is_class_extends()).find_map(inherited)
    }

    /// The classes that a class extends, or that it is short for; unknown ones left out.
    pub(crate) fn declared_bases(&self, class: ClassId) -> Arc<[ClassId]> {
        self.bases_once(class, || self.find_bases(class))
    }

    fn find_bases(&self, class: ClassId) -> Vec<ClassId> {
        let found = self.class(class);
        // What the class itself inherits does not count (MLS §5.6.1.4).
        let mut own: Visited = [class].into_iter().collect();
        let mut class_of = |scope, name: &Name| match self.meaning_without(scope, name, &mut own) {
            Some(Type::Class(base)) if base != class => Some(base),
            _ => None,
        };
        match &found.definition().specifier {
            ClassSpecifier::Short(short) => {
                class_of(found.parent, &short.target.name).into_iter().collect()
            }
            _ => {
                let extended = found.extends.iter();
                let extended = extended.filter_map(|one| class_of(Some(class), &one.base.name));
                self.replaced_class(class).into_iter().chain(extended).collect()
            }
        }
    }
}
