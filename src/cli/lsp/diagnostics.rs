//! Diagnostics as editors show them: message, code and helps of `gapi check`.

use super::parsed::Parsed;
use crate::diag::{Diagnostic, Severity};
use crate::source::Span;
use lsp_types::{
    DiagnosticRelatedInformation, DiagnosticSeverity, Location, NumberOrString, Range,
};
use std::ops;

/// What precedes an action in a message.
pub(crate) const HELP: &str = "help: ";

/// A diagnostic of a document; `location` says where a span is in the protocol.
pub(crate) fn of(
    parsed: &Parsed,
    diagnostic: &Diagnostic,
    location: impl Fn(Span) -> Option<Location>,
) -> lsp_types::Diagnostic {
    let own = diagnostic.labels.iter().find(|label| label.span.source == parsed.source);
    let bytes = own.map_or_else(|| around(parsed), |label| shown(parsed, label.span));
    let range = parsed.document.range(bytes);
    let helps = diagnostic.helps.iter().map(|help| format!("\n{HELP}{help}"));
    let message = diagnostic.message.clone() + &helps.collect::<String>();
    lsp_types::Diagnostic {
        range,
        severity: Some(match diagnostic.severity {
            Severity::Error => DiagnosticSeverity::ERROR,
            Severity::Warning => DiagnosticSeverity::WARNING,
            Severity::Note => DiagnosticSeverity::INFORMATION,
        }),
        code: Some(NumberOrString::String(diagnostic.code.slug.to_owned())),
        source: Some("gapi".to_owned()),
        message,
        related_information: related(parsed, diagnostic, (range, location)),
        ..lsp_types::Diagnostic::default()
    }
}

/// The bytes that are marked: something that can be seen.
fn shown(parsed: &Parsed, span: Span) -> ops::Range<usize> {
    let text = &parsed.document.text;
    let (start, end) = (span.start as usize, (span.end as usize).min(text.len()));
    if start < end {
        // Of a whole class its first line is enough.
        let first = text[start..end].lines().next().map_or(0, |line| line.trim_end().len());
        return start..start + first.max(1);
    }
    // A place between two tokens: the one before it.
    let head = text.get(..start.min(text.len())).unwrap_or_default().trim_end();
    let last = head.char_indices().next_back().map_or(0, |(at, _)| at);
    last..head.len()
}

/// Where something is marked that is wrong elsewhere: the name of the first class.
fn around(parsed: &Parsed) -> ops::Range<usize> {
    match parsed.classes().first() {
        Some(class) => class.name.span.start as usize..class.name.span.end as usize,
        None => 0..0,
    }
}

/// The other places of a diagnostic.
fn related(
    parsed: &Parsed,
    diagnostic: &Diagnostic,
    (own, location): (Range, impl Fn(Span) -> Option<Location>),
) -> Option<Vec<DiagnosticRelatedInformation>> {
    let labels = diagnostic.labels.iter().map(|label| (label.span, label.text.as_str()));
    let calls = diagnostic.trace.iter().map(|frame| (frame.span, frame.what.as_str()));
    let found: Vec<DiagnosticRelatedInformation> = labels
        .chain(calls)
        .filter_map(|(span, text)| {
            let location = location(span)?;
            let is_own = span.source == parsed.source && location.range.start == own.start;
            let message = if text.is_empty() { "here".to_owned() } else { text.to_owned() };
            (!is_own).then_some(DiagnosticRelatedInformation { location, message })
        })
        .collect();
    (!found.is_empty()).then_some(found)
}
