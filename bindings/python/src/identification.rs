//! Identification: problems as `gapi identify` solves them.

use crate::errors::{Reported, raised};
use crate::session::{Answer, Session, checked};
use crate::worker::Shown;
use gapilib::Session as Engine;
use gapilib::embedding::ResultsFolder;
use gapilib::internals::identify::problem::Solution;
use gapilib::internals::script::access::policy::Grant;
use gapilib::internals::script::runs::problem::{RunOptions, model_files, solve};
use indexmap::IndexMap;
use pyo3::exceptions::PyKeyboardInterrupt;
use pyo3::prelude::*;
use std::path::PathBuf;

/// The solution as JSON, as text, as the report's page; its figures as SVG and its tables as CSV by
/// their names; the calibrated model, and the files of its classes.
type Solved = (
    String,
    String,
    String,
    IndexMap<String, String>,
    IndexMap<String, String>,
    String,
    Vec<PathBuf>,
);

/// What is solved, and where its results go.
struct Task {
    problem: PathBuf,
    identity: PathBuf,
    out: PathBuf,
    overwrite: bool,
    given: IndexMap<PathBuf, Vec<u8>>,
    texts: Vec<(String, String)>,
}

/// Solves a problem in a session as `gapi identify` does. The package's `identify` makes an object of
/// what comes.
///
/// `given` are files in memory, `texts` names and texts of classes; the folder `out` says that it has
/// the results of `identity`.
#[pyfunction]
#[pyo3(signature = (session, problem, out, *, identity, given=IndexMap::new(), texts=Vec::new(),
    overwrite=false, resume=false, fresh=false, profile=false, design=false, bootstrap=false,
    posterior=false, sensitivity=None, samples=0, evaluations=None, searches=None, verbose=false,
    progress=None))]
#[allow(clippy::too_many_arguments, reason = "arguments of Python, all named")]
pub(crate) fn identify(
    py: Python<'_>,
    session: PyRef<'_, Session>,
    problem: PathBuf,
    out: PathBuf,
    identity: PathBuf,
    given: IndexMap<PathBuf, Vec<u8>>,
    texts: Vec<(String, String)>,
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
    verbose: bool,
    progress: Option<Py<PyAny>>,
) -> PyResult<Solved> {
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
    let task = Task { problem, identity, out, overwrite, given, texts };
    let shown = Shown { prints: verbose, progress: progress.as_ref() };
    let work = move |engine: &mut Engine| solved(engine, task, options);
    let (answer, _) = session.worker.call_shown(py, &shown, work)?;
    let (solved, interrupted) = answer.map_err(|errors: Vec<Reported>| {
        let errors: Vec<Reported> = errors.into_iter().map(Reported::in_python).collect();
        raised(py, &errors)
    })?;
    match interrupted {
        true => Err(PyKeyboardInterrupt::new_err("the identification was interrupted")),
        false => Ok(solved),
    }
}

fn solved(engine: &mut Engine, task: Task, options: RunOptions) -> Answer<(Solved, bool)> {
    let named = ("gapi identify", task.identity.as_path());
    let folder = ResultsFolder::claim(named, &task.out, task.overwrite);
    let folder = folder.map_err(|error| vec![Reported::refusal(&error)])?;
    engine.world.grant(Grant::Own(&folder.path));
    engine.world.grant(Grant::Read(&task.problem));
    engine.world.grant_input(&task.problem);
    for (name, text) in &task.texts {
        let loaded = engine.load_text(name, text);
        checked(engine, loaded)?;
    }
    task.given.into_iter().for_each(|(path, bytes)| engine.world.give(&path, bytes));
    let options = RunOptions { folder: folder.path.clone(), ..options };
    let solution = solve(engine, &task.problem, &options);
    let solution = checked(engine, solution)?;
    let interrupted = engine.is_interrupted();
    let (json, text, page) = (solution.to_json(), solution.text(), solution.html());
    let (figures, tables) = (figures(&solution), tables(&solution));
    let files = model_files(&solution.provenance.problem);
    Ok(((json, text, page, figures, tables, solution.modelica(), files), interrupted))
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

/// Tables that `gapi identify` writes, by their names without `.csv`.
fn tables(solution: &Solution) -> IndexMap<String, String> {
    let inferred = solution.inferred.tables().into_iter();
    let inferred = inferred.map(|(name, text)| (name.trim_end_matches(".csv").to_owned(), text));
    std::iter::once(("fit".to_owned(), solution.fit_csv())).chain(inferred).collect()
}
