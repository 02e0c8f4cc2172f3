//! The equations of connection sets (MLS §9.2): potentials are equal, flows sum to zero.

use super::super::instantiate::instance::MemberState;
use super::super::instantiate::instance::NodeKind;
use super::super::{FlatModel, Variability};
use crate::diag::Diagnostic;
use crate::fault;
use crate::flatten::connections::end::End;
use crate::flatten::connections::sets::Connections;
use crate::flatten::connections::sets::ConnectorSide;
use crate::flatten::errors::INVALID_CONNECTION;
use crate::flatten::ids::NodeId;
use crate::flatten::instantiate::instantiation::Instantiation;
use crate::flatten::instantiate::tree::Tree;
use crate::flatten::lookup::classes::Classes;
use crate::name::Name;
use crate::source::Span;
use crate::syntax::ast::{
    Arguments, BinaryOperator, CausalityPrefix, ComponentReference, ConnectionPrefix, Equation,
    EquationKind, Expression, ExpressionKind, UnaryOperator,
};

/// Terms of a sum of flows without brackets.
const LONGEST_SUM: usize = 100;

impl Instantiation<'_> {
    /// Adds the equations of all sets, and those of flows that are not connected.
    pub(crate) fn add_connection_equations(
        &mut self,
        connections: &Connections,
        model: &mut FlatModel,
    ) -> Result<(), Diagnostic> {
        for (sides, span) in connections.sets() {
            if self.classes.library.is_strict() {
                self.classes.check_source(&sides, span)?;
            }
            match self.classes.tree.connection_of(sides[0].leaf) {
                None => self.classes.tree.add_potential_equations(&sides, span, model),
                Some(ConnectionPrefix::Flow) => {
                    model.equations.push(self.classes.tree.flow_equation(&sides, span));
                }
                Some(ConnectionPrefix::Stream) => {
                    self.add_stream_equations(&sides, connections, span, model)?;
                }
            }
        }
        self.add_constraint_equations(connections, model)?;
        let mut unconnected = Vec::new();
        let root = self.classes.tree.root;
        self.classes.unconnected_flows(root, false, connections, &mut unconnected);
        self.classes.flows_passed_on(connections, &mut unconnected);
        for side in unconnected {
            let span = self.classes.tree.end_span(End::Scalar(side.leaf, side.element));
            model.equations.push(self.classes.tree.flow_equation(&[side], span));
        }
        Ok(())
    }
}

/// Parameters of connected connectors must be equal (MLS §9.2).
fn equal_parameters(left: Expression, right: Expression, span: Span) -> Expression {
    let message = "connected connectors have different values of a parameter";
    let condition = Expression::operation(BinaryOperator::Equal, left, right, span);
    let arguments = Arguments {
        positional: vec![condition, Expression::new(ExpressionKind::String(message.into()), span)],
        ..Arguments::default()
    };
    let function = ComponentReference::from_name(&Name::parse("assert"), span);
    Expression::new(ExpressionKind::Call { function, arguments: Box::new(arguments) }, span)
}

impl Tree {
    fn add_potential_equations(&self, sides: &[ConnectorSide], span: Span, model: &mut FlatModel) {
        for pair in sides.windows(2) {
            let left = self.scalar(pair[0].leaf, pair[0].element, span);
            let right = self.scalar(pair[1].leaf, pair[1].element, span);
            let fixed = |side: &ConnectorSide| {
                self.variability_of_leaf(side.leaf) <= Variability::Parameter
            };
            let kind = if pair.iter().all(fixed) {
                EquationKind::Call(equal_parameters(left, right, span))
            } else {
                EquationKind::Equal { left, right }
            };
            model.equations.push(Equation { kind, comment: Default::default(), span });
        }
    }

    /// Σ of the flows into the components = Σ of those through the connectors of the instance.
    fn flow_equation(&self, sides: &[ConnectorSide], span: Span) -> Equation {
        let zero = Expression::new(ExpressionKind::Real(0.0), span);
        let kind = EquationKind::Equal { left: self.sum_of_flows(sides, span), right: zero };
        Equation { kind, comment: Default::default(), span }
    }

    /// One after the other; long sums as sums of sums, where fewer digits are lost.
    fn sum_of_flows(&self, sides: &[ConnectorSide], span: Span) -> Expression {
        if sides.len() > LONGEST_SUM {
            let (first, second) = sides.split_at(sides.len() / 2);
            let [first, second] = [first, second].map(|half| self.sum_of_flows(half, span));
            return Expression::operation(BinaryOperator::Add, first, second, span);
        }
        let mut sum: Option<Expression> = None;
        for side in sides {
            let term = self.scalar(side.leaf, side.element, span);
            let kind = match (sum.take(), side.outside) {
                (None, false) => term.kind,
                (None, true) => ExpressionKind::Unary {
                    operator: UnaryOperator::Minus,
                    operand: Box::new(term),
                },
                (Some(sum), outside) => ExpressionKind::Binary {
                    operator: if outside { BinaryOperator::Subtract } else { BinaryOperator::Add },
                    left: sum.into(),
                    right: Box::new(term),
                },
            };
            sum = Some(Expression::new(kind, span));
        }
        sum.unwrap_or_else(|| Expression::new(ExpressionKind::Real(0.0), span))
    }

