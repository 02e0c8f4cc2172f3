//! After a fit with process noise: one without it, a simulation that does not see the data, and the states
//! from all data.

use super::build::{FilteredExperiment, with_states};
use super::estimate::Estimation;
use super::file::{Filtering, MoreTimes, ProblemFile};
use super::noise;
use super::searches::{Again, Change};
use crate::Session;
use crate::diag::Fault;
use crate::fault;
use crate::identify::problem::{
    EndingKind, Finding, FindingKind, NoiseComparison, Problem, Run, Series, Solution,
    SolvedParameter, SolvedSeries,
};
use crate::registry::BAD_OPTION;
use std::collections::BTreeMap;

/// The entry with the number of samples over which is predicted.
pub(super) const PREDICTION_STEPS: &str = "prediction_steps";

/// What is asked about the process noise of a problem.
pub(super) struct Questions {
    /// The densities that are estimated.
    densities: Vec<String>,
    /// Over how many samples outputs are predicted as well.
    steps: Option<usize>,
}

impl Questions {
    /// Those of a problem; `None` without process noise.
    ///
    /// # Errors
    ///
    /// Predictions without process noise, or over no more than one sample.
    pub(super) fn of(file: &ProblemFile) -> Result<Option<Questions>, Fault> {
        let steps = file.prediction_steps;
        if file.noise.is_empty() {
            return match steps {
                None => Ok(None),
                Some(_) => {
                    Err(fault!(BAD_OPTION, "predictions over several samples need process noise")
                        .help("say on which states noise acts, in `[noise]`, or remove the entry"))
                }
            };
        }
        if let Some(steps) = steps.filter(|steps| *steps < 2) {
            return Err(fault!(BAD_OPTION, "predictions over {steps} samples are not possible")
                .help("write a number from 2; predictions over one sample are always shown"));
        }
        Ok(Some(Questions { densities: noise::estimated(file), steps }))
    }
}

/// Compares a fit with what its densities add, and says it.
///
/// # Errors
///
/// Those of the problem that is made again.
pub(super) fn compare(
    session: &mut Session,
    (run, solution): (&mut Run, &mut Solution),
    questions: &Questions,
    again: &mut Again<'_>,
) -> Result<(), Fault> {
    if session.world.is_interrupted() {
        return Ok(());
    }
    let is_minimum = solution.outcome.ending.kind == EndingKind::Minimum;
    follow(session, solution, (is_minimum, questions.steps), again)?;
    if !is_minimum {
        return Ok(());
    }
    let names = &questions.densities[..];
    let mut without = None;
    if !names.is_empty() {
        let change = |file: &mut ProblemFile| file.context.filtering = Filtering::WithoutNoise;
        let other = again(session, Change::Entries(&change))?;
        let processors = session.world.processors();
        let starts = wider(solution);
        let found = run.best_with(other.problem.simulator, Some(&starts), &processors)?;
        solution.effort.simulations_for_statistics += found.simulations;
        without = found.best.map(|best| best.fitness);
        if without.is_none() {
            let sentence = "Whether the data need the process noise is not known: the fit without it \
                            does not come to an end.";
            let finding = Finding::new(FindingKind::ProcessNoise, sentence.to_owned());
            solution.findings.push(finding);
        }
    }
    let change = |file: &mut ProblemFile| {
        file.context.filtering = Filtering::Simulated(MoreTimes::default())
    };
    let other = again(session, Change::Entries(&change))?;
    solution.effort.simulations_for_statistics += 1;
    let values: Vec<f64> = solution.parameters.iter().map(|own| own.value).collect();
    let simulated = simulated(&other.problem, &values)?;
    solution.judge_noise(&NoiseComparison { names, without, simulated });
    Ok(())
}

/// The filtered experiments of a problem, those of the validation after the others.
struct All {
    fitted: Vec<FilteredExperiment>,
    validation: Vec<FilteredExperiment>,
}

