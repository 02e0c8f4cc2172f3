//! All loaded classes, as a tree of packages (MLS ch. 13).

mod bases;
mod chains;
mod conversion;
mod conversion_rules;
mod element_index;
mod files;
mod legacy;
mod machine_constants;
mod modifier_conversion;
mod old_names;
mod reading;
mod versions;

pub(super) use bases::BaseProperty;
pub use files::LibraryFiles;

use super::errors::UNKNOWN_CLASS;
use crate::diag::Diagnostic;
use crate::external::Resources;
use crate::fault;
use crate::name::{Ident, Name};
use crate::source::Span;
use crate::syntax::ast::{
    ClassDefinition, ClassSpecifier, Constraint, Element, ElementPrefixes, Extends, ImportKind,
    Section, StoredDefinition, Visibility,
};
use bases::BaseCache;
use conversion_rules::Conversions;
use element_index::ElementIndex;
use files::{Entry, Folder};
use indexmap::{IndexMap, IndexSet};
pub(super) use legacy::LegacyConstruct;
use legacy::LegacyConstructs;
use rustc_hash::FxHashMap;
use std::collections::BTreeSet;
use std::path::Path;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, OnceLock, PoisonError};

/// A class of a [`Library`].
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, Default)]
pub struct ClassId(u32);

/// The loaded classes. Classes are never changed; loading one again under the same name makes the
/// name mean the new one.
///
/// A class is read when it is asked for: its file first, if it lies in one of its own (MLS
/// §13.4.1), then its elements, but not those of the classes in it. What is wrong with the text of
/// a class is known only then: see [`Library::take_problems`].
#[derive(Debug, Default)]
pub struct Library {
    classes: Arc<boxcar::Vec<Slot>>,
    roots: IndexMap<Ident, ClassId>,
    /// Top-level names that were looked for and are not loaded.
    missing: Mutex<BTreeSet<Ident>>,
    /// The same since [`Library::forget_uses`].
    absent: Mutex<BTreeSet<Ident>>,
    /// What the classes extend, found so far; another cache as soon as a class is added.
    bases: Arc<Mutex<BaseCache>>,
    /// The classes that were asked for and could not be read.
    broken: Mutex<IndexSet<ClassId>>,
    legacy: LegacyConstructs,
    /// Another one as soon as a class is added.
    conversions: Arc<ConversionCache>,
    resources: Resources,
    /// Whether what the specification forbids but libraries do is an error.
    strict: bool,
}

/// A clone shares what was read and what either of them reads later. What was asked for in vain is
/// its own.
impl Clone for Library {
    fn clone(&self) -> Library {
        Library {
            classes: self.classes.clone(),
            roots: self.roots.clone(),
            missing: Mutex::default(),
            absent: Mutex::default(),
            bases: self.bases.clone(),
            broken: Mutex::default(),
            legacy: self.legacy.clone(),
            conversions: self.conversions.clone(),
            resources: self.resources.clone(),
            strict: self.strict,
        }
    }
}

/// How libraries are converted to the versions of others that are loaded, found so far.
#[derive(Debug, Default)]
struct ConversionCache {
    /// Whether any library is.
    is_any: OnceLock<bool>,
    /// By the classes at the top.
    rules: Mutex<FxHashMap<ClassId, Result<Conversions, Diagnostic>>>,
    /// Classes as if converted, where that changes them, in the order of all classes.
    classes: boxcar::Vec<OnceLock<Option<Box<Class>>>>,
}

/// A class that may not have been read yet.
#[derive(Debug, Clone)]
struct Slot {
    name: Name,
    parent: Option<ClassId>,
    declared: Declared,
    origin: Origin,
    class: OnceLock<Class>,
    /// Whether something was looked up in it since [`Library::forget_uses`].
    is_used: Flag,
}

/// What many threads may raise.
#[derive(Debug, Default)]
struct Flag(AtomicBool);

impl Clone for Flag {
    fn clone(&self) -> Flag {
        Flag(AtomicBool::new(self.0.load(Ordering::Relaxed)))
    }
}

/// What the class around it says of a class.
#[derive(Debug, Clone, Default)]
struct Declared {
    prefixes: ElementPrefixes,
    constraint: Option<Constraint>,
}

/// Where a class comes from.
#[derive(Debug, Clone)]
enum Origin {
    /// Its head was read; a package may have a folder.
    Head(Arc<ClassDefinition>, Option<Folder>),
    /// Only its file is known.
    File(Arc<dyn LibraryFiles>, Entry),
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
    /// Where its components and nested classes are declared.
    index: OnceLock<ElementIndex>,
    declared: Declared,
    /// What is wrong with its text.
    problems: Vec<Diagnostic>,
}

