//! Expandable connectors (MLS §9.1.3): they get the components that connections name, and connected
//! ones get those of each other; components that nothing connects are left out.

use super::super::errors::INVALID_CONNECTION;
use super::super::flat_expression::literal;
use super::super::instantiate::instance::Declaration;
use super::super::instantiate::instance::Member;
use super::super::instantiate::instance::MemberState;
use super::super::instantiate::instance::NodeKind;
use super::super::lookup::modification::{Bound, Modifier};
use super::collect::Connect;
use crate::diag::Diagnostic;
use crate::fault;
use crate::flatten::Variability;
use crate::flatten::connections::end::End;
use crate::flatten::connections::end::Ends;
use crate::flatten::connections::sets::Connections;
use crate::flatten::ids::NodeId;
use crate::flatten::ids::ScopeId;
use crate::flatten::instantiate::instantiation::Instantiation;
use crate::flatten::lookup::classes::Classes;
use crate::name::Ident;
use crate::syntax::ast::{
    ComponentReference, ElementPrefixes, Expression, ExpressionKind, ReferencePart, Restriction,
    Subscript,
};
use crate::value::Value;
use indexmap::IndexMap;
use std::sync::Arc;

/// How often components may be passed on between connected connectors.
const MAX_ROUNDS: usize = 100;

/// A component that an expandable connector does not have yet.
struct Undeclared {
    connector: NodeId,
    part: ReferencePart,
}

