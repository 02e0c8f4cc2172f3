//! Links in a document: the files and classes that `modelica://` addresses name.

use super::navigation;
use super::parsed::Parsed;
use super::uri;
use super::workspace::Workspace;
use crate::flatten::Declared;
use crate::name::Name;
use lsp_types::{DocumentLink, Uri};

/// What addresses begin with.
const SCHEME: &str = "modelica://";

/// The links of a document whose files are there.
pub(crate) fn links(workspace: &mut Workspace, parsed: &Parsed) -> Vec<DocumentLink> {
    let document = &parsed.document;
    let places = document.text.match_indices(SCHEME).map(|(start, _)| {
        let address = &document.text[start + SCHEME.len()..];
        let is_part = |c: char| c.is_alphanumeric() || "._-/%+'".contains(c);
        let length = address.find(|c| !is_part(c)).unwrap_or(address.len());
        // A full stop after it ends a sentence.
        let address = address[..length].trim_end_matches('.');
        (start..start + SCHEME.len() + address.len(), address.to_owned())
    });
    let places: Vec<_> = places.collect();
    let link = |(range, address): (std::ops::Range<usize>, String)| {
        let target = Some(target(workspace, &address)?);
        Some(DocumentLink { range: document.range(range), target, tooltip: None, data: None })
    };
    places.into_iter().filter_map(link).collect()
}

/// The file of an address: `Package/Resources/image.png` or `Package.Class`.
fn target(workspace: &mut Workspace, address: &str) -> Option<Uri> {
    let (class, file) = match address.split_once('/') {
        Some((class, file)) => (class, Some(file)),
        None => (address, None),
    };
    let name = Name::parse(class);
    let span = workspace.session.ask(|library| {
        let class = library.find(&name)?;
        navigation::declaration(library, Declared::Class(class))
    })?;
    let own = workspace.location(span)?.uri;
    match file {
        None => Some(own),
        Some(file) => {
            let path = uri::path(&own)?.parent()?.join(file.replace("%20", " "));
            uri::of_path(&path).filter(|_| workspace.session.world.exists(&path))
        }
    }
}
