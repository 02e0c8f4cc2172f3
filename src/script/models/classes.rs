//! The classes of a session: those of its scripts, of loaded files and of libraries.

use super::libraries::Warnings;
use crate::diag::{At, Diagnostic, Fault, suggest};
use crate::eval::Function;
use crate::fault;
use crate::flatten::Library;
use crate::flatten::errors::UNKNOWN_CLASS;
use crate::name::{Ident, Name};
use crate::script::Session;
use crate::script::errors::BAD_PARAMETER_VALUE;
use crate::script::language::constants::Answers;
use crate::source::{SourceId, Span, Spanned};
use crate::syntax::ast::{
    ClassDefinition, ComponentReference, Expression, ExpressionKind, Subscript,
};
use crate::syntax::{self, Outline};
use crate::value::Value;
use std::collections::{BTreeMap, HashMap, HashSet};
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// The loaded classes and where more can be found.
#[derive(Default)]
pub(in crate::script) struct Classes {
    pub(in crate::script) library: Library,
    /// Those that are nowhere.
    nowhere: HashSet<Ident>,
    /// Files that were loaded for the class that they are named after and do not define it. They
    /// stay here when other classes are loaded, or two of them would be loaded in turn for ever.
    misnamed: BTreeMap<Ident, PathBuf>,
    /// Functions that loaded ones call and that are no classes: copies for functions passed to them.
    copies: HashMap<Name, Arc<Function>>,
    /// Types and constants that scripts asked for.
    pub(in crate::script) answers: Answers,
    /// Counts what changes what a name can stand for.
    revision: u64,
    /// Folders whose packages are loaded when somebody names them.
    directories: Vec<PathBuf>,
    /// The file of each top-level class that came from one.
    files: BTreeMap<Name, PathBuf>,
    /// The versions of libraries that were asked for.
    pub(super) versions: BTreeMap<Ident, String>,
    /// What is to be told about the encodings of libraries.
    pub(super) warnings: Warnings,
}

impl Classes {
    /// A number that changes with the classes.
    pub(in crate::script) fn revision(&self) -> u64 {
        self.revision
    }

    /// Full names of the loaded functions and of everything else that could be called.
    pub(in crate::script) fn read_names(&self) -> Vec<Name> {
        self.library.known()
    }

    /// Folders whose packages are loaded when somebody names them.
    pub(super) fn directories(&self) -> &[PathBuf] {
        &self.directories
    }

    pub(super) fn add_directory(&mut self, path: PathBuf) {
        self.directories.push(path);
        self.nowhere.clear();
        self.misnamed.clear();
    }

    /// The files or folders of all classes at the top level.
    pub(super) fn packages(&self) -> BTreeMap<Ident, PathBuf> {
        let own = |(name, path): (&Name, &PathBuf)| Some((name.first()?, path.clone()));
        self.files.iter().filter_map(own).collect()
    }

    /// The file or folder of a class at the top level.
    pub(super) fn file_of(&self, name: &Name) -> Option<&PathBuf> {
        self.files.get(name)
    }

    pub(super) fn take_warnings(&self) -> Vec<Diagnostic> {
        self.warnings.lock().map_or(Vec::new(), |mut warnings| std::mem::take(&mut *warnings))
    }

    fn changed(&mut self) {
        self.revision += 1;
        self.nowhere.clear();
        self.copies.clear();
        self.answers.clear();
    }
}

impl Session {
    /// The loaded classes.
    pub fn library(&mut self) -> &mut Library {
        &mut self.classes.library
    }

    /// A number that changes whenever a class is loaded, defined or removed.
    pub fn library_revision(&self) -> u64 {
        self.classes.revision
    }

    /// Whether classes of this file or package folder are loaded already.
    pub(in crate::script) fn has_loaded(&self, path: &Path) -> bool {
        let Some(mut found) = self.find_file(path) else { return false };
        if found.file_name().is_some_and(|name| name == "package.mo") {
            found.pop();
        }
        self.classes.files.values().any(|file| *file == found)
    }

