//! What a reference in a connection names: connectors, or scalars of connectors.

use super::super::errors::{INVALID_CONNECTION, SIZE_MISMATCH, UNKNOWN_NAME};
use super::super::instantiate::instance::MemberState;
use super::super::instantiate::instance::NodeKind;
use crate::diag::Diagnostic;
use crate::fault;
use crate::flatten::connections::end::End;
use crate::flatten::connections::end::Ends;
use crate::flatten::expressions::local::Local;
use crate::flatten::ids::NodeId;
use crate::flatten::ids::ScopeId;
use crate::flatten::instantiate::instantiation::Instantiation;
use crate::flatten::instantiate::tree::Tree;
use crate::source::Span;
use crate::syntax::ast::{ComponentReference, ReferencePart, Subscript};

impl Instantiation<'_> {
    /// The connectors that a reference names; `None` if one of its components does not exist.
    pub(crate) fn ends(
        &mut self,
        reference: &ComponentReference,
        context: ScopeId,
        local: &Local,
    ) -> Result<Option<Ends>, Diagnostic> {
        let node = self.classes.node_of(context);
        let first = &reference.parts[0];
        if !self.classes.has_component(context, first.name)? {
            return Err(self.classes.unknown_name(reference, context));
        }
        let Some((dims, ends)) =
            self.walk_ends(node, &reference.parts, reference, context, local)?
        else {
            return Ok(None);
        };
        let outside = self.is_connector_member(node, first)?;
        Ok(Some(Ends { dims, ends, outside }))
    }

    /// Whether a component of an instance is itself a connector.
    fn is_connector_member(
        &mut self,
        node: NodeId,
        part: &ReferencePart,
    ) -> Result<bool, Diagnostic> {
        let one = match self.component_state(node, part)? {
            Some(MemberState::Single(one)) => Some(one),
            Some(MemberState::Array(_, nodes)) => nodes.first().copied(),
            _ => None,
        };
        Ok(one.is_some_and(|one| match &self.classes.tree.nodes[one.0].kind {
            NodeKind::Composite(composite) => composite.connector,
            NodeKind::Variable(leaf) => leaf.connector,
        }))
    }

    /// The state of a component, an outer one followed to its inner one.
    fn component_state(
        &mut self,
        node: NodeId,
        part: &ReferencePart,
    ) -> Result<Option<MemberState>, Diagnostic> {
        Ok(self.member(node, part.name)?.map(MemberState::seen))
    }

    #[allow(clippy::type_complexity, reason = "sizes and ends, or nothing")]
    fn walk_ends(
        &mut self,
        node: NodeId,
        parts: &[ReferencePart],
        whole: &ComponentReference,
        context: ScopeId,
        local: &Local,
    ) -> Result<Option<(Vec<usize>, Vec<End>)>, Diagnostic> {
        let Some((part, rest)) = parts.split_first() else {
            return Ok(Some((Vec::new(), vec![End::Composite(node)])));
        };
        let Some(state) = self.component_state(node, part)? else {
            return Err(self.classes.unknown_component(node, part.name, whole.span));
        };
        let subscripts = self.subscripts(&part.subscripts, context, local)?;
        match state {
            MemberState::Single(one) => match &self.classes.tree.nodes[one.0].kind {
                NodeKind::Variable(leaf) => {
                    let dims = self.classes.tree.variables[leaf.variable].0.dims.clone();
                    self.scalars(one, dims, &subscripts, rest, whole).map(Some)
                }
                NodeKind::Composite(_) if subscripts.is_empty() => {
                    self.walk_ends(one, rest, whole, context, local)
                }
                NodeKind::Composite(_) => {
                    Err(fault!(SIZE_MISMATCH, "`{}` is not an array", part.name).at(whole.span))
                }
            },
            MemberState::Array(dims, nodes) => {
                let chosen = self.choose(&dims, &subscripts, part.name, whole.span)?;
                let mut kept: Vec<usize> =
                    chosen.iter().filter(|(_, stays)| *stays).map(|(all, _)| all.len()).collect();
                let mut ends = Vec::new();
                let mut inner = None;
                for place in places(&chosen, &dims) {
                    let walked = self.walk_ends(nodes[place], rest, whole, context, local)?;
                    let Some((dims, mut found)) = walked else { return Ok(None) };
                    inner = Some(dims);
                    ends.append(&mut found);
                }
                kept.extend(inner.unwrap_or_default());
                Ok(Some((kept, ends)))
            }
            MemberState::Absent => Ok(None),
            MemberState::Pending
            | MemberState::Busy
            | MemberState::Outer(_)
            | MemberState::Both { .. } => {
                Err(fault!(INVALID_CONNECTION, "`{}` cannot be connected here", part.name)
                    .at(whole.span))
            }
        }
    }

    fn scalars(
        &mut self,
        leaf: NodeId,
        dims: Vec<usize>,
        subscripts: &[Subscript],
        rest: &[ReferencePart],
        whole: &ComponentReference,
    ) -> Result<(Vec<usize>, Vec<End>), Diagnostic> {
        if let Some(next) = rest.first() {
            let path = &self.classes.tree.nodes[leaf.0].path;
            let name = next.name;
            return Err(fault!(
                UNKNOWN_NAME,
                "`{path}` is a variable and has no component `{name}`"
            )
            .at(whole.span));
        }
        let name = whole.parts[whole.parts.len() - 1].name;
        let chosen = self.choose(&dims, subscripts, name, whole.span)?;
        let kept = chosen.iter().filter(|(_, stays)| *stays).map(|(all, _)| all.len()).collect();
        let ends = places(&chosen, &dims).into_iter().map(|place| End::Scalar(leaf, place));
        Ok((kept, ends.collect()))
    }
}

impl Tree {
    /// Where an end is declared, for messages.
    pub(crate) fn end_path(&self, end: End) -> String {
        match end {
            End::Composite(node) | End::Scalar(node, _) => self.nodes[node.0].path.clone(),
        }
    }

    pub(crate) fn end_span(&self, end: End) -> Span {
        match end {
            End::Composite(_) => Span::NONE,
            End::Scalar(node, _) => match &self.nodes[node.0].kind {
                NodeKind::Variable(leaf) => self.variables[leaf.variable].0.span,
                NodeKind::Composite(_) => Span::NONE,
            },
        }
    }
}

/// The places of chosen elements in an array, the last index fastest.
fn places(chosen: &[(Vec<usize>, bool)], dims: &[usize]) -> Vec<usize> {
    let mut places = vec![0];
    for ((indices, _), size) in chosen.iter().zip(dims) {
        let longer = |place: usize| indices.iter().map(move |index| place * size + index - 1);
        places = places.into_iter().flat_map(longer).collect();
    }
    places
}
