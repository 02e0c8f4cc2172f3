//! Real Schur form: A = Q T Qᵀ, T upper triangular but for blocks of two rows, one a conjugate pair
//! of eigenvalues ([Golub & Van Loan 2013](gapilib_base::bibliography#golub-van-loan-2013), §7.4, §7.6).
//!
//! Blocks are in LAPACK's standard form: equal diagonal elements, the other two of opposite signs.

use super::matrices::power_of_two;
use super::quasi_triangular::{block, block_size, block_start};
use super::sylvester::sylvester;
use crate::elementary;
use nalgebra::{Complex, DMatrix, DVector, Schur};

/// Absolute value of a complex number.
pub(crate) fn modulus(z: Complex<f64>) -> f64 {
    elementary::hypot(z.re, z.im)
}

/// Most sweeps of the iteration.
const MAX_SWEEPS: usize = 10_000;

/// A real Schur form.
#[derive(Debug, Clone)]
pub(crate) struct RealSchur {
    /// Orthogonal.
    pub(super) q: DMatrix<f64>,
    /// Upper quasi-triangular.
    pub(super) t: DMatrix<f64>,
}

impl RealSchur {
    /// The form of a square matrix; `None` if it was not found.
    pub(crate) fn of(a: &DMatrix<f64>) -> Option<RealSchur> {
        if a.nrows() < 2 {
            return Some(RealSchur { q: DMatrix::identity(a.nrows(), a.nrows()), t: a.clone() });
        }
        let size = power_of_two(a.amax());
        let a = a / size;
        let mut form = RealSchur::iterated(&a).or_else(|| RealSchur::reflected(&a))?;
        for row in 1..a.nrows() {
            form.t.view_mut((row, 0), (1, row - 1)).fill(0.0);
            let beside = form.t[(row - 1, row - 1)].abs() + form.t[(row, row)].abs();
            if form.t[(row, row - 1)].abs() <= f64::EPSILON * beside {
                form.t[(row, row - 1)] = 0.0;
            }
        }
        (0..a.nrows() - 1).for_each(|k| form.standardize(k));
        form.t *= size;
        Some(form)
    }

    fn iterated(a: &DMatrix<f64>) -> Option<RealSchur> {
        let (q, t) = Schur::try_new(a.clone(), f64::EPSILON, MAX_SWEEPS)?.unpack();
        Some(RealSchur { q, t })
    }

    /// Of a matrix that the iteration leaves as it is, as it does cyclic permutations: by way of one
    /// that is similar by a reflection.
    fn reflected(a: &DMatrix<f64>) -> Option<RealSchur> {
        let n = a.nrows();
        // Any direction that no symmetry of the matrix keeps.
        let axis = DVector::from_fn(n, |k, _| 1.0 / (k + 1) as f64).normalize();
        let reflection = DMatrix::identity(n, n) - 2.0 * &axis * axis.transpose();
        let RealSchur { q, t } = RealSchur::iterated(&(&reflection * a * &reflection))?;
        Some(RealSchur { q: reflection * q, t })
    }

    /// Brings the block of rows `k` and `k + 1`, if there is one, to standard form, or splits it if
    /// its eigenvalues are real.
    pub(crate) fn standardize(&mut self, k: usize) {
        if self.t[(k + 1, k)] == 0.0 {
            return;
        }
        let [[a, b], [c, d]] = block(&self.t, k);
        // Products must not overflow.
        let size = power_of_two([a, b, c, d].map(f64::abs).into_iter().fold(0.0, f64::max));
        let [a, b, c, d] = [a, b, c, d].map(|element| element / size);
        let half = (a - d) / 2.0;
        let discriminant = half * half + b * c;
        let is_real = discriminant >= 0.0;
        let angle = match is_real {
            // The first column becomes an eigenvector (half ± root, c).
            true => elementary::atan2(c, half + discriminant.sqrt().copysign(half)),
            false => -elementary::atan2(2.0 * half, b + c) / 2.0,
        };
        self.rotate(k, angle);
        if is_real {
            self.t[(k + 1, k)] = 0.0;
        } else {
            let mean = (self.t[(k, k)] + self.t[(k + 1, k + 1)]) / 2.0;
            self.t[(k, k)] = mean;
            self.t[(k + 1, k + 1)] = mean;
        }
    }

