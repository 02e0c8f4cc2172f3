//! Instances of classes with components (MLS §5.6.1): their components are listed, and built later.

use super::instance::{Declaration, Inherited, Member, MemberState, NodeKind, Shape};
use crate::diag::Diagnostic;
use crate::fault;
use crate::flatten::errors::{CYCLIC_CLASS, PARTIAL_CLASS, TOO_LARGE, TYPE_MISMATCH};
use crate::flatten::flat_expression::indices_of;
use crate::flatten::flat_expression::picked;
use crate::flatten::ids::NodeId;
use crate::flatten::ids::ScopeId;
use crate::flatten::instantiate::instance::Expanded;
use crate::flatten::instantiate::tree::MAX_INSTANCES;
use crate::flatten::lookup::classes::Classes;
use crate::flatten::lookup::modification::{Bound, Modifier};
use crate::flatten::lookup::scope::Text;
use crate::name::Ident;
use crate::source::Span;
use crate::syntax::ast::{
    Expression, ExpressionKind, ReferencePart, Restriction, VariabilityPrefix,
};
use indexmap::IndexMap;
use std::sync::Arc;

/// The deepest nesting of components that is built.
const MAX_DEPTH: usize = 60;

/// How many times a class may hold a component of its own class.
const MAX_SELF: usize = 20;

