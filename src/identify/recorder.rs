//! Follows a run of scripts, whatever they are called and whatever their variables: the functions
//! of GAPILib report what they are given and what they answer, and the recorder puts generations,
//! the best individual and the counts together.
//!
//! A generation ends with `Fit_Order`, which gets a population and its fitness; in scripts that
//! sort by themselves it ends when an experiment is simulated again after `Fit` got all its
//! individuals. So a script may evaluate its population in one call or one by one, with several
//! experiments whose results it sums, with its own fitness function or its own sorting. When it has
//! both of its own, the fitness is not known, and individuals are compared by the sum of squares.

use super::Simulated;
use super::fitness::sum_of_squares;
use super::generation::{self, Generation};
use super::objective::{Objective, recognized};
use super::search_record::{Best, SearchRecord};
use super::seeds::Seeds;
use super::study::{Compared, Measurement, Study};
use crate::ga::{Genomes, has_failed};
use std::sync::Arc;

/// Individuals of generations that may turn out to be parts of one: a population of 100 in the 36
/// experiments of `scripts/humidity` has 3600.
const PROVISIONAL: usize = 10_000;
/// The best individual of the run.
#[derive(Debug, Clone, Copy)]
pub struct ScriptBest<'a> {
    /// Its genes.
    pub genome: &'a [f64],
    /// Its fitness.
    pub fitness: f64,
    /// What the fitness is.
    pub objective: &'a Objective,
    /// Everything that it was compared with.
    pub compared: &'a [Compared],
}

/// What the fitness of the best individual is, and everything that it was compared with.
#[derive(Debug, Clone)]
struct Comparison {
    objective: Objective,
    compared: Vec<Compared>,
}

/// The best individual with its comparison, where there is one.
type Known = Option<(Best, Comparison)>;

/// What was observed of a run.
#[derive(Debug, Clone, Default)]
pub struct Recorder {
    /// Its generations, its best individual, and its failures.
    pub observed: SearchRecord,
    comparison: Option<Comparison>,
    /// The search ranges used last: minima and maxima.
    pub ranges: Option<(Vec<f64>, Vec<f64>)>,
    /// Smallest and largest gene of all individuals that were simulated.
    pub spanned: Option<(Vec<f64>, Vec<f64>)>,
    /// Number of simulations.
    pub evaluations: u64,
    /// What the user changed during the run, and from which generation on.
    pub changes: Vec<(usize, String)>,
    /// Whether operators of the genetic algorithm make one generation of the other; a script without
    /// them evaluates individuals that it chooses in another way.
    pub evolves: bool,
    measurements: Vec<Measurement>,
    seeds: Seeds,
    /// Individuals simulated in this run and those before it.
    numbered: u64,
    /// Individuals of the generation that ended last.
    generation_size: usize,
    sorted_by_fit_order: bool,
    /// Whether the script makes the parameters that it simulates of other genes.
    transforms: bool,
    pending: Generation,
    /// Generations that ended without `Fit_Order`, each with what was best before it.
    provisional: Vec<(Generation, Known)>,
}

impl Recorder {
    /// `Exp_Adq_SISO` has read data.
    pub fn measured(&mut self, measurement: Measurement) {
        self.measurements.push(measurement);
    }

    /// Measured X are compared in another unit: what was read with `from` belongs to `to` as well.
    pub fn measured_over(&mut self, from: &[f64], to: &[f64]) {
        let own = self.measurements.iter().filter(|read| read.x == from);
        let converted = own.map(|read| Measurement { x: to.to_vec(), ..read.clone() });
        let converted: Vec<Measurement> = converted.collect();
        self.measurements.extend(converted);
    }

    /// `Ram_Gen_ARENA` was called with `seed`, at the place `site` of a script, and gave `next` to
    /// go on with.
    pub fn seeded(&mut self, seed: [f64; 6], next: [f64; 6], site: u64) {
        self.seeds.drawn(seed, next, site, self.evaluations > 0);
    }

