//! A class is read: its elements, and for the package of a folder the names of what lies there.

use super::files::{Entry, Folder};
use super::legacy::{self, LegacyConstruct};
use super::machine_constants;
use super::{Class, ClassId, Declared, Library, Origin, Slot};
use crate::diag::Diagnostic;
use crate::fault;
use crate::flatten::errors::DUPLICATE_ELEMENT;
use crate::name::{Ident, Name};
use crate::source::{Span, Spanned};
use crate::syntax::ast::{
    ClassDefinition, ClassElement, ClassSpecifier, Element, LongClass, Restriction, Section,
    StoredDefinition,
};
use indexmap::IndexMap;
use rustc_hash::FxHashMap;
use std::sync::{Arc, OnceLock};

/// Packages inside each other whose folders are still looked into.
const MAX_FOLDERS: usize = 20;

impl Library {
    /// A class, read now if it was not; its problems are not reported.
    pub(super) fn read(&self, id: ClassId) -> &Class {
        let slot = self.slot(id);
        slot.class.get_or_init(|| self.read_slot(id, slot))
    }

    fn read_slot(&self, id: ClassId, slot: &Slot) -> Class {
        let (definition, folder, problem) = match &slot.origin {
            Origin::Head(definition, folder) => (definition.clone(), folder.clone(), None),
            Origin::File(files, entry) => match self.only_class(slot, entry, files.as_ref()) {
                Ok(definition) => {
                    let folder = entry.folder.clone();
                    let folder = folder.map(|path| Folder { files: files.clone(), path });
                    (definition, folder, None)
                }
                Err(problem) => (unreadable(&slot.name, problem.span()), None, Some(problem)),
            },
        };
        let definition = machine_constants::provided(&slot.name, definition);
        let mut class = Class {
            name: slot.name.clone(),
            definition: definition.clone(),
            parent: slot.parent,
            children: IndexMap::new(),
            imports: Vec::new(),
            extends: Vec::new(),
            index: OnceLock::new(),
            declared: slot.declared.clone(),
            problems: problem.into_iter().collect(),
        };
        if let ClassSpecifier::Long(long) = &definition.specifier {
            self.add_elements(id, &mut class, long);
        }
        if let Some(folder) = folder {
            self.add_folder(id, &mut class, &folder);
        }
        class
    }

    fn add_elements(&self, id: ClassId, class: &mut Class, long: &LongClass) {
        class.problems.extend(long.sections.error().cloned());
        for (construct, span) in legacy::of_sections(&long.sections) {
            self.legacy.meet(class.name.first(), construct, span);
        }
        for section in &long.sections {
            let Section::Elements { elements, .. } = section else { continue };
            for element in elements {
                match element {
                    Element::Class(nested) => self.add_nested(id, class, nested),
                    Element::Import(import) => class.imports.push(import.kind.clone()),
                    Element::Extends(extends) => class.extends.push(extends.clone()),
                    Element::Component(_) => {}
                }
            }
        }
    }

    fn add_nested(&self, id: ClassId, class: &mut Class, nested: &ClassElement) {
        let Spanned { node: name, span } = nested.class.name;
        if class.children.contains_key(&name) {
            let owner = &class.name;
            let fault = fault!(DUPLICATE_ELEMENT, "`{owner}` declares two classes named `{name}`");
            class.problems.push(fault.at(span));
            return;
        }
        let origin = Origin::Head(nested.class.clone(), None);
        let constraint = nested.constraint.clone();
        let declared = Declared { prefixes: nested.prefixes, constraint };
        class.children.insert(name, self.push(origin, declared, name, Some(id)));
    }

