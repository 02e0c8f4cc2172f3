//! Derivatives along directions, and backwards, from exact Jacobians.

use crate::codegen::{Access, SensitivityCode};
use crate::fmi::export::{Place, Setter};
use crate::instance::{Instance, Phase, Wrong};
use crate::runtime::Along;
use crate::sim::{Failure, SimErrorKind};
use nalgebra::DMatrix;
use std::sync::Arc;

/// Writes a matrix times a vector.
fn product(matrix: &DMatrix<f64>, vector: &[f64], out: &mut [f64]) {
    for (out, row) in out.iter_mut().zip(matrix.row_iter()) {
        *out = row.iter().zip(vector).map(|(entry, other)| entry * other).sum();
    }
}

impl Instance {
    /// ∂unknowns/∂knowns at the values at hand, by value references: rows of the unknowns, columns of
    /// the knowns, which are continuous states and inputs, parameters, and the time; during the
    /// initialization parameters and start values alone (FMI 3.0.2 §2.2.11).
    fn jacobian(&mut self, unknowns: &[u32], knowns: &[u32]) -> Result<DMatrix<f64>, Wrong> {
        let phases = [Phase::Initialization, Phase::Event, Phase::Continuous, Phase::Step];
        self.expect(&phases, "derivatives are known from the initialization on")?;
        if self.model.program.has_past() {
            return Err("derivatives are not known: the model reads values of the past".into());
        }
        let columns: Vec<Column> =
            knowns.iter().map(|known| self.column(*known)).collect::<Result<_, _>>()?;
        let mut variables: Vec<usize> = Vec::new();
        let mut rows: Vec<Row> = Vec::new();
        for unknown in unknowns {
            rows.push(self.row(*unknown, &mut variables)?);
        }
        let n = self.state.x.len();
        // The derivatives of the initial states come first.
        let first = if self.state.phase == Phase::Initialization { n } else { 0 };
        let mut out = DMatrix::zeros(unknowns.len(), knowns.len());
        for (at, column) in columns.iter().enumerate() {
            let all = self.column_of(*column, &variables)?;
            for (place, row) in rows.iter().enumerate() {
                out[(place, at)] = match (*row, *column) {
                    (Row::Time, Column::Time) => 1.0,
                    (Row::State(own), Column::State(state, sign)) if own == state => sign,
                    (Row::State(own), Column::Initial(_)) => all[own],
                    (Row::Time | Row::State(_), _) => 0.0,
                    (Row::Derivative(own), _) => all[first + own],
                    (Row::Variable(own), _) => all[first + n + own],
                };
            }
        }
        Ok(out)
    }

    /// Derivatives along a direction: a seed for each known, a result for each unknown.
    pub(crate) fn along(
        &mut self,
        (unknowns, knowns): (&[u32], &[u32]),
        seed: &[f64],
        out: &mut [f64],
    ) -> Result<(), Wrong> {
        product(&self.jacobian(unknowns, knowns)?, seed, out);
        Ok(())
    }

    /// Derivatives backwards: a seed for each unknown, a result for each known.
    pub(crate) fn backwards(
        &mut self,
        (unknowns, knowns): (&[u32], &[u32]),
        seed: &[f64],
        out: &mut [f64],
    ) -> Result<(), Wrong> {
        product(&self.jacobian(unknowns, knowns)?.transpose(), seed, out);
        Ok(())
    }

    /// The derivatives of the right sides of all states and of these variables by what a column stands for.
    fn column_of(&mut self, column: Column, variables: &[usize]) -> Result<Vec<f64>, Wrong> {
        let explained = |failure: Failure| SimErrorKind::Evaluation(failure);
        let found = match column {
            Column::State(state, sign) => {
                let all = self.by_states(variables)?;
                return Ok(all.column(state).iter().map(|entry| sign * entry).collect());
            }
            Column::Time => {
                let state = &mut self.state;
                state.system.reduced_jacobian(variables, Along::Time, state.time, &state.x)
            }
            Column::Parameter(at) => {
                let code = self.code_of(at, variables)?;
                self.state.system.parameter_jacobian(&code, self.state.time, &self.state.x)
            }
            Column::Initial(at) => {
                let code = self.code_of(at, variables)?;
                self.state.system.initial_jacobian(&code, self.state.time)
            }
        };
        let found = found.map_err(|failure| self.explained(explained(failure)))?;
        Ok(found.column(0).iter().copied().collect())
    }

