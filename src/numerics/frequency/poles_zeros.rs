//! Poles and zeros of linear systems ẋ = A x + Σ b_k u^(k), y = c x + Σ d_k u^(k), with derivatives of the
//! input. These are moved from the first equation into the second one, by x + b_k u^(k−1) in the place of x:
//!
//! ```text
//!   (s − A)⁻¹ b_k s^k = b_k s^(k−1) + (s − A)⁻¹ A b_k s^(k−1)
//! ```
//!
//! Where the highest derivative in y is not zero, y = 0 determines it, and the zeros are the poles of this
//! system. Else the zeros are the poles of the system that an input keeps at y = 0. Where d = 0, y is
//! differentiated until the input appears in it, after r times: what keeps y and its r − 1 derivatives at
//! zero leaves n − r directions to the states, in which A − b c Aʳ/(c Aʳ⁻¹ b) acts. So there are exactly
//! n − r zeros, and none at infinity that rounding would bring into sight.
//!
//! Reference: [isidori-1995](gapilib_base::bibliography#isidori-1995), section 4.3 (zero dynamics).

use nalgebra::linalg::{QR, Schur, balancing};
use nalgebra::{Complex, DMatrix, DVector, RowDVector};

/// A Markov parameter below this part of the size of its factors is zero: it is the sum of products
/// that cancel, with the rounding of each. Measured on ladders of 2 to 20 resistors and capacitors, whose
/// parameters that vanish are below 1e-15 of that size.
const VANISHES: f64 = 1e-12;
/// Sweeps of the QR algorithm for each eigenvalue, on average; it needs two or three.
const SWEEPS: usize = 100;

/// The eigenvalues of A, slowest first; `None` where the algorithm does not converge.
pub fn poles(a: &DMatrix<f64>) -> Option<Vec<Complex<f64>>> {
    if a.iter().any(|entry| !entry.is_finite()) {
        return None;
    }
    let n = a.nrows();
    if n == 0 {
        return Some(Vec::new());
    }
    let mut balanced = a.clone();
    balancing::balance_parlett_reinsch(&mut balanced);
    let schur = Schur::try_new(balanced, f64::EPSILON, SWEEPS * n)?;
    // What is as small as the rounding of the algorithm is zero.
    let rounding = f64::EPSILON * n as f64 * a.norm();
    let rounded =
        |s: &Complex<f64>| if s.norm_sqr().sqrt() <= rounding { Complex::default() } else { *s };
    let mut found: Vec<Complex<f64>> = schur.complex_eigenvalues().iter().map(rounded).collect();
    found.sort_by(|p, q| {
        let size = p.norm_sqr().total_cmp(&q.norm_sqr());
        size.then(p.re.total_cmp(&q.re)).then(p.im.total_cmp(&q.im))
    });
    Some(found)
}

/// The zeros from an input to an output, slowest first; `None` where the output does not answer to the
/// input at all. `b` and `d` are those of the input and of its derivatives, as many of each.
pub fn zeros(
    a: &DMatrix<f64>,
    mut b: Vec<DVector<f64>>,
    c: &RowDVector<f64>,
    mut d: Vec<f64>,
) -> Option<Vec<Complex<f64>>> {
    while b.len() > 1 {
        let moved = b.pop()?;
        let (at, through) = (b.len() - 1, (c * &moved)[0]);
        b[at] += a * &moved;
        let sum = d[at] + through;
        // A sum of parts that cancel is rounding.
        let size = d[at].abs().max(c.norm() * moved.norm());
        d[at] = if sum.abs() > VANISHES * size { sum } else { 0.0 };
    }
    let order = d.iter().rposition(|own| *own != 0.0).unwrap_or(0);
    match order {
        0 => proper_zeros(a, &b.pop()?, c, d[0]),
        order => poles(&held_by_derivative(a, &b.pop()?, c, &d[..=order])),
    }
}

/// The matrix of a system whose input keeps y at zero by its highest derivative: of x, u, …, u^(r−1).
fn held_by_derivative(
    a: &DMatrix<f64>,
    b: &DVector<f64>,
    c: &RowDVector<f64>,
    d: &[f64],
) -> DMatrix<f64> {
    let (n, r) = (a.nrows(), d.len() - 1);
    DMatrix::from_fn(n + r, n + r, |i, j| match (i < n, j < n) {
        (true, true) => a[(i, j)],
        (true, false) => {
            if j == n {
                b[i]
            } else {
                0.0
            }
        }
        (false, _) if i + 1 < n + r => f64::from(u8::from(j == i + 1)),
        (false, true) => -c[j] / d[r],
        (false, false) => -d[j - n] / d[r],
    })
}

