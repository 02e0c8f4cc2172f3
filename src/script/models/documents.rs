//! Classes whose text an editor shows, saved or not: they stand for those of their files, and what is
//! wrong with them is an answer, not a message.

use crate::Session;
use crate::causalize;
use crate::diag::Diagnostic;
use crate::flatten::{self, ClassId, Library};
use crate::models::left_open::LeftOpen;
use crate::models::uses::names_in;
use crate::name::{Ident, Name};
use crate::source::{SourceId, Span, Spanned};
use crate::syntax::ast::StoredDefinition;
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

/// A model, and the classes as they are now.
#[derive(Debug)]
pub struct ModelCheck {
    library: Library,
    model: Name,
}

/// What is wrong with a model.
#[derive(Debug)]
pub struct CheckedModel {
    /// The model.
    pub model: Name,
    /// Errors and warnings.
    pub found: Vec<Diagnostic>,
    /// Classes at the top that were looked for and are not loaded.
    pub missing: BTreeSet<Ident>,
}

impl ModelCheck {
    /// Finds out what is wrong with the model down to its causalization: what `gapi check` finds,
    /// without what is wrong only because the model leaves something to its users.
    pub fn run(self) -> CheckedModel {
        let mut found = self.found();
        let problems = self.library.take_problems();
        if !problems.is_empty() {
            found = problems;
        }
        CheckedModel { missing: self.library.take_missing(), model: self.model, found }
    }

    fn found(&self) -> Vec<Diagnostic> {
        let open = LeftOpen::of(&self.library, self.library.find(&self.model));
        let (flattened, imbalance) =
            match flatten::flatten_unbalanced(&self.library, &self.model, &[]) {
                Ok(flattened) => flattened,
                Err(errors) => return open.faults(errors),
            };
        // What has open connectors is not a system by itself: its local balance counts, if known.
        let is_component = match &flattened.balance {
            Some(balance) => balance.of_component().is_some(),
            None => open.is_component(),
        };
        let mut found = flattened.warnings;
        if let Some(imbalance) = imbalance {
            if !is_component {
                return vec![causalize::explain_imbalance(&flattened.model, imbalance)];
            }
            return open.faults(found);
        }
        let is_of_system = |error: &Diagnostic| {
            ["singular-system", "unbalanced-model", "clock-conflict"].contains(&error.code.slug)
        };
        let error = causalize::check(&flattened.model).err();
        found.extend(error.filter(|error| !is_component || !is_of_system(error)));
        open.faults(found)
    }
}

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
        let revision = self.classes.revision();
        self.classes.sources.note(&names_in(&file), &revision.to_string());
        self.ask_library(|library| library.load(&file).map_err(|error| vec![error]))
    }

    /// The package that a text belongs to by its place, loaded. Classes beside a text that belongs to
    /// none are found by name.
    fn package_of_document(&mut self, path: &Path) -> Result<Name, Vec<Diagnostic>> {
        self.world.grant_input(path);
        let Some(folder) = path.parent() else { return Ok(Name::default()) };
        let is_package = path.file_name().is_some_and(|name| name == "package.mo");
        let root = folder.ancestors().take_while(|one| self.world.exists(&one.join("package.mo")));
        match root.last().map(Path::to_path_buf) {
            // What is wrong with its own text is known from the document.
            Some(root) => _ = self.load_root(&root),
            None => self.search_beside(path),
        }
        self.package_around(if is_package { folder } else { path })
    }

    /// Finds classes by name beside a file, and in the folders `models` above it as a run of it does.
    pub fn search_beside(&mut self, path: &Path) {
        self.world.grant_input(path);
        let Some(folder) = path.parent() else { return };
        let models = folder.ancestors().map(|above| above.join("models"));
        let folders: Vec<PathBuf> = std::iter::once(folder.to_path_buf())
            .chain(models.filter(|models| self.world.is_dir(models)))
            .filter(|one| !self.library_folders().contains(one))
            .collect();
        folders.iter().for_each(|folder| self.add_library_dir(folder));
    }

    fn load_root(&mut self, root: &Path) -> Result<(), Vec<Diagnostic>> {
        if !self.classes.has_loaded(root) {
            self.load_library(root, &Name::default())?;
        }
        Ok(())
    }

    /// Loads the classes of a file that a script names, unless they are loaded as they are; naming it
    /// there gives no permission to read it.
    ///
    /// # Errors
    /// What is wrong with it.
    pub(crate) fn load_path_once(&mut self, path: &Path) -> Result<(), Vec<Diagnostic>> {
        if !self.is_as_loaded(path) {
            self.load_path(path)?;
        }
        Ok(())
    }

    /// The file that a source was read from.
    pub fn file_of_source(&self, source: SourceId) -> Option<PathBuf> {
        let single = self.classes.single.get(&source).cloned();
        single.or_else(|| self.classes.reads.file_of(source))
    }

    /// Asks about the loaded classes until nothing more has to be loaded for the answer.
    pub fn ask<T>(&mut self, question: impl Fn(&Library) -> T) -> T {
        loop {
            let answer = question(&self.classes.library);
            // A library that cannot be loaded is missed again by what needs it.
            if !self.load_requested().unwrap_or(false) {
                return answer;
            }
        }
    }

    /// What is wrong with a class by its text and the names in it; what is wrong with the text of a class
    /// that it needs comes first.
    pub fn examine_class(&mut self, class: &Name) -> Vec<Diagnostic> {
        let found = self.ask(|library| flatten::check(library, class));
        let problems = self.library().take_problems();
        if problems.is_empty() { found } else { problems }
    }

    /// The work of finding out what is wrong with a model, for any thread. The libraries that the loaded
    /// ones use are loaded before: a model that misses one of them is flattened again.
    pub fn model_check(&mut self, model: &Name) -> ModelCheck {
        // A library that cannot be loaded is missed by what needs it.
        let _ = self.load_used();
        let resources = self.resources_for(model);
        self.classes.library.set_resources(resources);
        ModelCheck { library: self.classes.library.clone(), model: model.clone() }
    }

    /// Loads what a model lacked; whether something was loaded, so that it is worth another attempt.
    pub fn load_missing(&mut self, missing: &BTreeSet<Ident>) -> bool {
        let mut loaded = false;
        for name in missing {
            // A library that cannot be loaded is missed again by what needs it.
            loaded |= self.autoload_class(*name).unwrap_or(false);
        }
        loaded
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
            // The version of a library follows a blank.
            Ident::new(name.split(' ').next().unwrap_or(name))
        };
        let shipped = crate::packages::list(Path::new(crate::packages::FOLDER)).unwrap_or_default();
        names.chain(shipped).map(class).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::world::MemoryWorld;

    #[test]
    fn the_libraries_that_a_library_uses_are_there_when_a_model_is_examined() {
        let pumps = "package Pumps model Pump Fluids.Port port; equation port.f = port.p; end Pump; \
            annotation(uses(Fluids(version = \"1\"), Nowhere(version = \"1\"))); end Pumps;";
        let fluids = "package Fluids connector Port Real p; flow Real f; end Port; end Fluids;";
        let world = MemoryWorld::new()
            .with_file("libraries/Pumps/package.mo", pumps)
            .with_file("libraries/Fluids/package.mo", fluids);
        let mut session = Session::new(Box::new(world));
        session.add_library_dir(Path::new("libraries"));
        let model = Name::parse("Pumps.Pump");
        assert_eq!(session.autoload(&model), Ok(true));
        let checked = session.model_check(&model).run();
        assert!(checked.missing.is_empty() && checked.found.is_empty(), "{checked:?}");
    }
}
