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
mod tests;
