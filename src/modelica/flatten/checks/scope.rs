//! What the checks ask about a class: its elements, those it inherits, and what names mean in it.

use super::lineage::Lineage;
use crate::flatten::declared::classes::Type;
use crate::flatten::library::{BaseProperty, ClassId, Library};
use crate::flatten::lookup::types::Predefined;
use crate::name::{Ident, Name};
use crate::syntax::ast::{
    ClassDefinition, ClassElement, ClassSpecifier, ComponentClause, ComponentDeclaration,
    ComponentReference, Element, Restriction, Section, TypePrefixes, VariabilityPrefix, Visibility,
};

/// The most short classes in a row that are followed.
const MAX_CHAIN: usize = 100;

/// A class of a library, as the checks see it.
#[derive(Clone, Copy)]
pub(crate) struct Scope<'a> {
    pub library: &'a Library,
    pub class: ClassId,
}

/// A component with the clause and the class that declare it.
#[derive(Clone, Copy)]
pub(crate) struct Component<'a> {
    pub owner: Scope<'a>,
    pub visibility: Visibility,
    pub clause: &'a ComponentClause,
    pub declaration: &'a ComponentDeclaration,
}

impl<'a> Scope<'a> {
    /// Another class of the same library.
    pub(crate) fn of(self, class: ClassId) -> Scope<'a> {
        Scope { class, ..self }
    }

    /// Its definition.
    pub(crate) fn definition(self) -> &'a ClassDefinition {
        &self.library.class(self.class).definition
    }

    /// Its keyword.
    pub(crate) fn restriction(self) -> Restriction {
        self.definition().restriction
    }

    /// Its full name.
    pub(crate) fn name(self) -> &'a Name {
        &self.library.class(self.class).name
    }

    /// The class that it is written in.
    pub(crate) fn parent(self) -> Option<Scope<'a>> {
        self.library.class(self.class).parent.map(|parent| self.of(parent))
    }

    /// The class around it whose names it sees: none for an encapsulated class.
    pub(super) fn around(self) -> Option<Scope<'a>> {
        self.library.around(self.class).map(|around| self.of(around))
    }

    /// Its sections; none for a short class.
    pub(crate) fn sections(self) -> &'a [Section] {
        self.library.class(self.class).sections()
    }

    /// Its own elements with their visibility.
    pub(crate) fn elements(self) -> impl Iterator<Item = (Visibility, &'a Element)> {
        self.library.class(self.class).elements()
    }

    /// Its own components.
    pub(crate) fn components(self) -> impl Iterator<Item = Component<'a>> {
        self.elements().flat_map(move |element| self.components_of(element))
    }

    fn components_of(
        self,
        (visibility, element): (Visibility, &'a Element),
    ) -> impl Iterator<Item = Component<'a>> {
        let clause = match element {
            Element::Component(clause) => Some(clause),
            _ => None,
        };
        clause.into_iter().flat_map(move |clause| {
            clause.components.iter().map(move |declaration| Component {
                owner: self,
                visibility,
                clause,
                declaration,
            })
        })
    }

    /// The classes that it declares itself, with their visibility.
    pub(crate) fn class_elements(self) -> impl Iterator<Item = (Visibility, &'a ClassElement)> {
        self.elements().filter_map(|(visibility, element)| match element {
            Element::Class(nested) => Some((visibility, nested)),
            _ => None,
        })
    }

    /// The class of a name that it declares itself.
    pub(crate) fn own_class(self, name: Ident) -> Option<Scope<'a>> {
        self.library.class(self.class).child(name).map(|class| self.of(class))
    }

    /// Itself and all classes that it extends or is short for.
    pub(crate) fn lineage(self) -> impl Iterator<Item = Scope<'a>> {
        Lineage::of(self.library, self.class).map(move |(class, _)| self.of(class))
    }

    /// The first of its lineage that answers a question; each is asked once.
    pub(crate) fn first(
        self,
        question: BaseProperty,
        answers: impl Fn(Scope<'a>) -> bool,
    ) -> Option<Scope<'a>> {
        let lineage = Lineage::of(self.library, self.class);
        let found = self.library.first_answer(question, lineage, |class| answers(self.of(class)));
        found.map(|class| self.of(class))
    }

    /// Its component of a name, its own or inherited.
    pub(crate) fn component(self, name: Ident) -> Option<Component<'a>> {
        let declaring = self.library.declaring(self.class, name, false)?;
        self.of(declaring).own_component(name)
    }

    /// The component of a name that it declares itself.
    pub(crate) fn own_component(self, name: Ident) -> Option<Component<'a>> {
        let (visibility, clause, declaration) =
            self.library.class(self.class).component_element(name)?;
        Some(Component { owner: self, visibility, clause, declaration })
    }

    /// The class of a name that it declares itself, in its file, with its visibility.
    pub(crate) fn class_element(self, name: Ident) -> Option<(Visibility, &'a ClassElement)> {
        self.library.class(self.class).class_element(name)
    }

    /// The components that the parts of a reference name, followed through their classes as they
    /// are declared; `None` where a redeclaration could change them.
    pub(crate) fn path(self, reference: &ComponentReference) -> Option<Vec<Component<'a>>> {
        if reference.global {
            return None;
        }
        let (first, rest) = reference.parts.split_first()?;
        let mut path = vec![self.component(first.name)?];
        for part in rest {
            let last = path.last()?;
            if last.clause.prefixes.replaceable || last.clause.prefixes.outer {
                return None;
            }
            path.push(last.class()?.component(part.name)?);
        }
        Some(path)
    }

    /// The component that a reference names, as [`Scope::path`] finds it.
    pub(crate) fn component_at(self, reference: &ComponentReference) -> Option<Component<'a>> {
        self.path(reference)?.pop()
    }

    /// What a name of a type or class means in it.
    pub(crate) fn meaning(self, name: &Name) -> Option<Type> {
        self.library.meaning(Some(self.class), name)
    }

    /// The class that a name means in it.
    pub(crate) fn class_named(self, name: &Name) -> Option<Scope<'a>> {
        match self.meaning(name)? {
            Type::Class(class) => Some(self.of(class)),
            Type::Predefined(_) => None,
        }
    }

    /// The class at the end of a chain of short classes, and the prefixes that they add.
    pub(crate) fn unaliased(self) -> (Option<Scope<'a>>, Vec<TypePrefixes>) {
        let mut class = self;
        let mut prefixes = Vec::new();
        for _ in 0..MAX_CHAIN {
            let ClassSpecifier::Short(short) = &class.definition().specifier else {
                return (Some(class), prefixes);
            };
            prefixes.push(short.prefixes);
            let outside = class.parent();
            let target = match outside {
                Some(outside) => outside.class_named(&short.target.name),
                None => self.library.find(&short.target.name).map(|found| self.of(found)),
            };
            match target {
                Some(target) => class = target,
                None => return (None, prefixes),
            }
        }
        (None, prefixes)
    }

    /// The predefined type that it is made of, through short classes and extends clauses.
    pub(crate) fn predefined(self) -> Option<Predefined> {
        let is_one = |class: Scope<'a>| class.own_predefined().is_some();
        self.first(BaseProperty::Predefined, is_one)?.own_predefined()
    }

    fn own_predefined(self) -> Option<Predefined> {
        match &self.definition().specifier {
            ClassSpecifier::Short(short) => {
                let scope = self.parent().unwrap_or(self);
                predefined(scope.meaning(&short.target.name))
            }
            ClassSpecifier::Long(_) => {
                let extends = &self.library.class(self.class).extends;
                extends.iter().find_map(|one| predefined(self.meaning(&one.base.name)))
            }
            _ => None,
        }
    }

    /// The enumeration that it is, by itself or through others.
    pub(crate) fn enumeration(self) -> Option<Scope<'a>> {
        self.first(BaseProperty::Enumeration, |class| {
            matches!(class.definition().specifier, ClassSpecifier::Enumeration(_))
        })
    }

    /// Whether it is an enumeration, by itself or through others.
    pub(crate) fn is_enumeration(self) -> bool {
        self.enumeration().is_some()
    }

    /// Whether it, or a class around it, is declared replaceable.
    pub(crate) fn is_replaceable(self) -> bool {
        std::iter::successors(Some(self), |class| class.parent())
            .any(|class| self.library.class(class.class).prefixes().replaceable)
    }
}

