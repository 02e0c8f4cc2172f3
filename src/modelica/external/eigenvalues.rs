//! LAPACK's eigenvalues and Schur forms of real matrices ([Anderson et al.
//! 1999](gapilib_base::bibliography#anderson-1999)): `dgeev`, `dgeevx`, `dgees`, `dhseqr`, `dtrevc`,
//! `dtrsen`, `dtrsyl`.
//!
//! `dgeev` balances, `dgeevx` as it is asked to. nalgebra's Schur form is made standard; it has no
//! eigenvectors, no balancing of its own and no exceptional shifts. The order of eigenvalues is that of the Schur form found, which LAPACK
//! does not specify.

use super::Entry;
use super::balancing::Balanced;
use super::call::Call;
use super::eigenvectors::{Scale, left_eigenvectors, right_eigenvectors, scale};
use super::matrices::{column, is_requested, is_transposed, matrix, norm, square, write};
use super::schur::{RealSchur, modulus};
use super::sylvester::sylvester;
use crate::diag::Fault;
use crate::elementary;
use nalgebra::{Complex, DMatrix};

pub(crate) const ENTRIES: &[Entry] = &[
    Entry::pure("dgeev", "ttnAnAAAnAnAnN", dgeev),
    Entry::pure("dgeevx", "ttttnAnAAAnAnNNANAAAnAN", dgeevx),
    Entry::pure("dgees", "ttanAnNAAAnAnAN", dgees),
    Entry::pure("dhseqr", "ttnnnAnAAAnAnN", dhseqr),
    Entry::pure("dtrevc", "ttanAnAnAnnNAN", dtrevc),
    Entry::pure("dtrsen", "ttanAnAnAANNNAnAnN", dtrsen),
    Entry::pure("dtrsyl", "ttnnnananAnNN", dtrsyl),
];

fn schur(call: &Call<'_>, a: &DMatrix<f64>) -> Result<RealSchur, Fault> {
    RealSchur::of(a).ok_or_else(|| call.fault("the Schur decomposition did not converge"))
}

/// Writes real and imaginary parts.
fn write_values(call: &mut Call<'_>, argument: usize, values: &[Complex<f64>]) {
    let part = |of: fn(&Complex<f64>) -> f64| column(&values.iter().map(of).collect::<Vec<_>>());
    write(call, argument, &part(|value| value.re));
    write(call, argument + 1, &part(|value| value.im));
}

/// A matrix, balanced, with its Schur form and eigenvalues.
struct Decomposed {
    balanced: Balanced,
    form: RealSchur,
    values: Vec<Complex<f64>>,
}

impl Decomposed {
    fn of(call: &Call<'_>, balanced: Balanced) -> Result<Decomposed, Fault> {
        let form = schur(call, &balanced.matrix)?;
        let values = form.eigenvalues();
        Ok(Decomposed { balanced, form, values })
    }

    /// The left eigenvectors, of norm 1.
    fn left(&self) -> DMatrix<f64> {
        let mut vectors = &self.form.q * left_eigenvectors(&self.form.t);
        self.balanced.left(&mut vectors);
        scale(&mut vectors, |at| self.values[at].im != 0.0, Scale::Norm);
        vectors
    }

    /// The right eigenvectors, of norm 1.
    fn right(&self) -> DMatrix<f64> {
        let mut vectors = &self.form.q * right_eigenvectors(&self.form.t);
        self.balanced.right(&mut vectors);
        scale(&mut vectors, |at| self.values[at].im != 0.0, Scale::Norm);
        vectors
    }
}

/// `(jobvl, jobvr, n, A, lda, wr, wi, VL, ldvl, VR, ldvr, work, lwork, info)`
fn dgeev(call: &mut Call<'_>) -> Result<(), Fault> {
    let found = Decomposed::of(call, Balanced::of(square(call, 3)?))?;
    if is_requested(call, 0) {
        write(call, 7, &found.left());
    }
    if is_requested(call, 1) {
        write(call, 9, &found.right());
    }
    write_values(call, 5, &found.values);
    call.set(13, 0.0);
    Ok(())
}

