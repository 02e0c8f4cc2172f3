//! Which variables are used at all.

use super::dae::Dae;
use crate::symbolic::{Expr, VariableCollection};

/// For every variable, whether equations, relations, assertions or events contain it.
pub(crate) fn used_variables(dae: &mut Dae) -> Vec<bool> {
    let mut used = vec![false; dae.variables.len()];
    let Dae { pool, equations, initial_equations, relations, assertions, events, .. } = dae;
    let mut collection = VariableCollection::new(pool);
    let mut mark = |e: Expr| collection.add(e, |variable| used[variable.0 as usize] = true);
    for equation in equations.iter().chain(initial_equations.iter()) {
        mark(equation.left);
        mark(equation.right);
    }
    for relation in relations {
        mark(relation.left);
        mark(relation.right);
    }
    for assertion in assertions {
        assertion.for_each_expression(|e| mark(*e));
    }
    events.for_each_expression(|e| mark(*e));
    used
}
