//! Operators of the genetic algorithm on arrays.

use crate::errors::raised_fault;
use crate::values;
use gapilib::Fault;
use gapilib::internals::ga::crossover::Parents;
use gapilib::internals::ga::mutation::{Child, Course};
use gapilib::internals::ga::{Gene, Genomes, Mrg32k3a, operators};
use gapilib::internals::registry::Choice;
use numpy::{PyArray1, PyArray2, PyArrayMethods};
use pyo3::prelude::*;
use std::sync::{Mutex, MutexGuard, PoisonError};

/// The random numbers of GAPILib (`Ram_Gen_ARENA`): L'Ecuyer's MRG32k3a from six whole numbers.
#[pyclass(frozen, module = "gapilib")]
pub(crate) struct Random(Mutex<Mrg32k3a>);

impl Random {
    fn generator(&self) -> MutexGuard<'_, Mrg32k3a> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

#[pymethods]
impl Random {
    #[new]
    #[pyo3(signature = (seed=None))]
    fn new(py: Python<'_>, seed: Option<Vec<f64>>) -> PyResult<Random> {
        let seed = seed.unwrap_or(Mrg32k3a::DEFAULT_SEED.to_vec());
        let generator = Mrg32k3a::new(&seed).map_err(|fault| raised_fault(py, fault))?;
        Ok(Random(Mutex::new(generator)))
    }

    /// The next numbers between 0 and 1.
    fn uniform<'py>(&self, py: Python<'py>, count: usize) -> Bound<'py, PyArray1<f64>> {
        let mut generator = self.generator();
        PyArray1::from_vec(py, (0..count).map(|_| generator.uniform()).collect())
    }

    /// The next numbers of the standard normal distribution.
    fn normal<'py>(&self, py: Python<'py>, count: usize) -> Bound<'py, PyArray1<f64>> {
        let mut generator = self.generator();
        PyArray1::from_vec(py, (0..count).map(|_| generator.normal()).collect())
    }

    /// Its state in the order of the seed: `Random` of it continues from here.
    #[getter]
    fn state(&self) -> Vec<f64> {
        self.generator().state().to_vec()
    }
}

fn genes(bounds: &[(f64, f64)]) -> Result<Vec<Gene>, Fault> {
    let named = |(k, &(min, max)): (usize, &(f64, f64))| Gene::new(format!("x{}", k + 1), min, max);
    bounds.iter().enumerate().map(named).collect()
}

fn array<'py>(py: Python<'py>, genomes: &Genomes) -> PyResult<Bound<'py, PyArray2<f64>>> {
    let rows = PyArray1::from_slice(py, genomes.values());
    rows.reshape([genomes.len(), genomes.n_genes()])
}

/// `count` individuals within the bounds, by a sampling: "latin_hypercube", "uniform", "sobol" or
/// "halton".
#[pyfunction]
#[pyo3(signature = (bounds, count, *, method="uniform", random))]
fn sample<'py>(
    py: Python<'py>,
    bounds: Vec<(f64, f64)>,
    count: usize,
    method: &str,
    random: &Random,
) -> PyResult<Bound<'py, PyArray2<f64>>> {
    let sampled = || {
        let sampling = operators::sampling(Choice::parse(method)?)?;
        sampling.sample(&genes(&bounds)?, count, &mut random.generator())
    };
    array(py, &sampled().map_err(|fault| raised_fault(py, fault))?)
}

/// The places of `count` parents by their fitness, of which a smaller one is better, in the order in
/// which they mate.
#[pyfunction]
#[pyo3(signature = (fitness, count, *, method="tournament", random))]
fn select(
    py: Python<'_>,
    fitness: Vec<f64>,
    count: usize,
    method: &str,
    random: &Random,
) -> PyResult<Vec<usize>> {
    let selected = || {
        let selection = operators::selection(Choice::parse(method)?)?;
        match fitness.is_empty() {
            true => Ok(Vec::new()),
            false => selection.select(&fitness, count, &mut random.generator()),
        }
    };
    selected().map_err(|fault| raised_fault(py, fault))
}

/// The children of a matrix of parents: the first row is crossed with the second, the third with the
/// fourth; a last one without partner stays as it is.
#[pyfunction]
#[pyo3(signature = (parents, bounds, *, method="one_point", random))]
fn cross<'py>(
    py: Python<'py>,
    parents: &Bound<'_, PyAny>,
    bounds: Vec<(f64, f64)>,
    method: &str,
    random: &Random,
) -> PyResult<Bound<'py, PyArray2<f64>>> {
    let (mut rows, _) = values::rows(parents, bounds.len(), "the parents")?;
    let crossed = || {
        let crossover = operators::crossover(Choice::parse(method)?)?;
        let (genes, mut rng) = (genes(&bounds)?, random.generator());
        let width = genes.len();
        let own = crossover.for_run(width, &mut rng);
        let crossover = own.unwrap_or(crossover);
        for pair in rows.chunks_exact_mut(2 * width) {
            let (first, second) = pair.split_at_mut(width);
            crossover.cross(Parents { first, second, genes: &genes }, &mut rng)?;
        }
        Genomes::new(width, rows)
    };
    array(py, &crossed().map_err(|fault| raised_fault(py, fault))?)
}

/// A population in which each gene has been mutated with the probability `rate`.
#[pyfunction]
#[pyo3(signature = (population, bounds, rate, *, method="uniform", generation=0, random))]
fn mutate<'py>(
    py: Python<'py>,
    population: &Bound<'_, PyAny>,
    bounds: Vec<(f64, f64)>,
    rate: f64,
    method: &str,
    generation: u64,
    random: &Random,
) -> PyResult<Bound<'py, PyArray2<f64>>> {
    let (rows, _) = values::rows(population, bounds.len(), "the population")?;
    let mutated = || {
        let mutation = operators::mutation(Choice::parse(method)?)?;
        let (genes, mut rng) = (genes(&bounds)?, random.generator());
        let mut genomes = Genomes::new(genes.len(), rows)?;
        let course = Course { generation, planned: None };
        for k in 0..genomes.len() {
            let child = Child { genome: genomes.row_mut(k), genes: &genes, rate, course };
            mutation.mutate(child, &mut rng)?;
        }
        Ok(genomes)
    };
    let mutated: Result<Genomes, Fault> = mutated();
    array(py, &mutated.map_err(|fault| raised_fault(py, fault))?)
}

/// Adds the functions of this file.
pub(crate) fn add(module: &Bound<'_, PyModule>) -> PyResult<()> {
    module.add_function(wrap_pyfunction!(sample, module)?)?;
    module.add_function(wrap_pyfunction!(select, module)?)?;
    module.add_function(wrap_pyfunction!(cross, module)?)?;
    module.add_function(wrap_pyfunction!(mutate, module)?)
}
