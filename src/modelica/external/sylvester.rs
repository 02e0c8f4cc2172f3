//! Sylvester's equation A X ± X B = C with quasi-triangular matrices.

use super::quasi_triangular::block_size;
use nalgebra::{DMatrix, DVector};

/// X with A X + sign X B = C, for upper quasi-triangular A and B ([Golub &
/// Van Loan 2013](gapilib_base::bibliography#golub-van-loan-2013), §7.6.3). Where the equation has no unique
/// solution, the nearest that has one is solved.
pub(crate) fn sylvester(
    a: &DMatrix<f64>,
    b: &DMatrix<f64>,
    c: &DMatrix<f64>,
    sign: f64,
) -> DMatrix<f64> {
    let (rows, columns) = (starts(a), starts(b));
    let mut x = DMatrix::zeros(a.nrows(), b.nrows());
    for &(column, n) in &columns {
        for &(row, m) in rows.iter().rev() {
            // Elements not solved for yet are zero.
            let known = a.rows(row, m) * x.columns(column, n)
                + sign * x.rows(row, m) * b.columns(column, n);
            let right = c.view((row, column), (m, n)) - known;
            let solved = small_sylvester(
                &a.view((row, row), (m, m)).into_owned(),
                &b.view((column, column), (n, n)).into_owned(),
                &right,
                sign,
            );
            x.view_mut((row, column), (m, n)).copy_from(&solved);
        }
    }
    x
}

/// First row and number of rows of every block.
fn starts(t: &DMatrix<f64>) -> Vec<(usize, usize)> {
    let mut blocks = Vec::new();
    let mut at = 0;
    while at < t.nrows() {
        let size = block_size(t, at);
        blocks.push((at, size));
        at += size;
    }
    blocks
}

/// As a linear system of the elements of X, column by column.
fn small_sylvester(
    a: &DMatrix<f64>,
    b: &DMatrix<f64>,
    c: &DMatrix<f64>,
    sign: f64,
) -> DMatrix<f64> {
    let (m, n) = (a.nrows(), b.nrows());
    let mut system = DMatrix::identity(n, n).kronecker(a);
    system += sign * b.transpose().kronecker(&DMatrix::identity(m, m));
    let least = f64::EPSILON * (a.norm() + b.norm()).max(f64::MIN_POSITIVE);
    let right = DVector::from_column_slice(c.as_slice());
    let solved = system.clone().full_piv_lu();
    let solution = match solved.solve(&right) {
        Some(x) if x.iter().all(|value| value.is_finite()) => x,
        _ => {
            let shifted = system + DMatrix::identity(m * n, m * n) * least;
            shifted.full_piv_lu().solve(&right).unwrap_or_else(|| DVector::zeros(m * n))
        }
    };
    DMatrix::from_column_slice(m, n, solution.as_slice())
}
