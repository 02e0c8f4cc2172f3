//! The IBPSA library, from the folder that `GAPILIB_IBPSA` names, which holds `IBPSA`, with the
//! standard library from the folder that `GAPILIB_MSL` names: `gapi verify` compares every model
//! that has reference results of Dymola with them, external functions in C included.

use crate::support::conformance::{Ledger, Stage, filter, folder, say};
use std::collections::BTreeMap;
use std::process::Command;

/// Seconds that a model may take: those that simulate a year take most of it.
const BUDGET: &str = "60";

#[test]
fn examples_of_the_ibpsa_library_agree_with_their_references() {
    let (Some(root), Some(msl)) = (folder("GAPILIB_IBPSA"), folder("GAPILIB_MSL")) else { return };
    let scratch = tempfile::tempdir().expect("a temporary folder");
    let table = scratch.path().join("table.json");
    let mut command = Command::new(env!("CARGO_BIN_EXE_gapi"));
    command.arg("verify").arg("--library").arg(&msl).arg("--library").arg(&root);
    command.arg("--references").arg(root.join("IBPSA/Resources/ReferenceResults/Dymola"));
    let budget = std::env::var("GAPILIB_BUDGET").unwrap_or_else(|_| BUDGET.to_owned());
    command.args(["--allow-read", "--allow-external", "--budget", &budget, "-o"]).arg(&table);
    if let Some(filter) = filter() {
        command.args(["--filter", &filter]);
    }
    let output = command.current_dir(scratch.path()).output().expect("gapi can be run");
    let text = std::fs::read(&table).unwrap_or_else(|_| panic!("{output:?}"));
    let rows: serde_json::Value = serde_json::from_slice(&text).expect("JSON");
    let rows = rows.as_array().expect("one object a model");
    assert!(!rows.is_empty(), "the collection holds no case");
    let mut ledger = Ledger::read("ibpsa.toml");
    let mut counts = BTreeMap::new();
    for row in rows {
        let (model, verdict) = (row["model"].as_str().expect("a name"), verdict(row));
        let word = verdict.as_deref().map_or("agree", |verdict| {
            if verdict.starts_with("differs") { "differ" } else { "fail" }
        });
        *counts.entry(word).or_insert(0) += 1;
        if let Some(verdict) = verdict {
            say(&format!("{model}: {verdict}"));
            ledger.note(&package(model), model, verdict);
        }
    }
    say(&format!("{} models: {counts:?}", rows.len()));
    ledger.settle(is_worse);
}

/// What is wrong with a model; `None` if nothing is.
fn verdict(row: &serde_json::Value) -> Option<String> {
    let text = |key: &str| row[key].as_str().unwrap_or_default();
    match text("outcome") {
        "agreed" | "unjudged" => None,
        "differs" => Some(format!("differs: {}", text("signal"))),
        "failed" => Some(format!("{}: {}", text("stage"), text("code"))),
        other => Some(other.to_owned()),
    }
}

/// The first two parts of a name, such as `IBPSA.Fluid`.
fn package(model: &str) -> String {
    model.split('.').take(2).collect::<Vec<_>>().join(".")
}

/// Whether a model gets less far than the ledger says; a trajectory that was not known to be wrong
/// is worse than an error.
fn is_worse(old: &str, new: &str) -> bool {
    if new.starts_with("differs:") {
        return !old.starts_with("differs:");
    }
    let stage = |reason: &str| Stage::named(reason.split(':').next().unwrap_or(""));
    stage(new) < stage(old)
}
