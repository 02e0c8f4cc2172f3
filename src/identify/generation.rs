//! The individuals simulated since the last generation ended, experiment by experiment.
//!
//! Every individual that `Eval` simulates has a number, which its row carries as a mark to `Fit`,
//! whatever order the script calls in and however it puts the rows together. Rows that a script copies
//! element by element carry none: they are those of the individuals with all of these numbers.

use super::Simulated;
use super::fitness::sum_of_squares;
use super::study::{Compared, Measurement, Study};
use crate::ga::Genomes;
use rustc_hash::{FxHashMap, FxHasher};
use std::hash::Hasher as _;
use std::sync::Arc;

/// Simulations of one generation.
#[derive(Debug, Clone, Default)]
pub struct Generation {
    experiments: Vec<Simulations>,
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

    pub fn clear(&mut self) {
        self.experiments.clear();
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
        let known = self.experiments.iter().position(|known| known.is_of(study, x));
        let place = known.unwrap_or_else(|| {
            let (study, x) = (study.clone(), x.to_vec());
            let (genomes, rows) = (Vec::new(), Vec::new());
            let (numbers, ratings) = (Vec::new(), Vec::new());
            self.experiments.push(Simulations { study, x, genomes, rows, numbers, ratings });
            self.experiments.len() - 1
        });
        let own = &mut self.experiments[place];
        own.numbers.extend((first..).take(genomes.len()));
        own.genomes.extend(genomes.rows().map(<[f64]>::to_vec));
        own.rows.extend(simulated.rows.chunks(x.len().max(1)).map(<[f64]>::to_vec));
        let count = own.genomes.len();
        own.ratings.iter_mut().for_each(|(_, rated)| rated.resize(count, false));
    }

    /// Adds the simulations of another one.
    pub fn append(&mut self, other: Generation) {
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

    /// Whether there are individuals and `Fit` got all of them.
    pub fn is_rated(&self) -> bool {
        !self.is_empty() && self.experiments.iter().all(Simulations::is_rated)
    }

    /// Whether `Fit` got any of them.
    pub(crate) fn has_ratings(&self) -> bool {
        self.experiments.iter().any(|simulations| !simulations.ratings.is_empty())
    }

    /// Whether this experiment has been simulated, and all its individuals compared.
    pub(crate) fn has_rated(&self, study: &Study, x: &[f64]) -> bool {
        self.experiments.iter().any(|own| own.is_of(study, x) && own.is_rated())
    }

    /// The only experiment, where there is one alone.
    pub fn only(&self) -> Option<(&Study, &[f64], usize)> {
        match self.experiments.as_slice() {
            [own] => Some((&own.study, &own.x, own.genomes.len())),
            _ => None,
        }
    }

    /// The individuals of the first experiment.
    pub fn genomes(&self) -> &[Vec<f64>] {
        self.experiments.first().map_or(&[], |first| &first.genomes)
    }

    /// Whether all individuals are among those of `population`.
    pub fn is_part_of(&self, population: &[u64]) -> bool {
        let known = |genome: &Vec<f64>| population.binary_search(&key(genome)).is_ok();
        self.experiments.iter().all(|own| own.genomes.iter().all(known))
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