    /// The seed that the random numbers of the run began with.
    pub fn seed(&self) -> Option<[f64; 6]> {
        self.seeds.seed
    }

    /// Begins to record another run and returns the one before, finished.
    pub fn begin_next(&mut self) -> Recorder {
        let (seeds, numbered) = (self.seeds.of_next_run(), self.numbered);
        let next = Recorder { seeds, numbered, ..Recorder::default() };
        let mut before = std::mem::replace(self, next);
        before.finish();
        before
    }

    /// `Mutation` or `Refine` was called with these search ranges, which are those of the parameters
    /// unless the script makes parameters of other genes.
    pub fn searched(&mut self, minima: &[f64], maxima: &[f64]) {
        self.ranges = (!self.transforms).then(|| (minima.to_vec(), maxima.to_vec()));
    }

    /// `Eval` has simulated `genomes`; returns the number of the first, from which the others count.
    pub fn evaluated(
        &mut self,
        study: &Arc<Study>,
        x: &[f64],
        genomes: &Genomes,
        simulated: &Simulated,
    ) -> u64 {
        let ends = !self.sorted_by_fit_order
            && self.pending.is_rated()
            && self.pending.has_rated(study, x);
        if ends {
            self.end_pending_generation();
        }
        let generations = self.observed.history.generations.len();
        if let Some(seed) = self.seeds.goes_on(generations) {
            let entries = seed.map(|entry| entry.to_string()).join(", ");
            self.changes.push((generations + 1, format!("seed := {{{entries}}}")));
        }
        self.evaluations += genomes.len() as u64;
        for failure in simulated.failures.iter().flatten() {
            self.observed.failed(&failure.cause);
        }
        self.span(genomes);
        let first = self.numbered + 1;
        self.numbered += genomes.len() as u64;
        self.pending.add((study, x), genomes, simulated, first);
        first
    }

    /// The numbers of the individuals of this generation whose rows a script may have copied.
    pub fn copied(&self, row: &[f64]) -> Vec<u64> {
        self.pending.equal_to(row)
    }

    /// `Fit` has compared the individuals with these numbers with `measured`. Those of generations
    /// that have ended are none of ours.
    pub fn rated(&mut self, numbers: impl IntoIterator<Item = u64>, measured: &[f64]) {
        self.pending.rate(numbers.into_iter(), measured);
    }

