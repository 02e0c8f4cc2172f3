//! The instance tree (MLS §5.6.1): its nodes, and the variables among them.

use super::instance::{
    Composite, Declaration, Inherited, Leaf, Member, MemberState, Node, NodeKind,
};
use crate::diag::Diagnostic;
use crate::fault;
use crate::flatten::errors::TOO_LARGE;
use crate::flatten::ids::NodeId;
use crate::flatten::ids::ScopeId;
use crate::flatten::instantiate::instance::Expanded;
use crate::flatten::lookup::modification::Modifier;
use crate::flatten::lookup::types::ATTRIBUTES;
use crate::flatten::{BaseType, Variability, Variable, unknown};
use crate::name::{Ident, Name};
use crate::source::Span;
use crate::syntax::ast::{CausalityPrefix, VariabilityPrefix};
use indexmap::IndexMap;
use rustc_hash::{FxHashMap, FxHashSet};
use std::sync::Arc;

/// The most scalar variables and the most components that are built: heat conduction with a million
/// states, and heat flows between them, has two million and one.
const MAX_SCALARS: usize = 5_000_000;
pub(crate) const MAX_INSTANCES: usize = 1_000_000;

/// Begins the path of a package's instance; no component can be named so.
const PACKAGE_MARK: char = '.';

/// The growing tree.
pub(crate) struct Tree {
    pub nodes: Vec<Node>,
    /// Variables with the node of each.
    pub variables: Vec<(Variable, NodeId)>,
    pub variable_of: FxHashMap<Arc<str>, usize>,
    /// Components that expandable connectors have because others have them (MLS §9.1.3).
    pub passed_on: FxHashSet<NodeId>,
    /// The instance of the model.
    pub root: NodeId,
    /// The simple name of its class.
    pub(crate) model_name: Ident,
    scalars: usize,
}

impl Tree {
    /// Whether an instance or a variable is a connector.
    pub(crate) fn is_connector(&self, node: NodeId) -> bool {
        match &self.nodes[node.0].kind {
            NodeKind::Composite(composite) => composite.connector,
            NodeKind::Variable(leaf) => leaf.connector,
        }
    }

    /// The node 0 alone, which has no components: the instance of the top scope.
    pub(crate) fn new() -> Tree {
        let nowhere = Composite {
            scope: ScopeId::TOP,
            class: ScopeId::TOP,
            members: Some(IndexMap::new()),
            inherited: Inherited::default(),
            connector: false,
        };
        let node = Node { path: String::new(), parent: None, kind: NodeKind::Composite(nowhere) };
        Tree {
            nodes: vec![node],
            variables: Vec::new(),
            variable_of: FxHashMap::default(),
            passed_on: FxHashSet::default(),
            root: NodeId(0),
            model_name: Ident::new(""),
            scalars: 0,
        }
    }

    pub(crate) fn add_node(
        &mut self,
        path: String,
        parent: Option<NodeId>,
        inherited: Inherited,
    ) -> NodeId {
        let id = NodeId(self.nodes.len());
        let composite = Composite {
            scope: ScopeId::TOP,
            class: ScopeId::TOP,
            members: None,
            inherited,
            connector: false,
        };
        self.nodes.push(Node { path, parent, kind: NodeKind::Composite(composite) });
        id
    }

    /// The instance of a package or class for its constants; nothing in it is built yet.
    pub(crate) fn add_package(&mut self, name: &Name, holder: NodeId) -> NodeId {
        let path = format!("{PACKAGE_MARK}{name}");
        self.add_node(path, Some(holder), Inherited::default())
    }

    pub(crate) fn set_scope(&mut self, node: NodeId, scope: ScopeId) {
        if let NodeKind::Composite(composite) = &mut self.nodes[node.0].kind {
            composite.scope = scope;
            composite.class = scope;
        }
    }

    pub(crate) fn set_class(&mut self, node: NodeId, class: ScopeId) {
        if let NodeKind::Composite(composite) = &mut self.nodes[node.0].kind {
            composite.class = class;
        }
    }

    /// The class of an instance; `None` for a variable.
    pub(crate) fn scope_of(&self, node: NodeId) -> Option<ScopeId> {
        self.composite_of(node).map(|composite| composite.scope)
    }

    /// The declaration of a component of an instance.
    pub(crate) fn declaration_of(&self, node: NodeId, name: Ident) -> Option<Arc<Declaration>> {
        let members = self.composite_of(node)?.members.as_ref()?;
        members.get(&name).map(|member| member.declaration.clone())
    }

    pub(crate) fn composite_of(&self, node: NodeId) -> Option<&Composite> {
        match &self.nodes[node.0].kind {
            NodeKind::Composite(composite) => Some(composite),
            NodeKind::Variable(_) => None,
        }
    }

    /// The names of the `outer` components of an instance whose components are known.
    pub(crate) fn outer_members(&self, node: NodeId) -> Vec<Ident> {
        let members = self.composite_of(node).and_then(|composite| composite.members.as_ref());
        let is_outer = |(name, member): (&Ident, &Member)| {
            matches!(member.state, MemberState::Outer(_)).then_some(*name)
        };
        members.map_or(Vec::new(), |members| members.iter().filter_map(is_outer).collect())
    }

