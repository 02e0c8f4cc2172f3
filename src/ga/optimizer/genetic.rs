//! A genetic algorithm with the operators that have proved themselves on real genes: Latin
//! hypercube or Sobol start that redraws failures, binary tournament, simulated binary crossover,
//! polynomial mutation, elites.
//!
//! References: [Deb & Agrawal 1995](crate::bibliography#deb-agrawal-1995),
//! [McKay et al. 1979](crate::bibliography#mckay-1979),
//! [Goldberg 1989](crate::bibliography#goldberg-1989).

use super::{Answers, Method, Optimizer, Setup, has_failed, key, whole};
use crate::diag::Fault;
use crate::fault;
use crate::ga::crossover::sbx;
use crate::ga::mutation::polynomial;
use crate::ga::sampling::{latin_hypercube, sobol};
use crate::ga::selection::tournament;
use crate::ga::{Genomes, Mrg32k3a, order};
use crate::registry::{BAD_OPTION, Entry};

/// The table entry.
pub(super) const ENTRY: Entry<dyn Method> = Entry {
    name: "genetic",
    aliases: &["ga", "genetic_algorithm"],
    summary: "genetic algorithm: Latin hypercube, tournament, SBX, polynomial mutation, elites",
    reference: "deb-agrawal-1995",
    make: |options| {
        Ok(Box::new(Genetic {
            population: whole(options, "population", 0.0..=1e6, 0.0)?,
            elites: whole(options, "elites", 0.0..=1e6, 1.0)?,
            crossover: options.take("crossover", 0.0..=1.0, 0.9)?,
            eta_crossover: options.take("eta_crossover", 0.0..=1000.0, 15.0)?,
            mutation: options.take("mutation", 0.0..=1.0, 0.0)?,
            eta_mutation: options.take("eta_mutation", 0.0..=1000.0, 20.0)?,
            sobol: whole(options, "sobol", 0.0..=1.0, 0.0)? == 1,
        }))
    },
};

/// How often a failed individual of the first generation is drawn again.
const REDRAWS: usize = 10;

#[derive(Clone, Copy)]
struct Genetic {
    /// 0 for five times the number of genes, from 20 to 100.
    population: usize,
    /// Members of the old generation that compete with the offspring; as many as the population or
    /// more for all of them.
    elites: usize,
    crossover: f64,
    eta_crossover: f64,
    /// 0 for one gene in each individual.
    mutation: f64,
    eta_mutation: f64,
    /// Whether it starts from a Sobol sequence instead of a Latin hypercube.
    sobol: bool,
}

impl Method for Genetic {
    fn start(&self, setup: Setup) -> Result<Box<dyn Optimizer>, Fault> {
        let n = setup.genes.len();
        let size = if self.population == 0 { (5 * n).clamp(20, 100) } else { self.population };
        let mut rng = setup.rng;
        let mut first = if self.sobol { sobol } else { latin_hypercube }(n, size, &mut rng);
        if let Some(start) = setup.start {
            first.row_mut(0).copy_from_slice(&start);
        }
        let settings = Genetic { population: size, ..*self };
        let (parents, fitness) = (Genomes::with_capacity(n, size), Vec::with_capacity(size));
        Ok(Box::new(Search { settings, rng, pending: first, parents, fitness, redraws: REDRAWS }))
    }
}

struct Search {
    settings: Genetic,
    rng: Mrg32k3a,
    /// Asked next.
    pending: Genomes,
    /// The generation that has been evaluated.
    parents: Genomes,
    fitness: Vec<f64>,
    /// Turns left to complete the first generation.
    redraws: usize,
}

impl Optimizer for Search {
    fn ask(&mut self, batch: &mut Genomes) {
        self.pending.rows().for_each(|genome| batch.push(genome));
    }

    fn tell(&mut self, batch: &Genomes, answers: &Answers<'_>) {
        let fitness: Vec<f64> = (0..batch.len()).map(|k| answers.fitness(k)).collect();
        match self.redraws {
            0 => self.replace(batch, &fitness),
            _ => self.complete(batch, &fitness),
        }
        if self.redraws == 0 {
            self.breed();
        }
    }

