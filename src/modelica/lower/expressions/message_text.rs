//! The wording of messages.

use super::{Lowered, Lowering, StringPart, Target};
use crate::lower::shape::UNKNOWN_TEXT;
use crate::syntax::ast::{Arguments, BinaryOperator, Expression, ExpressionKind};

/// The text of a message as far as it is known when compiling.
pub(crate) fn message_text<T: Target>(
    lowering: &mut Lowering<'_, T>,
    e: Option<&Expression>,
) -> String {
    let Some(e) = e else { return String::new() };
    let text = match &e.kind {
        ExpressionKind::String(text) => return text.to_string(),
        ExpressionKind::Binary { operator: BinaryOperator::Add, .. } => {
            return terms(e).map(|term| message_text(lowering, Some(term))).collect();
        }
        ExpressionKind::Call { function, .. }
            if function.as_ident().is_some_and(|name| name == "String") =>
        {
            lowering.lower(e)
        }
        ExpressionKind::Reference(_) | ExpressionKind::Subscripted { .. } => lowering.lower(e),
        _ => return UNKNOWN_TEXT.into(),
    };
    match text {
        Ok(Lowered::Text(text)) => text.to_string(),
        _ => UNKNOWN_TEXT.into(),
    }
}

fn terms(e: &Expression) -> impl Iterator<Item = &Expression> {
    e.operands_of(|operator| operator == BinaryOperator::Add)
}

/// The parts of a message: what is known at translation, and how values that are not are written.
pub(crate) fn message_parts<T: Target>(
    lowering: &mut Lowering<'_, T>,
    e: Option<&Expression>,
) -> Vec<StringPart<T::Scalar>> {
    let mut parts = Vec::new();
    if let Some(e) = e {
        collect(lowering, e, &mut parts);
    }
    parts
}

fn collect<T: Target>(
    lowering: &mut Lowering<'_, T>,
    e: &Expression,
    parts: &mut Vec<StringPart<T::Scalar>>,
) {
    if let ExpressionKind::Binary { operator: BinaryOperator::Add, .. } = &e.kind {
        terms(e).for_each(|term| collect(lowering, term, parts));
        return;
    }
    let text = message_text(lowering, Some(e));
    let part = match text.contains(UNKNOWN_TEXT) {
        true => varying_part(lowering, e),
        false => None,
    };
    parts.push(part.unwrap_or_else(|| StringPart::Text(text.into())));
}

/// A part that is known during the simulation only. Calls are not made for the sake of a message.
fn varying_part<T: Target>(
    lowering: &mut Lowering<'_, T>,
    e: &Expression,
) -> Option<StringPart<T::Scalar>> {
    let text = match &e.kind {
        ExpressionKind::Call { function, arguments } => {
            let is_string = function.as_ident().is_some_and(|name| name == "String");
            return if is_string { lowering.number_part(arguments).ok()? } else { None };
        }
        ExpressionKind::If { .. } if lowering.target.composes() => lowering.run_time_string(e),
        ExpressionKind::Reference(_) | ExpressionKind::Subscripted { .. } => {
            match lowering.target.composes() {
                true => lowering.composing(|own| own.lower(e)),
                false => lowering.lower(e),
            }
        }
        _ => return None,
    };
    match text {
        Ok(Lowered::Numbered(number)) => Some(StringPart::Numbered(number)),
        Ok(Lowered::Text(text)) => Some(StringPart::Text(text)),
        _ => None,
    }
}

/// An argument by its position or its name.
pub(crate) fn nth<'a>(
    arguments: &'a Arguments,
    position: usize,
    name: &str,
) -> Option<&'a Expression> {
    let named = arguments.named.iter().find(|a| a.name.node == name).map(|a| &a.value);
    arguments.positional.get(position).or(named)
}
