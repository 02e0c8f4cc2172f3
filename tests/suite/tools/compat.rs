//! The ledgers of `compat/` say what is true.

use gapilib::internals::script::builtins;
use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

/// Rows of a ledger: name, then key and value.
fn ledger(file: &str) -> BTreeMap<String, BTreeMap<String, String>> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("compat").join(file);
    let text = fs::read_to_string(path).expect("a readable ledger");
    let mut rows: BTreeMap<String, BTreeMap<String, String>> = BTreeMap::new();
    let mut current = String::new();
    for line in text.lines().filter(|line| !line.starts_with('#') && !line.trim().is_empty()) {
        if let Some(name) = line.strip_prefix('[').and_then(|rest| rest.strip_suffix(']')) {
            assert!(!rows.contains_key(name), "{file} has two rows `{name}`");
            let name = name.trim_matches('"');
            current = name.to_owned();
            rows.insert(current.clone(), BTreeMap::new());
        } else {
            let (key, value) = line.split_once(" = ").expect("key = \"value\"");
            let row = rows.get_mut(&current).expect("a row has a name");
            row.insert(key.to_owned(), value.trim_matches('"').to_owned());
        }
    }
    rows
}

/// The ledgers that have rows for commands.
const LEDGERS: [&str; 3] = ["dymola.toml", "openmodelica.toml", "gapilib.toml"];

/// Rows of statement forms, not of commands.
fn is_form(name: &str) -> bool {
    name.starts_with("form: ")
}

#[test]
fn rows_agree_with_the_commands_there_are() {
    let names = builtins::names();
    for file in LEDGERS {
        for (name, row) in ledger(file) {
            let exists = names.contains(&name.as_str()) || is_form(&name);
            let status = row.get("status").map(String::as_str);
            match status {
                Some("supported") => assert!(exists, "{file}: `{name}` does not exist"),
                Some("partial") => {
                    assert!(exists, "{file}: `{name}` does not exist");
                    assert!(row.contains_key("difference"), "{file}: `{name}` says no difference");
                }
                Some("absent") => {
                    let refused = row.get("difference").is_some_and(|d| d.starts_with("refused: "));
                    let exists = exists && !is_form(&name) && !refused;
                    assert!(!exists, "{file}: `{name}` exists, but is said absent");
                }
                other => panic!("{file}: `{name}` has the status {other:?}"),
            }
        }
    }
}

#[test]
fn every_command_has_a_row() {
    let mut rows = Vec::new();
    LEDGERS.iter().for_each(|file| rows.extend(ledger(file).into_keys()));
    let without = builtins::names().into_iter().filter(|name| !rows.iter().any(|row| row == name));
    let without: Vec<&str> = without.collect();
    assert!(without.is_empty(), "no row for {without:?}");
}

#[test]
fn transcripts_show_what_rows_say() {
    let tests = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests");
    let mut wrong = Vec::new();
    for file in LEDGERS {
        for (name, row) in ledger(file) {
            let Some(transcript) = row.get("transcript") else {
                let is_supported = row.get("status").is_some_and(|status| status == "supported");
                if is_supported && file != "gapilib.toml" {
                    wrong.push(format!("{file}: {name} names no transcript"));
                }
                continue;
            };
            let script = fs::read(tests.join(transcript)).unwrap_or_default();
            let script = String::from_utf8_lossy(&script);
            let snapshot = tests.join(transcript).with_extension("snap");
            let calls = |line: &str| line.contains(&format!("{name}(")) || line.trim() == name;
            if !snapshot.exists() || !is_form(&name) && !script.lines().any(calls) {
                wrong.push(format!("{file}: {transcript} does not show {name}"));
            }
        }
    }
    assert!(wrong.is_empty(), "{wrong:#?}");
}
