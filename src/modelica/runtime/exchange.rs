//! What another simulator asks of a system, as FMI does: event indicators, derivatives of chosen
//! variables along chosen states, and what it has come to, as numbers.

use super::execution::run;
use super::instants::Clock;
use super::state::DelayState;
use super::system::System;
use crate::codegen::{Program, SensitivityCode};
use crate::sim::{Failure, Residual};
use nalgebra::DMatrix;
use serde::{Deserialize, Serialize};
use std::sync::Arc;

/// What a system has come to at a time: what a system of the same program that was initialized with the
/// same parameters needs to go on from there.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct Snapshot {
    registers: Vec<f64>,
    relations: RelationSnapshot,
    clocks: Vec<Clock>,
    knots_passed: Vec<usize>,
    given: Vec<(u32, f64)>,
    before: Vec<f64>,
    is_sampled: bool,
    past: DelayState,
}

/// What is known of relations between events.
#[derive(Debug, Clone, Serialize, Deserialize)]
struct RelationSnapshot {
    switches: Vec<Option<f64>>,
    is_at_start: bool,
    postponed: Vec<bool>,
    held: Vec<bool>,
    uncertainty: Vec<f64>,
    kept: Vec<(usize, f64)>,
}

/// By what derivatives are taken.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Along {
    /// All states, a column each.
    States,
    /// The time, one column.
    Time,
}

impl Program {
    /// Whether systems of it can continue from a [`Snapshot`]: states that are chosen while a model is
    /// simulated are not part of one.
    pub fn has_snapshots(&self) -> bool {
        self.selections.is_empty()
    }
}

impl System {
    /// Writes the event indicators at (t, y), loops solved inside: each is positive until an event is
    /// due, and negative from then on until the event has been handled.
    ///
    /// # Errors
    /// Something has no value there.
    pub fn event_indicators(&mut self, t: f64, y: &[f64], out: &mut [f64]) -> Result<(), Failure> {
        self.load_with_loops(t, y)?;
        let (first, others) = out.split_at_mut(self.program.n_crossings());
        let (last, transported) = others.split_at_mut(self.loops.choices.len());
        self.distances(first)?;
        self.delays.transported_crossings(&self.program, &mut self.registers, t, transported)?;
        transported.iter_mut().step_by(2).for_each(|z| *z = -*z);
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
        let others = relations.len()..program.n_crossings() + program.selections.len();
        Ok(changes
            || indicators[others].iter().any(|z| *z < 0.0)
            || self.delays.is_at_border(&self.program, &mut self.registers, t)?)
    }

    /// Writes what the integrator holds, as the last evaluation has left it: states, and the unknowns of
    /// loops unless these are solved inside.
    pub fn unknowns(&self, y: &mut [f64]) {
        self.unload(y);
    }

    /// The derivatives of the states, in the first rows, and of variables (positions in
    /// [`Program::variables`](crate::codegen::Program::variables)) by the states, or by the time alone, at
    /// (t, x): loops are solved inside. Exact where the matrix of the loops is regular.
    ///
    /// # Errors
    /// Something has no value there, or the loops are singular.
    pub fn reduced_jacobian(
        &mut self,
        variables: &[usize],
        by: Along,
        t: f64,
        x: &[f64],
    ) -> Result<DMatrix<f64>, Failure> {
        self.load_with_loops(t, x)?;
        let (was_inside, n, p) = (self.loops.solves_loops, x.len(), variables.len());
        self.solve_loops(false);
        let m = self.n_algebraic();
        let mut y = vec![0.0; n + m];
        self.unload(&mut y);
        let whole = self.dense_jacobian(t, &y);
        let of_variables = self.jacobian_of(variables, t, &y);
        let in_time = match by {
            Along::States => Ok(DMatrix::zeros(0, 0)),
            Along::Time => self.time_derivatives(variables, t, &y),
        };
        self.solve_loops(was_inside);
        let (whole, of_variables, in_time) = (whole?, of_variables?, in_time?);
        let mut of_v = DMatrix::zeros(n + p, m);
        of_v.rows_mut(0, n).copy_from(&whole.view((0, n), (n, m)));
        of_v.rows_mut(n, p).copy_from(&of_variables.columns(n, m));
        // The columns asked for, of the right sides and variables, and of the residuals.
        let (of_own, residuals) = match by {
            Along::States => {
                let mut rows = DMatrix::zeros(n + p, n);
                rows.rows_mut(0, n).copy_from(&whole.view((0, 0), (n, n)));
                rows.rows_mut(n, p).copy_from(&of_variables.columns(0, n));
                (rows, whole.view((n, 0), (m, n)).into_owned())
            }
            Along::Time => {
                let residuals = in_time.rows(n, m).into_owned();
                (in_time.remove_rows(n, m), residuals)
            }
        };
        if m == 0 {
            return Ok(of_own);
        }
        let of_loops = whole.view((n, n), (m, m)).into_owned().lu();
        let speeds = of_loops.solve(&residuals).ok_or(Failure::Singular { block: 0 })?;
        Ok(of_own - of_v * speeds)
    }

