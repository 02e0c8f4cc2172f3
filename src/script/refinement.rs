//! Refinement as scripts ask for it: what a genetic algorithm has found, brought to the next
//! optimum by least squares.

use super::builtins::Failure;
use super::identification::Request;
use super::{Session, simulation};
use crate::diag::Fault;
use crate::fault;
use crate::ga::errors::BAD_POPULATION;
use crate::ga::optimizer::{Answers, METHODS, Optimizer, Setup};
use crate::ga::{Gene, Genomes, Individual, Mrg32k3a, best, has_failed};
use crate::identify::fitness::sum_of_squares;
use crate::identify::problem::{Free, NOISE_OF_FORMULAS, difference};
use crate::identify::{CompiledModel, Model};
use crate::registry::{self, Options};

/// Least squares draw no random numbers, but every search has a generator.
const SEED: [f64; 6] = [12345.0; 6];

/// What is refined.
pub(super) struct Refinement {
    /// The model and the points.
    pub(super) request: Request,
    /// The measured values of the points.
    pub(super) measured: Vec<f64>,
    /// The ranges, one for each gene; those wider than a decade are followed by their logarithm.
    pub(super) ranges: Vec<Free>,
}

/// Everything simulated so far, as one generation.
struct Simulations {
    genomes: Genomes,
    /// Their simulated points, one after the other.
    rows: Vec<f64>,
    fitness: Vec<f64>,
}

impl Session {
    /// The best individual that Levenberg and Marquardt's method finds from each of these.
    pub(super) fn refine(
        &mut self,
        refinement: &Refinement,
        starts: &Genomes,
    ) -> Result<(Individual, u64), Failure> {
        let n_genes = starts.n_genes();
        let genomes = Genomes::with_capacity(n_genes, 0);
        let mut done = Simulations { genomes, rows: vec![], fitness: vec![] };
        let difference = self.difference(&refinement.request)?;
        for start in starts.rows() {
            let mut search = descent(refinement, start, difference)?;
            self.follow(refinement, search.as_mut(), n_genes, &mut done)?;
        }
        let count = done.fitness.len() as u64;
        let recorder = &mut self.identification().recorder;
        recorder.rated(&done.rows, &refinement.measured);
        recorder.ordered(&done.genomes, &done.fitness);
        match best(&done.genomes, &done.fitness).filter(|found| !has_failed(found.fitness)) {
            Some(found) => Ok((found, count)),
            None => Err(fault!(BAD_POPULATION, "none of the individuals can be simulated").into()),
        }
    }

    /// Step of finite differences in the unit cube, matched to the errors of the simulation.
    fn difference(&mut self, request: &Request) -> Result<f64, Failure> {
        self.load_model_of(request)?;
        let program = simulation::translated(self, &request.model)?.program.clone();
        if program.sorted().states.is_empty() {
            return Ok(difference(NOISE_OF_FORMULAS));
        }
        Ok(difference(CompiledModel::new(&request.model, program).settings().tolerance))
    }

    /// Asks and answers until the search has converged.
    fn follow(
        &mut self,
        refinement: &Refinement,
        search: &mut dyn Optimizer,
        n_genes: usize,
        done: &mut Simulations,
    ) -> Result<(), Failure> {
        loop {
            let mut question = Genomes::with_capacity(n_genes, n_genes);
            search.ask(&mut question);
            if question.is_empty() || self.is_interrupted() {
                return Ok(());
            }
            let mut natural = Genomes::with_capacity(n_genes, question.len());
            for point in question.rows() {
                let value = |(free, &u): (&Free, &f64)| free.value(u);
                natural.push(&refinement.ranges.iter().zip(point).map(value).collect::<Vec<f64>>());
            }
            let first = done.fitness.len();
            let residuals = self.residuals(refinement, &natural, done)?;
            let objectives = &done.fitness[first..];
            search.tell(&question, &Answers { objectives, n_objectives: 1, residuals: &residuals });
        }
    }

    /// The residuals of some individuals, NaN where a simulation fails.
    fn residuals(
        &mut self,
        refinement: &Refinement,
        genomes: &Genomes,
        done: &mut Simulations,
    ) -> Result<Vec<f64>, Failure> {
        let measured = &refinement.measured;
        let simulated = self.evaluate_population(refinement.request.clone(), genomes)?;
        let rows = simulated.rows.chunks(measured.len());
        done.fitness.extend(rows.map(|row| sum_of_squares(row, measured)));
        done.rows.extend_from_slice(&simulated.rows);
        genomes.rows().for_each(|genome| done.genomes.push(genome));
        let points = simulated.rows.iter().zip(measured.iter().cycle());
        Ok(points.map(|(simulated, measured)| simulated - measured).collect())
    }
}

fn descent(
    refinement: &Refinement,
    start: &[f64],
    difference: f64,
) -> Result<Box<dyn Optimizer>, Fault> {
    let entry = registry::find("method", METHODS, "levenberg_marquardt")?;
    let method = (entry.make)(&mut Options::default())?;
    let genes = refinement.ranges.iter().map(|free| Gene::new(&free.name, free.min, free.max));
    let fraction = |(free, &value): (&Free, &f64)| free.fraction(value);
    method.start(Setup {
        genes: genes.collect::<Result<_, Fault>>()?,
        n_objectives: 1,
        budget: None,
        start: Some(refinement.ranges.iter().zip(start).map(fraction).collect()),
        difference,
        rng: Mrg32k3a::new(&SEED)?,
    })
}