impl Classes<'_> {
    /// The instance of the model itself, under a modifier.
    pub(crate) fn model(
        &mut self,
        class: ScopeId,
        modifier: Modifier,
    ) -> Result<NodeId, Diagnostic> {
        let text = self.text(class);
        let modifier = self
            .scope(class)
            .modifier
            .clone()
            .overridden_by(modifier, text.definition.name.node)?;
        let node = self.composite(class, String::new(), None, modifier, Inherited::default())?;
        self.tree.root = node;
        Ok(node)
    }

    /// An instance of a class with components at a path; its components are not built yet.
    fn composite(
        &mut self,
        class: ScopeId,
        path: String,
        holder: Option<NodeId>,
        modifier: Modifier,
        inherited: Inherited,
    ) -> Result<NodeId, Diagnostic> {
        let text = self.text(class).clone();
        if inherited.depth > MAX_DEPTH {
            return Err(fault!(
                TOO_LARGE,
                "the components of the model are nested more than {MAX_DEPTH} deep: `{}`",
                text.name
            )
            .at(text.span()));
        }
        if self.is_inside_itself(&text, holder) {
            return Err(fault!(
                CYCLIC_CLASS,
                "`{}` contains a component of its own class",
                text.name
            )
            .at(text.span()));
        }
        if self.tree.nodes.len() > MAX_INSTANCES {
            return Err(fault!(TOO_LARGE, "the model has more than {MAX_INSTANCES} components")
                .at(text.span()));
        }
        let parent = self.scope(class).parent.unwrap_or(ScopeId::TOP);
        let names: Vec<(Ident, Option<Span>)> =
            modifier.elements.iter().map(|(name, modifier)| (*name, modifier.span)).collect();
        let span = modifier.span.unwrap_or(text.span());
        let node = self.tree.add_node(path, holder, inherited);
        let scope = self.add_scope(text, parent, node, modifier, Modifier::default())?;
        self.tree.set_scope(node, scope);
        self.tree.set_class(node, class);
        self.fill(node)?;
        for (name, place) in names {
            self.check_modified(scope, name, place.unwrap_or(span))?;
        }
        Ok(node)
    }

    /// Whether a component of this class would hold itself.
    fn is_inside_itself(&self, text: &Text, holder: Option<NodeId>) -> bool {
        let mut node = holder;
        let mut times = 0;
        while let Some(id) = node {
            let known = self.tree.scope_of(id).and_then(|scope| self.scope(scope).text.as_ref());
            if known.is_some_and(|known| known.definition.span == text.definition.span) {
                times += 1;
            }
            node = self.tree.nodes[id.0].parent;
        }
        // A class may hold another form of itself, with the recursion ended by a condition.
        times > MAX_SELF
    }

    /// Lists the components of an instance, as far as they are not listed yet.
    pub(crate) fn fill(&mut self, node: NodeId) -> Result<(), Diagnostic> {
        let Some(composite) = self.tree.composite_of(node) else { return Ok(()) };
        if composite.members.is_some() {
            return Ok(());
        }
        let scope = composite.scope;
        let elements = self.elements(scope)?;
        let mut members: IndexMap<Ident, Member> = elements
            .iter()
            .map(|(name, declaration)| {
                let state = MemberState::Pending;
                (name, Member { declaration: declaration.clone(), state })
            })
            .collect();
        if let Some(binding) = self.scope(scope).modifier.binding.clone() {
            self.split_binding(scope, &binding, &mut members)?;
        }
        if let NodeKind::Composite(composite) = &mut self.tree.nodes[node.0].kind {
            composite.members = Some(members);
        }
        Ok(())
    }

    pub(crate) fn is_record(&self, scope: ScopeId) -> bool {
        matches!(self.text(scope).restriction(), Restriction::Record | Restriction::OperatorRecord)
    }

    /// The instances with components at a node and below it, the inner ones first.
    pub(crate) fn instances(&mut self, node: NodeId) -> Result<Vec<NodeId>, Diagnostic> {
        let mut found = Vec::new();
        self.collect_instances(node, &mut found)?;
        Ok(found)
    }

    fn collect_instances(
        &mut self,
        node: NodeId,
        found: &mut Vec<NodeId>,
    ) -> Result<(), Diagnostic> {
        if self.tree.scope_of(node).is_none() {
            return Ok(());
        }
        for (_, state) in self.members(node)? {
            match state {
                MemberState::Single(one) => self.collect_instances(one, found)?,
                MemberState::Array(_, nodes) => {
                    for one in nodes {
                        self.collect_instances(one, found)?;
                    }
                }
                _ => {}
            }
        }
        found.push(node);
        Ok(())
    }

    /// The components of an instance, with their states.
    pub(crate) fn members(
        &mut self,
        node: NodeId,
    ) -> Result<Vec<(Ident, MemberState)>, Diagnostic> {
        self.fill(node)?;
        let members = self.tree.composite_of(node).and_then(|composite| composite.members.as_ref());
        Ok(members.map_or(Vec::new(), |members| {
            members.iter().map(|(name, member)| (*name, member.state.clone().own())).collect()
        }))
    }

    /// Gives every component of a record its part of the record's binding (MLS §7.2.2).
    fn split_binding(
        &self,
        class: ScopeId,
        binding: &Bound,
        members: &mut IndexMap<Ident, Member>,
    ) -> Result<(), Diagnostic> {
        let Some(value) = &binding.value else { return Ok(()) };
        if !self.is_record(class) {
            let name = &self.text(class).name;
            return Err(fault!(TYPE_MISMATCH, "a component of type `{name}` cannot have a value";
                help: "only records and variables can have values")
            .at(value.span));
        }
        let picked = Arc::new(picked(value.clone(), &binding.indices));
        let is_computed = !is_component(&picked);
        for (name, member) in members {
            let is_constant =
                member.declaration.type_prefixes.variability == Some(VariabilityPrefix::Constant);
            if is_constant && is_computed && member.declaration.modifier.binding.is_some() {
                // A constant with a value is not an input of the record's constructor (MLS
                // §12.6.1).
                continue;
            }
            let mut declaration = (*member.declaration).clone();
            declaration.modifier.binding = Some(Bound {
                value: Some(component_of(&picked, *name)),
                context: binding.context,
                // The value was that of every element of an array of records; of one record each
                // component has its own.
                each: false,
                each_left: 0,
                indices: Vec::new(),
                of_class: false,
            });
            member.declaration = Arc::new(declaration);
        }
        Ok(())
    }

    pub(crate) fn components(
        &mut self,
        node: NodeId,
        declared: &Declaration,
        expanded: Expanded,
        dims: Vec<usize>,
    ) -> Result<MemberState, Diagnostic> {
        let Shape::Class(class) = expanded.shape else {
            return Err(fault!(
                TYPE_MISMATCH,
                "`{}` is a function; only an input of a function can have a function type",
                declared.name
            )
            .at(declared.span));
        };
        self.check_complete(class, declared.span)?;
        let inherited = self.tree.inherited_by(node, declared, &expanded);
        let path = self.tree.path_of(node, declared.name);
        expanded.modifier.check_elements(declared.name, &dims)?;
        if dims.is_empty() {
            let modifier = expanded.modifier.at_element(&[], declared.name)?;
            let built = self.composite(class, path, Some(node), modifier, inherited)?;
            self.tree.mark_connector(built, expanded.connector);
            return Ok(MemberState::Single(built));
        }
        let count = dims.iter().try_fold(1usize, |n, d| n.checked_mul(*d)).unwrap_or(usize::MAX);
        self.tree.count(count, declared.span)?;
        let mut nodes = Vec::with_capacity(count);
        for at in 0..count {
            let indices = indices_of(at, &dims);
            let numbers: Vec<String> = indices.iter().map(usize::to_string).collect();
            let element = format!("{path}[{}]", numbers.join(","));
            let modifier = expanded.modifier.at_element(&indices, declared.name)?;
            let built = self.composite(class, element, Some(node), modifier, inherited)?;
            self.tree.mark_connector(built, expanded.connector);
            nodes.push(built);
        }
        Ok(MemberState::Array(dims, nodes))
    }

    /// A partial class has no instances (MLS §4.7).
    pub(crate) fn check_complete(&self, class: ScopeId, span: Span) -> Result<(), Diagnostic> {
        let found = self.text(class);
        if found.definition.partial {
            return Err(
                fault!(PARTIAL_CLASS, "`{}` is partial and cannot be instantiated", found.name;
                help: "use a class that extends it")
                .at(span),
            );
        }
        Ok(())
    }
}

/// Whether a value is a component, or an element or component of one.
fn is_component(value: &Expression) -> bool {
    match &value.kind {
        ExpressionKind::Reference(_) => true,
        ExpressionKind::Subscripted { base, .. } => is_component(base),
        ExpressionKind::Field { base, .. } => is_component(base),
        _ => false,
    }
}

/// A component of a value.
fn component_of(value: &Arc<Expression>, name: Ident) -> Expression {
    let kind = match &value.kind {
        ExpressionKind::Reference(reference) => {
            let mut longer = reference.clone();
            longer.parts.push(ReferencePart { name, subscripts: Vec::new() });
            ExpressionKind::Reference(longer)
        }
        _ => ExpressionKind::Field { base: value.clone(), name },
    };
    Expression::new(kind, value.span)
}
