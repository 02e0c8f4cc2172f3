//! LAPACK's least squares and singular values ([Anderson et al.
//! 1999](gapilib_base::bibliography#anderson-1999)): `dgels`, `dgelsy`, `dgglse`, `dgesvd`, `dgesdd`.
//!
//! `dgels` solves by orthogonal triangularisation. Singular values are found by one-sided Jacobi
//! rotations: nalgebra's are wrong for some matrices of deficient rank
//! ([`singular_values`](crate::singular_values)).
//!
//! Signs of singular vectors are not specified, and the rank of `dgelsy` counts the singular values
//! above `rcond` times the largest.

use super::Entry;
use super::call::Call;
use super::householder::full_qr;
use super::matrices::{column, is_requested, matrix, write};
use crate::diag::Fault;
use crate::singular_values::SingularValues;
use nalgebra::DMatrix;

pub(crate) const ENTRIES: &[Entry] = &[
    Entry::pure("dgels", "tnnnAnAnAnN", dgels),
    Entry::pure("dgelsy", "nnnAnAnAnNAnN", dgelsy),
    Entry::pure("dgglse", "nnnAnAnAAAAnN", dgglse),
    Entry::pure("dgesvd", "ttnnAnAAnAnAnN", dgesvd),
    Entry::pure("dgesdd", "tnnAnAAnAnAnNN", dgesdd),
];

/// The solution of smallest norm of a least squares problem, and the rank of the matrix.
fn least_squares(
    call: &Call<'_>,
    a: DMatrix<f64>,
    b: &DMatrix<f64>,
    relative: f64,
) -> Result<(DMatrix<f64>, f64), Fault> {
    let (rows, columns) = a.shape();
    if b.nrows() < rows {
        return Err(call.fault("the right-hand side has a different number of rows"));
    }
    let b = b.rows(0, rows).into_owned();
    if rows == 0 || columns == 0 {
        return Ok((DMatrix::zeros(columns, b.ncols()), 0.0));
    }
    let found = SingularValues::of(&a).ok_or_else(|| call.fault("a value is not finite"))?;
    let least = found.largest() * relative.max(f64::EPSILON * rows.max(columns) as f64);
    Ok((found.solve(&b, least), found.rank(least) as f64))
}

/// `(trans, m, n, nrhs, A, lda, B, ldb, work, lwork, info)`
fn dgels(call: &mut Call<'_>) -> Result<(), Fault> {
    let a = matrix(call, 4)?;
    let a = if call.text(0).eq_ignore_ascii_case("N") { a } else { a.transpose() };
    let b = matrix(call, 6)?;
    if b.nrows() < a.nrows() {
        return Err(call.fault("the right side has another number of rows"));
    }
    let b = b.rows(0, a.nrows()).into_owned();
    let info = match full_rank(&a, &b) {
        Ok(x) => {
            write(call, 6, &x);
            0.0
        }
        Err(dependent) => (dependent + 1) as f64,
    };
    call.set(10, info);
    Ok(())
}

