//! Evaluates populations on all cores. What comes out depends neither on the number of threads
//! nor on what was evaluated before: equal genes are answered from memory.

use super::relative::{Compared, Relative, Scaled};
use super::{Failed, Linearization, Parts, Problem, Simulate};
use crate::diag::Fault;
use crate::elementary;
use crate::fitness::Whitening;
use crate::ga::optimizer::Required;
use crate::ga::{Genomes, has_failed};
use crate::ranks::{Asked, Batch, Processors, Simulation};
use crate::simulators::Simulators;
use nalgebra::DMatrix;
use rustc_hash::FxHashMap;
use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

/// Shows what is being done.
pub type Status = Arc<dyn Fn(&str) + Send + Sync>;

/// Individuals remembered.
const REMEMBERED: usize = 8192;

/// The answers to one question.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct Answered {
    /// Objectives, individual by individual.
    pub objectives: Vec<f64>,
    /// Weighted residuals, individual by individual; empty unless asked for.
    pub residuals: Vec<f64>,
    /// Derivatives of the weighted residuals by the genes, individual by individual, residuals ×
    /// genes; empty unless asked for.
    pub jacobians: Vec<f64>,
    /// Which failed, in order of the individuals.
    pub failures: Vec<(usize, Failed)>,
    /// Simulations that it took.
    pub simulations: u64,
}

/// The simulated points of an individual, or why there are none.
type Row = Result<Vec<f64>, Failed>;

/// Simulators, what their answers are compared with, and the memory of equal genes.
pub struct Evaluation {
    measured: Vec<f64>,
    weights: Vec<f64>,
    /// What residuals are multiplied with, where there is a sum of squares.
    scales: Option<Vec<f64>>,
    n_objectives: usize,
    /// Scales and offsets that each simulation gets before it is compared.
    relative: Option<Relative>,
    simulators: Simulators,
    /// The independent parts of what follows the search.
    pub parts: Parts,
    memory: Memory,
    status: Option<Status>,
}

/// Answers by genes; the oldest give way.
#[derive(Default)]
struct Memory {
    places: FxHashMap<u64, usize>,
    keys: Vec<u64>,
    genomes: Vec<f64>,
    objectives: Vec<f64>,
    failures: Vec<Option<Failed>>,
    next: usize,
}

impl Evaluation {
    /// Prepares one simulator for each of `threads` threads.
    ///
    /// # Errors
    ///
    /// Those of the simulator's maker.
    pub fn new(problem: &Problem, threads: usize) -> Result<Evaluation, Fault> {
        Evaluation::on(problem, &Processors::threads(threads))
    }

    /// Prepares simulators for the threads of this process and for other ranks.
    ///
    /// # Errors
    ///
    /// Those of [`Evaluation::new`]; `ranks-differ` where a rank cannot make the simulator.
    pub fn on(problem: &Problem, processors: &Processors) -> Result<Evaluation, Fault> {
        let measured: Vec<f64> =
            problem.series.iter().flat_map(|series| series.y.clone()).collect();
        let weights: Vec<f64> = problem.series.iter().flat_map(super::Series::weights).collect();
        let first = problem.objectives.first();
        let scales = first.and_then(|(_, fitness)| fitness.least_squares(&measured, &weights));
        Ok(Evaluation {
            scales,
            n_objectives: problem.objectives.len(),
            relative: Relative::of(problem),
            simulators: Simulators::on(processors, &*problem.simulator)?,
            measured,
            weights,
            parts: Parts::default(),
            memory: Memory::default(),
            status: None,
        })
    }

    /// Whether the first objective is a sum of squares, so that it has residuals.
    pub fn has_residuals(&self) -> bool {
        self.scales.is_some()
    }

    /// What the differences are multiplied with to become residuals.
    pub fn scales(&self) -> Option<&[f64]> {
        self.scales.as_deref()
    }

    /// Root of the sum of squares of the measured values, scaled as residuals are.
    pub(super) fn size(&self) -> f64 {
        let scales = self.scales.as_deref().unwrap_or(&self.weights);
        self.measured
            .iter()
            .zip(scales)
            .map(|(y, s)| elementary::powi(y * s, 2))
            .sum::<f64>()
            .sqrt()
    }

