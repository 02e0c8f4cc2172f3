//! The individuals simulated since their searches ended a generation, by what they are compared with.
//!
//! Every individual that `Eval` simulates has a number, which its row carries as a mark to `Fit`,
//! whatever order the script calls in and however it puts the rows together. Rows that a script copies
//! element by element carry none: they are those of the individuals with all of these numbers.

use super::Simulated;
use super::fitness::sum_of_squares;
use super::search_record::Failures;
use super::study::{Compared, Measurement, Study};
use crate::ga::Genomes;
use rustc_hash::{FxHashMap, FxHashSet, FxHasher};
use std::hash::Hasher as _;
use std::sync::Arc;

/// Generations that end without an individual before it is forgotten: a script may simulate the
/// populations of as many searches before it sorts the first.
const WAITS: u32 = 40;
/// Individuals that wait. Those of ten models with populations of 1000 are as many.
const WAITING: usize = 10_000;

/// Simulations of one generation.
#[derive(Debug, Clone, Default)]
pub struct Generation {
    experiments: Vec<Simulations>,
    /// Those that belong to no generation any more.
    loose: Tally,
}

/// How many simulations there were, and which of them failed.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Tally {
    /// Their number.
    pub simulations: u64,
    /// Those that failed.
    pub failures: Failures,
}

impl Tally {
    /// Counts those of another part as well.
    pub(crate) fn add(&mut self, others: &Tally) {
        self.simulations += others.simulations;
        self.failures.add(&others.failures);
    }
}

/// What a search compares: a model with its variables, and the measured points.
#[derive(Debug, Clone, PartialEq)]
pub struct Target {
    /// What is simulated.
    pub study: Arc<Study>,
    /// The measured X.
    pub x: Vec<f64>,
    /// The measured Y; `None` where the script has not shown it.
    pub measured: Option<Vec<f64>>,
}

/// Simulations of one model at the same points, which `Fit` has compared with the same measured
/// values, or with none so far.
#[derive(Debug, Clone)]
struct Simulations {
    target: Target,
    /// With ascending numbers.
    individuals: Vec<Individual>,
}

#[derive(Debug, Clone)]
struct Individual {
    number: u64,
    genome: Vec<f64>,
    row: Vec<f64>,
    /// Why the simulation failed.
    cause: Option<String>,
    /// Whether it is counted elsewhere: `Fit` has compared it with several series.
    is_copy: bool,
    /// Generations that have ended since without it.
    waited: u32,
}

/// A series that individuals are compared with.
struct Series<'a> {
    simulations: &'a Simulations,
    measured: Option<&'a [f64]>,
    file: Option<&'a str>,
}

impl Generation {
    pub fn is_empty(&self) -> bool {
        self.experiments.is_empty()
    }

    /// Forgets all individuals.
    pub fn clear(&mut self) {
        self.drop_where(|_| true);
    }

    /// All that was simulated here.
    pub fn tally(&self) -> Tally {
        let mut all = self.loose.clone();
        self.experiments.iter().for_each(|own| all.add(&own.tally()));
        all
    }

    /// Takes the simulations that are of one of these targets out of the count.
    pub fn take_tally_of(&mut self, targets: &[Target]) -> Tally {
        let mut all = Tally::default();
        for own in self.experiments.iter_mut().filter(|own| targets.contains(&own.target)) {
            all.add(&own.tally());
            own.individuals.clear();
        }
        self.experiments.retain(|own| !own.individuals.is_empty());
        all
    }

    /// The generation that these experiments make, taken out of this one, with what belongs to none:
    /// of each experiment as many individuals as there are in the population, all where it is not
    /// known.
    pub fn take(&mut self, experiments: &[usize], population: Option<&[Vec<f64>]>) -> Generation {
        let mut own =
            Generation { loose: std::mem::take(&mut self.loose), ..Generation::default() };
        for &place in experiments {
            let known = &mut self.experiments[place];
            let mut left = population.map(counts);
            let taken = known.individuals.extract_if(.., |one| match &mut left {
                None => true,
                Some(left) => left
                    .get_mut(&key(&one.genome))
                    .is_some_and(|count| *count > 0 && std::mem::replace(count, *count - 1) > 0),
            });
            let individuals = taken.collect();
            own.experiments.push(Simulations { target: known.target.clone(), individuals });
        }
        self.experiments.retain(|own| !own.individuals.is_empty());
        own
    }

