//! The summary of a run: its solution, with the statistics at the best point.

use super::effects::{Effect, Finite, effect};
use super::ending::{self, Ending, EndingKind};
use super::solution::OF_RANGE;
use super::statistics::BEYOND;
use super::statistics::distributions::chi_square_tails;
use super::{
    Best, ChiSquare, ErrorModel, FailureKind, Form, Run, Sigma, Solution, SolvedParameter,
    SolvedSeries, Statistics, Verdict,
};
use crate::diag::Fault;
use crate::ga::operators::KINDS;
use crate::identify::Uncertainty;
use crate::registry::BAD_OPTION;
use crate::{elementary, fault};

/// Values nearer to a bound than this fraction of the range are at it.
const AT_BOUND: f64 = 1e-3;

/// Points beside the best at which a lack of rank is looked at.
const ELSEWHERE: usize = 5;

/// The operators that were chosen, in the order of a generation.
fn chosen_operators(problem: &super::Problem) -> indexmap::IndexMap<String, String> {
    let chosen = problem.method.operators();
    let of = |kind: &'static str| chosen.iter().find(|(own, _)| *own == kind);
    let all = KINDS.iter().filter_map(|kind| of(kind.name));
    all.map(|(kind, label)| ((*kind).to_owned(), label.clone())).collect()
}

impl Solution {
    /// Puts together what a run has found. `validation`: series that were not used, with their
    /// simulation at the best values.
    ///
    /// # Errors
    ///
    /// When nothing was simulated successfully.
    pub fn of(run: &Run, stop: &str, validation: Vec<SolvedSeries>) -> Result<Solution, Fault> {
        let problem = &run.problem;
        let best = best(run, stop)?;
        let simulated = run.evaluation.simulate(&best.values);
        let simulated = simulated.map_err(|failed| fault!(BAD_OPTION, "{}", failed.cause))?;
        let others = elsewhere(run);
        let mut statistics =
            Statistics::at(problem, &run.evaluation, &best.values, &simulated, &others);
        let effects = effects(run, &best.values, &simulated, &mut statistics)?;
        let mut solution = Solution {
            fitness: best.fitness,
            parameters: parameters(run, &best.values, &statistics, &effects),
            series: solved_series(problem, &statistics, &simulated),
            validation,
            condition: statistics.condition.filter(|condition| condition.is_finite()),
            chi_square: chi_square(&statistics),
            negative_log_likelihood: negative_log_likelihood(run, &statistics),
            ..searched(run, stop)
        };
        solution.correlations = correlations(&statistics, solution.parameters.len());
        solution.add_ending(run, best, &statistics);
        solution.findings =
            super::notes::findings(&solution, run, &statistics, &effects, &simulated);
        if super::limits::along(problem, &best.values).is_some() {
            solution.drop_intervals();
        }
        match solution.ending.kind {
            // Where a parameter acts in steps, intervals go over all of them.
            EndingKind::Minimum if effects.is_empty() => {
                solution.check_linear_intervals(run, &statistics)?;
            }
            EndingKind::Minimum => {}
            _ => solution.drop_verdicts(),
        }
        let others = super::notes::about_other_minima(&solution);
        solution.findings.extend(others);
        Ok(solution)
    }

    /// Adds how the run ended, and all simulations beside the search.
    fn add_ending(&mut self, run: &Run, best: &Best, statistics: &Statistics) {
        self.ending = Ending::of(run, &best.values);
        self.descents = ending::descents(run);
        if self.ending.kind == EndingKind::Minimum {
            let limit = statistics.limit_of_squares();
            self.other_minima = ending::other_minima(&self.descents, limit);
        }
        self.simulations_for_statistics =
            statistics.simulations + run.conclusion.simulations + self.ending.simulations;
    }
}

/// The best individual of a run.
///
/// # Errors
///
/// When nothing was simulated successfully.
fn best<'a>(run: &'a Run, stop: &str) -> Result<&'a Best, Fault> {
    if let Some(best) = &run.best {
        return Ok(best);
    }
    if run.evaluations == 0 {
        return Err(fault!(
            BAD_OPTION,
            "the run ended ({stop}) before the first generation was simulated: there is \
             no result";
            help: "allow more time, or use fewer individuals per generation"
        ));
    }
    let most = run.causes.iter().max_by_key(|cause| cause.1);
    let why = most.map_or_else(String::new, |(cause, count)| format!("; {count} times: {cause}"));
    Err(fault!(
        BAD_OPTION,
        "none of {} individuals could be simulated{why}", run.evaluations;
        help: "correct the model or the search ranges"
    ))
}

