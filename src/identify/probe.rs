//! The end of a script's run: its experiments as a [`Problem`], least squares from its best
//! individual, and the [`Solution`] that this gives.
//!
//! A genetic algorithm ends somewhere near a minimum, and near it neither standard errors nor
//! identifiability mean anything: both are properties of the minimum. So a few dozen simulations
//! go there. The script's own values stay what they are and stand beside those of the minimum.

use super::fitness::FITNESSES;
use super::problem::inference::ModelPredictions;
use super::problem::{
    Course, Effort, EndingKind, Experiment, Finding, FindingKind, Free, Inference, ModelSimulator,
    Observation, Problem, Provenance, Run, ScriptError, ScriptResult, Series, Severity, Sigma,
    Simulate, Solution, SolvedParameter, SolvedSeries, Stop, Subject, conclude, draw_curves,
    failure_region,
};
use super::ranks::Processors;
use super::script_search::{ScriptBest, ScriptSearch};
use super::study::Compared;
use super::table::significant;
use super::{Model, Objective, Parameter};
use crate::Descriptions;
use crate::diag::Fault;
use crate::fault;
use crate::ga::optimizer::METHODS;
use crate::registry::{self, BAD_OPTION, Options};
use std::sync::Arc;

/// Simulations of the probe, for each parameter: from the script's best individual the shipped
/// problems need up to 40 for each.
const BUDGET: u64 = 200;
/// Relative reduction of the sum of squares that is worth a number.
const BETTER: f64 = 1e-6;
/// Ranges that the script does not name are widened so often at most, by this factor each time.
const WIDER: usize = 8;
/// So often at most for intervals that they end: what the data determine to an order of magnitude lies
/// within four orders of the individuals.
const WIDER_FOR_INTERVALS: usize = 4;
const WIDENING: f64 = 10.0;
/// A positive range that is wider than this ratio is widened beyond zero.
const DECADES: f64 = 1e4;
/// A seed for scripts that draw no random numbers: least squares need none, but a run has one.
const NO_SEED: [f64; 6] = [12345.0; 6];

/// What ends an identification by a script, from its best individual.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Probe {
    /// Nothing: what the script has found is reported as it is.
    Off,
    /// Least squares, standard errors, verdicts and prediction bands.
    #[default]
    LeastSquares,
    /// These and profile likelihoods.
    Profiles,
}

/// What is known of the experiments when a run ends.
pub struct Ending<'a> {
    /// Which of the searches of the script it is, and how many there are.
    pub number: [usize; 2],
    /// What was observed of the search.
    pub search: &'a ScriptSearch,
    /// The model of each series of the best individual, in their order; `None` where it is no
    /// longer at hand.
    pub models: Vec<Option<Arc<dyn Model>>>,
    /// Relative error of the simulated values.
    pub noise: f64,
    /// What simulates.
    pub processors: Processors,
    /// What is requested after the script's search.
    pub probe: Probe,
    /// Whether the user interrupted the run.
    pub interrupted: bool,
    /// Whether this search had ended before the script was interrupted or failed.
    pub is_over: bool,
    /// The first error of the script that it did not handle: where, and what.
    pub error: Option<ScriptError>,
}

