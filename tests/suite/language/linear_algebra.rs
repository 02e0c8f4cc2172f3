//! Linear algebra under its external names, on small matrices whose results are known exactly.

use super::external::Arg::{self, Array, Number, Text};
use super::external::{call, near};

#[test]
fn linear_systems_are_solved_and_factors_say_where_they_fail() {
    let a = [2.0, 1.0, -1.0, -3.0, -1.0, 2.0, -2.0, 1.0, 2.0];
    let b = [8.0, -11.0, -3.0];
    let (n, size, zeros) = (Number(3.0), [3, 3], [0.0; 9]);
    let column = || Array(&[3], &zeros[..3]);
    let solve = |a: &[f64]| {
        let args = [
            n.clone(),
            Number(1.0),
            Array(&size, a),
            n.clone(),
            column(),
            Array(&[3], &b),
            n.clone(),
            Number(0.0),
        ];
        call("dgesv", &args).expect("an answer").numbers
    };
    let done = solve(&a);
    for (x, expected) in done[15..18].iter().zip([2.0, 3.0, -1.0]) {
        near(*x, expected);
    }
    assert_eq!(done[19], 0.0);
    assert_eq!(solve(&[1.0, 2.0, 3.0, 2.0, 4.0, 6.0, 1.0, 0.0, 1.0])[19], 3.0);
    let args = [n.clone(), n.clone(), Array(&size, &a), n.clone(), column(), Number(0.0)];
    let factors = call("dgetrf", &args).expect("factors").numbers;
    let (lu, pivots) = (&factors[2..11], &factors[12..15]);
    let args = [
        n.clone(),
        Array(&size, lu),
        n.clone(),
        Array(&[3], pivots),
        column(),
        n.clone(),
        Number(0.0),
    ];
    let inverse = call("dgetri", &args).expect("an inverse").numbers[1..10].to_vec();
    for i in 0..3 {
        for j in 0..3 {
            let entry: f64 = (0..3).map(|k| a[3 * i + k] * inverse[3 * k + j]).sum();
            near(entry, f64::from(u8::from(i == j)));
        }
    }
    for (trans, expected) in [("N", [2.0, 3.0, -1.0]), ("T", [2.0, 3.0, -1.0])] {
        let right: Vec<f64> = (0..3)
            .map(|i| {
                let at = |k: usize| if trans == "N" { 3 * i + k } else { 3 * k + i };
                (0..3).map(|k| a[at(k)] * expected[k]).sum()
            })
            .collect();
        let args = [
            Text(trans),
            n.clone(),
            Number(1.0),
            Array(&size, lu),
            n.clone(),
            Array(&[3], pivots),
            Array(&[3], &right),
            n.clone(),
            Number(0.0),
        ];
        let found = call("dgetrs", &args).expect("an answer").numbers;
        for (x, expected) in found[15..18].iter().zip(expected) {
            near(*x, expected);
        }
    }
}

#[test]
fn least_squares_and_singular_values_are_exact() {
    // The line through (0, 1), (1, 3), (2, 4), (3, 4): 1.5 + t.
    let a = [1.0, 0.0, 1.0, 1.0, 1.0, 2.0, 1.0, 3.0];
    let args = [
        Text("N"),
        Number(4.0),
        Number(2.0),
        Number(1.0),
        Array(&[4, 2], &a),
        Number(4.0),
        Array(&[4], &[1.0, 3.0, 4.0, 4.0]),
        Number(4.0),
        Array(&[1], &[0.0]),
        Number(1.0),
        Number(0.0),
    ];
    let done = call("dgels", &args).expect("a line").numbers;
    near(done[12], 1.5);
    near(done[13], 1.0);
    let args = [
        Text("N"),
        Text("N"),
        Number(2.0),
        Number(2.0),
        Array(&[2, 2], &[3.0, 0.0, 4.0, 5.0]),
        Number(2.0),
        Array(&[2], &[0.0; 2]),
        Array(&[2, 2], &[0.0; 4]),
        Number(2.0),
        Array(&[2, 2], &[0.0; 4]),
        Number(2.0),
        Array(&[1], &[0.0]),
        Number(1.0),
        Number(0.0),
    ];
    let done = call("dgesvd", &args).expect("values").numbers;
    near(done[7], 45.0f64.sqrt());
    near(done[8], 5.0f64.sqrt());
    let args = [Text("U"), Number(2.0), Array(&[2, 2], &[4.0, 2.0, 2.0, 10.0]), Number(2.0)];
    let args: Vec<Arg<'_>> = args.into_iter().chain([Number(0.0)]).collect();
    let done = call("dpotrf", &args).expect("a factor").numbers;
    assert_eq!(&done[1..3], [2.0, 1.0]);
    near(done[4], 3.0);
}

/// Row-major product of matrices of `n` rows and columns.
fn product(n: usize, a: &[f64], b: &[f64]) -> Vec<f64> {
    let element = |at: usize| (0..n).map(|k| a[at / n * n + k] * b[k * n + at % n]).sum();
    (0..n * n).map(element).collect()
}

