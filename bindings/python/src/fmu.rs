//! Functional mock-up units: of models, and of files.

use crate::errors::{Reported, raised, raised_fault};
use crate::inputs::Inputs;
use crate::model::{Simulation, SimulationResult, ended, finished};
use crate::session::{Answer, Session, checked};
use crate::worker::{Worker, written};
use gapilib::Fault;
use gapilib::Session as Engine;
use gapilib::internals::fmi::description::Version;
use gapilib::internals::fmi::export::Kinds;
use gapilib::internals::fmi::import::Imported;
use gapilib::internals::identify::Model as _;
use gapilib::internals::script::models::exported::{Form, exported};
use gapilib::internals::script::models::imported::{self, CO_SIMULATION, Given};
use gapilib::internals::script::models::simulation::{self, SimulationOptions};
use gapilib::internals::script::runs::problem;
use indexmap::IndexMap;
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use std::path::PathBuf;
use std::sync::Arc;

/// A functional mock-up unit of a file. Made by `Session.fmu`.
#[pyclass(frozen, module = "gapilib")]
pub(crate) struct Fmu {
    worker: Arc<Worker>,
    unit: Arc<Imported>,
    path: PathBuf,
    threads: Option<usize>,
}

/// What units offer, as Python says it.
fn form(version: u8, kind: &str) -> PyResult<(Version, Kinds)> {
    let version = match version {
        2 => Version::V2,
        3 => Version::V3,
        other => {
            return Err(PyValueError::new_err(format!("there is no FMI {other}: write 2 or 3")));
        }
    };
    let (model_exchange, co_simulation) = match kind {
        "me" => (true, false),
        "cs" => (false, true),
        "both" => (true, true),
        other => {
            return Err(PyValueError::new_err(format!(
                "there is no kind {other:?}: write \"me\", \"cs\" or \"both\""
            )));
        }
    };
    Ok((version, Kinds { model_exchange, co_simulation }))
}

/// Writes a model as a unit.
pub(crate) fn export(
    py: Python<'_>,
    worker: &Worker,
    (problem, parameters): (String, Vec<(String, f64)>),
    (version, kind): (u8, &str),
    path: PathBuf,
) -> PyResult<()> {
    let (version, kinds) = form(version, kind)?;
    let (answer, errors) = worker.call_quietly(py, move |engine| -> Answer<Vec<u8>> {
        // Values that were set before do not count.
        let model = simulation::translate_anew(engine, &problem);
        checked(engine, model)?;
        for (name, value) in &parameters {
            let set = engine.set_parameter(name, *value);
            set.map_err(|fault| vec![Reported::fault(fault)])?;
        }
        let bytes = exported(engine, &problem, Form { version, kinds, name: None });
        checked(engine, bytes)
    })?;
    let bytes = answer.map_err(|errors| raised(py, &errors))?;
    written(py, "stderr", &errors)?;
    Ok(py.detach(|| std::fs::write(path, bytes))?)
}

impl Fmu {
    /// The unit of a file, that the session runs.
    pub(crate) fn open(
        py: Python<'_>,
        session: &Session,
        path: PathBuf,
        is_co_simulation: bool,
    ) -> PyResult<Fmu> {
        let (worker, threads) = (session.worker.clone(), session.threads);
        let path = std::path::absolute(path)?;
        let file = path.clone();
        let method = is_co_simulation.then_some(CO_SIMULATION);
        let unit = worker.call(py, move |engine| {
            engine.world.grant_input(&file);
            imported::import(engine, &file, method)
        })?;
        let unit = unit.map_err(|fault| raised_fault(py, fault))?;
        Ok(Fmu { worker, unit, path, threads })
    }

    fn model(
        &self,
        py: Python<'_>,
        given: Given,
    ) -> PyResult<gapilib::internals::identify::ImportedModel> {
        let model = imported::model(&self.unit, given, Vec::new());
        model.map_err(|fault| raised_fault(py, fault))
    }
}

