//! The classes of a session: those of its scripts, of loaded files and of libraries.

use super::constant_cache::ConstantCache;
use super::library_files::Warnings;
use super::stored::{History, Reads, digest};
use super::uses::LoadedSources;
use crate::diag::{Diagnostic, Fault, suggest};
use crate::eval::Function;
use crate::fault;
use crate::flatten::errors::UNKNOWN_CLASS;
use crate::flatten::{Library, RecordedInput};
use crate::name::{Ident, Name};
use crate::source::{SourceId, Span};
use crate::syntax;
use crate::syntax::ast::ClassDefinition;
use indexmap::IndexMap;
use std::collections::{BTreeMap, BTreeSet, HashMap, HashSet};
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// The loaded classes and where more can be found.
#[derive(Default)]
pub(crate) struct Classes {
    /// Trees of classes, and what is looked up in them.
    pub library: Library,
    /// Those that are nowhere.
    nowhere: HashSet<Ident>,
    /// Files that were loaded for the class that they are named after and do not define it. They
    /// stay here when other classes are loaded, or two of them would be loaded alternately without end.
    misnamed: BTreeMap<Ident, PathBuf>,
    /// Functions that loaded ones call and that are no classes: copies for functions passed to them.
    copies: HashMap<Name, Arc<Function>>,
    /// Types and constants that scripts asked for.
    pub constants: ConstantCache,
    /// Classes that runs build around models.
    pub(crate) enclosing: Vec<Enclosing>,
    /// Counts what changes what a name can stand for.
    revision: u64,
    /// Folders whose packages are loaded when they are first named.
    directories: Vec<PathBuf>,
    /// Folders of packages that were named themselves.
    named: BTreeMap<Ident, PathBuf>,
    /// The file of each top-level class that came from one.
    files: BTreeMap<Name, PathBuf>,
    /// The files that were loaded as a whole, not as part of a library, by their sources.
    pub single: BTreeMap<SourceId, PathBuf>,
    /// The versions of libraries that were asked for.
    pub versions: BTreeMap<Ident, String>,
    /// Warnings about the encodings of libraries.
    pub warnings: Warnings,
    /// How the classes came to be what they are.
    pub history: History,
    /// What was asked of the disk for them.
    pub reads: Reads,
    /// What the model that is translated asks for itself.
    pub(super) model_files: Reads,
    /// What they were loaded from.
    pub sources: LoadedSources,
}

/// A class that a run builds around a model of the user, who has written neither its name nor its
/// text: messages speak of the model, at the place that the class was built for.
#[derive(Debug, Clone)]
pub(crate) struct Enclosing {
    /// Its name.
    pub name: Ident,
    /// The model around which it was built.
    pub model: String,
    /// Names of its own elements, with what they are called instead.
    pub elements: Vec<(String, String)>,
    /// Those of its inputs that have samples.
    pub recorded: Vec<RecordedInput>,
    /// The source of the text that was generated for it.
    pub source: SourceId,
    /// The place that it was built for.
    pub place: Span,
}

impl Enclosing {
    fn in_users_terms(&self, text: &str) -> String {
        let own = self.elements.iter().map(|(name, words)| (name.as_str(), words.as_str()));
        let quoted = format!("`{}`", self.name);
        let model = format!("`{}`", self.model);
        own.chain([(quoted.as_str(), model.as_str())])
            .filter(|(name, _)| text.contains(*name))
            .fold(text.to_owned(), |text, (name, words)| text.replace(name, words))
    }
}

impl Classes {
    /// The diagnostic without names and places of classes that the user has not written.
    pub(crate) fn in_users_terms(&self, diagnostic: Diagnostic) -> Diagnostic {
        self.enclosing.iter().fold(diagnostic, |diagnostic, enclosing| {
            let place = |span: Span| match span.source == enclosing.source {
                true => enclosing.place,
                false => span,
            };
            diagnostic.with_spans(place).with_words(|text| enclosing.in_users_terms(text))
        })
    }

    /// The class of this name, if a run has built it.
    pub(crate) fn enclosing_named(&self, name: &Name) -> Option<&Enclosing> {
        let is_it =
            |enclosing: &&Enclosing| name.is_simple() && name.first() == Some(enclosing.name);
        self.enclosing.iter().find(is_it)
    }

