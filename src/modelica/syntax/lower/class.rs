//! Classes, component clauses and modifications (MLS §A.2.1–A.2.5), which contain one another.

use super::{
    Lowered, annotation, comment, description_string, equation, expression, ident, name, statement,
    string,
};
use crate::fault;
use crate::name::{Ident, Name};
use crate::source::Spanned;
use crate::syntax::ast::{
    Argument, Binding, CausalityPrefix, ClassDefinition, ClassElement, ClassSpecifier,
    ComponentClause, ComponentDeclaration, ConnectionPrefix, Constraint, DerivativeClass, Element,
    ElementModification, ElementPrefixes, ElementRedeclaration, EnumerationClass,
    EnumerationLiteral, Exclusion, Extends, External, Import, ImportKind, LongClass, Modification,
    Purity, RedeclaredElement, Restriction, Section, Sections, ShortClass, StoredDefinition,
    Subscript, TypePrefixes, TypeSpecifier, VariabilityPrefix, Visibility,
};
use crate::syntax::errors::SYNTAX_ERROR;
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
            prefixes: type_prefixes(&mut inside)?,
            target: type_specifier(&mut inside),
            subscripts: expression::optional_subscripts(&mut inside)?,
            modification: class_modification(&mut inside)?,
            comment: comment(&mut inside)?,
        }),
        Rule::enumeration_specifier => ClassSpecifier::Enumeration(enumeration(inside)?),
        Rule::der_class_specifier => ClassSpecifier::Derivative(DerivativeClass {
            target: type_specifier(&mut inside),
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
    let modification = class_modification(&mut inside)?;
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
    while element_prefix(&mut inside, &mut prefixes) {}
    let Some(class) = inside.try_enter(Rule::class_definition) else {
        return component_clause(&mut inside, prefixes).map(Element::Component);
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
    let base = type_specifier(&mut inside);
    let (mut arguments, mut excluded) = (Vec::new(), Vec::new());
    if let Some(mut list) = inside.try_enter(Rule::class_or_inheritance_modification) {
        while list.peek().is_some() {
            match list.try_enter(Rule::inheritance_modification) {
                Some(exclusion) => excluded.push(self::exclusion(exclusion)?),
                None => arguments.push(argument(&mut list)?),
            }
        }
    }
    Ok(Extends {
        base,
        modification: arguments,
        excluded,
        annotation: annotation(&mut inside)?,
        span: inside.whole,
    })
}

fn exclusion(mut inside: Nodes<'_>) -> Lowered<Exclusion> {
    inside.skip(Rule::kw_break);
    let Some(mut connect) = inside.try_enter(Rule::connect_equation) else {
        return Ok(Exclusion::Component(ident(&mut inside)));
    };
    let left = expression::reference(&mut connect)?;
    Ok(Exclusion::Connection(left, expression::reference(&mut connect)?))
}

/// The constraining clause that comes next, if one does.
fn constraint(nodes: &mut Nodes<'_>) -> Lowered<Option<Constraint>> {
    let Some(mut inside) = nodes.try_enter(Rule::constraining_clause) else { return Ok(None) };
    Ok(Some(Constraint {
        target: type_specifier(&mut inside),
        modification: class_modification(&mut inside)?,
        comment: comment(&mut inside)?,
        span: inside.whole,
    }))
}

/// The component clause that the grammar promises next, and its constraining clause.
pub(super) fn component_clause(
    nodes: &mut Nodes<'_>,
    prefixes: ElementPrefixes,
) -> Lowered<ComponentClause> {
    let mut parts = nodes.enter(Rule::component_clause);
    let (type_prefixes, type_specifier, subscripts) = clause_head(&mut parts)?;
    let mut components = Vec::new();
    while let Some(inside) = parts.try_enter(Rule::component_declaration) {
        components.push(component_declaration(inside)?);
    }
    let constraint = constraint(nodes)?;
    Ok(ComponentClause {
        prefixes,
        type_prefixes,
        type_specifier,
        subscripts,
        components,
        constraint,
        span: parts.whole,
    })
}

/// Prefixes, type and dimensions.
fn clause_head(parts: &mut Nodes<'_>) -> Lowered<(TypePrefixes, TypeSpecifier, Vec<Subscript>)> {
    let prefixes = type_prefixes(parts)?;
    let specifier = type_specifier(parts);
    Ok((prefixes, specifier, expression::optional_subscripts(parts)?))
}

/// The inside of a component declaration.
fn component_declaration(mut parts: Nodes<'_>) -> Lowered<ComponentDeclaration> {
    let name = ident(&mut parts);
    let subscripts = expression::optional_subscripts(&mut parts)?;
    let modification = modification(&mut parts)?;
    let condition = match parts.try_enter(Rule::condition_attribute) {
        Some(mut attribute) => Some(expression::expression(&mut attribute)?),
        None => None,
    };
    let comment = comment(&mut parts)?;
    let span = parts.whole;
    Ok(ComponentDeclaration { name, subscripts, modification, condition, comment, span })
}

/// The type specifier that the grammar promises next.
pub(super) fn type_specifier(nodes: &mut Nodes<'_>) -> TypeSpecifier {
    let mut inside = nodes.enter(Rule::type_specifier);
    let name = name(&mut inside);
    TypeSpecifier { name: name.node, span: name.span }
}

/// The type prefixes that come next, in any order, each kind once.
fn type_prefixes(nodes: &mut Nodes<'_>) -> Lowered<TypePrefixes> {
    let mut prefixes = TypePrefixes::default();
    while let Some(word) = nodes.take(Rule::type_prefix) {
        let earlier = match word.as_str() {
            "flow" => prefixes.connection.replace(ConnectionPrefix::Flow).is_some(),
            "stream" => prefixes.connection.replace(ConnectionPrefix::Stream).is_some(),
            "constant" => prefixes.variability.replace(VariabilityPrefix::Constant).is_some(),
            "parameter" => prefixes.variability.replace(VariabilityPrefix::Parameter).is_some(),
            "discrete" => prefixes.variability.replace(VariabilityPrefix::Discrete).is_some(),
            "input" => prefixes.causality.replace(CausalityPrefix::Input).is_some(),
            _ => prefixes.causality.replace(CausalityPrefix::Output).is_some(),
        };
        if earlier {
            return Err(fault!(
                SYNTAX_ERROR,
                "`{}` cannot follow another prefix of the same kind",
                word.as_str()
            )
            .help("keep one of `flow`, `stream`; one of `constant`, `parameter`, `discrete`; one of `input`, `output`")
            .at(nodes.span(&word)));
        }
    }
    Ok(prefixes)
}

/// Adds the element prefix that comes next; whether one does.
fn element_prefix(nodes: &mut Nodes<'_>, prefixes: &mut ElementPrefixes) -> bool {
    let flag = match nodes.peek() {
        Some(Rule::kw_redeclare) => &mut prefixes.redeclare,
        Some(Rule::kw_final) => &mut prefixes.is_final,
        Some(Rule::kw_inner) => &mut prefixes.inner,
        Some(Rule::kw_outer) => &mut prefixes.outer,
        Some(Rule::kw_replaceable) => &mut prefixes.replaceable,
        _ => return false,
    };
    *flag = true;
    nodes.next();
    true
}

/// The modification that comes next, if one does.
fn modification(nodes: &mut Nodes<'_>) -> Lowered<Option<Modification>> {
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
        Some(inside) => RedeclaredElement::Class(Box::new(ClassElement {
            prefixes,
            class: definition(inside, false)?,
            constraint: constraint(&mut parts)?,
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
    let (type_prefixes, type_specifier, subscripts) = clause_head(&mut clause)?;
    let declaration = clause.enter(Rule::component_declaration1);
    Ok(ComponentClause {
        prefixes,
        type_prefixes,
        type_specifier,
        subscripts,
        components: vec![component_declaration(declaration)?],
        constraint: constraint(parts)?,
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
        } else if !element_prefix(parts, &mut prefixes) {
            return (each, prefixes);
        }
    }
}
