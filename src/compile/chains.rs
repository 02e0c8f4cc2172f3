//! Long chains of assignments in loops.
//!
//! A loop of neighbours (a layer of control volumes) is torn to few iteration variables, and a chain
//! of assignments leads from one neighbour to the next. Substituted into each other, the k-th
//! depends on all before it: the Jacobian gets a dense triangle, whose factorisation grows with the
//! cube of the length. Where the integrator holds the iteration variables as algebraic unknowns, it
//! may hold every so-manieth variable of the chain, too, and the Jacobian is a band again.

use crate::dae::{Assignment, Block, SortedDae};
use crate::symbolic::{Expr, Pool, VarId};
use rustc_hash::{FxHashMap, FxHashSet};

/// An assignment that depends on more unknowns than this makes its variable an unknown.
const WIDEST: u32 = 24;
/// Unknowns are added where the Jacobian gets smaller by this factor.
const GAIN: usize = 2;

/// A set of unknowns by number.
type Set = Box<[u64]>;

/// Assignments of loops whose variables become unknowns; none where that does not pay. `unknowns`:
/// those there are; `outputs`: what is differentiated for them.
pub(super) fn cut_chains(
    pool: &Pool,
    sorted: &SortedDae,
    unknowns: &[VarId],
    outputs: &[Expr],
) -> Vec<Assignment> {
    let in_loops: FxHashSet<VarId> = loop_assignments(sorted).map(|a| a.variable).collect();
    if in_loops.len() <= WIDEST as usize {
        return Vec::new();
    }
    let whole = Dependence::of(pool, sorted, unknowns, &FxHashSet::default());
    let cut = Dependence::of(pool, sorted, unknowns, &in_loops);
    let added = cut.unknowns - unknowns.len();
    let entries = |dependence: &Dependence| -> usize {
        outputs.iter().map(|output| count(&dependence.set(pool, *output)) as usize).sum()
    };
    if entries(&whole) > GAIN * (entries(&cut) + added * WIDEST as usize) {
        cut.cut
    } else {
        Vec::new()
    }
}

fn loop_assignments(sorted: &SortedDae) -> impl Iterator<Item = &Assignment> {
    sorted
        .blocks
        .iter()
        .filter(|block| matches!(block, Block::Loop(_)))
        .flat_map(|block| block.assignments())
}

/// Which unknowns every variable depends on.
struct Dependence {
    sets: FxHashMap<VarId, Set>,
    words: usize,
    /// Number of unknowns, those added included.
    unknowns: usize,
    cut: Vec<Assignment>,
}

impl Dependence {
    /// Follows all assignments; a variable of `may_be_cut` that depends on too much becomes an
    /// unknown.
    fn of(
        pool: &Pool,
        sorted: &SortedDae,
        unknowns: &[VarId],
        may_be_cut: &FxHashSet<VarId>,
    ) -> Dependence {
        let words = (unknowns.len() + may_be_cut.len()).div_ceil(64);
        let mut found =
            Dependence { sets: FxHashMap::default(), words, unknowns: 0, cut: Vec::new() };
        unknowns.iter().for_each(|unknown| found.add_unknown(*unknown));
        for assignment in sorted.blocks.iter().flat_map(|block| block.assignments()) {
            let set = found.set(pool, assignment.value);
            if count(&set) > WIDEST && may_be_cut.contains(&assignment.variable) {
                found.add_unknown(assignment.variable);
                found.cut.push(*assignment);
            } else {
                found.sets.insert(assignment.variable, set);
            }
        }
        found
    }

    fn add_unknown(&mut self, variable: VarId) {
        let mut set = vec![0; self.words].into_boxed_slice();
        set[self.unknowns / 64] = 1 << (self.unknowns % 64);
        self.unknowns += 1;
        self.sets.insert(variable, set);
    }

    fn set(&self, pool: &Pool, e: Expr) -> Set {
        let mut union = vec![0; self.words].into_boxed_slice();
        for set in pool.variables(e).iter().filter_map(|variable| self.sets.get(variable)) {
            union.iter_mut().zip(set).for_each(|(all, some)| *all |= some);
        }
        union
    }
}

fn count(set: &Set) -> u32 {
    set.iter().map(|word| word.count_ones()).sum()
}
