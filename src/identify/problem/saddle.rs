//! Saddles: points at which the gradient vanishes because derivatives depend on each other there, not
//! because nothing nearby is better.
//!
//! Along a null direction of the Jacobian the model of Gauss and Newton is flat, so that the test of a
//! minimum says nothing of it. A finite step shows what is so: the objective stays (a combination of
//! parameters has no effect), rises, or falls, as beside the symmetric point of two exponentials with
//! equal rates. Where it falls, least squares go on from there.

use super::{Best, Finding, FindingKind, Run, Severity};
use crate::diag::Fault;
use crate::elementary;
use crate::ga::optimizer::FROM_THE_SOLVER;
use crate::singular_values::SingularValues;
use crate::table::significant;
use nalgebra::DMatrix;

/// So many saddles one after the other.
const MOST: usize = 4;
/// Singular values below this part of the largest belong to null directions, also of differences.
const NULL: f64 = 1e-4;
/// Steps along a null direction, as parts of the ranges.
const STEPS: [f64; 4] = [0.1, -0.1, 0.01, -0.01];
/// An objective that is smaller by this part is not so by rounding.
const BETTER: f64 = 1e-6;

/// Continues from the best point as long as it is a saddle.
///
/// # Errors
///
/// Those of least squares.
pub fn leave(run: &mut Run) -> Result<(), Fault> {
    if !run.evaluation.has_residuals() || run.problem.objectives.len() > 1 {
        return Ok(());
    }
    let Some(first) = run.observed.best.as_ref().map(|best| best.fitness) else { return Ok(()) };
    let mut left = false;
    for _ in 0..MOST {
        let Some(lower) = lower_beside(run) else { break };
        let before = run.observed.best.replace(lower);
        run.refit()?;
        let is_lower = |now: &Best, old: &Best| now.fitness < old.fitness;
        if !run
            .observed
            .best
            .as_ref()
            .zip(before.as_ref())
            .is_some_and(|(now, old)| is_lower(now, old))
        {
            run.observed.best = before;
            break;
        }
        left = true;
    }
    if let Some(best) = run.observed.best.as_ref().filter(|_| left) {
        let sentence = format!(
            "The search ended at a saddle point ({}), where derivatives are linearly dependent; \
             least squares continued from a point nearby to {}.",
            significant(first, 5),
            significant(best.fitness, 5)
        );
        let finding = Finding::new(FindingKind::Search, sentence);
        run.conclusion.findings.push(finding.severity(Severity::Information));
    }
    Ok(())
}

/// Whether the objective is a sum of squares of the errors of the simulation: other points are better
/// by rounding only.
fn is_exact(run: &Run, best: &Best) -> bool {
    let without_model = vec![0.0; run.problem.n_points()];
    let size = run.evaluation.objective(&run.problem, &without_model);
    (0.0..=elementary::powi(FROM_THE_SOLVER * run.problem.noise, 2) * size).contains(&best.fitness)
}

/// The best of some points along the null directions, if it is better than the best of the run.
fn lower_beside(run: &mut Run) -> Option<Best> {
    let best = run.observed.best.as_ref().filter(|best| !is_exact(run, best))?;
    let directions = null_directions(run, &best.values)?;
    let free = &run.problem.parameters;
    let step = |direction: &Vec<f64>, size: f64| {
        let places = free.iter().zip(&best.values).zip(direction);
        places
            .map(|((free, value), part)| {
                free.value((free.fraction(*value) + size * part).clamp(0.0, 1.0))
            })
            .collect::<Vec<f64>>()
    };
    let places: Vec<Vec<f64>> =
        directions.iter().flat_map(|d| STEPS.iter().map(|size| step(d, *size))).collect();
    let simulated = run.evaluation.simulate_all(&places);
    run.conclusion.simulations += places.len() as u64;
    let rated = places.into_iter().zip(simulated).filter_map(|(values, row)| {
        let fitness = run.evaluation.objective(&run.problem, &row.ok()?);
        Some(Best { values, fitness })
    });
    let lowest = rated.min_by(|a, b| a.fitness.total_cmp(&b.fitness))?;
    (lowest.fitness < best.fitness * (1.0 - BETTER)).then_some(lowest)
}

/// Directions in fractions of the ranges along which no residual changes.
fn null_directions(run: &Run, values: &[f64]) -> Option<Vec<Vec<f64>>> {
    let found = run.evaluation.linearize(&run.problem, &[values.to_vec()]).pop()?.ok()?;
    let jacobian = run.evaluation.weighted(&run.problem, values, &found);
    let n = values.len();
    let rows = jacobian.len() / n;
    // Rows of zeros make directions of what too few points leave free.
    let entry = |row: usize, column: usize| match row < rows {
        true => jacobian[row * n + column],
        false => 0.0,
    };
    let decomposed = SingularValues::of(&DMatrix::from_fn(rows.max(n), n, entry))?;
    let least = NULL * decomposed.largest();
    let null = (0..n).filter(|k| decomposed.s[*k] <= least);
    Some(null.map(|k| decomposed.v_t.row(k).iter().copied().collect()).collect())
}
