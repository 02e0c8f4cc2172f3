//! `homotopy` after the start: only the actual expressions are left.

use crate::lower::{Dae, Equation};
use crate::symbolic::{Substitution, VarId};

/// The equations with every `homotopy(actual, simplified)` replaced by `actual`.
pub(super) fn actual_equations(dae: &mut Dae) -> Vec<Equation> {
    let mut equations = dae.equations.clone();
    if let Some(homotopy) = dae.homotopy {
        let inactive = dae.pool.constant(0.0);
        let pool = &mut dae.pool;
        let replacement = |v: VarId| (v == homotopy.active).then_some(inactive);
        let mut substitution = Substitution::new(&replacement);
        for equation in &mut equations {
            for side in [&mut equation.left, &mut equation.right] {
                *side = substitution.apply(pool, *side);
            }
        }
    }
    equations
}
