//! Formatting: what `gapi fmt` writes, as changes of lines.

use super::document::Document;
use super::refusal::Refusal;
use crate::format::{self, Failure, diff};
use crate::source::SourceId;
use lsp_types::TextEdit;

/// The changes that format a document; none for one that cannot be read, which its diagnostics say.
///
/// # Errors
/// Formatting would change tokens.
pub(crate) fn edits(document: &Document) -> Result<Vec<TextEdit>, Refusal> {
    if document.is_toml() {
        return Ok(Vec::new());
    }
    let text = &*document.text;
    let formatted = match format::format(SourceId::NONE, text, document.language) {
        Ok(formatted) => formatted,
        Err(Failure::Syntax(_)) => return Ok(Vec::new()),
        Err(Failure::Changed) => {
            return Err(Refusal::failed("formatting would change tokens: report it as a fault"));
        }
    };
    let old: Vec<&str> = text.split_inclusive('\n').collect();
    let new: Vec<&str> = formatted.split_inclusive('\n').collect();
    let starts: Vec<usize> = std::iter::once(0)
        .chain(old.iter().scan(0, |at, line| {
            *at += line.len();
            Some(*at)
        }))
        .collect();
    let edit = |change: diff::Change| TextEdit {
        range: document.range(starts[change.old.start]..starts[change.old.end]),
        new_text: new[change.new].concat(),
    };
    Ok(diff::changes(&old, &new).into_iter().map(edit).collect())
}
