//! The solution: what was found, how well it fits, and what the data cannot tell.

use super::effects::{Effect, Finite, effect};
use super::ending::{self, Ending, EndingKind, OtherMinimum, SolvedDescent};
use super::statistics::distributions::chi_square_tails;
use super::{
    ErrorModel, FailureKind, FailureRegion, Finding, FindingKind, Form, Importance, Inferred,
    Profiles, Run, Severity, Sigma, Statistics, residual_test,
};
use crate::diag::Fault;
use crate::elementary;
use crate::fault;
use crate::ga::Generation;
use crate::ga::operators::KINDS;
use crate::identify::Uncertainty;
use crate::registry::BAD_OPTION;
use serde::{Deserialize, Serialize};

/// A parameter counts as identifiable when its standard error is below this fraction of its value:
/// the 95 % interval then excludes 0, and on a logarithmic scale spans less than a decade.
const RELATIVE: f64 = 0.5;
/// Or, on a linear scale, when its 95 % interval is below this fraction of the search range: a
/// parameter near 0 may be known well.
const OF_RANGE: f64 = 0.25;
/// Correlations above this are worth a word.
const STRONG: f64 = 0.95;
/// Values nearer to a bound than this fraction of the range are at it.
const AT_BOUND: f64 = 1e-3;
/// A bound is contradicted by the data where the fit would go beyond it by so many standard errors.
pub(super) const BEYOND: f64 = 2.0;

/// Points beside the best at which a lack of rank is looked at.
const ELSEWHERE: usize = 5;

/// The operators that were chosen, in the order of a generation.
fn chosen_operators(problem: &super::Problem) -> indexmap::IndexMap<String, String> {
    let chosen = problem.method.operators();
    let of = |kind: &'static str| chosen.iter().find(|(own, _)| *own == kind);
    let all = KINDS.iter().filter_map(|kind| of(kind.name));
    all.map(|(kind, label)| ((*kind).to_owned(), label.clone())).collect()
}

/// The solution of a problem.
#[derive(Debug, Clone, Default, Serialize, Deserialize)]
pub struct Solution {
    /// The heading.
    pub title: String,
    /// The model.
    pub model: String,
    /// The method.
    pub method: String,
    /// The operators that were chosen in place of the method's usual ones: kind, and name with
    /// settings.
    #[serde(default, skip_serializing_if = "indexmap::IndexMap::is_empty")]
    pub operators: indexmap::IndexMap<String, String>,
    /// The first objective: its name and the smallest value found.
    pub fitness_name: String,
    /// Its smallest value.
    pub fitness: f64,
    /// The parameters.
    pub parameters: Vec<SolvedParameter>,
    /// The series with their residuals.
    pub series: Vec<SolvedSeries>,
    /// Series that were not used for the fit.
    pub validation: Vec<SolvedSeries>,
    /// Correlations of the parameters, row by row; `None` where they could not be computed.
    pub correlations: Option<Vec<Vec<Option<f64>>>>,
    /// Condition number of the sensitivities.
    pub condition: Option<f64>,
    /// What must be known about these numbers, most important first.
    #[serde(default)]
    pub findings: Vec<Finding>,
    /// What was known of the errors of measurement.
    #[serde(default = "one_variance")]
    pub error_model: ErrorModel,
    /// The residuals against the given sigmas; `None` where not all are given.
    #[serde(default)]
    pub chi_square: Option<ChiSquare>,
    /// Negative logarithm of the likelihood of normal errors with the given or estimated standard
    /// deviations (maximum likelihood ones); `None` where the fitness is not one of normal errors.
    #[serde(default)]
    pub negative_log_likelihood: Option<f64>,
    /// Why the run ended.
    pub stop: String,
    /// Whether it ended at a minimum, and how that is known.
    #[serde(default)]
    pub ending: Ending,
    /// The descents by least squares, in their order.
    #[serde(default)]
    pub descents: Vec<SolvedDescent>,
    /// Minima beside the best whose sum of squares lies within the 95 % limit of the likelihood.
    #[serde(default)]
    pub other_minima: Vec<OtherMinimum>,
    /// Questions of the method.
    pub generations: u64,
    /// Individuals evaluated.
    pub evaluations: u64,
    /// Simulations that it took; equal genes are simulated once.
    pub simulations: u64,
    /// Further simulations for the statistics.
    pub simulations_for_statistics: u64,
    /// Failed individuals by kind.
    pub failures: indexmap::IndexMap<String, u64>,
    /// Failed individuals by cause.
    pub causes: indexmap::IndexMap<String, u64>,
    /// Where in the search space simulations failed, if that is a region.
    pub failure_region: Option<FailureRegion>,
    /// Settings changed during the run.
    pub changes: Vec<(u64, String, f64)>,
    /// How much each parameter matters, where that was asked before the fit.
    pub importance: Option<Importance>,
    /// Profiles of the parameters, where they were asked.
    pub profiles: Option<Profiles>,
    /// What was inferred beyond the estimates.
    #[serde(default)]
    pub inferred: Inferred,
    /// Points of the front, where there are several objectives: parameters and objectives.
    pub front: Vec<(Vec<f64>, Vec<f64>)>,
    /// The place in the front that is farthest from the line between its ends.
    pub knee: Option<usize>,
    /// The hypervolume of the front, and the reference point that it is measured from: a tenth of
    /// the front's width beyond its worst values.
    pub hypervolume: Option<(f64, Vec<f64>)>,
    /// Names of the objectives.
    pub objectives: Vec<String>,
    /// What the script has found whose search least squares have ended; `None` where the problem
    /// was solved without a script of its own.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub script: Option<super::ScriptResult>,
    /// The seed; `None` where no random numbers were drawn.
    pub seed: Option<[f64; 6]>,
    /// Version of the program.
    pub version: String,
    /// The problem as it was written; empty where it was put in Rust.
    pub problem: String,
    /// Every generation: best, mean, worst, failures.
    #[serde(skip)]
    pub history: Vec<Generation>,
    /// The best values after each generation.
    #[serde(skip)]
    pub trace: Vec<Vec<f64>>,
    /// Evenly chosen individuals.
    #[serde(skip)]
    pub individuals: Vec<(Vec<f64>, f64)>,
}