/// What is known of the problem and the search, without the best point.
fn searched(run: &Run, stop: &str) -> Solution {
    let problem = &run.problem;
    let kinds = FailureKind::ALL.iter().zip(&run.failed).filter(|(_, count)| **count > 0);
    Solution {
        title: problem.title.clone(),
        model: problem.model.clone(),
        method: method(run),
        operators: chosen_operators(problem),
        fitness_name: problem.objectives[0].0.clone(),
        error_model: ErrorModel::of(problem),
        stop: stop.to_owned(),
        generations: run.generations(),
        evaluations: run.evaluations,
        simulations: run.simulations,
        failures: kinds.map(|(kind, count)| (kind.name().to_owned(), *count)).collect(),
        causes: run.causes.clone(),
        failure_region: super::failure_region(&problem.parameters, &run.kept),
        changes: run.changed.clone(),
        knee: knee(&run.front),
        hypervolume: front_volume(&run.front),
        front: run.front.clone(),
        objectives: problem.objectives.iter().map(|(name, _)| name.clone()).collect(),
        seed: Some(problem.seed),
        version: env!("CARGO_PKG_VERSION").to_owned(),
        problem: problem.text.clone(),
        history: run.history.generations.clone(),
        trace: run.trace.clone(),
        individuals: run.kept.clone(),
        ..Solution::default()
    }
}

/// The method's name, with that of the least squares behind it.
fn method(run: &Run) -> String {
    let problem = &run.problem;
    let is_polished =
        problem.polish && problem.method.can_be_polished() && run.evaluation.has_residuals();
    match is_polished {
        true => format!("{} + levenberg_marquardt", problem.method_name),
        false => problem.method_name.clone(),
    }
}

/// Some individuals that were simulated successfully, from the whole run.
fn elsewhere(run: &Run) -> Vec<Vec<f64>> {
    let good: Vec<&Vec<f64>> = run
        .kept
        .iter()
        .filter(|(_, fitness)| !crate::ga::has_failed(*fitness))
        .map(|(values, _)| values)
        .collect();
    let every = good.len().div_ceil(ELSEWHERE).max(1);
    good.iter().step_by(every).map(|values| (*values).clone()).collect()
}

fn solved_series(
    problem: &super::Problem,
    statistics: &Statistics,
    simulated: &[f64],
) -> Vec<SolvedSeries> {
    let mut first = 0;
    let one = |measured: &super::Series| {
        let places = first..first + measured.x.len();
        first = places.end;
        let mut solved = SolvedSeries::new(measured, &simulated[places.clone()]);
        let square: f64 = statistics.weights[places]
            .iter()
            .map(|w| elementary::powi(measured.weight / w, 2))
            .sum();
        solved.sigma = (measured.sigma != Sigma::Unknown)
            .then(|| (square / measured.x.len() as f64).sqrt())
            .filter(|sigma| sigma.is_finite());
        solved
    };
    // Priors, the last, count as points, but they are not data.
    let solved = problem.series.iter().map(one);
    solved.filter(|series| series.experiment != super::inference::PRIOR).collect()
}

/// What the parameters do whose derivative is zero.
fn effects(
    run: &Run,
    values: &[f64],
    simulated: &[f64],
    statistics: &mut Statistics,
) -> Result<Vec<(usize, Effect)>, Fault> {
    let mut effects = Vec::new();
    for k in
        statistics.without_effect.iter().chain(&statistics.cancelling).copied().collect::<Vec<_>>()
    {
        let at = (values, simulated);
        let (found, simulations) = effect(&run.problem, &run.evaluation, statistics, at, k)?;
        statistics.simulations += simulations;
        effects.push((k, found));
    }
    Ok(effects)
}

fn chi_square(statistics: &Statistics) -> Option<ChiSquare> {
    if !statistics.believed {
        return None;
    }
    // Equal series count once.
    let pairs = statistics.residuals.iter().zip(&statistics.shares);
    let value: f64 = pairs.map(|(r, share)| share * r * r).sum();
    let freedom = statistics.freedom;
    let [_, probability] = chi_square_tails(value, freedom);
    (freedom > 0.0).then_some(ChiSquare { value, freedom, probability })
}

