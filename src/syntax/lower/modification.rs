//! Modifications (MLS §A.2.5).

use super::{Lowered, class, component, description_string, expression, name};
use crate::syntax::ast::{
    Argument, Binding, ClassElement, ComponentClause, ElementModification, ElementPrefixes,
    ElementRedeclaration, Modification, RedeclaredElement,
};
use crate::syntax::parser::{Nodes, Rule};

/// The modification that comes next, if one does.
pub(super) fn modification(nodes: &mut Nodes<'_>) -> Lowered<Option<Modification>> {
    let Some(mut parts) = nodes.try_enter(Rule::modification) else { return Ok(None) };
    let arguments = class_modification(&mut parts)?;
    let binding = match parts.take(Rule::kw_break) {
        Some(keyword) => Some(Binding::Break(parts.span(&keyword))),
        None => expression::try_expression(&mut parts)?.map(Binding::Expression),
    };
    Ok(Some(Modification { arguments, binding, span: parts.whole }))
}

/// The arguments of the class modification that comes next; empty if none does.
pub(super) fn class_modification(nodes: &mut Nodes<'_>) -> Lowered<Vec<Argument>> {
    match nodes.try_enter(Rule::class_modification) {
        Some(mut list) => arguments(&mut list),
        None => Ok(Vec::new()),
    }
}

fn arguments(list: &mut Nodes<'_>) -> Lowered<Vec<Argument>> {
    let mut all = Vec::new();
    while list.peek().is_some() {
        all.push(argument(list)?);
    }
    Ok(all)
}

/// The argument that the grammar promises next.
pub(super) fn argument(list: &mut Nodes<'_>) -> Lowered<Argument> {
    match list.try_enter(Rule::element_redeclaration) {
        Some(parts) => redeclaration(parts).map(Argument::Redeclaration),
        None => element_modification(list.enter(Rule::element_modification)).map(Argument::Element),
    }
}

fn element_modification(mut parts: Nodes<'_>) -> Lowered<ElementModification> {
    let (each, prefixes) = prefixes(&mut parts);
    Ok(ElementModification {
        each,
        is_final: prefixes.is_final,
        name: name(&mut parts),
        modification: modification(&mut parts)?,
        description: description_string(&mut parts),
        span: parts.whole,
    })
}

fn redeclaration(mut parts: Nodes<'_>) -> Lowered<ElementRedeclaration> {
    let (each, prefixes) = prefixes(&mut parts);
    let element = match parts.try_enter(Rule::short_class_definition) {
        Some(definition) => RedeclaredElement::Class(Box::new(ClassElement {
            prefixes,
            class: class::definition(definition, false)?,
            constraint: class::constraint(&mut parts)?,
        })),
        None => RedeclaredElement::Component(Box::new(redeclared_component(&mut parts, prefixes)?)),
    };
    Ok(ElementRedeclaration { each, element, span: parts.whole })
}

fn redeclared_component(
    parts: &mut Nodes<'_>,
    prefixes: ElementPrefixes,
) -> Lowered<ComponentClause> {
    let mut clause = parts.enter(Rule::component_clause1);
    let (type_prefixes, type_specifier, subscripts) = component::clause_head(&mut clause)?;
    let declaration = clause.enter(Rule::component_declaration1);
    Ok(ComponentClause {
        prefixes,
        type_prefixes,
        type_specifier,
        subscripts,
        components: vec![component::declaration(declaration)?],
        constraint: class::constraint(parts)?,
        span: clause.whole,
    })
}

/// `each` and the prefixes of an argument, in any order.
fn prefixes(parts: &mut Nodes<'_>) -> (bool, ElementPrefixes) {
    let mut each = false;
    let mut prefixes = ElementPrefixes::default();
    loop {
        if parts.skip(Rule::kw_each) {
            each = true;
        } else if !component::element_prefix(parts, &mut prefixes) {
            return (each, prefixes);
        }
    }
}
