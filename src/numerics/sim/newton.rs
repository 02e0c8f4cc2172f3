//! Newton's method with damping for small nonlinear systems F(x) = 0.
//!
//! ```text
//! Δ = −J(x)⁻¹ F(x)
//! λ = 1, halved until ‖J(x)⁻¹ F(x + λ Δ)‖ ≤ (1 − λ/2) ‖Δ‖
//! x += λ Δ
//! ```
//!
//! The test compares steps, not residuals: it does not depend on how the equations are scaled. Norms
//! are relative to max(|x|, nominal).
//!
//! Reference: [Deuflhard 2011](gapilib_base::bibliography#deuflhard-2011).

use super::norm::{set_weights, weighted_rms};
use super::{DenseLu, Factorization, Failure, Pattern};

/// The system that Newton's method solves.
pub trait Equations {
    /// Writes F(x).
    fn residual(&mut self, x: &[f64], out: &mut [f64]) -> Result<(), Failure>;
    /// Writes ∂F/∂x by columns.
    fn jacobian(&mut self, x: &[f64], out: &mut [f64]) -> Result<(), Failure>;
    /// Writes the entries of ∂F/∂x that a pattern has, in its order.
    fn nonzeros(&mut self, x: &[f64], pattern: &Pattern, out: &mut [f64]) -> Result<(), Failure> {
        let mut all = vec![0.0; pattern.n * pattern.n];
        self.jacobian(x, &mut all)?;
        gather(&all, pattern, out);
        Ok(())
    }
}

/// Writes the entries of a dense matrix that a pattern has.
pub fn gather(matrix: &[f64], pattern: &Pattern, out: &mut [f64]) {
    for column in 0..pattern.n {
        for at in pattern.column(column) {
            out[at] = matrix[column * pattern.n + pattern.rows[at]];
        }
    }
}

/// Why there is no solution.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum NewtonFailure {
    /// An evaluation failed where no shorter step could avoid it.
    Evaluation(Failure),
    /// The Jacobian is singular.
    Singular,
    /// No step, however short, came nearer to a solution, or there were too many.
    NoProgress,
}

/// Iterations until the attempt is given up.
const MAX_ITERATIONS: usize = 100;
/// Iterations without damping.
const MAX_LEAPS: usize = 30;
/// Shortest part of a step.
const SMALLEST_DAMPING: f64 = 1e-4;
/// A step shorter than this, relative to x, is the last; the error after it is about its square.
const LAST_STEP: f64 = 1e-9;

/// From this size on a Jacobian with few nonzeros is factorised as a sparse matrix. A network of 763
/// unknowns takes 20 times longer with a dense one; small loops keep their digits.
const SPARSE_FROM: usize = 64;

/// The Jacobian and its factors.
#[derive(Debug, Clone)]
enum Linear {
    Dense(DenseLu),
    Sparse { pattern: Pattern, values: Vec<f64>, factors: Box<Factorization> },
}

/// The workspace for systems of one size.
#[derive(Debug, Clone)]
pub struct Newton {
    linear: Linear,
    delta: Vec<f64>,
    residual: Vec<f64>,
    next_delta: Vec<f64>,
    trial: Vec<f64>,
    weights: Vec<f64>,
}

impl Newton {
    /// For n equations.
    pub fn new(n: usize) -> Newton {
        Newton::with(n, Linear::Dense(DenseLu::new(n)))
    }

    /// For equations whose Jacobian has this pattern.
    pub fn of_pattern(pattern: Pattern) -> Newton {
        let n = pattern.n;
        if n < SPARSE_FROM {
            return Newton::new(n);
        }
        let factors = Box::new(Factorization::new(&pattern, &[]));
        let values = vec![0.0; pattern.rows.len()];
        Newton::with(n, Linear::Sparse { pattern, values, factors })
    }

    fn with(n: usize, linear: Linear) -> Newton {
        let zeros = vec![0.0; n];
        Newton {
            linear,
            delta: zeros.clone(),
            residual: zeros.clone(),
            next_delta: zeros.clone(),
            trial: zeros.clone(),
            weights: zeros,
        }
    }

    /// A new simulation begins: it is to give the same bits whatever was solved before.
    pub fn forget(&mut self) {
        if let Linear::Sparse { factors, .. } = &mut self.linear {
            factors.forget();
        }
    }

    /// Improves x until it solves the system; `nominal` holds typical magnitudes of x, positive.
    /// On failure x is the last iterate.
    pub fn solve(
        &mut self,
        equations: &mut dyn Equations,
        x: &mut [f64],
        nominal: &[f64],
    ) -> Result<(), NewtonFailure> {
        self.iterate(equations, x, nominal, MAX_ITERATIONS, true)
    }

    /// The same with λ = 1 always: from one straight piece of a function to another, however far
    /// they lie from each other between.
    pub fn solve_undamped(
        &mut self,
        equations: &mut dyn Equations,
        x: &mut [f64],
        nominal: &[f64],
    ) -> Result<(), NewtonFailure> {
        self.iterate(equations, x, nominal, MAX_LEAPS, false)
    }

