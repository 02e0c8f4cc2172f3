//! Follows a run of scripts, whatever they are called and whatever their variables: the functions
//! of GAPILib tell it what they are given and what they answer, and it puts generations, the best
//! individual and the counts together.
//!
//! A generation ends with `Fit_Order`, which gets a population and its fitness; in scripts that
//! sort by themselves it ends when the next simulation follows a `Fit` for all individuals. So a
//! script may evaluate its population in one call or one by one, with its own fitness function or
//! its own sorting. When it has both of its own, nobody tells the recorder the fitness, and it
//! compares by the sum of squares.

use super::Simulated;
use super::fitness::sum_of_squares;
use crate::ga::{FAILED_FITNESS, Genomes, History, has_failed};
use indexmap::IndexMap;
use std::sync::Arc;

/// No more different failure messages than this are kept apart.
const MAX_CAUSES: usize = 50;
/// The cause under which all further messages are counted.
const OTHER_CAUSES: &str = "other causes";

/// What is simulated: the model, what varies, what is compared.
#[derive(Debug, Clone, PartialEq)]
pub struct Study {
    /// The model, with its modification.
    pub model: String,
    /// The identified parameters in the order of the genes.
    pub parameters: Vec<Quantity>,
    /// What the measured points are given over.
    pub x: Quantity,
    /// What was measured.
    pub y: Quantity,
}

/// A name and a unit.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Quantity {
    /// Its name in the model.
    pub name: String,
    /// Its unit; empty where the model gives none.
    pub unit: String,
}

/// Where the measured data come from.
#[derive(Debug, Clone, PartialEq)]
pub struct Measurement {
    /// The file as the script names it.
    pub file: String,
    /// Measured X.
    pub x: Vec<f64>,
    /// Measured Y.
    pub y: Vec<f64>,
}

/// Which fitness decided what is best.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum FitnessSource {
    /// `Fit` of GAPILib.
    SumOfSquares,
    /// A function of the script, seen by `Fit_Order`.
    Script,
    /// Nobody told: the sum of squares was taken to compare.
    Assumed,
}

/// The best individual of the run.
#[derive(Debug, Clone, PartialEq)]
pub struct Best {
    /// What was simulated.
    pub study: Arc<Study>,
    /// Its genes.
    pub genome: Vec<f64>,
    /// Its fitness.
    pub fitness: f64,
    /// Its simulated Y at the measured points.
    pub simulated: Vec<f64>,
    /// The measured X of those points.
    pub x: Vec<f64>,
    /// The measured Y of those points; `None` where nobody told.
    pub measured: Option<Vec<f64>>,
}

/// What was observed of a run.
#[derive(Debug, Clone, Default)]
pub struct Recorder {
    /// One record for each generation.
    pub history: History,
    /// The best individual so far.
    pub best: Option<Best>,
    /// The measured data read last.
    pub measurement: Option<Measurement>,
    /// The seed that the random numbers of the first population began with.
    pub seed: Option<[f64; 6]>,
    /// The search ranges used last: minima and maxima.
    pub ranges: Option<(Vec<f64>, Vec<f64>)>,
    /// Number of simulations.
    pub evaluations: u64,
    /// Number of failed simulations.
    pub failures: u64,
    /// Why simulations failed, and how often.
    pub causes: IndexMap<String, u64>,
    /// What the user changed while the run went on, and from which generation on.
    pub changes: Vec<(usize, String)>,
    /// The random numbers being drawn: the seed they began with, and the one they go on with.
    chain: Option<Chain>,
    /// Individuals of the generation that ended last.
    generation_size: usize,
    sorted_by_fit_order: bool,
    fitness_by_fit: bool,
    pending: Pending,
}

/// Calls of `Ram_Gen_ARENA`, each with the seed that the one before gave.
#[derive(Debug, Clone, Copy)]
struct Chain {
    first: [f64; 6],
    next: [f64; 6],
}

/// Individuals simulated since the last generation ended.
#[derive(Debug, Clone, Default)]
struct Pending {
    study: Option<Arc<Study>>,
    x: Vec<f64>,
    /// What `Fit` compared with.
    measured: Option<Vec<f64>>,
    genomes: Vec<Vec<f64>>,
    simulated: Vec<Vec<f64>>,
    fitness: Vec<f64>,
}

impl Recorder {
    /// `Exp_Adq_SISO` has read data.
    pub fn measured(&mut self, measurement: Measurement) {
        self.measurement = Some(measurement);
    }

