//! `v = 3`: in all other equations the number stands for the variable, and what becomes `w = 4` by
//! that goes on in the same way.
//!
//! `a = b` stays as it is: both are known then, and one will be a name for the other. An equation
//! keeps its last unknown: where there is one equation too many, its report must say of what.

use super::alias_elimination::alias;
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
    let mut known = Known { says: vec![false; dae.equations.len()], pending: Vec::new() };
    for number in 0..dae.equations.len() {
        known.add(dae, number, &occurrences);
    }
    while let Some((v, value)) = known.pending.pop() {
        for number in std::mem::take(&mut occurrences[v.0 as usize]) {
            let number = number as usize;
            if known.says[number] {
                continue;
            }
            if let Some((a, b, negated)) = alias(&dae.pool, dae.equations[number]) {
                let other = if a == v { b } else { a };
                if dae.is_solved_for(other) && !occurrences[other.0 as usize].is_empty() {
                    known.says[number] = true;
                    known.pending.push((other, if negated { -value } else { value }));
                }
                continue;
            }
            replace(dae, number, v, value);
            known.add(dae, number, &occurrences);
        }
    }
}

/// What is known, and not yet replaced.
struct Known {
    /// The equations that say what the values are.
    says: Vec<bool>,
    pending: Vec<(VarId, f64)>,
}

impl Known {
    /// Notes what an equation says; variables without occurrences have been replaced before.
    fn add(&mut self, dae: &Dae, number: usize, occurrences: &[Vec<u32>]) {
        let Some((v, value)) = constant(&dae.pool, dae.equations[number]) else { return };
        if dae.is_solved_for(v) && !occurrences[v.0 as usize].is_empty() {
            self.says[number] = true;
            self.pending.push((v, value));
        }
    }
}

fn replace(dae: &mut Dae, number: usize, v: VarId, value: f64) {
    let Equation { left, right, span } = dae.equations[number];
    let value = dae.pool.constant(value);
    let number_for = |found| (found == v).then_some(value);
    let [left, right] = [left, right].map(|side| substitute(&mut dae.pool, side, &number_for));
    let open = |side| dae.pool.variables(side).iter().any(|v| dae.is_solved_for(*v));
    if open(left) || open(right) {
        dae.equations[number] = Equation { left, right, span };
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
