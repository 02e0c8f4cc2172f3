//! Exact derivatives through a sequence of assignments: forward accumulation, column by column,
//! on symbolic expressions.

use crate::dae::Assignment;
use crate::symbolic::{Expr, Node, Pool, VarId, derivative, differentiate};
use rustc_hash::FxHashMap;
use std::collections::{BTreeMap, BTreeSet};

/// Assignments of derivatives and where each entry is found.
pub(super) struct Differentiated {
    /// Every assignment of the sequence, followed by those of its derivatives.
    pub(super) sequence: Vec<Assignment>,
    /// ∂output/∂column by output, columns ascending; zeros left out.
    pub(super) rows: Vec<BTreeMap<usize, Expr>>,
}

/// Differentiates `outputs` for `columns` through a sequence; `next` numbers new variables.
pub(super) fn differentiate_sequence(
    pool: &mut Pool,
    sequence: &[Assignment],
    outputs: &[Expr],
    columns: &[VarId],
    next: &mut u32,
) -> Differentiated {
    let one = pool.constant(1.0);
    let mut slopes: FxHashMap<VarId, BTreeMap<usize, Expr>> = FxHashMap::default();
    for (column, variable) in columns.iter().enumerate() {
        slopes.insert(*variable, BTreeMap::from([(column, one)]));
    }
    let mut extended = Vec::new();
    let mut solved = Solved::default();
    for assignment in sequence {
        extended.push(*assignment);
        let mut row = match *pool.node(assignment.value) {
            Node::Solution { matrix, right, output, .. } => {
                let columns = solved.entry((matrix, right)).or_insert_with(|| {
                    chain_by_column(pool, assignment.value, [matrix, right], &slopes)
                });
                of_unknown(pool, columns, output)
            }
            _ => chain(pool, assignment.value, &slopes),
        };
        for slope in row.values_mut() {
            let simple = pool.as_constant(*slope).is_some() || pool.as_variable(*slope).is_some();
            if !simple {
                let variable = VarId(*next);
                *next += 1;
                extended.push(Assignment {
                    variable,
                    value: *slope,
                    equation: assignment.equation,
                });
                *slope = pool.variable(variable);
            }
        }
        slopes.insert(assignment.variable, row);
    }
    let rows = outputs.iter().map(|output| chain(pool, *output, &slopes)).collect();
    Differentiated { sequence: extended, rows }
}

/// Slopes of an unknown of linear systems by columns, by matrix and right side.
type Solved = FxHashMap<(Expr, Expr), BTreeMap<usize, Expr>>;

/// The slopes of another unknown of the same system.
fn of_unknown(
    pool: &mut Pool,
    columns: &BTreeMap<usize, Expr>,
    output: u32,
) -> BTreeMap<usize, Expr> {
    let slopes = columns.iter();
    slopes.map(|(column, slope)| (*column, pool.other_unknown(*slope, output))).collect()
}

/// Σ ∂e/∂w · ∂w/∂column over the variables w of e.
fn chain(
    pool: &mut Pool,
    e: Expr,
    slopes: &FxHashMap<VarId, BTreeMap<usize, Expr>>,
) -> BTreeMap<usize, Expr> {
    let mut row: BTreeMap<usize, Expr> = BTreeMap::new();
    for variable in pool.variables(e) {
        let Some(inner) = slopes.get(&variable).filter(|inner| !inner.is_empty()) else {
            continue;
        };
        let partial = derivative(pool, e, variable);
        for (column, slope) in inner {
            let product = pool.mul(partial, *slope);
            let sum = match row.get(column) {
                Some(before) => pool.add(*before, product),
                None => product,
            };
            row.insert(*column, sum);
        }
    }
    row.retain(|_, slope| pool.as_constant(*slope) != Some(0.0));
    row
}

/// The same for an unknown of a linear system, which depends on many variables: along every column
/// the system is differentiated once.
fn chain_by_column(
    pool: &mut Pool,
    e: Expr,
    system: [Expr; 2],
    slopes: &FxHashMap<VarId, BTreeMap<usize, Expr>>,
) -> BTreeMap<usize, Expr> {
    let of = |v: VarId| slopes.get(&v).into_iter().flat_map(|row| row.keys().copied());
    let variables = system.map(|list| pool.variables(list));
    let columns: BTreeSet<usize> = variables.iter().flatten().flat_map(|v| of(*v)).collect();
    let mut row = BTreeMap::new();
    for column in columns {
        let seed = |v: VarId| slopes.get(&v).and_then(|row| row.get(&column)).copied();
        row.insert(column, differentiate(pool, e, &seed));
    }
    row.retain(|_, slope| pool.as_constant(*slope) != Some(0.0));
    row
}
