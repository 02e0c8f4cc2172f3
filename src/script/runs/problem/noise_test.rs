//! After a fit with process noise: one without it, a simulation that does not see the data, and the states
//! from all data.

use super::build::with_states;
use super::estimate::Estimation;
use super::file::{Filtering, MoreTimes, ProblemFile};
use super::searches::{Again, Change};
use crate::Session;
use crate::diag::Fault;
use crate::identify::problem::{
    EndingKind, Finding, FindingKind, NoiseComparison, Problem, Run, Series, Solution,
    SolvedParameter,
};

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
    if session.world.interrupted() {
        return Ok(());
    }
    let is_minimum = solution.outcome.ending.kind == EndingKind::Minimum;
    follow(session, solution, is_minimum, again)?;
    if !is_minimum {
        return Ok(());
    }
    let mut without = None;
    if !names.is_empty() {
        let change = |file: &mut ProblemFile| file.filtering = Filtering::WithoutNoise;
        let other = again(session, Change::Entries(&change))?;
        let processors = session.world.processors();
        let starts = wider(solution);
        let (found, simulations) =
            run.best_with(other.problem.simulator, Some(&starts), &processors)?;
        solution.effort.simulations_for_statistics += simulations;
        without = found.map(|best| best.fitness);
        if without.is_none() {
            let sentence = "Whether the data need the process noise is not known: the fit without it \
                            does not come to an end.";
            let finding = Finding::new(FindingKind::ProcessNoise, sentence.to_owned());
            solution.findings.push(finding);
        }
    }
    let change =
        |file: &mut ProblemFile| file.filtering = Filtering::Simulated(MoreTimes::default());
    let other = again(session, Change::Entries(&change))?;
    solution.effort.simulations_for_statistics += 1;
    let values: Vec<f64> = solution.parameters.iter().map(|own| own.value).collect();
    let simulated = simulated(&other.problem, &values)?;
    solution.judge_noise(&NoiseComparison { names, without, simulated });
    Ok(())
}

/// Predicts all outputs from earlier rows, and estimates the states from all data where `is_minimum`.
fn follow(
    session: &mut Session,
    solution: &mut Solution,
    is_minimum: bool,
    again: &mut Again<'_>,
) -> Result<(), Fault> {
    let values: Vec<f64> = solution.parameters.iter().map(|own| own.value).collect();
    let change =
        |file: &mut ProblemFile| file.filtering = Filtering::Smoothed(MoreTimes::default());
    let other = again(session, Change::Entries(&change))?;
    solution.effort.simulations_for_statistics += 1;
    let all = with_states(other.experiments, other.states, other.problem.series);
    let mut rest = &mut solution.series[..];
    for own in &all {
        let series;
        (series, rest) = rest.split_at_mut(own.experiment.deviations.min(rest.len()));
        match Estimation::of(own, &values) {
            Ok(found) => {
                found.predict(series);
                solution.inferred.states.extend(found.states().into_iter().filter(|_| is_minimum));
            }
            Err(fault) => {
                let sentence = format!("The states are not smoothed: {}.", fault.message);
                solution.findings.push(Finding::new(FindingKind::ProcessNoise, sentence));
            }
        }
    }
    let (experiments, series): (Vec<_>, Vec<_>) = other.validation.into_iter().unzip();
    let series = series.into_iter().flatten().collect();
    let mut rest = &mut solution.validation[..];
    for own in &with_states(experiments, other.validation_states, series) {
        let series;
        (series, rest) = rest.split_at_mut(own.experiment.deviations.min(rest.len()));
        // What cannot be simulated has been said.
        if let (true, Ok(found)) = (series.len() > 1, Estimation::of(own, &values)) {
            found.predict(series);
        }
    }
    solution.compare_validation_again();
    Ok(())
}

/// The begin of the names of estimated errors of measurement.
const SIGMA: &str = "sigma of ";

/// Starts at which the errors of measurement are larger: without process noise they have to explain what
/// it explained, and from far away a descent may end beside the minimum.
fn wider(solution: &Solution) -> Vec<Vec<f64>> {
    const FACTORS: [f64; 2] = [10.0, 100.0];
    let has_sigma = solution.parameters.iter().any(|own| own.name.starts_with(SIGMA));
    let start = |factor: &f64| {
        let value = |own: &SolvedParameter| match own.name.starts_with(SIGMA) {
            true => (own.value * factor).clamp(own.range[0], own.range[1]),
            false => own.value,
        };
        solution.parameters.iter().map(value).collect()
    };
    FACTORS.iter().filter(|_| has_sigma).map(start).collect()
}

/// The points of the measured series; `None` where the simulation fails.
fn simulated(problem: &Problem, values: &[f64]) -> Result<Option<Vec<Vec<f64>>>, Fault> {
    let count = problem.series.iter().map(|own| own.x.len()).sum();
    let mut row = vec![0.0; count];
    if (problem.simulator)()?.simulate(values, &mut row).is_err() {
        return Ok(None);
    }
    let mut rest = row.into_iter();
    let points = |own: &Series| {
        let points = rest.by_ref().take(own.x.len()).collect();
        own.is_data().then_some(points)
    };
    Ok(Some(problem.series.iter().filter_map(points).collect()))
}