    /// What messages call the class of this name.
    pub(crate) fn shown_name(&self, name: &Name) -> Option<&str> {
        self.enclosing_named(name).map(|enclosing| enclosing.model.as_str())
    }

    /// A number that changes with the classes.
    pub(crate) fn revision(&self) -> u64 {
        self.revision
    }

    /// Full names of the loaded functions and of everything else that could be called.
    pub(crate) fn read_names(&self) -> Vec<Name> {
        self.library.known()
    }

    /// Folders whose packages are loaded when they are first named.
    pub(crate) fn directories(&self) -> &[PathBuf] {
        &self.directories
    }

    pub(super) fn add_directory(&mut self, path: PathBuf) {
        self.directories.push(path);
        self.forget_missing();
    }

    /// The folders that were named for packages.
    pub(super) fn named_packages(&self) -> &BTreeMap<Ident, PathBuf> {
        &self.named
    }

    pub(super) fn add_named(&mut self, package: Ident, path: PathBuf) {
        self.named.entry(package).or_insert(path);
        self.forget_missing();
    }

    fn forget_missing(&mut self) {
        self.nowhere.clear();
        self.misnamed.clear();
    }

    /// The files or folders of all classes at the top level.
    pub(crate) fn packages(&self) -> BTreeMap<Ident, PathBuf> {
        let own = |(name, path): (&Name, &PathBuf)| Some((name.first()?, path.clone()));
        self.files.iter().filter_map(own).collect()
    }

    /// The file or folder of a class at the top level.
    pub(crate) fn file_of(&self, name: &Name) -> Option<&PathBuf> {
        self.files.get(name)
    }

    pub(super) fn take_warnings(&self) -> Vec<Diagnostic> {
        self.warnings.lock().map_or(Vec::new(), |mut warnings| std::mem::take(&mut *warnings))
    }

    /// The classes are going to change: what was known about names holds no longer.
    pub(crate) fn invalidate(&mut self) {
        self.revision += 1;
        self.nowhere.clear();
        self.copies.clear();
        self.constants.clear();
    }

    /// Forgets all classes.
    pub(crate) fn forget(&mut self) {
        self.invalidate();
        self.history.note("forget", "");
        self.library = Library::new();
        self.files.clear();
        self.misnamed.clear();
        self.versions.clear();
        self.sources.clear();
        self.enclosing.clear();
    }

    /// Whether classes of this file or package folder are loaded.
    pub(crate) fn has_loaded(&self, path: &Path) -> bool {
        self.files.values().any(|file| file == path)
    }

    /// The top-level classes that were loaded from this file or folder.
    pub(super) fn loaded_from(&self, path: &Path) -> Vec<&Name> {
        self.files.iter().filter(|(_, file)| *file == path).map(|(name, _)| name).collect()
    }

    /// Top-level classes were loaded from this file or folder.
    pub(crate) fn note_files(&mut self, names: &[Name], path: &Path) {
        for name in names.iter().filter(|name| name.is_simple()) {
            self.files.insert(name.clone(), path.to_owned());
        }
    }

    /// Whether there is a top-level class of this name.
    pub(crate) fn defines(&self, name: Ident) -> bool {
        self.library.find(&Name::from(name)).is_some()
    }

    /// Whether a class of this name was looked for in vain.
    pub(crate) fn is_missing(&self, name: Ident) -> bool {
        self.nowhere.contains(&name) || self.misnamed.contains_key(&name)
    }

    /// There is no file of this class.
    pub(crate) fn note_nowhere(&mut self, name: Ident) {
        self.nowhere.insert(name);
    }

    /// The file that is named after this class does not define it.
    pub(crate) fn note_misnamed(&mut self, name: Ident, path: PathBuf) {
        self.misnamed.insert(name, path);
    }

    /// The copy of this name that was made for functions passed to a function.
    pub(crate) fn copy(&self, name: &Name) -> Option<Arc<Function>> {
        self.copies.get(name).cloned()
    }

    /// Keeps the functions that are no classes of their own.
    pub(crate) fn keep_copies(&mut self, functions: IndexMap<Name, Arc<Function>>) {
        let Classes { library, copies, .. } = self;
        copies.extend(functions.into_iter().filter(|(called, _)| !library.contains(called)));
    }

    /// The diagnostic of an unknown class, with what the file of its name defines instead.
    pub(crate) fn with_misnamed_file(&self, diagnostic: Diagnostic, name: &Name) -> Diagnostic {
        if diagnostic.code != UNKNOWN_CLASS {
            return diagnostic;
        }
        match self.misnamed_note(name).or_else(|| self.loaded_note(name)) {
            Some(note) => diagnostic.help(note),
            None => diagnostic,
        }
    }

