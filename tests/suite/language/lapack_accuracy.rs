//! The accuracy of LAPACK's routines on matrices that are badly scaled, ill-conditioned, defective,
//! nearly singular, rectangular or empty, against results of 120 digits and beside the error that
//! LAPACK itself makes there (`tests/data/lapack/accuracy.json`, whose head says how it was computed).

use super::lapack::Given::{self, Vector};
use super::lapack::{Matrix, run, text};
use nalgebra::Complex;
use serde::Deserialize;
use serde_json::Value;
use std::fmt::Write as _;

#[derive(Deserialize)]
struct Entry {
    rows: usize,
    columns: usize,
    elements: Vec<f64>,
}

impl Entry {
    fn matrix(&self) -> Matrix {
        Matrix::from_row_slice(self.rows, self.columns, &self.elements)
    }
}

/// One routine on one matrix.
#[derive(Deserialize)]
struct Case {
    routine: String,
    case: String,
    a: Entry,
    b: Option<Entry>,
    c: Option<Entry>,
    exact: Vec<f64>,
    /// The error of LAPACK.
    scipy: f64,
    /// The error that a rounding of every element makes.
    #[serde(default)]
    rounding: f64,
    #[serde(default)]
    info: f64,
    #[serde(default)]
    pivots: Vec<f64>,
    rank: Option<f64>,
    backward: Option<f64>,
}

/// As many errors of LAPACK, or of a rounding of the elements, are granted: another order of the same
/// operations is as good, and where matrices are ill-conditioned, luck makes an order of magnitude.
const MARGIN: f64 = 10.0;
/// Errors of rounding, a row, that are granted where LAPACK happens to make none.
const ROUNDINGS: f64 = 16.0;

impl Case {
    fn b(&self) -> Matrix {
        self.b.as_ref().expect("a second matrix").matrix()
    }

    fn granted(&self, lapack: f64) -> f64 {
        let rows = self.a.rows.max(self.a.columns).max(1) as f64;
        (MARGIN * lapack).min(0.5) + ROUNDINGS * rows * f64::EPSILON
    }
}

fn cases() -> Vec<Case> {
    let text = include_str!("../../data/lapack/accuracy.json");
    let mut references: Value = serde_json::from_str(text).expect("the references are JSON");
    let matrices = references["matrices"].take();
    for case in references["cases"].as_array_mut().expect("cases") {
        for argument in ["a", "b", "c"] {
            if let Some(name) = case.get(argument).and_then(Value::as_str) {
                case[argument] = matrices[name].clone();
            }
        }
    }
    serde_json::from_value(references["cases"].take()).expect("the cases are well formed")
}

fn n(value: usize) -> Given {
    Given::Number(value as f64)
}

fn m(matrix: Matrix) -> Given {
    Given::Matrix(matrix)
}

fn flat(matrix: &Matrix) -> Vec<f64> {
    matrix.transpose().as_slice().to_vec()
}

/// The greatest difference over the greatest reference.
fn of_norm(found: &[f64], exact: &[f64]) -> f64 {
    assert_eq!(found.len(), exact.len());
    let size = exact.iter().fold(0.0, |size: f64, x| size.max(x.abs()));
    let scale = if size > 0.0 { size } else { 1.0 };
    let errors = found.iter().zip(exact).map(|(f, e)| (f - e).abs() / scale);
    errors.fold(0.0, greatest)
}

/// The greatest, also where one is not a number.
fn greatest(a: f64, b: f64) -> f64 {
    if a.is_nan() || b.is_nan() { f64::NAN } else { a.max(b) }
}

/// Errors of values whose order is free: of each relative to itself, or to the greatest.
fn of_values(found: Vec<Complex<f64>>, exact: &[f64], each: bool) -> f64 {
    let (re, im) = exact.split_at(exact.len() / 2);
    let exact: Vec<Complex<f64>> = re.iter().zip(im).map(|(x, y)| Complex::new(*x, *y)).collect();
    if found.len() != exact.len() {
        return f64::NAN;
    }
    let size = |z: Complex<f64>| z.re.hypot(z.im);
    let largest = exact.iter().fold(0.0, |largest: f64, z| largest.max(size(*z)));
    let mut left = found;
    let mut error: f64 = 0.0;
    for value in exact {
        let apart = |z: &Complex<f64>| size(z - value);
        let nearest = (0..left.len()).min_by(|i, j| apart(&left[*i]).total_cmp(&apart(&left[*j])));
        let found = left.swap_remove(nearest.expect("one is left"));
        let scale = if each && value != Complex::new(0.0, 0.0) { size(value) } else { largest };
        error = greatest(error, size(found - value) / if scale > 0.0 { scale } else { 1.0 });
    }
    error.min(1.0)
}

