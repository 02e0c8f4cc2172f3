//! The outline of a document: its classes and their components, or the definitions of a script.

use super::document::Document;
use super::parsed::{Parsed, elements};
use super::recovery::Tree;
use crate::source::Span;
use crate::syntax::ast::{
    ClassDefinition, ClassSpecifier, ComponentClause, Element, InteractiveKind, Restriction,
    StatementKind, VariabilityPrefix,
};
use lsp_types::{DocumentSymbol, Location, SymbolInformation, SymbolKind};
use std::collections::BTreeSet;

/// The symbols of a document.
pub(crate) fn symbols(parsed: &Parsed) -> Vec<DocumentSymbol> {
    let document = &parsed.document;
    match &parsed.tree {
        None => Vec::new(),
        Some(Tree::Classes(file)) => {
            file.classes.iter().map(|class| class_symbol(document, class)).collect()
        }
        Some(Tree::Script(script)) => {
            let mut seen = BTreeSet::new();
            let kinds = script.statements.iter().map(|statement| (&statement.kind, statement.span));
            kinds
                .flat_map(|(kind, span)| statement_symbols(document, kind, span))
                .filter(|symbol| {
                    symbol.kind != SymbolKind::VARIABLE || seen.insert(symbol.name.clone())
                })
                .collect()
        }
    }
}

/// The package that a file is in, as it says.
pub(crate) fn package(parsed: &Parsed) -> Option<String> {
    match &parsed.tree {
        Some(Tree::Classes(file)) => file.within.as_ref().map(|within| within.node.to_string()),
        _ => None,
    }
    .filter(|name| !name.is_empty())
}

/// The same for clients that do not know trees.
#[allow(deprecated, reason = "the field must be given")]
pub(crate) fn flat(document: &Document, symbols: Vec<DocumentSymbol>) -> Vec<SymbolInformation> {
    let mut found = Vec::new();
    let mut pending: Vec<(DocumentSymbol, Option<String>)> =
        symbols.into_iter().rev().map(|symbol| (symbol, None)).collect();
    while let Some((symbol, container_name)) = pending.pop() {
        let location = Location { uri: document.uri.clone(), range: symbol.range };
        let inside = symbol.children.into_iter().flatten().rev();
        pending.extend(inside.map(|child| (child, Some(symbol.name.clone()))));
        found.push(SymbolInformation {
            name: symbol.name,
            kind: symbol.kind,
            tags: None,
            deprecated: None,
            location,
            container_name,
        });
    }
    found
}

#[allow(deprecated, reason = "the field must be given")]
fn symbol(
    document: &Document,
    (name, detail): (String, Option<String>),
    kind: SymbolKind,
    (whole, own): (Span, Span),
    children: Vec<DocumentSymbol>,
) -> DocumentSymbol {
    let range = |span: Span| document.range(span.start as usize..span.end as usize);
    DocumentSymbol {
        name,
        detail,
        kind,
        tags: None,
        deprecated: None,
        range: range(whole.to(own)),
        selection_range: range(own),
        children: (!children.is_empty()).then_some(children),
    }
}

fn class_symbol(document: &Document, class: &ClassDefinition) -> DocumentSymbol {
    let mut children = Vec::new();
    for element in elements(class) {
        match element {
            Element::Class(nested) => children.push(class_symbol(document, &nested.class)),
            Element::Component(clause) => children.extend(component_symbols(document, clause)),
            Element::Import(_) | Element::Extends(_) => {}
        }
    }
    if let ClassSpecifier::Enumeration(enumeration) = &class.specifier {
        for literal in enumeration.literals.iter().flatten() {
            let name = (literal.name.node.to_string(), None);
            let spans = (literal.name.span, literal.name.span);
            children.push(symbol(document, name, SymbolKind::ENUM_MEMBER, spans, Vec::new()));
        }
    }
    let name = class.name.node.to_string();
    let detail = Some(class.restriction.keyword().to_owned());
    let spans = (class.span, class.name.span);
    symbol(document, (name, detail), kind(class), spans, children)
}

fn kind(class: &ClassDefinition) -> SymbolKind {
    match (class.restriction, &class.specifier) {
        (_, ClassSpecifier::Enumeration(_)) => SymbolKind::ENUM,
        (Restriction::Package, _) => SymbolKind::PACKAGE,
        (Restriction::Function { .. }, _) => SymbolKind::FUNCTION,
        (Restriction::Record | Restriction::OperatorRecord, _) => SymbolKind::STRUCT,
        (Restriction::Connector | Restriction::ExpandableConnector, _) => SymbolKind::INTERFACE,
        (Restriction::Operator, _) => SymbolKind::OPERATOR,
        _ => SymbolKind::CLASS,
    }
}

fn component_symbols(document: &Document, clause: &ComponentClause) -> Vec<DocumentSymbol> {
    let kind = match clause.type_prefixes.variability {
        Some(VariabilityPrefix::Constant | VariabilityPrefix::Parameter) => SymbolKind::CONSTANT,
        _ => SymbolKind::FIELD,
    };
    let one = |component: &crate::syntax::ast::ComponentDeclaration| {
        let name = component.name.node.to_string();
        let detail = Some(clause.type_specifier.name.to_string());
        let spans = (component.span, component.name.span);
        symbol(document, (name, detail), kind, spans, Vec::new())
    };
    clause.components.iter().map(one).collect()
}

fn statement_symbols(
    document: &Document,
    kind: &InteractiveKind,
    span: Span,
) -> Vec<DocumentSymbol> {
    match kind {
        InteractiveKind::Class(class) => vec![class_symbol(document, class)],
        InteractiveKind::Declaration(clause) => component_symbols(document, clause),
        InteractiveKind::Statement(statement) => match &statement.kind {
            StatementKind::Assign { target, .. } => {
                let name = (target.parts[0].name.to_string(), None);
                let spans = (span, target.span);
                vec![symbol(document, name, SymbolKind::VARIABLE, spans, Vec::new())]
            }
            _ => Vec::new(),
        },
        _ => Vec::new(),
    }
}
