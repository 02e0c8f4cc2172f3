//! The response of a linear system to oscillations of its input,
//!
//! ```text
//!   ẋ = f_x x + f_z z + f_u(s) u,  0 = g_x x + g_z z + g_u(s) u,  y = h_x x + h_z z + h_u(s) u
//!   H(s) = y/u at s = jω,  f_u(s) = Σ s^k f_k: the input and its derivatives
//! ```
//!
//! at many frequencies: z is eliminated, the rest is balanced (Parlett and Reinsch, 1969) and reduced
//! to Hessenberg form once, after which a frequency costs n² operations (Laub, 1981). One step of
//! iterative refinement with the entries as they are given makes up for what the reduction rounds.

mod poles_zeros;

pub use poles_zeros::{poles, zeros};

use nalgebra::linalg::{Hessenberg, balancing};
use nalgebra::{Complex, DMatrix, DVector, Dyn, LU};
use std::cell::OnceCell;

/// Real and imaginary part.
pub type Number = Complex<f64>;

/// A linear system, as the Jacobian of its equations.
#[derive(Debug, Clone)]
pub struct LinearSystem {
    /// Number of rows that have a derivative on their left side; they come first.
    pub n_states: usize,
    /// n + 1 rows: those of the n unknowns, then that of the output. Columns: the n unknowns, then the
    /// input and its derivatives.
    pub jacobian: DMatrix<f64>,
}

impl LinearSystem {
    /// Number of unknowns.
    pub fn n(&self) -> usize {
        self.jacobian.nrows() - 1
    }
}

/// A linear system, ready to be evaluated at frequencies.
pub struct Response<'a> {
    system: &'a LinearSystem,
    /// Hessenberg matrix T⁻¹ A T of the system without algebraic unknowns.
    reduced: DMatrix<f64>,
    plain: Direction,
    /// Made where derivatives are asked for.
    transposed: OnceCell<Direction>,
}

/// What solving the system, or the transposed one, takes.
struct Direction {
    is_transposed: bool,
    /// A = [f_x, f_z; g_x, g_z].
    whole: DMatrix<f64>,
    /// f_z and g_x.
    coupling: [DMatrix<f64>; 2],
    /// g_z.
    algebraic: LU<f64, Dyn, Dyn>,
    /// T⁻¹ and T.
    change: [DMatrix<f64>; 2],
}

/// The response at a frequency.
pub struct Point {
    /// H(jω).
    pub value: Number,
    /// The unknowns, then the input and its derivatives, where the input is 1.
    right: Vec<Number>,
    /// By equation, how the output answers to a residual; 1 for its own.
    left: Vec<Number>,
}

impl Point {
    /// The derivative of H by an entry of the Jacobian.
    pub fn by_entry(&self, row: usize, column: usize) -> Number {
        self.left[row] * self.right[column]
    }
}

