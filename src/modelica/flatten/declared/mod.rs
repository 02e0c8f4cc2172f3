//! What the names in classes mean as the classes are declared (MLS §5.3), without an instance: what
//! an editor shows of a text. Redeclarations and modifications from outside are not known here.

pub(super) mod classes;

use super::checks::scope::{Component, Scope};
use super::library::{ClassId, Library};
use crate::name::{Ident, Name};
use crate::names::{self, Names};
use crate::syntax::ast::{
    ClassDefinition, ClassSpecifier, ComponentClause, ComponentDeclaration, ImportKind, Visibility,
};
pub(super) use classes::Type;
use std::collections::BTreeSet;
use std::convert::Infallible;
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

impl Declared {
    /// What the name of a type means.
    fn of(found: Type, name: Ident) -> Declared {
        match found {
            Type::Class(class) => Declared::Class(class),
            Type::Predefined(_) => Declared::Predefined(name),
        }
    }
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

/// The elements of the classes of a library: components, classes and literals.
struct Elements<'a> {
    library: &'a Library,
}

impl Names for Elements<'_> {
    type Class = ClassId;
    type Meaning = Declared;
    type Fault = Infallible;

    fn element(&mut self, class: ClassId, name: Ident) -> Result<Option<Declared>, Infallible> {
        Ok(self.library.element(class, name))
    }

    fn imports(&self, class: ClassId) -> &[ImportKind] {
        self.library.class(class).imports()
    }

    fn around(&self, class: ClassId) -> Option<ClassId> {
        self.library.around(class)
    }

    fn top(&mut self, name: Ident) -> Result<Option<Declared>, Infallible> {
        let found = self.library.meaning(None, &Name::from(name));
        Ok(found.map(|found| Declared::of(found, name)))
    }

    fn inside(&mut self, of: Declared, name: Ident) -> Result<Option<Declared>, Infallible> {
        Ok(self.library.element_of(of, name))
    }
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
        let found = self.meaning(scope, &simple).map(|found| Declared::of(found, first));
        self.each_part(found, &name.parts)
    }

    /// What the parts of the name of a base class mean in a class, without what that class inherits.
    pub(super) fn parts_of_base(&self, class: ClassId, name: &Name) -> Vec<Option<Declared>> {
        let Some(first) = name.first() else { return Vec::new() };
        let simple = Name { global: name.global, parts: vec![first] };
        let found = self.meaning_of_base(class, &simple).map(|found| Declared::of(found, first));
        self.each_part(found, &name.parts)
    }

    /// What the parts of a name in an expression mean in a class, or at the top level.
    pub fn parts_of_reference(&self, scope: Option<ClassId>, name: &Name) -> Vec<Option<Declared>> {
        let Some(first) = name.first() else { return Vec::new() };
        let mut elements = Elements { library: self };
        let Ok(found) = elements.simple(scope.filter(|_| !name.global), first);
        self.each_part(found, &name.parts)
    }

    fn each_part(&self, first: Option<Declared>, parts: &[Ident]) -> Vec<Option<Declared>> {
        let mut found = vec![first];
        for part in &parts[1..] {
            let last = found.last().copied().flatten();
            found.push(last.and_then(|last| self.element_of(last, *part)));
        }
        found
    }

    /// The element of a name of a class, or of the class of a component.
    pub fn element_of(&self, of: Declared, name: Ident) -> Option<Declared> {
        self.element(self.class_of_declared(of)?, name)
    }

    /// The class itself, or that of a component.
    pub fn class_of_declared(&self, declared: Declared) -> Option<ClassId> {
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

    /// The names of the components of a class, inherited ones included.
    pub(super) fn component_names(&self, class: ClassId) -> Vec<Ident> {
        let members = self.members(class).into_iter();
        let components = members.filter(|one| matches!(one.declared, Declared::Component(..)));
        components.map(|component| component.name).collect()
    }

    /// The class whose name is nearest to one that means nothing in a class.
    pub(super) fn suggestion(&self, scope: Option<ClassId>, name: &Name) -> Option<String> {
        names::suggestion(name, |package| self.candidates(scope, package))
    }

    /// The names of the classes in a package; for no package, of those in scope.
    fn candidates(&self, scope: Option<ClassId>, package: &Name) -> Vec<Ident> {
        let own = |class: ClassId| self.class(class).children().map(|(name, _)| name);
        if !package.parts.is_empty() {
            return match self.meaning(scope, package) {
                Some(Type::Class(class)) => own(class).collect(),
                _ => Vec::new(),
            };
        }
        let mut names: Vec<Ident> = ["Real", "Integer", "Boolean", "String"].map(Ident::new).into();
        names.extend(std::iter::successors(scope, |class| self.enclosing(*class)).flat_map(own));
        names.extend(self.roots());
        names
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
