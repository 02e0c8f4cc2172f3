//! Whether a point is a minimum of the sum of squares, by the relative offset.
//!
//! Reference: [Bates & Watts 1981](gapilib_base::bibliography#bates-watts-1981).

use super::{Evaluation, Linearization, Problem, Run};
use crate::ga::optimizer::{Offset, test_minimum};

/// Whether the best point of a run is a minimum, and the simulations of the test; `None` where that
/// cannot be tested.
pub(crate) fn is_at_minimum(run: &Run) -> Option<(bool, u64)> {
    if !run.evaluation.has_residuals() || run.problem.objectives.len() > 1 {
        return None;
    }
    let values = &run.observed.best.as_ref()?.values;
    let found = run.evaluation.linearize(&run.problem, std::slice::from_ref(values)).pop()?.ok()?;
    Some((tested(&run.problem, &run.evaluation, values, &found).1, found.simulations))
}

/// The test of Bates and Watts at a point that was linearized.
pub fn tested(
    problem: &Problem,
    evaluation: &Evaluation,
    values: &[f64],
    found: &Linearization,
) -> (Offset, bool) {
    let parameters = &problem.parameters;
    let point: Vec<f64> = parameters.iter().zip(values).map(|(f, v)| f.fraction(*v)).collect();
    let residuals = evaluation.residuals(problem, &found.simulated);
    let jacobian = evaluation.weighted(problem, values, found);
    test_minimum(&point, &residuals, &jacobian, [problem.noise, evaluation.size()])
}
