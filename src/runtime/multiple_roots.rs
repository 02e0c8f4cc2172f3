//! Multiple zeros: solutions that are isolated though the Jacobian is singular there, as x = 0 of
//! x |x| = 0, which is a fan at rest whose flow rate is given.
//!
//! Along the only direction v with J v = 0 the residual grows with a power of the distance:
//!
//! ```text
//! |F(x ± h v)| ~ hᵖ, p ≥ 1        h = 1e-3, 5e-4, 2.5e-4 of the magnitudes of x
//! ```
//!
//! Where it does not, the equations depend on each other, and the solution is one of many. Where J v
//! = 0 for several directions, nothing is decided.

use crate::sim::Equations;

/// The largest distance, relative to the magnitudes of the unknowns.
const DISTANCE: f64 = 1e-3;
/// Residuals at half the distance are smaller by this factor at least; rounding errors are not, in
/// all four comparisons.
const GROWTH: f64 = 1.5;
/// The residual at the solution beside that at the smallest distance.
const AT_SOLUTION: f64 = 1e-2;
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
    let Some(direction) = null_direction(matrix, n) else { return false };
    let mut size = |distance: f64| {
        let moved: Vec<f64> = (0..n).map(|i| x[i] + distance * direction[i] * scale[i]).collect();
        let evaluated = equations.residual(&moved, &mut residual);
        let largest =
            residual.iter().zip(&rows).fold(0.0, |a: f64, (f, row)| a.max((f * row).abs()));
        evaluated.is_ok().then_some(largest).filter(|largest| largest.is_finite())
    };
    [DISTANCE, -DISTANCE].into_iter().all(|h| {
        let sizes = (size(h), size(h / 2.0), size(h / 4.0), size(0.0));
        let (Some(far), Some(middle), Some(near), Some(here)) = sizes else { return false };
        near > 0.0
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

/// The direction that a singular matrix by columns maps to zero, of largest component 1; `None` if
/// there are several. By elimination with complete pivoting: of a matrix that is only nearly singular
/// the direction of the last pivot.
fn null_direction(mut matrix: Vec<f64>, n: usize) -> Option<Vec<f64>> {
    let mut columns: Vec<usize> = (0..n).collect();
    let mut first = 0.0;
    for k in 0..n {
        let places = (k..n).flat_map(|j| (k..n).map(move |i| (i, j)));
        let (row, column) = places.max_by(|a, b| {
            let size = |(i, j): &(usize, usize)| matrix[j * n + i].abs();
            size(a).total_cmp(&size(b))
        })?;
        let pivot = matrix[column * n + row].abs();
        if k == 0 {
            first = pivot;
        }
        if k + 1 == n {
            return Some(back_substituted(&matrix, &columns));
        }
        if pivot <= RANK * first {
            return None;
        }
        columns.swap(k, column);
        (0..n).for_each(|i| matrix.swap(k * n + i, column * n + i));
        (0..n).for_each(|j| matrix.swap(j * n + k, j * n + row));
        for i in k + 1..n {
            let factor = matrix[k * n + i] / matrix[k * n + k];
            for j in k..n {
                matrix[j * n + i] -= factor * matrix[j * n + k];
            }
        }
    }
    None
}

/// The solution of U v = 0 with the last component 1, in the order of the unknowns, scaled.
fn back_substituted(matrix: &[f64], columns: &[usize]) -> Vec<f64> {
    let n = columns.len();
    let mut permuted = vec![0.0; n];
    permuted[n - 1] = 1.0;
    for i in (0..n - 1).rev() {
        let sum: f64 = (i + 1..n).map(|j| matrix[j * n + i] * permuted[j]).sum();
        permuted[i] = -sum / matrix[i * n + i];
    }
    let largest = permuted.iter().fold(1.0, |a: f64, b| a.max(b.abs()));
    let mut direction = vec![0.0; n];
    columns.iter().zip(permuted).for_each(|(at, value)| direction[*at] = value / largest);
    direction
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
                let slope = 2.0 * (x[0] - x[1]);
                j.copy_from_slice(&[1.0, slope, 1.0, -slope]);
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
