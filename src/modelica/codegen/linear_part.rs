//! The linear part of a model along its solution, as variables of the model: the entries of the
//! Jacobian of its equations. A simulation computes them where they are observed, and their total
//! derivatives by parameters with those of other variables.
//!
//! ```text
//!   ẋ = f(x, z, u, u̇, …),  0 = g(x, z, u, …),  y = h(x, z, u, …)
//!   ∂(f, g, h)/∂(x, z, u, u̇, …) at the operating point
//! ```
//!
//! Each input u is a chain of states of which each is the derivative of the one before, so that
//! equations that contain derivatives of u find them; the last derivative is a parameter.

use super::errors::NOT_LINEARIZED;
use super::jacobian::{Differentiated, differentiate_sequence};
use super::sequence::{resolved, right_sides, slice};
use crate::causalize::{Assignment, Block, CausalizedDae};
use crate::diag::Fault;
use crate::fault;
use crate::flatten::{BaseType, Variability};
use crate::lower::{StateSelect, Variable, VariableKind};
use crate::source::Span;
use crate::symbolic::{Expr, Pool, VarId};
use serde::{Deserialize, Serialize};
use std::sync::Arc;

/// Derivatives of an input that the Jacobian has columns for, itself included.
pub const ORDERS: usize = 3;

/// Where the entries of the Jacobian are found.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct LinearPart {
    /// Number of states without those of the inputs.
    pub n_states: usize,
    /// Number of algebraic unknowns; their equations have no derivative.
    pub n_algebraic: usize,
    /// What is not always zero. Rows: states, algebraic unknowns, the outputs. Columns: states, algebraic
    /// unknowns, each input with its derivatives.
    pub entries: Vec<LinearEntry>,
}

/// An entry of the Jacobian.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct LinearEntry {
    /// Its row.
    pub row: usize,
    /// Its column.
    pub column: usize,
    /// A number, or the name of the variable that has its value.
    pub value: Result<String, f64>,
}

/// The chain of an input: itself or what is added to it, its derivatives, and at the end a parameter.
pub struct InputChain {
    /// The states, each the derivative of the one before.
    pub states: [String; ORDERS],
    /// The parameter that is the derivative of the last one.
    pub end: String,
}

impl LinearPart {
    /// Refuses systems that have no linear part of this form.
    ///
    /// # Errors
    ///
    /// States that are chosen at run time, delays and transports.
    fn refuse(sorted: &CausalizedDae) -> Result<(), Fault> {
        if !sorted.selections.is_empty() {
            return Err(fault!(
                NOT_LINEARIZED,
                "`{}` cannot be linearized: it chooses its states at run time",
                sorted.dae.name
            ));
        }
        let events = &sorted.dae.events;
        if !events.delays.is_empty() || !events.transports.is_empty() {
            return Err(fault!(
                NOT_LINEARIZED,
                "`{}` cannot be linearized: `delay` and `spatialDistribution` are not supported",
                sorted.dae.name;
                help: "replace them by a rational approximation, such as a chain of first-order blocks"
            ));
        }
        Ok(())
    }

    /// Adds variables for the entries to a system. The outputs are names of variables.
    ///
    /// # Errors
    ///
    /// Names that the system does not have, an input that its states determine, an output that depends on
    /// higher derivatives of an input than the chain has.
    pub fn add_to(
        sorted: &mut CausalizedDae,
        chains: &[InputChain],
        outputs: &[String],
    ) -> Result<LinearPart, Fault> {
        LinearPart::refuse(sorted)?;
        let mut pool = std::mem::take(&mut sorted.dae.pool);
        let made = Made::of(&mut pool, sorted, chains, outputs);
        sorted.dae.pool = pool;
        made
    }

    /// The names of the states without those of the chains, in the order of their columns.
    ///
    /// # Errors
    ///
    /// An input that the states determine.
    pub fn states(sorted: &CausalizedDae, chains: &[InputChain]) -> Result<Vec<String>, Fault> {
        let inputs = chain_states(sorted, chains)?;
        let is_own = |state: &&VarId| inputs.iter().all(|(input, _)| input != *state);
        let own = sorted.states.iter().filter(is_own);
        Ok(own.map(|state| sorted.dae.variable(*state).name.to_string()).collect())
    }
}

