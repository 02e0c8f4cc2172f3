//! Units after numbers: `R = 100` is shown as `R = 100 Ohm` where the unit is that of the type.

use super::attributes;
use super::occurrences::{Entity, Occurrence};
use super::parsed::{Parsed, elements};
use crate::flatten::{Declared, Library};
use crate::source::Span;
use crate::syntax::ast::{
    Argument, ClassSpecifier, ComponentClause, Element, Expression, ExpressionKind, Modification,
    RedeclaredElement, UnaryOperator,
};
use lsp_types::{InlayHint, InlayHintKind, InlayHintLabel};
use std::ops::Range;

/// A number that is given to a variable: the name of the variable, and the number.
type Given = (Span, Span);

/// The units in some bytes of a document.
pub(crate) fn hints(
    library: &Library,
    parsed: &Parsed,
    names: &[Occurrence],
    within: Range<usize>,
) -> Vec<InlayHint> {
    let mut given = Vec::new();
    for (_, class) in parsed.all_classes() {
        if let ClassSpecifier::Short(short) = &class.specifier {
            of_arguments(&short.modification, &mut given);
        }
        for element in elements(&class) {
            match element {
                Element::Component(clause) => of_clause(clause, &mut given),
                Element::Extends(extends) => of_arguments(&extends.modification, &mut given),
                Element::Class(_) | Element::Import(_) => {}
            }
        }
    }
    let document = &parsed.document;
    let hint = |(name, value): Given| {
        let end = value.end as usize;
        let unit =
            unit(library, names, name).filter(|_| within.start <= end && end <= within.end)?;
        Some(InlayHint {
            position: document.range(end..end).start,
            label: InlayHintLabel::String(unit),
            kind: Some(InlayHintKind::TYPE),
            text_edits: None,
            tooltip: None,
            padding_left: Some(true),
            padding_right: None,
            data: None,
        })
    };
    given.into_iter().filter_map(hint).collect()
}

/// The unit of the variable that a name means; none for numbers without dimension.
fn unit(library: &Library, names: &[Occurrence], name: Span) -> Option<String> {
    // Of a dotted name the last part.
    let within = name.start as usize..name.end as usize;
    let last =
        names.iter().rfind(|one| within.start <= one.range.start && one.range.end == within.end)?;
    let Entity::Declared(Declared::Component(owner, name)) = last.entity else { return None };
    attributes::attribute(library, owner, name, "unit").filter(|unit| unit != "1")
}

fn of_clause(clause: &ComponentClause, given: &mut Vec<Given>) {
    for component in &clause.components {
        if let Some(modification) = &component.modification {
            of_modification(component.name.span, modification, given);
        }
    }
}

fn of_modification(name: Span, modification: &Modification, given: &mut Vec<Given>) {
    of_arguments(&modification.arguments, given);
    if let Some(value) = attributes::value(modification).filter(|value| is_number(value)) {
        given.push((name, value.span));
    }
}

fn of_arguments(arguments: &[Argument], given: &mut Vec<Given>) {
    for argument in arguments {
        match argument {
            Argument::Element(element) => {
                if let Some(modification) = &element.modification {
                    of_modification(element.name.span, modification, given);
                }
            }
            Argument::Redeclaration(redeclaration) => {
                if let RedeclaredElement::Component(clause) = &redeclaration.element {
                    of_clause(clause, given);
                }
            }
        }
    }
}

fn is_number(value: &Expression) -> bool {
    match &value.kind {
        ExpressionKind::Real(_) | ExpressionKind::Integer(_) => true,
        ExpressionKind::Unary { operator: UnaryOperator::Minus, operand } => is_number(operand),
        _ => false,
    }
}
