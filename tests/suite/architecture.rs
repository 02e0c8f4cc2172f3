//! The sources obey the module rules of `src/lib.rs`: who may import whom, who may touch the
//! outside world.

use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};

/// Module, and the modules it may name as `crate::…` (itself always).
const MAY_IMPORT: &[(&str, &[&str])] = &[
    ("bibliography", &[]),
    ("source", &[]),
    ("name", &[]),
    ("graph", &[]),
    ("models", &[]),
    ("elementary", &[]),
    ("page", &[]),
    ("singular_values", &[]),
    ("diag", &["source"]),
    ("registry", &["diag"]),
    ("symbolic", &["diag"]),
    ("budget", &[]),
    ("bytecode", &["budget", "external", "symbolic", "source", "diag"]),
    ("units", &[]),
    ("mat", &["units", "diag"]),
    ("external", &["mat", "singular_values", "diag"]),
    ("plot", &["diag"]),
    ("sim", &["registry", "diag"]),
    ("ga", &["singular_values", "registry", "diag"]),
    ("value", &["name", "diag"]),
    ("syntax", &["source", "name", "diag"]),
    ("eval", &["external", "syntax", "value", "symbolic", "name", "source", "diag"]),
    ("results", &["sim", "mat", "registry", "diag"]),
    (
        "flatten",
        &[
            "budget", "external", "syntax", "eval", "value", "symbolic", "units", "name", "source",
            "diag",
        ],
    ),
    (
        "dae",
        &[
            "budget", "bytecode", "external", "flatten", "eval", "value", "syntax", "symbolic",
            "graph", "name", "source", "diag",
        ],
    ),
    (
        "compile",
        &[
            "bytecode", "dae", "flatten", "eval", "value", "syntax", "symbolic", "graph", "sim",
            "name", "source", "diag",
        ],
    ),
    ("teach", &["ga", "page", "plot", "diag"]),
    (
        "identify",
        &[
            "compile",
            "results",
            "page",
            "plot",
            "sim",
            "ga",
            "singular_values",
            "registry",
            "name",
            "diag",
        ],
    ),
    (
        "script",
        &[
            "identify", "compile", "dae", "external", "flatten", "eval", "value", "syntax",
            "symbolic", "teach", "results", "plot", "mat", "units", "sim", "ga", "registry",
            "models", "name", "source", "diag",
        ],
    ),
    (
        "cli",
        &[
            "budget", "script", "identify", "teach", "compile", "results", "plot", "sim", "ga",
            "models", "registry", "name", "source", "diag",
        ],
    ),
];

/// Words that only the outermost layer may use, because they reach the outside world.
const OUTSIDE: &[&str] = &[
    "println!",
    "eprintln!",
    "print!(",
    "eprint!(",
    "std::fs",
    "std::env",
    "std::process",
    "SystemTime",
    "Instant::now",
    "std::net",
];

fn sources() -> Vec<(PathBuf, String)> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    let mut found = Vec::new();
    collect(&root, &root, &mut found);
    found.sort();
    assert!(found.len() > 20, "the sources were not found");
    found
}

fn collect(root: &Path, folder: &Path, found: &mut Vec<(PathBuf, String)>) {
    for entry in fs::read_dir(folder).expect("a readable folder") {
        let path = entry.expect("a readable entry").path();
        if path.is_dir() {
            collect(root, &path, found);
        } else if path.extension().is_some_and(|extension| extension == "rs") {
            let text = fs::read_to_string(&path).expect("a readable source");
            found.push((path.strip_prefix(root).expect("below the root").to_owned(), text));
        }
    }
}

/// The module a source file belongs to: the first folder, or the file at the top.
fn module(path: &Path) -> String {
    let first = path.components().next().expect("a path").as_os_str().to_string_lossy();
    first.trim_end_matches(".rs").to_owned()
}

/// The lines that are code: without comments and without the tests at the end of a file.
fn code(text: &str) -> impl Iterator<Item = (usize, &str)> {
    text.lines()
        .enumerate()
        .take_while(|(_, line)| line.trim() != "#[cfg(test)]")
        .map(|(number, line)| (number + 1, line))
        .filter(|(_, line)| !line.trim_start().starts_with("//"))
}

fn imports(text: &str) -> Vec<(usize, String)> {
    let mut named = Vec::new();
    for (number, line) in code(text) {
        for (at, _) in line.match_indices("crate::") {
            if at > 0 && line.as_bytes()[at - 1] == b'$' {
                continue;
            }
            let rest = &line[at + "crate::".len()..];
            if let Some(group) = rest.strip_prefix('{') {
                let group = group.split('}').next().unwrap_or(group);
                named.extend(group.split(',').map(|item| (number, first_word(item))));
            } else {
                named.push((number, first_word(rest)));
            }
        }
    }
    named.retain(|(_, word)| !word.is_empty());
    named
}

