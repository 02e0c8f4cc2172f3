//! One torn loop: Newton's method, and where it fails, least squares with damping.
//!
//! ```text
//! from the values at hand, then with zeros replaced by nominal values (at the start only)
//!     Newton's method
//!     otherwise Levenberg and Marquardt's method, then Newton's again
//!     otherwise Newton's method without damping, which leaps over kinks
//!     otherwise the same from beside the guess, where the Jacobian may be less singular
//!     otherwise the same from zero, if the guess is outside the domain
//!     otherwise the global Newton method, where a jump is no error
//!     otherwise the nearest change of sign of a single residual, likewise
//! ```
//!
//! A loop whose Jacobian is singular at an isolated solution is solved. Otherwise it need not have
//! only this one: at the start the one nearest to the start values is taken, with a warning. Later the
//! one nearest to the values at hand is, with a warning as well, where equations that depend on each
//! other leave unknowns open; at a turning point it is an error.

use super::bracketing::{solve_bracketed, solve_next_branch};
use super::difference_quotients::quotient;
use super::execution::run_loop;
use super::global_newton::Continuation;
use super::levenberg_marquardt::LeastSquares;
use super::multiple_roots::is_isolated;
use super::open_loops::{is_on_a_line, is_open, polish, return_from_leap};
use crate::codegen::code::CompiledLoop;
use crate::codegen::memory::Memory;
use crate::sim::{Equations, Failure, Newton, NewtonFailure, Pattern, gather};
use std::sync::Arc;

/// How far beside the guess another attempt begins, relative to its magnitude: small
/// enough to stay on the branch of the solution, and large enough for a Jacobian of its own.
const DISPLACEMENT: f64 = 1e-3;

/// What is tried for a loop.
#[derive(Debug, Clone, Copy)]
pub(super) struct Attempts {
    /// Whether it is one of the initial system.
    pub(super) initial: bool,
    /// Whether the solution may be far from the values at hand.
    pub(super) may_jump: bool,
    /// Whether it is given up where Newton's method fails.
    pub(super) is_brief: bool,
}

/// The workspace of one loop.
#[derive(Debug, Clone)]
pub(super) struct LoopSolver {
    newton: Newton,
    /// Made where Newton's method fails: large loops need much memory for it.
    least_squares: Option<Box<LeastSquares>>,
    continuation: Option<Box<Continuation>>,
    nominal: Arc<[f64]>,
    guess: Vec<f64>,
    /// Where an attempt begins, or what least squares found.
    start: Vec<f64>,
    x: Vec<f64>,
    /// Where least squares ended without a solution, and the residuals there; NaN before.
    nearest: Vec<f64>,
    nearest_residual: Vec<f64>,
    /// Whether the Jacobian is singular at the last solution.
    pub(super) is_singular: bool,
    /// How often it was solved, and its residuals evaluated.
    pub(super) solutions: u64,
    pub(super) evaluations: u64,
}

impl LoopSolver {
    /// For a loop whose unknowns have these magnitudes.
    pub(super) fn new(nominal: Vec<f64>, torn: &CompiledLoop) -> LoopSolver {
        let n = nominal.len();
        LoopSolver {
            newton: Newton::of_pattern(torn.pattern.clone()),
            least_squares: None,
            continuation: None,
            nominal: nominal.into(),
            guess: vec![0.0; n],
            start: vec![0.0; n],
            x: vec![0.0; n],
            nearest: vec![f64::NAN; n],
            nearest_residual: vec![f64::NAN; n],
            is_singular: false,
            solutions: 0,
            evaluations: 0,
        }
    }

    /// The magnitudes of its unknowns.
    pub(super) fn nominal(&self) -> &[f64] {
        &self.nominal
    }

    /// A new simulation begins.
    pub(super) fn forget(&mut self) {
        self.newton.forget();
    }

    /// Solves a loop from the values its unknowns have; they keep these on failure.
    pub(super) fn solve(
        &mut self,
        torn: &CompiledLoop,
        r: &mut Memory,
        Attempts { initial, may_jump, is_brief }: Attempts,
    ) -> Result<(), Failure> {
        for (value, unknown) in self.guess.iter_mut().zip(&torn.unknowns) {
            *value = r[*unknown as usize];
        }
        self.x.copy_from_slice(&self.guess);
        let nominal = self.nominal.clone();
        let mut equations = Evaluation { torn, r, nominal, has_jacobian: false, count: 0 };
        let outcome = match is_brief {
            true => self.attempt_briefly(&mut equations),
            false => self.attempt_everything(&mut equations, initial, may_jump),
        };
        let solution = if outcome.is_ok() { &self.x } else { &self.guess };
        // What follows from the unknowns is computed from the values they end with.
        let evaluated = equations.evaluate(solution);
        self.solutions += 1;
        self.evaluations += equations.count;
        outcome.and(evaluated)
    }

