//! Backward differentiation formulas of orders 1 to 5 with variable step, for x' = f, 0 = g.
//!
//! Numerical differentiation formulas in backward differences with quasi-constant step: with
//! D⁰ = y, Dᵏ⁺¹ = Dᵏ(tₙ) − Dᵏ(tₙ₋₁), γₖ = Σ 1/j and αₖ = (1 − κₖ) γₖ,
//!
//! ```text
//! predictor   p = Σ_{j=0..k} Dʲ        ψ = Σ_{j=1..k} γⱼ Dʲ / αₖ        c = h / αₖ
//! corrector   y = p + d,   c f(t, y) − ψ − d = 0 for x,   g(t, y) = 0 for v
//! error       (κₖ γₖ + 1/(k+1)) d
//! ```
//!
//! The corrector is solved by Newton's method with the matrix I − c ∂f/∂y over −∂g/∂y, whose
//! columns are scaled by the nominal values. The Jacobian is kept until the corrector converges
//! slowly: at once if it fails, with the next change of c if it needed more than two iterations.
//! Between steps the interpolating polynomial of the differences gives y. The first step after a
//! restart has order 1; v has no derivative there and takes no part in its error test.
//!
//! This is what `dassl` and its relatives name here: our own method of the same family, not
//! anybody's code.
//!
//! References: [Shampine & Reichelt 1997](gapilib_base::bibliography#shampine-reichelt-1997);
//! [Brenan, Campbell & Petzold 1996](gapilib_base::bibliography#brenan-campbell-petzold-1996).

mod sensitivities;

use super::step_control::{Attempt, FAILURE_FACTOR, error_factor, newton_safety};
use super::{Integrator, Problem};
use crate::elementary;
use crate::registry::Entry;
use crate::sim::linear::Factorization;
use crate::sim::norm::{set_weights, weighted_rms};
use crate::sim::{Pattern, Residual, SimErrorKind};
use std::sync::LazyLock;

pub(in crate::sim) const ENTRY: Entry<dyn Integrator> = Entry {
    name: "dassl",
    aliases: &["bdf", "ida", "cvode", "lsodar"],
    summary: "variable-order, variable-step BDF, orders 1 to 5 (gapilib's own; not the code DASSL)",
    reference: "shampine-reichelt-1997",
    make: |_| Ok(new()),
};

/// The method without workspace yet.
pub(in crate::sim) fn new() -> Box<dyn Integrator> {
    Box::new(Bdf::default())
}

const MAX_ORDER: usize = 5;
const KAPPA: [f64; 6] = [0.0, -0.1850, -1.0 / 9.0, -0.0823, -0.0415, 0.0];
const GAMMA: [f64; 6] = [0.0, 1.0, 1.5, 11.0 / 6.0, 25.0 / 12.0, 137.0 / 60.0];
const MAX_ITERATIONS: usize = 4;
const MAX_FULL_ITERATIONS: usize = 20;
/// Failures of one step after which the past is forgotten and Newton's method may take its time.
const MOST_FAILURES: usize = 4;
/// The local error is kept below this part of the tolerance, so that the global one meets it.
const SAFETY: f64 = 0.25;
/// The corrector's error relative to the local error allowed.
const NEWTON_TOLERANCE: f64 = 0.03;
/// Changes of the corrector below this part of the local error allowed do no harm where they do not
/// vanish.
const ROUNDING: f64 = 0.3;

/// An error that solving a system with a known solution has where its condition is no worse than 1e9.
const REGULAR: f64 = 1e-7;
/// A step shortened by more than this is not worth its past: order 1 is as good.
const LEAST_PART: f64 = 0.1;

fn alpha(order: usize) -> f64 {
    (1.0 - KAPPA[order]) * GAMMA[order]
}

fn error_constant(order: usize) -> f64 {
    KAPPA[order] * GAMMA[order] + 1.0 / (order as f64 + 1.0)
}

