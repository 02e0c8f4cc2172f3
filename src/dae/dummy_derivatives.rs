//! Chooses states after index reduction.
//!
//! ```text
//! for each block of the highest derivatives z and the equations g that determine them
//!     while some of g are derivatives of equations h
//!         choose as many of the z that are derivatives as there are such equations:
//!             they become dummy derivatives, their Jacobian in these equations is regular
//!         g := h,  z := the variables whose derivatives were chosen
//! states are the variables whose derivative is not a dummy
//! ```
//!
//! Dummies are taken first from variables that are little wanted as states: by `stateSelect`, then
//! those without `fixed`, then those without a start value. The Jacobian is that at the start
//! values; where it is singular there, the structure decides.
//!
//! Reference: [Mattsson & Söderlind 1993](crate::bibliography#mattsson-soderlind-1993).

use super::blt;
use super::model::{Dae, Kind, StateSelect};
use crate::diag::Diagnostic;
use crate::graph::{Bipartite, Matching, blocks, match_equations};
use crate::symbolic::{Expr, VarId, derivative, evaluate};
use rustc_hash::FxHashMap;

/// A differentiated system; equations and variables are numbered by their place in the lists.
pub(super) struct Chains {
    /// Numbers of the equations in the system.
    pub(super) equations: Vec<usize>,
    pub(super) variables: Vec<VarId>,
    pub(super) eq_to_derivative: Vec<Option<usize>>,
    pub(super) var_to_derivative: Vec<Option<usize>>,
    /// What determines the highest derivatives.
    pub(super) var_to_equation: Vec<Option<usize>>,
}

/// Pivots smaller than this, relative to the largest entry of their row, do not count.
const SMALLEST_PIVOT: f64 = 1e-6;

/// The states of a differentiated system, ascending.
pub(super) fn choose_states(
    dae: &mut Dae,
    chains: &Chains,
    parameters: &[VarId],
) -> Result<Vec<VarId>, Diagnostic> {
    let eq_to_origin = inverse(&chains.eq_to_derivative);
    let var_to_origin = inverse(&chains.var_to_derivative);
    let values = start_values(dae, parameters);
    let mut is_dummy = vec![false; chains.variables.len()];
    for (mut equations, mut variables) in highest_blocks(dae, chains) {
        loop {
            equations.retain(|e| eq_to_origin[*e].is_some());
            variables.retain(|v| var_to_origin[*v].is_some());
            if equations.is_empty() {
                break;
            }
            let choice = Choice { dae, chains, equations: &equations, variables: &variables };
            let chosen = choice.dummies(&values, &var_to_origin)?;
            chosen.iter().for_each(|v| is_dummy[*v] = true);
            equations = equations.iter().filter_map(|e| eq_to_origin[*e]).collect();
            variables = chosen.iter().filter_map(|v| var_to_origin[*v]).collect();
        }
    }
    let numbered = chains.var_to_derivative.iter().enumerate();
    let mut states: Vec<VarId> = numbered
        .filter(|(_, derivative)| derivative.is_some_and(|d| !is_dummy[d]))
        .map(|(variable, _)| chains.variables[variable])
        .collect();
    states.sort_unstable();
    Ok(states)
}

fn inverse(to: &[Option<usize>]) -> Vec<Option<usize>> {
    let mut from = vec![None; to.len()];
    for (source, target) in to.iter().enumerate() {
        if let Some(target) = target {
            from[*target] = Some(source);
        }
    }
    from
}

