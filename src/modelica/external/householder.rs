//! LAPACK's orthogonal factorizations: `dgeqp3`, `dgeqrf`, `dorgqr`, `dormqr`, `dgehrd`, `dorghr`,
//! `dormhr` ([Anderson et al. 1999](gapilib_base::bibliography#anderson-1999)).
//!
//! A reflection is I − τ v vᵀ with v = (1, …); below the result stand the other elements of v.
//! nalgebra's factorizations are not used: they scale v to norm 1 and reflect columns that are zero
//! already, so neither τ nor the signs of R are LAPACK's, they pivot for the largest element instead
//! of the longest column, and their norms overflow from 1e154 on.

use super::Entry;
use super::call::Call;
use super::matrices::{column, is_transposed, matrix, power_of_two, square, write};
use crate::diag::Fault;
use crate::elementary;
use nalgebra::DMatrix;
use std::ops::Range;

pub(crate) const ENTRIES: &[Entry] = &[
    Entry::pure("dgeqp3", "nnAnAAAnN", dgeqp3),
    Entry::pure("dgeqrf", "nnAnAAnN", dgeqrf),
    Entry::pure("dorgqr", "nnnAnaAnN", dorgqr),
    Entry::pure("dormqr", "ttnnnanaAnAnN", dormqr),
    Entry::pure("dgehrd", "nnnAnAAnN", dgehrd),
    Entry::pure("dorghr", "nnnAnaAnN", dorghr),
    Entry::pure("dormhr", "ttnnnnanaAnAnN", dormhr),
];

/// The Euclidean norm of a part of a column; squares neither overflow nor underflow.
fn length(a: &DMatrix<f64>, rows: Range<usize>, column: usize) -> f64 {
    let part = a.view((rows.start, column), (rows.len(), 1));
    let size = part.amax();
    if size == 0.0 {
        return 0.0;
    }
    let size = power_of_two(size);
    let squares = part.iter().map(|x| elementary::powi(x / size, 2)).sum::<f64>();
    size * squares.sqrt()
}

/// Makes the elements of a column below `row` zero by a reflection, of which v stays there; its τ.
fn reflect(a: &mut DMatrix<f64>, row: usize, column: usize) -> f64 {
    let first = a[(row, column)];
    if a.view((row + 1, column), (a.nrows() - row - 1, 1)).iter().all(|x| *x == 0.0) {
        return 0.0;
    }
    let beta = -first.signum() * length(a, row..a.nrows(), column);
    for i in row + 1..a.nrows() {
        a[(i, column)] /= first - beta;
    }
    a[(row, column)] = beta;
    (beta - first) / beta
}

/// The vector v of a reflection, from `row` on.
fn vector(a: &DMatrix<f64>, row: usize, column: usize) -> Vec<f64> {
    std::iter::once(1.0).chain((row + 1..a.nrows()).map(|i| a[(i, column)])).collect()
}

/// (I − τ v vᵀ) B for the rows of `b` from `row` and the columns from `column` on.
fn apply_left(b: &mut DMatrix<f64>, v: &[f64], tau: f64, row: usize, column: usize) {
    for j in column..b.ncols() {
        let sum: f64 = v.iter().enumerate().map(|(i, v)| v * b[(row + i, j)]).sum();
        for (i, v) in v.iter().enumerate() {
            b[(row + i, j)] -= tau * sum * v;
        }
    }
}

/// B (I − τ v vᵀ) for the columns of `b` from `column` on.
fn apply_right(b: &mut DMatrix<f64>, v: &[f64], tau: f64, column: usize) {
    for i in 0..b.nrows() {
        let sum: f64 = v.iter().enumerate().map(|(j, v)| v * b[(i, column + j)]).sum();
        for (j, v) in v.iter().enumerate() {
            b[(i, column + j)] -= tau * sum * v;
        }
    }
}

/// Q R = A P; with `pivots`, the column of greatest norm comes first.
fn qr(a: &mut DMatrix<f64>, mut pivots: Option<&mut [usize]>) -> Vec<f64> {
    let mut taus = Vec::new();
    for k in 0..a.nrows().min(a.ncols()) {
        if let Some(pivots) = pivots.as_deref_mut() {
            let rest = |j: usize| length(a, k..a.nrows(), j);
            let mut greatest = k;
            for j in k + 1..a.ncols() {
                // Norms that differ by rounding are equal: the first comes first.
                if rest(j) > rest(greatest) * (1.0 + 1e-12) {
                    greatest = j;
                }
            }
            a.swap_columns(k, greatest);
            pivots.swap(k, greatest);
        }
        let tau = reflect(a, k, k);
        let v = vector(a, k, k);
        apply_left(a, &v, tau, k, k + 1);
        taus.push(tau);
    }
    taus
}

/// All of Q and R.
pub(crate) fn full_qr(mut a: DMatrix<f64>) -> (DMatrix<f64>, DMatrix<f64>) {
    let taus = qr(&mut a, None);
    (product(&a, &taus, 0, a.nrows()), a.upper_triangle())
}

