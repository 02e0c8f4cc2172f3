//! What is said of names that mean nothing (MLS §5.3, §7.2), by the checks of classes as they are declared
//! and by instantiation alike.

use super::errors::{UNKNOWN_CLASS, UNKNOWN_ELEMENT, UNKNOWN_NAME};
use super::lookup::types::ATTRIBUTES;
use crate::diag::{Diagnostic, suggest};
use crate::fault;
use crate::functions::errors::WRONG_ARGUMENTS;
use crate::name::{Ident, Name};
use crate::source::Span;
use crate::syntax::foreign;

/// A class that nothing declares.
pub(crate) fn class(name: &Name, suggestion: Option<String>, span: Span) -> Diagnostic {
    let help = foreign::type_help(&name.to_string()).or(suggestion);
    fault!(UNKNOWN_CLASS, "there is no class `{name}`").help_if(help).at(span)
}

/// A class that is imported and that nothing declares: its name is a full name (MLS §13.2.1), `full` the
/// one of the class that it would mean in the scope of the import.
pub(crate) fn import(
    name: &Name,
    full: Option<Name>,
    suggestion: Option<String>,
    span: Span,
) -> Diagnostic {
    let full = full.map(|full| {
        format!("the name that an import gives starts at the top level: write `import {full}`")
    });
    fault!(UNKNOWN_CLASS, "there is no `{name}` to import").help_if(full.or(suggestion)).at(span)
}

/// A function that neither a class nor the language declares; without a suggestion one of the language.
/// `known` are the components that the name could mean.
pub(crate) fn function(
    name: &Name,
    known: &[Ident],
    suggestion: Option<String>,
    span: Span,
) -> Diagnostic {
    let written = name.to_string();
    let is_component = name.is_simple() && name.first().is_some_and(|first| known.contains(&first));
    let subscripts = is_component
        .then(|| format!("`{written}` is a variable: write a product as `{written}*(...)`, a subscript as `{written}[1]`"));
    let help = subscripts
        .or_else(|| foreign::function_help(&written))
        .or(suggestion)
        .or_else(|| suggest::did_you_mean(&written, crate::functions::names()));
    fault!(UNKNOWN_CLASS, "there is no function `{name}`").help_if(help).at(span)
}

/// A name in an expression; `known` are the components that it could mean.
pub(crate) fn name(name: &Name, known: &[Ident], span: Span) -> Diagnostic {
    let first = name.first().map_or("", Ident::as_str);
    let help = near(first, known).or_else(|| foreign::name_help(&name.to_string()));
    fault!(UNKNOWN_NAME, "`{name}` is not declared").help_if(help).at(span)
}

/// A component that a class with the components `known` does not have.
pub(crate) fn component(class: &Name, name: Ident, known: &[Ident], span: Span) -> Diagnostic {
    fault!(UNKNOWN_NAME, "`{class}` has no component `{name}`")
        .help_if(near(name.as_str(), known))
        .at(span)
}

/// A component of a variable.
pub(crate) fn component_of_variable(variable: &str, name: Ident, span: Span) -> Diagnostic {
    fault!(UNKNOWN_NAME, "`{variable}` is a variable and has no component `{name}`").at(span)
}

/// A literal that an enumeration of graphical annotations with the literals `known` does not have.
pub(crate) fn graphical_literal(
    enumeration: Ident,
    literal: Ident,
    known: &[&str],
    span: Span,
) -> Diagnostic {
    fault!(UNKNOWN_NAME, "`{enumeration}` has no literal `{literal}`")
        .help_if(suggest::did_you_mean(literal.as_str(), known.iter().copied()))
        .help(format!("its literals are {}", known.join(", ")))
        .at(span)
        .warning()
}

/// An element to modify that a class with the elements `known` does not have.
pub(crate) fn element(class: &Name, name: Ident, known: &[Ident], span: Span) -> Diagnostic {
    fault!(UNKNOWN_ELEMENT, "`{class}` has no component `{name}` to modify")
        .help_if(near(name.as_str(), known))
        .at(span)
}

/// An element to remove that a class with the elements `known` does not have.
pub(crate) fn removed_element(
    class: &Name,
    name: Ident,
    known: &[Ident],
    span: Span,
) -> Diagnostic {
    fault!(UNKNOWN_ELEMENT, "`{class}` has no component `{name}` to remove")
        .help_if(near(name.as_str(), known))
        .at(span)
}

/// An input of a function with the inputs `known`, as in `der(f, x)`, that it does not have.
pub(crate) fn input(function: &Name, name: Ident, known: &[Ident], span: Span) -> Diagnostic {
    let list = known.iter().map(|known| format!("`{known}`")).collect::<Vec<_>>().join(", ");
    let inputs = if list.is_empty() { "none".into() } else { list };
    fault!(WRONG_ARGUMENTS, "`{function}` has no input `{name}`")
        .help_if(near(name.as_str(), known))
        .help(format!("its inputs are {inputs}"))
        .at(span)
}

/// An attribute to modify that no variable has.
pub(crate) fn attribute(variable: Ident, name: Ident, span: Span) -> Diagnostic {
    fault!(UNKNOWN_ELEMENT, "`{variable}` has no attribute `{name}` to modify")
        .help_if(suggest::did_you_mean(name.as_str(), ATTRIBUTES))
        .at(span)
}

fn near(name: &str, known: &[Ident]) -> Option<String> {
    suggest::did_you_mean(name, known.iter().map(|known| known.as_str()))
}
