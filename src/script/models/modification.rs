//! Modifications as trees: elements at a path, made where they are missing.

use crate::name::{Ident, Name};
use crate::source::{Span, Spanned};
use crate::syntax::ast::{Argument, Binding, ElementModification, Expression, Modification};

/// Gives the element at a path a value, within what is there already.
pub fn merge(arguments: &mut Vec<Argument>, path: &[Ident], value: &Expression) {
    if let Some(modification) = modification_at(arguments, path) {
        modification.binding = Some(Binding::Expression(value.clone()));
    }
}

/// The modification of the element at a path, which is made where it is missing; `None` for the
/// empty path and after a redeclaration.
pub(crate) fn modification_at<'a>(
    arguments: &'a mut Vec<Argument>,
    path: &[Ident],
) -> Option<&'a mut Modification> {
    let (first, rest) = path.split_first()?;
    let position = arguments.iter().position(|argument| match argument {
        Argument::Element(element) => element.name.node == Name::from(*first),
        Argument::Redeclaration(_) => false,
    });
    let at = position.unwrap_or_else(|| {
        arguments.push(Argument::Element(element(*first)));
        arguments.len() - 1
    });
    let Argument::Element(element) = &mut arguments[at] else { return None };
    let modification = element.modification.get_or_insert_with(no_modification);
    if rest.is_empty() {
        Some(modification)
    } else {
        modification_at(&mut modification.arguments, rest)
    }
}

/// A modification that says nothing.
pub(crate) fn no_modification() -> Modification {
    Modification { arguments: Vec::new(), binding: None, span: Span::NONE }
}

fn element(name: Ident) -> ElementModification {
    ElementModification {
        each: false,
        is_final: false,
        name: Spanned { node: Name::from(name), span: Span::NONE },
        modification: None,
        description: None,
        span: Span::NONE,
    }
}