/// `(balanc, jobvl, jobvr, sense, n, A, lda, wr, wi, VL, ldvl, VR, ldvr, ilo, ihi, scale, abnrm,
/// rconde, rcondv, work, lwork, iwork, info)`; without condition numbers of the vectors.
fn dgeevx(call: &mut Call<'_>) -> Result<(), Fault> {
    if matches!(call.text(3), "V" | "v" | "B" | "b") {
        return Err(call.fault("condition numbers of eigenvectors are not supported"));
    }
    let found = Decomposed::of(call, balanced(call, square(call, 5)?)?)?;
    let (left, right) = (found.left(), found.right());
    write(call, 5, &found.form.t);
    write_values(call, 7, &found.values);
    if is_requested(call, 1) {
        write(call, 9, &left);
    }
    if is_requested(call, 2) {
        write(call, 11, &right);
    }
    let Balanced { matrix, active, scale } = found.balanced;
    call.set(13, (active.start + 1) as f64);
    call.set(14, active.end as f64);
    // Rows are counted from 1 where they were interchanged.
    let from_one = |(k, x): (usize, &f64)| if active.contains(&k) { *x } else { x + 1.0 };
    write(call, 15, &column(&scale.iter().enumerate().map(from_one).collect::<Vec<_>>()));
    let size = norm(call, "1", &matrix)?;
    call.set(16, size);
    if is_requested(call, 3) {
        write(call, 17, &column(&conditions(&found.values, &left, &right)));
    }
    call.set(22, 0.0);
    Ok(())
}

/// Balanced as the first argument says.
fn balanced(call: &Call<'_>, a: DMatrix<f64>) -> Result<Balanced, Fault> {
    let mut balanced = Balanced::unchanged(a);
    match call.text(0).to_ascii_uppercase().as_str() {
        "N" => {}
        "P" => balanced.permute(),
        "S" => balanced.scale(),
        "B" => {
            balanced.permute();
            balanced.scale();
        }
        other => return Err(call.fault(format!("there is no balancing `{other}`"))),
    }
    Ok(balanced)
}

/// |yᴴ x| for left and right eigenvectors of norm 1.
fn conditions(values: &[Complex<f64>], left: &DMatrix<f64>, right: &DMatrix<f64>) -> Vec<f64> {
    let condition = |at: usize| {
        let first = if values[at].im < 0.0 { at - 1 } else { at };
        if values[at].im == 0.0 {
            return left.column(at).dot(&right.column(at)).abs();
        }
        let product = |i: usize, j: usize| left.column(first + i).dot(&right.column(first + j));
        modulus(Complex::new(product(0, 0) + product(1, 1), product(0, 1) - product(1, 0)))
    };
    (0..values.len()).map(condition).collect()
}

/// `(jobvs, sort, select, n, A, lda, sdim, wr, wi, VS, ldvs, work, lwork, bwork, info)`; without
/// order.
fn dgees(call: &mut Call<'_>) -> Result<(), Fault> {
    if is_requested(call, 1) {
        return Err(call.fault("selecting eigenvalues by a function is not supported"));
    }
    let form = schur(call, &square(call, 4)?)?;
    write(call, 4, &form.t);
    call.set(6, 0.0);
    write_values(call, 7, &form.eigenvalues());
    if is_requested(call, 0) {
        write(call, 9, &form.q);
    }
    call.set(14, 0.0);
    Ok(())
}

/// `(job, compz, n, ilo, ihi, H, ldh, wr, wi, Z, ldz, work, lwork, info)`
fn dhseqr(call: &mut Call<'_>) -> Result<(), Fault> {
    let mut h = square(call, 5)?;
    let n = h.nrows();
    if call.number(3) != 1.0 || call.number(4) != n as f64 {
        return Err(call.fault("a part of a matrix"));
    }
    clear_below(&mut h);
    let form = schur(call, &h)?;
    write_values(call, 7, &form.eigenvalues());
    if call.text(0).eq_ignore_ascii_case("S") {
        write(call, 5, &form.t);
    }
    match call.text(1).to_ascii_uppercase().as_str() {
        "N" => {}
        "I" => write(call, 9, &form.q),
        "V" => {
            let z = same_size(call, 9, n)? * &form.q;
            write(call, 9, &z);
        }
        other => return Err(call.fault(format!("there is no job `{other}`"))),
    }
    call.set(13, 0.0);
    Ok(())
}

/// Zeros below the first subdiagonal.
fn clear_below(matrix: &mut DMatrix<f64>) {
    for row in 2..matrix.nrows() {
        matrix.view_mut((row, 0), (1, row - 1)).fill(0.0);
    }
}

fn same_size(call: &Call<'_>, argument: usize, n: usize) -> Result<DMatrix<f64>, Fault> {
    let matrix = square(call, argument)?;
    match matrix.nrows() == n {
        true => Ok(matrix),
        false => Err(call.fault("the matrices have different sizes")),
    }
}

/// An upper quasi-triangular matrix: no two blocks overlap.
fn quasi_triangular(call: &Call<'_>, argument: usize) -> Result<DMatrix<f64>, Fault> {
    let mut t = square(call, argument)?;
    clear_below(&mut t);
    let overlap =
        (2..t.nrows()).any(|row| t[(row, row - 1)] != 0.0 && t[(row - 1, row - 2)] != 0.0);
    match overlap {
        true => Err(call.fault("a matrix is not upper quasi-triangular")),
        false => Ok(t),
    }
}

