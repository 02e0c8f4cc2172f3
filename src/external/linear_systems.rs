//! LAPACK's systems of linear equations ([Anderson et al.
//! 1999](crate::bibliography#anderson-1999)), on row-major arrays.
//!
//! Arguments are those of LAPACK; leading dimensions and workspaces are not looked at. Conditions
//! are exact, not estimates. Routines and jobs that are not here are refused by name.

use super::Entry;
use super::call::Call;
use super::matrices::{column, is_transposed, matrix, norm, square, write};
use crate::diag::Fault;
use nalgebra::DMatrix;

pub(super) const ENTRIES: &[Entry] = &[
    Entry::pure("dgesv", "nnAnAAnN", dgesv),
    Entry::pure("dgesvx", "ttnnAnAnAtAAAnAnNAAAAN", dgesvx),
    Entry::pure("dgetrf", "nnAnAN", dgetrf),
    Entry::pure("dgetrs", "tnnanaAnN", dgetrs),
    Entry::pure("dgetri", "nAnaAnN", dgetri),
    Entry::pure("dgtsv", "nnAAAAnN", dgtsv),
    Entry::pure("dpotrf", "tnAnN", dpotrf),
    Entry::pure("dgbsv", "nnnnAnAAnN", dgbsv),
    Entry::pure("dgecon", "tnannNAAN", dgecon),
    Entry::pure("dlange", "tnnanA->n", dlange),
    Entry::pure("dtrsm", "ttttnnnanAn", dtrsm),
];

/// P A = L U in place by partial pivoting; pivots from 1, and the first zero pivot from 1, 0
/// without.
fn factorize(a: &mut DMatrix<f64>) -> (Vec<f64>, f64) {
    let (rows, columns) = a.shape();
    let (mut pivots, mut singular) = (Vec::new(), 0.0);
    for k in 0..rows.min(columns) {
        let mut pivot = k;
        for row in k + 1..rows {
            if a[(row, k)].abs() > a[(pivot, k)].abs() {
                pivot = row;
            }
        }
        pivots.push((pivot + 1) as f64);
        a.swap_rows(k, pivot);
        if a[(k, k)] == 0.0 {
            singular = if singular == 0.0 { (k + 1) as f64 } else { singular };
            continue;
        }
        for row in k + 1..rows {
            let factor = a[(row, k)] / a[(k, k)];
            a[(row, k)] = factor;
            for column in k + 1..columns {
                a[(row, column)] -= factor * a[(k, column)];
            }
        }
    }
    (pivots, singular)
}

/// Solves A X = B, or Aᵀ X = B, with the factors of A.
fn solve(lu: &DMatrix<f64>, pivots: &[f64], b: &mut DMatrix<f64>, transposed: bool) {
    let n = lu.nrows();
    let swaps: Vec<usize> = pivots.iter().map(|p| (*p as usize).clamp(1, n) - 1).collect();
    if transposed {
        // Uᵀ, then Lᵀ, then the permutation backwards.
        for column in 0..b.ncols() {
            for i in 0..n {
                let sum: f64 = (0..i).map(|k| lu[(k, i)] * b[(k, column)]).sum();
                b[(i, column)] = (b[(i, column)] - sum) / lu[(i, i)];
            }
            for i in (0..n).rev() {
                let sum: f64 = (i + 1..n).map(|k| lu[(k, i)] * b[(k, column)]).sum();
                b[(i, column)] -= sum;
            }
        }
        swaps.iter().enumerate().rev().for_each(|(k, pivot)| b.swap_rows(k, *pivot));
        return;
    }
    swaps.iter().enumerate().for_each(|(k, pivot)| b.swap_rows(k, *pivot));
    for column in 0..b.ncols() {
        for i in 0..n {
            let sum: f64 = (0..i).map(|k| lu[(i, k)] * b[(k, column)]).sum();
            b[(i, column)] -= sum;
        }
        for i in (0..n).rev() {
            let sum: f64 = (i + 1..n).map(|k| lu[(i, k)] * b[(k, column)]).sum();
            b[(i, column)] = (b[(i, column)] - sum) / lu[(i, i)];
        }
    }
}

fn same_rows(call: &Call<'_>, a: &DMatrix<f64>, b: &DMatrix<f64>) -> Result<(), Fault> {
    match a.nrows() == b.nrows() {
        true => Ok(()),
        false => Err(call.fault("the right-hand side has a different number of rows")),
    }
}

/// `(n, nrhs, A, lda, ipiv, B, ldb, info)`
fn dgesv(call: &mut Call<'_>) -> Result<(), Fault> {
    let (mut a, mut b) = (square(call, 2)?, matrix(call, 5)?);
    same_rows(call, &a, &b)?;
    let (pivots, info) = factorize(&mut a);
    if info == 0.0 {
        solve(&a, &pivots, &mut b, false);
        write(call, 5, &b);
    }
    write(call, 2, &a);
    write(call, 4, &column(&pivots));
    call.set(7, info);
    Ok(())
}