/// The method with its workspace.
#[derive(Default)]
struct Bdf {
    n_differential: usize,
    /// Length of y; in all vectors its derivatives along directions follow, n for each.
    n: usize,
    t: f64,
    /// Step length and order of the differences, also of the last step until the next begins.
    h: f64,
    order: usize,
    /// Steps made with this length and order.
    equal_steps: usize,
    /// Whether no step has been made since the restart.
    fresh: bool,
    /// Whether no step has been made since an event after which the past was kept.
    is_doubtful: bool,
    convergence: Convergence,
    /// Backward differences D⁰ … of n numbers each.
    differences: Vec<Vec<f64>>,
    predicted: Vec<f64>,
    psi: Vec<f64>,
    y: Vec<f64>,
    correction: Vec<f64>,
    rhs: Vec<f64>,
    delta: Vec<f64>,
    norms: Norms,
    iteration: IterationMatrix,
}

/// How the corrector converges, and what is left of the error.
#[derive(Default)]
struct Convergence {
    /// Relative error of the last step and the safety factor of its iterations.
    error: f64,
    safety: f64,
    /// How fast the corrector converged lately, and after how many iterations.
    rate: f64,
    iterations: usize,
}

/// Weights of the norms.
#[derive(Default)]
struct Norms {
    /// Of the tested unknowns.
    weights: Vec<f64>,
    /// Of their derivatives, and the magnitudes of the directions.
    direction_weights: Vec<f64>,
    magnitudes: Vec<f64>,
}

/// The matrix of the corrector.
#[derive(Default)]
struct IterationMatrix {
    pattern: Pattern,
    factors: Option<Factorization>,
    /// With columns scaled by nominal values.
    jacobian: Vec<f64>,
    /// The identity in the rows of differential variables, scaled alike.
    identity: Vec<f64>,
    is_differential: Vec<bool>,
    values: Vec<f64>,
    /// Whether the Jacobian was evaluated in this step.
    is_current: bool,
    /// Whether there is a Jacobian.
    is_evaluated: bool,
    /// The c that the factors belong to.
    factorized_for: Option<f64>,
}

impl IterationMatrix {
    fn prepare(&mut self, problem: &Problem) {
        let (pattern, n_differential) = (problem.system.pattern(), problem.system.n_differential());
        if self.factors.is_none() || self.pattern != *pattern {
            self.pattern = pattern.clone();
            self.factors = Some(Factorization::new(pattern, &problem.coupled()));
            self.jacobian.resize(pattern.rows.len(), 0.0);
            self.values.resize(pattern.rows.len(), 0.0);
        }
        self.identity.clear();
        self.is_differential.clear();
        for (column, nominal) in problem.nominal.iter().enumerate() {
            for row in &pattern.rows[pattern.column(column)] {
                let on_diagonal = *row == column && column < n_differential;
                self.identity.push(if on_diagonal { *nominal } else { 0.0 });
                self.is_differential.push(*row < n_differential);
            }
        }
        if let Some(factors) = &mut self.factors {
            factors.forget();
        }
        (self.is_current, self.is_evaluated, self.factorized_for) = (false, false, None);
    }

    fn evaluate(&mut self, problem: &mut Problem, t: f64, y: &[f64]) -> Result<(), SimErrorKind> {
        (self.is_evaluated, self.factorized_for) = (false, None);
        problem.jacobian(t, y, &mut self.jacobian)?;
        for (column, nominal) in problem.nominal.iter().enumerate() {
            self.jacobian[self.pattern.column(column)]
                .iter_mut()
                .for_each(|entry| *entry *= nominal);
        }
        (self.is_evaluated, self.is_current) = (true, true);
        Ok(())
    }

    fn factorize(&mut self, problem: &mut Problem, c: f64) -> Result<(), SimErrorKind> {
        if self.factorized_for == Some(c) {
            return Ok(());
        }
        self.factorized_for = None;
        let entries = self.jacobian.iter().zip(&self.identity).zip(&self.is_differential);
        for (value, ((entry, identity), is_differential)) in self.values.iter_mut().zip(entries) {
            *value = identity - if *is_differential { c * entry } else { *entry };
        }
        problem.statistics.factorizations += 1;
        let factors = self.factors.as_mut().expect("prepared at the restart");
        factors.factorize(&self.values).map_err(|_| SimErrorKind::Singular)?;
        self.factorized_for = Some(c);
        Ok(())
    }

    /// Whether solving gives back numbers that were multiplied with the matrix.
    fn is_regular(&mut self) -> bool {
        let number = |at: usize| 1.0 + 1.0 / (at as f64 + 1.0);
        let mut product = vec![0.0; self.pattern.n];
        for column in 0..self.pattern.n {
            for at in self.pattern.column(column) {
                product[self.pattern.rows[at]] += self.values[at] * number(column);
            }
        }
        self.factors.as_mut().expect("prepared at the restart").solve(&mut product);
        product.iter().enumerate().all(|(at, x)| (x - number(at)).abs() <= REGULAR)
    }

