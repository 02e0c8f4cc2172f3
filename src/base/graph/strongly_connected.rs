//! Strongly connected components, dependencies first.
//!
//! Reference: [Tarjan 1972](crate::bibliography#tarjan-1972), with an explicit stack.

use super::{Bipartite, Matching};

/// The blocks of a perfectly matched system in solving order: an equation depends on the equations
/// that determine its other unknowns. Equations within a block ascend.
///
/// # Panics
/// If the matching is not perfect.
pub fn blocks(graph: &Bipartite, matching: &Matching) -> Vec<Vec<usize>> {
    let mut starts = vec![0];
    let mut targets = Vec::new();
    for equation in 0..graph.n_equations() {
        let owners = graph.unknowns(equation).iter().map(|unknown| {
            matching.unknown_to_equation[*unknown].expect("blocks need a perfect matching")
        });
        targets.extend(owners.filter(|owner| *owner != equation));
        starts.push(targets.len());
    }
    strongly_connected(graph.n_equations(), |e| &targets[starts[e]..starts[e + 1]])
}

/// The strongly connected components of the graph of nodes 0 to n − 1: each component comes after
/// those that its successors belong to. Nodes within a component ascend.
pub fn strongly_connected<'a>(
    n: usize,
    successors: impl Fn(usize) -> &'a [usize],
) -> Vec<Vec<usize>> {
    let mut tarjan = Tarjan {
        order: vec![UNSEEN; n],
        low: vec![0; n],
        next: vec![0; n],
        open: Vec::new(),
        is_open: vec![false; n],
        path: Vec::new(),
        seen: 0,
        components: Vec::new(),
    };
    for root in 0..n {
        if tarjan.order[root] == UNSEEN {
            tarjan.search(root, &successors);
        }
    }
    tarjan.components
}

const UNSEEN: usize = usize::MAX;

struct Tarjan {
    /// When each node was seen first.
    order: Vec<usize>,
    /// The earliest open node that each node is known to reach.
    low: Vec<usize>,
    /// The next successor to visit.
    next: Vec<usize>,
    /// Nodes whose component is not complete.
    open: Vec<usize>,
    is_open: Vec<bool>,
    /// Nodes from the root down.
    path: Vec<usize>,
    seen: usize,
    components: Vec<Vec<usize>>,
}

impl Tarjan {
    fn search<'a>(&mut self, root: usize, successors: &impl Fn(usize) -> &'a [usize]) {
        self.enter(root);
        while let Some(&node) = self.path.last() {
            match successors(node).get(self.next[node]) {
                Some(&successor) => {
                    self.next[node] += 1;
                    if self.order[successor] == UNSEEN {
                        self.enter(successor);
                    } else if self.is_open[successor] {
                        self.low[node] = self.low[node].min(self.order[successor]);
                    }
                }
                None => self.leave(node),
            }
        }
    }

    fn enter(&mut self, node: usize) {
        self.order[node] = self.seen;
        self.low[node] = self.seen;
        self.seen += 1;
        self.open.push(node);
        self.is_open[node] = true;
        self.path.push(node);
    }

    fn leave(&mut self, node: usize) {
        self.path.pop();
        if let Some(&parent) = self.path.last() {
            self.low[parent] = self.low[parent].min(self.low[node]);
        }
        if self.low[node] != self.order[node] {
            return;
        }
        let first = self.open.iter().rposition(|open| *open == node);
        let mut component =
            self.open.split_off(first.expect("a node stays open until its component is closed"));
        for member in &component {
            self.is_open[*member] = false;
        }
        component.sort_unstable();
        self.components.push(component);
    }
}
