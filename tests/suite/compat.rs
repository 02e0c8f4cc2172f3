//! The ledgers of `compat/` say what is true.

use gapilib::script::builtins;
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

#[test]
fn rows_agree_with_the_commands_there_are() {
    let names = builtins::names();
    for file in ["dymola.toml", "openmodelica.toml"] {
        for (name, row) in ledger(file) {
            let exists = names.contains(&name.as_str());
            let status = row.get("status").map(String::as_str);
            match status {
                Some("supported") => assert!(exists, "{file}: `{name}` does not exist"),
                Some("partial") => {
                    assert!(exists, "{file}: `{name}` does not exist");
                    assert!(row.contains_key("difference"), "{file}: `{name}` says no difference");
                }
                Some("absent") => assert!(!exists, "{file}: `{name}` exists, but is said absent"),
                other => panic!("{file}: `{name}` has the status {other:?}"),
            }
        }
    }
}

#[test]
fn supported_rows_occur_in_a_transcript() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests");
    let mut scripts = String::new();
    let mut pending = vec![folder.join("transcripts"), folder.join("diagnostics")];
    while let Some(current) = pending.pop() {
        for entry in fs::read_dir(current).expect("a readable folder") {
            let path = entry.expect("a readable entry").path();
            if path.is_dir() {
                pending.push(path);
            } else if path.extension().is_some_and(|extension| extension == "mos") {
                scripts.push_str(&String::from_utf8_lossy(&fs::read(path).expect("a script")));
            }
        }
    }
    let mut unused = Vec::new();
    for file in ["dymola.toml", "openmodelica.toml"] {
        for (name, row) in ledger(file) {
            let is_supported = row.get("status").is_some_and(|status| status == "supported");
            let called = [format!("{name}("), format!("\n{name}\n")];
            if is_supported && !called.iter().any(|call| scripts.contains(call.as_str())) {
                unused.push(format!("{file}: {name}"));
            }
        }
    }
    assert!(unused.is_empty(), "no transcript shows {unused:?}");
}