impl Ending<'_> {
    /// The solution; `None` when no individual was simulated successfully.
    pub fn solution(&self) -> Option<Solution> {
        let best = self.search.best()?;
        let solution = match self.reached(best) {
            Ok(solution) => solution,
            Err(why) => self.unprobed(best, &why),
        };
        Some(self.with_search(best, solution))
    }

    /// Least squares from the best individual. Where the script names no ranges, those that its
    /// individuals span bound nothing: they are widened until neither the minimum lies at their ends
    /// nor an interval ends there, and where that does not help the minimum, there is none.
    fn reached(&self, best: ScriptBest<'_>) -> Result<Solution, String> {
        let named = self.search.ranges.is_some();
        let mut ranges = self.ranges(best);
        let limits = self.limits(best);
        let mut simulations = 0;
        for ((range, value), limits) in ranges.iter_mut().zip(best.genome).zip(&limits) {
            if range[0] == range[1] && !named {
                widen(range, *value, *limits);
            }
        }
        for round in 0..WIDER {
            let problem = self.problem(best, &ranges)?;
            let mut solution = self.probed(best, problem)?;
            simulations += solution.script.as_ref().map_or(0, |script| script.probe_simulations);
            let for_intervals = round < WIDER_FOR_INTERVALS;
            let mut widened = false;
            for (k, (range, limits)) in ranges.iter_mut().zip(&limits).enumerate() {
                let value = solution.parameters[k].value;
                for side in ended_sides(&solution.parameters, k, for_intervals) {
                    widened |= !named && widen_side(range, side, value, *limits);
                }
            }
            if !widened {
                if let Some(script) = &mut solution.script {
                    script.probe_simulations = simulations;
                }
                return Ok(solution);
            }
        }
        Err(format!(
            "it leads beyond {WIDER} times the range of the script's individuals; give search \
             ranges"
        ))
    }

    /// The problem of least squares; `Err` says why there is none.
    fn problem(
        &self,
        best: ScriptBest<'_>,
        ranges: &[[f64; 2]],
    ) -> Result<(Problem, Vec<Experiment>), String> {
        if self.interrupted {
            return Err("the run was interrupted".to_owned());
        }
        if self.probe == Probe::Off {
            return Err("it was turned off".to_owned());
        }
        let Some(weights) = best.objective.weights(best.compared.len()) else {
            return Err("the script minimizes its own function, not a sum of squares".into());
        };
        let models: Option<Vec<Arc<dyn Model>>> = self.models.iter().cloned().collect();
        let models = models.ok_or("a model of the best individual is no longer loaded")?;
        let used =
            || best.compared.iter().zip(&weights).zip(&models).filter(|((_, w), _)| **w > 0.0);
        let series: Option<Vec<Series>> = used()
            .enumerate()
            .map(|(k, ((compared, weight), _))| series(compared, weight.sqrt(), name(best, k)))
            .collect();
        let series = series.ok_or("the measured values are unknown")?;
        let experiments: Vec<Experiment> = used()
            .enumerate()
            .map(|(k, ((compared, _), model))| experiment(compared, model, name(best, k)))
            .collect();
        let problem = self.assembled(best, series, (&experiments, ranges));
        Ok((problem.map_err(|fault| fault.message)?, experiments))
    }

    fn assembled(
        &self,
        best: ScriptBest<'_>,
        series: Vec<Series>,
        (experiments, ranges): (&[Experiment], &[[f64; 2]]),
    ) -> Result<Problem, Fault> {
        let experiments = experiments.to_vec();
        let fitness = registry::find("fitness function", FITNESSES, "sum_of_squares")?;
        let method = registry::find("method", METHODS, "levenberg_marquardt")?;
        let parameters = self.parameters(best, ranges)?;
        Ok(Problem {
            title: self.title(best),
            model: models(best),
            text: String::new(),
            descriptions: self.descriptions(best),
            stop: Stop { evaluations: Some(BUDGET * parameters.len() as u64), ..Stop::default() },
            parameters,
            series,
            objectives: vec![(fitness.name.to_owned(), (fitness.make)(&mut Options::default())?)],
            method_name: method.name.to_owned(),
            method: (method.make)(&mut Options::default())?,
            polish: false,
            seed: self.search.seed.unwrap_or(NO_SEED),
            noise: self.noise,
            inference: Inference {
                predict: Some(Box::new(ModelPredictions {
                    experiments: experiments.clone(),
                    proposed: Vec::new(),
                })),
                bands: true,
                ..Inference::default()
            },
            simulator: Box::new(move || {
                Ok(Box::new(ModelSimulator::new(&experiments)?) as Box<dyn Simulate>)
            }),
        })
    }

    fn title(&self, best: ScriptBest<'_>) -> String {
        let number = match self.number {
            [_, 1] => String::new(),
            [number, all] => format!(", search {number} of {all}"),
        };
        format!("Identified parameters of {}{number}", models(best))
    }

    /// What the models describe the parameters, X and Y as.
    fn descriptions(&self, best: ScriptBest<'_>) -> Descriptions {
        let mut descriptions = Descriptions::default();
        for (compared, model) in best.compared.iter().zip(&self.models) {
            let Some(model) = model else { continue };
            let study = &compared.study;
            let quantities = study.parameters.iter().chain([&study.x, &study.y]);
            descriptions.add(model.as_ref(), quantities.map(|quantity| quantity.name.as_str()));
        }
        descriptions
    }

    /// The parameters with these ranges.
    fn parameters(&self, best: ScriptBest<'_>, ranges: &[[f64; 2]]) -> Result<Vec<Free>, Fault> {
        let quantities = &best.compared[0].study.parameters;
        if best.compared.iter().any(|compared| compared.study.parameters != *quantities) {
            return Err(fault!(BAD_OPTION, "its experiments have different parameters"));
        }
        let one = |(k, quantity): (usize, &super::Quantity)| {
            let value = best.genome[k];
            Free::new(&quantity.name, &quantity.unit, ranges[k], None, Some(value))
        };
        quantities.iter().enumerate().map(one).collect()
    }

    /// The ranges of the script, or those that its individuals span.
    fn ranges(&self, best: ScriptBest<'_>) -> Vec<[f64; 2]> {
        let genes = best.genome.iter().enumerate();
        genes.map(|(k, value)| self.range(k, *value)).collect()
    }

    /// What the models allow for each parameter.
    fn limits(&self, best: ScriptBest<'_>) -> Vec<[f64; 2]> {
        let quantities = best.compared[0].study.parameters.iter();
        let all: Vec<Parameter> =
            self.models.iter().flatten().flat_map(|model| model.parameters()).collect();
        let limits = |quantity: &super::Quantity| {
            let own = all.iter().filter(|known| known.name == quantity.name);
            own.fold([f64::NEG_INFINITY, f64::INFINITY], |[low, high], known| {
                [low.max(known.min), high.min(known.max)]
            })
        };
        quantities.map(limits).collect()
    }

    /// The range of a parameter, wide enough for its value.
    fn range(&self, k: usize, value: f64) -> [f64; 2] {
        let ranges = self.search.ranges.as_ref().or(self.search.spanned.as_ref());
        let known = ranges.and_then(|(low, high)| Some([*low.get(k)?, *high.get(k)?]));
        let [low, high] = known.unwrap_or([value, value]);
        [low.min(value), high.max(value)]
    }

    /// Least squares from the best individual, with everything that follows from its minimum.
    fn probed(
        &self,
        best: ScriptBest<'_>,
        (problem, experiments): (Problem, Vec<Experiment>),
    ) -> Result<Solution, String> {
        let before = best.sum_of_squares().ok_or("the measured values are unknown")?;
        let mut run = Run::on(problem, &self.processors).map_err(|fault| fault.message)?;
        let stop = loop {
            if let Some(stop) = run.stop() {
                break stop;
            }
            if run.step(0.0).is_none() {
                return Err("it was cancelled".to_owned());
            }
        };
        conclude(&mut run);
        let solution = self.inferred(&mut run, &stop).map_err(|fault| fault.message)?;
        let at_minimum = solution.outcome.ending.kind == EndingKind::Minimum;
        let mut solution = if at_minimum { solution } else { without_verdicts(solution) };
        let generations = self.search.observed.history.generations.len();
        let evolves = generations > 1 && self.search.evolves;
        let who = if evolves { "The genetic algorithm" } else { "The script" };
        draw_curves(&experiments, &mut solution, &[], None);
        let last = self.search.observed.history.generations.last().map(|last| last.best);
        let last = last.filter(|last| evolves && *last > best.fitness);
        let probe = sentence((who, best, before), last, &solution, at_minimum);
        solution.effort.simulations_for_statistics += run.simulations;
        solution.script = Some(ScriptResult {
            probed: true,
            probe,
            probe_simulations: run.simulations,
            ..ScriptResult::default()
        });
        Ok(solution)
    }

    /// What the run has found, and what follows from it at a minimum.
    fn inferred(&self, run: &mut Run, stop: &str) -> Result<Solution, Fault> {
        let mut solution = Solution::settled(run, |run| Solution::of(run, stop, Vec::new()))?;
        if solution.outcome.ending.kind != EndingKind::Minimum {
            return Ok(solution);
        }
        if self.probe == Probe::Profiles {
            solution = solution.with_profiles(run, |run| Solution::of(run, stop, Vec::new()))?;
        }
        solution.add_inference(run)?;
        Ok(solution)
    }

    /// The script's best individual alone; why there was no probe.
    fn unprobed(&self, best: ScriptBest<'_>, why: &str) -> Solution {
        let parameter = |(k, quantity): (usize, &super::Quantity)| SolvedParameter {
            name: quantity.name.clone(),
            unit: quantity.unit.clone(),
            value: best.genome[k],
            range: self.range(k, best.genome[k]),
            ..SolvedParameter::default()
        };
        let quantities = best.compared[0].study.parameters.iter().enumerate();
        let solved = |(k, compared): (usize, &Compared)| {
            let unknown = || vec![f64::NAN; compared.x.len()];
            let y = compared.measured.clone().unwrap_or_else(unknown);
            let compared = Compared { measured: Some(y), ..compared.clone() };
            series(&compared, 1.0, name(best, k))
                .map(|series| SolvedSeries::new(&series, &compared.simulated))
        };
        let probe = format!(
            "No least squares after the script's search: {why}. It is therefore unknown whether \
             this is a minimum, and there are no standard errors and no statements on \
             identifiability."
        );
        Solution {
            subject: Subject {
                title: self.title(best),
                model: models(best),
                descriptions: self.descriptions(best),
                ..Subject::default()
            },
            fitness: best.fitness,
            parameters: quantities.map(parameter).collect(),
            series: best.compared.iter().enumerate().filter_map(solved).collect(),
            provenance: Provenance {
                version: env!("CARGO_PKG_VERSION").to_owned(),
                ..Provenance::default()
            },
            script: Some(ScriptResult { probe, ..ScriptResult::default() }),
            ..Solution::default()
        }
    }

    /// Adds what the script's search was.
    fn with_search(&self, best: ScriptBest<'_>, mut solution: Solution) -> Solution {
        let record = self.search;
        let names = best.compared[0].study.parameters.iter().map(|quantity| quantity.name.clone());
        let script = solution.script.get_or_insert_default();
        script.parameters = names.zip(best.genome.iter().copied()).collect();
        script.fitness = best.fitness;
        script.fitness_name = best.objective.name().to_owned();
        script.interrupted = self.interrupted && !self.is_over;
        script.error = self.error.clone().filter(|_| !self.is_over);
        script.changes.clone_from(&record.changes);
        if script.probed {
            solution.series.iter_mut().for_each(|own| own.script = simulated(best, own));
        }
        let mut findings: Vec<Finding> = script.error.iter().map(ScriptError::finding).collect();
        findings.push(search(script.probe.clone()));
        if record.ranges.is_none() {
            findings.push(search(
                "The ranges in the table are those of the script's individuals, extended where \
                 the minimum or an interval lies outside.",
            ));
        }
        let method = if script.probed { "script, then least squares" } else { "script" };
        let stop = match &script.error {
            Some(error) => error.place(),
            None if self.is_over && (self.interrupted || self.error.is_some()) => {
                "the search has ended; the script was stopped during a later one".to_owned()
            }
            None if self.interrupted => {
                "interrupted: these are the best values found so far".to_owned()
            }
            None => "the script has ended".to_owned(),
        };
        findings.append(&mut solution.findings);
        if !script.probed {
            solution.subject.fitness_name = best.objective.name().to_owned();
        }
        let failed = [("simulation".to_owned(), record.observed.failures.count)];
        let free = self.parameters(best, &self.ranges(best));
        solution.findings = findings;
        solution.subject.method = method.to_owned();
        solution.outcome.stop = stop;
        solution.effort = Effort {
            generations: record.observed.history.generations.len() as u64,
            evaluations: record.evaluations,
            simulations: record.evaluations,
            failures: failed.into_iter().filter(|(_, count)| *count > 0).collect(),
            causes: record.observed.failures.causes.clone(),
            failure_region: free.ok().and_then(|free| failure_region(&free, &record.observed.kept)),
            ..solution.effort
        };
        solution.pareto.objectives = vec![best.objective.name().to_owned()];
        solution.provenance.seed = record.seed;
        solution.course = Course::of(&record.observed);
        solution
    }
}

