//! The sources obey the module rules of `src/lib.rs`: who may import whom, who may touch the outside
//! world; and the habits of CONTRIBUTING.md: no cycles of files, short functions, tables that are
//! read.

mod exceptions;
mod sources;

use exceptions::{CALL_CYCLES, CYCLES, LONG_FUNCTIONS};
use gapilib::internals::graph::strongly_connected;
use sources::{Modules, Source, sources};
use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;
use std::sync::OnceLock;

/// Module, and the modules it may name as `crate::…` (itself always).
const MAY_IMPORT: &[(&str, &[&str])] = &[
    ("bibliography", &[]),
    ("source", &[]),
    ("name", &[]),
    ("graph", &[]),
    ("packages", &[]),
    ("elementary", &[]),
    ("page", &[]),
    ("singular_values", &[]),
    ("diag", &["source", "name"]),
    ("registry", &["diag"]),
    ("symbolic", &["diag"]),
    ("budget", &[]),
    ("jit", &[]),
    ("arithmetic", &["symbolic"]),
    ("bytecode", &["arithmetic", "budget", "external", "jit", "symbolic", "source", "diag"]),
    ("units", &[]),
    ("mat", &["units", "diag"]),
    ("value", &["budget", "name", "diag"]),
    ("external", &["budget", "mat", "singular_values", "value", "diag"]),
    ("plot", &["diag"]),
    ("sim", &["registry", "diag"]),
    ("frequency", &[]),
    ("kramers_kronig", &["frequency"]),
    ("ga", &["singular_values", "registry", "diag"]),
    ("syntax", &["source", "name", "diag"]),
    ("format", &["syntax", "source", "diag"]),
    ("names", &["syntax", "name", "diag"]),
    ("functions", &["value", "symbolic", "diag"]),
    ("inference", &["functions", "syntax", "value", "name"]),
    ("execute", &["syntax", "source", "diag"]),
    (
        "eval",
        &[
            "execute",
            "functions",
            "inference",
            "external",
            "syntax",
            "value",
            "symbolic",
            "name",
            "source",
            "diag",
        ],
    ),
    ("results", &["budget", "sim", "mat", "registry", "diag"]),
    (
        "flatten",
        &[
            "budget",
            "external",
            "syntax",
            "names",
            "eval",
            "functions",
            "inference",
            "value",
            "symbolic",
            "units",
            "name",
            "source",
            "diag",
        ],
    ),
    (
        "lower",
        &[
            "arithmetic",
            "graph",
            "budget",
            "bytecode",
            "external",
            "flatten",
            "eval",
            "execute",
            "functions",
            "inference",
            "value",
            "syntax",
            "symbolic",
            "name",
            "source",
            "diag",
        ],
    ),
    ("causalize", &["lower", "flatten", "graph", "symbolic", "source", "diag"]),
    (
        "codegen",
        &[
            "arithmetic",
            "budget",
            "bytecode",
            "jit",
            "causalize",
            "lower",
            "flatten",
            "syntax",
            "symbolic",
            "sim",
            "source",
            "diag",
        ],
    ),
    (
        "runtime",
        &[
            "arithmetic",
            "codegen",
            "bytecode",
            "causalize",
            "lower",
            "flatten",
            "value",
            "symbolic",
            "sim",
            "source",
            "diag",
        ],
    ),
    ("fmi", &["sim", "codegen", "lower", "flatten", "units", "source", "diag"]),
    ("fmu", &["fmi", "runtime", "codegen", "sim", "source", "diag"]),
    ("exchange", &["registry", "diag"]),
    ("teach", &["ga", "page", "plot", "diag"]),
    (
        "identify",
        &[
            "fmi",
            "runtime",
            "codegen",
            "results",
            "page",
            "plot",
            "sim",
            "frequency",
            "ga",
            "singular_values",
            "registry",
            "name",
            "units",
            "source",
            "diag",
        ],
    ),
    (
        "script",
        &[
            "fmi",
            "identify",
            "runtime",
            "codegen",
            "causalize",
            "lower",
            "external",
            "flatten",
            "eval",
            "functions",
            "value",
            "syntax",
            "symbolic",
            "teach",
            "results",
            "plot",
            "mat",
            "units",
            "sim",
            "frequency",
            "kramers_kronig",
            "ga",
            "registry",
            "packages",
            "name",
            "source",
            "diag",
        ],
    ),
    ("lessons", &["script", "value", "syntax", "source"]),
    (
        "lsp",
        &[
            "script",
            "flatten",
            "format",
            "functions",
            "syntax",
            "packages",
            "name",
            "source",
            "diag",
        ],
    ),
    (
        "cli",
        &[
            "exchange", "fmi", "lsp", "lessons", "format", "syntax", "budget", "external",
            "script", "identify", "teach", "runtime", "codegen", "results", "plot", "sim", "ga",
            "packages", "registry", "name", "source", "diag",
        ],
    ),
];

