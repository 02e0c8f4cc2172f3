//! Classes whose text an editor shows, saved or not: they stand for those of their files, and what is
//! wrong with them is an answer, not a message.

use super::simulation;
use crate::causalize;
use crate::diag::Diagnostic;
use crate::flatten::{self, ClassId, Library};
use crate::name::{Ident, Name};
use crate::script::Session;
use crate::source::{SourceId, Span, Spanned};
use crate::syntax::ast::StoredDefinition;
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

impl Session {
    /// Loads the classes of a text instead of those of its file, with the package that it belongs to
    /// by its place. Returns their full names.
    ///
    /// # Errors
    /// The package around it is not there, or a class declares two classes of one name.
    pub fn load_document(
        &mut self,
        path: Option<&Path>,
        file: &StoredDefinition,
    ) -> Result<Vec<Name>, Vec<Diagnostic>> {
        let mut file = file.clone();
        if let Some(path) = path {
            let around = self.package_of_document(path)?;
            if !around.parts.is_empty() && file.within.is_none() {
                let span = Span::new(file.span.source, 0, 0);
                file.within = Some(Spanned { node: around, span });
            }
        }
        self.classes.invalidate();
        if let Some(package) = file.within.as_ref().and_then(|within| within.node.first()) {
            self.autoload_class(package)?;
        }
        self.ask_library(|library| library.load(&file).map_err(|error| vec![error]))
    }

    /// The package that a text belongs to by its place, loaded. Classes beside a text that belongs to
    /// none are found by name.
    fn package_of_document(&mut self, path: &Path) -> Result<Name, Vec<Diagnostic>> {
        self.grant_input(path);
        let Some(folder) = path.parent() else { return Ok(Name::default()) };
        let is_package = path.file_name().is_some_and(|name| name == "package.mo");
        let root = folder.ancestors().take_while(|one| self.world.exists(&one.join("package.mo")));
        match root.last().map(Path::to_path_buf) {
            // What is wrong with its own text is known from the document.
            Some(root) => _ = self.load_root(&root),
            None if !self.library_folders().iter().any(|known| known == folder) => {
                self.add_library_dir(folder);
            }
            None => {}
        }
        self.package_around(if is_package { folder } else { path })
    }

    fn load_root(&mut self, root: &Path) -> Result<(), Vec<Diagnostic>> {
        if !self.classes.has_loaded(root) {
            self.load_library(root, &Name::default())?;
        }
        Ok(())
    }

    /// Loads the classes of a file, if they are not loaded.
    ///
    /// # Errors
    /// What is wrong with it.
    pub fn load_path_once(&mut self, path: &Path) -> Result<(), Vec<Diagnostic>> {
        self.grant_input(path);
        if !self.has_loaded(path) {
            self.load_path(path)?;
        }
        Ok(())
    }

    /// The file that a source was read from as part of a library.
    pub fn file_of_source(&self, source: SourceId) -> Option<PathBuf> {
        self.classes.reads.file_of(source)
    }

    /// Asks about the loaded classes until nothing more has to be loaded for the answer.
    pub fn ask<T>(&mut self, question: impl Fn(&Library) -> T) -> T {
        loop {
            let answer = question(&self.classes.library);
            // A library that cannot be loaded is missed again by what needs it.
            if !self.load_wanted().unwrap_or(false) {
                return answer;
            }
        }
    }

    /// What is wrong with a class by its text and the names in it.
    pub fn examine_class(&mut self, class: &Name) -> Vec<Diagnostic> {
        self.ask(|library| flatten::check(library, class))
    }

    /// What is wrong with a model down to its causalization: what `gapi check` finds.
    pub fn examine_model(&mut self, model: &Name) -> Vec<Diagnostic> {
        let flattened = match simulation::flattened_silently(self, &model.to_string()) {
            Ok(flattened) => flattened,
            Err(mut errors) => {
                errors.retain(|error| error.code.slug != "parameter-without-value");
                return errors;
            }
        };
        let mut found = flattened.warnings;
        // What has open connectors is no system by itself, and whoever uses a model gives its parameters
        // values.
        let is_component = flattened.balance.and_then(|balance| balance.of_component()).is_some();
        let is_wrong = |error: &Diagnostic| match error.code.slug {
            "singular-system" => !is_component,
            "parameter-without-value" => false,
            _ => true,
        };
        found.extend(causalize::causalize(&flattened.model).err().filter(is_wrong));
        found
    }

    /// The class of a full name, loaded if it can be.
    pub fn class_id(&mut self, name: &Name) -> Option<ClassId> {
        self.ask(|library| {
            let found = library.find(name);
            if found.is_none() {
                // Asked for by its first name, which is noted as missing.
                library.parts_of_type(None, name);
            }
            found
        })
    }

    /// The names of the classes that are found in the library folders and beside open files, loaded or
    /// not. No file is read.
    pub fn loadable_classes(&self) -> BTreeSet<Ident> {
        let folders = self.library_folders().iter();
        let names = folders.flat_map(|folder| {
            let entries = self.world.list_dir(folder).unwrap_or_default().into_iter();
            entries.filter(|entry| {
                entry.ends_with(".mo") || self.world.exists(&folder.join(entry).join("package.mo"))
            })
        });
        let class = |entry: String| {
            let name = entry.strip_suffix(".mo").unwrap_or(&entry);
            // The version of a library is behind a blank.
            Ident::new(name.split(' ').next().unwrap_or(name))
        };
        let shipped = crate::models::list(Path::new(crate::models::FOLDER)).unwrap_or_default();
        names.chain(shipped).map(class).collect()
    }
}
