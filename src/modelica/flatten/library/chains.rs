//! Which class of a lineage declares a name. Rows of classes with one base each are indexed by the
//! names that they declare, so that the length of a row does not matter.

use super::{ClassId, Library, locked};
use crate::name::Ident;
use rustc_hash::{FxHashMap, FxHashSet};
use std::sync::Arc;

/// Shorter rows are searched class by class.
const INDEXED: usize = 8;

/// The rows met so far.
#[derive(Debug, Default)]
pub(super) struct Chains {
    /// The row of a class, and its number in it.
    places: FxHashMap<ClassId, (Arc<Chain>, usize)>,
}

/// A class, its only base, the only base of that, and so on.
#[derive(Debug)]
struct Chain {
    classes: Vec<ClassId>,
    /// Numbers of the classes that declare a component or, marked by `true`, a class; ascending.
    names: FxHashMap<(Ident, bool), Vec<usize>>,
}

impl Library {
    /// The first of a class and its bases that declares a component of a name, or, if `or_class`, a
    /// class of that name in its file.
    pub(in crate::flatten) fn declaring(
        &self,
        class: ClassId,
        name: Ident,
        or_class: bool,
    ) -> Option<ClassId> {
        let mut seen = FxHashSet::default();
        let mut pending = vec![class];
        while let Some(class) = pending.pop() {
            let (chain, at) = self.chain(class);
            if let Some(found) = self.found_in(&chain, at, name, or_class) {
                return Some(found);
            }
            if let Some(last) = chain.classes.last().filter(|last| seen.insert(**last)) {
                pending.extend(self.declared_bases(*last).iter().rev());
            }
        }
        None
    }

    fn found_in(&self, chain: &Chain, at: usize, name: Ident, or_class: bool) -> Option<ClassId> {
        if chain.classes.len() < INDEXED {
            let declares = |class: &ClassId| self.declares(*class, name, or_class);
            return chain.classes[at..].iter().copied().find(declares);
        }
        let first = |is_class: bool| {
            let numbers = chain.names.get(&(name, is_class))?;
            numbers.get(numbers.partition_point(|number| *number < at)).copied()
        };
        let (component, class) = (first(false), first(true).filter(|_| or_class));
        Some(chain.classes[component.into_iter().chain(class).min()?])
    }

    fn declares(&self, class: ClassId, name: Ident, or_class: bool) -> bool {
        let class = self.class(class);
        class.component_element(name).is_some() || or_class && class.class_element(name).is_some()
    }

    /// The row of a class, and its number in it.
    fn chain(&self, class: ClassId) -> (Arc<Chain>, usize) {
        if let Some((chain, at)) = locked(&self.bases).chains.places.get(&class) {
            return (chain.clone(), *at);
        }
        let mut classes = vec![class];
        let mut seen: FxHashSet<ClassId> = [class].into_iter().collect();
        let mut last = class;
        while let [base] = *self.declared_bases(last)
            && !locked(&self.bases).chains.places.contains_key(&base)
            && seen.insert(base)
        {
            classes.push(base);
            last = base;
        }
        let chain = Arc::new(Chain { names: self.names_of(&classes), classes });
        let mut cache = locked(&self.bases);
        let places = chain.classes.iter().zip(0..).map(|(one, at)| (*one, (chain.clone(), at)));
        cache.chains.places.extend(places);
        drop(cache);
        (chain, 0)
    }

    fn names_of(&self, classes: &[ClassId]) -> FxHashMap<(Ident, bool), Vec<usize>> {
        let mut names: FxHashMap<(Ident, bool), Vec<usize>> = FxHashMap::default();
        if classes.len() >= INDEXED {
            for (at, class) in classes.iter().enumerate() {
                for name in self.class(*class).declared_names() {
                    names.entry(name).or_default().push(at);
                }
            }
        }
        names
    }
}
