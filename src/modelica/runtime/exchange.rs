//! What another simulator asks of a system, as FMI does: event indicators, and derivatives of chosen
//! variables along chosen states.

use super::instants::Stage;
use super::system::System;
use crate::sim::{Failure, Residual};
use nalgebra::DMatrix;

impl System {
    /// Writes the event indicators at (t, y), loops solved inside: each is positive until an event is
    /// due, and negative from then on until the event has been handled.
    ///
    /// # Errors
    /// Something has no value there.
    pub fn event_indicators(&mut self, t: f64, y: &[f64], out: &mut [f64]) -> Result<(), Failure> {
        self.load(t, y);
        self.solve(Stage::Continuous)?;
        let (first, last) = out.split_at_mut(self.program.n_crossings());
        self.distances(first)?;
        let choices = self.loops.choices.iter_mut().zip(&self.program.selections);
        for ((choice, selection), out) in choices.zip(last) {
            *out = choice.quality(selection, &mut self.registers)?;
        }
        Ok(())
    }

    /// Whether a relation or rounding does not have the value at (t, y) that its sides say, loops solved
    /// inside: an event is due that no crossing function will announce any more, as it has crossed
    /// zero already. So it is where a simulation continues next to an event.
    ///
    /// # Errors
    /// Something has no value there.
    pub fn is_event_due(&mut self, t: f64, y: &[f64]) -> Result<bool, Failure> {
        let program = self.program.clone();
        let mut indicators = vec![0.0; program.n_indicators()];
        self.event_indicators(t, y, &mut indicators)?;
        self.relations.has_changed.fill(false);
        let relations = &program.switching.crossing_relations;
        let changes = relations.iter().any(|at| {
            let register = program.switching.relations[*at].register;
            let holds = self.registers[register as usize] != 0.0;
            self.relation_value(*at, holds, t) != holds
        });
        Ok(changes || indicators[relations.len()..].iter().any(|z| *z < 0.0))
    }

    /// Writes what the integrator holds, as the last evaluation has left it: states, and the unknowns of
    /// loops unless these are solved inside.
    pub fn unknowns(&self, y: &mut [f64]) {
        self.unload(y);
    }

    /// The derivatives of the states, in the first rows, and of variables (positions in
    /// [`Program::variables`](crate::codegen::Program::variables)) by the states, at (t, x): loops are
    /// solved inside. Exact where the matrix of the loops is regular.
    ///
    /// # Errors
    /// Something has no value there, or the loops are singular.
    pub fn reduced_jacobian(
        &mut self,
        variables: &[usize],
        t: f64,
        x: &[f64],
    ) -> Result<DMatrix<f64>, Failure> {
        self.load(t, x);
        self.solve(Stage::Continuous)?;
        let (was_inside, n, p) = (self.loops.solves_loops, x.len(), variables.len());
        self.solve_loops(false);
        let m = self.n_algebraic();
        let mut y = vec![0.0; n + m];
        self.unload(&mut y);
        let whole = self.dense_jacobian(t, &y);
        let of_variables = self.jacobian_of(variables, t, &y);
        self.solve_loops(was_inside);
        let (whole, of_variables) = (whole?, of_variables?);
        let mut rows = DMatrix::zeros(n + p, n + m);
        rows.view_mut((0, 0), (n, n + m)).copy_from(&whole.view((0, 0), (n, n + m)));
        rows.view_mut((n, 0), (p, n + m)).copy_from(&of_variables);
        if m == 0 {
            return Ok(rows);
        }
        let (g_x, g_v) = (whole.view((n, 0), (m, n)), whole.view((n, n), (m, m)));
        let Some(v_x) = g_v.into_owned().lu().solve(&g_x.into_owned()) else {
            return Err(Failure::Singular { block: 0 });
        };
        let (of_x, of_v) = (rows.view((0, 0), (n + p, n)), rows.view((0, n), (n + p, m)));
        Ok(of_x - of_v * v_x)
    }
}