    /// Newton's method from the guess alone.
    fn attempt_briefly(&mut self, equations: &mut Evaluation) -> Result<(), Failure> {
        self.is_singular = false;
        let block = equations.torn.block;
        let solved = self.newton.solve(equations, &mut self.x, &self.nominal);
        solved.map_err(|_| Failure::Newton { block })?;
        self.return_from_leap(equations);
        Ok(())
    }

    /// What leaps because nothing determines it stays at the guess.
    fn return_from_leap(&mut self, equations: &mut Evaluation) {
        let from = (&self.guess[..], &self.nominal[..]);
        self.is_singular |= return_from_leap(equations, from, &mut self.x);
    }

    /// All that the head of this file lists.
    fn attempt_everything(
        &mut self,
        equations: &mut Evaluation,
        initial: bool,
        may_jump: bool,
    ) -> Result<(), Failure> {
        let mut outcome = self.attempt(equations, initial);
        if initial {
            outcome = self.attempt_from_nominal(equations, initial, outcome);
        }
        for side in [1.0, -1.0] {
            if matches!(outcome, Err(Failure::Singular { .. } | Failure::Newton { .. })) {
                for ((x, guess), nominal) in self.x.iter_mut().zip(&self.guess).zip(&*self.nominal)
                {
                    *x = guess + side * DISPLACEMENT * guess.abs().max(*nominal);
                }
                outcome = self.attempt(equations, initial).or(outcome);
            }
        }
        if may_jump && matches!(outcome, Err(Failure::Domain { .. })) {
            // The guess may lie a little outside the domain, as -1e-8 for a root.
            self.x.fill(0.0);
            outcome = self.attempt(equations, initial).or(outcome);
        }
        if outcome.is_err() && may_jump && self.jump(equations, initial) {
            outcome = Ok(());
        }
        if !initial {
            // A fan that starts needs half of its speed at once: the solution at rest has ended.
            outcome = self.attempt_from_nominal(equations, initial, outcome);
        }
        if initial && outcome.is_err() {
            self.x.copy_from_slice(&self.guess);
            let (newton, nominal) = (&mut self.newton, &self.nominal);
            let found = solve_bracketed(newton, equations, &mut self.x, nominal);
            outcome = found.or(outcome);
        }
        outcome
    }

    /// Solves where a jump is no error; whether it did.
    fn jump(&mut self, equations: &mut Evaluation, initial: bool) -> bool {
        self.x.copy_from_slice(&self.guess);
        let (newton, nominal) = (&mut self.newton, &self.nominal);
        let n = nominal.len();
        let continuation = self.continuation.get_or_insert_with(|| Continuation::new(n).into());
        if continuation.solve(newton, equations, &mut self.x, nominal).is_ok() {
            return true;
        }
        self.x.copy_from_slice(&self.guess);
        !initial && solve_next_branch(newton, equations, &mut self.x, nominal).is_ok()
    }

    /// Where least squares ended without a solution, and the residuals there.
    pub(super) fn nearest(&self) -> Option<(&[f64], &[f64])> {
        let is_known = self.nearest_residual.iter().all(|residual| residual.is_finite());
        is_known.then_some((&self.nearest, &self.nearest_residual))
    }

    /// Where everything else failed: with zeros replaced by nominal values.
    fn attempt_from_nominal(
        &mut self,
        equations: &mut Evaluation,
        initial: bool,
        outcome: Result<(), Failure>,
    ) -> Result<(), Failure> {
        let is_zero = |x: f64, nominal: f64| x.abs() <= DISPLACEMENT * nominal;
        let mut pairs = self.guess.iter().zip(&*self.nominal);
        if outcome.is_ok() || !pairs.any(|(guess, nominal)| is_zero(*guess, *nominal)) {
            return outcome;
        }
        for ((x, guess), nominal) in self.x.iter_mut().zip(&self.guess).zip(&*self.nominal) {
            *x = if is_zero(*guess, *nominal) { *nominal } else { *guess };
        }
        self.attempt(equations, initial).or(outcome)
    }

    /// Solves from x.
    fn attempt(&mut self, equations: &mut Evaluation, initial: bool) -> Result<(), Failure> {
        self.attempt_from_x(equations, initial)?;
        self.return_from_leap(equations);
        Ok(())
    }

