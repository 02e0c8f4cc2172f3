//! What classes inherit from which others, found once: chains of a thousand extends clauses are
//! followed by every check of every class in them.

use super::chains::Chains;
use super::{ClassId, Library, locked};
use rustc_hash::{FxHashMap, FxHashSet};
use std::sync::Arc;
use std::thread::ThreadId;

/// What was found out about base classes; another one as soon as a class is added.
#[derive(Debug, Default)]
pub(super) struct BaseCache {
    /// The classes that a class extends.
    known: FxHashMap<ClassId, Arc<[ClassId]>>,
    /// Classes whose bases a thread is looking up: one that needs its own bases for that has none.
    busy: FxHashSet<(ThreadId, ClassId)>,
    /// Where a search for nested classes continues: the first class on the way that has some, or
    /// several bases.
    forks: FxHashMap<ClassId, ClassId>,
    /// The first class among a class and its bases that answers a question.
    answers: FxHashMap<(ClassId, BaseProperty), Option<ClassId>>,
    /// Rows of classes with one base each.
    pub(super) chains: Chains,
}

/// What is asked about a class and its bases.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub(in crate::flatten) enum BaseProperty {
    /// Which is short for, or extends, a predefined type?
    Predefined,
    /// Which is an enumeration?
    Enumeration,
    /// Which cannot be extended together with others?
    Alone,
    /// Which has components, equations or algorithms?
    Content,
    /// Which has more than a package may have?
    NoPackage,
    /// Which may have elements that no declaration shows?
    Open,
}

impl Library {
    /// The classes that a class extends as `find` finds them, each looked up once.
    pub(in crate::flatten) fn bases_once(
        &self,
        class: ClassId,
        find: impl FnOnce() -> Vec<ClassId>,
    ) -> Arc<[ClassId]> {
        if let Some(known) = locked(&self.bases).known.get(&class) {
            return known.clone();
        }
        let thread = std::thread::current().id();
        if !locked(&self.bases).busy.insert((thread, class)) {
            return Arc::default();
        }
        let found: Arc<[ClassId]> = find().into();
        let mut cache = locked(&self.bases);
        cache.busy.remove(&(thread, class));
        cache.known.insert(class, found.clone());
        found
    }

    /// The class from which on a nested class is to be searched: classes without any, and with one
    /// base that is known already, are passed.
    pub(in crate::flatten) fn fork(&self, class: ClassId) -> ClassId {
        let mut way = FxHashSet::default();
        let mut at = class;
        // A class that has been met extends itself.
        while let Some(next) = self.passed(at).filter(|_| way.insert(at)) {
            at = next;
        }
        let mut cache = locked(&self.bases);
        if !way.is_empty() && (!self.class(at).children.is_empty() || cache.known.contains_key(&at))
        {
            cache.forks.extend(way.into_iter().map(|one| (one, at)));
        }
        at
    }

    /// Where a search continues from a class that has no nested classes and one known base.
    fn passed(&self, class: ClassId) -> Option<ClassId> {
        if !self.class(class).children.is_empty() {
            return None;
        }
        let cache = locked(&self.bases);
        match (cache.forks.get(&class), cache.known.get(&class).map(|bases| &**bases)) {
            (Some(fork), _) => Some(*fork),
            (None, Some([base])) => Some(*base),
            _ => None,
        }
    }

    /// The first class of a lineage that answers a question. The answer holds for all that come
    /// before the first one with several bases.
    pub(in crate::flatten) fn first_answer(
        &self,
        question: BaseProperty,
        lineage: impl Iterator<Item = (ClassId, bool)>,
        answers: impl Fn(ClassId) -> bool,
    ) -> Option<ClassId> {
        let mut way = Vec::new();
        let mut found = None;
        for (id, is_alone) in lineage {
            if is_alone {
                if let Some(known) = locked(&self.bases).answers.get(&(id, question)) {
                    found = *known;
                    break;
                }
                way.push(id);
            }
            if answers(id) {
                found = Some(id);
                break;
            }
        }
        let mut cache = locked(&self.bases);
        cache.answers.extend(way.into_iter().map(|one| ((one, question), found)));
        found
    }
}
