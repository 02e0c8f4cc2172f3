//! Classes (MLS §A.2.1–A.2.3).

use super::{
    Lowered, annotation, comment, component, description_string, equation, expression, ident,
    modification, name, statement, string,
};
use crate::name::{Ident, Name};
use crate::source::Spanned;
use crate::syntax::ast::{
    ClassDefinition, ClassElement, ClassSpecifier, Constraint, DerivativeClass, Deselection,
    Element, ElementPrefixes, EnumerationClass, EnumerationLiteral, Extends, External, Import,
    ImportKind, LongClass, Purity, Restriction, Section, ShortClass, StoredDefinition, Visibility,
};
use crate::syntax::lazy::Sections;
use crate::syntax::parser::{Nodes, Rule};
use std::sync::Arc;

/// A whole `.mo` file.
pub(in crate::syntax) fn stored_definition(mut nodes: Nodes<'_>) -> Lowered<StoredDefinition> {
    let within = nodes.try_enter(Rule::within_clause).map(|mut clause| match clause.peek() {
        Some(Rule::name) => name(&mut clause),
        _ => Spanned { node: Name::default(), span: clause.whole },
    });
    let mut classes = Vec::new();
    while nodes.peek().is_some() {
        let is_final = nodes.skip(Rule::kw_final);
        let inside = nodes.enter(Rule::class_definition);
        classes.push(definition(inside, is_final)?);
    }
    Ok(StoredDefinition { within, classes, span: nodes.whole })
}

/// The class definition that is the whole text.
pub(in crate::syntax) fn lone_class(mut nodes: Nodes<'_>) -> Lowered<Arc<ClassDefinition>> {
    definition(nodes.enter(Rule::class_definition), false)
}

/// The inside of a class definition, long or short.
pub(super) fn definition(mut parts: Nodes<'_>, is_final: bool) -> Lowered<Arc<ClassDefinition>> {
    let encapsulated = parts.skip(Rule::kw_encapsulated);
    let partial = parts.skip(Rule::kw_partial);
    let restriction = restriction(parts.enter(Rule::restriction));
    let (name, specifier) = match parts.try_enter(Rule::extends_class_specifier) {
        Some(mut inside) => {
            let name = ident(&mut inside);
            (name, ClassSpecifier::Long(long_class(inside, name, true)?))
        }
        None => {
            let name = ident(&mut parts);
            (name, class_specifier(&mut parts, name)?)
        }
    };
    let span = parts.whole;
    Ok(Arc::new(ClassDefinition {
        name,
        is_final,
        encapsulated,
        partial,
        restriction,
        specifier,
        span,
    }))
}

fn restriction(mut words: Nodes<'_>) -> Restriction {
    let (mut purity, mut operator) = (None, false);
    while let Some(word) = words.next() {
        match word.as_rule() {
            Rule::word_class => return Restriction::Class,
            Rule::word_model => return Restriction::Model,
            Rule::word_record if operator => return Restriction::OperatorRecord,
            Rule::word_record => return Restriction::Record,
            Rule::word_block => return Restriction::Block,
            Rule::word_connector => return Restriction::Connector,
            Rule::word_type => return Restriction::Type,
            Rule::word_package => return Restriction::Package,
            Rule::word_expandable => return Restriction::ExpandableConnector,
            Rule::word_pure => purity = Some(Purity::Pure),
            Rule::word_impure => purity = Some(Purity::Impure),
            Rule::word_operator => operator = true,
            _ => return Restriction::Function { purity, operator },
        }
    }
    Restriction::Operator
}

fn class_specifier(parts: &mut Nodes<'_>, name: Spanned<Ident>) -> Lowered<ClassSpecifier> {
    let Some(node) = parts.next() else { panic!("the grammar promises a class specifier") };
    let rule = node.as_rule();
    let mut inside = parts.inside(node);
    Ok(match rule {
        Rule::long_class_specifier => ClassSpecifier::Long(long_class(inside, name, false)?),
        Rule::short_class_specifier => ClassSpecifier::Short(ShortClass {
            prefixes: component::type_prefixes(&mut inside)?,
            target: component::type_specifier(&mut inside),
            subscripts: expression::optional_subscripts(&mut inside)?,
            modification: modification::class_modification(&mut inside)?,
            comment: comment(&mut inside)?,
        }),
        Rule::enumeration_specifier => ClassSpecifier::Enumeration(enumeration(inside)?),
        Rule::der_class_specifier => ClassSpecifier::Derivative(DerivativeClass {
            target: component::type_specifier(&mut inside),
            variables: idents(&mut inside),
            comment: comment(&mut inside)?,
        }),
        other => panic!("the grammar has no class specifier {other:?}"),
    })
}

