//! A class and all that it extends or is short for, in the order in which names are searched.

use crate::flatten::library::{ClassId, Library};
use rustc_hash::FxHashSet;
use std::sync::Arc;

/// The most base classes that a class is followed to.
const MAX_BASES: usize = 10_000;

/// Goes through a class and its bases, each once.
pub(crate) struct Lineage<'a> {
    library: &'a Library,
    seen: FxHashSet<ClassId>,
    pending: Vec<ClassId>,
    /// The bases of the class given last, not yet pending.
    bases: Option<ClassId>,
    /// Whether no class so far has several bases: what the rest of the lineage is for one of them it
    /// is for all.
    is_alone: bool,
}

impl<'a> Lineage<'a> {
    /// The lineage of a class, itself first.
    pub(crate) fn of(library: &'a Library, class: ClassId) -> Lineage<'a> {
        let seen = FxHashSet::default();
        Lineage { library, seen, pending: vec![class], bases: None, is_alone: true }
    }

    /// Puts the bases of the class given last before what is pending: no one reads those of the
    /// last one that is needed.
    fn descend(&mut self) {
        let Some(class) = self.bases.take() else { return };
        let bases: Arc<[ClassId]> = self.library.declared_bases(class);
        self.is_alone &= bases.len() < 2;
        self.pending.extend(bases.iter().rev());
    }
}

impl Iterator for Lineage<'_> {
    type Item = (ClassId, bool);

    fn next(&mut self) -> Option<(ClassId, bool)> {
        self.descend();
        while let Some(class) = self.pending.pop() {
            if self.seen.len() < MAX_BASES && self.seen.insert(class) {
                self.bases = Some(class);
                return Some((class, self.is_alone));
            }
        }
        None
    }
}