fn transposed(n: usize, a: &[f64]) -> Vec<f64> {
    (0..n * n).map(|at| a[at % n * n + at / n]).collect()
}

const SQUARE: [f64; 9] = [1.0, 2.0, -1.0, 4.0, 0.0, 3.0, 2.0, 5.0, 7.0];

#[test]
fn orthogonal_factors_multiply_to_the_matrix() {
    let (size, n) = ([3usize, 3], Number(3.0));
    let args = [
        n.clone(),
        n.clone(),
        Array(&size, &SQUARE),
        n.clone(),
        Array(&[3], &[0.0; 3]),
        Array(&[3], &[0.0; 3]),
        Array(&[9], &[0.0; 9]),
        Number(9.0),
        Number(-1.0),
    ];
    // Two numbers stand before the matrix.
    let factored = call("dgeqp3", &args).expect("factors").numbers;
    let (qr, pivots, taus) = (&factored[2..11], &factored[12..15], &factored[15..18]);
    let args = [
        n.clone(),
        n.clone(),
        n.clone(),
        Array(&size, qr),
        n.clone(),
        Array(&[3], taus),
        Array(&[9], &[0.0; 9]),
        Number(9.0),
        Number(-1.0),
    ];
    let q = call("dorgqr", &args).expect("a factor").numbers[3..12].to_vec();
    for (at, value) in product(3, &transposed(3, &q), &q).into_iter().enumerate() {
        near(value, f64::from(u8::from(at / 3 == at % 3)));
    }
    let r: Vec<f64> = (0..9).map(|at| if at / 3 > at % 3 { 0.0 } else { qr[at] }).collect();
    for (at, value) in product(3, &q, &r).into_iter().enumerate() {
        near(value, SQUARE[at / 3 * 3 + pivots[at % 3] as usize - 1]);
    }
    assert_eq!(pivots, [3.0, 2.0, 1.0]);
}

#[test]
fn a_hessenberg_form_is_similar_to_the_matrix() {
    let (size, n) = ([3usize, 3], Number(3.0));
    let work = [0.0; 9];
    let args = |matrix, taus| {
        let (n, work) = (n.clone(), Array(&[9], &work));
        [n.clone(), Number(1.0), n.clone(), matrix, n, taus, work, Number(9.0), Number(-1.0)]
    };
    let done = call("dgehrd", &args(Array(&size, &SQUARE), Array(&[2], &[0.0; 2])));
    let done = done.expect("a form").numbers;
    let (reduced, taus) = (&done[3..12], &done[13..15]);
    let q = call("dorghr", &args(Array(&size, reduced), Array(&[2], taus))).expect("a factor");
    let q = q.numbers[3..12].to_vec();
    let mut h = reduced.to_vec();
    h[6] = 0.0;
    let again = product(3, &product(3, &q, &h), &transposed(3, &q));
    again.into_iter().zip(SQUARE).for_each(|(value, expected)| near(value, expected));
}

#[test]
fn eigenvectors_belong_to_their_eigenvalues() {
    // A rotation with a real axis: one real eigenvalue and a pair.
    for matrix in [SQUARE, [0.0, -1.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 2.0]] {
        let zeros = [0.0; 9];
        let size = [3usize, 3];
        let args = [
            Text("N"),
            Text("V"),
            Number(3.0),
            Array(&size, &matrix),
            Number(3.0),
            Array(&[3], &zeros[..3]),
            Array(&[3], &zeros[..3]),
            Array(&size, &zeros),
            Number(3.0),
            Array(&size, &zeros),
            Number(3.0),
            Array(&[9], &zeros),
            Number(9.0),
            Number(-1.0),
        ];
        let done = call("dgeev", &args).expect("vectors").numbers;
        let (re, im, v) = (&done[11..14], &done[14..17], &done[27..36]);
        let av = product(3, &matrix, v);
        for j in 0..3 {
            for i in 0..3 {
                let (k, sign) = match im[j] {
                    0.0 => (j, 0.0),
                    positive if positive > 0.0 => (j + 1, -1.0),
                    _ => (j - 1, -1.0),
                };
                // A (x + i y) = (a + i b)(x + i y)
                near(av[i * 3 + j], re[j] * v[i * 3 + j] + sign * im[j] * v[i * 3 + k]);
            }
        }
        assert_eq!(*done.last().expect("a number"), 0.0);
    }
}

#[test]
fn norms_and_conditions_are_exact() {
    let size = [2usize, 2];
    let norm = |letter| {
        let args = [Text(letter), Number(2.0), Number(2.0), Array(&size, &[3.0, -4.0, 0.0, 12.0])];
        let args: Vec<Arg<'_>> =
            args.into_iter().chain([Number(2.0), Array(&[2], &[0.0; 2])]).collect();
        call("dlange", &args).expect("a norm").result
    };
    assert_eq!([norm("M"), norm("1"), norm("I"), norm("F")], [12.0, 16.0, 12.0, 13.0]);
}