    /// A rotation of the coordinates `k` and `k + 1`: it maps the first axis to the given
    /// direction.
    fn rotate(&mut self, k: usize, angle: f64) {
        let (sin, cos) = elementary::sin_cos(angle);
        let rotation = |matrix: &mut DMatrix<f64>| {
            for row in 0..matrix.nrows() {
                let (x, y) = (matrix[(row, k)], matrix[(row, k + 1)]);
                matrix[(row, k)] = cos * x + sin * y;
                matrix[(row, k + 1)] = cos * y - sin * x;
            }
        };
        rotation(&mut self.q);
        rotation(&mut self.t);
        for column in 0..self.t.ncols() {
            let (x, y) = (self.t[(k, column)], self.t[(k + 1, column)]);
            self.t[(k, column)] = cos * x + sin * y;
            self.t[(k + 1, column)] = cos * y - sin * x;
        }
    }

    /// Brings chosen eigenvalues to the front, in their order; both of a pair count as chosen where
    /// one is. How many there are.
    pub(crate) fn reorder(&mut self, chosen: &[bool]) -> usize {
        let mut front = 0;
        let mut at = 0;
        while at < self.t.nrows() {
            let size = block_size(&self.t, at);
            if chosen[at..at + size].contains(&true) {
                let mut here = at;
                while here > front {
                    let before = block_start(&self.t, here - 1);
                    self.swap(before, here - before, size);
                    here = before;
                }
                front += size;
            }
            at += size;
        }
        front
    }

    /// Interchanges the blocks of `m` rows from `k` on and of `n` rows after them ([Golub & Van
    /// Loan 2013](gapilib_base::bibliography#golub-van-loan-2013), §7.6.2).
    fn swap(&mut self, k: usize, m: usize, n: usize) {
        let first = self.t.view((k, k), (m, m)).into_owned();
        let second = self.t.view((k + m, k + m), (n, n)).into_owned();
        let coupling = self.t.view((k, k + m), (m, n)).into_owned();
        // (−X, 1) spans the invariant subspace of the second block.
        let x = sylvester(&first, &second, &coupling, -1.0);
        let mut span = DMatrix::identity(m + n, m + n);
        span.view_mut((0, 0), (m, n)).copy_from(&-x);
        span.view_mut((m, 0), (n, n)).fill_with_identity();
        span.view_mut((0, n), (m, m)).fill_with_identity();
        span.view_mut((m, n), (n, m)).fill(0.0);
        let rotation = span.qr().q();
        for matrix in [&mut self.q, &mut self.t] {
            let rotated = matrix.columns(k, m + n) * &rotation;
            matrix.columns_mut(k, m + n).copy_from(&rotated);
        }
        let rotated = rotation.transpose() * self.t.rows(k, m + n);
        self.t.rows_mut(k, m + n).copy_from(&rotated);
        self.t.view_mut((k + n, k), (m, n)).fill(0.0);
        if n == 2 {
            self.standardize(k);
        }
        if m == 2 {
            self.standardize(k + n);
        }
    }

    /// The eigenvalues in the order of the diagonal; of a pair, the one with positive imaginary
    /// part first.
    pub(crate) fn eigenvalues(&self) -> Vec<Complex<f64>> {
        let mut values = Vec::with_capacity(self.t.nrows());
        while values.len() < self.t.nrows() {
            let at = values.len();
            let first = eigenvalue(&self.t, at);
            values.push(first);
            if block_size(&self.t, at) == 2 {
                values.push(first.conj());
            }
        }
        values
    }
}

/// The eigenvalue of the block that starts in a row: of a pair, the one with positive imaginary
/// part.
fn eigenvalue(t: &DMatrix<f64>, row: usize) -> Complex<f64> {
    if block_size(t, row) == 1 {
        return Complex::new(t[(row, row)], 0.0);
    }
    let [[a, b], [c, d]] = block(t, row);
    // In standard form a is d, and b and c are of opposite signs.
    Complex::new((a + d) / 2.0, b.abs().sqrt() * c.abs().sqrt())
}
