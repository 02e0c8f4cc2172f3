//! Attributes of variables as they are declared: `unit`, `displayUnit`, `min` and so on (MLS §4.9.1),
//! from the declaration itself or from its type.

use super::parsed::elements;
use crate::flatten::{ClassId, Declared, Library};
use crate::name::Ident;
use crate::syntax::ast::{
    Argument, Binding, ClassSpecifier, Element, Expression, ExpressionKind, Modification,
    TypeSpecifier,
};
use crate::syntax::print;

/// Types that lead to others, at most.
const MAX_TYPES: usize = 50;

/// An attribute of a component, as it is written; strings without quotation marks.
pub(crate) fn attribute(
    library: &Library,
    owner: ClassId,
    name: Ident,
    attribute: &str,
) -> Option<String> {
    let (clause, declaration) = library.component(owner, name)?;
    let own = declaration.modification.as_ref();
    own.and_then(|own| argument(&own.arguments, attribute))
        .map(written)
        .or_else(|| of_type(library, Some(owner), &clause.type_specifier, attribute))
        .filter(|text| !text.is_empty())
}

/// An attribute that a type gives to its variables.
fn of_type(
    library: &Library,
    scope: Option<ClassId>,
    specifier: &TypeSpecifier,
    attribute: &str,
) -> Option<String> {
    let (mut scope, mut specifier) = (scope, specifier.clone());
    for _ in 0..MAX_TYPES {
        let meaning = library.parts_of_type(scope, &specifier.name).pop().flatten()?;
        let Declared::Class(class) = meaning else { return None };
        let definition = library.definition_of(class);
        let (arguments, base) = match &definition.specifier {
            ClassSpecifier::Short(short) => (&short.modification, &short.target),
            _ => elements(definition).find_map(|element| match element {
                Element::Extends(extends) => Some((&extends.modification, &extends.base)),
                _ => None,
            })?,
        };
        if let Some(found) = argument(arguments, attribute) {
            return Some(written(found));
        }
        scope = library.enclosing(class);
        specifier = base.clone();
    }
    None
}

/// The value that modification arguments give to an element.
fn argument<'a>(arguments: &'a [Argument], name: &str) -> Option<&'a Expression> {
    arguments.iter().find_map(|argument| match argument {
        Argument::Element(element) => {
            let is_it = element.name.node.is_simple()
                && element.name.node.first().is_some_and(|first| first == name);
            element.modification.as_ref().filter(|_| is_it).and_then(value)
        }
        Argument::Redeclaration(_) => None,
    })
}

/// The value of a modification.
pub(crate) fn value(modification: &Modification) -> Option<&Expression> {
    match &modification.binding {
        Some(Binding::Expression(value)) => Some(value),
        _ => None,
    }
}

fn written(value: &Expression) -> String {
    match &value.kind {
        ExpressionKind::String(text) => text.to_string(),
        _ => print::expression(value),
    }
}