/// The sides on which the range of a parameter ends what is said of the parameters: 0 below, 1 above.
fn ended_sides(
    all: &[SolvedParameter],
    k: usize,
    for_intervals: bool,
) -> impl Iterator<Item = usize> {
    let own = &all[k];
    let [low, high] = own.range;
    let stands = [own.value - low <= high - own.value, own.value - low > high - own.value];
    let ends_another = |side: usize| {
        let held = all.iter().flat_map(|other| other.held.iter().flatten());
        let mut held = held.filter(|held| held.parameter == own.name);
        held.any(|held| (held.end - low > high - held.end) == (side == 1))
    };
    let ends = |side: usize| {
        own.at_bound && stands[side] || for_intervals && (own.open[side] || ends_another(side))
    };
    [ends(0), ends(1)].into_iter().enumerate().filter(|(_, ends)| *ends).map(|(side, _)| side)
}

/// Widens a range at the end that a value stands at, as far as the model allows; whether it could.
fn widen(range: &mut [f64; 2], value: f64, limits: [f64; 2]) -> bool {
    let [low, high] = *range;
    let side = if high - value > value - low { 0 } else { 1 };
    widen_side(range, side, value, limits)
}

/// Widens a range below (0) or above (1), as far as the model allows; whether it could.
fn widen_side([low, high]: &mut [f64; 2], side: usize, value: f64, limits: [f64; 2]) -> bool {
    let before = [*low, *high];
    let width = match *high - *low {
        0.0 => value.abs().max(f64::MIN_POSITIVE.sqrt()),
        width => width,
    };
    if side == 0 {
        // Of a positive parameter the ratio counts, as long as it has not lost its meaning.
        let wider = match *low > *high / DECADES {
            true if *low > 0.0 => *low / WIDENING,
            _ => *low - WIDENING * width,
        };
        *low = wider.max(limits[0]);
    } else {
        *high = (*high + WIDENING * width).min(limits[1]);
    }
    before != [*low, *high]
}