impl Library {
    /// A library without classes.
    pub fn new() -> Library {
        Library::default()
    }

    /// Says whether what the specification forbids but libraries do is an error.
    pub fn set_strict(&mut self, strict: bool) {
        self.strict = strict;
    }

    /// Whether what the specification forbids but libraries do is an error.
    pub fn is_strict(&self) -> bool {
        self.strict
    }

    /// Says which files models may use.
    pub fn set_resources(&mut self, resources: Resources) {
        self.resources = resources;
    }

    /// The files that models may use.
    pub fn resources(&self) -> &Resources {
        &self.resources
    }

    /// Adds the classes of a file and returns their full names. An error if the package named by
    /// `within` is not loaded, or if a class declares two classes of one name.
    pub fn load(&mut self, file: &StoredDefinition) -> Result<Vec<Name>, Diagnostic> {
        let parent = self.package_around(file)?;
        let mut names = Vec::new();
        for class in &file.classes {
            let former = self.named(parent, class.name.node);
            let id = self.add(Origin::Head(class.clone(), None), class.name.node, parent);
            if let Some(problem) = self.problems_below(id).into_iter().next() {
                return Err(problem);
            }
            self.keep_separate_files(former, id);
            names.push(self.slot(id).name.clone());
        }
        Ok(names)
    }

    /// Adds the classes of a file, or a package from its folder, without reading more than their
    /// heads now; they belong to the package `around`, if the file says nothing else. Returns their
    /// full names.
    ///
    /// # Errors
    /// The file cannot be read, has no class, or is within a package that is not loaded.
    pub fn load_lazily(
        &mut self,
        files: &Arc<dyn LibraryFiles>,
        path: &Path,
        around: &Name,
    ) -> Result<Vec<Name>, Diagnostic> {
        let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
        let stem = name.strip_suffix(".mo").unwrap_or(&name).to_owned();
        let package = path.join("package.mo");
        let entry = match files.is_file(&package) {
            true => Entry { file: package, folder: Some(path.to_owned()), stem },
            false => Entry { file: path.to_owned(), folder: None, stem },
        };
        let file = entry.heads(files.as_ref())?;
        let parent = match &file.within {
            Some(_) => self.package_around(&file)?,
            None => self.find(around),
        };
        if file.classes.is_empty() {
            return Err(fault!(UNKNOWN_CLASS, "there is no class in this file").at(file.span));
        }
        if entry.folder.is_some() {
            self.meet_folder(parent, &entry, &file);
        }
        let mut names = Vec::new();
        for (class, origin) in entry.classes(files, &file) {
            let id = self.add(origin, class, parent);
            names.push(self.slot(id).name.clone());
        }
        Ok(names)
    }

    /// Adds one class at the top level, as a script defines it.
    pub fn define(&mut self, class: &Arc<ClassDefinition>) -> Result<Name, Diagnostic> {
        let span = class.span;
        let file = StoredDefinition { within: None, classes: vec![class.clone()], span };
        self.load(&file)?;
        Ok(Name::from(class.name.node))
    }

    /// The class that the `within` clause of a file names.
    fn package_around(&self, file: &StoredDefinition) -> Result<Option<ClassId>, Diagnostic> {
        let Some(within) = file.within.as_ref().filter(|within| !within.node.parts.is_empty())
        else {
            return Ok(None);
        };
        let found = self.find(&within.node);
        found.map(Some).ok_or_else(|| {
            fault!(UNKNOWN_CLASS, "package `{}` of the within clause is not loaded", within.node;
                help: "load the package's own file, `package.mo`, first")
            .at(within.span)
        })
    }

    fn named(&self, parent: Option<ClassId>, name: Ident) -> Option<ClassId> {
        match parent {
            Some(parent) => self.class(parent).children.get(&name).copied(),
            None => self.roots.get(&name).copied(),
        }
    }

    /// Makes a name in a package, or at the top level, mean another class.
    fn add(&mut self, origin: Origin, name: Ident, parent: Option<ClassId>) -> ClassId {
        let id = self.push(origin, Declared::default(), name, parent);
        match parent {
            Some(parent) => {
                self.read(parent);
                if let Some(class) = self.class_mut(parent) {
                    class.children.insert(name, id);
                }
            }
            None => {
                self.roots.insert(name, id);
            }
        }
        self.bases = Arc::default();
        self.conversions = Arc::default();
        id
    }