/// An identified parameter.
#[derive(Debug, Clone, Default, Serialize, Deserialize)]
pub struct SolvedParameter {
    /// Its name.
    pub name: String,
    /// Its unit.
    pub unit: String,
    /// Its value.
    pub value: f64,
    /// The range that was searched.
    pub range: [f64; 2],
    /// Whether its logarithm was searched.
    pub logarithmic: bool,
    /// One standard deviation; `None` where infinite or unknown.
    pub deviation: Option<f64>,
    /// The 95 % interval, not cut at the range.
    pub interval: Option<[f64; 2]>,
    /// Whether the data determine it; `None` where unknown.
    pub determined: Option<bool>,
    /// Whether it lies at an end of its range.
    pub at_bound: bool,
    /// Whether the interval is that of its profile, because the linear one does not hold.
    #[serde(default)]
    pub by_profile: bool,
    /// Whether finite changes have told what its derivative does not.
    #[serde(default)]
    pub in_steps: bool,
    /// What the data say about it; `None` where unknown.
    #[serde(default)]
    pub verdict: Option<Verdict>,
}

/// What the data say about a parameter.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Verdict {
    /// The data bound it.
    Identifiable,
    /// These data do not bound it; others of the kind may.
    PracticallyNonIdentifiable,
    /// No data of this kind bound it: it acts only in a combination with others.
    StructurallyNonIdentifiable,
    /// It changes nothing that was compared.
    WithoutEffect,
}

impl Verdict {
    /// In words.
    pub fn words(self) -> &'static str {
        match self {
            Verdict::Identifiable => "identifiable",
            Verdict::PracticallyNonIdentifiable => "practically non-identifiable from these data",
            Verdict::StructurallyNonIdentifiable => "structurally non-identifiable combination",
            Verdict::WithoutEffect => "without effect",
        }
    }
}

/// Weighted sum of squares where the standard deviations of the measurements are given.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct ChiSquare {
    /// The sum.
    pub value: f64,
    /// Points less parameters.
    pub freedom: f64,
    /// Probability of a larger sum by chance.
    pub probability: f64,
}

fn one_variance() -> ErrorModel {
    ErrorModel::OneVariance
}

