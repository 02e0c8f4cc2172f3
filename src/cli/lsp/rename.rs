//! Renaming: all places that write the name, in the document and in the other files of its library.

use super::navigation::{self, Found, Places};
use super::occurrences::{Entity, is_identifier};
use super::refusal::Refusal;
use super::workspace::{Documents, Workspace};
use crate::flatten::Declared;
use crate::name::{Ident, Name};
use lsp_types::{
    OneOf, OptionalVersionedTextDocumentIdentifier, TextDocumentEdit, TextEdit, WorkspaceEdit,
};

/// Refuses what cannot be renamed: what is not declared in the workspace, and names that other
/// elements must share.
///
/// # Errors
/// Why it cannot.
pub(crate) fn check(
    workspace: &mut Workspace,
    found: &Found,
    all: &Documents,
) -> Result<(), Refusal> {
    let Entity::Declared(declared) = found.one.entity else {
        return match found.one.entity {
            Entity::Function(name) => {
                Err(Refusal::failed(format!("`{name}` is part of the language")))
            }
            _ => Ok(()),
        };
    };
    if let Declared::Predefined(name) = declared {
        return Err(Refusal::failed(format!("`{name}` is part of the language")));
    }
    if let Declared::Component(owner, name) = declared
        && let Some((clause, _)) = workspace.session.library().component(owner, name)
        && (clause.prefixes.inner || clause.prefixes.outer)
    {
        return Err(Refusal::failed(format!(
            "`{name}` is an inner or outer component: its name is shared by other classes"
        )));
    }
    if let Declared::Class(class) = declared
        && is_named_by_file(workspace, class)
    {
        let name = workspace.session.library().name_of(class).to_string();
        return Err(Refusal::failed(format!(
            "`{name}` has the name of its file or folder: rename the file and its class together"
        )));
    }
    let place = navigation::declaration(workspace.session.library(), declared)
        .and_then(|span| workspace.location(span));
    let path = place.as_ref().and_then(|place| super::uri::path(&place.uri));
    let is_open = place.as_ref().is_some_and(|place| all.contains_key(place.uri.as_str()));
    let own = |workspace: &Workspace| {
        let roots = all.values().filter_map(|one| navigation::root(workspace, one.path.as_ref()?));
        path.as_ref().is_some_and(|path| roots.into_iter().any(|root| path.starts_with(root)))
    };
    if is_open || own(workspace) {
        return Ok(());
    }
    Err(Refusal::failed("it is declared in a library outside the open documents"))
}

/// Whether a class has a separate file in the folder of its package.
fn is_named_by_file(workspace: &mut Workspace, class: crate::flatten::ClassId) -> bool {
    let library = workspace.session.library();
    let span = library.definition_of(class).name.span;
    let name = library.name_of(class).last();
    let Some(path) = workspace.location(span).and_then(|place| super::uri::path(&place.uri)) else {
        return false;
    };
    let stem = path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
    let folder = path.parent().and_then(|folder| folder.file_name()).unwrap_or_default();
    let is_package = stem == "package" && name.is_some_and(|name| folder == name.as_str());
    let in_package = path
        .parent()
        .is_some_and(|folder| workspace.session.world.exists(&folder.join("package.mo")));
    is_package || in_package && name.is_some_and(|name| name == stem.as_str())
}

/// The changes that give a name another spelling.
///
/// # Errors
/// It is not an identifier, another element has it already, or what it means cannot be renamed.
pub(crate) fn edits(
    workspace: &mut Workspace,
    found: &Found,
    all: &Documents,
    new_name: &str,
) -> Result<WorkspaceEdit, Refusal> {
    if !is_identifier(new_name) {
        return Err(Refusal::failed(format!("`{new_name}` is not an identifier")));
    }
    check(workspace, found, all)?;
    check_free(workspace, found, new_name)?;
    let old = declared_name(workspace, found);
    let places = navigation::references(workspace, found, all);
    let changes = places.into_iter().filter_map(|one| changes(&one, &old, new_name, all)).collect();
    Ok(workspace.client.edit(changes))
}

/// Refuses a name that another element has where the renamed one is declared or used.
fn check_free(workspace: &mut Workspace, found: &Found, new_name: &str) -> Result<(), Refusal> {
    let ident = Ident::new(new_name);
    let library = workspace.session.library();
    let taken = match found.one.entity {
        Entity::Declared(Declared::Component(owner, _)) => library.element(owner, ident).is_some(),
        Entity::Declared(Declared::Literal(owner, _)) => library.element(owner, ident).is_some(),
        Entity::Declared(Declared::Class(class)) => match library.enclosing(class) {
            Some(around) => library.element(around, ident).is_some(),
            None => library.contains(&Name::from(ident)),
        },
        entity => found.names.iter().any(|one| {
            one.entity != entity && found.parsed.document.text[one.range.clone()] == *new_name
        }),
    };
    match taken {
        true => Err(Refusal::failed(format!("`{new_name}` is declared already"))),
        false => Ok(()),
    }
}

/// The name as it is declared: aliases that imports give are kept.
fn declared_name(workspace: &mut Workspace, found: &Found) -> String {
    let library = workspace.session.library();
    match found.one.entity {
        Entity::Declared(Declared::Class(class)) => {
            library.name_of(class).last().map_or(String::new(), |name| name.to_string())
        }
        Entity::Declared(
            Declared::Component(_, name) | Declared::Literal(_, name) | Declared::Predefined(name),
        )
        | Entity::Variable(name)
        | Entity::Function(name) => name.to_string(),
        Entity::Loop(_) => found.parsed.document.text[found.one.range.clone()].to_owned(),
    }
}

fn changes(places: &Places, old: &str, new: &str, all: &Documents) -> Option<TextDocumentEdit> {
    let document = &places.document;
    let written = places.names.iter().filter(|one| document.text[one.range.clone()] == *old);
    let edits: Vec<_> = written
        .map(|one| {
            let range = document.range(one.range.clone());
            OneOf::Left(TextEdit { range, new_text: new.to_owned() })
        })
        .collect();
    let version = all.get(document.uri.as_str()).map(|one| one.version);
    let text_document =
        OptionalVersionedTextDocumentIdentifier { uri: document.uri.clone(), version };
    (!edits.is_empty()).then_some(TextDocumentEdit { text_document, edits })
}
