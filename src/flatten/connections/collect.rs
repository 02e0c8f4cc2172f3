//! Finds the connections and the statements about the connection graph in all instances, loops
//! unrolled and branches chosen (MLS §9.1, §9.4).

use super::super::equations::is_graph_statement;
use super::super::errors::{INVALID_CONNECTION, SIZE_MISMATCH};
use super::super::instantiate::instance::MemberState;
use crate::diag::Diagnostic;
use crate::fault;
use crate::flatten::connections::end::End;
use crate::flatten::connections::end::Ends;
use crate::flatten::connections::sets::Connections;
use crate::flatten::expressions::local::Local;
use crate::flatten::ids::NodeId;
use crate::flatten::ids::ScopeId;
use crate::flatten::instantiate::instantiation::Instantiation;
use crate::name::Name;
use crate::source::Span;
use crate::syntax::ast::{
    Arguments, ComponentReference, Equation, EquationKind, Expression, ExpressionKind, Section,
};
use crate::value::Value;

/// A `connect` equation in one instance.
pub struct Connect {
    pub left: ComponentReference,
    pub right: ComponentReference,
    pub context: ScopeId,
    /// Values of loop variables.
    pub local: Local,
    pub span: Span,
}

impl Instantiation<'_> {
    /// All connections below an instance, as sets; errors are added to the list.
    pub fn connections(&mut self, root: NodeId, errors: &mut Vec<Diagnostic>) -> Connections {
        let mut connections = Connections::default();
        let mut connects = Vec::new();
        self.collect_connections(root, &mut connections, &mut connects, errors);
        if let Err(error) = self.expand_connectors(&connects) {
            errors.push(error);
        }
        for connect in &connects {
            if let Err(error) = self.connect(connect, &mut connections) {
                errors.push(error);
            }
        }
        connections.context = None;
        if let Err(error) = self.classes.build_graph(&mut connections) {
            errors.push(error);
        }
        self.classes.drop_unconnected(root, &mut connections);
        connections
    }

    fn collect_connections(
        &mut self,
        node: NodeId,
        connections: &mut Connections,
        connects: &mut Vec<Connect>,
        errors: &mut Vec<Diagnostic>,
    ) {
        let Some(scope) = self.classes.tree.scope_of(node) else { return };
        let parts = self
            .classes
            .elements(scope)
            .and_then(|elements| Ok((elements, self.classes.members(node)?)));
        let Ok((elements, members)) = parts else { return };
        for (_, state) in members {
            let nodes = match state {
                MemberState::Single(one) => vec![one],
                MemberState::Array(_, nodes) => nodes,
                _ => Vec::new(),
            };
            for one in nodes {
                self.collect_connections(one, connections, connects, errors);
            }
        }
        for context in elements.lineage() {
            let text = self.classes.text(context).clone();
            for section in text.sections() {
                let Section::Equations { initial: false, equations, .. } = section else {
                    continue;
                };
                for equation in equations {
                    let local = Local::default();
                    if let Err(error) =
                        self.collect_equation(equation, context, &local, connections, connects)
                    {
                        errors.push(error);
                    }
                }
            }
        }
    }

    fn collect_equation(
        &mut self,
        equation: &Equation,
        context: ScopeId,
        local: &Local,
        connections: &mut Connections,
        connects: &mut Vec<Connect>,
    ) -> Result<(), Diagnostic> {
        if !is_about_connections(equation) {
            return Ok(());
        }
        match &equation.kind {
            EquationKind::Connect { left, right }
                if self.classes.is_deselected(context, left, right) =>
            {
                Ok(())
            }
            EquationKind::Connect { left, right } => {
                connects.push(Connect {
                    left: left.clone(),
                    right: right.clone(),
                    context,
                    local: local.clone(),
                    span: equation.span,
                });
                Ok(())
            }
            EquationKind::Call(call) => self.graph_statement(call, context, local, connections),
            EquationKind::For { indices, body } => {
                let mut turns = Vec::new();
                let indices = self.loop_ranges(indices, body, context, local)?;
                self.turns(&indices, context, local, &mut turns)?;
                for turn in turns {
                    for inner in body {
                        self.collect_equation(inner, context, &turn, connections, connects)?;
                    }
                }
                Ok(())
            }
            EquationKind::If { branches, otherwise } => {
                let chosen = match self.chosen_branch(branches, context, local)? {
                    Some(Some(at)) => &branches[at].1,
                    Some(None) => otherwise,
                    None => {
                        return Err(fault!(
                            INVALID_CONNECTION,
                            "a connection in an if-equation needs a condition that is known at \
                             translation"
                        )
                        .at(equation.span));
                    }
                };
                for inner in chosen {
                    self.collect_equation(inner, context, local, connections, connects)?;
                }
                Ok(())
            }
            EquationKind::When { .. } => {
                Err(fault!(INVALID_CONNECTION, "connections are not allowed in a when-equation")
                    .at(equation.span))
            }
            EquationKind::Equal { .. } => Ok(()),
        }
    }

    fn connect(
        &mut self,
        connect: &Connect,
        connections: &mut Connections,
    ) -> Result<(), Diagnostic> {
        let Connect { left, right, context, local, span } = connect;
        let span = *span;
        let left_ends = self.ends(left, *context, local)?;
        let right_ends = self.ends(right, *context, local)?;
        // Connections with a component whose condition is false are removed (MLS §4.4.5).
        let (Some(left_ends), Some(right_ends)) = (left_ends, right_ends) else { return Ok(()) };
        if left_ends.dims != right_ends.dims {
            return Err(fault!(
                SIZE_MISMATCH,
                "`{}` has the sizes {:?}, `{}` has {:?}",
                left.name(),
                left_ends.dims,
                right.name(),
                right_ends.dims
            )
            .at(span));
        }
        let sides = (left_ends.outside, right_ends.outside);
        connections.context = Some(self.classes.node_of(*context));
        for (one, other) in left_ends.ends.iter().zip(&right_ends.ends) {
            connections.count(*one);
            connections.count(*other);
            self.classes.pair(*one, *other, sides, span, connections)?;
        }
        Ok(())
    }

    /// `Connections.branch(a, b)`, `root(a)`, `potentialRoot(a, priority)` (MLS §9.4.1).
    fn graph_statement(
        &mut self,
        call: &Expression,
        context: ScopeId,
        local: &Local,
        connections: &mut Connections,
    ) -> Result<(), Diagnostic> {
        let ExpressionKind::Call { function, arguments } = &call.kind else { return Ok(()) };
        let name = Name::new(function.name().parts).to_string();
        let Some(first) = self.overdetermined_argument(arguments, 0, context, local)? else {
            return Ok(());
        };
        match name.as_str() {
            "Connections.branch" => {
                if let Some(second) = self.overdetermined_argument(arguments, 1, context, local)? {
                    connections.graph.branch(first, second);
                }
            }
            "Connections.root" => connections.graph.root(first),
            "Connections.potentialRoot" => {
                let named = || {
                    let named = arguments.named.iter();
                    named.filter(|n| n.name.node == "priority").map(|n| &n.value).next()
                };
                let priority = match arguments.positional.get(1).or_else(named) {
                    Some(priority) => match self.structural_value(priority, context)? {
                        Value::Integer(priority) => priority,
                        other => {
                            return Err(fault!(
                                INVALID_CONNECTION,
                                "a priority is Integer, not {}",
                                other.type_name()
                            )
                            .at(priority.span));
                        }
                    },
                    None => 0,
                };
                connections.graph.potential_root(first, priority);
            }
            _ => {}
        }
        Ok(())
    }

    /// The record that an argument of such a statement names; `None` if it does not exist.
    pub fn overdetermined_argument(
        &mut self,
        arguments: &Arguments,
        at: usize,
        context: ScopeId,
        local: &Local,
    ) -> Result<Option<NodeId>, Diagnostic> {
        let Some(argument) = arguments.positional.get(at) else { return Ok(None) };
        let ExpressionKind::Reference(reference) = &argument.kind else {
            return Err(fault!(INVALID_CONNECTION, "expected the name of a record in a connector")
                .at(argument.span));
        };
        match self.ends(reference, context, local)? {
            Some(Ends { ends, .. }) => match ends.as_slice() {
                [End::Composite(node)] => Ok(Some(*node)),
                [End::Scalar(node, _), ..] => Ok(Some(*node)),
                _ => Ok(None),
            },
            None => Ok(None),
        }
    }
}

/// Whether an equation holds a connection or a statement about the connection graph.
fn is_about_connections(equation: &Equation) -> bool {
    match &equation.kind {
        EquationKind::Connect { .. } => true,
        EquationKind::Call(call) => is_graph_statement(call),
        EquationKind::For { body, .. } => body.iter().any(is_about_connections),
        EquationKind::If { branches, otherwise } => {
            branches.iter().flat_map(|(_, body)| body).chain(otherwise).any(is_about_connections)
        }
        EquationKind::When { branches } => {
            branches.iter().flat_map(|(_, body)| body).any(is_about_connections)
        }
        EquationKind::Equal { .. } => false,
    }
}