    /// The derivatives of the states, in the first rows, and of variables by the parameters of a code,
    /// which was made for these variables, at (t, x): what changes at events alone is held.
    ///
    /// # Errors
    /// Something has no value there, or the loops are singular.
    pub fn parameter_jacobian(
        &self,
        code: &Arc<SensitivityCode>,
        t: f64,
        x: &[f64],
    ) -> Result<DMatrix<f64>, Failure> {
        let mut own = self.differentiated(code);
        for register in &code.cleared {
            own.registers[*register as usize] = 0.0;
        }
        run(&code.constants, &mut own.registers)?;
        let mut y = vec![0.0; x.len() * (1 + code.n_directions())];
        y[..x.len()].copy_from_slice(x);
        own.total_derivatives(code, t, &y)
    }

    /// The derivatives of the initial states by the parameters of a code, and below them those that
    /// [`System::parameter_jacobian`] has, total ones: the initial states move with the parameters.
    ///
    /// # Errors
    /// The initial system has no solution, or something has no value there.
    pub fn initial_jacobian(
        &self,
        code: &Arc<SensitivityCode>,
        t: f64,
    ) -> Result<DMatrix<f64>, Failure> {
        let mut own = self.differentiated(code);
        let (n, m) = (own.n_differential(), code.n_directions());
        let mut y = vec![0.0; n * (1 + m)];
        own.initialize(t, &mut y)?;
        let below = own.total_derivatives(code, t, &y)?;
        let mut all = below.insert_rows(0, n, 0.0);
        for (column, direction) in code.directions.iter().enumerate() {
            let Some(direction) = direction else { continue };
            let derivatives = &y[n * (1 + direction)..][..n];
            all.view_mut((0, column), (n, 1)).copy_from_slice(derivatives);
        }
        Ok(all)
    }

    /// A copy that carries the derivatives of a code, with its loops solved inside.
    fn differentiated(&self, code: &Arc<SensitivityCode>) -> System {
        let mut own = self.clone();
        own.differentiate(Some(code));
        own.solve_loops(true);
        own
    }

    /// The derivatives of the right sides, in the first rows, and of the observed variables along
    /// those of the states in y.
    fn total_derivatives(
        &mut self,
        code: &SensitivityCode,
        t: f64,
        y: &[f64],
    ) -> Result<DMatrix<f64>, Failure> {
        let (n, m) = (self.n_differential(), code.n_directions());
        let mut observed = vec![0.0; self.n_observed()];
        // This solves the loops, and finds the derivatives of their unknowns.
        self.observe(t, y, &mut observed)?;
        let mut right_sides = vec![0.0; code.rhs.len()];
        self.right_sides_along(&mut right_sides)?;
        let (columns, stride) = (code.n_parameters(), right_sides.len() / m.max(1));
        let p = observed.len() / (1 + columns);
        let mut all = DMatrix::zeros(n + p, columns);
        for (column, direction) in code.directions.iter().enumerate() {
            if let Some(direction) = direction {
                let derivatives = &right_sides[direction * stride..][..n];
                all.view_mut((0, column), (n, 1)).copy_from_slice(derivatives);
            }
            let derivatives = &observed[p * (1 + column)..][..p];
            all.view_mut((n, column), (p, 1)).copy_from_slice(derivatives);
        }
        Ok(all)
    }

    /// What the system has come to.
    pub fn snapshot(&self) -> Snapshot {
        let (relations, events, inputs) = (&self.relations, &self.events, &self.inputs);
        Snapshot {
            registers: self.registers.registers.clone(),
            relations: RelationSnapshot {
                switches: relations.switches.clone(),
                is_at_start: relations.is_at_start,
                postponed: relations.postponed.clone(),
                held: relations.held.clone(),
                uncertainty: relations.uncertainty.clone(),
                kept: relations.kept.clone(),
            },
            clocks: events.clocks.clone(),
            knots_passed: inputs.knots_passed.clone(),
            given: inputs.given.clone(),
            before: events.before.clone(),
            is_sampled: events.sampled,
            past: self.delays.clone(),
        }
    }

    /// Continues from there; whether it is a snapshot of this program.
    pub fn continue_from(&mut self, snapshot: Snapshot) -> bool {
        let (relations, events) = (&mut self.relations, &mut self.events);
        let inputs = &mut self.inputs;
        let Snapshot { registers, relations: of_relations, .. } = snapshot;
        let fits = registers.len() == self.registers.registers.len()
            && of_relations.switches.len() == relations.switches.len()
            && of_relations.postponed.len() == relations.postponed.len()
            && of_relations.held.len() == relations.held.len()
            && of_relations.uncertainty.len() == relations.uncertainty.len()
            && of_relations.kept.iter().all(|(at, _)| *at < relations.switches.len())
            && snapshot.clocks.len() == events.clocks.len()
            && snapshot.knots_passed.len() == inputs.knots_passed.len()
            && snapshot.before.len() == events.before.len()
            && snapshot.past.fits(&self.program)
            && snapshot.given.iter().all(|(at, _)| (*at as usize) < registers.len());
        if !fits {
            return false;
        }
        self.loops.is_solved = false;
        self.registers.registers = registers;
        relations.switches = of_relations.switches;
        relations.is_at_start = of_relations.is_at_start;
        relations.postponed = of_relations.postponed;
        relations.held = of_relations.held;
        relations.uncertainty = of_relations.uncertainty;
        relations.kept = of_relations.kept;
        events.clocks = snapshot.clocks;
        inputs.knots_passed = snapshot.knots_passed;
        inputs.given = snapshot.given;
        events.before = snapshot.before;
        events.sampled = snapshot.is_sampled;
        self.delays = snapshot.past;
        true
    }
}