impl Instantiation<'_> {
    /// Adds to all expandable connectors what connections ask of them.
    pub(crate) fn expand_connectors(&mut self, connects: &[Connect]) -> Result<(), Diagnostic> {
        let mut links: Vec<(NodeId, NodeId)> = Vec::new();
        let mut is_linked = vec![false; connects.len()];
        for _ in 0..MAX_ROUNDS {
            let mut required: IndexMap<(NodeId, Ident), Declaration> = IndexMap::new();
            for (connect, is_linked) in connects.iter().zip(&mut is_linked) {
                let one = self.undeclared(&connect.left, connect)?;
                let other = self.undeclared(&connect.right, connect)?;
                match (one, other) {
                    (Some(new), None) => {
                        self.require(new, &connect.right, connect, &mut required)?
                    }
                    (None, Some(new)) => {
                        self.require(new, &connect.left, connect, &mut required)?
                    }
                    // A component added by an earlier round may be expandable itself.
                    (None, None) if !*is_linked => {
                        self.link(connect, &mut links)?;
                        *is_linked = true;
                    }
                    _ => {}
                }
            }
            let mut changed = !required.is_empty();
            for ((node, _), declaration) in required {
                self.add_member(node, declaration);
            }
            for (one, other) in &links {
                changed |= self.pass_on(*one, *other) | self.pass_on(*other, *one);
            }
            if !changed {
                return Ok(());
            }
        }
        Ok(())
    }

    /// Whether one side of a connection would be a new component of an expandable connector: where
    /// the other side is disabled, there is no such component and no connection (MLS §4.4.5).
    pub(crate) fn adds_nothing(&mut self, connect: &Connect) -> Result<bool, Diagnostic> {
        let left = self.undeclared(&connect.left, connect)?;
        let right = self.undeclared(&connect.right, connect)?;
        Ok(left.is_some() || right.is_some())
    }

    /// The component that a reference would add to an expandable connector.
    fn undeclared(
        &mut self,
        reference: &ComponentReference,
        connect: &Connect,
    ) -> Result<Option<Undeclared>, Diagnostic> {
        let Some((last, before)) = reference.parts.split_last() else { return Ok(None) };
        if before.is_empty() {
            return Ok(None);
        }
        let holder = ComponentReference { parts: before.to_vec(), ..reference.clone() };
        // Any error is reported when the connection itself is made.
        let Ok(Some(Ends { ends, .. })) = self.ends(&holder, connect.context, &connect.local)
        else {
            return Ok(None);
        };
        let [End::Composite(connector)] = ends.as_slice() else { return Ok(None) };
        let known = self.classes.tree.declaration_of(*connector, last.name).is_some();
        if known || !self.classes.is_expandable(*connector) {
            return Ok(None);
        }
        Ok(Some(Undeclared { connector: *connector, part: last.clone() }))
    }

    /// Notes the component that a connection adds: of the type of what it is connected with.
    fn require(
        &mut self,
        new: Undeclared,
        partner: &ComponentReference,
        connect: &Connect,
        required: &mut IndexMap<(NodeId, Ident), Declaration>,
    ) -> Result<(), Diagnostic> {
        let Ok(Some(ends)) = self.ends(partner, connect.context, &connect.local) else {
            return Ok(());
        };
        let Some(end) = ends.ends.first() else { return Ok(()) };
        let (End::Composite(node) | End::Scalar(node, _)) = *end;
        let name = partner.parts[partner.parts.len() - 1].name;
        let holder = self.classes.tree.nodes[node.0].parent;
        let Some(model) = holder.and_then(|holder| self.classes.tree.declaration_of(holder, name))
        else {
            return Ok(());
        };
        let mut sizes = Vec::new();
        for subscript in &new.part.subscripts {
            sizes.push(self.place_of(subscript, connect)?);
        }
        sizes.extend(&ends.dims);
        let key = (new.connector, new.part.name);
        if let Some(known) = required.get(&key) {
            for (size, (subscript, _)) in sizes.iter_mut().zip(&known.dims) {
                if let Subscript::Index(Expression { kind: ExpressionKind::Integer(n), .. }) =
                    subscript
                {
                    *size = (*size).max(*n as usize);
                }
            }
        }
        let span = connect.span;
        let dim = |size: usize| {
            let kind = ExpressionKind::Integer(size as i64);
            (Subscript::Index(Expression::new(kind, span)), ScopeId::TOP)
        };
        let declaration = Declaration {
            name: new.part.name,
            dims: sizes.into_iter().map(dim).collect(),
            modifier: self.structure_of(node, partner, connect),
            condition: None,
            prefixes: ElementPrefixes::default(),
            protected: false,
            span,
            ..(*model).clone()
        };
        required.insert(key, declaration);
        Ok(())
    }

    /// The parameters of a connector that sizes and conditions in it may depend on: a connector that
    /// is to have its type has their values as well.
    fn structure_of(
        &mut self,
        node: NodeId,
        reference: &ComponentReference,
        connect: &Connect,
    ) -> Modifier {
        let mut modifier = Modifier::default();
        for (name, state) in self.classes.members(node).unwrap_or_default() {
            let MemberState::Single(parameter) = state else { continue };
            let NodeKind::Variable(leaf) = &self.classes.tree.nodes[parameter.0].kind else {
                continue;
            };
            let variable = &self.classes.tree.variables[leaf.variable].0;
            if variable.variability > Variability::Parameter || !variable.dims.is_empty() {
                continue;
            }
            let mut of_member = reference.clone();
            of_member.parts.push(ReferencePart { name, subscripts: Vec::new() });
            let e = Expression::new(ExpressionKind::Reference(of_member), connect.span);
            let Ok(resolved) = self.resolve(&e, connect.context, &connect.local) else { continue };
            let Ok(value @ (Value::Integer(_) | Value::Boolean(_) | Value::Enumeration(_))) =
                self.flat_value(&resolved)
            else {
                continue;
            };
            let binding = Bound {
                value: Some(literal(&value, connect.span)),
                context: ScopeId::TOP,
                each: true,
                each_left: 1,
                indices: Vec::new(),
                of_class: false,
            };
            let own = Modifier { binding: Some(binding), ..Modifier::default() };
            modifier.elements.insert(name, own);
        }
        modifier
    }

    fn place_of(&mut self, subscript: &Subscript, connect: &Connect) -> Result<usize, Diagnostic> {
        let Subscript::Index(index) = subscript else {
            return Err(fault!(
                INVALID_CONNECTION,
                "the size of a new component of an expandable connector must be known at \
                 translation"
            )
            .at(connect.span));
        };
        let resolved = self.resolve(index, connect.context, &connect.local)?;
        match self.flat_value(&resolved)? {
            Value::Integer(n) if n > 0 => Ok(n as usize),
            _ => Err(fault!(INVALID_CONNECTION, "expected a positive Integer").at(index.span)),
        }
    }

    /// Notes that two expandable connectors are connected.
    fn link(
        &mut self,
        connect: &Connect,
        links: &mut Vec<(NodeId, NodeId)>,
    ) -> Result<(), Diagnostic> {
        let one = self.ends(&connect.left, connect.context, &connect.local);
        let other = self.ends(&connect.right, connect.context, &connect.local);
        let (Ok(Some(one)), Ok(Some(other))) = (one, other) else { return Ok(()) };
        for pair in one.ends.iter().zip(&other.ends) {
            if let (End::Composite(a), End::Composite(b)) = pair
                && self.classes.is_expandable(*a)
                && self.classes.is_expandable(*b)
            {
                links.push((*a, *b));
            }
        }
        Ok(())
    }

    /// Gives one connector the components of another; `true` if it had not all of them. Expandable
    /// connectors inside are passed on to each other as well.
    fn pass_on(&mut self, from: NodeId, to: NodeId) -> bool {
        let Ok(members) = self.classes.members(from) else { return false };
        let mut changed = false;
        for (name, state) in members {
            if matches!(state, MemberState::Absent) {
                continue;
            }
            let Some(declaration) = self.classes.tree.declaration_of(from, name) else { continue };
            if self.classes.tree.declaration_of(to, name).is_none() {
                self.add_member(to, (*declaration).clone());
                changed = true;
            } else if let (Ok(Some(MemberState::Single(a))), Ok(Some(MemberState::Single(b)))) =
                (self.member(from, name), self.member(to, name))
                && self.classes.is_expandable(a)
                && self.classes.is_expandable(b)
            {
                changed |= self.pass_on(a, b);
            }
        }
        changed
    }

    fn add_member(&mut self, node: NodeId, declaration: Declaration) {
        let name = declaration.name;
        let member = Member { declaration: Arc::new(declaration), state: MemberState::Pending };
        if let NodeKind::Composite(composite) = &mut self.classes.tree.nodes[node.0].kind
            && let Some(members) = &mut composite.members
        {
            members.insert(name, member);
        }
        // What is wrong with it is found again when it is connected.
        let _ = self.member(node, name).map(|state| self.complete_added(state));
    }

    fn complete_added(&mut self, state: Option<MemberState>) {
        let nodes = match state {
            Some(MemberState::Single(one)) => vec![one],
            Some(MemberState::Array(_, nodes)) => nodes,
            _ => Vec::new(),
        };
        for node in nodes {
            let _ = self.complete(node);
            self.classes.tree.passed_on.insert(node);
        }
    }
}

