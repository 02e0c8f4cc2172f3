//! Completion in problem files: the entries that a table may have.

use super::super::document::Document;
use super::plain;
use crate::script::runs::problem;
use lsp_types::{CompletionItem, CompletionItemKind};

/// A name that no entry has.
const PROBE: &str = "entry_that_there_is_not";

/// The entries that may be written at a byte. They are those that the reader of problems names where it
/// finds another one there.
pub(super) fn items(document: &Document, offset: usize) -> Vec<CompletionItem> {
    let text = &document.text;
    let line = document.lines.content(text, document.lines.line_of(offset));
    let Some(before) = text.get(line.start..offset) else { return Vec::new() };
    let is_word = |c: char| c.is_alphanumeric() || c == '_';
    let head = before.trim_end_matches(is_word);
    let probed = match head.trim_end().chars().next_back() {
        None => format!("{head}{PROBE} = 0"),
        // In braces: what follows in them is left out.
        Some('{' | ',') if is_in_braces(head) => {
            let open = head.matches('{').count() - head.matches('}').count();
            format!("{head}{PROBE} = 0{}", "}".repeat(open))
        }
        _ => return Vec::new(),
    };
    let probed = format!("{}{probed}{}", &text[..line.start], &text[line.end..]);
    let entry = |name: String| CompletionItem {
        insert_text: Some(format!("{name} = ")),
        ..plain(&name, CompletionItemKind::PROPERTY, '0')
    };
    problem::entries(&probed).into_iter().map(entry).collect()
}

fn is_in_braces(head: &str) -> bool {
    head.matches('{').count() > head.matches('}').count()
}
