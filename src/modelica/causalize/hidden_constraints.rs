//! Constraints that numbers hide: the equations of a linear loop may depend on each other although
//! each of them could determine an unknown.
//!
//! ```text
//! a i₁ + b i₂ = u        i₁, i₂ unknown        0 = u - w/2 follows, and takes the place of one
//! 2a i₁ + 2b i₂ = w      u, w known            of them: index reduction sees it then
//! ```
//!
//! The currents of the phases of a star determine the field of a machine by cosines; with five phases
//! and more the equations of the field are fewer than they seem. Only coefficients that are numbers
//! are looked at: what depends on parameters may be singular for some of their values alone, which
//! is found out when it is solved.

use super::causalized::{Block, LinearLoop};
use crate::lower::{Dae, Equation};
use crate::symbolic::{Expr, Node, VarId};
use rustc_hash::{FxHashMap, FxHashSet};
use std::collections::{BTreeMap, BTreeSet};

/// Sums that are smaller parts of their terms are rounding errors: cosines of the angles of five phases
/// leave 2e-16.
const ROUNDING: f64 = 1e-11;
/// Equations that no own unknown determines; loops with more of them are left as they are.
const MOST_EQUATIONS: usize = 1_000;

/// A sum of expressions with numbers as factors.
type Sum = BTreeMap<Expr, f64>;

/// An equation, or what is left of it: unknowns + known = 0.
struct Row {
    /// Its number among the equations.
    equation: usize,
    unknowns: Sum,
    known: Sum,
}

/// Equations that take the place of others, by number: of the first `n_given`, which are those before index
/// reduction, as what is made of others has no place there.
pub(super) fn hidden_constraints(
    dae: &mut Dae,
    equations: &[Equation],
    blocks: &[Block],
    n_given: usize,
) -> Vec<(usize, Equation)> {
    let mut found = Vec::new();
    for block in blocks {
        let Block::Linear(LinearLoop { assignments, .. }) = block else { continue };
        let numbers = assignments.iter().map(|a| a.equation);
        let members = assignments.iter().map(|a| a.variable).collect();
        let rows = without_own_unknowns(rows(dae, equations, (numbers, &members), n_given));
        if rows.len() > MOST_EQUATIONS {
            continue;
        }
        for row in dependent(rows) {
            found.extend(
                constraint(dae, equations[row.equation], &row.known).map(|e| (row.equation, e)),
            );
        }
    }
    found
}

/// Whether the equations of a block may depend on each other, should the block be a linear loop: what
/// is found out without solving it.
pub(super) fn may_be_dependent(
    dae: &Dae,
    equations: &[Equation],
    (block, members): (&[usize], &[VarId]),
    n_given: usize,
) -> bool {
    let members = members.iter().copied().collect();
    let rows = rows(dae, equations, (block.iter().copied(), &members), n_given);
    !without_own_unknowns(rows).is_empty()
}

/// The equations of a loop, by their numbers, whose unknowns have numbers as factors.
fn rows(
    dae: &Dae,
    equations: &[Equation],
    (numbers, members): (impl Iterator<Item = usize>, &FxHashSet<VarId>),
    n_given: usize,
) -> Vec<Row> {
    let is_member = |e: Expr| dae.pool.as_variable(e).is_some_and(|v| members.contains(&v));
    let row = |at: usize| {
        let sum = sum_of(dae, equations[at]);
        let (unknowns, known): (Sum, Sum) = sum.into_iter().partition(|(e, _)| is_member(*e));
        let is_known = |e: &Expr| !dae.pool.any_variable(*e, |v| members.contains(&v));
        known.keys().all(is_known).then_some(Row { equation: at, unknowns, known })
    };
    numbers.filter(|at| *at < n_given).filter_map(row).collect()
}