    fn solve(&mut self, nominal: &[f64], b: &mut [f64]) {
        self.factors.as_mut().expect("prepared at the restart").solve(b);
        b.iter_mut().zip(nominal).for_each(|(b, nominal)| *b *= nominal);
    }

    /// The same for right-hand sides one after another.
    fn solve_all(&mut self, nominal: &[f64], b: &mut [f64]) {
        self.factors.as_mut().expect("prepared at the restart").solve_all(b);
        for b in b.chunks_exact_mut(nominal.len()) {
            b.iter_mut().zip(nominal).for_each(|(b, nominal)| *b *= nominal);
        }
    }
}

/// How an attempt to solve the corrector ended.
enum Corrected {
    /// After so many iterations.
    Converged(usize),
    /// Too slowly or not at all.
    Slow,
}

impl Bdf {
    fn resize(&mut self, n: usize) {
        self.differences.resize_with(MAX_ORDER + 3, Vec::new);
        let workspaces = [
            &mut self.predicted,
            &mut self.psi,
            &mut self.y,
            &mut self.correction,
            &mut self.rhs,
            &mut self.delta,
        ];
        for vector in workspaces.into_iter().chain(&mut self.differences) {
            vector.resize(n, 0.0);
        }
    }

    /// Changes the step length: the differences are those of the same polynomial at the new
    /// distance.
    fn rescale(&mut self, h_new: f64) {
        let order = self.order;
        let transformation = rescaling(order, h_new / self.h);
        // The matrix is upper triangular: a difference needs those from its own order on.
        for j in 1..=order {
            let (_, from) = self.differences.split_at_mut(j);
            let (target, others) = from.split_at_mut(1);
            target[0].iter_mut().for_each(|d| *d *= transformation[j][j]);
            for (k, other) in others.iter().enumerate().take(order - j) {
                let factor = transformation[j + 1 + k][j];
                target[0].iter_mut().zip(other).for_each(|(d, other)| *d += factor * other);
            }
        }
        self.h = h_new;
        self.equal_steps = 0;
    }

    /// Moves the point that the differences belong to: they are those of the same polynomial there.
    fn shift(&mut self, t: f64) {
        let s = (t - self.t) / self.h;
        for j in 0..=self.order {
            let (target, others) = self.differences.split_at_mut(j + 1);
            let mut factor = 1.0;
            for (k, other) in others.iter().enumerate().take(self.order - j) {
                factor *= (s + k as f64) / (k as f64 + 1.0);
                target[j].iter_mut().zip(other).for_each(|(d, other)| *d += factor * other);
            }
        }
        self.t = t;
    }

    /// Chooses order and length of the next step when the differences tell enough.
    fn adapt(&mut self, problem: &Problem) {
        if self.equal_steps < self.order + 1 {
            return;
        }
        let order = self.order;
        let gain = |error: f64, order: usize| elementary::powf(error, -1.0 / (order as f64 + 1.0));
        let norm =
            |difference: usize| self.norm(&self.differences[difference], self.norms.weights.len());
        let mut best = (gain(self.convergence.error, order), order);
        if order > 1 {
            let lower = gain(error_constant(order - 1) * norm(order), order - 1);
            best = if lower > best.0 { (lower, order - 1) } else { best };
        }
        if order < MAX_ORDER {
            let higher = gain(error_constant(order + 1).abs() * norm(order + 2), order + 1);
            best = if higher > best.0 { (higher, order + 1) } else { best };
        }
        let factor = (self.convergence.safety * best.0).min(10.0);
        let h_new = (self.h * factor).min(problem.settings.max_step);
        let ratio = h_new / self.h;
        if best.1 == order && (0.8..1.2).contains(&ratio) {
            return;
        }
        self.order = best.1;
        self.rescale(h_new);
    }

    /// Shortens the step to one or two equal ones to the limit if it comes near; where the next one
    /// ends.
    fn approach(&mut self, limit: f64) -> f64 {
        let attempt = Attempt::towards(limit, self.t, self.h);
        if attempt.h != self.h {
            self.rescale(attempt.h);
        }
        attempt.end
    }