/// Macros and paths that only the outermost layer may use, because they reach the outside world.
const OUTSIDE: &[&str] = &[
    "println!",
    "eprintln!",
    "print!",
    "eprint!",
    "std::fs",
    "std::env",
    "std::process",
    "std::net",
    "SystemTime::now",
    "Instant::now",
];

/// Lines of a function that reads at a glance.
const LONGEST: usize = 60;
/// Lines of a class that a test itself contains.
const LONGEST_CLASS: usize = 10;
/// A file that treats so many functions of the language itself may name them.
const MOST_NAMED: usize = 6;
/// Files of a cycle that are one concept, and files in all cycles.
const MOST_IN_CYCLES: usize = 12;
const LARGEST_CYCLE: usize = 3;
/// Files whose methods of one type call each other.
const LARGEST_CALL_CYCLE: usize = 2;

fn all() -> &'static [Source] {
    static SOURCES: OnceLock<Vec<Source>> = OnceLock::new();
    SOURCES.get_or_init(sources)
}

fn passes(wrong: &[String]) {
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn modules_import_only_what_they_may() {
    let modules: BTreeSet<&str> = MAY_IMPORT.iter().map(|(module, _)| *module).collect();
    let mut wrong = Vec::new();
    for source in all() {
        let Some(own) = source.module.first().filter(|own| *own != "main") else { continue };
        let Some((_, allowed)) = MAY_IMPORT.iter().find(|(name, _)| name == own) else {
            wrong.push(format!("{}: `{own}` is not in the table", source.path.display()));
            continue;
        };
        for (line, path) in &source.named {
            let named = path.first().map_or("", String::as_str);
            // As those of the standard library, which they replace, everyone may call them.
            let known = named != "elementary" && modules.contains(named);
            if known && named != own && !allowed.contains(&named) {
                wrong.push(format!("{}:{line}: `{own}` imports `{named}`", source.path.display()));
            }
        }
    }
    passes(&wrong);
}

#[test]
fn only_the_command_line_touches_the_outside() {
    let mut wrong = Vec::new();
    for source in all() {
        let is_test = source.path.ends_with("tests.rs")
            || source.path.to_string_lossy().contains("_tests")
            || source.path.iter().any(|folder| folder == "tests");
        if source.module.first().is_some_and(|own| ["cli", "main", "fmu"].contains(&own.as_str()))
            || is_test
        {
            continue;
        }
        for (line, used) in &source.outside {
            let matches = |word: &&&str| used == **word || used.starts_with(&format!("{word}::"));
            if let Some(word) = OUTSIDE.iter().find(matches) {
                wrong.push(format!("{}:{line}: {word}", source.path.display()));
            }
        }
    }
    passes(&wrong);
}

/// The cycles of files that are too large, as sizes by folder, against those that are known: a change
/// makes none larger, and what has become smaller is written down.
#[test]
fn files_of_a_cycle_are_one_concept() {
    let modules = Modules::new(all());
    let edges: Vec<Vec<usize>> = (0..all().len()).map(|at| modules.successors(at)).collect();
    let mut found: BTreeMap<&str, Vec<(usize, String)>> = BTreeMap::new();
    for cycle in strongly_connected(all().len(), |at| &edges[at]) {
        if cycle.len() > LARGEST_CYCLE {
            let names: Vec<String> = cycle.iter().map(|at| all()[*at].module.join("::")).collect();
            let folder = all()[cycle[0]].module[0].as_str();
            found.entry(folder).or_default().push((cycle.len(), names.join(", ")));
        }
    }
    let mut wrong = Vec::new();
    for (folder, cycles) in &mut found {
        cycles.sort();
        let sizes: Vec<usize> = cycles.iter().map(|(size, _)| *size).collect();
        let known = CYCLES.iter().find(|known| known.0 == *folder).map_or(&[][..], |k| k.1);
        if sizes != known {
            let names: Vec<&str> = cycles.iter().map(|(_, names)| names.as_str()).collect();
            wrong.push(format!(
                "`{folder}` has cycles of {sizes:?} files where {known:?} are known:\n  {}",
                names.join("\n  ")
            ));
        }
    }
    let mut cycles = strongly_connected(all().len(), |at| &edges[at]);
    cycles.retain(|cycle| cycle.len() > 1);
    let in_cycles: usize = cycles.iter().map(Vec::len).sum();
    if in_cycles > MOST_IN_CYCLES {
        let names = |cycle: &Vec<usize>| {
            cycle.iter().map(|at| all()[*at].module.join("::")).collect::<Vec<_>>().join(", ")
        };
        let names: Vec<String> = cycles.iter().map(names).collect();
        wrong.push(format!(
            "{in_cycles} files are in cycles, {MOST_IN_CYCLES} are known:\n  {}",
            names.join("\n  ")
        ));
    }
    let gone = CYCLES.iter().filter(|known| !found.contains_key(known.0));
    wrong.extend(gone.map(|known| format!("`{}` has no large cycle any more", known.0)));
    passes(&wrong);
}

/// The functions and operators of the language have one home, `functions`: a file of another folder
/// that names many of them is a second list.
/// The methods of a type may lie in several files; those of few of them call each other. A call counts
/// where one file alone has a method of this name.
#[test]
fn methods_of_a_type_lie_in_layers() {
    let mut files: BTreeMap<(&str, &str), BTreeSet<usize>> = BTreeMap::new();
    let mut homes: BTreeMap<(&str, &str, &str), BTreeSet<usize>> = BTreeMap::new();
    let folder = |at: usize| all()[at].module.first().map_or("", String::as_str);
    for (at, source) in all().iter().enumerate() {
        for (of, method) in &source.methods {
            files.entry((folder(at), of)).or_default().insert(at);
            homes.entry((folder(at), of, method)).or_default().insert(at);
        }
    }
    let mut found: BTreeMap<&str, usize> = BTreeMap::new();
    let mut wrong = Vec::new();
    for ((owner, of), files) in files {
        let files: Vec<usize> = files.into_iter().collect();
        let called = |at: usize| {
            let own = all()[at].own_calls.iter().filter(|(called, _)| called == of);
            let home = own.filter_map(|(_, method)| homes.get(&(owner, of, method.as_str())));
            let only = home.filter(|home| home.len() == 1 && !home.contains(&at)).flatten();
            only.filter_map(|home| files.binary_search(home).ok()).collect::<Vec<usize>>()
        };
        let edges: Vec<Vec<usize>> = files.iter().map(|at| called(*at)).collect();
        for cycle in strongly_connected(files.len(), |at| &edges[at]) {
            if cycle.len() <= LARGEST_CALL_CYCLE {
                continue;
            }
            let largest = found.entry(of).or_default();
            *largest = cycle.len().max(*largest);
            let known = CALL_CYCLES.iter().find(|known| known.0 == of).map_or(0, |known| known.1);
            if cycle.len() != known {
                let names = cycle.iter().map(|at| all()[files[*at]].module.join("::"));
                let names = names.collect::<Vec<_>>().join(", ");
                wrong.push(format!("`{of}`: {} files, known {known}: {names}", cycle.len()));
            }
        }
    }
    let gone = CALL_CYCLES.iter().filter(|known| !found.contains_key(known.0));
    wrong.extend(gone.map(|known| format!("`{}` has no large cycle any more", known.0)));
    passes(&wrong);
}

#[test]
fn functions_of_the_language_are_listed_once() {
    let known: Vec<String> = gapilib::internals::functions::names()
        .chain(["der", "pre", "edge", "change", "initial", "terminal", "sample", "delay"])
        .map(|name| format!("\"{name}\""))
        .collect();
    let mut wrong = Vec::new();
    for source in all() {
        let folder = source.module.first().map_or("", String::as_str);
        let is_test = source.module.iter().any(|part| part == "tests");
        if !["eval", "flatten", "lower", "causalize", "codegen"].contains(&folder) || is_test {
            continue;
        }
        let code = source.text.split("#[cfg(test)]").next().unwrap_or_default();
        let named: Vec<&String> = known.iter().filter(|name| code.contains(*name)).collect();
        if named.len() > MOST_NAMED {
            wrong.push(format!("{}: names {named:?}", source.path.display()));
        }
    }
    passes(&wrong);
}

#[test]
fn functions_read_at_a_glance() {
    let mut wrong = Vec::new();
    let mut seen = BTreeSet::new();
    for source in all() {
        let file = source.path.to_string_lossy().replace('\\', "/");
        for (name, lines) in &source.functions {
            if *lines <= LONGEST {
                continue;
            }
            let known = LONG_FUNCTIONS.iter().find(|known| known.0 == file && known.1 == name);
            match known {
                Some(known) => _ = seen.insert((known.0, known.1)),
                None => wrong.push(format!("{file}: `{name}` has {lines} lines")),
            }
        }
    }
    let unused = LONG_FUNCTIONS.iter().filter(|known| !seen.contains(&(known.0, known.1)));
    wrong.extend(unused.map(|known| format!("{}: `{}` is short or gone", known.0, known.1)));
    passes(&wrong);
}

/// A file with an entry stands in the table of its folder, and every table is read somewhere.
#[test]
fn tables_name_every_file_of_their_folder_and_are_read() {
    let mut wrong = Vec::new();
    for source in all() {
        let Some((stem, folder)) = source.module.split_last() else { continue };
        for line in source.text.lines().filter(|_| !source.is_door) {
            let Some((before, _)) = line.split_once("ENTRY: Entry<") else { continue };
            let row = format!("{stem}::{}ENTRY", before.rsplit(' ').next().unwrap_or_default());
            let door = all().iter().find(|door| door.module == folder).expect("a face");
            let table = door.text.split_once("Entry<").map_or("", |(_, table)| table);
            if !table.contains(&row) {
                wrong.push(format!("{}: `{row}` is not a row", source.path.display()));
            }
        }
        for table in &source.tables {
            let uses = |other: &Source| other.identifiers.get(table).copied().unwrap_or(0);
            let elsewhere = all().iter().filter(|other| other.path != source.path);
            if uses(source) < 2 && elsewhere.map(uses).sum::<usize>() == 0 {
                wrong.push(format!("{}: nobody reads `{table}`", source.path.display()));
            }
        }
    }
    passes(&wrong);
}

/// The text of classes lies in files, which editors and `gapi` read as well.
#[test]
fn classes_of_tests_lie_in_files() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let mut tests = Vec::new();
    for (path, text) in sources::files(&root.join("tests")) {
        tests.push((path, text.clone(), 0));
    }
    for (path, text) in sources::files(&root.join("src")) {
        let is_test = path.iter().any(|part| part == "tests") || path.ends_with("tests.rs");
        let begin = if is_test { Some(0) } else { text.find("#[cfg(test)]") };
        tests.extend(begin.map(|begin| (path, text.clone(), text[..begin].lines().count())));
    }
    let mut wrong = Vec::new();
    for (path, text, begin) in tests {
        for (line, literal, lines) in sources::literals(&text) {
            if line > begin && lines > LONGEST_CLASS && begins_with_a_class(&literal) {
                wrong.push(format!("{}:{line}: a class of {lines} lines", path.display()));
            }
        }
    }
    passes(&wrong);
}