impl<'a> Response<'a> {
    /// Prepares a system; `None` where its algebraic equations are singular or an entry is not finite.
    pub fn new(system: &'a LinearSystem) -> Option<Response<'a>> {
        let (n, m) = (system.n(), system.n_states);
        if system.jacobian.iter().any(|entry| !entry.is_finite()) {
            return None;
        }
        let whole = system.jacobian.view((0, 0), (n, n)).into_owned();
        let change = [DMatrix::identity(m, m), DMatrix::identity(m, m)];
        let mut plain = Direction::new(false, whole.clone(), m, change);
        if !plain.algebraic.is_invertible() {
            return None;
        }
        let [f_z, g_x] = &plain.coupling;
        let z_of_x = if n == m { g_x.clone() } else { plain.algebraic.solve(g_x)? };
        let mut reduced = whole.view((0, 0), (m, m)) - f_z * z_of_x;
        if reduced.iter().any(|entry| !entry.is_finite()) {
            return None;
        }
        if m > 1 {
            let scale = balancing::balance_parlett_reinsch(&mut reduced);
            let (q, h) = Hessenberg::new(reduced).unpack();
            reduced = h;
            let from_states = q.transpose() * DMatrix::from_diagonal(&scale.map(|d| 1.0 / d));
            let to_states = DMatrix::from_diagonal(&scale) * q;
            plain.change = [from_states, to_states];
        }
        Some(Response { system, reduced, plain, transposed: OnceCell::new() })
    }

    /// H at s = jω; `None` at a pole.
    pub fn value(&self, omega: f64) -> Option<Number> {
        let s = Number::new(0.0, omega);
        let (value, _) = self.solved(&Factors::new(&self.reduced, s)?, s)?;
        Some(value)
    }

    /// H and its derivatives at s = jω; `None` at a pole.
    pub fn at(&self, omega: f64) -> Option<Point> {
        let s = Number::new(0.0, omega);
        let n = self.system.n();
        let factors = Factors::new(&self.reduced, s)?;
        let (value, right) = self.solved(&factors, s)?;
        let output = DVector::from_fn(n, |column, _| self.system.jacobian[(n, column)].into());
        let transposed = self.transposed.get_or_init(|| self.plain.transposed());
        let mut left: Vec<Number> =
            transposed.refined(&factors, s, &output)?.iter().copied().collect();
        left.push(1.0.into());
        Some(Point { value, right, left })
    }

    /// H, and the unknowns with the input and its derivatives.
    fn solved(&self, factors: &Factors, s: Number) -> Option<(Number, Vec<Number>)> {
        let n = self.system.n();
        let orders = self.system.jacobian.ncols() - n;
        let input: Vec<Number> = (0..orders).map(|k| s.powu(k as u32)).collect();
        let forced = DVector::from_fn(n, |row, _| {
            let of = |(k, u): (usize, &Number)| u * self.system.jacobian[(row, n + k)];
            input.iter().enumerate().map(of).sum::<Number>()
        });
        let mut right: Vec<Number> =
            self.plain.refined(factors, s, &forced)?.iter().copied().collect();
        right.extend(input);
        let last = self.system.jacobian.row(n);
        let value = last.iter().zip(&right).map(|(entry, v)| v * *entry).sum();
        Some((value, right))
    }
}

impl Direction {
    fn new(
        is_transposed: bool,
        whole: DMatrix<f64>,
        m: usize,
        change: [DMatrix<f64>; 2],
    ) -> Direction {
        let n = whole.nrows();
        let f_z = whole.view((0, m), (m, n - m)).into_owned();
        let g_x = whole.view((m, 0), (n - m, m)).into_owned();
        let algebraic = whole.view((m, m), (n - m, n - m)).into_owned().lu();
        Direction { is_transposed, whole, coupling: [f_z, g_x], algebraic, change }
    }

    /// What solving the transposed system takes.
    fn transposed(&self) -> Direction {
        let [from_states, to_states] = &self.change;
        let change = [to_states.transpose(), from_states.transpose()];
        Direction::new(true, self.whole.transpose(), from_states.nrows(), change)
    }

    /// The solution of (s E − A) v = b after a step of refinement.
    fn refined(
        &self,
        factors: &Factors,
        s: Number,
        b: &DVector<Number>,
    ) -> Option<DVector<Number>> {
        let first = self.solved(factors, b)?;
        let mut residual = b + times(&self.whole, &first);
        for i in 0..self.coupling[0].nrows() {
            residual[i] -= s * first[i];
        }
        let better = &first + self.solved(factors, &residual)?;
        let is_finite = |v: &Number| v.re.is_finite() && v.im.is_finite();
        better.iter().all(is_finite).then_some(better)
    }

