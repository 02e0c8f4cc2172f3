//! Solutions of linear systems with constant coefficients, over one step:
//!
//! ```text
//! x' = A x + b + c t      x(h) = x + E x + G b + H c
//! E = exp(A h) − I,   G = ∫₀ʰ exp(A s) ds,   H = ∫₀ʰ exp(A (h − s)) s ds
//! ```
//!
//! Scaling and squaring of their Taylor series: with those of a step of h the step of 2h has
//! 2E + E², G + (I + E) G and H + (I + E) H + h G. E, not exp(A h), is squared: what changes slowly
//! keeps its digits beside what changes fast. G and H need no inverse of A. The derivatives along a
//! change of A go through the same recursion (Fréchet derivatives).
//!
//! References: [Van Loan 1978](gapilib_base::bibliography#van-loan-1978),
//! [Al-Mohy & Higham 2009](gapilib_base::bibliography#al-mohy-higham-2009).

use nalgebra::DMatrix;

/// The series is used where the norm of A h is not larger: then this many terms leave less than
/// rounding.
const LARGEST_NORM: f64 = 0.5;
const TERMS: i32 = 15;

/// E, G and H of a step, or their derivatives.
#[derive(Debug, Clone)]
pub(super) struct Blocks {
    pub(super) e: DMatrix<f64>,
    pub(super) g: DMatrix<f64>,
    pub(super) h: DMatrix<f64>,
}

impl Blocks {
    fn zero(n: usize) -> Blocks {
        let zero = DMatrix::zeros(n, n);
        Blocks { e: zero.clone(), g: zero.clone(), h: zero }
    }

    fn add_term(&mut self, term: &DMatrix<f64>, k: i32, step: f64) {
        let k = f64::from(k);
        self.g += term * (step / (k + 1.0));
        self.h += term * (step * step / ((k + 1.0) * (k + 2.0)));
        if k > 0.0 {
            self.e += term;
        }
    }
}

/// What a step of one length does.
#[derive(Debug, Clone)]
pub(super) struct Propagator {
    pub(super) length: f64,
    pub(super) blocks: Blocks,
    /// The derivatives, one for each change of A.
    pub(super) derivatives: Vec<Blocks>,
}

/// The largest sum of absolute values in a column.
pub(super) fn norm(a: &DMatrix<f64>) -> f64 {
    let sums = a.column_iter().map(|column| column.iter().map(|entry| entry.abs()).sum::<f64>());
    sums.fold(0.0, f64::max)
}

impl Propagator {
    /// For a step of x' = A x + b + c t, with the derivatives along these changes of A.
    pub(super) fn new(a: &DMatrix<f64>, changes: &[DMatrix<f64>], length: f64) -> Propagator {
        let mut halvings = 0;
        let mut step = length;
        while norm(a) * step > LARGEST_NORM && halvings < 1100 {
            step *= 0.5;
            halvings += 1;
        }
        let mut propagator = Propagator::series(a, changes, step);
        for _ in 0..halvings {
            propagator.double();
        }
        propagator.length = length;
        propagator
    }

    fn series(a: &DMatrix<f64>, changes: &[DMatrix<f64>], length: f64) -> Propagator {
        let n = a.nrows();
        let scaled = a * length;
        let changes: Vec<DMatrix<f64>> = changes.iter().map(|change| change * length).collect();
        let mut term = DMatrix::identity(n, n);
        let mut of_changes = vec![DMatrix::zeros(n, n); changes.len()];
        let mut blocks = Blocks::zero(n);
        let mut derivatives = vec![Blocks::zero(n); changes.len()];
        blocks.add_term(&term, 0, length);
        for k in 1..=TERMS {
            for ((change, of_change), out) in
                changes.iter().zip(&mut of_changes).zip(&mut derivatives)
            {
                *of_change = (change * &term + &scaled * &*of_change) / f64::from(k);
                out.add_term(of_change, k, length);
            }
            term = (&scaled * &term) / f64::from(k);
            blocks.add_term(&term, k, length);
        }
        Propagator { length, blocks, derivatives }
    }