    /// Computes predictor and ψ.
    fn predict(&mut self) {
        self.predicted.copy_from_slice(&self.differences[0]);
        self.psi.fill(0.0);
        for (j, difference) in self.differences.iter().enumerate().take(self.order + 1).skip(1) {
            let factor = GAMMA[j] / alpha(self.order);
            let targets = self.predicted.iter_mut().zip(&mut self.psi);
            for ((predicted, psi), d) in targets.zip(difference) {
                *predicted += d;
                *psi += factor * d;
            }
        }
    }

    /// Newton's method for y at `t_new`.
    fn iterate(
        &mut self,
        problem: &mut Problem,
        t_new: f64,
        c: f64,
        full: bool,
    ) -> Result<Corrected, SimErrorKind> {
        self.y.copy_from_slice(&self.predicted);
        self.correction.fill(0.0);
        let n = self.n;
        let mut last = f64::INFINITY;
        for iteration in 1..=if full { MAX_FULL_ITERATIONS } else { MAX_ITERATIONS } {
            if full && iteration > 1 {
                self.iteration.evaluate(problem, t_new, &self.y[..n])?;
                self.iteration.factorize(problem, c)?;
            }
            problem.rhs(t_new, &self.y[..n], &mut self.rhs[..n])?;
            self.delta[..n].copy_from_slice(&self.rhs[..n]);
            let known = self.psi.iter().zip(&self.correction).take(self.n_differential);
            for (delta, (psi, correction)) in self.delta.iter_mut().zip(known) {
                *delta = c * *delta - psi - correction;
            }
            self.iteration.solve(problem.nominal, &mut self.delta[..n]);
            let norm = weighted_rms(&self.delta, &self.norms.weights);
            if !norm.is_finite() || (norm > 2.0 * last && norm > ROUNDING && !full) {
                return Ok(Corrected::Slow);
            }
            if iteration > 1 {
                self.convergence.rate = (norm / last).max(0.3 * self.convergence.rate);
            }
            let delta = &self.delta[..n];
            self.y.iter_mut().zip(delta).for_each(|(y, delta)| *y += delta);
            self.correction.iter_mut().zip(delta).for_each(|(d, delta)| *d += delta);
            // With an old Jacobian a small first step tells nothing about stiff and algebraic
            // equations.
            let is_trusted = iteration > 1 || self.iteration.is_current;
            if is_trusted && norm * self.convergence.rate.min(1.0) <= NEWTON_TOLERANCE {
                return Ok(Corrected::Converged(iteration));
            }
            last = norm;
        }
        // What does not become smaller with a new Jacobian is made of rounding errors.
        match self.iteration.is_current && last <= ROUNDING {
            true => Ok(Corrected::Converged(MAX_ITERATIONS)),
            false => Ok(Corrected::Slow),
        }
    }

    /// Solves the corrector, if need be with a new Jacobian. Returns the number of iterations.
    /// `full` evaluates the Jacobian in every iteration, and there may be more of them.
    fn correct(
        &mut self,
        problem: &mut Problem,
        t_new: f64,
        full: bool,
    ) -> Result<usize, SimErrorKind> {
        let c = self.h / alpha(self.order);
        if self.convergence.iterations > 2 && self.iteration.factorized_for != Some(c) {
            self.iteration.is_evaluated = false;
        }
        loop {
            if !self.iteration.is_evaluated {
                self.iteration.evaluate(problem, t_new, &self.predicted[..self.n])?;
            }
            if self.iteration.factorized_for != Some(c) {
                self.iteration.factorize(problem, c)?;
                self.convergence.rate = 1.0;
            }
            match self.iterate(problem, t_new, c, full)? {
                Corrected::Converged(iterations) => {
                    self.convergence.iterations = iterations;
                    return Ok(iterations);
                }
                Corrected::Slow if self.iteration.is_current => {
                    return Err(SimErrorKind::StepSize);
                }
                Corrected::Slow => self.iteration.is_evaluated = false,
            }
        }
    }

    /// Solves the corrector for y and, where its error is small enough, for its derivatives.
    fn attempt(
        &mut self,
        problem: &mut Problem,
        t_new: f64,
        full: bool,
    ) -> Result<usize, SimErrorKind> {
        let iterations = self.correct(problem, t_new, full)?;
        self.convergence.error = self.error_of_attempt();
        if self.convergence.error <= 1.0 && self.y.len() > self.n {
            self.correct_directions(problem, t_new)?;
            self.convergence.error = self.error_with_directions();
        }
        Ok(iterations)
    }

