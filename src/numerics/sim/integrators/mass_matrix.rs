//! The matrix s M − J of one-step methods, M = diag(I, 0), with its factors.

use super::Problem;
use crate::sim::linear::Factorization;
use crate::sim::{Pattern, Residual, SimErrorKind};

/// s M − J for a Jacobian that is kept, columns scaled by nominal values.
#[derive(Default)]
pub(crate) struct ShiftedMatrix {
    pattern: Pattern,
    factors: Option<Factorization>,
    jacobian: Vec<f64>,
    values: Vec<f64>,
}

impl ShiftedMatrix {
    /// For the Jacobians of a problem, whose pattern holds the diagonal of the differential variables.
    pub fn prepare(&mut self, problem: &Problem) {
        let pattern = problem.system.pattern();
        if self.factors.is_none() || self.pattern != *pattern {
            self.pattern = pattern.clone();
            self.factors = Some(Factorization::new(pattern, &problem.coupled()));
            self.jacobian.resize(pattern.rows.len(), 0.0);
            self.values.resize(pattern.rows.len(), 0.0);
        }
        if let Some(factors) = &mut self.factors {
            factors.forget();
        }
    }

    /// Evaluates the Jacobian.
    pub fn evaluate(
        &mut self,
        problem: &mut Problem,
        t: f64,
        y: &[f64],
    ) -> Result<(), SimErrorKind> {
        problem.jacobian(t, y, &mut self.jacobian)
    }

    /// The nonzeros of a column of J.
    pub fn column(&self, column: usize) -> &[f64] {
        &self.jacobian[self.pattern.column(column)]
    }

    /// Factorises s M − J.
    pub fn factorize(
        &mut self,
        problem: &mut Problem,
        s: f64,
        n_differential: usize,
    ) -> Result<(), SimErrorKind> {
        for column in 0..self.pattern.n {
            let scale = problem.nominal[column];
            for k in self.pattern.column(column) {
                let row = self.pattern.rows[k];
                let on_diagonal = row == column && row < n_differential;
                let shift = if on_diagonal { s } else { 0.0 };
                self.values[k] = scale * (shift - self.jacobian[k]);
            }
        }
        problem.statistics.factorizations += 1;
        let factors = self.factors.as_mut().expect("prepared at the restart");
        factors.factorize(&self.values).map_err(|_| SimErrorKind::Singular)
    }

    /// Replaces b by the solution.
    pub fn solve(&mut self, nominal: &[f64], b: &mut [f64]) {
        self.factors.as_mut().expect("prepared at the restart").solve(b);
        b.iter_mut().zip(nominal).for_each(|(b, nominal)| *b *= nominal);
    }
}