/// `(m, n, A, lda, ipiv, info)`
fn dgetrf(call: &mut Call<'_>) -> Result<(), Fault> {
    let mut a = matrix(call, 2)?;
    let (pivots, info) = factorize(&mut a);
    write(call, 2, &a);
    write(call, 4, &column(&pivots));
    call.set(5, info);
    Ok(())
}

/// The pivots that an argument holds, one a row.
fn pivots(call: &Call<'_>, argument: usize, n: usize) -> Result<Vec<f64>, Fault> {
    let pivots = call.array(argument).to_vec();
    let fits = |pivot: &f64| (1.0..=n as f64).contains(pivot);
    match pivots.len() == n && pivots.iter().all(fits) {
        true => Ok(pivots),
        false => Err(call.fault("the pivots do not belong to a factorization")),
    }
}

/// Whether a diagonal has no zero, so that it can be divided by.
fn regular(call: &Call<'_>, lu: &DMatrix<f64>) -> Result<(), Fault> {
    match lu.diagonal().iter().all(|pivot| *pivot != 0.0) {
        true => Ok(()),
        false => Err(call.fault("the matrix is singular")),
    }
}

/// `(trans, n, nrhs, LU, lda, ipiv, B, ldb, info)`
fn dgetrs(call: &mut Call<'_>) -> Result<(), Fault> {
    let (lu, mut b) = (square(call, 3)?, matrix(call, 6)?);
    same_rows(call, &lu, &b)?;
    regular(call, &lu)?;
    let pivots = pivots(call, 5, lu.nrows())?;
    let transposed = is_transposed(call, 0);
    solve(&lu, &pivots, &mut b, transposed);
    write(call, 6, &b);
    call.set(8, 0.0);
    Ok(())
}

/// `(n, LU, lda, ipiv, work, lwork, info)`
fn dgetri(call: &mut Call<'_>) -> Result<(), Fault> {
    let lu = square(call, 1)?;
    let n = lu.nrows();
    let pivots = pivots(call, 3, n)?;
    let zero = lu.diagonal().iter().position(|pivot| *pivot == 0.0);
    if zero.is_none() {
        let mut inverse = DMatrix::identity(n, n);
        solve(&lu, &pivots, &mut inverse, false);
        write(call, 1, &inverse);
    }
    call.set(6, zero.map_or(0.0, |at| (at + 1) as f64));
    Ok(())
}

/// `(n, nrhs, dl, d, du, B, ldb, info)`: a tridiagonal matrix.
fn dgtsv(call: &mut Call<'_>) -> Result<(), Fault> {
    let (lower, diagonal, upper) = (matrix(call, 2)?, matrix(call, 3)?, matrix(call, 4)?);
    let (n, mut b) = (diagonal.nrows(), matrix(call, 5)?);
    same_rows(call, &diagonal, &b)?;
    if lower.nrows() + 1 != n || upper.nrows() + 1 != n {
        return Err(call.fault("the sizes of the diagonals do not match"));
    }
    let mut a = DMatrix::zeros(n, n);
    for i in 0..n {
        a[(i, i)] = diagonal[i];
        if i + 1 < n {
            a[(i + 1, i)] = lower[i];
            a[(i, i + 1)] = upper[i];
        }
    }
    let (pivots, info) = factorize(&mut a);
    if info == 0.0 {
        solve(&a, &pivots, &mut b, false);
        write(call, 5, &b);
    }
    call.set(7, info);
    Ok(())
}

/// `(uplo, n, A, lda, info)`: the factor stands in one triangle, the other is left as it is.
fn dpotrf(call: &mut Call<'_>) -> Result<(), Fault> {
    let mut a = square(call, 2)?;
    let is_upper = call.text(0).eq_ignore_ascii_case("U");
    let at = |i: usize, j: usize| if is_upper { (j, i) } else { (i, j) };
    let mut info = 0.0;
    'rows: for i in 0..a.nrows() {
        for j in 0..=i {
            let sum: f64 = (0..j).map(|k| a[at(i, k)] * a[at(j, k)]).sum();
            let rest = a[at(i, j)] - sum;
            if i != j {
                a[at(i, j)] = rest / a[at(j, j)];
            } else if rest > 0.0 {
                a[at(i, i)] = rest.sqrt();
            } else {
                info = (i + 1) as f64;
                break 'rows;
            }
        }
    }
    write(call, 2, &a);
    call.set(4, info);
    Ok(())
}

