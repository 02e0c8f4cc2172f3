//! LAPACK's routines as `Modelica.Math.Matrices` calls them: every result by the identity that
//! defines it.

use super::external::Arg::{self, Array, Number, Text};
use super::external::call;
use nalgebra::{Complex, DMatrix};

pub(super) type Matrix = DMatrix<f64>;

/// An argument of a call.
pub(super) enum Given {
    Number(f64),
    Text(&'static str),
    Matrix(Matrix),
    /// A vector of zeros.
    Vector(usize),
    /// A vector.
    Values(Vec<f64>),
}

use Given::Vector;

fn n(value: usize) -> Given {
    Given::Number(value as f64)
}

fn zeros(rows: usize, columns: usize) -> Given {
    Given::Matrix(Matrix::zeros(rows, columns))
}

/// The arguments after a call: vectors as columns, numbers as matrices of one element.
pub(super) fn run(name: &str, given: &[Given]) -> Result<Vec<Matrix>, String> {
    let rows: Vec<(Vec<usize>, Vec<f64>)> = given
        .iter()
        .map(|given| match given {
            Given::Number(value) => (vec![], vec![*value]),
            Given::Text(_) => (vec![], vec![]),
            Given::Matrix(m) => (vec![m.nrows(), m.ncols()], m.transpose().as_slice().to_vec()),
            Vector(n) => (vec![*n], vec![0.0; *n]),
            Given::Values(values) => (vec![values.len()], values.clone()),
        })
        .collect();
    let args: Vec<Arg<'_>> = given
        .iter()
        .zip(&rows)
        .map(|(given, (dims, values))| match given {
            Given::Text(text) => Text(text),
            Given::Number(value) => Number(*value),
            Given::Matrix(_) | Vector(_) | Given::Values(_) => Array(dims, values),
        })
        .collect();
    let done = call(name, &args).map_err(|fault| fault.message)?;
    let mut rest = done.numbers.as_slice();
    let mut results = Vec::new();
    for (dims, values) in &rows {
        let (own, others) = rest.split_at(values.len());
        rest = others;
        let columns = dims.get(1).copied().unwrap_or(1);
        let count = own.len() / columns.max(1);
        results.push(Matrix::from_row_slice(count, columns, own));
    }
    Ok(results)
}

fn same(a: &Matrix, b: &Matrix) {
    assert_eq!(a.shape(), b.shape());
    let difference = (a - b).norm();
    assert!(difference <= 1e-10 * (1.0 + b.norm()), "{a} is not {b}");
}

fn orthogonal(q: &Matrix) {
    same(&(q.transpose() * q), &Matrix::identity(q.ncols(), q.ncols()));
}

/// Reproducible elements between -1 and 1.
fn any(rows: usize, columns: usize, seed: u64) -> Matrix {
    let mut state = seed.wrapping_mul(2).wrapping_add(1);
    Matrix::from_fn(rows, columns, |_, _| {
        state =
            state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 11) as f64 / (1u64 << 52) as f64 - 1.0
    })
}

/// Square matrices with real and complex, simple and multiple eigenvalues.
fn squares() -> Vec<Matrix> {
    let mut all: Vec<Matrix> = (1..8).map(|n| any(n, n, n as u64)).collect();
    all.push(Matrix::identity(4, 4));
    all.push(Matrix::zeros(3, 3));
    all.push(Matrix::from_row_slice(
        4,
        4,
        &[0.0, 1.0, 0.0, 0.0, -1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 5.0, 0.0, 0.0, -5.0, 0.0],
    ));
    all.push(Matrix::from_row_slice(3, 3, &[1.0, 1.0, 0.0, 0.0, 1.0, 1.0, 0.0, 0.0, 1.0]));
    all
}

fn is_standard(t: &Matrix) {
    for i in 0..t.nrows() {
        for j in 0..i {
            if t[(i, j)] != 0.0 {
                assert_eq!(j + 1, i, "{t}");
                assert!(t[(i, j)] * t[(j, i)] < 0.0, "{t}");
                assert_eq!(t[(i, i)], t[(j, j)], "{t}");
                assert!(i + 1 == t.nrows() || t[(i + 1, i)] == 0.0, "{t}");
            }
        }
    }
}

pub(super) fn text(text: &'static str) -> Given {
    Given::Text(text)
}

