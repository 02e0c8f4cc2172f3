//! Balancing of square matrices before their eigenvalues are computed, as LAPACK's `dgebal` and
//! `dgebak` do: eigenvalues that a permutation isolates are brought to the ends of the diagonal, and
//! the rows and columns between them are scaled to about equal norms by powers of two, which rounds
//! nothing ([Golub & Van Loan 2013](gapilib_base::bibliography#golub-van-loan-2013), §7.5.7).
//!
//! The scaling is nalgebra's, by 2-norms ([James et al. 2014](gapilib_base::bibliography#james-2014)). On
//! D R D⁻¹ with D from 10⁻⁶ to 10⁶ it brings the relative error of eigenvalues from 1e-1 to 3e-15
//! (`tests/suite/language/lapack_accuracy.rs`).

use super::matrices::power_of_two;
use nalgebra::DMatrix;
use nalgebra::linalg::balancing::balance_parlett_reinsch;
use std::ops::Range;

/// A similar matrix, and how it came about.
#[derive(Debug, Clone)]
pub(crate) struct Balanced {
    /// B = D⁻¹ Pᵀ A P D.
    pub(super) matrix: DMatrix<f64>,
    /// Rows and columns that are scaled; upper triangular before and after these.
    pub(super) active: Range<usize>,
    /// The diagonal of D within `active`; the row, from 0, that was interchanged with this one
    /// outside.
    pub(super) scale: Vec<f64>,
}

impl Balanced {
    /// Neither permuted nor scaled.
    pub(crate) fn unchanged(matrix: DMatrix<f64>) -> Balanced {
        let n = matrix.nrows();
        Balanced { matrix, active: 0..n, scale: vec![1.0; n] }
    }

    /// Permuted and scaled.
    pub(crate) fn of(matrix: DMatrix<f64>) -> Balanced {
        let mut balanced = Balanced::unchanged(matrix);
        balanced.permute();
        balanced.scale();
        balanced
    }

    /// Rows without elements beside the diagonal go down, then columns without them to the left.
    pub(crate) fn permute(&mut self) {
        while let Some(row) = self.active.clone().rev().find(|row| self.is_isolated(*row, false)) {
            self.active.end -= 1;
            self.interchange(row, self.active.end);
        }
        while let Some(column) = self.active.clone().find(|column| self.is_isolated(*column, true))
        {
            self.interchange(column, self.active.start);
            self.active.start += 1;
        }
    }

    /// Whether a row, or a column, has no element beside the diagonal within the active part.
    fn is_isolated(&self, k: usize, column: bool) -> bool {
        let at = |j: usize| if column { self.matrix[(j, k)] } else { self.matrix[(k, j)] };
        self.active.clone().all(|j| j == k || at(j) == 0.0)
    }

    fn interchange(&mut self, k: usize, with: usize) {
        self.matrix.swap_rows(k, with);
        self.matrix.swap_columns(k, with);
        self.scale[with] = k as f64;
    }

    /// Scales the active part.
    pub(crate) fn scale(&mut self) {
        let (first, size) = (self.active.start, self.active.len());
        let block = self.matrix.view((first, first), (size, size));
        // Squares of its elements must not overflow.
        let mut block = block / power_of_two(block.amax());
        let scale = balance_parlett_reinsch(&mut block);
        if !scale.iter().all(|factor| factor.is_normal()) {
            return;
        }
        for (k, factor) in self.active.clone().zip(scale.iter()) {
            self.matrix.column_mut(k).scale_mut(*factor);
            self.matrix.row_mut(k).unscale_mut(*factor);
            self.scale[k] = *factor;
        }
    }

    /// Transforms right eigenvectors of the balanced matrix, as columns, to those of the matrix.
    pub(crate) fn right(&self, vectors: &mut DMatrix<f64>) {
        for k in self.active.clone() {
            vectors.row_mut(k).scale_mut(self.scale[k]);
        }
        self.back(vectors);
    }

    /// Transforms left eigenvectors of the balanced matrix, as columns, to those of the matrix.
    pub(crate) fn left(&self, vectors: &mut DMatrix<f64>) {
        for k in self.active.clone() {
            vectors.row_mut(k).unscale_mut(self.scale[k]);
        }
        self.back(vectors);
    }

    fn back(&self, vectors: &mut DMatrix<f64>) {
        for k in (0..self.active.start).rev().chain(self.active.end..self.scale.len()) {
            vectors.swap_rows(k, self.scale[k] as usize);
        }
    }
}
