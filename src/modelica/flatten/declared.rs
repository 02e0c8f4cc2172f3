//! What the names in classes mean as the classes are declared (MLS §5.3), without an instance: what
//! an editor shows of a text. Redeclarations and modifications from outside are not known here.

use super::checks::lookup::Type;
use super::checks::scope::{Component, Scope};
use super::library::{ClassId, Library};
use crate::name::{Ident, Name};
use crate::syntax::ast::{
    ClassDefinition, ClassSpecifier, ComponentClause, ComponentDeclaration, ImportKind, Visibility,
};
use std::collections::BTreeSet;
use std::sync::Arc;

/// What a name means.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Declared {
    /// A class.
    Class(ClassId),
    /// A component of this name, declared in this class.
    Component(ClassId, Ident),
    /// A literal of an enumeration.
    Literal(ClassId, Ident),
    /// A predefined type.
    Predefined(Ident),
}

/// An element of a class, its own or inherited.
#[derive(Debug, Clone, Copy)]
pub struct Member {
    /// Its name.
    pub name: Ident,
    /// What it is.
    pub declared: Declared,
    /// Whether it is protected.
    pub protected: bool,
}

impl Library {
    fn scope_of(&self, class: ClassId) -> Scope<'_> {
        Scope { library: self, class }
    }

    /// The full name of a class.
    pub fn name_of(&self, class: ClassId) -> &Name {
        self.scope_of(class).name()
    }

    /// Whether a class is declared `replaceable` in the class around it.
    pub fn is_replaceable(&self, class: ClassId) -> bool {
        self.class(class).prefixes().replaceable
    }

    /// The text of a class.
    pub fn definition_of(&self, class: ClassId) -> &Arc<ClassDefinition> {
        self.class(class).definition()
    }

    /// The class that a class is written in.
    pub fn enclosing(&self, class: ClassId) -> Option<ClassId> {
        self.scope_of(class).parent().map(|parent| parent.class)
    }

    /// A class, and those that it extends or is short for, directly or through others.
    pub fn lineage(&self, class: ClassId) -> Vec<ClassId> {
        self.scope_of(class).lineage().map(|class| class.class).collect()
    }

    /// What the parts of the name of a class mean in a class, or at the top level.
    pub fn parts_of_type(&self, scope: Option<ClassId>, name: &Name) -> Vec<Option<Declared>> {
        let Some(first) = name.first() else { return Vec::new() };
        let simple = Name { global: name.global, parts: vec![first] };
        let found = match self.meaning(scope, &simple) {
            Some(Type::Class(class)) => Some(Declared::Class(class)),
            Some(Type::Predefined(_)) => Some(Declared::Predefined(first)),
            None => None,
        };
        self.followed(found, &name.parts)
    }

    /// What the parts of a name in an expression mean in a class, or at the top level.
    pub fn parts_of_reference(&self, scope: Option<ClassId>, name: &Name) -> Vec<Option<Declared>> {
        let Some(first) = name.first() else { return Vec::new() };
        let found = match scope.filter(|_| !name.global) {
            Some(scope) => self.visible(scope, first),
            None => self.at_top(first),
        };
        self.followed(found, &name.parts)
    }

    fn followed(&self, first: Option<Declared>, parts: &[Ident]) -> Vec<Option<Declared>> {
        let mut found = vec![first];
        for part in &parts[1..] {
            let last = found.last().copied().flatten();
            found.push(last.and_then(|last| self.element_of(last, *part)));
        }
        found
    }

    fn at_top(&self, name: Ident) -> Option<Declared> {
        match self.meaning(None, &Name::from(name))? {
            Type::Class(class) => Some(Declared::Class(class)),
            Type::Predefined(_) => Some(Declared::Predefined(name)),
        }
    }

    /// A simple name: an element of the class or of one that encloses it, or imported.
    fn visible(&self, scope: ClassId, name: Ident) -> Option<Declared> {
        let mut at = Some(scope);
        while let Some(class) = at {
            let found = self.element(class, name).or_else(|| self.imported_element(class, name));
            if found.is_some() {
                return found;
            }
            let scope = self.scope_of(class);
            at = if scope.definition().encapsulated { None } else { self.enclosing(class) };
        }
        self.at_top(name)
    }

    fn imported_element(&self, class: ClassId, name: Ident) -> Option<Declared> {
        let global = |name: &Name| self.parts_of_reference(None, name).pop().flatten();
        let imports = || self.class(class).imports().iter();
        let named = imports().find_map(|import| match import {
            ImportKind::Qualified(target) if target.last() == Some(name) => global(target),
            ImportKind::Renaming(own, target) if *own == name => global(target),
            ImportKind::Group(package, names) if names.contains(&name) => {
                global(&package.child(name))
            }
            _ => None,
        });
        named.or_else(|| {
            imports().find_map(|import| match import {
                ImportKind::Unqualified(package) => global(&package.child(name)),
                _ => None,
            })
        })
    }

    /// The element of a name of a class, or of the class of a component.
    pub fn element_of(&self, of: Declared, name: Ident) -> Option<Declared> {
        self.element(self.class_behind(of)?, name)
    }

    /// The class itself, or that of a component.
    pub fn class_behind(&self, declared: Declared) -> Option<ClassId> {
        match declared {
            Declared::Class(class) => Some(class),
            Declared::Component(owner, name) => match self.type_of(owner, name)? {
                Declared::Class(class) => Some(class),
                _ => None,
            },
            Declared::Literal(..) | Declared::Predefined(_) => None,
        }
    }

    /// The element of a name of a class, its own or inherited.
    pub fn element(&self, class: ClassId, name: Ident) -> Option<Declared> {
        let scope = self.scope_of(class);
        if let Some(component) = scope.component(name) {
            return Some(self.first_declared(component));
        }
        if let Some(nested) = scope.lineage().find_map(|class| class.own_class(name)) {
            return Some(Declared::Class(nested.class));
        }
        let owner = scope.enumeration()?;
        let ClassSpecifier::Enumeration(enumeration) = &owner.definition().specifier else {
            return None;
        };
        let is_literal =
            enumeration.literals.iter().flatten().any(|literal| literal.name.node == name);
        is_literal.then_some(Declared::Literal(owner.class, name))
    }

    /// A component; of one that redeclares an inherited one that.
    fn first_declared(&self, component: Component<'_>) -> Declared {
        let name = component.name();
        let mut component = component;
        let mut seen = BTreeSet::from([component.owner.class]);
        while component.clause.prefixes.redeclare {
            let bases = self.declared_bases(component.owner.class);
            let inherited = bases.iter().find_map(|base| self.scope_of(*base).component(name));
            match inherited.filter(|found| seen.insert(found.owner.class)) {
                Some(found) => component = found,
                None => break,
            }
        }
        Declared::Component(component.owner.class, name)
    }

    /// The declaration of a component that a class itself declares.
    pub fn component(
        &self,
        owner: ClassId,
        name: Ident,
    ) -> Option<(&ComponentClause, &ComponentDeclaration)> {
        let found = self.scope_of(owner).own_component(name)?;
        Some((found.clause, found.declaration))
    }

    /// What the type of a component means.
    pub fn type_of(&self, owner: ClassId, name: Ident) -> Option<Declared> {
        let component = self.scope_of(owner).own_component(name)?;
        self.parts_of_type(Some(owner), &component.clause.type_specifier.name).pop().flatten()
    }

    /// The elements of a class, its own first, then inherited ones; each name once.
    pub fn members(&self, class: ClassId) -> Vec<Member> {
        let mut found = Vec::new();
        let mut seen = BTreeSet::new();
        for scope in self.scope_of(class).lineage() {
            let own = scope.components().map(|one| (one.name(), one.visibility));
            let own: Vec<(Ident, Visibility)> = own.collect();
            for (name, visibility) in own {
                if seen.insert(name) {
                    let protected = visibility == Visibility::Protected;
                    let declared = Declared::Component(scope.class, name);
                    found.push(Member { name, declared, protected });
                }
            }
            for (name, id) in self.class(scope.class).children() {
                if seen.insert(name) {
                    let visibility = scope.class_element(name).map(|(visibility, _)| visibility);
                    let protected = visibility == Some(Visibility::Protected);
                    found.push(Member { name, declared: Declared::Class(id), protected });
                }
            }
            if let ClassSpecifier::Enumeration(enumeration) = &scope.definition().specifier {
                for literal in enumeration.literals.iter().flatten() {
                    let name = literal.name.node;
                    let declared = Declared::Literal(scope.class, name);
                    found.push(Member { name, declared, protected: false });
                }
            }
        }
        found
    }

    /// The names that the import clauses of a class give to something, with what they mean.
    pub fn imports_of(&self, class: ClassId) -> Vec<(Ident, Declared)> {
        let mut found = Vec::new();
        let global = |name: &Name| self.parts_of_reference(None, name).pop().flatten();
        for import in self.class(class).imports() {
            match import {
                ImportKind::Qualified(target) => {
                    found.extend(target.last().zip(global(target)));
                }
                ImportKind::Renaming(own, target) => {
                    found.extend(global(target).map(|target| (*own, target)));
                }
                ImportKind::Group(package, names) => {
                    let each = names.iter().map(|name| (*name, global(&package.child(*name))));
                    found.extend(each.filter_map(|(name, target)| Some((name, target?))));
                }
                ImportKind::Unqualified(package) => {
                    if let Some(Declared::Class(package)) = global(package) {
                        let members = self.members(package).into_iter();
                        let public = members.filter(|member| !member.protected);
                        found.extend(public.map(|member| (member.name, member.declared)));
                    }
                }
            }
        }
        found
    }
}
