//! A run: the method asks, the simulator answers, until a stop condition holds.

use super::evaluation::{Answered, Evaluation};
use super::{Failed, FailureKind, Fingerprint, Problem, Record, Stop};
use crate::diag::Fault;
use crate::ga::optimizer::{
    Answers, DescentReport, Optimizer, Polished, Required, Scale, Setup, non_dominated,
};
use crate::ga::{Gene, Genomes, Mrg32k3a, has_failed};
use crate::ranks::Processors;
use crate::registry::BAD_OPTION;
use crate::search_record::{Best, SearchRecord};
use crate::{bail, elementary, fault};
use indexmap::IndexMap;

/// The smallest relative improvement that is one.
const IMPROVEMENT: f64 = 1e-6;
/// Evaluations of a run without any stop condition, of up to [`FEW`] parameters. With more they grow as the
/// square of the number: of the benchmark problems of PEtab, those with 20 and more parameters ended
/// here in 10 to 100 s, far from the published optimum.
const EVALUATIONS: u64 = 20_000;
/// So many parameters need no further evaluations.
const FEW: u64 = 10;
/// Individuals that fail alike, at the same time for the same cause, before the search ends: the cause
/// is the model, whatever the parameters are.
const ALIKE: u64 = 20;
/// Individuals that fail, none of them being simulated, before the search ends. Where a hundredth of
/// the search space can be simulated, these many find it with a probability of 0.99.
const HOPELESS: u64 = 500;

/// What ended the search, as far as it is known.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Cause {
    Condition,
    Converged,
    User,
}

/// A run under way.
pub struct Run {
    /// What is solved.
    pub problem: Problem,
    /// The simulators.
    pub evaluation: Evaluation,
    optimizer: Box<dyn Optimizer>,
    batch: Genomes,
    asked: bool,
    converged: bool,
    changes: Vec<(String, f64)>,
    /// What was observed; a generation is a question.
    pub observed: SearchRecord,
    /// Simulations that it took.
    pub simulations: u64,
    /// Seconds of work so far, as the records say.
    pub seconds: f64,
    /// Failures by kind.
    pub failed: [u64; FailureKind::ALL.len()],
    /// Values with which each cause came first.
    pub examples: IndexMap<String, Vec<f64>>,
    /// The first failure, as long as all others are like it.
    alike: Option<Failed>,
    /// Why no further simulation is worth its time.
    hopeless: Option<String>,
    /// The non-dominated individuals, where there are several objectives: values and objectives.
    pub front: Vec<(Vec<f64>, Vec<f64>)>,
    last_gain: u64,
    reference: f64,
    /// Changes made during the run, and before which question.
    pub changed: Vec<(u64, String, f64)>,
    cause: Cause,
    /// What [`conclude`](super::conclude) did after the last question.
    pub(crate) conclusion: super::Conclusion,
}

impl Run {
    /// Prepares a run on `threads` threads.
    ///
    /// # Errors
    ///
    /// Problems without parameters, points or objectives; a method that cannot solve this one;
    /// whatever the simulator's maker refuses.
    pub fn new(problem: Problem, threads: usize) -> Result<Run, Fault> {
        Run::on(problem, &Processors::threads(threads))
    }

    /// Prepares a run on the threads of this process and on other ranks.
    ///
    /// # Errors
    ///
    /// Those of [`Run::new`]; `ranks-differ` where a rank cannot make the simulator.
    pub fn on(mut problem: Problem, processors: &Processors) -> Result<Run, Fault> {
        if problem.parameters.is_empty() || problem.n_points() == 0 || problem.objectives.is_empty()
        {
            bail!(BAD_OPTION, "there are no parameters, no points or no fitness functions");
        }
        let several = problem.objectives.len() > 1;
        if several && !problem.method.handles_several_objectives() {
            bail!(BAD_OPTION, "`{}` minimizes one fitness function, not {}", problem.method_name, problem.objectives.len(); help: "use `nsga2`");
        }
        if problem.stop == Stop::default() {
            let many = (problem.parameters.len() as u64).max(FEW);
            problem.stop.evaluations = Some(EVALUATIONS * many * many / (FEW * FEW));
        }
        let evaluation = Evaluation::on(&problem, processors)?;
        if problem.method.needs_residuals() && !evaluation.has_residuals() {
            bail!(BAD_OPTION, "`{}` needs a sum of squares, which `{}` is not", problem.method_name, problem.objectives[0].0; help: "use `nelder_mead` or a genetic method");
        }
        let optimizer = optimizer(&problem, &evaluation)?;
        Ok(Run {
            batch: Genomes::with_capacity(problem.parameters.len(), 0),
            problem,
            evaluation,
            optimizer,
            asked: false,
            converged: false,
            changes: Vec::new(),
            observed: SearchRecord::default(),
            simulations: 0,
            seconds: 0.0,
            failed: [0; FailureKind::ALL.len()],
            examples: IndexMap::new(),
            alike: None,
            hopeless: None,
            front: Vec::new(),
            last_gain: 0,
            reference: f64::INFINITY,
            changed: Vec::new(),
            cause: Cause::User,
            conclusion: super::Conclusion::default(),
        })
    }

