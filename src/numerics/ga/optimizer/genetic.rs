//! A genetic algorithm on real genes. Its usual operators have proved themselves there: Latin
//! hypercube, binary tournament, simulated binary crossover, polynomial mutation, elites; each can
//! be replaced by another one of its table. Failures of the first generation are drawn again.
//!
//! References: [Deb & Agrawal 1995](gapilib_base::bibliography#deb-agrawal-1995),
//! [McKay et al. 1979](gapilib_base::bibliography#mckay-1979),
//! [Goldberg 1989](gapilib_base::bibliography#goldberg-1989).

use super::breeding::{self, Breeding, Chosen};
use super::islands::{Island, Islands};
use super::{Answers, Method, Optimizer, Setup, has_failed};
use crate::diag::Fault;
use crate::fault;
use crate::ga::mutation::Course;
use crate::ga::operators::{self, usual};
use crate::ga::sampling::Sampling;
use crate::ga::selection::Selection;
use crate::ga::survival::{Brood, Rated, Sizes, Survival, Survivor};
use crate::ga::{Gene, Genomes, Mrg32k3a, order};
use crate::registry::{BAD_OPTION, Entry, Options};
use std::sync::Arc;

/// The table entry.
pub(crate) const ENTRY: Entry<dyn Method> = Entry {
    name: "genetic",
    aliases: &["ga", "genetic_algorithm"],
    summary: "genetic algorithm: Latin hypercube, tournament, SBX, polynomial mutation, elites",
    reference: "deb-agrawal-1995",
    make: |options| Ok(Box::new(Genetic::new(options)?)),
};

/// The first stream of random numbers of further islands, far from those of other methods.
const STREAM: u64 = 2_000_003;
/// Generations between two migrations by default.
const MIGRATION: f64 = 10.0;
/// How often a failed individual of the first generation is drawn again.
const REDRAWS: usize = 10;

#[derive(Clone)]
struct Genetic {
    /// Of each island; 0 for five times the number of genes, from 20 to 100.
    population: usize,
    /// Members of the old generation that compete with the offspring; as many as the population or
    /// more for all of them.
    elites: usize,
    /// Populations that evolve apart.
    islands: usize,
    /// Generations between two migrations.
    migration: usize,
    sampling: Arc<dyn Sampling>,
    /// For failed individuals of the first generation.
    redrawing: Arc<dyn Sampling>,
    selection: Arc<dyn Selection>,
    breeding: Breeding,
    survival: Arc<dyn Survival>,
    chosen: Chosen,
}

impl Genetic {
    fn new(options: &mut Options) -> Result<Genetic, Fault> {
        let mut chosen = Chosen::new();
        let population = options.take_whole("population", 0.0..=1e6, 0.0)?;
        let redrawing = operators::sampling(usual("latin_hypercube", &[]))?;
        let (sampling, redrawing) = match options.take_choice("sampling") {
            Some(choice) => {
                chosen.push(("sampling", choice.label()));
                let sampling = operators::sampling(choice)?;
                (sampling.clone(), sampling)
            }
            // The setting is older than the choice; without both it is a hypercube.
            None if options.take_whole("sobol", 0.0..=1.0, 0.0)? == 1 => {
                (operators::sampling(usual("sobol", &[]))?, redrawing)
            }
            None => (redrawing.clone(), redrawing),
        };
        let survival = breeding::take(options, "survival", usual("elitism", &[]), &mut chosen);
        let survival = operators::survival(survival)?;
        let elites = match survival.has_elites() {
            true => options.take_whole("elites", 0.0..=1e6, 1.0)?,
            false => 0,
        };
        let selection = usual(survival.usual_selection(), &[]);
        let selection = breeding::take(options, "selection", selection, &mut chosen);
        let selection = operators::selection(selection)?;
        let breeding = Breeding::on_real_genes(options, &mut chosen)?;
        Ok(Genetic {
            population,
            elites,
            islands: options.take_whole("islands", 1.0..=1e5, 1.0)?,
            migration: options.take_whole("migration", 1.0..=1e6, MIGRATION)?,
            sampling,
            redrawing,
            selection,
            breeding,
            survival,
            chosen,
        })
    }
}