    /// Why other ranks take no part, in words that follow on "because".
    pub fn alone(&self) -> Option<&str> {
        self.simulators.alone()
    }

    /// What differences of the points count.
    pub(super) fn weights(&self) -> &[f64] {
        &self.weights
    }

    /// How far two simulations are apart: root mean square of the weighted differences.
    pub(super) fn distance(&self, a: &[f64], b: &[f64]) -> f64 {
        let pairs = a.iter().zip(b).zip(&self.weights);
        let square: f64 = pairs.map(|((a, b), weight)| elementary::powi(weight * (a - b), 2)).sum();
        (square / a.len() as f64).sqrt()
    }

    /// From now on simulations end when the flag is set.
    pub fn cancel_by(&mut self, flag: Option<Arc<AtomicBool>>) {
        self.simulators.cancel_by(flag);
    }

    /// What ends simulations when it is set.
    pub(super) fn cancel(&self) -> Option<Arc<AtomicBool>> {
        self.simulators.cancel().cloned()
    }

    /// From now on what is being done is shown this way.
    pub fn show_by(&mut self, status: Option<Status>) {
        self.status = status;
    }

    /// Shows what is being done; nothing by an empty text.
    pub fn show(&self, text: &str) {
        if let Some(status) = &self.status {
            status(text);
        }
    }

    /// Evaluates every individual; the genomes are those of the method. `None` when simulations
    /// were cancelled.
    pub fn evaluate(
        &mut self,
        problem: &Problem,
        batch: &Genomes,
        required: Required,
    ) -> Option<Answered> {
        let answered = match required {
            Required::Jacobians => self.with_jacobians(problem, batch),
            _ => self.without(problem, batch, required == Required::Residuals),
        };
        if self.is_cancelled() {
            return None;
        }
        self.remember(batch, &answered);
        Some(answered)
    }

    /// The objectives of one individual, simulated again in any case, as the method requires them.
    pub(super) fn objectives_anew(
        &self,
        problem: &Problem,
        genome: &[f64],
        required: Required,
    ) -> Vec<f64> {
        if required == Required::Jacobians {
            let single = Genomes::new(genome.len(), genome.to_vec());
            return single.map_or(Vec::new(), |one| self.with_jacobians(problem, &one).objectives);
        }
        let mut row = vec![f64::NAN; self.measured.len()];
        let failed = self.simulators.own().simulate(&problem.values(genome), &mut row).err();
        self.relate(&mut row);
        self.rate(problem, &row, failed).0
    }

    fn with_jacobians(&self, problem: &Problem, batch: &Genomes) -> Answered {
        let (points, n) = (self.measured.len(), problem.parameters.len());
        let places: Vec<Vec<f64>> = batch.rows().map(|genome| problem.values(genome)).collect();
        let mut answered = Answered::default();
        for (k, found) in self.linearize(problem, &places).into_iter().enumerate() {
            let (row, failed) = match found {
                Ok(found) => {
                    answered.simulations += found.simulations;
                    answered.jacobians.extend(self.weighted(problem, &places[k], &found));
                    (found.simulated, None)
                }
                Err(failed) => {
                    answered.simulations += 1;
                    answered.jacobians.extend(vec![f64::NAN; points * n]);
                    (vec![f64::NAN; points], Some(failed))
                }
            };
            let (objectives, failed) = self.rate(problem, &row, failed);
            answered.objectives.extend(objectives);
            answered.failures.extend(failed.map(|failed| (k, failed)));
            answered.residuals.extend(self.residuals(problem, &row));
        }
        answered
    }

