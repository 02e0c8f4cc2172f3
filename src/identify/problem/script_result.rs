//! What a script's own search has found, beside the solution that least squares from there gives.

use super::{Finding, FindingKind, Severity};
use indexmap::IndexMap;
use serde::{Deserialize, Serialize};

/// The result of a search that a script has executed.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct ScriptResult {
    /// The parameters of its best individual.
    pub parameters: IndexMap<String, f64>,
    /// The objective value of that individual, as the script has it.
    pub fitness: f64,
    /// What the objective is.
    pub fitness_name: String,
    /// Whether the values of the solution are those of least squares, and not of the script.
    pub probed: bool,
    /// What least squares made of it, in a sentence.
    pub probe: String,
    /// Simulations of least squares.
    pub(crate) probe_simulations: u64,
    /// Whether the run was interrupted.
    pub interrupted: bool,
    /// The first error of the script that it did not handle.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub error: Option<ScriptError>,
    /// Statements typed while it ran, and the first generation that they hold for.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub changes: Vec<(usize, String)>,
}

/// An error that a script did not handle.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct ScriptError {
    /// The script; empty where the error belongs to no statement.
    pub file: String,
    /// The line of the statement, from 1.
    pub line: usize,
    /// What is wrong.
    pub message: String,
}

impl ScriptError {
    /// Where it happened: how the run ended, in a few words.
    pub fn place(&self) -> String {
        match self.file.as_str() {
            "" => "error".to_owned(),
            file => format!("error in {file}, line {}", self.line),
        }
    }

    /// The error in a sentence.
    pub fn sentence(&self) -> String {
        let place = self.place();
        let place = place.strip_prefix("error").unwrap_or_default();
        format!("The script failed with an error{place}: {}.", self.message.trim_end_matches('.'))
    }

    /// The finding that comes before all others.
    pub fn finding(&self) -> Finding {
        let sentence = format!(
            "{} The result is that of the simulations which the script has evaluated.",
            self.sentence()
        );
        Finding::new(FindingKind::Search, sentence).severity(Severity::Serious)
    }
}
