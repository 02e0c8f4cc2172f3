//! Overconstrained connections (MLS §9.4): a spanning tree of the connection graph says which
//! connections of redundant records become equalities and which become `equalityConstraint`s.

use super::super::FlatModel;
use super::super::errors::INVALID_CONNECTION;
use super::super::expressions::resolve::Local;
use super::super::flat_expression::flat_reference;
use super::super::instantiate::instance::{NodeId, NodeKind};
use super::super::instantiate::instantiation::Instantiation;
use super::super::lookup::names::Type;
use super::super::lookup::scope::ScopeId;
use super::ends::End;
use super::sets::Connections;
use crate::diag::Diagnostic;
use crate::fault;
use crate::name::{Ident, Name};
use crate::source::Span;
use crate::syntax::ast::{
    Arguments, ComponentReference, Equation, EquationKind, Expression, ExpressionKind, Subscript,
};
use indexmap::{IndexMap, IndexSet};
use rustc_hash::FxHashMap;
use std::collections::VecDeque;

/// The function that makes a record redundant.
const EQUALITY_CONSTRAINT: &str = "equalityConstraint";

/// A connection of two redundant records.
#[derive(Debug, Clone, Copy)]
struct Edge {
    nodes: (NodeId, NodeId),
    outside: (bool, bool),
    span: Span,
}

/// The virtual connection graph.
#[derive(Debug, Default)]
pub struct Graph {
    nodes: IndexSet<NodeId>,
    branches: Vec<(NodeId, NodeId)>,
    edges: Vec<Edge>,
    definite: Vec<NodeId>,
    potential: IndexMap<NodeId, i64>,
    /// Chosen roots.
    roots: IndexSet<NodeId>,
    /// Number of edges to the root of each node.
    distance: FxHashMap<NodeId, usize>,
    /// Connections that the tree does not hold.
    broken: Vec<Edge>,
}

impl Graph {
    /// The redundant records that take part.
    pub fn nodes(&self) -> impl Iterator<Item = NodeId> {
        self.nodes.iter().copied()
    }

    pub fn branch(&mut self, one: NodeId, other: NodeId) {
        self.nodes.extend([one, other]);
        self.branches.push((one, other));
    }

    pub fn root(&mut self, node: NodeId) {
        self.nodes.insert(node);
        self.definite.push(node);
    }

    pub fn potential_root(&mut self, node: NodeId, priority: i64) {
        self.nodes.insert(node);
        self.potential.entry(node).or_insert(priority);
    }

    pub fn connect(&mut self, one: NodeId, other: NodeId, outside: (bool, bool), span: Span) {
        self.nodes.extend([one, other]);
        self.edges.push(Edge { nodes: (one, other), outside, span });
    }

    /// Whether a node was chosen as the root of its tree.
    pub fn is_root(&self, node: NodeId) -> bool {
        self.roots.contains(&node)
    }

    /// Whether a node is nearer to the root than the node at the other end of its branch.
    pub fn is_rooted(&self, node: NodeId) -> bool {
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

    /// Chooses the tree; returns the connections that it holds.
    fn span(&mut self) -> Vec<Edge> {
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

impl Instantiation<'_> {
    /// Chooses the spanning tree and joins the records that it connects.
    pub fn build_graph(&mut self, connections: &mut Connections) -> Result<(), Diagnostic> {
        let kept = connections.graph.span();
        for edge in kept {
            let (one, other) = edge.nodes;
            match self.scalars_of(one).zip(self.scalars_of(other)) {
                Some((ones, others)) => {
                    for (a, b) in ones.into_iter().zip(others) {
                        self.pair(a, b, edge.outside, edge.span, connections)?;
                    }
                }
                None => self.pair_members(one, other, edge.outside, edge.span, connections)?,
            }
        }
        connections.close();
        Ok(())
    }

    /// Whether the class of a component declares itself redundant.
    pub fn is_overdetermined(&mut self, node: NodeId) -> Result<bool, Diagnostic> {
        let Some(class) = self.redundant_class(node) else { return Ok(false) };
        Ok(self.find_class(class, Ident::new(EQUALITY_CONSTRAINT))?.is_some())
    }

    /// The class of a record or of a variable, which may be redundant.
    fn redundant_class(&self, node: NodeId) -> Option<ScopeId> {
        match &self.nodes[node.0].kind {
            NodeKind::Composite(composite) => {
                let class = composite.class;
                (!composite.connector && self.is_record(class)).then_some(class)
            }
            NodeKind::Variable(leaf) => leaf.class.filter(|_| !leaf.connector),
        }
    }

    /// The scalars of a variable; `None` for an instance with components.
    fn scalars_of(&self, node: NodeId) -> Option<Vec<End>> {
        let NodeKind::Variable(leaf) = &self.nodes[node.0].kind else { return None };
        let count = self.variables[leaf.variable].0.len();
        Some((0..count).map(|element| End::Scalar(node, element)).collect())
    }

    /// `0 = equalityConstraint(a, b)` for every connection outside the tree.
    pub fn add_constraint_equations(
        &mut self,
        connections: &Connections,
        model: &mut FlatModel,
    ) -> Result<(), Diagnostic> {
        for edge in &connections.graph.broken {
            let equation = self.constraint_equation(edge)?;
            model.equations.push(equation);
        }
        Ok(())
    }

    fn constraint_equation(&mut self, edge: &Edge) -> Result<Equation, Diagnostic> {
        let span = edge.span;
        let class = self.redundant_class(edge.nodes.0).unwrap_or(ScopeId::TOP);
        let invalid = || {
            fault!(INVALID_CONNECTION, "`{EQUALITY_CONSTRAINT}` of this record is not a function")
                .at(span)
        };
        let nested = self.find_class(class, Ident::new(EQUALITY_CONSTRAINT))?;
        let Some(Type::Class(scope)) = nested.map(|nested| self.instance(&nested)).transpose()?
        else {
            return Err(invalid());
        };
        let name = self.function(scope)?.ok_or_else(invalid)?;
        let size = self
            .functions
            .get(&name)
            .and_then(|function| function.as_ref())
            .and_then(|function| function.outputs.first()?.dims.first().cloned());
        let Some(Subscript::Index(size)) = size else { return Err(invalid()) };
        let flat = self.flat_scope();
        let record = |this: &mut Self, node: NodeId| {
            let reference = flat_reference(&this.nodes[node.0].path, span);
            this.resolve(
                &Expression::new(ExpressionKind::Reference(reference), span),
                flat,
                &Local::default(),
            )
        };
        let positional = vec![record(self, edge.nodes.0)?, record(self, edge.nodes.1)?];
        let left = call(&name, positional, span);
        let right = call(&Name::parse("zeros"), vec![size], span);
        let kind = EquationKind::Equal { left, right };
        Ok(Equation { kind, comment: Default::default(), span })
    }
}

/// A call with positional arguments.
pub fn call(name: &Name, positional: Vec<Expression>, span: Span) -> Expression {
    let function = ComponentReference::from_name(name, span);
    let arguments = Box::new(Arguments { positional, ..Arguments::default() });
    Expression::new(ExpressionKind::Call { function, arguments }, span)
}
