//! Singular value decomposition by one-sided Jacobi rotations: columns are turned against each other
//! until all are orthogonal; their lengths are the singular values.
//!
//! The crate nalgebra, whose matrices are used here, answers wrong singular values for some matrices
//! whose rank is deficient (its issue 1172: the matrix of ones is one of them), which is where the
//! identifiability of parameters is decided. One-sided Jacobi finds also small singular values to
//! high relative accuracy where columns differ in scale.
//!
//! Reference: [Demmel & Veselić 1992](crate::bibliography#demmel-veselic-1992).

use crate::elementary;
use nalgebra::{DMatrix, DVector};

/// Columns count as orthogonal when the cosine between them is below this.
const ORTHOGONAL: f64 = 1e-15;
/// Sweeps over all pairs; six to ten are usual.
const SWEEPS: usize = 60;

/// A = U diag(s) Vᵀ with m × k, k and k × n entries, k the smaller of m and n; s descends.
#[derive(Debug, Clone)]
pub struct SingularValues {
    /// Left singular vectors, orthonormal.
    pub u: DMatrix<f64>,
    /// Singular values, the largest first.
    pub s: DVector<f64>,
    /// Right singular vectors, orthonormal rows.
    pub v_t: DMatrix<f64>,
}

impl SingularValues {
    /// Decomposes a matrix; `None` where it holds a value that is not finite.
    pub fn of(a: &DMatrix<f64>) -> Option<SingularValues> {
        if !a.iter().all(|value| value.is_finite()) {
            return None;
        }
        if a.nrows() < a.ncols() {
            let SingularValues { u, s, v_t } = SingularValues::tall(&a.transpose());
            return Some(SingularValues { u: v_t.transpose(), s, v_t: u.transpose() });
        }
        Some(SingularValues::tall(a))
    }

    /// The largest singular value; 0 for a matrix without entries.
    pub fn largest(&self) -> f64 {
        self.s.iter().copied().next().unwrap_or(0.0)
    }

    /// How many singular values are larger than `least`.
    pub fn rank(&self, least: f64) -> usize {
        self.s.iter().filter(|value| **value > least).count()
    }

    /// The solution of least squares with the smallest norm; singular values up to `least` count as
    /// zero. `b` has as many rows as the matrix.
    pub fn solve(&self, b: &DMatrix<f64>, least: f64) -> DMatrix<f64> {
        let mut z = self.u.tr_mul(b);
        for (mut row, s) in z.row_iter_mut().zip(self.s.iter()) {
            row *= if *s > least { 1.0 / s } else { 0.0 };
        }
        self.v_t.tr_mul(&z)
    }

    /// At least as many rows as columns.
    fn tall(a: &DMatrix<f64>) -> SingularValues {
        let n = a.ncols();
        // Columns of size one cannot overflow when they are multiplied.
        let size = a.amax();
        let mut work = if size > 0.0 { a / size } else { a.clone() };
        let mut v = DMatrix::identity(n, n);
        for _ in 0..SWEEPS {
            if !sweep(&mut work, &mut v) {
                break;
            }
        }
        let lengths: Vec<f64> = work.column_iter().map(|column| column.norm()).collect();
        let mut order: Vec<usize> = (0..n).collect();
        order.sort_by(|&a, &b| lengths[b].total_cmp(&lengths[a]));
        let s = DVector::from_iterator(n, order.iter().map(|&k| lengths[k]));
        let u = left_vectors(&work.select_columns(&order), &s);
        SingularValues { u, s: s * size, v_t: v.select_columns(&order).transpose() }
    }
}

/// Rotates every pair of columns that is not orthogonal; whether there was one.
fn sweep(work: &mut DMatrix<f64>, v: &mut DMatrix<f64>) -> bool {
    let mut rotated = false;
    for p in 0..work.ncols() {
        for q in p + 1..work.ncols() {
            let (alpha, beta) = (work.column(p).norm_squared(), work.column(q).norm_squared());
            let gamma = work.column(p).dot(&work.column(q));
            // Also where the product of both underflows to zero.
            if gamma.abs() <= ORTHOGONAL * alpha.sqrt() * beta.sqrt() || gamma == 0.0 {
                continue;
            }
            rotated = true;
            let zeta = (beta - alpha) / (2.0 * gamma);
            let tangent = zeta.signum() / (zeta.abs() + elementary::hypot(zeta, 1.0));
            let cosine = 1.0 / elementary::hypot(tangent, 1.0);
            rotate(work, [p, q], cosine, cosine * tangent);
            rotate(v, [p, q], cosine, cosine * tangent);
        }
    }
    rotated
}

fn rotate(matrix: &mut DMatrix<f64>, [p, q]: [usize; 2], cosine: f64, sine: f64) {
    for row in 0..matrix.nrows() {
        let (a, b) = (matrix[(row, p)], matrix[(row, q)]);
        matrix[(row, p)] = cosine * a - sine * b;
        matrix[(row, q)] = sine * a + cosine * b;
    }
}

