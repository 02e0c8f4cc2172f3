//! Connection sets and their equations (MLS §9.1, §9.2).

use super::super::errors::INVALID_CONNECTION;
use super::super::flat_expression::flat_reference;
use super::super::instantiate::instance::{MemberState, NodeId, NodeKind};
use super::super::instantiate::instantiation::{Instantiation, indices_of};
use super::super::{FlatModel, Variability};
use super::ends::End;
use super::graph::Graph;
use crate::diag::Diagnostic;
use crate::fault;
use crate::name::{Ident, Name};
use crate::source::Span;
use crate::syntax::ast::{
    Arguments, BinaryOperator, ComponentReference, ConnectionPrefix, Equation, EquationKind,
    Expression, ExpressionKind, Subscript, UnaryOperator,
};
use rustc_hash::{FxHashMap, FxHashSet};

/// A scalar of a connector, seen from one side.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct Face {
    /// The node of the variable.
    pub leaf: NodeId,
    /// The element of the variable, from 0.
    pub element: usize,
    pub outside: bool,
}

/// Two scalars that a connection joins.
#[derive(Debug, Clone)]
pub struct Edge {
    /// The instance whose class writes the connection.
    pub context: NodeId,
    pub faces: [Face; 2],
    pub span: Span,
}

/// All connection sets of a model.
#[derive(Debug, Default)]
pub struct Connections {
    faces: Vec<Face>,
    number: FxHashMap<Face, usize>,
    /// The set of each face, as a union-find forest.
    parent: Vec<usize>,
    /// A connection of each face, for messages.
    spans: Vec<Span>,
    /// How often each connector stands in a connection.
    counts: FxHashMap<End, i64>,
    pub graph: Graph,
    /// The instance whose connections are being made.
    pub context: Option<NodeId>,
    /// What was joined, for the balance of each class.
    pub edges: Vec<Edge>,
    /// Variables of expandable connectors that are left out.
    pub dropped: FxHashSet<NodeId>,
    /// Members of each set by its representative, made when all connections are known.
    members: Vec<Vec<usize>>,
}

impl Connections {
    fn face(&mut self, face: Face, span: Span) -> usize {
        if let Some(known) = self.number.get(&face) {
            return *known;
        }
        let number = self.faces.len();
        self.faces.push(face);
        self.parent.push(number);
        self.spans.push(span);
        self.number.insert(face, number);
        number
    }

    fn find(&self, mut at: usize) -> usize {
        while self.parent[at] != at {
            at = self.parent[at];
        }
        at
    }

    fn join(&mut self, one: Face, other: Face, span: Span) {
        let (one, other) = (self.face(one, span), self.face(other, span));
        let (one, other) = (self.shorten(one), self.shorten(other));
        // The earlier face represents the set.
        let (root, child) = (one.min(other), one.max(other));
        self.parent[child] = root;
    }

    /// As [`Connections::find`], halving the path on the way.
    fn shorten(&mut self, mut at: usize) -> usize {
        while self.parent[at] != at {
            self.parent[at] = self.parent[self.parent[at]];
            at = self.parent[at];
        }
        at
    }

    pub fn count(&mut self, end: End) {
        *self.counts.entry(end).or_default() += 1;
    }

    /// How many connections name a connector (`cardinality`, MLS §3.7.4.3).
    pub fn cardinality(&self, end: End) -> i64 {
        self.counts.get(&end).copied().unwrap_or(0)
    }

    /// All faces that are connected with a scalar, on either side.
    pub fn around(&self, leaf: NodeId, element: usize) -> Vec<Face> {
        [false, true]
            .into_iter()
            .flat_map(|outside| self.set_of(Face { leaf, element, outside }))
            .collect()
    }

    /// Lists the members of the sets.
    pub fn close(&mut self) {
        for at in 0..self.parent.len() {
            self.parent[at] = self.find(at);
        }
        self.members = vec![Vec::new(); self.faces.len()];
        for at in 0..self.faces.len() {
            self.members[self.parent[at]].push(at);
        }
    }