fn idents(nodes: &mut Nodes<'_>) -> Vec<Spanned<Ident>> {
    let mut all = Vec::new();
    while nodes.peek() == Some(Rule::IDENT) {
        all.push(ident(nodes));
    }
    all
}

fn enumeration(mut inside: Nodes<'_>) -> Lowered<EnumerationClass> {
    if inside.skip(Rule::enumeration_open) {
        return Ok(EnumerationClass { literals: None, comment: comment(&mut inside)? });
    }
    let mut literals = Vec::new();
    while let Some(mut literal) = inside.try_enter(Rule::enumeration_literal) {
        let name = ident(&mut literal);
        literals.push(EnumerationLiteral { name, comment: comment(&mut literal)? });
    }
    Ok(EnumerationClass { literals: Some(literals), comment: comment(&mut inside)? })
}

fn long_class(mut inside: Nodes<'_>, name: Spanned<Ident>, extends: bool) -> Lowered<LongClass> {
    let modification = modification::class_modification(&mut inside)?;
    let description = description_string(&mut inside);
    let composition = inside.enter(Rule::composition);
    let sections = match inside.place.unread(name.span) {
        Some(unread) => unread,
        None => Sections::from(sections(composition)?),
    };
    let class_extends = extends.then_some(modification);
    Ok(LongClass { class_extends, description, sections, end_name: ident(&mut inside) })
}

/// Sections, cut at every annotation: what follows one is a section of the same kind.
fn sections(mut composition: Nodes<'_>) -> Lowered<Vec<Section>> {
    let mut sections = Vec::new();
    let first = composition.enter(Rule::element_list);
    elements(first, None, &mut sections)?;
    loop {
        while composition.peek() == Some(Rule::annotation_clause) {
            push_annotation(&mut composition, &mut sections)?;
        }
        let Some(node) = composition.next() else { return Ok(sections) };
        let rule = node.as_rule();
        let mut inside = composition.inside(node);
        match rule {
            Rule::public_section => {
                let list = inside.enter(Rule::element_list);
                elements(list, Some(Visibility::Public), &mut sections)?;
            }
            Rule::protected_section => {
                let list = inside.enter(Rule::element_list);
                elements(list, Some(Visibility::Protected), &mut sections)?;
            }
            Rule::equation_section => equations(inside, &mut sections)?,
            Rule::algorithm_section => statements(inside, &mut sections)?,
            _ => external(inside, &mut sections)?,
        }
    }
}

fn push_annotation(inside: &mut Nodes<'_>, sections: &mut Vec<Section>) -> Lowered<()> {
    sections.extend(annotation(inside)?.map(Section::Annotation));
    Ok(())
}

fn elements(
    mut list: Nodes<'_>,
    visibility: Option<Visibility>,
    sections: &mut Vec<Section>,
) -> Lowered<()> {
    let mut elements = Vec::new();
    let mut written = false;
    while let Some(rule) = list.peek() {
        if rule != Rule::annotation_clause {
            elements.push(element(&mut list)?);
            continue;
        }
        if !elements.is_empty() || (visibility.is_some() && !written) {
            let elements = std::mem::take(&mut elements);
            sections.push(Section::Elements { visibility, elements });
        }
        written = true;
        push_annotation(&mut list, sections)?;
    }
    if !elements.is_empty() || (visibility.is_some() && !written) {
        sections.push(Section::Elements { visibility, elements });
    }
    Ok(())
}

fn equations(mut inside: Nodes<'_>, sections: &mut Vec<Section>) -> Lowered<()> {
    let span = inside.whole;
    let initial = inside.skip(Rule::kw_initial);
    let mut written = false;
    loop {
        let equations = equation::equations(&mut inside)?;
        if !equations.is_empty() || !written {
            sections.push(Section::Equations { initial, equations, span });
        }
        written = true;
        if inside.peek().is_none() {
            return Ok(());
        }
        push_annotation(&mut inside, sections)?;
    }
}

