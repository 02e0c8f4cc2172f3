//! Translated models and the results of their simulations.

use crate::errors::{Reported, raised, raised_fault, reported};
use crate::inputs::Inputs;
use crate::session::{Session, checked};
use crate::simulator::{Points, Simulator};
use crate::worker::{Worker, written};
use gapilib::Fault;
use gapilib::Session as Engine;
use gapilib::internals::identify::{CompiledModel, Model as _};
use gapilib::internals::script::models::final_state::FinalState;
use gapilib::internals::script::models::simulation::{
    self, Simulated, SimulationOptions, Translated, Unfinished,
};
use gapilib::internals::script::runs::problem::{self, Driven};
use gapilib::internals::sim::Statistics;
use gapilib::results::{self, ResultTable, Values};
use indexmap::IndexMap;
use numpy::PyArray1;
use pyo3::exceptions::PyKeyError;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyIterator, PyList};
use std::path::PathBuf;
use std::sync::Arc;

/// A translated model. Made by `Session.model`.
#[pyclass(frozen, module = "gapilib")]
pub(crate) struct Model {
    worker: Arc<Worker>,
    translated: Arc<Translated>,
    compiled: Arc<CompiledModel>,
    threads: Option<usize>,
}

impl Model {
    pub(crate) fn new(
        worker: Arc<Worker>,
        translated: Arc<Translated>,
        threads: Option<usize>,
    ) -> Model {
        let program = translated.program.clone();
        let compiled = Arc::new(CompiledModel::new(translated.problem.clone(), program));
        Model { worker, translated, compiled, threads }
    }
}

/// What a simulation is asked for.
struct SimulationRequest {
    options: SimulationOptions,
    parameters: Vec<(String, f64)>,
    from: Option<(Arc<ResultTable>, Option<f64>)>,
    inputs: Option<Inputs>,
}

#[pymethods]
impl Model {
    /// The class with its modification.
    #[getter]
    fn name(&self) -> &str {
        &self.translated.problem
    }

    /// The session that has made it.
    #[getter]
    fn session(&self) -> Session {
        Session { worker: self.worker.clone(), threads: self.threads }
    }

