//! Linear loops: the residuals contain the iteration variables linearly, with coefficients free of
//! them.
//!
//! ```text
//! one   a z + r = 0                    z = −r / a
//! two   a z + b w + r = 0              z = (b s − d r) / (a d − b c)
//!       c z + d w + s = 0              w = (c r − a s) / (a d − b c)
//! more  A z = b                        by elimination when it is evaluated
//! ```
//!
//! The closed forms are taken where the divisor cannot vanish. Where it can, elimination finds out
//! whether there is a solution; of many it takes the smallest. So that it is the smallest in all
//! unknowns of the loop, one that is singular with the default parameters is solved without tearing.

use super::causalized::{Assignment, LinearLoop, Loop};
use crate::lower::{Dae, VariableKind};
use crate::symbolic::{Expr, Linear, Node, Pool, VarId, differentiate_all, linear_in, substitute};
use rustc_hash::{FxHashMap, FxHashSet};

/// Nodes of the residuals beyond which a loop is left to iteration.
const MOST_NODES: usize = 200_000;
/// Unknowns beyond which a loop is left to the integrator, which knows sparse matrices.
const MOST_UNKNOWNS: usize = 120;
/// A matrix of rows and columns of size one is singular if one of its singular values is a smaller part
/// of the largest.
const SMALLEST: f64 = 1e-13;

/// The solution of a torn loop, if it is linear.
pub(super) fn solve_linear(dae: &mut Dae, torn: &Loop) -> Option<LinearLoop> {
    if torn.iteration.is_empty() || torn.iteration.len() > MOST_UNKNOWNS {
        return None;
    }
    let residuals = residuals(&mut dae.pool, torn)?;
    if !are_linear(&dae.pool, &residuals, &torn.iteration) {
        return None;
    }
    let values = match closed_form(dae, &torn.iteration, &residuals) {
        Some(values) => values,
        None => {
            let values = by_elimination(&mut dae.pool, &torn.iteration, &residuals);
            if is_singular(dae, &values)
                && let Some(whole) = untorn(torn, &mut dae.pool)
            {
                return solve_linear(dae, &whole);
            }
            values
        }
    };
    let solved = torn.iteration.iter().zip(values).zip(&torn.residuals);
    let mut assignments: Vec<Assignment> = solved
        .map(|((variable, value), (_, equation))| Assignment {
            variable: *variable,
            value,
            equation: *equation,
        })
        .collect();
    assignments.extend(&torn.assignments);
    let (unknowns, residuals) = (torn.iteration.clone(), torn.residuals.clone());
    Some(LinearLoop { unknowns, assignments, residuals })
}

/// Whether a matrix has a value with the default parameters, and is singular then. Lines that are zero
/// because parameters are so are left to `vanishing_coefficients`.
fn is_singular(dae: &Dae, solutions: &[Expr]) -> bool {
    let Some(Node::Solution { matrix, .. }) = solutions.first().map(|e| dae.pool.node(*e)) else {
        return false;
    };
    let n = solutions.len();
    let entries = dae.pool.entries(*matrix);
    let values: Vec<f64> = entries.iter().map(|e| dae.defaults.of(dae, *e)).collect();
    if values.iter().any(|value| !value.is_finite()) {
        return false;
    }
    let vanishes = |at: usize| values[at] == 0.0 && dae.pool.as_constant(entries[at]).is_none();
    let is_zero = |line: &dyn Fn(usize) -> usize| (0..n).all(|i| values[line(i)] == 0.0);
    for line in 0..n {
        let (row, column) = (|i: usize| line * n + i, |i: usize| i * n + line);
        let vanish = [
            is_zero(&row) && (0..n).any(|i| vanishes(row(i))),
            is_zero(&column) && (0..n).any(|i| vanishes(column(i))),
        ];
        if vanish.contains(&true) {
            return false;
        }
    }
    let mut matrix = nalgebra::DMatrix::from_row_slice(n, n, &values);
    matrix.row_iter_mut().for_each(|mut row| scale(row.amax(), |factor| row *= factor));
    matrix.column_iter_mut().for_each(|mut column| scale(column.amax(), |factor| column *= factor));
    let singular_values = matrix.singular_values();
    singular_values.min() <= SMALLEST * singular_values.max()
}

/// Divides by what is not zero.
fn scale(largest: f64, multiply: impl FnOnce(f64)) {
    if largest > 0.0 {
        multiply(largest.recip());
    }
}

/// A loop that is solved for all of its unknowns at once; `None` if it is so already.
fn untorn(torn: &Loop, pool: &mut Pool) -> Option<Loop> {
    if torn.assignments.is_empty() {
        return None;
    }
    let mut iteration = torn.iteration.clone();
    let mut residuals = torn.residuals.clone();
    for assignment in &torn.assignments {
        let variable = pool.variable(assignment.variable);
        iteration.push(assignment.variable);
        residuals.push((pool.sub(variable, assignment.value), assignment.equation));
    }
    (iteration.len() <= MOST_UNKNOWNS).then(|| Loop {
        iteration,
        assignments: Vec::new(),
        residuals,
    })
}

