//! What no bytes may make panic or hang. The fuzz targets call these functions with inputs that are
//! led by coverage, the suite with a corpus and fixed mutations of it.

use gapilib::Session;
use gapilib::embedding::Embedding;
use gapilib::internals::flatten::{Library, flatten};
use gapilib::internals::identify::problem;
use gapilib::internals::lsp::{Client, Document, Documents, Workspace, answer};
use gapilib::internals::mat::{self, MatFile};
use gapilib::internals::script::runs::problem::{RunOptions, solve};
use gapilib::internals::source::SourceId;
use gapilib::internals::syntax::ast::StoredDefinition;
use gapilib::internals::syntax::visit::{WithoutSpans, rewrite_script, rewrite_stored_definition};
use gapilib::internals::syntax::{decode, parse_script, parse_stored_definition, print};
use gapilib::results;
use gapilib::world::{MemoryWorld, Store};
use lsp_types::{TextDocumentContentChangeEvent, TextDocumentItem};
use serde_json::json;
use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex};

/// How often a session looks whether it has to stop: often enough for small scripts.
const QUESTIONS: u64 = 3000;

/// The reader of `.mo` files.
pub(crate) fn parse_model(bytes: &[u8]) {
    let (text, _) = decode(bytes);
    let _ = parse_stored_definition(SourceId::NONE, &text);
}

/// The reader of `.mos` files.
pub(crate) fn run_parser_of_scripts(bytes: &[u8]) {
    let (text, _) = decode(bytes);
    let _ = parse_script(SourceId::NONE, &text);
}

/// What is read and printed reads back as the same tree.
pub(crate) fn print_and_parse(bytes: &[u8]) {
    let Ok(text) = std::str::from_utf8(bytes) else { return };
    if let Ok(mut tree) = parse_script(SourceId::NONE, text) {
        let printed = print::script(&tree);
        let mut again = parse_script(SourceId::NONE, &printed).expect("the printed script is read");
        rewrite_script(&mut WithoutSpans, &mut tree);
        rewrite_script(&mut WithoutSpans, &mut again);
        assert_eq!(tree, again, "{printed}");
    }
    if let Ok(mut tree) = parse_stored_definition(SourceId::NONE, text) {
        let printed = print::stored_definition(&tree);
        let mut again =
            parse_stored_definition(SourceId::NONE, &printed).expect("the printed file is read");
        rewrite_stored_definition(&mut WithoutSpans, &mut tree);
        rewrite_stored_definition(&mut WithoutSpans, &mut again);
        assert_eq!(tree, again, "{printed}");
    }
}

fn read(bytes: &[u8]) -> Option<StoredDefinition> {
    let (text, _) = decode(bytes);
    parse_stored_definition(SourceId::NONE, &text).ok()
}

/// Checks and flattens every class of a file.
pub(crate) fn flatten_model(bytes: &[u8]) {
    let Some(file) = read(bytes) else { return };
    let mut library = Library::new();
    let _ = library.load(&file);
    for class in library.all() {
        let _ = gapilib::internals::flatten::check(&library, &class);
        if let Ok(flattened) = flatten(&library, &class, &[]) {
            let _ = flattened.model.to_string();
        }
    }
}

/// Simulates every class at the top of a file for a second, in a world in memory.
pub(crate) fn simulate_model(bytes: &[u8]) {
    let Some(file) = read(bytes) else { return };
    let world = MemoryWorld::new().with_file("M.mo", bytes).interrupted_after(QUESTIONS);
    let mut script = "openModel(\"M.mo\");\n".to_owned();
    for class in &file.classes {
        let name = class.name.node;
        script += &format!("simulateModel(\"{name}\", stopTime = 1, numberOfIntervals = 5);\n");
    }
    Session::new(Box::new(world)).run_text("fuzz.mos", &script);
}

/// Runs a script in a world in memory.
pub(crate) fn run_script(bytes: &[u8]) {
    let Ok(text) = std::str::from_utf8(bytes) else { return };
    let world = MemoryWorld::new().interrupted_after(QUESTIONS);
    Session::new(Box::new(world)).run_text("fuzz.mos", text);
}