    fn solved(&self, factors: &Factors, b: &DVector<Number>) -> Option<DVector<Number>> {
        let [f_z, g_x] = &self.coupling;
        let (n, m) = (b.len(), f_z.nrows());
        // 0 = -b_z − g_x x − g_z z
        let z_of = |right: DVector<Number>| match n - m {
            0 => Some(right),
            _ => {
                let [re, im] = [right.map(|v| v.re), right.map(|v| v.im)];
                let (re, im) = (self.algebraic.solve(&re)?, self.algebraic.solve(&im)?);
                Some(re.zip_map(&im, Number::new))
            }
        };
        let (b_x, b_z) = (b.rows(0, m).into_owned(), b.rows(m, n - m).into_owned());
        let b_x = b_x - times(f_z, &z_of(b_z.clone())?);
        let mut x = times(&self.change[0], &b_x);
        match self.is_transposed {
            true => factors.solve_transposed(&mut x),
            false => factors.solve(&mut x),
        }
        let x = times(&self.change[1], &x);
        let z = z_of(-(b_z + times(g_x, &x)))?;
        Some(DVector::from_fn(n, |i, _| if i < m { x[i] } else { z[i - m] }))
    }
}

fn times(matrix: &DMatrix<f64>, v: &DVector<Number>) -> DVector<Number> {
    let [re, im] = [v.map(|v| v.re), v.map(|v| v.im)];
    (matrix * re).zip_map(&(matrix * im), Number::new)
}

/// s I − H of a Hessenberg matrix, factorized with partial pivoting.
struct Factors {
    upper: DMatrix<Number>,
    /// By column: the multiplier of the row below, and whether both rows were exchanged.
    steps: Vec<(Number, bool)>,
}

impl Factors {
    fn new(hessenberg: &DMatrix<f64>, s: Number) -> Option<Factors> {
        let n = hessenberg.nrows();
        let mut upper = DMatrix::from_fn(n, n, |i, j| match i <= j + 1 {
            true => (if i == j { s } else { Number::default() }) - hessenberg[(i, j)],
            false => Number::default(),
        });
        let mut steps = Vec::with_capacity(n);
        for k in 0..n.saturating_sub(1) {
            let exchanged = upper[(k + 1, k)].norm_sqr() > upper[(k, k)].norm_sqr();
            if exchanged {
                upper.swap_rows(k, k + 1);
            }
            let pivot = upper[(k, k)];
            let factor = match pivot == Number::default() {
                true => return None,
                false => upper[(k + 1, k)] / pivot,
            };
            for j in k..n {
                let above = upper[(k, j)];
                upper[(k + 1, j)] -= factor * above;
            }
            steps.push((factor, exchanged));
        }
        let is_singular = n > 0 && upper[(n - 1, n - 1)] == Number::default();
        (!is_singular).then_some(Factors { upper, steps })
    }

    fn solve(&self, b: &mut DVector<Number>) {
        for (k, (factor, exchanged)) in self.steps.iter().enumerate() {
            if *exchanged {
                b.swap_rows(k, k + 1);
            }
            let above = b[k];
            b[k + 1] -= factor * above;
        }
        for i in (0..b.len()).rev() {
            let rest: Number = (i + 1..b.len()).map(|j| self.upper[(i, j)] * b[j]).sum();
            b[i] = (b[i] - rest) / self.upper[(i, i)];
        }
    }