    /// The error of the attempt relative to the tolerance.
    fn error_of_attempt(&self) -> f64 {
        let tested = if self.fresh { self.n_differential } else { self.norms.weights.len() };
        error_constant(self.order) * weighted_rms(&self.correction, &self.norms.weights[..tested])
    }

    /// The same with the derivatives along all directions.
    fn error_with_directions(&self) -> f64 {
        let tested = if self.fresh { self.n_differential } else { self.norms.weights.len() };
        error_constant(self.order) * self.norm(&self.correction, tested)
    }

    /// The norm of a vector of all unknowns, of each direction the first `tested`.
    fn norm(&self, vector: &[f64], tested: usize) -> f64 {
        let norm = weighted_rms(vector, &self.norms.weights[..tested]);
        if vector.len() == self.n {
            norm
        } else {
            norm.max(self.norm_of_directions(vector, tested))
        }
    }

    fn accept(&mut self, t_new: f64) {
        let order = self.order;
        let (lower, upper) = self.differences.split_at_mut(order + 2);
        let last = upper[0].iter_mut().zip(&mut lower[order + 1]);
        for ((above, difference), d) in last.zip(&self.correction) {
            *above = d - *difference;
            *difference = *d;
        }
        for j in (0..=order).rev() {
            let (lower, upper) = lower.split_at_mut(j + 1);
            lower[j].iter_mut().zip(&upper[0]).for_each(|(lower, upper)| *lower += upper);
        }
        if self.fresh {
            for difference in &mut self.differences[2..4] {
                for values in difference.chunks_exact_mut(self.n.max(1)) {
                    values[self.n_differential..].fill(0.0);
                }
            }
        }
        (self.fresh, self.is_doubtful) = (false, false);
        self.t = t_new;
        self.equal_steps += 1;
        self.iteration.is_current = false;
    }
}

/// The matrix that takes differences at distance h to differences at distance `factor` · h: its rows
/// from the diagonal on, which are all that is not zero.
fn rescaling(order: usize, factor: f64) -> [[f64; MAX_ORDER + 1]; MAX_ORDER + 1] {
    // With the factor 1 entry (k, j) is zero where k > j.
    static OF_EQUAL_STEPS: LazyLock<[[f64; MAX_ORDER + 1]; MAX_ORDER + 1]> =
        LazyLock::new(|| binomials(MAX_ORDER, 1.0));
    let (new, old) = (binomials(order, factor), &*OF_EQUAL_STEPS);
    let mut product = [[0.0; MAX_ORDER + 1]; MAX_ORDER + 1];
    for i in 0..=order {
        for j in 0..=i {
            product[i][j] = (0..=j).map(|k| new[i][k] * old[k][j]).sum();
        }
    }
    product
}

/// Entry (i, j) is Π_{m=1..i} (m − 1 − factor · j) / m.
fn binomials(order: usize, factor: f64) -> [[f64; MAX_ORDER + 1]; MAX_ORDER + 1] {
    let mut matrix = [[0.0; MAX_ORDER + 1]; MAX_ORDER + 1];
    matrix[0] = [1.0; MAX_ORDER + 1];
    for i in 1..=order {
        let m = i as f64;
        matrix[i] = std::array::from_fn(|j| matrix[i - 1][j] * (m - 1.0 - factor * j as f64) / m);
    }
    matrix
}

impl Bdf {
    /// Restarts at the current point, with order 1 and the current step: the history does not
    /// predict what follows.
    fn forget(&mut self, problem: &mut Problem) -> Result<(), SimErrorKind> {
        problem.rhs(self.t, &self.differences[0][..self.n], &mut self.rhs[..self.n])?;
        self.order = 1;
        self.equal_steps = 0;
        self.fresh = true;
        self.differences[1..].iter_mut().for_each(|difference| difference.fill(0.0));
        for i in 0..self.n_differential {
            self.differences[1][i] = self.h * self.rhs[i];
        }
        self.start_directions(problem, self.t)
    }
}

impl Integrator for Bdf {
    fn is_explicit(&self) -> bool {
        false
    }