    /// Derivatives of the weighted residuals by the fractions of the ranges, residuals × genes.
    pub(super) fn weighted(
        &self,
        problem: &Problem,
        values: &[f64],
        found: &Linearization,
    ) -> Vec<f64> {
        let ranges = problem.parameters.iter().zip(values);
        let range_derivatives: Vec<f64> =
            ranges.map(|(free, value)| free.derivative(*value)).collect();
        let points = self.measured.len();
        let (mut residuals, mut scales) = (vec![0.0; points], vec![0.0; points]);
        self.scaled(problem, &found.simulated, &mut residuals, &mut scales);
        let rows = found.derivatives.chunks_exact(values.len()).zip(&scales);
        let mut weighted: Vec<f64> = rows
            .flat_map(|(row, scale)| {
                row.iter().zip(&range_derivatives).map(move |(d, s)| d * s * scale)
            })
            .collect();
        if let Some(whitening) = self.whitening(problem, &found.simulated) {
            whitening.apply_to_rows(&mut weighted, values.len());
        }
        weighted
    }

    /// What makes weighted residuals and their derivatives uncorrelated.
    pub(super) fn whitening(&self, problem: &Problem, simulated: &[f64]) -> Option<Whitening> {
        let fitness = &problem.objectives.first()?.1;
        fitness.whitening([simulated, &self.measured, &self.weights])
    }

    /// The correlations of the groups of series whose errors are correlated.
    pub(super) fn correlations(&self, problem: &Problem, simulated: &[f64]) -> Vec<DMatrix<f64>> {
        let Some((_, fitness)) = problem.objectives.first() else { return Vec::new() };
        let all = fitness.covariances([simulated, &self.measured, &self.weights]).into_iter();
        let correlation = |own: DMatrix<f64>| {
            let size = |a: usize, b: usize| (own[(a, a)] * own[(b, b)]).sqrt();
            DMatrix::from_fn(own.nrows(), own.ncols(), |a, b| own[(a, b)] / size(a, b))
        };
        all.map(correlation).collect()
    }

    fn without(&self, problem: &Problem, batch: &Genomes, residuals: bool) -> Answered {
        let (n, m) = (batch.len(), self.n_objectives);
        let mut objectives = vec![f64::NAN; n * m];
        let mut failed: Vec<Option<Failed>> = vec![None; n];
        // Those with equal genes stand for each other; with residuals everything is simulated.
        let mut unknown: Vec<usize> = Vec::with_capacity(n);
        for (k, genome) in batch.rows().enumerate() {
            match self.memory.find(genome).filter(|_| !residuals) {
                Some(place) => self.memory.answer(
                    place,
                    m,
                    &mut objectives[k * m..(k + 1) * m],
                    &mut failed[k],
                ),
                None => unknown.push(k),
            }
        }
        let places: Vec<Vec<f64>> = unknown.iter().map(|&k| problem.values(batch.row(k))).collect();
        let found = self.distributed(&places, (Asked::Points, 1.0), |mut own| {
            self.relate(&mut own.row);
            let rated = self.rate(problem, &own.row, own.failed);
            (rated, residuals.then_some(own.row))
        });
        let mut rows = Vec::new();
        for (&k, ((values, failure), row)) in unknown.iter().zip(found) {
            objectives[k * m..(k + 1) * m].copy_from_slice(&values);
            failed[k] = failure;
            rows.extend(row.into_iter().flatten());
        }
        Answered {
            residuals: if residuals { self.residuals(problem, &rows) } else { Vec::new() },
            objectives,
            failures: failed.into_iter().enumerate().filter_map(|(k, f)| Some((k, f?))).collect(),
            simulations: unknown.len() as u64,
            jacobians: Vec::new(),
        }
    }

    /// Simulations at several places with the tolerance times a factor, spread over all threads and
    /// ranks, and what `then` makes of them. Where they were cancelled, they have failed.
    fn distributed<T: Send>(
        &self,
        places: &[Vec<f64>],
        (asked, factor): (Asked, f64),
        then: impl Fn(Simulation) -> T + Sync,
    ) -> Vec<T> {
        let batch = Batch {
            values: &places.concat(),
            parameters: places.first().map_or(1, Vec::len),
            points: self.measured.len(),
            asked,
            tolerance: factor * self.simulators.tolerance(),
        };
        self.simulators.simulate(&batch, then)
    }

    /// The simulated points of one individual.
    ///
    /// # Errors
    ///
    /// Why it failed.
    pub fn simulate(&self, values: &[f64]) -> Result<Vec<f64>, Failed> {
        let mut row = vec![f64::NAN; self.measured.len()];
        self.simulators.own().simulate(values, &mut row)?;
        self.relate(&mut row);
        Ok(row)
    }

