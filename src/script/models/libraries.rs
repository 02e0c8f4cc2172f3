//! Libraries: where they are found, and their files as classes are read from them.

use super::library_files::SourceFiles;
use crate::Session;
use crate::access::policy::{Access, Refusal, refusal_of};
use crate::diag::{Diagnostic, Fault};
use crate::errors::{FILE_ERROR, OTHER_VERSION};
use crate::flatten::LibraryFiles;
use crate::name::{Ident, Name};
use crate::packages;
use crate::syntax::ast::{
    Annotation, Argument, Binding, ClassDefinition, ClassSpecifier, ExpressionKind, Modification,
    Section,
};
use crate::syntax::{self, Outline};
use crate::world::normalized;
use crate::{fault, flatten::Library};
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
        if let Some(name) = self.package_in(&path) {
            self.classes.add_named(name, path);
        }
    }

    /// The name of the package that a folder holds.
    pub(super) fn package_in(&self, folder: &Path) -> Option<Ident> {
        let bytes = self.world.bytes_of(&folder.join("package.mo")).ok()?;
        let (text, _) = syntax::decode(&bytes);
        let package = Outline::of(&text)?.classes.into_iter().next()?;
        Some(Ident::new(&text[package.name]))
    }

    /// The files of a library that is going to be loaded.
    pub fn library_files(&self) -> Arc<dyn LibraryFiles> {
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

    /// Where the top-level class of this name is: in the library folders, the working directory,
    /// a folder `models` beside the scripts being run or above them, or in the program. A package
    /// whose own folder was named comes first, then a folder of the version that was asked for, and
    /// one with the name in other case last.
    pub fn search_class(&self, name: Ident) -> Option<PathBuf> {
        if let Some(named) = self.classes.named_packages().get(&name) {
            return Some(named.clone());
        }
        let folders = self.class_folders();
        let exact = self.classes.versions.get(&name).and_then(|version| {
            let required = format!("{name} {version}");
            folders.iter().find_map(|folder| self.version_in(folder, &required))
        });
        let name = name.as_str();
        exact
            .or_else(|| folders.iter().find_map(|folder| self.class_in(folder, name)))
            .or_else(|| folders.iter().find_map(|folder| self.in_other_case(folder, name)))
    }

    /// Asks for the first of these versions that is there, when the library is loaded.
    pub(crate) fn require_version(&mut self, name: &Name, versions: Vec<String>) {
        let Some(library) = name.first() else { return };
        let folders = self.class_folders();
        let required = versions.into_iter().take_while(|version| version != "default");
        let found = required.into_iter().find(|version| {
            let named = format!("{library} {version}");
            folders.iter().any(|folder| self.version_in(folder, &named).is_some())
        });
        if let Some(version) = found {
            self.classes.versions.insert(library, version);
        }
    }

    /// Folders that were named for libraries.
    pub(crate) fn library_folders(&self) -> &[PathBuf] {
        self.classes.directories()
    }

    fn class_folders(&self) -> Vec<PathBuf> {
        let may_read = |folder: &PathBuf| self.world.permits(folder, Access::Read).is_ok();
        let own = self.classes.directories().iter().cloned().chain([self.world.current_dir()]);
        let models = self.models_folders().into_iter().filter(may_read);
        let all = own.chain(models).chain([PathBuf::from(packages::FOLDER)]);
        all.map(|folder| normalized(&folder)).collect()
    }

    /// The folders `models` beside the scripts being run and the working directory, or above them.
    fn models_folders(&self) -> Vec<PathBuf> {
        let current = self.world.current_dir();
        let frames = self.world.folders().flat_map(Path::ancestors);
        frames.chain(current.ancestors()).map(|folder| folder.join("models")).collect()
    }

    /// Warnings about folders `models` in which a class would be found and is not looked for.
    pub(super) fn passed_over(&self, name: Ident) -> Vec<Fault> {
        let why = |folder: &Path| {
            let refused = self.world.permits(folder, Access::Read).err()?;
            let refusal = refusal_of(&refused)?;
            matches!(refusal, Refusal::Link | Refusal::Owner).then_some(refusal)
        };
        let warning = |folder: &PathBuf| {
            let refusal = why(folder).filter(|_| self.class_in(folder, name.as_str()).is_some())?;
            Some(fault!(FILE_ERROR, "`{name}` is not taken from `{}`: {refusal}", folder.display();
                help: "if you trust this library, give its folder with `--library`"))
        };
        self.models_folders().iter().filter_map(warning).collect()
    }

    /// The folder `Name 1.2.3`, also with more after it: `Name 1.2.3+build.4`.
    fn version_in(&self, folder: &Path, required: &str) -> Option<PathBuf> {
        let entries = self.world.list_dir(folder).ok()?;
        let fits = |entry: &&String| {
            entry
                .strip_prefix(required)
                .is_some_and(|rest| !rest.starts_with(char::is_alphanumeric))
        };
        let found = entries.iter().find(fits)?;
        Some(folder.join(found))
    }

    fn class_in(&self, folder: &Path, name: &str) -> Option<PathBuf> {
        let package = folder.join(name);
        if self.world.exists(&package.join("package.mo")) {
            return Some(package);
        }
        let file = folder.join(format!("{name}.mo"));
        if self.world.exists(&file) {
            return Some(file);
        }
        let prefix = format!("{name} ");
        let entries = self.world.list_dir(folder).ok()?;
        let versions = entries.iter().filter(|entry| entry.starts_with(&prefix));
        let newest = versions.max_by_key(|entry| numbers(&entry[prefix.len()..]))?;
        Some(folder.join(newest))
    }

    fn in_other_case(&self, folder: &Path, name: &str) -> Option<PathBuf> {
        let entries = self.world.list_dir(folder).ok()?;
        let mut same = entries.iter().filter(|entry| entry.eq_ignore_ascii_case(name));
        let found = same.find(|entry| self.world.exists(&folder.join(entry).join("package.mo")));
        found.map(|entry| folder.join(entry))
    }

    /// Notes the versions that loaded packages ask for, and tells if another one is loaded.
    pub(crate) fn note_versions(&mut self, names: &[Name]) {
        for name in names {
            let Some(definition) = self.classes.library.definition(name) else { continue };
            for (library, version) in uses(&definition) {
                self.classes.versions.entry(library).or_insert(version);
            }
        }
        for name in names.iter().filter(|name| name.is_simple()) {
            if let Some(fault) = self.other_version(name) {
                self.report(fault.at(self.call_site()).warning());
            }
        }
    }

    /// The `version` annotation of a loaded package; empty without.
    pub(crate) fn class_version(&self, name: &Name) -> Result<String, Fault> {
        let definition = self.classes.library.definition(name);
        let definition = definition.ok_or_else(|| self.classes.class_to_load(name))?;
        Ok(version(&definition).unwrap_or_default())
    }

    /// The warning about a library that is older than what was asked for, or of another main
    /// version. The library in the program serves models of all versions.
    fn other_version(&self, name: &Name) -> Option<Fault> {
        let required = self.classes.versions.get(&name.first()?)?;
        let definition = self.classes.library.definition(name)?;
        let loaded = version(&definition)?;
        let is_shipped = self.classes.file_of(name)?.starts_with(packages::FOLDER);
        let (asked, given) = (numbers(required), numbers(&loaded));
        let fits = asked.first() == given.first() && asked <= given;
        let converts = match self.classes.library.converts_from(name, required) {
            true => "its conversion script is applied; ",
            false => "",
        };
        (!fits && !is_shipped).then(|| {
            fault!(OTHER_VERSION, "version {loaded} of library `{name}` is loaded, but version \
                                   {required} is required";
                help: "{converts}if results differ, give the folder of the required version with \
                       `--library`")
        })
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

/// The numbers of a version, for comparison.
fn numbers(text: &str) -> Vec<u64> {
    text.split(|c: char| !c.is_ascii_digit()).filter_map(|part| part.parse().ok()).collect()
}

/// The `version` annotation of a package (MLS §18.8.2).
fn version(definition: &ClassDefinition) -> Option<String> {
    string(annotated(definition, "version")?)
}

/// The libraries that a package uses, with their versions (MLS §18.8.3).
fn uses(definition: &ClassDefinition) -> Vec<(Ident, String)> {
    let Some(uses) = annotated(definition, "uses") else { return Vec::new() };
    let library = |argument: &Argument| {
        let (name, modification) = named(argument)?;
        let version = modification.arguments.iter().filter_map(named);
        let version = version.filter(|(name, _)| *name == "version").find_map(|(_, v)| string(v));
        Some((name, version?))
    };
    uses.arguments.iter().filter_map(library).collect()
}

/// What an annotation of a class says about a name.
fn annotated<'a>(definition: &'a ClassDefinition, name: &str) -> Option<&'a Modification> {
    let ClassSpecifier::Long(long) = &definition.specifier else { return None };
    let annotation = |section: &'a Section| match section {
        Section::Annotation(Annotation { arguments, .. }) => Some(arguments),
        _ => None,
    };
    let mut arguments = long.sections.iter().filter_map(annotation).flatten().filter_map(named);
    arguments.find(|(known, _)| *known == name).map(|(_, modification)| modification)
}

fn named(argument: &Argument) -> Option<(Ident, &Modification)> {
    match argument {
        Argument::Element(element) => {
            Some((element.name.node.last()?, element.modification.as_ref()?))
        }
        Argument::Redeclaration(_) => None,
    }
}

fn string(modification: &Modification) -> Option<String> {
    let Some(Binding::Expression(value)) = &modification.binding else { return None };
    match &value.kind {
        ExpressionKind::String(text) => Some(text.to_string()),
        _ => None,
    }
}
