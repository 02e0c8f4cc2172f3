//! Code actions: the helps of diagnostics, where they say what to write.

use super::client::Client;
use super::diagnostics::HELP;
use super::document::Document;
use super::occurrences::{identifiers, is_identifier};
use super::parsed::{Parsed, sections};
use crate::diag::suggest;
use crate::syntax::ast::{ClassSpecifier, Section};
use lsp_types::{
    CodeAction, CodeActionKind, CodeActionOrCommand, Diagnostic, NumberOrString, OneOf,
    OptionalVersionedTextDocumentIdentifier, TextDocumentEdit, TextEdit,
};
use std::ops::Range;

/// The actions for some diagnostics of a document.
pub(crate) fn actions(
    client: &Client,
    parsed: &Parsed,
    diagnostics: &[Diagnostic],
) -> Vec<CodeActionOrCommand> {
    let mut found = Vec::new();
    for diagnostic in diagnostics {
        let range = parsed.document.lines.bytes(&parsed.document.text, diagnostic.range);
        for help in diagnostic.message.lines().filter_map(|line| line.strip_prefix(HELP)) {
            found.extend(of_help(client, &parsed.document, diagnostic, (range.clone(), help)));
        }
        if diagnostic.code == Some(NumberOrString::String("unknown-name".to_owned())) {
            found.extend(declarations(client, parsed, diagnostic, range));
        }
    }
    found.into_iter().map(CodeActionOrCommand::CodeAction).collect()
}

fn action(
    client: &Client,
    document: &Document,
    diagnostic: &Diagnostic,
    title: String,
    (range, new_text): (Range<usize>, String),
    is_preferred: bool,
) -> CodeAction {
    let edit = TextEdit { range: document.range(range), new_text };
    let text_document = OptionalVersionedTextDocumentIdentifier {
        uri: document.uri.clone(),
        version: Some(document.version),
    };
    let change = TextDocumentEdit { text_document, edits: vec![OneOf::Left(edit)] };
    CodeAction {
        title,
        kind: Some(CodeActionKind::QUICKFIX),
        diagnostics: Some(vec![diagnostic.clone()]),
        edit: Some(client.edit(vec![change])),
        is_preferred: Some(is_preferred),
        ..CodeAction::default()
    }
}

/// What is in the first backticks of a text.
fn quoted(text: &str) -> Option<&str> {
    text.split('`').nth(1).filter(|inside| !inside.is_empty())
}

/// The action of a help that says what to write.
fn of_help(
    client: &Client,
    document: &Document,
    diagnostic: &Diagnostic,
    (range, help): (Range<usize>, &str),
) -> Option<CodeAction> {
    let suggested = quoted(help)?;
    if help.starts_with("did you mean `") {
        let place = meant(document, range, suggested);
        let title = format!("Change to `{suggested}`");
        return Some(action(
            client,
            document,
            diagnostic,
            title,
            (place, suggested.to_owned()),
            true,
        ));
    }
    let rest = help.strip_prefix("write `")?.strip_prefix(suggested)?.strip_prefix('`')?;
    let title = format!("Write `{suggested}`");
    if rest.starts_with(" here") {
        let blank = if suggested.starts_with(|c: char| c.is_alphanumeric()) { " " } else { "" };
        let written = format!("{blank}{suggested}");
        return Some(action(
            client,
            document,
            diagnostic,
            title,
            (range.end..range.end, written),
            true,
        ));
    }
    let is_replacement = rest.is_empty() || rest.starts_with(": ") || rest.starts_with(" to ");
    is_replacement
        .then(|| action(client, document, diagnostic, title, (range, suggested.to_owned()), true))
}

/// The part of what is marked that a suggestion replaces: all for a dotted one, else the identifier
/// that is most like it.
fn meant(document: &Document, range: Range<usize>, suggested: &str) -> Range<usize> {
    if suggested.contains('.') {
        return range;
    }
    let parts = identifiers(&document.text, range.clone());
    let identifiers_there: Vec<&str> =
        parts.iter().map(|part| &document.text[part.clone()]).collect();
    let nearest = suggest::nearest(suggested, identifiers_there.iter().copied());
    let at = nearest.and_then(|nearest| identifiers_there.iter().position(|text| *text == nearest));
    at.map_or(range, |at| parts[at].clone())
}

/// Declarations of a name that nothing declares, before the equations of its class.
fn declarations(
    client: &Client,
    parsed: &Parsed,
    diagnostic: &Diagnostic,
    range: Range<usize>,
) -> Vec<CodeAction> {
    let document = &parsed.document;
    let name = &document.text[range.clone()];
    let Some((_, class)) = parsed.class_at(range.start).filter(|_| is_identifier(name)) else {
        return Vec::new();
    };
    let ClassSpecifier::Long(long) = &class.specifier else { return Vec::new() };
    let behaviour = sections(&class).iter().find_map(|section| match section {
        Section::Equations { span, .. } | Section::Algorithm { span, .. } => Some(span.start),
        Section::Annotation(annotation) => Some(annotation.span.start),
        _ => None,
    });
    let before = behaviour.unwrap_or(long.end_name.span.start) as usize;
    // Of the line that the section begins, or `end`.
    let line = document.lines.line_of(before);
    let start = document.lines.content(&document.text, line).start;
    let head = &document.text[start..before];
    let is_alone = head.trim().is_empty() || head.trim() == "end";
    let place = if is_alone { start } else { before };
    let indent: String = head.chars().take_while(|c| matches!(c, ' ' | '\t')).collect();
    let indent = if head.trim() == "end" || behaviour_is_keyword(&document.text[before..]) {
        indent + "  "
    } else {
        indent
    };
    let declaration = |title: &str, text: String| {
        let text = match is_alone {
            true => format!("{indent}{text}{}", document.line_end()),
            false => format!("{text} "),
        };
        let title = format!("Declare `{name}` as {title}");
        action(client, document, diagnostic, title, (place..place, text), false)
    };
    vec![
        declaration("a Real variable", format!("Real {name};")),
        declaration("a Real parameter", format!("parameter Real {name};")),
    ]
}

/// Whether a text begins with the keyword of a section, which is less indented than declarations.
fn behaviour_is_keyword(text: &str) -> bool {
    ["equation", "algorithm", "initial"].iter().any(|word| text.starts_with(word))
}