fn complex(re: &Matrix, im: &Matrix) -> Vec<Complex<f64>> {
    re.iter().zip(im.iter()).map(|(x, y)| Complex::new(*x, *y)).collect()
}

fn equal(what: &str, found: &[f64], wanted: &[f64]) -> Result<(), String> {
    match found == wanted {
        true => Ok(()),
        false => Err(format!("{what}: {found:?}, not {wanted:?}")),
    }
}

fn below(what: &str, found: f64, granted: f64) -> Result<(), String> {
    match found <= granted {
        true => Ok(()),
        false => Err(format!("{what}: {found:e}, not below {granted:e}")),
    }
}

/// What a routine does on the matrices of a case: its error; what else is not as it must be.
fn error(case: &Case) -> Result<f64, String> {
    let a = case.a.matrix();
    match case.routine.as_str() {
        "dgesv" => linear_system(case, a),
        "dgtsv" => tridiagonal(case, a),
        "dgbsv" => band(case, a),
        "dgetrf" => factors(case, a),
        "dgetrs" | "dgetri" | "dgecon" => from_factors(case, &a),
        "dgeqrf" | "dgeqp3" | "dgehrd" => reflections(case, a),
        "dgeev" => eigenvalues(case, a),
        "dgees" => schur_form(case, a),
        "dgesdd" => singular_values(case, a),
        "dgels" | "dgelsy" => least_squares(case, a),
        "dpotrf" => cholesky(case, a),
        "dtrsyl" => sylvester(case, a),
        "dggev" => pencil(case, a),
        other => panic!("there is no way to call `{other}`"),
    }
}

fn linear_system(case: &Case, a: Matrix) -> Result<f64, String> {
    let k = a.nrows();
    let args = [n(k), n(1), m(a), n(k), Vector(k), m(case.b()), n(k), n(0)];
    let done = run("dgesv", &args)?;
    equal("info", &[done[7][0]], &[case.info])?;
    Ok(if case.info == 0.0 { of_norm(&flat(&done[5]), &case.exact) } else { 0.0 })
}

fn tridiagonal(case: &Case, a: Matrix) -> Result<f64, String> {
    let k = a.nrows();
    let diagonal = |below: usize, beside: usize| {
        let size = k - below.max(beside);
        Given::Values((0..size).map(|i| a[(i + below, i + beside)]).collect())
    };
    let (lower, main, upper) = (diagonal(1, 0), diagonal(0, 0), diagonal(0, 1));
    let args = [n(k), n(1), lower, main, upper, m(case.b()), n(k), n(0)];
    let done = run("dgtsv", &args)?;
    equal("info", &[done[7][0]], &[0.0])?;
    Ok(of_norm(&flat(&done[5]), &case.exact))
}

fn band(case: &Case, a: Matrix) -> Result<f64, String> {
    let k = a.nrows();
    let (below, above) = (case.pivots[0] as usize, case.pivots[1] as usize);
    let rows = 2 * below + above + 1;
    let mut band = Matrix::zeros(rows, k);
    for j in 0..k {
        for i in j.saturating_sub(above)..k.min(j + below + 1) {
            band[(below + above + i - j, j)] = a[(i, j)];
        }
    }
    let sizes = [n(k), n(below), n(above), n(1)];
    let args = sizes.into_iter().chain([m(band), n(rows), Vector(k), m(case.b()), n(k), n(0)]);
    let done = run("dgbsv", &args.collect::<Vec<_>>())?;
    equal("info", &[done[9][0]], &[0.0])?;
    Ok(of_norm(&flat(&done[7]), &case.exact))
}

fn factors(case: &Case, a: Matrix) -> Result<f64, String> {
    let (rows, columns) = a.shape();
    let args = [n(rows), n(columns), m(a), n(rows), Vector(rows.min(columns)), n(0)];
    let done = run("dgetrf", &args)?;
    equal("pivots", &flat(&done[4]), &case.exact)?;
    equal("info", &[done[5][0]], &[case.info])?;
    Ok(0.0)
}

