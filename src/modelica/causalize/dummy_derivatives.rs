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
//! Dummies are taken first from the variables least preferred as states: by `stateSelect`, then
//! those without `fixed`, then those without a start value. The Jacobian is that at the start
//! values; where it is singular there, the structure decides. Pivots that are made of parameters
//! are regular for all time; where there are none the choice is left to run time
//! ([`dynamic_states`](super::dynamic_states)), unless `stateSelect` asks for these states.
//!
//! Reference: [Mattsson & Söderlind 1993](gapilib_base::bibliography#mattsson-soderlind-1993).

use super::causalized::Selection;
use super::dynamic_states::{Candidate, declare_selection};
use super::{blt, singularity};
use crate::diag::Diagnostic;
use crate::graph::{Bipartite, Matching, blocks, match_equations};
use crate::lower::{Dae, DefaultValues, StateSelect, VariableKind};
use crate::source::Span;
use crate::symbolic::{Expr, VarId, derivative};
use rustc_hash::FxHashMap;

/// A differentiated system; equations and variables are numbered by their place in the lists.
pub(super) struct Chains {
    /// Numbers of the equations in the system.
    pub(super) equations: Vec<usize>,
    pub(super) variables: Vec<VarId>,
    pub(super) eq_to_derivative: Vec<Option<usize>>,
    pub(super) var_to_derivative: Vec<Option<usize>>,
    /// Whether the derivative of a variable is the opposite of that named.
    pub(super) negated: Vec<bool>,
    /// What determines the highest derivatives.
    pub(super) var_to_equation: Vec<Option<usize>>,
}

/// The states, and those among them that are chosen at run time.
#[derive(Default)]
pub(super) struct ChosenStates {
    /// Ascending.
    pub(super) states: Vec<VarId>,
    pub(super) selections: Vec<Selection>,
}

/// Pivots smaller than this, relative to the largest entry of their row, do not count.
const SMALLEST_PIVOT: f64 = 1e-6;

/// Equations of the highest derivatives, and what they determine.
pub(super) type HighestBlock = (Vec<usize>, Vec<usize>);

