//! The summary of a run: its solution, with the statistics at the best point.

use super::effects::{Effect, Finite, effect};
use super::ending::{self, Ending, EndingKind};
use super::explicit::Explicit;
use super::inference::errors_of_coefficients;
use super::solution::CurveKind;
use super::statistics::distributions::chi_square_tails;
use super::verdicts::Judged;
use super::{
    Best, ChiSquare, Course, Effort, ErrorModel, FailureKind, Finding, FindingKind, Likelihood,
    Outcome, Pareto, Provenance, Run, Severity, Sigma, Solution, SolvedParameter, SolvedSeries,
    Statistics, Subject,
};
use crate::diag::Fault;
use crate::fitness::{Law, twice_negative_log};
use crate::ga::Mrg32k3a;
use crate::ga::operators::KINDS;
use crate::ga::sampling::latin_hypercube;
use crate::registry::BAD_OPTION;
use crate::{elementary, fault};

/// Points beside the best at which a lack of rank is looked at.
const ELSEWHERE: usize = 5;
/// They differ from it by more than this part of a range: 1e-3 apart, a capacitance times a resistance
/// passed for their sum.
const FAR: f64 = 0.02;
/// The stream of random numbers of those that the search has not simulated.
const STREAM: u64 = 1_000_019;

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
        run.evaluation.show("standard errors");
        let others = elsewhere(run, &best.values)?;
        let mut statistics =
            Statistics::at(problem, &run.evaluation, &best.values, &simulated, &others);
        let effects = effects(run, &best.values, &simulated, &mut statistics)?;
        let mut solution = Solution {
            fitness: best.fitness,
            parameters: parameters(run, &best.values, &statistics, &effects),
            series: solved_series(problem, &statistics, &simulated),
            validation,
            condition: statistics.rank.condition.filter(|condition| condition.is_finite()),
            likelihood: Likelihood {
                error_model: ErrorModel::of(problem),
                degrees_of_freedom: Some(statistics.spread.freedom).filter(|own| own.is_finite()),
                quantile: Some(statistics.spread.quantile).filter(|own| own.is_finite()),
                chi_square: chi_square(problem, &statistics),
                negative_log_likelihood: negative_log_likelihood(run, &statistics),
                covariances: covariances(run, &statistics, &simulated),
            },
            ..searched(run, stop)
        };
        solution.correlations = correlations(&statistics, solution.parameters.len());
        solution.add_ending(run, best, &statistics);
        if run.evaluation.is_cancelled() {
            return Err(fault!(BAD_OPTION, "the statistics were stopped"));
        }
        let is_at_limit = super::limits::along(problem, &best.values).is_some();
        let is_minimum = solution.outcome.ending.kind == EndingKind::Minimum;
        let judged = match is_minimum && !is_at_limit {
            true => solution.judge(run, &statistics, &effects)?,
            false => vec![Judged::Nothing; solution.parameters.len()],
        };
        let about = (&statistics, &effects[..], &judged[..]);
        solution.findings = super::notes::findings(&solution, run, about, &simulated);
        solution.put_ranges_first();
        solution.doubt_columns();
        if is_at_limit {
            solution.drop_intervals();
        }
        if !is_minimum {
            solution.drop_verdicts();
        }
        let others = super::notes::about_other_minima(&solution);
        solution.findings.extend(others);
        Ok(solution)
    }

    /// What the search has found, without any statistics: values, and the simulation with them.
    ///
    /// # Errors
    ///
    /// When nothing was simulated successfully.
    pub fn of_search(
        run: &Run,
        stop: &str,
        validation: Vec<SolvedSeries>,
    ) -> Result<Solution, Fault> {
        let best = best(run, stop)?;
        let simulated = run.evaluation.simulate(&best.values);
        let simulated = simulated.map_err(|failed| fault!(BAD_OPTION, "{}", failed.cause))?;
        let parameter = |(free, value): (&super::Free, &f64)| SolvedParameter {
            name: free.name.clone(),
            unit: free.unit.clone(),
            value: *value,
            range: [free.min, free.max],
            logarithmic: free.logarithmic,
            ..SolvedParameter::default()
        };
        let mut rest = &simulated[..];
        let scaled = Explicit::without_columns(&run.evaluation, &best.values);
        let series = |(number, own): (usize, &super::Series)| {
            let (simulated, others) = rest.split_at(own.x.len());
            rest = others;
            own.is_data().then(|| {
                let mut solved = SolvedSeries::new(own, simulated);
                if run.problem.inference.logarithmic.contains(&number) {
                    solved.curve_kind = CurveKind::Logarithms;
                }
                if let Some(own) = &scaled {
                    [solved.scale, solved.offset] = own.solved(number, &[]);
                }
                solved
            })
        };
        let mut solution = Solution {
            fitness: best.fitness,
            parameters: run.problem.parameters.iter().zip(&best.values).map(parameter).collect(),
            series: run.problem.series.iter().enumerate().filter_map(series).collect(),
            validation,
            ..searched(run, stop)
        };
        solution.outcome.descents = ending::descents(run);
        solution.outcome.ending = Ending::unjudged("the statistics of the search are not made yet");
        Ok(solution)
    }

    /// Says that the statistics were not made, and why.
    pub fn without_statistics(mut self, why: &str) -> Solution {
        self.outcome.ending = Ending::unjudged(why);
        let words = self.outcome.ending.words.clone();
        let finding = Finding::new(FindingKind::NotAMinimum, words).severity(Severity::Serious);
        self.findings.insert(0, finding);
        self
    }

    /// Adds how the run ended, and all simulations beside the search.
    fn add_ending(&mut self, run: &Run, best: &Best, statistics: &Statistics) {
        let ending = Ending::of(run, &best.values);
        let is_at_end = self.parameters.iter().any(|own| own.at_bound);
        self.outcome.ending = if is_at_end { ending.within_ranges() } else { ending };
        self.outcome.descents = ending::descents(run);
        if self.outcome.ending.kind == EndingKind::Minimum {
            let limit = statistics.limit_of_squares();
            self.outcome.other_minima = ending::other_minima(&self.outcome.descents, limit);
            if ErrorModel::of(&run.problem).is_likelihood() {
                let n = statistics.residuals.len() as f64;
                let twice = |sum: f64| twice_negative_log(sum, n);
                for other in &mut self.outcome.other_minima {
                    let rise = twice(other.objective) - twice(statistics.searched);
                    other.objective = best.fitness + 0.5 * rise;
                }
            }
        }
        self.effort.simulations_for_statistics =
            statistics.simulations + run.conclusion.simulations + self.outcome.ending.simulations;
    }
}

