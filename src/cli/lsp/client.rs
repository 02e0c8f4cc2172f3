//! What the client of a session understands, and where libraries are searched for its workspace.

use super::uri;
use lsp_types::{
    ClientCapabilities, Documentation, HoverContents, InitializeParams, MarkupContent, MarkupKind,
    TextDocumentEdit, WorkspaceEdit,
};
use lsp_types::{DocumentChanges, OneOf, TextEdit, Uri};
use serde_json::Value;
use std::collections::HashMap;
use std::path::PathBuf;

/// What was said when the connection began.
#[derive(Debug, Clone, Default)]
pub struct Client {
    /// Folders with libraries, besides those of the command line: `initializationOptions.libraries`.
    pub libraries: Vec<PathBuf>,
    /// The folders that the editor shows.
    pub folders: Vec<PathBuf>,
    /// Hovers may be Markdown.
    markdown_hover: bool,
    /// Documentation of completions may be Markdown; `None` if it has to be a string.
    markdown_completion: Option<bool>,
    /// Changes may name versions of documents.
    versioned_changes: bool,
    /// Outlines may be trees.
    pub(crate) nested_outline: bool,
    /// Work that takes long may be announced.
    pub(crate) progress: bool,
}

impl Client {
    /// The client that sends these parameters.
    pub fn of(params: &InitializeParams) -> Client {
        let folders = params.initialization_options.as_ref().and_then(|all| all.get("libraries"));
        let folders = folders.and_then(Value::as_array).into_iter().flatten();
        let libraries = folders.filter_map(Value::as_str).map(PathBuf::from).collect();
        let all = &params.capabilities;
        Client {
            libraries,
            folders: folders_of(params),
            markdown_hover: hover_formats(all).is_some_and(is_markdown),
            markdown_completion: completion_formats(all).map(is_markdown),
            versioned_changes: versioned_changes(all).unwrap_or(false),
            nested_outline: nested_outline(all).unwrap_or(false),
            progress: all.window.as_ref().and_then(|own| own.work_done_progress).unwrap_or(false),
        }
    }

    /// A text for a hover.
    pub(super) fn hover(&self, markdown: String) -> HoverContents {
        HoverContents::Markup(markup(self.markdown_hover, markdown))
    }

    /// A text for a completion.
    pub(super) fn documentation(&self, markdown: String) -> Documentation {
        match self.markdown_completion {
            Some(is_markdown) => Documentation::MarkupContent(markup(is_markdown, markdown)),
            None => Documentation::String(markup(false, markdown).value),
        }
    }

    /// Changes of documents.
    pub(super) fn edit(&self, changes: Vec<TextDocumentEdit>) -> WorkspaceEdit {
        if self.versioned_changes {
            let document_changes = Some(DocumentChanges::Edits(changes));
            return WorkspaceEdit { document_changes, ..WorkspaceEdit::default() };
        }
        #[allow(clippy::mutable_key_type, reason = "the type of the protocol")]
        let mut by_name: HashMap<Uri, Vec<TextEdit>> = HashMap::new();
        for change in changes {
            let edits = change.edits.into_iter().map(|edit| match edit {
                OneOf::Left(edit) => edit,
                OneOf::Right(annotated) => annotated.text_edit,
            });
            by_name.entry(change.text_document.uri).or_default().extend(edits);
        }
        WorkspaceEdit { changes: Some(by_name), ..WorkspaceEdit::default() }
    }
}

/// The folders of the workspace, or the one that older editors know.
fn folders_of(params: &InitializeParams) -> Vec<PathBuf> {
    let several = params.workspace_folders.iter().flatten().map(|folder| &folder.uri);
    let folders: Vec<PathBuf> = several.filter_map(uri::path).collect();
    #[allow(deprecated, reason = "editors that know no workspace folders send it")]
    let single = params.root_uri.as_ref().and_then(uri::path);
    if folders.is_empty() { single.into_iter().collect() } else { folders }
}

fn is_markdown(formats: &[MarkupKind]) -> bool {
    formats.contains(&MarkupKind::Markdown)
}

fn hover_formats(all: &ClientCapabilities) -> Option<&[MarkupKind]> {
    all.text_document.as_ref()?.hover.as_ref()?.content_format.as_deref()
}

fn completion_formats(all: &ClientCapabilities) -> Option<&[MarkupKind]> {
    let completion = all.text_document.as_ref()?.completion.as_ref()?;
    completion.completion_item.as_ref()?.documentation_format.as_deref()
}

fn versioned_changes(all: &ClientCapabilities) -> Option<bool> {
    all.workspace.as_ref()?.workspace_edit.as_ref()?.document_changes
}

fn nested_outline(all: &ClientCapabilities) -> Option<bool> {
    all.text_document.as_ref()?.document_symbol.as_ref()?.hierarchical_document_symbol_support
}

/// A text as Markdown, or without its fences.
fn markup(is_markdown: bool, markdown: String) -> MarkupContent {
    if is_markdown {
        return MarkupContent { kind: MarkupKind::Markdown, value: markdown };
    }
    let lines = markdown.lines().filter(|line| !line.starts_with("```"));
    let value = lines.collect::<Vec<_>>().join("\n");
    MarkupContent { kind: MarkupKind::PlainText, value }
}
