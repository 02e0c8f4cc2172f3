//! `outer output` components (MLS §17.3.5): variables of an enclosing instance that a state of a
//! state machine determines while it is active.

use super::instance::{Declaration, MemberState, NodeKind};
use crate::diag::Diagnostic;
use crate::fault;
use crate::flatten::errors::NOT_SUPPORTED;
use crate::flatten::ids::NodeId;
use crate::flatten::instantiate::instantiation::Instantiation;
use crate::flatten::lookup::classes::Classes;
use crate::name::Ident;
use crate::syntax::ast::{
    CausalityPrefix, Equation, EquationKind, Expression, ExpressionKind, Section,
};
use std::sync::Arc;

impl Instantiation<'_> {
    /// The variables to which the `outer output` components of an instance refer, by their flat
    /// names.
    pub(crate) fn outer_outputs(&mut self, node: NodeId) -> Result<Vec<Arc<str>>, Diagnostic> {
        let mut found = Vec::new();
        for name in self.classes.tree.component_names(node) {
            let Some(declared) = self.classes.tree.declaration_of(node, name) else { continue };
            let is_output = declared.type_prefixes.causality == Some(CausalityPrefix::Output);
            if !declared.prefixes.outer || !is_output {
                continue;
            }
            if let Some(state) = self.member(node, name)? {
                self.leaves(state.seen(), &mut found)?;
            }
        }
        Ok(found)
    }

    fn leaves(&mut self, state: MemberState, found: &mut Vec<Arc<str>>) -> Result<(), Diagnostic> {
        let nodes = match state {
            MemberState::Single(one) => vec![one],
            MemberState::Array(_, nodes) => nodes,
            _ => return Ok(()),
        };
        for node in nodes {
            match &self.classes.tree.nodes[node.0].kind {
                NodeKind::Variable(_) => {
                    found.push(self.classes.tree.nodes[node.0].path.as_str().into());
                }
                NodeKind::Composite(_) => {
                    for (_, state) in self.classes.members(node)? {
                        self.leaves(state, found)?;
                    }
                }
            }
        }
        Ok(())
    }
}

impl Classes<'_> {
    /// Whether an `inner outer` component is one variable with the one further out: an output of
    /// a state, whose definitions on all levels are merged.
    pub(crate) fn is_merged_output(
        &mut self,
        node: NodeId,
        declared: &Declaration,
    ) -> Result<bool, Diagnostic> {
        let is_output = declared.type_prefixes.causality == Some(CausalityPrefix::Output);
        if !is_output || !self.is_state(node)? {
            return Ok(false);
        }
        if !declared.modifier.is_empty() {
            return Err(fault!(NOT_SUPPORTED,
                "a modifier of the `inner outer output` component `{}` of a state machine's state",
                declared.name;
                help: "write it at the outermost `inner` component, which is the variable")
            .at(declared.span));
        }
        Ok(true)
    }

    /// Whether the class that holds an instance makes it a state of a state machine.
    fn is_state(&mut self, node: NodeId) -> Result<bool, Diagnostic> {
        let one = &self.tree.nodes[node.0];
        let Some(holder) = one.parent else { return Ok(false) };
        let last = one.path.rsplit('.').next().unwrap_or_default();
        let name = Ident::new(last.split('[').next().unwrap_or_default());
        let Some(scope) = self.tree.scope_of(holder) else { return Ok(false) };
        let elements = self.elements(scope)?;
        Ok(elements.lineage().any(|context| {
            self.text(context).sections().iter().any(|section| match section {
                Section::Equations { equations, .. } => names_state(equations, name),
                _ => false,
            })
        }))
    }
}

/// Whether one of the equations makes a component of this name a state.
fn names_state(equations: &[Equation], name: Ident) -> bool {
    equations.iter().any(|equation| match &equation.kind {
        EquationKind::Call(call) => is_about(call, name),
        EquationKind::For { body, .. } => names_state(body, name),
        EquationKind::If { branches, otherwise } => {
            branches.iter().any(|(_, body)| names_state(body, name)) || names_state(otherwise, name)
        }
        _ => false,
    })
}

fn is_about(call: &Expression, name: Ident) -> bool {
    let ExpressionKind::Call { function, arguments } = &call.kind else { return false };
    let is_operator =
        function.as_ident().is_some_and(|f| ["transition", "initialState"].contains(&f.as_str()));
    let named = arguments.named.iter().map(|given| &given.value);
    let names = |e: &Expression| match &e.kind {
        ExpressionKind::Reference(reference) => {
            matches!(reference.parts.as_slice(), [part] if part.name == name)
        }
        _ => false,
    };
    is_operator && arguments.positional.iter().chain(named).any(names)
}
