//! The local balance of classes (MLS §4.8): the equations that a model or block writes itself, with
//! those of its own connections and those that its connectors promise, against the unknowns that
//! it declares itself, with the inputs and flows of its components' connectors.
//!
//! Counted over the instances of a model. A class whose counts do not follow from its text — with expandable or
//! overdetermined connectors, connections through components or equations of unknown size — is
//! left out.

use super::super::connections::ScalarPair;
use super::super::errors::INVALID_CONNECTION;
use super::super::instantiate::instance::Leaf;
use super::super::instantiate::instance::MemberState;
use super::super::instantiate::instance::NodeKind;
use super::super::{BaseType, FlatModel, Part, Variability};
use super::{path, plural, scalars_of, size};
use crate::diag::Diagnostic;
use crate::eval::ValueType;
use crate::fault;
use crate::flatten::connections::sets::Connections;
use crate::flatten::connections::sets::ConnectorSide;
use crate::flatten::ids::NodeId;
use crate::flatten::instantiate::instantiation::Instantiation;
use crate::flatten::instantiate::tree::Tree;
use crate::flatten::lookup::classes::Classes;
use crate::name::Name;
use crate::source::Span;
use crate::syntax::ast::{
    CausalityPrefix, ConnectionPrefix, EquationKind, Expression, ExpressionKind, Restriction,
    targets,
};
use indexmap::IndexMap;
use rustc_hash::FxHashMap;
use std::collections::BTreeSet;
use std::sync::Arc;

/// Local unknowns and equations of one instance of a class.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct LocalBalance {
    /// The class.
    pub class: Name,
    /// Path of the instance; empty for the model itself.
    pub path: String,
    /// Scalar unknowns (MLS §4.8).
    pub unknowns: usize,
    /// Scalar equations, those that the connectors promise included.
    pub equations: usize,
    /// Scalar flow variables of its public connectors.
    pub flows: usize,
    /// Scalar inputs that the outside determines.
    pub inputs: usize,
    /// Where the class is declared.
    pub span: Span,
}

#[derive(Debug, Clone, Default)]
struct Counts {
    unknowns: usize,
    equations: usize,
    /// Equations of flows of components that are part of a larger set.
    merged: usize,
    flows: usize,
    inputs: usize,
    unclear: bool,
    /// The instance whose class holds the component; `None` for the model itself.
    holder: Option<NodeId>,
}

/// Where in a class a variable stands.
#[derive(Debug, Clone, Copy)]
struct Ownership {
    owner: NodeId,
    public: bool,
    in_connector: bool,
}

impl LocalBalance {
    /// Whether the numbers agree.
    pub(crate) fn is_balanced(&self) -> bool {
        self.unknowns == self.equations
    }

    /// The balance of a class whose connectors are open, in one line; `None` if it has none or the
    /// numbers differ.
    pub fn of_component(&self) -> Option<String> {
        let is_component = self.flows + self.inputs > 0 && self.is_balanced();
        is_component.then(|| {
            format!(
                "balanced: {}, {} with {} of connectors and {} outside",
                plural(self.unknowns, "unknown"),
                plural(self.equations, "equation"),
                plural(self.flows, "flow variable"),
                plural(self.inputs, "input")
            )
        })
    }

    /// What is wrong with the class.
    pub fn finding(&self) -> String {
        let (few, many) = (plural(self.unknowns, "unknown"), plural(self.equations, "equation"));
        format!("`{}` is not locally balanced: it has {few} but {many}", self.class)
    }
}

