//! Maximum matching by augmenting paths.
//!
//! Each equation in turn searches depth first for a free unknown, moving other equations to other
//! unknowns on the way. Before it goes deeper, an equation looks for a free unknown of its own
//! (look-ahead). Cost O(equations × edges) at worst, near linear on models.

use super::Bipartite;

/// Pairs of equations and unknowns; no equation and no unknown occurs twice.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Matching {
    /// The unknown that an equation determines.
    pub equation_to_unknown: Vec<Option<usize>>,
    /// The equation that determines an unknown.
    pub unknown_to_equation: Vec<Option<usize>>,
}

impl Matching {
    /// Number of pairs.
    pub fn len(&self) -> usize {
        self.equation_to_unknown.iter().flatten().count()
    }

    /// Whether there is no pair.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Whether every equation and every unknown is matched.
    pub fn is_perfect(&self) -> bool {
        self.equation_to_unknown.iter().all(Option::is_some)
            && self.unknown_to_equation.iter().all(Option::is_some)
    }

    fn pair(&mut self, equation: usize, unknown: usize) {
        self.equation_to_unknown[equation] = Some(unknown);
        self.unknown_to_equation[unknown] = Some(equation);
    }
}

/// A matching with as many pairs as possible. Earlier unknowns of an equation are preferred.
pub fn match_equations(graph: &Bipartite) -> Matching {
    let mut search = Augmentation {
        graph,
        matching: Matching {
            equation_to_unknown: vec![None; graph.n_equations()],
            unknown_to_equation: vec![None; graph.n_unknowns()],
        },
        looked_ahead: vec![0; graph.n_equations()],
        next: vec![0; graph.n_equations()],
        visited_in: vec![usize::MAX; graph.n_unknowns()],
        path: Vec::new(),
    };
    for equation in 0..graph.n_equations() {
        search.augment(equation);
    }
    search.matching
}

struct Augmentation<'a> {
    graph: &'a Bipartite,
    matching: Matching,
    /// How many unknowns of each equation are known to be matched: they stay so.
    looked_ahead: Vec<usize>,
    /// The next unknown that each equation on the path will try.
    next: Vec<usize>,
    /// In which search each unknown was visited last.
    visited_in: Vec<usize>,
    /// Equations from the root down.
    path: Vec<usize>,
}

impl Augmentation<'_> {
    fn augment(&mut self, root: usize) {
        self.path.clear();
        self.enter(root);
        while let Some(&equation) = self.path.last() {
            if let Some(unknown) = self.free_unknown(equation) {
                return self.rematch_path(unknown);
            }
            match self.unvisited_unknown(equation, root) {
                Some(unknown) => {
                    let owner = self.matching.unknown_to_equation[unknown];
                    self.enter(owner.expect("an unknown that is not free is matched"));
                }
                None => {
                    self.path.pop();
                }
            }
        }
    }

    fn enter(&mut self, equation: usize) {
        self.next[equation] = 0;
        self.path.push(equation);
    }

    fn free_unknown(&mut self, equation: usize) -> Option<usize> {
        let unknowns = self.graph.unknowns(equation);
        while let Some(&unknown) = unknowns.get(self.looked_ahead[equation]) {
            if self.matching.unknown_to_equation[unknown].is_none() {
                return Some(unknown);
            }
            self.looked_ahead[equation] += 1;
        }
        None
    }

    fn unvisited_unknown(&mut self, equation: usize, search: usize) -> Option<usize> {
        let unknowns = self.graph.unknowns(equation);
        while let Some(&unknown) = unknowns.get(self.next[equation]) {
            self.next[equation] += 1;
            if self.visited_in[unknown] != search {
                self.visited_in[unknown] = search;
                return Some(unknown);
            }
        }
        None
    }

    /// Every equation of the path takes the unknown by which it was left; the last one the free one.
    fn rematch_path(&mut self, free: usize) {
        let mut unknown = free;
        while let Some(equation) = self.path.pop() {
            let released = self.matching.equation_to_unknown[equation];
            self.matching.pair(equation, unknown);
            match released {
                Some(released) => unknown = released,
                None => return,
            }
        }
    }
}
