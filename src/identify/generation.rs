//! The individuals simulated since the last generation ended, experiment by experiment.
//!
//! Every individual that `Eval` simulates has a number, which its row carries as a mark to `Fit`,
//! whatever order the script calls in and however it puts the rows together. Rows that a script copies
//! element by element carry none: they are those of the individuals with all of these numbers.

use super::Simulated;
use super::fitness::sum_of_squares;
use super::search_record::Failures;
use super::study::{Compared, Measurement, Study};
use crate::ga::Genomes;
use rustc_hash::{FxHashMap, FxHasher};
use std::hash::Hasher as _;
use std::sync::Arc;

/// Individuals that were left over by generations that have ended, and may be of the next one of
/// another search. Those of ten models with populations of 1000 are as many.
const LEFT_OVER: usize = 10_000;

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

/// Simulations of one model at the same points.
#[derive(Debug, Clone)]
struct Simulations {
    study: Arc<Study>,
    x: Vec<f64>,
    genomes: Vec<Vec<f64>>,
    rows: Vec<Vec<f64>>,
    /// The numbers of the individuals, ascending.
    numbers: Vec<u64>,
    /// The measured values that `Fit` compared with, and which individuals it got.
    ratings: Vec<(Vec<f64>, Vec<bool>)>,
    tally: Tally,
    /// Whether a generation has ended since without them.
    left_over: bool,
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
        let own = std::mem::take(&mut self.experiments);
        own.iter().for_each(|one| self.loose.add(&one.tally));
    }

    /// All that was simulated here.
    pub fn tally(&self) -> Tally {
        let mut all = self.loose.clone();
        self.experiments.iter().for_each(|own| all.add(&own.tally));
        all
    }

    /// The generation that these experiments make, taken out of this one, with what belongs to none.
    pub fn take(&mut self, experiments: &[usize]) -> Generation {
        let mut own =
            Generation { loose: std::mem::take(&mut self.loose), ..Generation::default() };
        let mut place = 0;
        own.experiments.extend(self.experiments.extract_if(.., |_| {
            place += 1;
            experiments.contains(&(place - 1))
        }));
        own
    }

    /// A generation of these individuals has ended. What was simulated of some of them was a check;
    /// the rest may be of another search, until the same is simulated again.
    pub fn leave(&mut self, individuals: &[Vec<f64>]) {
        let count = individuals.len();
        let mut known: Vec<u64> = individuals.iter().map(|genome| key(genome)).collect();
        known.sort_unstable();
        self.drop_where(|own| own.genomes.len() < count && own.are_among(&known));
        self.experiments.iter_mut().for_each(|own| own.left_over = true);
        while self.size() > LEFT_OVER {
            let mut is_first = true;
            self.drop_where(|_| std::mem::take(&mut is_first));
        }
    }

    fn drop_where(&mut self, mut is_dropped: impl FnMut(&Simulations) -> bool) {
        for own in self.experiments.extract_if(.., |own| is_dropped(own)) {
            self.loose.add(&own.tally);
        }
    }

    /// The experiments that were simulated since the last generation ended.
    fn fresh(&self) -> impl Iterator<Item = &Simulations> {
        self.experiments.iter().filter(|own| !own.left_over)
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
        self.experiments.iter().map(|simulations| simulations.genomes.len()).sum()
    }

    /// Adds what `Eval` has simulated; the individuals have the numbers from `first` on.
    pub fn add(
        &mut self,
        (study, x): (&Arc<Study>, &[f64]),
        genomes: &Genomes,
        simulated: &Simulated,
        first: u64,
    ) {
        self.drop_where(|known| known.left_over && known.is_of(study, x));
        let known = self.experiments.iter().position(|known| known.is_of(study, x));
        let place = known.unwrap_or_else(|| {
            self.experiments.push(Simulations::new(study.clone(), x.to_vec()));
            self.experiments.len() - 1
        });
        let own = &mut self.experiments[place];
        own.tally.simulations += genomes.len() as u64;
        for failure in simulated.failures.iter().flatten() {
            own.tally.failures.note(&failure.cause);
        }
        own.numbers.extend((first..).take(genomes.len()));
        own.genomes.extend(genomes.rows().map(<[f64]>::to_vec));
        own.rows.extend(simulated.rows.chunks(x.len().max(1)).map(<[f64]>::to_vec));
        let count = own.genomes.len();
        own.ratings.iter_mut().for_each(|(_, rated)| rated.resize(count, false));
    }

    /// Adds the simulations of another one.
    pub fn append(&mut self, other: Generation) {
        self.loose.add(&other.loose);
        for mut more in other.experiments {
            match self.experiments.iter_mut().find(|own| own.is_of(&more.study, &more.x)) {
                Some(own) => own.append(&mut more),
                None => self.experiments.push(more),
            }
        }
    }

    /// The numbers of the individuals whose rows have the bits of this one.
    pub fn equal_to(&self, row: &[f64]) -> Vec<u64> {
        let of_size = self.experiments.iter().filter(|own| own.x.len() == row.len());
        let own = of_size.flat_map(|own| own.rows.iter().zip(&own.numbers));
        own.filter(|(known, _)| same_bits(known, row)).map(|(_, number)| *number).collect()
    }

    /// `Fit` has compared the individuals with these numbers with `measured`.
    pub fn rate(&mut self, numbers: impl Iterator<Item = u64>, measured: &[f64]) {
        for number in numbers {
            let found = self.experiments.iter_mut().find_map(|own| {
                let place = own.numbers.binary_search(&number).ok()?;
                Some((own, place))
            });
            if let Some((own, place)) = found {
                own.note_rated(measured, place);
            }
        }
    }

    /// Whether individuals were simulated since the last generation ended, and `Fit` got all of them.
    pub fn is_rated(&self) -> bool {
        self.fresh().next().is_some() && self.fresh().all(Simulations::is_rated)
    }

    /// Whether `Fit` got any of them.
    pub(crate) fn has_ratings(&self) -> bool {
        self.fresh().any(|simulations| !simulations.ratings.is_empty())
    }

    /// Whether this experiment has been simulated, and all its individuals compared.
    pub(crate) fn has_rated(&self, study: &Study, x: &[f64]) -> bool {
        self.fresh().any(|own| own.is_of(study, x) && own.is_rated())
    }

    /// The only experiment that was simulated since the last generation ended, where there is one
    /// alone, and how many individuals it has.
    pub fn only(&self, measurements: &[Measurement]) -> Option<(Target, usize)> {
        let [place] = self.fresh_places()[..] else { return None };
        let target = self.targets(&[place], measurements).pop()?;
        Some((target, self.experiments[place].genomes.len()))
    }

    /// Where the experiments are that were simulated since the last generation ended.
    pub fn fresh_places(&self) -> Vec<usize> {
        let places = self.experiments.iter().enumerate();
        places.filter(|(_, own)| !own.left_over).map(|(place, _)| place).collect()
    }

    /// What each series of these experiments compares.
    pub fn targets(&self, experiments: &[usize], measurements: &[Measurement]) -> Vec<Target> {
        let one = |series: Series<'_>| Target {
            study: series.simulations.study.clone(),
            x: series.simulations.x.clone(),
            measured: series.measured.map(<[f64]>::to_vec),
        };
        self.series(experiments, measurements).into_iter().map(one).collect()
    }

    /// Of which experiment each series of these is.
    pub fn experiments_of_series(&self, experiments: &[usize]) -> Vec<usize> {
        let own = |&place: &usize| {
            let count = self.experiments[place].ratings.len().max(1);
            std::iter::repeat_n(place, count)
        };
        experiments.iter().flat_map(own).collect()
    }

    /// All experiments.
    pub fn places(&self) -> Vec<usize> {
        (0..self.experiments.len()).collect()
    }

    /// The individuals of an experiment.
    pub fn genomes(&self, experiment: usize) -> &[Vec<f64>] {
        self.experiments.get(experiment).map_or(&[], |own| &own.genomes)
    }

    /// The individuals of all experiments.
    pub fn all_genomes(&self) -> impl Iterator<Item = &[f64]> {
        self.experiments.iter().flat_map(|own| own.genomes.iter().map(Vec::as_slice))
    }

    /// Counts simulations that belong to no generation.
    pub fn count(&mut self, tally: &Tally) {
        self.loose.add(tally);
    }

    /// Whether all individuals are among those of `population`.
    pub fn is_part_of(&self, population: &[u64]) -> bool {
        self.experiments.iter().all(|own| own.are_among(population))
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
                let row = &series.simulations.rows[*places.get(&key(genome))?];
                Some(sum_of_squares(row, series.measured?))
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
            let own = series.simulations;
            Some(Compared {
                study: own.study.clone(),
                x: own.x.clone(),
                simulated: own.rows[own.place_of(genome)?].clone(),
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
        let mut all = Vec::new();
        for own in experiments.iter().map(|&k| &self.experiments[k]) {
            let read = |y: &[f64]| {
                let mut known = measurements.iter().rev().filter(|read| read.x == own.x);
                known.find(|read| read.y == y).map(|read| read.file.as_str())
            };
            all.extend(own.ratings.iter().map(|(measured, _)| Series {
                simulations: own,
                measured: Some(measured),
                file: read(measured),
            }));
            if own.ratings.is_empty() {
                let known = measurements.iter().rev().find(|read| read.x == own.x);
                all.push(Series {
                    simulations: own,
                    measured: known.map(|read| read.y.as_slice()),
                    file: known.map(|read| read.file.as_str()),
                });
            }
        }
        all
    }
}

impl Simulations {
    fn new(study: Arc<Study>, x: Vec<f64>) -> Simulations {
        Simulations {
            study,
            x,
            genomes: Vec::new(),
            rows: Vec::new(),
            numbers: Vec::new(),
            ratings: Vec::new(),
            tally: Tally::default(),
            left_over: false,
        }
    }

    /// Whether all individuals have one of these keys, which are sorted.
    fn are_among(&self, population: &[u64]) -> bool {
        self.genomes.iter().all(|genome| population.binary_search(&key(genome)).is_ok())
    }

    fn sorted_keys(&self) -> Vec<u64> {
        let mut keys: Vec<u64> = self.genomes.iter().map(|genome| key(genome)).collect();
        keys.sort_unstable();
        keys.dedup();
        keys
    }

    /// Whether it compares the same points with another model, or with a model that was changed.
    fn replaces(&self, known: &Simulations) -> bool {
        let [own, other] =
            [self, known].map(|one| one.ratings.iter().map(|(measured, _)| measured));
        let is_changed =
            self.study.model == known.study.model && self.study.changes != known.study.changes;
        is_changed || self.x == known.x && !self.ratings.is_empty() && own.eq(other)
    }

    fn is_of(&self, study: &Study, x: &[f64]) -> bool {
        self.x == x && *self.study == *study
    }

    fn is_rated(&self) -> bool {
        let rated = |k: usize| self.ratings.iter().any(|(_, rated)| rated[k]);
        !self.genomes.is_empty() && (0..self.genomes.len()).all(rated)
    }

    fn note_rated(&mut self, measured: &[f64], place: usize) {
        let count = self.genomes.len();
        let known = self.ratings.iter().position(|(known, _)| known == measured);
        let rating = known.unwrap_or_else(|| {
            self.ratings.push((measured.to_vec(), vec![false; count]));
            self.ratings.len() - 1
        });
        self.ratings[rating].1[place] = true;
    }

    fn append(&mut self, more: &mut Simulations) {
        let first = self.genomes.len();
        self.tally.add(&more.tally);
        self.genomes.append(&mut more.genomes);
        self.rows.append(&mut more.rows);
        self.numbers.append(&mut more.numbers);
        let count = self.genomes.len();
        self.ratings.iter_mut().for_each(|(_, rated)| rated.resize(count, false));
        for (measured, rated) in &more.ratings {
            let places = rated.iter().enumerate().filter(|(_, rated)| **rated);
            places.for_each(|(place, _)| self.note_rated(measured, first + place));
        }
    }

    fn place_of(&self, genome: &[f64]) -> Option<usize> {
        self.genomes.iter().position(|known| known == genome)
    }

    fn places(&self) -> FxHashMap<u64, usize> {
        self.genomes.iter().enumerate().map(|(place, genome)| (key(genome), place)).collect()
    }
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
