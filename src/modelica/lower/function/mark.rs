//! A state of a function being compiled to go back to.

use super::emitter::Checkpoint;

/// How far the code of a function, and each list of jumps whose targets are open, has come.
pub(super) struct Mark {
    pub(super) emitter: Checkpoint,
    pub(super) branches: usize,
    pub(super) breaks: Vec<usize>,
    pub(super) returns: usize,
}

impl Mark {
    /// The number of instructions.
    pub(super) fn length(&self) -> usize {
        self.emitter.length()
    }
}
