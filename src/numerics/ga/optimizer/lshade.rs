//! L-SHADE: differential evolution that remembers which step sizes and crossover rates succeeded
//! and lets the population shrink linearly with the evaluations spent.
//!
//! Reference: [Tanabe & Fukunaga 2014](gapilib_base::bibliography#tanabe-fukunaga-2014).

use super::{Answers, Method, Optimizer, Setup, key};
use crate::diag::Fault;
use crate::elementary;
use crate::ga::sampling::latin_hypercube;
use crate::ga::{Genomes, Mrg32k3a, order};
use crate::registry::Entry;

/// The table entry.
pub(crate) const ENTRY: Entry<dyn Method> = Entry {
    name: "lshade",
    aliases: &["l-shade", "differential_evolution"],
    summary: "differential evolution with success-history adaptation and linear population size \
              reduction",
    reference: "tanabe-fukunaga-2014",
    make: |options| {
        Ok(Box::new(Lshade { population: options.take_whole("population", 0.0..=1e6, 0.0)? }))
    },
};

/// Slots of the memory of success.
const MEMORY: usize = 6;
/// The best part of the population that pulls the others.
const BEST_PART: f64 = 0.11;
/// Replaced parents kept, relative to the population.
const ARCHIVE: f64 = 2.6;
/// The smallest population.
const SMALLEST: usize = 4;
/// Evaluations planned for each gene when the run has no limit.
const BUDGET_PER_GENE: u64 = 5000;

struct Lshade {
    /// 0 for ten individuals a gene: the 18 of the reference use up small budgets before they
    /// learn.
    population: usize,
}

impl Method for Lshade {
    fn start(&self, setup: Setup) -> Result<Box<dyn Optimizer>, Fault> {
        let n = setup.genes.len();
        let size = if self.population == 0 { 10 * n } else { self.population }.max(SMALLEST);
        let budget = setup.budget.unwrap_or(BUDGET_PER_GENE * n as u64).max(1);
        // A population that uses up the budget in its first generations learns nothing.
        let size = size.min((budget / 10) as usize).max(SMALLEST);
        let mut rng = setup.rng;
        let mut first = latin_hypercube(n, size, &mut rng);
        if let Some(start) = setup.start {
            first.row_mut(0).copy_from_slice(&start);
        }
        Ok(Box::new(LshadeRun {
            rng,
            first: size,
            budget,
            used: 0,
            population: Genomes::with_capacity(n, size),
            fitness: Vec::new(),
            trials: first,
            drawn: Vec::new(),
            archive: Vec::new(),
            steps: [0.5; MEMORY],
            rates: [Some(0.5); MEMORY],
            slot: 0,
        }))
    }
}

struct LshadeRun {
    rng: Mrg32k3a,
    /// Individuals at the beginning.
    first: usize,
    budget: u64,
    used: u64,
    population: Genomes,
    fitness: Vec<f64>,
    trials: Genomes,
    /// Step size and crossover rate of each trial.
    drawn: Vec<(f64, f64)>,
    archive: Vec<Vec<f64>>,
    steps: [f64; MEMORY],
    /// `None` once all successful rates were 0.
    rates: [Option<f64>; MEMORY],
    slot: usize,
}

impl Optimizer for LshadeRun {
    fn ask(&mut self, batch: &mut Genomes) {
        self.trials.rows().for_each(|genome| batch.push(genome));
    }

    fn tell(&mut self, batch: &Genomes, answers: &Answers<'_>) {
        self.used += batch.len() as u64;
        let fitness: Vec<f64> = (0..batch.len()).map(|k| key(answers.fitness(k))).collect();
        if self.population.is_empty() {
            self.population = batch.clone();
            self.fitness = fitness;
        } else {
            self.select(batch, &fitness);
            self.shrink();
        }
        self.make_trials();
    }

    fn phase(&self) -> &'static str {
        "search"
    }

    fn rescale(&mut self, gene: usize, offset: f64, scale: f64) {
        for genomes in [&mut self.population, &mut self.trials] {
            for k in 0..genomes.len() {
                let value = &mut genomes.row_mut(k)[gene];
                *value = (offset + scale * *value).clamp(0.0, 1.0);
            }
        }
        for genome in &mut self.archive {
            genome[gene] = (offset + scale * genome[gene]).clamp(0.0, 1.0);
        }
    }
}

