//! Statements (MLS §A.2.6), of algorithms and of scripts.

use super::{Lowered, comment, expression};
use crate::fault;
use crate::syntax::ast::{
    ComponentReference, Expression, ExpressionKind, Statement, StatementKind,
};
use crate::syntax::errors::SYNTAX_ERROR;
use crate::syntax::parser::{Nodes, Rule};

/// All statements that come next.
pub(super) fn statements(nodes: &mut Nodes<'_>) -> Lowered<Vec<Statement>> {
    let mut all = Vec::new();
    loop {
        match nodes.peek() {
            Some(Rule::statement | Rule::script_statement) => {}
            Some(Rule::terminator) => {
                nodes.next();
                continue;
            }
            _ => return Ok(all),
        }
        let Some(node) = nodes.next() else { return Ok(all) };
        let mut inside = nodes.inside(node);
        all.push(statement(&mut inside)?);
    }
}

/// The inside of a statement.
pub(super) fn statement(inside: &mut Nodes<'_>) -> Lowered<Statement> {
    let kind = kind(inside)?;
    Ok(Statement { kind, comment: comment(inside)?, span: inside.whole })
}

fn kind(nodes: &mut Nodes<'_>) -> Lowered<StatementKind> {
    let Some(node) = nodes.next() else { panic!("the grammar promises a statement") };
    let rule = node.as_rule();
    let mut inside = nodes.inside(node);
    Ok(match rule {
        Rule::kw_break => StatementKind::Break,
        Rule::kw_return => StatementKind::Return,
        Rule::if_statement | Rule::script_if => {
            let branches = branches(&mut inside)?;
            StatementKind::If { branches, otherwise: list(&mut inside)? }
        }
        Rule::for_statement | Rule::script_for => {
            let indices = expression::for_indices(&mut inside)?;
            StatementKind::For { indices, body: list(&mut inside)? }
        }
        Rule::while_statement | Rule::script_while => {
            let condition = expression::expression(&mut inside)?;
            StatementKind::While { condition, body: list(&mut inside)? }
        }
        Rule::when_statement | Rule::script_when => {
            StatementKind::When { branches: branches(&mut inside)? }
        }
        rule => return assignment_or_call(inside, rule == Rule::script_assignment_or_call),
    })
}

fn branches(inside: &mut Nodes<'_>) -> Lowered<Vec<(Expression, Vec<Statement>)>> {
    let mut branches = Vec::new();
    while let Some(condition) = expression::try_expression(inside)? {
        branches.push((condition, list(inside)?));
    }
    Ok(branches)
}

fn list(inside: &mut Nodes<'_>) -> Lowered<Vec<Statement>> {
    match inside.take(Rule::statement_list).or_else(|| inside.take(Rule::script_list)) {
        Some(node) => statements(&mut inside.inside(node)),
        None => Ok(Vec::new()),
    }
}

/// In a script any expression is a statement, as the `"";` that some write after a call; but for a
/// name alone, which is a command or a call without its parentheses.
fn assignment_or_call(mut inside: Nodes<'_>, is_in_script: bool) -> Lowered<StatementKind> {
    let left = expression::expression(&mut inside)?;
    let is_statement = match left.kind {
        ExpressionKind::Call { .. } => true,
        ExpressionKind::Reference(_) => false,
        _ => is_in_script,
    };
    match expression::try_expression(&mut inside)? {
        Some(value) => assignment(left, value),
        None if is_statement => Ok(StatementKind::Call(left)),
        None => Err(fault!(SYNTAX_ERROR, "this expression is not a statement")
            .help("assign it with `:=`, or write a call")
            .at(left.span)),
    }
}

/// `left := value`.
pub(super) fn assignment(left: Expression, value: Expression) -> Lowered<StatementKind> {
    match left.kind {
        ExpressionKind::Reference(target) => Ok(StatementKind::Assign { target, value }),
        ExpressionKind::Tuple(outputs) if !outputs.is_empty() => {
            let targets = outputs.into_iter().map(|output| output.map(target).transpose());
            Ok(StatementKind::MultiAssign { targets: targets.collect::<Lowered<_>>()?, value })
        }
        _ => target(left).map(|target| StatementKind::Assign { target, value }),
    }
}

fn target(left: Expression) -> Lowered<ComponentReference> {
    match left.kind {
        ExpressionKind::Reference(target) => Ok(target),
        _ => Err(fault!(SYNTAX_ERROR, "only a variable can be assigned")
            .help("write a name, possibly with subscripts, on the left of `:=`")
            .at(left.span)),
    }
}
