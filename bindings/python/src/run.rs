//! Scripts as `gapi run` runs them.

use crate::errors::{Reported, raised};
use crate::session::{dict_of, ended, owned_variables};
use crate::worker::{Worker, written};
use gapilib::Value;
use gapilib::embedding::Embedding;
use gapilib::{Journaling, Options, Permissions};
use pyo3::exceptions::PyKeyboardInterrupt;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use std::path::PathBuf;

/// Seconds between two checkpoints.
const CHECKPOINT: f64 = 2.0;

type Ended = (Vec<(String, Value)>, Result<(), Vec<Reported>>, bool);

/// Runs a script as `gapi run` does, with checkpoints, results in `out` (by default a folder for each
/// script in `results`); its variables as a dict.
#[pyfunction]
#[pyo3(signature = (script, *, out=None, overwrite=false, resume=false, libraries=Vec::new(),
    threads=None, allow_read=Vec::new(), allow_write=false, allow_system=false,
    allow_external=false, cache=true, progress=None))]
#[allow(clippy::too_many_arguments, reason = "arguments of Python, all named")]
pub(crate) fn run<'py>(
    py: Python<'py>,
    script: PathBuf,
    out: Option<PathBuf>,
    overwrite: bool,
    resume: bool,
    libraries: Vec<PathBuf>,
    threads: Option<usize>,
    allow_read: Vec<PathBuf>,
    allow_write: bool,
    allow_system: bool,
    allow_external: bool,
    cache: bool,
    progress: Option<Py<PyAny>>,
) -> PyResult<Bound<'py, PyDict>> {
    let embedding = Embedding {
        libraries,
        threads,
        read: allow_read,
        write: allow_write,
        external: allow_external,
        cache,
    };
    let journaling = match resume {
        true => Journaling::Resume(CHECKPOINT),
        false => Journaling::Fresh(CHECKPOINT),
    };
    let permissions = Permissions { system: allow_system, ..Permissions::default() };
    let file = script.clone();
    let worker = Worker::new(
        py,
        threads,
        move |screen, stop| {
            let task = ("gapi run", file.as_path());
            let session =
                embedding.session_for(task, (out.as_deref(), overwrite), (screen, stop))?;
            Ok(session.with_options(Options { journaling, permissions, ..Options::default() }))
        },
        progress,
    )?;
    let (answer, errors) = worker.call_quietly(py, move |engine| -> Ended {
        let status = engine.run_file(&script);
        (owned_variables(engine), ended(engine, status.errors), status.interrupted)
    })?;
    let (variables, outcome, interrupted) = answer;
    if interrupted {
        return Err(PyKeyboardInterrupt::new_err(
            "the run was interrupted; `resume=True` continues it",
        ));
    }
    outcome.map_err(|errors| raised(py, &errors))?;
    written(py, "stderr", &errors)?;
    dict_of(py, variables)
}