    fn solve_transposed(&self, b: &mut DVector<Number>) {
        for i in 0..b.len() {
            let rest: Number = (0..i).map(|j| self.upper[(j, i)] * b[j]).sum();
            b[i] = (b[i] - rest) / self.upper[(i, i)];
        }
        for (k, (factor, exchanged)) in self.steps.iter().enumerate().rev() {
            let below = b[k + 1];
            b[k] -= factor * below;
            if *exchanged {
                b.swap_rows(k, k + 1);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn system(n_states: usize, n: usize, orders: usize, entries: &[f64]) -> LinearSystem {
        LinearSystem { n_states, jacobian: DMatrix::from_row_slice(n + 1, n + orders, entries) }
    }

    fn assert_near(actual: Number, expected: Number) {
        assert!(
            (actual - expected).norm() <= 1e-12 * expected.norm(),
            "{actual} is not {expected}"
        );
    }

    /// z = (R₁ + L s) u + x, C ẋ = u − x/R₂, written with an algebraic unknown for the current of R₂.
    #[test]
    fn a_circuit_with_an_algebraic_unknown_has_the_impedance_of_its_formula() {
        let (r1, r2, c, l) = (0.1, 2.0, 1e-3, 1e-6);
        #[rustfmt::skip]
        let system = system(1, 2, 2, &[
            0.0, -1.0 / c, 1.0 / c, 0.0,
            1.0, -r2, 0.0, 0.0,
            1.0, 0.0, r1, l,
        ]);
        let response = Response::new(&system).unwrap();
        for omega in [1e-6, 1.0, 500.0, 1e7] {
            let s = Number::new(0.0, omega);
            let point = response.at(omega).unwrap();
            assert_near(point.value, r1 + l * s + 1.0 / (1.0 / r2 + c * s));
            assert_eq!(response.value(omega), Some(point.value));
            // by R₁, by L, and by R₂ through the entry −R₂ of the algebraic equation
            assert_near(point.by_entry(2, 2), 1.0.into());
            assert_near(point.by_entry(2, 3), s);
            let parallel = 1.0 / (1.0 / r2 + c * s);
            assert_near(-point.by_entry(1, 1), parallel * parallel / (r2 * r2));
        }
    }

    /// The diffusion of 100 volumes whose coefficients span ten decades, against the continued fraction of
    /// its ladder. Sums of entries lose digits, so that it is as exact as these are.
    #[test]
    fn a_ladder_with_scales_of_many_decades_is_exact() {
        let n = 100;
        let power =
            |first: f64, decades: f64, k: i32| 10f64.powf(first + decades * f64::from(k) / 99.0);
        let r: Vec<f64> = (0..n).map(|k| power(-2.0, 4.0, k)).collect();
        let c: Vec<f64> = (0..n).map(|k| power(0.0, -6.0, k)).collect();
        let n = n as usize;
        let mut jacobian = DMatrix::zeros(n + 1, n + 1);
        for k in 0..n {
            // Cₖ v̇ₖ = (vₖ₋₁ − vₖ)/Rₖ₋₁ − (vₖ − vₖ₊₁)/Rₖ, the last resistance to ground
            if k > 0 {
                jacobian[(k, k - 1)] += 1.0 / (r[k - 1] * c[k]);
                jacobian[(k, k)] -= 1.0 / (r[k - 1] * c[k]);
            }
            jacobian[(k, k)] -= 1.0 / (r[k] * c[k]);
            if k + 1 < n {
                jacobian[(k, k + 1)] += 1.0 / (r[k] * c[k]);
            }
        }
        jacobian[(0, n)] = 1.0 / c[0];
        jacobian[(n, 0)] = 1.0;
        let system = LinearSystem { n_states: n, jacobian };
        let response = Response::new(&system).unwrap();
        for omega in [1e-6, 1e-3, 1.0, 1e3, 1e6] {
            let s = Number::new(0.0, omega);
            let mut z = Number::default();
            for k in (0..n).rev() {
                z = 1.0 / (c[k] * s + 1.0 / (r[k] + z));
            }
            let found = response.at(omega).unwrap().value;
            assert!((found - z).norm() <= 1e-10 * z.norm(), "{omega}: {found} is not {z}");
        }
    }

    #[test]
    fn a_pole_and_singular_equations_have_no_response() {
        let integrator = system(1, 1, 1, &[0.0, 1.0, 1.0, 0.0]);
        assert!(Response::new(&integrator).unwrap().at(0.0).is_none());
        let singular = system(0, 1, 1, &[0.0, 1.0, 1.0, 0.0]);
        assert!(Response::new(&singular).is_none());
    }
}
