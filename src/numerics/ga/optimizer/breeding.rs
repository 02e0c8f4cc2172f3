//! What the methods that breed share: which operators they were given, and how often crossover and
//! mutation take place.

use super::Setup;
use crate::diag::Fault;
use crate::ga::crossover::{Crossover, Parents};
use crate::ga::mutation::{Child, Course, Mutation};
use crate::ga::operators::{self, usual};
use crate::ga::{Gene, Mrg32k3a};
use crate::registry::{Choice, Options};
use std::sync::Arc;

/// The operators that were chosen in place of the usual ones: their kinds, and their names with
/// the settings given.
pub(crate) type Chosen = Vec<(&'static str, String)>;

/// The choice of this kind, or the usual one.
pub(crate) fn take(
    options: &mut Options,
    kind: &'static str,
    usual: Choice,
    chosen: &mut Chosen,
) -> Choice {
    match options.take_choice(kind) {
        Some(choice) => {
            chosen.push((kind, choice.label()));
            choice
        }
        None => usual,
    }
}

/// Crossover and mutation of a method.
#[derive(Clone)]
pub(crate) struct Breeding {
    crossover: Arc<dyn Crossover>,
    /// How likely a pair is crossed; without a number every pair is, and none is drawn.
    pub(super) probability: Option<f64>,
    mutation: Arc<dyn Mutation>,
    /// How likely a gene mutates.
    pub(super) rate: f64,
    /// Whether the rate 0 stands for one gene in each individual.
    zero_is_one_gene: bool,
}

impl Breeding {
    /// Simulated binary crossover of nine pairs in ten and polynomial mutation of one gene in each
    /// individual, unless others are chosen.
    pub(crate) fn on_real_genes(
        options: &mut Options,
        chosen: &mut Chosen,
    ) -> Result<Breeding, Fault> {
        let (crossover, probability) = match options.take_choice("crossover") {
            Some(choice) => crossover(choice, 0.9, chosen)?,
            None => {
                let probability = options.take("crossover", 0.0..=1.0, 0.9)?;
                let eta = options.take("eta_crossover", 0.0..=1000.0, 15.0)?;
                (operators::crossover(usual("sbx", &[("eta", eta)]))?, probability)
            }
        };
        let (mutation, rate) = match options.take_choice("mutation") {
            Some(choice) => mutation(choice, 0.0, chosen)?,
            None => {
                let rate = options.take("mutation", 0.0..=1.0, 0.0)?;
                let eta = options.take("eta_mutation", 0.0..=1000.0, 20.0)?;
                (operators::mutation(usual("polynomial", &[("eta", eta)]))?, rate)
            }
        };
        let probability = Some(probability);
        Ok(Breeding { crossover, probability, mutation, rate, zero_is_one_gene: true })
    }

    /// The crossover and the mutation of the paper, unless others are chosen.
    pub(crate) fn of_the_paper(
        options: &mut Options,
        chosen: &mut Chosen,
    ) -> Result<Breeding, Fault> {
        let (crossover, probability) = match options.take_choice("crossover") {
            Some(choice) => crossover(choice, 1.0, chosen)?,
            None => {
                let points = options.take_whole("cross_points", 0.0..=1e3, 1.0)? as f64;
                (operators::crossover(usual("fixed_points", &[("points", points)]))?, 1.0)
            }
        };
        let (mutation, rate) = match options.take_choice("mutation") {
            Some(choice) => mutation(choice, 0.25, chosen)?,
            None => {
                let rate = options.take("mutation", 0.0..=1.0, 0.25)?;
                (operators::mutation(usual("uniform", &[]))?, rate)
            }
        };
        let probability = Some(probability).filter(|probability| *probability < 1.0);
        Ok(Breeding { crossover, probability, mutation, rate, zero_is_one_gene: false })
    }

    /// These for one run.
    pub(crate) fn for_run(&self, n_genes: usize, rng: &mut Mrg32k3a) -> Breeding {
        let crossover = self.crossover.for_run(n_genes, rng);
        Breeding { crossover: crossover.unwrap_or_else(|| self.crossover.clone()), ..self.clone() }
    }

    /// Recombines two parents to two children, or copies them unaltered.
    pub(crate) fn cross(
        &self,
        first: &mut [f64],
        second: &mut [f64],
        genes: &[Gene],
        rng: &mut Mrg32k3a,
    ) -> Result<(), Fault> {
        if self.probability.is_none_or(|probability| rng.uniform() < probability) {
            self.crossover.cross(Parents { first, second, genes }, rng)?;
        }
        Ok(())
    }

    /// Mutates a child.
    pub(crate) fn mutate(
        &self,
        child: &mut [f64],
        genes: &[Gene],
        course: Course,
        rng: &mut Mrg32k3a,
    ) -> Result<(), Fault> {
        let one_gene = self.zero_is_one_gene && self.rate == 0.0;
        let rate = if one_gene { 1.0 / genes.len() as f64 } else { self.rate };
        self.mutation.mutate(Child { genome: child, genes, rate, course }, rng)
    }
}

/// A chosen crossover with its probability.
fn crossover(
    choice: Choice,
    usual: f64,
    chosen: &mut Chosen,
) -> Result<(Arc<dyn Crossover>, f64), Fault> {
    let (choice, probability) = frequency("crossover", "probability", choice, usual, chosen)?;
    Ok((operators::crossover(choice)?, probability))
}

/// A chosen mutation with its rate.
fn mutation(
    choice: Choice,
    usual: f64,
    chosen: &mut Chosen,
) -> Result<(Arc<dyn Mutation>, f64), Fault> {
    let (choice, rate) = frequency("mutation", "rate", choice, usual, chosen)?;
    Ok((operators::mutation(choice)?, rate))
}

/// How often an operator takes place: a setting beside its own.
fn frequency(
    kind: &'static str,
    setting: &str,
    mut choice: Choice,
    usual: f64,
    chosen: &mut Chosen,
) -> Result<(Choice, f64), Fault> {
    chosen.push((kind, choice.label()));
    let value = choice.options.take(setting, 0.0..=1.0, usual).map_err(|mut fault| {
        fault.message = format!("{kind} `{}`: {}", choice.name, fault.message);
        fault
    })?;
    Ok((choice, value))
}

/// The generations that a run is to have, where its evaluations are known.
pub(crate) fn planned(setup: &Setup, individuals: usize) -> Option<f64> {
    setup.budget.map(|budget| budget as f64 / individuals.max(1) as f64)
}

/// The genes in the unit cube.
pub(crate) fn unit(genes: Vec<Gene>) -> Vec<Gene> {
    genes.into_iter().map(|gene| Gene { min: 0.0, max: 1.0, ..gene }).collect()
}