    /// What is counted: generations, or evaluations where nothing evolves. Which of them it is shows
    /// in the first generation only.
    pub fn counted(&self) -> &'static str {
        let is_known = self.observed.generations() > 0;
        if is_known && !self.evolves { "evaluation" } else { "generation" }
    }

    /// The best individual so far.
    pub fn best(&self) -> Option<ScriptBest<'_>> {
        let (best, comparison) = (self.observed.best.as_ref()?, self.comparison.as_ref()?);
        Some(ScriptBest {
            genome: &best.values,
            fitness: best.fitness,
            objective: &comparison.objective,
            compared: &comparison.compared,
        })
    }

    /// `Fit_Order` got a population with its fitness: a generation ends.
    pub fn ordered(&mut self, population: &Genomes, fitness: &[f64]) {
        self.evolves = true;
        self.refined(population, fitness);
    }

    /// All individuals of a search have this fitness, such as those of `Refine`: a generation ends.
    pub fn refined(&mut self, population: &Genomes, fitness: &[f64]) {
        if !std::mem::replace(&mut self.sorted_by_fit_order, true) {
            self.take_back(population);
        }
        if self.pending.is_empty() || population.len() != fitness.len() {
            return;
        }
        let individuals: Vec<Vec<f64>> = population.rows().map(<[f64]>::to_vec).collect();
        let individuals = match self.simulated_instead(&individuals, fitness) {
            Some(simulated) => {
                // The ranges so far were those of the genes.
                (self.transforms, self.ranges) = (true, None);
                simulated
            }
            None => individuals,
        };
        self.end_generation(&individuals, fitness, true);
    }

    /// What was simulated in place of these genes, which were not all simulated: a script that makes parameters of
    /// them, such as 10^g, simulates as many individuals, whose sums of squares are the fitness.
    fn simulated_instead(&self, genes: &[Vec<f64>], fitness: &[f64]) -> Option<Vec<Vec<f64>>> {
        let simulated = self.pending.genomes();
        if simulated.len() != genes.len() || genes.iter().all(|own| simulated.contains(own)) {
            return None;
        }
        let experiments = self.pending.covering(simulated);
        let sums = self.pending.sums(&experiments, simulated, &self.measurements);
        (recognized(&sums, fitness) != Objective::Script).then(|| simulated.to_vec())
    }

    /// The run has ended or was interrupted: ends the generation that is complete.
    pub fn finish(&mut self) {
        let not_shown = self.observed.generations() == 0 && !self.pending.has_ratings();
        let complete = self.pending.is_rated() && !self.sorted_by_fit_order;
        let interrupted =
            self.pending.is_rated() && self.sorted_by_fit_order && self.is_next_generation();
        if !self.pending.is_empty() && (not_shown || complete || interrupted) {
            self.end_pending_generation();
        }
        self.pending.clear();
    }

    /// Whether what is pending may be a generation that was interrupted before `Fit_Order`, and not
    /// a simulation for another purpose. What a script adds up is known by `Fit_Order` alone.
    fn is_next_generation(&self) -> bool {
        let Some((study, x, count)) = self.pending.only() else { return false };
        let alike = |best: ScriptBest<'_>| match best.compared {
            [one] => {
                one.x == x
                    && *one.study == *study
                    && *best.objective == Objective::SumOfSquares(vec![1.0])
            }
            _ => false,
        };
        count == self.generation_size && self.best().is_some_and(alike)
    }

    fn span(&mut self, genomes: &Genomes) {
        let Some(first) = genomes.rows().next() else { return };
        let known = self.spanned.take().filter(|(low, _)| low.len() == first.len());
        let (mut low, mut high) = known.unwrap_or_else(|| (first.to_vec(), first.to_vec()));
        for genome in genomes.rows() {
            for (k, &gene) in genome.iter().enumerate() {
                (low[k], high[k]) = (low[k].min(gene), high[k].max(gene));
            }
        }
        self.spanned = Some((low, high));
    }

    /// At the first `Fit_Order`: what was taken for generations before, because nothing sorted,
    /// were individuals or experiments of this one.
    fn take_back(&mut self, population: &Genomes) {
        let mut known: Vec<u64> = population.rows().map(generation::key).collect();
        known.sort_unstable();
        while let Some((part, before)) =
            self.provisional.pop_if(|(part, _)| part.is_part_of(&known))
        {
            let mut whole = part;
            whole.append(std::mem::take(&mut self.pending));
            self.pending = whole;
            let (best, comparison) = before.unzip();
            self.observed.take_back(best);
            self.comparison = comparison;
        }
        self.provisional = Vec::new();
    }

    /// A generation that the script has not sorted: the sum over its series.
    fn end_pending_generation(&mut self) {
        let individuals = self.pending.genomes().to_vec();
        let experiments = self.pending.covering(&individuals);
        let sums = self.pending.sums(&experiments, &individuals, &self.measurements);
        let total = |sums: &Vec<f64>| if sums.is_empty() { f64::NAN } else { sums.iter().sum() };
        let mut fitness: Vec<f64> = sums.iter().map(total).collect();
        if fitness.iter().all(|fitness| fitness.is_nan()) {
            return self.pending.clear();
        }
        for value in fitness.iter_mut().filter(|value| has_failed(**value)) {
            *value = crate::ga::FAILED_FITNESS;
        }
        let before = self.observed.best.clone().zip(self.comparison.clone());
        let part = self.pending.clone();
        self.end_generation(&individuals, &fitness, false);
        if !self.sorted_by_fit_order {
            self.provisional.push((part, before));
            while self.provisional.iter().map(|(part, _)| part.size()).sum::<usize>() > PROVISIONAL
            {
                self.provisional.remove(0);
            }
        }
    }

    fn end_generation(&mut self, individuals: &[Vec<f64>], fitness: &[f64], sorted: bool) {
        self.generation_size = fitness.len();
        let mut observed = std::mem::take(&mut self.observed);
        let mut comparison = None;
        let counts = |k: usize| {
            comparison = self.comparison_of(k, individuals, fitness, sorted);
            comparison.is_some()
        };
        if observed.generation(fitness, |k| individuals[k].clone(), counts) {
            self.comparison = comparison;
        }
        self.observed = observed;
        self.pending.clear();
    }

    /// What individual `k` was compared with, if it is better than the best so far.
    fn comparison_of(
        &self,
        k: usize,
        all: &[Vec<f64>],
        fitness: &[f64],
        sorted: bool,
    ) -> Option<Comparison> {
        let experiments = self.pending.covering(all);
        let compared = self.pending.compared(&experiments, &all[k], &self.measurements);
        if compared.is_empty() {
            return None;
        }
        let objective = match (sorted, self.pending.has_ratings(), compared.len()) {
            (false, true, 1) => Objective::SumOfSquares(vec![1.0]),
            (false, ..) => Objective::Assumed,
            (true, ..) => {
                recognized(&self.pending.sums(&experiments, all, &self.measurements), fitness)
            }
        };
        let before = self.comparison.as_ref().map(|before| &before.objective);
        Some(Comparison { objective: objective.agreeing(before), compared })
    }
}

