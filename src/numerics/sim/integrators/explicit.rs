//! Explicit Runge-Kutta methods from their tableaus, with fixed or variable step.
//!
//! ```text
//! kᵢ = f(t + cᵢ h, x + h Σⱼ aᵢⱼ kⱼ);  x₁ = x + h Σ bᵢ kᵢ
//! ```
//!
//! Between steps: cubic Hermite interpolation, with the term of order 4 where the tableau has one.
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

/// What a method with variable step knows besides. The last of the seven derivatives is the one at the
/// end of the step.
pub(crate) struct Embedded {
    /// Order of the method the error is measured against.
    pub(super) order: i32,
    /// Error = h Σ eᵢ kᵢ
    pub(super) error: [f64; 7],
    /// Term of order 4 of the interpolation = h Σ dᵢ kᵢ
    pub(super) dense: [f64; 7],
}

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
    /// Whether the derivative at the end is another one since.
    is_outdated: bool,
    /// Error estimate, then term of order 4 of the interpolation.
    combined: Vec<f64>,
}

impl ExplicitRungeKutta {
    pub fn new(tableau: &'static Tableau) -> ExplicitRungeKutta {
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
            is_outdated: false,
            combined: Vec::new(),
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
        for vector in workspaces.into_iter().chain(&mut self.derivatives) {
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

    /// Writes h Σ cᵢ kᵢ over all derivatives and the one at the end.
    fn combine_all(&mut self, h: f64, coefficients: &[f64; 7]) {
        for (i, combined) in self.combined.iter_mut().enumerate() {
            let derivatives = self.derivatives.iter().chain([&self.derivative_end]);
            let sum: f64 =
                coefficients.iter().zip(derivatives).map(|(c, derivative)| c * derivative[i]).sum();
            *combined = h * sum;
        }
    }

    /// The error of the attempt relative to the tolerance.
    fn error(&mut self, problem: &Problem, h: f64, embedded: &Embedded) -> f64 {
        self.combine_all(h, &embedded.error);
        set_weights(problem.settings.tolerance, &self.y_old, &self.nominal, &mut self.weights);
        let n = problem.nominal.len().max(1);
        let blocks = self.combined.chunks_exact(n).zip(self.weights.chunks_exact(n));
        blocks.map(|(error, weights)| weighted_rms(error, weights)).fold(0.0, f64::max)
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

    fn accept(&mut self, attempt: Attempt) {
        match &self.tableau.embedded {
            Some(embedded) => self.combine_all(attempt.h, &embedded.dense),
            None => self.combined.fill(0.0),
        }
        self.t = attempt.end;
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
fn combine(y: &[f64], h: f64, coefficients: &[f64], derivatives: &[Vec<f64>], out: &mut [f64]) {
    out.copy_from_slice(y);
    for (coefficient, derivative) in coefficients.iter().zip(derivatives) {
        for (out, derivative) in out.iter_mut().zip(derivative) {
            *out += h * coefficient * derivative;
        }
    }
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
        self.control.begin(problem, self.t);
        loop {
            problem.may_continue()?;
            let attempt = Attempt::cut(limit, self.t_old, self.control.h());
            let advanced = self.advance(problem, attempt);
            let Some(embedded) = &self.tableau.embedded else {
                advanced.inspect_err(|_| problem.statistics.newton_failures += 1)?;
                self.accept(attempt);
                problem.statistics.steps += 1;
                return Ok(());
            };
            match advanced {
                Ok(()) => {
                    let error = self.error(problem, attempt.h, embedded);
                    let factor = error_factor(error, embedded.order, SAFETY, MOST_FACTOR);
                    if error <= 1.0 {
                        self.accept(attempt);
                        self.control.accept(problem, attempt, factor);
                        return Ok(());
                    }
                    self.control.reject(problem, attempt, factor)?;
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
            let inner = start + theta * (end + rest * self.combined[i]);
            *y = self.y_old[i] + theta * (difference + rest * inner);
        }
    }
}
