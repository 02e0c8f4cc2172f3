//! Rodas4: a Rosenbrock method of order 4 with six stages, L-stable and stiffly accurate, for
//! x' = f, 0 = g.
//!
//! With M = diag(I, 0), J = ∂(f, g)/∂y and F = (f, g):
//!
//! ```text
//! (M/(hγ) − J) uᵢ = F(t + αᵢ h, y + Σ aᵢⱼ uⱼ) + M Σ (cᵢⱼ/h) uⱼ + γᵢ h ∂F/∂t,   i = 1 … 6
//! y₁ = y + Σ a₅ⱼ uⱼ + u₅ + u₆        error u₆
//! ```
//!
//! Nothing is iterated and nothing kept from one step to the next, so events cost no more than a
//! step. ∂F/∂t is a difference. Between steps a polynomial of order 3 gives y. F at the end of a step
//! is evaluated before the step is accepted: where F has no value there, as past the zero of a
//! root, the step was too long.
//!
//! Reference: [Hairer & Wanner 1996](gapilib_base::bibliography#hairer-wanner-1996), sections IV.7 and VI.4.

use super::mass_matrix::ShiftedMatrix;
use super::step_control::{Attempt, SAFETY, StepControl, error_factor};
use super::{Integrator, Problem};
use crate::registry::Entry;
use crate::sim::norm::{set_weights, weighted_rms};
use crate::sim::{Events, Residual, SimErrorKind};

pub const ENTRY: Entry<dyn Integrator> = Entry {
    name: "rodas4",
    aliases: &["rodas", "rosenbrock"],
    summary: "Rosenbrock method Rodas4, L-stable, order 4, variable step",
    reference: "hairer-wanner-1996",
    make: |_| Ok(Box::new(Rodas::default())),
};

const STAGES: usize = 6;
const GAMMA: f64 = 0.25;
const ALPHA: [f64; STAGES] = [0.0, 0.386, 0.21, 0.63, 1.0, 1.0];
/// Coefficients of h ∂F/∂t.
const TIME: [f64; STAGES] = [0.25, -0.1043, 0.1035, -0.0362, 0.0, 0.0];
/// aᵢⱼ; the last two rows differ by u₅ alone.
const A: [[f64; 4]; 5] = [
    [0.0, 0.0, 0.0, 0.0],
    [1.544, 0.0, 0.0, 0.0],
    [0.9466785280815826, 0.2557011698983284, 0.0, 0.0],
    [3.314825187068521, 2.896124015972201, 0.9986419139977817, 0.0],
    [1.221224509226641, 6.019134481288629, 12.53708332932087, -0.687886036105895],
];
const C: [[f64; 5]; STAGES] = [
    [0.0, 0.0, 0.0, 0.0, 0.0],
    [-5.6688, 0.0, 0.0, 0.0, 0.0],
    [-2.430093356833875, -0.2063599157091915, 0.0, 0.0, 0.0],
    [-0.1073529058151375, -9.594562251023355, -20.47028614809616, 0.0, 0.0],
    [7.496443313967647, -10.24680431464352, -33.99990352819905, 11.7089089320616, 0.0],
    [
        8.083246795921522,
        -7.981132988064893,
        -31.52159432874371,
        16.31930543123136,
        -6.058818238834054,
    ],
];
/// Coefficients of the interpolation.
const DENSE: [[f64; 5]; 2] = [
    [
        10.12623508344586,
        -7.487995877610167,
        -34.80091861555747,
        -7.992771707568823,
        1.025137723295662,
    ],
    [
        -0.6762803392801253,
        6.087714651680015,
        16.43084320892478,
        24.76722511418386,
        -6.594389125716872,
    ],
];
/// The local error is kept below this part of the tolerance, so that the global one meets it.
const ERROR_PART: f64 = 0.5;

/// Order of the embedded method, which the error is measured against.
const ERROR_ORDER: i32 = 3;
/// A step is at most this many times longer than the one before; the choice of Hairer & Wanner.
const MOST_FACTOR: f64 = 6.0;

/// The method with its workspace.
#[derive(Default)]
struct Rodas {
    n: usize,
    n_differential: usize,
    t: f64,
    t_old: f64,
    control: StepControl,
    y: Vec<f64>,
    y_old: Vec<f64>,
    trial: Vec<f64>,
    rhs: Vec<f64>,
    /// F at the start of the step, whether it is known, and its derivative by time.
    first: Vec<f64>,
    knows_first: bool,
    time_derivative: Vec<f64>,
    stages: [Vec<f64>; STAGES],
    dense: [Vec<f64>; 2],
    weights: Vec<f64>,
    matrix: ShiftedMatrix,
}

impl Rodas {
    fn resize(&mut self, n: usize) {
        self.n = n;
        let single = [
            &mut self.y,
            &mut self.y_old,
            &mut self.trial,
            &mut self.rhs,
            &mut self.first,
            &mut self.time_derivative,
        ];
        for vector in single.into_iter().chain(&mut self.stages).chain(&mut self.dense) {
            vector.resize(n, 0.0);
        }
    }

    /// F, ∂F/∂t and J at the start of a step.
    fn linearize(&mut self, problem: &mut Problem) -> Result<(), SimErrorKind> {
        if !std::mem::take(&mut self.knows_first) {
            problem.rhs(self.t, &self.y, &mut self.first)?;
        }
        let mut delta = (f64::EPSILON * self.t.abs().max(1e-5)).sqrt().min(self.control.h());
        if problem.rhs(self.t + delta, &self.y, &mut self.time_derivative).is_err() {
            // The domain of F may end here, as that of sqrt(1 - t) at t = 1.
            delta = -delta;
            problem.rhs(self.t + delta, &self.y, &mut self.time_derivative)?;
        }
        for (derivative, first) in self.time_derivative.iter_mut().zip(&self.first) {
            *derivative = (*derivative - first) / delta;
        }
        self.matrix.evaluate(problem, self.t, &self.y)
    }

