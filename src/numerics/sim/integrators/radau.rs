//! Radau IIA of order 5: an implicit Runge-Kutta method with three stages, L-stable and stiffly
//! accurate, for x' = f, 0 = g.
//!
//! With M = diag(I, 0), F = (f, g) and B the inverse of the method's matrix A:
//!
//! ```text
//! M Σ bᵢⱼ zⱼ / h = F(t + cᵢ h, y + zᵢ),   i = 1, 2, 3          y₁ = y + z₃
//! error           (M/(hγ) − J) e = F(t, y) + M Σ eⱼ zⱼ / h
//! ```
//!
//! The stages are found by Newton's method with one Jacobian for all, starting from the polynomial
//! of the last step. Between steps the collocation polynomial, of degree 3, gives y. F at the end of
//! a step is evaluated before the step is accepted: where F has no value there, as past the zero of
//! a root, the step was too long.
//!
//! Reference: [Hairer & Wanner 1996](gapilib_base::bibliography#hairer-wanner-1996), section IV.8.

use super::mass_matrix::ShiftedMatrix;
use super::step_control::{Attempt, StepControl, error_factor, newton_safety};
use super::{Integrator, Problem};
use crate::elementary;
use crate::registry::Entry;
use crate::sim::linear::Factorization;
use crate::sim::norm::{set_weights, weighted_rms};
use crate::sim::{Events, Pattern, Residual, SimErrorKind};

pub const ENTRY: Entry<dyn Integrator> = Entry {
    name: "radau",
    aliases: &["radau5", "radauIIa"],
    summary: "implicit Runge-Kutta method Radau IIA, L-stable, order 5, variable step",
    reference: "hairer-wanner-1996",
    make: |_| Ok(Box::new(Radau::default())),
};

const STAGES: usize = 3;
const MAX_ITERATIONS: usize = 8;
const SQRT6: f64 = 2.449489742783178;
const C: [f64; STAGES] = [(4.0 - SQRT6) / 10.0, (4.0 + SQRT6) / 10.0, 1.0];
/// The inverse of A.
const B: [[f64; STAGES]; STAGES] = [
    [2.0 + SQRT6 / 2.0, -1.2 + 29.0 * SQRT6 / 30.0, 0.4 - 4.0 * SQRT6 / 15.0],
    [-1.2 - 29.0 * SQRT6 / 30.0, 2.0 - SQRT6 / 2.0, 0.4 + 4.0 * SQRT6 / 15.0],
    [-1.0 + 8.0 * SQRT6 / 3.0, -1.0 - 8.0 * SQRT6 / 3.0, 5.0],
];
/// The real eigenvalue of B, 1/γ.
const REAL_EIGENVALUE: f64 = 3.637_834_252_744_496;
/// Coefficients of the error.
const E: [f64; STAGES] = [-(13.0 + 7.0 * SQRT6) / 3.0, (-13.0 + 7.0 * SQRT6) / 3.0, -1.0 / 3.0];
/// The iteration error relative to the local error allowed.
const NEWTON_TOLERANCE: f64 = 0.01;

/// Order of the embedded method, which the error is measured against.
const ERROR_ORDER: i32 = 3;
/// A step is at most this many times longer than the one before; the choice of Hairer & Wanner.
const MOST_FACTOR: f64 = 8.0;
/// Steps that are longer by such a factor are not worth new factors of the matrices; the choice of
/// Hairer & Wanner.
const NOT_WORTH: std::ops::RangeInclusive<f64> = 1.0..=1.2;

/// The method with its workspace.
#[derive(Default)]
struct Radau {
    n: usize,
    n_differential: usize,
    t: f64,
    t_old: f64,
    control: StepControl,
    y: Vec<f64>,
    y_old: Vec<f64>,
    /// z₁, z₂, z₃ one after the other, of the last step or the attempt.
    z: Vec<f64>,
    /// Those of the last step while there is an attempt.
    z_old: Vec<f64>,
    /// Whether there is a last step to start from.
    has_past: bool,
    work: Work,
    /// F at the start of the step, and whether it is known.
    first: Vec<f64>,
    knows_first: bool,
    /// F at the end of an attempt that meets the tolerance.
    end: Vec<f64>,
    /// Whether the Jacobian is that of this step, and whether it need not be evaluated again.
    is_current: bool,
    is_good: bool,
    matrix: ShiftedMatrix,
    stages: StageMatrix,
}

/// Vectors of a step that outlive none.
#[derive(Default)]
struct Work {
    delta: Vec<f64>,
    point: Vec<f64>,
    rhs: Vec<f64>,
    error: Vec<f64>,
    weights: Vec<f64>,
}