/// All columns that the reader of tables returns are equally long.
pub(crate) fn read_csv(bytes: &[u8]) {
    if let Ok(table) = mat::read_csv(bytes) {
        let mut lengths = table.arrays.values().map(|column| column.rows);
        let first = lengths.next();
        assert!(lengths.all(|length| Some(length) == first));
    }
}

/// The reader of MAT files takes no memory that their bytes do not pay for.
pub(crate) fn read_mat(bytes: &[u8]) {
    mat::read(bytes).iter().for_each(whole);
}

/// The reader of spreadsheets, whatever the archive says.
pub(crate) fn read_spreadsheet(bytes: &[u8]) {
    mat::read_named("table.xlsx", bytes).iter().for_each(whole);
}

fn whole(file: &MatFile) {
    for matrix in file.arrays.values() {
        assert_eq!(matrix.values.len(), matrix.rows * matrix.columns);
        matrix.row_strings();
    }
}

/// What the readers of results return can be written.
pub(crate) fn read_results(bytes: &[u8]) {
    for entry in results::FORMATS {
        let format = results::format(entry.name).expect("the table holds its own names");
        if let Ok(table) = format.read(bytes) {
            let _ = format.write(&table);
        }
    }
}

const MODEL: &str = "model Line parameter Real a = 1; parameter Real b = 0; input Real x; \
output Real y; equation y = a*x + b; end Line;";
const DATA: &str = "x,y\n0,1\n1,3.1\n2,4.9\n3,7.2\n";

/// Solves the problem of a problem file in a world in memory, with a few simulations.
pub(crate) fn solve_problem(bytes: &[u8]) {
    let world = MemoryWorld::new()
        .with_file("Line.mo", MODEL)
        .with_file("line.csv", DATA)
        .with_file("line.toml", bytes)
        .interrupted_after(QUESTIONS);
    let mut session = Session::new(Box::new(world));
    let options = RunOptions { evaluations: Some(50), ..RunOptions::default() };
    let _ = solve(&mut session, Path::new("line.toml"), &options);
}

/// What is read of a journal is at most what is there, and its records can be written again.
pub(crate) fn read_journal(bytes: &[u8]) {
    if let Some(journal) = problem::decode(bytes) {
        assert_eq!(journal.whole + journal.lost, bytes.len());
        for entry in &journal.entries {
            entry.to_bytes();
        }
    }
}

/// A model with what a translation may have: states, events, functions, loops, delays, texts that are
/// put together at run time, external functions with arrays and objects.
const KEPT: &str = include_str!("../data/models/fuzz_kept.mo");

/// A store that has one entry under every name, and takes another one.
#[derive(Default)]
struct OneEntry(Mutex<Option<Vec<u8>>>);

impl Store for OneEntry {
    fn find(&self, _: &str) -> Option<Vec<u8>> {
        self.0.lock().expect("one thread").clone()
    }

    fn keep(&self, _: &str, bytes: &[u8]) {
        *self.0.lock().expect("one thread") = Some(bytes.to_vec());
    }
}

/// A translated model that was kept, whatever its entry contains.
pub(crate) fn read_cache_entry(bytes: &[u8]) {
    simulate_kept(OneEntry(Mutex::new(Some(bytes.to_vec()))));
}

/// Whether nothing is translated where there is this entry: it stays the only one.
pub(crate) fn is_taken(entry: &[u8]) -> bool {
    // A byte more than the entry has is read as well.
    let longer = [entry, &[0]].concat();
    let kept = simulate_kept(OneEntry(Mutex::new(Some(longer.clone()))));
    kept.find("") == Some(longer)
}

/// The entry that is kept where there was none.
pub(crate) fn cache_entry() -> Vec<u8> {
    let kept = simulate_kept(OneEntry::default());
    kept.find("").expect("the model is kept")
}