fn schur(a: &Matrix) -> (Matrix, Matrix, Matrix, Matrix) {
    let k = a.nrows();
    let mut results = run(
        "dgees",
        &[
            text("V"),
            text("N"),
            Vector(1),
            n(k),
            Given::Matrix(a.clone()),
            n(k),
            n(0),
            Vector(k),
            Vector(k),
            zeros(k, k),
            n(k),
            Vector(10 * k),
            n(10 * k),
            Vector(k),
            Given::Number(-1.0),
        ],
    )
    .expect("a Schur form");
    assert_eq!(results[14][0], 0.0);
    let q = results.swap_remove(9);
    (results[4].clone(), q, results[7].clone(), results[8].clone())
}

#[test]
fn a_schur_form_is_similar_to_its_matrix() {
    for a in squares() {
        let (t, q, re, im) = schur(&a);
        is_standard(&t);
        orthogonal(&q);
        same(&(&q * &t * q.transpose()), &a);
        same(&re, &Matrix::from_fn(a.nrows(), 1, |i, _| t[(i, i)]));
        let sum: f64 = im.iter().sum();
        assert_eq!(sum, 0.0, "pairs are conjugate");
    }
}

#[test]
fn chosen_eigenvalues_come_first() {
    for a in squares() {
        let k = a.nrows();
        let (t, q, re, im) = schur(&a);
        // Those of the left half plane, and of the right one.
        for side in [1.0, -1.0] {
            let select = Matrix::from_fn(k, 1, |i, _| f64::from(u8::from(side * re[i] < 0.0)));
            let chosen = select.sum();
            let results = run(
                "dtrsen",
                &[
                    text("E"),
                    text("V"),
                    Given::Matrix(select),
                    n(k),
                    Given::Matrix(t.clone()),
                    n(k),
                    Given::Matrix(q.clone()),
                    n(k),
                    Vector(k),
                    Vector(k),
                    n(0),
                    n(0),
                    n(0),
                    Vector(k * k),
                    n(k * k),
                    Vector(1),
                    n(1),
                    Given::Number(-1.0),
                ],
            );
            let results = results.expect("another order");
            let (t, q) = (&results[4], &results[6]);
            is_standard(t);
            orthogonal(q);
            same(&(q * t * q.transpose()), &a);
            assert_eq!(results[10][0], chosen);
            for (i, part) in results[8].iter().enumerate().take(k) {
                assert_eq!(side * part < 0.0, (i as f64) < chosen, "{t}");
            }
            assert!((results[9].norm() - im.norm()).abs() < 1e-10);
            assert!((0.0..=1.0).contains(&results[11][0]));
        }
    }
}

#[test]
fn sylvesters_equation_holds() {
    for (a, b) in squares().into_iter().zip(squares().into_iter().skip(3)) {
        // Apart from each other, so that there is one solution.
        let (a, ..) = schur(&a);
        let (b, ..) = schur(&(&b + Matrix::identity(b.nrows(), b.nrows()) * 9.5));
        let c = any(a.nrows(), b.nrows(), 77);
        for (first, second, sign) in
            [("N", "N", 1.0), ("T", "N", 1.0), ("N", "T", -1.0), ("T", "T", -1.0)]
        {
            let results = run(
                "dtrsyl",
                &[
                    text(first),
                    text(second),
                    Given::Number(sign),
                    n(a.nrows()),
                    n(b.nrows()),
                    Given::Matrix(a.clone()),
                    n(a.nrows()),
                    Given::Matrix(b.clone()),
                    n(b.nrows()),
                    Given::Matrix(c.clone()),
                    n(a.nrows()),
                    n(0),
                    n(0),
                ],
            );
            let results = results.expect("a solution");
            let (x, scale) = (&results[9], results[11][0]);
            let op =
                |letter: &str, m: &Matrix| if letter == "T" { m.transpose() } else { m.clone() };
            same(&(op(first, &a) * x + sign * x * op(second, &b)), &(scale * &c));
        }
    }
}

/// A column that real and imaginary parts stand for.
fn complex_column(m: &Matrix, im: &Matrix, at: usize) -> DMatrix<Complex<f64>> {
    let (first, sign) = if im[at] < 0.0 { (at - 1, -1.0) } else { (at, im[at].signum()) };
    DMatrix::from_fn(m.nrows(), 1, |i, _| match im[at] {
        0.0 => Complex::new(m[(i, at)], 0.0),
        _ => Complex::new(m[(i, first)], sign * m[(i, first + 1)]),
    })
}