    /// The set of a face; the face alone if it is not connected.
    pub fn set_of(&self, face: Face) -> Vec<Face> {
        match self.number.get(&face) {
            Some(at) => self.members[self.parent[*at]].iter().map(|at| self.faces[*at]).collect(),
            None => vec![face],
        }
    }
}

impl Instantiation<'_> {
    /// Joins the scalars of two connectors, matched by name (MLS §9.3).
    pub fn pair(
        &mut self,
        one: End,
        other: End,
        outside: (bool, bool),
        span: Span,
        connections: &mut Connections,
    ) -> Result<(), Diagnostic> {
        match (one, other) {
            (End::Scalar(a, i), End::Scalar(b, j)) => {
                self.pair_scalars((a, i, outside.0), (b, j, outside.1), span, connections)
            }
            (End::Composite(a), End::Composite(b)) => {
                if self.is_overdetermined(a)? && self.is_overdetermined(b)? {
                    connections.graph.connect(a, b, outside, span);
                    return Ok(());
                }
                self.pair_members(a, b, outside, span, connections)
            }
            _ => Err(self.unlike(one, other, span)),
        }
    }

    fn unlike(&self, one: End, other: End, span: Span) -> Diagnostic {
        let (a, b) = (self.end_path(one), self.end_path(other));
        let error = fault!(INVALID_CONNECTION, "`{a}` and `{b}` are connectors of different types")
            .at(span);
        [one, other].into_iter().map(|end| (end, self.end_span(end))).fold(
            error,
            |error, (_, place)| {
                if place.is_known() { error.related(place, "declared here") } else { error }
            },
        )
    }

    pub fn pair_members(
        &mut self,
        one: NodeId,
        other: NodeId,
        outside: (bool, bool),
        span: Span,
        connections: &mut Connections,
    ) -> Result<(), Diagnostic> {
        if self.is_expandable(one) != self.is_expandable(other) {
            return Err(self.unlike(End::Composite(one), End::Composite(other), span));
        }
        let left = self.connectable(one)?;
        let right = self.connectable(other)?;
        let missing = |from: &[(Ident, MemberState)], to: &[(Ident, MemberState)]| {
            from.iter().map(|(name, _)| *name).find(|name| to.iter().all(|(n, _)| n != name))
        };
        if let Some(name) = missing(&left, &right).or_else(|| missing(&right, &left)) {
            let (a, b) = (&self.nodes[one.0].path, &self.nodes[other.0].path);
            return Err(fault!(
                INVALID_CONNECTION,
                "`{a}` and `{b}` cannot be connected: only one of them has `{name}`"
            )
            .at(span));
        }
        for (name, state) in left {
            let Some((_, counterpart)) = right.iter().find(|(known, _)| *known == name) else {
                continue;
            };
            if let (MemberState::Single(a), MemberState::Single(b)) = (&state, counterpart)
                && self.is_redundant_variable(*a)?
                && self.is_redundant_variable(*b)?
            {
                connections.graph.connect(*a, *b, outside, span);
                continue;
            }
            let (ends, partners) = (self.ends_of(&state), self.ends_of(counterpart));
            if ends.len() != partners.len() {
                let (a, b) = (&self.nodes[one.0].path, &self.nodes[other.0].path);
                return Err(fault!(
                    INVALID_CONNECTION,
                    "`{a}.{name}` and `{b}.{name}` have different sizes"
                )
                .at(span));
            }
            for (end, partner) in ends.into_iter().zip(partners) {
                self.pair(end, partner, outside, span, connections)?;
            }
        }
        Ok(())
    }

    /// The components of a connector that take part in connections.
    fn connectable(&mut self, node: NodeId) -> Result<Vec<(Ident, MemberState)>, Diagnostic> {
        let members = self.members(node)?;
        Ok(members
            .into_iter()
            .filter(|(_, state)| matches!(state, MemberState::Single(_) | MemberState::Array(..)))
            .collect())
    }

    fn is_redundant_variable(&mut self, node: NodeId) -> Result<bool, Diagnostic> {
        let is_variable = matches!(self.nodes[node.0].kind, NodeKind::Variable(_));
        Ok(is_variable && self.is_overdetermined(node)?)
    }

    fn ends_of(&self, state: &MemberState) -> Vec<End> {
        match state {
            MemberState::Single(one) => match &self.nodes[one.0].kind {
                NodeKind::Composite(_) => vec![End::Composite(*one)],
                NodeKind::Variable(leaf) => {
                    let count = self.variables[leaf.variable].0.len();
                    (0..count).map(|element| End::Scalar(*one, element)).collect()
                }
            },
            MemberState::Array(_, nodes) => {
                nodes.iter().map(|node| End::Composite(*node)).collect()
            }
            _ => Vec::new(),
        }
    }

    fn pair_scalars(
        &mut self,
        one: (NodeId, usize, bool),
        other: (NodeId, usize, bool),
        span: Span,
        connections: &mut Connections,
    ) -> Result<(), Diagnostic> {
        let (a, b) = (self.connection_of(one.0), self.connection_of(other.0));
        let types = (self.base_of(one.0), self.base_of(other.0));
        if a != b || types.0 != types.1 {
            let (a, b) = (End::Scalar(one.0, one.1), End::Scalar(other.0, other.1));
            return Err(self.unlike(a, b, span));
        }
        // Both faces of a potential are the same value.
        let two_faced = a.is_some();
        let face = |(leaf, element, outside): (NodeId, usize, bool)| Face {
            leaf,
            element,
            outside: outside && two_faced,
        };
        let faces = [face(one), face(other)];
        let context = connections.context;
        connections.edges.extend(context.map(|context| Edge { context, faces, span }));
        connections.join(faces[0], faces[1], span);
        Ok(())
    }

    pub fn connection_of(&self, leaf: NodeId) -> Option<ConnectionPrefix> {
        match &self.nodes[leaf.0].kind {
            NodeKind::Variable(leaf) => leaf.connection,
            NodeKind::Composite(_) => None,
        }
    }

    fn base_of(&self, leaf: NodeId) -> Option<super::super::BaseType> {
        match &self.nodes[leaf.0].kind {
            NodeKind::Variable(leaf) => Some(self.variables[leaf.variable].0.base.clone()),
            NodeKind::Composite(_) => None,
        }
    }

    fn variability_of_leaf(&self, leaf: NodeId) -> Variability {
        match &self.nodes[leaf.0].kind {
            NodeKind::Variable(leaf) => self.variables[leaf.variable].0.variability,
            NodeKind::Composite(_) => Variability::Continuous,
        }
    }

    /// One scalar of a variable as an expression of flat names.
    pub fn scalar(&self, leaf: NodeId, element: usize, span: Span) -> Expression {
        let mut reference = flat_reference(&self.nodes[leaf.0].path, span);
        if let NodeKind::Variable(variable) = &self.nodes[leaf.0].kind {
            let dims = &self.variables[variable.variable].0.dims;
            let literal = |index: usize| {
                let kind = ExpressionKind::Integer(index as i64);
                Subscript::Index(Expression::new(kind, span))
            };
            if let Some(last) = reference.parts.last_mut() {
                last.subscripts = indices_of(element, dims).into_iter().map(literal).collect();
            }
        }
        Expression::new(ExpressionKind::Reference(reference), span)
    }

    /// Adds the equations of all sets, and those of flows that are not connected.
    pub fn add_connection_equations(
        &mut self,
        connections: &Connections,
        model: &mut FlatModel,
    ) -> Result<(), Diagnostic> {
        for (root, members) in connections.members.iter().enumerate() {
            if members.len() < 2 {
                continue;
            }
            let faces: Vec<Face> = members
                .iter()
                .map(|at| connections.faces[*at])
                .filter(|face| !connections.dropped.contains(&face.leaf))
                .collect();
            if faces.is_empty() {
                continue;
            }
            let span = connections.spans[root];
            match self.connection_of(faces[0].leaf) {
                None => self.add_potential_equations(&faces, span, model),
                Some(ConnectionPrefix::Flow) => {
                    model.equations.push(self.flow_equation(&faces, span));
                }
                Some(ConnectionPrefix::Stream) => {
                    self.add_stream_equations(&faces, connections, span, model)?;
                }
            }
        }
        self.add_constraint_equations(connections, model)?;
        let mut unconnected = Vec::new();
        self.unconnected_flows(self.root_node, connections, &mut unconnected);
        for face in unconnected {
            let span = self.end_span(End::Scalar(face.leaf, face.element));
            model.equations.push(self.flow_equation(&[face], span));
        }
        Ok(())
    }

    fn add_potential_equations(&self, faces: &[Face], span: Span, model: &mut FlatModel) {
        for pair in faces.windows(2) {
            let left = self.scalar(pair[0].leaf, pair[0].element, span);
            let right = self.scalar(pair[1].leaf, pair[1].element, span);
            let fixed = |face: &Face| self.variability_of_leaf(face.leaf) <= Variability::Parameter;
            let kind = if pair.iter().all(fixed) {
                EquationKind::Call(equal_parameters(left, right, span))
            } else {
                EquationKind::Equal { left, right }
            };
            model.equations.push(Equation { kind, comment: Default::default(), span });
        }
    }

    /// Σ of the flows into the components = Σ of those through the connectors of the instance.
    fn flow_equation(&self, faces: &[Face], span: Span) -> Equation {
        let mut sum: Option<Expression> = None;
        for face in faces {
            let term = self.scalar(face.leaf, face.element, span);
            let kind = match (sum.take(), face.outside) {
                (None, false) => term.kind,
                (None, true) => ExpressionKind::Unary {
                    operator: UnaryOperator::Minus,
                    operand: Box::new(term),
                },
                (Some(sum), outside) => ExpressionKind::Binary {
                    operator: if outside { BinaryOperator::Subtract } else { BinaryOperator::Add },
                    left: Box::new(sum),
                    right: Box::new(term),
                },
            };
            sum = Some(Expression::new(kind, span));
        }
        let zero = Expression::new(ExpressionKind::Real(0.0), span);
        let left = sum.unwrap_or_else(|| zero.clone());
        let kind = EquationKind::Equal { left, right: zero };
        Equation { kind, comment: Default::default(), span }
    }

    /// Flows of connectors that no connection sees from the inside.
    fn unconnected_flows(
        &mut self,
        node: NodeId,
        connections: &Connections,
        found: &mut Vec<Face>,
    ) {
        if let NodeKind::Variable(leaf) = &self.nodes[node.0].kind {
            if leaf.connection == Some(ConnectionPrefix::Flow) {
                let count = self.variables[leaf.variable].0.len();
                let faces = (0..count).map(|element| Face { leaf: node, element, outside: false });
                found.extend(faces.filter(|face| !connections.number.contains_key(face)));
            }
            return;
        }
        let Ok(members) = self.members(node) else { return };
        for (_, state) in members {
            let nodes = match state {
                MemberState::Single(one) => vec![one],
                MemberState::Array(_, nodes) => nodes,
                _ => continue,
            };
            for one in nodes {
                self.unconnected_flows(one, connections, found);
            }
        }
    }
}

/// Parameters of connected connectors must be equal (MLS §9.2).
fn equal_parameters(left: Expression, right: Expression, span: Span) -> Expression {
    let message = "connected connectors have different values of a parameter";
    let condition = ExpressionKind::Binary {
        operator: BinaryOperator::Equal,
        left: Box::new(left),
        right: Box::new(right),
    };
    let arguments = Arguments {
        positional: vec![
            Expression::new(condition, span),
            Expression::new(ExpressionKind::String(message.into()), span),
        ],
        ..Arguments::default()
    };
    let function = ComponentReference::from_name(&Name::parse("assert"), span);
    Expression::new(ExpressionKind::Call { function, arguments: Box::new(arguments) }, span)
}
