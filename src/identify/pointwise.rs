//! Static curves: the system has no states and X is an input, so that every point is a solution of its
//! own. X is set, the system solved, Y read.

use super::Instance;
use crate::sim::{Failure, SimError, SimErrorKind};

/// Evaluates points one by one; keeps its memory.
#[derive(Debug, Default)]
pub(crate) struct Pointwise {
    /// Values of the varied parameters, that which stands for X at the end.
    values: Vec<f64>,
    unknowns: Vec<f64>,
    observed: Vec<f64>,
}

impl Pointwise {
    /// Writes observed variable `column` at each `x` for these values of the parameters; nothing of
    /// one point remains for the next.
    ///
    /// # Errors
    ///
    /// Why a point has no solution, in one sentence.
    pub fn evaluate(
        &mut self,
        instance: &mut dyn Instance,
        at: (&[f64], f64),
        (column, x): (usize, &[f64]),
        out: &mut [f64],
    ) -> Result<(), String> {
        for (value, &x) in out.iter_mut().zip(x) {
            self.solve(instance, at, x)?;
            *value = self.observed[column];
        }
        Ok(())
    }

    /// As [`evaluate`](Pointwise::evaluate) with an instance that differentiates, `observed` variables
    /// in all; the derivatives by the parameters follow each other point by point.
    ///
    /// # Errors
    ///
    /// Why a point has no solution or no derivatives, in one sentence.
    pub fn differentiate(
        &mut self,
        instance: &mut dyn Instance,
        at: (&[f64], f64),
        (column, observed, x): (usize, usize, &[f64]),
        (out, derivatives): (&mut [f64], &mut Vec<f64>),
    ) -> Result<(), String> {
        for (value, &x) in out.iter_mut().zip(x) {
            self.solve(instance, at, x)?;
            *value = self.observed[column];
            let of = |parameter: usize| self.observed[observed * (parameter + 1) + column];
            derivatives.extend((0..at.0.len()).map(of));
        }
        Ok(())
    }

    /// One point.
    fn solve(
        &mut self,
        instance: &mut dyn Instance,
        (parameters, time): (&[f64], f64),
        x: f64,
    ) -> Result<(), String> {
        self.values.clear();
        self.values.extend_from_slice(parameters);
        self.values.push(x);
        instance.set(&self.values).map_err(|fault| fault.message)?;
        let Some(system) = instance.system() else {
            return Err("the model cannot be solved point by point".to_owned());
        };
        let unknowns = system.n_differential() + system.n_algebraic();
        self.unknowns.clear();
        self.unknowns.resize(unknowns * (1 + system.n_directions()), 0.0);
        self.observed.clear();
        self.observed.resize(system.n_observed(), f64::NAN);
        let solved = system
            .initialize(time, &mut self.unknowns)
            .map_err(SimErrorKind::Initialization)
            .and_then(|()| {
                let checked = system.check(time, &self.unknowns);
                let read = |()| system.observe(time, &self.unknowns, &mut self.observed);
                checked.and_then(read).map_err(|failure: Failure| SimErrorKind::Evaluation(failure))
            });
        solved.map_err(|kind| {
            let error = SimError { time, kind, offending: None };
            format!("{} (at X = {x})", instance.explain(&error))
        })
    }
}
