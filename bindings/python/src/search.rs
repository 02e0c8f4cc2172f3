//! Searches by ask and tell.

use crate::errors::raised_fault;
use crate::values;
use gapilib::internals::ga::optimizer::{Answers, METHODS, Optimizer as Search, Required, Setup};
use gapilib::internals::ga::{Gene, Genomes, Mrg32k3a};
use gapilib::internals::registry::{Choice, Options, find};
use indexmap::IndexMap;
use numpy::{PyArray1, PyArray2, PyArrayMethods};
use pyo3::exceptions::{PyRuntimeError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::PyString;
use std::sync::{Mutex, MutexGuard, PoisonError};

/// Default relative error of the answers.
const NOISE: f64 = 1e-9;

/// A search: `ask()` gives the rows of genes to evaluate next, `tell(fitness)` how good they are;
/// smaller is better. When `ask` gives no rows, the search has converged.
///
/// The same seed and the same answers give the same questions.
#[pyclass(frozen, module = "gapilib")]
pub(crate) struct Optimizer {
    genes: Vec<Gene>,
    in_natural_units: bool,
    state: Mutex<State>,
}

struct State {
    search: Box<dyn Search>,
    batch: Genomes,
    /// Whether the batch waits for its answers.
    is_asked: bool,
    best: Option<(Vec<f64>, f64)>,
}

impl Optimizer {
    fn state(&self) -> MutexGuard<'_, State> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Genes as the asker knows them, in their ranges.
    fn natural(&self, genome: &[f64]) -> Vec<f64> {
        let pairs = self.genes.iter().zip(genome);
        pairs.map(|(gene, &u)| if self.in_natural_units { u } else { gene.at(u) }).collect()
    }
}

#[pymethods]
impl Optimizer {
    /// `bounds`: pairs of least and greatest value, one for each gene. `settings`: numbers, and
    /// operators by name such as `crossover="sbx(eta = 5)"`.
    #[new]
    #[pyo3(signature = (bounds, *, method="genetic", seed=None, start=None, budget=None,
        objectives=1, data_norm=1.0, settings=IndexMap::new()))]
    #[allow(clippy::too_many_arguments, reason = "arguments of Python, all named")]
    fn new(
        py: Python<'_>,
        bounds: Vec<(f64, f64)>,
        method: &str,
        seed: Option<Vec<f64>>,
        start: Option<Vec<f64>>,
        budget: Option<u64>,
        objectives: usize,
        data_norm: f64,
        settings: IndexMap<String, Bound<'_, PyAny>>,
    ) -> PyResult<Optimizer> {
        let fault = |fault| raised_fault(py, fault);
        if bounds.is_empty() || objectives == 0 {
            return Err(PyValueError::new_err("at least one gene and one objective"));
        }
        let named =
            |(k, &(min, max)): (usize, &(f64, f64))| Gene::new(format!("x{}", k + 1), min, max);
        let genes = bounds.iter().enumerate().map(named).collect::<Result<Vec<_>, _>>();
        let genes = genes.map_err(fault)?;
        let mut options = options(py, settings)?;
        let entry = find("method", METHODS, method).map_err(fault)?;
        let method = (entry.make)(&mut options).map_err(fault)?;
        options.finish().map_err(fault)?;
        let seed = seed.unwrap_or(Mrg32k3a::DEFAULT_SEED.to_vec());
        if start.as_ref().is_some_and(|start| start.len() != genes.len()) {
            return Err(PyValueError::new_err("`start` must have a value for each gene"));
        }
        let fractions = |start: Vec<f64>| {
            genes.iter().zip(start).map(|(gene, x)| gene.fraction(x).clamp(0.0, 1.0)).collect()
        };
        let setup = Setup {
            start: start.map(fractions),
            genes: genes.clone(),
            scales: Vec::new(),
            n_objectives: objectives,
            budget,
            noise: NOISE,
            size: data_norm,
            rng: Mrg32k3a::new(&seed).map_err(fault)?,
        };
        let search = method.start(setup).map_err(fault)?;
        let batch = Genomes::with_capacity(genes.len(), 0);
        let state = State { search, batch, is_asked: false, best: None };
        Ok(Optimizer {
            in_natural_units: method.in_natural_units(),
            genes,
            state: Mutex::new(state),
        })
    }

    /// The names of all methods, the default first.
    #[staticmethod]
    fn methods() -> Vec<&'static str> {
        METHODS.iter().map(|entry| entry.name).collect()
    }

    /// The individuals to evaluate next: rows of genes within their bounds. Asked twice without an
    /// answer, it asks the same.
    fn ask<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        let mut state = self.state();
        let State { search, batch, is_asked, .. } = &mut *state;
        if !*is_asked {
            *batch = Genomes::with_capacity(self.genes.len(), 0);
            search.ask(batch);
            *is_asked = !batch.is_empty();
        }
        if let Some(fault) = search.fault() {
            return Err(raised_fault(py, fault.clone()));
        }
        let rows: Vec<f64> = batch.rows().flat_map(|genome| self.natural(genome)).collect();
        PyArray1::from_vec(py, rows).reshape([batch.len(), self.genes.len()])
    }

    /// What the next answer must hold besides the fitness: "fitness", "residuals" (with them) or
    /// "jacobians" (both).
    #[getter]
    fn wants(&self) -> &'static str {
        match self.state().search.required() {
            Required::Objectives => "fitness",
            Required::Residuals => "residuals",
            Required::Jacobians => "jacobians",
        }
    }

    /// Answers the last question, row by row: the fitness (or objectives, a row each; NaN for an
    /// individual that has failed), and where `wants` says so the residuals (rows × residuals) and their
    /// derivatives by the genes (rows × residuals × genes).
    #[pyo3(signature = (fitness, residuals=None, jacobians=None))]
    fn tell(
        &self,
        fitness: &Bound<'_, PyAny>,
        residuals: Option<&Bound<'_, PyAny>>,
        jacobians: Option<&Bound<'_, PyAny>>,
    ) -> PyResult<()> {
        let mut state = self.state();
        let State { search, batch, is_asked, best } = &mut *state;
        if !*is_asked {
            return Err(PyRuntimeError::new_err("nothing was asked: call `ask` first"));
        }
        let count = batch.len();
        let objectives: Vec<f64> = flat(fitness)?
            .into_iter()
            .map(
                |value| {
                    if value.is_finite() { value } else { gapilib::internals::ga::FAILED_FITNESS }
                },
            )
            .collect();
        let residuals = residuals.map(flat).transpose()?.unwrap_or_default();
        let mut jacobians = jacobians.map(flat).transpose()?.unwrap_or_default();
        let n_objectives = objectives.len() / count;
        if objectives.len() != n_objectives * count || n_objectives == 0 {
            return Err(PyValueError::new_err(format!("{count} individuals need {count} answers")));
        }
        let required = search.required();
        let n_residuals = residuals.len() / count;
        if required >= Required::Residuals && (residuals.is_empty() || residuals.len() % count != 0)
        {
            return Err(PyValueError::new_err(
                "this question wants `residuals`, a row for each individual",
            ));
        }
        let n_genes = self.genes.len();
        if required == Required::Jacobians && jacobians.len() != count * n_residuals * n_genes {
            return Err(PyValueError::new_err(
                "this question wants `jacobians`: individuals × residuals × genes",
            ));
        }
        if !self.in_natural_units {
            // The search works with fractions of the ranges.
            for (k, value) in jacobians.iter_mut().enumerate() {
                let gene = &self.genes[k % n_genes];
                *value *= gene.max - gene.min;
            }
        }
        for (genome, &fitness) in batch.rows().zip(objectives.iter().step_by(n_objectives)) {
            if best.as_ref().is_none_or(|(_, known)| fitness < *known) {
                *best = Some((self.natural(genome), fitness));
            }
        }
        let answers = Answers {
            objectives: &objectives,
            n_objectives,
            residuals: &residuals,
            jacobians: &jacobians,
        };
        search.tell(batch, &answers);
        *is_asked = false;
        Ok(())
    }

    /// The best genes so far and their fitness; None before the first answer.
    #[getter]
    fn best<'py>(&self, py: Python<'py>) -> Option<(Bound<'py, PyArray1<f64>>, f64)> {
        let state = self.state();
        state.best.as_ref().map(|(genes, fitness)| (PyArray1::from_slice(py, genes), *fitness))
    }

    /// What it is doing, in one word.
    #[getter]
    fn phase(&self) -> &'static str {
        self.state().search.phase()
    }
}

/// Settings of a method: numbers, and operators by name.
fn options(py: Python<'_>, settings: IndexMap<String, Bound<'_, PyAny>>) -> PyResult<Options> {
    let mut options = Options::default();
    for (name, value) in settings {
        match value.cast::<PyString>() {
            Ok(text) => {
                let choice = Choice::parse(&text.to_cow()?).map_err(|f| raised_fault(py, f))?;
                options.choose(&name, choice);
            }
            Err(_) => options.set(&name, value.extract()?),
        }
    }
    Ok(options)
}

/// All numbers of an array, row by row.
fn flat(value: &Bound<'_, PyAny>) -> PyResult<Vec<f64>> {
    let numpy = value.py().import("numpy")?;
    let array = numpy.call_method1("ravel", (value,))?;
    let length: usize = array.len()?;
    Ok(values::rows(&array, length, "the answer")?.0)
}
