//! All loaded classes, as a tree of packages (MLS ch. 13).

use super::errors::{DUPLICATE_ELEMENT, UNKNOWN_CLASS};
use crate::diag::Diagnostic;
use crate::fault;
use crate::name::{Ident, Name};
use crate::syntax::ast::{
    ClassDefinition, ClassElement, ClassSpecifier, Constraint, Element, ElementPrefixes, Extends,
    ImportKind, Section, StoredDefinition, Visibility,
};
use indexmap::IndexMap;
use rustc_hash::{FxHashMap, FxHashSet};
use std::collections::BTreeSet;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::thread::ThreadId;

/// A class of a [`Library`].
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, Default)]
pub struct ClassId(u32);

/// The loaded classes. Classes are never changed; loading one again under the same name makes the
/// name mean the new one.
#[derive(Debug, Clone, Default)]
pub struct Library {
    classes: Vec<Class>,
    roots: IndexMap<Ident, ClassId>,
    /// Top-level names that were looked for and are not loaded.
    missing: Arc<Mutex<BTreeSet<Ident>>>,
    /// What the classes extend, found so far; another cache as soon as a class is added.
    bases: Arc<Mutex<BaseCache>>,
}

/// The classes that others extend, as far as they were looked up.
#[derive(Debug, Default)]
struct BaseCache {
    known: FxHashMap<ClassId, Vec<ClassId>>,
    /// Classes whose bases a thread is looking up: one that needs its own bases for that has none.
    busy: FxHashSet<(ThreadId, ClassId)>,
}

/// A class with what its text says directly, before inheritance.
#[derive(Debug, Clone)]
pub(super) struct Class {
    pub(super) name: Name,
    pub(super) definition: Arc<ClassDefinition>,
    pub(super) parent: Option<ClassId>,
    pub(super) children: IndexMap<Ident, ClassId>,
    pub(super) imports: Vec<ImportKind>,
    pub(super) extends: Vec<Extends>,
    prefixes: ElementPrefixes,
    protected: bool,
    constraint: Option<Constraint>,
}

impl Library {
    /// A library without classes.
    pub fn new() -> Library {
        Library::default()
    }

    /// Adds the classes of a file and returns their full names. An error if the package named by
    /// `within` is not loaded, or if a class declares two classes of one name.
    pub fn load(&mut self, file: &StoredDefinition) -> Result<Vec<Name>, Diagnostic> {
        let parent = match &file.within {
            Some(within) if !within.node.parts.is_empty() => {
                let found = self.find(&within.node);
                Some(found.ok_or_else(|| {
                    fault!(UNKNOWN_CLASS, "package `{}` of the within clause is not loaded", within.node;
                        help: "load the package's own file, `package.mo`, first")
                    .at(within.span)
                })?)
            }
            _ => None,
        };
        file.classes
            .iter()
            .map(|class| {
                let id = self.add(class, parent)?;
                Ok(self.class(id).name.clone())
            })
            .collect()
    }

    /// Adds one class at the top level, as a script defines it.
    pub fn define(&mut self, class: &Arc<ClassDefinition>) -> Result<Name, Diagnostic> {
        let id = self.add(class, None)?;
        Ok(self.class(id).name.clone())
    }

    fn add(
        &mut self,
        definition: &Arc<ClassDefinition>,
        parent: Option<ClassId>,
    ) -> Result<ClassId, Diagnostic> {
        let own = definition.name.node;
        let name = match parent {
            Some(parent) => self.class(parent).name.child(own),
            None => Name::from(own),
        };
        let id = ClassId(self.classes.len() as u32);
        let known = match parent {
            Some(parent) => self.classes[parent.0 as usize].children.insert(own, id),
            None => self.roots.insert(own, id),
        };
        self.bases = Arc::default();
        self.classes.push(Class {
            name,
            definition: definition.clone(),
            parent,
            children: IndexMap::new(),
            imports: Vec::new(),
            extends: Vec::new(),
            prefixes: ElementPrefixes::default(),
            protected: false,
            constraint: None,
        });
        self.add_elements(id, definition)?;
        self.keep_separate_files(known, id);
        Ok(id)
    }

    /// A package read again from its own file keeps the classes that lie in files beside it.
    fn keep_separate_files(&mut self, former: Option<ClassId>, id: ClassId) {
        let Some(former) = former else { return };
        let source = self.class(former).definition.span.source;
        let children = self.class(former).children.clone();
        for (name, child) in children {
            let elsewhere = self.class(child).definition.span.source != source;
            if elsewhere && !self.class(id).children.contains_key(&name) {
                self.classes[id.0 as usize].children.insert(name, child);
            }
        }
    }

    fn add_elements(
        &mut self,
        id: ClassId,
        definition: &ClassDefinition,
    ) -> Result<(), Diagnostic> {
        let ClassSpecifier::Long(long) = &definition.specifier else { return Ok(()) };
        for section in &long.sections {
            let Section::Elements { visibility, elements } = section else { continue };
            let protected = *visibility == Some(Visibility::Protected);
            for element in elements {
                match element {
                    Element::Class(nested) => {
                        let name = nested.class.name;
                        if self.class(id).children.contains_key(&name.node) {
                            let owner = &self.class(id).name;
                            return Err(fault!(
                                DUPLICATE_ELEMENT,
                                "`{owner}` declares two classes named `{}`",
                                name.node
                            )
                            .at(name.span));
                        }
                        let child = self.add(&nested.class, Some(id))?;
                        self.declared(child, nested, protected);
                    }
                    Element::Import(import) => {
                        self.classes[id.0 as usize].imports.push(import.kind.clone());
                    }
                    Element::Extends(extends) => {
                        self.classes[id.0 as usize].extends.push(extends.clone());
                    }
                    Element::Component(_) => {}
                }
            }
        }
        Ok(())
    }