    /// Adds the classes beside a `package.mo`. A file that `package.order` lists is not opened.
    fn add_folder(&self, id: ClassId, class: &mut Class, folder: &Folder) {
        if class.name.parts.len() > MAX_FOLDERS {
            // A link that leads back would make the package one without end.
            return;
        }
        let order = folder.order().unwrap_or_default();
        let place: FxHashMap<Ident, usize> =
            order.iter().enumerate().map(|(at, name)| (Ident::new(name), at)).collect();
        for entry in folder.entries() {
            let name = Ident::new(&entry.stem);
            let listed = place.contains_key(&name);
            let file = if listed { None } else { entry.heads(folder.files.as_ref()).ok() };
            let found = match file {
                Some(file) => {
                    self.meet_file(&class.name, &entry, &file, None);
                    entry.classes(&folder.files, &file)
                }
                // Not needed yet, or reported as unreadable when it is needed.
                None => vec![(name, Origin::File(folder.files.clone(), entry))],
            };
            for (name, origin) in found {
                if !class.children.contains_key(&name) {
                    let declared = Declared::default();
                    class.children.insert(name, self.push(origin, declared, name, Some(id)));
                }
            }
        }
        let last = place.len();
        class.children.sort_by_cached_key(|name, _| place.get(name).copied().unwrap_or(last));
    }

    /// The class of a file that is named like it.
    fn only_class(
        &self,
        slot: &Slot,
        entry: &Entry,
        files: &dyn super::LibraryFiles,
    ) -> Result<Arc<ClassDefinition>, Diagnostic> {
        let file = entry.heads(files)?;
        let own = slot.name.last();
        self.meet_file(&slot.name.parent(), entry, &file, own);
        let named = file.classes.iter().find(|class| Some(class.name.node) == own);
        named.or(file.classes.first()).cloned().ok_or_else(|| no_class(&file))
    }

    /// Notes what an old library does otherwise with a file in the folder of `package`.
    fn meet_file(
        &self,
        package: &Name,
        entry: &Entry,
        file: &StoredDefinition,
        given: Option<Ident>,
    ) {
        let library = package.first();
        let span = file.classes.first().map_or(file.span, |class| class.name.span);
        match &file.within {
            None => self.legacy.meet(library, LegacyConstruct::NoWithin, span),
            Some(within) if within.node.parts != package.parts => {
                self.legacy.meet(library, LegacyConstruct::OtherWithin, within.span);
            }
            Some(_) => {}
        }
        let name = given.unwrap_or_else(|| Ident::new(&entry.stem));
        self.meet_name(library, entry, file, name);
    }

    /// Notes a package's folder whose name, without a version, is not that of the package.
    pub(super) fn meet_folder(
        &self,
        parent: Option<ClassId>,
        entry: &Entry,
        file: &StoredDefinition,
    ) {
        let library = match parent {
            Some(parent) => self.slot(parent).name.first(),
            None => file.classes.first().map(|class| class.name.node),
        };
        let name = entry.stem.split(' ').next().unwrap_or_default();
        self.meet_name(library, entry, file, Ident::new(name));
    }

    /// Notes a file or folder whose name is none of a class in it.
    fn meet_name(
        &self,
        library: Option<Ident>,
        entry: &Entry,
        file: &StoredDefinition,
        name: Ident,
    ) {
        if file.classes.iter().any(|class| class.name.node == name) {
            return;
        }
        let span = file.classes.first().map_or(file.span, |class| class.name.span);
        let is_folder = entry.folder.is_some();
        let construct =
            if is_folder { LegacyConstruct::FolderName } else { LegacyConstruct::FileName };
        self.legacy.meet(library, construct, span);
    }
}

fn no_class(file: &StoredDefinition) -> Diagnostic {
    fault!(crate::flatten::errors::UNKNOWN_CLASS, "there is no class in this file").at(file.span)
}

/// What stands for a class whose file cannot be read.
fn unreadable(name: &Name, span: Span) -> Arc<ClassDefinition> {
    let name = Spanned { node: name.last().unwrap_or_else(|| Ident::new("")), span };
    Arc::new(ClassDefinition {
        name,
        is_final: false,
        encapsulated: false,
        partial: false,
        restriction: Restriction::Class,
        specifier: ClassSpecifier::Long(LongClass {
            class_extends: None,
            description: None,
            sections: Vec::new().into(),
            end_name: name,
        }),
        span,
    })
}