fn proper_zeros(
    a: &DMatrix<f64>,
    b: &DVector<f64>,
    c: &RowDVector<f64>,
    d: f64,
) -> Option<Vec<Complex<f64>>> {
    let mut a = a.clone();
    let n = a.nrows();
    let scale = if n > 0 { balancing::balance_parlett_reinsch(&mut a) } else { DVector::zeros(0) };
    let (b, c) = (b.component_div(&scale), c.component_mul(&scale.transpose()));
    if d != 0.0 {
        return poles(&(a - b * c / d));
    }
    // Directions that y and its derivatives up to the one with the input leave free.
    let (mut row, mut rows) = (c, Vec::new());
    let of_input = loop {
        let markov = (&row * &b)[0];
        if markov.abs() > VANISHES * row.norm() * b.norm() {
            rows.push(row.clone());
            break markov;
        }
        if rows.len() == n || row.norm() == 0.0 {
            return None;
        }
        rows.push(row.clone());
        row = &row * &a;
    };
    let held = &a - &b * (&row * &a) / of_input;
    let columns: Vec<DVector<f64>> = rows.iter().map(|own| own.transpose().normalize()).collect();
    let mut basis = DMatrix::identity(n, n);
    QR::new(DMatrix::from_columns(&columns)).q_tr_mul(&mut basis);
    let free = basis.rows(rows.len(), n - rows.len());
    poles(&(free * held * free.transpose()))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The companion form of a numerator and a monic denominator, highest power first, n of each after
    /// the leading one.
    fn companion(numerator: &[f64], denominator: &[f64]) -> (DMatrix<f64>, [DVector<f64>; 2]) {
        let n = denominator.len();
        let a = DMatrix::from_fn(n, n, |i, j| match i {
            0 => -denominator[j],
            i => f64::from(u8::from(i == j + 1)),
        });
        let b = DVector::from_fn(n, |i, _| f64::from(u8::from(i == 0)));
        (a, [b, DVector::from_row_slice(numerator)])
    }

    fn assert_are(found: &[Complex<f64>], expected: &[[f64; 2]]) {
        assert_eq!(found.len(), expected.len(), "{found:?}");
        for (own, [re, im]) in found.iter().zip(expected) {
            let distance = (own - Complex::new(*re, *im)).norm();
            assert!(distance < 1e-9 * own.norm().max(1.0), "{found:?} {expected:?}");
        }
    }

    #[test]
    fn poles_and_zeros_are_the_roots_of_the_polynomials() {
        // (s + 3)/((s + 1) (s + 2) (s² + 2 s + 10)), in coordinates of very different sizes.
        let (a, [b, c]) = companion(&[0.0, 0.0, 1.0, 3.0], &[5.0, 18.0, 34.0, 20.0]);
        let t = DMatrix::from_diagonal(&DVector::from_row_slice(&[1.0, 1e4, 1e-5, 10.0]));
        let back = t.map(|v| if v == 0.0 { 0.0 } else { 1.0 / v });
        let a = &back * a * &t;
        let (b, c) = (&back * b, (c.transpose() * &t));
        let expected = [[-1.0, 0.0], [-2.0, 0.0], [-1.0, -3.0], [-1.0, 3.0]];
        assert_are(&poles(&a).unwrap(), &expected);
        assert_are(&zeros(&a, vec![b.clone()], &c, vec![0.0]).unwrap(), &[[-3.0, 0.0]]);
        // With d = 2 the numerator is 2 (…) + s + 3.
        let found = zeros(&a, vec![b.clone()], &c, vec![2.0]).unwrap();
        for s in &found {
            let value = (s + 1.0) * (s + 2.0) * (s * s + s * 2.0 + 10.0) * 2.0 + s + 3.0;
            assert!(value.norm() < 1e-7, "{s}: {value}");
        }
        assert_eq!(found.len(), 4);
    }

    /// y = x + u̇ with ẋ = −x + 2 u + 3 u̇ + ü: (s² + 3 s + 2)/(s + 1) + s, whose numerator is
    /// 2 s² + 4 s + 2; and the same without the last term, whose input in place of derivatives is
    /// proper: (s + 2)(s + 1)/(s + 1).
    #[test]
    fn derivatives_of_the_input_add_zeros() {
        let a = DMatrix::from_element(1, 1, -1.0);
        let one = |value: f64| DVector::from_element(1, value);
        let c = RowDVector::from_element(1, 1.0);
        let b = vec![one(2.0), one(3.0), one(1.0)];
        let found = zeros(&a, b.clone(), &c, vec![0.0, 1.0, 0.0]).unwrap();
        assert_eq!(found.len(), 2);
        for s in &found {
            assert!((s + 1.0).norm() < 1e-7, "{found:?}");
        }
        assert_are(&zeros(&a, b, &c, vec![0.0; 3]).unwrap(), &[[-1.0, 0.0], [-2.0, 0.0]]);
        // (2 + s)/(s + 1) − 1 = 1/(s + 1): what cancels is not a zero far away.
        let found = zeros(&a, vec![one(2.0), one(1.0)], &c, vec![-1.0, 0.0]).unwrap();
        assert_are(&found, &[]);
    }

    #[test]
    fn a_ladder_from_end_to_end_has_no_zero_and_from_its_begin_all() {
        let n = 20;
        let a = DMatrix::from_fn(n, n, |i, j| match i.abs_diff(j) {
            0 if i == n - 1 => -1.0,
            0 => -2.0,
            1 => 1.0,
            _ => 0.0,
        });
        let unit = |at: usize| DVector::from_fn(n, |i, _| f64::from(u8::from(i == at)));
        assert_eq!(zeros(&a, vec![unit(0)], &unit(n - 1).transpose(), vec![0.0]).unwrap(), []);
        // The zeros of the driving point are the poles of the ladder without its first rung.
        let found = zeros(&a, vec![unit(0)], &unit(0).transpose(), vec![0.0]).unwrap();
        let expected: Vec<[f64; 2]> = poles(&a.view((1, 1), (n - 1, n - 1)).into_owned())
            .unwrap()
            .iter()
            .map(|s| [s.re, s.im])
            .collect();
        assert_are(&found, &expected);
        assert_eq!(zeros(&a, vec![unit(0)], &(unit(0) * 0.0).transpose(), vec![0.0]), None);
    }
}
