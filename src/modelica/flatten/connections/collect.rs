//! Finds the connections and the statements about the connection graph in all instances, loops
//! unrolled and branches chosen (MLS §9.1, §9.4).

use super::super::equations::is_graph_statement;
use super::super::errors::{INVALID_CONNECTION, SIZE_MISMATCH};
use crate::diag::Diagnostic;
use crate::fault;
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
pub(crate) struct Connect {
    pub left: ComponentReference,
    pub right: ComponentReference,
    pub context: ScopeId,
    /// Values of loop variables.
    pub local: Local,
    pub span: Span,
}

impl Instantiation<'_> {
    /// All connections below an instance, as sets; errors are added to the list.
    pub(crate) fn connections(
        &mut self,
        root: NodeId,
        errors: &mut Vec<Diagnostic>,
    ) -> Connections {
        let connections = Connections::default();
        let mut collector = Collector { instantiation: self, connections, connects: Vec::new() };
        collector.collect(root, errors);
        if let Err(error) = collector.instantiation.expand_connectors(&collector.connects) {
            errors.push(error);
        }
        for connect in std::mem::take(&mut collector.connects) {
            if let Err(error) = collector.connect(&connect) {
                errors.push(error);
            }
        }
        let mut connections = collector.connections;
        connections.context = None;
        if let Err(error) = self.classes.build_graph(&mut connections) {
            errors.push(error);
        }
        self.classes.drop_unconnected(root, &mut connections);
        connections
    }

    /// The record that an argument of such a statement names; `None` if it does not exist.
    pub(crate) fn overdetermined_argument(
        &mut self,
        arguments: &Arguments,
        at: usize,
        context: ScopeId,
        local: &Local,
    ) -> Result<Option<NodeId>, Diagnostic> {
        let nodes = self.overdetermined_arguments(arguments, at, context, local)?;
        Ok(nodes.first().copied().filter(|_| nodes.len() == 1))
    }

    /// The records that such an argument names, element by element.
    pub(crate) fn overdetermined_arguments(
        &mut self,
        arguments: &Arguments,
        at: usize,
        context: ScopeId,
        local: &Local,
    ) -> Result<Vec<NodeId>, Diagnostic> {
        let Some(argument) = arguments.positional.get(at) else { return Ok(Vec::new()) };
        let ExpressionKind::Reference(reference) = &argument.kind else {
            return Err(fault!(INVALID_CONNECTION, "expected the name of a record in a connector")
                .at(argument.span));
        };
        let ends = self.ends(reference, context, local)?.map_or(Vec::new(), |ends| ends.ends);
        let mut nodes: Vec<NodeId> = ends.iter().map(|end| end.node()).collect();
        nodes.dedup();
        Ok(nodes)
    }
}

/// Collects the connections that the instances of a model write.
struct Collector<'c, 'a> {
    instantiation: &'c mut Instantiation<'a>,
    connections: Connections,
    connects: Vec<Connect>,
}

impl Collector<'_, '_> {
    fn collect(&mut self, root: NodeId, errors: &mut Vec<Diagnostic>) {
        let classes = &mut self.instantiation.classes;
        for node in classes.instances(root).unwrap_or_default() {
            let classes = &mut self.instantiation.classes;
            let Some(scope) = classes.tree.scope_of(node) else { continue };
            let Ok(elements) = classes.elements(scope) else { continue };
            for context in elements.lineage() {
                self.collect_class(context, errors);
            }
        }
    }

    fn collect_class(&mut self, context: ScopeId, errors: &mut Vec<Diagnostic>) {
        let text = self.instantiation.classes.text(context).clone();
        for section in text.sections() {
            let Section::Equations { initial: false, equations, .. } = section else { continue };
            for equation in equations {
                errors.extend(self.collect_equation(equation, context, &Local::default()).err());
            }
        }
    }

    fn collect_equations(
        &mut self,
        equations: &[Equation],
        context: ScopeId,
        local: &Local,
    ) -> Result<(), Diagnostic> {
        equations.iter().try_for_each(|one| self.collect_equation(one, context, local))
    }

