//! Calls of the operators of state machines (MLS §17.1): the instances that they name become
//! strings, their full paths.

use crate::diag::Diagnostic;
use crate::fault;
use crate::flatten::errors::{TYPE_MISMATCH, UNKNOWN_NAME};
use crate::flatten::expressions::local::Local;
use crate::flatten::ids::{NodeId, ScopeId};
use crate::flatten::instantiate::instance::{MemberState, NodeKind};
use crate::flatten::instantiate::instantiation::Instantiation;
use crate::source::Span;
use crate::syntax::ast::{
    Arguments, ComponentReference, Expression, ExpressionKind, NamedArgument, ReferencePart,
};

impl Instantiation<'_> {
    /// `transition(A, B, …)` as `transition("path of A", "path of B", …)`, `initialState` and
    /// `activeState` likewise; `ticksInState()` and `timeInState()` with the path of the instance
    /// in whose class they are written. `None` for any other call.
    pub(crate) fn state_operator(
        &mut self,
        span: Span,
        function: &ComponentReference,
        arguments: &Arguments,
        context: ScopeId,
        local: &Local,
    ) -> Result<Option<Expression>, Diagnostic> {
        let Some(name) = function.as_ident() else { return Ok(None) };
        let instances: &[&str] = match name.as_str() {
            "transition" => &["from", "to"],
            "initialState" | "activeState" => &["state"],
            "ticksInState" | "timeInState" => &[],
            _ => return Ok(None),
        };
        let in_model =
            context != ScopeId::TOP && !self.classes.tree.in_package(self.classes.node_of(context));
        if !in_model || self.classes.lookup(context, &function.name())?.is_some() {
            return Ok(None);
        }
        let mut positional = Vec::new();
        for (at, parameter) in instances.iter().enumerate() {
            let named = arguments.named.iter().find(|given| given.name.node == *parameter);
            let given = arguments.positional.get(at).or(named.map(|given| &given.value));
            let Some(given) = given else {
                return Err(
                    fault!(TYPE_MISMATCH, "`{name}` needs the argument `{parameter}`").at(span)
                );
            };
            positional.push(self.path_of_instance(given, context, local)?);
        }
        if instances.is_empty() {
            if !arguments.positional.is_empty() || !arguments.named.is_empty() {
                return Err(fault!(TYPE_MISMATCH, "`{name}` takes no arguments").at(span));
            }
            let path = self.classes.tree.nodes[self.classes.node_of(context).0].path.clone();
            positional.push(Expression::new(ExpressionKind::String(path.into()), span));
        }
        for given in arguments.positional.iter().skip(instances.len()) {
            positional.push(self.resolve(given, context, local)?);
        }
        let others = arguments.named.iter();
        let others = others.filter(|given| !instances.contains(&given.name.node.as_str()));
        let others: Vec<NamedArgument> = others.cloned().collect();
        let named = self.named_arguments(&others, context, local)?;
        let arguments = Box::new(Arguments { positional, named, ..Arguments::default() });
        let kind = ExpressionKind::Call { function: function.clone(), arguments };
        Ok(Some(Expression::new(kind, span)))
    }

    /// The full path of the instance that an argument names.
    fn path_of_instance(
        &mut self,
        e: &Expression,
        context: ScopeId,
        local: &Local,
    ) -> Result<Expression, Diagnostic> {
        let not_an_instance = || {
            fault!(TYPE_MISMATCH, "a state of a state machine must be the instance of a block")
                .at(e.span)
        };
        let ExpressionKind::Reference(reference) = &e.kind else { return Err(not_an_instance()) };
        let mut node = self.classes.node_of(context);
        for part in &reference.parts {
            node = self.instance_of_part(node, part, e.span, context, local)?;
        }
        let Node { path, is_block } = self.described(node);
        if !is_block {
            return Err(not_an_instance());
        }
        Ok(Expression::new(ExpressionKind::String(path.into()), e.span))
    }

    fn instance_of_part(
        &mut self,
        node: NodeId,
        part: &ReferencePart,
        span: Span,
        context: ScopeId,
        local: &Local,
    ) -> Result<NodeId, Diagnostic> {
        match self.member(node, part.name)?.map(MemberState::seen) {
            Some(MemberState::Single(one)) if part.subscripts.is_empty() => Ok(one),
            Some(MemberState::Array(dims, nodes)) => {
                let subscripts = self.subscripts(&part.subscripts, context, local)?;
                let chosen = self.choose(&dims, &subscripts, part.name, span)?;
                let mut at = 0;
                for ((indices, stays), size) in chosen.iter().zip(&dims) {
                    let ([index], false) = (indices.as_slice(), *stays) else {
                        return Err(fault!(TYPE_MISMATCH,
                            "a state of a state machine must be one instance, not an array";
                            help: "write a subscript for `{}`", part.name)
                        .at(span));
                    };
                    at = at * size + index - 1;
                }
                nodes
                    .get(at)
                    .copied()
                    .ok_or_else(|| fault!(UNKNOWN_NAME, "`{}` has no elements", part.name).at(span))
            }
            Some(MemberState::Absent) => Err(fault!(
                UNKNOWN_NAME,
                "`{}` does not exist: its condition is false or its declaration has an error",
                part.name
            )
            .at(span)),
            _ => Err(self.classes.unknown_component(node, part.name, span)),
        }
    }

    fn described(&self, node: NodeId) -> Node {
        let one = &self.classes.tree.nodes[node.0];
        let is_block = match &one.kind {
            NodeKind::Composite(composite) => {
                !composite.connector && !self.classes.is_record(composite.class)
            }
            NodeKind::Variable(_) => false,
        };
        Node { path: one.path.clone(), is_block }
    }
}

/// What is asked of an instance.
struct Node {
    path: String,
    is_block: bool,
}
