//! The files that classes are read from when they are needed.

use super::Origin;
use crate::diag::{At, Diagnostic, Fault};
use crate::name::Ident;
use crate::source::{SourceId, Span};
use crate::syntax;
use crate::syntax::ast::StoredDefinition;
use std::fmt::Debug;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// Access to the files of a library. Implementations decode and number the source files.
pub trait LibraryFiles: Debug + Send + Sync {
    /// The text of a file, and its number.
    ///
    /// # Errors
    /// The file cannot be read.
    fn read(&self, path: &Path) -> Result<(SourceId, Arc<str>), Fault>;

    /// The names of what lies in a folder, sorted; none if there is no such folder.
    fn list(&self, folder: &Path) -> Vec<String>;

    /// Whether there is such a file.
    fn is_file(&self, path: &Path) -> bool;
}

/// The folder of a package (MLS §13.4.1).
#[derive(Debug, Clone)]
pub(super) struct Folder {
    pub(super) files: Arc<dyn LibraryFiles>,
    pub(super) path: PathBuf,
}

/// A class in the folder of its package: a file `M.mo`, or a folder with a `package.mo`.
#[derive(Debug, Clone)]
pub(super) struct Entry {
    /// The file with the class's text.
    pub(super) file: PathBuf,
    /// The folder of a package.
    pub(super) folder: Option<PathBuf>,
    /// The name without `.mo`: that of the class, if all is as it should be.
    pub(super) stem: String,
}

impl Entry {
    /// The heads of the classes in the file.
    pub(super) fn heads(&self, files: &dyn LibraryFiles) -> Result<StoredDefinition, Diagnostic> {
        let (source, text) = files.read(&self.file).at(Span::NONE)?;
        syntax::parse_stored_definition_lazily(source, &text)
    }

    /// The classes of the file; the first one has the folder.
    pub(super) fn classes(
        &self,
        files: &Arc<dyn LibraryFiles>,
        file: &StoredDefinition,
    ) -> Vec<(Ident, Origin)> {
        let mut path = self.folder.clone();
        let origin = |class: &Arc<_>| {
            let folder = path.take().map(|path| Folder { files: files.clone(), path });
            Origin::Head(Arc::clone(class), folder)
        };
        let origins: Vec<Origin> = file.classes.iter().map(origin).collect();
        file.classes.iter().map(|class| class.name.node).zip(origins).collect()
    }
}

impl Folder {
    /// The classes of the folder by the names of their files.
    pub(super) fn entries(&self) -> Vec<Entry> {
        let names = self.files.list(&self.path);
        names.into_iter().filter_map(|name| self.entry(&name)).collect()
    }

    fn entry(&self, name: &str) -> Option<Entry> {
        let path = self.path.join(name);
        if let Some(stem) = name.strip_suffix(".mo") {
            let is_class = stem != "package" && self.files.is_file(&path);
            let stem = stem.to_owned();
            return is_class.then_some(Entry { file: path, folder: None, stem });
        }
        let file = path.join("package.mo");
        let is_package = self.files.is_file(&file);
        is_package.then(|| Entry { file, folder: Some(path), stem: name.to_owned() })
    }

    /// The names that `package.order` lists; `None` without that file.
    pub(super) fn order(&self) -> Option<Vec<String>> {
        let path = self.path.join("package.order");
        if !self.files.is_file(&path) {
            return None;
        }
        let (_, text) = self.files.read(&path).ok()?;
        let names = text.lines().map(str::trim).filter(|line| !line.is_empty());
        Some(names.map(str::to_owned).collect())
    }
}
