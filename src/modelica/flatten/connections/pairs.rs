//! Pairs of connected scalars, matched by the names in their connectors (MLS §9.2, §9.3).

use super::super::errors::INVALID_CONNECTION;
use super::super::flat_expression::flat_reference;
use super::super::instantiate::instance::MemberState;
use super::super::instantiate::instance::NodeKind;
use super::sets::ScalarPair;
use crate::diag::Diagnostic;
use crate::fault;
use crate::flatten::connections::end::End;
use crate::flatten::connections::sets::Connections;
use crate::flatten::connections::sets::ConnectorSide;
use crate::flatten::flat_expression::indices_of;
use crate::flatten::ids::NodeId;
use crate::flatten::instantiate::tree::Tree;
use crate::flatten::lookup::classes::Classes;
use crate::name::Ident;
use crate::source::Span;
use crate::syntax::ast::{ConnectionPrefix, Expression, ExpressionKind, Subscript};

impl Classes<'_> {
    /// Joins the scalars of two connectors, matched by name (MLS §9.3).
    pub(crate) fn pair(
        &mut self,
        one: End,
        other: End,
        outside: (bool, bool),
        span: Span,
        connections: &mut Connections,
    ) -> Result<(), Diagnostic> {
        match (one, other) {
            (End::Scalar(a, i), End::Scalar(b, j)) => {
                self.tree.pair_scalars((a, i, outside.0), (b, j, outside.1), span, connections)
            }
            (End::Composite(a), End::Composite(b)) => {
                if self.is_overdetermined(a)? && self.is_overdetermined(b)? {
                    connections.graph.connect(a, b, outside, span);
                    return Ok(());
                }
                self.pair_members(a, b, outside, span, connections)
            }
            _ => Err(self.tree.unlike(one, other, span)),
        }
    }

    pub(crate) fn pair_members(
        &mut self,
        one: NodeId,
        other: NodeId,
        outside: (bool, bool),
        span: Span,
        connections: &mut Connections,
    ) -> Result<(), Diagnostic> {
        if self.is_expandable(one) != self.is_expandable(other) {
            return Err(self.tree.unlike(End::Composite(one), End::Composite(other), span));
        }
        let left = self.connectable(one)?;
        let right = self.connectable(other)?;
        let missing = |from: &[(Ident, MemberState)], to: &[(Ident, MemberState)]| {
            from.iter().map(|(name, _)| *name).find(|name| to.iter().all(|(n, _)| n != name))
        };
        if let Some(name) = missing(&left, &right).or_else(|| missing(&right, &left)) {
            let (a, b) = (&self.tree.nodes[one.0].path, &self.tree.nodes[other.0].path);
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
            let (ends, partners) = (self.tree.ends_of(&state), self.tree.ends_of(counterpart));
            if ends.len() != partners.len() {
                let (a, b) = (&self.tree.nodes[one.0].path, &self.tree.nodes[other.0].path);
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
        let is_variable = matches!(self.tree.nodes[node.0].kind, NodeKind::Variable(_));
        Ok(is_variable && self.is_overdetermined(node)?)
    }
}

impl Tree {
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
        // Both sides of a potential are the same value.
        let has_two_sides = a.is_some();
        let side = |(leaf, element, outside): (NodeId, usize, bool)| ConnectorSide {
            leaf,
            element,
            outside: outside && has_two_sides,
        };
        let sides = [side(one), side(other)];
        let context = connections.context;
        connections.pairs.extend(context.map(|context| ScalarPair { context, sides, span }));
        connections.join(sides[0], sides[1], span);
        Ok(())
    }

    pub(crate) fn connection_of(&self, leaf: NodeId) -> Option<ConnectionPrefix> {
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

    /// One scalar of a variable as an expression of flat names.
    pub(crate) fn scalar(&self, leaf: NodeId, element: usize, span: Span) -> Expression {
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
}