/// β A x = α B x, or with yᴴ from the left; no vector is zero.
fn eigenvectors_fit(a: &Matrix, b: &Matrix, vectors: &Matrix, values: [&Matrix; 3], left: bool) {
    let complex = |m: &Matrix| m.map(|v| Complex::new(v, 0.0));
    let (a, b) = match left {
        true => (complex(&a.transpose()), complex(&b.transpose())),
        false => (complex(a), complex(b)),
    };
    let [re, im, beta] = values;
    for at in 0..re.nrows() {
        let x = complex_column(vectors, im, at);
        let x = if left { x.map(|v| v.conj()) } else { x };
        assert!(x.norm() > 0.5 && x.norm() < 4.0, "{vectors}");
        let alpha = Complex::new(re[at], im[at]);
        let rest = &a * &x * Complex::new(beta[at], 0.0) - &b * &x * alpha;
        assert!(rest.norm() < 1e-9 * (1.0 + a.norm() + alpha.re.hypot(alpha.im)), "{rest}");
    }
}

#[test]
fn left_and_right_eigenvectors_belong_to_their_eigenvalues() {
    for a in squares() {
        let k = a.nrows();
        let args = [
            text("B"),
            text("V"),
            text("V"),
            text("E"),
            n(k),
            Given::Matrix(a.clone()),
            n(k),
            Vector(k),
            Vector(k),
            zeros(k, k),
            n(k),
            zeros(k, k),
            n(k),
            n(0),
            n(0),
            Vector(k),
            n(0),
            Vector(k),
            Vector(k),
            Vector(1),
            n(1),
            Vector(1),
            Given::Number(-1.0),
        ];
        let results = run("dgeevx", &args).expect("eigenvalues");
        let one = Matrix::identity(k, k);
        let values = [&results[7], &results[8], &Matrix::repeat(k, 1, 1.0)];
        eigenvectors_fit(&a, &one, &results[9], values, true);
        eigenvectors_fit(&a, &one, &results[11], values, false);
        assert!(results[17].iter().all(|c| (0.0..=1.0 + 1e-12).contains(c)));

        let (t, q, re, im) = schur(&a);
        let args = [
            text("B"),
            text("B"),
            Vector(k),
            n(k),
            Given::Matrix(t),
            n(k),
            Given::Matrix(q.clone()),
            n(k),
            Given::Matrix(q),
            n(k),
            n(k),
            n(0),
            Vector(3 * k),
            Given::Number(-1.0),
        ];
        let results = run("dtrevc", &args).expect("eigenvectors");
        let values = [&re, &im, &Matrix::repeat(k, 1, 1.0)];
        eigenvectors_fit(&a, &one, &results[6], values, true);
        eigenvectors_fit(&a, &one, &results[8], values, false);
    }
}

fn generalized(a: &Matrix, b: &Matrix) -> Result<Vec<Matrix>, String> {
    let k = a.nrows();
    run(
        "dggev",
        &[
            text("V"),
            text("V"),
            n(k),
            Given::Matrix(a.clone()),
            n(k),
            Given::Matrix(b.clone()),
            n(k),
            Vector(k),
            Vector(k),
            Vector(k),
            zeros(k, k),
            n(k),
            zeros(k, k),
            n(k),
            Vector(1),
            n(1),
            Given::Number(-1.0),
        ],
    )
}

#[test]
fn generalized_eigenvectors_belong_to_their_eigenvalues() {
    for (seed, a) in squares().into_iter().enumerate() {
        let k = a.nrows();
        let mut b = any(k, k, 100 + seed as u64);
        if seed % 2 == 1 {
            // One infinite eigenvalue.
            b.row_mut(k - 1).fill(0.0);
        }
        if a.determinant() == 0.0 && seed % 2 == 1 {
            continue;
        }
        let results = generalized(&a, &b).expect("eigenvalues");
        let values = [&results[7], &results[8], &results[9]];
        let infinite = results[9].iter().filter(|beta| **beta == 0.0).count();
        assert_eq!(infinite, seed % 2, "{}", results[9]);
        eigenvectors_fit(&a, &b, &results[10], values, true);
        eigenvectors_fit(&a, &b, &results[12], values, false);
    }
    // Where B is the most regular to invert.
    for a in squares() {
        let b = Matrix::identity(a.nrows(), a.nrows()) * 2.0;
        let results = generalized(&a, &b).expect("eigenvalues");
        let values = [&results[7], &results[8], &results[9]];
        eigenvectors_fit(&a, &b, &results[10], values, true);
        eigenvectors_fit(&a, &b, &results[12], values, false);
    }
    let singular = generalized(&Matrix::zeros(2, 2), &Matrix::zeros(2, 2));
    assert!(singular.is_err_and(|message| message.contains("singular")));
}

