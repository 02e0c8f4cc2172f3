//! Explicit Runge-Kutta methods from their tableaus, with fixed or variable step.
//!
//! ```text
//! kᵢ = f(t + cᵢ h, x + h Σⱼ aᵢⱼ kⱼ);  x₁ = x + h Σ bᵢ kᵢ
//! ```
//!
//! Between steps: cubic Hermite interpolation, with terms of higher order where the tableau has them:
//!
//! ```text
//! x(t + θ h) = x + θ (F₀ + (1 − θ) (F₁ + θ (F₂ + (1 − θ) (F₃ + θ (F₄ + …)))))
//! F₀ = x₁ − x,  F₁ = h k₁ − F₀,  F₂ = F₀ − h f(t + h, x₁) − F₁,  Fᵢ = h Σ dᵢⱼ kⱼ
//! ```
//!
//! For systems without algebraic unknowns. Derivatives along directions are integrated with y, as
//! unknowns of the same method, and take part in the error test.

use super::step_control::{Attempt, SAFETY, StepControl, error_factor};
use super::{Integrator, Problem};
use crate::sim::norm::{set_weights, weighted_rms};
use crate::sim::{Sensitive, SimErrorKind};

/// The coefficients of a method.
pub(crate) struct Tableau {
    /// cᵢ
    pub(super) nodes: &'static [f64],
    /// aᵢⱼ, j < i
    pub(super) stages: &'static [&'static [f64]],
    /// bᵢ
    pub(super) weights: &'static [f64],
    /// For variable steps.
    pub(super) embedded: Option<Embedded>,
}

/// What a method with variable step knows besides. Its derivatives are those of the stages, then the one
/// at the end of the step, then those of the stages for the interpolation.
pub(crate) struct Embedded {
    /// Order of the method the error is measured against.
    pub(super) order: i32,
    /// Error = h Σ eᵢ kᵢ
    pub(super) error: &'static [f64],
    /// The error of a method of low order, in the same way, which damps the other one where that is
    /// small by chance.
    pub(super) coarse_error: Option<&'static [f64]>,
    /// Nodes and coefficients of stages that the interpolation needs besides.
    pub(super) inner_stages: &'static [(f64, &'static [f64])],
    /// Terms from order 4 on of the interpolation = h Σ dᵢ kᵢ
    pub(super) dense: &'static [&'static [f64]],
}

/// The part of a coarse error that counts in the denominator of the finer one.
const COARSE: f64 = 0.1;

/// A step is at most this many times longer than the one before.
const MOST_FACTOR: f64 = 5.0;

/// An explicit method with its workspace.
pub(crate) struct ExplicitRungeKutta {
    tableau: &'static Tableau,
    t: f64,
    t_old: f64,
    control: StepControl,
    y: Vec<f64>,
    y_old: Vec<f64>,
    stage: Vec<f64>,
    weights: Vec<f64>,
    /// Typical magnitudes of y and, after them, of its derivatives along directions.
    nominal: Vec<f64>,
    /// Derivatives of the stages, the first at the start of the step.
    derivatives: Vec<Vec<f64>>,
    /// Derivative at the end of the step.
    derivative_end: Vec<f64>,
    /// Derivatives of the stages for the interpolation.
    inner: Vec<Vec<f64>>,
    /// Whether the derivative at the end is another one since.
    is_outdated: bool,
    /// Error estimate.
    combined: Vec<f64>,
    /// Terms from order 4 on of the interpolation.
    terms: Vec<Vec<f64>>,
}

impl ExplicitRungeKutta {
    pub fn new(tableau: &'static Tableau) -> ExplicitRungeKutta {
        let (inner, terms) = match &tableau.embedded {
            Some(embedded) => (embedded.inner_stages.len(), embedded.dense.len()),
            None => (0, 0),
        };
        ExplicitRungeKutta {
            tableau,
            t: 0.0,
            t_old: 0.0,
            control: StepControl::default(),
            y: Vec::new(),
            y_old: Vec::new(),
            stage: Vec::new(),
            weights: Vec::new(),
            nominal: Vec::new(),
            derivatives: vec![Vec::new(); tableau.nodes.len()],
            derivative_end: Vec::new(),
            inner: vec![Vec::new(); inner],
            is_outdated: false,
            combined: Vec::new(),
            terms: vec![Vec::new(); terms],
        }
    }

