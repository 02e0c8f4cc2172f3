//! What a script's own search has found, beside the solution that least squares from there gives.

use indexmap::IndexMap;
use serde::{Deserialize, Serialize};

/// The result of a search that a script has carried out.
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
    pub probe_simulations: u64,
    /// Whether the run was interrupted.
    pub interrupted: bool,
    /// Statements typed while it ran, and the first generation that they hold for.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub changes: Vec<(usize, String)>,
}
