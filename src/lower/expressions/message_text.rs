//! Texts of messages.

use super::{Lowered, Lowering, Target};
use crate::lower::shape::UNKNOWN_TEXT;
use crate::syntax::ast::{BinaryOperator, Expression, ExpressionKind};

/// The text of a message as far as it is known when compiling.
pub(crate) fn message_text<T: Target>(
    lowering: &mut Lowering<'_, T>,
    e: Option<&Expression>,
) -> String {
    let Some(e) = e else { return String::new() };
    let text = match &e.kind {
        ExpressionKind::String(text) => return text.to_string(),
        ExpressionKind::Binary { operator: BinaryOperator::Add, left, right } => {
            return message_text(lowering, Some(left)) + &message_text(lowering, Some(right));
        }
        ExpressionKind::Call { function, .. }
            if function.as_ident().is_some_and(|name| name == "String") =>
        {
            lowering.lower(e)
        }
        ExpressionKind::Reference(_) => lowering.lower(e),
        _ => return UNKNOWN_TEXT.into(),
    };
    match text {
        Ok(Lowered::Text(text)) => text.to_string(),
        _ => UNKNOWN_TEXT.into(),
    }
}
