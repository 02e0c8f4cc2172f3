//! On which classes a translation depends: those at the top level that were looked at, whether they
//! were there or not, each with the source that it was loaded from. Whatever else is loaded afterwards
//! does not concern the model.

use super::stored::{Digest, digest};
use crate::name::{Ident, Name};
use crate::syntax::ast::StoredDefinition;
use std::collections::{BTreeMap, BTreeSet};

/// The sources from which classes were loaded, by their full names.
#[derive(Debug, Default)]
pub struct LoadedSources(BTreeMap<Name, Digest>);

/// The top-level names on which something depends, and what they meant.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Uses(BTreeMap<Ident, Digest>);

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

    /// What these top-level names mean.
    pub fn uses(&self, roots: &BTreeSet<Ident>) -> Uses {
        Uses(roots.iter().map(|root| (*root, self.of(*root))).collect())
    }

    /// Whether the names still mean what they did.
    pub(crate) fn are_unchanged(&self, uses: &Uses) -> bool {
        uses.0.iter().all(|(root, text)| self.of(*root) == *text)
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
