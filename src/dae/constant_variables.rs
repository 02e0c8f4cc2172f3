//! `v = 3`: in all other equations the number stands for the variable, and what becomes `w = 4` by
//! that goes on in the same way. An equation keeps its last unknown: one too many must say of what.

use super::model::{Dae, Equation};
use crate::symbolic::{Expr, Node, Pool, VarId, substitute};

/// Replaces variables that equal numbers in all equations but those that say so.
pub(super) fn substitute_constants(dae: &mut Dae) {
    let mut occurrences: Vec<Vec<u32>> = vec![Vec::new(); dae.variables.len()];
    for (number, equation) in dae.equations.iter().enumerate() {
        for side in [equation.left, equation.right] {
            for v in dae.pool.variables(side) {
                occurrences[v.0 as usize].push(number as u32);
            }
        }
    }
    let mut says = vec![false; dae.equations.len()];
    let mut known = vec![false; dae.variables.len()];
    let mut pending: Vec<usize> = (0..dae.equations.len()).collect();
    while let Some(number) = pending.pop() {
        let Some((v, value)) = constant(&dae.pool, dae.equations[number]) else { continue };
        if says[number] || known[v.0 as usize] || !dae.is_solved_for(v) {
            continue;
        }
        (says[number], known[v.0 as usize]) = (true, true);
        let value = dae.pool.constant(value);
        for other in std::mem::take(&mut occurrences[v.0 as usize]) {
            let other = other as usize;
            if other == number {
                continue;
            }
            let Equation { left, right, span } = dae.equations[other];
            let number_for = |found| (found == v).then_some(value);
            let [left, right] =
                [left, right].map(|side| substitute(&mut dae.pool, side, &number_for));
            let open = |side| dae.pool.variables(side).iter().any(|v| dae.is_solved_for(*v));
            if open(left) || open(right) {
                dae.equations[other] = Equation { left, right, span };
                pending.push(other);
            }
        }
    }
}

/// The variable that an equation sets to a number.
fn constant(pool: &Pool, equation: Equation) -> Option<(VarId, f64)> {
    let sides = |side: Expr, other: Expr| {
        let value = pool.as_constant(other).filter(|value| value.is_finite())?;
        match pool.node(side) {
            Node::Variable(v) => Some((*v, value)),
            Node::Neg(inner) => Some((pool.as_variable(*inner)?, -value)),
            _ => None,
        }
    };
    sides(equation.left, equation.right).or_else(|| sides(equation.right, equation.left))
}