/// The best individual of a run.
///
/// # Errors
///
/// When nothing was simulated successfully.
fn best<'a>(run: &'a Run, stop: &str) -> Result<&'a Best, Fault> {
    if let Some(best) = &run.observed.best {
        return Ok(best);
    }
    if run.evaluations() == 0 {
        return Err(fault!(
            BAD_OPTION,
            "the run ended ({stop}) before the first generation was simulated: there is \
             no result";
            help: "allow more time, or use fewer individuals per generation"
        ));
    }
    let most = run.observed.failures.causes.iter().max_by_key(|cause| cause.1);
    let why = most.map_or_else(String::new, |(cause, count)| format!("; {count} times: {cause}"));
    Err(fault!(
        BAD_OPTION,
        "none of {} individuals could be simulated{why}", run.evaluations();
        help: "correct the model, the search ranges or the data"
    ))
}

/// What is known of the problem and the search, without the best point.
fn searched(run: &Run, stop: &str) -> Solution {
    let problem = &run.problem;
    let kinds = FailureKind::ALL.iter().zip(&run.failed).filter(|(_, count)| **count > 0);
    let subject = Subject {
        title: problem.title.clone(),
        model: problem.model.clone(),
        method: method(run),
        operators: chosen_operators(problem),
        fitness_name: problem.objectives[0].0.clone(),
        descriptions: problem.descriptions.clone(),
    };
    let effort = Effort {
        generations: run.generations(),
        evaluations: run.evaluations(),
        simulations: run.simulations,
        simulations_for_statistics: 0,
        failures: kinds.map(|(kind, count)| (kind.name().to_owned(), *count)).collect(),
        causes: run.observed.failures.causes.clone(),
        failure_region: super::failure_region(&problem.parameters, &run.observed.kept),
        changes: run.changed.clone(),
    };
    let pareto = Pareto {
        knee: knee(&run.front),
        hypervolume: front_volume(&run.front),
        front: run.front.clone(),
        objectives: problem.objectives.iter().map(|(name, _)| name.clone()).collect(),
    };
    let provenance = Provenance {
        seed: Some(problem.seed),
        version: env!("CARGO_PKG_VERSION").to_owned(),
        problem: problem.text.clone(),
    };
    let likelihood = Likelihood { error_model: ErrorModel::of(problem), ..Likelihood::default() };
    Solution {
        subject,
        likelihood,
        outcome: Outcome { stop: stop.to_owned(), ..Outcome::default() },
        effort,
        pareto,
        provenance,
        course: Course::of(&run.observed),
        ..Solution::default()
    }
}

