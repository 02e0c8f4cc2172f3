//! Growth of errors along the assignments of a torn loop.
//!
//! Tearing leaves chains of assignments from one neighbour to the next. A chain may multiply what it
//! begins with at every step: `x[i+1] = 3 x[i] - x[i-1]` by 2.6, so that after 40 steps the residual
//! contains 1e16 times the rounding errors of the first, and nothing of the solution. This is the
//! growth of elements in Gaussian elimination with pivots that the structure alone has chosen
//! ([Golub & Van Loan 2013](gapilib_base::bibliography#golub-van-loan-2013), §3.4.5).
//!
//! Measured is how strongly every variable depends on each iteration variable, in units in which
//! the entries of the block are about one. A variable that depends on one too strongly is iterated
//! as well, its assignment becomes a residual, and the chain begins again after it. Coefficients
//! are those with the default parameters and start values; those without a value are left out.

use super::causalized::{Assignment, Loop};
use crate::lower::{Dae, DefaultValues};
use crate::symbolic::{Expr, Node, VarId, derivative};
use rustc_hash::{FxHashMap, FxHashSet};
use std::collections::BTreeMap;

/// A stronger dependence costs more than six of sixteen digits. Of chains with the factor above, one of
/// 80 masses gave wrong numbers, one of 160 could not be integrated.
const LARGEST: f64 = 1e6;
/// A dependence that is too strong beside a variable that has become iterated: a recurrence of second
/// order carries two values, and begins again with both. Without, a chain of 120 gets 53 iteration
/// variables in the place of 15.
const LARGEST_BESIDE: f64 = 1e3;
/// Shorter chains would need factors of three and more at every step.
const SHORTEST: usize = 12;
/// Numbers beyond which the rest of the loop is left as it is.
const MOST_NUMBERS: usize = 4_000_000;
/// How often rows and columns are scaled in turn; the entries of chains are within a factor of two
/// of one after three.
const SWEEPS: usize = 5;

/// Coefficients that are numbers, by position of the variable.
type Row = Vec<(usize, f64)>;

/// The loop with more iteration variables where errors would grow.
pub(super) fn limit_growth(dae: &mut Dae, torn: Loop) -> Loop {
    if torn.assignments.len() < SHORTEST {
        return torn;
    }
    let rows = coefficients(dae, &torn);
    let scales = scales(&rows, &torn);
    let Loop { iteration, assignments, residuals } = torn;
    let mut limited = Loop { iteration, assignments: Vec::new(), residuals };
    // How every variable depends on the iteration variables, by their number.
    let unit = |number: usize| BTreeMap::from([(number, 1.0)]);
    let mut dependences: Vec<BTreeMap<usize, f64>> =
        (0..limited.iteration.len()).map(unit).collect();
    let first = dependences.len();
    let mut numbers = 0;
    let mut added: FxHashSet<usize> = FxHashSet::default();
    for (at, assignment) in assignments.into_iter().enumerate() {
        let own = scales[first + at];
        let mut dependence: BTreeMap<usize, f64> = BTreeMap::new();
        if numbers < MOST_NUMBERS {
            for (column, coefficient) in &rows[at] {
                let factor = coefficient * scales[*column] / own;
                for (number, value) in &dependences[*column] {
                    *dependence.entry(*number).or_default() += factor * value;
                }
            }
        }
        let is_beside = rows[at].iter().any(|(column, _)| added.contains(column));
        let largest = if is_beside { LARGEST_BESIDE } else { LARGEST };
        if dependence.values().any(|value| value.abs() > largest) {
            dependence = unit(limited.iteration.len());
            added.insert(first + at);
            iterate_over(dae, &mut limited, assignment);
        } else {
            limited.assignments.push(assignment);
        }
        numbers += dependence.len();
        dependences.push(dependence);
    }
    limited
}

/// Makes the variable of an assignment an iteration variable.
fn iterate_over(dae: &mut Dae, torn: &mut Loop, assignment: Assignment) {
    let Assignment { variable, value, equation } = assignment;
    let unknown = dae.pool.variable(variable);
    torn.residuals.push((dae.pool.sub(unknown, value), equation));
    torn.iteration.push(variable);
}

/// The coefficients of what is assigned, then of the residuals; variables are numbered as they are
/// known: iteration variables first.
fn coefficients(dae: &mut Dae, torn: &Loop) -> Vec<Row> {
    let known = torn.iteration.iter().copied().chain(torn.assignments.iter().map(|a| a.variable));
    let columns: FxHashMap<VarId, usize> = known.zip(0..).collect();
    let assigned = torn.assignments.iter().map(|assignment| assignment.value);
    let residuals = torn.residuals.iter().map(|(residual, _)| *residual);
    let expressions: Vec<Expr> = assigned.chain(residuals).collect();
    let values = dae.defaults.with_starts(dae);
    expressions.into_iter().map(|e| row(dae, &values, e, &columns)).collect()
}

fn row(dae: &mut Dae, values: &DefaultValues, e: Expr, columns: &FxHashMap<VarId, usize>) -> Row {
    let mut row = Row::new();
    for variable in dae.pool.variables(e) {
        let Some(column) = columns.get(&variable) else { continue };
        let partial = derivative(&mut dae.pool, e, variable);
        // Functions are not called: they may be external, and start values outside their domain.
        if calls(dae, partial) {
            continue;
        }
        let value = values.of(dae, partial);
        if value.is_finite() && value != 0.0 {
            row.push((*column, value));
        }
    }
    row
}

fn calls(dae: &Dae, e: Expr) -> bool {
    let is_call =
        |e: &Expr| matches!(dae.pool.node(*e), Node::Call { .. } | Node::CallDerivative { .. });
    dae.pool.reachable(&[e]).iter().any(is_call)
}

/// Units of the variables in which the largest entries of all rows and columns are about one.
fn scales(rows: &[Row], torn: &Loop) -> Vec<f64> {
    let n = torn.iteration.len() + torn.assignments.len();
    let mut of_columns = vec![1.0f64; n];
    let mut of_rows = vec![1.0f64; rows.len()];
    for _ in 0..SWEEPS {
        let mut largest_of_rows = vec![0.0f64; rows.len()];
        let mut largest_of_columns = vec![0.0f64; n];
        for (at, row) in rows.iter().enumerate() {
            let own = (at < torn.assignments.len()).then_some((torn.iteration.len() + at, 1.0f64));
            for (column, entry) in row.iter().copied().chain(own) {
                let size = (entry * of_rows[at] * of_columns[column]).abs();
                largest_of_rows[at] = largest_of_rows[at].max(size);
                largest_of_columns[column] = largest_of_columns[column].max(size);
            }
        }
        divide(&mut of_rows, &largest_of_rows);
        divide(&mut of_columns, &largest_of_columns);
    }
    of_columns
}

fn divide(scales: &mut [f64], largest: &[f64]) {
    for (scale, largest) in scales.iter_mut().zip(largest) {
        if *largest > 0.0 {
            *scale /= largest.sqrt();
        }
    }
}