    /// What a file defines instead of the class that it is named after.
    fn misnamed_note(&self, name: &Name) -> Option<String> {
        let requested = name.first()?;
        let path = self.misnamed.get(&requested)?;
        let own = self.files.iter().filter(|(_, file)| *file == path);
        let names: Vec<String> = own.map(|(own, _)| format!("`{own}`")).collect();
        let file = path.file_name()?.to_string_lossy();
        match names.is_empty() {
            true => Some(format!("`{file}` does not define `{requested}`")),
            false => Some(format!(
                "`{file}` does not define `{requested}`; it defines {}",
                names.join(", ")
            )),
        }
    }

    /// What the files that were loaded by hand define, where a class in none of them is requested.
    fn loaded_note(&self, name: &Name) -> Option<String> {
        const MOST: usize = 3;
        let requested = name.first()?;
        let files: BTreeSet<&PathBuf> = self.files.values().collect();
        if self.files.keys().any(|own| own.first() == Some(requested)) || files.len() > MOST {
            return None;
        }
        let defined = files.iter().map(|path| {
            let own = self.files.iter().filter(|(_, file)| file == path);
            let names: Vec<String> = own.map(|(own, _)| format!("`{own}`")).collect();
            let file = path.file_name().unwrap_or_default().to_string_lossy();
            format!("`{file}` defines {}", names.join(", "))
        });
        let defined = defined.collect::<Vec<_>>().join("; ");
        (!defined.is_empty()).then_some(defined)
    }

    /// The fault of a class that is not loaded and cannot be found.
    pub(crate) fn unknown_class(&self, name: &Name) -> Fault {
        let requested = name.to_string();
        let known = self.read_names().iter().map(Name::to_string).collect::<Vec<_>>();
        let last = known.iter().map(|full| full.rsplit('.').next().unwrap_or(full));
        let hint = suggest::did_you_mean(&requested, known.iter().map(String::as_str))
            .or_else(|| suggest::did_you_mean(&requested, last));
        let misnamed = self.misnamed_note(name);
        fault!(UNKNOWN_CLASS, "there is no class `{requested}`").help_if(misnamed).help_if(hint)
    }

    /// The same in a script, which can load it.
    pub(crate) fn class_to_load(&self, name: &Name) -> Fault {
        self.unknown_class(name).help(
            "load the file that defines it first, with `openModel` or `loadFile`, or give its \
             folder with `--library`",
        )
    }

    /// A class that a script defines; it replaces one of the same name.
    pub(crate) fn define(&mut self, class: &Arc<ClassDefinition>) -> Result<(), Diagnostic> {
        self.invalidate();
        // An edited class still has the place of the text that it was read from.
        let text = syntax::print::class(class);
        self.history.note("class", &text);
        self.sources.note(&[class.name.node.into()], &text);
        self.library.define(class).map(|_| ())
    }

    /// A class that a run builds around a model; it replaces the one of the same name.
    pub(crate) fn define_enclosing(
        &mut self,
        class: ClassDefinition,
        enclosing: Enclosing,
    ) -> Result<(), Diagnostic> {
        self.invalidate();
        let mut text = syntax::print::class(&class);
        enclosing.recorded.iter().for_each(|input| text += &in_short(input));
        self.history.note("enclosing", &text);
        self.sources.note(&[class.name.node.into()], &text);
        self.enclosing.retain(|known| known.name != enclosing.name);
        self.enclosing.push(enclosing);
        self.library.define(&Arc::new(class)).map(|_| ())
    }

    /// Removes a class; whether there was one.
    pub(crate) fn remove(&mut self, name: &Name) -> bool {
        self.invalidate();
        self.history.note("remove", &name.to_string());
        self.sources.remove(name);
        name.is_simple() && name.first().is_some_and(|name| self.library.remove(name))
    }
}

/// What tells the samples of an input from others.
fn in_short(input: &RecordedInput) -> String {
    let numbers = input.times.iter().chain(&*input.values);
    let bytes: Vec<u8> = numbers.flat_map(|number| number.to_bits().to_le_bytes()).collect();
    format!("{} {} {:?}", input.name, input.is_held, digest(&bytes))
}
