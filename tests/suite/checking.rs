//! `tests/checking/*.mo`: what is wrong with each class of a file by its text and the names in it,
//! whatever is made of it.

use gapilib::diag::render::render;
use gapilib::flatten::{Library, check};
use gapilib::source::SourceMap;
use gapilib::syntax::ast::StoredDefinition;
use gapilib::syntax::parse_stored_definition;
use std::path::{Path, PathBuf};

fn parsed(sources: &SourceMap, name: &str, text: &str) -> StoredDefinition {
    parse_stored_definition(sources.add(name, text), text).expect("Modelica")
}

fn library(file: &StoredDefinition) -> Library {
    let mut library = Library::new();
    library.load(file).expect("a loadable file");
    library
}

/// The errors of all classes of a text.
fn errors(library: &Library, sources: &SourceMap) -> Vec<String> {
    let all = library.all().into_iter().flat_map(|class| check(library, &class));
    all.map(|error| render(&error, sources, false)).collect()
}

#[test]
fn corpus() {
    insta::glob!("../checking", "*.mo", |path| {
        insta::with_settings!({
            snapshot_path => path.parent().expect("a folder"),
            prepend_module_to_snapshot => false,
            snapshot_suffix => "",
            omit_expression => true,
        }, {
            let stem = path.file_stem().expect("a file name").to_string_lossy().into_owned();
            let text = std::fs::read_to_string(path).expect("a readable file");
            let sources = SourceMap::default();
            let file = parsed(&sources, &format!("{stem}.mo"), &text);
            let found = errors(&library(&file), &sources);
            insta::assert_snapshot!(stem, found.join("\n"));
        });
    });
}

/// Models of one file that are simulated elsewhere in these tests.
fn right_models() -> Vec<PathBuf> {
    let here = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests");
    let folders = ["simulation", "structure"].map(|folder| here.join(folder));
    let entries = folders.iter().flat_map(|folder| std::fs::read_dir(folder).expect("a folder"));
    let mut found: Vec<PathBuf> = entries
        .map(|entry| entry.expect("a readable entry").path())
        .filter(|path| path.extension().is_some_and(|extension| extension == "mo"))
        .collect();
    found.sort();
    found
}

#[test]
fn models_that_are_simulated_have_no_unknown_names() {
    for path in right_models() {
        let text = std::fs::read_to_string(&path).expect("a readable file");
        let sources = SourceMap::default();
        let library = library(&parsed(&sources, &path.display().to_string(), &text));
        let all = library.all().into_iter().flat_map(|class| check(&library, &class));
        let wrong: Vec<String> =
            all.filter(|one| one.is_error()).map(|error| render(&error, &sources, false)).collect();
        assert!(wrong.is_empty(), "{}", wrong.join("\n"));
    }
}