impl Instantiation<'_> {
    /// The local balance of the model and of its components, as far as they are known.
    pub(crate) fn local_balances(
        &mut self,
        connections: &Connections,
        model: &FlatModel,
    ) -> Result<Vec<LocalBalance>, Vec<Diagnostic>> {
        let mut counts = IndexMap::new();
        let mut owners = FxHashMap::default();
        counts.insert(self.classes.tree.root, Counts::default());
        let place = Ownership { owner: self.classes.tree.root, public: true, in_connector: false };
        self.classes.count_variables(
            self.classes.tree.root,
            place,
            model,
            &mut counts,
            &mut owners,
        );
        let root = self.classes.tree.root;
        let instances = self.classes.instances(root).map_err(|error| vec![error])?;
        for (node, part) in instances.into_iter().zip(&model.parts) {
            let owner = owners.get(&node).copied().unwrap_or(root);
            let added = self.local_equations(part, model);
            let Some(count) = counts.get_mut(&owner) else { continue };
            match added {
                Some(added) => count.equations += added,
                None => count.unclear = true,
            }
        }
        let found = self.classes.count_connections(connections, model, &mut counts, &owners);
        let (errors, warnings): (Vec<_>, Vec<_>) = found.into_iter().partition(|d| d.is_error());
        if !errors.is_empty() {
            return Err(errors);
        }
        self.warnings.extend(warnings);
        for path in determined_from_inside(model) {
            if let Some(count) = counts.iter_mut().find_map(|(node, count)| {
                (self.classes.tree.nodes[node.0].path == path).then_some(count)
            }) {
                count.unclear = true;
            }
        }
        for redundant in connections.graph.nodes() {
            if let Some(owner) = owners.get(&redundant) {
                self.classes.mark_unclear(*owner, &mut counts);
            }
        }
        let clear = counts.into_iter().filter(|(_, count)| !count.unclear);
        Ok(clear.filter_map(|(node, count)| self.classes.local_balance(node, &count)).collect())
    }

    /// Number of scalar equations, those of algorithms included; `None` if it is not known.
    fn local_equations(&mut self, part: &Part, model: &FlatModel) -> Option<usize> {
        let mut count = 0;
        for equation in &model.equations[part.equations.clone()] {
            count += match &equation.kind {
                EquationKind::Equal { left, right }
                    if self.is_of_records(left) || self.is_of_records(right) =>
                {
                    return None;
                }
                _ => size(equation, &mut |e| self.shape_of(e))?,
            };
        }
        for statements in &model.algorithms[part.algorithms.clone()] {
            count += scalars_of(targets(statements).into_iter(), model);
        }
        Some(count)
    }

    /// Whether the value is a record, or an array of records: its shape is not its number of scalars.
    fn is_of_records(&self, e: &Expression) -> bool {
        match &e.kind {
            ExpressionKind::Reference(reference) => {
                let name = path(reference);
                name != "time" && !self.classes.tree.variable_of.contains_key(&*name)
            }
            ExpressionKind::Call { function, .. } => {
                let function = self.functions.table.get(&function.name()).and_then(Option::as_ref);
                let output = function.and_then(|function| function.outputs.first());
                output.is_some_and(|output| matches!(output.value_type, ValueType::Record(..)))
            }
            ExpressionKind::Unary { operand, .. } => self.is_of_records(operand),
            ExpressionKind::Array(elements) => {
                elements.first().is_some_and(|first| self.is_of_records(first))
            }
            ExpressionKind::Subscripted { base, .. } => self.is_of_records(base),
            _ => false,
        }
    }
}