    /// Computes all stages with step h; `trial` is y at the end then.
    fn attempt(&mut self, problem: &mut Problem, h: f64) -> Result<(), SimErrorKind> {
        self.matrix.factorize(problem, 1.0 / (h * GAMMA), self.n_differential)?;
        for i in 0..STAGES {
            if i == 0 {
                self.rhs.copy_from_slice(&self.first);
            } else {
                self.stage_point(i);
                problem.rhs(self.t + ALPHA[i] * h, &self.trial, &mut self.rhs)?;
            }
            let (done, rest) = self.stages.split_at_mut(i);
            let stage = &mut rest[0];
            for (k, stage) in stage.iter_mut().enumerate() {
                let mut sum = self.rhs[k] + TIME[i] * h * self.time_derivative[k];
                if k < self.n_differential {
                    let before: f64 = done.iter().zip(&C[i]).map(|(u, c)| c * u[k]).sum();
                    sum += before / h;
                }
                *stage = sum;
            }
            self.matrix.solve(problem.nominal, stage);
        }
        for (trial, last) in self.trial.iter_mut().zip(&self.stages[5]) {
            *trial += last;
        }
        if self.trial.iter().all(|y| y.is_finite()) { Ok(()) } else { Err(SimErrorKind::NotFinite) }
    }

    fn stage_point(&mut self, i: usize) {
        for k in 0..self.n {
            let row = A[i.min(4)].iter().zip(&self.stages);
            let sum: f64 = row.map(|(a, u)| a * u[k]).sum();
            let last = if i == 5 { self.stages[4][k] } else { 0.0 };
            self.trial[k] = self.y[k] + sum + last;
        }
    }

    fn error(&mut self, tolerance: f64, nominal: &[f64]) -> f64 {
        set_weights(ERROR_PART * tolerance, &self.y, nominal, &mut self.weights);
        for (weight, y) in self.weights.iter_mut().zip(&self.trial) {
            *weight = weight.max(ERROR_PART * tolerance * y.abs());
        }
        weighted_rms(&self.stages[5], &self.weights)
    }

    /// Tries a step to `t_new`; the error relative to the tolerance.
    fn try_step(&mut self, problem: &mut Problem, t_new: f64, h: f64) -> Result<f64, SimErrorKind> {
        self.attempt(problem, h)?;
        let error = self.error(problem.settings.tolerance, problem.nominal);
        if error <= 1.0 {
            problem.rhs(t_new, &self.trial, &mut self.rhs)?;
            // The value of a delay at the end is known only after it.
            self.knows_first = !problem.system.remembers();
        }
        Ok(error)
    }

    fn accept(&mut self, t_new: f64) {
        std::mem::swap(&mut self.first, &mut self.rhs);
        std::mem::swap(&mut self.y_old, &mut self.y);
        self.y.copy_from_slice(&self.trial);
        for (dense, row) in self.dense.iter_mut().zip(&DENSE) {
            for (k, dense) in dense.iter_mut().enumerate() {
                *dense = row.iter().zip(&self.stages).map(|(d, u)| d * u[k]).sum();
            }
        }
        (self.t_old, self.t) = (self.t, t_new);
    }
}

impl Integrator for Rodas {
    fn is_explicit(&self) -> bool {
        false
    }

    fn restart(&mut self, problem: &mut Problem, t: f64, y: &[f64]) -> Result<(), SimErrorKind> {
        self.resize(y.len());
        self.weights.resize(problem.n_tested(), 0.0);
        self.n_differential = problem.system.n_differential();
        self.matrix.prepare(problem);
        (self.t, self.t_old) = (t, t);
        self.y.copy_from_slice(y);
        self.y_old.copy_from_slice(y);
        self.dense.iter_mut().for_each(|dense| dense.fill(0.0));
        problem.rhs(t, y, &mut self.first)?;
        self.knows_first = true;
        self.control.restart(problem, t, y, &self.first);
        Ok(())
    }

    fn step(&mut self, problem: &mut Problem, limit: f64) -> Result<(), SimErrorKind> {
        self.control.begin(problem);
        self.linearize(problem)?;
        loop {
            problem.may_continue()?;
            let attempt = Attempt::towards(limit, self.t, self.control.h());
            match self.try_step(problem, attempt.end, attempt.h) {
                Ok(error) => {
                    let factor = error_factor(error, ERROR_ORDER, SAFETY, MOST_FACTOR);
                    if error <= 1.0 {
                        self.accept(attempt.end);
                        self.control.accept(problem, attempt, factor);
                        return Ok(());
                    }
                    self.control.reject(problem, attempt, factor)?;
                }
                Err(failure) => self.control.fail(problem, attempt, failure)?,
            }
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
        self.knows_first = false;
        true
    }

    fn branches_changed(&mut self) {
        self.knows_first = false;
    }

    fn time(&self) -> f64 {
        self.t
    }

    fn next_step(&self) -> Option<f64> {
        Some(self.control.h()).filter(|h| *h > 0.0)
    }

    fn state(&self) -> &[f64] {
        &self.y
    }

    fn interpolate(&self, t: f64, y: &mut [f64]) {
        let h = self.t - self.t_old;
        let s = if h > 0.0 { (t - self.t_old) / h } else { 1.0 };
        for (k, y) in y.iter_mut().enumerate() {
            let curve = self.dense[0][k] + s * self.dense[1][k];
            *y = (1.0 - s) * self.y_old[k] + s * (self.y[k] + (1.0 - s) * curve);
        }
    }
}