    fn attempt_from_x(&mut self, equations: &mut Evaluation, initial: bool) -> Result<(), Failure> {
        let block = equations.torn.block;
        self.is_singular = false;
        self.start.copy_from_slice(&self.x);
        let first = self.newton.solve(equations, &mut self.x, &self.nominal);
        let Err(failure) = first else { return Ok(()) };
        self.x.copy_from_slice(&self.start);
        let n = self.x.len();
        let least_squares = self.least_squares.get_or_insert_with(|| LeastSquares::new(n).into());
        let near = least_squares.solve(equations, &mut self.x, &self.nominal);
        if near.is_err() {
            self.nearest.copy_from_slice(&self.x);
            if equations.residual(&self.x, &mut self.nearest_residual).is_err() {
                self.nearest_residual.fill(f64::NAN);
            }
        }
        if near.is_ok() {
            self.start.copy_from_slice(&self.x);
            match self.newton.solve(equations, &mut self.x, &self.nominal) {
                Ok(()) => return Ok(()),
                Err(NewtonFailure::Singular)
                    if is_isolated(equations, &self.start, &self.nominal) =>
                {
                    self.x.copy_from_slice(&self.start);
                    return Ok(());
                }
                // A pivot that is a rounding error makes steps without end of a singular Jacobian.
                Err(_)
                    if !initial
                        && (is_open(equations, &self.start, &self.nominal)
                            || is_on_a_line(equations, &self.start, &self.nominal)) =>
                {
                    self.is_singular = true;
                    self.x.copy_from_slice(&self.start);
                    polish(equations, &mut self.x, &self.nominal);
                    return Ok(());
                }
                Err(NewtonFailure::Singular) if !initial => {
                    return Err(Failure::Singular { block });
                }
                Err(failure) if initial => {
                    self.is_singular = failure == NewtonFailure::Singular;
                    self.x.copy_from_slice(&self.start);
                    return Ok(());
                }
                Err(_) => {}
            }
        }
        self.x.copy_from_slice(&self.guess);
        if self.newton.solve_undamped(equations, &mut self.x, &self.nominal).is_ok() {
            return Ok(());
        }
        Err(match failure {
            NewtonFailure::Evaluation(failure) => failure,
            NewtonFailure::Singular => Failure::Singular { block },
            NewtonFailure::NoProgress => Failure::Newton { block },
        })
    }
}

/// A loop evaluated in the registers.
struct Evaluation<'a> {
    torn: &'a CompiledLoop,
    r: &'a mut Memory,
    nominal: Arc<[f64]>,
    /// Whether the registers hold the Jacobian at the unknowns that they hold.
    has_jacobian: bool,
    /// How often it was evaluated.
    count: u64,
}

impl Evaluation<'_> {
    /// Computes residuals and Jacobian. Only a residual without a value is a failure.
    fn evaluate(&mut self, x: &[f64]) -> Result<(), Failure> {
        for (unknown, value) in self.torn.unknowns.iter().zip(x) {
            self.r[*unknown as usize] = *value;
        }
        self.count += 1;
        let done = run_loop(self.torn, self.r);
        self.has_jacobian = done.is_ok();
        match done {
            Err(Failure::Domain { .. }) if self.r[self.torn.has_residuals as usize] == 1.0 => {
                Ok(())
            }
            other => other,
        }
    }

    /// Computes the Jacobian, if it has values.
    fn differentiate(&mut self, x: &[f64]) -> Result<(), Failure> {
        let here = self.torn.unknowns.iter().zip(x).all(|(u, x)| self.r[*u as usize] == *x);
        if here { Ok(()) } else { self.evaluate(x) }
    }

    /// The Jacobian where a derivative has no value.
    fn difference_jacobian(&mut self, x: &[f64], out: &mut [f64]) -> Result<(), Failure> {
        let n = x.len();
        let (mut before, mut moved) = (vec![0.0; n], x.to_vec());
        self.residual(x, &mut before)?;
        for (j, column) in out.chunks_exact_mut(n).enumerate() {
            quotient(x[j], self.nominal[j], &before, column, |value, out| {
                moved[j] = value;
                self.residual(&moved, out)
            })?;
            moved[j] = x[j];
        }
        self.evaluate(x)
    }
}

impl Equations for Evaluation<'_> {
    fn residual(&mut self, x: &[f64], out: &mut [f64]) -> Result<(), Failure> {
        self.evaluate(x)?;
        for (out, register) in out.iter_mut().zip(&self.torn.residuals) {
            *out = self.r[*register as usize];
        }
        Ok(())
    }

    fn jacobian(&mut self, x: &[f64], out: &mut [f64]) -> Result<(), Failure> {
        self.differentiate(x)?;
        if !self.has_jacobian {
            return self.difference_jacobian(x, out);
        }
        let n = x.len();
        out.fill(0.0);
        let pattern = &self.torn.pattern;
        for column in 0..n {
            for at in pattern.column(column) {
                out[column * n + pattern.rows[at]] = self.r[self.torn.jacobian[at] as usize];
            }
        }
        Ok(())
    }

    fn nonzeros(&mut self, x: &[f64], pattern: &Pattern, out: &mut [f64]) -> Result<(), Failure> {
        self.differentiate(x)?;
        if !self.has_jacobian {
            let mut all = vec![0.0; x.len() * x.len()];
            self.difference_jacobian(x, &mut all)?;
            gather(&all, pattern, out);
            return Ok(());
        }
        for (out, register) in out.iter_mut().zip(&self.torn.jacobian) {
            *out = self.r[*register as usize];
        }
        Ok(())
    }
}
