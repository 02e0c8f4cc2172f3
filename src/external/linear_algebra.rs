//! The LAPACK routines that `Modelica.Math.Matrices` calls ([Anderson et al.
//! 1999](crate::bibliography#anderson-1999)), on row-major arrays.
//!
//! Arguments are those of LAPACK; leading dimensions and workspaces are not looked at. Signs of
//! singular vectors are not specified, and the rank of `dgelsy` counts the singular values above
//! `rcond` times the largest. Routines and jobs that are not here are refused by name.

use super::Entry;
use super::call::Call;
use super::eigenvectors::eigenvectors;
use crate::diag::Fault;
use nalgebra::{Complex, DMatrix};

pub(super) const ENTRIES: &[Entry] = &[
    Entry::pure("dgesv", "nnAnAAnN", dgesv),
    Entry::pure("dgetrf", "nnAnAN", dgetrf),
    Entry::pure("dgetrs", "tnnanaAnN", dgetrs),
    Entry::pure("dgetri", "nAnaAnN", dgetri),
    Entry::pure("dgtsv", "nnAAAAnN", dgtsv),
    Entry::pure("dpotrf", "tnAnN", dpotrf),
    Entry::pure("dgels", "tnnnAnAnAnN", dgels),
    Entry::pure("dgelsy", "nnnAnAnAnNAnN", dgelsy),
    Entry::pure("dgesvd", "ttnnAnAAnAnAnN", dgesvd),
    Entry::pure("dgeev", "ttnAnAAAnAnAnN", dgeev),
    Entry::pure("dgbsv", "nnnnAnAAnN", dgbsv),
    Entry::pure("dgecon", "tnannNAAN", dgecon),
    Entry::pure("dlange", "tnnanA->n", dlange),
];

/// A vector or matrix argument; a vector is a column.
pub(super) fn matrix(call: &Call<'_>, argument: usize) -> Result<DMatrix<f64>, Fault> {
    let (rows, columns) = match *call.dims(argument) {
        [rows] => (rows as usize, 1),
        [rows, columns] => (rows as usize, columns as usize),
        _ => return Err(call.fault("an argument is neither vector nor matrix")),
    };
    let values = call.array(argument);
    match values.iter().all(|value| value.is_finite()) {
        true => Ok(DMatrix::from_row_slice(rows, columns, values)),
        false => Err(call.fault("a matrix holds a number that is not finite")),
    }
}

/// Writes the upper left part that fits.
pub(super) fn write(call: &mut Call<'_>, argument: usize, matrix: &DMatrix<f64>) {
    let columns = call.dims(argument).get(1).map_or(1, |columns| *columns as usize);
    for (at, element) in call.array_mut(argument).iter_mut().enumerate() {
        let (row, column) = (at / columns, at % columns);
        if row < matrix.nrows() && column < matrix.ncols() {
            *element = matrix[(row, column)];
        }
    }
}

fn square(call: &Call<'_>, argument: usize) -> Result<DMatrix<f64>, Fault> {
    let matrix = matrix(call, argument)?;
    match matrix.is_square() {
        true => Ok(matrix),
        false => Err(call.fault("a matrix is not square")),
    }
}

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
        false => Err(call.fault("the right side has another number of rows")),
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
    write(call, 4, &DMatrix::from_vec(pivots.len(), 1, pivots));
    call.set(7, info);
    Ok(())
}

/// `(m, n, A, lda, ipiv, info)`
fn dgetrf(call: &mut Call<'_>) -> Result<(), Fault> {
    let mut a = matrix(call, 2)?;
    let (pivots, info) = factorize(&mut a);
    write(call, 2, &a);
    write(call, 4, &DMatrix::from_vec(pivots.len(), 1, pivots));
    call.set(5, info);
    Ok(())
}

