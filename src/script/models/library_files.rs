//! The files of a library as its classes are read from them: decoded, and put among the sources of
//! the session.

use super::stored::{Reads, Watched};
use crate::access::faults::cannot;
use crate::diag::{Diagnostic, Fault};
use crate::flatten::LibraryFiles;
use crate::source::{SourceId, SourceMap, Span};
use crate::syntax;
use crate::world::FileReader;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, OnceLock};

/// The files of one library.
#[derive(Debug)]
pub(crate) struct SourceFiles {
    files: Watched,
    reads: Reads,
    sources: SourceMap,
    /// The working directory, to which shown paths are relative.
    current: PathBuf,
    /// The warning about the first file that is not UTF-8.
    encoding: OnceLock<Diagnostic>,
    warnings: Warnings,
}

/// Warnings about the encodings of libraries.
pub(crate) type Warnings = Arc<Mutex<Vec<Diagnostic>>>;

impl LibraryFiles for SourceFiles {
    fn read(&self, path: &Path) -> Result<(SourceId, Arc<str>), Fault> {
        let bytes = self.files.read(path).map_err(|error| cannot("read", path, &error))?;
        let (text, warning) = syntax::decode(&bytes);
        let shown = path.strip_prefix(&self.current).unwrap_or(path).display().to_string();
        let text: Arc<str> = text.into();
        let source = self.sources.add(shown, text.clone());
        self.reads.note_text(source, path);
        if let Some(warning) = warning {
            let warning = warning.at(Span::new(source, 0, 0)).warning();
            if self.encoding.set(warning.clone()).is_ok()
                && let Ok(mut warnings) = self.warnings.lock()
            {
                warnings.push(warning);
            }
        }
        Ok((source, text))
    }

    fn list(&self, folder: &Path) -> Vec<String> {
        self.files.list_dir(folder).unwrap_or_default()
    }

    fn is_file(&self, path: &Path) -> bool {
        self.files.is_file(path)
    }
}

impl SourceFiles {
    /// The files of one library; paths are shown relative to the working directory `current`.
    pub(crate) fn new(
        files: Arc<dyn FileReader>,
        reads: Reads,
        sources: SourceMap,
        current: PathBuf,
        warnings: Warnings,
    ) -> SourceFiles {
        let files = Watched::new(files, reads.clone());
        SourceFiles { files, reads, sources, current, encoding: OnceLock::new(), warnings }
    }
}
