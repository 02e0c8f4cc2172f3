//! Equations (MLS §A.2.6).

use super::{Lowered, comment, expression};
use crate::fault;
use crate::syntax::ast::{BinaryOperator, Equation, EquationKind, Expression, ExpressionKind};
use crate::syntax::errors::SYNTAX_ERROR;
use crate::syntax::parser::{Nodes, Rule};

/// All equations that come next.
pub(super) fn equations(nodes: &mut Nodes<'_>) -> Lowered<Vec<Equation>> {
    let mut all = Vec::new();
    while let Some(mut inside) = nodes.try_enter(Rule::some_equation) {
        let kind = kind(&mut inside)?;
        all.push(Equation { kind, comment: comment(&mut inside)?, span: inside.whole });
    }
    Ok(all)
}

fn kind(nodes: &mut Nodes<'_>) -> Lowered<EquationKind> {
    let Some(node) = nodes.next() else { panic!("the grammar promises an equation") };
    let rule = node.as_rule();
    let mut inside = nodes.inside(node);
    match rule {
        Rule::equation_or_procedure => equation_or_procedure(inside),
        Rule::if_equation => {
            let branches = branches(&mut inside)?;
            Ok(EquationKind::If { branches, otherwise: list(&mut inside)? })
        }
        Rule::for_equation => {
            let indices = expression::for_indices(&mut inside)?;
            Ok(EquationKind::For { indices, body: list(&mut inside)? })
        }
        Rule::when_equation => Ok(EquationKind::When { branches: branches(&mut inside)? }),
        _ => {
            let left = expression::reference(&mut inside)?;
            Ok(EquationKind::Connect { left, right: expression::reference(&mut inside)? })
        }
    }
}

fn branches(inside: &mut Nodes<'_>) -> Lowered<Vec<(Expression, Vec<Equation>)>> {
    let mut branches = Vec::new();
    while let Some(condition) = expression::try_expression(inside)? {
        branches.push((condition, list(inside)?));
    }
    Ok(branches)
}

fn list(inside: &mut Nodes<'_>) -> Lowered<Vec<Equation>> {
    match inside.try_enter(Rule::equation_list) {
        Some(mut list) => equations(&mut list),
        None => Ok(Vec::new()),
    }
}

fn equation_or_procedure(mut inside: Nodes<'_>) -> Lowered<EquationKind> {
    let left = expression::expression(&mut inside)?;
    if let Some(right) = expression::try_expression(&mut inside)? {
        return Ok(EquationKind::Equal { left, right });
    }
    if matches!(left.kind, ExpressionKind::Call { .. }) {
        return Ok(EquationKind::Call(left));
    }
    let compares =
        matches!(left.kind, ExpressionKind::Binary { operator: BinaryOperator::Equal, .. });
    let help = match compares {
        true => "write `=`: `==` only compares",
        false => "write `left = right`, or a call such as `assert(...)`",
    };
    Err(fault!(SYNTAX_ERROR, "an equation needs `=`")
        .help(help)
        .labelled(left.span, "this is only an expression"))
}