/// A finding about the search, which comes first.
fn search(sentence: impl Into<String>) -> Finding {
    Finding::new(FindingKind::Search, sentence).severity(Severity::Information)
}

/// The models of a best individual, each once.
fn models(best: ScriptBest<'_>) -> String {
    let mut names: Vec<&str> =
        best.compared.iter().map(|compared| compared.study.model.as_str()).collect();
    names.dedup();
    names.join(", ")
}

/// What an experiment is called: nothing where it is the only one.
fn name(best: ScriptBest<'_>, k: usize) -> String {
    match best.compared.len() {
        1 => String::new(),
        _ => format!("experiment {}", k + 1),
    }
}

/// X and Y of the best individual, for the series of a solution.
fn simulated(best: ScriptBest<'_>, own: &SolvedSeries) -> Vec<[f64; 2]> {
    let is_own = |(k, compared): &(usize, &Compared)| {
        name(best, *k) == own.experiment && compared.study.y.name == own.y[0]
    };
    let Some((_, found)) = best.compared.iter().enumerate().find(is_own) else {
        return Vec::new();
    };
    found.x.iter().zip(&found.simulated).map(|(x, y)| [*x, *y]).collect()
}

fn series(compared: &Compared, weight: f64, experiment: String) -> Option<Series> {
    let study = &compared.study;
    Some(Series {
        experiment,
        y_name: study.y.name.clone(),
        y_unit: study.y.unit.clone(),
        x_name: study.x.name.clone(),
        x_unit: study.x.unit.clone(),
        file: compared.file.clone(),
        x: compared.x.clone(),
        y: compared.measured.clone()?,
        weight,
        role: Default::default(),
        relative: Vec::new(),
        sigma: Sigma::Unknown,
        law: crate::fitness::Law::Normal,
        censored: Vec::new(),
        column: study.y.name.clone(),
        x_column: String::new(),
        rows: Vec::new(),
        missing: Vec::new(),
        scaling: Default::default(),
        joint: None,
    })
}

