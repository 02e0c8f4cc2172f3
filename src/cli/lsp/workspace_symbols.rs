//! Classes of the workspace by parts of their names.

use super::document::Document;
use super::navigation;
use super::outline;
use super::parsed::Parsed;
use super::recovery;
use super::uri;
use super::workspace::{Documents, Workspace};
use lsp_types::{SymbolInformation, SymbolKind, TextDocumentItem};
use std::collections::BTreeSet;
use std::path::Path;
use std::sync::Arc;

/// Symbols in an answer, at most.
const MOST: usize = 256;

/// The classes whose names contain the query, in whatever case: of open documents, and of the files in
/// the folders that the editor shows and in the libraries of open documents.
pub(crate) fn symbols(
    workspace: &mut Workspace,
    all: &Documents,
    query: &str,
) -> Vec<SymbolInformation> {
    let query = query.to_lowercase();
    let mut found = Vec::new();
    let mut seen = BTreeSet::new();
    for document in all.values() {
        seen.extend(document.path.clone());
        let parsed = workspace.open(document, all);
        found.extend(of(&parsed, &query));
    }
    for path in navigation::workspace_files(workspace, all) {
        if found.len() >= MOST {
            break;
        }
        if seen.insert(path.clone())
            && let Some(parsed) = read(workspace, &path, &query)
        {
            found.extend(of(&parsed, &query));
        }
    }
    found.truncate(MOST);
    found
}

/// A file whose text contains the query.
fn read(workspace: &Workspace, path: &Path, query: &str) -> Option<Parsed> {
    let bytes = workspace.session.world.read(path).ok()?;
    let text = crate::syntax::decode(&bytes).0;
    if !text.to_lowercase().contains(query) {
        return None;
    }
    let uri = uri::of_path(path)?;
    let item = TextDocumentItem { uri, language_id: String::new(), version: 0, text };
    let document = Arc::new(Document::opened(item));
    // Only its names are read: the session does not keep the text.
    let source = crate::source::SourceId::NONE;
    let tree = recovery::read(source, &document.text, false).tree;
    Some(Parsed { document, source, tree, errors: Vec::new(), names: Vec::new() })
}

fn of(parsed: &Parsed, query: &str) -> Vec<SymbolInformation> {
    let document = &parsed.document;
    let within = outline::package(parsed);
    let mut symbols = outline::flat(document, outline::symbols(parsed));
    symbols.retain(|symbol| {
        let is_component = [SymbolKind::FIELD, SymbolKind::CONSTANT, SymbolKind::VARIABLE];
        !is_component.contains(&symbol.kind) && symbol.name.to_lowercase().contains(query)
    });
    for symbol in symbols.iter_mut().filter(|symbol| symbol.container_name.is_none()) {
        symbol.container_name.clone_from(&within);
    }
    symbols
}
