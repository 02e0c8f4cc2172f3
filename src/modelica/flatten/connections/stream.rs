//! Stream connectors (MLS ch. 15): `inStream`, `actualStream` and the equations of mixing.

use super::super::FlatModel;
use super::super::errors::INVALID_CONNECTION;
use super::super::instantiate::instance::MemberState;
use super::super::instantiate::instance::NodeKind;
use crate::diag::Diagnostic;
use crate::fault;
use crate::flatten::connections::end::End;
use crate::flatten::connections::end::Ends;
use crate::flatten::connections::sets::Connections;
use crate::flatten::connections::sets::ConnectorSide;
use crate::flatten::flat_expression::call;
use crate::flatten::ids::NodeId;
use crate::flatten::instantiate::instantiation::Instantiation;
use crate::flatten::instantiate::tree::Tree;
use crate::flatten::lookup::classes::Classes;
use crate::name::{Ident, Name};
use crate::source::Span;
use crate::syntax::ast::{
    BinaryOperator, ConnectionPrefix, Equation, EquationKind, Expression, ExpressionKind,
    UnaryOperator,
};
use crate::value::Value;

/// What keeps the denominator of a mixture from vanishing, kg/s (MLS §15.2, ε).
const SMALL_FLOW: f64 = 1e-10;

/// The deepest nesting of connectors through which a stream is followed.
const MAX_LEVELS: usize = 50;

impl Instantiation<'_> {
    /// The values of `inStream` or `actualStream` of what a reference names, as one expression.
    pub(crate) fn stream_value(
        &mut self,
        ends: &Ends,
        actual: bool,
        connections: &Connections,
        span: Span,
    ) -> Result<Expression, Diagnostic> {
        let mut values = Vec::with_capacity(ends.ends.len());
        for end in &ends.ends {
            let End::Scalar(leaf, element) = *end else {
                return Err(fault!(INVALID_CONNECTION, "expected a stream variable").at(span));
            };
            if self.classes.tree.connection_of(leaf) != Some(ConnectionPrefix::Stream) {
                let path = &self.classes.tree.nodes[leaf.0].path;
                return Err(
                    fault!(INVALID_CONNECTION, "`{path}` is not a stream variable").at(span)
                );
            }
            let inside = self.in_stream(leaf, element, connections, span, 0)?;
            values.push(match actual {
                false => inside,
                true => self.classes.actual_stream(leaf, element, inside, span)?,
            });
        }
        Ok(arranged(values, &ends.dims, span))
    }

    /// What would flow in through a connector (MLS §15.2).
    fn in_stream(
        &mut self,
        leaf: NodeId,
        element: usize,
        connections: &Connections,
        span: Span,
        level: usize,
    ) -> Result<Expression, Diagnostic> {
        let own = ConnectorSide { leaf, element, outside: false };
        let others: Vec<ConnectorSide> =
            connections.set_of(own).into_iter().filter(|side| *side != own).collect();
        if others.is_empty() {
            return Ok(self.classes.tree.scalar(leaf, element, span));
        }
        self.mixture(&others, connections, span, level)
    }

    /// The mixture of what flows out of connectors into their connection set.
    fn mixture(
        &mut self,
        sides: &[ConnectorSide],
        connections: &Connections,
        span: Span,
        level: usize,
    ) -> Result<Expression, Diagnostic> {
        if level > MAX_LEVELS {
            return Err(fault!(INVALID_CONNECTION, "the stream connections form a cycle").at(span));
        }
        if let [side] = sides {
            return self.outflow(*side, connections, span, level);
        }
        let (mut numerator, mut denominator): (Option<Expression>, Option<Expression>) =
            (None, None);
        for side in sides {
            let flow = self.classes.flow_beside(side.leaf, span)?;
            if self.never_flows_out(flow, side.outside) {
                continue;
            }
            let weight = self.classes.tree.weight(flow, side.outside, span);
            let value = self.outflow(*side, connections, span, level)?;
            let product = binary(BinaryOperator::Multiply, weight.clone(), value);
            numerator = Some(sum(numerator, product));
            denominator = Some(sum(denominator, weight));
        }
        match (numerator, denominator) {
            (Some(numerator), Some(denominator)) => {
                Ok(binary(BinaryOperator::Divide, numerator, denominator))
            }
            // Nothing ever flows out: any of them is as good (MLS §15.2).
            _ => self.outflow(sides[0], connections, span, level),
        }
    }

    /// What flows from a side into its set: the component's own value, or, through a connector of
    /// the instance, what comes in from outside.
    fn outflow(
        &mut self,
        side: ConnectorSide,
        connections: &Connections,
        span: Span,
        level: usize,
    ) -> Result<Expression, Diagnostic> {
        if side.outside {
            self.in_stream(side.leaf, side.element, connections, span, level + 1)
        } else {
            Ok(self.classes.tree.scalar(side.leaf, side.element, span))
        }
    }

    /// Whether `min` or `max` of the flow say that nothing leaves the component here.
    fn never_flows_out(&mut self, flow: NodeId, outside: bool) -> bool {
        let NodeKind::Variable(leaf) = &self.classes.tree.nodes[flow.0].kind else { return false };
        let attribute = Ident::new(if outside { "max" } else { "min" });
        let Some(bound) = leaf.modifier.elements.get(&attribute) else { return false };
        let Some(bound) = bound.binding.clone() else { return false };
        let Some(value) = bound.value else { return false };
        let read = std::mem::take(&mut self.values.read);
        let known = self.known_value(&value, bound.context);
        self.values.read = read;
        let number = match known {
            Ok(Value::Real(number)) => number,
            Ok(Value::Integer(number)) => number as f64,
            _ => return false,
        };
        if outside { number <= 0.0 } else { number >= 0.0 }
    }

    /// The equations of the connectors of an instance: what leaves through them is the mixture of
    /// all others (MLS §15.2).
    pub(crate) fn add_stream_equations(
        &mut self,
        sides: &[ConnectorSide],
        connections: &Connections,
        span: Span,
        model: &mut FlatModel,
    ) -> Result<(), Diagnostic> {
        for side in sides.iter().filter(|side| side.outside) {
            let others: Vec<ConnectorSide> =
                sides.iter().copied().filter(|other| other != side).collect();
            let left = self.classes.tree.scalar(side.leaf, side.element, span);
            let right = self.mixture(&others, connections, span, 0)?;
            let kind = EquationKind::Equal { left, right };
            model.equations.push(Equation { kind, comment: Default::default(), span });
        }
        Ok(())
    }
}

