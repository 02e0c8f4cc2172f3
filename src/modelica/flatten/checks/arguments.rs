//! The arguments of calls (MLS §12.4.1): each input is given at most once, and its argument has its
//! type. Arrays of it are a call for each element (§12.4.6); sizes are known at translation only.

use super::declared_types::{CheckedType, kind_of};
use super::inputs::Inputs;
use super::scope::{Component, Scope};
use crate::diag::Diagnostic;
use crate::fault;
use crate::functions::errors::WRONG_ARGUMENTS;
use crate::name::{Ident, Name};
use crate::source::Span;
use crate::syntax::ast::{Arguments, ComponentReference, Expression, NamedArgument, Restriction};

/// An argument and the type that its input is declared of.
pub(super) struct Expected<'e> {
    pub(super) input: Ident,
    pub(super) declared: CheckedType,
    pub(super) argument: &'e Expression,
}

/// An input that is given twice.
pub(super) fn given_twice(
    class: Scope<'_>,
    function: &ComponentReference,
    arguments: &Arguments,
) -> Option<Diagnostic> {
    if arguments.named.is_empty() {
        return None;
    }
    let named = &arguments.named;
    let is_before = |(at, one): &(usize, &NamedArgument)| {
        named.iter().take(*at).any(|other| other.name.node == one.name.node)
    };
    let again = named.iter().enumerate().find(is_before).map(|(_, one)| one);
    let inputs = || inputs_of(class, function);
    let again = match again {
        None if arguments.positional.is_empty() => None,
        None => inputs().and_then(|inputs| inputs.twice(arguments)),
        again => again,
    };
    again.map(|again| twice(&function.name(), again.name.node, again.name.span))
}

fn twice(function: &Name, input: Ident, span: Span) -> Diagnostic {
    fault!(WRONG_ARGUMENTS, "the input `{input}` of `{function}` is specified twice";
        help: "remove one of the two arguments")
    .at(span)
}

/// The arguments of a call whose inputs have types that are known.
pub(super) fn expected<'e>(
    class: Scope<'_>,
    function: &ComponentReference,
    arguments: &'e Arguments,
) -> Vec<Expected<'e>> {
    if !arguments.iterators.is_empty() {
        return Vec::new();
    }
    let Some(inputs) = inputs_of(class, function) else { return Vec::new() };
    let expected = |(input, argument): (Component<'_>, &'e Expression)| {
        Some(Expected { input: input.name(), declared: kind_of(&input)?, argument })
    };
    inputs.given(arguments).into_iter().filter_map(expected).collect()
}

/// The inputs of a function or of the constructor of a record that nothing can replace.
fn inputs_of<'a>(class: Scope<'a>, function: &ComponentReference) -> Option<Inputs<'a>> {
    let called = class.certain_class(&function.name()).filter(|called| !called.is_open())?;
    match called.restriction() {
        Restriction::Record => {
            let has_operators =
                called.lineage().any(|one| one.restriction() == Restriction::OperatorRecord);
            (!has_operators).then(|| Inputs::of_record(called))
        }
        _ => Inputs::of(called),
    }
}