    fn variability_of_leaf(&self, leaf: NodeId) -> Variability {
        match &self.nodes[leaf.0].kind {
            NodeKind::Variable(leaf) => self.variables[leaf.variable].0.variability,
            NodeKind::Composite(_) => Variability::Continuous,
        }
    }
}

impl Classes<'_> {
    /// What is an input in expandable connectors is something else in one of them at least (MLS
    /// §9.1.3). Those of the model itself may get it from outside.
    fn check_source(&self, sides: &[ConnectorSide], span: Span) -> Result<(), Diagnostic> {
        let is_input = |side: &ConnectorSide| match &self.tree.nodes[side.leaf.0].kind {
            NodeKind::Variable(leaf) => leaf.causality == Some(CausalityPrefix::Input),
            NodeKind::Composite(_) => false,
        };
        let mut within = sides.iter().filter(|side| self.is_inside_expandable(side.leaf));
        let Some(one) = within.clone().next() else { return Ok(()) };
        let of_model = within.any(|side| self.is_connector_of_model(side.leaf));
        if of_model || !sides.iter().all(is_input) {
            return Ok(());
        }
        let path = &self.tree.nodes[one.leaf.0].path;
        Err(fault!(INVALID_CONNECTION, "`{path}` of an expandable connector is only used as input";
            help: "connect it to an output, or to what is neither input nor output")
        .at(span))
    }

    /// Whether a variable belongs to a connector that the model itself declares.
    fn is_connector_of_model(&self, leaf: NodeId) -> bool {
        let mut node = leaf;
        while let Some(parent) = self.tree.nodes[node.0].parent {
            if parent == self.tree.root {
                return self.is_expandable(node);
            }
            node = parent;
        }
        false
    }

    /// Flows that expandable connectors of components have because others have them: without a
    /// connection within the component nothing flows into it.
    fn flows_passed_on(&mut self, connections: &Connections, found: &mut Vec<ConnectorSide>) {
        let mut nodes: Vec<NodeId> = self.tree.passed_on.iter().copied().collect();
        nodes.sort_unstable_by_key(|node| node.0);
        let mut leaves = Vec::new();
        for node in nodes {
            self.leaves_below(node, &mut leaves);
        }
        // A component that was passed on may have been passed others of its own.
        leaves.sort_unstable_by_key(|node| node.0);
        leaves.dedup();
        for node in leaves {
            let NodeKind::Variable(leaf) = &self.tree.nodes[node.0].kind else { continue };
            if leaf.connection != Some(ConnectionPrefix::Flow)
                || connections.dropped.contains(&node)
                || self.is_connector_of_model(node)
            {
                continue;
            }
            let count = self.tree.variables[leaf.variable].0.len();
            let side = |element, outside| ConnectorSide { leaf: node, element, outside };
            let only_above = (0..count).filter(|element| {
                connections.contains(&side(*element, false))
                    && !connections.contains(&side(*element, true))
            });
            found.extend(only_above.map(|element| side(element, true)));
        }
    }

    fn leaves_below(&mut self, node: NodeId, found: &mut Vec<NodeId>) {
        if let NodeKind::Variable(_) = &self.tree.nodes[node.0].kind {
            found.push(node);
            return;
        }
        for (_, state) in self.members(node).unwrap_or_default() {
            match state {
                MemberState::Single(one) => self.leaves_below(one, found),
                MemberState::Array(_, nodes) => {
                    nodes.into_iter().for_each(|one| self.leaves_below(one, found));
                }
                _ => {}
            }
        }
    }

    /// Flows of connectors that no connection sees from the inside.
    fn unconnected_flows(
        &mut self,
        node: NodeId,
        in_connector: bool,
        connections: &Connections,
        found: &mut Vec<ConnectorSide>,
    ) {
        let in_connector = in_connector || self.tree.is_connector(node);
        if let NodeKind::Variable(leaf) = &self.tree.nodes[node.0].kind {
            // A flow variable outside of connectors that has a value is a variable like others.
            let is_open = in_connector || leaf.modifier.binding.is_none();
            if is_open && leaf.connection == Some(ConnectionPrefix::Flow) {
                let count = self.tree.variables[leaf.variable].0.len();
                let sides =
                    (0..count).map(|element| ConnectorSide { leaf: node, element, outside: false });
                found.extend(sides.filter(|side| !connections.contains(side)));
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
                self.unconnected_flows(one, in_connector, connections, found);
            }
        }
    }
}