fn statements(mut inside: Nodes<'_>, sections: &mut Vec<Section>) -> Lowered<()> {
    let span = inside.whole;
    let initial = inside.skip(Rule::kw_initial);
    let mut written = false;
    loop {
        let statements = statement::statements(&mut inside)?;
        if !statements.is_empty() || !written {
            sections.push(Section::Algorithm { initial, statements, span });
        }
        written = true;
        if inside.peek().is_none() {
            return Ok(());
        }
        push_annotation(&mut inside, sections)?;
    }
}

fn external(mut inside: Nodes<'_>, sections: &mut Vec<Section>) -> Lowered<()> {
    let language = inside.take(Rule::STRING).map(|node| string(&node));
    let (mut output, mut function, mut arguments) = (None, None, Vec::new());
    if let Some(mut call) = inside.try_enter(Rule::external_function_call) {
        if call.peek() == Some(Rule::component_reference) {
            output = Some(expression::reference(&mut call)?);
        }
        function = Some(ident(&mut call));
        arguments = expression::expressions(&mut call)?;
    }
    let annotation = annotation(&mut inside)?;
    let span = inside.whole;
    sections.push(Section::External(External {
        language,
        output,
        function,
        arguments,
        annotation,
        span,
    }));
    Ok(())
}

fn element(list: &mut Nodes<'_>) -> Lowered<Element> {
    let Some(node) = list.next() else { panic!("the grammar promises an element") };
    let rule = node.as_rule();
    let inside = list.inside(node);
    match rule {
        Rule::import_clause => import(inside).map(Element::Import),
        Rule::extends_clause => extends(inside).map(Element::Extends),
        _ => declared_element(inside),
    }
}

fn declared_element(mut inside: Nodes<'_>) -> Lowered<Element> {
    let mut prefixes = ElementPrefixes::default();
    while component::element_prefix(&mut inside, &mut prefixes) {}
    let Some(class) = inside.try_enter(Rule::class_definition) else {
        return component::clause(&mut inside, prefixes).map(Element::Component);
    };
    let class = definition(class, false)?;
    Ok(Element::Class(ClassElement { prefixes, class, constraint: constraint(&mut inside)? }))
}

/// The inside of an import clause.
pub(super) fn import(mut inside: Nodes<'_>) -> Lowered<Import> {
    let kind = match inside.try_enter(Rule::import_renaming) {
        Some(mut renaming) => {
            let alias = ident(&mut renaming).node;
            ImportKind::Renaming(alias, name(&mut renaming).node)
        }
        None => {
            let name = name(&mut inside).node;
            if inside.skip(Rule::import_all) {
                ImportKind::Unqualified(name)
            } else if let Some(mut list) = inside.try_enter(Rule::import_list) {
                let members = idents(&mut list).into_iter().map(|member| member.node);
                ImportKind::Group(name, members.collect())
            } else {
                ImportKind::Qualified(name)
            }
        }
    };
    Ok(Import { kind, comment: comment(&mut inside)?, span: inside.whole })
}

fn extends(mut inside: Nodes<'_>) -> Lowered<Extends> {
    let base = component::type_specifier(&mut inside);
    let (mut arguments, mut deselected) = (Vec::new(), Vec::new());
    if let Some(mut list) = inside.try_enter(Rule::class_or_inheritance_modification) {
        while list.peek().is_some() {
            match list.try_enter(Rule::inheritance_modification) {
                Some(deselection) => deselected.push(self::deselection(deselection)?),
                None => arguments.push(modification::argument(&mut list)?),
            }
        }
    }
    Ok(Extends {
        base,
        modification: arguments,
        deselected,
        annotation: annotation(&mut inside)?,
        span: inside.whole,
    })
}

fn deselection(mut inside: Nodes<'_>) -> Lowered<Deselection> {
    inside.skip(Rule::kw_break);
    let Some(mut connect) = inside.try_enter(Rule::connect_equation) else {
        return Ok(Deselection::Component(ident(&mut inside)));
    };
    let left = expression::reference(&mut connect)?;
    Ok(Deselection::Connection(left, expression::reference(&mut connect)?))
}

/// The constraining clause that comes next, if one does.
pub(super) fn constraint(nodes: &mut Nodes<'_>) -> Lowered<Option<Constraint>> {
    let Some(mut inside) = nodes.try_enter(Rule::constraining_clause) else { return Ok(None) };
    Ok(Some(Constraint {
        target: component::type_specifier(&mut inside),
        modification: modification::class_modification(&mut inside)?,
        comment: comment(&mut inside)?,
        span: inside.whole,
    }))
}
