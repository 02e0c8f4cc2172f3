//! Sessions: statements, classes, models.

use crate::errors::{Reported, raised, reported};
use crate::fmu::Fmu;
use crate::model::Model;
use crate::values;
use crate::worker::{Worker, written};
use gapilib::Diagnostic;
use gapilib::Value;
use gapilib::embedding::Embedding;
use gapilib::internals::script::access::policy::Grant;
use gapilib::internals::script::builtins;
use gapilib::internals::script::models::simulation;
use gapilib::{Dialect, Echo, Options, Session as Engine};
use pyo3::exceptions::{PyKeyError, PyKeyboardInterrupt};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use std::path::PathBuf;
use std::sync::Arc;

/// What a work of the session has come to, or what is wrong.
pub(crate) type Answer<T> = Result<T, Vec<Reported>>;

/// A session: variables, loaded classes and models, as in a Modelica tool.
///
/// Each session has a thread of its own; several of them work at the same time.
#[pyclass(frozen, module = "gapilib")]
pub(crate) struct Session {
    pub(crate) worker: Arc<Worker>,
    pub(crate) threads: Option<usize>,
}

/// Makes errors of the engine ready for Python.
pub(crate) fn checked<T>(engine: &Engine, result: Result<T, Vec<Diagnostic>>) -> Answer<T> {
    result.map_err(|errors| reported(&errors, &engine.sources))
}

impl Session {
    /// Has the engine do something; what is wrong becomes an exception.
    pub(crate) fn ask<T: Send + 'static>(
        &self,
        py: Python<'_>,
        job: impl FnOnce(&mut Engine) -> Answer<T> + Send + 'static,
    ) -> PyResult<T> {
        let (answer, errors) = self.worker.call_quietly(py, job)?;
        if answer.is_ok() {
            // The script has asked for them: they end nothing.
            written(py, "stderr", &errors)?;
        }
        answer.map_err(|errors| raised(py, &errors))
    }
}