    /// A generation of these individuals has ended. What was simulated of some of them was a check;
    /// the rest may be of another search.
    pub fn leave(&mut self, individuals: &[Vec<f64>]) {
        let known: FxHashSet<u64> = individuals.iter().map(|genome| key(genome)).collect();
        let is_check = |own: &Simulations| {
            own.individuals.len() < individuals.len()
                && own.individuals.iter().all(|one| known.contains(&key(&one.genome)))
        };
        let checks = self.experiments.extract_if(.., |own| is_check(own));
        checks.for_each(|own| self.loose.add(&own.tally()));
        for own in &mut self.experiments {
            own.individuals.iter_mut().for_each(|one| one.waited += 1);
        }
        for waits in (1..=WAITS).rev() {
            self.drop_where(|one| one.waited > waits);
            if self.size() <= WAITING {
                break;
            }
        }
    }

    fn drop_where(&mut self, is_dropped: impl Fn(&Individual) -> bool) {
        for own in &mut self.experiments {
            let dropped: Vec<Individual> =
                own.individuals.extract_if(.., |one| is_dropped(one)).collect();
            self.loose.add(&tally(&dropped));
        }
        self.experiments.retain(|own| !own.individuals.is_empty());
    }

    /// Where the experiments are of which something was simulated since the last generation ended.
    pub fn fresh_places(&self) -> Vec<usize> {
        let places = self.experiments.iter().enumerate();
        places.filter(|(_, own)| own.is_fresh()).map(|(place, _)| place).collect()
    }

    /// Groups of experiments whose sums of squares a script may add up: those with the same individuals,
    /// unless they compare the same points with another model. An experiment that simulated some of the
    /// individuals of an earlier group was a check of it and is in none.
    pub fn groups(&self) -> Vec<Vec<usize>> {
        let mut groups: Vec<(Vec<u64>, Vec<usize>)> = Vec::new();
        for place in self.fresh_places() {
            let own = &self.experiments[place];
            let keys = own.sorted_keys();
            let replaces = |known: &&usize| own.replaces(&self.experiments[**known]);
            let is_another = groups.iter().flat_map(|(_, places)| places).any(|k| replaces(&k));
            let same = groups
                .iter()
                .position(|(known, places)| *known == keys && !places.iter().any(|k| replaces(&k)));
            let is_part = |(known, _): &(Vec<u64>, Vec<usize>)| {
                keys.iter().all(|key| known.binary_search(key).is_ok())
            };
            match same {
                Some(same) => groups[same].1.push(place),
                None if !is_another && groups.iter().any(is_part) => (),
                None => groups.push((keys, vec![place])),
            }
        }
        groups.into_iter().map(|(_, places)| places).collect()
    }

    /// Number of individuals of all experiments.
    pub fn size(&self) -> usize {
        self.experiments.iter().map(|own| own.individuals.len()).sum()
    }

    /// Adds what `Eval` has simulated; the individuals have the numbers from `first` on.
    pub fn add(
        &mut self,
        (study, x): (&Arc<Study>, &[f64]),
        genomes: &Genomes,
        simulated: &Simulated,
        first: u64,
    ) {
        let target = Target { study: study.clone(), x: x.to_vec(), measured: None };
        let rows = simulated.rows.chunks(x.len().max(1)).map(<[f64]>::to_vec);
        let cause = |k: usize| {
            let failed = simulated.failures.get(k)?.as_ref()?;
            Some(failed.cause.to_string())
        };
        let one = |(k, (genome, row)): (usize, (&[f64], Vec<f64>))| Individual {
            number: first + k as u64,
            genome: genome.to_vec(),
            row,
            cause: cause(k),
            is_copy: false,
            waited: 0,
        };
        let individuals = genomes.rows().zip(rows).enumerate().map(one).collect();
        self.put(target, individuals);
    }

    /// Adds individuals of a target, those that are not there yet.
    fn put(&mut self, target: Target, individuals: Vec<Individual>) {
        let known = self.experiments.iter().position(|own| own.target == target);
        let place = known.unwrap_or_else(|| {
            self.experiments.push(Simulations { target, individuals: Vec::new() });
            self.experiments.len() - 1
        });
        let own = &mut self.experiments[place].individuals;
        let last = own.last().map_or(0, |last| last.number);
        let ascends = individuals.first().is_none_or(|first| first.number > last);
        own.extend(individuals);
        if !ascends {
            own.sort_by_key(|one| one.number);
            own.dedup_by_key(|one| one.number);
        }
    }

    /// Adds the simulations of another one.
    pub fn append(&mut self, other: Generation) {
        self.loose.add(&other.loose);
        for more in other.experiments {
            self.put(more.target, more.individuals);
        }
    }

    /// The numbers of the individuals whose rows have the bits of this one.
    pub fn equal_to(&self, row: &[f64]) -> Vec<u64> {
        let all = self.experiments.iter().flat_map(|own| &own.individuals);
        let mut numbers: Vec<u64> =
            all.filter(|one| same_bits(&one.row, row)).map(|one| one.number).collect();
        numbers.sort_unstable();
        numbers.dedup();
        numbers
    }