/// A series with its simulation.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct SolvedSeries {
    /// The experiment.
    pub experiment: String,
    /// The variable and its unit.
    pub y: [String; 2],
    /// What it is given over, and the unit.
    pub x: [String; 2],
    /// Where the data come from.
    pub file: String,
    /// Root of the mean squared residual.
    #[serde(deserialize_with = "super::saved::number")]
    pub rmse: f64,
    /// Coefficient of determination.
    pub r_squared: Option<f64>,
    /// Standard deviation of the measurements, root mean square; `None` where it is not known.
    #[serde(default)]
    pub sigma: Option<f64>,
    /// Whether that was estimated with the parameters.
    #[serde(default)]
    pub sigma_estimated: bool,
    /// Runs of equal sign, how many are expected, the probability of that by chance, and the
    /// correlation of neighbours.
    pub residual_test: Option<[f64; 4]>,
    /// The simulated curve between the points, by ascending X, where it was simulated.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub curve: Vec<[f64; 2]>,
    /// X, measured, simulated.
    #[serde(deserialize_with = "super::saved::points")]
    pub points: Vec<[f64; 3]>,
}

impl SolvedSeries {
    /// Puts a series beside its simulation.
    pub fn new(series: &super::Series, simulated: &[f64]) -> SolvedSeries {
        let n = series.y.len() as f64;
        let points: Vec<[f64; 3]> =
            series.x.iter().zip(&series.y).zip(simulated).map(|((x, y), s)| [*x, *y, *s]).collect();
        let square: f64 = points.iter().map(|p| elementary::powi(p[1] - p[2], 2)).sum();
        let mean = series.y.iter().sum::<f64>() / n;
        let total: f64 = series.y.iter().map(|y| elementary::powi(y - mean, 2)).sum();
        let mut ordered = points.clone();
        ordered.sort_by(|a, b| a[0].total_cmp(&b[0]));
        let residuals: Vec<f64> = ordered.iter().map(|p| p[1] - p[2]).collect();
        let test = residual_test(&residuals);
        SolvedSeries {
            experiment: series.experiment.clone(),
            y: [series.y_name.clone(), series.y_unit.clone()],
            x: [series.x_name.clone(), series.x_unit.clone()],
            file: series.file.clone(),
            rmse: (square / n).sqrt(),
            r_squared: (total > 0.0).then(|| 1.0 - square / total),
            sigma: None,
            sigma_estimated: series.sigma.is_estimated(),
            residual_test: test
                .map(|t| [t.runs as f64, t.expected_runs, t.runs_probability, t.autocorrelation]),
            curve: Vec::new(),
            points,
        }
    }
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
        let Some(best) = &run.best else {
            if run.evaluations == 0 {
                return Err(fault!(
                    BAD_OPTION,
                    "the run ended ({stop}) before the first generation was simulated: there is \
                     no result";
                    help: "allow more time, or use fewer individuals per generation"
                ));
            }
            let most = run.causes.iter().max_by_key(|cause| cause.1);
            let why =
                most.map_or_else(String::new, |(cause, count)| format!("; {count} times: {cause}"));
            return Err(fault!(
                BAD_OPTION,
                "none of {} individuals could be simulated{why}", run.evaluations;
                help: "correct the model or the search ranges"
            ));
        };
        let simulated = run.evaluation.simulate(&best.values);
        let simulated = simulated.map_err(|failed| fault!(BAD_OPTION, "{}", failed.cause))?;
        let others = elsewhere(run);
        let mut statistics =
            Statistics::at(problem, &run.evaluation, &best.values, &simulated, &others);
        let effects = effects(run, &best.values, &simulated, &mut statistics)?;
        let series = solved_series(problem, &statistics, &simulated);
        let parameters = parameters(run, &best.values, &statistics, &effects);
        let ending = Ending::of(run, &best.values);
        let descents = ending::descents(run);
        let limit = super::conclusion::limit(&statistics);
        let other_minima = match ending.kind {
            EndingKind::Minimum => ending::other_minima(&descents, limit),
            _ => Vec::new(),
        };
        let kinds = FailureKind::ALL.iter().zip(&run.failed).filter(|(_, count)| **count > 0);
        let mut solution = Solution {
            title: problem.title.clone(),
            model: problem.model.clone(),
            method: format!(
                "{}{}",
                problem.method_name,
                if problem.polish
                    && problem.method.can_be_polished()
                    && run.evaluation.has_residuals()
                {
                    " + levenberg_marquardt"
                } else {
                    ""
                }
            ),
            operators: chosen_operators(problem),
            fitness_name: problem.objectives[0].0.clone(),
            fitness: best.fitness,
            correlations: correlations(&statistics, parameters.len()),
            condition: statistics.condition.filter(|condition| condition.is_finite()),
            parameters,
            series,
            validation,
            findings: Vec::new(),
            error_model: ErrorModel::of(problem),
            chi_square: chi_square(&statistics),
            negative_log_likelihood: negative_log_likelihood(run, &statistics),
            stop: stop.to_owned(),
            descents,
            other_minima,
            generations: run.generations(),
            evaluations: run.evaluations,
            simulations: run.simulations,
            simulations_for_statistics: statistics.simulations
                + run.conclusion.simulations
                + ending.simulations,
            ending,
            failures: kinds.map(|(kind, count)| (kind.name().to_owned(), *count)).collect(),
            causes: run.causes.clone(),
            failure_region: super::failure_region(&problem.parameters, &run.kept),
            changes: run.changed.clone(),
            importance: None,
            profiles: None,
            inferred: Inferred::default(),
            knee: knee(&run.front),
            hypervolume: front_volume(&run.front),
            front: run.front.clone(),
            objectives: problem.objectives.iter().map(|(name, _)| name.clone()).collect(),
            script: None,
            seed: Some(problem.seed),
            version: env!("CARGO_PKG_VERSION").to_owned(),
            problem: problem.text.clone(),
            history: run.history.generations.clone(),
            trace: run.trace.clone(),
            individuals: run.kept.clone(),
        };
        let own = super::notes::findings(&solution, run, &statistics, &effects, &simulated);
        solution.findings = own;
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
        solution.findings.extend(ending::about_other_minima(&solution));
        Ok(solution)
    }

    /// Takes standard errors and intervals away, and what was said of them. At the limit of a
    /// constraint they would be too small along it: the data may as well hold inside.
    fn drop_intervals(&mut self) {
        for parameter in &mut self.parameters {
            (parameter.deviation, parameter.interval) = (None, None);
            (parameter.determined, parameter.verdict) = (None, None);
        }
        (self.correlations, self.condition) = (None, None);
        self.findings.retain(|finding| !ending::is_about_intervals(finding.kind));
    }

    /// Takes away everything that holds at a minimum only, and says that this is none.
    fn drop_verdicts(&mut self) {
        self.drop_intervals();
        self.findings.retain(|finding| ending::holds_anywhere(finding.kind));
        let words = self.ending.words.clone();
        let finding = Finding::new(FindingKind::NotAMinimum, words).severity(Severity::Serious);
        self.findings.insert(0, finding);
    }

    /// Pairs of parameters that the data can hardly tell apart.
    pub fn strongly_correlated(&self) -> Vec<(usize, usize, f64)> {
        let Some(rows) = &self.correlations else { return Vec::new() };
        let n = self.parameters.len();
        let pairs = (0..n).flat_map(|k| (k + 1..n).map(move |l| (k, l)));
        pairs
            .filter_map(|(k, l)| Some((k, l, rows[k][l]?)))
            .filter(|(_, _, correlation)| correlation.abs() > STRONG)
            .collect()
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
            _ => interval_with(effects, free, k, value, reach(statistics, k), statistics.factor),
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
        return Some([statistics.factor * deviation; 2]);
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
    let group = statistics.inseparable.iter().find(|group| group.parameters.contains(&k));
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
            0.5 * elementary::ln(high / low).abs() * parameter.value.abs() / statistics.factor
        }
        Some([low, high]) => 0.5 * (high - low) / statistics.factor,
        _ => deviation,
    };
    Some(yes(is_narrow(parameter, deviation.max(spread), statistics.factor)))
}

/// Whether a standard error is small against the value, or on a linear scale against the range.
pub(super) fn is_narrow(parameter: &SolvedParameter, deviation: f64, factor: f64) -> bool {
    let [min, max] = parameter.range;
    let small = deviation <= RELATIVE * parameter.value.abs() && deviation <= max - min;
    small || !parameter.logarithmic && 2.0 * factor * deviation <= OF_RANGE * (max - min)
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
