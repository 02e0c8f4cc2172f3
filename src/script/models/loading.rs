//! Loading classes: from files, folders and libraries, when they are first named.

use super::class_search::package_in;
use super::imported::refuse_as_text;
use super::uses::names_in;
use crate::Session;
use crate::diag::{At, Diagnostic, Fault};
use crate::errors::FILE_ERROR;
use crate::eval::Function;
use crate::flatten::Library;
use crate::name::{Ident, Name};
use crate::source::{SourceId, Span, Spanned};
use crate::syntax;
use std::path::{Path, PathBuf};
use std::sync::Arc;

impl Session {
    /// The loaded classes.
    pub fn library(&mut self) -> &mut Library {
        &mut self.classes.library
    }

    /// A number that changes whenever a class is loaded, defined or removed.
    pub fn library_revision(&self) -> u64 {
        self.classes.revision()
    }

    /// Whether the classes of this file or package folder are loaded as they are: a file is what it was,
    /// and no other text has defined its classes since. The files of a package are not looked at.
    pub(crate) fn is_as_loaded(&self, path: &Path) -> bool {
        let Some(mut found) = self.world.find_file(path) else { return false };
        if found.file_name().is_some_and(|name| name == "package.mo") {
            found.pop();
        }
        let names = self.classes.loaded_from(&found);
        if names.is_empty() || self.world.is_dir(&found) {
            return !names.is_empty();
        }
        let Ok(bytes) = self.world.bytes_of(&found) else { return false };
        let text = text_of_file(&found, &syntax::decode(&bytes).0);
        names.into_iter().all(|name| self.classes.sources.is_from(name, &text))
    }

    /// Loads a `.mo` file, or a package from its folder or its `package.mo`, or all that lie in a
    /// folder, and reads all of it. Returns the names of the classes.
    ///
    /// # Errors
    /// What is wrong with the files; then nothing may be relied on of what they define.
    pub fn load_path(&mut self, path: &Path) -> Result<Vec<Name>, Vec<Diagnostic>> {
        let Some(mut found) = self.world.find_file(path) else {
            return Err(vec![self.world.missing_file(path).at(self.call_site())]);
        };
        if found.file_name().is_some_and(|name| name == "package.mo") {
            found.pop();
        }
        let (mut names, mut errors) = (Vec::new(), Vec::new());
        for path in self.paths_to_load(found) {
            match self.load_all_of(&path) {
                Ok(loaded) => names.extend(loaded),
                Err(wrong) => errors.extend(wrong),
            }
        }
        if errors.is_empty() { Ok(names) } else { Err(errors) }
    }

    /// A file or package, or all files and packages of a folder that is no package.
    fn paths_to_load(&mut self, path: PathBuf) -> Vec<PathBuf> {
        let is_package = |path: &Path| self.world.exists(&path.join("package.mo"));
        if !self.world.is_dir(&path) || is_package(&path) {
            return vec![path];
        }
        let entries = self.world.list_dir(&path).unwrap_or_default().into_iter();
        let inside = entries.map(|entry| path.join(entry));
        let inside: Vec<PathBuf> = inside
            .filter(|path| is_package(path) || path.extension().is_some_and(|e| e == "mo"))
            .collect();
        // What a link in the folder leads to was not named: its being there does not allow to read it.
        let leads_out = |path: &PathBuf| self.world.is_link(path) && !self.world.sees(path);
        let (links, files): (Vec<PathBuf>, Vec<PathBuf>) = inside.into_iter().partition(leads_out);
        for link in links {
            let message =
                format!("`{}` is passed over: it is a link out of the folder", link.display());
            let fault = Fault::new(FILE_ERROR, message);
            let help = "name the file to which it leads to load it as well";
            self.report(fault.help(help).at(Span::NONE).warning());
        }
        files
    }

    fn load_all_of(&mut self, path: &Path) -> Result<Vec<Name>, Vec<Diagnostic>> {
        if !self.world.is_dir(path) {
            return self.load_file(path);
        }
        let around = self.package_around(path)?;
        let names = self.load_library(path, &around)?;
        self.ask_library(|library| {
            let problems = names.iter().flat_map(|name| library.read_all(name));
            let problems: Vec<Diagnostic> = problems.collect();
            if problems.is_empty() { Ok(names) } else { Err(problems) }
        })
    }

