//! The exact Jacobian of chosen variables, as a model that is linearized needs them.

use super::execution::read;
use super::system::System;
use crate::codegen::jacobian::differentiate_sequence;
use crate::codegen::oscillations::TIME;
use crate::codegen::sequence::{compile_outputs, expressions, right_sides, slice};
use crate::sim::{Failure, Residual};
use crate::symbolic::{Expr, Pool, VarId};
use nalgebra::DMatrix;

impl System {
    /// ∂(f, g)/∂y: the right sides of the states and the residuals of the algebraic loops, for the
    /// states and the iteration variables of the loops.
    pub fn dense_jacobian(&mut self, t: f64, y: &[f64]) -> Result<DMatrix<f64>, Failure> {
        let pattern = self.pattern().clone();
        let mut values = vec![0.0; pattern.rows.len()];
        self.jacobian(t, y, &mut values)?;
        let mut dense = DMatrix::zeros(pattern.n, pattern.n);
        for column in 0..pattern.n {
            for entry in pattern.column(column) {
                dense[(pattern.rows[entry], column)] = values[entry];
            }
        }
        Ok(dense)
    }

    /// ∂v/∂y of variables v (positions in [`Program::variables`](crate::codegen::Program::variables)): a row
    /// for each, columns as those of [`System::dense_jacobian`].
    pub fn jacobian_of(
        &self,
        variables: &[usize],
        t: f64,
        y: &[f64],
    ) -> Result<DMatrix<f64>, Failure> {
        let program = self.program.clone();
        let mut pool = program.sorted.dae.pool.clone();
        let outputs = expressions(&program, &mut pool, variables);
        self.derivatives_of(pool, &outputs, &program.continuous.unknowns, (t, y))
    }

    /// ∂(f, g, v)/∂t of the right sides of the states, the residuals of the algebraic loops and variables
    /// v: a row for each, one column.
    pub(super) fn time_derivatives(
        &self,
        variables: &[usize],
        t: f64,
        y: &[f64],
    ) -> Result<DMatrix<f64>, Failure> {
        let program = self.program.clone();
        let mut pool = program.sorted.dae.pool.clone();
        let mut outputs = right_sides(&program.sorted, &mut pool);
        outputs.extend(&program.continuous.residuals);
        outputs.extend(expressions(&program, &mut pool, variables));
        self.derivatives_of(pool, &outputs, &[TIME], (t, y))
    }

    /// Derivatives of outputs by variables that no equation determines: a row for each output.
    fn derivatives_of(
        &self,
        mut pool: Pool,
        outputs: &[Expr],
        columns: &[VarId],
        (t, y): (f64, &[f64]),
    ) -> Result<DMatrix<f64>, Failure> {
        let program = self.program.clone();
        let needed = slice(&pool, &program.continuous.integrated, outputs);
        let mut next = program.sorted.dae.variables.len() as u32;
        let derivatives = differentiate_sequence(&mut pool, &needed, outputs, columns, &mut next);
        let places: Vec<(usize, usize)> = derivatives
            .rows
            .iter()
            .enumerate()
            .flat_map(|(row, entries)| entries.keys().map(move |column| (row, *column)))
            .collect();
        let entries: Vec<_> =
            derivatives.rows.iter().flat_map(|row| row.values().copied()).collect();
        let mut registers = program.registers.clone();
        let code = compile_outputs(&pool, &mut registers, &derivatives.sequence, &entries);
        let mut system = self.clone();
        system.registers.extend(&registers);
        system.load(t, y);
        let mut values = vec![0.0; entries.len()];
        read(&code, &mut system.registers, &mut values)?;
        let mut dense = DMatrix::zeros(outputs.len(), columns.len());
        for (place, value) in places.into_iter().zip(values) {
            dense[place] = value;
        }
        Ok(dense)
    }
}