    fn resize(&mut self, n: usize) {
        let workspaces = [
            &mut self.y,
            &mut self.y_old,
            &mut self.stage,
            &mut self.weights,
            &mut self.derivative_end,
            &mut self.combined,
        ];
        let stages = self.derivatives.iter_mut().chain(&mut self.inner).chain(&mut self.terms);
        for vector in workspaces.into_iter().chain(stages) {
            vector.resize(n, 0.0);
        }
    }

    /// Computes y and its derivative at t + h from y_old.
    fn advance(&mut self, problem: &mut Problem, attempt: Attempt) -> Result<(), SimErrorKind> {
        let h = attempt.h;
        for i in 1..self.tableau.nodes.len() {
            combine(&self.y_old, h, self.tableau.stages[i], &self.derivatives, &mut self.stage);
            let t = self.t_old + h * self.tableau.nodes[i];
            differentiate(problem, t, &self.stage, &mut self.derivatives[i])?;
        }
        combine(&self.y_old, h, self.tableau.weights, &self.derivatives, &mut self.y);
        differentiate(problem, attempt.end, &self.y, &mut self.derivative_end)
    }

    /// The error of the attempt relative to the tolerance.
    fn error(&mut self, problem: &Problem, h: f64, embedded: &Embedded) -> f64 {
        set_weights(problem.settings.tolerance, &self.y_old, &self.nominal, &mut self.weights);
        let n = problem.nominal.len().max(1);
        let mut norms = [0.0; 2];
        let errors = [Some(embedded.error), embedded.coarse_error];
        for (norm, coefficients) in norms.iter_mut().zip(errors) {
            let Some(coefficients) = coefficients else { continue };
            let derivatives = self.derivatives.iter().chain([&self.derivative_end]);
            combine_all(h, coefficients, derivatives, &mut self.combined);
            let blocks = self.combined.chunks_exact(n).zip(self.weights.chunks_exact(n));
            *norm = blocks.map(|(error, weights)| weighted_rms(error, weights)).fold(0.0, f64::max);
        }
        let [fine, coarse] = norms;
        let damped = COARSE * coarse;
        if damped == 0.0 {
            return fine;
        }
        fine * fine / (fine * fine + damped * damped).sqrt()
    }

    /// An error of a derivative times what its direction changes counts as one of y.
    fn set_nominal(&mut self, problem: &Problem) {
        self.nominal.clear();
        self.nominal.extend_from_slice(problem.nominal);
        let mut magnitudes = vec![1.0; problem.system.n_directions()];
        problem.system.directions(&mut magnitudes);
        for magnitude in magnitudes {
            self.nominal.extend(problem.nominal.iter().map(|nominal| nominal / magnitude));
        }
    }

    /// Ends a step, and computes what the interpolation needs.
    fn accept(&mut self, problem: &mut Problem, attempt: Attempt) -> Result<(), SimErrorKind> {
        let (h, tableau) = (attempt.h, self.tableau);
        self.t = attempt.end;
        let Some(embedded) = &tableau.embedded else { return Ok(()) };
        for (i, (node, coefficients)) in embedded.inner_stages.iter().enumerate() {
            let (known, next) = self.inner.split_at_mut(i);
            let derivatives = self.derivatives.iter().chain([&self.derivative_end]).chain(&*known);
            combine(&self.y_old, h, coefficients, derivatives, &mut self.stage);
            differentiate(problem, self.t_old + h * node, &self.stage, &mut next[0])?;
        }
        for (coefficients, term) in embedded.dense.iter().zip(&mut self.terms) {
            let derivatives = self.derivatives.iter().chain([&self.derivative_end]);
            combine_all(h, coefficients, derivatives.chain(&self.inner), term);
        }
        Ok(())
    }
}

/// Writes the derivatives of y and of its derivatives along directions, which follow it.
fn differentiate(
    problem: &mut Problem,
    t: f64,
    y: &[f64],
    out: &mut [f64],
) -> Result<(), SimErrorKind> {
    let n = problem.nominal.len();
    problem.rhs(t, &y[..n], &mut out[..n])?;
    match y.len() == n {
        true => Ok(()),
        false => problem.sensitivity_rhs(t, y, &mut out[n..]),
    }
}

