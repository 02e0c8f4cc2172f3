//! LAPACK's systems of linear equations ([Anderson et al.
//! 1999](gapilib_base::bibliography#anderson-1999)), on row-major arrays.
//!
//! The dense LU with partial pivoting and the triangular solutions are nalgebra's; pivots are given as
//! LAPACK's interchanges. Cholesky is written out: that of nalgebra does not say which leading minor
//! is not positive, LAPACK's `info`.
//!
//! Arguments are those of LAPACK; leading dimensions and workspaces are not looked at. Conditions
//! are exact, not estimates. Routines and jobs that are not here are refused by name.

use super::Entry;
use super::call::Call;
use super::matrices::{column, is_transposed, matrix, norm, square, write};
use crate::diag::Fault;
use nalgebra::{DMatrix, DVector};

pub(crate) const ENTRIES: &[Entry] = &[
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

/// L below the diagonal and U, pivots, and the first zero pivot.
type Factors = (DMatrix<f64>, Vec<f64>, f64);

/// P A = L U by partial pivoting, L below the diagonal; pivots from 1, and the first zero pivot from
/// 1, 0 without.
fn factorize(a: DMatrix<f64>) -> Factors {
    let rows = a.nrows();
    let lu = a.lu();
    let mut order = DVector::from_iterator(rows, 0..rows);
    lu.p().permute_rows(&mut order);
    let (_, mut factors, upper) = lu.unpack();
    factors.resize_mut(rows, upper.ncols(), 0.0);
    for column in 0..upper.ncols() {
        let above = upper.nrows().min(column + 1);
        factors.view_mut((0, column), (above, 1)).copy_from(&upper.view((0, column), (above, 1)));
    }
    // The interchanges of LAPACK, one a step, that lead to this order.
    let mut places: Vec<usize> = (0..rows).collect();
    let mut pivots = Vec::new();
    for k in 0..upper.nrows() {
        let pivot = (k..rows).find(|at| places[*at] == order[k]).unwrap_or(k);
        places.swap(k, pivot);
        pivots.push((pivot + 1) as f64);
    }
    let zero = (0..upper.nrows().min(upper.ncols())).position(|k| upper[(k, k)] == 0.0);
    (factors, pivots, zero.map_or(0.0, |at| (at + 1) as f64))
}

/// Solves A X = B, or Aᵀ X = B, with the factors of a regular A.
fn solve(lu: &DMatrix<f64>, pivots: &[f64], b: &mut DMatrix<f64>, transposed: bool) {
    let n = lu.nrows();
    if n == 0 {
        return;
    }
    let swaps = pivots.iter().map(|p| (*p as usize).clamp(1, n) - 1).enumerate();
    if transposed {
        // Uᵀ, then Lᵀ, then the permutation backwards.
        lu.tr_solve_upper_triangular_unchecked_mut(b);
        let mut lower = lu.clone();
        lower.fill_diagonal(1.0);
        lower.tr_solve_lower_triangular_unchecked_mut(b);
        swaps.rev().for_each(|(k, pivot)| b.swap_rows(k, pivot));
    } else {
        swaps.for_each(|(k, pivot)| b.swap_rows(k, pivot));
        lu.solve_lower_triangular_with_diag_unchecked_mut(b, 1.0);
        lu.solve_upper_triangular_unchecked_mut(b);
    }
}

/// A⁻¹ = U⁻¹ L⁻¹ P in LAPACK's order, U first.
fn inverse(lu: &DMatrix<f64>, pivots: &[f64]) -> DMatrix<f64> {
    let mut transposed = DMatrix::identity(lu.nrows(), lu.nrows());
    solve(lu, pivots, &mut transposed, true);
    transposed.transpose()
}

fn same_rows(call: &Call<'_>, a: &DMatrix<f64>, b: &DMatrix<f64>) -> Result<(), Fault> {
    match a.nrows() == b.nrows() {
        true => Ok(()),
        false => Err(call.fault("the right-hand side has a different number of rows")),
    }
}

/// Solves A X = B and writes X in the place of the argument B, if A is regular; the factors.
fn replace_by_solution(
    call: &mut Call<'_>,
    a: DMatrix<f64>,
    argument: usize,
) -> Result<Factors, Fault> {
    let mut b = matrix(call, argument)?;
    same_rows(call, &a, &b)?;
    let (lu, pivots, info) = factorize(a);
    if info == 0.0 {
        solve(&lu, &pivots, &mut b, false);
        write(call, argument, &b);
    }
    Ok((lu, pivots, info))
}

/// `(n, nrhs, A, lda, ipiv, B, ldb, info)`
fn dgesv(call: &mut Call<'_>) -> Result<(), Fault> {
    let (lu, pivots, info) = replace_by_solution(call, square(call, 2)?, 5)?;
    write(call, 2, &lu);
    write(call, 4, &column(&pivots));
    call.set(7, info);
    Ok(())
}

/// `(m, n, A, lda, ipiv, info)`
fn dgetrf(call: &mut Call<'_>) -> Result<(), Fault> {
    let (lu, pivots, info) = factorize(matrix(call, 2)?);
    write(call, 2, &lu);
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
        write(call, 1, &inverse(&lu, &pivots));
    }
    call.set(6, zero.map_or(0.0, |at| (at + 1) as f64));
    Ok(())
}

/// `(n, nrhs, dl, d, du, B, ldb, info)`: a tridiagonal matrix.
fn dgtsv(call: &mut Call<'_>) -> Result<(), Fault> {
    let (lower, diagonal, upper) = (matrix(call, 2)?, matrix(call, 3)?, matrix(call, 4)?);
    let n = diagonal.nrows();
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
    let (_, _, info) = replace_by_solution(call, a, 5)?;
    call.set(7, info);
    Ok(())
}

/// `(uplo, n, A, lda, info)`: the factor is in one triangle, the other is unchanged.
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

/// `(n, kl, ku, nrhs, AB, ldab, ipiv, B, ldb, info)`: A(i, j) is in row kl + ku + i − j.
fn dgbsv(call: &mut Call<'_>) -> Result<(), Fault> {
    let band = matrix(call, 4)?;
    let diagonals = |argument| usize::try_from(call.whole(argument)).unwrap_or(0);
    let (n, lower, upper) = (band.ncols(), diagonals(1), diagonals(2));
    if band.nrows() < 2 * lower + upper + 1 {
        return Err(call.fault("the band has fewer rows than diagonals"));
    }
    let mut a = DMatrix::zeros(n, n);
    for j in 0..n {
        for i in j.saturating_sub(upper)..n.min(j + lower + 1) {
            a[(i, j)] = band[(lower + upper + i - j, j)];
        }
    }
    let (_, _, info) = replace_by_solution(call, a, 7)?;
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
    Ok(1.0 / (size * norm(call, letter, &inverse(lu, &pivots))?))
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
    let (lu, pivots, mut info) = factorize(a);
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
