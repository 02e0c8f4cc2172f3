//! A version of a document as it was read, and the classes in it.

use super::document::Document;
use super::recovery::Tree;
use crate::diag::Diagnostic;
use crate::name::Name;
use crate::source::SourceId;
use crate::syntax::ast::{
    ClassDefinition, ClassSpecifier, Element, InteractiveKind, Section, StoredDefinition,
};
use std::sync::Arc;

/// A document that was read.
#[derive(Debug)]
pub struct Parsed {
    /// The document.
    pub document: Arc<Document>,
    /// The number of its text in the session.
    pub source: SourceId,
    /// What it contains, as far as it could be read.
    pub tree: Option<Tree>,
    /// What is wrong with its text, or with loading its classes.
    pub errors: Vec<Diagnostic>,
    /// The full names of its classes at the top.
    pub names: Vec<Name>,
}

impl Parsed {
    /// The classes at the top of the document, those that a script defines.
    pub fn classes(&self) -> Vec<&Arc<ClassDefinition>> {
        self.tree.as_ref().map_or(Vec::new(), classes_of)
    }

    /// All classes of the document with their full names, outer before inner.
    pub(crate) fn all_classes(&self) -> Vec<(Name, Arc<ClassDefinition>)> {
        let mut found = Vec::new();
        for (name, class) in self.names.iter().zip(self.classes()) {
            collect(name.clone(), class, &mut found);
        }
        found
    }

    /// The innermost class around a byte.
    pub(crate) fn class_at(&self, offset: usize) -> Option<(Name, Arc<ClassDefinition>)> {
        let around = |class: &ClassDefinition| {
            class.span.start as usize <= offset && offset <= class.span.end as usize
        };
        self.all_classes().into_iter().rfind(|(_, class)| around(class))
    }
}

/// The classes at the top of a tree.
pub(crate) fn classes_of(tree: &Tree) -> Vec<&Arc<ClassDefinition>> {
    match tree {
        Tree::Classes(file) => file.classes.iter().collect(),
        Tree::Script(script) => script
            .statements
            .iter()
            .filter_map(|statement| match &statement.kind {
                InteractiveKind::Class(class) => Some(class),
                _ => None,
            })
            .collect(),
    }
}

/// A tree as the file that a library loads.
pub(crate) fn file_of(tree: &Tree) -> StoredDefinition {
    match tree {
        Tree::Classes(file) => file.clone(),
        Tree::Script(script) => {
            let classes = classes_of(tree).into_iter().cloned().collect();
            StoredDefinition { within: None, classes, span: script.span }
        }
    }
}

/// The elements of a class; none of a short one.
pub(crate) fn elements(class: &ClassDefinition) -> impl Iterator<Item = &Element> {
    sections(class).iter().flat_map(|section| match section {
        Section::Elements { elements, .. } => elements.as_slice(),
        _ => &[],
    })
}

/// The sections of a class; none of a short one.
pub(crate) fn sections(class: &ClassDefinition) -> &[Section] {
    match &class.specifier {
        ClassSpecifier::Long(long) => &long.sections,
        _ => &[],
    }
}

fn collect(
    name: Name,
    class: &Arc<ClassDefinition>,
    found: &mut Vec<(Name, Arc<ClassDefinition>)>,
) {
    found.push((name.clone(), class.clone()));
    for element in elements(class) {
        if let Element::Class(nested) = element {
            collect(name.child(nested.class.name.node), &nested.class, found);
        }
    }
}
