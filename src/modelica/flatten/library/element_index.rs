//! Where a class declares its components and nested classes, for classes with many of them.

use super::Class;
use crate::name::Ident;
use crate::syntax::ast::Section;
use crate::syntax::ast::{
    ClassElement, ComponentClause, ComponentDeclaration, Element, Visibility,
};
use rustc_hash::FxHashMap;

/// The places of components and nested classes by their names; of two of one name the first.
#[derive(Debug, Clone, Default)]
pub(super) struct ElementIndex {
    components: FxHashMap<Ident, ElementPosition>,
    classes: FxHashMap<Ident, ElementPosition>,
}

/// Which section, which element in it, and which component of a clause.
#[derive(Debug, Clone, Copy)]
struct ElementPosition {
    section: usize,
    element: usize,
    component: usize,
}

impl ElementIndex {
    fn of(sections: &[Section]) -> ElementIndex {
        let mut index = ElementIndex::default();
        for (section, part) in sections.iter().enumerate() {
            let Section::Elements { elements, .. } = part else { continue };
            for (element, declared) in elements.iter().enumerate() {
                index.add(declared, ElementPosition { section, element, component: 0 });
            }
        }
        index
    }

    fn add(&mut self, declared: &Element, place: ElementPosition) {
        match declared {
            Element::Component(clause) => {
                for (component, declaration) in clause.components.iter().enumerate() {
                    let name = declaration.name.node;
                    self.components.entry(name).or_insert(ElementPosition { component, ..place });
                }
            }
            Element::Class(nested) => {
                self.classes.entry(nested.class.name.node).or_insert(place);
            }
            _ => {}
        }
    }
}

impl Class {
    fn index(&self) -> &ElementIndex {
        self.index.get_or_init(|| ElementIndex::of(self.sections()))
    }

    /// The declaration of the component of a name, with its visibility and its clause.
    pub(in crate::flatten) fn component_element(
        &self,
        name: Ident,
    ) -> Option<(Visibility, &ComponentClause, &ComponentDeclaration)> {
        let place = self.index().components.get(&name)?;
        let (visibility, element) = self.element_at(*place)?;
        let Element::Component(clause) = element else { return None };
        Some((visibility, clause, clause.components.get(place.component)?))
    }

    /// The names of its components and, marked by `true`, of the nested classes that its file declares.
    pub(super) fn declared_names(&self) -> impl Iterator<Item = (Ident, bool)> {
        let index = self.index();
        let components = index.components.keys().map(|name| (*name, false));
        components.chain(index.classes.keys().map(|name| (*name, true)))
    }

    /// The nested class of a name, among those that its file declares.
    pub(in crate::flatten) fn class_element(
        &self,
        name: Ident,
    ) -> Option<(Visibility, &ClassElement)> {
        let (visibility, element) = self.element_at(*self.index().classes.get(&name)?)?;
        let Element::Class(nested) = element else { return None };
        Some((visibility, nested))
    }

    fn element_at(&self, place: ElementPosition) -> Option<(Visibility, &Element)> {
        match self.sections().get(place.section)? {
            Section::Elements { visibility, elements } => {
                Some((visibility.unwrap_or(Visibility::Public), elements.get(place.element)?))
            }
            _ => None,
        }
    }
}