impl Method for Genetic {
    fn start(&self, setup: Setup) -> Result<Box<dyn Optimizer>, Fault> {
        if self.islands == 1 {
            return Ok(Box::new(self.population(setup)?));
        }
        let budget = setup.budget.map(|budget| budget / self.islands as u64);
        let island = |number: usize| {
            let mut own = Setup { budget, ..setup.clone() };
            if number > 0 {
                own.rng = setup.rng.stream(STREAM + number as u64);
                own.start = None;
            }
            Ok(Box::new(self.population(own)?) as Box<dyn Island>)
        };
        let islands: Result<Vec<Box<dyn Island>>, Fault> = (0..self.islands).map(island).collect();
        Ok(Box::new(Islands::new(islands?, self.migration as u64)))
    }

    fn operators(&self) -> Vec<(&'static str, String)> {
        let mut chosen = self.chosen.clone();
        if self.islands > 1 {
            chosen.push(("islands", format!("{} (migration {})", self.islands, self.migration)));
        }
        chosen
    }
}

impl Genetic {
    /// A population of its own.
    fn population(&self, setup: Setup) -> Result<GeneticRun, Fault> {
        let n = setup.genes.len();
        let size = if self.population == 0 { (5 * n).clamp(20, 100) } else { self.population };
        let planned = breeding::planned(&setup, size);
        let mut rng = setup.rng;
        let genes = breeding::unit(setup.genes);
        let breeding = self.breeding.for_run(n, &mut rng);
        let mut first = self.sampling.sample(&genes, size, &mut rng)?;
        if let Some(start) = setup.start {
            first.row_mut(0).copy_from_slice(&start);
        }
        Ok(GeneticRun {
            settings: Genetic { population: size, breeding, ..self.clone() },
            genes,
            rng,
            pending: first,
            families: Vec::new(),
            parents: Genomes::with_capacity(n, size),
            fitness: Vec::with_capacity(size),
            ages: Vec::new(),
            redraws: REDRAWS,
            course: Course { generation: 0, planned },
            fault: None,
        })
    }
}

struct GeneticRun {
    settings: Genetic,
    genes: Vec<Gene>,
    rng: Mrg32k3a,
    /// Asked next.
    pending: Genomes,
    /// The parents of each of these, as places in the generation.
    families: Vec<[usize; 2]>,
    /// The generation that has been evaluated.
    parents: Genomes,
    fitness: Vec<f64>,
    /// Generations that each of it has survived.
    ages: Vec<u64>,
    /// Attempts left to complete the first generation.
    redraws: usize,
    course: Course,
    fault: Option<Fault>,
}

impl Optimizer for GeneticRun {
    fn ask(&mut self, batch: &mut Genomes) {
        self.pending.rows().for_each(|genome| batch.push(genome));
    }

    fn tell(&mut self, batch: &Genomes, answers: &Answers<'_>) {
        let fitness: Vec<f64> = (0..batch.len()).map(|k| answers.fitness(k)).collect();
        if let Err(fault) = self.go_on(batch, &fitness) {
            self.fault = Some(fault);
            self.pending = Genomes::with_capacity(batch.n_genes(), 0);
        }
    }

