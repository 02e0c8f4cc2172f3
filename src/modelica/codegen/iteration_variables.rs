//! Which algebraic unknowns the integrator holds.
//!
//! Those are the iteration variables of torn loops, and more where that keeps the Jacobian sparse.
//! A loop of neighbours (a layer of control volumes) is torn to few iteration variables, and a chain
//! of assignments leads from one neighbour to the next. Substituted into each other, the k-th
//! depends on all before it: the Jacobian gets a dense triangle, whose factorisation grows with the
//! cube of the length. The unknown of a long linear loop, solved in closed form, depends on all of
//! its neighbours, and they on it. Where the integrator holds the unknowns of such linear loops and
//! every so-manieth variable of a chain as well, the Jacobian is a band with a border again. These
//! are auxiliary: they are computed from the others when they are read.

use crate::causalize::{Assignment, Block, CausalizedDae};
use crate::symbolic::{Expr, Pool, VarId};
use rustc_hash::{FxHashMap, FxHashSet};

/// An assignment that depends on more unknowns than this makes its variable an unknown; loops with
/// more assignments than this are long.
const WIDEST: usize = 24;
/// Unknowns are added where the Jacobian gets smaller by this factor.
const GAIN: usize = 2;
/// With fewer unknowns a full Jacobian costs little.
const FEWEST: usize = 32;
/// Counting stops at this number of unknowns.
const MANY: usize = 256;

/// The algebraic unknowns of the integrator and what is computed from them.
pub(super) struct IterationVariables {
    /// Iteration variables of torn loops, then the auxiliary unknowns.
    pub(super) iteration: Vec<VarId>,
    pub(super) n_auxiliary: usize,
    /// What must be zero, one for each of them.
    pub(super) residuals: Vec<Expr>,
    /// All other variables, in order.
    pub(super) sequence: Vec<Assignment>,
}

impl IterationVariables {
    /// The form with the sparser Jacobian; `derivatives` are those of the states.
    pub(super) fn choose(
        pool: &mut Pool,
        sorted: &CausalizedDae,
        derivatives: &[Expr],
    ) -> IterationVariables {
        let plain = IterationVariables::plain(sorted);
        if sorted.states.len() + plain.iteration.len() < FEWEST {
            return plain;
        }
        let in_loops: FxHashSet<VarId> = long_loops(sorted)
            .flat_map(|block| block.assignments())
            .map(|assignment| assignment.variable)
            .collect();
        if in_loops.is_empty() {
            return plain;
        }
        let outputs = |held: &IterationVariables| [derivatives, &held.residuals].concat();
        let count = |found: &Dependence, outputs: &[Expr]| -> usize {
            outputs.iter().map(|output| found.set(pool, *output).len()).sum()
        };
        let whole = Dependence::of(pool, sorted, &plain, &FxHashSet::default());
        let opened = IterationVariables::opened(sorted);
        let cut = Dependence::of(pool, sorted, &opened, &in_loops);
        let added = opened.n_auxiliary + cut.cut.len();
        let entries = count(&cut, &outputs(&opened)) + added * WIDEST;
        if count(&whole, &outputs(&plain)) > GAIN * entries {
            opened.cut_at(pool, &cut.cut)
        } else {
            plain
        }
    }

    /// The iteration variables of torn loops alone.
    fn plain(sorted: &CausalizedDae) -> IterationVariables {
        let mut iteration = Vec::new();
        let mut residuals = Vec::new();
        for block in &sorted.blocks {
            residuals.extend(block.residuals());
            if let Block::Loop(torn) = block {
                iteration.extend(&torn.iteration);
            }
        }
        let sequence = sorted.blocks.iter().flat_map(|block| block.assignments()).copied();
        IterationVariables { iteration, n_auxiliary: 0, residuals, sequence: sequence.collect() }
    }

    /// With the unknowns of long linear loops.
    fn opened(sorted: &CausalizedDae) -> IterationVariables {
        let mut held = IterationVariables::plain(sorted);
        let linear = long_loops(sorted).filter_map(|block| match block {
            Block::Linear(solved) => Some(solved),
            Block::Assignment(_) | Block::Loop(_) => None,
        });
        for solved in linear {
            held.residuals.extend(solved.residuals.iter().map(|(residual, _)| *residual));
            held.add(&solved.unknowns);
        }
        held
    }

    /// With the variables of these assignments as well.
    fn cut_at(mut self, pool: &mut Pool, assignments: &[Assignment]) -> IterationVariables {
        for assignment in assignments {
            let unknown = pool.variable(assignment.variable);
            self.residuals.push(pool.sub(unknown, assignment.value));
        }
        let variables: Vec<VarId> = assignments.iter().map(|a| a.variable).collect();
        self.add(&variables);
        self
    }

    fn add(&mut self, unknowns: &[VarId]) {
        self.n_auxiliary += unknowns.len();
        self.iteration.extend(unknowns);
        let unknowns: FxHashSet<VarId> = unknowns.iter().copied().collect();
        self.sequence.retain(|assignment| !unknowns.contains(&assignment.variable));
    }
}

/// Loops of which the Jacobian may profit.
fn long_loops(sorted: &CausalizedDae) -> impl Iterator<Item = &Block> {
    sorted.blocks.iter().filter(|block| block.assignments().len() > WIDEST)
}

/// Unknowns by number, ascending; no more than [`MANY`].
type Set = Box<[u32]>;

/// Which unknowns every variable depends on.
struct Dependence {
    sets: FxHashMap<VarId, Set>,
    unknowns: u32,
    /// What became an unknown besides.
    cut: Vec<Assignment>,
}

impl Dependence {
    /// Follows all assignments; a variable of `may_be_cut` that depends on too much becomes an
    /// unknown.
    fn of(
        pool: &Pool,
        sorted: &CausalizedDae,
        held: &IterationVariables,
        may_be_cut: &FxHashSet<VarId>,
    ) -> Dependence {
        let mut found = Dependence { sets: FxHashMap::default(), unknowns: 0, cut: Vec::new() };
        let unknowns = sorted.states.iter().chain(&held.iteration);
        unknowns.for_each(|unknown| found.add_unknown(*unknown));
        for assignment in &held.sequence {
            let set = found.set(pool, assignment.value);
            if set.len() > WIDEST && may_be_cut.contains(&assignment.variable) {
                found.add_unknown(assignment.variable);
                found.cut.push(*assignment);
            } else {
                found.sets.insert(assignment.variable, set);
            }
        }
        found
    }

    fn add_unknown(&mut self, variable: VarId) {
        self.sets.insert(variable, [self.unknowns].into());
        self.unknowns += 1;
    }

    fn set(&self, pool: &Pool, e: Expr) -> Set {
        let variables = pool.variables(e);
        let sets = variables.iter().filter_map(|variable| self.sets.get(variable));
        let mut union: Vec<u32> = sets.flatten().copied().collect();
        union.sort_unstable();
        union.dedup();
        union.truncate(MANY);
        union.into_boxed_slice()
    }
}
