//! The classes of open documents and of the libraries that they use.

use super::client::Client;
use super::diagnostics;
use super::document::Document;
use super::lines::Lines;
use super::occurrences::{self, Occurrence};
use super::parsed::{Parsed, file_of};
use super::recovery::{self, Read, Tree};
use super::uri;
use crate::diag::Diagnostic;
use crate::name::Name;
use crate::packages;
use crate::script::language::output::subject;
use crate::script::language::script_checks::check_script;
use crate::script::models::documents::{CheckedModel, ModelCheck};
use crate::script::runs::problem;
use crate::script::{Session, builtins};
use crate::source::{SourceId, Span};
use crate::syntax::ast::Restriction;
use crate::syntax::errors::NOT_A_SCRIPT;
use lsp_types::Location;
use std::collections::{BTreeMap, BTreeSet, VecDeque};
use std::sync::Arc;

/// The newest versions of the open documents, by their names.
pub type Documents = BTreeMap<String, Arc<Document>>;

/// Bytes of former versions that are kept, at most: a session forgets no text, so that it is replaced by
/// another one. With each byte come about 64 of what was found out about it: measured on 1400 versions
/// of a file of 6 kB, which took 510 MB.
const MOST_FORMER: usize = 1 << 20;

/// Classes that are kept when a document is closed, at most. An example of the Modelica Standard Library
/// reads 74 (`CauerLowPassAnalog`) to 626 (`HeatingSystem`); after twelve of its files, one after the
/// other, nothing forgotten, the server takes 220 MB.
const MOST_CLASSES: usize = 500;

/// The session that knows the classes, and what it was given.
pub struct Workspace {
    new_session: Box<dyn Fn() -> Session>,
    pub(super) session: Session,
    /// Who asks.
    pub(super) client: Client,
    parsed: BTreeMap<String, Arc<Parsed>>,
    /// The names of documents, by the names of these, each with the state of the classes.
    names: BTreeMap<String, Names>,
    /// Bytes of all versions that were loaded.
    loaded: usize,
    commands: BTreeSet<&'static str>,
}

/// The names of a document at a state of the classes.
struct Names {
    revision: u64,
    parsed: Arc<Parsed>,
    all: Arc<Vec<Occurrence>>,
}

/// What is left to be found out about a document.
#[derive(Debug)]
pub struct Examination {
    parsed: Arc<Parsed>,
    models: VecDeque<Name>,
    found: Vec<Diagnostic>,
}

impl Workspace {
    /// A workspace whose sessions are made so.
    pub fn new(client: Client, new_session: impl Fn() -> Session + 'static) -> Workspace {
        let session = new_session();
        let new_session = Box::new(new_session);
        Workspace {
            new_session,
            session,
            client,
            parsed: BTreeMap::new(),
            names: BTreeMap::new(),
            loaded: 0,
            commands: builtins::names().into_iter().collect(),
        }
    }

    /// Whether work that takes long may be announced to the client.
    pub(crate) fn shows_progress(&self) -> bool {
        self.client.progress
    }

    /// Files have changed on the disk: all is read again when it is needed.
    pub fn forget(&mut self) {
        self.session = (self.new_session)();
        self.parsed.clear();
        self.names.clear();
        self.loaded = 0;
    }

    /// A document is closed: from now on its file counts.
    pub fn close(&mut self, document: &Document) {
        let saved = document.path.as_ref().and_then(|path| self.session.world.read(path).ok());
        let is_saved =
            saved.is_some_and(|bytes| *crate::syntax::decode(&bytes).0 == *document.text);
        let defines = document.is_script()
            && self.parsed.get(document.uri.as_str()).is_some_and(|one| !one.names.is_empty());
        let is_small = self.session.library().number_read() <= MOST_CLASSES;
        if is_saved && !defines && is_small {
            self.parsed.remove(document.uri.as_str());
            self.names.remove(document.uri.as_str());
        } else {
            self.forget();
        }
    }

    /// A document as it was read, its classes and those of all other open documents loaded.
    pub fn open(&mut self, document: &Arc<Document>, all: &Documents) -> Arc<Parsed> {
        if self.loaded > MOST_FORMER + all.values().map(|one| one.text.len()).sum::<usize>() {
            self.forget();
        }
        self.read(document);
        // Loading a package again forgets the documents inside it, so that those come after it.
        for other in all.values().filter(|other| !other.is_script() && other.uri != document.uri) {
            self.read(other);
        }
        self.read(document)
    }

