//! Definitions and references.

use super::document::Document;
use super::occurrences::{self, Entity, Occurrence};
use super::parsed::Parsed;
use super::recovery;
use super::uri;
use super::workspace::{Documents, Workspace};
use crate::flatten::{ClassId, Declared, Library};
use crate::format::Language;
use crate::name::Ident;
use crate::source::Span;
use crate::syntax::ast::ClassSpecifier;
use lsp_types::{DocumentHighlight, DocumentHighlightKind, Location, Position, TextDocumentItem};
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// Files of a library in which a name is looked for, at most.
const MOST_FILES: usize = 20_000;

/// A name at a position: the document, all its names, and the one.
pub(crate) struct Found {
    /// The document.
    pub parsed: Arc<Parsed>,
    /// Its names.
    pub names: Arc<Vec<Occurrence>>,
    /// The one at the position.
    pub one: Occurrence,
}

/// The name at a position.
pub(crate) fn at(
    workspace: &mut Workspace,
    document: &Arc<Document>,
    all: &Documents,
    position: Position,
) -> Option<Found> {
    let parsed = workspace.open(document, all);
    let names = workspace.names(&parsed);
    let one = occurrences::at(&names, document.offset(position))?.clone();
    Some(Found { parsed, names, one })
}

/// Where a declaration is written; `None` for what is not declared in a text.
pub(crate) fn declaration(library: &Library, declared: Declared) -> Option<Span> {
    match declared {
        Declared::Class(class) => Some(library.definition_of(class).name.span),
        Declared::Component(owner, name) => {
            library.component(owner, name).map(|(_, declaration)| declaration.name.span)
        }
        Declared::Literal(owner, name) => literal(library, owner, name),
        Declared::Predefined(_) => None,
    }
}

fn literal(library: &Library, owner: ClassId, name: Ident) -> Option<Span> {
    let ClassSpecifier::Enumeration(enumeration) = &library.definition_of(owner).specifier else {
        return None;
    };
    let mut literals = enumeration.literals.iter().flatten();
    literals.find(|literal| literal.name.node == name).map(|literal| literal.name.span)
}

/// Where a name is declared.
pub(crate) fn definition(workspace: &mut Workspace, found: &Found) -> Option<Location> {
    let document = &found.parsed.document;
    let here = |range: std::ops::Range<usize>| Location {
        uri: document.uri.clone(),
        range: document.range(range),
    };
    match found.one.entity {
        Entity::Declared(declared) => {
            let span = declaration(workspace.session.library(), declared)?;
            workspace.location(span)
        }
        // The first place where a script assigns it.
        Entity::Loop(_) | Entity::Variable(_) => {
            let first = found.names.iter().find(|one| one.entity == found.one.entity)?;
            Some(here(first.range.clone()))
        }
        Entity::Function(_) => None,
    }
}

/// The places of the same name in its document.
pub(crate) fn highlights(found: &Found) -> Vec<DocumentHighlight> {
    let same = found.names.iter().filter(|one| one.entity == found.one.entity);
    let highlight = |one: &Occurrence| DocumentHighlight {
        range: found.parsed.document.range(one.range.clone()),
        kind: Some(DocumentHighlightKind::TEXT),
    };
    same.map(highlight).collect()
}

/// A document in which a name occurs, with the places.
pub(crate) struct Places {
    /// The document.
    pub document: Arc<Document>,
    /// The places.
    pub names: Vec<Occurrence>,
}