/// The pivots that an argument holds, one a row.
fn pivots(call: &Call<'_>, argument: usize, n: usize) -> Result<Vec<f64>, Fault> {
    let pivots = call.array(argument).to_vec();
    let fits = |pivot: &f64| (1.0..=n as f64).contains(pivot);
    match pivots.len() == n && pivots.iter().all(fits) {
        true => Ok(pivots),
        false => Err(call.fault("the pivots are not those of a factorization")),
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
    let transposed = !call.text(0).eq_ignore_ascii_case("N");
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
        return Err(call.fault("the diagonals do not fit each other"));
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

/// The solution of smallest norm of a least squares problem, and the rank of the matrix.
fn least_squares(
    call: &Call<'_>,
    a: DMatrix<f64>,
    b: &DMatrix<f64>,
    relative: f64,
) -> Result<(DMatrix<f64>, f64), Fault> {
    let (rows, columns) = a.shape();
    if b.nrows() < rows {
        return Err(call.fault("the right side has another number of rows"));
    }
    let b = b.rows(0, rows).into_owned();
    if rows == 0 || columns == 0 {
        return Ok((DMatrix::zeros(columns, b.ncols()), 0.0));
    }
    let svd = a.svd(true, true);
    let largest = svd.singular_values.max();
    let least = largest * relative.max(f64::EPSILON * rows.max(columns) as f64);
    let rank = svd.singular_values.iter().filter(|value| **value > least).count();
    let x = svd.solve(&b, least).map_err(|reason| call.fault(reason))?;
    Ok((x, rank as f64))
}

/// `(trans, m, n, nrhs, A, lda, B, ldb, work, lwork, info)`
fn dgels(call: &mut Call<'_>) -> Result<(), Fault> {
    let a = matrix(call, 4)?;
    let a = if call.text(0).eq_ignore_ascii_case("N") { a } else { a.transpose() };
    let full = a.nrows().min(a.ncols()) as f64;
    let b = matrix(call, 6)?;
    let (x, rank) = least_squares(call, a, &b, 0.0)?;
    if rank == full {
        write(call, 6, &x);
    }
    call.set(10, if rank == full { 0.0 } else { rank + 1.0 });
    Ok(())
}

/// `(m, n, nrhs, A, lda, B, ldb, jpvt, rcond, rank, work, lwork, info)`
fn dgelsy(call: &mut Call<'_>) -> Result<(), Fault> {
    let (a, b) = (matrix(call, 3)?, matrix(call, 5)?);
    let (x, rank) = least_squares(call, a, &b, call.number(8))?;
    write(call, 5, &x);
    call.set(9, rank);
    call.set(12, 0.0);
    Ok(())
}

/// `(jobu, jobvt, m, n, A, lda, s, U, ldu, VT, ldvt, work, lwork, info)`; vectors of square
/// matrices, values of all.
fn dgesvd(call: &mut Call<'_>) -> Result<(), Fault> {
    let a = matrix(call, 4)?;
    let vectors = !call.text(0).eq_ignore_ascii_case("N");
    if vectors && !a.is_square() {
        return Err(call.fault("singular vectors of a matrix that is not square"));
    }
    let svd = a.svd(vectors, vectors);
    let n = svd.singular_values.len();
    write(call, 6, &DMatrix::from_column_slice(n, 1, svd.singular_values.as_slice()));
    if let (Some(u), Some(v)) = (&svd.u, &svd.v_t) {
        write(call, 7, u);
        write(call, 9, v);
    }
    call.set(13, 0.0);
    Ok(())
}

/// `(jobvl, jobvr, n, A, lda, wr, wi, VL, ldvl, VR, ldvr, work, lwork, info)`; no left vectors.
fn dgeev(call: &mut Call<'_>) -> Result<(), Fault> {
    let wants = |argument: usize| !call.text(argument).eq_ignore_ascii_case("N");
    if wants(0) {
        return Err(call.fault("left eigenvectors of unsymmetric matrices are not supported"));
    }
    let (a, wants_vectors) = (square(call, 3)?, wants(1));
    let mut values = a.complex_eigenvalues().as_slice().to_vec();
    pair(&mut values);
    if wants_vectors {
        let vectors = eigenvectors(&a, &values);
        let vectors = vectors.ok_or_else(|| call.fault("the eigenvectors were not found"))?;
        write(call, 9, &vectors);
    }
    let column = |part: Vec<f64>| DMatrix::from_vec(part.len(), 1, part);
    write(call, 5, &column(values.iter().map(|value| value.re).collect()));
    write(call, 6, &column(values.iter().map(|value| value.im).collect()));
    call.set(13, 0.0);
    Ok(())
}

/// Conjugate pairs with the positive imaginary part first.
fn pair(values: &mut [Complex<f64>]) {
    let mut at = 0;
    while at + 1 < values.len() {
        if values[at].im == 0.0 {
            at += 1;
            continue;
        }
        if values[at].im < 0.0 {
            values.swap(at, at + 1);
        }
        at += 2;
    }
}

/// `(n, kl, ku, nrhs, AB, ldab, ipiv, B, ldb, info)`: A(i, j) stands in row kl + ku + i − j.
fn dgbsv(call: &mut Call<'_>) -> Result<(), Fault> {
    let (band, mut b) = (matrix(call, 4)?, matrix(call, 7)?);
    let (n, lower, upper) = (band.ncols(), call.number(1) as usize, call.number(2) as usize);
    if b.nrows() != n || band.nrows() < 2 * lower + upper + 1 {
        return Err(call.fault("the band and the right side do not fit"));
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

/// The norm that a letter names: greatest element, columns, rows, Frobenius.
fn norm(call: &Call<'_>, letter: &str, a: &DMatrix<f64>) -> Result<f64, Fault> {
    let greatest = |values: &mut dyn Iterator<Item = f64>| values.fold(0.0, f64::max);
    let size = |values: &[f64]| values.iter().map(|value| value.abs()).sum::<f64>();
    Ok(match letter.to_ascii_uppercase().as_str() {
        "M" => greatest(&mut a.iter().map(|value| value.abs())),
        "1" | "O" => greatest(&mut a.column_iter().map(|c| size(c.clone_owned().as_slice()))),
        "I" => greatest(&mut a.row_iter().map(|r| size(r.clone_owned().as_slice()))),
        "F" | "E" => a.norm(),
        _ => return Err(call.fault(format!("there is no norm `{letter}`"))),
    })
}

/// `(norm, m, n, A, lda, work)`
fn dlange(call: &mut Call<'_>) -> Result<(), Fault> {
    let norm = norm(call, call.text(0), &matrix(call, 3)?)?;
    call.give(norm)
}

/// `(norm, n, LU, lda, anorm, rcond, work, iwork, info)`; from the inverse, not an estimate. The
/// interchange of rows changes neither norm of the inverse.
fn dgecon(call: &mut Call<'_>) -> Result<(), Fault> {
    let lu = square(call, 2)?;
    let n = lu.nrows();
    let pivots: Vec<f64> = (1..=n).map(|k| k as f64).collect();
    let is_singular = (0..n).any(|k| lu[(k, k)] == 0.0);
    let rcond = match is_singular || call.number(4) == 0.0 {
        true => 0.0,
        false => {
            let mut inverse = DMatrix::identity(n, n);
            solve(&lu, &pivots, &mut inverse, false);
            1.0 / (call.number(4) * norm(call, call.text(0), &inverse)?)
        }
    };
    call.set(5, rcond);
    call.set(8, 0.0);
    Ok(())
}