fn simulate_kept(kept: OneEntry) -> Arc<OneEntry> {
    let world = MemoryWorld::new().with_file("Kept.mo", KEPT).interrupted_after(QUESTIONS);
    let (mut session, kept) = (Session::new(Box::new(world)), Arc::new(kept));
    session.storage = Some(kept.clone());
    session
        .run_text("fuzz.mos", "openModel(\"Kept.mo\");\nsimulateModel(\"Kept\", stopTime = 1);\n");
    kept
}

/// Requests that name a place in a document, or the document alone.
const REQUESTS: &[&str] = &[
    "hover",
    "completion",
    "definition",
    "references",
    "documentHighlight",
    "prepareRename",
    "documentSymbol",
    "semanticTokens/full",
    "foldingRange",
    "formatting",
];

/// An editor opens a text, asks for all that it can at some places, and changes the text there.
pub(crate) fn serve_editor(bytes: &[u8]) {
    let Ok(text) = std::str::from_utf8(bytes) else { return };
    let world = || MemoryWorld::new().interrupted_after(QUESTIONS);
    let mut workspace = Workspace::new(Client::default(), move || Session::new(Box::new(world())));
    let uri: lsp_types::Uri = "file:///home/M.mo".parse().expect("a name");
    let item = TextDocumentItem::new(uri.clone(), "modelica".to_owned(), 1, text.to_owned());
    let mut document = Arc::new(Document::opened(item));
    let name = json!({"uri": "file:///home/M.mo"});
    // Places that the text itself chooses, the last of them outside of it.
    for (version, chosen) in (2..).zip(bytes.iter().take(3).chain(&[u8::MAX])) {
        let all = Documents::from([(uri.as_str().to_owned(), document.clone())]);
        workspace.open(&document, &all);
        let place = json!({"line": chosen / 16, "character": chosen % 64});
        for method in REQUESTS {
            let params = json!({
                "textDocument": name,
                "position": place,
                "context": {"includeDeclaration": true},
                "options": {"tabSize": 2, "insertSpaces": true},
            });
            _ = answer(&mut workspace, &all, &format!("textDocument/{method}"), params);
        }
        let range = json!({"start": place, "end": {"line": chosen / 8, "character": 3}});
        let change = json!({"range": range, "text": "x; end "});
        let change: TextDocumentContentChangeEvent =
            serde_json::from_value(change).expect("a change");
        document = Arc::new(document.changed(version, vec![change]));
    }
}

/// What no script may read, and where it lies.
const SECRET: &str = "5ecret";
/// Names in the folder of the script.
const NAMES: &[&str] = &["a", "b", "models", "results", "d.csv", "M.mo", "package.mo", "x.txt"];
/// What a link leads to, from the folder of the script.
const LEADS_TO: &[&str] = &[
    "../victim",
    "../victim/secret.csv",
    "..",
    ".",
    "a",
    "b/../../victim",
    "../victim/new.csv",
    "/",
];
/// Steps between the names of a path.
const BETWEEN: &[&str] = &["/", "/../", "/./", "/../../", "/../victim/", "//"];

/// Takes choices from bytes, the first ones again and again where these are at their end.
struct Choices<'b>(std::iter::Cycle<std::slice::Iter<'b, u8>>);