/// All places of a name: in open documents, and in the files of the libraries that they belong to.
pub(crate) fn references(workspace: &mut Workspace, found: &Found, all: &Documents) -> Vec<Places> {
    let same = |names: &[Occurrence]| -> Vec<Occurrence> {
        names.iter().filter(|one| one.entity == found.one.entity).cloned().collect()
    };
    let own = Places { document: found.parsed.document.clone(), names: same(&found.names) };
    let mut places = vec![own];
    if !matches!(found.one.entity, Entity::Declared(_)) {
        return places;
    }
    let text = found.parsed.document.text[found.one.range.clone()].to_owned();
    let mut seen: BTreeSet<PathBuf> = found.parsed.document.path.iter().cloned().collect();
    for document in all.values().filter(|one| one.uri != found.parsed.document.uri) {
        seen.extend(document.path.clone());
        if document.text.contains(&text) {
            let parsed = workspace.open(document, all);
            let names = same(&workspace.names(&parsed));
            places.push(Places { document: document.clone(), names });
        }
    }
    for path in files(workspace, found, all) {
        if seen.insert(path.clone())
            && let Some(one) = in_file(workspace, &path, &text, &same)
        {
            places.push(one);
        }
    }
    places.retain(|one| !one.names.is_empty());
    places
}

/// The folder of the outermost package that a file belongs to, or the folder of the file.
pub(crate) fn root(workspace: &Workspace, path: &Path) -> Option<PathBuf> {
    let folder = path.parent()?;
    let is_package = |one: &&Path| workspace.session.world.exists(&one.join("package.mo"));
    Some(folder.ancestors().take_while(is_package).last().unwrap_or(folder).to_path_buf())
}

/// The Modelica files in the folders that the editor shows, and of the libraries of open documents.
pub(super) fn workspace_files(workspace: &Workspace, all: &Documents) -> Vec<PathBuf> {
    let paths = all.values().filter_map(|one| one.path.clone());
    let own = paths.filter_map(|path| root(workspace, &path));
    let folders: BTreeSet<PathBuf> =
        own.filter(|root| workspace.session.world.exists(&root.join("package.mo"))).collect();
    let shown = workspace.client.folders.iter();
    let mut files = Vec::new();
    for folder in shown.chain(&folders) {
        collect(workspace, folder, true, &mut files);
    }
    files
}

/// The Modelica files of the libraries of the open documents.
fn files(workspace: &Workspace, found: &Found, all: &Documents) -> Vec<PathBuf> {
    let paths = all.values().chain([&found.parsed.document]).filter_map(|one| one.path.clone());
    let roots: BTreeSet<PathBuf> = paths.filter_map(|path| root(workspace, &path)).collect();
    let mut files = Vec::new();
    for root in roots {
        let is_package = workspace.session.world.exists(&root.join("package.mo"));
        collect(workspace, &root, is_package, &mut files);
    }
    files
}

fn collect(workspace: &Workspace, folder: &Path, deep: bool, files: &mut Vec<PathBuf>) {
    let world = &workspace.session.world;
    for name in world.list_dir(folder).unwrap_or_default() {
        let path = folder.join(&name);
        if files.len() >= MOST_FILES {
            return;
        }
        if Language::of_name(&name) == Some(Language::Modelica) {
            files.push(path);
        } else if deep && world.is_dir(&path) && !world.is_link(&path) {
            collect(workspace, &path, deep, files);
        }
    }
}

/// The places in a file that is not open.
fn in_file(
    workspace: &mut Workspace,
    path: &Path,
    text: &str,
    same: &impl Fn(&[Occurrence]) -> Vec<Occurrence>,
) -> Option<Places> {
    let bytes = workspace.session.world.read(path).ok()?;
    memchr::memmem::find(&bytes, text.as_bytes())?;
    let content = crate::syntax::decode(&bytes).0;
    let item = TextDocumentItem {
        uri: uri::of_path(path)?,
        language_id: String::new(),
        version: 0,
        text: content,
    };
    let document = Arc::new(Document::opened(item));
    let source = workspace.session.sources.add(document.name(), document.text.clone());
    let read = recovery::read(source, &document.text, false);
    let parsed = workspace.as_loaded(&document, source, read)?;
    let names = same(&workspace.names_once(&parsed));
    Some(Places { document, names })
}