    fn push(
        &self,
        origin: Origin,
        declared: Declared,
        name: Ident,
        parent: Option<ClassId>,
    ) -> ClassId {
        let name = match parent {
            Some(parent) => self.slot(parent).name.child(name),
            None => Name::from(name),
        };
        let class = OnceLock::new();
        let is_used = Flag::default();
        ClassId(self.classes.push(Slot { name, parent, declared, origin, class, is_used }) as u32)
    }

    fn class_mut(&mut self, id: ClassId) -> Option<&mut Class> {
        Arc::make_mut(&mut self.classes).get_mut(id.0 as usize)?.class.get_mut()
    }

    /// A package read again from its own file keeps the classes that lie in files beside it. They are
    /// read again when they are needed: what encloses them is another class now.
    fn keep_separate_files(&mut self, former: Option<ClassId>, id: ClassId) {
        let Some(former) = former else { return };
        let source = self.class(former).definition.span.source;
        let elsewhere = |child: ClassId| match &self.slot(child).origin {
            Origin::Head(definition, _) => definition.span.source != source,
            Origin::File(..) => true,
        };
        let own = &self.read(id).children;
        let children = self.read(former).children.iter();
        let kept: Vec<(Ident, ClassId)> = children
            .filter(|(name, child)| !own.contains_key(*name) && elsewhere(**child))
            .map(|(name, child)| (*name, *child))
            .collect();
        let again = |(name, child): &(Ident, ClassId)| {
            let Slot { origin, declared, .. } = self.slot(*child).clone();
            (*name, self.push(origin, declared, *name, Some(id)))
        };
        let read_again: Vec<(Ident, ClassId)> = kept.iter().map(again).collect();
        if let Some(class) = self.class_mut(id) {
            class.children.extend(read_again.iter().copied());
        }
        // What was converted before does not have them.
        self.conversions = Arc::default();
        // Those in a folder are found again; what was put into a package by itself is not.
        for ((_, child), (_, new)) in kept.into_iter().zip(read_again) {
            let slot = self.slot(child);
            if matches!(slot.origin, Origin::Head(_, None)) && slot.class.get().is_some() {
                self.keep_separate_files(Some(child), new);
            }
        }
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
        self.conversions = Arc::default();
        self.roots.shift_remove(&name).is_some()
    }

    /// Full names of all classes, in order of loading, outer before inner. What was not read yet
    /// is read now.
    pub fn all(&self) -> Vec<Name> {
        self.roots().flat_map(|root| self.all_in(&root.into())).collect()
    }

    /// The same for one class, which comes first, and those in it; none if it is not loaded.
    pub fn all_in(&self, name: &Name) -> Vec<Name> {
        let ids = self.find(name).map_or(Vec::new(), |id| self.below(id, |_| true));
        ids.into_iter().map(|id| self.slot(id).name.clone()).collect()
    }

    /// Full names of the classes that are known without reading more, in the order of
    /// [`Library::all`].
    pub fn known(&self) -> Vec<Name> {
        let is_read = |id: ClassId| self.slot(id).class.get().is_some();
        let ids = self.roots.values().flat_map(|root| self.below(*root, is_read));
        ids.map(|id| self.slot(id).name.clone()).collect()
    }

    /// How many classes were read so far.
    pub fn number_read(&self) -> usize {
        self.classes.iter().filter(|(_, slot)| slot.class.get().is_some()).count()
    }

    /// Full names of the classes that were read so far, because something was looked up in them.
    pub fn read_names(&self) -> BTreeSet<Name> {
        let read = self.classes.iter().filter(|(_, slot)| slot.class.get().is_some());
        read.map(|(_, slot)| slot.name.clone()).collect()
    }

    /// Reads a class and all that are in it, and returns the errors in their source text.
    pub fn read_all(&self, name: &Name) -> Vec<Diagnostic> {
        let all = self.find(name).map_or(Vec::new(), |id| self.below(id, |_| true));
        all.into_iter().flat_map(|id| self.seen(id).problems.clone()).collect()
    }

    /// A class and those in it, outer before inner; of those inside only where `enter` allows.
    fn below(&self, id: ClassId, enter: impl Fn(ClassId) -> bool) -> Vec<ClassId> {
        let mut found = Vec::new();
        let mut pending = vec![id];
        while let Some(id) = pending.pop() {
            found.push(id);
            if enter(id) {
                pending.extend(self.read(id).children.values().rev());
            }
        }
        found
    }

