//! Which components may have which type prefixes (MLS §4.4.2.2, §9.1.3, §9.3,
//! §15.1).

use super::scope::{Component, Scope};
use crate::diag::Diagnostic;
use crate::fault;
use crate::flatten::declared::classes::Type;
use crate::flatten::errors::ILLEGAL_PREFIX;
use crate::flatten::lookup::types::Predefined;
use crate::source::Span;
use crate::syntax::ast::{
    CausalityPrefix, ClassSpecifier, ConnectionPrefix, Restriction, TypePrefixes, VariabilityPrefix,
};

/// The most classes that are looked through for a prefix.
const MAX_CLASSES: usize = 200;

/// Checks the prefixes of the own components of a class, and those of a short class.
pub(crate) fn check(class: Scope<'_>, errors: &mut Vec<Diagnostic>) {
    for component in class.components() {
        let found = wrong_use(class, &component)
            .or_else(|| wrong_kind(&component))
            .or_else(|| wrong_type(&component))
            .or_else(|| no_additive_group(&component))
            .or_else(|| conflict(&component));
        errors.extend(found);
    }
    if let ClassSpecifier::Short(short) = &class.definition().specifier
        && let Some(target) = class.parent().and_then(|p| p.class_named(&short.target.name))
    {
        errors.extend(conflict_with(short.prefixes, target, short.target.span));
    }
}

/// Prefixes that exclude each other, or that have no meaning in such a class.
fn wrong_use(class: Scope<'_>, component: &Component<'_>) -> Option<Diagnostic> {
    let prefixes = component.clause.type_prefixes;
    let name = component.name();
    let span = component.declaration.name.span;
    let is_fixed = fixed_word(prefixes.variability);
    if let (Some(CausalityPrefix::Input), Some(variability)) = (prefixes.causality, is_fixed) {
        return Some(
            fault!(ILLEGAL_PREFIX, "`{name}` has both prefixes `input` and `{variability}`";
                help: "remove one of the prefixes")
            .at(span)
            // Libraries do it; it is the parameter that counts.
            .warning(),
        );
    }
    let is_connector =
        matches!(class.restriction(), Restriction::Connector | Restriction::ExpandableConnector);
    let in_record =
        matches!(class.restriction(), Restriction::Record | Restriction::OperatorRecord);
    if class.restriction() == Restriction::ExpandableConnector
        && prefixes.connection == Some(ConnectionPrefix::Flow)
    {
        return Some(
            fault!(ILLEGAL_PREFIX, "the expandable connector `{}` has the flow variable `{name}`",
                class.name();
                help: "declare it in a separate connector, and that connector in the expandable \
                       one")
            .at(span),
        );
    }
    let is_stream = prefixes.connection == Some(ConnectionPrefix::Stream);
    if is_stream && !is_connector && !in_record {
        return Some(
            fault!(ILLEGAL_PREFIX, "the stream variable `{name}` is declared outside of a connector";
                help: "remove the prefix `stream`, or declare it in a connector")
            .at(span),
        );
    }
    None
}

/// Prefixes of components of models, and variability prefixes of connectors.
fn wrong_kind(component: &Component<'_>) -> Option<Diagnostic> {
    let prefixes = component.clause.type_prefixes;
    let word = any_word(prefixes)?;
    let class = component.class()?;
    let name = component.name();
    let span = component.declaration.name.span;
    match class.restriction() {
        Restriction::Model | Restriction::Block | Restriction::Package => Some(
            fault!(ILLEGAL_PREFIX, "the {} `{name}` has the prefix `{word}`",
                class.restriction().keyword();
                help: "remove the prefix; it is allowed only for variables, records and connectors")
            .at(span)
            .warning(),
        ),
        Restriction::Connector if class.predefined().is_none() => {
            let word = fixed_word(prefixes.variability)?;
            Some(
                fault!(ILLEGAL_PREFIX, "the connector `{name}` has the prefix `{word}`";
                    help: "remove the prefix")
                .at(span),
            )
        }
        _ => None,
    }
}

/// Flow and stream variables that are not numbers.
fn wrong_type(component: &Component<'_>) -> Option<Diagnostic> {
    let connection = component.clause.type_prefixes.connection?;
    let (base, is_enumeration) = match component.meaning()? {
        Type::Predefined(predefined) => (Some(predefined), false),
        Type::Class(class) => {
            let class = component.owner.of(class);
            (class.predefined(), class.is_enumeration())
        }
    };
    let fits = match (base, connection) {
        (Some(Predefined::Real), _) => true,
        (Some(Predefined::Integer), ConnectionPrefix::Flow) => true,
        (Some(_), _) => false,
        (None, _) => !is_enumeration,
    };
    let word = connection_word(connection);
    (!fits).then(|| {
        fault!(ILLEGAL_PREFIX, "the {word} variable `{}` is not Real", component.name();
            help: "declare it Real, or remove the prefix")
        .at(component.declaration.name.span)
    })
}