/// Equations and variables of every block of the highest derivatives.
fn highest_blocks(dae: &Dae, chains: &Chains) -> Vec<(Vec<usize>, Vec<usize>)> {
    let highest = |to: &[Option<usize>]| -> Vec<usize> {
        (0..to.len()).filter(|number| to[*number].is_none()).collect()
    };
    let equations = highest(&chains.eq_to_derivative);
    let mut variables = highest(&chains.var_to_derivative);
    variables.retain(|v| chains.var_to_equation[*v].is_some());
    let list: Vec<_> = equations.iter().map(|e| dae.equations[chains.equations[*e]]).collect();
    let ids: Vec<VarId> = variables.iter().map(|v| chains.variables[*v]).collect();
    let graph = blt::incidence(dae, &list, &ids);
    let mut matching = Matching {
        equation_to_unknown: vec![None; equations.len()],
        unknown_to_equation: vec![None; variables.len()],
    };
    for (column, variable) in variables.iter().enumerate() {
        let row = chains.var_to_equation[*variable].and_then(|e| equations.binary_search(&e).ok());
        matching.unknown_to_equation[column] = row;
        if let Some(row) = row {
            matching.equation_to_unknown[row] = Some(column);
        }
    }
    if !matching.is_perfect() {
        matching = match_equations(&graph);
    }
    if !matching.is_perfect() {
        // Derivatives cancel symbolically: one block, and the choice below will tell.
        return vec![(equations, variables)];
    }
    let members = |block: Vec<usize>| {
        let owned = |row: &usize| matching.equation_to_unknown[*row].map(|u| variables[u]);
        let of_block = block.iter().filter_map(owned).collect();
        (block.iter().map(|row| equations[*row]).collect(), of_block)
    };
    blocks(&graph, &matching).into_iter().map(members).collect()
}

/// Default parameters and start values, zero where there are none.
fn start_values(dae: &Dae, parameters: &[VarId]) -> Vec<f64> {
    let mut values = vec![0.0; dae.variables.len()];
    for (value, variable) in values.iter_mut().zip(&dae.variables) {
        if let Kind::Constant(number) = variable.kind {
            *value = number;
        }
    }
    let starts = (0..dae.variables.len() as u32).map(VarId).filter(|v| dae.is_unknown(*v));
    let bound = parameters.iter().map(|p| (*p, dae.variable(*p).binding));
    for (variable, e) in bound.chain(starts.map(|v| (v, dae.variable(v).start))) {
        let value = e.map_or(0.0, |e| evaluate(&dae.pool, e, &values[..]));
        values[variable.0 as usize] = if value.is_finite() { value } else { 0.0 };
    }
    values
}

/// Equations of one level, and the derivatives of which as many become dummies.
struct Choice<'a> {
    dae: &'a mut Dae,
    chains: &'a Chains,
    equations: &'a [usize],
    variables: &'a [usize],
}

/// How little a variable is wanted as a state, the least wanted first.
type Wish = (StateSelect, bool, bool);