impl Classes<'_> {
    pub(crate) fn is_expandable(&self, node: NodeId) -> bool {
        self.tree.scope_of(node).is_some_and(|scope| {
            scope != ScopeId::TOP
                && self.text(scope).restriction() == Restriction::ExpandableConnector
        })
    }

    /// Leaves out the components of expandable connectors that no connection names.
    pub(crate) fn drop_unconnected(&mut self, node: NodeId, connections: &mut Connections) {
        let expandable = self.is_expandable(node);
        let Ok(members) = self.members(node) else { return };
        for (name, state) in members {
            let nodes = match &state {
                MemberState::Single(one) => vec![*one],
                MemberState::Array(_, nodes) => nodes.clone(),
                _ => continue,
            };
            if expandable && !nodes.iter().any(|one| self.is_connected(*one, connections)) {
                self.tree.set_state(node, name, MemberState::Absent);
                nodes.iter().for_each(|one| self.drop_leaves(*one, connections));
                continue;
            }
            for one in nodes {
                self.drop_unconnected(one, connections);
            }
        }
    }

    fn drop_leaves(&mut self, node: NodeId, connections: &mut Connections) {
        if let NodeKind::Variable(_) = self.tree.nodes[node.0].kind {
            connections.dropped.insert(node);
            return;
        }
        for (_, state) in self.members(node).unwrap_or_default() {
            match state {
                MemberState::Single(one) => self.drop_leaves(one, connections),
                MemberState::Array(_, nodes) => {
                    nodes.into_iter().for_each(|one| self.drop_leaves(one, connections));
                }
                _ => {}
            }
        }
    }

    pub(crate) fn is_inside_expandable(&self, leaf: NodeId) -> bool {
        let mut node = self.tree.nodes[leaf.0].parent;
        while let Some(id) = node {
            if self.is_expandable(id) {
                return true;
            }
            node = self.tree.nodes[id.0].parent;
        }
        false
    }

    /// Whether a connection beyond expandable connectors names a scalar of an instance, or the instance has its own equations.
    fn is_connected(&mut self, node: NodeId, connections: &Connections) -> bool {
        if let NodeKind::Variable(leaf) = &self.tree.nodes[node.0].kind {
            let count = self.tree.variables[leaf.variable].0.len();
            let bound = leaf.modifier.binding.is_some();
            return bound
                || (0..count).any(|element| {
                    let set = connections.around(node, element);
                    set.iter().any(|side| !self.is_inside_expandable(side.leaf))
                });
        }
        let Ok(members) = self.members(node) else { return false };
        members.into_iter().any(|(_, state)| match state {
            MemberState::Single(one) => self.is_connected(one, connections),
            MemberState::Array(_, nodes) => {
                nodes.into_iter().any(|one| self.is_connected(one, connections))
            }
            _ => false,
        })
    }
}
