//! Identification: problems as `gapi identify` solves them.

use crate::errors::{Reported, raised};
use crate::session::{Answer, checked};
use crate::worker::{Worker, written};
use gapilib::embedding::Embedding;
use gapilib::internals::identify::problem::Solution;
use gapilib::Session as Engine;
use gapilib::internals::script::access::policy::Grant;
use gapilib::internals::script::runs::problem::{RunOptions, solve};
use indexmap::IndexMap;
use pyo3::exceptions::PyKeyboardInterrupt;
use pyo3::prelude::*;
use std::path::PathBuf;

/// The solution as JSON, as text, as the report's page, and its figures as SVG by their names.
type Solved = (String, String, String, IndexMap<String, String>);

/// Solves the problem of a file as `gapi identify` does: JSON, text, page and figures of the solution.
/// The package's `identify` makes an object of them.
#[pyfunction]
#[pyo3(signature = (problem, *, out=None, overwrite=false, resume=false, fresh=false, profile=false,
    design=false, bootstrap=false, posterior=false, sensitivity=None, samples=0, evaluations=None,
    searches=None, libraries=Vec::new(), threads=None, allow_read=Vec::new(), allow_external=false, cache=true,
    progress=None))]
#[allow(clippy::too_many_arguments, reason = "arguments of Python, all named")]
pub(crate) fn identify(
    py: Python<'_>,
    problem: PathBuf,
    out: Option<PathBuf>,
    overwrite: bool,
    resume: bool,
    fresh: bool,
    profile: bool,
    design: bool,
    bootstrap: bool,
    posterior: bool,
    sensitivity: Option<String>,
    samples: usize,
    evaluations: Option<u64>,
    searches: Option<usize>,
    libraries: Vec<PathBuf>,
    threads: Option<usize>,
    allow_read: Vec<PathBuf>,
    allow_external: bool,
    cache: bool,
    progress: Option<Py<PyAny>>,
) -> PyResult<Solved> {
    let embedding = Embedding {
        libraries,
        threads,
        read: allow_read,
        external: allow_external,
        cache,
        ..Embedding::default()
    };
    let options = RunOptions {
        resume,
        fresh,
        profile,
        design,
        bootstrap,
        posterior,
        sensitivity,
        samples,
        evaluations,
        searches,
        ..RunOptions::default()
    };
    let file = problem.clone();
    let worker = Worker::new(
        py,
        threads,
        move |screen, stop| {
            let task = ("gapi identify", file.as_path());
            embedding.session_for(task, (out.as_deref(), overwrite), (screen, stop))
        },
        progress,
    )?;
    let (answer, errors) =
        worker.call_quietly(py, move |engine| solved(engine, &problem, &options))?;
    let (solved, interrupted) = answer.map_err(|errors: Vec<Reported>| raised(py, &errors))?;
    written(py, "stderr", &errors)?;
    match interrupted {
        true => Err(PyKeyboardInterrupt::new_err(
            "the identification was interrupted; `resume=True` continues it",
        )),
        false => Ok(solved),
    }
}

fn solved(
    engine: &mut Engine,
    problem: &std::path::Path,
    options: &RunOptions,
) -> Answer<(Solved, bool)> {
    engine.world.grant(Grant::Read(problem));
    engine.grant_input(problem);
    let solution = solve(engine, problem, options);
    let solution = checked(engine, solution)?;
    let interrupted = engine.is_interrupted();
    let solved = (solution.to_json(), solution.text(), solution.html(), figures(&solution));
    Ok((solved, interrupted))
}

/// Those that `gapi identify` writes, by the names of the files, and the profiles of the report.
fn figures(solution: &Solution) -> IndexMap<String, String> {
    let stem = |name: String| name.trim_end_matches(".svg").to_owned();
    let fits = solution.fit_figures().into_iter().map(|(name, figure)| (stem(name), figure));
    let profiles = solution.profile_figures().into_iter();
    let profiles = profiles.map(|(parameter, figure)| (format!("profile-{parameter}"), figure));
    let convergence = ("convergence".to_owned(), solution.convergence_figure());
    let all = fits.chain([convergence]).chain(profiles);
    all.map(|(name, figure)| (name, figure.svg())).collect()
}
