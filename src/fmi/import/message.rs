//! A message of a unit.

use serde::{Deserialize, Serialize};

/// A message of a unit.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct LogMessage {
    /// Whether the unit calls it a warning or an error.
    pub is_problem: bool,
    /// The category that the unit gives it.
    pub category: String,
    /// The text.
    pub text: String,
}
