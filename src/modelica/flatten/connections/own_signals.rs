//! Inputs and outputs of the model itself that lie in its connectors, such as `inlet.m_flow` of a model
//! that is made to be a unit of a larger one (MLS §4.4.2.2).

use crate::diag::Diagnostic;
use crate::flatten::FlatModel;
use crate::flatten::ids::NodeId;
use crate::flatten::instantiate::instance::{MemberState, NodeKind};
use crate::flatten::lookup::classes::Classes;
use crate::syntax::ast::CausalityPrefix;
use std::sync::Arc;

/// Variables by their names with what they are.
pub(crate) type Signals = Vec<(Arc<str>, CausalityPrefix)>;

impl Classes<'_> {
    /// The inputs and outputs in the public connectors of a model. What expandable connectors have follows
    /// from connections.
    pub(crate) fn own_signals(&mut self, root: NodeId) -> Result<Signals, Diagnostic> {
        let mut found = Vec::new();
        for node in self.nodes_in(root)? {
            let composite = self.tree.composite_of(node);
            let is_own = composite.is_some_and(|one| one.connector && !one.inherited.protected);
            if is_own && !self.is_expandable(node) {
                self.signals_in(node, &mut found)?;
            }
        }
        Ok(found)
    }

    fn signals_in(&mut self, node: NodeId, found: &mut Signals) -> Result<(), Diagnostic> {
        for one in self.nodes_in(node)? {
            match &self.tree.nodes[one.0].kind {
                NodeKind::Variable(leaf) => {
                    let name = self.tree.nodes[one.0].path.as_str().into();
                    found.extend(leaf.causality.map(|causality| (name, causality)));
                }
                NodeKind::Composite(_) => self.signals_in(one, found)?,
            }
        }
        Ok(())
    }

    fn nodes_in(&mut self, node: NodeId) -> Result<Vec<NodeId>, Diagnostic> {
        let states = self.members(node)?.into_iter().map(|(_, state)| match state {
            MemberState::Single(one) => vec![one],
            MemberState::Array(_, nodes) => nodes,
            _ => Vec::new(),
        });
        Ok(states.flatten().collect())
    }
}

/// Makes variables inputs and outputs of the model, or takes that back.
pub(crate) fn name(model: &mut FlatModel, signals: &Signals, are_own: bool) {
    for (name, causality) in signals {
        if let Some(variable) = model.variables.get_mut(name) {
            variable.causality = are_own.then_some(*causality);
        }
    }
}