fn first_word(text: &str) -> String {
    text.trim().chars().take_while(|c| c.is_alphanumeric() || *c == '_').collect()
}

#[test]
fn modules_import_only_what_they_may() {
    let modules: BTreeSet<&str> = MAY_IMPORT.iter().map(|(module, _)| *module).collect();
    let mut wrong = Vec::new();
    for (path, text) in sources() {
        let own = module(&path);
        if own == "lib" || own == "main" {
            continue;
        }
        let Some((_, allowed)) = MAY_IMPORT.iter().find(|(name, _)| *name == own) else {
            wrong.push(format!("{}: module `{own}` is not in the table", path.display()));
            continue;
        };
        for (line, named) in imports(&text) {
            // As those of the standard library, which they replace, everyone may call them.
            let known = named != "elementary" && modules.contains(named.as_str());
            if known && named != own && !allowed.contains(&named.as_str()) {
                wrong.push(format!("{}:{line}: `{own}` imports `{named}`", path.display()));
            }
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn only_the_command_line_touches_the_outside() {
    let mut wrong = Vec::new();
    for (path, text) in sources() {
        if module(&path) == "cli" || module(&path) == "main" || path.ends_with("tests.rs") {
            continue;
        }
        for (line, content) in code(&text) {
            for word in OUTSIDE.iter().filter(|word| content.contains(**word)) {
                wrong.push(format!("{}:{line}: {word}", path.display()));
            }
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn pest_pairs_stay_in_syntax() {
    for (path, text) in sources() {
        if module(&path) != "syntax" {
            let found = code(&text).find(|(_, line)| line.contains("pest::"));
            assert!(found.is_none(), "{}: {found:?}", path.display());
        }
    }
}

#[test]
fn every_module_begins_with_its_documentation() {
    for (path, text) in sources() {
        assert!(text.starts_with("//!"), "{} has no module documentation", path.display());
    }
}

#[test]
fn every_cited_work_is_in_the_bibliography() {
    let sources = sources();
    let (_, bibliography) = sources
        .iter()
        .find(|(path, _)| path.ends_with("bibliography.rs"))
        .expect("src/bibliography.rs");
    for (path, text) in &sources {
        for (at, _) in text.match_indices("bibliography#") {
            let rest = &text[at + "bibliography#".len()..];
            let key: String = rest
                .chars()
                .take_while(|c| c.is_alphanumeric() || matches!(c, '-' | '.'))
                .collect();
            let anchor = format!("id=\"{}\"", key.trim_end_matches('.'));
            assert!(bibliography.contains(&anchor), "{}: `{key}` is not there", path.display());
        }
    }
}

/// Folders with a table: every file with an entry is a row of it.
const TABLES: [&str; 10] = [
    "sim/integrators",
    "results",
    "identify/fitness",
    "identify/problem/importance",
    "ga/optimizer",
    "ga/sampling",
    "ga/selection",
    "ga/crossover",
    "ga/mutation",
    "ga/survival",
];

/// One file and one row add an operator: nothing else has to be touched, so nothing else names it.
#[test]
fn tables_name_every_file_of_their_folder() {
    for folder in TABLES {
        let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("src").join(folder);
        let door = fs::read_to_string(root.join("mod.rs")).expect("a table");
        let table = door.split_once("Entry<").map_or("", |(_, table)| table);
        let mut rows = 0;
        for entry in fs::read_dir(&root).expect("a readable folder") {
            let path = entry.expect("a readable entry").path();
            let text = fs::read_to_string(&path).unwrap_or_default();
            let stem = path.file_stem().expect("a file name").to_string_lossy().into_owned();
            for line in text.lines().filter(|_| stem != "mod") {
                let Some((before, _)) = line.split_once("ENTRY: Entry<") else { continue };
                let name = before.rsplit(' ').next().unwrap_or_default();
                let row = format!("{stem}::{name}ENTRY");
                assert!(table.contains(&row), "src/{folder}/mod.rs does not list `{row}`");
                rows += 1;
            }
        }
        assert!(rows > 1, "src/{folder} has no table");
    }
}

/// The operators that a problem can choose are known by their tables alone.
#[test]
fn operators_are_named_in_their_files_only() {
    let names = ["blend", "arithmetic", "two_point", "gaussian", "non_uniform", "roulette"];
    for (path, text) in sources() {
        let is_home = path.starts_with("ga");
        for (line, content) in code(&text).filter(|_| !is_home) {
            for name in names {
                let quoted = format!("\"{name}\"");
                assert!(!content.contains(&quoted), "{}:{line}: {content}", path.display());
            }
        }
    }
}