    pub(crate) fn set_state(&mut self, node: NodeId, name: Ident, state: MemberState) {
        if let NodeKind::Composite(composite) = &mut self.nodes[node.0].kind
            && let Some(member) =
                composite.members.as_mut().and_then(|members| members.get_mut(&name))
        {
            member.state = state;
        }
    }

    pub(crate) fn path_of(&self, node: NodeId, name: Ident) -> String {
        let parent = &self.nodes[node.0].path;
        if parent.is_empty() { name.to_string() } else { format!("{parent}.{name}") }
    }

    pub(crate) fn count(&mut self, scalars: usize, span: Span) -> Result<(), Diagnostic> {
        self.scalars = self.scalars.saturating_add(scalars.max(1));
        if self.scalars > MAX_SCALARS {
            return Err(fault!(
                TOO_LARGE,
                "the model has more than {MAX_SCALARS} scalar variables"
            )
            .at(span));
        }
        Ok(())
    }

    pub(crate) fn inherited_by(
        &self,
        node: NodeId,
        declared: &Declaration,
        expanded: &Expanded,
    ) -> Inherited {
        let parent = self.composite_of(node).map_or(Inherited::default(), |c| c.inherited);
        let prefixes = declared.type_prefixes;
        Inherited {
            variability: stricter(parent.variability, prefixes.variability.map(variability)),
            causality: parent.causality.or(prefixes.causality).or(expanded.causality),
            connection: parent.connection.or(prefixes.connection).or(expanded.connection),
            is_final: parent.is_final || declared.is_final,
            protected: parent.protected || declared.protected,
            depth: parent.depth + 1,
        }
    }

    pub(crate) fn mark_connector(&mut self, node: NodeId, connector: bool) {
        if let NodeKind::Composite(composite) = &mut self.nodes[node.0].kind {
            composite.connector = connector;
        }
    }

    /// Adds a variable below a node.
    pub(crate) fn variable(
        &mut self,
        node: NodeId,
        declared: &Declaration,
        expanded: Expanded,
        base: BaseType,
        dims: Vec<usize>,
    ) -> Result<NodeId, Diagnostic> {
        check_attributes(declared, &expanded.modifier)?;
        expanded.modifier.check_elements(declared.name, &dims)?;
        let scalars = dims.iter().try_fold(1usize, |n, d| n.checked_mul(*d)).unwrap_or(usize::MAX);
        self.count(scalars, declared.span)?;
        let inherited = self.inherited_by(node, declared, &expanded);
        let top_level = self.nodes[node.0].path.is_empty();
        // A protected input cannot get its value from outside: it is determined inside.
        let is_inner_input =
            inherited.protected && inherited.causality == Some(CausalityPrefix::Input);
        let name: Arc<str> = self.path_of(node, declared.name).into();
        let discrete = base != BaseType::Real;
        let default = if discrete { Variability::Discrete } else { Variability::Continuous };
        let variable = Variable {
            name: name.clone(),
            base,
            dims,
            variability: inherited.variability.unwrap_or(default).min(default),
            causality: inherited.causality.filter(|_| top_level && !is_inner_input),
            is_input: inherited.causality == Some(CausalityPrefix::Input),
            is_final: inherited.is_final,
            protected: inherited.protected,
            evaluate: declared.evaluate,
            is_relative: declared.absolute.or(expanded.absolute) == Some(false),
            structural: false,
            top_level,
            attributes: IndexMap::new(),
            binding: None,
            description: declared.description.clone(),
            span: declared.span,
        };
        let leaf = Leaf {
            variable: self.variables.len(),
            modifier: expanded.modifier,
            connection: inherited.connection,
            causality: inherited.causality,
            connector: expanded.connector,
            class: expanded.class,
        };
        let id = NodeId(self.nodes.len());
        if !self.in_package(node) {
            self.variable_of.insert(name.clone(), leaf.variable);
        }
        self.variables.push((variable, id));
        let path = name.to_string();
        self.nodes.push(Node { path, parent: Some(node), kind: NodeKind::Variable(leaf) });
        Ok(id)
    }

    /// Whether a node lies in the instance of a package, whose paths begin with its full name.
    pub(crate) fn in_package(&self, node: NodeId) -> bool {
        self.nodes[node.0].path.starts_with(PACKAGE_MARK)
    }

    pub(crate) fn member_at(&self, node: NodeId, at: usize) -> Option<Ident> {
        let members = self.composite_of(node)?.members.as_ref()?;
        members.get_index(at).map(|(name, _)| *name)
    }
}

fn variability(prefix: VariabilityPrefix) -> Variability {
    match prefix {
        VariabilityPrefix::Constant => Variability::Constant,
        VariabilityPrefix::Parameter => Variability::Parameter,
        VariabilityPrefix::Discrete => Variability::Discrete,
    }
}

fn stricter(outer: Option<Variability>, own: Option<Variability>) -> Option<Variability> {
    match (outer, own) {
        (Some(outer), Some(own)) => Some(outer.min(own)),
        (outer, own) => outer.or(own),
    }
}

/// Modifiers of a variable are those of its attributes (MLS §4.9).
fn check_attributes(declared: &Declaration, modifier: &Modifier) -> Result<(), Diagnostic> {
    for (name, modifier) in &modifier.elements {
        if !ATTRIBUTES.contains(&name.as_str()) {
            let span = modifier.span.unwrap_or(declared.span);
            return Err(unknown::attribute(declared.name, *name, span));
        }
    }
    Ok(())
}