impl ScriptBest<'_> {
    /// The sum of squared residuals over all series, each times its weight; `None` where the
    /// objective is not of this kind or data are not known.
    pub fn sum_of_squares(&self) -> Option<f64> {
        let weights = self.objective.weights(self.compared.len())?;
        let one = |(compared, weight): (&Compared, f64)| {
            Some(weight * sum_of_squares(&compared.simulated, compared.measured.as_deref()?))
        };
        self.compared.iter().zip(weights).map(one).sum()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Quantity;
    use crate::problem::{Failed, FailureKind};

    fn study() -> Arc<Study> {
        let quantity = |name: &str| Quantity { name: name.to_owned(), unit: String::new() };
        Arc::new(Study {
            model: "M".to_owned(),
            parameters: vec![quantity("p")],
            x: quantity("time"),
            y: quantity("y"),
            descriptions: crate::Descriptions::default(),
        })
    }

    fn genomes(values: &[f64]) -> Genomes {
        Genomes::new(1, values.to_vec()).unwrap()
    }

    fn simulated(rows: &[f64]) -> Simulated {
        let failure =
            |row: &f64| row.is_nan().then(|| Failed::new(FailureKind::Model, "log of -1", 0.5));
        Simulated { rows: rows.to_vec(), failures: rows.iter().map(failure).collect() }
    }

    #[test]
    fn fit_order_ends_a_generation() {
        let mut recorder = Recorder::default();
        let population = genomes(&[3.0, 1.0, 9.0]);
        let rows = simulated(&[3.0, 1.0, f64::NAN]);
        for _ in 0..2 {
            let first = recorder.evaluated(&study(), &[0.0], &population, &rows);
            recorder.rated(first..first + 3, &[0.0]);
            recorder.ordered(&population, &[9.0, 1.0, 1e60]);
        }
        recorder.finish();
        assert_eq!(recorder.observed.history.generations.len(), 2);
        assert_eq!(recorder.observed.history.generations[1].failures, 1);
        assert_eq!((recorder.evaluations, recorder.observed.failures), (6, 2));
        assert_eq!(recorder.observed.causes["log of -1"], 2);
        let best = recorder.best().unwrap();
        assert_eq!((best.genome[0], best.fitness, best.compared[0].simulated[0]), (1.0, 1.0, 1.0));
        assert_eq!(best.objective, &Objective::SumOfSquares(vec![1.0]));
        assert_eq!(best.compared[0].measured, Some(vec![0.0]));
    }

    /// Genes are logarithms: what counts is what was simulated, and the ranges of the genes are none
    /// of the parameters.
    #[test]
    fn parameters_made_of_genes_are_those_that_were_simulated() {
        let mut recorder = Recorder::default();
        for generation in 0..2 {
            let first = recorder.evaluated(
                &study(),
                &[0.0],
                &genomes(&[1.0, 10.0, 100.0]),
                &simulated(&[1.0, 10.0, f64::NAN]),
            );
            recorder.rated(first..first + 3, &[0.0]);
            recorder.ordered(&genomes(&[0.0, 1.0, 2.0]), &[1.0, 100.0, 1e60]);
            recorder.searched(&[-3.0], &[3.0]);
            assert_eq!(recorder.observed.history.generations.len(), generation + 1);
        }
        let best = recorder.best().unwrap();
        assert_eq!((best.genome[0], best.fitness), (1.0, 1.0));
        assert_eq!(best.objective, &Objective::SumOfSquares(vec![1.0]));
        assert_eq!((&recorder.ranges, &recorder.spanned), (&None, &Some((vec![1.0], vec![100.0]))));
    }

    #[test]
    fn genes_that_explain_no_fitness_are_not_exchanged() {
        let mut recorder = Recorder::default();
        let first =
            recorder.evaluated(&study(), &[0.0], &genomes(&[1.0, 10.0]), &simulated(&[1.0, 10.0]));
        recorder.rated(first..first + 2, &[0.0]);
        recorder.ordered(&genomes(&[0.0, 1.0]), &[5.0, 7.0]);
        assert!(recorder.best().is_none());
    }

    #[test]
    fn individuals_evaluated_one_by_one_make_one_generation() {
        let mut recorder = Recorder::default();
        for generation in 0..2 {
            for k in 0..3 {
                let value = [f64::from(3 - k - generation)];
                let one =
                    recorder.evaluated(&study(), &[0.0], &genomes(&value), &simulated(&value));
                recorder.rated([one], &[0.0]);
            }
            let population = genomes(&[3, 2, 1].map(|value| f64::from(value - generation)));
            recorder.ordered(&population, population.values());
        }
        assert_eq!(recorder.observed.history.generations.len(), 2);
        assert_eq!(recorder.best().unwrap().fitness, 0.0);
    }

    #[test]
    fn another_run_has_its_own_seed() {
        let seed = |entry: f64| [entry; 6];
        let mut recorder = Recorder::default();
        recorder.seeded(seed(1.0), seed(2.0), 1);
        recorder.evaluated(&study(), &[0.0], &genomes(&[5.0]), &simulated(&[7.0]));
        recorder.seeded(seed(2.0), seed(4.0), 2);
        recorder.ordered(&genomes(&[5.0]), &[42.0]);
        recorder.seeded(seed(7.0), seed(8.0), 1);
        let before = recorder.begin_next();
        assert_eq!((before.seed(), before.evaluations), (Some(seed(1.0)), 1));
        recorder.seeded(seed(8.0), seed(10.0), 1);
        assert_eq!((recorder.seed(), recorder.evaluations), (Some(seed(7.0)), 0));
    }

    /// Two populations are simulated before either is compared, and compared the other way round.
    #[test]
    fn genes_belong_to_the_individuals_that_fit_was_given() {
        let mut recorder = Recorder::default();
        recorder.evaluated(&study(), &[0.0], &genomes(&[1.1]), &simulated(&[1.1]));
        recorder.evaluated(
            &study(),
            &[0.0],
            &genomes(&[2.0, 3.0, 4.0]),
            &simulated(&[2.0, 3.0, 4.0]),
        );
        recorder.rated(2..=4, &[3.0]);
        assert!(recorder.observed.history.generations.is_empty());
        recorder.rated([1], &[3.0]);
        recorder.finish();
        let best = recorder.best().unwrap();
        assert_eq!((best.genome[0], best.fitness, best.compared[0].simulated[0]), (3.0, 0.0, 3.0));
        assert_eq!(recorder.observed.history.generations.len(), 1);
    }

    /// Some individuals of an `Eval`, and those of several put together, are known as well.
    #[test]
    fn individuals_are_known_wherever_they_stand() {
        let mut recorder = Recorder::default();
        recorder.evaluated(&study(), &[0.0], &genomes(&[1.0, 2.0]), &simulated(&[1.0, 2.0]));
        recorder.evaluated(&study(), &[0.0], &genomes(&[5.0]), &simulated(&[5.0]));
        recorder.rated([3, 2], &[4.0]);
        assert!(!recorder.pending.is_rated(), "one of three was not compared");
        recorder.rated([17], &[4.0]);
        assert!(!recorder.pending.is_rated(), "that individual is not known");
        recorder.rated([1], &[4.0]);
        recorder.finish();
        let best = recorder.best().unwrap();
        assert_eq!((best.genome[0], best.fitness), (5.0, 1.0));
    }

    /// A copy is that of all individuals with its numbers: elites are simulated again in each generation.
    #[test]
    fn copies_belong_to_the_individuals_with_their_numbers() {
        let mut recorder = Recorder::default();
        let (genes, rows) = (genomes(&[1.0, 1.0, 2.0]), simulated(&[5.0, 5.0, f64::NAN]));
        recorder.evaluated(&study(), &[0.0], &genes, &rows);
        let copied = [5.0, f64::NAN].map(|value| recorder.copied(&[value])).concat();
        assert_eq!(copied, [1, 2, 3]);
        assert!(recorder.copied(&[6.0]).is_empty() && recorder.copied(&[5.0, 5.0]).is_empty());
        recorder.rated(copied, &[4.0]);
        assert!(recorder.pending.is_rated());
    }

    /// Rows without any digit of their own: whose they are, their numbers say.
    #[test]
    fn failed_individuals_belong_to_their_experiment() {
        let mut recorder = Recorder::default();
        let failed = simulated(&[f64::NAN, f64::NAN]);
        let first = recorder.evaluated(&study(), &[0.0], &genomes(&[1.0, 2.0]), &failed);
        let other = recorder.evaluated(&second(), &[0.0], &genomes(&[1.0, 2.0]), &failed);
        recorder.rated([first, first + 1], &[4.0]);
        assert!(!recorder.pending.is_rated(), "the other experiment was not compared");
        recorder.rated([other, other + 1], &[4.0]);
        assert!(recorder.pending.is_rated());
        let before = recorder.begin_next();
        assert_eq!(before.numbered, 4);
        let later = recorder.evaluated(&study(), &[0.0], &genomes(&[1.0]), &simulated(&[1.0]));
        assert_eq!(later, 5, "no number comes twice");
    }

    fn second() -> Arc<Study> {
        Arc::new(Study { model: "M2".to_owned(), ..(*study()).clone() })
    }

    /// Two experiments a generation, whose sums the script adds; `total` is what it adds up.
    fn two_experiments(total: fn(f64, f64) -> f64) -> Recorder {
        let mut recorder = Recorder::default();
        for generation in 0..3 {
            let genes: Vec<f64> =
                [1.0, 2.0, 3.0, 4.0, 5.0].map(|g| g + f64::from(generation)).into();
            let (first, other): (Vec<f64>, Vec<f64>) = genes.iter().map(|g| (*g, 2.0 * g)).unzip();
            let all = |first: u64| first..first + 5;
            let own = recorder.evaluated(&study(), &[0.0], &genomes(&genes), &simulated(&first));
            recorder.rated(all(own), &[4.0]);
            let own = recorder.evaluated(&second(), &[0.0], &genomes(&genes), &simulated(&other));
            recorder.rated(all(own), &[9.0]);
            let sums = genes.iter().map(|g| total((g - 4.0).powi(2), (2.0 * g - 9.0).powi(2)));
            recorder.ordered(&genomes(&genes), &sums.collect::<Vec<f64>>());
        }
        recorder.finish();
        recorder
    }

    #[test]
    fn a_generation_with_several_experiments_is_one() {
        let recorder = two_experiments(|a, b| a + b);
        assert_eq!((recorder.observed.history.generations.len(), recorder.evaluations), (3, 30));
        assert_eq!(recorder.observed.history.generations[0].best, 1.0, "not a partial sum");
        let best = recorder.best().unwrap();
        assert_eq!((best.genome[0], best.fitness), (4.0, 1.0));
        assert_eq!(best.objective, &Objective::SumOfSquares(vec![1.0, 1.0]));
        let models: Vec<&str> = best.compared.iter().map(|c| c.study.model.as_str()).collect();
        assert_eq!((models, best.sum_of_squares()), (vec!["M", "M2"], Some(1.0)));
    }

    #[test]
    fn the_weights_of_the_script_are_found() {
        let recorder = two_experiments(|a, b| a + 0.25 * b);
        let best = recorder.best().unwrap();
        let Objective::SumOfSquares(weights) = best.objective else { panic!("{best:?}") };
        assert!((weights[0] - 1.0).abs() < 1e-9 && (weights[1] - 0.25).abs() < 1e-9);
        assert_eq!(*two_experiments(|a, b| a + b * b).best().unwrap().objective, Objective::Script);
    }

    #[test]
    fn a_check_with_other_data_is_no_generation() {
        let mut recorder = Recorder::default();
        recorder.evaluated(&study(), &[0.0], &genomes(&[5.0]), &simulated(&[3.0]));
        recorder.rated([1], &[0.0]);
        recorder.ordered(&genomes(&[5.0]), &[9.0]);
        recorder.evaluated(&study(), &[1.0], &genomes(&[5.0]), &simulated(&[3.0]));
        recorder.rated([2], &[3.0]);
        recorder.finish();
        assert_eq!(recorder.observed.history.generations.len(), 1);
        assert_eq!(recorder.best().unwrap().fitness, 9.0);
        assert_eq!(recorder.best().unwrap().compared[0].measured, Some(vec![0.0]));
    }

    #[test]
    fn own_sorting_ends_a_generation_with_the_next_simulation() {
        let mut recorder = Recorder::default();
        for value in [3.0, 2.0] {
            let one =
                recorder.evaluated(&study(), &[0.0], &genomes(&[value]), &simulated(&[value]));
            recorder.rated([one], &[0.0]);
        }
        assert_eq!(recorder.observed.history.generations.len(), 1);
        recorder.finish();
        assert_eq!(recorder.observed.history.generations.len(), 2);
        assert_eq!(recorder.best().unwrap().genome, [2.0]);
    }

    #[test]
    fn own_fitness_is_taken_from_fit_order() {
        let mut recorder = Recorder::default();
        recorder.evaluated(&study(), &[0.0], &genomes(&[5.0]), &simulated(&[7.0]));
        recorder.ordered(&genomes(&[5.0]), &[42.0]);
        recorder.finish();
        assert_eq!(recorder.best().unwrap().fitness, 42.0);
        assert_eq!(recorder.best().unwrap().objective, &Objective::Script);
    }

    #[test]
    fn with_own_fitness_and_own_sorting_the_sum_of_squares_is_assumed() {
        let mut recorder = Recorder::default();
        recorder.measured(Measurement { file: "d.mat".into(), x: vec![0.0], y: vec![1.0] });
        recorder.evaluated(&study(), &[0.0], &genomes(&[5.0]), &simulated(&[3.0]));
        recorder.finish();
        assert_eq!(recorder.best().unwrap().fitness, 4.0);
        assert_eq!(recorder.best().unwrap().objective, &Objective::Assumed);
    }

    #[test]
    fn an_interrupted_generation_without_fitness_does_not_count() {
        let mut recorder = Recorder::default();
        recorder.evaluated(&study(), &[0.0], &genomes(&[5.0]), &simulated(&[3.0]));
        recorder.ordered(&genomes(&[5.0]), &[9.0]);
        recorder.evaluated(&study(), &[0.0], &genomes(&[4.0]), &simulated(&[3.0]));
        recorder.finish();
        assert_eq!(recorder.observed.history.generations.len(), 1);
        assert_eq!(recorder.evaluations, 2);
    }
}