    /// Makes the step twice as long.
    fn double(&mut self) {
        let Blocks { e, g, h } = &self.blocks;
        for of in &mut self.derivatives {
            let square = &of.e * e + e * &of.e;
            let new_g = &of.g * 2.0 + &of.e * g + e * &of.g;
            of.h = &of.h * 2.0 + &of.e * h + e * &of.h + &of.g * self.length;
            of.g = new_g;
            of.e = &of.e * 2.0 + square;
        }
        let new_e = e * 2.0 + e * e;
        let new_g = g * 2.0 + e * g;
        let new_h = h * 2.0 + e * h + g * self.length;
        self.blocks = Blocks { e: new_e, g: new_g, h: new_h };
        self.length *= 2.0;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// x after a step, from x, b and c.
    fn after(a: &DMatrix<f64>, h: f64, [x, b, c]: [&[f64]; 3]) -> Vec<f64> {
        let p = Propagator::new(a, &[], h).blocks;
        let [x, b, c] = [x, b, c].map(|v| DMatrix::from_column_slice(v.len(), 1, v));
        let x = &x + &p.e * &x + &p.g * b + &p.h * c;
        x.as_slice().to_vec()
    }

    #[test]
    fn one_state_has_the_exact_solution() {
        // x' = −x/τ + b + c t, from relaxations much longer than the step to much shorter ones.
        for tau in [1e-9, 1e-3, 0.7, 12.0, 1e6] {
            let (h, b, c) = (3.0, 2.0, -0.5);
            let a = DMatrix::from_element(1, 1, -1.0 / tau);
            let x = after(&a, h, [&[4.0], &[b], &[c]])[0];
            let decay = (-h / tau).exp();
            let held = -tau * (-h / tau).exp_m1();
            // For slow relaxation h − held cancels: the series there.
            let cubic = h.powi(3) / (6.0 * tau);
            let series = h * h / 2.0 - cubic + h.powi(4) / (24.0 * tau * tau);
            let rising = if tau > 1e3 { series } else { tau * (h - held) };
            let exact = 4.0 * decay + b * held + c * rising;
            assert!((x - exact).abs() <= 1e-13 * exact.abs().max(1.0), "{tau}: {x} {exact}");
        }
    }

    #[test]
    fn chains_of_integrators_have_polynomials() {
        // x''' = c t: powers of h without an error but rounding.
        let a = DMatrix::from_row_slice(3, 3, &[0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0]);
        let h: f64 = 7.0;
        let x = after(&a, h, [&[1.0, 2.0, 3.0], &[0.0; 3], &[0.0, 0.0, 0.5]]);
        let exact = [
            1.0 + 2.0 * h + 1.5 * h * h + 0.5 * h.powi(4) / 24.0,
            2.0 + 3.0 * h + 0.5 * h.powi(3) / 6.0,
            3.0 + 0.25 * h * h,
        ];
        for (x, exact) in x.iter().zip(exact) {
            assert!((x - exact).abs() <= 1e-13 * exact.abs(), "{x} {exact}");
        }
    }

    #[test]
    fn slow_modes_keep_their_digits_beside_fast_ones() {
        // Two modes whose rates differ by 1e6, in coordinates of their own and mixed ones.
        let (fast, slow, h): (f64, f64, f64) = (1e6, 1.0, 0.5);
        let a = DMatrix::from_row_slice(2, 2, &[-fast, 0.0, 0.0, -slow]);
        let x = after(&a, h, [&[1.0, 1.0], &[0.0; 2], &[0.0; 2]]);
        assert!((x[1] - (-slow * h).exp()).abs() <= 1e-14, "{}", x[1]);
        let (c, s) = (0.6, 0.8);
        let rotation = DMatrix::from_row_slice(2, 2, &[c, -s, s, c]);
        let mixed = &rotation * a * rotation.transpose();
        let x = after(&mixed, h, [&[1.0, 0.0], &[0.0; 2], &[0.0; 2]]);
        let decay = (-slow * h).exp();
        // A itself is known to rounding of its large entries alone.
        assert!((x[0] - s * s * decay).abs() <= 1e-9, "{}", x[0]);
    }

    #[test]
    fn an_oscillator_turns_around() {
        let omega: f64 = 40.0;
        let a = DMatrix::from_row_slice(2, 2, &[0.0, 1.0, -omega * omega, 0.0]);
        for h in [1e-3, 0.1, 3.0] {
            let x = after(&a, h, [&[1.0, 0.0], &[0.0; 2], &[0.0; 2]]);
            assert!((x[0] - (omega * h).cos()).abs() < 1e-10, "{h}");
            assert!((x[1] + omega * (omega * h).sin()).abs() < 1e-10 * omega, "{h}");
        }
    }

    #[test]
    fn derivatives_are_those_of_difference_quotients() {
        let a = DMatrix::from_row_slice(3, 3, &[-3.0, 1.0, 0.5, 2.0, -7.0, 0.0, 1.0, 4.0, 0.0]);
        let change = DMatrix::from_row_slice(3, 3, &[0.3, -1.0, 0.0, 0.7, 0.2, 0.0, 0.0, 1.1, 0.0]);
        for h in [0.01, 0.4, 2.5] {
            let at = Propagator::new(&a, std::slice::from_ref(&change), h);
            let d = 1e-5;
            let moved = |sign: f64| Propagator::new(&(&a + &change * (sign * d)), &[], h).blocks;
            let (up, down) = (moved(1.0), moved(-1.0));
            let quotient = |up: &DMatrix<f64>, down: &DMatrix<f64>| (up - down) / (2.0 * d);
            let exact = &at.derivatives[0];
            for (exact, quotient) in [
                (&exact.e, quotient(&up.e, &down.e)),
                (&exact.g, quotient(&up.g, &down.g)),
                (&exact.h, quotient(&up.h, &down.h)),
            ] {
                assert!((exact - &quotient).amax() <= 1e-7 * quotient.amax(), "{h}");
            }
        }
    }
}