    /// The simulated points of several individuals given by their values, at once.
    pub(crate) fn simulate_all(&self, values: &[Vec<f64>]) -> Vec<Result<Vec<f64>, Failed>> {
        self.simulate_scaled(values, 1.0)
    }

    /// The same with the tolerance of the solver times `factor`.
    pub(crate) fn simulate_scaled(
        &self,
        values: &[Vec<f64>],
        factor: f64,
    ) -> Vec<Result<Vec<f64>, Failed>> {
        let points = |mut own: Simulation| {
            self.relate(&mut own.row);
            own.failed.map_or(Ok(own.row), Err)
        };
        self.distributed(values, (Asked::Points, factor), points)
    }

    /// The same as the model has them, without scales and offsets of relative data.
    pub(super) fn simulate_unscaled(
        &self,
        values: &[Vec<f64>],
        factor: f64,
    ) -> Vec<Result<Vec<f64>, Failed>> {
        let points = |own: Simulation| own.failed.map_or(Ok(own.row), Err);
        self.distributed(values, (Asked::Points, factor), points)
    }

    /// Scales and offsets of relative data.
    pub(super) fn relative(&self) -> Option<&Relative> {
        self.relative.as_ref()
    }

    /// The scales and offsets that fit a simulation best.
    pub(super) fn scaled_best(&self, relative: &Relative, row: &[f64]) -> Scaled {
        let (measured, weights) = (&self.measured[..], &self.weights[..]);
        relative.fit(row, Compared { measured, weights, are_final: false })
    }

    /// Gives simulated points the scales and offsets of relative data.
    fn relate(&self, row: &mut [f64]) {
        if let Some(relative) = &self.relative {
            relative.apply(&self.scaled_best(relative, row), row);
        }
    }

    /// Runs a job for every number below `count` on all threads, each with a simulator of its own.
    pub(super) fn each<T: Send>(
        &self,
        count: usize,
        job: impl Fn(usize, &mut dyn Simulate) -> T + Sync,
    ) -> Vec<T> {
        self.simulators.each(count, job)
    }

    /// The results of jobs that several shards may share, all of which start from `start`; `None`
    /// where others belong to other shards.
    pub(super) fn each_part<T: Send + Serialize + DeserializeOwned>(
        &self,
        kind: &str,
        start: &[f64],
        count: usize,
        job: impl Fn(usize, &mut dyn Simulate) -> T + Sync,
    ) -> Option<Vec<T>> {
        self.parts.all((kind, start), count, |missing| {
            self.each(missing.len(), |place, simulator| job(missing[place], simulator))
        })
    }

    /// The simulated points of several groups of individuals that several shards may share; `None`
    /// where some belong to other shards.
    pub(super) fn simulate_groups(
        &self,
        kind: &str,
        groups: &[Vec<Vec<f64>>],
    ) -> Option<Vec<Vec<Row>>> {
        let start: Vec<f64> = groups.iter().flatten().flatten().copied().collect();
        self.parts.all((kind, &start), groups.len(), |missing| {
            let values: Vec<Vec<f64>> = missing.iter().flat_map(|k| groups[*k].clone()).collect();
            let mut rows = self.simulate_all(&values).into_iter();
            missing.iter().map(|k| rows.by_ref().take(groups[*k].len()).collect()).collect()
        })
    }

    /// Whether simulations have been cancelled.
    pub(super) fn is_cancelled(&self) -> bool {
        self.simulators.is_cancelled()
    }

    /// The simulated points at several places, with derivatives where the simulator has exact ones,
    /// with the tolerance of the solver times `factor`; as the model has them.
    pub(super) fn exact_all(
        &self,
        places: &[Vec<f64>],
        factor: f64,
    ) -> Vec<Result<Linearization, Failed>> {
        let linearization = |own: Simulation| match own.failed {
            Some(failed) => Err(failed),
            None => Ok(Linearization {
                simulated: own.row,
                derivatives: own.derivatives,
                exact: own.exact,
                refusal: own.refusal,
                simulations: 1,
                shares: Vec::new(),
            }),
        };
        self.distributed(places, (Asked::DerivativesOrPoints, factor), linearization)
    }