    /// `Ram_Gen_ARENA` was called with `seed` and gave `next` to go on with.
    pub fn seeded(&mut self, seed: [f64; 6], next: [f64; 6]) {
        let first = match self.chain {
            Some(chain) if chain.next == seed => chain.first,
            _ => seed,
        };
        self.chain = Some(Chain { first, next });
        if self.evaluations == 0 {
            self.seed = Some(first);
        }
        self.seed.get_or_insert(first);
    }

    /// Begins to record another run and returns the one before, finished. Its random numbers are
    /// those drawn with the seed that a script set last.
    pub fn begin_next(&mut self) -> Recorder {
        let next = Recorder {
            seed: self.chain.map(|chain| chain.first),
            chain: self.chain,
            ..Recorder::default()
        };
        let mut before = std::mem::replace(self, next);
        before.finish();
        before
    }

    /// `Mutation` was called with these search ranges.
    pub fn searched(&mut self, minima: &[f64], maxima: &[f64]) {
        self.ranges = Some((minima.to_vec(), maxima.to_vec()));
    }

    /// `Eval` has simulated `genomes`.
    pub fn evaluated(
        &mut self,
        study: &Arc<Study>,
        x: &[f64],
        genomes: &Genomes,
        simulated: &Simulated,
    ) {
        if !self.sorted_by_fit_order && self.pending.is_rated() {
            self.end_pending_generation();
        }
        self.evaluations += genomes.len() as u64;
        for failure in simulated.failures.iter().flatten() {
            self.count_failure(&failure.cause);
        }
        let pending = &mut self.pending;
        if pending.x != x || pending.study.as_ref() != Some(study) {
            *pending = Pending { study: Some(study.clone()), x: x.to_vec(), ..Pending::default() };
        }
        pending.genomes.extend(genomes.rows().map(<[f64]>::to_vec));
        pending.simulated.extend(simulated.rows.chunks(x.len().max(1)).map(<[f64]>::to_vec));
    }

    /// `Fit` has rated the simulations of the last individuals. Calls about anything else, such as
    /// the check of a result with other data, are none of ours.
    pub fn rated(&mut self, fitness: &[f64], measured: &[f64]) {
        let pending = &mut self.pending;
        if fitness.len() > pending.genomes.len() || measured.len() != pending.x.len() {
            return;
        }
        self.fitness_by_fit = true;
        pending.measured = Some(measured.to_vec());
        if pending.fitness.len() + fitness.len() > pending.genomes.len() {
            pending.fitness.clear();
        }
        pending.fitness.extend_from_slice(fitness);
    }

    /// `Fit_Order` got a population with its fitness: a generation ends.
    pub fn ordered(&mut self, population: &Genomes, fitness: &[f64]) {
        let first = !std::mem::replace(&mut self.sorted_by_fit_order, true);
        if first && self.evaluations == population.len() as u64 {
            // Evaluated one by one, the individuals of this generation were taken for generations.
            self.history = History::default();
        }
        if self.pending.genomes.is_empty() || population.len() != fitness.len() {
            return;
        }
        self.history.record(fitness);
        self.generation_size = fitness.len();
        let best = crate::ga::best(population, fitness);
        if let Some(best) = best
            && let Some(k) = self.pending.genomes.iter().position(|known| *known == best.genome)
        {
            self.keep_if_better(k, best.fitness);
        }
        self.pending.clear();
    }

    /// The run has ended or was interrupted: ends the generation that is complete.
    pub fn finish(&mut self) {
        let nobody_told = self.history.generations.is_empty() && !self.fitness_by_fit;
        if nobody_told && let Some(measurement) = &self.measurement {
            let rate = |row: &Vec<f64>| match row.len() == measurement.y.len() {
                true => sum_of_squares(row, &measurement.y),
                false => FAILED_FITNESS,
            };
            self.pending.fitness = self.pending.simulated.iter().map(rate).collect();
        }
        if self.pending.is_rated() && (!self.sorted_by_fit_order || self.is_next_generation()) {
            self.end_pending_generation();
        }
    }

    /// Whether what is pending may be a generation that was interrupted before `Fit_Order`, and not
    /// a simulation for another purpose.
    fn is_next_generation(&self) -> bool {
        let alike = |best: &Best| {
            best.x == self.pending.x && Some(&best.study) == self.pending.study.as_ref()
        };
        self.pending.genomes.len() == self.generation_size && self.best.as_ref().is_some_and(alike)
    }

