//! NSGA-II: individuals are ranked by non-dominated fronts, within a front by their distance to
//! their neighbours; parents and offspring compete for the next generation.
//!
//! Reference: [Deb et al. 2002](gapilib_base::bibliography#deb-2002).

use super::breeding::{self, Breeding, Chosen};
use super::{Answers, Method, Optimizer, Setup, key};
use crate::diag::Fault;
use crate::ga::mutation::Course;
use crate::ga::operators::{self, usual};
use crate::ga::sampling::Sampling;
use crate::ga::selection::tournament;
use crate::ga::{Gene, Genomes, Mrg32k3a};
use crate::registry::Entry;
use std::cmp::Ordering;
use std::sync::Arc;

/// The table entry.
pub(crate) const ENTRY: Entry<dyn Method> = Entry {
    name: "nsga2",
    aliases: &["nsga-ii"],
    summary: "several fitness functions: a Pareto front",
    reference: "deb-2002",
    make: |options| {
        let mut chosen = Chosen::new();
        let population = options.take_whole("population", 4.0..=1e5, 100.0)?;
        let sampling =
            breeding::take(options, "sampling", usual("latin_hypercube", &[]), &mut chosen);
        let sampling = operators::sampling(sampling)?;
        let breeding = Breeding::on_real_genes(options, &mut chosen)?;
        Ok(Box::new(Nsga2 { population, sampling, breeding, chosen }))
    },
};

/// Selection (binary tournaments of rank and distance) and survival are what the method is.
#[derive(Clone)]
struct Nsga2 {
    population: usize,
    sampling: Arc<dyn Sampling>,
    breeding: Breeding,
    chosen: Chosen,
}

impl Method for Nsga2 {
    fn start(&self, setup: Setup) -> Result<Box<dyn Optimizer>, Fault> {
        let n = setup.genes.len();
        let planned = breeding::planned(&setup, self.population);
        let mut rng = setup.rng;
        let genes = breeding::unit(setup.genes);
        let breeding = self.breeding.for_run(n, &mut rng);
        let mut pending = self.sampling.sample(&genes, self.population, &mut rng)?;
        if let Some(start) = setup.start {
            pending.row_mut(0).copy_from_slice(&start);
        }
        let settings = Nsga2 { breeding, ..self.clone() };
        let (genomes, objectives) = (Genomes::with_capacity(n, 0), Vec::new());
        Ok(Box::new(Nsga2Run {
            settings,
            genes,
            rng,
            pending,
            genomes,
            objectives,
            rank: Vec::new(),
            distance: Vec::new(),
            course: Course { generation: 0, planned },
            fault: None,
        }))
    }

    fn operators(&self) -> Vec<(&'static str, String)> {
        self.chosen.clone()
    }

    fn can_be_polished(&self) -> bool {
        false
    }

    fn handles_several_objectives(&self) -> bool {
        true
    }
}

struct Nsga2Run {
    settings: Nsga2,
    genes: Vec<Gene>,
    rng: Mrg32k3a,
    pending: Genomes,
    genomes: Genomes,
    objectives: Vec<f64>,
    rank: Vec<usize>,
    distance: Vec<f64>,
    course: Course,
    fault: Option<Fault>,
}

impl Optimizer for Nsga2Run {
    fn ask(&mut self, batch: &mut Genomes) {
        self.pending.rows().for_each(|genome| batch.push(genome));
    }

    fn tell(&mut self, batch: &Genomes, answers: &Answers<'_>) {
        batch.rows().for_each(|genome| self.genomes.push(genome));
        self.objectives.extend(answers.objectives.iter().copied().map(key));
        self.survive(answers.n_objectives);
        if let Err(fault) = self.breed() {
            self.fault = Some(fault);
            self.pending = Genomes::with_capacity(batch.n_genes(), 0);
        }
    }

    fn fault(&self) -> Option<&Fault> {
        self.fault.as_ref()
    }

    fn phase(&self) -> &'static str {
        "search"
    }

    fn rescale(&mut self, gene: usize, offset: f64, scale: f64) {
        for genomes in [&mut self.pending, &mut self.genomes] {
            for k in 0..genomes.len() {
                let value = &mut genomes.row_mut(k)[gene];
                *value = (offset + scale * *value).clamp(0.0, 1.0);
            }
        }
    }
}

impl Nsga2Run {
    fn survive(&mut self, m: usize) {
        let survivors = survivors(&self.objectives, m, self.settings.population);
        let mut next = Genomes::with_capacity(self.genomes.n_genes(), 2 * survivors.len());
        survivors.iter().for_each(|survivor| next.push(self.genomes.row(survivor.place)));
        let own = |survivor: &Survivor| survivor.place * m..(survivor.place + 1) * m;
        self.objectives = survivors.iter().flat_map(|s| self.objectives[own(s)].to_vec()).collect();
        self.rank = survivors.iter().map(|survivor| survivor.rank).collect();
        self.distance = survivors.iter().map(|survivor| survivor.distance).collect();
        self.genomes = next;
    }