/// The method's name, followed by that of the least squares.
fn method(run: &Run) -> String {
    let problem = &run.problem;
    let is_polished =
        problem.polish && problem.method.can_be_polished() && run.evaluation.has_residuals();
    match is_polished {
        true => format!("{} + levenberg_marquardt", problem.method_name),
        false => problem.method_name.clone(),
    }
}

/// Points of the search far from the best; where there are too few, points of a Latin hypercube. Near
/// the best a product looks like a sum.
fn elsewhere(run: &Run, best: &[f64]) -> Result<Vec<Vec<f64>>, Fault> {
    let parameters = &run.problem.parameters;
    let is_far = |values: &[f64]| {
        let pairs = parameters.iter().zip(values.iter().zip(best));
        pairs.into_iter().any(|(free, (a, b))| (free.fraction(*a) - free.fraction(*b)).abs() > FAR)
    };
    let good: Vec<&Vec<f64>> = run
        .observed
        .kept
        .iter()
        .filter(|(values, fitness)| !crate::ga::has_failed(*fitness) && is_far(values))
        .map(|(values, _)| values)
        .collect();
    let every = good.len().div_ceil(ELSEWHERE).max(1);
    let mut found: Vec<Vec<f64>> =
        good.iter().step_by(every).map(|values| (*values).clone()).collect();
    if found.len() < ELSEWHERE {
        let mut rng = Mrg32k3a::new(&run.problem.seed)?.stream(STREAM);
        let more = latin_hypercube(parameters.len(), ELSEWHERE - found.len(), &mut rng);
        let value = |(free, u): (&super::Free, &f64)| free.value(*u);
        found.extend(more.rows().map(|row| parameters.iter().zip(row).map(value).collect()));
    }
    Ok(found)
}

fn solved_series(
    problem: &super::Problem,
    statistics: &Statistics,
    simulated: &[f64],
) -> Vec<SolvedSeries> {
    let mut first = 0;
    let errors = errors_of_coefficients(statistics);
    let one = |(number, measured): (usize, &super::Series)| -> Option<SolvedSeries> {
        let places = first..first + measured.x.len();
        first = places.end;
        let mut solved = SolvedSeries::new(measured, &simulated[places.clone()]);
        if problem.inference.logarithmic.contains(&number) {
            solved.curve_kind = CurveKind::Logarithms;
        }
        if let Some(own) = &statistics.explicit {
            [solved.scale, solved.offset] = own.solved(number, &errors);
        }
        // The weights are roots of the information, which the tails of Student's density lessen.
        let scale = |(point, w): (usize, &f64)| match measured.law_of(point) {
            law @ Law::Student(_) => measured.weight / w * law.root_information(0.0),
            _ => measured.weight / w,
        };
        let deviations = || statistics.weights[places.clone()].iter().enumerate().map(scale);
        let valued =
            || deviations().enumerate().filter(|(at, _)| !measured.law_of(*at).is_censored());
        let square: f64 = valued().map(|(_, sigma)| elementary::powi(sigma, 2)).sum();
        if solved.sigma_computed {
            solved.deviations = deviations().collect();
        }
        // The deviation of a count is that of its expectation.
        solved.sigma = (measured.sigma != Sigma::Unknown && measured.law != Law::Poisson)
            .then(|| (square / valued().count() as f64).sqrt())
            .filter(|sigma| sigma.is_finite());
        // Priors and deviations have points, but they are not data.
        measured.is_data().then_some(solved)
    };
    problem.series.iter().enumerate().filter_map(one).collect()
}