    fn iterate(
        &mut self,
        equations: &mut dyn Equations,
        x: &mut [f64],
        nominal: &[f64],
        iterations: usize,
        is_damped: bool,
    ) -> Result<(), NewtonFailure> {
        evaluate(equations, x, &mut self.delta)?;
        for _ in 0..iterations {
            self.linear.factorize(equations, x)?;
            self.linear.solve(&mut self.delta);
            set_weights(1.0, x, nominal, &mut self.weights);
            let length = weighted_rms(&self.delta, &self.weights);
            if !length.is_finite() {
                return Err(NewtonFailure::NoProgress);
            }
            if length <= LAST_STEP {
                x.iter_mut().zip(&self.delta).for_each(|(x, delta)| *x -= delta);
                return Ok(());
            }
            if is_damped {
                self.advance(equations, x, length)?;
            } else {
                x.iter_mut().zip(&self.delta).for_each(|(x, delta)| *x -= delta);
                evaluate(equations, x, &mut self.delta)?;
            }
        }
        Err(NewtonFailure::NoProgress)
    }

    /// Makes a step as long as it helps; `delta` holds the residual at the new x afterwards.
    fn advance(
        &mut self,
        equations: &mut dyn Equations,
        x: &mut [f64],
        length: f64,
    ) -> Result<(), NewtonFailure> {
        let mut damping = 1.0;
        loop {
            for ((trial, x), delta) in self.trial.iter_mut().zip(x.iter()).zip(&self.delta) {
                *trial = x - damping * delta;
            }
            let failure = match evaluate(equations, &self.trial, &mut self.residual) {
                Ok(()) => {
                    self.next_delta.copy_from_slice(&self.residual);
                    self.linear.solve(&mut self.next_delta);
                    let next = weighted_rms(&self.next_delta, &self.weights);
                    if next <= (1.0 - 0.5 * damping) * length {
                        x.copy_from_slice(&self.trial);
                        self.delta.copy_from_slice(&self.residual);
                        return Ok(());
                    }
                    NewtonFailure::NoProgress
                }
                Err(failure) => failure,
            };
            damping *= 0.5;
            if damping < SMALLEST_DAMPING {
                return Err(failure);
            }
        }
    }
}

impl Linear {
    /// Factorises the Jacobian at x.
    fn factorize(&mut self, equations: &mut dyn Equations, x: &[f64]) -> Result<(), NewtonFailure> {
        let factorized = match self {
            Linear::Dense(lu) => {
                equations.jacobian(x, lu.matrix()).map_err(NewtonFailure::Evaluation)?;
                lu.factorize()
            }
            Linear::Sparse { pattern, values, factors } => {
                equations.nonzeros(x, pattern, values).map_err(NewtonFailure::Evaluation)?;
                factors.factorize(values)
            }
        };
        factorized.map_err(|_| NewtonFailure::Singular)
    }

    fn solve(&mut self, b: &mut [f64]) {
        match self {
            Linear::Dense(lu) => lu.solve(b),
            Linear::Sparse { factors, .. } => factors.solve(b),
        }
    }
}

/// The residual, which must be finite.
fn evaluate(
    equations: &mut dyn Equations,
    x: &[f64],
    out: &mut [f64],
) -> Result<(), NewtonFailure> {
    equations.residual(x, out).map_err(NewtonFailure::Evaluation)?;
    let finite = out.iter().all(|value| value.is_finite());
    if finite { Ok(()) } else { Err(NewtonFailure::NoProgress) }
}

#[cfg(test)]
mod tests {
    /// 0 = u - x + saturated(1e4 x): where u passes a bound, the solution jumps.
    struct Trigger(f64);

    impl Equations for Trigger {
        fn residual(&mut self, x: &[f64], out: &mut [f64]) -> Result<(), Failure> {
            out[0] = self.0 - x[0] + (1e4 * x[0]).clamp(-1.0, 1.0);
            Ok(())
        }

        fn jacobian(&mut self, x: &[f64], out: &mut [f64]) -> Result<(), Failure> {
            out[0] = if x[0].abs() < 1e-4 { 1e4 - 1.0 } else { -1.0 };
            Ok(())
        }
    }

    #[test]
    fn a_solution_on_another_piece_is_reached_without_damping() {
        let mut newton = Newton::new(1);
        let mut x = [-0.5];
        assert!(newton.solve(&mut Trigger(1.5), &mut x, &[1.0]).is_err());
        x = [-0.5];
        newton.solve_undamped(&mut Trigger(1.5), &mut x, &[1.0]).unwrap();
        assert!((x[0] - 2.5).abs() < 1e-12, "{}", x[0]);
    }

    use super::*;

    /// Equations and their Jacobian as functions.
    struct Given(fn(&[f64], &mut [f64]), fn(&[f64], &mut [f64]));

