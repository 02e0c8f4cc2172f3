//! Scripts: the top level of a `.mos` file.

use super::{Lowered, class, comment, expression, statement};
use crate::source::Spanned;
use crate::syntax::ast::{
    ElementPrefixes, InteractiveKind, InteractiveStatement, Script, Statement,
};
use crate::syntax::parser::{Node, Nodes, Rule};
use std::sync::Arc;

/// A whole script.
pub(in crate::syntax) fn script(mut nodes: Nodes<'_>) -> Lowered<Script> {
    let mut statements = Vec::new();
    while let Some(inside) = nodes.try_enter(Rule::interactive_statement) {
        let span = inside.whole;
        let kind = kind(inside)?;
        let semicolon = nodes.take(Rule::terminator).is_some_and(|end| end.as_str() == ";");
        statements.push(InteractiveStatement { kind, semicolon, span });
    }
    Ok(Script { statements, span: nodes.whole })
}

fn kind(mut nodes: Nodes<'_>) -> Lowered<InteractiveKind> {
    let Some(node) = nodes.next() else { panic!("the grammar promises a statement") };
    let rule = node.as_rule();
    let mut inside = nodes.inside(node);
    match rule {
        Rule::command => Ok(command(inside)),
        Rule::class_definition => class::definition(inside, false).map(InteractiveKind::Class),
        Rule::import_clause => {
            class::import(inside).map(|import| InteractiveKind::Import(Box::new(import)))
        }
        Rule::script_declaration => {
            class::component_clause(&mut inside, ElementPrefixes::default())
                .map(|clause| InteractiveKind::Declaration(Box::new(clause)))
        }
        _ => statement_or_expression(inside),
    }
}

fn command(mut inside: Nodes<'_>) -> InteractiveKind {
    let text = |inside: &mut Nodes<'_>| match inside.next() {
        Some(node) => spanned_text(inside, &node),
        None => panic!("the grammar promises a command and its argument"),
    };
    let name = text(&mut inside);
    InteractiveKind::Command { name, argument: text(&mut inside) }
}

fn spanned_text<'i>(nodes: &Nodes<'i>, node: &Node<'i>) -> Spanned<Arc<str>> {
    Spanned { node: node.as_str().trim_end().into(), span: nodes.span(node) }
}

/// A call or another expression alone is shown; everything else is a statement.
fn statement_or_expression(mut inside: Nodes<'_>) -> Lowered<InteractiveKind> {
    if inside.peek() != Some(Rule::script_assignment_or_call) {
        return statement::statement(&mut inside).map(InteractiveKind::Statement);
    }
    let mut parts = inside.enter(Rule::script_assignment_or_call);
    let left = expression::expression(&mut parts)?;
    let Some(value) = expression::try_expression(&mut parts)? else {
        return Ok(InteractiveKind::Expression(left));
    };
    let kind = statement::assignment(left, value)?;
    let comment = comment(&mut inside)?;
    Ok(InteractiveKind::Statement(Statement { kind, comment, span: inside.whole }))
}
