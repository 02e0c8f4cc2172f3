//! Refinement as scripts ask for it: what a genetic algorithm has found, brought to the next
//! optimum by least squares.

use super::identification::Request;
use crate::Session;
use crate::builtins::Failure;
use crate::diag::Fault;
use crate::ga::errors::BAD_POPULATION;
use crate::ga::optimizer::{Answers, METHODS, Optimizer, Required, Setup};
use crate::ga::{Gene, Genomes, Individual, Mrg32k3a, best, has_failed};
use crate::identify::fitness::sum_of_squares;
use crate::identify::problem::{Free, NOISE_OF_FORMULAS};
use crate::identify::{CompiledModel, Model};
use crate::models::simulation;
use crate::registry::{self, Options};
use crate::{elementary, fault};

/// Least squares draw no random numbers, but every search has a generator.
const SEED: [f64; 6] = [12345.0; 6];

/// What is refined.
pub(crate) struct Refinement {
    /// The model and the points.
    pub(crate) request: Request,
    /// The measured values of the points.
    pub(crate) measured: Vec<f64>,
    /// The ranges, one for each gene; those wider than a decade are followed by their logarithm.
    pub(crate) ranges: Vec<Free>,
}

/// Everything simulated so far, as one generation.
struct Simulations {
    genomes: Genomes,
    /// Their numbers.
    numbers: Vec<u64>,
    fitness: Vec<f64>,
}

impl Session {
    /// The best individual that Levenberg and Marquardt's method finds from each of these.
    pub(crate) fn refine(
        &mut self,
        mut refinement: Refinement,
        starts: &Genomes,
    ) -> Result<(Individual, u64), Failure> {
        let Refinement { request, measured, .. } = &refinement;
        if let Some(converted) = self.measured_in_unit_of(request, measured)? {
            refinement.measured = converted;
        }
        let refinement = &refinement;
        let n_genes = starts.n_genes();
        let genomes = Genomes::with_capacity(n_genes, 0);
        let mut done = Simulations { genomes, numbers: vec![], fitness: vec![] };
        let noise = self.noise(&refinement.request)?;
        for start in starts.rows() {
            let mut search = descent(refinement, start, noise)?;
            self.follow(refinement, search.as_mut(), noise, &mut done)?;
        }
        let count = done.fitness.len() as u64;
        let recorder = &mut self.identification().recorder;
        recorder.rated(done.numbers, &refinement.measured);
        let ends = |end: fn(&Free) -> f64| refinement.ranges.iter().map(end).collect::<Vec<f64>>();
        recorder.searched(&ends(|free| free.min), &ends(|free| free.max), &done.genomes);
        recorder.refined(&done.genomes, &done.fitness);
        match best(&done.genomes, &done.fitness).filter(|found| !has_failed(found.fitness)) {
            Some(found) => Ok((found, count)),
            None => Err(fault!(BAD_POPULATION, "no individual can be simulated").into()),
        }
    }

    /// Relative error of the simulated values.
    fn noise(&mut self, request: &Request) -> Result<f64, Failure> {
        self.load_model_of(request)?;
        let program = simulation::translated(self, &request.model)?.program.clone();
        if program.sorted().states.is_empty() {
            return Ok(NOISE_OF_FORMULAS);
        }
        Ok(CompiledModel::new(&request.model, program).settings().tolerance)
    }

    /// Asks and answers until the search has converged.
    fn follow(
        &mut self,
        refinement: &Refinement,
        search: &mut dyn Optimizer,
        noise: f64,
        done: &mut Simulations,
    ) -> Result<(), Failure> {
        let n_genes = refinement.ranges.len();
        loop {
            let mut question = Genomes::with_capacity(n_genes, n_genes);
            search.ask(&mut question);
            if question.is_empty() || self.is_interrupted() {
                return Ok(());
            }
            let first = done.fitness.len();
            let residuals = self.residuals(refinement, &question, done)?;
            let answered = done.fitness.len();
            let jacobians = match search.required() {
                Required::Jacobians => self.jacobians(refinement, &question, noise, done)?,
                _ => Vec::new(),
            };
            let objectives = &done.fitness[first..answered];
            search.tell(
                &question,
                &Answers {
                    objectives,
                    n_objectives: 1,
                    residuals: &residuals,
                    jacobians: &jacobians,
                },
            );
        }
    }

    /// Derivatives of the residuals by the fractions, by differences of all genes at once.
    fn jacobians(
        &mut self,
        refinement: &Refinement,
        question: &Genomes,
        noise: f64,
        done: &mut Simulations,
    ) -> Result<Vec<f64>, Failure> {
        let (n, m) = (question.n_genes(), refinement.measured.len());
        let step = elementary::cbrt(noise).clamp(1e-6, 1e-2);
        let mut ends = Genomes::with_capacity(n, 2 * n * question.len());
        for point in question.rows() {
            for (j, side) in (0..n).flat_map(|j| [(j, -step), (j, step)]) {
                let mut end = point.to_vec();
                end[j] = (end[j] + side * end[j].abs().max(0.1)).clamp(0.0, 1.0);
                ends.push(&end);
            }
        }
        let rows = self.residuals(refinement, &ends, done)?;
        let mut jacobians = vec![f64::NAN; question.len() * m * n];
        for (k, j) in (0..question.len()).flat_map(|k| (0..n).map(move |j| (k, j))) {
            let low = 2 * (k * n + j);
            let length = ends.row(low + 1)[j] - ends.row(low)[j];
            for point in 0..m {
                let difference = rows[(low + 1) * m + point] - rows[low * m + point];
                jacobians[(k * m + point) * n + j] = difference / length;
            }
        }
        Ok(jacobians)
    }

    /// The residuals of some individuals of the unit cube, NaN where a simulation fails.
    fn residuals(
        &mut self,
        refinement: &Refinement,
        question: &Genomes,
        done: &mut Simulations,
    ) -> Result<Vec<f64>, Failure> {
        let measured = &refinement.measured;
        let mut genomes = Genomes::with_capacity(question.n_genes(), question.len());
        for point in question.rows() {
            let value = |(free, &u): (&Free, &f64)| free.value(u);
            genomes.push(&refinement.ranges.iter().zip(point).map(value).collect::<Vec<f64>>());
        }
        let (simulated, first) = self.evaluate_population(refinement.request.clone(), &genomes)?;
        let rows = simulated.rows.chunks(measured.len());
        done.fitness.extend(rows.map(|row| sum_of_squares(row, measured)));
        done.numbers.extend((first..).take(genomes.len()));
        genomes.rows().for_each(|genome| done.genomes.push(genome));
        let points = simulated.rows.iter().zip(measured.iter().cycle());
        Ok(points.map(|(simulated, measured)| simulated - measured).collect())
    }
}

fn descent(
    refinement: &Refinement,
    start: &[f64],
    noise: f64,
) -> Result<Box<dyn Optimizer>, Fault> {
    let entry = registry::find("method", METHODS, "levenberg_marquardt")?;
    let method = (entry.make)(&mut Options::default())?;
    let genes = refinement.ranges.iter().map(|free| Gene::new(&free.name, free.min, free.max));
    let fraction = |(free, &value): (&Free, &f64)| free.fraction(value);
    method.start(Setup {
        genes: genes.collect::<Result<_, Fault>>()?,
        scales: Vec::new(),
        n_objectives: 1,
        budget: None,
        start: Some(refinement.ranges.iter().zip(start).map(fraction).collect()),
        noise,
        size: refinement.measured.iter().map(|y| y * y).sum::<f64>().sqrt(),
        rng: Mrg32k3a::new(&SEED)?,
    })
}
