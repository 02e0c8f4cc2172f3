//! Open documents: what the editor shows, whether it is saved or not.

use super::lines::Lines;
use super::uri;
use crate::format::Language;
use lsp_types::{TextDocumentContentChangeEvent, TextDocumentItem, Uri};
use std::ops;
use std::path::PathBuf;
use std::sync::Arc;

/// One version of a document.
#[derive(Debug, Clone)]
pub struct Document {
    /// Its name in the protocol, as the editor writes it.
    pub uri: Uri,
    /// The number of this version.
    pub version: i32,
    /// What it is.
    pub language: Language,
    /// Its file; `None` for one that was never saved.
    pub path: Option<PathBuf>,
    /// The text.
    pub text: Arc<str>,
    /// Its lines.
    pub lines: Lines,
}

impl Document {
    /// A document that the editor opens. What its name does not say, the language that the editor
    /// states does.
    pub fn opened(item: TextDocumentItem) -> Document {
        let path = uri::path(&item.uri);
        let name = path.as_ref().map_or_else(
            || item.uri.as_str().to_owned(),
            |path| path.to_string_lossy().into_owned(),
        );
        let stated = match item.language_id.as_str() {
            "modelica-script" | "mos" => Language::Script,
            _ => Language::Modelica,
        };
        let language = Language::of_name(&name).unwrap_or(stated);
        Document::new(item.uri, path, language, item.version, item.text)
    }

    fn new(
        uri: Uri,
        path: Option<PathBuf>,
        language: Language,
        version: i32,
        text: String,
    ) -> Document {
        let lines = Lines::of(&text);
        Document { uri, version, language, path, text: text.into(), lines }
    }

    /// The next version: the changes one after the other.
    #[must_use]
    pub fn changed(&self, version: i32, changes: Vec<TextDocumentContentChangeEvent>) -> Document {
        let mut text = self.text.to_string();
        let mut lines = self.lines.clone();
        for change in changes {
            match change.range {
                Some(range) => {
                    let bytes = lines.bytes(&text, range);
                    text.replace_range(bytes, &change.text);
                }
                None => text = change.text,
            }
            lines = Lines::of(&text);
        }
        Document { version, text: text.into(), lines, ..self.clone() }
    }

    /// Whether it is a script.
    pub fn is_script(&self) -> bool {
        self.language == Language::Script
    }

    /// Whether it is a file of TOML, of which only problems are read.
    pub(crate) fn is_toml(&self) -> bool {
        self.uri.as_str().ends_with(".toml")
    }

    /// Whether its file is one of classes.
    pub(crate) fn is_modelica(&self) -> bool {
        self.uri.as_str().ends_with(".mo")
    }

    /// Whether it is a problem file: one with an experiment.
    pub fn is_problem(&self) -> bool {
        let mut lines = self.text.lines();
        let is_head = |line: &str| {
            let words: String = line.split_whitespace().collect();
            words.starts_with("[[experiment]]")
        };
        self.is_toml() && lines.any(is_head)
    }

    /// The name that is shown in messages.
    pub fn name(&self) -> String {
        match &self.path {
            Some(path) => path.display().to_string(),
            None => self.uri.as_str().to_owned(),
        }
    }

    /// How its lines end.
    pub fn line_end(&self) -> &'static str {
        if self.text.contains("\r\n") { "\r\n" } else { "\n" }
    }

    /// The range of some bytes.
    pub fn range(&self, bytes: ops::Range<usize>) -> lsp_types::Range {
        self.lines.range(&self.text, bytes)
    }

    /// The byte of a position.
    pub fn offset(&self, position: lsp_types::Position) -> usize {
        self.lines.offset(&self.text, position)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use lsp_types::{Position, Range};

    fn document(uri: &str, language: &str, text: &str) -> Document {
        Document::opened(TextDocumentItem {
            uri: uri.parse().expect("a name"),
            language_id: language.to_owned(),
            version: 1,
            text: text.to_owned(),
        })
    }

    #[test]
    fn changes_apply_one_after_the_other() {
        let opened =
            document("file:///a/M.mo", "modelica", "model M\r\n  Real \u{1f600};\r\nend M;\r\n");
        let change = |line: u32, from: u32, to: u32, text: &str| TextDocumentContentChangeEvent {
            range: Some(Range {
                start: Position { line, character: from },
                end: Position { line, character: to },
            }),
            range_length: None,
            text: text.to_owned(),
        };
        let changed = opened.changed(2, vec![change(1, 7, 9, "x"), change(1, 8, 8, "y")]);
        assert_eq!(&*changed.text, "model M\r\n  Real xy;\r\nend M;\r\n");
        assert_eq!(changed.version, 2);
        let outside = changed.changed(3, vec![change(77, 3, 1, "// end\n")]);
        assert!(outside.text.ends_with("end M;\r\n// end\n"));
    }

    #[test]
    fn the_name_says_the_language_before_the_editor_does() {
        assert!(document("file:///a/run.mos", "modelica", "").is_script());
        assert!(!document("untitled:Untitled-1", "modelica", "").is_script());
        assert!(document("untitled:Untitled-1", "modelica-script", "").is_script());
    }
}
