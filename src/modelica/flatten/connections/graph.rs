//! Overconstrained connections (MLS §9.4): a spanning tree of the connection graph says which
//! connections of redundant records become equalities and which become `equalityConstraint`s.

use crate::flatten::ids::NodeId;
use crate::source::Span;
use indexmap::{IndexMap, IndexSet};
use rustc_hash::FxHashMap;
use std::collections::VecDeque;

/// A connection of two redundant records.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Edge {
    pub nodes: (NodeId, NodeId),
    pub outside: (bool, bool),
    pub span: Span,
}

/// A root whose graph may have no other one.
#[derive(Debug)]
struct UniqueRoot {
    /// What is said of a second one.
    message: String,
    span: Span,
}

/// The virtual connection graph.
#[derive(Debug, Default)]
pub(crate) struct Graph {
    nodes: IndexSet<NodeId>,
    branches: Vec<(NodeId, NodeId)>,
    edges: Vec<Edge>,
    definite: Vec<NodeId>,
    potential: IndexMap<NodeId, i64>,
    unique: IndexMap<NodeId, UniqueRoot>,
    /// The number of the graph that each node is in, connections that the tree does not hold included.
    parts: FxHashMap<NodeId, usize>,
    /// Chosen roots.
    roots: IndexSet<NodeId>,
    /// Number of edges to the root of each node.
    distance: FxHashMap<NodeId, usize>,
    /// Connections that the tree does not hold.
    broken: Vec<Edge>,
}

impl Graph {
    /// The redundant records that take part.
    pub(crate) fn nodes(&self) -> impl Iterator<Item = NodeId> {
        self.nodes.iter().copied()
    }

    pub(crate) fn branch(&mut self, one: NodeId, other: NodeId) {
        self.nodes.extend([one, other]);
        self.branches.push((one, other));
    }

    pub(crate) fn root(&mut self, node: NodeId) {
        self.nodes.insert(node);
        self.definite.push(node);
    }

    pub(crate) fn potential_root(&mut self, node: NodeId, priority: i64) {
        self.nodes.insert(node);
        self.potential.entry(node).or_insert(priority);
    }

    /// A root whose graph may have no other one, with what is said of a second one.
    pub(crate) fn unique_root(&mut self, node: NodeId, message: &str, span: Span) {
        self.root(node);
        self.unique.entry(node).or_insert(UniqueRoot { message: message.to_owned(), span });
    }

    /// Two unique roots of one graph, with the message and the place of the second.
    pub(crate) fn ambiguous_roots(&self) -> Option<([NodeId; 2], &str, Span)> {
        let mut first: FxHashMap<usize, NodeId> = FxHashMap::default();
        self.unique.iter().find_map(|(node, root)| {
            let before = first.insert(*self.parts.get(node)?, *node)?;
            Some(([before, *node], root.message.as_str(), root.span))
        })
    }

    /// The numbers of the roots, from 0, that are in the graphs of these nodes, then those of the others.
    ///
    /// # Errors
    /// The first node that none of the roots left over is connected with.
    pub(crate) fn indices_of_roots(
        &self,
        roots: &[NodeId],
        nodes: &[NodeId],
    ) -> Result<Vec<usize>, NodeId> {
        let part = |node: &NodeId| self.parts.get(node);
        let mut left: Vec<usize> = (0..roots.len()).collect();
        let mut indices = Vec::with_capacity(roots.len());
        for node in nodes {
            let own = part(node).ok_or(*node)?;
            let found = left.iter().position(|root| part(&roots[*root]) == Some(own));
            indices.push(left.remove(found.ok_or(*node)?));
        }
        indices.append(&mut left);
        Ok(indices)
    }

    pub(crate) fn connect(
        &mut self,
        one: NodeId,
        other: NodeId,
        outside: (bool, bool),
        span: Span,
    ) {
        self.nodes.extend([one, other]);
        self.edges.push(Edge { nodes: (one, other), outside, span });
    }

    /// Whether a node was chosen as the root of its tree.
    pub(crate) fn is_root(&self, node: NodeId) -> bool {
        self.roots.contains(&node)
    }