    /// Questions answered so far.
    pub fn generations(&self) -> u64 {
        self.observed.generations()
    }

    /// Individuals evaluated.
    pub fn evaluations(&self) -> u64 {
        self.observed.individuals
    }

    /// What the method is doing, in one word.
    pub fn phase(&self) -> &'static str {
        self.optimizer.phase()
    }

    /// Why the run cannot go on: an operator of the user has failed.
    pub fn fault(&self) -> Option<Fault> {
        self.optimizer.fault().cloned()
    }

    /// Why the run is over, in words; `None` while it is not.
    pub fn stop(&mut self) -> Option<String> {
        let condition = self.condition();
        self.cause = if condition.is_some() { Cause::Condition } else { Cause::User };
        if condition.is_some() {
            return condition;
        }
        self.ask();
        if self.converged {
            self.cause = Cause::Converged;
        }
        self.converged.then(|| "the search has converged".to_owned())
    }

    /// The stop condition that holds, in words.
    fn condition(&self) -> Option<String> {
        if let Some(cause) = &self.hopeless {
            return Some(format!("the simulations do not end: {cause}"));
        }
        if self.is_hopeless() {
            return Some("no individual could be simulated".to_owned());
        }
        let stop = self.problem.stop;
        let best = self.observed.best.as_ref().map_or(f64::INFINITY, |best| best.fitness);
        if let Some(target) = stop.target.filter(|target| best <= *target) {
            return Some(format!("the fitness {best:e} has reached the target {target:e}"));
        }
        if let Some(limit) = stop.generations.filter(|limit| self.generations() >= *limit) {
            return Some(format!("{limit} generations"));
        }
        // A Jacobian by differences is one individual, but many simulations.
        let evaluations = self.evaluations().max(self.simulations);
        if let Some(limit) = stop.evaluations.filter(|limit| evaluations >= *limit) {
            return Some(format!("{limit} evaluations"));
        }
        if let Some(limit) = stop.seconds.filter(|limit| self.seconds >= *limit) {
            return Some(format!("{limit} seconds"));
        }
        let idle = self.generations() - self.last_gain;
        let limit = stop.stagnation.filter(|limit| idle >= *limit)?;
        Some(format!("{limit} generations without improvement"))
    }

    /// Whether nothing was simulated and nothing will be.
    fn is_hopeless(&self) -> bool {
        let enough = if self.alike.is_some() { ALIKE } else { HOPELESS };
        self.observed.best.is_none() && self.evaluations() >= enough
    }

    /// Ends the run because the time of its stop conditions is used up while a question is under way;
    /// the reason in words.
    pub fn end_by_time(&mut self) -> String {
        self.cause = Cause::Condition;
        format!("{} seconds", self.problem.stop.seconds.unwrap_or(self.seconds))
    }

    /// What ended the search; the user, where nothing else did.
    pub(super) fn cause(&self) -> Cause {
        self.cause
    }

    /// The descents by least squares so far.
    pub(super) fn descents(&self) -> Vec<DescentReport> {
        self.optimizer.descents()
    }

    /// Goes to a better point that was found beside the search, as by a profile: statistics are
    /// those of this point from now on. Returns whether it is better.
    pub(super) fn go_to(&mut self, values: &[f64]) -> bool {
        let Ok(simulated) = self.evaluation.simulate(values) else { return false };
        let fitness = self.evaluation.objective(&self.problem, &simulated);
        let is_better = self.observed.best.as_ref().is_none_or(|best| fitness < best.fitness);
        if is_better && !has_failed(fitness) {
            self.observed.best = Some(Best { values: values.to_vec(), fitness });
        }
        is_better
    }

    /// Changes a setting of the method, or with `min NAME` and `max NAME` a range, or a stop
    /// condition, before the next question.
    ///
    /// # Errors
    ///
    /// `bad-option` where there is no such setting or the value does not fit.
    pub fn change(&mut self, setting: &str, value: f64) -> Result<(), Fault> {
        let whole = value.fract() == 0.0 && value >= 0.0;
        match setting {
            "generations" if whole => self.problem.stop.generations = Some(value as u64),
            "evaluations" if whole => self.problem.stop.evaluations = Some(value as u64),
            "seconds" if value >= 0.0 => self.problem.stop.seconds = Some(value),
            _ if setting.starts_with("min ") || setting.starts_with("max ") => {
                self.change_range(setting, value)?;
            }
            _ => self.optimizer.change(setting, value)?,
        }
        self.changes.push((setting.to_owned(), value));
        self.changed.push((self.generations(), setting.to_owned(), value));
        Ok(())
    }

    fn change_range(&mut self, setting: &str, value: f64) -> Result<(), Fault> {
        if self.problem.method.in_natural_units() {
            bail!(BAD_OPTION, "`{}` cannot change search ranges during the \
                               run", self.problem.method_name; help: "use another method, or change them in the loop of the script");
        }
        let (end, name) = setting.split_at(4);
        let place = self.problem.parameters.iter().position(|free| free.name == name);
        let place =
            place.ok_or_else(|| fault!(BAD_OPTION, "there is no estimated parameter `{name}`"))?;
        let old = self.problem.parameters[place].clone();
        let range = if end == "min " { [value, old.max] } else { [old.min, value] };
        let new = super::Free::new(&old.name, &old.unit, range, Some(old.logarithmic), None)?;
        // Both scales are linear in the fractions, so the map is found from two points.
        let fraction = |value: f64| match new.logarithmic {
            true => elementary::ln(value / new.min) / elementary::ln(new.max / new.min),
            false => (value - new.min) / (new.max - new.min),
        };
        let (offset, end) = (fraction(old.min), fraction(old.max));
        self.optimizer.rescale(place, offset, end - offset);
        self.problem.parameters[place] = new;
        self.asked = false;
        self.batch = Genomes::with_capacity(self.problem.parameters.len(), 0);
        self.evaluation.forget();
        Ok(())
    }

    fn ask(&mut self) {
        if self.asked || self.converged {
            return;
        }
        self.batch = Genomes::with_capacity(self.problem.parameters.len(), self.batch.len());
        self.optimizer.ask(&mut self.batch);
        self.asked = !self.batch.is_empty();
        self.converged = !self.asked;
    }

    /// One question and its answers; `None` when the method has converged or the simulations were
    /// cancelled, after which it can be asked again. `seconds` of work so
    /// far go into the record.
    pub fn step(&mut self, seconds: f64) -> Option<Record> {
        self.ask();
        if self.converged {
            return None;
        }
        let required = self.optimizer.required();
        let answered = self.evaluation.evaluate(&self.problem, &self.batch, required)?;
        let record = Record {
            seconds,
            changes: std::mem::take(&mut self.changes),
            asked: fingerprint(&self.batch),
            answered,
        };
        self.take(&record);
        Some(record)
    }

    /// Goes all steps of an earlier run again. Its best individual and another one are recomputed:
    /// if a bit differs, it was the run of another problem.
    ///
    /// # Errors
    ///
    /// `bad-option` when this run asks or answers something else than that one did.
    pub fn resume(&mut self, records: &[Record]) -> Result<(), Fault> {
        let m = self.problem.objectives.len();
        let first = |record: &Record| -> Vec<f64> {
            record.answered.objectives.iter().step_by(m).copied().collect()
        };
        let all = records.iter().enumerate().flat_map(|(k, record)| {
            first(record).into_iter().enumerate().map(move |(row, value)| (value, k, row))
        });
        let best = all.filter(|(value, ..)| !has_failed(*value)).min_by(|a, b| a.0.total_cmp(&b.0));
        // The genes asked last are as good as random.
        let random = records.last().map_or(0, |last| last.asked as usize);
        for (k, record) in records.iter().enumerate() {
            self.ask_again(record)?;
            if let Some((_, _, row)) = best.filter(|(_, of, _)| *of == k) {
                self.compute_again(record, row)?;
            }
            if k == random % records.len() && !self.batch.is_empty() {
                self.compute_again(record, random % self.batch.len())?;
            }
            self.take_again(record);
        }
        Ok(())
    }

    /// An individual of the question at hand has the objectives that the record says.
    fn compute_again(&self, record: &Record, row: usize) -> Result<(), Fault> {
        let m = self.problem.objectives.len();
        let before = record.answered.objectives.get(row * m..(row + 1) * m).unwrap_or_default();
        let genome = self.batch.row(row);
        let now = self.evaluation.objectives_anew(&self.problem, genome, self.optimizer.required());
        let bits = |values: &[f64]| values.iter().map(|v| v.to_bits()).collect::<Vec<_>>();
        // What a cancelled simulation says is not compared.
        let have_failed = now.iter().chain(before).all(|value| has_failed(*value));
        if bits(&now) == bits(before) || have_failed || self.evaluation.is_cancelled() {
            return Ok(());
        }
        bail!(
            BAD_OPTION,
            "individual {} of candidate set {} of the checkpoint has the objective {}, but now {}: the simulation has changed",
            row + 1,
            self.generations() + 1,
            before.first().unwrap_or(&f64::NAN),
            now.first().unwrap_or(&f64::NAN);
            help: "restore the model, its libraries and tables, the program and the machine, or start again with `--fresh`"
        );
    }

    /// Goes a step of an earlier run again.
    ///
    /// # Errors
    ///
    /// `bad-option` when this run asks something else than that one did.
    pub fn replay(&mut self, record: &Record) -> Result<(), Fault> {
        self.ask_again(record)?;
        self.take_again(record);
        Ok(())
    }

    fn take_again(&mut self, record: &Record) {
        self.evaluation.remember(&self.batch, &record.answered);
        self.take(record);
    }

    fn ask_again(&mut self, record: &Record) -> Result<(), Fault> {
        for (setting, value) in &record.changes {
            self.change(setting, *value)?;
        }
        self.changes.clear();
        self.ask();
        if fingerprint(&self.batch) != record.asked || !self.is_answer(&record.answered) {
            bail!(
                BAD_OPTION,
                "generation {} of the checkpoint does not belong to this problem", self.generations() + 1;
                help: "start again, or use the program version that wrote the checkpoint"
            );
        }
        Ok(())
    }

    /// Whether these can be the answers to what was asked.
    fn is_answer(&self, answered: &Answered) -> bool {
        let (count, required) = (self.batch.len(), self.optimizer.required());
        let residuals = if required >= Required::Residuals { self.problem.n_points() } else { 0 };
        let genes = if required == Required::Jacobians { self.problem.parameters.len() } else { 0 };
        answered.objectives.len() == count * self.problem.objectives.len()
            && answered.residuals.len() == count * residuals
            && answered.jacobians.len() == count * residuals * genes
    }

    fn take(&mut self, record: &Record) {
        let Answered { objectives, residuals, jacobians, failures, simulations } = &record.answered;
        let m = self.problem.objectives.len();
        let fitness: Vec<f64> = objectives.iter().step_by(m).copied().collect();
        self.seconds = record.seconds;
        self.simulations += simulations;
        for (row, failed) in failures {
            self.note_failure(*row, failed);
        }
        self.observe(&fitness);
        if m > 1 {
            self.keep_front(objectives, m);
        }
        let answers = Answers { objectives, n_objectives: m, residuals, jacobians };
        self.optimizer.tell(&self.batch, &answers);
        self.asked = false;
    }

    fn note_failure(&mut self, row: usize, failed: &Failed) {
        let kind = FailureKind::ALL.iter().position(|kind| *kind == failed.kind).unwrap_or(0);
        let is_first = self.failed.iter().all(|count| *count == 0);
        let is_alike = |first: &Failed| {
            first.cause == failed.cause && first.progress.to_bits() == failed.progress.to_bits()
        };
        self.alike = match self.alike.take() {
            None if is_first => Some(failed.clone()),
            known => known.filter(is_alike),
        };
        self.failed[kind] += 1;
        if failed.kind == FailureKind::Hopeless {
            self.hopeless.get_or_insert_with(|| failed.cause.clone());
        }
        let cause = self.observed.failures.note(&failed.cause);
        if row < self.batch.len() && !self.examples.contains_key(cause) {
            let values = self.problem.values(self.batch.row(row));
            self.examples.insert(cause.to_owned(), values);
        }
    }

    /// A generation has this fitness.
    fn observe(&mut self, fitness: &[f64]) {
        let (problem, batch) = (&self.problem, &self.batch);
        let values = |k: usize| problem.values(batch.row(k));
        if !self.observed.generation(fitness, values, |_| true) {
            return;
        }
        let best = self.observed.best.as_ref().map_or(f64::INFINITY, |best| best.fitness);
        let is_first = self.reference.is_infinite();
        if is_first || best <= self.reference - IMPROVEMENT * self.reference.abs() {
            self.last_gain = self.generations();
            self.reference = best;
        }
    }

    fn keep_front(&mut self, objectives: &[f64], m: usize) {
        for k in 0..self.batch.len() {
            let own = &objectives[k * m..(k + 1) * m];
            if !has_failed(own[0]) {
                self.front.push((self.problem.values(self.batch.row(k)), own.to_vec()));
            }
        }
        let all: Vec<f64> =
            self.front.iter().flat_map(|(_, objectives)| objectives.clone()).collect();
        let kept = non_dominated(&all, m);
        let mut front: Vec<_> = kept.into_iter().map(|k| self.front[k].clone()).collect();
        front.sort_by(|a, b| a.1[0].total_cmp(&b.1[0]));
        front.dedup_by(|a, b| a.1 == b.1);
        self.front = front;
    }

    /// Where the individuals of the last question lie in the range of a parameter, as fractions.
    pub fn fractions(&self, parameter: usize) -> Vec<f64> {
        let natural = self.problem.method.in_natural_units();
        let fraction = |gene: f64| match natural {
            true => self.problem.parameters[parameter].fraction(gene),
            false => gene.clamp(0.0, 1.0),
        };
        self.batch.rows().map(|genome| fraction(genome[parameter])).collect()
    }
}

