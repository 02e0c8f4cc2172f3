//! Data files as instruments and laboratories write them, against the tables that they were made
//! from (`tests/data/laboratory`).

use gapilib::internals::mat::{self, MatFile};
use serde_json::Value;
use std::path::PathBuf;

fn folder() -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("tests/data/laboratory")
}

fn read(name: &str) -> Result<MatFile, String> {
    let bytes = std::fs::read(folder().join(name)).unwrap();
    mat::read_named(name, &bytes).map_err(|fault| fault.to_string())
}

fn strings(list: &Value) -> Vec<&str> {
    list.as_array().unwrap().iter().map(|word| word.as_str().unwrap()).collect()
}

/// What is wrong with the columns of a file; empty if nothing is.
fn wrong(file: &MatFile, expected: &Value) -> Vec<String> {
    let mut found = Vec::new();
    for (name, column) in expected["columns"].as_object().unwrap() {
        let read = match file.column(name) {
            Ok(read) => read,
            Err(fault) => {
                found.push(fault.to_string());
                continue;
            }
        };
        let finite: Vec<f64> = read.values.iter().copied().filter(|x| x.is_finite()).collect();
        let missing: Vec<usize> =
            (1..=read.values.len()).filter(|row| !read.values[row - 1].is_finite()).collect();
        let rows: Vec<usize> = serde_json::from_value(column["missing_rows"].clone()).unwrap();
        let unit = read.about.unit.clone().unwrap_or_default();
        let is =
            (read.values.len() as u64, finite.first().copied(), finite.last().copied(), missing);
        let should = (
            expected["points"].as_u64().unwrap(),
            column["first"].as_f64(),
            column["last"].as_f64(),
            rows,
        );
        if is != should || unit != column["unit"].as_str().unwrap() {
            found.push(format!("{name} is {is:?} in `{unit}`, not {should:?} {column}"));
        }
        if !is.3.is_empty() && !read.notes().any(|note| note.contains("missing")) {
            found.push(format!("no word about the missing values of {name}"));
        }
    }
    found
}

/// Every message about the file: it is refused, or its columns are, or what is said of the first as
/// the X of an experiment.
fn messages(name: &str) -> String {
    let file = match read(name) {
        Ok(file) => file,
        Err(message) => return message,
    };
    let mut said: Vec<String> =
        file.unreadable().map(|(column, _)| file.matrix(column).unwrap_err().to_string()).collect();
    let first = file.arrays.keys().next();
    said.extend(first.iter().flat_map(|first| file.column(first).unwrap().order(first)));
    said.join("\n")
}

fn judge(name: &str, expected: &Value) -> Vec<String> {
    if let Some(refuse) = expected.get("refuse") {
        let said = messages(name);
        let words = strings(&refuse["message_must_name"]);
        let missing = words.iter().filter(|word| !said.contains(*word));
        return missing.map(|word| format!("no `{word}` in: {said}")).collect();
    }
    let mut found = match read(name) {
        Ok(file) => wrong(&file, expected),
        Err(message) => vec![message],
    };
    if let Some(allowed) = expected.get("refuse_allowed").filter(|_| !found.is_empty()) {
        let said = messages(name);
        let words = allowed.as_array().map(|_| strings(allowed)).unwrap_or_else(|| vec!["line 1"]);
        if words.iter().all(|word| said.contains(word)) {
            found.clear();
        }
    }
    for (column, refuse) in expected["if_asked_for"].as_object().into_iter().flatten() {
        let fault = read(name).unwrap().column(column).unwrap_err().to_string();
        let words = strings(&refuse["refuse"]);
        found.extend(words.iter().filter(|word| !fault.contains(*word)).map(|_| fault.clone()));
    }
    found
}

#[test]
fn files_of_laboratories_are_read_as_they_are_meant() {
    let text = std::fs::read_to_string(folder().join("expected.json")).unwrap();
    let cases: serde_json::Map<String, Value> = serde_json::from_str(&text).unwrap();
    assert_eq!(cases.len(), 46);
    let failed: Vec<String> = cases
        .iter()
        .map(|(name, expected)| (name, judge(name, expected)))
        .filter(|(_, found)| !found.is_empty())
        .map(|(name, found)| format!("{name}: {}", found.join("\n    ")))
        .collect();
    assert!(failed.is_empty(), "{} of {}:\n{}", failed.len(), cases.len(), failed.join("\n"));
}
