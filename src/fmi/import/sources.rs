//! What the shared library of a unit is compiled of where there are sources alone (FMI 2.0.5 §2.3,
//! FMI 3.0.2 §2.5.1.4).

use super::plan::InterfaceKind;
use super::platform::interface;
use crate::archive::Archive;
use crate::description::{Description, Version};
use crate::xml::Element;
use roxmltree::Document;

/// Where a unit of FMI 3.0 says how it is built.
const BUILD: &str = "sources/buildDescription.xml";

/// What a compiler of C is given, paths within the archive.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Sources {
    /// Files that are compiled.
    pub files: Vec<String>,
    /// Macros with their values.
    pub definitions: Vec<(String, Option<String>)>,
    /// Folders with headers, besides `sources`.
    pub include_directories: Vec<String>,
}

/// What the library of a kind is compiled of; `None` where the unit does not say.
///
/// # Errors
/// What it needs besides C, or that files are missing, in one sentence.
pub fn sources(
    archive: &Archive,
    description: &Description,
    kind: InterfaceKind,
) -> Result<Option<Sources>, String> {
    let interface = interface(description, kind)?;
    let found = match description.version {
        Version::V2 => {
            let files = interface.source_files.iter();
            Sources { files: files.map(|file| in_sources(file)).collect(), ..Sources::default() }
        }
        Version::V3 => match archive.file(BUILD) {
            Ok(text) => built(&String::from_utf8_lossy(text), &interface.model_identifier)?,
            Err(_) => return Ok(None),
        },
    };
    if let Some(missing) = found.files.iter().find(|file| archive.file(file).is_err()) {
        return Err(format!("it has no `{missing}`, of which its library is built"));
    }
    Ok(Some(found).filter(|found| !found.files.is_empty()))
}

fn in_sources(file: &str) -> String {
    format!("sources/{file}")
}

/// The configuration for an identifier, of all source sets together.
fn built(text: &str, identifier: &str) -> Result<Sources, String> {
    let wrong = |why: String| format!("`{BUILD}`: {why}");
    let document = Document::parse(text).map_err(|error| wrong(error.to_string()))?;
    let configurations = Element(document.root_element()).children();
    let is_own = |one: &&Element| {
        one.name() == "BuildConfiguration"
            && one.get("modelIdentifier") == Some(identifier)
            && one.get("platform").is_none()
    };
    let Some(own) = configurations.iter().find(is_own) else { return Ok(Sources::default()) };
    let mut sources = Sources::default();
    for part in own.children() {
        match part.name() {
            "SourceFileSet" => add(&mut sources, &part).map_err(wrong)?,
            "Library" => {
                let name = part.get("name").unwrap_or_default();
                return Err(format!("its library needs the library `{name}`"));
            }
            _ => {}
        }
    }
    Ok(sources)
}

fn add(sources: &mut Sources, set: &Element) -> Result<(), String> {
    let language = set.get("language").unwrap_or("C99");
    if !language.starts_with('C') || language.starts_with("C++") {
        return Err(format!("its sources are {language}, not C"));
    }
    for part in set.children() {
        let name = part.required("name").map_err(|error| error.to_string());
        match part.name() {
            "SourceFile" => sources.files.push(in_sources(name?)),
            "PreprocessorDefinition" => {
                sources.definitions.push((name?.to_owned(), part.text("value")));
            }
            "IncludeDirectory" => sources.include_directories.push(in_sources(name?)),
            _ => {}
        }
    }
    Ok(())
}