impl<'a> Component<'a> {
    /// What its type means.
    pub(crate) fn meaning(&self) -> Option<Type> {
        self.owner.meaning(&self.clause.type_specifier.name)
    }

    /// The class of its type.
    pub(crate) fn class(&self) -> Option<Scope<'a>> {
        self.owner.class_named(&self.clause.type_specifier.name)
    }

    /// The predefined type that it is of.
    pub(crate) fn predefined(&self) -> Option<Predefined> {
        match self.meaning()? {
            Type::Predefined(predefined) => Some(predefined),
            Type::Class(class) => self.owner.of(class).predefined(),
        }
    }

    /// Whether it, or its type, is declared constant or parameter.
    pub(crate) fn is_fixed(&self) -> bool {
        let fixed = |prefixes: &TypePrefixes| {
            let variability = prefixes.variability;
            matches!(variability, Some(VariabilityPrefix::Constant | VariabilityPrefix::Parameter))
        };
        let of_type = || self.class().is_some_and(|class| class.unaliased().1.iter().any(fixed));
        fixed(&self.clause.type_prefixes) || of_type()
    }

    /// Whether it, or its type, is declared input or output.
    pub(crate) fn has_direction(&self) -> bool {
        let directed = |prefixes: &TypePrefixes| prefixes.causality.is_some();
        let of_type = || self.class().is_some_and(|class| class.unaliased().1.iter().any(directed));
        directed(&self.clause.type_prefixes) || of_type()
    }

    /// Its name.
    pub(crate) fn name(&self) -> Ident {
        self.declaration.name.node
    }
}

fn predefined(meaning: Option<Type>) -> Option<Predefined> {
    match meaning {
        Some(Type::Predefined(predefined)) => Some(predefined),
        _ => None,
    }
}
