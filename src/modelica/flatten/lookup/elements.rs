//! The components of a class, inherited ones included, and the classes that its equations come from
//! (MLS §7.1).
//!
//! A class shares what its first base class has: a chain of a thousand extends clauses is as long as
//! what is written in it, and not the square of that.

use crate::flatten::ids::ScopeId;
use crate::flatten::instantiate::instance::Declaration;
use crate::name::Ident;
use indexmap::IndexMap;
use std::rc::Rc;
use std::sync::Arc;

/// How many shared parts a name is searched in at most: more are copied into one.
const MAX_PARTS: usize = 64;

/// The most base classes that one class may have, those of its bases included.
pub(crate) const MAX_BASES: usize = 10_000;

/// The components of a class and the classes that its equations come from.
#[derive(Debug, Default)]
pub(crate) struct Elements {
    /// What the first base class gives.
    shared: Option<Rc<Elements>>,
    parts: usize,
    components: IndexMap<Ident, Arc<Declaration>>,
    /// Bases first, the class itself last.
    lineage: Vec<ScopeId>,
    bases: usize,
}

impl Elements {
    /// All of another class, which nothing comes before.
    pub(crate) fn sharing(base: &Rc<Elements>) -> Elements {
        if base.parts < MAX_PARTS {
            let shared = Some(base.clone());
            return Elements {
                shared,
                parts: base.parts + 1,
                bases: base.bases,
                ..Elements::default()
            };
        }
        let components = base.iter().map(|(name, one)| (name, one.clone())).collect();
        let lineage = base.lineage().collect();
        Elements { shared: None, parts: 0, components, lineage, bases: base.bases }
    }

    /// Whether it has no components and comes from no class.
    pub(crate) fn is_empty(&self) -> bool {
        self.shared.is_none() && self.components.is_empty() && self.lineage.is_empty()
    }

    /// The declaration of a component.
    pub(crate) fn get(&self, name: Ident) -> Option<&Arc<Declaration>> {
        let parts = std::iter::successors(Some(self), |part| part.shared.as_deref());
        parts.into_iter().find_map(|part| part.components.get(&name))
    }

    /// Whether there is a component of a name.
    pub(crate) fn contains(&self, name: Ident) -> bool {
        self.get(name).is_some()
    }

    /// The components in order, inherited ones first.
    pub(crate) fn iter(&self) -> impl Iterator<Item = (Ident, &Arc<Declaration>)> {
        let components = self.parts().into_iter().flat_map(|part| &part.components);
        components.map(|(name, declaration)| (*name, declaration))
    }

    /// Their names.
    pub(crate) fn names(&self) -> impl Iterator<Item = Ident> {
        self.iter().map(|(name, _)| name)
    }

    /// The classes that equations come from, bases first, the class itself last.
    pub(crate) fn lineage(&self) -> impl Iterator<Item = ScopeId> {
        self.parts().into_iter().flat_map(|part| part.lineage.iter().copied())
    }

    /// How many classes equations come from.
    pub(crate) fn bases(&self) -> usize {
        self.bases
    }

    /// Adds a component that is not there yet.
    pub(crate) fn add(&mut self, declaration: Arc<Declaration>) {
        self.components.insert(declaration.name, declaration);
    }

    /// Adds a class that equations come from.
    pub(crate) fn add_base(&mut self, base: ScopeId) {
        self.lineage.push(base);
        self.bases += 1;
    }

    /// What is shared, first, and itself, last.
    fn parts(&self) -> Vec<&Elements> {
        let mut parts: Vec<_> =
            std::iter::successors(Some(self), |part| part.shared.as_deref()).collect();
        parts.reverse();
        parts
    }
}