    /// The same without the line that someone is typing: where a name is completed.
    pub(super) fn open_without_line(
        &mut self,
        document: &Arc<Document>,
        all: &Documents,
        line: usize,
    ) -> Arc<Parsed> {
        let parsed = self.open(document, all);
        if parsed.errors.is_empty() {
            return parsed;
        }
        let source = self.session.sources.add(document.name(), document.text.clone());
        let read = recovery::read_without_line(source, &document.text, document.is_script(), line);
        match read.tree {
            Some(_) => self.load(document, source, read),
            None => parsed,
        }
    }

    fn read(&mut self, document: &Arc<Document>) -> Arc<Parsed> {
        let known = self.parsed.get(document.uri.as_str()).cloned();
        if let Some(known) = known
            && Arc::ptr_eq(&known.document.text, &document.text)
            && self.is_loaded(&known)
        {
            return known;
        }
        let source = self.session.sources.add(document.name(), document.text.clone());
        let read = match document.is_toml() {
            true => Read { tree: None, errors: Vec::new() },
            false => recovery::read(source, &document.text, document.is_script()),
        };
        let parsed = self.load(document, source, read);
        self.parsed.insert(document.uri.as_str().to_owned(), parsed.clone());
        parsed
    }

    fn load(&mut self, document: &Arc<Document>, source: SourceId, read: Read) -> Arc<Parsed> {
        self.loaded += document.text.len();
        let (mut names, mut errors) = (Vec::new(), read.errors);
        if let Some(tree) = &read.tree {
            let path = document.path.as_deref().filter(|_| !document.is_script());
            if document.is_script()
                && let Some(path) = &document.path
            {
                self.session.search_beside(path);
            }
            match self.session.load_document(path, &file_of(tree)) {
                Ok(loaded) => names = loaded,
                Err(wrong) if errors.is_empty() => errors = wrong,
                Err(_) => {}
            }
        }
        Arc::new(Parsed { document: document.clone(), source, tree: read.tree, errors, names })
    }

    /// The names of a document and what they mean.
    pub(super) fn names(&mut self, parsed: &Arc<Parsed>) -> Arc<Vec<Occurrence>> {
        let name = parsed.document.uri.as_str();
        let revision = self.session.library_revision();
        if let Some(known) = self.names.get(name)
            && known.revision == revision
            && Arc::ptr_eq(&known.parsed, parsed)
        {
            return known.all.clone();
        }
        let all = Arc::new(self.names_once(parsed));
        // Looking them up may have loaded libraries.
        let revision = self.session.library_revision();
        let names = Names { revision, parsed: parsed.clone(), all: all.clone() };
        self.names.insert(name.to_owned(), names);
        all
    }

    /// The same, not kept.
    pub(super) fn names_once(&mut self, parsed: &Parsed) -> Vec<Occurrence> {
        let commands = &self.commands;
        self.session.ask(|library| occurrences::of(library, parsed, commands))
    }

    /// A file of a library that is loaded, as it was read; `None` if its classes are not those of the
    /// library.
    pub(super) fn as_loaded(
        &mut self,
        document: &Arc<Document>,
        source: SourceId,
        read: Read,
    ) -> Option<Arc<Parsed>> {
        let tree = read.tree?;
        let file = file_of(&tree);
        let package = file.within.as_ref().map_or(Name::default(), |within| within.node.clone());
        let names: Vec<Name> =
            file.classes.iter().map(|class| package.child(class.name.node)).collect();
        let is_known = names.iter().all(|name| self.session.class_id(name).is_some());
        let (document, tree) = (document.clone(), Some(tree));
        is_known.then(|| Arc::new(Parsed { document, source, tree, errors: Vec::new(), names }))
    }

    /// Whether its classes are those that their names mean: another document may declare them too.
    fn is_loaded(&mut self, parsed: &Parsed) -> bool {
        let library = self.session.library();
        let is_own = |name: &Name| {
            library.definition(name).is_some_and(|class| class.span.source == parsed.source)
        };
        parsed.names.iter().all(is_own)
    }

    /// What is wrong with a script or a problem, which name files of classes: of those that are open the
    /// contents of the editor count.
    fn check_user_of_files(&mut self, parsed: &Parsed, all: &Documents) -> Vec<Diagnostic> {
        let open = all.values().filter(|document| document.is_modelica());
        let open: Vec<_> = open.filter_map(|own| Some((own.path.as_ref()?, &own.text))).collect();
        open.iter().for_each(|(path, text)| self.session.world.give(path, text.as_bytes()));
        let mut found = self.check_script(parsed);
        found.extend(self.check_problem(parsed));
        open.iter().for_each(|(path, _)| self.session.world.take_back(path));
        found
    }

