//! How the simulated points change with the parameters: central differences at the best
//! individual, and what follows for the parameters.

use super::{Best, Evaluator, Parameter, Uncertainty, uncertainty};
use crate::diag::Fault;
use crate::ga::Genomes;

/// Smallest relative step.
const SMALLEST_STEP: f64 = 1e-5;

/// What the data tell about the parameters of the best individual, and how many simulations that
/// took; `None` where they tell nothing (too few points, failed simulations).
///
/// # Errors
///
/// Those of [`Evaluator::evaluate`].
pub fn deviations(
    evaluator: &mut Evaluator,
    best: &Best,
    measured: &[f64],
) -> Result<(Option<Uncertainty>, u64), Fault> {
    let points = measured.len();
    if points <= best.genome.len() {
        return Ok((None, 0));
    }
    let steps = steps(evaluator, &best.genome);
    let mut genomes = Genomes::with_capacity(best.genome.len(), 2 * steps.len());
    for (k, ends) in steps.iter().enumerate() {
        for end in ends {
            let mut genome = best.genome.clone();
            genome[k] = *end;
            genomes.push(&genome);
        }
    }
    let simulated = evaluator.evaluate(&genomes)?;
    let row = |number: usize| match &simulated.failures[number] {
        None => &simulated.rows[number * points..(number + 1) * points],
        // One-sided where one side fails.
        Some(_) => &best.simulated,
    };
    let column = |(k, [low, high]): (usize, &[f64; 2])| {
        let (below, above) = (row(2 * k), row(2 * k + 1));
        let value = best.genome[k];
        let from = if simulated.failures[2 * k].is_none() { *low } else { value };
        let to = if simulated.failures[2 * k + 1].is_none() { *high } else { value };
        below.iter().zip(above).map(|(below, above)| (above - below) / (to - from)).collect()
    };
    let jacobian: Vec<Vec<f64>> = steps.iter().enumerate().map(column).collect();
    let residuals: Vec<f64> = measured.iter().zip(&best.simulated).map(|(m, s)| m - s).collect();
    Ok((uncertainty(&jacobian, &residuals), genomes.len() as u64))
}

/// Below and above every gene. The step follows the tolerance of the simulator, or the differences
/// would be those of its errors; it stays within what the model allows.
fn steps(evaluator: &Evaluator, genome: &[f64]) -> Vec<[f64; 2]> {
    let relative = evaluator.settings().tolerance.cbrt().max(SMALLEST_STEP);
    let step = |(&value, parameter): (&f64, &Parameter)| {
        let step = relative * if value == 0.0 { 1.0 } else { value.abs() };
        [(value - step).max(parameter.min), (value + step).min(parameter.max)]
    };
    genome.iter().zip(evaluator.parameters()).map(step).collect()
}