    /// Loads a `.mo` file, or a package from its folder or its `package.mo`, or all that lie in a
    /// folder, and reads all of it. Returns the names of the classes.
    ///
    /// # Errors
    /// What is wrong with the texts; then nothing may be relied on of what they define.
    pub fn load_path(&mut self, path: &Path) -> Result<Vec<Name>, Vec<Diagnostic>> {
        let Some(mut found) = self.find_file(path) else {
            return Err(vec![self.missing_file(path).at(self.call)]);
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
    fn paths_to_load(&self, path: PathBuf) -> Vec<PathBuf> {
        let is_package = |path: &Path| self.world.exists(&path.join("package.mo"));
        if !self.world.is_dir(&path) || is_package(&path) {
            return vec![path];
        }
        let entries = self.world.list_dir(&path).unwrap_or_default().into_iter();
        let inside = entries.map(|entry| path.join(entry));
        inside
            .filter(|path| is_package(path) || path.extension().is_some_and(|e| e == "mo"))
            .collect()
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
    fn package_around(&mut self, path: &Path) -> Result<Name, Vec<Diagnostic>> {
        let is_package = |folder: &&Path| self.world.exists(&folder.join("package.mo"));
        let folders: Vec<&Path> = path.ancestors().skip(1).take_while(is_package).collect();
        let Some(root) = folders.last() else { return Ok(Name::default()) };
        if !self.classes.files.values().any(|file| file == root) {
            self.load_library(root, &Name::default())?;
        }
        let names = folders.iter().rev().map_while(|folder| self.package_in(folder));
        Ok(Name::new(names.collect::<Vec<_>>()))
    }

    /// The name of the package that a folder holds.
    fn package_in(&self, folder: &Path) -> Option<Ident> {
        let bytes = self.world.read(&folder.join("package.mo")).ok()?;
        let (text, _) = syntax::decode(&bytes);
        let package = Outline::of(&text)?.classes.into_iter().next()?;
        Some(Ident::new(&text[package.name]))
    }

    fn load_file(&mut self, path: &Path) -> Result<Vec<Name>, Vec<Diagnostic>> {
        let (source, text) = self.add_file(path).at(self.call).map_err(|error| vec![error])?;
        let names = self.load_source(source, &text, Some(path))?;
        self.note_files(&names, path);
        Ok(names)
    }

    /// Loads a package from its folder; its classes are read when they are needed.
    fn load_library(&mut self, folder: &Path, around: &Name) -> Result<Vec<Name>, Vec<Diagnostic>> {
        self.classes.changed();
        let texts = self.library_texts();
        let one = |error: Diagnostic| vec![error];
        let names =
            self.ask_library(|library| library.load_lazily(&texts, folder, around).map_err(one))?;
        self.note_files(&names, folder);
        self.supply_units(&names).map_err(one)?;
        self.note_versions(&names);
        Ok(names)
    }

    fn note_files(&mut self, names: &[Name], path: &Path) {
        for name in names.iter().filter(|name| name.is_simple()) {
            self.classes.files.insert(name.clone(), path.to_owned());
        }
    }

    /// Loads classes from a text; `name` stands in diagnostics.
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
        self.classes.changed();
        let around = path.map_or(Ok(Name::default()), |path| self.package_around(path))?;
        if !around.parts.is_empty() && file.within.is_none() {
            file.within = Some(Spanned { node: around, span: Span::new(source, 0, 0) });
        }
        if let Some(package) = file.within.as_ref().and_then(|within| within.node.first()) {
            self.autoload_class(package)?;
        }
        let names = self.ask_library(|library| library.load(&file).map_err(|error| vec![error]))?;
        self.note_versions(&names);
        Ok(names)
    }

    /// Loads the top-level class that a name begins with, if it is not loaded and can be found.
    /// Returns whether something was loaded.
    pub(super) fn autoload(&mut self, name: &Name) -> Result<bool, Vec<Diagnostic>> {
        match name.first() {
            Some(first) => self.autoload_class(first),
            None => Ok(false),
        }
    }

    fn autoload_class(&mut self, name: Ident) -> Result<bool, Vec<Diagnostic>> {
        let nowhere = &self.classes.nowhere;
        if self.defines(name)
            || nowhere.contains(&name)
            || self.classes.misnamed.contains_key(&name)
        {
            return Ok(false);
        }
        let Some(path) = self.search_class(name) else {
            self.classes.nowhere.insert(name);
            return Ok(false);
        };
        if self.world.is_dir(&path) {
            self.load_library(&path, &Name::default())?;
        } else {
            self.load_file(&path)?;
        }
        let found = self.defines(name);
        if !found {
            self.classes.misnamed.insert(name, path);
        }
        Ok(found)
    }

    fn defines(&self, name: Ident) -> bool {
        self.classes.library.find(&Name::from(name)).is_some()
    }

    /// The diagnostic of an unknown class, with what the file of its name defines instead.
    pub(super) fn with_misnamed_file(&self, diagnostic: Diagnostic, name: &Name) -> Diagnostic {
        match self.misnamed_note(name).filter(|_| diagnostic.code == UNKNOWN_CLASS) {
            Some(note) => diagnostic.help(note),
            None => diagnostic,
        }
    }

    /// What a file defines instead of the class that it is named after.
    fn misnamed_note(&self, name: &Name) -> Option<String> {
        let wanted = name.first()?;
        let path = self.classes.misnamed.get(&wanted)?;
        let own = self.classes.files.iter().filter(|(_, file)| *file == path);
        let names: Vec<String> = own.map(|(own, _)| format!("`{own}`")).collect();
        let file = path.file_name()?.to_string_lossy();
        match names.is_empty() {
            true => Some(format!("`{file}` does not define `{wanted}`")),
            false => Some(format!(
                "`{file}` does not define `{wanted}`; it defines {}",
                names.join(", ")
            )),
        }
    }

    /// Loads what the library asked for and did not have. Returns whether something was loaded:
    /// then what failed is worth another attempt.
    pub(super) fn load_wanted(&mut self) -> Result<bool, Vec<Diagnostic>> {
        let mut loaded = false;
        for name in self.classes.library.take_missing() {
            loaded |= self.autoload_class(name)?;
        }
        Ok(loaded)
    }

    /// Whether a class of this name is loaded or can be.
    ///
    /// # Errors
    /// What is wrong with the texts that would tell.
    pub(in crate::script) fn find_class(&mut self, name: &Name) -> Result<bool, Vec<Diagnostic>> {
        self.autoload(name)?;
        self.ask_library(|library| Ok(library.contains(name)))
    }

    /// The same, the errors reported.
    pub(in crate::script) fn class_exists(&mut self, name: &Name) -> bool {
        let found = self.find_class(name);
        self.or_report_all(found).unwrap_or(false)
    }

    /// A class that a script defines; it replaces one of the same name.
    pub(in crate::script) fn define_class(
        &mut self,
        class: &Arc<ClassDefinition>,
    ) -> Result<(), Diagnostic> {
        self.classes.changed();
        self.classes.library.define(class).map(|_| ())
    }

    /// Whether a class comes from a folder, so that its parts are read when they are needed.
    pub(in crate::script) fn is_lazy(&self, name: &Name) -> bool {
        self.classes.files.get(name).is_some_and(|path| self.world.is_dir(path))
    }

    /// Removes a class; whether there was one.
    pub(in crate::script) fn remove_class(&mut self, name: &Name) -> bool {
        self.classes.changed();
        name.is_simple() && name.first().is_some_and(|name| self.classes.library.remove(name))
    }

    /// Removes all classes.
    pub(in crate::script) fn forget_classes(&mut self) {
        self.classes.changed();
        self.classes.library = Library::new();
        self.classes.files.clear();
        self.classes.misnamed.clear();
        self.classes.versions.clear();
        self.models.forget();
    }

    /// The fault of a class that is not loaded and cannot be found.
    pub(in crate::script) fn unknown_class(&self, name: &Name) -> Fault {
        let wanted = name.to_string();
        let known = self.classes.read_names().iter().map(Name::to_string).collect::<Vec<_>>();
        let last = known.iter().map(|full| full.rsplit('.').next().unwrap_or(full));
        let hint = suggest::did_you_mean(&wanted, known.iter().map(String::as_str))
            .or_else(|| suggest::did_you_mean(&wanted, last));
        let misnamed = self.misnamed_note(name);
        fault!(UNKNOWN_CLASS, "there is no class `{wanted}`").help_if(misnamed).help_if(hint).help(
            "load the file that defines it first, with `openModel` or `loadFile`, or give its \
             folder with `--library`",
        )
    }

    /// A function of the loaded classes, looked up from the top level.
    pub(in crate::script) fn loaded_function(
        &mut self,
        name: &Name,
    ) -> Result<Option<Arc<Function>>, Diagnostic> {
        for candidate in self.candidates(name) {
            if let Some(function) = self.function_named(&candidate)? {
                return Ok(Some(function));
            }
        }
        Ok(None)
    }

    pub(in crate::script) fn function_named(
        &mut self,
        name: &Name,
    ) -> Result<Option<Arc<Function>>, Diagnostic> {
        let first = |mut errors: Vec<Diagnostic>| errors.swap_remove(0);
        if let Some(copy) = self.classes.copies.get(name) {
            return Ok(Some(copy.clone()));
        }
        loop {
            let one = |error: Diagnostic| vec![error];
            match self.ask_library(|library| library.function(name).map_err(one)) {
                Ok(None) => return Ok(None),
                Ok(Some(functions)) => {
                    let own = functions.values().next().cloned();
                    let Classes { library, copies, .. } = &mut self.classes;
                    let made = functions.into_iter();
                    copies.extend(made.filter(|(called, _)| !library.contains(called)));
                    return Ok(own);
                }
                Err(errors) => {
                    if !self.load_wanted().map_err(first)? {
                        return Err(first(errors));
                    }
                }
            }
        }
    }

    /// The file that a path or a `modelica://Package/…` URI names.
    pub(in crate::script) fn resource(&mut self, uri: &str) -> Result<PathBuf, Fault> {
        if let Some(rest) = uri.strip_prefix("modelica://") {
            let (package, file) = rest.split_once('/').unwrap_or((rest, ""));
            let package = Name::parse(package);
            let top = Name::new(package.first());
            if let (true, Some(folder)) = (self.class_exists(&top), self.classes.files.get(&top)) {
                let inner = package.parts[1..].iter().map(|part| part.as_str());
                return Ok(folder.join(inner.collect::<PathBuf>()).join(file));
            }
        }
        let path = Path::new(uri);
        self.find_file(path).ok_or_else(|| self.missing_file(path))
    }

    /// The value that a parameter of the model translated last has.
    pub(in crate::script) fn model_value(
        &mut self,
        reference: &ComponentReference,
    ) -> Result<Option<Value>, Diagnostic> {
        let value = flat_name(reference).and_then(|name| self.parameter_value(&name));
        Ok(value.map(Value::Real))
    }

    /// Sets a flag, or a parameter of the model translated last.
    pub(in crate::script) fn assign_dotted(
        &mut self,
        target: &ComponentReference,
        value: Value,
        span: Span,
    ) -> Result<bool, Diagnostic> {
        if self.set_flag(target, &value) {
            return Ok(true);
        }
        if self.models.last().is_none() {
            return Err(self.nothing_translated(target).at(target.span));
        }
        let Some(name) = flat_name(target) else {
            let message = "subscripts of a model component must be Integers";
            return Err(Fault::new(BAD_PARAMETER_VALUE, message).at(target.span));
        };
        let number = match value {
            Value::Boolean(value) => f64::from(value),
            Value::Enumeration(value) => value.ordinal as f64,
            other => match other.as_real() {
                Some(number) => number,
                None => {
                    return Err(fault!(
                        BAD_PARAMETER_VALUE,
                        "`{name}` cannot be set to {}", other.type_name();
                        help: "assign a number, or the elements of an array one by one"
                    )
                    .at(span));
                }
            },
        };
        self.set_parameter(&name, number).at(span)?;
        Ok(true)
    }

    /// The file a class was loaded from, if it was loaded from one.
    pub(in crate::script) fn source_file(&self, name: &Name) -> Option<PathBuf> {
        self.classes.files.get(&Name::new(name.first())).cloned()
    }
}

/// A reference as variables of flat models are named: `pack.cell[2].V`; `None` if a subscript is
/// not an Integer.
fn flat_name(reference: &ComponentReference) -> Option<String> {
    let mut name = String::new();
    for part in &reference.parts {
        if !name.is_empty() {
            name.push('.');
        }
        name.push_str(part.name.as_str());
        let subscripts: Option<Vec<String>> = part
            .subscripts
            .iter()
            .map(|subscript| match subscript {
                Subscript::Index(Expression { kind: ExpressionKind::Integer(at), .. }) => {
                    Some(at.to_string())
                }
                _ => None,
            })
            .collect();
        match subscripts?.join(",") {
            none if none.is_empty() => {}
            subscripts => name.push_str(&format!("[{subscripts}]")),
        }
    }
    Some(name)
}

/// The message of a diagnostic, for places where only that of the caller is known.
pub(in crate::script) fn first_fault(diagnostic: Diagnostic) -> Fault {
    let mut fault = Fault::new(diagnostic.code, diagnostic.message.clone());
    fault.helps.clone_from(&diagnostic.helps);
    fault
}