    /// The answers of an earlier run are remembered as if they were new.
    pub fn remember(&mut self, batch: &Genomes, answered: &Answered) {
        let m = self.n_objectives;
        let mut failures = answered.failures.iter().peekable();
        for (k, genome) in batch.rows().enumerate() {
            let failure =
                failures.next_if(|(failed, _)| *failed == k).map(|(_, failed)| failed.clone());
            self.memory.insert(genome, &answered.objectives[k * m..(k + 1) * m], failure);
        }
    }

    /// Forgets the answers: equal genes mean other values from now on.
    pub(super) fn forget(&mut self) {
        self.memory = Memory::default();
    }

    /// The objectives of a simulation, and why it failed.
    fn rate(
        &self,
        problem: &Problem,
        row: &[f64],
        failed: Option<Failed>,
    ) -> (Vec<f64>, Option<Failed>) {
        if let Some(failed) = failed {
            return (vec![failed.fitness(); self.n_objectives], Some(failed));
        }
        let value = |(_, f): &(String, Box<dyn super::Fitness>)| {
            f.fitness(row, &self.measured, &self.weights)
        };
        let values: Vec<f64> = problem.objectives.iter().map(value).collect();
        let unrated = values.iter().position(|value| has_failed(*value));
        let why = |k: usize| {
            wrong_deviation(problem, row).unwrap_or_else(|| unrated_by(&problem.objectives[k].0))
        };
        (values, unrated.map(why))
    }

    pub(super) fn residuals(&self, problem: &Problem, rows: &[f64]) -> Vec<f64> {
        if self.scales.is_none() {
            return Vec::new();
        }
        let (mut all, mut factors) = (vec![0.0; rows.len()], vec![0.0; self.measured.len()]);
        let n = self.measured.len();
        for (row, own) in rows.chunks_exact(n).zip(all.chunks_exact_mut(n)) {
            self.scaled(problem, row, own, &mut factors);
        }
        all
    }

    /// Residuals of one simulation whose squares add up to what least squares minimizes, and the
    /// factors that make derivatives of the points those of the residuals.
    pub(super) fn scaled(
        &self,
        problem: &Problem,
        simulated: &[f64],
        residuals: &mut [f64],
        factors: &mut [f64],
    ) {
        let fitness = &problem.objectives[0].1;
        let compared = [simulated, &self.measured[..], &self.weights[..]];
        if fitness.scaled(compared, residuals, factors) {
            return;
        }
        let scales = self.scales.as_deref().unwrap_or(&self.weights);
        factors.copy_from_slice(scales);
        let points = simulated.iter().zip(&self.measured).zip(scales);
        residuals.iter_mut().zip(points).for_each(|(r, ((s, m), w))| *r = w * (s - m));
    }

    /// The weights that the errors have at this simulation: reciprocal standard deviations where
    /// these are known or estimated.
    pub(super) fn error_weights(&self, problem: &Problem, simulated: &[f64]) -> Vec<f64> {
        let fitness = problem.objectives.first().map(|(_, fitness)| fitness);
        fitness
            .and_then(|own| own.error_weights(simulated, &self.measured, &self.weights))
            .or_else(|| self.scales.clone())
            .unwrap_or_else(|| self.weights.clone())
    }

    /// Weighted residuals, measured less simulated, without the factors of a robust fitness; those of
    /// deviations that the model computes are what their points' residuals u make of them,
    /// (u² - 1)/√2, whose mean is 0 and whose variance is 1 where the deviations hold.
    pub(super) fn standard_residuals(&self, problem: &Problem, simulated: &[f64]) -> Vec<f64> {
        let weights = self.error_weights(problem, simulated);
        let points = self.measured.iter().zip(simulated).zip(&weights);
        let mut residuals: Vec<f64> = points.map(|((m, s), w)| w * (m - s)).collect();
        if let Some(whitening) = self.whitening(problem, simulated) {
            whitening.apply(&mut residuals);
        }
        let mut first = 0;
        for (k, series) in problem.series.iter().enumerate() {
            if let super::Role::Deviation(back) = series.role {
                let distance: usize =
                    problem.series[k - back..k].iter().map(|own| own.y.len()).sum();
                for point in first..first + series.y.len() {
                    let u = residuals[point - distance];
                    residuals[point] = (u * u - 1.0) / std::f64::consts::SQRT_2;
                }
            }
            first += series.y.len();
        }
        residuals
    }

