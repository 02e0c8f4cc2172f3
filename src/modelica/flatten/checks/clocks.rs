//! Which expressions are clocks, as far as a class tells by itself (MLS §16.3).

use super::scope::Scope;
use crate::flatten::lookup::types::Predefined;
use crate::functions::{self, Clocked, Operator, Temporal};
use crate::syntax::ast::{Expression, ExpressionKind};

/// Whether an expression is a clock: a component that is one, a constructor or a conversion.
pub(crate) fn is_clock(class: Scope<'_>, e: &Expression) -> bool {
    match &e.kind {
        ExpressionKind::Reference(reference) => {
            let component = class.component_at(reference);
            component.and_then(|c| c.predefined()) == Some(Predefined::Clock)
        }
        ExpressionKind::Call { function, arguments } => {
            let [name] = function.parts.as_slice() else { return false };
            match functions::operator(name.name.as_str()) {
                Some(Operator::InTime(Temporal::Clocked(Clocked::Constructor))) => true,
                Some(Operator::InTime(Temporal::Clocked(_))) => {
                    arguments.positional.first().is_some_and(|u| is_clock(class, u))
                }
                _ => false,
            }
        }
        ExpressionKind::If { otherwise, .. } => is_clock(class, otherwise),
        _ => false,
    }
}
