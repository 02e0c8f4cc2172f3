//! LAPACK's generalized eigenvalues, A x = λ B x ([Anderson et al.
//! 1999](gapilib_base::bibliography#anderson-1999)): `dggev`, `dggevx`, `dhgeqz`.
//!
//! They are those of B⁻¹ A, or of (A − μB)⁻¹ B = ν, λ = μ + 1/ν, whichever is the most regular to
//! invert ([Golub & Van Loan 2013](gapilib_base::bibliography#golub-van-loan-2013), §7.7): finite ones are
//! ratios of α and β, infinite ones have β = 0.

use super::Entry;
use super::balancing::Balanced;
use super::call::Call;
use super::eigenvectors::{Scale, left_eigenvectors, right_eigenvectors, scale};
use super::matrices::{column, is_requested, norm, square, write};
use super::schur::{RealSchur, modulus};
use crate::diag::Fault;
use nalgebra::{Complex, DMatrix};

pub(crate) const ENTRIES: &[Entry] = &[
    Entry::pure("dggev", "ttnAnAnAAAAnAnAnN", dggev),
    Entry::pure("dggevx", "ttttnAnAnAAAAnAnNNAANNAAAnAAN", dggevx),
    Entry::pure("dhgeqz", "tttnnnAnAnAAAAnAnAnN", dhgeqz),
];

/// The factors of |A|/|B| that are tried for μ.
const SHIFTS: [f64; 7] = [0.0, 0.37, -0.37, 1.3, -1.3, 0.11, -4.1];

/// Eigenvalues α/β with their vectors as columns.
struct Generalized {
    alpha: Vec<Complex<f64>>,
    beta: Vec<f64>,
    left: DMatrix<f64>,
    right: DMatrix<f64>,
}

impl Generalized {
    fn of(call: &Call<'_>, a: &DMatrix<f64>, b: &DMatrix<f64>) -> Result<Generalized, Fault> {
        if a.shape() != b.shape() {
            return Err(call.fault("the matrices have different sizes"));
        }
        let (size_a, size_b) = (a.norm(), b.norm());
        let ratio = if size_b > 0.0 && size_a > 0.0 { size_a / size_b } else { 1.0 };
        let (shift, inverse) = most_regular(a, b, ratio).ok_or_else(|| {
            call.fault("the matrix pencil is singular: every number is an eigenvalue")
        })?;
        let balanced = Balanced::of(&inverse * if shift.is_some() { b } else { a });
        let form = RealSchur::of(&balanced.matrix)
            .ok_or_else(|| call.fault("the Schur decomposition did not converge"))?;
        let least = f64::EPSILON * a.nrows() as f64 * form.t.norm();
        let mut left = &form.q * left_eigenvectors(&form.t);
        let mut right = &form.q * right_eigenvectors(&form.t);
        balanced.left(&mut left);
        balanced.right(&mut right);
        let left = inverse.transpose() * left;
        let mut all = Generalized { alpha: Vec::new(), beta: Vec::new(), left, right };
        for nu in form.eigenvalues() {
            let Some(shift) = shift else {
                all.alpha.push(nu);
                all.beta.push(1.0);
                continue;
            };
            let nu = if modulus(nu) <= least { Complex::new(0.0, 0.0) } else { nu };
            // The factor makes β real and positive.
            let factor = match modulus(nu) {
                0.0 => Complex::new(1.0, 0.0),
                size => nu.conj() / size,
            };
            all.alpha.push(((nu * shift + 1.0) * factor).conj());
            all.beta.push(modulus(nu));
        }
        // 1/ν has the imaginary part of the other sign: its vector is the conjugate one.
        let conjugate = |at: &usize| shift.is_some() && all.alpha[*at].im < 0.0;
        for at in (0..all.alpha.len()).filter(conjugate).collect::<Vec<_>>() {
            all.left.column_mut(at).neg_mut();
            all.right.column_mut(at).neg_mut();
        }
        let is_complex = |at: usize| all.alpha[at].im != 0.0;
        scale(&mut all.left, is_complex, Scale::Largest);
        scale(&mut all.right, is_complex, Scale::Largest);
        Ok(all)
    }

    /// Writes α in two parts and β from an argument on.
    fn write_values(&self, call: &mut Call<'_>, argument: usize) {
        let part = |of: fn(&Complex<f64>) -> f64| self.alpha.iter().map(of).collect::<Vec<_>>();
        write(call, argument, &column(&part(|alpha| alpha.re)));
        write(call, argument + 1, &column(&part(|alpha| alpha.im)));
        write(call, argument + 2, &column(&self.beta));
    }