/// The residuals as expressions of the iteration variables.
fn residuals(pool: &mut Pool, torn: &Loop) -> Option<Vec<Expr>> {
    let mut inner: FxHashMap<VarId, Expr> = FxHashMap::default();
    for assignment in &torn.assignments {
        let value = substitute(pool, assignment.value, &|v| inner.get(&v).copied());
        inner.insert(assignment.variable, value);
    }
    let mut residuals = Vec::new();
    for (residual, _) in &torn.residuals {
        residuals.push(substitute(pool, *residual, &|v| inner.get(&v).copied()));
    }
    (pool.reachable(&residuals).len() <= MOST_NODES).then_some(residuals)
}

/// Whether expressions are linear in variables by the form they are written in.
fn are_linear(pool: &Pool, exprs: &[Expr], variables: &[VarId]) -> bool {
    let variables: FxHashSet<VarId> = variables.iter().copied().collect();
    let mut depending: FxHashSet<Expr> = FxHashSet::default();
    for e in pool.reachable(exprs) {
        let depends = |a: &Expr| depending.contains(a);
        let (depends, is_linear) = match pool.node(e) {
            Node::Variable(v) => (variables.contains(v), true),
            Node::Neg(a) => (depends(a), true),
            Node::Add(a, b) | Node::Sub(a, b) => (depends(a) || depends(b), true),
            Node::Mul(a, b) => (depends(a) || depends(b), !(depends(a) && depends(b))),
            Node::Div(a, b) => (depends(a), !depends(b)),
            Node::If(condition, a, b) => (depends(a) || depends(b), !depends(condition)),
            node => {
                let mut any = false;
                node.for_each_operand(|operand| any |= depends(&operand));
                (any, !any)
            }
        };
        if !is_linear {
            return false;
        }
        if depends {
            depending.insert(e);
        }
    }
    true
}

fn closed_form(dae: &mut Dae, unknowns: &[VarId], residuals: &[Expr]) -> Option<Vec<Expr>> {
    let (values, divisor) = match (unknowns, residuals) {
        (&[z], &[residual]) => one(&mut dae.pool, residual, z)?,
        (&[z, w], &[first, second]) => two(&mut dae.pool, [first, second], [z, w])?,
        _ => return None,
    };
    is_safe(dae, divisor).then_some(values)
}

/// The unknown and what is divided by.
fn one(pool: &mut Pool, residual: Expr, z: VarId) -> Option<(Vec<Expr>, Expr)> {
    let Linear { coefficient, rest } = linear_in(pool, residual, z)?;
    let opposite = pool.neg(rest);
    Some((vec![pool.div(opposite, coefficient)], coefficient))
}

/// The unknowns and what is divided by.
fn two(pool: &mut Pool, residuals: [Expr; 2], [z, w]: [VarId; 2]) -> Option<(Vec<Expr>, Expr)> {
    let [(a, b, r), (c, d, s)] =
        [coefficients(pool, residuals[0], [z, w])?, coefficients(pool, residuals[1], [z, w])?];
    let mut cross = |a: Expr, d: Expr, b: Expr, c: Expr| {
        let (ad, bc) = (pool.mul(a, d), pool.mul(b, c));
        pool.sub(ad, bc)
    };
    let determinant = cross(a, d, b, c);
    let (upper, lower) = (cross(b, s, d, r), cross(c, r, a, s));
    Some((vec![pool.div(upper, determinant), pool.div(lower, determinant)], determinant))
}

fn coefficients(pool: &mut Pool, residual: Expr, [z, w]: [VarId; 2]) -> Option<(Expr, Expr, Expr)> {
    let Linear { coefficient: a, rest } = linear_in(pool, residual, z)?;
    if pool.depends_on(a, w) {
        return None;
    }
    let Linear { coefficient: b, rest } = linear_in(pool, rest, w)?;
    Some((a, b, rest))
}

/// A holds the derivatives of the residuals, b their negated values where all unknowns are zero.
fn by_elimination(pool: &mut Pool, unknowns: &[VarId], residuals: &[Expr]) -> Vec<Expr> {
    let n = unknowns.len();
    let (zero, one) = (pool.constant(0.0), pool.constant(1.0));
    let mut matrix = vec![zero; n * n];
    for (column, unknown) in unknowns.iter().enumerate() {
        let seed = |v: VarId| (v == *unknown).then_some(one);
        let column_entries = differentiate_all(pool, residuals, &seed);
        for (row, entry) in column_entries.into_iter().enumerate() {
            matrix[row * n + column] = entry;
        }
    }
    let at_zero = |v: VarId| unknowns.contains(&v).then_some(zero);
    let mut right = Vec::with_capacity(n);
    for residual in residuals {
        let rest = substitute(pool, *residual, &at_zero);
        right.push(if pool.as_constant(rest) == Some(0.0) { zero } else { pool.neg(rest) });
    }
    let (matrix, right) = (pool.list(&matrix), pool.list(&right));
    (0..n as u32).map(|output| pool.solution(matrix, right, output)).collect()
}

/// Whether a divisor is a number that is not zero, or made of parameters that do not make it zero
/// by default: where others make it zero, the division fails with a message rather than giving a
/// wrong value.
pub(super) fn is_safe(dae: &Dae, divisor: Expr) -> bool {
    if let Some(value) = dae.pool.as_constant(divisor) {
        return value != 0.0;
    }
    let varies = |v: VarId| !matches!(dae.variable(v).kind, VariableKind::Parameter { .. });
    !dae.pool.any_variable(divisor, varies) && {
        let value = dae.defaults.of(dae, divisor);
        value.is_finite() && value != 0.0
    }
}