/// `(n, kl, ku, nrhs, AB, ldab, ipiv, B, ldb, info)`: A(i, j) stands in row kl + ku + i − j.
fn dgbsv(call: &mut Call<'_>) -> Result<(), Fault> {
    let (band, mut b) = (matrix(call, 4)?, matrix(call, 7)?);
    let (n, lower, upper) = (band.ncols(), call.number(1) as usize, call.number(2) as usize);
    if b.nrows() != n || band.nrows() < 2 * lower + upper + 1 {
        return Err(call.fault("the sizes of the band matrix and the right-hand side do not match"));
    }
    let mut a = DMatrix::zeros(n, n);
    for j in 0..n {
        for i in j.saturating_sub(upper)..n.min(j + lower + 1) {
            a[(i, j)] = band[(lower + upper + i - j, j)];
        }
    }
    let (pivots, info) = factorize(&mut a);
    if info == 0.0 {
        solve(&a, &pivots, &mut b, false);
        write(call, 7, &b);
    }
    call.set(9, info);
    Ok(())
}

/// `(norm, m, n, A, lda, work)`
fn dlange(call: &mut Call<'_>) -> Result<(), Fault> {
    let norm = norm(call, call.text(0), &matrix(call, 3)?)?;
    call.give(norm)
}

/// `(norm, n, LU, lda, anorm, rcond, work, iwork, info)`
fn dgecon(call: &mut Call<'_>) -> Result<(), Fault> {
    let lu = square(call, 2)?;
    let rcond = reciprocal_condition(call, &lu, call.text(0), call.number(4))?;
    call.set(5, rcond);
    call.set(8, 0.0);
    Ok(())
}

/// 1/(|A| |A⁻¹|) in a norm, from the factors of A and its norm. The interchange of rows changes
/// neither norm of the inverse.
fn reciprocal_condition(
    call: &Call<'_>,
    lu: &DMatrix<f64>,
    letter: &str,
    size: f64,
) -> Result<f64, Fault> {
    let n = lu.nrows();
    if size == 0.0 || (0..n).any(|k| lu[(k, k)] == 0.0) {
        return Ok(0.0);
    }
    let pivots: Vec<f64> = (1..=n).map(|k| k as f64).collect();
    let mut inverse = DMatrix::identity(n, n);
    solve(lu, &pivots, &mut inverse, false);
    Ok(1.0 / (size * norm(call, letter, &inverse)?))
}

/// `(fact, trans, n, nrhs, A, lda, AF, ldaf, ipiv, equed, R, C, B, ldb, X, ldx, rcond, ferr, berr,
/// work, iwork, info)`; without equilibration and bounds of errors.
fn dgesvx(call: &mut Call<'_>) -> Result<(), Fault> {
    if !call.text(0).eq_ignore_ascii_case("N") {
        return Err(call.fault("equilibration and prior factorizations are not supported"));
    }
    let (a, mut b) = (square(call, 4)?, matrix(call, 12)?);
    same_rows(call, &a, &b)?;
    let transposed = is_transposed(call, 1);
    let letter = if transposed { "I" } else { "1" };
    let size = norm(call, letter, &a)?;
    let mut lu = a;
    let (pivots, mut info) = factorize(&mut lu);
    let rcond = reciprocal_condition(call, &lu, letter, size)?;
    if info == 0.0 {
        solve(&lu, &pivots, &mut b, transposed);
        write(call, 14, &b);
        if rcond < f64::EPSILON / 2.0 {
            info = lu.nrows() as f64 + 1.0;
        }
    }
    write(call, 6, &lu);
    write(call, 8, &column(&pivots));
    call.set(16, rcond);
    call.set(21, info);
    Ok(())
}

/// `(side, uplo, transa, diag, m, n, alpha, A, lda, B, ldb)`
fn dtrsm(call: &mut Call<'_>) -> Result<(), Fault> {
    let (a, b) = (square(call, 7)?, matrix(call, 9)? * call.number(6));
    let is = |argument: usize, letter: &str| call.text(argument).eq_ignore_ascii_case(letter);
    let mut a = if is(1, "U") { a.upper_triangle() } else { a.lower_triangle() };
    if is(3, "U") {
        a.fill_diagonal(1.0);
    }
    let is_right = is(0, "R");
    // X op(A) = B is op(A)ᵀ Xᵀ = Bᵀ.
    let a = if is_transposed(call, 2) != is_right { a.transpose() } else { a };
    let b = if is_right { b.transpose() } else { b };
    same_rows(call, &a, &b)?;
    regular(call, &a)?;
    let is_upper = is(1, "U") == (is_transposed(call, 2) == is_right);
    let x = if is_upper { a.solve_upper_triangular(&b) } else { a.solve_lower_triangular(&b) };
    let x = x.ok_or_else(|| call.fault("the matrix is singular"))?;
    write(call, 9, &if is_right { x.transpose() } else { x });
    Ok(())
}