    /// The package that a file or folder belongs to by its place; the outermost package around it
    /// is loaded. The empty name if no package is around.
    pub(super) fn package_around(&mut self, path: &Path) -> Result<Name, Vec<Diagnostic>> {
        let is_package = |folder: &&Path| self.world.exists(&folder.join("package.mo"));
        let folders: Vec<&Path> = path.ancestors().skip(1).take_while(is_package).collect();
        let Some(root) = folders.last() else { return Ok(Name::default()) };
        if !self.classes.has_loaded(root) {
            self.load_library(root, &Name::default())?;
        }
        let names = folders.iter().rev().map_while(|folder| package_in(&self.world, folder));
        Ok(Name::new(names.collect::<Vec<_>>()))
    }

    fn load_file(&mut self, path: &Path) -> Result<Vec<Name>, Vec<Diagnostic>> {
        let refused = refuse_as_text(path, "a Modelica file");
        let added = refused.and_then(|()| self.add_file(path));
        let (source, text) = added.at(self.call_site()).map_err(|error| vec![error])?;
        self.classes.single.insert(source, self.world.absolute(path));
        let names = self.load_source(source, &text, Some(path))?;
        self.classes.note_files(&names, path);
        Ok(names)
    }

    /// Loads a package from its folder; its classes are read when they are needed.
    pub(super) fn load_library(
        &mut self,
        folder: &Path,
        around: &Name,
    ) -> Result<Vec<Name>, Vec<Diagnostic>> {
        self.classes.invalidate();
        self.classes.history.note("folder", &format!("{} in `{around}`", folder.display()));
        let files = self.library_files();
        let one = |error: Diagnostic| vec![error];
        let names =
            self.ask_library(|library| library.load_lazily(&files, folder, around).map_err(one))?;
        self.classes.note_files(&names, folder);
        // Its files are read later: whether they are the same is not known yet.
        let revision = self.classes.revision();
        self.classes.sources.note(&names, &format!("{}\n{revision}", folder.display()));
        self.supply_units(&names).map_err(one)?;
        self.note_versions(&names);
        Ok(names)
    }

    /// Loads classes from a text; `name` is shown in diagnostics.
    pub fn load_text(&mut self, name: &str, text: &str) -> Result<Vec<Name>, Vec<Diagnostic>> {
        let source = self.sources.add(name, text);
        self.load_source(source, text, None)
    }

    fn load_source(
        &mut self,
        source: SourceId,
        text: &str,
        path: Option<&Path>,
    ) -> Result<Vec<Name>, Vec<Diagnostic>> {
        let mut file = syntax::parse_all_of_stored_definition(source, text)?;
        self.classes.invalidate();
        let origin = text_of_file(path.unwrap_or(Path::new("")), text);
        self.classes.history.note("text", &origin);
        let around = path.map_or(Ok(Name::default()), |path| self.package_around(path))?;
        if !around.parts.is_empty() && file.within.is_none() {
            file.within = Some(Spanned { node: around, span: Span::new(source, 0, 0) });
        }
        if let Some(package) = file.within.as_ref().and_then(|within| within.node.first()) {
            self.autoload_class(package)?;
        }
        // Before: a text of which only a part can be loaded changes classes, too.
        self.classes.sources.note(&names_in(&file), &origin);
        let names = self.ask_library(|library| library.load(&file).map_err(|error| vec![error]))?;
        self.note_versions(&names);
        Ok(names)
    }

    /// Loads the top-level class that a name begins with, if it is not loaded and can be found.
    /// Returns whether something was loaded.
    pub fn autoload(&mut self, name: &Name) -> Result<bool, Vec<Diagnostic>> {
        match name.first() {
            Some(first) => self.autoload_class(first),
            None => Ok(false),
        }
    }

    pub(super) fn autoload_class(&mut self, name: Ident) -> Result<bool, Vec<Diagnostic>> {
        if self.classes.defines(name) || self.classes.is_missing(name) {
            return Ok(false);
        }
        let is_loaded = self.load_class(name)?;
        self.classes.history.note_search(name, is_loaded);
        Ok(is_loaded)
    }

    fn load_class(&mut self, name: Ident) -> Result<bool, Vec<Diagnostic>> {
        for fault in self.class_search().passed_over(name) {
            self.report(fault.at(self.call_site()).warning());
        }
        let Some(path) = self.search_class(name) else {
            self.classes.note_nowhere(name);
            return Ok(false);
        };
        if self.world.is_dir(&path) {
            self.load_library(&path, &Name::default())?;
        } else {
            self.load_file(&path)?;
        }
        let found = self.classes.defines(name);
        if !found {
            self.classes.note_misnamed(name, path);
        }
        Ok(found)
    }

