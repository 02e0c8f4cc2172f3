//! The loaded classes as a tree of packages (MLS ch. 13).

use super::errors::{UNKNOWN_CLASS, WRONG_RESTRICTION};
use crate::diag::{Diagnostic, suggest};
use crate::eval::Function;
use crate::fault;
use crate::name::{Ident, Name};
use crate::source::Span;
use crate::syntax::ast::{ClassDefinition, ClassSpecifier, Element, Section, StoredDefinition};
use indexmap::IndexMap;
use rustc_hash::FxHashMap;
use std::sync::Arc;

/// Number of a class in its [`Library`].
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct ClassId(u32);

/// A loaded class.
#[derive(Debug, Clone)]
pub struct LoadedClass {
    /// Its definition.
    pub definition: Arc<ClassDefinition>,
    /// The class that encloses it.
    pub parent: Option<ClassId>,
    /// The classes in it, whether written inside or loaded with `within`, in order.
    pub children: IndexMap<Ident, ClassId>,
}

/// All loaded classes. Classes are shared, never copied.
#[derive(Default)]
pub struct Library {
    classes: Vec<LoadedClass>,
    top: IndexMap<Ident, ClassId>,
    loader: Option<Box<dyn Loader + Send>>,
    pub(super) functions: FxHashMap<(Name, Name), Option<Arc<Function>>>,
}

/// Finds packages that are not loaded yet (MLS §13.4).
pub trait Loader {
    /// The files of the top-level class of this name, each parsed, in the order in which they are
    /// to be loaded; `None` if there is no such class.
    fn load(&mut self, name: Ident) -> Option<Result<Vec<StoredDefinition>, Vec<Diagnostic>>>;
}

impl std::fmt::Debug for Library {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Library").field("top", &self.top.keys()).finish_non_exhaustive()
    }
}

impl Library {
    /// An empty library.
    pub fn new() -> Library {
        Library::default()
    }

    /// Says who finds top-level classes that are not loaded.
    pub fn set_loader(&mut self, loader: impl Loader + Send + 'static) {
        self.loader = Some(Box::new(loader));
    }

    /// Loads the classes of a file, each in the package that `within` names; a class of the same
    /// name that was loaded before is replaced. Returns the full names.
    ///
    /// Fails if the package of `within` is not loaded.
    pub fn load(&mut self, file: StoredDefinition) -> Result<Vec<Name>, Diagnostic> {
        self.functions.clear();
        let parent = match &file.within {
            Some(within) if !within.node.parts.is_empty() => {
                Some(self.find(&within.node).ok_or_else(|| {
                    fault!(UNKNOWN_CLASS, "package `{}` is not loaded", within.node;
                        help: "load `{}` first", within.node)
                    .at(within.span)
                })?)
            }
            _ => None,
        };
        Ok(file.classes.into_iter().map(|class| self.add(parent, class)).collect())
    }

    /// Loads the files of a package directory, in the order of `package.order`: a file without
    /// `within` is put into the package that the first one defines.
    pub fn load_package(&mut self, files: Vec<StoredDefinition>) -> Result<Vec<Name>, Diagnostic> {
        let mut loaded: Vec<Name> = Vec::new();
        for mut file in files {
            if file.within.is_none()
                && let Some(root) = loaded.first()
            {
                let within = crate::source::Spanned { node: root.clone(), span: file.span };
                file.within = Some(within);
            }
            loaded.extend(self.load(file)?);
        }
        Ok(loaded)
    }

    /// Adds one class at the top level, such as one that a script defines.
    pub fn define(&mut self, class: Arc<ClassDefinition>) -> Name {
        self.functions.clear();
        self.add(None, class)
    }

    fn add(&mut self, parent: Option<ClassId>, class: Arc<ClassDefinition>) -> Name {
        let name = class.name.node;
        let id = self.insert(parent, class);
        match parent {
            Some(parent) => self.classes[parent.0 as usize].children.insert(name, id),
            None => self.top.insert(name, id),
        };
        self.full_name(id)
    }

