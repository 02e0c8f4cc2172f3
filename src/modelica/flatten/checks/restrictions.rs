//! What the specialized classes may contain (MLS §4.7).

use super::scope::{Component, Scope};
use crate::diag::Diagnostic;
use crate::fault;
use crate::flatten::errors::CLASS_RESTRICTION;
use crate::source::Span;
use crate::syntax::ast::{
    CausalityPrefix, Element, Restriction, Section, VariabilityPrefix, Visibility,
};

/// Checks the own contents of a class against its keyword.
pub(crate) fn check(class: Scope<'_>, errors: &mut Vec<Diagnostic>) {
    match class.restriction() {
        Restriction::Record | Restriction::OperatorRecord => record(class, errors),
        Restriction::Connector | Restriction::ExpandableConnector => connector(class, errors),
        Restriction::Package => package(class, errors),
        Restriction::Operator => operator(class, errors),
        Restriction::Type => no_components(class, "a type", errors),
        Restriction::Block => block(class, errors),
        Restriction::Model | Restriction::Class | Restriction::Function { .. } => {}
    }
    operators_lie_in_records(class, errors);
}

fn record(class: Scope<'_>, errors: &mut Vec<Diagnostic>) {
    only_public_elements(class, "a record", errors);
    for component in class.components() {
        let clause = component.clause;
        if clause.prefixes.outer {
            // Only bindings refer to it: the frequency of a system as the default of a nominal one.
            errors.push(prefixed(class, &component, "outer").warning());
            continue;
        }
        let prefix = match (clause.type_prefixes.causality, clause.type_prefixes.connection) {
            (Some(CausalityPrefix::Input), _) => Some("input"),
            (Some(CausalityPrefix::Output), _) => Some("output"),
            (None, Some(connection)) => Some(super::prefixes::connection_word(connection)),
            (None, None) => inner_or_outer(&component),
        };
        if let Some(prefix) = prefix {
            errors.push(prefixed(class, &component, prefix));
        }
        let allowed = |r| {
            matches!(
                r,
                Restriction::Record
                    | Restriction::OperatorRecord
                    | Restriction::Type
                    | Restriction::Class
            )
        };
        kind_of_component(class, &component, allowed, errors);
    }
}

fn connector(class: Scope<'_>, errors: &mut Vec<Diagnostic>) {
    only_public_elements(class, "a connector", errors);
    for component in class.components() {
        if let Some(prefix) = inner_or_outer(&component) {
            errors.push(prefixed(class, &component, prefix));
        }
        let allowed = |r| {
            matches!(
                r,
                Restriction::Record
                    | Restriction::OperatorRecord
                    | Restriction::Type
                    | Restriction::Class
                    | Restriction::Connector
                    | Restriction::ExpandableConnector
            )
        };
        kind_of_component(class, &component, allowed, errors);
    }
}

fn package(class: Scope<'_>, errors: &mut Vec<Diagnostic>) {
    no_behaviour(class, "a package", errors);
    for component in class.components() {
        if component.clause.type_prefixes.variability != Some(VariabilityPrefix::Constant) {
            let span = component.declaration.name.span;
            errors.push(
                fault!(CLASS_RESTRICTION, "`{}` is not a constant, but the package `{}` can \
                    contain only classes and constants",
                    component.name(), class.name();
                    help: "declare it `constant`, or move it into a model")
                .at(span),
            );
        }
    }
}

fn operator(class: Scope<'_>, errors: &mut Vec<Diagnostic>) {
    no_behaviour(class, "an operator", errors);
    no_components(class, "an operator", errors);
    for (_, nested) in class.class_elements() {
        if !matches!(nested.class.restriction, Restriction::Function { .. }) {
            let name = nested.class.name;
            errors.push(
                fault!(
                    CLASS_RESTRICTION,
                    "`{}` is not a function, but the operator `{}` can contain only functions",
                    name.node,
                    class.name()
                )
                .at(name.span),
            );
        }
    }
}

/// Operators and operator functions may only lie directly in an operator record.
fn operators_lie_in_records(class: Scope<'_>, errors: &mut Vec<Diagnostic>) {
    if class.restriction() == Restriction::OperatorRecord {
        return;
    }
    for (_, nested) in class.class_elements() {
        let what = match nested.class.restriction {
            Restriction::Operator => "operator",
            Restriction::Function { operator: true, .. } => "operator function",
            _ => continue,
        };
        let name = nested.class.name;
        let error =
            fault!(CLASS_RESTRICTION, "the {what} `{}` is declared in `{}`, which is not an \
                                               operator record",
            name.node, class.name();
            help: "move it into the operator record that it operates on")
            .at(name.span);
        // Libraries forget the prefix `operator` of a record; then nothing is overloaded.
        let is_tolerated = class.restriction() == Restriction::Record && !class.library.is_strict();
        errors.push(if is_tolerated { error.warning() } else { error });
    }
}