impl All {
    fn again(
        session: &mut Session,
        filtering: &Filtering,
        again: &mut Again<'_>,
    ) -> Result<All, Fault> {
        let change = |file: &mut ProblemFile| file.context.filtering = filtering.clone();
        let made = again(session, Change::Entries(&change))?;
        let fitted = with_states(made.experiments, made.states, made.problem.series);
        let (experiments, series): (Vec<_>, Vec<_>) = made.validation.into_iter().unzip();
        let series = series.into_iter().flatten().collect();
        let validation = with_states(experiments, made.validation_states, series);
        Ok(All { fitted, validation })
    }

    /// Each experiment with its series, and whether it was fitted. What cannot be simulated has no series,
    /// which has been said.
    fn with<'s>(
        &self,
        solution: &'s mut Solution,
    ) -> Vec<(bool, &FilteredExperiment, &'s mut [SolvedSeries])> {
        let mut all = Vec::new();
        let fitted = (true, &self.fitted, &mut solution.series[..]);
        let validation = (false, &self.validation, &mut solution.validation[..]);
        for (is_fitted, experiments, mut rest) in [fitted, validation] {
            for own in experiments {
                let series;
                (series, rest) = rest.split_at_mut(own.experiment.deviations.min(rest.len()));
                if !series.is_empty() {
                    all.push((is_fitted, own, series));
                }
            }
        }
        all
    }
}

/// Predicts all outputs from earlier rows; where `is_minimum`, estimates the states from all data and predicts
/// over so many samples.
fn follow(
    session: &mut Session,
    solution: &mut Solution,
    (is_minimum, steps): (bool, Option<usize>),
    again: &mut Again<'_>,
) -> Result<(), Fault> {
    let values: Vec<f64> = solution.parameters.iter().map(|own| own.value).collect();
    let all = All::again(session, &Filtering::Smoothed(MoreTimes::default()), again)?;
    solution.effort.simulations_for_statistics += 1;
    let (mut estimations, mut sentences) = (Vec::new(), Vec::new());
    let mut states = Vec::new();
    for (is_fitted, own, series) in all.with(solution) {
        match Estimation::of(own, &values) {
            Ok(found) => {
                found.predict(series);
                if is_fitted && is_minimum {
                    states.extend(found.states());
                }
                estimations.push(found);
            }
            Err(fault) if is_fitted => {
                sentences.push(format!("The states are not smoothed: {}.", fault.message));
            }
            Err(_) => {}
        }
    }
    solution.inferred.states.extend(states);
    if let Some(steps) = steps.filter(|_| is_minimum) {
        sentences.extend(predict_over(session, solution, (steps, &estimations), again)?);
    }
    let finding = |sentence| Finding::new(FindingKind::ProcessNoise, sentence);
    solution.findings.extend(sentences.into_iter().map(finding));
    solution.compare_validation_again();
    Ok(())
}

/// Predicts all outputs over so many samples; sentences on what is not possible.
fn predict_over(
    session: &mut Session,
    solution: &mut Solution,
    (steps, estimations): (usize, &[Estimation<'_>]),
    again: &mut Again<'_>,
) -> Result<Vec<String>, Fault> {
    let values: Vec<f64> = solution.parameters.iter().map(|own| own.value).collect();
    let (mut sentences, mut begins) = (Vec::new(), BTreeMap::new());
    for own in estimations {
        match own.ahead(steps) {
            Ok(ahead) => _ = begins.insert(own.experiment().to_owned(), ahead),
            Err(fault) => sentences.push(format!("{}: {}.", own.experiment(), fault.message)),
        }
    }
    let filtering = Filtering::Ahead(begins.clone(), MoreTimes::default());
    let runs = All::again(session, &filtering, again)?;
    solution.effort.simulations_for_statistics += steps as u64;
    for (_, run, series) in runs.with(solution) {
        let name = &run.experiment.name;
        let own = estimations.iter().find(|own| own.experiment() == name);
        let Some((own, ahead)) = own.zip(begins.get(name)) else { continue };
        if let Err(fault) = own.predict_over(ahead, (run, &values), series) {
            sentences
                .push(format!("{name} is not predicted over {steps} samples: {}.", fault.message));
        }
    }
    Ok(sentences)
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