/// What the parameters do whose derivative is zero.
fn effects(
    run: &Run,
    values: &[f64],
    simulated: &[f64],
    statistics: &mut Statistics,
) -> Result<Vec<(usize, Effect)>, Fault> {
    let mut effects = Vec::new();
    for k in statistics
        .rank
        .without_effect
        .iter()
        .chain(&statistics.cancelling)
        .copied()
        .collect::<Vec<_>>()
    {
        let at = (values, simulated);
        let (found, simulations) = effect(&run.problem, &run.evaluation, statistics, at, k)?;
        statistics.simulations += simulations;
        effects.push((k, found));
    }
    let count = effects.iter().filter(|(_, effect)| *effect == Effect::None).count();
    statistics.release(&run.problem, &run.evaluation, (values, simulated), count);
    Ok(effects)
}

fn chi_square(problem: &super::Problem, statistics: &Statistics) -> Option<ChiSquare> {
    // Deviations that follow the parameters are fitted to the residuals.
    let is_given = |own: &super::Series| {
        own.is_normal() && own.sigma.is_known() && !matches!(own.sigma, Sigma::Variable(_))
    };
    if !statistics.spread.believed || !problem.series.iter().all(is_given) {
        return None;
    }
    let value = statistics.chi_square(problem, &[]);
    let freedom = statistics.spread.freedom;
    let [_, probability] = chi_square_tails(value, freedom);
    (freedom > 0.0).then_some(ChiSquare { value, freedom, probability })
}

/// The covariances of outputs with correlated errors.
fn covariances(
    run: &Run,
    statistics: &Statistics,
    simulated: &[f64],
) -> Vec<super::SolvedCovariance> {
    let correlations = run.evaluation.correlations(&run.problem, simulated);
    super::joint::solved(&run.problem.series, &statistics.weights, &correlations)
}

fn negative_log_likelihood(run: &Run, statistics: &Statistics) -> Option<f64> {
    run.evaluation.scales()?;
    if statistics.spread.robust {
        return None;
    }
    if ErrorModel::of(&run.problem).is_likelihood() {
        let value = run.observed.best.as_ref()?.fitness + super::inference::beside(&run.problem);
        return Some(value).filter(|value| value.is_finite());
    }
    let n = statistics.residuals.len() as f64;
    let square: f64 = statistics.residuals.iter().map(|r| r * r).sum();
    let of_weights: f64 = statistics.weights.iter().map(|w| elementary::ln(*w)).sum();
    let of_residuals = match ErrorModel::of(&run.problem) {
        ErrorModel::OneVariance => 0.5 * n * (elementary::ln(square / n) + 1.0),
        _ => 0.5 * square,
    };
    let value = of_residuals - of_weights
        + 0.5 * n * elementary::ln(std::f64::consts::TAU)
        + super::inference::beside(&run.problem);
    value.is_finite().then_some(value)
}

/// The parameters with their standard errors; what the data tell of them is judged later.
fn parameters(
    run: &Run,
    values: &[f64],
    statistics: &Statistics,
    effects: &[(usize, Effect)],
) -> Vec<SolvedParameter> {
    let one = |(k, free): (usize, &super::Free)| {
        let deviation = statistics.tabulated().map(|found| found.standard_deviations[k]);
        let own = effects.iter().find(|(place, _)| *place == k).map(|(_, effect)| effect);
        SolvedParameter {
            name: free.name.clone(),
            unit: free.unit.clone(),
            value: values[k],
            range: [free.min, free.max],
            logarithmic: free.logarithmic,
            deviation: deviation.filter(|deviation| deviation.is_finite()),
            at_bound: statistics.inward[k].is_some(),
            in_steps: matches!(own, Some(Effect::Finite(Finite { .. }))),
            ..SolvedParameter::default()
        }
    };
    run.problem.parameters.iter().enumerate().map(one).collect()
}

fn correlations(statistics: &Statistics, n: usize) -> Option<Vec<Vec<Option<f64>>>> {
    let found = statistics.tabulated()?;
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