/// A flow variable of an operator record that cannot be added up (MLS §9.2).
fn no_additive_group(component: &Component<'_>) -> Option<Diagnostic> {
    if component.clause.type_prefixes.connection != Some(ConnectionPrefix::Flow) {
        return None;
    }
    let (class, _) = component.class()?.unaliased();
    let class = class.filter(|class| class.restriction() == Restriction::OperatorRecord)?;
    let declares = |operator: &str| {
        class.class_elements().any(|(_, nested)| nested.class.name.node.as_str() == operator)
    };
    let missing = ["'+'", "'-'", "'0'"].into_iter().find(|operator| !declares(operator))?;
    Some(
        fault!(ILLEGAL_PREFIX, "the flow variable `{}` is of the operator record `{}`, which has no operator `{missing}`",
            component.name(), class.name();
            help: "declare the operator; flow variables need addition, negation and zero")
        .at(component.declaration.name.span),
    )
}

/// A prefix of a structured component whose elements have one of their own.
fn conflict(component: &Component<'_>) -> Option<Diagnostic> {
    let class = component.class()?;
    let is_function = matches!(class.restriction(), Restriction::Function { .. });
    if is_function || class.predefined().is_some() {
        return None;
    }
    conflict_with(component.clause.type_prefixes, class, component.declaration.name.span)
}

fn conflict_with(outer: TypePrefixes, class: Scope<'_>, span: Span) -> Option<Diagnostic> {
    let word = flow_or_direction(outer)?;
    let clashes = |inner: TypePrefixes| match outer.connection {
        Some(ConnectionPrefix::Stream) => inner.connection == Some(ConnectionPrefix::Stream),
        Some(ConnectionPrefix::Flow) if outer.causality.is_none() => inner.connection.is_some(),
        _ => flow_or_direction(inner).is_some(),
    };
    let (name, inner) = prefixed_element(class, clashes)?;
    Some(
        fault!(ILLEGAL_PREFIX, "the prefix `{word}` conflicts with the prefix `{inner}` of the \
                                element `{name}`";
            help: "remove one of them")
        .at(span),
    )
}

/// An element of a class, at any depth, whose prefixes clash, with its prefix.
fn prefixed_element(
    class: Scope<'_>,
    clashes: impl Fn(TypePrefixes) -> bool,
) -> Option<(String, &'static str)> {
    let mut pending = vec![class];
    let mut seen = Vec::new();
    while let Some(class) = pending.pop() {
        if seen.len() >= MAX_CLASSES || seen.contains(&class.class) {
            continue;
        }
        seen.push(class.class);
        let (_, prefixes) = class.unaliased();
        if let Some(prefix) = prefixes.into_iter().find(|prefix| clashes(*prefix)) {
            return Some((class.name().to_string(), flow_or_direction(prefix)?));
        }
        for component in class.lineage().flat_map(Scope::components) {
            let prefixes = component.clause.type_prefixes;
            if clashes(prefixes) {
                return Some((component.name().to_string(), flow_or_direction(prefixes)?));
            }
            pending.extend(component.class());
        }
    }
    None
}

fn flow_or_direction(prefixes: TypePrefixes) -> Option<&'static str> {
    prefixes.connection.map(connection_word).or_else(|| prefixes.causality.map(causality_word))
}

fn any_word(prefixes: TypePrefixes) -> Option<&'static str> {
    let variability = prefixes.variability.map(|variability| match variability {
        VariabilityPrefix::Constant => "constant",
        VariabilityPrefix::Parameter => "parameter",
        VariabilityPrefix::Discrete => "discrete",
    });
    flow_or_direction(prefixes).or(variability)
}

fn fixed_word(variability: Option<VariabilityPrefix>) -> Option<&'static str> {
    match variability? {
        VariabilityPrefix::Constant => Some("constant"),
        VariabilityPrefix::Parameter => Some("parameter"),
        VariabilityPrefix::Discrete => None,
    }
}

pub(crate) fn connection_word(prefix: ConnectionPrefix) -> &'static str {
    match prefix {
        ConnectionPrefix::Flow => "flow",
        ConnectionPrefix::Stream => "stream",
    }
}

fn causality_word(prefix: CausalityPrefix) -> &'static str {
    match prefix {
        CausalityPrefix::Input => "input",
        CausalityPrefix::Output => "output",
    }
}