    /// The sum of squares that least squares minimize.
    pub(super) fn searched_sum(&self, problem: &Problem, simulated: &[f64]) -> f64 {
        self.residuals(problem, simulated).iter().map(|r| r * r).sum()
    }

    /// The first objective of a simulation.
    pub(super) fn objective(&self, problem: &Problem, simulated: &[f64]) -> f64 {
        problem.objectives[0].1.fitness(simulated, &self.measured, &self.weights)
    }

    /// From now on the points count these weights; what was remembered holds no longer.
    pub(super) fn reweigh(&mut self, problem: &Problem, weights: Vec<f64>) {
        let fitness = problem.objectives.first();
        self.scales = fitness.and_then(|(_, own)| own.least_squares(&self.measured, &weights));
        self.weights = weights;
        self.forget();
    }

    /// From now on simulators solve with their tolerance times this.
    pub(super) fn scale_tolerance(&mut self, factor: f64) {
        self.simulators.scale_tolerance(factor);
        self.forget();
    }
}

/// The first standard deviation of the model that is none.
fn wrong_deviation(problem: &Problem, row: &[f64]) -> Option<Failed> {
    let mut rest = row;
    for series in &problem.series {
        let (own, others) = rest.split_at(series.x.len().min(rest.len()));
        rest = others;
        let is_deviation = matches!(series.role, super::Role::Deviation(_));
        let is_wrong = own.iter().any(|sigma| sigma.is_nan() || *sigma <= 0.0);
        if is_deviation && is_wrong {
            // The same words for all individuals, which are counted by them.
            let cause = format!(
                "{}: the sigma `{}` is not positive everywhere",
                series.experiment,
                series.y_name.trim_matches('\'')
            );
            return Some(Failed::new(super::FailureKind::Points, cause, 1.0));
        }
    }
    None
}

fn unrated_by(name: &str) -> Failed {
    let cause = format!("the fitness function `{name}` does not return a number");
    Failed::new(super::FailureKind::Points, cause, 1.0)
}

impl Memory {
    fn key(genome: &[f64]) -> u64 {
        use std::hash::Hasher;
        let mut hasher = rustc_hash::FxHasher::default();
        genome.iter().for_each(|value| hasher.write_u64(value.to_bits()));
        hasher.finish()
    }

    fn find(&self, genome: &[f64]) -> Option<usize> {
        let place = *self.places.get(&Memory::key(genome))?;
        let known = &self.genomes[place * genome.len()..(place + 1) * genome.len()];
        (known == genome).then_some(place)
    }

    fn answer(&self, place: usize, m: usize, objectives: &mut [f64], failed: &mut Option<Failed>) {
        objectives.copy_from_slice(&self.objectives[place * m..(place + 1) * m]);
        failed.clone_from(&self.failures[place]);
    }

    fn insert(&mut self, genome: &[f64], objectives: &[f64], failure: Option<Failed>) {
        if self.find(genome).is_some() {
            return;
        }
        let (n, m, key, place) = (genome.len(), objectives.len(), Memory::key(genome), self.next);
        if self.keys.len() < REMEMBERED {
            self.keys.push(key);
            self.genomes.extend_from_slice(genome);
            self.objectives.extend_from_slice(objectives);
            self.failures.push(failure);
        } else {
            if self.places.get(&self.keys[place]) == Some(&place) {
                self.places.remove(&self.keys[place]);
            }
            self.keys[place] = key;
            self.genomes[place * n..(place + 1) * n].copy_from_slice(genome);
            self.objectives[place * m..(place + 1) * m].copy_from_slice(objectives);
            self.failures[place] = failure;
        }
        self.places.insert(key, place);
        self.next = (place + 1) % REMEMBERED;
    }
}
