//! Overconstrained connections (MLS §9.4): records that the spanning tree connects are joined, the
//! others get the equations of `equalityConstraint`.

use super::super::FlatModel;
use super::super::errors::INVALID_CONNECTION;
use super::super::flat_expression::flat_reference;
use super::super::instantiate::instance::NodeKind;
use super::graph::Edge;
use crate::diag::Diagnostic;
use crate::fault;
use crate::flatten::connections::end::End;
use crate::flatten::connections::sets::Connections;
use crate::flatten::expressions::local::Local;
use crate::flatten::flat_expression::call;
use crate::flatten::ids::NodeId;
use crate::flatten::ids::ScopeId;
use crate::flatten::instantiate::instantiation::Instantiation;
use crate::flatten::instantiate::tree::Tree;
use crate::flatten::lookup::classes::Classes;
use crate::flatten::lookup::types::Type;
use crate::name::{Ident, Name};
use crate::syntax::ast::{
    ClassSpecifier, Equation, EquationKind, Expression, ExpressionKind, Subscript,
};

/// The function that makes a record redundant.
const EQUALITY_CONSTRAINT: &str = "equalityConstraint";

impl Classes<'_> {
    /// Chooses the spanning tree and joins the records that it connects.
    pub(crate) fn build_graph(&mut self, connections: &mut Connections) -> Result<(), Diagnostic> {
        let kept = connections.graph.span();
        if let Some(([one, other], message, span)) = connections.graph.ambiguous_roots() {
            let [one, other] = [one, other].map(|node| self.tree.nodes[node.0].path.to_string());
            return Err(fault!(
                INVALID_CONNECTION,
                "`{one}` and `{other}` are unique roots of connection graphs, but connected{}",
                said(message)
            )
            .at(span));
        }
        for edge in kept {
            let (one, other) = edge.nodes;
            match self.tree.scalars_of(one).zip(self.tree.scalars_of(other)) {
                Some((ones, others)) => {
                    for (a, b) in ones.into_iter().zip(others) {
                        self.pair(a, b, edge.outside, edge.span, connections)?;
                    }
                }
                None => self.pair_members(one, other, edge.outside, edge.span, connections)?,
            }
        }
        connections.close();
        Ok(())
    }

    /// Whether the class of a component declares itself redundant.
    pub(crate) fn is_overdetermined(&mut self, node: NodeId) -> Result<bool, Diagnostic> {
        Ok(self.redundant_class(node)?.is_some())
    }

    /// The class of a record or of a variable that declares itself redundant: that of the component, or
    /// one that it is made of.
    fn redundant_class(&mut self, node: NodeId) -> Result<Option<ScopeId>, Diagnostic> {
        let mut class = match &self.tree.nodes[node.0].kind {
            NodeKind::Composite(composite) => {
                let class = composite.class;
                (!composite.connector && self.is_record(class)).then_some(class)
            }
            NodeKind::Variable(leaf) => leaf.class.filter(|_| !leaf.connector),
        };
        while let Some(found) = class {
            if self.find_class(found, Ident::new(EQUALITY_CONSTRAINT))?.is_some() {
                return Ok(Some(found));
            }
            class = self.made_of(found)?;
        }
        Ok(None)
    }

    /// The class that a type is made of, if it is not a predefined one: such a type inherits no
    /// elements, so that these are looked for there.
    fn made_of(&mut self, class: ScopeId) -> Result<Option<ScopeId>, Diagnostic> {
        let text = self.text(class).clone();
        let parent = self.scope(class).parent.unwrap_or(ScopeId::TOP);
        let base = match &text.definition.specifier {
            ClassSpecifier::Short(short) => Some(self.lookup_type(parent, &short.target)?),
            ClassSpecifier::Long(_) => self.predefined_base(class, &text)?.map(|(base, _)| base),
            ClassSpecifier::Enumeration(_) | ClassSpecifier::Derivative(_) => None,
        };
        Ok(match base {
            Some(Type::Class(base)) if base != class => Some(base),
            _ => None,
        })
    }
}

/// What a model says, after our own message.
pub(super) fn said(message: &str) -> String {
    if message.is_empty() { String::new() } else { format!(": {message}") }
}

impl Tree {
    /// The scalars of a variable; `None` for an instance with components.
    fn scalars_of(&self, node: NodeId) -> Option<Vec<End>> {
        let NodeKind::Variable(leaf) = &self.nodes[node.0].kind else { return None };
        let count = self.variables[leaf.variable].0.len();
        Some((0..count).map(|element| End::Scalar(node, element)).collect())
    }
}

impl Instantiation<'_> {
    /// `0 = equalityConstraint(a, b)` for every connection outside the tree.
    pub(crate) fn add_constraint_equations(
        &mut self,
        connections: &Connections,
        model: &mut FlatModel,
    ) -> Result<(), Diagnostic> {
        for edge in connections.graph.broken() {
            let equation = self.constraint_equation(edge)?;
            model.equations.push(equation);
        }
        Ok(())
    }

    fn constraint_equation(&mut self, edge: &Edge) -> Result<Equation, Diagnostic> {
        let span = edge.span;
        let class = self.classes.redundant_class(edge.nodes.0)?.unwrap_or(ScopeId::TOP);
        let invalid = || {
            fault!(INVALID_CONNECTION, "`{EQUALITY_CONSTRAINT}` of this record is not a function")
                .at(span)
        };
        let nested = self.classes.find_class(class, Ident::new(EQUALITY_CONSTRAINT))?;
        let Some(Type::Class(scope)) =
            nested.map(|nested| self.classes.instance(&nested)).transpose()?
        else {
            return Err(invalid());
        };
        let name = self.function(scope)?.ok_or_else(invalid)?;
        let size = self
            .functions
            .table
            .get(&name)
            .and_then(|function| function.as_ref())
            .and_then(|function| function.outputs.first()?.dims.first().cloned());
        let Some(Subscript::Index(size)) = size else { return Err(invalid()) };
        let flat = self.classes.flat_scope();
        let record = |this: &mut Self, node: NodeId| {
            let reference = flat_reference(&this.classes.tree.nodes[node.0].path, span);
            this.resolve(
                &Expression::new(ExpressionKind::Reference(reference), span),
                flat,
                &Local::default(),
            )
        };
        let positional = vec![record(self, edge.nodes.0)?, record(self, edge.nodes.1)?];
        let left = call(&name, positional, span);
        let right = call(&Name::parse("zeros"), vec![size], span);
        let kind = EquationKind::Equal { left, right };
        Ok(Equation { kind, comment: Default::default(), span })
    }
}
