//! Where in the scripts something happened.

use serde::{Deserialize, Serialize};

/// A line of a script.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
pub struct ScriptLine {
    /// Which of the trace's scripts, from 0.
    pub script: u32,
    /// Its line, from 1.
    pub line: u32,
}