#[pymethods]
impl Session {
    #[new]
    #[pyo3(signature = (*, libraries=Vec::new(), threads=None, allow_read=Vec::new(),
        allow_write=false, allow_external=false, cache=true, dialogue=false, progress=None))]
    #[allow(clippy::too_many_arguments, reason = "arguments of Python, all named")]
    fn new(
        py: Python<'_>,
        libraries: Vec<PathBuf>,
        threads: Option<usize>,
        allow_read: Vec<PathBuf>,
        allow_write: bool,
        allow_external: bool,
        cache: bool,
        dialogue: bool,
        progress: Option<Py<PyAny>>,
    ) -> PyResult<Session> {
        let embedding = Embedding {
            libraries,
            threads,
            read: allow_read,
            write: allow_write,
            external: allow_external,
            cache,
        };
        let options = match dialogue {
            true => Options {
                echo: Echo::Dialogue,
                dialect: Some(Dialect::Dymola),
                ..Options::default()
            },
            false => Options::default(),
        };
        let open = move |screen, stop| Ok(embedding.session(screen, stop)?.with_options(options));
        Ok(Session { worker: Arc::new(Worker::new(py, threads, open, progress)?), threads })
    }

    /// Loads a Modelica file, or a package from its folder; the names of its classes.
    fn load(&self, py: Python<'_>, path: PathBuf) -> PyResult<Vec<String>> {
        self.ask(py, move |engine| {
            engine.world.grant_input(&path);
            let names = engine.load_path(&path);
            checked(engine, names.map(|names| names.iter().map(ToString::to_string).collect()))
        })
    }

    /// Loads classes from a text; their names. `name` stands in messages.
    #[pyo3(signature = (text, name="text"))]
    fn load_text(&self, py: Python<'_>, text: String, name: &str) -> PyResult<Vec<String>> {
        let name = name.to_owned();
        self.ask(py, move |engine| {
            let names = engine.load_text(&name, &text);
            checked(engine, names.map(|names| names.iter().map(ToString::to_string).collect()))
        })
    }

    /// Executes statements of a script.
    #[pyo3(signature = (text, name="input"))]
    fn execute(&self, py: Python<'_>, text: String, name: &str) -> PyResult<()> {
        let name = name.to_owned();
        self.ask(py, move |engine| {
            engine.output.messages.clear();
            let status = engine.run_text(&name, &text);
            ended(engine, status.errors).map(|()| status.interrupted)
        })
        .and_then(uninterrupted)
    }

    /// Runs a script.
    fn run(&self, py: Python<'_>, path: PathBuf) -> PyResult<()> {
        self.ask(py, move |engine| {
            engine.world.grant_input(&path);
            engine.output.messages.clear();
            let status = engine.run_file(&path);
            ended(engine, status.errors).map(|()| status.interrupted)
        })
        .and_then(uninterrupted)
    }

    /// The value of an expression.
    fn eval<'py>(&self, py: Python<'py>, expression: String) -> PyResult<Bound<'py, PyAny>> {
        let value = self.ask(py, move |engine| {
            let value = engine.value_of("expression", &expression);
            checked(engine, value.map_err(|error| vec![error]))
        })?;
        values::to_python(py, value)
    }

    /// All variables of the scripts by their names.
    fn variables<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let variables = self.worker.call(py, |engine| owned_variables(engine))?;
        dict_of(py, variables)
    }

    fn __getitem__<'py>(&self, py: Python<'py>, name: String) -> PyResult<Bound<'py, PyAny>> {
        let key = name.clone();
        let value = self.worker.call(py, move |engine| engine.variable(&key).cloned())?;
        match value {
            Some(value) => values::to_python(py, value),
            None => Err(PyKeyError::new_err(name)),
        }
    }

    fn __setitem__(&self, py: Python<'_>, name: String, value: &Bound<'_, PyAny>) -> PyResult<()> {
        let value = values::from_python(value)?;
        self.ask(py, move |engine| {
            engine.set_variable(&name, value).map_err(|fault| vec![Reported::fault(fault)])
        })
    }

    fn __contains__(&self, py: Python<'_>, name: String) -> PyResult<bool> {
        self.worker.call(py, move |engine| engine.variable(&name).is_some())
    }

    /// What is wrong with a class: a list of dicts as in `GapilibError.diagnostics`, empty for a
    /// class without fault.
    fn check<'py>(&self, py: Python<'py>, name: String) -> PyResult<Vec<Bound<'py, PyDict>>> {
        let found =
            self.worker.call(py, move |engine| match simulation::translate(engine, &name) {
                Ok(_) => Vec::new(),
                Err(errors) => reported(&errors, &engine.sources),
            })?;
        found.iter().map(|one| one.to_dict(py)).collect()
    }

    /// The flat model of a class as text.
    fn flatten(&self, py: Python<'_>, name: String) -> PyResult<String> {
        self.ask(py, move |engine| {
            let flat = simulation::flat_model(engine, &name);
            checked(engine, flat.map(|flat| flat.to_string()))
        })
    }

    /// Translates a model: `"Class"` or `"Class(parameter = 2)"`.
    fn model(slf: &Bound<'_, Self>, name: String) -> PyResult<Model> {
        let (py, this) = (slf.py(), slf.get());
        let translated = this.ask(py, move |engine| {
            let model = simulation::translate(engine, &name);
            checked(engine, model)
        })?;
        Ok(Model::new(this.worker.clone(), translated, this.threads))
    }

    /// A functional mock-up unit. It runs, in a process of its own, if the session has
    /// `allow_external=True`; with `co_simulation` it integrates itself.
    #[pyo3(signature = (path, *, co_simulation=false))]
    fn fmu(slf: &Bound<'_, Self>, path: PathBuf, co_simulation: bool) -> PyResult<Fmu> {
        Fmu::open(slf.py(), slf.get(), path, co_simulation)
    }

    /// The declarations of a command, or of a loaded class; None for what is neither.
    fn help(&self, py: Python<'_>, name: String) -> PyResult<Option<String>> {
        self.worker.call(py, move |engine| {
            let declarations = builtins::declarations(&name);
            match declarations.is_empty() {
                true => engine.declaration(&name),
                false => Some(declarations.join("\n")),
            }
        })
    }

    /// The folder for results, absolute.
    #[getter]
    fn output(&self, py: Python<'_>) -> PyResult<PathBuf> {
        self.worker.call(py, |engine| engine.world.output_dir())
    }

    /// Stops what another thread has the session do; that call raises `KeyboardInterrupt`.
    fn interrupt(&self) {
        self.worker.interrupt();
    }

    /// Allows scripts and models to read a file or folder.
    fn allow_read(&self, py: Python<'_>, path: PathBuf) -> PyResult<()> {
        self.worker.call(py, move |engine| engine.world.grant(Grant::Read(&path)))
    }

    /// The names that begin so: variables, commands, functions, classes.
    fn complete(&self, py: Python<'_>, beginning: String) -> PyResult<Vec<String>> {
        self.worker.call(py, move |engine| {
            let mut names = engine.names_to_complete();
            names.extend(builtins::names().into_iter().map(str::to_owned));
            names.retain(|name| name.starts_with(&beginning));
            names.sort();
            names.dedup();
            names
        })
    }
}

/// What came of statements: the errors that they have not asked for.
pub(crate) fn ended(engine: &mut Engine, errors: usize) -> Answer<()> {
    let found = reported(engine.output.messages.unread(), &engine.sources);
    engine.output.messages.clear();
    if errors == 0 { Ok(()) } else { Err(found) }
}

/// `KeyboardInterrupt` for work that was stopped.
fn uninterrupted(interrupted: bool) -> PyResult<()> {
    match interrupted {
        true => Err(PyKeyboardInterrupt::new_err("interrupted")),
        false => Ok(()),
    }
}

/// All variables, apart from the engine.
pub(crate) fn owned_variables(engine: &Engine) -> Vec<(String, Value)> {
    engine.variables().map(|(name, value)| (name.to_owned(), value.clone())).collect()
}

/// Variables by their names; external objects, which have no value here, are left out.
pub(crate) fn dict_of(
    py: Python<'_>,
    variables: Vec<(String, Value)>,
) -> PyResult<Bound<'_, PyDict>> {
    let dict = PyDict::new(py);
    for (name, value) in variables {
        if !matches!(value, Value::External(_)) {
            dict.set_item(name, values::to_python(py, value)?)?;
        }
    }
    Ok(dict)
}