    /// `Fit` has compared the individuals with these numbers with `measured`.
    pub fn rate(&mut self, numbers: impl Iterator<Item = u64>, measured: &[f64]) {
        let numbers: FxHashSet<u64> = numbers.collect();
        let mut rated: Vec<(Target, Vec<Individual>)> = Vec::new();
        for own in &mut self.experiments {
            let is_rated = |one: &Individual| numbers.contains(&one.number);
            let individuals: Vec<Individual> = match &own.target.measured {
                None => own.individuals.extract_if(.., |one| is_rated(one)).collect(),
                Some(known) if known == measured => continue,
                Some(_) => {
                    let all = own.individuals.iter().filter(|one| is_rated(one));
                    all.map(|one| Individual { is_copy: true, ..one.clone() }).collect()
                }
            };
            if !individuals.is_empty() {
                let measured = Some(measured.to_vec());
                rated.push((Target { measured, ..own.target.clone() }, individuals));
            }
        }
        self.experiments.retain(|own| !own.individuals.is_empty());
        rated.into_iter().for_each(|(target, individuals)| self.put(target, individuals));
    }

    /// Whether individuals were simulated since the last generation ended, and `Fit` got all of them.
    pub fn is_rated(&self) -> bool {
        let mut fresh = self.experiments.iter().filter(|own| own.is_fresh()).peekable();
        fresh.peek().is_some() && fresh.all(|own| own.target.measured.is_some())
    }

    /// Whether `Fit` got any of them.
    pub(crate) fn has_ratings(&self) -> bool {
        self.experiments.iter().any(|own| own.is_fresh() && own.target.measured.is_some())
    }

    /// Whether `Fit` got all of its individuals.
    pub fn is_compared(&self) -> bool {
        self.experiments.iter().all(|own| own.target.measured.is_some())
    }

    /// Whether this experiment has been simulated.
    pub(crate) fn has_simulated(&self, study: &Study, x: &[f64]) -> bool {
        self.experiments.iter().any(|own| own.is_fresh() && own.is_of(study, x))
    }

    /// The individuals compared with this that have larger numbers than `last`, as a generation of
    /// their own, where they are so many.
    pub fn take_rest(&mut self, target: &Target, last: u64, count: usize) -> Option<Generation> {
        let own = self.experiments.iter_mut().find(|own| own.target == *target)?;
        let is_later = |one: &Individual| one.number > last;
        if own.individuals.iter().filter(|one| is_later(one)).count() != count {
            return None;
        }
        let individuals = own.individuals.extract_if(.., |one| is_later(one)).collect();
        let rest = Simulations { target: target.clone(), individuals };
        Some(Generation { experiments: vec![rest], ..Generation::default() })
    }