/// Left side − right side.
fn sum_of(dae: &Dae, equation: Equation) -> Sum {
    let pool = &dae.pool;
    let mut sum = Sum::new();
    let mut open = vec![(equation.left, 1.0), (equation.right, -1.0)];
    while let Some((e, factor)) = open.pop() {
        match *pool.node(e) {
            Node::Neg(a) => open.push((a, -factor)),
            Node::Add(a, b) => open.extend([(a, factor), (b, factor)]),
            Node::Sub(a, b) => open.extend([(a, factor), (b, -factor)]),
            Node::Mul(a, b) => match (pool.as_constant(a), pool.as_constant(b)) {
                (Some(number), _) => open.push((b, factor * number)),
                (None, Some(number)) => open.push((a, factor * number)),
                (None, None) => add(&mut sum, e, factor),
            },
            Node::Div(a, b) => match pool.as_constant(b) {
                Some(number) if number != 0.0 => open.push((a, factor / number)),
                _ => add(&mut sum, e, factor),
            },
            _ => match pool.as_constant(e) {
                Some(0.0) => {}
                _ => add(&mut sum, e, factor),
            },
        }
    }
    sum
}

/// Adds a multiple of an expression; what rounding errors leave of it is nothing.
fn add(sum: &mut Sum, e: Expr, factor: f64) {
    let before = sum.get(&e).copied().unwrap_or(0.0);
    let after = before + factor;
    if after.abs() <= ROUNDING * before.abs().max(factor.abs()) {
        sum.remove(&e);
    } else {
        sum.insert(e, after);
    }
}

/// Without the equations that have an unknown of their own: they depend on no others.
fn without_own_unknowns(rows: Vec<Row>) -> Vec<Row> {
    let mut owners: FxHashMap<Expr, BTreeSet<usize>> = FxHashMap::default();
    for (at, row) in rows.iter().enumerate() {
        row.unknowns.keys().for_each(|unknown| _ = owners.entry(*unknown).or_default().insert(at));
    }
    let is_own = |owners: &FxHashMap<Expr, BTreeSet<usize>>, row: &Row| {
        row.unknowns.keys().any(|unknown| owners[unknown].len() == 1)
    };
    let mut rows: Vec<Option<Row>> = rows.into_iter().map(Some).collect();
    let mut open: Vec<usize> = (0..rows.len()).collect();
    while let Some(at) = open.pop() {
        let Some(row) = rows[at].take_if(|row| is_own(&owners, row)) else { continue };
        for unknown in row.unknowns.keys() {
            let Some(others) = owners.get_mut(unknown) else { continue };
            others.remove(&at);
            open.extend(others.iter());
        }
    }
    rows.into_iter().flatten().collect()
}

/// Gaussian elimination: what is left of equations that depend on others has no unknowns.
fn dependent(mut rows: Vec<Row>) -> Vec<Row> {
    let mut found = Vec::new();
    while let Some(at) = (0..rows.len()).min_by_key(|at| rows[*at].unknowns.len()) {
        let row = rows.swap_remove(at);
        let entries = row.unknowns.iter();
        let Some((pivot, largest)) = entries.max_by(|a, b| a.1.abs().total_cmp(&b.1.abs())) else {
            found.push(row);
            continue;
        };
        for other in &mut rows {
            let Some(entry) = other.unknowns.get(pivot) else { continue };
            let factor = -entry / largest;
            row.unknowns.iter().for_each(|(e, value)| add(&mut other.unknowns, *e, factor * value));
            other.unknowns.remove(pivot);
            row.known.iter().for_each(|(e, value)| add(&mut other.known, *e, factor * value));
        }
    }
    found
}

/// What is known of unknowns of other parts of the system; `None` if it says nothing about any.
fn constraint(dae: &mut Dae, place: Equation, known: &Sum) -> Option<Equation> {
    let constrains = |e: &Expr| dae.pool.any_variable(*e, |v| dae.is_unknown(v));
    if !known.keys().any(constrains) {
        return None;
    }
    let pool = &mut dae.pool;
    let mut sum = pool.constant(0.0);
    for (e, factor) in known {
        let factor = pool.constant(*factor);
        let term = pool.mul(factor, *e);
        sum = pool.add(sum, term);
    }
    let zero = pool.constant(0.0);
    Some(Equation { left: sum, right: zero, ..place })
}
