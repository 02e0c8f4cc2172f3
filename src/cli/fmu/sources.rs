//! Units of which there are sources alone: their library is compiled where they are unpacked. They need
//! the headers of the standard, which units do not bring along.

use crate::c_compiler;
use crate::fmi::archive::DESCRIPTION;
use crate::fmi::description;
use crate::fmi::import::{InterfaceKind, Sources, library_path, sources};
use crate::fmi::{Archive, FmuError};
use std::fs;
use std::io;
use std::path::Path;

/// The headers, with their names.
const HEADERS: &[(&str, &str)] = &[
    ("fmi2TypesPlatform.h", include_str!("headers/fmi2TypesPlatform.h")),
    ("fmi2FunctionTypes.h", include_str!("headers/fmi2FunctionTypes.h")),
    ("fmi2Functions.h", include_str!("headers/fmi2Functions.h")),
    ("fmi3PlatformTypes.h", include_str!("headers/fmi3PlatformTypes.h")),
    ("fmi3FunctionTypes.h", include_str!("headers/fmi3FunctionTypes.h")),
    ("fmi3Functions.h", include_str!("headers/fmi3Functions.h")),
];
/// The folder of the headers: no path in an archive begins so.
const FOLDER: &str = "fmi-headers";

/// Compiles the libraries that an unpacked unit lacks and has sources of.
pub(super) fn compile(archive: &Archive, folder: &Path) -> Result<(), String> {
    let words = |error: FmuError| error.to_string();
    let text = archive.file(DESCRIPTION).map_err(words)?;
    let description = description::read(text).map_err(words)?;
    use InterfaceKind::{CoSimulation, ModelExchange, ScheduledExecution};
    for kind in [ModelExchange, CoSimulation, ScheduledExecution] {
        // A kind that the unit does not have.
        let Ok(library) = library_path(&description, kind) else { continue };
        if folder.join(&library).exists() {
            continue;
        }
        if let Some(own) = sources(archive, &description, kind)? {
            prepare(folder, &library).map_err(|error| format!("it cannot be compiled: {error}"))?;
            c_compiler::shared_library(folder, &arguments(&own, &library))?;
        }
    }
    Ok(())
}

fn prepare(folder: &Path, library: &str) -> io::Result<()> {
    let headers = folder.join(FOLDER);
    fs::create_dir_all(&headers)?;
    for (name, text) in HEADERS {
        fs::write(headers.join(name), text)?;
    }
    folder.join(library).parent().map_or(Ok(()), fs::create_dir_all)
}

/// The unit's own headers come before ours.
fn arguments(sources: &Sources, library: &str) -> Vec<String> {
    let mut all = vec!["-o".to_owned(), library.to_owned()];
    let own = sources.include_directories.iter().map(String::as_str);
    for folder in ["sources"].into_iter().chain(own).chain([FOLDER]) {
        all.extend(["-I".to_owned(), folder.to_owned()]);
    }
    for (name, value) in &sources.definitions {
        let value = value.as_ref().map(|value| format!("={value}")).unwrap_or_default();
        all.push(format!("-D{name}{value}"));
    }
    all.extend(sources.files.iter().cloned());
    all.push("-lm".to_owned());
    all
}
