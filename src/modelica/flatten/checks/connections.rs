//! What `connect` equations name (MLS §9.1, §9.3): connectors whose variables of one name have the
//! same variability and both a direction or both none.

use super::scope::{Component, Scope};
use crate::diag::Diagnostic;
use crate::fault;
use crate::flatten::declared::classes::Type;
use crate::flatten::errors::INVALID_CONNECTION;
use crate::flatten::library::LegacyConstruct;
use crate::source::Span;
use crate::syntax::ast::{
    ComponentReference, Equation, EquationKind, Restriction, Section, VariabilityPrefix,
};
use crate::syntax::visit::{Visit, walk_equation};

/// Checks the `connect` equations that a class itself writes.
pub(crate) fn check(class: Scope<'_>, errors: &mut Vec<Diagnostic>) {
    let mut walk = ConnectCheck { class, errors };
    for section in class.sections() {
        if let Section::Equations { equations, .. } = section {
            equations.iter().for_each(|equation| walk.equation(equation));
        }
    }
}

struct ConnectCheck<'a, 'e> {
    class: Scope<'a>,
    errors: &'e mut Vec<Diagnostic>,
}

impl Visit for ConnectCheck<'_, '_> {
    fn equation(&mut self, equation: &Equation) {
        let EquationKind::Connect { left, right } = &equation.kind else {
            return walk_equation(self, equation);
        };
        let wrong = self.no_connector(left).or_else(|| self.no_connector(right));
        let wrong = wrong.or_else(|| self.mismatch(left, right, equation.span));
        let wrong = wrong.or_else(|| self.too_deep(left)).or_else(|| self.too_deep(right));
        self.errors.extend(wrong);
    }
}

/// The first connectors of a class, by name.
fn connectors(class: Scope<'_>) -> Vec<String> {
    const SHOWN: usize = 8;
    let mut names = Vec::new();
    for scope in class.lineage() {
        for component in scope.components() {
            let is_connector = component.class().is_some_and(|class| {
                let restriction = class.restriction();
                matches!(restriction, Restriction::Connector | Restriction::ExpandableConnector)
            });
            if is_connector && names.len() < SHOWN {
                names.push(component.name().to_string());
            }
        }
    }
    names
}

impl ConnectCheck<'_, '_> {
    /// A reference to a variable, a record or a model.
    fn no_connector(&self, reference: &ComponentReference) -> Option<Diagnostic> {
        let path = self.class.path(reference)?;
        let in_expandable = path.iter().any(|one| {
            one.class().is_some_and(|class| class.restriction() == Restriction::ExpandableConnector)
        });
        let component = path.last().filter(|_| !in_expandable)?;
        let in_connector = matches!(
            component.owner.restriction(),
            Restriction::Connector | Restriction::ExpandableConnector
        );
        let is_connector = match component.meaning()? {
            Type::Predefined(_) => false,
            Type::Class(class) => !matches!(
                component.owner.of(class).restriction(),
                Restriction::Type | Restriction::Record | Restriction::Model | Restriction::Block
            ),
        };
        if is_connector || in_connector || self.is_tolerated(component, reference.span) {
            return None;
        }
        let name = component.name();
        let own: Vec<String> = match component.meaning()? {
            Type::Predefined(_) => Vec::new(),
            Type::Class(class) => connectors(component.owner.of(class)),
        };
        let help = match own.as_slice() {
            [] => "connect connectors; for variables, write an equation".to_owned(),
            own => {
                let own: Vec<String> = own.iter().map(|one| format!("`{name}.{one}`")).collect();
                format!("connect one of its connectors: {}", own.join(", "))
            }
        };
        let fault = fault!(INVALID_CONNECTION, "`{name}` is not a connector");
        Some(fault.help(help).at(reference.span))
    }

    /// A variable of a predefined type. Libraries connect them as they connect inputs and outputs that are
    /// connectors, other programs accept that, and it can only mean that both are equal.
    fn is_tolerated(&self, component: &Component<'_>, span: Span) -> bool {
        let library = self.class.library;
        if library.is_strict() || !is_variable(component) {
            return false;
        }
        library.meet(self.class.name(), LegacyConstruct::ConnectedVariable, span);
        true
    }

    /// A connector of a component of a component. Libraries use them, and what is meant is clear:
    /// it is reported only in strict conformance checks.
    fn too_deep(&self, reference: &ComponentReference) -> Option<Diagnostic> {
        if !self.class.library.is_strict() {
            return None;
        }
        let path = self.class.path(reference)?;
        let is_component = |one: &&Component<'_>| {
            let restriction = one.class().map(Scope::restriction);
            matches!(restriction, Some(Restriction::Model | Restriction::Block))
        };
        (path.iter().filter(is_component).count() > 1).then(|| {
            fault!(INVALID_CONNECTION, "`{}` is a connector of a component of another component",
                crate::syntax::print::reference(reference);
                help: "connect it in the class of the component, to a connector of that class")
            .at(reference.span)
        })
    }

    fn mismatch(
        &self,
        left: &ComponentReference,
        right: &ComponentReference,
        span: Span,
    ) -> Option<Diagnostic> {
        let (a, b) = (self.class.component_at(left)?, self.class.component_at(right)?);
        let (a, b) = (a.class()?, b.class()?);
        let is_plain = |class: Scope<'_>| class.restriction() == Restriction::Connector;
        if a.class == b.class || !is_plain(a) || !is_plain(b) {
            return None;
        }
        a.lineage().flat_map(Scope::components).find_map(|one| {
            let other = b.component(one.name())?;
            let reason = if fixed(&one) != fixed(&other) {
                "their variability prefixes differ"
            } else if is_variable(&one) && one.has_direction() != other.has_direction() {
                "only one of them is input or output"
            } else {
                return None;
            };
            Some(
                fault!(INVALID_CONNECTION, "`{}` of the two connectors cannot be connected: \
                    {reason}",
                    one.name();
                    help: "connect connectors of one class, or of classes with the same prefixes")
                .at(span),
            )
        })
    }
}

/// `constant` or `parameter`, by itself or its type.
fn fixed(component: &Component<'_>) -> Option<VariabilityPrefix> {
    let own = component.clause.type_prefixes.variability;
    own.filter(|variability| *variability != VariabilityPrefix::Discrete)
}

/// Whether it is of a predefined type, rather than a connector with variables of its own.
fn is_variable(component: &Component<'_>) -> bool {
    component.class().is_none_or(|class| class.predefined().is_some())
}