/// out = y + h Σ cᵢ kᵢ
fn combine<'a>(
    y: &[f64],
    h: f64,
    coefficients: &[f64],
    derivatives: impl IntoIterator<Item = &'a Vec<f64>>,
    out: &mut [f64],
) {
    out.copy_from_slice(y);
    for (coefficient, derivative) in coefficients.iter().zip(derivatives) {
        if *coefficient != 0.0 {
            for (out, derivative) in out.iter_mut().zip(derivative) {
                *out += h * coefficient * derivative;
            }
        }
    }
}

/// out = h Σ cᵢ kᵢ
fn combine_all<'a>(
    h: f64,
    coefficients: &[f64],
    derivatives: impl IntoIterator<Item = &'a Vec<f64>>,
    out: &mut [f64],
) {
    out.fill(0.0);
    for (coefficient, derivative) in coefficients.iter().zip(derivatives) {
        if *coefficient != 0.0 {
            for (out, derivative) in out.iter_mut().zip(derivative) {
                *out += coefficient * derivative;
            }
        }
    }
    out.iter_mut().for_each(|out| *out *= h);
}

impl Integrator for ExplicitRungeKutta {
    fn is_explicit(&self) -> bool {
        true
    }

    fn restart(&mut self, problem: &mut Problem, t: f64, y: &[f64]) -> Result<(), SimErrorKind> {
        self.resize(y.len());
        self.y.copy_from_slice(y);
        (self.t, self.t_old) = (t, t);
        self.set_nominal(problem);
        differentiate(problem, t, &self.y, &mut self.derivative_end)?;
        self.is_outdated = false;
        match self.tableau.embedded {
            None => self.control = StepControl::fixed(problem.settings.fixed_step()),
            Some(_) => self.control.start(problem, t, &self.y, &self.derivative_end),
        }
        Ok(())
    }

    fn step(&mut self, problem: &mut Problem, limit: f64) -> Result<(), SimErrorKind> {
        self.t_old = self.t;
        self.y_old.copy_from_slice(&self.y);
        if std::mem::take(&mut self.is_outdated) {
            differentiate(problem, self.t, &self.y, &mut self.derivative_end)?;
        }
        self.derivatives[0].copy_from_slice(&self.derivative_end);
        self.control.begin(problem);
        loop {
            problem.may_continue()?;
            let attempt = Attempt::cut(limit, self.t_old, self.control.h());
            let advanced = self.advance(problem, attempt);
            let Some(embedded) = &self.tableau.embedded else {
                advanced.inspect_err(|_| problem.statistics.newton_failures += 1)?;
                self.accept(problem, attempt)?;
                problem.note_step(attempt.h);
                return Ok(());
            };
            match advanced {
                Ok(()) => {
                    let error = self.error(problem, attempt.h, embedded);
                    let factor = error_factor(error, embedded.order, SAFETY, MOST_FACTOR);
                    if error > 1.0 || error.is_nan() {
                        self.control.reject(problem, attempt, factor)?;
                        continue;
                    }
                    match self.accept(problem, attempt) {
                        Ok(()) => {
                            self.control.accept(problem, attempt, factor);
                            return Ok(());
                        }
                        Err(failure) => self.control.fail(problem, attempt, failure)?,
                    }
                }
                Err(failure) => self.control.fail(problem, attempt, failure)?,
            }
        }
    }

    fn branches_changed(&mut self) {
        self.is_outdated = true;
    }

    fn time(&self) -> f64 {
        self.t
    }

    fn state(&self) -> &[f64] {
        &self.y
    }

    fn interpolate(&self, t: f64, y: &mut [f64]) {
        let h = self.t - self.t_old;
        if h == 0.0 {
            return y.copy_from_slice(&self.y);
        }
        let theta = (t - self.t_old) / h;
        let rest = 1.0 - theta;
        for (i, y) in y.iter_mut().enumerate() {
            let difference = self.y[i] - self.y_old[i];
            let start = h * self.derivatives[0][i] - difference;
            let end = difference - h * self.derivative_end[i] - start;
            let mut tail = 0.0;
            for (order, term) in self.terms.iter().enumerate().rev() {
                let factor = if order % 2 == 0 { theta } else { rest };
                tail = term[i] + factor * tail;
            }
            let inner = start + theta * (end + rest * tail);
            *y = self.y_old[i] + theta * (difference + rest * inner);
        }
    }
}