    fn problems_below(&self, id: ClassId) -> Vec<Diagnostic> {
        let all = self.below(id, |_| true);
        all.into_iter().flat_map(|id| self.read(id).problems.clone()).collect()
    }

    /// The errors in the source text of the classes that were requested since the last call. What
    /// was made of these classes is worth nothing.
    pub fn take_problems(&self) -> Vec<Diagnostic> {
        let broken = std::mem::take(&mut *locked(&self.broken));
        broken.into_iter().flat_map(|id| self.seen(id).problems.clone()).collect()
    }

    /// Warnings about the libraries read since the last call, each kind once for a library.
    pub fn take_warnings(&self) -> Vec<Diagnostic> {
        self.legacy.take()
    }

    /// The top-level names that were looked for in vain since the last call, sorted: who has the
    /// files can load them and try again.
    pub fn take_missing(&self) -> BTreeSet<Ident> {
        std::mem::take(&mut *locked(&self.missing))
    }

    /// Notes that the library of a class has a construct, at a place.
    pub(super) fn meet(&self, class: &Name, construct: LegacyConstruct, span: Span) {
        self.legacy.meet(class.first(), construct, span);
    }

    /// Whether a library was written for an old Modelica, as far as its legacy constructs show.
    pub(super) fn is_old(&self, library: Ident) -> bool {
        self.legacy.is_old(library)
    }

    pub(super) fn root(&self, name: Ident) -> Option<ClassId> {
        let found = self.roots.get(&name).copied();
        if found.is_none() {
            locked(&self.missing).insert(name);
            locked(&self.absent).insert(name);
        }
        found
    }

    /// From here on it is noted which classes are used: see [`Library::uses`].
    pub fn forget_uses(&self) {
        self.classes.iter().for_each(|(_, slot)| slot.is_used.0.store(false, Ordering::Relaxed));
        locked(&self.absent).clear();
    }

    /// The top-level names on which everything depends that was looked up since
    /// [`Library::forget_uses`]: those of the classes, and those that no class had.
    pub fn uses(&self) -> BTreeSet<Ident> {
        let used = self.classes.iter().filter(|(_, slot)| slot.is_used.0.load(Ordering::Relaxed));
        let roots = used.filter_map(|(_, slot)| slot.name.first());
        roots.chain(locked(&self.absent).iter().copied()).collect()
    }

    /// A class, read now if it was not.
    pub(super) fn class(&self, id: ClassId) -> &Class {
        self.slot(id).is_used.0.store(true, Ordering::Relaxed);
        let class = self.seen(id);
        if !class.problems.is_empty() {
            locked(&self.broken).insert(id);
        }
        class
    }

    /// A class as those that use it see it: converted, if its library is.
    fn seen(&self, id: ClassId) -> &Class {
        self.as_converted(id).unwrap_or_else(|| self.read(id))
    }

    /// Whether a nested class stands for an inherited one: `redeclare` (MLS §7.3); known
    /// without reading it. `model extends M` alone is a class beside the inherited one.
    pub(super) fn is_redeclaration(&self, id: ClassId) -> bool {
        self.slot(id).declared.prefixes.redeclare
    }

    fn slot(&self, id: ClassId) -> &Slot {
        &self.classes[id.0 as usize]
    }
}

/// What a mutex holds; a panic elsewhere leaves these sets whole.
fn locked<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

impl Class {
    /// Its full name.
    pub(super) fn name(&self) -> &Name {
        &self.name
    }

    pub(super) fn definition(&self) -> &Arc<ClassDefinition> {
        &self.definition
    }

    /// The class of this name that is declared in it, or lies in its folder.
    pub(super) fn child(&self, name: Ident) -> Option<ClassId> {
        self.children.get(&name).copied()
    }

    /// All these, in order.
    pub(super) fn children(&self) -> impl Iterator<Item = (Ident, ClassId)> {
        self.children.iter().map(|(name, id)| (*name, *id))
    }

    pub(super) fn imports(&self) -> &[ImportKind] {
        &self.imports
    }

    /// The text before its keyword in the enclosing class; nothing for one in a separate file.
    pub(super) fn prefixes(&self) -> ElementPrefixes {
        self.declared.prefixes
    }

    /// Its `constrainedby`.
    pub(super) fn constraint(&self) -> Option<&Constraint> {
        self.declared.constraint.as_ref()
    }

    /// Whether it is written `model extends M … end M` (MLS §7.3.1).
    pub(super) fn is_class_extends(&self) -> bool {
        match &self.definition.specifier {
            ClassSpecifier::Long(long) => long.class_extends.is_some(),
            _ => false,
        }
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
