//! Follows a run of scripts, whatever they are called and whatever their variables: the functions
//! of GAPILib report what they are given and what they answer, and the recorder puts generations,
//! the best individual and the counts together.
//!
//! A generation ends with `Fit_Order`, which gets a population and its fitness; in scripts that
//! sort by themselves it ends when an experiment is simulated again after `Fit` got all its
//! individuals. So a script may evaluate its population in one call or one by one, with several
//! experiments whose results it sums, with its own fitness function or its own sorting. When it has
//! both of its own, the fitness is not known, and individuals are compared by the sum of squares.
//!
//! What a generation has compared, models and measured points, says which search it belongs to.

use super::Simulated;
use super::generation::{self, Generation, Tally, Target};
use super::objective::{Objective, is_informative, recognized};
use super::script_search::{Before, Ended, ScriptSearch};
use super::search_ranges::SearchRanges;
use super::seeds::Seeds;
use super::study::{Measurement, Study};
use crate::ga::{Genomes, has_failed};
use std::sync::Arc;

/// Individuals of generations that may turn out to be parts of one: a population of 100 in the 36
/// experiments of `scripts/humidity` has 3600.
const PROVISIONAL: usize = 10_000;

/// Calls of `Eval` before each of which the seeds are remembered; a search is found to be one when its
/// first generation ends, whose individuals may have been simulated one by one.
const SEEDS: usize = 200;

/// Searches that keep individuals for their figures; a script that repeats a search for thousands of
/// samples would fill the memory with them.
const IN_DETAIL: usize = 64;

/// What was observed of a run.
#[derive(Debug, Clone, Default)]
pub struct Recorder {
    /// Its searches, in the order of their first generations.
    searches: Vec<ScriptSearch>,
    /// The search of the generation that ended last.
    current: usize,
    /// All simulations of the run.
    tally: Tally,
    /// Generations of all searches that have ended.
    generations: u64,
    /// Those that had ended when data were read last.
    generations_before_data: u64,
    /// Seconds since the run began, until the generation that ended last and until now.
    seconds: [f64; 2],
    /// What the user has changed for the generation that ends next.
    changes: Vec<String>,
    /// Whether operators were called since the last generation ended.
    evolves: bool,
    ranges: SearchRanges,
    measurements: Vec<Measurement>,
    seeds: Seeds,
    /// The seeds before the simulations from these numbers on.
    seeds_before: Vec<(u64, Seeds)>,
    /// Individuals simulated in this run and those before it.
    numbered: u64,
    sorted_by_fit_order: bool,
    pending: Generation,
    /// Generations that ended without `Fit_Order`, each with its search as it was before.
    provisional: Vec<(Generation, usize, Before)>,
}

impl Recorder {
    /// Whether data that are read now are of another run: a script that reads its data in each generation
    /// has had one generation with those before.
    pub fn begins_another_run(&self) -> bool {
        self.generations > self.generations_before_data + 1
    }

    /// `Exp_Adq_SISO` has read data.
    pub fn measured(&mut self, measurement: Measurement) {
        self.generations_before_data = self.generations;
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
        self.seeds.drawn(seed, next, site, self.tally.simulations > 0);
    }

    /// It is so late, in seconds since the run began.
    pub fn at(&mut self, seconds: f64) {
        self.seconds[1] = seconds;
    }

    /// All simulations of the run.
    pub fn tally(&self) -> &Tally {
        &self.tally
    }

    /// The search of the generation that ended last.
    pub fn current(&self) -> Option<&ScriptSearch> {
        self.searches.get(self.current)
    }

    /// The search that simulates this at these points; the last one of several.
    pub fn search_simulating(&self, study: &Study, x: &[f64]) -> Option<&ScriptSearch> {
        self.searches.iter().rev().find(|search| search.simulates(study, x))
    }

    /// Whether there is one search at most, so far.
    pub fn is_one_search(&self) -> bool {
        self.searches.len() <= 1
    }

    /// Begins to record another run and returns the searches of the one before, finished.
    pub fn begin_next(&mut self) -> Vec<ScriptSearch> {
        let (seeds, numbered) = (self.seeds.of_next_run(), self.numbered);
        let next = Recorder { seeds, numbered, ..Recorder::default() };
        std::mem::replace(self, next).finished()
    }

    /// `Mutation`, `Refine` or another operator has made individuals with these search ranges, which
    /// are those of the parameters unless the script makes parameters of other genes.
    pub fn searched(&mut self, minima: &[f64], maxima: &[f64], made: &Genomes) {
        self.ranges.given([minima, maxima], made, self.generations);
    }

