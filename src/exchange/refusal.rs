//! Why a file of another program is not imported.

use crate::diag::Fault;
use std::ops::Range;

/// What is wrong with a file, or not supported in it, and where.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Refusal {
    /// The name of the file; empty for the one that is read.
    pub file: String,
    /// The place in its text, in bytes.
    pub place: Range<usize>,
    /// What is wrong.
    pub fault: Fault,
}

impl Refusal {
    /// What is wrong at this place of the file that is read.
    pub(crate) fn new(place: Range<usize>, fault: Fault) -> Refusal {
        Refusal { file: String::new(), place, fault }
    }

    /// The same in a file of this name, unless the file is known.
    pub(crate) fn in_file(mut self, file: &str) -> Refusal {
        if self.file.is_empty() {
            file.clone_into(&mut self.file);
        }
        self
    }
}
