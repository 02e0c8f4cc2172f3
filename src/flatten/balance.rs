//! Compares the number of equations with that of unknowns (MLS §4.8).

use super::errors::UNBALANCED_MODEL;
use super::{FlatModel, Variability};
use crate::diag::Diagnostic;
use crate::fault;
use crate::source::Span;
use crate::syntax::ast::{
    CausalityPrefix, ComponentReference, Equation, EquationKind, Expression, ExpressionKind,
    Statement, StatementKind,
};
use std::collections::BTreeSet;

/// An error if the numbers differ. Where the size of an equation cannot be told from its text, the
/// model is left to the matching of equations and unknowns.
pub(super) fn check(model: &FlatModel) -> Result<(), Diagnostic> {
    let unknowns: usize = model
        .variables
        .values()
        .filter(|variable| {
            variable.variability >= Variability::Discrete
                && variable.causality != Some(CausalityPrefix::Input)
        })
        .map(super::Variable::len)
        .sum();
    let bindings = model.variables.values().filter(|variable| {
        variable.variability >= Variability::Discrete
            && variable.causality != Some(CausalityPrefix::Input)
            && variable.binding.is_some()
    });
    let mut equations: usize = bindings.map(super::Variable::len).sum();
    for equation in &model.equations {
        match size(equation, model) {
            Some(count) => equations += count,
            None => return Ok(()),
        }
    }
    let mut assigned = BTreeSet::new();
    for statements in &model.algorithms {
        targets(statements, &mut assigned);
    }
    equations += assigned
        .iter()
        .filter_map(|name| model.variables.get(name.as_str()))
        .map(super::Variable::len)
        .sum::<usize>();
    if equations == unknowns {
        return Ok(());
    }
    let name = &model.name;
    let (few, many) = (plural(unknowns, "unknown"), plural(equations, "equation"));
    let fault = if equations < unknowns {
        fault!(UNBALANCED_MODEL, "`{name}` has {few} but {many}";
            help: "add the equations that are missing, or give variables a binding")
    } else {
        fault!(UNBALANCED_MODEL, "`{name}` has {few} but {many}";
            help: "remove equations, or declare the unknowns that they determine")
    };
    Err(fault.at(model.span.unwrap_or(Span::NONE)))
}

fn plural(count: usize, noun: &str) -> String {
    format!("{count} {noun}{}", if count == 1 { "" } else { "s" })
}

/// Number of scalar equations; `None` if it cannot be told from the text.
fn size(equation: &Equation, model: &FlatModel) -> Option<usize> {
    match &equation.kind {
        EquationKind::Equal { left, right } => match (dims(left, model), dims(right, model)) {
            (Some(dims), _) | (None, Some(dims)) => Some(dims.iter().product()),
            (None, None) => None,
        },
        EquationKind::If { branches, .. } => {
            branches.first().and_then(|(_, body)| sum(body, model))
        }
        EquationKind::When { branches } => branches.first().and_then(|(_, body)| sum(body, model)),
        EquationKind::Call(_) => Some(0),
        EquationKind::For { .. } | EquationKind::Connect { .. } => None,
    }
}

fn sum(equations: &[Equation], model: &FlatModel) -> Option<usize> {
    equations.iter().map(|equation| size(equation, model)).sum()
}

/// The sizes of an expression where its text shows them.
fn dims(e: &Expression, model: &FlatModel) -> Option<Vec<usize>> {
    match &e.kind {
        ExpressionKind::Real(_) | ExpressionKind::Integer(_) | ExpressionKind::Boolean(_) => {
            Some(Vec::new())
        }
        ExpressionKind::Reference(reference) => reference_dims(reference, model),
        ExpressionKind::Call { function, arguments } if function.as_ident()? == "der" => {
            dims(arguments.positional.first()?, model)
        }
        ExpressionKind::Unary { operand, .. } => dims(operand, model),
        ExpressionKind::Array(elements) => {
            let mut sizes = dims(elements.first()?, model)?;
            sizes.insert(0, elements.len());
            Some(sizes)
        }
        _ => None,
    }
}

fn reference_dims(reference: &ComponentReference, model: &FlatModel) -> Option<Vec<usize>> {
    if reference.as_ident().is_some_and(|name| name == "time") {
        return Some(Vec::new());
    }
    let last = reference.parts.last()?;
    let variable = model.variables.get(path(reference).as_str())?;
    if last.subscripts.is_empty() {
        return Some(variable.dims.clone());
    }
    let scalar = last.subscripts.iter().all(|subscript| {
        matches!(
            subscript,
            crate::syntax::ast::Subscript::Index(Expression {
                kind: ExpressionKind::Integer(_),
                ..
            })
        )
    });
    let all = last.subscripts.len() == variable.dims.len();
    (scalar && all).then(Vec::new)
}

/// The name of the variable that a flat reference names, without the last subscripts.
pub(super) fn path(reference: &ComponentReference) -> String {
    let mut path = String::new();
    for (at, part) in reference.parts.iter().enumerate() {
        if at > 0 {
            path.push('.');
        }
        path.push_str(part.name.as_str());
        if at + 1 < reference.parts.len() && !part.subscripts.is_empty() {
            let texts: Vec<String> = part
                .subscripts
                .iter()
                .map(|subscript| match subscript {
                    crate::syntax::ast::Subscript::Index(Expression {
                        kind: ExpressionKind::Integer(n),
                        ..
                    }) => n.to_string(),
                    _ => ":".to_owned(),
                })
                .collect();
            path.push_str(&format!("[{}]", texts.join(",")));
        }
    }
    path
}

fn targets(statements: &[Statement], out: &mut BTreeSet<String>) {
    for statement in statements {
        match &statement.kind {
            StatementKind::Assign { target, .. } => {
                out.insert(path(target));
            }
            StatementKind::MultiAssign { targets, .. } => {
                out.extend(targets.iter().flatten().map(path));
            }
            StatementKind::If { branches, otherwise } => {
                branches.iter().for_each(|(_, body)| targets(body, out));
                targets(otherwise, out);
            }
            StatementKind::For { body, .. } | StatementKind::While { body, .. } => {
                targets(body, out);
            }
            StatementKind::When { branches } => {
                branches.iter().for_each(|(_, body)| targets(body, out));
            }
            StatementKind::Call(_) | StatementKind::Break | StatementKind::Return => {}
        }
    }
}