/// A value that Python gives a variable.
#[derive(FromPyObject)]
enum Value {
    Number(f64),
    Text(String),
}

/// What a simulation is asked for.
struct Request {
    options: SimulationOptions,
    parameters: Vec<(String, Value)>,
    inputs: Option<Inputs>,
}

#[pymethods]
impl Fmu {
    /// The name of the file.
    #[getter]
    fn name(&self) -> &str {
        &self.unit.file
    }

    /// Where it lies, absolute.
    #[getter]
    fn path(&self) -> PathBuf {
        self.path.clone()
    }

    /// The session that runs it.
    #[getter]
    fn session(&self) -> Session {
        Session { worker: self.worker.clone(), threads: self.threads }
    }

    /// Its parameters: dicts with unit, min, max, tunable and top_level by their names.
    #[getter]
    fn parameters<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        crate::model::parameters(py, &self.model(py, Given::default())?)
    }

    /// The names of its outputs.
    #[getter]
    fn outputs(&self, py: Python<'_>) -> PyResult<Vec<String>> {
        Ok(self.model(py, Given::default())?.outputs())
    }

    /// The names of all its variables that are numbers.
    #[getter]
    fn names(&self, py: Python<'_>) -> PyResult<Vec<String>> {
        Ok(self.model(py, Given::default())?.names())
    }

    /// Simulates it, with values for parameters and start values by their names (numbers, bools, strings,
    /// literals of enumerations by their names), and inputs that follow the columns of a file or of
    /// data in memory; between the rows they hold or are linear, as `interpolation` says. What is None is taken from its description.
    #[pyo3(signature = (parameters=None, *, start=None, stop=None, intervals=None, interval=None,
        tolerance=None, method=None, variables=None, inputs=None,
        interpolation=None))]
    #[allow(clippy::too_many_arguments, reason = "arguments of Python, all named")]
    fn simulate(
        &self,
        py: Python<'_>,
        parameters: Option<IndexMap<String, Value>>,
        start: Option<f64>,
        stop: Option<f64>,
        intervals: Option<i64>,
        interval: Option<f64>,
        tolerance: Option<f64>,
        method: Option<String>,
        variables: Option<Vec<String>>,
        inputs: Option<Bound<'_, PyAny>>,
        interpolation: Option<String>,
    ) -> PyResult<SimulationResult> {
        let options = SimulationOptions {
            start,
            stop,
            intervals,
            interval,
            tolerance,
            method,
            ..SimulationOptions::default()
        };
        let parameters = parameters.into_iter().flatten().collect();
        let request = Request { options, parameters, inputs: Inputs::of(inputs, interpolation)? };
        let unit = self.unit.clone();
        let (answer, errors) =
            self.worker.call_quietly(py, move |engine| simulated(engine, &unit, request))?;
        finished(py, &self.unit.file, (answer, &errors), variables.as_deref())
    }

    fn __repr__(&self) -> String {
        format!("<gapilib.Fmu {}>", self.unit.file)
    }
}

/// Simulates on the thread of the session.
fn simulated(engine: &mut Engine, unit: &Arc<Imported>, request: Request) -> Simulation {
    let fault = |fault: Fault| (vec![Reported::fault(fault)], None);
    let mut given = Given::default();
    for (name, value) in &request.parameters {
        let set = match value {
            Value::Number(value) => given.set(unit, name, *value),
            Value::Text(text) => given.add(unit, name, text),
        };
        set.map_err(fault)?;
    }
    let samples = match &request.inputs {
        None => Vec::new(),
        Some(inputs) => {
            let given = inputs.open(engine);
            let followed = problem::inputs_of(engine, unit, given).map_err(|error| vec![error]);
            checked(engine, followed).map_err(|errors| (errors, None))?.samples
        }
    };
    let model = imported::model(unit, given, samples).map_err(fault)?;
    let done = imported::simulate(engine, &model, &request.options);
    ended(engine, done)
}
