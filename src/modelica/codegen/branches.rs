//! What is known in which branch while a tape is written.
//!
//! A branch ends where its if-expression ends, but the next if-expression with the same condition
//! takes the same branch: what the first computed is known there again. So an array that is set
//! under one condition costs one computation of what its elements share, not one for each.

use super::places::Places;
use crate::arithmetic::Register;
use crate::symbolic::Expr;
use rustc_hash::FxHashMap;
use std::hash::Hash;

/// The branches of one tape.
#[derive(Debug)]
pub(super) struct Branches {
    known: FxHashMap<Key, Branch>,
    is_open: Vec<bool>,
    /// Those around what is written now, innermost last; the first is what is in none.
    open: Vec<Branch>,
}

/// A branch by its number.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub(super) struct Branch(u32);

/// The branch around it, its condition, and whether it is taken where that holds.
type Key = (Branch, Register, bool);

impl Branches {
    pub(super) fn new() -> Branches {
        Branches { known: FxHashMap::default(), is_open: vec![true], open: vec![Branch(0)] }
    }

    /// Whether what is written now is in a branch.
    pub(super) fn is_inside(&self) -> bool {
        self.open.len() > 1
    }

    fn current(&self) -> Branch {
        *self.open.last().expect("an entry outside any branch is open")
    }

    fn fresh(&mut self) -> Branch {
        self.is_open.push(false);
        Branch(self.is_open.len() as u32 - 1)
    }

    fn open(&mut self, branch: Branch) {
        self.is_open[branch.0 as usize] = true;
        self.open.push(branch);
    }

    fn close(&mut self, branch: Branch) {
        self.is_open[branch.0 as usize] = false;
    }

    /// What follows is in a branch within the present one.
    pub(super) fn enter(&mut self, condition: Register, holds: bool) {
        let key = (self.current(), condition, holds);
        let branch = match self.known.get(&key) {
            Some(known) => *known,
            None => {
                let fresh = self.fresh();
                self.known.insert(key, fresh);
                fresh
            }
        };
        self.open(branch);
    }

    /// What follows is in the branch around the present one.
    pub(super) fn leave(&mut self) {
        let branch = self.open.pop().expect("a branch was entered");
        self.close(branch);
    }

    /// What follows may be executed from any branch: it knows what is in none, and itself.
    /// Returns the branches to continue with.
    pub(super) fn begin_routine(&mut self) -> Vec<Branch> {
        let suspended = self.open.split_off(1);
        suspended.iter().for_each(|branch| self.close(*branch));
        let fresh = self.fresh();
        self.open(fresh);
        suspended
    }

    pub(super) fn end_routine(&mut self, suspended: Vec<Branch>) {
        self.leave();
        suspended.into_iter().for_each(|branch| self.open(branch));
    }

    /// Branches that come are none of those that were, whatever their conditions.
    pub(super) fn forget(&mut self) {
        self.known.clear();
    }
}

/// What was computed in branches, with that in which it was computed last.
pub(super) type Inside<K> = FxHashMap<K, (Register, Branch)>;

/// The register of what was computed in a branch, if the present one knows it.
fn known_inside<K: Eq + Hash>(
    inside: &Inside<K>,
    key: &K,
    branches: &Branches,
) -> Option<Register> {
    let (register, branch) = inside.get(key)?;
    branches.is_open[branch.0 as usize].then_some(*register)
}

/// The registers of what was computed.
#[derive(Debug)]
pub(super) struct Computed<K> {
    /// In no branch.
    outside: FxHashMap<K, Register>,
    inside: Inside<K>,
}

impl<K: Eq + Hash> Computed<K> {
    pub(super) fn new() -> Computed<K> {
        Computed { outside: FxHashMap::default(), inside: FxHashMap::default() }
    }

    /// The register, if it was computed where the present branch knows it.
    pub(super) fn get(&self, key: &K, branches: &Branches) -> Option<Register> {
        let outside = self.outside.get(key).copied();
        outside.or_else(|| known_inside(&self.inside, key, branches))
    }

    pub(super) fn insert(&mut self, key: K, register: Register, branches: &Branches) {
        match branches.is_inside() {
            true => _ = self.inside.insert(key, (register, branches.current())),
            false => _ = self.outside.insert(key, register),
        }
    }

    /// What the branches know, which are suspended for a routine.
    pub(super) fn suspend(&mut self) -> Inside<K> {
        std::mem::take(&mut self.inside)
    }

    pub(super) fn resume(&mut self, inside: Inside<K>) {
        self.inside = inside;
    }
}

/// The same of expressions, which are asked for more often than all else: those in no branch are in
/// the [`Places`] of the registers.
#[derive(Debug, Default)]
pub(super) struct ComputedExpressions {
    inside: Inside<Expr>,
}

impl ComputedExpressions {
    pub(super) fn get(&self, e: Expr, places: &Places, branches: &Branches) -> Option<Register> {
        match places.get(e) {
            None if !self.inside.is_empty() => known_inside(&self.inside, &e, branches),
            known => known,
        }
    }

    pub(super) fn insert(
        &mut self,
        e: Expr,
        d: Register,
        places: &mut Places,
        branches: &Branches,
    ) {
        match branches.is_inside() {
            true => _ = self.inside.insert(e, (d, branches.current())),
            false => places.insert(e, d),
        }
    }

    pub(super) fn suspend(&mut self) -> Inside<Expr> {
        std::mem::take(&mut self.inside)
    }

    pub(super) fn resume(&mut self, inside: Inside<Expr>) {
        self.inside = inside;
    }
}