/// The least squares solution of a matrix of full rank, by Q R = A; of smallest norm, by Q R = Aᵀ,
/// where there are fewer rows than columns. Else the first column, or row, that depends on those
/// before it. How columns are scaled plays no part.
fn full_rank(a: &DMatrix<f64>, b: &DMatrix<f64>) -> Result<DMatrix<f64>, usize> {
    let is_wide = a.nrows() < a.ncols();
    let (q, r) = full_qr(if is_wide { a.transpose() } else { a.clone() });
    let k = r.ncols();
    let (q, r) = (q.columns(0, k), r.rows(0, k));
    let negligible = f64::EPSILON * q.nrows() as f64;
    let depends = |at: &usize| r[(*at, *at)].abs() <= negligible * r.column(*at).norm();
    if let Some(dependent) = (0..k).find(depends) {
        return Err(dependent);
    }
    Ok(if is_wide {
        let mut x = b.clone();
        r.tr_solve_upper_triangular_unchecked_mut(&mut x);
        q * x
    } else {
        let mut x = q.tr_mul(b);
        r.solve_upper_triangular_unchecked_mut(&mut x);
        x
    })
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

/// `(m, n, p, A, lda, B, ldb, c, d, x, work, lwork, info)`: least |A x − c| with B x = d, in the
/// null space of B ([Golub & Van Loan 2013](gapilib_base::bibliography#golub-van-loan-2013), §6.2.3).
fn dgglse(call: &mut Call<'_>) -> Result<(), Fault> {
    let (a, b) = (matrix(call, 3)?, matrix(call, 5)?);
    let (c, d) = (matrix(call, 7)?, matrix(call, 8)?);
    let (p, n) = b.shape();
    if a.ncols() != n || c.nrows() != a.nrows() || d.nrows() != p || p > n || n > p + a.nrows() {
        return Err(call.fault("the matrix sizes do not match"));
    }
    let (q, r) = full_qr(b.transpose());
    let r = r.rows(0, p).into_owned();
    let size = r.norm();
    if r.diagonal().iter().any(|pivot| pivot.abs() <= f64::EPSILON * size) {
        call.set(12, 1.0);
        return Ok(());
    }
    let first = r.transpose().solve_lower_triangular(&d);
    let first = first.ok_or_else(|| call.fault("the constraints are singular"))?;
    let particular = q.columns(0, p) * first;
    let null = q.columns(p, n - p).into_owned();
    let (rest, rank) = least_squares(call, &a * &null, &(c - &a * &particular), 0.0)?;
    write(call, 9, &(particular + null * rest));
    call.set(12, if rank == (n - p) as f64 { 0.0 } else { 2.0 });
    Ok(())
}

/// All of U, the singular values, all of Vᵀ.
type Factors = (DMatrix<f64>, DMatrix<f64>, DMatrix<f64>);

fn singular_values(call: &Call<'_>, a: DMatrix<f64>) -> Result<Factors, Fault> {
    let found = SingularValues::of(&a).ok_or_else(|| call.fault("a value is not finite"))?;
    Ok((
        completed(found.u),
        column(found.s.as_slice()),
        completed(found.v_t.transpose()).transpose(),
    ))
}

/// Orthonormal columns and as many more as there are rows.
fn completed(columns: DMatrix<f64>) -> DMatrix<f64> {
    let (m, k) = columns.shape();
    let (mut q, _) = full_qr(columns.clone());
    q.columns_mut(0, k.min(m)).copy_from(&columns);
    q
}

/// `(jobu, jobvt, m, n, A, lda, s, U, ldu, VT, ldvt, work, lwork, info)`
fn dgesvd(call: &mut Call<'_>) -> Result<(), Fault> {
    let a = matrix(call, 4)?;
    let jobs = [call.text(0), call.text(1)].map(str::to_ascii_uppercase);
    if jobs.iter().any(|job| job == "O") {
        return Err(call.fault("vectors instead of the matrix are not supported"));
    }
    let (u, values, v_t) = singular_values(call, a)?;
    write(call, 6, &values);
    if is_requested(call, 0) {
        write(call, 7, &u);
    }
    if is_requested(call, 1) {
        write(call, 9, &v_t);
    }
    call.set(13, 0.0);
    Ok(())
}

/// `(jobz, m, n, A, lda, s, U, ldu, VT, ldvt, work, lwork, iwork, info)`
fn dgesdd(call: &mut Call<'_>) -> Result<(), Fault> {
    if call.text(0).eq_ignore_ascii_case("O") {
        return Err(call.fault("vectors instead of the matrix are not supported"));
    }
    let (u, values, v_t) = singular_values(call, matrix(call, 3)?)?;
    write(call, 5, &values);
    if is_requested(call, 0) {
        write(call, 6, &u);
        write(call, 8, &v_t);
    }
    call.set(13, 0.0);
    Ok(())
}