/// The matrix B ⊗ M / h − I ⊗ J of all stages.
#[derive(Default)]
struct StageMatrix {
    n: usize,
    pattern: Pattern,
    factors: Option<Factorization>,
    values: Vec<f64>,
    /// The step that the factors belong to.
    factorized_for: Option<f64>,
}

impl StageMatrix {
    fn prepare(&mut self, problem: &Problem) {
        let (pattern, n_differential) = (problem.system.pattern(), problem.system.n_differential());
        self.factorized_for = None;
        let n = pattern.n;
        let mut whole = Pattern { n: STAGES * n, column_starts: vec![0], rows: Vec::new() };
        for stage in 0..STAGES {
            for column in 0..n {
                for block in 0..STAGES {
                    if block == stage {
                        let rows = &pattern.rows[pattern.column(column)];
                        whole.rows.extend(rows.iter().map(|row| block * n + row));
                    } else if column < n_differential {
                        whole.rows.push(block * n + column);
                    }
                }
                whole.column_starts.push(whole.rows.len());
            }
        }
        if self.factors.is_none() || self.pattern != whole {
            let coupled = problem.coupled();
            let of_stage = |stage: usize| coupled.iter().map(move |at| stage * n + at);
            let coupled: Vec<usize> = (0..STAGES).flat_map(of_stage).collect();
            self.factors = Some(Factorization::new(&whole, &coupled));
            self.values.resize(whole.rows.len(), 0.0);
            self.pattern = whole;
            self.n = n;
        }
        if let Some(factors) = &mut self.factors {
            factors.forget();
        }
    }

    fn factorize(
        &mut self,
        problem: &mut Problem,
        matrix: &ShiftedMatrix,
        h: f64,
        n_differential: usize,
    ) -> Result<(), SimErrorKind> {
        if self.factorized_for == Some(h) {
            return Ok(());
        }
        self.factorized_for = None;
        let n = self.n;
        for column in 0..self.pattern.n {
            let (stage, variable) = (column / n, column % n);
            let scale = problem.nominal[variable];
            let mut entries = matrix.column(variable).iter();
            for k in self.pattern.column(column) {
                let (block, row) = (self.pattern.rows[k] / n, self.pattern.rows[k] % n);
                let shift = match row == variable && row < n_differential {
                    true => B[block][stage] / h,
                    false => 0.0,
                };
                let entry = match block == stage {
                    true => *entries.next().expect("the block has the pattern of J"),
                    false => 0.0,
                };
                self.values[k] = scale * (shift - entry);
            }
        }
        problem.statistics.factorizations += 1;
        let factors = self.factors.as_mut().expect("prepared at the restart");
        factors.factorize(&self.values).map_err(|_| SimErrorKind::Singular)?;
        self.factorized_for = Some(h);
        Ok(())
    }

    fn solve(&mut self, nominal: &[f64], b: &mut [f64]) {
        self.factors.as_mut().expect("prepared at the restart").solve(b);
        let n = self.n;
        b.iter_mut().enumerate().for_each(|(k, b)| *b *= nominal[k % n]);
    }
}

impl Radau {
    fn resize(&mut self, n: usize) {
        self.n = n;
        for vector in [&mut self.z, &mut self.z_old, &mut self.work.delta] {
            vector.resize(STAGES * n, 0.0);
        }
        let single = [
            &mut self.y,
            &mut self.y_old,
            &mut self.work.point,
            &mut self.work.rhs,
            &mut self.first,
            &mut self.end,
            &mut self.work.error,
        ];
        single.into_iter().for_each(|vector| vector.resize(n, 0.0));
    }

    /// First values of the stages: the polynomial of the last step, continued.
    fn predict(&mut self, h: f64) {
        if !self.has_past {
            self.z.fill(0.0);
            return;
        }
        let ratio = h / (self.t - self.t_old);
        for (stage, c) in C.iter().enumerate() {
            let weights = lagrange(1.0 + c * ratio);
            for k in 0..self.n {
                let value: f64 = (0..STAGES).map(|j| weights[j] * self.z_old[j * self.n + k]).sum();
                self.z[stage * self.n + k] = self.y_old[k] + value - self.y[k];
            }
        }
    }