impl Choice<'_> {
    fn dummies(
        mut self,
        values: &[f64],
        var_to_origin: &[Option<usize>],
    ) -> Result<Vec<usize>, Diagnostic> {
        let wish = |variable: usize| -> Wish {
            let origin = var_to_origin[variable].expect("only derivatives are asked for");
            let origin = self.dae.variable(self.chains.variables[origin]);
            (origin.state_select, origin.fixed, origin.start.is_some())
        };
        let mut columns: Vec<usize> = self.variables.to_vec();
        // Of those that are wanted alike the first declared stays a state.
        columns.sort_by_key(|v| (wish(*v), std::cmp::Reverse(self.chains.variables[*v])));
        let wishes: Vec<Wish> = columns.iter().map(|v| wish(*v)).collect();
        let entries = self.jacobian(&columns);
        let numbers = entries.iter().map(|row| {
            let value = |e: &Option<Expr>| e.map_or(0.0, |e| evaluate(&self.dae.pool, e, values));
            row.iter().map(value).map(|v| if v.is_finite() { v } else { 0.0 }).collect()
        });
        let chosen = match pivots(numbers.collect(), &wishes) {
            Some(chosen) => chosen,
            None => self.by_structure(&entries, &columns)?,
        };
        Ok(chosen.into_iter().map(|column| columns[column]).collect())
    }

    /// Entries by equation; `None` where a variable does not occur.
    fn jacobian(&mut self, columns: &[usize]) -> Vec<Vec<Option<Expr>>> {
        let place: FxHashMap<VarId, usize> = columns
            .iter()
            .enumerate()
            .map(|(column, v)| (self.chains.variables[*v], column))
            .collect();
        let mut rows = Vec::with_capacity(self.equations.len());
        for equation in self.equations {
            let equation = self.dae.equations[self.chains.equations[*equation]];
            let mut row = vec![None; columns.len()];
            let residual = self.dae.pool.sub(equation.left, equation.right);
            for variable in self.dae.pool.variables(residual) {
                if let Some(column) = place.get(&variable) {
                    let entry = derivative(&mut self.dae.pool, residual, variable);
                    let is_zero = self.dae.pool.as_constant(entry) == Some(0.0);
                    row[*column] = (!is_zero).then_some(entry);
                }
            }
            rows.push(row);
        }
        rows
    }

    /// A choice that is regular for most values of the entries; earlier columns go first.
    fn by_structure(
        &self,
        entries: &[Vec<Option<Expr>>],
        columns: &[usize],
    ) -> Result<Vec<usize>, Diagnostic> {
        let rows_of = |column: usize| {
            (0..entries.len()).filter(|row| entries[*row][column].is_some()).collect::<Vec<_>>()
        };
        let transposed = Bipartite::new(entries.len(), (0..columns.len()).map(rows_of));
        let matching = match_equations(&transposed);
        if matching.len() == entries.len() {
            let taken = |column: &usize| matching.equation_to_unknown[*column].is_some();
            return Ok((0..columns.len()).filter(taken).collect());
        }
        let equations: Vec<_> =
            self.equations.iter().map(|e| self.dae.equations[self.chains.equations[*e]]).collect();
        let unknowns: Vec<VarId> = columns.iter().map(|c| self.chains.variables[*c]).collect();
        let graph = blt::incidence(self.dae, &equations, &unknowns);
        Err(blt::report(self.dae, &equations, &unknowns, &graph, &match_equations(&graph)))
    }
}

/// Columns that make a regular matrix, by elimination with pivots from the columns of the first
/// wish while there are any, then from those of the next.
fn pivots(mut rows: Vec<Vec<f64>>, wishes: &[Wish]) -> Option<Vec<usize>> {
    for row in &mut rows {
        let scale = row.iter().fold(0.0, |a: f64, b| a.max(b.abs()));
        if scale == 0.0 {
            return None;
        }
        row.iter_mut().for_each(|entry| *entry /= scale);
    }
    let mut chosen: Vec<usize> = Vec::new();
    for group in wishes.chunk_by(|a, b| a == b).scan(0, |end, group| {
        *end += group.len();
        Some(*end - group.len()..*end)
    }) {
        while chosen.len() < rows.len() {
            let done = chosen.len();
            let open = group.clone().filter(|column| !chosen.contains(column));
            let places = open.flat_map(|column| (done..rows.len()).map(move |row| (row, column)));
            let mut best = (SMALLEST_PIVOT, None);
            for (row, column) in places {
                // A little more than equal: rounding must not decide.
                if rows[row][column].abs() > best.0 * (1.0 + 1e-9) {
                    best = (rows[row][column].abs(), Some((row, column)));
                }
            }
            let (_, Some((row, column))) = best else { break };
            rows.swap(done, row);
            eliminate(&mut rows, done, column);
            chosen.push(column);
        }
    }
    (chosen.len() == rows.len()).then_some(chosen)
}

/// Subtracts the row `pivot` from those below it so that their entries in `column` vanish.
fn eliminate(rows: &mut [Vec<f64>], pivot: usize, column: usize) {
    let (above, below) = rows.split_at_mut(pivot + 1);
    let line = &above[pivot];
    for row in below {
        let factor = row[column] / line[column];
        if factor != 0.0 {
            row.iter_mut().zip(line).for_each(|(entry, other)| *entry -= factor * other);
        }
    }
}