    /// Writes left vectors to an argument and right ones to that after its leading dimension, where
    /// the jobs, the first of which is named, request them.
    fn write_vectors(&self, call: &mut Call<'_>, job: usize, argument: usize) {
        for (at, vectors) in [&self.left, &self.right].into_iter().enumerate() {
            if is_requested(call, job + at) {
                write(call, argument + 2 * at, vectors);
            }
        }
    }
}

/// B⁻¹ without a shift, or μ and (A − μB)⁻¹: the one of the best condition.
fn most_regular(
    a: &DMatrix<f64>,
    b: &DMatrix<f64>,
    ratio: f64,
) -> Option<(Option<f64>, DMatrix<f64>)> {
    let mut best: Option<(f64, Option<f64>, DMatrix<f64>)> = None;
    let shifts = SHIFTS.map(|factor| Some(factor * ratio));
    for shift in [None].into_iter().chain(shifts) {
        let matrix = shift.map_or_else(|| b.clone(), |shift| a - b * shift);
        let Some(inverse) = matrix.clone().try_inverse() else { continue };
        let condition = matrix.norm() * inverse.norm();
        let limit = best.as_ref().map_or(0.1 / f64::EPSILON, |(condition, ..)| *condition);
        if condition < limit {
            best = Some((condition, shift, inverse));
        }
    }
    best.map(|(_, shift, inverse)| (shift, inverse))
}

/// The leading part of a square matrix that a number of rows names.
fn leading(call: &Call<'_>, argument: usize, rows: usize) -> Result<DMatrix<f64>, Fault> {
    let matrix = square(call, argument)?;
    match call.whole(rows) {
        n @ 0.. if n as usize <= matrix.nrows() => {
            Ok(matrix.view((0, 0), (n as usize, n as usize)).into_owned())
        }
        n => Err(call.fault(format!("there are no {n} rows"))),
    }
}

/// `(jobvl, jobvr, n, A, lda, B, ldb, alphar, alphai, beta, VL, ldvl, VR, ldvr, work, lwork, info)`
fn dggev(call: &mut Call<'_>) -> Result<(), Fault> {
    let (a, b) = (leading(call, 3, 2)?, leading(call, 5, 2)?);
    let all = Generalized::of(call, &a, &b)?;
    all.write_values(call, 7);
    all.write_vectors(call, 0, 10);
    call.set(16, 0.0);
    Ok(())
}

/// `(balanc, jobvl, jobvr, sense, n, A, lda, B, ldb, alphar, alphai, beta, VL, ldvl, VR, ldvr, ilo,
/// ihi, lscale, rscale, abnrm, bbnrm, rconde, rcondv, work, lwork, iwork, bwork, info)`; not
/// balanced, without condition numbers.
fn dggevx(call: &mut Call<'_>) -> Result<(), Fault> {
    let (a, b) = (leading(call, 5, 4)?, leading(call, 7, 4)?);
    let n = a.nrows();
    let all = Generalized::of(call, &a, &b)?;
    all.write_values(call, 9);
    all.write_vectors(call, 1, 12);
    call.set(16, 1.0);
    call.set(17, n as f64);
    write(call, 18, &DMatrix::repeat(n, 1, 1.0));
    write(call, 19, &DMatrix::repeat(n, 1, 1.0));
    let sizes = (norm(call, "1", &a)?, norm(call, "1", &b)?);
    call.set(20, sizes.0);
    call.set(21, sizes.1);
    call.set(28, 0.0);
    Ok(())
}

/// `(job, compq, compz, n, ilo, ihi, H, ldh, T, ldt, alphar, alphai, beta, Q, ldq, Z, ldz, work,
/// lwork, info)`; eigenvalues only.
fn dhgeqz(call: &mut Call<'_>) -> Result<(), Fault> {
    if !call.text(0).eq_ignore_ascii_case("E") {
        return Err(call.fault("the generalized Schur form is not supported"));
    }
    let (mut h, t) = (leading(call, 6, 3)?, leading(call, 8, 3)?.upper_triangle());
    if call.number(4) != 1.0 || call.number(5) != h.nrows() as f64 {
        return Err(call.fault("a part of a matrix"));
    }
    for row in 2..h.nrows() {
        h.view_mut((row, 0), (1, row - 1)).fill(0.0);
    }
    Generalized::of(call, &h, &t)?.write_values(call, 10);
    call.set(19, 0.0);
    Ok(())
}