    fn phase(&self) -> &'static str {
        "search"
    }

    fn change(&mut self, setting: &str, value: f64) -> Result<(), Fault> {
        let probability = (0.0..=1.0).contains(&value);
        let size = value.fract() == 0.0 && (0.0..=1e6).contains(&value);
        match setting {
            "mutation" if probability => self.settings.mutation = value,
            "crossover" if probability => self.settings.crossover = value,
            "elites" if size => self.settings.elites = value as usize,
            "population" if size && value >= 4.0 => self.settings.population = value as usize,
            _ => return Err(fault!(BAD_OPTION, "`{setting}` cannot become {value}")),
        }
        Ok(())
    }

    fn rescale(&mut self, gene: usize, offset: f64, scale: f64) {
        for genomes in [&mut self.pending, &mut self.parents] {
            for k in 0..genomes.len() {
                let value = &mut genomes.row_mut(k)[gene];
                *value = (offset + scale * *value).clamp(0.0, 1.0);
            }
        }
    }
}

impl Search {
    /// The first generation: keeps what succeeded and draws the rest again.
    fn complete(&mut self, batch: &Genomes, fitness: &[f64]) {
        self.redraws -= 1;
        let size = self.settings.population;
        let last = self.redraws == 0;
        for (k, &fitness) in fitness.iter().enumerate() {
            if !has_failed(fitness) || last {
                self.parents.push(batch.row(k));
                self.fitness.push(fitness);
            }
        }
        let missing = size.saturating_sub(self.parents.len());
        if missing == 0 {
            self.redraws = 0;
        } else {
            self.pending = latin_hypercube(batch.n_genes(), missing, &mut self.rng);
        }
    }

    /// The best of the elites of the old generation and the offspring, each of them once.
    fn replace(&mut self, offspring: &Genomes, fitness: &[f64]) {
        let elites = order(&self.fitness).into_iter().take(self.settings.elites);
        let mut all: Vec<(&[f64], f64)> =
            elites.map(|k| (self.parents.row(k), self.fitness[k])).collect();
        all.extend(offspring.rows().zip(fitness.iter().copied()));
        all.sort_by(|a, b| key(a.1).total_cmp(&key(b.1)));
        let mut next = Genomes::with_capacity(offspring.n_genes(), self.settings.population);
        let mut next_fitness: Vec<f64> = Vec::with_capacity(self.settings.population);
        for (genome, fitness) in all {
            let is_last = |last: usize| next_fitness[last] == fitness && next.row(last) == genome;
            let known = next.len().checked_sub(1).is_some_and(is_last);
            if next.len() < self.settings.population && !known {
                next.push(genome);
                next_fitness.push(fitness);
            }
        }
        (self.parents, self.fitness) = (next, next_fitness);
    }

    fn breed(&mut self) {
        let n = self.parents.n_genes();
        let settings = self.settings;
        // Where all parents compete with them, there are as many offspring.
        let kept = if settings.elites < settings.population { settings.elites } else { 0 };
        let count = settings.population - kept;
        let mutation = if settings.mutation > 0.0 { settings.mutation } else { 1.0 / n as f64 };
        let better = |a: usize, b: usize, fitness: &[f64]| key(fitness[a]) <= key(fitness[b]);
        let mut offspring = Genomes::with_capacity(n, count);
        let (mut first, mut second) = (vec![0.0; n], vec![0.0; n]);
        while offspring.len() < count {
            let fitness = &self.fitness;
            let mut parent =
                || tournament(fitness.len(), &mut self.rng, |a, b| better(a, b, fitness));
            let (a, b) = (parent(), parent());
            first.copy_from_slice(self.parents.row(a));
            second.copy_from_slice(self.parents.row(b));
            if self.rng.uniform() < settings.crossover {
                sbx(&mut first, &mut second, settings.eta_crossover, &mut self.rng);
            }
            for child in [&mut first, &mut second] {
                polynomial(child, mutation, settings.eta_mutation, &mut self.rng);
                if offspring.len() < count {
                    offspring.push(child);
                }
            }
        }
        self.pending = offspring;
    }
}