/// What uses the factors of `dgetrf`.
fn from_factors(case: &Case, a: &Matrix) -> Result<f64, String> {
    let rows = a.nrows();
    let size = a.column_iter().map(|c| c.iter().map(|x| x.abs()).sum::<f64>()).fold(0.0, f64::max);
    let args = [n(rows), n(rows), m(a.clone()), n(rows), Vector(rows), n(0)];
    let mut done = run("dgetrf", &args)?;
    let (pivots, lu) = (done.swap_remove(4), done.swap_remove(2));
    match case.routine.as_str() {
        "dgetrs" => {
            let b = m(case.b());
            let trans = text("T");
            let pivots = Given::Values(flat(&pivots));
            let args = [trans, n(rows), n(1), m(lu), n(rows), pivots, b, n(rows), n(0)];
            Ok(of_norm(&flat(&run("dgetrs", &args)?[6]), &case.exact))
        }
        "dgetri" => {
            let pivots = Given::Values(flat(&pivots));
            let args = [n(rows), m(lu), n(rows), pivots, Vector(rows), n(rows), n(0)];
            Ok(of_norm(&flat(&run("dgetri", &args)?[1]), &case.exact))
        }
        _ => {
            let (letter, size) = (text("1"), Given::Number(size));
            let (work, whole) = (Vector(4 * rows), Vector(rows));
            let args = [letter, n(rows), m(lu), n(rows), size, n(0), work, whole, n(0)];
            Ok(of_norm(&flat(&run("dgecon", &args)?[5]), &case.exact))
        }
    }
}

/// Triangle and vectors in one argument, τ in another.
fn reflections(case: &Case, a: Matrix) -> Result<f64, String> {
    let (rows, columns) = a.shape();
    let taus = Vector(rows.min(columns));
    let (done, factors, taus) = match case.routine.as_str() {
        "dgeqrf" => {
            let args = [n(rows), n(columns), m(a), n(rows), taus, Vector(1), n(1), n(0)];
            (run("dgeqrf", &args)?, 2, 4)
        }
        "dgeqp3" => {
            let pivots = Vector(columns);
            let args = [n(rows), n(columns), m(a), n(rows), pivots, taus, Vector(1), n(1), n(0)];
            let done = run("dgeqp3", &args)?;
            equal("pivots", &flat(&done[4]), &case.pivots)?;
            (done, 2, 5)
        }
        _ => {
            let taus = Vector(rows.saturating_sub(1));
            let args = [n(rows), n(1), n(rows), m(a), n(rows), taus, Vector(1), n(1), n(0)];
            (run("dgehrd", &args)?, 3, 5)
        }
    };
    let (exact, exact_taus) = case.exact.split_at(rows * columns);
    Ok(greatest(of_norm(&flat(&done[factors]), exact), of_norm(&flat(&done[taus]), exact_taus)))
}

fn eigenvalues(case: &Case, a: Matrix) -> Result<f64, String> {
    let k = a.nrows();
    let (work, square) = ([Vector(1), n(1), n(0)], || m(Matrix::zeros(k, k)));
    let args = [text("V"), text("V"), n(k), m(a), n(k), Vector(k), Vector(k)];
    let vectors = [square(), n(k), square(), n(k)];
    let args: Vec<Given> = args.into_iter().chain(vectors).chain(work).collect();
    let done = run("dgeev", &args)?;
    equal("info", &[done[13][0]], &[0.0])?;
    Ok(of_values(complex(&done[5], &done[6]), &case.exact, true))
}

/// Q is orthogonal and Q T Qᵀ the matrix.
fn schur_form(case: &Case, a: Matrix) -> Result<f64, String> {
    let (k, scale) = (a.nrows(), a.amax().max(f64::MIN_POSITIVE));
    let square = m(Matrix::zeros(k, k));
    let args = [
        text("V"),
        text("N"),
        Vector(1),
        n(k),
        m(a.clone()),
        n(k),
        n(0),
        Vector(k),
        Vector(k),
        square,
        n(k),
        Vector(1),
        n(1),
        Vector(k),
        n(0),
    ];
    let done = run("dgees", &args)?;
    let (t, q) = (&done[4], &done[9]);
    let rest = (q.transpose() * q - Matrix::identity(k, k)).norm();
    below("orthogonality of Q", rest, case.granted(1e-15))?;
    let (a, t) = (a / scale, t / scale);
    let backward = (q * t * q.transpose() - &a).norm() / a.norm().max(f64::MIN_POSITIVE);
    let granted = case.granted(case.backward.expect("an error"));
    below("Q T Qᵀ - A", backward, granted)?;
    Ok(of_values(complex(&done[7], &done[8]), &case.exact, false))
}

