//! Tearing: the unknowns of a block that have to be iterated so that the others follow one by one.
//!
//! ```text
//! repeat
//!     while an equation has one undetermined unknown left, and may be solved for it:
//!         let it determine that unknown
//!     iterate over the unknown that makes most equations solvable so
//! until every unknown is determined or iterated; the equations left are residuals
//! ```
//!
//! What each unknown would make solvable is kept from one choice to the next, so that a block of
//! thousands of unknowns is torn in a time linear in what it contains.
//!
//! The smallest set is NP-hard to find; the greedy choice is that of
//! [Cellier & Kofman 2006](crate::bibliography#cellier-kofman-2006) and
//! [Carpanzano & Maffezzoni 1998](crate::bibliography#carpanzano-maffezzoni-1998).

use super::Bipartite;
use std::cmp::Reverse;
use std::collections::BinaryHeap;

/// How a block is torn.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Tearing {
    /// The iteration variables, in the order chosen.
    pub iteration_unknowns: Vec<usize>,
    /// Equations and the unknown each determines, in solving order.
    pub assignments: Vec<(usize, usize)>,
    /// The equations left; as many as iteration variables if the block is square.
    pub residual_equations: Vec<usize>,
}

/// Tears a block; `solvable(equation, unknown)` tells whether the equation may be solved for the
/// unknown (linear in it, divisor never small).
pub fn tear(graph: &Bipartite, solvable: impl Fn(usize, usize) -> bool) -> Tearing {
    let transposed = graph.transposed();
    let mut state = State {
        graph,
        transposed: &transposed,
        solvable,
        undetermined: (0..graph.n_equations()).map(|e| graph.unknowns(e).len()).collect(),
        determined: vec![false; graph.n_unknowns()],
        used: vec![false; graph.n_equations()],
        candidates: BinaryHeap::new(),
        gains: vec![Gain::default(); graph.n_unknowns()],
        by_gain: BinaryHeap::new(),
        outdated: (0..graph.n_unknowns()).collect(),
        tearing: Tearing::default(),
    };
    for equation in 0..graph.n_equations() {
        state.offer(equation);
    }
    loop {
        state.propagate();
        match state.best_iteration_unknown() {
            Some(unknown) => {
                state.tearing.iteration_unknowns.push(unknown);
                state.determine(unknown);
            }
            None => break,
        }
    }
    state.tearing.residual_equations =
        (0..graph.n_equations()).filter(|e| !state.used[*e]).collect();
    state.tearing
}

struct State<'a, S> {
    graph: &'a Bipartite,
    transposed: &'a Bipartite,
    solvable: S,
    /// Number of undetermined unknowns of each equation.
    undetermined: Vec<usize>,
    determined: Vec<bool>,
    /// Whether the equation determines an unknown.
    used: Vec<bool>,
    /// Equations with one undetermined unknown left, the first on top.
    candidates: BinaryHeap<Reverse<usize>>,
    /// What each unknown gains, but for those that are outdated.
    gains: Vec<Gain>,
    /// Undetermined unknowns, the best on top; those whose gain is another now are here again.
    by_gain: BinaryHeap<(Gain, Reverse<usize>)>,
    /// Unknowns whose gain may have changed.
    outdated: Vec<usize>,
    tearing: Tearing,
}

/// How many equations an unknown makes solvable, whether no equation can be solved for it, and how
/// many equations it is in.
type Gain = (usize, bool, usize);

impl<S: Fn(usize, usize) -> bool> State<'_, S> {
    fn offer(&mut self, equation: usize) {
        if self.undetermined[equation] == 1 && !self.used[equation] {
            self.candidates.push(Reverse(equation));
        }
    }

    fn propagate(&mut self) {
        while let Some(Reverse(equation)) = self.candidates.pop() {
            let left = self.graph.unknowns(equation).iter().find(|u| !self.determined[**u]);
            let Some(&unknown) = left else { continue };
            if (self.solvable)(equation, unknown) {
                self.used[equation] = true;
                self.outdate(equation);
                self.tearing.assignments.push((equation, unknown));
                self.determine(unknown);
            }
        }
    }

    fn determine(&mut self, unknown: usize) {
        self.determined[unknown] = true;
        let transposed = self.transposed;
        for equation in transposed.unknowns(unknown) {
            self.undetermined[*equation] -= 1;
            self.offer(*equation);
            // With more unknowns left it releases nothing, whatever is determined.
            if self.undetermined[*equation] <= 2 {
                self.outdate(*equation);
            }
        }
    }

    /// The gains of the unknowns left in an equation may have changed.
    fn outdate(&mut self, equation: usize) {
        let left = self.graph.unknowns(equation).iter().filter(|u| !self.determined[**u]);
        self.outdated.extend(left);
    }

    /// The undetermined unknown that makes most equations solvable at once; among these the one
    /// that no equation can be solved for, then the one in most equations, then the first.
    fn best_iteration_unknown(&mut self) -> Option<usize> {
        let mut outdated = std::mem::take(&mut self.outdated);
        outdated.sort_unstable();
        outdated.dedup();
        for unknown in outdated {
            let gain = self.gain(unknown);
            if !self.determined[unknown] {
                self.gains[unknown] = gain;
                self.by_gain.push((gain, Reverse(unknown)));
            }
        }
        while let Some((gain, Reverse(unknown))) = self.by_gain.pop() {
            if !self.determined[unknown] && gain == self.gains[unknown] {
                return Some(unknown);
            }
        }
        None
    }

    fn gain(&self, unknown: usize) -> Gain {
        let open = || self.transposed.unknowns(unknown).iter().filter(|e| !self.used[**e]);
        let released = open().filter(|e| self.is_released(**e, unknown)).count();
        let never_solved = !open().any(|e| (self.solvable)(*e, unknown));
        (released, never_solved, open().count())
    }

    /// Whether the equation could be solved as soon as `unknown` is determined.
    fn is_released(&self, equation: usize, unknown: usize) -> bool {
        if self.undetermined[equation] != 2 {
            return false;
        }
        let mut left = self.graph.unknowns(equation).iter().filter(|u| !self.determined[**u]);
        left.find(|u| **u != unknown).is_some_and(|other| (self.solvable)(equation, *other))
    }
}