    /// Newton's method for the stages; the number of iterations.
    fn iterate(&mut self, problem: &mut Problem, h: f64) -> Result<usize, SimErrorKind> {
        let n = self.n;
        let (mut last, mut rate) = (f64::INFINITY, 1.0f64);
        for iteration in 1..=MAX_ITERATIONS {
            for (stage, c) in C.iter().enumerate() {
                for k in 0..n {
                    self.work.point[k] = self.y[k] + self.z[stage * n + k];
                }
                problem.rhs(self.t + c * h, &self.work.point, &mut self.work.rhs)?;
                for k in 0..n {
                    let mut residual = self.work.rhs[k];
                    if k < self.n_differential {
                        let sum: f64 = (0..STAGES).map(|j| B[stage][j] * self.z[j * n + k]).sum();
                        residual -= sum / h;
                    }
                    self.work.delta[stage * n + k] = residual;
                }
            }
            self.stages.solve(problem.nominal, &mut self.work.delta);
            let norms = self
                .work
                .delta
                .chunks_exact(n)
                .map(|d| elementary::powi(weighted_rms(d, &self.work.weights), 2));
            let norm = (norms.sum::<f64>() / STAGES as f64).sqrt();
            if !norm.is_finite() || norm > 2.0 * last {
                return Err(SimErrorKind::StepSize);
            }
            if iteration > 1 {
                rate = (norm / last).max(0.1 * rate);
                let left = (MAX_ITERATIONS - iteration) as i32;
                let hopeless = rate >= 1.0 || elementary::powi(rate, left) * norm > (1.0 - rate);
                if hopeless && norm > NEWTON_TOLERANCE {
                    return Err(SimErrorKind::StepSize);
                }
            }
            self.z.iter_mut().zip(&self.work.delta).for_each(|(z, delta)| *z += delta);
            let ahead = if iteration > 1 { (rate / (1.0 - rate).max(1e-3)).min(1.0) } else { 1.0 };
            if ahead * norm <= NEWTON_TOLERANCE {
                self.is_good = iteration <= 3;
                return Ok(iteration);
            }
            last = norm;
        }
        Err(SimErrorKind::StepSize)
    }

    /// The error of the attempt relative to the tolerance.
    fn estimate(&mut self, problem: &mut Problem, h: f64) -> Result<f64, SimErrorKind> {
        let n = self.n;
        self.matrix.factorize(problem, REAL_EIGENVALUE / h, self.n_differential)?;
        let sum = |radau: &Radau, k: usize| -> f64 {
            let terms = E.iter().enumerate().map(|(j, e)| e * radau.z[j * n + k]);
            if k < radau.n_differential { terms.sum::<f64>() / h } else { 0.0 }
        };
        for k in 0..n {
            self.work.error[k] = self.first[k] + sum(self, k);
        }
        self.matrix.solve(problem.nominal, &mut self.work.error);
        let mut norm = weighted_rms(&self.work.error, &self.work.weights);
        if norm >= 1.0 && self.control.is_cautious() {
            for k in 0..n {
                self.work.point[k] = self.y[k] + self.work.error[k];
            }
            problem.rhs(self.t, &self.work.point, &mut self.work.rhs)?;
            for k in 0..n {
                self.work.error[k] = self.work.rhs[k] + sum(self, k);
            }
            self.matrix.solve(problem.nominal, &mut self.work.error);
            norm = weighted_rms(&self.work.error, &self.work.weights);
        }
        Ok(norm)
    }

    /// Evaluates the Jacobian at the start of the step, unless the last one is still good.
    fn update_jacobian(&mut self, problem: &mut Problem) -> Result<(), SimErrorKind> {
        if !self.is_good && !self.is_current {
            self.matrix.evaluate(problem, self.t, &self.y)?;
            self.stages.factorized_for = None;
            self.is_current = true;
        }
        Ok(())
    }

    /// The error relative to the tolerance, and the iterations of Newton's method.
    fn attempt(&mut self, problem: &mut Problem, h: f64) -> Result<(f64, usize), SimErrorKind> {
        self.stages.factorize(problem, &self.matrix, h, self.n_differential)?;
        self.predict(h);
        let iterations = match self.iterate(problem, h) {
            // A polynomial continued may leave the domain of F where y itself does not.
            Err(SimErrorKind::Evaluation(_) | SimErrorKind::NotFinite) if self.has_past => {
                self.z.fill(0.0);
                self.iterate(problem, h)?
            }
            iterated => iterated?,
        };
        let error = self.estimate(problem, h)?;
        if error <= 1.0 {
            self.evaluate_end(problem, self.t + h)?;
        }
        Ok((error, iterations))
    }