/// U Σ Vᵀ is the matrix; the error of the singular values, each relative to itself.
fn singular_values(case: &Case, a: Matrix) -> Result<f64, String> {
    let (rows, columns) = a.shape();
    let least = rows.min(columns);
    let args = [
        text("A"),
        n(rows),
        n(columns),
        m(a.clone()),
        n(rows),
        Vector(least),
        m(Matrix::zeros(rows, rows)),
        n(rows),
        m(Matrix::zeros(columns, columns)),
        n(columns),
        Vector(1),
        n(1),
        n(1),
        n(0),
    ];
    let done = run("dgesdd", &args)?;
    let (s, u, v_t) = (&done[5], &done[6], &done[8]);
    if least > 0 {
        let scale = a.amax().max(f64::MIN_POSITIVE);
        let sigma = Matrix::from_fn(rows, columns, |i, j| if i == j { s[i] / scale } else { 0.0 });
        let rest = (u * sigma * v_t - &a / scale).norm();
        below("U Σ Vᵀ - A", rest, case.granted(1e-15))?;
    }
    let largest = case.exact.first().copied().filter(|s| *s > 0.0).unwrap_or(1.0);
    let errors = s
        .iter()
        .zip(&case.exact)
        .map(|(found, exact)| (found - exact).abs() / if *exact > 0.0 { *exact } else { largest });
    Ok(errors.fold(0.0, greatest))
}

fn least_squares(case: &Case, a: Matrix) -> Result<f64, String> {
    let (rows, columns) = a.shape();
    let mut b = Matrix::zeros(rows.max(columns), 1);
    b.rows_mut(0, rows).copy_from(&case.b());
    let (system, work) = ([n(1), m(a), n(rows), m(b), n(rows)], [Vector(1), n(1), n(0)]);
    let x = if case.routine == "dgels" {
        let args = [text("N"), n(rows), n(columns)].into_iter().chain(system).chain(work);
        let done = run("dgels", &args.collect::<Vec<_>>())?;
        equal("info", &[done[10][0]], &[0.0])?;
        flat(&done[6])
    } else {
        let rank = [Vector(columns), Given::Number(1e-12), n(0)];
        let args = [n(rows), n(columns)].into_iter().chain(system).chain(rank).chain(work);
        let done = run("dgelsy", &args.collect::<Vec<_>>())?;
        equal("rank", &[done[9][0]], &[case.rank.expect("a rank")])?;
        flat(&done[5])
    };
    Ok(of_norm(&x[..columns], &case.exact))
}

fn cholesky(case: &Case, a: Matrix) -> Result<f64, String> {
    let k = a.nrows();
    let done = run("dpotrf", &[text("L"), n(k), m(a), n(k), n(0)])?;
    equal("info", &[done[4][0]], &[case.info])?;
    let lower = flat(&done[2].lower_triangle());
    Ok(if case.info == 0.0 { of_norm(&lower, &case.exact) } else { 0.0 })
}

fn sylvester(case: &Case, a: Matrix) -> Result<f64, String> {
    let (b, c) = (case.b(), case.c.as_ref().expect("a right side").matrix());
    let (j, k) = (a.nrows(), b.nrows());
    let sizes = [text("N"), text("N"), n(1), n(j), n(k)];
    let matrices = [m(a), n(j), m(b), n(k), m(c), n(j), n(0), n(0)];
    let done = run("dtrsyl", &sizes.into_iter().chain(matrices).collect::<Vec<_>>())?;
    Ok(of_norm(&flat(&(&done[9] / done[11][0])), &case.exact))
}

fn pencil(case: &Case, a: Matrix) -> Result<f64, String> {
    let k = a.nrows();
    let given = [text("N"), text("N"), n(k), m(a), n(k), m(case.b()), n(k)];
    let values = [Vector(k), Vector(k), Vector(k)];
    let square = || m(Matrix::zeros(k, k));
    let vectors = [square(), n(k), square(), n(k), Vector(1), n(1), n(0)];
    let args = given.into_iter().chain(values).chain(vectors);
    let done = run("dggev", &args.collect::<Vec<_>>())?;
    let finite = |at: &usize| done[9][*at] != 0.0;
    let value = |at| Complex::new(done[7][at], done[8][at]) / done[9][at];
    let found = (0..k).filter(finite).map(value).collect();
    Ok(of_values(found, &case.exact, true))
}

#[test]
fn every_routine_is_as_accurate_as_lapack() {
    let (mut table, mut missed) = (String::new(), String::new());
    for case in cases() {
        let granted = case.granted(case.scipy.max(case.rounding));
        let label = format!("{:8} {:24}", case.routine, case.case);
        let (line, holds) = match error(&case) {
            Ok(error) => {
                (format!("{label} {error:9.1e}  LAPACK {:9.1e}", case.scipy), error <= granted)
            }
            Err(message) => (format!("{label} {message}"), false),
        };
        if !holds {
            _ = writeln!(missed, "{line}");
        }
        _ = writeln!(table, "{line}");
    }
    assert!(missed.is_empty(), "worse than LAPACK:\n{missed}\nof\n{table}");
}