    /// Loads what the library asked for and did not have. Returns whether something was loaded:
    /// then what failed is worth another attempt.
    pub(crate) fn load_requested(&mut self) -> Result<bool, Vec<Diagnostic>> {
        let mut loaded = false;
        for name in self.classes.library.take_missing() {
            loaded |= self.autoload_class(name)?;
        }
        Ok(loaded)
    }

    /// Loads the libraries that the `uses` annotations of loaded ones name, as far as they are found:
    /// for those who hand the classes on to where nothing is loaded any more.
    pub fn load_used(&mut self) -> Result<(), Vec<Diagnostic>> {
        loop {
            let used: Vec<Ident> = self.classes.versions.keys().copied().collect();
            let mut is_loaded = false;
            for name in used {
                is_loaded |= self.autoload(&Name::from(name))?;
            }
            if !is_loaded {
                return Ok(());
            }
        }
    }

    /// Whether a class of this name is loaded or can be.
    ///
    /// # Errors
    /// What is wrong with the files that were read.
    pub(crate) fn find_class(&mut self, name: &Name) -> Result<bool, Vec<Diagnostic>> {
        self.autoload(name)?;
        self.ask_library(|library| Ok(library.contains(name)))
    }

    /// The same, the errors reported.
    pub(crate) fn class_exists(&mut self, name: &Name) -> bool {
        let found = self.find_class(name);
        self.or_report_all(found).unwrap_or(false)
    }

    /// Whether a class comes from a folder, so that its parts are read when they are needed.
    pub(crate) fn is_lazy(&self, name: &Name) -> bool {
        self.classes.file_of(name).is_some_and(|path| self.world.is_dir(path))
    }

    /// Removes all classes.
    pub(crate) fn forget_classes(&mut self) {
        self.classes.forget();
        self.models.forget();
    }

    /// A function of the loaded classes, looked up from the top level.
    pub(crate) fn loaded_function(
        &mut self,
        name: &Name,
    ) -> Result<Option<Arc<Function>>, Diagnostic> {
        for candidate in self.workspace.candidates(name) {
            if let Some(function) = self.function_named(&candidate)? {
                return Ok(Some(function));
            }
        }
        Ok(None)
    }

    pub(crate) fn function_named(
        &mut self,
        name: &Name,
    ) -> Result<Option<Arc<Function>>, Diagnostic> {
        let first = |mut errors: Vec<Diagnostic>| errors.swap_remove(0);
        if let Some(copy) = self.classes.copy(name) {
            return Ok(Some(copy));
        }
        loop {
            let one = |error: Diagnostic| vec![error];
            match self.ask_library(|library| library.function(name).map_err(one)) {
                Ok(None) => return Ok(None),
                Ok(Some(functions)) => {
                    let own = functions.values().next().cloned();
                    self.classes.keep_copies(functions);
                    return Ok(own);
                }
                Err(errors) => {
                    if !self.load_requested().map_err(first)? {
                        return Err(first(errors));
                    }
                }
            }
        }
    }

    /// The file that a path or a `modelica://Package/…` URI names.
    pub(crate) fn resource(&mut self, uri: &str) -> Result<PathBuf, Fault> {
        if let Some(rest) = uri.strip_prefix("modelica://") {
            let (package, file) = rest.split_once('/').unwrap_or((rest, ""));
            let package = Name::parse(package);
            let top = Name::new(package.first());
            if let (true, Some(folder)) = (self.class_exists(&top), self.classes.file_of(&top)) {
                let inner = package.parts[1..].iter().map(|part| part.as_str());
                return Ok(folder.join(inner.collect::<PathBuf>()).join(file));
            }
        }
        let path = Path::new(uri);
        self.world.find_file(path).ok_or_else(|| self.world.missing_file(path))
    }

    /// The file a class was loaded from, if it was loaded from one.
    pub fn source_file(&self, name: &Name) -> Option<PathBuf> {
        self.classes.file_of(&Name::new(name.first())).cloned()
    }
}

/// A text with the file that it is from.
fn text_of_file(path: &Path, text: &str) -> String {
    format!("{}\n{text}", path.display())
}