    impl Equations for Given {
        fn residual(&mut self, x: &[f64], out: &mut [f64]) -> Result<(), Failure> {
            self.0(x, out);
            Ok(())
        }

        fn jacobian(&mut self, x: &[f64], out: &mut [f64]) -> Result<(), Failure> {
            self.1(x, out);
            Ok(())
        }
    }

    fn solved(mut given: Given, start: &[f64]) -> Result<Vec<f64>, NewtonFailure> {
        let mut x = start.to_vec();
        let nominal = vec![1.0; x.len()];
        Newton::new(x.len()).solve(&mut given, &mut x, &nominal).map(|()| x)
    }

    #[test]
    fn a_sparse_jacobian_gives_the_solution_of_a_dense_one() {
        // A chain: exp(x_i) + x_i + 0.2 sin(x_{i-1}) + 0.3 sin(x_{i+1}) = i / n.
        const N: usize = 80;
        let given = || {
            Given(
                |x, f| {
                    for i in 0..N {
                        let before = if i > 0 { 0.2 * x[i - 1].sin() } else { 0.0 };
                        let after = if i + 1 < N { 0.3 * x[i + 1].sin() } else { 0.0 };
                        f[i] = x[i].exp() + x[i] + before + after - i as f64 / N as f64;
                    }
                },
                |x, j| {
                    j.fill(0.0);
                    for i in 0..N {
                        j[i * N + i] = x[i].exp() + 1.0;
                        if i > 0 {
                            j[(i - 1) * N + i] = 0.2 * x[i - 1].cos();
                        }
                        if i + 1 < N {
                            j[(i + 1) * N + i] = 0.3 * x[i + 1].cos();
                        }
                    }
                },
            )
        };
        let rows = |column: usize| column.saturating_sub(1)..(column + 2).min(N);
        let starts = (0..N).scan(0, |sum, column| {
            *sum += rows(column).len();
            Some(*sum)
        });
        let column_starts = std::iter::once(0).chain(starts).collect();
        let pattern = Pattern { n: N, column_starts, rows: (0..N).flat_map(rows).collect() };
        let mut newton = Newton::of_pattern(pattern);
        assert!(matches!(newton.linear, Linear::Sparse { .. }));
        let mut x = vec![0.0; N];
        newton.solve(&mut given(), &mut x, &[1.0; N]).unwrap();
        let dense = solved(given(), &[0.0; N]).unwrap();
        assert!(x.iter().zip(&dense).all(|(a, b)| (a - b).abs() < 1e-14), "{x:?}");
        let mut residual = vec![0.0; N];
        given().residual(&x, &mut residual).unwrap();
        assert!(residual.iter().all(|r| r.abs() < 1e-13), "{residual:?}");
    }

    #[test]
    fn steps_are_damped_where_full_ones_diverge() {
        let arctangent = Given(|x, f| f[0] = x[0].atan(), |x, j| j[0] = 1.0 / (1.0 + x[0] * x[0]));
        let x = solved(arctangent, &[10.0]).unwrap();
        assert!(x[0].abs() < 1e-12, "{x:?}");
        // A full first step would leave the domain of the logarithm.
        let logarithm = Given(|x, f| f[0] = x[0].ln(), |x, j| j[0] = 1.0 / x[0]);
        let x = solved(logarithm, &[20.0]).unwrap();
        assert!((x[0] - 1.0).abs() < 1e-12, "{x:?}");
    }

    #[test]
    fn badly_scaled_equations_are_solved() {
        // x² + y² = 4 times 1e12, x y = 1 times 1e-12.
        let given = Given(
            |x, f| {
                f[0] = 1e12 * (x[0] * x[0] + x[1] * x[1] - 4.0);
                f[1] = 1e-12 * (x[0] * x[1] - 1.0);
            },
            |x, j| {
                j.copy_from_slice(&[2e12 * x[0], 1e-12 * x[1], 2e12 * x[1], 1e-12 * x[0]]);
            },
        );
        let x = solved(given, &[3.0, 0.1]).unwrap();
        let expected = [(2.0 + 3f64.sqrt()).sqrt(), (2.0 - 3f64.sqrt()).sqrt()];
        assert!(x.iter().zip(expected).all(|(x, e)| (x - e).abs() < 1e-12), "{x:?}");
    }

    #[test]
    fn what_has_no_solution_says_so() {
        let parabola = Given(|x, f| f[0] = x[0] * x[0] + 1.0, |x, j| j[0] = 2.0 * x[0]);
        assert!(solved(parabola, &[1.3]).is_err());
        let constant = Given(|_, f| f[0] = 1.0, |_, j| j[0] = 0.0);
        assert_eq!(solved(constant, &[0.0]), Err(NewtonFailure::Singular));
        let undefined = Given(|_, f| f[0] = f64::NAN, |_, j| j[0] = 1.0);
        assert_eq!(solved(undefined, &[0.0]), Err(NewtonFailure::NoProgress));
    }
}