impl LshadeRun {
    /// Trials that are not worse replace their parents; what made them better is remembered.
    fn select(&mut self, trials: &Genomes, fitness: &[f64]) {
        let mut successes: Vec<(f64, f64, f64)> = Vec::new();
        for (k, &trial) in fitness.iter().enumerate() {
            if trial > self.fitness[k] {
                continue;
            }
            if trial < self.fitness[k] {
                let gain = (self.fitness[k] - trial).min(f64::MAX);
                let (step, rate) = self.drawn[k];
                successes.push((gain, step, rate));
                self.archive.push(self.population.row(k).to_vec());
            }
            self.population.row_mut(k).copy_from_slice(trials.row(k));
            self.fitness[k] = trial;
        }
        self.trim_archive();
        self.remember(&successes);
    }

    fn remember(&mut self, successes: &[(f64, f64, f64)]) {
        let largest = successes.iter().map(|s| s.0).fold(0.0, f64::max);
        if largest <= 0.0 {
            return;
        }
        // Relative gains: a failed parent's fitness would overflow the sums.
        let lehmer = |value: fn(&(f64, f64, f64)) -> f64| {
            let (mut above, mut below) = (0.0, 0.0);
            for success in successes {
                let weight = success.0 / largest;
                above += weight * value(success) * value(success);
                below += weight * value(success);
            }
            if below > 0.0 { Some(above / below) } else { None }
        };
        self.steps[self.slot] = lehmer(|s| s.1).unwrap_or(self.steps[self.slot]);
        self.rates[self.slot] = self.rates[self.slot].and_then(|_| lehmer(|s| s.2));
        self.slot = (self.slot + 1) % MEMORY;
    }

    fn trim_archive(&mut self) {
        let room = (ARCHIVE * self.population.len() as f64) as usize;
        while self.archive.len() > room {
            let k = self.draw(self.archive.len());
            self.archive.swap_remove(k);
        }
    }

    fn shrink(&mut self) {
        let spent = (self.used as f64 / self.budget as f64).min(1.0);
        let target = self.first as f64 + (SMALLEST as f64 - self.first as f64) * spent;
        let target = (target.round() as usize).max(SMALLEST);
        if target >= self.population.len() {
            return;
        }
        let mut kept = order(&self.fitness);
        kept.truncate(target);
        kept.sort_unstable();
        let mut next = Genomes::with_capacity(self.population.n_genes(), target);
        kept.iter().for_each(|&k| next.push(self.population.row(k)));
        self.fitness = kept.iter().map(|&k| self.fitness[k]).collect();
        self.population = next;
        self.trim_archive();
    }

    fn make_trials(&mut self) {
        let (size, n) = (self.population.len(), self.population.n_genes());
        let ranks = order(&self.fitness);
        let best = ((BEST_PART * size as f64).round() as usize).clamp(2, size);
        let mut trials = Genomes::with_capacity(n, size);
        self.drawn.clear();
        let mut trial = vec![0.0; n];
        for k in 0..size {
            let (step, rate) = self.draw_settings();
            self.drawn.push((step, rate));
            let pull = ranks[self.draw(best)];
            let first = self.draw_other(size, &[k]);
            let second = self.draw_other(size + self.archive.len(), &[k, first]);
            let always = self.draw(n);
            let own = self.population.row(k);
            for j in 0..n {
                trial[j] = own[j];
                if j == always || self.rng.uniform() < rate {
                    let other = match second.checked_sub(size) {
                        Some(place) => self.archive[place][j],
                        None => self.population.row(second)[j],
                    };
                    let population = &self.population;
                    let value = own[j]
                        + step * (population.row(pull)[j] - own[j])
                        + step * (population.row(first)[j] - other);
                    // Outside: halfway between the bound and the parent.
                    trial[j] = match value {
                        v if v < 0.0 => own[j] / 2.0,
                        v if v > 1.0 => (1.0 + own[j]) / 2.0,
                        v => v,
                    };
                }
            }
            trials.push(&trial);
        }
        self.trials = trials;
    }

    /// Step size (Cauchy) and crossover rate (normal) about a slot of the memory.
    fn draw_settings(&mut self) -> (f64, f64) {
        let slot = self.draw(MEMORY);
        let rate = match self.rates[slot] {
            Some(mean) => (mean + 0.1 * self.rng.normal()).clamp(0.0, 1.0),
            None => 0.0,
        };
        loop {
            let turn = std::f64::consts::PI * (self.rng.uniform() - 0.5);
            let step = self.steps[slot] + 0.1 * elementary::tan(turn);
            if step > 0.0 {
                return (step.min(1.0), rate);
            }
        }
    }

    fn draw(&mut self, count: usize) -> usize {
        ((self.rng.uniform() * count as f64) as usize).min(count - 1)
    }

    fn draw_other(&mut self, count: usize, taken: &[usize]) -> usize {
        loop {
            let k = self.draw(count);
            if !taken.contains(&k) {
                return k;
            }
        }
    }
}
