//! Selective model extension (MLS §7.4): components and connections that an extends clause leaves
//! out of its base class, `extends B(break f, break connect(a, b))`.

use crate::diag::Diagnostic;
use crate::fault;
use crate::flatten::errors::{TYPE_MISMATCH, UNKNOWN_ELEMENT};
use crate::flatten::ids::ScopeId;
use crate::flatten::instantiate::instance::{Declaration, Shape};
use crate::flatten::lookup::classes::Classes;
use crate::flatten::lookup::scope::Text;
use crate::flatten::lookup::types::Predefined;
use crate::flatten::lookup::types::Type;
use crate::flatten::unknown;
use crate::name::Ident;
use crate::source::Spanned;
use crate::syntax::ast::{
    ComponentReference, Equation, EquationKind, Exclusion, Extends, Restriction, Section,
};
use crate::syntax::print;
use crate::syntax::visit::{Visit, walk_equation};
use std::sync::Arc;

impl Classes<'_> {
    /// Whether a class that extends the one in which a connection is written leaves it out.
    pub(crate) fn is_deselected(
        &self,
        context: ScopeId,
        left: &ComponentReference,
        right: &ComponentReference,
    ) -> bool {
        let mut next = Some(context);
        while let Some(id) = next {
            let scope = self.scope(id);
            if scope.excluded.iter().any(|one| matches(one, left, right)) {
                return true;
            }
            next = scope.derived;
        }
        false
    }

    /// Each exclusion (`break`) of an extends clause must match something of the base class.
    pub(crate) fn check_deselected(
        &mut self,
        derived: &Text,
        base: ScopeId,
        extends: &Extends,
    ) -> Result<(), Diagnostic> {
        for excluded in &extends.excluded {
            match excluded {
                Exclusion::Component(name) => self.check_component(base, name)?,
                Exclusion::Connection(left, right) => {
                    if !self.has_connection(base, left, right)? {
                        return Err(fault!(
                            UNKNOWN_ELEMENT,
                            "`{}` has no `connect({}, {})` that `{}` can remove",
                            self.text(base).name,
                            print::reference(left),
                            print::reference(right),
                            derived.name
                        )
                        .at(left.span));
                    }
                }
            }
        }
        Ok(())
    }

    /// A component that is left out must exist and be a model, a block or a connector.
    fn check_component(&mut self, base: ScopeId, name: &Spanned<Ident>) -> Result<(), Diagnostic> {
        let elements = self.elements(base)?;
        let Some(declaration) = elements.get(name.node) else {
            let known: Vec<Ident> = elements.names().collect();
            let class = &self.text(base).name;
            return Err(unknown::removed_element(class, name.node, &known, name.span));
        };
        if self.can_be_left_out(declaration)? {
            return Ok(());
        }
        Err(fault!(
            TYPE_MISMATCH,
            "`{}` is not a model, block or connector and cannot be removed",
            name.node
        )
        .at(name.span)
        .related(declaration.span, "declared here"))
    }

    fn can_be_left_out(&mut self, declaration: &Arc<Declaration>) -> Result<bool, Diagnostic> {
        if let Type::Predefined(Predefined::ExternalObject) =
            self.lookup_type(declaration.scope, &declaration.type_specifier)?
        {
            return Ok(false);
        }
        let expanded = self.expand(declaration)?;
        Ok(match expanded.shape {
            Shape::Class(scope) => matches!(
                self.text(scope).restriction(),
                Restriction::Model
                    | Restriction::Block
                    | Restriction::Class
                    | Restriction::Connector
                    | Restriction::ExpandableConnector
            ),
            _ => expanded.connector,
        })
    }

    /// Whether a class or one that it extends writes a connection.
    fn has_connection(
        &mut self,
        base: ScopeId,
        left: &ComponentReference,
        right: &ComponentReference,
    ) -> Result<bool, Diagnostic> {
        let mut search = ElementSearch {
            target: Exclusion::Connection(left.clone(), right.clone()),
            found: false,
        };
        for context in self.elements(base)?.lineage() {
            for section in self.text(context).sections() {
                if let Section::Equations { initial: false, equations, .. } = section {
                    equations.iter().for_each(|equation| search.equation(equation));
                }
            }
        }
        Ok(search.found)
    }
}

/// Looks for a connection.
struct ElementSearch {
    target: Exclusion,
    found: bool,
}

impl Visit for ElementSearch {
    fn equation(&mut self, equation: &Equation) {
        match &equation.kind {
            EquationKind::Connect { left, right } => {
                self.found |= matches(&self.target, left, right);
            }
            _ => walk_equation(self, equation),
        }
    }
}

/// Whether a connection is one with a component that is left out or with a part of it, or is
/// written as the one that is left out, in either order.
fn matches(excluded: &Exclusion, left: &ComponentReference, right: &ComponentReference) -> bool {
    match excluded {
        Exclusion::Component(out) => {
            let is_part = |one: &ComponentReference| {
                !one.global && one.parts.first().is_some_and(|part| part.name == out.node)
            };
            is_part(left) || is_part(right)
        }
        Exclusion::Connection(a, b) => {
            let printed = [a, b, left, right].map(print::reference);
            let [a, b, left, right] = &printed;
            (a, b) == (left, right) || (a, b) == (right, left)
        }
    }
}
