//! A search of a script: the generations that compare the same model with the same measured points.
//!
//! A script may search several times, for each of its data sets or models, one after the other or
//! in one loop: their fitness values are of different functions, so that each search has its own
//! best individual.

use super::fitness::sum_of_squares;
use super::generation::{Generation, Tally, Target};
use super::objective::Objective;
use super::search_record::{Best, SearchRecord};
use super::study::{Compared, Measurement, Study};

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

/// A generation that has ended.
pub(super) struct Ended<'a> {
    pub individuals: &'a [Vec<f64>],
    pub fitness: &'a [f64],
    /// What the script minimizes, by all that was seen.
    pub objective: Objective,
}

/// What a generation may change of a search, as it was before.
#[derive(Debug, Clone)]
pub(super) struct Before {
    best: Option<Best>,
    compared: Option<Vec<Compared>>,
    objective: Option<Objective>,
    tally: Tally,
}

/// What was observed of a search.
#[derive(Debug, Clone, Default)]
pub struct ScriptSearch {
    /// Its generations, its best individual, and its failures.
    pub observed: SearchRecord,
    /// The search ranges: the least minima and the largest maxima of all that were given.
    pub ranges: Option<(Vec<f64>, Vec<f64>)>,
    /// Smallest and largest gene of all individuals that were simulated.
    pub spanned: Option<(Vec<f64>, Vec<f64>)>,
    /// Number of simulations.
    pub evaluations: u64,
    /// Seconds that its generations took.
    pub seconds: f64,
    /// What the user changed during the search, and from which generation on.
    pub changes: Vec<(usize, String)>,
    /// Whether operators of the genetic algorithm make one generation of the other; a script without
    /// them evaluates individuals that it chooses in another way.
    pub evolves: bool,
    /// The seed that its random numbers began with.
    pub seed: Option<[f64; 6]>,
    /// The numbers of its first and its last generation among those of the run.
    pub generations_of_run: [u64; 2],
    /// Everything that the best individual was compared with.
    pub(super) compared: Option<Vec<Compared>>,
    /// What the script minimizes, by all that was seen.
    pub(super) objective: Option<Objective>,
    /// The largest number of an individual of its generations.
    pub(super) last_individual: u64,
    /// What its generations compare.
    pub(super) targets: Vec<Target>,
    /// Individuals of the generation that ended last.
    pub(super) generation_size: usize,
    /// Whether the script makes the parameters that it simulates of other genes.
    pub(super) transforms: bool,
}

impl ScriptSearch {
    /// The best individual so far.
    pub fn best(&self) -> Option<ScriptBest<'_>> {
        let (best, compared) = (self.observed.best.as_ref()?, self.compared.as_ref()?);
        Some(ScriptBest {
            genome: &best.values,
            fitness: best.fitness,
            objective: self.objective.as_ref()?,
            compared,
        })
    }

    /// The models that it simulates, in words.
    pub fn models(&self) -> String {
        let mut names: Vec<&str> = Vec::new();
        for target in &self.targets {
            if !names.contains(&target.study.model.as_str()) {
                names.push(&target.study.model);
            }
        }
        names.join(", ")
    }

    /// What is counted: generations, or evaluations where nothing evolves. Which of them it is shows
    /// in the first generation only.
    pub fn counted(&self) -> &'static str {
        let is_known = self.observed.generations() > 0;
        if is_known && !self.evolves { "evaluation" } else { "generation" }
    }

    /// Whether it simulates this at these points.
    pub fn simulates(&self, study: &Study, x: &[f64]) -> bool {
        self.targets.iter().any(|target| *target.study == *study && target.x == x)
    }

    /// Whether it compares the same, in whatever order.
    pub(super) fn compares(&self, targets: &[Target]) -> bool {
        let contains = |target: &Target| self.targets.contains(target);
        self.targets == targets
            || self.targets.len() == targets.len() && targets.iter().all(contains)
    }

    /// Whether one compares a part of what the other does.
    pub(super) fn shares(&self, targets: &[Target]) -> bool {
        targets.iter().all(|target| self.targets.contains(target))
            || self.targets.iter().all(|own| targets.contains(own))
    }

    /// Which of these targets are its own, in their order; `None` where one is missing.
    pub(super) fn series_among(&self, targets: &[Target]) -> Option<Vec<usize>> {
        let place = |own: &Target| targets.iter().position(|target| target == own);
        self.targets.iter().map(place).collect()
    }

    /// Counts these simulations as well.
    pub(super) fn count(&mut self, tally: &Tally) {
        self.evaluations += tally.simulations;
        self.observed.failures.add(&tally.failures);
    }

    /// Extends what the individuals span.
    pub(super) fn span<'a>(&mut self, genomes: impl Iterator<Item = &'a [f64]>) {
        genomes.for_each(|genome| extend(&mut self.spanned, [genome, genome]));
    }

    /// Extends the search ranges: those of a script that narrows them are all that it has searched.
    pub(super) fn extend_ranges(&mut self, minima: &[f64], maxima: &[f64]) {
        extend(&mut self.ranges, [minima, maxima]);
    }

    /// A generation with these simulations has ended: its best individual may be that of the search.
    pub(super) fn ended(
        &mut self,
        part: &Generation,
        Ended { individuals, fitness, objective }: Ended<'_>,
        measurements: &[Measurement],
    ) {
        self.generation_size = fitness.len();
        self.objective = Some(objective);
        let mut compared = None;
        let counts = |k: usize| {
            let own = part.compared(&part.places(), &individuals[k], measurements);
            compared = Some(own).filter(|own| !own.is_empty());
            compared.is_some()
        };
        if self.observed.generation(fitness, |k| individuals[k].clone(), counts) {
            self.compared = compared;
        }
    }

    /// What the next generation may change.
    pub(super) fn before(&self) -> Before {
        let failures = self.observed.failures.clone();
        Before {
            best: self.observed.best.clone(),
            compared: self.compared.clone(),
            objective: self.objective.clone(),
            tally: Tally { simulations: self.evaluations, failures },
        }
    }

    /// The last generation was none.
    pub(super) fn take_back(&mut self, before: Before) {
        self.observed.take_back(before.best);
        (self.compared, self.objective) = (before.compared, before.objective);
        self.evaluations = before.tally.simulations;
        self.observed.failures = before.tally.failures;
    }
}

fn extend(known: &mut Option<(Vec<f64>, Vec<f64>)>, [minima, maxima]: [&[f64]; 2]) {
    match known {
        Some((low, high)) if low.len() == minima.len() => {
            for k in 0..low.len() {
                (low[k], high[k]) = (low[k].min(minima[k]), high[k].max(maxima[k]));
            }
        }
        _ => *known = Some((minima.to_vec(), maxima.to_vec())),
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