    fn collect_equation(
        &mut self,
        equation: &Equation,
        context: ScopeId,
        local: &Local,
    ) -> Result<(), Diagnostic> {
        if !is_about_connections(equation) {
            return Ok(());
        }
        match &equation.kind {
            EquationKind::Connect { left, right }
                if self.instantiation.classes.is_deselected(context, left, right) =>
            {
                Ok(())
            }
            EquationKind::Connect { left, right } => {
                self.connects.push(Connect {
                    left: left.clone(),
                    right: right.clone(),
                    context,
                    local: local.clone(),
                    span: equation.span,
                });
                Ok(())
            }
            EquationKind::Call(call) => self.graph_statement(call, context, local),
            EquationKind::For { indices, body } => {
                let mut iterations = Vec::new();
                let indices = self.instantiation.loop_ranges(indices, body, context, local)?;
                self.instantiation.iterations(&indices, context, local, &mut iterations)?;
                for iteration in iterations {
                    self.collect_equations(body, context, &iteration)?;
                }
                Ok(())
            }
            EquationKind::If { branches, otherwise } => {
                let chosen = match self.instantiation.chosen_branch(branches, context, local)? {
                    Some(Some(at)) => &branches[at].1,
                    Some(None) => otherwise,
                    None => return Err(unknown_condition(equation.span)),
                };
                self.collect_equations(chosen, context, local)
            }
            EquationKind::When { .. } => {
                Err(fault!(INVALID_CONNECTION, "connections are not allowed in a when-equation")
                    .at(equation.span))
            }
            EquationKind::Equal { .. } => Ok(()),
        }
    }

    fn connect(&mut self, connect: &Connect) -> Result<(), Diagnostic> {
        let Connect { left, right, context, local, span } = connect;
        let span = *span;
        let left_ends = self.instantiation.ends(left, *context, local);
        let right_ends = self.instantiation.ends(right, *context, local);
        if matches!((&left_ends, &right_ends), (Ok(None), Err(_)) | (Err(_), Ok(None)))
            && self.instantiation.adds_nothing(connect)?
        {
            return Ok(());
        }
        if let (Ok(None), Err(error)) | (Err(error), Ok(None)) = (&left_ends, &right_ends)
            && error.code == SIZE_MISMATCH
        {
            // The connection goes with the component that does not exist (MLS §4.4.5): which element
            // it would have gone to is of no account.
            return Ok(());
        }
        let (left_ends, right_ends) = (left_ends?, right_ends?);
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
        self.connections.context = Some(self.instantiation.classes.node_of(*context));
        for (one, other) in left_ends.ends.iter().zip(&right_ends.ends) {
            self.connections.count(*one);
            self.connections.count(*other);
            self.instantiation.classes.pair(*one, *other, sides, span, &mut self.connections)?;
        }
        Ok(())
    }

    /// `Connections.branch(a, b)`, `root(a)`, `potentialRoot(a, priority)` (MLS §9.4.1).
    fn graph_statement(
        &mut self,
        call: &Expression,
        context: ScopeId,
        local: &Local,
    ) -> Result<(), Diagnostic> {
        let ExpressionKind::Call { function, arguments } = &call.kind else { return Ok(()) };
        let name = Name::new(function.name().parts).to_string();
        if name == "Connections.uniqueRoot" {
            return self.unique_roots(arguments, call.span, context, local);
        }
        let Some(first) =
            self.instantiation.overdetermined_argument(arguments, 0, context, local)?
        else {
            return Ok(());
        };
        match name.as_str() {
            "Connections.branch" => {
                if let Some(second) =
                    self.instantiation.overdetermined_argument(arguments, 1, context, local)?
                {
                    self.connections.graph.branch(first, second);
                }
            }
            "Connections.root" => self.connections.graph.root(first),
            "Connections.potentialRoot" => {
                let priority = self.priority(arguments, context)?;
                self.connections.graph.potential_root(first, priority);
            }
            _ => {}
        }
        Ok(())
    }

    /// `Connections.uniqueRoot(roots, message)` of other tools: no two of them may be connected.
    fn unique_roots(
        &mut self,
        arguments: &Arguments,
        span: Span,
        context: ScopeId,
        local: &Local,
    ) -> Result<(), Diagnostic> {
        let message = self.instantiation.message_of_roots((arguments, 1), span, context)?;
        let roots = self.instantiation.overdetermined_arguments(arguments, 0, context, local)?;
        for root in roots {
            self.connections.graph.unique_root(root, &message, span);
        }
        Ok(())
    }

    /// The priority of a potential root, 0 if none is given.
    fn priority(&mut self, arguments: &Arguments, context: ScopeId) -> Result<i64, Diagnostic> {
        let named = || {
            let named = arguments.named.iter();
            named.filter(|n| n.name.node == "priority").map(|n| &n.value).next()
        };
        match arguments.positional.get(1).or_else(named) {
            Some(priority) => match self.instantiation.structural_value(priority, context)? {
                Value::Integer(priority) => Ok(priority),
                other => Err(fault!(
                    INVALID_CONNECTION,
                    "a priority is Integer, not {}",
                    other.type_name()
                )
                .at(priority.span)),
            },
            None => Ok(0),
        }
    }
}

fn unknown_condition(span: Span) -> Diagnostic {
    fault!(
        INVALID_CONNECTION,
        "a connection in an if-equation needs a condition that is known at translation"
    )
    .at(span)
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