    fn declared(&mut self, id: ClassId, element: &ClassElement, protected: bool) {
        let class = &mut self.classes[id.0 as usize];
        class.prefixes = element.prefixes;
        class.protected = protected;
        class.constraint = element.constraint.clone();
    }

    /// The class of a full name.
    pub fn find(&self, name: &Name) -> Option<ClassId> {
        let (first, rest) = name.parts.split_first()?;
        let mut id = *self.roots.get(first)?;
        for part in rest {
            id = *self.class(id).children.get(part)?;
        }
        Some(id)
    }

    /// Whether a class of this full name is loaded.
    pub fn contains(&self, name: &Name) -> bool {
        self.find(name).is_some()
    }

    /// The names of the classes at the top level, in the order they were loaded.
    pub fn roots(&self) -> impl Iterator<Item = Ident> {
        self.roots.keys().copied()
    }

    /// The names of the classes declared directly in a class, in order.
    pub fn children(&self, name: &Name) -> Vec<Ident> {
        self.find(name).map_or(Vec::new(), |id| self.class(id).children.keys().copied().collect())
    }

    /// The definition of a class.
    pub fn definition(&self, name: &Name) -> Option<Arc<ClassDefinition>> {
        self.find(name).map(|id| self.class(id).definition.clone())
    }

    /// Removes a class at the top level; `false` if there was none.
    pub fn remove(&mut self, name: Ident) -> bool {
        self.roots.shift_remove(&name).is_some()
    }

    /// Full names of all classes, in order of loading, outer before inner.
    pub fn all(&self) -> Vec<Name> {
        let mut names = Vec::new();
        let mut pending: Vec<ClassId> = self.roots.values().rev().copied().collect();
        while let Some(id) = pending.pop() {
            names.push(self.class(id).name.clone());
            pending.extend(self.class(id).children.values().rev());
        }
        names
    }

    /// The top-level names that were looked for in vain since the last call, sorted: who has the
    /// files can load them and try again.
    pub fn take_missing(&self) -> BTreeSet<Ident> {
        std::mem::take(&mut *locked(&self.missing))
    }

    pub(super) fn root(&self, name: Ident) -> Option<ClassId> {
        let found = self.roots.get(&name).copied();
        if found.is_none() {
            locked(&self.missing).insert(name);
        }
        found
    }

    /// The classes that a class extends as `find` finds them, each looked up once.
    pub(super) fn bases_once(
        &self,
        class: ClassId,
        find: impl FnOnce() -> Vec<ClassId>,
    ) -> Vec<ClassId> {
        let thread = std::thread::current().id();
        {
            let mut cache = locked(&self.bases);
            if let Some(known) = cache.known.get(&class) {
                return known.clone();
            }
            if !cache.busy.insert((thread, class)) {
                return Vec::new();
            }
        }
        let found = find();
        let mut cache = locked(&self.bases);
        cache.busy.remove(&(thread, class));
        cache.known.insert(class, found.clone());
        found
    }

    pub(super) fn class(&self, id: ClassId) -> &Class {
        &self.classes[id.0 as usize]
    }
}

/// What a mutex holds; a panic elsewhere leaves these sets whole.
fn locked<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

impl Class {
    pub(super) fn name(&self) -> &Name {
        &self.name
    }

    pub(super) fn definition(&self) -> &Arc<ClassDefinition> {
        &self.definition
    }

    pub(super) fn parent(&self) -> Option<ClassId> {
        self.parent
    }

    pub(super) fn child(&self, name: Ident) -> Option<ClassId> {
        self.children.get(&name).copied()
    }

    pub(super) fn children(&self) -> impl Iterator<Item = (Ident, ClassId)> {
        self.children.iter().map(|(name, id)| (*name, *id))
    }

    pub(super) fn imports(&self) -> &[ImportKind] {
        &self.imports
    }

    pub(super) fn extends(&self) -> &[Extends] {
        &self.extends
    }

    pub(super) fn encapsulated(&self) -> bool {
        self.definition.encapsulated
    }

    /// The prefixes of the element that it is of its package or class.
    pub(super) fn prefixes(&self) -> ElementPrefixes {
        self.prefixes
    }

    /// Whether it is declared behind `protected`.
    pub(super) fn is_protected(&self) -> bool {
        self.protected
    }

    /// Whether it is `extends M(…)`, which replaces an inherited class (MLS §7.3.1).
    pub(super) fn is_class_extends(&self) -> bool {
        matches!(&self.definition.specifier, ClassSpecifier::Long(long) if long.class_extends.is_some())
    }

    /// What replacements must be compatible with (MLS §7.3.2).
    pub(super) fn constraint(&self) -> Option<&Constraint> {
        self.constraint.as_ref()
    }

    /// The elements with their visibility, in order; none for a short class.
    pub(super) fn elements(&self) -> impl Iterator<Item = (Visibility, &Element)> {
        self.sections().iter().flat_map(|section| {
            let (visibility, elements) = match section {
                Section::Elements { visibility, elements } => {
                    (visibility.unwrap_or(Visibility::Public), elements.as_slice())
                }
                _ => (Visibility::Public, [].as_slice()),
            };
            elements.iter().map(move |element| (visibility, element))
        })
    }

    /// The sections of a long class; none for a short one.
    pub(super) fn sections(&self) -> &[Section] {
        match &self.definition.specifier {
            ClassSpecifier::Long(long) => &long.sections,
            _ => &[],
        }
    }
}
