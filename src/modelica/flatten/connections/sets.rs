//! Connection sets and their equations (MLS §9.1, §9.2).

use crate::flatten::connections::end::End;
use crate::flatten::connections::graph::Graph;
use crate::flatten::ids::NodeId;
use crate::source::Span;
use rustc_hash::{FxHashMap, FxHashSet};

/// A scalar of a connector, seen from one side.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub(crate) struct ConnectorSide {
    /// The node of the variable.
    pub leaf: NodeId,
    /// The element of the variable, from 0.
    pub element: usize,
    pub outside: bool,
}

/// Two scalars that a connection joins.
#[derive(Debug, Clone)]
pub(crate) struct ScalarPair {
    /// The instance whose class writes the connection.
    pub context: NodeId,
    pub sides: [ConnectorSide; 2],
    pub span: Span,
}

/// All connection sets of a model.
#[derive(Debug, Default)]
pub(crate) struct Connections {
    sides: Vec<ConnectorSide>,
    number: FxHashMap<ConnectorSide, usize>,
    /// The set of each side, as a union-find forest.
    parent: Vec<usize>,
    /// A connection of each side, for messages.
    spans: Vec<Span>,
    /// How often each connector occurs in a connection.
    counts: FxHashMap<End, i64>,
    pub graph: Graph,
    /// The instance whose connections are being made.
    pub context: Option<NodeId>,
    /// What was joined, for the balance of each class.
    pub pairs: Vec<ScalarPair>,
    /// Variables of expandable connectors that are left out.
    pub dropped: FxHashSet<NodeId>,
    /// Members of each set by its representative, made when all connections are known.
    members: Vec<Vec<usize>>,
}

impl Connections {
    fn side(&mut self, side: ConnectorSide, span: Span) -> usize {
        if let Some(known) = self.number.get(&side) {
            return *known;
        }
        let number = self.sides.len();
        self.sides.push(side);
        self.parent.push(number);
        self.spans.push(span);
        self.number.insert(side, number);
        number
    }

    fn find(&self, mut at: usize) -> usize {
        while self.parent[at] != at {
            at = self.parent[at];
        }
        at
    }

    pub(crate) fn join(&mut self, one: ConnectorSide, other: ConnectorSide, span: Span) {
        let (one, other) = (self.side(one, span), self.side(other, span));
        let (one, other) = (self.shorten(one), self.shorten(other));
        // The earlier side represents the set.
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

    pub(crate) fn count(&mut self, end: End) {
        *self.counts.entry(end).or_default() += 1;
    }

    /// How many connections name a connector (`cardinality`, MLS §3.7.4.3).
    pub(crate) fn cardinality(&self, end: End) -> i64 {
        self.counts.get(&end).copied().unwrap_or(0)
    }

    /// All sides that are connected with a scalar, on either side.
    pub(crate) fn around(&self, leaf: NodeId, element: usize) -> Vec<ConnectorSide> {
        [false, true]
            .into_iter()
            .flat_map(|outside| self.set_of(ConnectorSide { leaf, element, outside }))
            .collect()
    }

    /// Lists the members of the sets.
    pub(crate) fn close(&mut self) {
        for at in 0..self.parent.len() {
            self.parent[at] = self.find(at);
        }
        self.members = vec![Vec::new(); self.sides.len()];
        for at in 0..self.sides.len() {
            self.members[self.parent[at]].push(at);
        }
    }

    /// The sets of two or more with a connection of each, without the variables of expandable
    /// connectors that are left out.
    pub(crate) fn sets(&self) -> impl Iterator<Item = (Vec<ConnectorSide>, Span)> {
        let joined = self.members.iter().zip(&self.spans).filter(|(members, _)| members.len() > 1);
        joined.filter_map(|(members, span)| {
            let sides = members.iter().map(|at| self.sides[*at]);
            let sides: Vec<ConnectorSide> =
                sides.filter(|side| !self.dropped.contains(&side.leaf)).collect();
            (!sides.is_empty()).then_some((sides, *span))
        })
    }

    /// Whether a side is connected.
    pub(crate) fn contains(&self, side: &ConnectorSide) -> bool {
        self.number.contains_key(side)
    }

    /// The set of a side; the side alone if it is not connected.
    pub(crate) fn set_of(&self, side: ConnectorSide) -> Vec<ConnectorSide> {
        match self.number.get(&side) {
            Some(at) => self.members[self.parent[*at]].iter().map(|at| self.sides[*at]).collect(),
            None => vec![side],
        }
    }
}
