//! Multiple zeros: solutions that are isolated though the Jacobian is singular there, as x = 0 of
//! x |x| = 0, which is a fan at rest whose flow rate is given.
//!
//! Along the only direction v with J v = 0 the residual grows with a power of the distance, also where
//! the other unknowns follow as well as they can:
//!
//! ```text
//! F of all but one equation = 0, one unknown held at that of x ± h v
//! |F of the other equation| ~ hᵖ, p ≥ 1        h = 1e-3, 5e-4, 2.5e-4 of the magnitudes of x
//! ```
//!
//! Where it does not, the equations depend on each other, and the solution is one of many, on a
//! straight line or a curve. Where J v = 0 for several directions, nothing is decided.

use crate::sim::Equations;

/// The largest distance, relative to the magnitudes of the unknowns.
const DISTANCE: f64 = 1e-3;
/// Residuals at half the distance are smaller by this factor at least; rounding errors are not, in
/// all four comparisons.
const GROWTH: f64 = 1.5;
/// The residual at the solution beside that at the smallest distance.
const AT_SOLUTION: f64 = 1e-2;
/// What is left of the residual at the smallest distance at least, in rows of largest entry 1: a
/// triple zero leaves 1.6e-11, rounding of the following unknowns less than 1e-14.
const SMALLEST: f64 = 1e-12;
/// Corrections of the unknowns that follow: each leaves a thousandth of the error of the one before.
const CORRECTIONS: usize = 6;
/// Pivots below this part of the first are zero.
const RANK: f64 = 1e-12;

/// Whether a solution at which the Jacobian is singular, exactly or nearly, is the only one nearby.
pub(super) fn is_isolated(equations: &mut dyn Equations, x: &[f64], nominal: &[f64]) -> bool {
    let n = x.len();
    let scale: Vec<f64> = x.iter().zip(nominal).map(|(x, nominal)| x.abs().max(*nominal)).collect();
    let (mut matrix, mut residual) = (vec![0.0; n * n], vec![0.0; n]);
    if equations.residual(x, &mut residual).is_err() || equations.jacobian(x, &mut matrix).is_err()
    {
        return false;
    }
    for (column, scale) in matrix.chunks_exact_mut(n).zip(&scale) {
        column.iter_mut().for_each(|entry| *entry *= scale);
    }
    let rows = row_scales(&matrix, n);
    for column in matrix.chunks_exact_mut(n) {
        column.iter_mut().zip(&rows).for_each(|(entry, row)| *entry *= row);
    }
    let Some(elimination) = Elimination::of(matrix, n) else { return false };
    let direction = elimination.null_direction();
    let mut size = |distance: f64| -> Option<f64> {
        let mut moved: Vec<f64> =
            (0..n).map(|i| x[i] + distance * direction[i] * scale[i]).collect();
        for corrected in 0..=CORRECTIONS {
            equations.residual(&moved, &mut residual).ok()?;
            residual.iter_mut().zip(&rows).for_each(|(f, row)| *f *= row);
            if corrected < CORRECTIONS {
                elimination.follow(&residual, &scale, &mut moved);
            }
        }
        let largest = residual.iter().fold(0.0, |a: f64, f| a.max(f.abs()));
        Some(largest).filter(|largest| largest.is_finite())
    };
    [DISTANCE, -DISTANCE].into_iter().all(|h| {
        let sizes = (size(h), size(h / 2.0), size(h / 4.0), size(0.0));
        let (Some(far), Some(middle), Some(near), Some(here)) = sizes else { return false };
        near > SMALLEST
            && far >= GROWTH * middle
            && middle >= GROWTH * near
            && here <= AT_SOLUTION * near
    })
}

/// One over the largest entry of each row; 1 for a row of zeros.
fn row_scales(matrix: &[f64], n: usize) -> Vec<f64> {
    let row = |i: usize| matrix.iter().skip(i).step_by(n);
    let largest = |i: usize| row(i).fold(0.0, |a: f64, b| a.max(b.abs()));
    (0..n).map(|i| if largest(i) > 0.0 { 1.0 / largest(i) } else { 1.0 }).collect()
}

/// A singular matrix by columns, eliminated with complete pivoting: rows and columns are swapped, the
/// factors stand below the diagonal. The last pivot is zero, or nearly.
struct Elimination {
    matrix: Vec<f64>,
    rows: Vec<usize>,
    columns: Vec<usize>,
}

impl Elimination {
    /// `None` if more than one pivot is zero.
    fn of(matrix: Vec<f64>, n: usize) -> Option<Elimination> {
        let order: Vec<usize> = (0..n).collect();
        let mut own = Elimination { matrix, rows: order.clone(), columns: order };
        let mut first = 0.0;
        for k in 0..n {
            let places = (k..n).flat_map(|j| (k..n).map(move |i| (i, j)));
            let (row, column) = places.max_by(|a, b| {
                let size = |(i, j): &(usize, usize)| own.matrix[j * n + i].abs();
                size(a).total_cmp(&size(b))
            })?;
            let pivot = own.matrix[column * n + row].abs();
            if k == 0 {
                first = pivot;
            }
            if k + 1 == n {
                return Some(own);
            }
            if pivot <= RANK * first {
                return None;
            }
            own.swap(k, row, column);
            own.eliminate(k);
        }
        None
    }