/// A Schur form given by its parts: `t`, and `q` or 1.
fn given(call: &Call<'_>, t: usize, q: Option<usize>) -> Result<RealSchur, Fault> {
    let t = quasi_triangular(call, t)?;
    let n = t.nrows();
    let q = q.map_or(Ok(DMatrix::identity(n, n)), |q| same_size(call, q, n))?;
    let mut form = RealSchur { q, t };
    (0..n.saturating_sub(1)).for_each(|k| form.standardize(k));
    Ok(form)
}

/// `(side, howmny, select, n, T, ldt, VL, ldvl, VR, ldvr, mm, m, work, info)`; all vectors.
fn dtrevc(call: &mut Call<'_>) -> Result<(), Fault> {
    let how = call.text(1).to_ascii_uppercase();
    if how == "S" {
        return Err(call.fault("selecting eigenvectors is not supported"));
    }
    let side = call.text(0).to_ascii_uppercase();
    for (letter, argument, of) in [
        ("L", 6, left_eigenvectors as fn(&DMatrix<f64>) -> DMatrix<f64>),
        ("R", 8, right_eigenvectors),
    ] {
        if side != letter && side != "B" {
            continue;
        }
        let form = given(call, 4, (how == "B").then_some(argument))?;
        let values = form.eigenvalues();
        let mut vectors = &form.q * of(&form.t);
        scale(&mut vectors, |at| values[at].im != 0.0, Scale::Largest);
        write(call, argument, &vectors);
    }
    let n = call.dims(4)[0];
    call.set(11, f64::from(n));
    call.set(13, 0.0);
    Ok(())
}

/// `(job, compq, select, n, T, ldt, Q, ldq, wr, wi, m, s, sep, work, lwork, iwork, liwork, info)`;
/// without `sep`.
fn dtrsen(call: &mut Call<'_>) -> Result<(), Fault> {
    if matches!(call.text(0), "V" | "v" | "B" | "b") {
        return Err(call.fault("the separation of invariant subspaces is not supported"));
    }
    let updates = call.text(1).eq_ignore_ascii_case("V");
    let mut form = given(call, 4, updates.then_some(6))?;
    let n = form.t.nrows();
    let chosen: Vec<bool> = call.array(2).iter().map(|value| *value != 0.0).collect();
    if chosen.len() != n {
        return Err(call.fault("the selection and the matrix have different sizes"));
    }
    let m = form.reorder(&chosen);
    write(call, 4, &form.t);
    if updates {
        write(call, 6, &form.q);
    }
    write_values(call, 8, &form.eigenvalues());
    call.set(10, m as f64);
    if is_requested(call, 0) {
        let first = form.t.view((0, 0), (m, m)).into_owned();
        let second = form.t.view((m, m), (n - m, n - m)).into_owned();
        let coupling = form.t.view((0, m), (m, n - m)).into_owned();
        let x = sylvester(&first, &second, &coupling, -1.0);
        call.set(11, 1.0 / elementary::hypot(x.norm(), 1.0));
        call.set(12, 0.0);
    }
    call.set(17, 0.0);
    Ok(())
}

/// `(trana, tranb, isgn, m, n, A, lda, B, ldb, C, ldc, scale, info)`; the scale is 1.
fn dtrsyl(call: &mut Call<'_>) -> Result<(), Fault> {
    let (a, b) = (quasi_triangular(call, 5)?, quasi_triangular(call, 7)?);
    let c = matrix(call, 9)?;
    if c.shape() != (a.nrows(), b.nrows()) {
        return Err(call.fault("the right-hand side has a different size"));
    }
    let sign = call.number(2).signum();
    let transposed = (is_transposed(call, 0), is_transposed(call, 1));
    // The transposed of a quasi-triangular matrix is one with its coordinates in reverse.
    let a = if transposed.0 { reversed(&a) } else { a };
    let b = if transposed.1 { reversed(&b) } else { b };
    let x = sylvester(&a, &b, &flipped(c, transposed), sign);
    write(call, 9, &flipped(x, transposed));
    call.set(11, 1.0);
    call.set(12, 0.0);
    Ok(())
}

/// P Aᵀ P, where P reverses the order.
fn reversed(a: &DMatrix<f64>) -> DMatrix<f64> {
    let n = a.nrows();
    DMatrix::from_fn(n, n, |i, j| a[(n - 1 - j, n - 1 - i)])
}

/// Rows and columns in reverse where requested.
fn flipped(a: DMatrix<f64>, (rows, columns): (bool, bool)) -> DMatrix<f64> {
    let (m, n) = a.shape();
    let at = |flip: bool, i: usize, n: usize| if flip { n - 1 - i } else { i };
    DMatrix::from_fn(m, n, |i, j| a[(at(rows, i, m), at(columns, j, n))])
}