    /// Its parameters: dicts with unit, min, max, tunable and top_level by their names.
    #[getter]
    fn parameters<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        parameters(py, &*self.compiled)
    }

    /// Writes it, with values for parameters and start values by their names, as a functional mock-up
    /// unit of FMI 3 or 2: for model exchange ("me"), co-simulation ("cs") or both.
    #[pyo3(signature = (path, parameters=None, *, version=3, kind="both"))]
    fn export_fmu(
        &self,
        py: Python<'_>,
        path: PathBuf,
        parameters: Option<IndexMap<String, f64>>,
        version: u8,
        kind: &str,
    ) -> PyResult<()> {
        let parameters = parameters.into_iter().flatten().collect();
        let model = (self.translated.problem.clone(), parameters);
        crate::fmu::export(py, &self.worker, model, (version, kind), path)
    }

    /// The names of its top-level outputs.
    #[getter]
    fn outputs(&self) -> Vec<String> {
        self.compiled.outputs()
    }

    /// The names of its states.
    #[getter]
    fn states(&self) -> Vec<String> {
        self.translated.state_names().map(ToString::to_string).collect()
    }

    /// The names of all its Real variables and parameters.
    #[getter]
    fn names(&self) -> Vec<String> {
        self.compiled.names()
    }

    /// The unit of a variable; empty if it has none.
    fn unit(&self, py: Python<'_>, variable: &str) -> PyResult<String> {
        match self.compiled.unit(variable) {
            Some(unit) => Ok(unit),
            None => {
                let found = self.translated.program.find_variable(variable);
                Err(found.err().map_or_else(
                    || PyKeyError::new_err(variable.to_owned()),
                    |fault| raised_fault(py, fault),
                ))
            }
        }
    }

    /// Its `experiment` annotation: start_time, stop_time, tolerance and interval, None where it says
    /// nothing.
    #[getter]
    fn experiment<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let experiment = self.translated.program.experiment();
        let dict = PyDict::new(py);
        dict.set_item("start_time", experiment.start_time)?;
        dict.set_item("stop_time", experiment.stop_time)?;
        dict.set_item("tolerance", experiment.tolerance)?;
        dict.set_item("interval", experiment.interval)?;
        Ok(dict)
    }

    /// Simulates it, with values for parameters and start values by their names, and inputs that follow
    /// the columns of a file or of data in memory that have their names; between the rows they hold or
    /// are linear, as `interpolation` says. What is None is taken from the experiment annotation, the end
    /// also from the data.
    #[pyo3(signature = (parameters=None, *, start=None, stop=None, intervals=None, interval=None,
        tolerance=None, method=None, step=None, variables=None, initial=None, initial_time=None,
        inputs=None, interpolation=None))]
    #[allow(clippy::too_many_arguments, reason = "arguments of Python, all named")]
    fn simulate(
        &self,
        py: Python<'_>,
        parameters: Option<IndexMap<String, f64>>,
        start: Option<f64>,
        stop: Option<f64>,
        intervals: Option<i64>,
        interval: Option<f64>,
        tolerance: Option<f64>,
        method: Option<String>,
        step: Option<f64>,
        variables: Option<Vec<String>>,
        initial: Option<PyRef<'_, SimulationResult>>,
        initial_time: Option<f64>,
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
            fixed_step: step,
            only: None,
            ..SimulationOptions::default()
        };
        let request = SimulationRequest {
            options,
            parameters: parameters.into_iter().flatten().collect(),
            from: initial.map(|result| (result.table.clone(), initial_time)),
            inputs: Inputs::of(inputs, interpolation)?,
        };
        let model = self.translated.clone();
        let (answer, errors) =
            self.worker.call_quietly(py, move |engine| simulated(engine, &model, request))?;
        finished(py, self.name(), (answer, &errors), variables.as_deref())
    }

    /// Prepares many simulations that differ in the values of `parameters` and answer the values of
    /// `outputs` at the points `at` of the variable `x`. See `Simulator`.
    #[pyo3(signature = (parameters, outputs, at, *, x="time", tolerance=None, threads=None))]
    #[allow(clippy::too_many_arguments, reason = "arguments of Python")]
    fn simulator(
        &self,
        py: Python<'_>,
        parameters: Vec<String>,
        outputs: &Bound<'_, PyAny>,
        at: &Bound<'_, PyAny>,
        x: &str,
        tolerance: Option<f64>,
        threads: Option<usize>,
    ) -> PyResult<Simulator> {
        let (outputs, is_single) = match outputs.extract::<String>() {
            Ok(name) => (vec![name], true),
            Err(_) => (outputs.extract::<Vec<String>>()?, false),
        };
        let points: Vec<f64> = {
            let numpy = py.import("numpy")?;
            numpy.call_method1("ravel", (at,))?.call_method1("astype", ("float64",))?.extract()?
        };
        let available = std::thread::available_parallelism().map_or(1, usize::from);
        let threads = threads.or(self.threads).unwrap_or(available).max(1);
        let points = Points { outputs, is_single, x_name: x.to_owned(), x: points };
        Simulator::new(py, self.compiled.clone(), (parameters, points), tolerance, threads)
    }

    fn __repr__(&self) -> String {
        format!("<gapilib.Model {}>", self.name())
    }
}

/// The parameters of a model: dicts with unit, min, max, tunable and top_level by their names.
pub(crate) fn parameters<'py>(
    py: Python<'py>,
    model: &dyn gapilib::internals::identify::Model,
) -> PyResult<Bound<'py, PyDict>> {
    let all = PyDict::new(py);
    for parameter in model.parameters() {
        let dict = PyDict::new(py);
        dict.set_item("unit", parameter.unit)?;
        dict.set_item("min", parameter.min)?;
        dict.set_item("max", parameter.max)?;
        dict.set_item("tunable", parameter.tunable)?;
        dict.set_item("top_level", parameter.top_level)?;
        all.set_item(parameter.name, dict)?;
    }
    Ok(all)
}

/// What a simulation has come to, or what is wrong, with what was computed until then.
pub(crate) type Simulation = Result<Simulated, (Vec<Reported>, Option<Box<Simulated>>)>;

/// A simulation that has ended on the thread of the session.
pub(crate) fn ended(engine: &Engine, done: Result<Simulated, Unfinished>) -> Simulation {
    done.map_err(|Unfinished { why, until }| (reported(&[why], &engine.sources), until))
}

/// The result of a simulation; the exception for one that failed has what was computed until then as its
/// `result`.
pub(crate) fn finished(
    py: Python<'_>,
    name: &str,
    (simulation, errors): (Simulation, &str),
    variables: Option<&[String]>,
) -> PyResult<SimulationResult> {
    let result = |simulated: Simulated| {
        let Simulated { mut table, statistics, .. } = simulated;
        keep_only(&mut table, variables).map_err(|fault| raised_fault(py, fault))?;
        Ok(SimulationResult { model: name.to_owned(), table: Arc::new(table), statistics })
    };
    match simulation {
        Ok(simulated) => {
            written(py, "stderr", errors)?;
            result(simulated)
        }
        Err((reported, until)) => {
            let error = raised(py, &reported);
            let until = until.map(|until| result(*until)).transpose()?;
            error.value(py).setattr("result", until)?;
            Err(error)
        }
    }
}