    fn phase(&self) -> &'static str {
        "search"
    }

    fn fault(&self) -> Option<&Fault> {
        self.fault.as_ref()
    }

    fn change(&mut self, setting: &str, value: f64) -> Result<(), Fault> {
        let probability = (0.0..=1.0).contains(&value);
        let size = value.fract() == 0.0 && (0.0..=1e6).contains(&value);
        let settings = &mut self.settings;
        match setting {
            "mutation" if probability => settings.breeding.rate = value,
            "crossover" if probability => settings.breeding.probability = Some(value),
            "elites" if size && settings.survival.has_elites() => settings.elites = value as usize,
            "population" if size && value >= 4.0 && settings.survival.can_resize() => {
                settings.population = value as usize;
            }
            _ => return Err(fault!(BAD_OPTION, "`{setting}` cannot be set to {value}")),
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

impl Island for GeneticRun {
    fn best(&self) -> Option<Vec<f64>> {
        let best = *order(&self.fitness).first()?;
        Some(self.parents.row(best).to_vec()).filter(|_| !has_failed(self.fitness[best]))
    }

    fn immigrate(&mut self, genome: &[f64]) {
        if let Some(last) = self.pending.len().checked_sub(1) {
            self.pending.row_mut(last).copy_from_slice(genome);
        }
    }
}

impl GeneticRun {
    fn go_on(&mut self, batch: &Genomes, fitness: &[f64]) -> Result<(), Fault> {
        match self.redraws {
            0 => self.replace(batch, fitness)?,
            _ => self.complete(batch, fitness)?,
        }
        if self.redraws == 0 { self.breed() } else { Ok(()) }
    }

    fn sizes(&self) -> Sizes {
        Sizes { population: self.settings.population, elites: self.settings.elites }
    }

    /// The first generation: keeps what succeeded and draws the rest again.
    fn complete(&mut self, batch: &Genomes, fitness: &[f64]) -> Result<(), Fault> {
        self.redraws -= 1;
        let size = self.settings.population;
        let last = self.redraws == 0;
        for (k, &fitness) in fitness.iter().enumerate() {
            if !has_failed(fitness) || last {
                self.parents.push(batch.row(k));
                self.fitness.push(fitness);
                self.ages.push(0);
            }
        }
        let missing = size.saturating_sub(self.parents.len());
        if missing == 0 {
            self.redraws = 0;
        } else {
            self.pending = self.settings.redrawing.sample(&self.genes, missing, &mut self.rng)?;
        }
        Ok(())
    }

    /// The next generation of the old one and its offspring.
    fn replace(&mut self, offspring: &Genomes, fitness: &[f64]) -> Result<(), Fault> {
        let brood = Brood {
            old: Rated { genomes: &self.parents, fitness: &self.fitness },
            ages: &self.ages,
            offspring: Rated { genomes: offspring, fitness },
            parents: &self.families,
            genes: &self.genes,
        };
        let survivors = self.settings.survival.survivors(&brood, self.sizes())?;
        let mut next = Genomes::with_capacity(offspring.n_genes(), survivors.len());
        survivors.iter().for_each(|&one| next.push(brood.genome(one)));
        let next_fitness = survivors.iter().map(|&one| brood.fitness(one)).collect();
        let age = |one: &Survivor| match one {
            Survivor::Old(k) => self.ages[*k] + 1,
            Survivor::Offspring(_) => 0,
        };
        self.ages = survivors.iter().map(age).collect();
        (self.parents, self.fitness) = (next, next_fitness);
        Ok(())
    }

    fn breed(&mut self) -> Result<(), Fault> {
        let Genetic { selection, breeding, survival, .. } = &self.settings;
        let count = survival.n_offspring(self.sizes());
        let rng = &mut self.rng;
        let drawn = match selection.draws_all_at_once() {
            true => selection.select(&self.fitness, 2 * count.div_ceil(2), rng)?,
            false => Vec::new(),
        };
        let mut drawn = drawn.chunks_exact(2);
        let mut offspring = Genomes::with_capacity(self.genes.len(), count);
        self.families.clear();
        while offspring.len() < count {
            let pair = match drawn.next() {
                Some(pair) => [pair[0], pair[1]],
                None => {
                    let pair = selection.select(&self.fitness, 2, rng)?;
                    [pair[0], pair[1]]
                }
            };
            let [mut first, mut second] = pair.map(|k| self.parents.row(k).to_vec());
            breeding.cross(&mut first, &mut second, &self.genes, rng)?;
            for child in [&mut first, &mut second] {
                breeding.mutate(child, &self.genes, self.course, rng)?;
                if offspring.len() < count {
                    offspring.push(child);
                    self.families.push(pair);
                }
            }
        }
        self.course.generation += 1;
        self.pending = offspring;
        Ok(())
    }
}
