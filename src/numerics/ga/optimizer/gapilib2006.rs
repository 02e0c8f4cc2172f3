//! The genetic algorithm of the paper, number for number as the scripts of GAPILib draw them:
//! crossing points first, then the initial population row by row; in every generation the numbers
//! of the mutation row by row (elites included), then those of the random individuals.
//!
//! Reference: [Rubio et al. 2006](gapilib_base::bibliography#rubio-2006), §2 and §3.

use super::breeding::{self, Breeding, Chosen};
use super::{Answers, Method, Optimizer, Setup};
use crate::diag::Fault;
use crate::ga::crossover::cross_rows;
use crate::ga::mutation::Course;
use crate::ga::operators::{self, usual};
use crate::ga::sampling::Sampling;
use crate::ga::selection::Selection;
use crate::ga::survival::elites_first;
use crate::ga::{Gene, Genomes, Mrg32k3a, sort_by_fitness};
use crate::registry::{BAD_OPTION, Entry, Options};
use crate::{bail, fault};
use std::sync::Arc;

/// The table entry.
pub(crate) const ENTRY: Entry<dyn Method> = Entry {
    name: "gapilib2006",
    aliases: &["gapilib"],
    summary: "the genetic algorithm of the paper, exactly",
    reference: "rubio-2006",
    make: |options| Ok(Box::new(Gapilib::new(options)?)),
};

#[derive(Clone)]
struct Gapilib {
    population: usize,
    parents: usize,
    elites: usize,
    sampling: Arc<dyn Sampling>,
    selection: Arc<dyn Selection>,
    breeding: Breeding,
    chosen: Chosen,
}

impl Gapilib {
    fn new(options: &mut Options) -> Result<Gapilib, Fault> {
        let mut chosen = Chosen::new();
        if let Some(choice) = options.take_choice("survival").filter(|own| own.name != "elitism") {
            bail!(
                BAD_OPTION,
                "`gapilib2006` keeps its elites and adds random individuals; `{}` cannot replace \
                 that", choice.name;
                help: "use the method `genetic`, or set `elites`"
            );
        }
        let population = options.take_whole("population", 1.0..=1e6, 100.0)?;
        let parents = options.take_whole("parents", 1.0..=1e6, 70.0)?;
        let elites = options.take_whole("elites", 0.0..=1e6, 1.0)?;
        let sampling = breeding::take(options, "sampling", usual("uniform", &[]), &mut chosen);
        // The number of parents alone says who is one.
        let selection = usual("truncation", &[("share", 1.0)]);
        let selection = breeding::take(options, "selection", selection, &mut chosen);
        Ok(Gapilib {
            population,
            parents,
            elites,
            sampling: operators::sampling(sampling)?,
            selection: operators::selection(selection)?,
            breeding: Breeding::of_the_paper(options, &mut chosen)?,
            chosen,
        })
    }

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
        let planned = breeding::planned(&setup, self.population);
        let mut rng = setup.rng;
        let breeding = self.breeding.for_run(setup.genes.len(), &mut rng);
        let pending = self.sampling.sample(&setup.genes, self.population, &mut rng)?;
        Ok(Box::new(PaperRun {
            settings: Gapilib { breeding, ..self.clone() },
            genes: setup.genes,
            rng,
            pending,
            course: Course { generation: 0, planned },
            fault: None,
        }))
    }

    fn operators(&self) -> Vec<(&'static str, String)> {
        self.chosen.clone()
    }

    fn in_natural_units(&self) -> bool {
        true
    }

    fn can_be_polished(&self) -> bool {
        false
    }
}

struct PaperRun {
    settings: Gapilib,
    genes: Vec<Gene>,
    rng: Mrg32k3a,
    pending: Genomes,
    course: Course,
    fault: Option<Fault>,
}

impl Optimizer for PaperRun {
    fn ask(&mut self, batch: &mut Genomes) {
        self.pending.rows().for_each(|genome| batch.push(genome));
    }

    fn tell(&mut self, batch: &Genomes, answers: &Answers<'_>) {
        let fitness: Vec<f64> = (0..batch.len()).map(|k| answers.fitness(k)).collect();
        let next = self.next(batch, &fitness);
        let none = || Genomes::with_capacity(self.genes.len(), 0);
        (self.pending, self.fault) = match next {
            Ok(next) => (next, None),
            Err(fault) => (none(), Some(fault)),
        };
    }

    fn fault(&self) -> Option<&Fault> {
        self.fault.as_ref()
    }

    fn phase(&self) -> &'static str {
        "search"
    }

    fn change(&mut self, setting: &str, value: f64) -> Result<(), Fault> {
        let mut changed = self.settings.clone();
        let size = value.fract() == 0.0 && (0.0..=1e6).contains(&value);
        match setting {
            "mutation" if (0.0..=1.0).contains(&value) => changed.breeding.rate = value,
            "parents" if size && value >= 1.0 => changed.parents = value as usize,
            "elites" if size => changed.elites = value as usize,
            "population" if size => changed.population = value as usize,
            _ => return Err(fault!(BAD_OPTION, "`{setting}` cannot be set to {value}")),
        }
        changed.check()?;
        self.settings = changed;
        Ok(())
    }
}

impl PaperRun {
    /// The next generation: elites, children, random individuals.
    fn next(&mut self, batch: &Genomes, fitness: &[f64]) -> Result<Genomes, Fault> {
        let (ordered, fitness) = sort_by_fitness(batch, fitness)?;
        let Gapilib { population, parents, elites, sampling, selection, breeding, .. } =
            &self.settings;
        let rng = &mut self.rng;
        // After the population was enlarged, the evaluated generation is still the smaller one.
        let (parents, elites) = ((*parents).min(ordered.len()), (*elites).min(ordered.len()));
        let mut chosen = Genomes::with_capacity(self.genes.len(), parents);
        let places = selection.select(&fitness, parents, rng)?;
        places.into_iter().for_each(|k| chosen.push(ordered.row(k)));
        let children = cross_rows(&chosen, |a, b| breeding.cross(a, b, &self.genes, rng))?;
        let mut next = elites_first(&ordered, elites, &children);
        for k in 0..next.len() {
            // The scripts draw numbers for the elites as well.
            let mut mutated = next.row(k).to_vec();
            breeding.mutate(&mut mutated, &self.genes, self.course, rng)?;
            if k >= elites {
                next.row_mut(k).copy_from_slice(&mutated);
            }
        }
        let random = sampling.sample(&self.genes, population.saturating_sub(next.len()), rng)?;
        random.rows().for_each(|genome| next.push(genome));
        self.course.generation += 1;
        Ok(next)
    }
}
