//! `inner` and `outer` components (MLS §5.4): an outer component is another name of the inner one
//! of that name in the nearest enclosing instance.

use super::instance::Declaration;
use super::instance::Member;
use super::instance::MemberState;
use super::instance::NodeKind;
use super::instance::Shape;
use crate::diag::Diagnostic;
use crate::fault;
use crate::flatten::errors::{
    ILLEGAL_PREFIX, MISSING_INNER, PARTIAL_CLASS, TYPE_MISMATCH, UNKNOWN_NAME,
};
use crate::flatten::ids::NodeId;
use crate::flatten::instantiate::instantiation::Instantiation;
use crate::flatten::instantiate::tree::Tree;
use crate::flatten::library::LegacyConstruct;
use crate::flatten::lookup::classes::Classes;
use crate::flatten::lookup::modification::Modifier;
use crate::name::Ident;
use crate::source::Span;
use crate::syntax::ast::{CausalityPrefix, ElementPrefixes};
use std::sync::Arc;

impl Instantiation<'_> {
    /// What an outer component of an instance means.
    pub(crate) fn outer(
        &mut self,
        node: NodeId,
        declared: &Declaration,
    ) -> Result<MemberState, Diagnostic> {
        if !declared.prefixes.inner
            && !declared.modifier.is_empty()
            && let Some(text) = &self.classes.scope(declared.scope).text
        {
            if self.classes.library.is_strict() {
                return Err(fault!(ILLEGAL_PREFIX, "the `outer` component `{}` has modifiers",
                    declared.name;
                    help: "write them at the `inner` component")
                .at(declared.span));
            }
            self.classes.library.meet(&text.name, LegacyConstruct::OuterValue, declared.span);
        }
        let mut holder = self.classes.tree.nodes[node.0].parent;
        while let Some(id) = holder {
            if self.classes.tree.is_inner(id, declared.name) {
                let state = self.member(id, declared.name)?.map(|state| match state {
                    // An output of a state is one variable with the one further out.
                    MemberState::Outer(same) => *same,
                    state => state.own(),
                });
                if let Some(state) = &state {
                    self.check_same_type(state, declared)?;
                }
                return Ok(MemberState::Outer(Box::new(state.unwrap_or(MemberState::Absent))));
            }
            holder = self.classes.tree.nodes[id.0].parent;
        }
        self.missing_inner(node, declared)
    }

    /// The inner component must be of a subtype of the outer one's type (MLS §5.4): variables of
    /// the same predefined type and sizes, as far as the outer ones are known.
    fn check_same_type(
        &mut self,
        inner: &MemberState,
        outer: &Declaration,
    ) -> Result<(), Diagnostic> {
        let MemberState::Single(node) = inner else { return Ok(()) };
        let NodeKind::Variable(leaf) = &self.classes.tree.nodes[node.0].kind else { return Ok(()) };
        let variable = leaf.variable;
        let expanded = self.classes.expand(outer)?;
        let rank = outer.dims.len() + expanded.dims.len();
        let dims = self.dimensions(outer, &expanded).ok();
        let variable = &self.classes.tree.variables[variable].0;
        let same_sizes = match dims {
            Some(dims) => dims == variable.dims,
            None => rank == variable.dims.len(),
        };
        let is_same = expanded.shape.base().is_some_and(|base| base == variable.base);
        if is_same && same_sizes {
            return Ok(());
        }
        let reason = if is_same { "has different dimensions" } else { "has a different type" };
        Err(fault!(TYPE_MISMATCH, "the inner `{}` {reason} than the outer one", outer.name)
            .at(outer.span)
            .related(variable.span, "the inner one"))
    }

    /// Without an inner component the model itself gets one, with the defaults of its class; a
    /// variable becomes an input, as nothing here determines it.
    fn missing_inner(
        &mut self,
        node: NodeId,
        declared: &Declaration,
    ) -> Result<MemberState, Diagnostic> {
        let name = declared.name;
        let path = self.classes.tree.nodes[node.0].path.clone();
        let expanded = self.classes.expand(declared)?;
        let missing = || {
            let holder = match path.as_str() {
                "" => "the model".to_owned(),
                path => format!("`{path}`"),
            };
            fault!(MISSING_INNER, "there is no enclosing `inner` component for the `outer` \
                                  component `{name}` in {holder}";
                help: "declare `inner {} {name};` in the model", declared.type_specifier.name)
            .at(declared.span)
        };
        let root = self.classes.tree.root;
        let is_partial = match expanded.shape {
            Shape::Class(class) => self
                .classes
                .check_complete(class, declared.span)
                .is_err_and(|error| error.code == PARTIAL_CLASS),
            _ => expanded.shape.base().is_none(),
        };
        let of_root = self.classes.tree.declaration_of(root, name);
        let is_outer = of_root.as_ref().is_some_and(|one| one.prefixes.outer);
        if is_partial || self.classes.tree.in_package(node) || (of_root.is_some() && !is_outer) {
            return Err(missing());
        }
        if node != root && is_outer {
            let state = self.member(root, name)?.map(MemberState::own);
            return Ok(MemberState::Outer(Box::new(state.unwrap_or(MemberState::Absent))));
        }
        self.warnings.push(missing().warning());
        let mut declaration = Declaration {
            prefixes: ElementPrefixes { inner: true, ..ElementPrefixes::default() },
            modifier: Modifier::default(),
            condition: None,
            ..declared.clone()
        };
        if expanded.shape.base().is_some() && declaration.type_prefixes.variability.is_none() {
            declaration.type_prefixes.causality = Some(CausalityPrefix::Input);
        }
        if node == root {
            let own = Box::new(self.built(root, &declaration)?);
            return Ok(MemberState::Both { inner: own.clone(), outer: own });
        }
        let member = Member { declaration: Arc::new(declaration), state: MemberState::Pending };
        if let NodeKind::Composite(composite) = &mut self.classes.tree.nodes[root.0].kind
            && let Some(members) = &mut composite.members
        {
            members.insert(name, member);
        }
        let state = self.member(root, name)?.map(MemberState::own);
        Ok(MemberState::Outer(Box::new(state.unwrap_or(MemberState::Absent))))
    }
}

impl Classes<'_> {
    /// Of an outer component only what its own class declares can be named, whatever else the inner
    /// one has.
    pub(crate) fn check_outer_element(
        &mut self,
        node: NodeId,
        outer: Ident,
        element: Ident,
        span: Span,
    ) -> Result<(), Diagnostic> {
        let Some(declared) = self.tree.declaration_of(node, outer) else { return Ok(()) };
        let Shape::Class(class) = self.expand(&declared)?.shape else { return Ok(()) };
        if self.has_component(class, element)? {
            return Ok(());
        }
        let class = &self.text(class).name;
        Err(fault!(UNKNOWN_NAME, "`{class}`, the class of the outer `{outer}`, has no component `{element}`";
            help: "declare the outer component with the class of the inner component")
        .at(span))
    }
}

impl Tree {
    fn is_inner(&self, node: NodeId, name: Ident) -> bool {
        self.declaration_of(node, name).is_some_and(|declaration| declaration.prefixes.inner)
    }
}