    /// Adds the class and, with a list of work instead of recursion, all classes in it.
    fn insert(&mut self, parent: Option<ClassId>, class: Arc<ClassDefinition>) -> ClassId {
        let first = self.push(parent, class);
        let mut open = vec![first];
        while let Some(id) = open.pop() {
            let definition = self.class(id).definition.clone();
            for nested in nested_classes(&definition) {
                let child = self.push(Some(id), nested.clone());
                self.classes[id.0 as usize].children.insert(nested.name.node, child);
                open.push(child);
            }
        }
        first
    }

    fn push(&mut self, parent: Option<ClassId>, definition: Arc<ClassDefinition>) -> ClassId {
        self.classes.push(LoadedClass { definition, parent, children: IndexMap::new() });
        ClassId(self.classes.len() as u32 - 1)
    }

    /// The class of this number.
    pub fn class(&self, id: ClassId) -> &LoadedClass {
        &self.classes[id.0 as usize]
    }

    /// The class of this full name, following enclosing classes only (no inheritance, no imports).
    pub fn find(&self, name: &Name) -> Option<ClassId> {
        let (first, rest) = name.parts.split_first()?;
        let top = *self.top.get(first)?;
        rest.iter().try_fold(top, |id, part| self.class(id).children.get(part).copied())
    }

    /// Removes a top-level class. Returns whether there was one.
    pub fn remove(&mut self, name: Ident) -> bool {
        self.functions.clear();
        self.top.shift_remove(&name).is_some()
    }

    /// Removes all classes.
    pub fn clear(&mut self) {
        self.functions.clear();
        self.classes.clear();
        self.top.clear();
    }

    /// The top-level classes, in the order loaded.
    pub fn top_level(&self) -> impl Iterator<Item = (Ident, ClassId)> {
        self.top.iter().map(|(name, id)| (*name, *id))
    }

    /// The top-level class of this name, loaded now if need be.
    pub(super) fn top_class(&mut self, name: Ident) -> Result<Option<ClassId>, Diagnostic> {
        if let Some(id) = self.top.get(&name) {
            return Ok(Some(*id));
        }
        let Some(found) = self.loader.as_mut().and_then(|loader| loader.load(name)) else {
            return Ok(None);
        };
        let files = match found {
            Ok(files) => files,
            Err(errors) => return errors.into_iter().next().map_or(Ok(None), Err),
        };
        self.load_package(files)?;
        Ok(self.top.get(&name).copied())
    }

    /// The full name of a class.
    pub fn full_name(&self, id: ClassId) -> Name {
        let mut parts = Vec::new();
        let mut at = Some(id);
        while let Some(id) = at {
            let class = self.class(id);
            parts.push(class.definition.name.node);
            at = class.parent;
        }
        parts.reverse();
        Name::new(parts)
    }

    /// The full names of all classes, packages before what they hold.
    pub fn all_names(&self) -> Vec<Name> {
        let mut names = Vec::new();
        let mut open: Vec<ClassId> = self.top.values().rev().copied().collect();
        while let Some(id) = open.pop() {
            names.push(self.full_name(id));
            open.extend(self.class(id).children.values().rev());
        }
        names
    }

    /// The diagnostic for a class that is not there: the part that is missing, with a suggestion.
    pub fn unknown_class(&self, name: &Name, span: Span) -> Diagnostic {
        let mut known: Option<ClassId> = None;
        for part in &name.parts {
            let children = match known {
                None => &self.top,
                Some(id) => &self.class(id).children,
            };
            let Some(child) = children.get(part) else {
                let help = suggest::did_you_mean(part.as_str(), children.keys().map(|k| k.as_str()));
                let place = known.map_or(String::new(), |id| format!(" in `{}`", self.full_name(id)));
                return fault!(UNKNOWN_CLASS, "there is no class `{part}`{place}")
                    .help_if(help)
                    .at(span);
            };
            known = Some(*child);
        }
        fault!(WRONG_RESTRICTION, "`{name}` cannot be used here").at(span)
    }
}

/// The classes written in a class.
fn nested_classes(class: &ClassDefinition) -> Vec<Arc<ClassDefinition>> {
    let ClassSpecifier::Long(long) = &class.specifier else { return Vec::new() };
    let elements = long.sections.iter().filter_map(|section| match section {
        Section::Elements { elements, .. } => Some(elements),
        _ => None,
    });
    elements
        .flatten()
        .filter_map(|element| match element {
            Element::Class(element) => Some(element.class.clone()),
            _ => None,
        })
        .collect()
}
