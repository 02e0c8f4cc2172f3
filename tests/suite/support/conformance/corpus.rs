//! A folder of Modelica files, loaded as one library.

use gapilib::internals::external::errors::EXTERNAL_OUTSIDE;
use gapilib::internals::external::{Provide, Resources};
use gapilib::internals::flatten::Library;
use gapilib::internals::source::SourceMap;
use gapilib::internals::syntax::ast::StoredDefinition;
use gapilib::internals::syntax::{self, parse_stored_definition};
use gapilib::{Diagnostic, Fault};
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// A loaded folder.
pub(crate) struct Corpus {
    /// All classes of the files that could be loaded.
    pub(crate) library: Arc<Library>,
    /// All texts.
    pub(crate) sources: Arc<SourceMap>,
    /// All files, packages before what lies in them.
    pub(crate) files: Vec<File>,
}

/// A file and what parsing and loading gave.
pub(crate) struct File {
    /// Its path below the folder, without `.mo`, parts separated by dots.
    pub(crate) name: String,
    /// Its text.
    pub(crate) text: String,
    /// Its classes.
    pub(crate) parsed: Result<StoredDefinition, Diagnostic>,
    /// Why its classes were not added to the library.
    pub(crate) refused: Option<Diagnostic>,
}

impl Corpus {
    /// Loads every `.mo` file below a folder.
    pub(crate) fn load(root: &Path) -> Corpus {
        let mut paths = Vec::new();
        collect(root, &mut paths);
        let (mut library, sources) = (Library::new(), SourceMap::default());
        let files = paths
            .iter()
            .map(|path| {
                let text = syntax::decode(&fs::read(path).expect("a readable file")).0;
                let source = sources.add(path.display().to_string(), text.as_str());
                let parsed = parse_stored_definition(source, &text);
                let loaded = parsed.as_ref().map(|file| library.load(file));
                let refused = loaded.ok().and_then(Result::err);
                File { name: dotted(root, path), text, parsed, refused }
            })
            .collect();
        library.set_resources(Resources::new(Arc::new(Below(root.to_path_buf()))));
        Corpus { library: Arc::new(library), sources: Arc::new(sources), files }
    }
}

/// The files that models name: `modelica://` URIs below a folder, paths as they are.
#[derive(Debug)]
struct Below(PathBuf);

impl Below {
    fn found(&self, name: &str) -> PathBuf {
        name.strip_prefix("modelica://").map_or_else(|| name.into(), |uri| self.0.join(uri))
    }
}

impl Provide for Below {
    fn path(&self, name: &str) -> Result<String, Fault> {
        Ok(self.found(name).display().to_string())
    }

    fn read(&self, name: &str) -> Result<Vec<u8>, Fault> {
        let error = |error: std::io::Error| Fault::new(EXTERNAL_OUTSIDE, error.to_string());
        fs::read(self.found(name)).map_err(error)
    }

    fn is_folder(&self, name: &str) -> Option<bool> {
        fs::metadata(self.found(name)).ok().map(|found| found.is_dir())
    }
}

/// The files below a folder: its `package.mo` first, its folders last.
fn collect(folder: &Path, found: &mut Vec<PathBuf>) {
    let entries = fs::read_dir(folder).expect("a readable folder");
    let mut paths: Vec<PathBuf> =
        entries.map(|entry| entry.expect("a readable entry").path()).collect();
    paths.sort_by_key(|path| {
        let is_package = path.file_name().is_some_and(|name| name == "package.mo");
        (!is_package, path.is_dir(), path.clone())
    });
    for path in paths {
        match path.is_dir() {
            true => collect(&path, found),
            false if path.extension().is_some_and(|extension| extension == "mo") => {
                found.push(path);
            }
            false => {}
        }
    }
}

fn dotted(root: &Path, path: &Path) -> String {
    let below = path.strip_prefix(root).expect("below the root").with_extension("");
    let parts = below.components().map(|part| part.as_os_str().to_string_lossy().into_owned());
    parts.collect::<Vec<_>>().join(".")
}