/// Simulates on the thread of the session.
fn simulated(
    engine: &mut Engine,
    model: &Arc<Translated>,
    request: SimulationRequest,
) -> Simulation {
    let fault = |fault: Fault| (vec![Reported::fault(fault)], None);
    // Values that were set before do not count.
    let driven = match &request.inputs {
        None => None,
        Some(inputs) => {
            let (path, interpolation) = inputs.open(engine);
            let driven = problem::driven(engine, &model.problem, path, interpolation);
            Some(checked(engine, driven).map_err(|errors| (errors, None))?)
        }
    };
    let class = driven.as_ref().map_or(&*model.problem, |driven| &*driven.class);
    let model = simulation::translate_anew(engine, class);
    let model = checked(engine, model).map_err(|errors| (errors, None))?;
    let mut options = request.options;
    options.takes_exact_steps = driven.is_some();
    if let Some(driven) = &driven
        && model.program.experiment().stop_time.is_none()
    {
        options.stop.get_or_insert(driven.last);
    }
    if let Some((table, time)) = request.from {
        let time = time.or(table.time.last().copied()).unwrap_or(0.0);
        let state = FinalState::in_result(&model, &table, time).map_err(fault)?;
        engine.continue_from(&state, "the result").map_err(fault)?;
        options.start = options.start.or(Some(time));
    }
    for (name, value) in &request.parameters {
        engine.set_parameter(name, *value).map_err(fault)?;
    }
    let mut done = simulation::simulate(engine, &model, &options);
    if driven.is_some()
        && let Ok(simulated) = &mut done
    {
        Driven::without_own_inputs(&mut simulated.table);
    }
    ended(engine, done)
}

/// Removes the variables that are not selected.
pub(crate) fn keep_only(table: &mut ResultTable, selected: Option<&[String]>) -> Result<(), Fault> {
    let Some(selected) = selected else { return Ok(()) };
    let mut kept = ResultTable { series: Vec::new(), ..ResultTable::new(table.time.clone()) };
    for name in selected.iter().filter(|name| *name != "time") {
        let values = Values::Trajectory(table.column(name)?);
        let of = table.series.iter().find(|series| &series.name == name);
        let (unit, description) =
            of.map_or_else(Default::default, |of| (of.unit.clone(), of.description.clone()));
        kept.series.push(results::Series { name: name.clone(), unit, description, values });
    }
    *table = kept;
    Ok(())
}

/// The trajectories of a simulation. At an event there are two points of one time: the values before
/// and after it.
#[pyclass(frozen, module = "gapilib")]
pub(crate) struct SimulationResult {
    pub(crate) model: String,
    pub(crate) table: Arc<ResultTable>,
    pub(crate) statistics: Statistics,
}

