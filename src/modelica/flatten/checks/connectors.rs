//! What a connector class must hold together (MLS §9.3.1, §9.4, §15.1).

use super::scope::{Component, Scope};
use crate::diag::Diagnostic;
use crate::fault;
use crate::flatten::declared::classes::Type;
use crate::flatten::errors::CLASS_RESTRICTION;
use crate::name::Ident;
use crate::syntax::ast::{
    Binding, CausalityPrefix, ConnectionPrefix, Expression, ExpressionKind, Restriction, Subscript,
};

/// The deepest nesting of records and connectors that is counted.
const MAX_DEPTH: usize = 20;

/// The most components that are counted: records of records may have any number.
const MAX_COMPONENTS: usize = 10_000;

/// Scalar variables of a connector by what they do in a connection.
#[derive(Default)]
struct Count {
    potential: usize,
    flow: usize,
    stream: usize,
    /// How many components were counted.
    components: usize,
}

/// Checks a connector class: as many flow variables as potential variables, and one scalar flow
/// variable beside stream variables.
pub(crate) fn check(class: Scope<'_>, errors: &mut Vec<Diagnostic>) {
    let is_long = !class.sections().is_empty();
    if class.restriction() != Restriction::Connector || !is_long || class.definition().partial {
        return;
    }
    let mut count = Count::default();
    if add(class, 1, None, 0, &mut count).is_none() {
        return;
    }
    let span = class.definition().name.span;
    let name = class.name();
    if count.stream > 0 && count.flow != 1 {
        errors.push(
            fault!(CLASS_RESTRICTION, "the connector `{name}` has stream variables and {} flow variables instead of one", count.flow;
                help: "declare exactly one scalar flow variable; it transports the stream \
                       variables")
            .at(span),
        );
    } else if count.flow != count.potential && !is_simple(&count) {
        errors.push(
            fault!(CLASS_RESTRICTION, "the connector `{name}` has {} flow variables and {} potential variables",
                count.flow, count.potential;
                help: "declare equal numbers of both, or give the remaining variables the prefix \
                       `input` or `output`")
            .at(span)
            // Libraries before Modelica 3 have such connectors; the model that uses one may still
            // have as many equations as variables.
            .warning(),
        );
    }
}

/// A connector of potential variables alone is an old one for signals; it is balanced by what uses
/// it.
fn is_simple(count: &Count) -> bool {
    count.flow == 0
}

/// Counts the scalar variables of a class without a direction; `None` where a size or a class is
/// not known from its text.
fn add(
    class: Scope<'_>,
    times: usize,
    outer: Option<ConnectionPrefix>,
    depth: usize,
    count: &mut Count,
) -> Option<()> {
    if depth > MAX_DEPTH {
        return None;
    }
    for base in class.lineage() {
        let bases = base.library.declared_bases(base.class).len();
        if bases != base.library.class(base.class).extends.len() {
            return None;
        }
        for component in base.components() {
            add_component(&component, times, outer, depth, count)?;
        }
    }
    Some(())
}

fn add_component(
    component: &Component<'_>,
    times: usize,
    outer: Option<ConnectionPrefix>,
    depth: usize,
    count: &mut Count,
) -> Option<()> {
    count.components += 1;
    if count.components > MAX_COMPONENTS {
        return None;
    }
    let prefixes = component.clause.type_prefixes;
    let is_open =
        component.clause.prefixes.replaceable || component.declaration.condition.is_some();
    if is_open {
        return None;
    }
    if component.is_fixed() || prefixes.causality.is_some() {
        return Some(());
    }
    let sizes = component.clause.subscripts.iter().chain(&component.declaration.subscripts);
    let times = sizes
        .map(|size| known_size(component.owner, size))
        .try_fold(times, |all, size| all.checked_mul(size?))?;
    let connection = prefixes.connection.or(outer);
    let class = match component.meaning()? {
        Type::Predefined(_) => None,
        Type::Class(class) => Some(component.owner.of(class)),
    };
    let Some(class) = class else { return count.add(connection, times) };
    let (target, short) = class.unaliased();
    let is_plain = short.iter().all(|one| one.causality.is_none() && one.connection.is_none());
    if class.is_replaceable() || !is_plain {
        return None;
    }
    if let Some(constraint) = equality_constraint(class) {
        return count.add(connection, times.checked_mul(residue_size(constraint)?)?);
    }
    if super::compatibility::dimensions(class) > 0 {
        return None;
    }
    if class.predefined().is_some() || class.is_enumeration() {
        return count.add(connection, times);
    }
    match target?.restriction() {
        Restriction::Record | Restriction::Connector => {
            add(target?, times, connection, depth + 1, count)
        }
        Restriction::OperatorRecord => count.add(connection, times),
        _ => None,
    }
}

impl Count {
    fn add(&mut self, connection: Option<ConnectionPrefix>, times: usize) -> Option<()> {
        let number = match connection {
            Some(ConnectionPrefix::Flow) => &mut self.flow,
            Some(ConnectionPrefix::Stream) => &mut self.stream,
            None => &mut self.potential,
        };
        *number = number.checked_add(times)?;
        Some(())
    }
}

/// The function of an overdetermined type, which counts less than its variables (MLS §9.4).
fn equality_constraint(class: Scope<'_>) -> Option<Scope<'_>> {
    let name = Ident::new("equalityConstraint");
    class.lineage().find_map(|class| class.own_class(name))
}

/// How many equations the function stands for: the size of its output.
fn residue_size(function: Scope<'_>) -> Option<usize> {
    let is_output = |component: &Component<'_>| {
        component.clause.type_prefixes.causality == Some(CausalityPrefix::Output)
    };
    let output = function.components().find(is_output)?;
    let sizes = output.clause.subscripts.iter().chain(&output.declaration.subscripts);
    let mut sizes = sizes.map(|size| known_size(function, size));
    sizes.try_fold(1usize, |all, size| all.checked_mul(size?))
}

/// The size that a subscript gives: a number, or a component of the class with a number as value.
fn known_size(class: Scope<'_>, subscript: &Subscript) -> Option<usize> {
    let Subscript::Index(size) = subscript else { return None };
    if let ExpressionKind::Reference(reference) = &size.kind {
        let component = class.component(reference.as_ident()?)?;
        let modification = component.declaration.modification.as_ref()?;
        return match &modification.binding {
            Some(Binding::Expression(value)) => natural(value),
            _ => None,
        };
    }
    natural(size)
}

fn natural(e: &Expression) -> Option<usize> {
    match e.kind {
        ExpressionKind::Integer(size) => usize::try_from(size).ok(),
        _ => None,
    }
}
