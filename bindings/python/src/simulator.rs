//! Many simulations of one model, spread over all cores.

use crate::errors::raised_fault;
use crate::forked::{AtWork, Own};
use crate::values;
use crate::watch::Watched;
use gapilib::Fault;
use gapilib::internals::identify::problem::{
    Experiment, Failed, ModelSimulator, Observation, Simulate,
};
use gapilib::internals::identify::{CompiledModel, Model as _};
use numpy::{PyArray1, PyArrayMethods};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use rayon::prelude::*;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, PoisonError, mpsc};
use std::time::{Duration, Instant};

/// How often the signals of the user are looked at.
const TICK: Duration = Duration::from_millis(20);

/// What is answered.
pub(crate) struct Points {
    /// The variables.
    pub outputs: Vec<String>,
    /// Whether one was named alone, so that it has no axis of its own.
    pub is_single: bool,
    /// The variable that `x` holds values of.
    pub x_name: String,
    /// The points.
    pub x: Vec<f64>,
}

/// Many simulations of one model with other values of some parameters.
///
/// `simulator(values)` gives the outputs at the points: an array of points (and outputs, if several
/// were asked for). `many` simulates the rows of a matrix on all cores, `jacobian` gives derivatives by
/// the parameters. What comes out does not depend on the number of threads.
#[pyclass(frozen, module = "gapilib")]
pub(crate) struct Simulator {
    parameters: Vec<String>,
    points: Points,
    workers: Arc<Vec<Mutex<ModelSimulator>>>,
    pool: Mutex<Pool>,
    /// While one call uses the workers, another one waits.
    busy: Arc<Mutex<()>>,
    watched: Arc<Watched>,
}

/// The threads for many simulations. A forked process has none of them and makes its own.
type Pool = Own<Arc<rayon::ThreadPool>>;

fn new_pool(threads: usize) -> PyResult<Arc<rayon::ThreadPool>> {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
    let pool = pool.map_err(|error| PyValueError::new_err(error.to_string()))?;
    // All have begun: what a thread locks when it begins is free when the process forks.
    pool.broadcast(|_| ());
    Ok(Arc::new(pool))
}

/// The answer to one row.
type Row = Result<Vec<f64>, Failed>;

impl Simulator {
    pub(crate) fn new(
        py: Python<'_>,
        model: Arc<CompiledModel>,
        (parameters, points): (Vec<String>, Points),
        tolerance: Option<f64>,
        threads: usize,
    ) -> PyResult<Simulator> {
        let _at_work = AtWork::begin(py)?;
        if points.x.is_empty() || points.x.iter().any(|x| !x.is_finite()) {
            return Err(PyValueError::new_err("`at` must hold finite numbers, at least one"));
        }
        let mut settings = model.settings();
        if let Some(tolerance) = tolerance {
            if !(1e-14..=0.1).contains(&tolerance) {
                return Err(PyValueError::new_err("`tolerance` must be between 1e-14 and 0.1"));
            }
            settings.tolerance = tolerance;
        }
        let observe = |name: &String| Observation { y_name: name.clone(), x: points.x.clone() };
        let experiment = Experiment {
            name: String::new(),
            model,
            settings,
            second_attempt: true,
            x_name: points.x_name.clone(),
            observations: points.outputs.iter().map(observe).collect(),
            deviations: 0,
            parameters: parameters.iter().cloned().enumerate().collect(),
        };
        let make = || ModelSimulator::new(std::slice::from_ref(&experiment)).map(Mutex::new);
        let workers: Result<Vec<_>, Fault> = (0..threads).map(|_| make()).collect();
        let workers = workers.map_err(|fault| raised_fault(py, fault))?;
        Ok(Simulator {
            parameters,
            points,
            workers: Arc::new(workers),
            pool: Mutex::new(Own::new(new_pool(threads)?)),
            busy: Arc::new(Mutex::new(())),
            watched: Watched::new(),
        })
    }

    /// The threads of this process.
    fn threads(&self) -> PyResult<Arc<rayon::ThreadPool>> {
        let mut pool = self.pool.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(threads) = pool.get() {
            return Ok(threads.clone());
        }
        let threads = new_pool(self.workers.len())?;
        *pool = Own::new(threads.clone());
        Ok(threads)
    }

    fn n_values(&self) -> usize {
        self.points.outputs.len() * self.points.x.len()
    }