/// The states of a differentiated system, block by block.
pub(super) fn choose_states(
    dae: &mut Dae,
    chains: &Chains,
    blocks: Vec<HighestBlock>,
) -> Result<ChosenStates, Diagnostic> {
    let eq_to_origin = inverse(&chains.eq_to_derivative);
    let var_to_origin = inverse(&chains.var_to_derivative);
    let values = start_values(dae);
    let mut is_dummy = vec![false; chains.variables.len()];
    let mut selections = Vec::new();
    for (mut equations, mut variables) in blocks {
        loop {
            equations.retain(|e| eq_to_origin[*e].is_some());
            variables.retain(|v| var_to_origin[*v].is_some());
            if equations.is_empty() {
                break;
            }
            let level = Level { chains, var_to_origin: &var_to_origin, equations, variables };
            let choice = level.choose(dae, &values)?;
            let mut chosen = choice.dummies.clone();
            if !choice.is_static {
                selections.push(level.select_at_run_time(dae, &choice, selections.len()));
                chosen.clone_from(&level.variables);
            }
            equations = level.equations;
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
    states.extend(selections.iter().flat_map(|s: &Selection| &s.states));
    states.sort_unstable();
    Ok(ChosenStates { states, selections })
}

pub(super) fn inverse(to: &[Option<usize>]) -> Vec<Option<usize>> {
    let mut from = vec![None; to.len()];
    for (source, target) in to.iter().enumerate() {
        if let Some(target) = target {
            from[*target] = Some(source);
        }
    }
    from
}

/// Equations and variables of every block of the highest derivatives.
pub(super) fn highest_blocks(dae: &Dae, chains: &Chains) -> Vec<HighestBlock> {
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
fn start_values(dae: &Dae) -> DefaultValues {
    let mut values = dae.defaults.clone();
    values.grow(dae.variables.len());
    for variable in (0..dae.variables.len() as u32).map(VarId) {
        if dae.is_unknown(variable) {
            let start = dae.variable(variable).start.map_or(0.0, |start| values.of(dae, start));
            values.set(variable, start);
        }
        if !values.get(variable).is_finite() {
            values.set(variable, 0.0);
        }
    }
    values
}

/// Equations of one level, and the derivatives of which as many become dummies.
struct Level<'a> {
    chains: &'a Chains,
    var_to_origin: &'a [Option<usize>],
    equations: Vec<usize>,
    variables: Vec<usize>,
}

/// What was chosen on one level.
struct Choice {
    dummies: Vec<usize>,
    /// Whether it is good whatever values the variables take, or the user requests it
    /// (`stateSelect`).
    is_static: bool,
    /// Derivatives in the order of the columns of the Jacobian.
    columns: Vec<usize>,
    /// Entries by equation; `None` where a variable does not occur.
    jacobian: Vec<Vec<Option<Expr>>>,
}

/// How little a variable is preferred as a state, the least preferred first.
type Preference = (StateSelect, bool, bool);

impl Level<'_> {
    /// The variable that a derivative comes from.
    fn origin(&self, variable: usize) -> usize {
        self.var_to_origin[variable].expect("only derivatives are asked for")
    }

    /// What is asked for a variable is asked for its derivatives too: the choice of speeds decides
    /// that of positions.
    fn preference(&self, dae: &Dae, variable: usize) -> Preference {
        let first = self.origin(variable);
        let mut preference: Preference = (StateSelect::Default, false, false);
        let mut next = Some(first);
        while let Some(origin) = next {
            let origin_of = dae.variable(self.chains.variables[origin]);
            preference.0 = preference.0.merged_with(origin_of.state_select);
            preference.1 |= origin_of.fixed;
            preference.2 |= origin_of.start.is_some();
            next = self.var_to_origin[origin];
        }
        preference
    }

    fn choose(&self, dae: &mut Dae, values: &DefaultValues) -> Result<Choice, Diagnostic> {
        let mut columns = self.variables.clone();
        // Of equally preferred ones the first declared stays a state.
        columns.sort_by_key(|v| {
            (self.preference(dae, *v), std::cmp::Reverse(self.chains.variables[*v]))
        });
        let preferences: Vec<Preference> =
            columns.iter().map(|v| self.preference(dae, *v)).collect();
        let jacobian = self.jacobian(dae, &columns);
        let entry = |e: &Option<Expr>| {
            let value = e.map_or(0.0, |e| values.of(dae, e));
            let value = if value.is_finite() { value } else { 0.0 };
            (value, e.is_none_or(|e| is_known(dae, e)))
        };
        let entries: Vec<Vec<(f64, bool)>> =
            jacobian.iter().map(|row| row.iter().map(entry).collect()).collect();
        let all = |places: Vec<usize>| places.into_iter().map(|at| columns[at]).collect();
        let by_value = pivots(entries.clone(), &preferences, false);
        let accepted = by_value.as_ref().filter(|chosen| is_preferred(chosen, &preferences));
        let lasting = match accepted {
            Some(chosen) => Some(chosen.clone()),
            None => pivots(entries, &preferences, true),
        };
        let (dummies, is_static) = match (lasting, by_value) {
            (Some(chosen), _) => (all(chosen), true),
            (None, Some(chosen)) => (all(chosen), columns.len() == self.equations.len()),
            (None, None) => {
                let chosen = self.by_structure(dae, &jacobian, &columns)?;
                (all(chosen), columns.len() == self.equations.len())
            }
        };
        Ok(Choice { dummies, is_static, columns, jacobian })
    }

    /// Entries by equation; `None` where a variable does not occur.
    fn jacobian(&self, dae: &mut Dae, columns: &[usize]) -> Vec<Vec<Option<Expr>>> {
        let place: FxHashMap<VarId, usize> = columns
            .iter()
            .enumerate()
            .map(|(column, v)| (self.chains.variables[*v], column))
            .collect();
        let mut rows = Vec::with_capacity(self.equations.len());
        for equation in &self.equations {
            let equation = dae.equations[self.chains.equations[*equation]];
            let mut row = vec![None; columns.len()];
            let residual = dae.pool.sub(equation.left, equation.right);
            for variable in dae.pool.variables(residual) {
                if let Some(column) = place.get(&variable) {
                    let entry = derivative(&mut dae.pool, residual, variable);
                    let is_zero = dae.pool.as_constant(entry) == Some(0.0);
                    row[*column] = (!is_zero).then_some(entry);
                }
            }
            rows.push(row);
        }
        rows
    }

    /// Makes all derivatives of this level dummies, and states of a choice that may change.
    fn select_at_run_time(&self, dae: &mut Dae, choice: &Choice, number: usize) -> Selection {
        let zero = dae.pool.constant(0.0);
        let rows = choice.jacobian.iter();
        let jacobian = rows.map(|row| row.iter().map(|e| e.unwrap_or(zero)).collect()).collect();
        let mut candidates = Vec::new();
        for column in &choice.columns {
            let origin = self.origin(*column);
            let mut derivative = dae.pool.variable(self.chains.variables[*column]);
            if self.chains.negated[origin] {
                derivative = dae.pool.neg(derivative);
            }
            candidates.push(Candidate {
                variable: self.chains.variables[origin],
                derivative,
                is_chosen: !choice.dummies.contains(column),
            });
        }
        let equation = self.equations.first().map(|e| self.chains.equations[*e]);
        let span = equation.map_or(Span::NONE, |e| dae.equations[e].span);
        declare_selection(dae, &candidates, jacobian, number, span)
    }

    /// A choice that is regular for most values of the entries; earlier columns go first.
    fn by_structure(
        &self,
        dae: &Dae,
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
            self.equations.iter().map(|e| dae.equations[self.chains.equations[*e]]).collect();
        let unknowns: Vec<VarId> = columns.iter().map(|c| self.chains.variables[*c]).collect();
        let graph = blt::incidence(dae, &equations, &unknowns);
        Err(singularity::report(
            dae,
            &format!("`{}`", dae.name),
            &equations,
            &unknowns,
            &graph,
            &match_equations(&graph),
        ))
    }
}

/// Whether an expression is made of parameters and numbers.
fn is_known(dae: &Dae, e: Expr) -> bool {
    let variables = dae.pool.variables(e);
    variables.iter().all(|v| matches!(dae.variable(*v).kind, VariableKind::Parameter { .. }))
}

/// Whether `stateSelect` prefers every state to every dummy.
fn is_preferred(dummies: &[usize], preferences: &[Preference]) -> bool {
    let is_dummy = |column: &usize| dummies.contains(column);
    let (dummies, states): (Vec<usize>, Vec<usize>) = (0..preferences.len()).partition(is_dummy);
    let most = dummies.iter().map(|column| preferences[*column].0).max();
    let least = states.iter().map(|column| preferences[*column].0).min();
    least.is_some_and(|least| least >= StateSelect::Prefer && most.is_none_or(|most| most < least))
}

/// Columns that make a regular matrix, by elimination with pivots from the columns of the first
/// preference while there are any, then from those of the next. An entry comes with whether it never
/// changes; `known` allows only such pivots.
fn pivots(
    mut rows: Vec<Vec<(f64, bool)>>,
    preferences: &[Preference],
    known: bool,
) -> Option<Vec<usize>> {
    for row in &mut rows {
        let scale = row.iter().fold(0.0, |a: f64, b| a.max(b.0.abs()));
        if scale == 0.0 {
            return None;
        }
        row.iter_mut().for_each(|entry| entry.0 /= scale);
    }
    let n = rows.len();
    // By columns: they are sought through for pivots, and an elimination changes few of them.
    let mut matrix: Vec<Vec<(f64, bool)>> =
        (0..preferences.len()).map(|column| rows.iter().map(|row| row[column]).collect()).collect();
    let mut chosen: Vec<usize> = Vec::new();
    let mut is_chosen = vec![false; preferences.len()];
    let mut end = 0;
    for group in preferences.chunk_by(|a, b| a == b) {
        let columns = end..end + group.len();
        end = columns.end;
        while chosen.len() < n {
            let done = chosen.len();
            let mut best = (SMALLEST_PIVOT, None);
            for column in columns.clone().filter(|column| !is_chosen[*column]) {
                for (row, (value, is_known)) in matrix[column].iter().enumerate().skip(done) {
                    // A little more than equal: rounding must not decide.
                    if value.abs() > best.0 * (1.0 + 1e-9) && (*is_known || !known) {
                        best = (value.abs(), Some((row, column)));
                    }
                }
            }
            let (_, Some((row, column))) = best else { break };
            matrix.iter_mut().for_each(|column| column.swap(done, row));
            eliminate(&mut matrix, done, column);
            chosen.push(column);
            is_chosen[column] = true;
        }
    }
    (chosen.len() == n).then_some(chosen)
}

/// Subtracts the row `pivot` from those below it so that their entries in `column` vanish.
fn eliminate(matrix: &mut [Vec<(f64, bool)>], pivot: usize, column: usize) {
    let entry = matrix[column][pivot];
    let below = matrix[column].iter().enumerate().skip(pivot + 1);
    let factors = below.map(|(row, of)| (row, of.0 / entry.0, of.1 && entry.1));
    let factors: Vec<(usize, f64, bool)> =
        factors.filter(|(_, factor, is_known)| *factor != 0.0 || !is_known).collect();
    for column in matrix.iter_mut() {
        let other = column[pivot];
        // What is added never changes if one of its factors is always zero.
        if other == (0.0, true) {
            continue;
        }
        for (row, factor, is_known) in &factors {
            column[*row].0 -= factor * other.0;
            column[*row].1 &= *is_known && other.1;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const PLAIN: Preference = (StateSelect::Default, false, false);
    const PREFERRED: Preference = (StateSelect::Prefer, false, false);

    #[test]
    fn the_least_preferred_columns_are_taken_while_they_are_regular() {
        let known = |values: &[f64]| values.iter().map(|v| (*v, true)).collect::<Vec<_>>();
        let rows = vec![known(&[1.0, 2.0, 1.0]), known(&[2.0, 4.0, 3.0])];
        // The first two columns are parallel.
        let preferences = [PLAIN, PLAIN, PREFERRED];
        assert_eq!(pivots(rows.clone(), &preferences, false), Some(vec![1, 2]));
        assert_eq!(pivots(vec![known(&[0.0, 0.0])], &[PLAIN, PLAIN], false), None);
        assert!(!is_preferred(&[1, 2], &preferences));
        assert!(is_preferred(&[0, 1], &preferences));
    }

    #[test]
    fn known_pivots_are_distinguished_from_those_that_may_vanish() {
        let rows = vec![vec![(2.0, false), (1.0, true)]];
        assert_eq!(pivots(rows.clone(), &[PLAIN, PLAIN], false), Some(vec![0]));
        assert_eq!(pivots(rows, &[PLAIN, PLAIN], true), Some(vec![1]));
        // What is left of a known entry after a varying one was subtracted is not known.
        let rows = vec![vec![(1.0, true), (0.5, false)], vec![(1.0, true), (1.0, true)]];
        assert_eq!(pivots(rows, &[PLAIN, PLAIN], true), None);
    }
}