    /// Whether a node is nearer to the root than the node at the other end of its branch.
    pub(crate) fn is_rooted(&self, node: NodeId) -> bool {
        let other = self.branches.iter().find_map(|(a, b)| match node {
            node if node == *a => Some(*b),
            node if node == *b => Some(*a),
            _ => None,
        });
        match (other.and_then(|other| self.distance.get(&other)), self.distance.get(&node)) {
            (Some(other), Some(own)) => own < other,
            _ => true,
        }
    }

    /// The connections that the tree does not hold.
    pub(crate) fn broken(&self) -> &[Edge] {
        &self.broken
    }

    /// Chooses the tree; returns the connections that it holds.
    pub(crate) fn span(&mut self) -> Vec<Edge> {
        let mut sets = Sets::new(self.nodes.len());
        let at = |nodes: &IndexSet<NodeId>, node: NodeId| nodes.get_index_of(&node).unwrap_or(0);
        for node in &self.definite {
            sets.rooted[at(&self.nodes, *node)] = true;
            self.roots.insert(*node);
        }
        for (one, other) in &self.branches {
            sets.join(at(&self.nodes, *one), at(&self.nodes, *other));
        }
        // Potential roots of higher rank come before connections to others of the same set.
        let mut kept = Vec::new();
        for edge in &self.edges {
            let (one, other) = (at(&self.nodes, edge.nodes.0), at(&self.nodes, edge.nodes.1));
            let (a, b) = (sets.find(one), sets.find(other));
            if a == b || (sets.rooted[a] && sets.rooted[b]) {
                self.broken.push(*edge);
            } else {
                sets.join(a, b);
                kept.push(*edge);
            }
        }
        let mut potential: Vec<(i64, usize, NodeId)> = self
            .potential
            .iter()
            .map(|(node, priority)| (*priority, at(&self.nodes, *node), *node))
            .collect();
        potential.sort_by_key(|(priority, number, _)| (*priority, *number));
        for (_, number, node) in potential {
            let set = sets.find(number);
            if !sets.rooted[set] {
                sets.rooted[set] = true;
                self.roots.insert(node);
            }
        }
        self.measure(&kept);
        let edges = self.broken.iter().chain(&kept);
        for Edge { nodes: (one, other), .. } in edges {
            sets.join(at(&self.nodes, *one), at(&self.nodes, *other));
        }
        let numbered = self.nodes.iter().enumerate();
        self.parts = numbered.map(|(number, node)| (*node, sets.find(number))).collect();
        kept
    }

    /// The distances of all nodes from their roots, over branches and kept connections.
    fn measure(&mut self, kept: &[Edge]) {
        let mut neighbours: FxHashMap<NodeId, Vec<NodeId>> = FxHashMap::default();
        let edges = self.branches.iter().copied().chain(kept.iter().map(|edge| edge.nodes));
        for (one, other) in edges {
            neighbours.entry(one).or_default().push(other);
            neighbours.entry(other).or_default().push(one);
        }
        let mut queue: VecDeque<(NodeId, usize)> =
            self.roots.iter().map(|root| (*root, 0)).collect();
        while let Some((node, distance)) = queue.pop_front() {
            if self.distance.contains_key(&node) {
                continue;
            }
            self.distance.insert(node, distance);
            for next in neighbours.get(&node).into_iter().flatten() {
                queue.push_back((*next, distance + 1));
            }
        }
    }
}

/// Disjoint sets of nodes, each with or without a root.
struct Sets {
    parent: Vec<usize>,
    rooted: Vec<bool>,
}

impl Sets {
    fn new(len: usize) -> Sets {
        Sets { parent: (0..len).collect(), rooted: vec![false; len] }
    }

    fn find(&self, mut at: usize) -> usize {
        while self.parent[at] != at {
            at = self.parent[at];
        }
        at
    }

    fn join(&mut self, one: usize, other: usize) {
        let (one, other) = (self.find(one), self.find(other));
        if one != other {
            self.parent[other] = one;
            self.rooted[one] |= self.rooted[other];
        }
    }
}
