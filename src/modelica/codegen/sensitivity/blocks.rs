//! Derivatives through blocks whose solution is known: the values of all variables are those in
//! their registers, so that only derivatives are computed.

use super::super::jacobian::{Forward, differentiate_sequence};
use crate::causalize::{Assignment, Block, Loop};
use crate::symbolic::{Expr, Pool, VarId, VariableCollection};
use rustc_hash::FxHashSet;
use std::collections::{BTreeMap, BTreeSet};

/// Carries derivatives through blocks in order; `made` gets the assignments that compute them.
pub(in super::super) fn through_blocks<'b>(
    forward: &mut Forward<'_>,
    blocks: impl IntoIterator<Item = &'b Block>,
    made: &mut Vec<Assignment>,
) {
    for block in blocks {
        match block {
            Block::Assignment(_) | Block::Linear(_) => {
                block.assignments().iter().for_each(|a| forward.assign(a, made));
            }
            Block::Loop(torn) => through_loop(forward, torn, made),
        }
    }
}

/// The blocks that expressions need, in order.
pub(super) fn needed_blocks<'b>(
    pool: &Pool,
    blocks: &'b [Block],
    expressions: &[Expr],
) -> Vec<&'b Block> {
    let mut needed = FxHashSet::default();
    let mut collection = VariableCollection::new(pool);
    let mut add = |e: Expr, needed: &mut FxHashSet<VarId>| {
        collection.add(e, |variable| {
            needed.insert(variable);
        });
    };
    expressions.iter().for_each(|e| add(*e, &mut needed));
    let mut found = Vec::new();
    for block in blocks.iter().rev() {
        let of_loop: &[VarId] = match block {
            Block::Loop(torn) => &torn.iteration,
            Block::Assignment(_) | Block::Linear(_) => &[],
        };
        let mut own = block.assignments().iter().map(|a| a.variable).chain(of_loop.iter().copied());
        if own.any(|variable| needed.contains(&variable)) {
            block.assignments().iter().for_each(|a| add(a.value, &mut needed));
            block.residuals().for_each(|residual| add(residual, &mut needed));
            found.push(block);
        }
    }
    found.reverse();
    found
}

/// A torn loop r(z, …) = 0: ∂r/∂z · dz = −dr with z held, then everything that follows from z.
fn through_loop(forward: &mut Forward<'_>, torn: &Loop, made: &mut Vec<Assignment>) {
    let residuals: Vec<Expr> = torn.residuals.iter().map(|(residual, _)| *residual).collect();
    let equation = torn.residuals.first().map_or(0, |(_, equation)| *equation);
    let n = torn.iteration.len();
    for unknown in &torn.iteration {
        forward.seed(*unknown, BTreeMap::new());
    }
    torn.assignments.iter().for_each(|a| forward.assign(a, made));
    let held: Vec<BTreeMap<usize, Expr>> = residuals.iter().map(|r| forward.row(*r)).collect();
    let columns: BTreeSet<usize> = held.iter().flat_map(|row| row.keys().copied()).collect();
    if columns.is_empty() {
        return;
    }
    let matrix = matrix_of(forward, torn, &residuals, made);
    let mut rows = vec![BTreeMap::new(); n];
    for column in columns {
        let zero = forward.pool.constant(0.0);
        let right: Vec<Expr> = held
            .iter()
            .map(|row| row.get(&column).map_or(zero, |entry| forward.pool.neg(*entry)))
            .collect();
        let right = forward.pool.list(&right);
        for (output, row) in (0u32..).zip(&mut rows) {
            row.insert(column, forward.pool.solution(matrix, right, output));
        }
    }
    for (unknown, mut row) in torn.iteration.iter().zip(rows) {
        forward.name(&mut row, equation, made);
        forward.seed(*unknown, row);
    }
    torn.assignments.iter().for_each(|a| forward.assign(a, made));
}

/// The list of the entries of ∂r/∂z, by rows.
fn matrix_of(
    forward: &mut Forward<'_>,
    torn: &Loop,
    residuals: &[Expr],
    made: &mut Vec<Assignment>,
) -> Expr {
    let (pool, next) = forward.parts();
    let inner = differentiate_sequence(pool, &torn.assignments, residuals, &torn.iteration, next);
    // The values of the variables are in their registers.
    let is_new = |a: &&Assignment| torn.assignments.iter().all(|b| b.variable != a.variable);
    made.extend(inner.sequence.iter().filter(is_new));
    let zero = pool.constant(0.0);
    let n = torn.iteration.len();
    let mut entries = vec![zero; residuals.len() * n];
    for (row, derivatives) in inner.rows.iter().enumerate() {
        for (column, entry) in derivatives {
            entries[row * n + column] = *entry;
        }
    }
    pool.list(&entries)
}
