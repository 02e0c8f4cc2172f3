//! Which expressions of a flat model are clocks (MLS §16.3).

use crate::flatten::{BaseType, FlatModel};
use crate::functions::{self, Clocked, Operator, Temporal};
use crate::syntax::ast::{ComponentReference, Expression, ExpressionKind, Subscript};

/// Whether an expression is a clock rather than a Boolean.
pub(in crate::lower) fn is_clock(flat: &FlatModel, e: &Expression) -> bool {
    match &e.kind {
        ExpressionKind::Reference(reference) => {
            let variable = flat.variables.get(path(reference).as_str());
            variable.is_some_and(|variable| variable.base == BaseType::Clock)
        }
        ExpressionKind::Call { function, arguments } => {
            let name = function.name().to_string();
            match functions::operator(&name) {
                Some(Operator::InTime(Temporal::Clocked(Clocked::Constructor))) => true,
                Some(Operator::InTime(Temporal::Clocked(_))) => {
                    arguments.positional.first().is_some_and(|u| is_clock(flat, u))
                }
                _ => false,
            }
        }
        ExpressionKind::If { otherwise, .. } => is_clock(flat, otherwise),
        _ => false,
    }
}

/// The flat name without the last part's subscripts; those of the others are literals.
fn path(reference: &ComponentReference) -> String {
    let mut path = String::new();
    for (at, part) in reference.parts.iter().enumerate() {
        if at > 0 {
            path.push('.');
        }
        path.push_str(part.name.as_str());
        if part.subscripts.is_empty() || at + 1 == reference.parts.len() {
            continue;
        }
        let indices = part.subscripts.iter().map(|subscript| match subscript {
            Subscript::Index(Expression { kind: ExpressionKind::Integer(n), .. }) => n.to_string(),
            _ => String::new(),
        });
        path.push_str(&format!("[{}]", indices.collect::<Vec<_>>().join(",")));
    }
    path
}