impl Classes<'_> {
    fn actual_stream(
        &mut self,
        leaf: NodeId,
        element: usize,
        inside: Expression,
        span: Span,
    ) -> Result<Expression, Diagnostic> {
        let flow = self.flow_beside(leaf, span)?;
        let zero = Expression::new(ExpressionKind::Real(0.0), span);
        let condition = binary(BinaryOperator::Greater, self.tree.scalar(flow, 0, span), zero);
        let own = self.tree.scalar(leaf, element, span);
        let choice =
            ExpressionKind::If { branches: vec![(condition, inside)], otherwise: Box::new(own) };
        let order = Expression::new(ExpressionKind::Integer(0), span);
        Ok(call(&Name::parse("smooth"), vec![order, Expression::new(choice, span)], span))
    }

    /// The flow variable of the connector that holds a stream variable.
    fn flow_beside(&mut self, leaf: NodeId, span: Span) -> Result<NodeId, Diagnostic> {
        let path = self.tree.nodes[leaf.0].path.clone();
        let missing = || {
            fault!(
                INVALID_CONNECTION,
                "the connector of `{path}` does not have exactly one flow variable"
            )
            .at(span)
        };
        let holder = self.tree.nodes[leaf.0].parent.ok_or_else(missing)?;
        let mut flows = Vec::new();
        for (_, state) in self.members(holder)? {
            if let MemberState::Single(one) = state
                && self.tree.connection_of(one) == Some(ConnectionPrefix::Flow)
            {
                flows.push(one);
            }
        }
        match flows.as_slice() {
            [flow] => Ok(*flow),
            _ => Err(missing()),
        }
    }
}

impl Tree {
    /// max(flow into the set, ε), without events.
    fn weight(&self, flow: NodeId, outside: bool, span: Span) -> Expression {
        let mut out = self.scalar(flow, 0, span);
        if !outside {
            let kind =
                ExpressionKind::Unary { operator: UnaryOperator::Minus, operand: Box::new(out) };
            out = Expression::new(kind, span);
        }
        let small = Expression::new(ExpressionKind::Real(SMALL_FLOW), span);
        let largest = call(&Name::parse("max"), vec![out, small], span);
        call(&Name::parse("noEvent"), vec![largest], span)
    }
}

fn binary(operator: BinaryOperator, left: Expression, right: Expression) -> Expression {
    let span = left.span;
    Expression::operation(operator, left, right, span)
}

fn sum(so_far: Option<Expression>, term: Expression) -> Expression {
    match so_far {
        Some(so_far) => binary(BinaryOperator::Add, so_far, term),
        None => term,
    }
}

/// Values as an array of these sizes; a single one without dimensions.
pub(crate) fn arranged(mut values: Vec<Expression>, dims: &[usize], span: Span) -> Expression {
    let Some((size, inner)) = dims.split_first() else {
        return match values.len() {
            1 => values.remove(0),
            _ => Expression::new(ExpressionKind::Array(values), span),
        };
    };
    let stride: usize = inner.iter().product();
    let mut elements = Vec::with_capacity(*size);
    for _ in 0..*size {
        let rest = values.split_off(stride.min(values.len()));
        elements.push(arranged(values, inner, span));
        values = rest;
    }
    Expression::new(ExpressionKind::Array(elements), span)
}
