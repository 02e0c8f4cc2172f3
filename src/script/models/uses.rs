//! On what a translation depends: classes at the top level that were looked at, whether they were
//! there or not, each with the source that it was loaded from, and the files that the model reads.
//! Whatever else is loaded afterwards does not concern the model.

use super::stored::{Answers, Digest, digest};
use crate::name::{Ident, Name};
use crate::syntax::ast::StoredDefinition;
use std::collections::{BTreeMap, BTreeSet};

/// The sources from which classes were loaded, by their full names.
#[derive(Debug, Default)]
pub struct LoadedSources(BTreeMap<Name, Digest>);

/// What something depends on.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Uses {
    /// Top-level names, and what they meant.
    classes: BTreeMap<Ident, Digest>,
    files: Answers,
}

impl Uses {
    /// What a model with these classes at the top level and these files depends on.
    pub(super) fn new(sources: &LoadedSources, roots: &BTreeSet<Ident>, files: &Answers) -> Uses {
        let classes = roots.iter().map(|root| (*root, sources.of(*root))).collect();
        Uses { classes, files: files.clone() }
    }

    /// Whether the classes are still what they were.
    pub(super) fn has_classes(&self, sources: &LoadedSources) -> bool {
        self.classes.iter().all(|(root, text)| sources.of(*root) == *text)
    }

    /// What was read of files and the environment.
    pub(super) fn files(&self) -> &Answers {
        &self.files
    }
}

impl LoadedSources {
    /// Classes were loaded from a text.
    pub fn note(&mut self, names: &[Name], text: &str) {
        let digest = digest(text.as_bytes());
        for name in names {
            // What was put into a package goes when the package is replaced; what stays of it
            // counts as changed.
            self.remove(name);
            self.0.insert(name.clone(), digest);
        }
    }

    /// A class was removed, with all in it.
    pub fn remove(&mut self, name: &Name) {
        self.0.retain(|known, _| !known.parts.starts_with(&name.parts));
    }

    /// All classes were removed.
    pub fn clear(&mut self) {
        self.0.clear();
    }

    /// Whether a class is what this text says.
    pub(super) fn is_from(&self, name: &Name, text: &str) -> bool {
        self.0.get(name) == Some(&digest(text.as_bytes()))
    }

    /// What a top-level name means.
    fn of(&self, root: Ident) -> Digest {
        let own = self.0.iter().filter(|(name, _)| name.first() == Some(root));
        let bytes = own.flat_map(|(name, text)| [name.to_string().as_bytes(), text].concat());
        digest(&bytes.collect::<Vec<u8>>())
    }
}

/// The full names of the classes of a file.
pub(super) fn names_in(file: &StoredDefinition) -> Vec<Name> {
    let around = file.within.as_ref().map(|within| within.node.clone()).unwrap_or_default();
    file.classes.iter().map(|class| around.child(class.name.node)).collect()
}
