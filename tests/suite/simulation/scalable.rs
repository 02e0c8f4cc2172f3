//! The ScalableTestSuite, from the folder that `GAPILIB_SCALABLE` names, which holds
//! `ScalableTestSuite`, with the standard library from the folder that `GAPILIB_MSL` names: every
//! model at the sizes that the library publishes (its packages `ScaledExperiments`) is simulated as
//! its experiment annotation says, one after the other, each in a process with a limit of time and
//! memory.

use crate::simulation::msl::is_experiment;
use crate::support::conformance::{Corpus, Ledger, folder, is_asked_for, say};
use std::path::Path;
use std::process::{Command, Output};

/// Seconds that a model may take, unless `GAPILIB_BUDGET` says otherwise.
const BUDGET: &str = "60";
/// Memory that a model may take, MiB.
const MEMORY: &str = "4096";

#[test]
fn models_of_the_scalable_test_suite_are_simulated_at_their_sizes() {
    let (Some(root), Some(msl)) = (folder("GAPILIB_SCALABLE"), folder("GAPILIB_MSL")) else {
        return;
    };
    let corpus = Corpus::load(&root);
    let is_scaled = |name: &gapilib::internals::name::Name| {
        let text = name.to_string();
        text.contains(".ScaledExperiments.")
            && is_asked_for(&text)
            && is_experiment(&corpus.library, name)
    };
    let models: Vec<_> = corpus.library.all().into_iter().filter(is_scaled).collect();
    assert!(!models.is_empty(), "the folder holds no scaled experiment");
    let mut ledger = Ledger::read("scalable.toml");
    let mut simulated = 0;
    for model in &models {
        let name = model.to_string();
        let output = simulated_alone(&name, &root, &msl);
        if output.status.success() {
            simulated += 1;
            continue;
        }
        let verdict = format!("fails: {}", code(&output));
        say(&format!("{name}: {verdict}"));
        ledger.note(&package(&name), &name, verdict);
    }
    say(&format!("{simulated} of {} models are simulated", models.len()));
    // How a model fails may change with the machine; that it fails must be known.
    ledger.settle(|_, _| false);
}

fn simulated_alone(model: &str, root: &Path, msl: &Path) -> Output {
    let scratch = tempfile::tempdir().expect("a temporary folder");
    let budget = std::env::var("GAPILIB_BUDGET").unwrap_or_else(|_| BUDGET.to_owned());
    let mut command = Command::new(env!("CARGO_BIN_EXE_gapi"));
    command.arg("simulate").arg("--library").arg(msl).arg("--library").arg(root);
    command.args(["--model", model, "--variable-filter", "time", "-o"]);
    command.arg(scratch.path().join("result.mat"));
    command.args(["--time-limit", &budget, "--memory-limit", MEMORY]);
    command.current_dir(scratch.path()).output().expect("gapi can be run")
}

/// The code of the first error; `stopped` if the process ended without one.
fn code(output: &Output) -> String {
    let text = String::from_utf8_lossy(&output.stderr);
    let code = text.lines().find_map(|line| line.strip_prefix("error["));
    code.and_then(|rest| rest.split(']').next()).unwrap_or("stopped").to_owned()
}

/// The name without its last part.
fn package(model: &str) -> String {
    model.rsplit_once('.').map_or(model, |(package, _)| package).to_owned()
}
