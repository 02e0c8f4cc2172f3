//! The grammar: corpora with their trees and errors, printing and reading again.

use gapilib::diag::render::render;
use gapilib::source::SourceMap;
use gapilib::syntax::ast::StoredDefinition;
use gapilib::syntax::visit::{WithoutSpans, rewrite_stored_definition};
use gapilib::syntax::{self, print};
use std::path::{Path, PathBuf};

/// Every `.mo` file below the folder.
fn modelica_files(folder: &Path, found: &mut Vec<PathBuf>) {
    for entry in std::fs::read_dir(folder).expect("the folder is readable") {
        let path = entry.expect("the entry is readable").path();
        if path.is_dir() {
            modelica_files(&path, found);
        } else if path.extension().is_some_and(|extension| extension == "mo") {
            found.push(path);
        }
    }
}

/// What is wrong if the printed text does not read back as the same tree.
fn reads_back_differently(mut tree: StoredDefinition, path: &Path) -> Option<String> {
    let text = print::stored_definition(&tree);
    let mut sources = SourceMap::default();
    let source = sources.add(format!("{} printed", path.display()), text.as_str());
    let mut again = match syntax::parse_stored_definition(source, &text) {
        Ok(again) => again,
        Err(error) => return Some(render(&error, &sources, false)),
    };
    rewrite_stored_definition(&mut WithoutSpans, &mut tree);
    rewrite_stored_definition(&mut WithoutSpans, &mut again);
    (tree != again).then(|| format!("{}: another tree:\n{text}", path.display()))
}

/// Reads a local library named by `GAPILIB_MODELICA_LIBRARY`; says so where it is not set.
#[test]
fn local_library_is_read() {
    let Some(folder) = std::env::var_os("GAPILIB_MODELICA_LIBRARY") else {
        eprintln!("skipped: GAPILIB_MODELICA_LIBRARY names no local library");
        return;
    };
    let mut files = Vec::new();
    modelica_files(Path::new(&folder), &mut files);
    files.sort();
    let (mut bytes, mut failures) = (0, Vec::new());
    let start = std::time::Instant::now();
    for path in &files {
        let content = std::fs::read(path).expect("the file is readable");
        let (text, _) = syntax::decode(&content);
        bytes += text.len();
        let mut sources = SourceMap::default();
        let source = sources.add(path.display().to_string(), text.as_str());
        match syntax::parse_stored_definition(source, &text) {
            Ok(definition) => failures.extend(reads_back_differently(definition, path)),
            // The compliance library marks the models that a tool must refuse.
            Err(_) if text.contains("shouldPass = false") => {}
            Err(error) => failures.push(render(&error, &sources, false)),
        }
    }
    let seconds = start.elapsed().as_secs_f64();
    eprintln!("{} files, {:.2} MB, {seconds:.2} s", files.len(), bytes as f64 / 1e6);
    assert!(failures.is_empty(), "{} of {}:\n{}", failures.len(), files.len(), failures.join("\n"));
}