    /// An operator of the genetic algorithm makes one generation of the other.
    pub fn evolves(&mut self) {
        self.evolves = true;
    }

    /// The user has changed something, from the next generation on.
    pub fn changed(&mut self, what: &str) {
        self.changes.push(what.to_owned());
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
            && self.pending.has_simulated(study, x);
        if ends {
            self.end_pending_generations();
        }
        let first = self.numbered + 1;
        if self.seeds_before.len() >= SEEDS {
            self.seeds_before.remove(0);
        }
        self.seeds_before.push((first, self.seeds.clone()));
        let own =
            self.searches.last().map_or(0, |search| search.observed.history.generations.len());
        if let Some(seed) = self.seeds.goes_on(own) {
            let entries = seed.map(|entry| entry.to_string()).join(", ");
            self.changes.push(format!("seed := {{{entries}}}"));
        }
        self.tally.simulations += genomes.len() as u64;
        for failure in simulated.failures.iter().flatten() {
            self.tally.failures.note(&failure.cause);
        }
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

    /// `Fit_Order` got a population with its fitness: a generation ends.
    pub fn ordered(&mut self, population: &Genomes, fitness: &[f64]) {
        self.evolves = true;
        self.refined(population, fitness);
    }

    /// All individuals of a search have this fitness, such as those of `Refine`: a generation ends.
    pub fn refined(&mut self, population: &Genomes, fitness: &[f64]) {
        self.sorted_by_fit_order = true;
        self.take_back(population);
        if self.pending.is_empty() || population.len() != fitness.len() {
            return;
        }
        let individuals: Vec<Vec<f64>> = population.rows().map(<[f64]>::to_vec).collect();
        let simulated = self.simulated_instead(&individuals, fitness);
        let transforms = simulated.is_some();
        let individuals = simulated.unwrap_or(individuals);
        let place = self.end_sorted(&individuals, fitness);
        if transforms {
            // The ranges so far were those of the genes.
            let search = &mut self.searches[place];
            (search.transforms, search.ranges) = (true, None);
        }
    }

    /// What was simulated in place of these genes, which were not all simulated: a script that makes parameters of
    /// them, such as 10^g, simulates as many individuals, whose sums of squares are the fitness.
    fn simulated_instead(&self, genes: &[Vec<f64>], fitness: &[f64]) -> Option<Vec<Vec<f64>>> {
        let simulated = self.pending.genomes(*self.pending.fresh_places().first()?);
        if simulated.len() != genes.len() || genes.iter().all(|own| simulated.contains(own)) {
            return None;
        }
        let experiments = self.pending.covering(&simulated);
        let sums = self.pending.sums(&experiments, &simulated, &self.measurements);
        (recognized(&sums, fitness) != Objective::Script).then_some(simulated)
    }

    /// The run has ended or was interrupted: ends the generation that is complete; its searches.
    fn finished(mut self) -> Vec<ScriptSearch> {
        let not_shown = self.generations == 0 && !self.pending.has_ratings();
        let complete = self.pending.is_rated() && !self.sorted_by_fit_order;
        if !self.pending.is_empty() && (not_shown || complete) {
            self.end_pending_generations();
        }
        for place in 0..self.searches.len() {
            self.end_interrupted(place);
            let search = &mut self.searches[place];
            search.count(&self.pending.take_tally_of(&search.targets));
        }
        let rest = self.pending.tally();
        if self.searches.is_empty() && rest.simulations > 0 {
            self.searches.push(ScriptSearch::default());
        }
        if let Some(search) = self.searches.get_mut(self.current) {
            search.count(&rest);
            search.evolves |= self.evolves;
        }
        for search in self.searches.iter_mut().filter(|own| own.ranges.is_none() && !own.transforms)
        {
            let Some((low, high)) = search.spanned.clone() else { continue };
            self.ranges.assign(search, [low.as_slice(), high.as_slice()].into_iter());
        }
        // Those that were taken for searches, and were parts of others.
        self.searches.retain(|search| search.evaluations > 0);
        self.searches
    }

    /// The last generation of a search, if the script has ended or was interrupted before `Fit_Order`: as
    /// many individuals as in the one before, and no simulations for another purpose. What a script adds
    /// up is known by `Fit_Order` alone.
    fn end_interrupted(&mut self, place: usize) {
        let search = &self.searches[place];
        let is_sum = search.objective == Some(Objective::SumOfSquares(vec![1.0]));
        let [target] = search.targets.as_slice() else { return };
        if !is_sum || !self.sorted_by_fit_order || target.measured.is_none() {
            return;
        }
        let (last, count) = (search.last_individual, search.generation_size);
        let Some(part) = self.pending.take_rest(target, last, count) else { return };
        self.end_unsorted(&part, place);
    }

    /// At `Fit_Order`: what was taken for generations of a search before, because nothing sorted, were
    /// individuals or experiments of this one.
    fn take_back(&mut self, population: &Genomes) {
        let mut known: Vec<u64> = population.rows().map(generation::key).collect();
        known.sort_unstable();
        let mut kept: Vec<usize> = Vec::new();
        for number in (0..self.provisional.len()).rev() {
            let (part, place, _) = &self.provisional[number];
            if kept.contains(place) {
                continue;
            }
            if !part.is_part_of(&known) {
                kept.push(*place);
                continue;
            }
            let (mut whole, place, before) = self.provisional.remove(number);
            whole.append(std::mem::take(&mut self.pending));
            self.pending = whole;
            self.searches[place].take_back(before);
            self.generations -= 1;
        }
    }

    /// Generations that the script has not sorted, of one search or several: the sum over the series of
    /// each.
    fn end_pending_generations(&mut self) {
        let groups = self.pending.groups();
        let mut parts: Vec<Generation> = Vec::new();
        for (number, group) in groups.iter().enumerate() {
            // Each that was taken out leaves the places of the others less.
            let earlier = groups[..number].iter().flatten();
            let earlier: Vec<usize> = earlier.copied().collect();
            let now = |place: &usize| place - earlier.iter().filter(|gone| *gone < place).count();
            let places: Vec<usize> = group.iter().map(now).collect();
            parts.push(self.pending.take(&places, None));
        }
        self.pending.clear();
        let evolves = std::mem::take(&mut self.evolves);
        for part in parts {
            let targets = part.targets(&part.places(), &self.measurements);
            let known = self.searches.iter().rposition(|search| search.compares(&targets));
            let place = known.unwrap_or_else(|| self.begin_search(&targets, &part));
            let before = self.searches[place].before();
            self.evolves = evolves;
            if self.end_unsorted(&part, place) && !self.sorted_by_fit_order {
                self.provisional.push((part, place, before));
            }
        }
        while self.provisional.iter().map(|(part, ..)| part.size()).sum::<usize>() > PROVISIONAL {
            self.provisional.remove(0);
        }
    }

    /// A generation that the script has not sorted; whether it is one: its measured values may be unknown.
    fn end_unsorted(&mut self, part: &Generation, place: usize) -> bool {
        let experiments = part.places();
        let individuals = part.genomes(0);
        let sums = part.sums(&experiments, &individuals, &self.measurements);
        let total = |sums: &Vec<f64>| if sums.is_empty() { f64::NAN } else { sums.iter().sum() };
        let mut fitness: Vec<f64> = sums.iter().map(total).collect();
        if fitness.iter().all(|fitness| fitness.is_nan()) {
            self.pending.count(&part.tally());
            return false;
        }
        for value in fitness.iter_mut().filter(|value| has_failed(**value)) {
            *value = crate::ga::FAILED_FITNESS;
        }
        let objective = match part.is_compared() && experiments.len() == 1 {
            true => Objective::SumOfSquares(vec![1.0]),
            false => Objective::Assumed,
        };
        let known = self.searches[place].objective.as_ref();
        let objective = objective.agreeing(known);
        let ended = Ended { individuals: &individuals, fitness: &fitness, objective };
        self.end_generation(place, part, ended);
        true
    }

    /// A generation that `Fit_Order` got; the place of its search.
    fn end_sorted(&mut self, individuals: &[Vec<f64>], fitness: &[f64]) -> usize {
        let covering = self.pending.covering(individuals);
        let is_known = !covering.is_empty();
        let experiments = if is_known { covering } else { self.pending.fresh_places() };
        let sums = self.pending.sums(&experiments, individuals, &self.measurements);
        let (place, own, objective) = self.search_of(experiments, (&sums, fitness));
        let part = self.pending.take(&own, is_known.then_some(individuals));
        self.pending.leave(individuals);
        let place = place.unwrap_or_else(|| {
            let targets = part.targets(&part.places(), &self.measurements);
            self.begin_search(&targets, &part)
        });
        self.end_generation(place, &part, Ended { individuals, fitness, objective });
        place
    }

    /// The search that a generation belongs to, if there is one, the experiments that are of it, and what
    /// the script minimizes by all that was seen: experiments that do not count in the fitness may be
    /// those of another search, or checks, and other weights make another function.
    fn search_of(
        &self,
        experiments: Vec<usize>,
        (sums, fitness): (&[Vec<f64>], &[f64]),
    ) -> (Option<usize>, Vec<usize>, Objective) {
        let all = self.pending.targets(&experiments, &self.measurements);
        let explaining = self.searches.iter().enumerate().rev().find_map(|(place, search)| {
            let series = search.series_among(&all)?;
            let own: Vec<Vec<f64>> = sums
                .iter()
                .map(|sums| series.iter().filter_map(|&k| sums.get(k)).copied().collect())
                .collect();
            let objective = search.objective.clone().filter(|own| own.is_function_of_sums())?;
            objective.explains(&own, fitness).then_some((place, series, objective))
        });
        if let Some((place, series, objective)) = explaining {
            return (Some(place), series.iter().map(|&k| experiments[k]).collect(), objective);
        }
        let objective = recognized(sums, fitness);
        let known = |is_it: &dyn Fn(&ScriptSearch) -> bool| self.searches.iter().rposition(is_it);
        let Some(weights) = objective.weights(all.len()) else {
            // Penalties, or a function of the script's own.
            let place = known(&|search| search.compares(&all));
            let place = place.or_else(|| known(&|search| search.shares(&all)));
            let says_nothing = !is_informative(sums, fitness);
            let before = place.and_then(|place| self.searches[place].objective.clone());
            let objective = before.filter(|_| says_nothing).unwrap_or(objective);
            return (place, experiments, objective);
        };
        let is_unknown = |search: &ScriptSearch| search.objective == Some(Objective::Script);
        if let Some(place) = known(&|search| is_unknown(search) && search.compares(&all)) {
            return (Some(place), experiments, Objective::Script);
        }
        let series: Vec<usize> = (0..all.len()).filter(|&k| weights[k] != 0.0).collect();
        let used: Vec<Target> = series.iter().map(|&k| all[k].clone()).collect();
        let own = series.iter().map(|&k| experiments[k]).collect();
        if let Some(place) = known(&|search| is_unknown(search) && search.compares(&used)) {
            return (Some(place), own, Objective::Script);
        }
        // All that was taken for generations of it were parts of this one.
        let place = known(&|search| search.objective.is_none() && search.compares(&used));
        (place, own, objective.of_series(&series))
    }

    /// A search begins, with this generation.
    fn begin_search(&mut self, targets: &[Target], part: &Generation) -> usize {
        let [first, _] = part.numbers();
        let before = self.seeds_before.iter().rev().find(|(number, _)| *number <= first);
        if let Some((_, before)) = before.filter(|_| !self.searches.is_empty()) {
            self.seeds = before.of_next_search(&self.seeds);
            self.changes.clear();
        }
        if let Some(old) = self.searches.len().checked_sub(IN_DETAIL) {
            self.searches[old].observed.kept = Vec::new();
        }
        self.searches.push(ScriptSearch {
            targets: targets.to_vec(),
            generations_of_run: [self.generations + 1, 0],
            ..ScriptSearch::default()
        });
        self.searches.len() - 1
    }

    /// A generation of a search ends.
    fn end_generation(&mut self, place: usize, part: &Generation, ended: Ended<'_>) {
        self.generations += 1;
        self.current = place;
        if self.pending.is_empty() {
            self.seeds_before.clear();
        }
        let is_last = place + 1 == self.searches.len();
        let search = &mut self.searches[place];
        let number = search.observed.history.generations.len() + 1;
        search.changes.extend(self.changes.drain(..).map(|what| (number, what)));
        if is_last {
            search.seed = self.seeds.seed;
        }
        search.last_individual = search.last_individual.max(part.numbers()[1]);
        search.generations_of_run[1] = self.generations;
        search.seconds += self.seconds[1] - self.seconds[0];
        self.seconds[0] = self.seconds[1];
        search.evolves |= std::mem::take(&mut self.evolves);
        search.count(&part.tally());
        search.span(part.all_genomes());
        if !search.transforms {
            self.ranges.assign(search, ended.individuals.iter().map(Vec::as_slice));
        }
        search.ended(part, ended, &self.measurements);
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
            changes: 0,
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

    /// The only search of a run that has ended.
    fn ended(recorder: Recorder) -> ScriptSearch {
        let mut all = recorder.finished();
        assert_eq!(all.len(), 1);
        all.pop().unwrap()
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
        let search = ended(recorder);
        assert_eq!(search.observed.history.generations.len(), 2);
        assert_eq!(search.observed.history.generations[1].failures, 1);
        assert_eq!((search.evaluations, search.observed.failures.count), (6, 2));
        assert_eq!(search.observed.failures.causes["log of -1"], 2);
        let best = search.best().unwrap();
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
            recorder.searched(&[-3.0], &[3.0], &genomes(&[0.0, 1.0, 2.0]));
            assert_eq!(
                recorder.current().unwrap().observed.history.generations.len(),
                generation + 1
            );
        }
        let search = ended(recorder);
        let best = search.best().unwrap();
        assert_eq!((best.genome[0], best.fitness), (1.0, 1.0));
        assert_eq!(best.objective, &Objective::SumOfSquares(vec![1.0]));
        assert_eq!((&search.ranges, &search.spanned), (&None, &Some((vec![1.0], vec![100.0]))));
    }

    #[test]
    fn genes_that_explain_no_fitness_are_not_exchanged() {
        let mut recorder = Recorder::default();
        let first =
            recorder.evaluated(&study(), &[0.0], &genomes(&[1.0, 10.0]), &simulated(&[1.0, 10.0]));
        recorder.rated(first..first + 2, &[0.0]);
        recorder.ordered(&genomes(&[0.0, 1.0]), &[5.0, 7.0]);
        assert!(ended(recorder).best().is_none());
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
        let search = ended(recorder);
        assert_eq!(search.observed.history.generations.len(), 2);
        assert_eq!(search.best().unwrap().fitness, 0.0);
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
        let before = recorder.begin_next().pop().unwrap();
        assert_eq!((before.seed, before.evaluations), (Some(seed(1.0)), 1));
        recorder.seeded(seed(8.0), seed(10.0), 1);
        assert_eq!((recorder.seeds.seed, recorder.tally.simulations), (Some(seed(7.0)), 0));
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
        assert!(recorder.generations == 0);
        recorder.rated([1], &[3.0]);
        let search = ended(recorder);
        let best = search.best().unwrap();
        assert_eq!((best.genome[0], best.fitness, best.compared[0].simulated[0]), (3.0, 0.0, 3.0));
        assert_eq!(search.observed.history.generations.len(), 1);
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
        let search = ended(recorder);
        let best = search.best().unwrap();
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
        recorder.begin_next();
        let later = recorder.evaluated(&study(), &[0.0], &genomes(&[1.0]), &simulated(&[1.0]));
        assert_eq!(later, 5, "no number comes twice");
    }

    fn second() -> Arc<Study> {
        Arc::new(Study { model: "M2".to_owned(), ..(*study()).clone() })
    }

    /// Two experiments a generation, whose sums the script adds; `total` is what it adds up.
    fn two_experiments(total: fn(f64, f64) -> f64) -> ScriptSearch {
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
        ended(recorder)
    }

    #[test]
    fn a_generation_with_several_experiments_is_one() {
        let search = two_experiments(|a, b| a + b);
        assert_eq!((search.observed.history.generations.len(), search.evaluations), (3, 30));
        assert_eq!(search.observed.history.generations[0].best, 1.0, "not a partial sum");
        let best = search.best().unwrap();
        assert_eq!((best.genome[0], best.fitness), (4.0, 1.0));
        assert_eq!(best.objective, &Objective::SumOfSquares(vec![1.0, 1.0]));
        let models: Vec<&str> = best.compared.iter().map(|c| c.study.model.as_str()).collect();
        assert_eq!((models, best.sum_of_squares()), (vec!["M", "M2"], Some(1.0)));
    }

    #[test]
    fn the_weights_of_the_script_are_found() {
        let search = two_experiments(|a, b| a + 0.25 * b);
        let best = search.best().unwrap();
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
        let search = ended(recorder);
        assert_eq!(search.observed.history.generations.len(), 1);
        assert_eq!(search.best().unwrap().fitness, 9.0);
        assert_eq!(search.best().unwrap().compared[0].measured, Some(vec![0.0]));
    }

    #[test]
    fn own_sorting_ends_a_generation_with_the_next_simulation() {
        let mut recorder = Recorder::default();
        for value in [3.0, 2.0] {
            let one =
                recorder.evaluated(&study(), &[0.0], &genomes(&[value]), &simulated(&[value]));
            recorder.rated([one], &[0.0]);
        }
        assert_eq!(recorder.current().unwrap().observed.history.generations.len(), 1);
        let search = ended(recorder);
        assert_eq!(search.observed.history.generations.len(), 2);
        assert_eq!(search.best().unwrap().genome, [2.0]);
    }

    #[test]
    fn own_fitness_is_taken_from_fit_order() {
        let mut recorder = Recorder::default();
        recorder.evaluated(&study(), &[0.0], &genomes(&[5.0]), &simulated(&[7.0]));
        recorder.ordered(&genomes(&[5.0]), &[42.0]);
        let search = ended(recorder);
        assert_eq!(search.best().unwrap().fitness, 42.0);
        assert_eq!(search.best().unwrap().objective, &Objective::Script);
    }

    #[test]
    fn with_own_fitness_and_own_sorting_the_sum_of_squares_is_assumed() {
        let mut recorder = Recorder::default();
        recorder.measured(Measurement { file: "d.mat".into(), x: vec![0.0], y: vec![1.0] });
        recorder.evaluated(&study(), &[0.0], &genomes(&[5.0]), &simulated(&[3.0]));
        let search = ended(recorder);
        assert_eq!(search.best().unwrap().fitness, 4.0);
        assert_eq!(search.best().unwrap().objective, &Objective::Assumed);
    }

    #[test]
    fn an_interrupted_generation_without_fitness_does_not_count() {
        let mut recorder = Recorder::default();
        recorder.evaluated(&study(), &[0.0], &genomes(&[5.0]), &simulated(&[3.0]));
        recorder.ordered(&genomes(&[5.0]), &[9.0]);
        recorder.evaluated(&study(), &[0.0], &genomes(&[4.0]), &simulated(&[3.0]));
        let search = ended(recorder);
        assert_eq!(search.observed.history.generations.len(), 1);
        assert_eq!(search.evaluations, 2);
    }

    /// One generation of a search: individuals whose simulations are their genes.
    fn generation_of(recorder: &mut Recorder, study: &Arc<Study>, genes: &[f64], measured: f64) {
        let population = genomes(genes);
        let first = recorder.evaluated(study, &[0.0], &population, &simulated(genes));
        recorder.rated(first..first + genes.len() as u64, &[measured]);
        let fitness: Vec<f64> = genes.iter().map(|gene| (gene - measured).powi(2)).collect();
        recorder.ordered(&population, &fitness);
    }

    /// Genes of the best individual, its fitness, generations and simulations of each search.
    fn found(recorder: Recorder) -> Vec<(f64, f64, u64, u64)> {
        let one = |search: &ScriptSearch| {
            let best = search.best().unwrap();
            (best.genome[0], best.fitness, search.observed.generations(), search.evaluations)
        };
        recorder.finished().iter().map(one).collect()
    }

    /// The first search fits better: its best individual is none of the second.
    #[test]
    fn other_measured_values_are_another_search() {
        let mut recorder = Recorder::default();
        for generation in [0.0, 0.5] {
            generation_of(&mut recorder, &study(), &[3.0 - generation, 5.0, 4.0], 2.0);
        }
        for generation in [0.0, 0.5, 1.0] {
            generation_of(&mut recorder, &study(), &[3.0, 1.0, 4.0 + generation], 9.0);
        }
        assert_eq!(found(recorder), [(2.5, 0.25, 2, 6), (5.0, 16.0, 3, 9)]);
    }

    #[test]
    fn searches_may_alternate_in_one_loop() {
        let mut recorder = Recorder::default();
        for generation in [0.0, 1.0] {
            generation_of(&mut recorder, &study(), &[3.0 - generation, 5.0], 1.0);
            recorder.searched(&[0.0], &[9.0], &genomes(&[2.0, 5.0]));
            generation_of(&mut recorder, &second(), &[30.0 - generation, 50.0, 60.0], 20.0);
            recorder.searched(&[0.0], &[90.0], &genomes(&[29.0, 50.0, 60.0]));
        }
        let searches = recorder.clone().finished();
        assert_eq!(found(recorder), [(2.0, 1.0, 2, 4), (29.0, 81.0, 2, 6)]);
        let ranges = |k: usize| searches[k].ranges.as_ref().unwrap().1[0];
        assert_eq!((ranges(0), ranges(1)), (9.0, 90.0));
    }

    /// Both populations are simulated and compared before either is sorted; at first they are the same.
    #[test]
    fn searches_may_be_sorted_after_both_were_compared() {
        let mut recorder = Recorder::default();
        let fitness = |genes: &[f64], measured: f64| -> Vec<f64> {
            genes.iter().map(|gene| (gene - measured).powi(2)).collect()
        };
        for generation in 0..3 {
            let one = [1.0, 2.0, 3.0, 4.0, 5.0 + f64::from(generation)];
            let other = if generation == 0 { one } else { [6.0, 7.0, 8.0, 9.0, 10.5] };
            let all = |first: u64| first..first + 5;
            let first = recorder.evaluated(&study(), &[0.0], &genomes(&one), &simulated(&one));
            recorder.rated(all(first), &[2.5]);
            let first = recorder.evaluated(&second(), &[0.0], &genomes(&other), &simulated(&other));
            recorder.rated(all(first), &[20.5]);
            recorder.ordered(&genomes(&one), &fitness(&one, 2.5));
            recorder.ordered(&genomes(&other), &fitness(&other, 20.5));
        }
        assert_eq!(found(recorder), [(2.0, 0.25, 3, 15), (10.5, 100.0, 3, 15)]);
    }

    /// The values of two models, compared by hand.
    #[test]
    fn models_that_are_simulated_once_each_are_two_searches() {
        for others in [[7.0, 8.0], [2.0, 1.0]] {
            let mut recorder = Recorder::default();
            for (study, genes) in [(study(), [1.0, 2.0]), (second(), others)] {
                let first =
                    recorder.evaluated(&study, &[0.0], &genomes(&genes), &simulated(&genes));
                recorder.rated(first..first + 2, &[4.0]);
            }
            let other = (others[0], (others[0] - 4.0).powi(2), 1, 2);
            assert_eq!(found(recorder), [(2.0, 4.0, 1, 2), other]);
        }
    }

    /// The whole population is compared with data that do not count in its fitness, in some generations.
    #[test]
    fn data_that_do_not_count_are_no_search() {
        let mut recorder = Recorder::default();
        let genes = [1.0, 2.0, 3.0, 4.0, 5.0];
        for generation in 0..4 {
            if generation % 2 == 1 {
                let first =
                    recorder.evaluated(&study(), &[7.0], &genomes(&genes), &simulated(&genes));
                recorder.rated(first..first + 5, &[8.5]);
            }
            generation_of(&mut recorder, &study(), &genes, 2.5);
        }
        assert_eq!(found(recorder), [(2.0, 0.25, 4, 30)]);
    }

    /// The second begins with another seed, which is none that the first continued with.
    #[test]
    fn each_search_has_the_seed_that_it_began_with() {
        let seed = |entry: f64| [entry; 6];
        let mut recorder = Recorder::default();
        for (measured, first) in [(2.0, 10.0), (9.0, 70.0)] {
            recorder.seeded(seed(first), seed(first + 1.0), 1);
            for generation in 1..=3 {
                generation_of(&mut recorder, &study(), &[3.0, 1.0, 4.0], measured);
                let state = first + f64::from(generation);
                recorder.seeded(seed(state), seed(state + 1.0), 2);
            }
        }
        let searches = recorder.finished();
        let seeds: Vec<_> = searches.iter().map(|search| search.seed).collect();
        assert_eq!(seeds, [Some(seed(10.0)), Some(seed(70.0))]);
        assert!(searches.iter().all(|search| search.changes.is_empty()));
    }

    /// Simulates and compares a population with these measured values.
    fn compare(recorder: &mut Recorder, genes: &[f64], measured: f64) {
        let first = recorder.evaluated(&study(), &[0.0], &genomes(genes), &simulated(genes));
        recorder.rated(first..first + genes.len() as u64, &[measured]);
    }

    fn sort(recorder: &mut Recorder, genes: &[f64], fitness: impl Fn(f64) -> f64) {
        let fitness: Vec<f64> = genes.iter().map(|gene| fitness(*gene)).collect();
        recorder.ordered(&genomes(genes), &fitness);
    }

    fn square(measured: f64) -> impl Fn(f64) -> f64 {
        move |gene| (gene - measured).powi(2)
    }

    /// The same model at the same points, with other measured values; the first populations are the same.
    #[test]
    fn data_sets_may_be_sorted_after_both_were_compared() {
        let mut recorder = Recorder::default();
        for generation in 0..3 {
            let one = [1.0, 2.0, 3.0, 4.0, 5.0 + f64::from(generation)];
            let other = if generation == 0 { one } else { [6.0, 7.0, 2.0, 9.0, 10.5] };
            compare(&mut recorder, &one, 2.25);
            compare(&mut recorder, &other, 20.5);
            sort(&mut recorder, &one, square(2.25));
            sort(&mut recorder, &other, square(20.5));
        }
        assert_eq!(found(recorder), [(2.0, 0.0625, 3, 15), (10.5, 100.0, 3, 15)]);
    }

    /// Evaluated before the loop and after each mutation, so that the last generation is not sorted.
    #[test]
    fn populations_that_wait_are_sorted_by_their_searches() {
        let mut recorder = Recorder::default();
        let one = |k: i32| [1.0, 2.0, 3.0, 5.0 - f64::from(k)];
        let other = |k: i32| [6.0, 7.0, 8.0 + f64::from(k)];
        compare(&mut recorder, &one(0), 2.25);
        compare(&mut recorder, &other(0), 20.5);
        for k in 0..3 {
            sort(&mut recorder, &one(k), square(2.25));
            compare(&mut recorder, &one(k + 1), 2.25);
            sort(&mut recorder, &other(k), square(20.5));
            compare(&mut recorder, &other(k + 1), 20.5);
        }
        assert_eq!(found(recorder), [(2.0, 0.0625, 4, 16), (11.0, 90.25, 4, 12)]);
    }

    #[test]
    fn individuals_of_two_searches_may_be_simulated_one_by_one() {
        let mut recorder = Recorder::default();
        for k in 0..3 {
            let one = [1.0, 2.0, 3.0 + f64::from(k)];
            let other = [6.0, 7.0, 8.0 + f64::from(k)];
            for (a, b) in one.into_iter().zip(other) {
                compare(&mut recorder, &[a], 2.25);
                compare(&mut recorder, &[b], 20.5);
            }
            sort(&mut recorder, &one, square(2.25));
            sort(&mut recorder, &other, square(20.5));
        }
        assert_eq!(found(recorder), [(2.0, 0.0625, 3, 9), (10.0, 110.25, 3, 9)]);
    }

    #[test]
    fn islands_are_one_search() {
        let mut recorder = Recorder::default();
        for k in 0..3 {
            let one = [1.0, 5.0, 6.0];
            let other = if k == 0 { one } else { [2.0, 7.0, 8.0] };
            compare(&mut recorder, &one, 2.25);
            compare(&mut recorder, &other, 2.25);
            sort(&mut recorder, &one, square(2.25));
            sort(&mut recorder, &other, square(2.25));
        }
        assert_eq!(found(recorder), [(2.0, 0.0625, 6, 18)]);
    }

    #[test]
    fn other_weights_are_another_function() {
        let mut recorder = Recorder::default();
        for generation in 0..4 {
            let genes = [1.0, 2.0, 3.0, 4.0 + f64::from(generation)];
            compare(&mut recorder, &genes, 2.25);
            let weight = if generation < 2 { 1.0 } else { 10.0 };
            sort(&mut recorder, &genes, |gene| weight * (gene - 2.25).powi(2));
        }
        assert_eq!(found(recorder), [(2.0, 0.0625, 2, 8), (2.0, 0.625, 2, 8)]);
    }

    /// Some individuals of later generations have a penalty: the script minimizes something else than a sum
    /// of squares.
    #[test]
    fn a_penalty_makes_a_function_of_the_script() {
        let mut recorder = Recorder::default();
        for generation in 0..4 {
            let genes = [1.0, 2.0, 3.0, 4.0, 5.0];
            compare(&mut recorder, &genes, 2.25);
            let penalty = |gene: f64| if generation > 1 { (gene - 2.5).max(0.0) } else { 0.0 };
            sort(&mut recorder, &genes, |gene| (gene - 2.25).powi(2) + penalty(gene));
        }
        let search = ended(recorder);
        assert_eq!(search.best().unwrap().objective, &Objective::Script);
    }

    /// A script that narrows its ranges has searched in all of them.
    #[test]
    fn ranges_are_those_of_all_generations() {
        let mut recorder = Recorder::default();
        for generation in 0..4 {
            let genes = [1.0, 2.0, 3.0, 4.0];
            generation_of(&mut recorder, &study(), &genes, 2.25);
            let end = 9.0 - f64::from(generation);
            recorder.searched(&[1.0 / end], &[end], &genomes(&genes));
        }
        assert_eq!(ended(recorder).ranges, Some((vec![1.0 / 9.0], vec![9.0])));
    }
}