    fn breed(&mut self) -> Result<(), Fault> {
        let Nsga2 { population, breeding, .. } = &self.settings;
        let mut offspring = Genomes::with_capacity(self.genes.len(), *population);
        let count = self.genomes.len();
        let (rank, distance) = (&self.rank, &self.distance);
        let better = |a: usize, b: usize| (rank[a], -distance[a]) <= (rank[b], -distance[b]);
        while offspring.len() < *population {
            let mut parent = || tournament(count, 2, &mut self.rng, better);
            let pair = [parent(), parent()];
            let [mut first, mut second] = pair.map(|k| self.genomes.row(k).to_vec());
            breeding.cross(&mut first, &mut second, &self.genes, &mut self.rng)?;
            for child in [&mut first, &mut second] {
                breeding.mutate(child, &self.genes, self.course, &mut self.rng)?;
                let known =
                    self.genomes.rows().chain(offspring.rows()).any(|genome| genome == &child[..]);
                if offspring.len() < *population && (!known || self.rng.uniform() < 0.05) {
                    offspring.push(child);
                }
            }
        }
        self.course.generation += 1;
        self.pending = offspring;
        Ok(())
    }
}

/// `Less` where `a` dominates `b`, `Greater` where `b` dominates `a`, else `Equal`.
fn dominance(a: &[f64], b: &[f64]) -> Ordering {
    let (mut better, mut worse) = (false, false);
    for (a, b) in a.iter().zip(b) {
        better |= a < b;
        worse |= a > b;
    }
    worse.cmp(&better)
}

/// The individuals that no other dominates, in their order; `objectives` has `m` numbers each.
pub fn non_dominated(objectives: &[f64], m: usize) -> Vec<usize> {
    fronts(objectives, m).into_iter().next().unwrap_or_default()
}

/// An individual that lives on.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Survivor {
    /// Its place among the individuals that competed.
    pub place: usize,
    /// The number of its front; 0 is the best.
    pub rank: usize,
    /// How far its neighbours in the front are; infinite at the ends.
    pub distance: f64,
}

/// The individuals that form the next population: whole fronts, best first, then of the front that
/// does not fit the members with the most room about them. `objectives` has `m` numbers each.
pub fn survivors(objectives: &[f64], m: usize, population: usize) -> Vec<Survivor> {
    let mut survivors = Vec::with_capacity(population);
    for (rank, front) in fronts(objectives, m).into_iter().enumerate() {
        let distance = crowding(&front, objectives, m);
        let mut chosen: Vec<usize> = (0..front.len()).collect();
        let room = population - survivors.len();
        if chosen.len() > room {
            chosen.sort_by(|&a, &b| distance[b].total_cmp(&distance[a]));
            chosen.truncate(room);
        }
        let survivor = |k: usize| Survivor { place: front[k], rank, distance: distance[k] };
        survivors.extend(chosen.into_iter().map(survivor));
    }
    survivors
}

/// Fronts, best first.
fn fronts(objectives: &[f64], m: usize) -> Vec<Vec<usize>> {
    let count = objectives.len() / m;
    let row = |k: usize| &objectives[k * m..(k + 1) * m];
    let mut dominated: Vec<Vec<usize>> = vec![Vec::new(); count];
    let mut above = vec![0_usize; count];
    for a in 0..count {
        for b in a + 1..count {
            match dominance(row(a), row(b)) {
                Ordering::Less => {
                    dominated[a].push(b);
                    above[b] += 1;
                }
                Ordering::Greater => {
                    dominated[b].push(a);
                    above[a] += 1;
                }
                Ordering::Equal => {}
            }
        }
    }
    let mut fronts = Vec::new();
    let mut front: Vec<usize> = (0..count).filter(|&k| above[k] == 0).collect();
    while !front.is_empty() {
        let mut next = Vec::new();
        for &a in &front {
            for &b in &dominated[a] {
                above[b] -= 1;
                if above[b] == 0 {
                    next.push(b);
                }
            }
        }
        next.sort_unstable();
        fronts.push(std::mem::replace(&mut front, next));
    }
    fronts
}

/// How far the neighbours of each member of a front are, summed over the objectives, each relative
/// to the width of the front; infinite at the ends.
fn crowding(front: &[usize], objectives: &[f64], m: usize) -> Vec<f64> {
    let mut distance = vec![0.0; front.len()];
    for objective in 0..m {
        let value = |k: usize| objectives[front[k] * m + objective];
        let mut sorted: Vec<usize> = (0..front.len()).collect();
        sorted.sort_by(|&a, &b| value(a).total_cmp(&value(b)));
        let (first, last) = (sorted[0], sorted[sorted.len() - 1]);
        let width = value(last) - value(first);
        distance[first] = f64::INFINITY;
        distance[last] = f64::INFINITY;
        for three in sorted.windows(3).filter(|_| width > 0.0) {
            distance[three[1]] += (value(three[2]) - value(three[0])) / width;
        }
    }
    distance
}