fn negative_log_likelihood(run: &Run, statistics: &Statistics) -> Option<f64> {
    run.evaluation.scales()?;
    if statistics.robust {
        return None;
    }
    let n = statistics.residuals.len() as f64;
    let square: f64 = statistics.residuals.iter().map(|r| r * r).sum();
    let of_weights: f64 = statistics.weights.iter().map(|w| elementary::ln(*w)).sum();
    let of_residuals = match ErrorModel::of(&run.problem) {
        ErrorModel::OneVariance => 0.5 * n * (elementary::ln(square / n) + 1.0),
        _ => 0.5 * square,
    };
    let value = of_residuals - of_weights + 0.5 * n * elementary::ln(std::f64::consts::TAU);
    value.is_finite().then_some(value)
}

fn parameters(
    run: &Run,
    values: &[f64],
    statistics: &Statistics,
    effects: &[(usize, Effect)],
) -> Vec<SolvedParameter> {
    let one = |(k, free): (usize, &super::Free)| {
        let value = values[k];
        let deviation = tabulated(statistics).map(|found| found.standard_deviations[k]);
        let own = effects.iter().find(|(place, _)| *place == k).map(|(_, effect)| effect);
        let interval = match own {
            Some(Effect::Finite(Finite { ends: [low, high], .. })) => {
                Some([low.unwrap_or(free.min), high.unwrap_or(free.max)])
            }
            _ => interval_with(effects, free, k, value, reach(statistics, k), statistics.quantile),
        };
        let place = free.fraction(value);
        let mut solved = SolvedParameter {
            name: free.name.clone(),
            unit: free.unit.clone(),
            value,
            range: [free.min, free.max],
            logarithmic: free.logarithmic,
            deviation: deviation.filter(|deviation| deviation.is_finite()),
            interval,
            determined: None,
            at_bound: place.min(1.0 - place) < AT_BOUND,
            by_profile: false,
            in_steps: matches!(own, Some(Effect::Finite(_))),
            verdict: None,
        };
        solved.verdict = verdict(&solved, k, statistics, own);
        solved.determined = solved.verdict.map(|verdict| verdict == Verdict::Identifiable);
        solved
    };
    run.problem.parameters.iter().enumerate().map(one).collect()
}

/// Standard errors and correlations as they are told: where parameters stand at ends of their
/// ranges, those of the others with these held.
fn tabulated(statistics: &Statistics) -> Option<&Uncertainty> {
    statistics.at_bounds.as_ref().map_or(statistics.uncertainty.as_ref(), |own| Some(&own.held))
}

/// How far the linear 95 % interval reaches below and above; `None` where it is not bounded, or the
/// data contradict the end at which the parameter stands.
fn reach(statistics: &Statistics, k: usize) -> Option<[f64; 2]> {
    let Some(at_bounds) = &statistics.at_bounds else {
        let deviation = statistics.uncertainty.as_ref()?.standard_deviations[k];
        return Some([statistics.quantile * deviation; 2]);
    };
    let end = at_bounds.ends.iter().find(|end| end.parameter == k);
    end.is_none_or(|end| end.pull <= BEYOND).then(|| at_bounds.reach[k])
}

/// The linear interval, over all values of other parameters that act without a derivative: what is
/// true of one step need not be of the next, which fits these data as well.
fn interval_with(
    effects: &[(usize, Effect)],
    free: &super::Free,
    k: usize,
    value: f64,
    reach: Option<[f64; 2]>,
    factor: f64,
) -> Option<[f64; 2]> {
    let mut hull = linear_interval(free, value, reach)?;
    for (_, effect) in effects {
        let Effect::Finite(finite) = effect else { continue };
        for fit in &finite.within {
            let half = factor * fit.left * fit.deviations[k];
            let [low, high] = linear_interval(free, fit.values[k], Some([half; 2]))?;
            hull = [hull[0].min(low), hull[1].max(high)];
        }
    }
    Some(hull)
}