#[test]
fn singular_vectors_of_any_shape_are_orthogonal() {
    for (rows, columns) in [(3, 3), (5, 2), (2, 5), (4, 1), (1, 1)] {
        let mut a = any(rows, columns, 5);
        if rows == 3 {
            let first = a.row(0) * 2.0;
            a.row_mut(2).copy_from(&first);
        }
        let least = rows.min(columns);
        let args = [
            text("A"),
            n(rows),
            n(columns),
            Given::Matrix(a.clone()),
            n(rows),
            Vector(least),
            zeros(rows, rows),
            n(rows),
            zeros(columns, columns),
            n(columns),
            Vector(1),
            n(1),
            n(1),
            Given::Number(-1.0),
        ];
        let results = run("dgesdd", &args).expect("singular values");
        let (s, u, v_t) = (&results[5], &results[6], &results[8]);
        orthogonal(u);
        orthogonal(v_t);
        let sigma = Matrix::from_fn(rows, columns, |i, j| if i == j { s[i] } else { 0.0 });
        same(&(u * sigma * v_t), &a);
        assert!(s.as_slice().windows(2).all(|pair| pair[0] >= pair[1]));
    }
}

#[test]
fn constrained_least_squares_hold_their_constraints() {
    let (a, b) = (any(6, 4, 3), any(2, 4, 4));
    let (c, d) = (any(6, 1, 5), any(2, 1, 6));
    let args = [
        n(6),
        n(4),
        n(2),
        Given::Matrix(a.clone()),
        n(6),
        Given::Matrix(b.clone()),
        n(2),
        Given::Matrix(c.clone()),
        Given::Matrix(d.clone()),
        Vector(4),
        Vector(1),
        n(1),
        Given::Number(-1.0),
    ];
    let results = run("dgglse", &args).expect("a solution");
    let x = &results[9];
    assert_eq!(results[12][0], 0.0);
    same(&(&b * x), &d);
    // With multipliers, it is a linear system: Aᵀ A x + Bᵀ λ = Aᵀ c, B x = d.
    let mut system = Matrix::zeros(6, 6);
    system.view_mut((0, 0), (4, 4)).copy_from(&(a.transpose() * &a));
    system.view_mut((0, 4), (4, 2)).copy_from(&b.transpose());
    system.view_mut((4, 0), (2, 4)).copy_from(&b);
    let mut right = Matrix::zeros(6, 1);
    right.rows_mut(0, 4).copy_from(&(a.transpose() * &c));
    right.rows_mut(4, 2).copy_from(&d);
    let solution = system.lu().solve(&right).expect("regular");
    same(x, &solution.rows(0, 4).into_owned());
}

#[test]
fn triangular_systems_are_solved_from_both_sides() {
    let full = any(3, 3, 9) + Matrix::identity(3, 3) * 2.0;
    for (side, triangle, transposed, unit) in [
        ("L", "U", "N", "N"),
        ("L", "L", "T", "N"),
        ("R", "U", "T", "U"),
        ("R", "L", "N", "N"),
        ("R", "U", "N", "N"),
    ] {
        let b = if side == "L" { any(3, 2, 10) } else { any(2, 3, 10) };
        let args = [
            text(side),
            text(triangle),
            text(transposed),
            text(unit),
            n(b.nrows()),
            n(b.ncols()),
            Given::Number(2.5),
            Given::Matrix(full.clone()),
            n(3),
            Given::Matrix(b.clone()),
            n(3),
        ];
        let x = run("dtrsm", &args).expect("a solution").swap_remove(9);
        let mut a = if triangle == "U" { full.upper_triangle() } else { full.lower_triangle() };
        if unit == "U" {
            a.fill_diagonal(1.0);
        }
        let a = if transposed == "T" { a.transpose() } else { a };
        same(&if side == "L" { a * x } else { x * a }, &(2.5 * b));
    }
}