    fn swap(&mut self, k: usize, row: usize, column: usize) {
        let n = self.rows.len();
        self.rows.swap(k, row);
        self.columns.swap(k, column);
        (0..n).for_each(|i| self.matrix.swap(k * n + i, column * n + i));
        (0..n).for_each(|j| self.matrix.swap(j * n + k, j * n + row));
    }

    fn eliminate(&mut self, k: usize) {
        let (n, matrix) = (self.rows.len(), &mut self.matrix);
        for i in k + 1..n {
            let factor = matrix[k * n + i] / matrix[k * n + k];
            for j in k + 1..n {
                matrix[j * n + i] -= factor * matrix[j * n + k];
            }
            matrix[k * n + i] = factor;
        }
    }

    /// The direction that the matrix maps to zero, of largest component 1.
    fn null_direction(&self) -> Vec<f64> {
        let (n, matrix) = (self.rows.len(), &self.matrix);
        let mut permuted = vec![0.0; n];
        permuted[n - 1] = 1.0;
        for i in (0..n - 1).rev() {
            let sum: f64 = (i + 1..n).map(|j| matrix[j * n + i] * permuted[j]).sum();
            permuted[i] = -sum / matrix[i * n + i];
        }
        let largest = permuted.iter().fold(1.0, |a: f64, b| a.max(b.abs()));
        let mut direction = vec![0.0; n];
        self.columns.iter().zip(permuted).for_each(|(at, value)| direction[*at] = value / largest);
        direction
    }

    /// Lets all unknowns but the last one follow, so that all equations but the last one hold.
    fn follow(&self, residual: &[f64], scale: &[f64], x: &mut [f64]) {
        let (n, matrix) = (self.rows.len(), &self.matrix);
        let mut step: Vec<f64> = self.rows[..n - 1].iter().map(|row| residual[*row]).collect();
        for i in 0..n - 1 {
            let sum: f64 = (0..i).map(|j| matrix[j * n + i] * step[j]).sum();
            step[i] -= sum;
        }
        for i in (0..n - 1).rev() {
            let sum: f64 = (i + 1..n - 1).map(|j| matrix[j * n + i] * step[j]).sum();
            step[i] = (step[i] - sum) / matrix[i * n + i];
        }
        for (column, step) in self.columns.iter().zip(&step) {
            x[*column] -= step * scale[*column];
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::elementary;
    use crate::sim::Failure;

    struct Given(fn(&[f64], &mut [f64]), fn(&[f64], &mut [f64]));

    impl Equations for Given {
        fn residual(&mut self, x: &[f64], out: &mut [f64]) -> Result<(), Failure> {
            self.0(x, out);
            Ok(())
        }

        fn jacobian(&mut self, x: &[f64], out: &mut [f64]) -> Result<(), Failure> {
            self.1(x, out);
            Ok(())
        }
    }

    fn isolated(mut given: Given, x: &[f64]) -> bool {
        is_isolated(&mut given, x, &vec![1.0; x.len()])
    }

    #[test]
    fn a_double_zero_is_isolated() {
        let fan = Given(|x, f| f[0] = 6e4 * x[0] * x[0].abs(), |x, j| j[0] = 12e4 * x[0].abs());
        assert!(isolated(fan, &[0.0]));
        // x + y = 3, (x - y)² = 0
        let meeting = Given(
            |x, f| {
                f[0] = x[0] + x[1] - 3.0;
                f[1] = (x[0] - x[1]) * (x[0] - x[1]);
            },
            |x, j| {
                let entry = 2.0 * (x[0] - x[1]);
                j.copy_from_slice(&[1.0, entry, 1.0, -entry]);
            },
        );
        assert!(isolated(meeting, &[1.5, 1.5]));
    }

    #[test]
    fn equations_that_depend_on_each_other_have_no_isolated_solution() {
        // The second equation is three times the first, but for rounding.
        let twice = Given(
            |x, f| {
                f[0] = 0.1 * x[0] * x[1] - 0.1;
                f[1] = 0.3 * x[0] * x[1] - 0.3;
            },
            |x, j| j.copy_from_slice(&[0.1 * x[1], 0.3 * x[1], 0.1 * x[0], 0.3 * x[0]]),
        );
        assert!(!isolated(twice, &[0.1 + 0.2, 1.0 / (0.1 + 0.2)]));
        // x = y, sin(x - y) = 0, and 0 = 0 twice.
        let line = Given(
            |x, f| {
                f[0] = x[0] - x[1];
                f[1] = elementary::sin(x[0] - x[1]);
            },
            |_, j| j.copy_from_slice(&[1.0, 1.0, -1.0, -1.0]),
        );
        assert!(!isolated(line, &[0.7, 0.7]));
        let plane = Given(|_, f| f.fill(0.0), |_, j| j.fill(0.0));
        assert!(!isolated(plane, &[0.0, 0.0]));
    }
}
