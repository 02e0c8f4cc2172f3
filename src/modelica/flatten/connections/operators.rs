//! Operators whose values the connections give: `inStream`, `actualStream` (MLS §15.2),
//! `cardinality` (MLS §3.7.4.3), `Connections.isRoot` and `Connections.rooted` (MLS §9.4.1),
//! `Connections.uniqueRootIndices` of other tools (Modelica_StateGraph2, User's Guide).

use super::super::errors::INVALID_CONNECTION;
use crate::diag::Diagnostic;
use crate::fault;
use crate::flatten::connections::overconstrained::said;
use crate::flatten::connections::sets::Connections;
use crate::flatten::expressions::local::Local;
use crate::flatten::ids::ScopeId;
use crate::flatten::instantiate::instantiation::Instantiation;
use crate::source::Span;
use crate::syntax::ast::{Arguments, ComponentReference, Expression, ExpressionKind};
use crate::value::Value;
use std::rc::Rc;

impl Instantiation<'_> {
    /// The value of such an operator; `None` for any other call.
    pub(crate) fn connection_operator(
        &mut self,
        span: Span,
        function: &ComponentReference,
        arguments: &Arguments,
        context: ScopeId,
        local: &Local,
    ) -> Result<Option<Expression>, Diagnostic> {
        let names: Vec<&str> = function.parts.iter().map(|part| part.name.as_str()).collect();
        let value = match names.as_slice() {
            ["inStream"] => self.stream_operator(span, false, arguments, context, local)?,
            ["actualStream"] => self.stream_operator(span, true, arguments, context, local)?,
            ["cardinality"] => {
                let reference = argument(arguments, span)?;
                let connections = self.known_connections(span)?;
                let ends = self.ends(reference, context, local)?;
                let end = ends.and_then(|ends| ends.ends.first().copied());
                let count = end.map_or(0, |end| connections.cardinality(end));
                Expression::new(ExpressionKind::Integer(count), span)
            }
            ["Connections", "isRoot"] => {
                let node = self.overdetermined_argument(arguments, 0, context, local)?;
                let connections = self.known_connections(span)?;
                let is_root = node.is_some_and(|node| connections.graph.is_root(node));
                Expression::new(ExpressionKind::Boolean(is_root), span)
            }
            ["Connections", "rooted"] | ["rooted"] => {
                let node = self.overdetermined_argument(arguments, 0, context, local)?;
                let connections = self.known_connections(span)?;
                let rooted = node.is_some_and(|node| connections.graph.is_rooted(node));
                Expression::new(ExpressionKind::Boolean(rooted), span)
            }
            ["Connections", "uniqueRootIndices"] => {
                self.unique_root_indices(span, arguments, context, local)?
            }
            _ => return Ok(None),
        };
        Ok(Some(value))
    }

    /// `Connections.uniqueRootIndices(roots, nodes, message)`: for each node the number of the root that it
    /// is connected with, then the numbers of the other roots.
    fn unique_root_indices(
        &mut self,
        span: Span,
        arguments: &Arguments,
        context: ScopeId,
        local: &Local,
    ) -> Result<Expression, Diagnostic> {
        let message = self.message_of_roots((arguments, 2), span, context)?;
        let roots = self.overdetermined_arguments(arguments, 0, context, local)?;
        let nodes = self.overdetermined_arguments(arguments, 1, context, local)?;
        let connections = self.known_connections(span)?;
        let indices = connections.graph.indices_of_roots(&roots, &nodes).map_err(|node| {
            let node = &self.classes.tree.nodes[node.0].path;
            fault!(
                INVALID_CONNECTION,
                "`{node}` is connected with none of the roots that are left for it{}",
                said(&message)
            )
            .at(span)
        })?;
        let number = |root: usize| Expression::new(ExpressionKind::Integer(root as i64 + 1), span);
        let numbers = indices.into_iter().map(number).collect();
        Ok(Expression::new(ExpressionKind::Array(numbers), span))
    }

    /// The message that a statement about unique roots has for its failure. Modelica has no such
    /// statement.
    pub(super) fn message_of_roots(
        &mut self,
        (arguments, at): (&Arguments, usize),
        span: Span,
        context: ScopeId,
    ) -> Result<String, Diagnostic> {
        let foreign = fault!(
            INVALID_CONNECTION,
            "unique roots of connection graphs are not part of \
            Modelica: they are checked as the users' guide of Modelica_StateGraph2 has it"
        )
        .at(span);
        match self.classes.library.is_strict() {
            true => return Err(foreign),
            false => self.warnings.add_once(foreign),
        }
        let named = arguments.named.iter().find(|named| named.name.node == "message");
        let given = arguments.positional.get(at).or_else(|| named.map(|named| &named.value));
        let Some(given) = given else { return Ok(String::new()) };
        match self.structural_value(given, context)? {
            Value::String(message) => Ok(message.to_string()),
            other => {
                Err(fault!(INVALID_CONNECTION, "a message is a String, not {}", other.type_name())
                    .at(given.span))
            }
        }
    }

    fn stream_operator(
        &mut self,
        span: Span,
        actual: bool,
        arguments: &Arguments,
        context: ScopeId,
        local: &Local,
    ) -> Result<Expression, Diagnostic> {
        let reference = argument(arguments, span)?;
        let connections = self.known_connections(span)?;
        match self.ends(reference, context, local)? {
            Some(ends) => self.stream_value(&ends, actual, &connections, span),
            None => {
                Err(fault!(INVALID_CONNECTION, "`{}` does not exist", reference.name()).at(span))
            }
        }
    }

    fn known_connections(&self, span: Span) -> Result<Rc<Connections>, Diagnostic> {
        self.connections.clone().ok_or_else(|| {
            fault!(
                INVALID_CONNECTION,
                "the structure of the model cannot depend on its connections"
            )
            .at(span)
        })
    }
}

fn argument(arguments: &Arguments, span: Span) -> Result<&ComponentReference, Diagnostic> {
    match arguments.positional.first().map(|argument| &argument.kind) {
        Some(ExpressionKind::Reference(reference)) => Ok(reference),
        _ => Err(fault!(
            INVALID_CONNECTION,
            "expected the name of a connector or of a variable in a connector"
        )
        .at(span)),
    }
}