fn experiment(compared: &Compared, model: &Arc<dyn Model>, name: String) -> Experiment {
    let study = &compared.study;
    let parameters = study.parameters.iter().map(|quantity| quantity.name.clone());
    Experiment {
        deviations: 0,
        second_attempt: true,
        name,
        settings: model.settings(),
        model: Arc::clone(model),
        x_name: study.x.name.clone(),
        observations: vec![Observation { y_name: study.y.name.clone(), x: compared.x.clone() }],
        parameters: parameters.enumerate().collect(),
    }
}

/// What least squares have made of the script's best individual; `last`: the best of the last
/// generation, where that is worse.
fn sentence(
    (who, best, before): (&str, ScriptBest<'_>, f64),
    last: Option<f64>,
    solution: &Solution,
    at_minimum: bool,
) -> String {
    let own = match best.objective {
        Objective::SumOfSquares(_) => significant(best.fitness, 5),
        _ => format!(
            "{} ({}), a sum of squares of {}",
            significant(best.fitness, 5),
            best.objective.name(),
            significant(before, 5)
        ),
    };
    let after = solution.fitness;
    let values =
        solution.parameters.iter().map(|p| format!("{} = {}", p.name, significant(p.value, 5)));
    let values = values.collect::<Vec<String>>().join(", ");
    let (search, from) = match last {
        Some(last) => {
            (format!("{who} found {own} and ended at {}", significant(last, 5)), "from its best")
        }
        None => (format!("{who} ended at {own}"), "from there"),
    };
    let reached = if before - after > BETTER * before {
        let ratio = before / after;
        let much = match ratio {
            ratio if ratio >= 1.1 => format!("{} times better", significant(ratio, 3)),
            ratio => format!("{} % better", significant(100.0 * (ratio - 1.0), 2)),
        };
        let after = significant(after, 5);
        format!("{search}; least squares {from} reaches {after} ({much}) at {values}.")
    } else {
        format!("{search}; least squares {from} finds no improvement.")
    };
    match at_minimum {
        true => format!(
            "{reached} This is a minimum; standard errors and statements on identifiability \
             refer to this minimum."
        ),
        false => format!(
            "{reached} This is not a minimum ({}), so there are no standard errors and no \
             statements on identifiability.",
            solution.outcome.stop
        ),
    }
}

/// The solution without what holds at a minimum only.
fn without_verdicts(mut solution: Solution) -> Solution {
    for parameter in &mut solution.parameters {
        parameter.deviation = None;
        parameter.forget();
    }
    (solution.correlations, solution.condition) = (None, None);
    solution.findings.clear();
    solution
}
