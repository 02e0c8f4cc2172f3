//! The types of scalar expressions of the system.

use super::dae::{Dae, VariableKind};
use crate::flatten::BaseType;
use crate::symbolic::function::ResultType;
use crate::symbolic::{Expr, Node};
use rustc_hash::FxHashSet;

/// Whether the value of an expression is a Real rather than an Integer, Boolean or enumeration.
pub(crate) fn is_real(dae: &Dae, e: Expr) -> bool {
    let (mut open, mut seen) = (vec![e], FxHashSet::default());
    while let Some(e) = open.pop() {
        if !seen.insert(e) {
            continue;
        }
        match dae.pool.node(e) {
            Node::Constant(number) if number.0.fract() != 0.0 => return true,
            Node::Variable(v) => {
                let variable = dae.variable(*v);
                if variable.base == BaseType::Real && variable.kind != VariableKind::Frozen {
                    return true;
                }
            }
            Node::Div(..) | Node::Pow(..) => return true,
            Node::Apply(id, arguments) => match id.get().result {
                ResultType::Real if id.get().event_generating => {}
                ResultType::Real => return true,
                ResultType::Integer => {}
                ResultType::AsArguments => open.extend(arguments.iter()),
            },
            Node::Neg(a) => open.push(*a),
            Node::Add(a, b) | Node::Sub(a, b) | Node::Mul(a, b) => open.extend([*a, *b]),
            Node::If(_, a, b) => open.extend([*a, *b]),
            _ => {}
        }
    }
    false
}

/// Whether the value of an expression is Boolean.
pub(in crate::lower) fn is_boolean(dae: &Dae, e: Expr) -> bool {
    match dae.pool.node(e) {
        Node::Variable(v) => dae.variable(*v).base == BaseType::Boolean,
        Node::Relation(..) | Node::And(..) | Node::Or(..) | Node::Not(..) => true,
        Node::If(_, a, _) => is_boolean(dae, *a),
        _ => false,
    }
}

/// Whether the value of an expression is an Integer.
pub(in crate::lower) fn is_whole(dae: &Dae, e: Expr) -> bool {
    match dae.pool.node(e) {
        Node::Variable(v) => dae.variable(*v).base == BaseType::Integer,
        Node::Constant(number) => number.0.fract() == 0.0,
        _ => !is_real(dae, e),
    }
}
