//! What is known in which branch while a tape is written.
//!
//! A branch ends where its if-expression ends, but the next if-expression with the same condition
//! takes the same branch: what the first computed is known there again. So an array that is set
//! under one condition costs one computation of what its elements share, not one for each.

use super::tape::Register;
use rustc_hash::FxHashMap;
use std::hash::Hash;

/// The branches of one tape.
#[derive(Debug)]
pub(super) struct Branches {
    known: FxHashMap<Key, Branch>,
    is_open: Vec<bool>,
    current: Branch,
}

/// A branch by its number; the first is what stands in none.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub(super) struct Branch(u32);

/// The branch around it, its condition, and whether it is taken where that holds.
type Key = (Branch, Register, bool);

impl Branches {
    pub(super) fn new() -> Branches {
        Branches { known: FxHashMap::default(), is_open: vec![true], current: Branch(0) }
    }

    /// Whether what is written now stands in a branch.
    pub(super) fn is_inside(&self) -> bool {
        self.current != Branch(0)
    }

    /// What follows stands in a branch within the present one, which is returned for
    /// [`Branches::leave`].
    pub(super) fn enter(&mut self, condition: Register, holds: bool) -> Branch {
        let outer = self.current;
        let fresh = Branch(self.is_open.len() as u32);
        self.current = *self.known.entry((outer, condition, holds)).or_insert(fresh);
        if self.current == fresh {
            self.is_open.push(false);
        }
        self.is_open[self.current.0 as usize] = true;
        outer
    }

    /// What follows stands in the branch around the present one.
    pub(super) fn leave(&mut self, outer: Branch) {
        self.is_open[self.current.0 as usize] = false;
        self.current = outer;
    }

    /// Branches that come are none of those that were, whatever their conditions.
    pub(super) fn forget(&mut self) {
        self.known.clear();
    }
}

/// The registers of what was computed last, and in which branches.
#[derive(Debug)]
pub(super) struct Computed<K>(FxHashMap<K, (Register, Branch)>);

impl<K: Eq + Hash> Computed<K> {
    pub(super) fn new() -> Computed<K> {
        Computed(FxHashMap::default())
    }

    /// The register, if it was computed where the present branch knows it.
    pub(super) fn get(&self, key: &K, branches: &Branches) -> Option<Register> {
        let (register, branch) = self.0.get(key)?;
        branches.is_open[branch.0 as usize].then_some(*register)
    }

    pub(super) fn insert(&mut self, key: K, register: Register, branches: &Branches) {
        self.0.insert(key, (register, branches.current));
    }
}
