//! States chosen at run time, where the Jacobian of constraints may become singular for any choice
//! made beforehand.
//!
//! With m constraints on k candidates z, whose derivatives are ż, there are k − m states
//!
//! ```text
//!   qᵢ = Σ aᵢⱼ zⱼ        q̇ᵢ = Σ aᵢⱼ żⱼ
//! ```
//!
//! with weights a of which one is 1 in every row and the others 0. They are constant between events:
//! when the choice becomes bad the system sets other weights and continues from the same z.
//!
//! Reference: [Mattsson & Söderlind 1993](gapilib_base::bibliography#mattsson-soderlind-1993), section 4.

use super::causalized::Selection;
use crate::lower::{Dae, Equation, VariableKind, derivative_of, scalar_of_nothing};
use crate::source::Span;
use crate::symbolic::{Expr, VarId};

/// A candidate and its derivative.
#[derive(Debug, Clone, Copy)]
pub(super) struct Candidate {
    pub(super) variable: VarId,
    pub(super) derivative: Expr,
    /// Whether it is a state at first.
    pub(super) is_chosen: bool,
}

/// Declares states, weights and their equations; `jacobian` is that of the constraints in the
/// candidates, by rows.
pub(super) fn declare_selection(
    dae: &mut Dae,
    candidates: &[Candidate],
    jacobian: Vec<Vec<Expr>>,
    number: usize,
    span: Span,
) -> Selection {
    let numbered = candidates.iter().enumerate();
    let chosen: Vec<usize> = numbered.filter(|(_, c)| c.is_chosen).map(|(at, _)| at).collect();
    let mut selection = Selection {
        jacobian,
        candidates: candidates.iter().map(|c| c.variable).collect(),
        states: Vec::new(),
        weights: Vec::new(),
        chosen,
    };
    for (row, at) in selection.chosen.clone().into_iter().enumerate() {
        let name = format!("$state[{},{}]", number + 1, row + 1);
        let mut state = scalar_of_nothing(&name, VariableKind::Unknown, span);
        state.start = dae.variable(candidates[at].variable).start;
        state.nominal = dae.variable(candidates[at].variable).nominal;
        let id = push(dae, state);
        let derivative = derivative_of(dae.variable(id), id);
        let derivative = push(dae, derivative);
        let weights = (0..candidates.len()).map(|column| {
            let name = format!("$weight[{},{},{}]", number + 1, row + 1, column + 1);
            push(dae, scalar_of_nothing(&name, VariableKind::Frozen, span))
        });
        let weights: Vec<VarId> = weights.collect();
        let values = candidates.iter().map(|c| c.variable);
        let values: Vec<Expr> = values.map(|v| dae.pool.variable(v)).collect();
        let derivatives: Vec<Expr> = candidates.iter().map(|c| c.derivative).collect();
        for (left, terms) in [(id, values), (derivative, derivatives)] {
            let (left, right) = (dae.pool.variable(left), weighted_sum(dae, &weights, &terms));
            dae.equations.push(Equation::new(left, right, span));
        }
        selection.states.push(id);
        selection.weights.push(weights);
    }
    selection
}

fn push(dae: &mut Dae, variable: crate::lower::Variable) -> VarId {
    dae.variables.push(variable);
    VarId(dae.variables.len() as u32 - 1)
}

fn weighted_sum(dae: &mut Dae, weights: &[VarId], terms: &[Expr]) -> Expr {
    let pool = &mut dae.pool;
    let mut sum = pool.constant(0.0);
    for (weight, term) in weights.iter().zip(terms) {
        let weight = pool.variable(*weight);
        let product = pool.mul(weight, *term);
        sum = pool.add(sum, product);
    }
    sum
}