    /// What each of these experiments compares.
    pub fn targets(&self, experiments: &[usize], measurements: &[Measurement]) -> Vec<Target> {
        let one = |series: Series<'_>| Target {
            measured: series.measured.map(<[f64]>::to_vec),
            ..series.simulations.target.clone()
        };
        self.series(experiments, measurements).into_iter().map(one).collect()
    }

    /// All experiments.
    pub fn places(&self) -> Vec<usize> {
        (0..self.experiments.len()).collect()
    }

    /// The individuals of an experiment.
    pub fn genomes(&self, experiment: usize) -> Vec<Vec<f64>> {
        let own = self.experiments.get(experiment);
        own.iter().flat_map(|own| &own.individuals).map(|one| one.genome.clone()).collect()
    }

    /// The individuals of all experiments.
    pub fn all_genomes(&self) -> impl Iterator<Item = &[f64]> {
        self.experiments.iter().flat_map(|own| own.individuals.iter().map(|one| &*one.genome))
    }

    /// The smallest and the largest number.
    pub fn numbers(&self) -> [u64; 2] {
        let all = self.experiments.iter().flat_map(|own| own.individuals.iter());
        all.fold([u64::MAX, 0], |[low, high], one| [low.min(one.number), high.max(one.number)])
    }

    /// Counts simulations that belong to no generation.
    pub fn count(&mut self, tally: &Tally) {
        self.loose.add(tally);
    }

    /// Whether all individuals are among those of `population`.
    pub fn is_part_of(&self, population: &[u64]) -> bool {
        self.all_genomes().all(|genome| population.binary_search(&key(genome)).is_ok())
    }

    /// The experiments that simulated the most of these individuals: one that simulated few of them
    /// had another purpose, such as the check of a result with other data.
    pub(crate) fn covering(&self, individuals: &[Vec<f64>]) -> Vec<usize> {
        let covered = |own: &Simulations| {
            let places = own.places();
            individuals.iter().filter(|genome| places.contains_key(&key(genome))).count()
        };
        let counts: Vec<usize> = self.experiments.iter().map(covered).collect();
        let most = counts.iter().copied().max().unwrap_or(0);
        (0..counts.len()).filter(|&k| most > 0 && counts[k] == most).collect()
    }

    /// The sums of squares of each individual, series by series of these experiments; empty for
    /// one that was not simulated in all of them or where data are not known.
    pub fn sums(
        &self,
        experiments: &[usize],
        individuals: &[Vec<f64>],
        measurements: &[Measurement],
    ) -> Vec<Vec<f64>> {
        let series = self.series(experiments, measurements);
        let places: Vec<FxHashMap<u64, usize>> =
            series.iter().map(|series| series.simulations.places()).collect();
        let sums = |genome: &Vec<f64>| -> Option<Vec<f64>> {
            let one = |(series, places): (&Series<'_>, &FxHashMap<u64, usize>)| {
                let own = &series.simulations.individuals[*places.get(&key(genome))?];
                Some(sum_of_squares(&own.row, series.measured?))
            };
            series.iter().zip(&places).map(one).collect()
        };
        individuals.iter().map(|genome| sums(genome).unwrap_or_default()).collect()
    }

    /// An individual beside all series of these experiments; empty if it was not simulated.
    pub fn compared(
        &self,
        experiments: &[usize],
        genome: &[f64],
        measurements: &[Measurement],
    ) -> Vec<Compared> {
        let one = |series: &Series<'_>| {
            let Simulations { target, individuals } = series.simulations;
            Some(Compared {
                study: target.study.clone(),
                x: target.x.clone(),
                simulated: individuals.iter().find(|one| one.genome == genome)?.row.clone(),
                measured: series.measured.map(<[f64]>::to_vec),
                file: series.file.unwrap_or_default().to_owned(),
            })
        };
        let all: Option<Vec<Compared>> =
            self.series(experiments, measurements).iter().map(one).collect();
        all.unwrap_or_default()
    }

    /// What experiments are compared with: what `Fit` got, else the data read last with the same X.
    fn series<'a>(
        &'a self,
        experiments: &[usize],
        measurements: &'a [Measurement],
    ) -> Vec<Series<'a>> {
        let one = |&place: &usize| {
            let own = &self.experiments[place];
            let given = own.target.measured.as_deref();
            let mut known = measurements.iter().rev().filter(|read| read.x == own.target.x);
            let read = known.find(|read| given.is_none_or(|given| read.y == given));
            Series {
                simulations: own,
                measured: given.or(read.map(|read| read.y.as_slice())),
                file: read.map(|read| read.file.as_str()),
            }
        };
        experiments.iter().map(one).collect()
    }
}

impl Simulations {
    fn is_of(&self, study: &Study, x: &[f64]) -> bool {
        self.target.x == x && *self.target.study == *study
    }

    /// Whether something was simulated since the last generation ended.
    fn is_fresh(&self) -> bool {
        self.individuals.iter().any(|one| one.waited == 0)
    }

    fn tally(&self) -> Tally {
        tally(&self.individuals)
    }

    fn sorted_keys(&self) -> Vec<u64> {
        let mut keys: Vec<u64> = self.individuals.iter().map(|one| key(&one.genome)).collect();
        keys.sort_unstable();
        keys.dedup();
        keys
    }

    /// Whether it compares the same points with another model, or with a model that was changed.
    fn replaces(&self, known: &Simulations) -> bool {
        let [own, other] = [&self.target, &known.target];
        let is_changed =
            own.study.model == other.study.model && own.study.changes != other.study.changes;
        let is_same = own.x == other.x && own.measured == other.measured;
        is_changed || own.measured.is_some() && is_same
    }

    /// Where the individuals are; the last one of equal ones.
    fn places(&self) -> FxHashMap<u64, usize> {
        let all = self.individuals.iter().enumerate();
        all.map(|(place, one)| (key(&one.genome), place)).collect()
    }
}

fn tally(individuals: &[Individual]) -> Tally {
    let mut all = Tally::default();
    for one in individuals.iter().filter(|one| !one.is_copy) {
        all.simulations += 1;
        if let Some(cause) = &one.cause {
            all.failures.note(cause);
        }
    }
    all
}

/// How often each individual occurs.
fn counts(population: &[Vec<f64>]) -> FxHashMap<u64, usize> {
    let mut counts = FxHashMap::default();
    population.iter().for_each(|genome| *counts.entry(key(genome)).or_insert(0) += 1);
    counts
}

/// A number made of the bits.
pub fn key(values: &[f64]) -> u64 {
    let mut hasher = FxHasher::default();
    values.iter().for_each(|value| hasher.write_u64(value.to_bits()));
    hasher.finish()
}

fn same_bits(a: &[f64], b: &[f64]) -> bool {
    a.len() == b.len() && a.iter().zip(b).all(|(a, b)| a.to_bits() == b.to_bits())
}