impl Classes<'_> {
    fn local_balance(&self, node: NodeId, count: &Counts) -> Option<LocalBalance> {
        let text = self.text(self.tree.scope_of(node)?);
        Some(LocalBalance {
            class: text.name.clone(),
            path: self.tree.nodes[node.0].path.clone(),
            unknowns: count.unknowns,
            equations: count.equations.saturating_sub(count.merged),
            flows: count.flows,
            inputs: count.inputs,
            span: text.span(),
        })
    }

    fn count_variables(
        &mut self,
        node: NodeId,
        place: Ownership,
        model: &FlatModel,
        counts: &mut IndexMap<NodeId, Counts>,
        owners: &mut FxHashMap<NodeId, NodeId>,
    ) {
        owners.insert(node, place.owner);
        let Ok(members) = self.members(node) else { return };
        for (name, state) in members {
            let hidden = self.tree.declaration_of(node, name).is_some_and(|one| one.protected);
            let nodes = match state {
                MemberState::Single(one) => vec![one],
                MemberState::Array(_, nodes) => nodes,
                _ => continue,
            };
            for one in nodes {
                let mut inner = Ownership { public: place.public && !hidden, ..place };
                if self.is_open_overdetermined(one, inner) {
                    self.mark_unclear(place.owner, counts);
                }
                let NodeKind::Composite(composite) = &self.tree.nodes[one.0].kind else {
                    owners.insert(one, place.owner);
                    self.count_variable(one, inner, model, counts);
                    continue;
                };
                inner.in_connector |= composite.connector;
                let restriction = self.text(composite.scope).restriction();
                let is_model = matches!(
                    restriction,
                    Restriction::Model | Restriction::Block | Restriction::Class
                );
                if is_model && !inner.in_connector {
                    let holder = Some(place.owner);
                    counts.insert(one, Counts { holder, ..Counts::default() });
                    inner = Ownership { owner: one, public: true, in_connector: false };
                } else if self.is_expandable(one) {
                    self.mark_unclear(place.owner, counts);
                }
                self.count_variables(one, inner, model, counts, owners);
            }
        }
    }

    /// Whether the outside decides which equations an overdetermined type in a connector of the model
    /// gets. In components the connections show it.
    fn is_open_overdetermined(&mut self, node: NodeId, place: Ownership) -> bool {
        let is_open = place.in_connector && place.public && place.owner == self.tree.root;
        is_open && self.is_overdetermined(node).unwrap_or(false)
    }

    fn mark_unclear(&self, owner: NodeId, counts: &mut IndexMap<NodeId, Counts>) {
        let holder = counts.get(&owner).and_then(|count| count.holder);
        for one in [Some(owner), holder].into_iter().flatten() {
            if let Some(count) = counts.get_mut(&one) {
                count.unclear = true;
            }
        }
    }

    fn count_variable(
        &self,
        node: NodeId,
        place: Ownership,
        model: &FlatModel,
        counts: &mut IndexMap<NodeId, Counts>,
    ) {
        let NodeKind::Variable(leaf) = &self.tree.nodes[node.0].kind else { return };
        let Some(variable) = model.variables.get(self.tree.nodes[node.0].path.as_str()) else {
            return;
        };
        let has_value = variable.binding.is_some() || leaf.modifier.binding.is_some();
        let is_bound_object = matches!(variable.base, BaseType::ExternalObject(_)) && has_value;
        if variable.variability < Variability::Discrete || is_bound_object {
            return;
        }
        let n = variable.len();
        let binder = self.binder(leaf);
        let given_inside = variable.binding.is_some() && binder == Some(place.owner);
        let is_flow = leaf.connection == Some(ConnectionPrefix::Flow) && place.in_connector;
        let is_input = leaf.causality == Some(CausalityPrefix::Input) && place.public;
        let is_open_input = is_input && !given_inside;
        if is_input && given_inside && (place.in_connector || leaf.connector) {
            // It determines what its binding names if it is connected; otherwise it is determined by it.
            self.mark_unclear(place.owner, counts);
        }
        let Some(count) = counts.get_mut(&place.owner) else { return };
        count.unknowns += n;
        // The outside determines flows and inputs; a flow that is not visible outside is zero.
        if is_flow || is_open_input {
            count.equations += n;
        }
        count.flows += if is_flow && place.public { n } else { 0 };
        count.inputs += if is_open_input { n } else { 0 };
        let holder = count.holder;
        if variable.binding.is_some() && !is_open_input {
            count.equations += n;
        }
        let Some(outside) = holder.and_then(|holder| counts.get_mut(&holder)) else { return };
        if place.public && (is_flow || is_open_input) {
            outside.unknowns += n;
            // A flow that is not connected is zero.
            outside.equations += if is_flow { n } else { 0 };
        }
        if is_open_input && variable.binding.is_some() {
            outside.equations += n;
        }
    }

    /// The instance in whose class the binding of a variable is written.
    fn binder(&self, leaf: &Leaf) -> Option<NodeId> {
        let mut own = leaf.modifier.of_elements.values().filter_map(|one| one.binding.as_ref());
        let bound = leaf.modifier.binding.as_ref().or_else(|| own.next())?;
        Some(self.node_of(bound.context))
    }

    /// Adds the equations of the sets that the connections of each class make by themselves.
    fn count_connections(
        &self,
        connections: &Connections,
        model: &FlatModel,
        counts: &mut IndexMap<NodeId, Counts>,
        owners: &FxHashMap<NodeId, NodeId>,
    ) -> Vec<Diagnostic> {
        let mut of_class: IndexMap<NodeId, Vec<ScalarPair>> = IndexMap::new();
        for edge in &connections.pairs {
            let Some(context) = owners.get(&edge.context).copied() else { continue };
            let is_near = |leaf: NodeId| {
                let owner = owners.get(&leaf).copied();
                let holder = owner.and_then(|owner| counts.get(&owner)?.holder);
                owner == Some(context) || holder == Some(context)
            };
            let far: Vec<NodeId> =
                edge.sides.iter().map(|side| side.leaf).filter(|leaf| !is_near(*leaf)).collect();
            for leaf in &far {
                if let Some(owner) = owners.get(leaf) {
                    self.mark_unclear(*owner, counts);
                }
            }
            match counts.get_mut(&context) {
                Some(count) if !far.is_empty() => count.unclear = true,
                _ => of_class.entry(context).or_default().push(edge.clone()),
            }
        }
        let mut errors = Vec::new();
        for (context, edges) in of_class {
            let sets = super::sets::of_edges(&edges);
            let Some(count) = counts.get_mut(&context) else { continue };
            for set in sets {
                errors.extend(self.two_sources(&set, context, &edges, owners));
                if set.iter().any(|side| self.is_bound_object(side.leaf, model)) {
                    continue;
                }
                let outside = set.iter().filter(|side| side.outside).count();
                match self.tree.connection_of(set[0].leaf) {
                    None => count.equations += self.tree.potential_equations(&set),
                    Some(ConnectionPrefix::Flow) => {
                        count.equations += 1;
                        count.merged += set.len() - outside;
                    }
                    Some(ConnectionPrefix::Stream) => count.equations += outside,
                }
            }
        }
        errors
    }

    /// Objects with a value are not unknowns: see `object_equations`.
    fn is_bound_object(&self, node: NodeId, model: &FlatModel) -> bool {
        let variable = model.variables.get(self.tree.nodes[node.0].path.as_str());
        variable.is_some_and(|variable| {
            matches!(variable.base, BaseType::ExternalObject(_)) && variable.binding.is_some()
        })
    }

    /// A connection set of a class has one source of a signal at most: an output of a component, or
    /// an input of the class itself (MLS §9.3). Expandable connectors pass signals on in either
    /// direction (MLS §9.1.3).
    fn two_sources(
        &self,
        set: &[ConnectorSide],
        context: NodeId,
        edges: &[ScalarPair],
        owners: &FxHashMap<NodeId, NodeId>,
    ) -> Option<Diagnostic> {
        let is_source = |side: &&ConnectorSide| {
            let NodeKind::Variable(leaf) = &self.tree.nodes[side.leaf.0].kind else { return false };
            let is_own = owners.get(&side.leaf) == Some(&context);
            match leaf.causality {
                Some(CausalityPrefix::Input) => {
                    is_own && !self.tree.variables[leaf.variable].0.protected
                }
                Some(CausalityPrefix::Output) => !is_own,
                None => false,
            }
        };
        // A connector with flow variables has two sides; which of them gives its signals shows in
        // the balance of the whole (as BioChem has it).
        let mut sources = set.iter().filter(|side| {
            is_source(side)
                && !self.is_inside_expandable(side.leaf)
                && !self.tree.is_beside_flow(side.leaf)
        });
        let (one, other) = (sources.next()?, sources.next()?);
        let edge = edges.iter().find(|edge| edge.sides.contains(other))?;
        let [one, other] = [one, other].map(|side| &self.tree.nodes[side.leaf.0].path);
        let error =
            fault!(INVALID_CONNECTION, "`{one}` and `{other}` are connected and both are sources";
                help: "connect an output of a component, or an input of the class, to inputs; \
                       outputs of several states of a state machine are not supported: let the \
                       states have an `outer output`")
            .at(edge.span);
        // One of them may have no equation of its own: the balance of the model decides.
        Some(if self.library.is_strict() { error } else { error.warning() })
    }
}

