//! The files of a disk, for the benchmarks that read libraries.

use gapilib::internals::flatten::LibraryFiles;
use gapilib::internals::source::{SourceId, SourceMap};
use gapilib::internals::syntax;
use std::path::Path;
use std::sync::Arc;

/// The files of a disk.
#[derive(Debug, Default)]
pub(crate) struct Disk(SourceMap);

impl LibraryFiles for Disk {
    fn read(&self, path: &Path) -> Result<(SourceId, Arc<str>), gapilib::Fault> {
        let text: Arc<str> = syntax::decode(&std::fs::read(path).unwrap_or_default()).0.into();
        Ok((self.0.add(path.display().to_string(), text.clone()), text))
    }

    fn list(&self, folder: &Path) -> Vec<String> {
        let entries = std::fs::read_dir(folder).into_iter().flatten().flatten();
        let names = entries.map(|entry| entry.file_name().to_string_lossy().into_owned());
        let mut names: Vec<String> = names.collect();
        names.sort();
        names
    }

    fn is_file(&self, path: &Path) -> bool {
        path.is_file()
    }
}
