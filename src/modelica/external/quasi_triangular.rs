//! The diagonal blocks of quasi-triangular matrices: one row for a real eigenvalue, two for a pair.

use nalgebra::DMatrix;

pub(crate) fn block(t: &DMatrix<f64>, k: usize) -> [[f64; 2]; 2] {
    [[t[(k, k)], t[(k, k + 1)]], [t[(k + 1, k)], t[(k + 1, k + 1)]]]
}

/// Number of rows of the block that starts in a row.
pub(crate) fn block_size(t: &DMatrix<f64>, row: usize) -> usize {
    if row + 1 < t.nrows() && t[(row + 1, row)] != 0.0 { 2 } else { 1 }
}

/// The first row of the block that a row belongs to.
pub(crate) fn block_start(t: &DMatrix<f64>, row: usize) -> usize {
    if row > 0 && t[(row, row - 1)] != 0.0 { row - 1 } else { row }
}