    /// What is wrong with the calls of a script.
    fn check_script(&mut self, parsed: &Parsed) -> Vec<Diagnostic> {
        let Some(Tree::Script(script)) = &parsed.tree else { return Vec::new() };
        let path = parsed.document.path.as_ref();
        // The user has opened this file, but not those that it names.
        if let Some(path) = path {
            self.session.world.grant_input(path);
        }
        check_script(&mut self.session, script, path.and_then(|path| path.parent()))
    }

    /// What is wrong with a problem file, as `gapi identify` says before a run.
    fn check_problem(&mut self, parsed: &Parsed) -> Vec<Diagnostic> {
        let document = &parsed.document;
        let Some(path) = document.path.as_ref().filter(|_| document.is_problem()) else {
            return Vec::new();
        };
        self.session.world.grant_input(path);
        problem::check(&mut self.session, path, (parsed.source, &document.text))
    }

    /// Begins to look for what is wrong with a document: with its text and the names in it.
    pub(crate) fn examine(&mut self, document: &Arc<Document>, all: &Documents) -> Examination {
        let parsed = self.open(document, all);
        let mut found = parsed.errors.clone();
        found.retain(|error| error.code != NOT_A_SCRIPT);
        let mut models = VecDeque::new();
        if parsed.errors.is_empty() {
            found.extend(self.check_user_of_files(&parsed, all));
            for (name, class) in parsed.all_classes() {
                found.extend(self.session.examine_class(&name));
                let is_model = matches!(class.restriction, Restriction::Model | Restriction::Block);
                if is_model && !self.is_partial(&name) {
                    models.push_back(name);
                }
            }
        }
        Examination { parsed, models, found }
    }

    /// Whether a class is incomplete: it or one around it is partial.
    fn is_partial(&mut self, name: &Name) -> bool {
        let library = self.session.library();
        let mut name = name.clone();
        while !name.parts.is_empty() {
            if library.definition(&name).is_some_and(|class| class.partial) {
                return true;
            }
            name = name.parent();
        }
        false
    }

    /// How many models of a document are left.
    pub(crate) fn models_left(examination: &Examination) -> usize {
        examination.models.len()
    }

    /// The work on one more model of a document, for any thread; `None` if none is left.
    pub(crate) fn next_model(&mut self, examination: &mut Examination) -> Option<ModelCheck> {
        let model = examination.models.pop_front()?;
        Some(self.session.model_check(&model))
    }

    /// What was found out about a model. If it lacked a library that can be loaded, the model is left
    /// again.
    pub(crate) fn add_model(&mut self, examination: &mut Examination, checked: CheckedModel) {
        if self.session.load_missing(&checked.missing) {
            examination.models.push_front(checked.model);
        } else {
            examination.found.extend(checked.found);
        }
    }

    /// What was found so far, for the editor.
    pub fn diagnostics(&self, examination: &Examination) -> Vec<lsp_types::Diagnostic> {
        let mut seen = BTreeSet::new();
        let is_new = |one: &&Diagnostic| {
            let span = one.span();
            seen.insert((one.code.slug, span.source, span.start, subject(one).to_owned()))
        };
        let distinct = examination.found.iter().filter(is_new);
        distinct
            .map(|one| diagnostics::of(&examination.parsed, one, |span| self.location(span)))
            .collect()
    }

    /// The place of a span in the protocol, in whatever document or file it is.
    pub(super) fn location(&self, span: Span) -> Option<Location> {
        let source = self.session.sources.get(span.source)?;
        let bytes = span.start as usize..span.end as usize;
        let open = self.parsed.values().find(|parsed| parsed.source == span.source);
        if let Some(parsed) = open {
            let uri = parsed.document.uri.clone();
            return Some(Location { uri, range: parsed.document.range(bytes) });
        }
        let path = self.session.file_of_source(span.source)?;
        // What is part of the program has no file.
        let uri = uri::of_path(&path).filter(|_| !path.starts_with(packages::FOLDER))?;
        let lines = Lines::of(&source.text);
        Some(Location { uri, range: lines.range(&source.text, bytes) })
    }
}