/// What the linear part is made from.
struct Made {
    /// By unknown: the column, and the sign that the unknown has there.
    columns: Vec<Column>,
    n_states: usize,
    n_algebraic: usize,
    derivatives: Differentiated,
    /// The first number of new variables.
    first: u32,
}

/// What an unknown is.
#[derive(Clone, Copy)]
enum Column {
    Unknown(usize),
    /// An input or one of its derivatives, by its place among all of them.
    Input {
        place: usize,
        sign: f64,
    },
}

impl Made {
    fn of(
        pool: &mut Pool,
        sorted: &mut CausalizedDae,
        chains: &[InputChain],
        outputs: &[String],
    ) -> Result<LinearPart, Fault> {
        let mut equations = right_sides(sorted, pool);
        let mut iteration = Vec::new();
        for block in &sorted.blocks {
            equations.extend(block.residuals());
            if let Block::Loop(torn) = block {
                iteration.extend(&torn.iteration);
            }
        }
        for output in outputs {
            let y = variable(sorted, output)?;
            equations.push(resolved(pool, sorted, y));
        }
        let sequence: Vec<Assignment> =
            sorted.blocks.iter().flat_map(|block| block.assignments()).copied().collect();
        let needed = slice(pool, &sequence, &equations);
        let mut unknowns: Vec<VarId> = sorted.states.iter().chain(&iteration).copied().collect();
        let columns = columns(sorted, chains, &unknowns)?;
        let n_states = sorted.states.len() - ORDERS * chains.len();
        for chain in chains {
            unknowns.push(variable(sorted, &chain.end)?);
        }
        let first = sorted.dae.variables.len() as u32;
        let mut next = first;
        let derivatives = differentiate_sequence(pool, &needed, &equations, &unknowns, &mut next);
        let made = Made { columns, n_states, n_algebraic: iteration.len(), derivatives, first };
        made.refuse_derivatives(sorted)?;
        Ok(made.added(pool, sorted))
    }

    /// The row of an equation; `None` for those of the inputs.
    fn row(&self, equation: usize) -> Option<usize> {
        match self.columns.get(equation) {
            Some(Column::Unknown(row)) => Some(*row),
            Some(Column::Input { .. }) => None,
            None => Some(self.n_states + self.n_algebraic + equation - self.columns.len()),
        }
    }

    /// Refuses equations that contain the end of a chain, other than that of the chain itself.
    fn refuse_derivatives(&self, sorted: &CausalizedDae) -> Result<(), Fault> {
        let mut rows = self.derivatives.rows.iter().enumerate();
        let end = self.columns.len();
        let wrong = rows.any(|(equation, row)| {
            self.row(equation).is_some() && row.keys().any(|unknown| *unknown >= end)
        });
        match wrong {
            true => Err(fault!(
                NOT_LINEARIZED,
                "`{}` cannot be linearized: an equation depends on the derivative of its input of order {ORDERS}",
                sorted.dae.name;
                help: "filter the input with a first-order block"
            )),
            false => Ok(()),
        }
    }

    /// Makes the derivatives variables of the system.
    fn added(self, pool: &mut Pool, sorted: &mut CausalizedDae) -> LinearPart {
        let is_new = |a: &&Assignment| a.variable.0 >= self.first;
        let auxiliary: Vec<Assignment> =
            self.derivatives.sequence.iter().filter(is_new).copied().collect();
        for (number, assignment) in auxiliary.iter().enumerate() {
            add(sorted, assignment.variable, format!("'derivative {number}'"));
            solve_for(sorted, *assignment);
        }
        let mut entries = Vec::new();
        for (equation, row_of) in self.derivatives.rows.iter().enumerate() {
            let Some(row) = self.row(equation) else { continue };
            for (unknown, value) in row_of {
                let (column, sign) = match self.columns.get(*unknown) {
                    Some(Column::Unknown(column)) => (*column, 1.0),
                    Some(Column::Input { place, sign }) => {
                        (self.n_states + self.n_algebraic + place, *sign)
                    }
                    None => continue,
                };
                let value = scaled(pool, *value, sign);
                let value = match pool.as_constant(value) {
                    Some(number) => Err(number),
                    None => {
                        let name = format!("'derivative of equation {row} by unknown {column}'");
                        let variable = VarId(sorted.dae.variables.len() as u32);
                        add(sorted, variable, name.clone());
                        solve_for(sorted, Assignment { variable, value, equation: 0 });
                        Ok(name)
                    }
                };
                entries.push(LinearEntry { row, column, value });
            }
        }
        LinearPart { n_states: self.n_states, n_algebraic: self.n_algebraic, entries }
    }
}

