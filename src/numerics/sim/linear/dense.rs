//! Dense LU with partial pivoting, in place: nothing is allocated after construction. The one of the
//! simulation: Newton's methods, loops within tapes and integrators use it.
//!
//! Not nalgebra's, which takes its matrix by value and allocates a permutation for each factorization:
//! here factorizations are repeated in the innermost loops. Where a matrix is factorised once and may
//! be rectangular or singular, as for LAPACK's routines in `external`, nalgebra's is used.

use super::SingularMatrix;

/// A pivot that can be divided by.
fn usable(pivot: f64) -> Result<f64, SingularMatrix> {
    match pivot == 0.0 || !pivot.is_finite() {
        true => Err(SingularMatrix),
        false => Ok(pivot),
    }
}

/// A dense square matrix and its factors, P A = L U.
#[derive(Debug, Clone)]
pub struct DenseLu {
    n: usize,
    /// By columns; the matrix before, L below and U on and above the diagonal after factorisation.
    entries: Vec<f64>,
    /// The row that was exchanged with row k in step k.
    pivots: Vec<usize>,
}

impl DenseLu {
    /// For matrices of n rows and columns.
    pub fn new(n: usize) -> DenseLu {
        DenseLu { n, entries: vec![0.0; n * n], pivots: vec![0; n] }
    }

    /// Number of rows.
    pub(super) fn size(&self) -> usize {
        self.n
    }

    /// The entries, by columns, to be written before [`DenseLu::factorize`].
    #[inline]
    pub fn matrix(&mut self) -> &mut [f64] {
        &mut self.entries
    }

    /// Replaces the matrix by its factors.
    pub fn factorize(&mut self) -> Result<(), SingularMatrix> {
        // The loops of most models have one or two unknowns, and are solved in every evaluation.
        match self.entries.as_mut_slice() {
            [a] => return usable(*a).map(|_| ()),
            [a, b, c, d] => {
                let is_second = a.abs().total_cmp(&b.abs()).is_le();
                if is_second {
                    std::mem::swap(a, b);
                    std::mem::swap(c, d);
                }
                self.pivots[0] = usize::from(is_second);
                *b /= usable(*a)?;
                if *c != 0.0 {
                    *d -= *b * *c;
                }
                self.pivots[1] = 1;
                return usable(*d).map(|_| ());
            }
            _ => {}
        }
        let n = self.n;
        for k in 0..n {
            let column = &self.entries[k * n..(k + 1) * n];
            let pivot = (k..n).max_by(|a, b| column[*a].abs().total_cmp(&column[*b].abs()));
            let pivot = pivot.expect("k is less than n");
            let value = usable(column[pivot])?;
            self.pivots[k] = pivot;
            self.eliminate(k, pivot, value);
        }
        Ok(())
    }

    fn eliminate(&mut self, k: usize, pivot: usize, value: f64) {
        let n = self.n;
        let (left, right) = self.entries.split_at_mut((k + 1) * n);
        let pivot_column = &mut left[k * n..];
        pivot_column.swap(k, pivot);
        for factor in &mut pivot_column[k + 1..] {
            *factor /= value;
        }
        for column in right.chunks_exact_mut(n) {
            column.swap(k, pivot);
            let top = column[k];
            if top != 0.0 {
                for (entry, factor) in column[k + 1..].iter_mut().zip(&pivot_column[k + 1..]) {
                    *entry -= factor * top;
                }
            }
        }
        for column in self.entries[..k * n].chunks_exact_mut(n) {
            column.swap(k, pivot);
        }
    }

    /// The sign of the determinant of what was factorised.
    pub fn sign(&self) -> f64 {
        let pivots = self.entries.iter().step_by(self.n + 1);
        let exchanged = self.pivots.iter().enumerate().filter(|(k, pivot)| k != *pivot).count();
        let negative = pivots.filter(|pivot| **pivot < 0.0).count();
        if (exchanged + negative) % 2 == 0 { 1.0 } else { -1.0 }
    }

    /// Replaces the right-hand side by the solution.
    pub fn solve(&self, b: &mut [f64]) {
        match (self.entries.as_slice(), &mut *b) {
            ([entry], [x]) => return *x /= entry,
            ([u11, l21, u12, u22], [x, y]) => {
                if self.pivots[0] == 1 {
                    std::mem::swap(x, y);
                }
                *y -= l21 * *x;
                *y /= u22;
                *x -= u12 * *y;
                *x /= u11;
                return;
            }
            _ => {}
        }
        let n = self.n;
        for (k, pivot) in self.pivots.iter().enumerate() {
            b.swap(k, *pivot);
        }
        for k in 0..n {
            let x = b[k];
            for (b, factor) in b[k + 1..].iter_mut().zip(&self.entries[k * n + k + 1..(k + 1) * n])
            {
                *b -= factor * x;
            }
        }
        for k in (0..n).rev() {
            b[k] /= self.entries[k * n + k];
            let x = b[k];
            for (b, entry) in b[..k].iter_mut().zip(&self.entries[k * n..k * n + k]) {
                *b -= entry * x;
            }
        }
    }
}