/// The interval that reaches so far; where the logarithm is searched, it is one of ratios.
fn linear_interval(free: &super::Free, value: f64, reach: Option<[f64; 2]>) -> Option<[f64; 2]> {
    let [below, above] = reach?;
    let ends = match free.logarithmic {
        true => {
            let [a, b] = [-below, above].map(|reach| value * elementary::exp(reach / value));
            [a.min(b), a.max(b)]
        }
        false => [value - below, value + above],
    };
    // The truth is taken to lie in the range.
    let ends = ends.map(|end| if end.is_nan() { end } else { end.clamp(free.min, free.max) });
    let is_finite = below.is_finite() && above.is_finite();
    Some(ends).filter(|ends| is_finite && ends.iter().all(|end| end.is_finite()))
}

fn verdict(
    parameter: &SolvedParameter,
    k: usize,
    statistics: &Statistics,
    effect: Option<&Effect>,
) -> Option<Verdict> {
    let [min, max] = parameter.range;
    let yes = |yes: bool| match yes {
        true => Verdict::Identifiable,
        false => Verdict::PracticallyNonIdentifiable,
    };
    match effect {
        Some(Effect::None) => return Some(Verdict::WithoutEffect),
        Some(Effect::Finite(Finite { ends: [Some(low), Some(high)], .. })) => {
            return Some(yes(high - low <= 0.5 * (max - min)));
        }
        Some(Effect::Finite(_)) => return Some(Verdict::PracticallyNonIdentifiable),
        None => {}
    }
    let group = statistics.non_identifiable.iter().find(|group| group.parameters.contains(&k));
    if let Some(group) = group {
        return Some(match group.form {
            Form::Sum | Form::Product => Verdict::StructurallyNonIdentifiable,
            Form::Local => Verdict::PracticallyNonIdentifiable,
        });
    }
    statistics.uncertainty.as_ref()?;
    if statistics.at_bounds.as_ref().is_some_and(|own| own.ends.iter().any(|e| e.parameter == k)) {
        // One end of the interval is the bound, where that is not contradicted.
        let [low, high] = parameter.interval?;
        return Some(yes(high - low <= OF_RANGE * (max - min)));
    }
    let Some(deviation) = parameter.deviation else { return Some(yes(false)) };
    // The interval is wider than its standard error says where another parameter acts in steps.
    let spread = match parameter.interval {
        Some([low, high]) if parameter.logarithmic => {
            0.5 * elementary::ln(high / low).abs() * parameter.value.abs() / statistics.quantile
        }
        Some([low, high]) => 0.5 * (high - low) / statistics.quantile,
        _ => deviation,
    };
    Some(yes(parameter.is_narrow(deviation.max(spread), statistics.quantile)))
}

fn correlations(statistics: &Statistics, n: usize) -> Option<Vec<Vec<Option<f64>>>> {
    let found = tabulated(statistics)?;
    let entry = |k: usize, l: usize| Some(found.correlations[k * n + l]).filter(|c| c.is_finite());
    Some((0..n).map(|k| (0..n).map(|l| entry(k, l)).collect()).collect())
}

fn front_volume(front: &[(Vec<f64>, Vec<f64>)]) -> Option<(f64, Vec<f64>)> {
    let m = front.first()?.1.len();
    let column = |j: usize| front.iter().map(move |(_, objectives)| objectives[j]);
    let reference: Vec<f64> = (0..m)
        .map(|j| {
            let worst = column(j).fold(f64::NEG_INFINITY, f64::max);
            worst + 0.1 * (worst - column(j).fold(f64::INFINITY, f64::min))
        })
        .collect();
    let points: Vec<f64> = front.iter().flat_map(|(_, objectives)| objectives.clone()).collect();
    Some((crate::ga::hypervolume(&points, m, &reference), reference))
}

/// The member of a front of two objectives that is farthest from the line between its ends, both
/// objectives in units of the front's width.
fn knee(front: &[(Vec<f64>, Vec<f64>)]) -> Option<usize> {
    if front.len() < 3 || front[0].1.len() != 2 {
        return None;
    }
    let (first, last) = (&front[0].1, &front[front.len() - 1].1);
    let scaled = |point: &[f64], j: usize| (point[j] - first[j]) / (last[j] - first[j]);
    let below = |k: usize| scaled(&front[k].1, 1) - scaled(&front[k].1, 0);
    (0..front.len()).max_by(|a, b| below(*a).abs().total_cmp(&below(*b).abs()))
}
