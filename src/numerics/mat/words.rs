//! The cells of columns that are not all numbers.

use std::ops::Range;
use std::sync::Arc;

/// The cells of a column that are not all numbers.
#[derive(Debug, Clone, PartialEq, Default)]
pub(super) struct Words {
    /// The cells; `None` where a value is missing.
    pub cells: Vec<Option<String>>,
    /// Their lines, counted from 1.
    pub lines: Arc<[usize]>,
}

impl Words {
    /// These rows alone.
    pub(super) fn rows(&self, rows: Range<usize>) -> Words {
        Words { cells: self.cells[rows.clone()].to_vec(), lines: self.lines[rows].into() }
    }
}