    fn dominant(&self) -> Option<usize> {
        let shares =
            self.correction.iter().zip(&self.norms.weights).map(|(e, weight)| (e / weight).abs());
        let largest = shares.enumerate().max_by(|a, b| a.1.total_cmp(&b.1));
        largest.map(|(at, _)| at)
    }

    fn restart(&mut self, problem: &mut Problem, t: f64, y: &[f64]) -> Result<(), SimErrorKind> {
        self.resize(y.len());
        self.n = problem.nominal.len();
        self.n_differential = problem.system.n_differential();
        self.norms.weights.resize(problem.n_tested(), 0.0);
        self.iteration.prepare(problem);
        self.t = t;
        problem.rhs(t, &y[..self.n], &mut self.rhs[..self.n])?;
        self.h = problem.first_step(t, y, &self.rhs);
        self.order = 1;
        self.equal_steps = 0;
        (self.fresh, self.is_doubtful) = (true, false);
        self.convergence.rate = 1.0;
        self.convergence.iterations = 0;
        self.differences.iter_mut().for_each(|difference| difference.fill(0.0));
        self.differences[0].copy_from_slice(y);
        for i in 0..self.n_differential {
            self.differences[1][i] = self.h * self.rhs[i];
        }
        self.start_directions(problem, t)
    }

    fn step(&mut self, problem: &mut Problem, limit: f64) -> Result<(), SimErrorKind> {
        let smallest = problem.smallest_step();
        let tolerance = SAFETY * problem.settings.tolerance;
        set_weights(tolerance, &self.differences[0], problem.nominal, &mut self.norms.weights);
        self.set_direction_weights(problem, tolerance);
        self.adapt(problem);
        let mut failures = 0;
        loop {
            problem.may_continue()?;
            let t_new = self.approach(limit);
            self.predict();
            let corrected = self.attempt(problem, t_new, failures >= MOST_FAILURES);
            let (failure, factor) = match corrected {
                Ok(iterations) => {
                    self.convergence.safety = newton_safety(iterations, MAX_ITERATIONS);
                    if self.convergence.error <= 1.0 {
                        self.accept(t_new);
                        problem.note_step(self.h);
                        return Ok(());
                    }
                    problem.statistics.error_failures += 1;
                    let factor = error_factor(
                        self.convergence.error,
                        self.order as i32,
                        self.convergence.safety,
                        1.0,
                    );
                    (SimErrorKind::StepSize, factor)
                }
                Err(failure) => {
                    problem.statistics.newton_failures += 1;
                    (failure, FAILURE_FACTOR)
                }
            };
            if self.h * factor < smallest {
                return Err(failure);
            }
            self.rescale(self.h * factor);
            failures += 1;
            if failures == MOST_FAILURES || std::mem::take(&mut self.is_doubtful) {
                self.forget(problem)?;
            }
        }
    }

    fn keeps_past(&self) -> bool {
        true
    }

    fn determines_unknowns(&mut self, problem: &mut Problem, t: f64, y: &[f64]) -> bool {
        if self.norms.weights.len() == self.n_differential {
            return true;
        }
        let c = self.h / alpha(self.order);
        let evaluated = self.iteration.evaluate(problem, t, &y[..self.n]);
        evaluated.and_then(|()| self.iteration.factorize(problem, c)).is_ok()
            && self.iteration.is_regular()
    }

    fn continue_from(&mut self, t: f64, y: &[f64], longest: f64) -> bool {
        if longest < LEAST_PART * self.h {
            return false;
        }
        self.shift(t);
        self.differences[0].copy_from_slice(y);
        if longest < self.h {
            self.rescale(longest);
        }
        (self.equal_steps, self.is_doubtful) = (0, true);
        true
    }

    fn time(&self) -> f64 {
        self.t
    }

    fn state(&self) -> &[f64] {
        &self.differences[0]
    }

    fn interpolate(&self, t: f64, y: &mut [f64]) {
        y.copy_from_slice(&self.differences[0]);
        let mut factor = 1.0;
        for (j, difference) in self.differences.iter().enumerate().take(self.order + 1).skip(1) {
            factor *= (t - self.t + self.h * (j as f64 - 1.0)) / (self.h * j as f64);
            for (y, d) in y.iter_mut().zip(difference) {
                *y += factor * d;
            }
        }
    }
}