impl Choices<'_> {
    fn one<'a>(&mut self, all: &[&'a str]) -> &'a str {
        all[*self.0.next().unwrap_or(&0) as usize % all.len()]
    }

    fn path(&mut self) -> String {
        let ends = [NAMES, &["secret.csv", "M.mo", "new.csv", ".profile", "Makefile"]].concat();
        let start = self.one(&["", "", "", "./", "../", "../victim/", "../inside/"]);
        let (name, between) = (self.one(NAMES), self.one(BETWEEN));
        match self.one(&["long", "short"]) {
            "long" => format!("{start}{name}{between}{}", self.one(&ends)),
            _ => format!("{start}{}", self.one(&ends)),
        }
    }

    fn statement(&mut self) -> String {
        let (path, other) = (self.path(), self.path());
        match self
            .one(&["read", "write", "copy", "move", "remove", "folder", "list", "model", "run"])
        {
            "read" => format!("print(readFile(\"{path}\"));\n"),
            "write" => format!("writeFile(\"{path}\", \"new\");\n"),
            "copy" => format!("Modelica.Utilities.Files.copy(\"{path}\", \"{other}\");\n"),
            "move" => format!("Modelica.Utilities.Files.move(\"{path}\", \"{other}\");\n"),
            "remove" => format!("Modelica.Utilities.Files.remove(\"{path}\");\n"),
            "folder" => format!("Modelica.Utilities.Files.createDirectory(\"{path}\");\n"),
            "list" => format!("Modelica.Utilities.Files.list(\"{path}\");\n"),
            "model" => {
                format!("openModel(\"{path}\");\nsimulateModel(\"M\", resultFile = \"{other}\");\n")
            }
            _ => format!("RunScript(\"{path}\");\nprint(readLine(\"{other}\", 1));\n"),
        }
    }
}

/// A tree of files, folders and links of a stranger, with a script in it: it reads and changes nothing
/// beside its folder.
#[cfg(unix)]
pub(crate) fn visit_stranger(bytes: &[u8]) {
    let base = tempfile::tempdir().expect("a temporary folder");
    let base = base.path().canonicalize().expect("an absolute path");
    let (victim, work) = (base.join("victim"), base.join("inside"));
    [&victim, &work].iter().for_each(|folder| fs::create_dir(folder).expect("made"));
    fs::write(victim.join("secret.csv"), format!("time,{SECRET}\n0,1\n")).expect("written");
    let model = format!("model M \"{SECRET}\" Real x = 1; end M;");
    fs::write(victim.join("M.mo"), model).expect("written");
    let mut choices = Choices(bytes.iter().cycle());
    for _ in 0..4 {
        let path = work.join(choices.one(NAMES));
        // A name that is taken stays what it is.
        _ = match choices.one(&["file", "folder", "link", "link"]) {
            "file" => fs::write(&path, "model M Real x = 1; end M;"),
            "folder" => fs::create_dir(&path),
            _ => std::os::unix::fs::symlink(choices.one(LEADS_TO), &path),
        };
    }
    let before = content(&victim);
    let script = work.join("s.mos");
    let statements: String = (0..12).map(|_| choices.statement()).collect();
    let text = format!("cd(\"{}\");\n{statements}", work.display());
    fs::write(&script, text).expect("written");
    let screen = MemoryWorld::new();
    let streams = screen.streams();
    let embedding = Embedding { cache: false, threads: Some(1), ..Embedding::default() };
    let out = work.join("out");
    let session = embedding.session_for(
        ("gapi run", &script),
        (Some(&out), true),
        (Box::new(screen), Arc::default()),
    );
    if let Ok(mut session) = session {
        session.world.grant_script(&script);
        _ = session.run_file(&script);
    }
    let text = fs::read_to_string(&script).unwrap_or_default();
    assert_eq!(content(&victim), before, "changed by:\n{text}");
    let shown = streams.output() + &streams.errors();
    assert!(!shown.contains(SECRET), "{shown}\nshown by:\n{text}");
    for (path, bytes) in content(&work) {
        let has_secret = bytes.windows(SECRET.len()).any(|part| part == SECRET.as_bytes());
        assert!(!has_secret, "{} has it by:\n{text}", path.display());
    }
    assert_eq!(fs::read_dir(&base).expect("readable").count(), 2, "made by:\n{text}");
}

/// The files below a folder; no link is followed.
#[cfg(unix)]
fn content(folder: &Path) -> BTreeMap<PathBuf, Vec<u8>> {
    let mut found = BTreeMap::new();
    for entry in fs::read_dir(folder).into_iter().flatten().flatten() {
        let (path, kind) = (entry.path(), entry.file_type().expect("known"));
        if kind.is_dir() {
            found.extend(content(&path));
        }
        let bytes = if kind.is_file() { fs::read(&path).unwrap_or_default() } else { Vec::new() };
        found.insert(path, bytes);
    }
    found
}