    /// Which fitness decided.
    pub fn fitness_source(&self) -> FitnessSource {
        match (self.fitness_by_fit, self.sorted_by_fit_order) {
            (true, _) => FitnessSource::SumOfSquares,
            (false, true) => FitnessSource::Script,
            (false, false) => FitnessSource::Assumed,
        }
    }

    /// The measured Y of the best individual's points, if known.
    pub fn measured_y(&self) -> Option<&[f64]> {
        self.best.as_ref()?.measured.as_deref()
    }

    fn count_failure(&mut self, cause: &str) {
        self.failures += 1;
        let room = self.causes.len() < MAX_CAUSES || self.causes.contains_key(cause);
        let cause = if room { cause } else { OTHER_CAUSES };
        *self.causes.entry(cause.to_owned()).or_insert(0) += 1;
    }

    fn end_pending_generation(&mut self) {
        self.history.record(&self.pending.fitness);
        if let Some(&k) = crate::ga::order(&self.pending.fitness).first() {
            self.keep_if_better(k, self.pending.fitness[k]);
        }
        self.pending.clear();
    }

    /// Keeps pending individual `k` when it is better than the best so far.
    fn keep_if_better(&mut self, k: usize, fitness: f64) {
        let better = self.best.as_ref().is_none_or(|best| fitness < best.fitness);
        if !better || has_failed(fitness) {
            return;
        }
        let Some(study) = self.pending.study.clone() else { return };
        let read = self.measurement.as_ref().filter(|read| read.x == self.pending.x);
        let measured = self.pending.measured.clone().or(read.map(|read| read.y.clone()));
        self.best = Some(Best {
            study,
            genome: self.pending.genomes[k].clone(),
            fitness,
            simulated: self.pending.simulated[k].clone(),
            x: self.pending.x.clone(),
            measured,
        });
    }
}

impl Pending {
    /// Whether there are individuals and all have a fitness.
    fn is_rated(&self) -> bool {
        !self.genomes.is_empty() && self.fitness.len() == self.genomes.len()
    }

