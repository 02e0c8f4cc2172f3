//! From the grammar's nodes to the syntax tree.

mod class;
mod equation;
mod expression;
mod script;
mod statement;

pub(super) use class::{lone_class, stored_definition};
pub(super) use script::script;

use super::ast::{Annotation, Argument, Comment, Expression};
use super::parser::{Node, Nodes, Rule};
use crate::diag::Diagnostic;
use crate::name::{Ident, Name};
use crate::source::Spanned;
use std::sync::Arc;

/// What lowering a node gives.
type Lowered<T> = Result<T, Diagnostic>;

/// The expression that is the whole text.
pub(super) fn lone_expression(mut nodes: Nodes<'_>) -> Lowered<Expression> {
    expression::expression(&mut nodes)
}

/// `M(p = 2)` as the whole text.
pub(super) fn class_with_modification(mut nodes: Nodes<'_>) -> Lowered<(Name, Vec<Argument>)> {
    let name = name(&mut nodes).node;
    Ok((name, class::class_modification(&mut nodes)?))
}

fn ident_of<'i>(nodes: &Nodes<'i>, node: &Node<'i>) -> Spanned<Ident> {
    Spanned { node: Ident::new(node.as_str()), span: nodes.span(node) }
}

/// The identifier that the grammar promises next.
fn ident(nodes: &mut Nodes<'_>) -> Spanned<Ident> {
    let node = nodes.expect(Rule::IDENT);
    ident_of(nodes, &node)
}

/// The name that the grammar promises next.
fn name(nodes: &mut Nodes<'_>) -> Spanned<Name> {
    let mut parts = nodes.enter(Rule::name);
    let mut name = Name { global: parts.skip(Rule::global_dot), parts: Vec::new() };
    while let Some(part) = parts.take(Rule::IDENT) {
        name.parts.push(Ident::new(part.as_str()));
    }
    Spanned { node: name, span: parts.whole }
}

/// The content of a string literal, escapes resolved.
fn string(node: &Node<'_>) -> Arc<str> {
    let quoted = node.as_str();
    let content = &quoted[1..quoted.len() - 1];
    if !content.contains('\\') {
        return content.into();
    }
    let mut text = String::with_capacity(content.len());
    let mut characters = content.chars();
    while let Some(character) = characters.next() {
        if character != '\\' {
            text.push(character);
            continue;
        }
        match characters.next() {
            Some('n') => text.push('\n'),
            Some('r') => text.push('\r'),
            Some('t') => text.push('\t'),
            Some('a') => text.push('\u{07}'),
            Some('b') => text.push('\u{08}'),
            Some('f') => text.push('\u{0c}'),
            Some('v') => text.push('\u{0b}'),
            Some(same @ ('\\' | '"' | '\'' | '?')) => text.push(same),
            // No escape of MLS §2.4.6: kept as written, as in the Windows paths of old scripts.
            other => {
                text.push('\\');
                text.extend(other);
            }
        }
    }
    text.into()
}

/// The description string that comes next, its parts joined.
fn description_string(nodes: &mut Nodes<'_>) -> Option<Arc<str>> {
    let mut parts = nodes.try_enter(Rule::description_string)?;
    let first = parts.expect(Rule::STRING);
    let mut text = string(&first);
    while let Some(more) = parts.take(Rule::STRING) {
        text = format!("{text}{}", string(&more)).into();
    }
    Some(text)
}

/// String and annotation that come next.
fn comment(nodes: &mut Nodes<'_>) -> Lowered<Comment> {
    Ok(Comment { text: description_string(nodes), annotation: annotation(nodes)? })
}

/// The annotation that comes next, if one does.
fn annotation(nodes: &mut Nodes<'_>) -> Lowered<Option<Annotation>> {
    let Some(mut clause) = nodes.try_enter(Rule::annotation_clause) else { return Ok(None) };
    let arguments = class::class_modification(&mut clause)?;
    Ok(Some(Annotation { arguments, span: clause.whole }))
}