    /// One answer as an array. With one output it is copied as it is: to make an array of a vector and
    /// reshape it takes as long as a short simulation.
    fn array<'py>(&self, py: Python<'py>, row: &[f64]) -> PyResult<Bound<'py, PyAny>> {
        if self.points.outputs.len() == 1 {
            let array = PyArray1::from_slice(py, row);
            return match self.points.is_single {
                true => Ok(array.into_any()),
                false => Ok(array.reshape(self.shape())?.into_any()),
            };
        }
        let mut out = Vec::with_capacity(row.len());
        self.by_points(row, 1, &mut out);
        Ok(PyArray1::from_vec(py, out).reshape(self.shape())?.into_any())
    }

    /// The shape of one answer: points, or points × outputs.
    fn shape(&self) -> Vec<usize> {
        match self.points.is_single {
            true => vec![self.points.x.len()],
            false => vec![self.points.x.len(), self.points.outputs.len()],
        }
    }

    /// One answer, output by output, as points × outputs × `last`.
    fn by_points(&self, row: &[f64], last: usize, out: &mut Vec<f64>) {
        let (points, outputs) = (self.points.x.len(), self.points.outputs.len());
        for point in 0..points {
            for output in 0..outputs {
                let first = (output * points + point) * last;
                out.extend_from_slice(&row[first..first + last]);
            }
        }
    }

    /// Works on the rows `0..count` on all cores; Ctrl-C ends it.
    fn all(
        &self,
        py: Python<'_>,
        count: usize,
        work: impl Fn(&mut ModelSimulator, usize) -> Row + Send + Sync + 'static,
    ) -> PyResult<Vec<Row>> {
        let (workers, pool) = (self.workers.clone(), self.threads()?);
        self.waited(py, move |stop| {
            for worker in workers.iter() {
                let mut worker = worker.lock().unwrap_or_else(PoisonError::into_inner);
                worker.cancel_by(Some(stop.clone()));
            }
            let one = |row: usize| {
                let own = rayon::current_thread_index().unwrap_or(0);
                let mut worker = workers[own].lock().unwrap_or_else(PoisonError::into_inner);
                work(&mut worker, row)
            };
            pool.install(|| (0..count).into_par_iter().with_min_len(1).map(one).collect())
        })
    }

    /// Works on another thread and waits for it; Ctrl-C sets the flag that the work is given.
    fn waited<T: Send + 'static>(
        &self,
        py: Python<'_>,
        work: impl FnOnce(Arc<AtomicBool>) -> T + Send + 'static,
    ) -> PyResult<T> {
        let at_work = AtWork::begin(py)?;
        let busy = self.busy.clone();
        let (done, is_done) = mpsc::channel();
        let stop = Arc::new(AtomicBool::new(false));
        let stopped = stop.clone();
        let run = move || {
            let alone = busy.lock().unwrap_or_else(PoisonError::into_inner);
            let answer = work(stopped);
            // Before the answer: the caller may fork after it.
            drop(alone);
            drop(at_work);
            drop(done.send(answer));
        };
        std::thread::Builder::new().spawn(run)?;
        let is_done = Mutex::new(is_done);
        loop {
            let received = py.detach(|| {
                is_done.lock().unwrap_or_else(PoisonError::into_inner).recv_timeout(TICK)
            });
            match received {
                Ok(answer) => return Ok(answer),
                Err(mpsc::RecvTimeoutError::Timeout) => {
                    if let Err(interrupt) = py.check_signals() {
                        stop.store(true, Ordering::SeqCst);
                        return Err(interrupt);
                    }
                }
                Err(mpsc::RecvTimeoutError::Disconnected) => {
                    return Err(PyValueError::new_err(
                        "the simulations ended with an internal error",
                    ));
                }
            }
        }
    }

    /// Works on the calling thread, where a call of another one would cost more than a short
    /// simulation; a long one is restarted on another one, and Ctrl-C ends it.
    fn one<T: Send + 'static>(
        &self,
        py: Python<'_>,
        work: impl Fn(&mut ModelSimulator) -> Result<T, Failed> + Send + Sync + 'static,
    ) -> PyResult<Result<T, Failed>> {
        if !self.watched.is_slow() {
            let at_work = AtWork::begin(py)?;
            self.watched.watch(at_work.process())?;
            let answer = py.detach(|| {
                let _alone = self.busy.lock().unwrap_or_else(PoisonError::into_inner);
                let mut worker = self.workers[0].lock().unwrap_or_else(PoisonError::into_inner);
                worker.cancel_by(Some(self.watched.begin()));
                let answer = work(&mut worker);
                if self.watched.end() { None } else { Some(answer) }
            });
            if let Some(answer) = answer {
                return Ok(answer);
            }
        }
        let (workers, watched) = (self.workers.clone(), self.watched.clone());
        self.waited(py, move |stop| {
            let mut worker = workers[0].lock().unwrap_or_else(PoisonError::into_inner);
            worker.cancel_by(Some(stop));
            let begin = Instant::now();
            let answer = work(&mut worker);
            watched.lasted(begin.elapsed());
            answer
        })
    }
}

#[pymethods]
impl Simulator {
    /// The names of the parameters, in the order of the values.
    #[getter]
    fn parameters(&self) -> Vec<String> {
        self.parameters.clone()
    }

    /// The names of the outputs.
    #[getter]
    fn outputs(&self) -> Vec<String> {
        self.points.outputs.clone()
    }

