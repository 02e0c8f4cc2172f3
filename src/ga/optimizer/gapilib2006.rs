//! The genetic algorithm of the paper, number for number as the scripts of GAPILib draw them:
//! crossing points first, then the initial population row by row; in every generation the numbers
//! of the mutation row by row (elites included), then those of the random individuals.
//!
//! Reference: [Rubio et al. 2006](crate::bibliography#rubio-2006), §2 and §3.

use super::{Answers, Method, Optimizer, Setup, whole};
use crate::diag::Fault;
use crate::ga::crossover::cross_adjacent;
use crate::ga::mutation::mutate_uniform;
use crate::ga::sampling::sample_uniform;
use crate::ga::survival::elites_first;
use crate::ga::{Gene, Genomes, Mrg32k3a, sort_by_fitness};
use crate::registry::{BAD_OPTION, Entry};
use crate::{bail, fault};

/// The table entry.
pub(super) const ENTRY: Entry<dyn Method> = Entry {
    name: "gapilib2006",
    aliases: &["gapilib"],
    summary: "the paper's genetic algorithm, exactly",
    reference: "rubio-2006",
    make: |options| {
        Ok(Box::new(Gapilib {
            population: whole(options, "population", 1.0..=1e6, 100.0)?,
            parents: whole(options, "parents", 1.0..=1e6, 70.0)?,
            elites: whole(options, "elites", 0.0..=1e6, 1.0)?,
            cross_points: whole(options, "cross_points", 0.0..=1e3, 1.0)?,
            factor: options.take("mutation", 0.0..=1.0, 0.25)?,
        }))
    },
};

#[derive(Clone, Copy)]
struct Gapilib {
    population: usize,
    parents: usize,
    elites: usize,
    cross_points: usize,
    factor: f64,
}

impl Gapilib {
    fn check(&self) -> Result<(), Fault> {
        if self.parents + self.elites > self.population {
            bail!(
                BAD_OPTION,
                "{} parents and {} elites are more than the population of {}",
                self.parents, self.elites, self.population;
                help: "the paper uses 70, 1 and 100"
            );
        }
        Ok(())
    }
}

impl Method for Gapilib {
    fn start(&self, setup: Setup) -> Result<Box<dyn Optimizer>, Fault> {
        self.check()?;
        let mut rng = setup.rng;
        let room = setup.genes.len().saturating_sub(1) as f64;
        let points = (0..self.cross_points).map(|_| 1 + (room * rng.uniform()) as usize).collect();
        let pending = sample_uniform(&setup.genes, self.population, &mut rng);
        Ok(Box::new(Search { settings: *self, genes: setup.genes, points, rng, pending }))
    }

    fn in_natural_units(&self) -> bool {
        true
    }

    fn can_be_polished(&self) -> bool {
        false
    }
}

struct Search {
    settings: Gapilib,
    genes: Vec<Gene>,
    points: Vec<usize>,
    rng: Mrg32k3a,
    pending: Genomes,
}

impl Optimizer for Search {
    fn ask(&mut self, batch: &mut Genomes) {
        self.pending.rows().for_each(|genome| batch.push(genome));
    }

    fn tell(&mut self, batch: &Genomes, answers: &Answers<'_>) {
        let fitness: Vec<f64> = (0..batch.len()).map(|k| answers.fitness(k)).collect();
        let Ok((ordered, _)) = sort_by_fitness(batch, &fitness) else { return };
        let Gapilib { population, parents, elites, factor, .. } = self.settings;
        let n = self.genes.len();
        // A population that was changed to be larger has fewer individuals behind it.
        let (parents, elites) = (parents.min(ordered.len()), elites.min(ordered.len()));
        let mut chosen = Genomes::with_capacity(n, parents);
        ordered.rows().take(parents).for_each(|genome| chosen.push(genome));
        let children = cross_adjacent(&chosen, &self.points);
        let mut next = elites_first(&ordered, elites, &children);
        let numbers: Vec<f64> = (0..next.len() * n).map(|_| self.rng.uniform()).collect();
        mutate_uniform(&mut next, elites, &self.genes, factor, &numbers);
        let random = population.saturating_sub(next.len());
        let random = sample_uniform(&self.genes, random, &mut self.rng);
        random.rows().for_each(|genome| next.push(genome));
        self.pending = next;
    }

    fn phase(&self) -> &'static str {
        "search"
    }

    fn change(&mut self, setting: &str, value: f64) -> Result<(), Fault> {
        let mut changed = self.settings;
        let size = value.fract() == 0.0 && (0.0..=1e6).contains(&value);
        match setting {
            "mutation" if (0.0..=1.0).contains(&value) => changed.factor = value,
            "parents" if size && value >= 1.0 => changed.parents = value as usize,
            "elites" if size => changed.elites = value as usize,
            "population" if size => changed.population = value as usize,
            _ => return Err(fault!(BAD_OPTION, "`{setting}` cannot become {value}")),
        }
        changed.check()?;
        self.settings = changed;
        Ok(())
    }
}