impl Tree {
    /// Whether a scalar is in a connector that has flow variables.
    fn is_beside_flow(&self, leaf: NodeId) -> bool {
        let Some(parent) = self.nodes[leaf.0].parent else { return false };
        let NodeKind::Composite(connector) = &self.nodes[parent.0].kind else { return false };
        let members = connector.members.iter().flat_map(|members| members.values());
        members.into_iter().any(|member| match member.state {
            MemberState::Single(child) => self.connection_of(child) == Some(ConnectionPrefix::Flow),
            _ => false,
        })
    }

    fn potential_equations(&self, set: &[ConnectorSide]) -> usize {
        let varies = |side: &&ConnectorSide| match &self.nodes[side.leaf.0].kind {
            NodeKind::Variable(leaf) => {
                self.variables[leaf.variable].0.variability >= Variability::Discrete
            }
            NodeKind::Composite(_) => false,
        };
        set.iter().filter(varies).count().saturating_sub(1)
    }
}

/// The instances with `outer output` components, and those that hold the variables to which these
/// refer: in a state machine several equations determine one variable in turn (MLS §17.3.5).
fn determined_from_inside(model: &FlatModel) -> BTreeSet<&str> {
    let mut paths = BTreeSet::new();
    for part in model.parts.iter().filter(|part| !part.outputs.is_empty()) {
        paths.insert(&*part.instance);
        let holder = |name: &'_ Arc<str>| name.rfind('.').unwrap_or(0);
        paths.extend(part.outputs.iter().map(|name| &name[..holder(name)]));
    }
    paths
}