/// The variables of the public connectors of a block are inputs or outputs.
fn block(class: Scope<'_>, errors: &mut Vec<Diagnostic>) {
    extends_models(class, errors);
    for component in class.components() {
        let is_public = component.visibility == Visibility::Public;
        if !is_public || component.clause.type_prefixes.causality.is_some() {
            continue;
        }
        let Some(connector) = component.class() else { continue };
        if connector.restriction() == Restriction::Connector && has_acausal_variable(connector) {
            let error = fault!(CLASS_RESTRICTION, "`{}` of the block `{}` has variables that are neither input nor output",
                component.name(), class.name();
                help: "make the class a model, or declare the variables of the connector \
                       `input` or `output`")
            .at(component.declaration.name.span);
            // Libraries call components of fluid systems blocks; nothing depends on it.
            errors.push(if class.library.is_strict() { error } else { error.warning() });
        }
    }
}

/// A block that extends a model (MLS §7.1.3): libraries do it, and it is a block nevertheless.
fn extends_models(class: Scope<'_>, errors: &mut Vec<Diagnostic>) {
    for (_, element) in class.elements() {
        let Element::Extends(extends) = element else { continue };
        let Some(base) = class.class_named(&extends.base.name) else { continue };
        if base.restriction() == Restriction::Model {
            errors.push(
                fault!(CLASS_RESTRICTION, "the block `{}` extends the model `{}`",
                    class.name(), base.name();
                    help: "make `{}` a block, or `{}` a model", base.name(), class.name())
                .at(extends.base.span)
                .warning(),
            );
        }
    }
}

/// Whether a connector class declares, without any direction, a variable of a predefined type.
fn has_acausal_variable(connector: Scope<'_>) -> bool {
    let (target, prefixes) = connector.unaliased();
    if prefixes.iter().any(|prefix| prefix.causality.is_some()) {
        return false;
    }
    let Some(target) = target else { return connector.predefined().is_some() };
    target.lineage().flat_map(Scope::components).any(|component| {
        !component.is_fixed() && !component.has_direction() && is_predefined(&component)
    })
}

fn is_predefined(component: &Component<'_>) -> bool {
    component.class().is_none_or(|class| class.predefined().is_some())
}

/// Only public elements, no equations, no algorithms.
fn only_public_elements(class: Scope<'_>, what: &str, errors: &mut Vec<Diagnostic>) {
    no_behaviour(class, what, errors);
    let hidden = class.elements().find(|(visibility, _)| *visibility == Visibility::Protected);
    if let Some((_, element)) = hidden {
        errors.push(
            fault!(CLASS_RESTRICTION, "`{}` is {what} and has protected elements", class.name();
                help: "make them public")
            .at(place(element))
            .warning(),
        );
    }
}

fn no_behaviour(class: Scope<'_>, what: &str, errors: &mut Vec<Diagnostic>) {
    for section in class.sections() {
        // Editors leave empty sections.
        let (kind, span) = match section {
            Section::Equations { equations, span, .. } if !equations.is_empty() => {
                ("equations", *span)
            }
            Section::Algorithm { statements, span, .. } if !statements.is_empty() => {
                ("an algorithm", *span)
            }
            _ => continue,
        };
        errors.push(
            fault!(CLASS_RESTRICTION, "`{}` is {what} and has {kind}", class.name();
                help: "move them into a model or a function")
            .at(span),
        );
    }
}

/// Whether a section holds equations or an algorithm.
pub(crate) fn is_behaviour(section: &Section) -> bool {
    matches!(section, Section::Equations { .. } | Section::Algorithm { .. })
}

fn no_components(class: Scope<'_>, what: &str, errors: &mut Vec<Diagnostic>) {
    for component in class.components() {
        errors.push(
            fault!(
                CLASS_RESTRICTION,
                "`{}` is {what} and has the component `{}`",
                class.name(),
                component.name()
            )
            .at(component.declaration.name.span),
        );
    }
}

fn kind_of_component(
    class: Scope<'_>,
    component: &Component<'_>,
    allowed: impl Fn(Restriction) -> bool,
    errors: &mut Vec<Diagnostic>,
) {
    let Some(kind) = component.class() else { return };
    if !allowed(kind.restriction()) {
        errors.push(
            fault!(
                CLASS_RESTRICTION,
                "`{}` has the component `{}` of the {} `{}`",
                class.name(),
                component.name(),
                kind.restriction().keyword(),
                kind.name()
            )
            .at(component.declaration.name.span),
        );
    }
}

fn inner_or_outer(component: &Component<'_>) -> Option<&'static str> {
    let prefixes = component.clause.prefixes;
    if prefixes.inner {
        return Some("inner");
    }
    prefixes.outer.then_some("outer")
}

fn prefixed(class: Scope<'_>, component: &Component<'_>, prefix: &str) -> Diagnostic {
    let what = class.restriction().keyword();
    fault!(CLASS_RESTRICTION, "`{}` of the {what} `{}` has the prefix `{prefix}`",
        component.name(), class.name();
        help: "remove the prefix")
    .at(component.declaration.name.span)
}

/// Where an element is written.
pub(crate) fn place(element: &Element) -> Span {
    match element {
        Element::Import(import) => import.span,
        Element::Extends(extends) => extends.span,
        Element::Class(nested) => nested.class.name.span,
        Element::Component(clause) => {
            clause.components.first().map_or(clause.span, |component| component.name.span)
        }
    }
}