    fn clear(&mut self) {
        self.genomes.clear();
        self.simulated.clear();
        self.fitness.clear();
        self.measured = None;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::identify::FailedSimulation;

    fn study() -> Arc<Study> {
        let quantity = |name: &str| Quantity { name: name.to_owned(), unit: String::new() };
        Arc::new(Study {
            model: "M".to_owned(),
            parameters: vec![quantity("p")],
            x: quantity("time"),
            y: quantity("y"),
        })
    }

    fn genomes(values: &[f64]) -> Genomes {
        Genomes::new(1, values.to_vec()).unwrap()
    }

    fn simulated(rows: &[f64]) -> Simulated {
        let failure = |row: &f64| {
            row.is_nan().then(|| FailedSimulation { cause: "log of -1".into(), time: Some(0.5) })
        };
        Simulated { rows: rows.to_vec(), failures: rows.iter().map(failure).collect() }
    }

    #[test]
    fn fit_order_ends_a_generation() {
        let mut recorder = Recorder::default();
        let population = genomes(&[3.0, 1.0, 9.0]);
        let rows = simulated(&[3.0, 1.0, f64::NAN]);
        for _ in 0..2 {
            recorder.evaluated(&study(), &[0.0], &population, &rows);
            recorder.rated(&[9.0, 1.0, 1e60], &[0.0]);
            recorder.ordered(&population, &[9.0, 1.0, 1e60]);
        }
        recorder.finish();
        assert_eq!(recorder.history.generations.len(), 2);
        assert_eq!(recorder.history.generations[1].failures, 1);
        assert_eq!((recorder.evaluations, recorder.failures), (6, 2));
        assert_eq!(recorder.causes["log of -1"], 2);
        let best = recorder.best.as_ref().unwrap();
        assert_eq!((best.genome[0], best.fitness, best.simulated[0]), (1.0, 1.0, 1.0));
        assert_eq!(recorder.fitness_source(), FitnessSource::SumOfSquares);
        assert_eq!(recorder.measured_y(), Some(&[0.0][..]));
    }

    #[test]
    fn individuals_evaluated_one_by_one_make_one_generation() {
        let mut recorder = Recorder::default();
        for generation in 0..2 {
            for k in 0..3 {
                let value = [f64::from(3 - k - generation)];
                recorder.evaluated(&study(), &[0.0], &genomes(&value), &simulated(&value));
                recorder.rated(&value, &[0.0]);
            }
            let population = genomes(&[3, 2, 1].map(|value| f64::from(value - generation)));
            recorder.ordered(&population, population.values());
        }
        assert_eq!(recorder.history.generations.len(), 2);
        assert_eq!(recorder.best.unwrap().fitness, 0.0);
    }

    #[test]
    fn another_run_has_its_own_seed() {
        let seed = |entry: f64| [entry; 6];
        let mut recorder = Recorder::default();
        recorder.seeded(seed(1.0), seed(2.0));
        recorder.seeded(seed(2.0), seed(3.0));
        recorder.evaluated(&study(), &[0.0], &genomes(&[5.0]), &simulated(&[7.0]));
        recorder.seeded(seed(3.0), seed(4.0));
        recorder.ordered(&genomes(&[5.0]), &[42.0]);
        recorder.seeded(seed(7.0), seed(8.0));
        recorder.seeded(seed(8.0), seed(9.0));
        let before = recorder.begin_next();
        assert_eq!((before.seed, before.evaluations), (Some(seed(1.0)), 1));
        recorder.seeded(seed(9.0), seed(10.0));
        assert_eq!((recorder.seed, recorder.evaluations), (Some(seed(7.0)), 0));
        // Another seed before anything was simulated is the one that counts, not one for later.
        recorder.seeded(seed(20.0), seed(21.0));
        recorder.evaluated(&study(), &[0.0], &genomes(&[5.0]), &simulated(&[7.0]));
        recorder.seeded(seed(30.0), seed(31.0));
        assert_eq!(recorder.seed, Some(seed(20.0)));
    }

    #[test]
    fn a_check_with_other_data_is_no_generation() {
        let mut recorder = Recorder::default();
        recorder.evaluated(&study(), &[0.0], &genomes(&[5.0]), &simulated(&[3.0]));
        recorder.rated(&[9.0], &[0.0]);
        recorder.ordered(&genomes(&[5.0]), &[9.0]);
        recorder.evaluated(&study(), &[1.0], &genomes(&[5.0]), &simulated(&[3.0]));
        recorder.rated(&[0.0], &[3.0]);
        recorder.finish();
        assert_eq!(recorder.history.generations.len(), 1);
        assert_eq!(recorder.best.as_ref().unwrap().fitness, 9.0);
        assert_eq!(recorder.measured_y(), Some(&[0.0][..]));
    }

    #[test]
    fn own_sorting_ends_a_generation_with_the_next_simulation() {
        let mut recorder = Recorder::default();
        for value in [3.0, 2.0] {
            recorder.evaluated(&study(), &[0.0], &genomes(&[value]), &simulated(&[value]));
            recorder.rated(&[value], &[0.0]);
        }
        assert_eq!(recorder.history.generations.len(), 1);
        recorder.finish();
        assert_eq!(recorder.history.generations.len(), 2);
        assert_eq!(recorder.best.unwrap().genome, [2.0]);
    }

    #[test]
    fn own_fitness_is_taken_from_fit_order() {
        let mut recorder = Recorder::default();
        recorder.evaluated(&study(), &[0.0], &genomes(&[5.0]), &simulated(&[7.0]));
        recorder.ordered(&genomes(&[5.0]), &[42.0]);
        recorder.finish();
        assert_eq!(recorder.best.as_ref().unwrap().fitness, 42.0);
        assert_eq!(recorder.fitness_source(), FitnessSource::Script);
    }

    #[test]
    fn with_own_fitness_and_own_sorting_the_sum_of_squares_is_assumed() {
        let mut recorder = Recorder::default();
        recorder.measured(Measurement { file: "d.mat".into(), x: vec![0.0], y: vec![1.0] });
        recorder.evaluated(&study(), &[0.0], &genomes(&[5.0]), &simulated(&[3.0]));
        recorder.finish();
        assert_eq!(recorder.best.as_ref().unwrap().fitness, 4.0);
        assert_eq!(recorder.fitness_source(), FitnessSource::Assumed);
    }

    #[test]
    fn an_interrupted_generation_without_fitness_does_not_count() {
        let mut recorder = Recorder::default();
        recorder.evaluated(&study(), &[0.0], &genomes(&[5.0]), &simulated(&[3.0]));
        recorder.ordered(&genomes(&[5.0]), &[9.0]);
        recorder.evaluated(&study(), &[0.0], &genomes(&[4.0]), &simulated(&[3.0]));
        recorder.finish();
        assert_eq!(recorder.history.generations.len(), 1);
        assert_eq!(recorder.evaluations, 2);
    }
}