fn scaled(pool: &mut Pool, value: Expr, sign: f64) -> Expr {
    if sign < 0.0 { pool.neg(value) } else { value }
}

/// The states of the chains among those of a system, each with its sign.
fn chain_states(sorted: &CausalizedDae, chains: &[InputChain]) -> Result<Vec<(VarId, f64)>, Fault> {
    let mut inputs = Vec::new();
    for name in chains.iter().flat_map(|chain| &chain.states) {
        let own = variable(sorted, name)?;
        let (of, negated) = match sorted.aliases[own.0 as usize] {
            Some(alias) => (alias.of, alias.negated),
            None => (own, false),
        };
        if !sorted.states.contains(&of) {
            return Err(fault!(
                NOT_LINEARIZED,
                "`{}` cannot be linearized: its states determine its input",
                sorted.dae.name;
                help: "take another variable as the input, one that is not connected to a storage"
            ));
        }
        inputs.push((of, if negated { -1.0 } else { 1.0 }));
    }
    Ok(inputs)
}

/// What the unknowns are.
fn columns(
    sorted: &CausalizedDae,
    chains: &[InputChain],
    unknowns: &[VarId],
) -> Result<Vec<Column>, Fault> {
    let inputs = chain_states(sorted, chains)?;
    let mut next = 0;
    let column = |unknown: &VarId| match inputs.iter().position(|(of, _)| of == unknown) {
        Some(place) => Column::Input { place, sign: inputs[place].1 },
        None => {
            next += 1;
            Column::Unknown(next - 1)
        }
    };
    Ok(unknowns.iter().map(column).collect())
}

/// The variable with this name.
pub(super) fn variable(sorted: &CausalizedDae, name: &str) -> Result<VarId, Fault> {
    let found = sorted.dae.variables.iter().position(|variable| &*variable.name == name);
    found
        .map(|at| VarId(at as u32))
        .ok_or_else(|| fault!(NOT_LINEARIZED, "`{}` has no variable `{name}`", sorted.dae.name))
}

/// Adds a variable, which must be the next one.
pub(super) fn add(sorted: &mut CausalizedDae, variable: VarId, name: String) {
    debug_assert_eq!(variable.0 as usize, sorted.dae.variables.len());
    let empty: Arc<str> = "".into();
    sorted.dae.variables.push(Variable {
        name: name.into(),
        kind: VariableKind::Unknown,
        base: BaseType::Real,
        variability: Variability::Continuous,
        causality: None,
        top_level: true,
        protected: true,
        is_relative: false,
        unit: empty.clone(),
        display_unit: empty.clone(),
        description: empty,
        binding: None,
        start: None,
        fixed: false,
        min: None,
        max: None,
        nominal: None,
        state_select: StateSelect::Default,
        span: Span::NONE,
    });
    sorted.aliases.push(None);
}

/// Lets the system compute the value of a variable after all others.
fn solve_for(sorted: &mut CausalizedDae, assignment: Assignment) {
    let CausalizedDae { blocks, event_blocks, initial_blocks, .. } = sorted;
    blocks.push(Block::Assignment(assignment));
    initial_blocks.push(Block::Assignment(assignment));
    if !event_blocks.is_empty() {
        event_blocks.push(Block::Assignment(assignment));
    }
}