#[pymethods]
impl SimulationResult {
    /// The time points, seconds.
    #[getter]
    fn time<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        PyArray1::from_slice(py, &self.table.time)
    }

    /// The names of the variables.
    #[getter]
    fn names(&self) -> Vec<String> {
        self.table.series.iter().map(|series| series.name.clone()).collect()
    }

    /// The units of the variables that have one.
    #[getter]
    fn units(&self) -> IndexMap<String, String> {
        let with_unit = self.table.series.iter().filter(|series| !series.unit.is_empty());
        with_unit.map(|series| (series.name.clone(), series.unit.clone())).collect()
    }

    /// The descriptions of the variables that have one.
    #[getter]
    fn descriptions(&self) -> IndexMap<String, String> {
        let described = self.table.series.iter().filter(|series| !series.description.is_empty());
        described.map(|series| (series.name.clone(), series.description.clone())).collect()
    }

    /// What the simulation cost: steps, evaluations of right-hand sides and Jacobians, events.
    #[getter]
    fn statistics<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let s = &self.statistics;
        let dict = PyDict::new(py);
        dict.set_item("steps", s.steps)?;
        dict.set_item("error_failures", s.error_failures)?;
        dict.set_item("newton_failures", s.newton_failures)?;
        dict.set_item("rhs_evaluations", s.rhs_evaluations)?;
        dict.set_item("jacobian_evaluations", s.jacobian_evaluations)?;
        dict.set_item("factorizations", s.factorizations)?;
        dict.set_item("state_events", s.state_events)?;
        dict.set_item("time_events", s.time_events)?;
        Ok(dict)
    }

    /// The values of a variable, one per point in time.
    fn __getitem__<'py>(&self, py: Python<'py>, name: &str) -> PyResult<Bound<'py, PyArray1<f64>>> {
        let values = self.table.column(name).map_err(|fault| raised_fault(py, fault))?;
        Ok(PyArray1::from_vec(py, values))
    }

    /// The values at these times, between two points by a straight line.
    fn at<'py>(
        &self,
        py: Python<'py>,
        name: &str,
        times: &Bound<'_, PyAny>,
    ) -> PyResult<Bound<'py, PyArray1<f64>>> {
        let numpy = py.import("numpy")?;
        let times: Vec<f64> = numpy.call_method1("atleast_1d", (times,))?.extract()?;
        let values = self.table.interpolate(name, &times);
        Ok(PyArray1::from_vec(py, values.map_err(|fault| raised_fault(py, fault))?))
    }

    fn __contains__(&self, name: &str) -> bool {
        self.table.column(name).is_ok()
    }

    fn __len__(&self) -> usize {
        self.table.time.len()
    }

    /// The names of the variables, as a data frame of pandas has them.
    fn __iter__<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyIterator>> {
        PyList::new(py, self.names())?.try_iter()
    }

    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<crate::stored::Reduced<'py>> {
        crate::stored::reduced(py, self)
    }

    /// A data frame of pandas with time as index: all variables, or those of `names`. Units are in
    /// its `attrs["units"]`.
    #[pyo3(signature = (names=None))]
    fn to_pandas<'py>(
        &self,
        py: Python<'py>,
        names: Option<Vec<String>>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let columns = PyDict::new(py);
        for name in names.unwrap_or_else(|| self.names()) {
            columns.set_item(&name, self.__getitem__(py, &name)?)?;
        }
        let pandas = py.import("pandas")?;
        let index = PyDict::new(py);
        index.set_item("name", "time")?;
        let index = pandas.getattr("Index")?.call((self.time(py),), Some(&index))?;
        let arguments = PyDict::new(py);
        arguments.set_item("index", index)?;
        arguments.set_item("copy", false)?;
        let frame = pandas.getattr("DataFrame")?.call((columns,), Some(&arguments))?;
        frame.getattr("attrs")?.set_item("units", self.units())?;
        Ok(frame)
    }

    /// A table of Arrow: time, and all variables or those of `names`. Units and descriptions are in the
    /// metadata of the fields.
    #[pyo3(signature = (names=None))]
    fn to_arrow<'py>(
        slf: &Bound<'py, Self>,
        names: Option<Vec<String>>,
    ) -> PyResult<Bound<'py, PyAny>> {
        slf.py().import("gapilib._export")?.call_method1("arrow", (slf, names))
    }

    /// A dataset of xarray over time: all variables, or those of `names`, with their units.
    #[pyo3(signature = (names=None))]
    fn to_xarray<'py>(
        slf: &Bound<'py, Self>,
        names: Option<Vec<String>>,
    ) -> PyResult<Bound<'py, PyAny>> {
        slf.py().import("gapilib._export")?.call_method1("xarray", (slf, names))
    }

    /// Writes all variables into a file; its extension selects the format: .mat or .csv, with pyarrow
    /// also .parquet and .feather, with xarray also .nc.
    fn write(slf: &Bound<'_, Self>, path: PathBuf) -> PyResult<()> {
        let (py, this) = (slf.py(), slf.get());
        let export = py.import("gapilib._export")?;
        if export.call_method1("is_written", (slf, path.to_string_lossy()))?.extract()? {
            return Ok(());
        }
        let format = results::format_of_file(&path.to_string_lossy());
        let format = format.map_err(|fault| raised_fault(py, fault))?;
        let bytes = format.write(&this.table).map_err(|fault| raised_fault(py, fault))?;
        Ok(py.detach(|| std::fs::write(path, bytes))?)
    }

    fn __repr__(&self) -> String {
        let (first, last) = (self.table.time.first(), self.table.time.last());
        format!(
            "<gapilib.SimulationResult of {}: {} variables, {} points from {} s to {} s>",
            self.model,
            self.table.series.len(),
            self.table.time.len(),
            first.unwrap_or(&f64::NAN),
            last.unwrap_or(&f64::NAN)
        )
    }
}