fn optimizer(problem: &Problem, evaluation: &Evaluation) -> Result<Box<dyn Optimizer>, Fault> {
    let rng = Mrg32k3a::new(&problem.seed)?;
    let natural = problem.method.in_natural_units();
    let gene = |free: &super::Free| match natural {
        true => Gene::new(&free.name, free.min, free.max),
        false => Gene::new(&free.name, 0.0, 1.0),
    };
    let scale = |free: &super::Free| Scale {
        min: free.min,
        max: free.max,
        logarithmic: free.logarithmic,
        unit: free.unit.clone(),
    };
    let starts = problem.parameters.iter().any(|free| free.start.is_some());
    let start = |free: &super::Free| free.start.map_or(0.5, |value| free.fraction(value));
    let setup = Setup {
        genes: problem.parameters.iter().map(gene).collect::<Result<_, Fault>>()?,
        scales: problem.parameters.iter().map(scale).collect(),
        n_objectives: problem.objectives.len(),
        budget: problem.stop.evaluations,
        start: starts.then(|| problem.parameters.iter().map(start).collect()),
        noise: problem.noise,
        size: evaluation.size(),
        rng: rng.clone(),
    };
    let search = problem.method.start(setup.clone())?;
    let polished = problem.polish && problem.method.can_be_polished() && evaluation.has_residuals();
    if !polished {
        return Ok(search);
    }
    Ok(Box::new(Polished::new(search, &setup, rng.stream(1))))
}

fn fingerprint(batch: &Genomes) -> u64 {
    let mut fingerprint = Fingerprint::default();
    fingerprint.add_numbers(batch.values());
    fingerprint.number()
}