/// Columns of unit length; those of the size of rounding are replaced by what is orthogonal to the
/// others.
fn left_vectors(work: &DMatrix<f64>, s: &DVector<f64>) -> DMatrix<f64> {
    let (m, n) = work.shape();
    let least = s.iter().copied().next().unwrap_or(0.0) * f64::EPSILON * m as f64;
    let mut u = DMatrix::zeros(m, n);
    let mut unit = 0;
    for k in 0..n {
        let known = u.columns(0, k).into_owned();
        let column = if s[k] > least { Some(work.column(k) / s[k]) } else { None };
        let column = column.unwrap_or_else(|| {
            // One of m unit vectors is at least so far from the space of fewer than m columns.
            loop {
                let mut axis = DVector::zeros(m);
                axis[unit % m] = 1.0;
                unit += 1;
                // Twice is enough.
                for _ in 0..2 {
                    axis -= &known * known.tr_mul(&axis);
                }
                if axis.norm_squared() * 2.0 * m as f64 >= 1.0 {
                    return axis.normalize();
                }
            }
        });
        u.set_column(k, &column);
    }
    u
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn assert_decomposes(a: &DMatrix<f64>) -> SingularValues {
        let found = SingularValues::of(a).unwrap();
        let k = found.s.len();
        let close = |a: &DMatrix<f64>, b: &DMatrix<f64>, size: f64| {
            assert!((a - b).amax() <= 1e-13 * size.max(f64::MIN_POSITIVE), "{a} {b}");
        };
        close(&(&found.u * DMatrix::from_diagonal(&found.s) * &found.v_t), a, a.norm());
        close(&found.u.tr_mul(&found.u), &DMatrix::identity(k, k), 1.0);
        close(&(&found.v_t * found.v_t.transpose()), &DMatrix::identity(k, k), 1.0);
        assert!(found.s.as_slice().is_sorted_by(|a, b| a >= b));
        found
    }

    #[test]
    fn matrices_of_ones_have_one_singular_value() {
        for (m, n) in (1..20).flat_map(|m| (1..20).map(move |n| (m, n))) {
            let found = assert_decomposes(&DMatrix::repeat(m, n, 1.0));
            let exact = ((m * n) as f64).sqrt();
            assert!((found.largest() - exact).abs() < 1e-13 * exact);
            assert_eq!(found.rank(1e-12), 1);
        }
    }

    /// nalgebra 0.35 answers 1.427 for the first singular value.
    #[test]
    fn equal_columns_with_an_error_of_rounding() {
        let a = DMatrix::from_row_slice(2, 2, &[-1.0, -1.0 - 2.2e-16, 0.0, 1.152e-15]);
        let found = assert_decomposes(&a);
        assert!((found.largest() - 2.0_f64.sqrt()).abs() < 1e-14);
    }

    #[test]
    fn small_values_are_accurate_where_columns_differ_in_scale() {
        // Orthogonal but for their scale: the lengths of the columns.
        let scales = [1.0, 1e-8, 1e-16];
        let base = [[1.0, 2.0, 2.0], [2.0, 1.0, -2.0], [2.0, -2.0, 1.0]];
        let found =
            assert_decomposes(&DMatrix::from_fn(3, 3, |row, k| base[row][k] / 3.0 * scales[k]));
        for (found, exact) in found.s.iter().zip(scales) {
            assert!((found / exact - 1.0).abs() < 1e-14, "{found} {exact}");
        }
    }

    #[test]
    fn least_squares_of_deficient_rank_have_the_smallest_norm() {
        let a = DMatrix::from_row_slice(3, 2, &[1.0, 1.0, 2.0, 2.0, 3.0, 3.0]);
        let b = DMatrix::from_column_slice(3, 1, &[2.0, 4.0, 6.0]);
        let x = SingularValues::of(&a).unwrap().solve(&b, 1e-12);
        assert!((x[0] - 1.0).abs() < 1e-14 && (x[1] - 1.0).abs() < 1e-14, "{x}");
    }

    #[test]
    fn nothing_and_what_is_not_finite() {
        assert_eq!(SingularValues::of(&DMatrix::zeros(3, 0)).unwrap().largest(), 0.0);
        assert_decomposes(&DMatrix::zeros(4, 3));
        assert!(SingularValues::of(&DMatrix::repeat(2, 2, f64::NAN)).is_none());
        assert_decomposes(&(DMatrix::<f64>::identity(3, 3) * 1e300));
        assert_decomposes(&(DMatrix::<f64>::identity(3, 3) * 1e-300));
    }

    proptest! {
        #[test]
        fn every_matrix_is_decomposed(
            (m, n) in (1usize..7, 1usize..7),
            values in prop::collection::vec(-2i8..=2, 36),
            exponents in prop::collection::vec(-12i32..=12, 6),
        ) {
            let a = DMatrix::from_fn(m, n, |row, k| {
                f64::from(values[6 * row + k]) * 10f64.powi(exponents[k])
            });
            assert_decomposes(&a);
        }
    }
}
