//! Where users look for what is wrong with a model: what they wrote, not what was made of it.

use crate::diag::Diagnostic;
use crate::errors::FILE_ERROR;
use crate::flatten::FlatModel;
use crate::source::{SourceId, Span};
use crate::syntax::ast::{Expression, ExpressionKind};
use std::sync::Arc;

/// The diagnostic at the place of the call, if it has none of its own.
pub(super) fn placed(diagnostic: Diagnostic, call: Span) -> Diagnostic {
    if diagnostic.span().is_known() || !diagnostic.is_error() {
        return diagnostic;
    }
    diagnostic.moved_to(call)
}

/// What is wrong with the text of a class and its modification: at the call that gave it, if there
/// is one, and in it.
pub(super) fn in_argument(error: Diagnostic, text: SourceId, call: Span) -> Diagnostic {
    match error.span().source == text && call.is_known() {
        true => error.seen_from(call, "in this argument"),
        false => error,
    }
}

/// The Strings that a model gives its parameters, and where.
pub(super) fn strings(flat: &FlatModel) -> Vec<(Arc<str>, Span)> {
    let bindings = flat.variables.values().filter_map(|variable| variable.binding.as_ref());
    let text = |binding: &Expression| match &binding.kind {
        ExpressionKind::String(text) => Some((text.clone(), binding.span)),
        _ => None,
    };
    bindings.filter_map(text).collect()
}

/// A file that is not there: at the String that names it, not in the library that reads it.
pub(super) fn where_named(error: Diagnostic, strings: &[(Arc<str>, Span)]) -> Diagnostic {
    let is_named = |text: &str| error.message.contains(&format!("`{text}`"));
    let named = strings.iter().find(|(text, place)| place.is_known() && is_named(text));
    match named {
        Some((_, place)) if error.code == FILE_ERROR => error.moved_to(*place),
        _ => error,
    }
}