    /// Whether there is one output, without a dimension of its own in what is simulated.
    #[getter]
    fn is_single(&self) -> bool {
        self.points.is_single
    }

    /// The points.
    #[getter]
    fn at<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        PyArray1::from_slice(py, &self.points.x)
    }

    /// Simulates with these values. Raises `GapilibError` where the simulation fails.
    fn __call__<'py>(
        &self,
        py: Python<'py>,
        values: &Bound<'_, PyAny>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let (values, count) = values::rows(values, self.parameters.len(), "the values")?;
        if count != 1 {
            return Err(PyValueError::new_err("one row of values; `many` takes several"));
        }
        let size = self.n_values();
        let row = self.one(py, move |worker| {
            let mut row = vec![f64::NAN; size];
            worker.simulate(&values, &mut row).map(|()| row)
        });
        let row = row?.map_err(|failed| failure(py, failed))?;
        self.array(py, &row)
    }

    /// Simulates with the values of each row of a matrix, on all cores: an array of rows × points
    /// (× outputs). NaN where a simulation has failed; with `failures=True` the list of the messages,
    /// None where it has not, comes as well.
    #[pyo3(signature = (values, *, failures=false))]
    fn many<'py>(
        &self,
        py: Python<'py>,
        values: &Bound<'_, PyAny>,
        failures: bool,
    ) -> PyResult<Bound<'py, PyAny>> {
        let width = self.parameters.len();
        let (values, count) = values::rows(values, width, "the values")?;
        let size = self.n_values();
        let rows = self.all(py, count, move |simulator, k| {
            let mut row = vec![f64::NAN; size];
            let values = &values[k * width..(k + 1) * width];
            simulator.simulate(values, &mut row).map(|()| row)
        })?;
        let mut out = Vec::with_capacity(count * size);
        let mut messages = Vec::new();
        for row in rows {
            match row {
                Ok(row) => {
                    self.by_points(&row, 1, &mut out);
                    messages.push(None);
                }
                Err(failed) => {
                    out.resize(out.len() + size, f64::NAN);
                    messages.push(Some(failed.cause));
                }
            }
        }
        let shape = [vec![count], self.shape()].concat();
        let array = PyArray1::from_vec(py, out).reshape(shape)?;
        match failures {
            true => Ok((array, messages).into_pyobject(py)?.into_any()),
            false => Ok(array.into_any()),
        }
    }

    /// The outputs and their derivatives by the parameters, integrated with the model:
    /// points (× outputs), and points (× outputs) × parameters. Raises `GapilibError` where the
    /// simulation fails or the model has no derivatives.
    fn jacobian<'py>(
        &self,
        py: Python<'py>,
        values: &Bound<'_, PyAny>,
    ) -> PyResult<(Bound<'py, PyAny>, Bound<'py, PyAny>)> {
        let width = self.parameters.len();
        let (values, count) = values::rows(values, width, "the values")?;
        if count != 1 {
            return Err(PyValueError::new_err("derivatives are computed at one row of values"));
        }
        let size = self.n_values();
        let answer = self.one(py, move |worker| {
            let (mut row, mut derivatives) = (vec![f64::NAN; size], vec![f64::NAN; size * width]);
            let is_exact = worker.sensitivities(&values, &mut row, &mut derivatives)?;
            let refusal = || worker.sensitivity_refusal().map(str::to_owned);
            Ok(if is_exact { Ok((row, derivatives)) } else { Err(refusal()) })
        });
        let answer = answer?.map_err(|failed| failure(py, failed))?;
        let (row, derivatives) = answer.map_err(|refusal| without_derivatives(py, refusal))?;
        let mut by_point = Vec::with_capacity(derivatives.len());
        self.by_points(&derivatives, width, &mut by_point);
        let shape = [self.shape(), vec![width]].concat();
        let by_point = PyArray1::from_vec(py, by_point).reshape(shape)?;
        Ok((self.array(py, &row)?, by_point.into_any()))
    }

    fn __repr__(&self) -> String {
        format!(
            "<gapilib.Simulator of {} at {} points of {}, parameters {}>",
            self.points.outputs.join(", "),
            self.points.x.len(),
            self.points.x_name,
            self.parameters.join(", ")
        )
    }
}

/// Why there are no exact derivatives, as an exception.
fn without_derivatives(py: Python<'_>, refusal: Option<String>) -> PyErr {
    let why = refusal.unwrap_or_else(|| "the model has events".to_owned());
    let message = format!("there are no exact derivatives because {why}");
    let fault = Fault::new(gapilib::internals::registry::BAD_OPTION, message);
    raised_fault(py, fault.help("take differences of simulations instead"))
}

/// A failed simulation as an exception.
fn failure(py: Python<'_>, failed: Failed) -> PyErr {
    let code = gapilib::internals::codegen::errors::SIMULATION_FAILED;
    raised_fault(py, Fault::new(code, failed.cause))
}
