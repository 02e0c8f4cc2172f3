//! Libraries: the folders and versions that are asked for, and what is asked of those that are loaded.

use super::class_search::{ClassSearch, package_in};
use super::library_files::SourceFiles;
use crate::Session;
use crate::diag::Diagnostic;
use crate::flatten::{Library, LibraryFiles};
use crate::name::{Ident, Name};
use crate::packages;
use std::path::{Path, PathBuf};
use std::sync::Arc;

impl Session {
    /// Makes the packages in a folder loadable by name.
    pub fn add_library_dir(&mut self, path: &Path) {
        let path = self.world.absolute(path);
        self.classes.add_directory(path);
    }

    /// Makes the package in a folder loadable by the name that it has, whatever the folder is
    /// called.
    pub fn add_package_dir(&mut self, path: &Path) {
        let path = self.world.absolute(path);
        if let Some(name) = package_in(&self.world, &path) {
            self.classes.add_named(name, path);
        }
    }

    /// The files of a library that is going to be loaded.
    pub(super) fn library_files(&self) -> Arc<dyn LibraryFiles> {
        Arc::new(SourceFiles::new(
            self.world.reader_with_given(),
            self.classes.reads.clone(),
            self.sources.clone(),
            self.world.current_dir(),
            self.classes.warnings.clone(),
        ))
    }

    /// The answer of the library to a question, or what is wrong with the files that it needed for
    /// it. Tells the warnings about them.
    pub(crate) fn ask_library<T>(
        &mut self,
        question: impl FnOnce(&mut Library) -> Result<T, Vec<Diagnostic>>,
    ) -> Result<T, Vec<Diagnostic>> {
        // What was found before concerned another question.
        self.classes.library.take_problems();
        let answer = question(&mut self.classes.library);
        let mut warnings = self.classes.take_warnings();
        warnings.extend(self.classes.library.take_warnings());
        warnings.into_iter().for_each(|warning| self.report(warning));
        match self.classes.library.take_problems() {
            problems if problems.is_empty() => answer,
            problems => Err(problems),
        }
    }

    /// Where the top-level class of this name is; see [`ClassSearch::find`].
    pub fn search_class(&self, name: Ident) -> Option<PathBuf> {
        self.class_search().find(name)
    }

    pub(super) fn class_search(&self) -> ClassSearch<'_> {
        ClassSearch { world: &self.world, classes: &self.classes }
    }

    /// Asks for the first of these versions that is there, when the library is loaded.
    pub(crate) fn require_version(&mut self, name: &Name, versions: Vec<String>) {
        let Some(library) = name.first() else { return };
        let mut required = versions.into_iter().take_while(|version| version != "default");
        let search = self.class_search();
        let found = required.find(|version| search.has_version(library, version));
        if let Some(version) = found {
            self.classes.versions.insert(library, version);
        }
    }

    /// Folders that were named for libraries.
    pub(crate) fn library_folders(&self) -> &[PathBuf] {
        self.classes.directories()
    }

    /// Notes the versions that loaded packages ask for, and tells if another one is loaded.
    pub(crate) fn note_versions(&mut self, names: &[Name]) {
        self.classes.note_versions_used(names);
        for name in names.iter().filter(|name| name.is_simple()) {
            if let Some(fault) = self.classes.other_version(name) {
                self.report(fault.at(self.call_site()).warning());
            }
        }
    }

    /// Puts the types under their former name into a standard library that lacks them.
    pub(crate) fn supply_units(&mut self, names: &[Name]) -> Result<(), Diagnostic> {
        let modelica = Name::parse("Modelica");
        let library: &mut Library = &mut self.classes.library;
        let has = |part: &str| library.contains(&modelica.child(Ident::new(part)));
        if !names.contains(&modelica) || !has("Units") || has("SIunits") {
            return Ok(());
        }
        let path = Path::new(packages::FOLDER).join("Modelica").join("SIunits.mo");
        let files = self.library_files();
        if files.is_file(&path) {
            self.classes.library.load_lazily(&files, &path, &modelica)?;
        }
        Ok(())
    }
}
