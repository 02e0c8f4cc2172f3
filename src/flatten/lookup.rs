//! Looking up names of classes: simple (MLS §5.3.1), composite (§5.3.2), global (§5.3.3) and
//! imported ones (§5.3.4, §13.2).

use super::errors::UNKNOWN_CLASS;
use super::library::{ClassId, Library};
use crate::diag::{Diagnostic, suggest};
use crate::fault;
use crate::name::{Ident, Name};
use crate::source::Span;
use crate::syntax::ast::{ClassSpecifier, ImportKind, TypeSpecifier};
use std::collections::BTreeSet;

/// What the name of a type means.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Type {
    /// A class of the library.
    Class(ClassId),
    /// A predefined type (MLS §4.9).
    Predefined(Predefined),
}

/// The predefined types.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Predefined {
    Real,
    Integer,
    Boolean,
    String,
}

impl Predefined {
    fn named(name: Ident) -> Option<Predefined> {
        match name.as_str() {
            "Real" => Some(Predefined::Real),
            "Integer" => Some(Predefined::Integer),
            "Boolean" => Some(Predefined::Boolean),
            "String" => Some(Predefined::String),
            _ => None,
        }
    }
}

/// Classes whose inherited elements were searched already: a class that extends itself ends there.
type Visited = BTreeSet<ClassId>;

/// The most base classes in which a name is searched.
const MAX_BASES: usize = 1000;

impl Library {
    /// What a type specifier means in the scope of a class; an error with suggestions if nothing.
    pub(super) fn lookup_type(
        &self,
        scope: Option<ClassId>,
        specifier: &TypeSpecifier,
    ) -> Result<Type, Diagnostic> {
        self.lookup(scope, &specifier.name)
            .ok_or_else(|| self.unknown_class(scope, &specifier.name, specifier.span))
    }

    /// What a base class means: as [`Library::lookup_type`], but names inherited by the extending
    /// class itself do not count (MLS §5.6.1.4).
    pub(super) fn lookup_base(
        &self,
        class: ClassId,
        specifier: &TypeSpecifier,
    ) -> Result<Type, Diagnostic> {
        self.lookup_with(Some(class), &specifier.name, &mut [class].into())
            .ok_or_else(|| self.unknown_class(Some(class), &specifier.name, specifier.span))
    }

    /// What a name means in the scope of a class.
    pub(super) fn lookup(&self, scope: Option<ClassId>, name: &Name) -> Option<Type> {
        self.lookup_with(scope, name, &mut Visited::new())
    }

    fn lookup_with(
        &self,
        scope: Option<ClassId>,
        name: &Name,
        visited: &mut Visited,
    ) -> Option<Type> {
        let (first, rest) = name.parts.split_first()?;
        let found = match scope {
            Some(scope) if !name.global => self.lookup_simple(scope, *first, visited),
            _ => self.root(*first),
        };
        let Some(mut class) = found else {
            let predefined = Predefined::named(*first).filter(|_| rest.is_empty());
            return predefined.map(Type::Predefined);
        };
        for part in rest {
            class = self.member(class, *part, &mut Visited::new())?;
        }
        Some(Type::Class(class))
    }

    /// A simple name: declared, inherited or imported by the class or by one that encloses it.
    fn lookup_simple(&self, scope: ClassId, name: Ident, visited: &mut Visited) -> Option<ClassId> {
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
        if let Some(own) = self.class(class).children.get(&name) {
            return Some(*own);
        }
        if visited.len() >= MAX_BASES || !visited.insert(class) {
            return None;
        }
        self.bases(class).iter().find_map(|base| self.member(*base, name, visited))
    }

    /// The classes that a class extends, or that it is short for; unknown ones left out.
    pub(super) fn bases(&self, class: ClassId) -> Vec<ClassId> {
        self.bases_once(class, || self.find_bases(class))
    }

    fn find_bases(&self, class: ClassId) -> Vec<ClassId> {
        let found = self.class(class);
        let mut own: Visited = [class].into();
        let mut class_of = |scope, name: &Name| match self.lookup_with(scope, name, &mut own) {
            Some(Type::Class(base)) if base != class => Some(base),
            _ => None,
        };
        match &found.definition.specifier {
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
        let global = |name: &Name| match self.lookup_with(None, name, &mut Visited::new()) {
            Some(Type::Class(found)) => Some(found),
            _ => None,
        };
        let imports = &self.class(class).imports;
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

    /// The name with which an import makes a constant visible, if one does.
    pub(super) fn imported_name(&self, class: ClassId, name: Ident) -> Vec<Name> {
        self.class(class)
            .imports
            .iter()
            .filter_map(|import| match import {
                ImportKind::Qualified(target) if target.last() == Some(name) => {
                    Some(target.clone())
                }
                ImportKind::Renaming(own, target) if *own == name => Some(target.clone()),
                ImportKind::Group(package, names) if names.contains(&name) => {
                    Some(package.child(name))
                }
                ImportKind::Unqualified(package) => Some(package.child(name)),
                _ => None,
            })
            .collect()
    }

    /// The diagnostic for a class that is not there.
    pub(super) fn unknown_class(
        &self,
        scope: Option<ClassId>,
        name: &Name,
        span: Span,
    ) -> Diagnostic {
        let wanted = name.last().map_or("", Ident::as_str);
        let (package, candidates) = self.siblings(scope, name);
        let suggestion = suggest::nearest(wanted, candidates.iter().map(|c| c.as_str()))
            .map(|near| format!("did you mean `{}`?", package.child(Ident::new(near))));
        fault!(UNKNOWN_CLASS, "no class named `{name}`").help_if(suggestion).at(span)
    }

    /// The names among which the last part of a name was looked up, and the package they lie in.
    fn siblings(&self, scope: Option<ClassId>, name: &Name) -> (Name, Vec<Ident>) {
        let package = name.parent();
        if !package.parts.is_empty() {
            let names = match self.lookup(scope, &package) {
                Some(Type::Class(id)) => self.class(id).children.keys().copied().collect(),
                _ => Vec::new(),
            };
            return (package, names);
        }
        let mut names: Vec<Ident> = ["Real", "Integer", "Boolean", "String"].map(Ident::new).into();
        let mut scope = scope;
        while let Some(id) = scope {
            names.extend(self.class(id).children.keys());
            scope = self.class(id).parent;
        }
        names.extend(self.roots());
        (Name::default(), names)
    }
}