/// Whether a text begins with a class definition (MLS §4.5).
fn begins_with_a_class(text: &str) -> bool {
    let prefixes = ["encapsulated", "partial", "pure", "impure", "operator", "expandable"];
    let kinds = ["model", "function", "package", "record", "block", "connector", "class", "type"];
    let mut words = text.split_whitespace().skip_while(|word| prefixes.contains(word));
    words.next().is_some_and(|word| kinds.contains(&word)) && text.contains("end ")
}

#[test]
fn pest_pairs_stay_in_syntax() {
    for source in all() {
        if source.module.first().is_some_and(|own| own != "syntax") {
            let found = source.outside.iter().find(|(_, used)| used.starts_with("pest::"));
            assert!(found.is_none(), "{}: {found:?}", source.path.display());
        }
    }
}

#[test]
fn every_module_begins_with_its_documentation() {
    for Source { path, text, .. } in all() {
        assert!(text.starts_with("//!"), "{} has no module documentation", path.display());
    }
}

#[test]
fn every_cited_work_is_in_the_bibliography() {
    let bibliography = all().iter().find(|source| source.path.ends_with("bibliography.rs"));
    let bibliography = &bibliography.expect("src/base/bibliography.rs").text;
    for Source { path, text, .. } in all() {
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

/// One file and one row add an operator: nothing else names it.
#[test]
fn operators_are_named_in_their_files_only() {
    let names = ["blend", "arithmetic", "two_point", "gaussian", "non_uniform", "roulette"];
    let others = all().iter().filter(|source| source.module.first().is_none_or(|own| own != "ga"));
    let wrong: Vec<String> = others
        .flat_map(|source| {
            let named = names.iter().filter(|name| source.text.contains(&format!("\"{name}\"")));
            named.map(|name| format!("{}: {name}", source.path.display()))
        })
        .collect();
    passes(&wrong);
}