    fn evaluate_end(&mut self, problem: &mut Problem, t: f64) -> Result<(), SimErrorKind> {
        let last = &self.z[2 * self.n..];
        for ((point, y), z) in self.work.point.iter_mut().zip(&self.y).zip(last) {
            *point = y + z;
        }
        problem.rhs(t, &self.work.point, &mut self.end)?;
        // The value of a delay at the end is known only after it.
        self.knows_first = !problem.system.remembers();
        Ok(())
    }

    fn accept(&mut self, t_new: f64) {
        let n = self.n;
        self.y_old.copy_from_slice(&self.y);
        std::mem::swap(&mut self.first, &mut self.end);
        for (y, z) in self.y.iter_mut().zip(&self.z[2 * n..]) {
            *y += z;
        }
        self.z_old.copy_from_slice(&self.z);
        self.has_past = true;
        (self.t_old, self.t) = (self.t, t_new);
        self.is_current = false;
    }
}

/// Weights of z₁, z₂, z₃ in the polynomial through them and 0, at a part of the step.
fn lagrange(s: f64) -> [f64; STAGES] {
    std::array::from_fn(|i| {
        let others = (0..STAGES).filter(|j| *j != i);
        others.fold(s / C[i], |product, j| product * (s - C[j]) / (C[i] - C[j]))
    })
}

impl Integrator for Radau {
    fn is_explicit(&self) -> bool {
        false
    }

    fn restart(&mut self, problem: &mut Problem, t: f64, y: &[f64]) -> Result<(), SimErrorKind> {
        self.resize(y.len());
        self.work.weights.resize(problem.n_tested(), 0.0);
        self.n_differential = problem.system.n_differential();
        self.matrix.prepare(problem);
        self.stages.prepare(problem);
        (self.t, self.t_old) = (t, t);
        self.y.copy_from_slice(y);
        self.y_old.copy_from_slice(y);
        self.z_old.fill(0.0);
        self.has_past = false;
        (self.is_current, self.is_good) = (false, false);
        problem.rhs(t, y, &mut self.first)?;
        self.knows_first = true;
        self.control.restart(problem, t, y, &self.first);
        Ok(())
    }

    fn step(&mut self, problem: &mut Problem, limit: f64) -> Result<(), SimErrorKind> {
        self.control.begin(problem);
        if !self.has_past {
            self.control.be_cautious();
        }
        set_weights(problem.settings.tolerance, &self.y, problem.nominal, &mut self.work.weights);
        if !std::mem::take(&mut self.knows_first) {
            problem.rhs(self.t, &self.y, &mut self.first)?;
        }
        loop {
            problem.may_continue()?;
            self.update_jacobian(problem)?;
            let attempt = Attempt::towards(limit, self.t, self.control.h());
            match self.attempt(problem, attempt.h) {
                Ok((error, iterations)) => {
                    let safety = newton_safety(iterations, MAX_ITERATIONS);
                    let factor = error_factor(error, ERROR_ORDER, safety, MOST_FACTOR);
                    if error <= 1.0 {
                        self.accept(attempt.end);
                        let factor = if NOT_WORTH.contains(&factor) { 1.0 } else { factor };
                        self.control.accept(problem, attempt, factor);
                        return Ok(());
                    }
                    self.control.reject(problem, attempt, factor)?;
                }
                Err(_) if !self.is_current => {
                    // With a new Jacobian the same step may do.
                    problem.statistics.newton_failures += 1;
                    self.is_good = false;
                    continue;
                }
                Err(failure) => self.control.fail(problem, attempt, failure)?,
            }
            self.is_good = self.is_current;
        }
    }

    fn keeps_past(&self) -> bool {
        true
    }

    fn continue_from(&mut self, t: f64, y: &[f64], longest: f64) -> bool {
        if longest < self.control.h() {
            return false;
        }
        (self.t, self.t_old) = (t, t);
        self.y.copy_from_slice(y);
        (self.has_past, self.knows_first, self.is_current) = (false, false, false);
        true
    }

    fn branches_changed(&mut self) {
        self.knows_first = false;
    }

    fn time(&self) -> f64 {
        self.t
    }

    fn state(&self) -> &[f64] {
        &self.y
    }

    fn interpolate(&self, t: f64, y: &mut [f64]) {
        let h = self.t - self.t_old;
        let weights = lagrange(if h > 0.0 { (t - self.t_old) / h } else { 1.0 });
        for (k, y) in y.iter_mut().enumerate() {
            let value: f64 = (0..STAGES).map(|j| weights[j] * self.z_old[j * self.n + k]).sum();
            *y = self.y_old[k] + value;
        }
    }
}