/// `(m, n, A, lda, jpvt, tau, work, lwork, info)`; all columns are free.
fn dgeqp3(call: &mut Call<'_>) -> Result<(), Fault> {
    let mut a = matrix(call, 2)?;
    let mut pivots: Vec<usize> = (0..a.ncols()).collect();
    let taus = qr(&mut a, Some(&mut pivots));
    write(call, 2, &a);
    let pivots: Vec<f64> = pivots.iter().map(|pivot| (pivot + 1) as f64).collect();
    write(call, 4, &column(&pivots));
    write(call, 5, &column(&taus));
    call.set(8, 0.0);
    Ok(())
}

/// `(m, n, A, lda, tau, work, lwork, info)`
fn dgeqrf(call: &mut Call<'_>) -> Result<(), Fault> {
    let mut a = matrix(call, 2)?;
    let taus = qr(&mut a, None);
    write(call, 2, &a);
    write(call, 4, &column(&taus));
    call.set(7, 0.0);
    Ok(())
}

/// The product of the reflections whose vectors are the columns of `a`, that of column `k`
/// from row `k + shift` on; the first `columns` columns of it.
fn product(a: &DMatrix<f64>, taus: &[f64], shift: usize, columns: usize) -> DMatrix<f64> {
    let mut q = DMatrix::identity(a.nrows(), columns);
    for k in (0..taus.len().min(a.ncols())).rev() {
        if k + shift < a.nrows() {
            apply_left(&mut q, &vector(a, k + shift, k), taus[k], k + shift, 0);
        }
    }
    q
}

/// `(m, n, k, A, lda, tau, work, lwork, info)`
fn dorgqr(call: &mut Call<'_>) -> Result<(), Fault> {
    let a = matrix(call, 3)?;
    let n = call.array(5).len().min(usize::try_from(call.whole(2)).unwrap_or(0));
    let q = product(&a, &call.array(5)[..n], 0, a.ncols());
    write(call, 3, &q);
    call.set(8, 0.0);
    Ok(())
}

/// `(n, ilo, ihi, A, lda, tau, work, lwork, info)`: H = Qᵀ A Q.
fn dgehrd(call: &mut Call<'_>) -> Result<(), Fault> {
    let mut a = matrix(call, 3)?;
    whole_range(call, &a)?;
    let mut taus = Vec::new();
    for k in 0..a.nrows().saturating_sub(1) {
        let tau = reflect(&mut a, k + 1, k);
        let v = vector(&a, k + 1, k);
        apply_left(&mut a, &v, tau, k + 1, k + 1);
        // The columns after `k` do not hold vectors yet.
        apply_right(&mut a, &v, tau, k + 1);
        taus.push(tau);
    }
    write(call, 3, &a);
    write(call, 5, &column(&taus));
    call.set(8, 0.0);
    Ok(())
}

/// `(n, ilo, ihi, A, lda, tau, work, lwork, info)`
fn dorghr(call: &mut Call<'_>) -> Result<(), Fault> {
    let a = matrix(call, 3)?;
    whole_range(call, &a)?;
    let q = product(&a, call.array(5), 1, a.ncols());
    write(call, 3, &q);
    call.set(8, 0.0);
    Ok(())
}

/// `(side, trans, m, n, k, A, lda, tau, C, ldc, work, lwork, info)`
fn dormqr(call: &mut Call<'_>) -> Result<(), Fault> {
    let a = matrix(call, 5)?;
    let q = product(&a, call.array(7), 0, a.nrows());
    multiply(call, q, 8)?;
    call.set(12, 0.0);
    Ok(())
}

/// `(side, trans, m, n, ilo, ihi, A, lda, tau, C, ldc, work, lwork, info)`
fn dormhr(call: &mut Call<'_>) -> Result<(), Fault> {
    let a = square(call, 6)?;
    if call.number(4) != 1.0 || call.number(5) != a.nrows() as f64 {
        return Err(call.fault("a part of a matrix"));
    }
    let q = product(&a, call.array(8), 1, a.ncols());
    multiply(call, q, 9)?;
    call.set(13, 0.0);
    Ok(())
}

/// Replaces the argument C by op(Q) C or C op(Q), as the first two arguments say.
fn multiply(call: &mut Call<'_>, q: DMatrix<f64>, argument: usize) -> Result<(), Fault> {
    let c = matrix(call, argument)?;
    let is_left = call.text(0).eq_ignore_ascii_case("L");
    if q.nrows() != if is_left { c.nrows() } else { c.ncols() } {
        return Err(call.fault("the matrix sizes do not match"));
    }
    let q = if is_transposed(call, 1) { q.transpose() } else { q };
    write(call, argument, &if is_left { q * c } else { c * q });
    Ok(())
}

/// Only matrices as a whole are reduced.
fn whole_range(call: &Call<'_>, a: &DMatrix<f64>) -> Result<(), Fault> {
    match a.is_square() && call.number(1) == 1.0 && call.number(2) == a.nrows() as f64 {
        true => Ok(()),
        false => Err(call.fault("a part of a matrix, or one that is not square")),
    }
}
