//! What no bytes may make panic or hang. The fuzz targets call these functions with inputs that are
//! led by coverage, the suite with a corpus and fixed mutations of it.

use gapilib::flatten::{Library, flatten};
use gapilib::identify::problem;
use gapilib::mat::{self, MatFile};
use gapilib::results;
use gapilib::script::Session;
use gapilib::script::runs::problem::{RunOptions, solve};
use gapilib::script::world::{MemoryWorld, Store};
use gapilib::source::SourceId;
use gapilib::syntax::ast::StoredDefinition;
use gapilib::syntax::visit::{WithoutSpans, rewrite_script, rewrite_stored_definition};
use gapilib::syntax::{decode, parse_script, parse_stored_definition, print};
use std::path::Path;
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
        let _ = gapilib::flatten::check(&library, &class);
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
        matrix.text_rows();
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
        for record in &journal.records {
            problem::encode(record);
        }
    }
}

/// A model with all that a translation has: states, events, a function, a nonlinear equation.
const KEPT: &str = "model Kept
  function f input Real u; output Real v; algorithm v := u*u + 1; end f;
  parameter Real p = 2;
  parameter Integer n = 2;
  Real x[n](each start = 1, each fixed = true);
  Real y;
  Real z(start = 1);
  discrete Real d(start = 0, fixed = true);
equation
  for i in 1:n loop der(x[i]) = -p*x[i]; end for;
  y = f(x[1]) + (if time > 0.5 then 1 else 0);
  z^3 + z = y;
  when sample(0.2, 0.2) then d = pre(d) + 1; end when;
end Kept;
";

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
