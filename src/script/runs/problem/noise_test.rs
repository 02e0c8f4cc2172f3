//! After a fit with process noise: one without it, and a simulation that does not see the data.

use super::file::{Filtering, ProblemFile};
use super::searches::{Again, Change};
use crate::Session;
use crate::diag::Fault;
use crate::identify::problem::{EndingKind, NoiseComparison, Problem, Run, Solution};

/// Compares a fit with what its densities `names` add, and says it.
///
/// # Errors
///
/// Those of the problem that is made again.
pub(super) fn compare(
    session: &mut Session,
    (run, solution): (&mut Run, &mut Solution),
    names: &[String],
    again: &mut Again<'_>,
) -> Result<(), Fault> {
    if solution.outcome.ending.kind != EndingKind::Minimum || session.world.interrupted() {
        return Ok(());
    }
    let mut without = None;
    if !names.is_empty() {
        let change = |file: &mut ProblemFile| file.filtering = Filtering::WithoutNoise;
        let other = again(session, Change::Entries(&change))?;
        let processors = session.world.processors();
        let (found, simulations) = run.best_with(other.problem.simulator, &processors)?;
        solution.effort.simulations_for_statistics += simulations;
        without = found.map(|best| best.fitness);
    }
    let change = |file: &mut ProblemFile| file.filtering = Filtering::Simulated;
    let other = again(session, Change::Entries(&change))?;
    solution.effort.simulations_for_statistics += 1;
    let values: Vec<f64> = solution.parameters.iter().map(|own| own.value).collect();
    let simulated = errors(&other.problem, &values)?;
    solution.judge_noise(&NoiseComparison { names, without, simulated });
    Ok(())
}

/// The root mean squared residuals of the measured series.
fn errors(problem: &Problem, values: &[f64]) -> Result<Option<Vec<f64>>, Fault> {
    let count = problem.series.iter().map(|own| own.x.len()).sum();
    let mut row = vec![0.0; count];
    if (problem.simulator)()?.simulate(values, &mut row).is_err() {
        return Ok(None);
    }
    let mut rest = &row[..];
    let error = |own: &crate::identify::problem::Series| {
        let (simulated, others) = rest.split_at(own.x.len());
        rest = others;
        let squares = own.y.iter().zip(simulated).map(|(y, s)| (y - s) * (y - s));
        own.is_data().then(|| (squares.sum::<f64>() / own.y.len() as f64).sqrt())
    };
    Ok(Some(problem.series.iter().filter_map(error).collect()))
}