    fn by_states(&mut self, variables: &[usize]) -> Result<&DMatrix<f64>, Wrong> {
        let known = self.derivatives.by_states.take().filter(|(of, _)| *of == variables);
        let all = match known {
            Some((_, all)) => all,
            None => {
                let state = &mut self.state;
                let all =
                    state.system.reduced_jacobian(variables, Along::States, state.time, &state.x);
                all.map_err(|failure| self.explained(SimErrorKind::Evaluation(failure)))?
            }
        };
        Ok(&self.derivatives.by_states.insert((variables.to_vec(), all)).1)
    }

    fn code_of(
        &mut self,
        parameter: usize,
        variables: &[usize],
    ) -> Result<Arc<SensitivityCode>, Wrong> {
        self.refuse_derivatives_by(parameter)?;
        let key = (parameter, variables.to_vec());
        if let Some(code) = self.derivatives.by_parameters.get(&key) {
            return Ok(code.clone());
        }
        let program = &self.model.program;
        let name = &program.parameters()[parameter].name;
        let code = SensitivityCode::compile(program, &[parameter], variables).map_err(|why| {
            Wrong::Error(format!("derivatives by `{name}` are not known because {why}"))
        })?;
        self.derivatives.by_parameters.insert(key, code.clone());
        Ok(code)
    }

    /// Refuses a parameter on which others depend in ways that are not differentiated.
    fn refuse_derivatives_by(&self, parameter: usize) -> Result<(), Wrong> {
        let program = &self.model.program;
        let name = |at: usize| &program.parameters()[at].name;
        if program.has_solved_parameters() {
            return Err(Wrong::Error(format!(
                "derivatives by `{}` are not known: initial equations determine parameters of the model",
                name(parameter)
            )));
        }
        let own = self.model.content.set.iter().map(|(at, _)| *at);
        let mut follow = own
            .chain(self.parameters_given())
            .filter(|at| *at != parameter && program.follows_from_parameters(*at));
        match follow.next() {
            None => Ok(()),
            Some(other) => Err(Wrong::Error(format!(
                "derivatives by `{}` are not known: `{}` follows from parameters in the model, but has a \
                 value of its own",
                name(parameter),
                name(other)
            ))),
        }
    }

    fn column(&self, reference: u32) -> Result<Column, Wrong> {
        let variable = self.model.content.variables.get(reference as usize);
        if self.state.phase == Phase::Initialization {
            let setter = variable.map(|variable| variable.setter);
            let Some(Setter::Parameter(at) | Setter::Input { start: at, .. }) = setter else {
                return Err(Wrong::Error(format!(
                    "derivatives during the initialization are known by parameters, inputs and start \
                     values; the variable with value reference {reference} is none"
                )));
            };
            return Ok(Column::Initial(at));
        }
        let found = variable.and_then(|variable| match (variable.place, variable.setter) {
            (_, Setter::Input { state, is_negated, .. }) => {
                Some(Column::State(state, if is_negated { -1.0 } else { 1.0 }))
            }
            (Place::State(state), _) => Some(Column::State(state, 1.0)),
            (Place::Time, _) => Some(Column::Time),
            (Place::Variable(at), Setter::Parameter(parameter)) => {
                let is_parameter = self.access(at) == Access::Parameter;
                is_parameter.then_some(Column::Parameter(parameter))
            }
            _ => None,
        });
        found.ok_or_else(|| {
            Wrong::Error(format!(
                "derivatives are known by continuous states, continuous inputs, parameters and the \
                 time; the variable with value reference {reference} is none"
            ))
        })
    }

    fn access(&self, variable: usize) -> Access {
        self.model.program.variables()[variable].access
    }

    /// Where the derivatives of a variable are.
    fn row(&self, reference: u32, variables: &mut Vec<usize>) -> Result<Row, Wrong> {
        let variable = self.model.content.variables.get(reference as usize);
        match variable.map(|variable| variable.place) {
            Some(Place::Time) => Ok(Row::Time),
            Some(Place::State(state)) => Ok(Row::State(state)),
            Some(Place::Derivative(state)) => Ok(Row::Derivative(state)),
            Some(Place::Variable(at)) if self.access(at) == Access::Time => Ok(Row::Time),
            Some(Place::Variable(at)) => {
                variables.push(at);
                Ok(Row::Variable(variables.len() - 1))
            }
            Some(Place::Indicator(_) | Place::Text(_)) | None => Err(Wrong::Error(format!(
                "the variable with value reference {reference} has no derivatives"
            ))),
        }
    }
}

/// What a known stands for.
#[derive(Clone, Copy)]
enum Column {
    /// A state by its number, or an input that is one, with its sign.
    State(usize, f64),
    Time,
    /// A parameter by its position.
    Parameter(usize),
    /// A parameter or start value by its position, during the initialization.
    Initial(usize),
}

/// What an unknown stands for.
#[derive(Clone, Copy)]
enum Row {
    Time,
    State(usize),
    Derivative(usize),
    Variable(usize),
}
