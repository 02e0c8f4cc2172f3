//! What the last simulation has left: the results that commands take which name none.

use crate::Session;
use crate::diag::Fault;
use crate::errors::BAD_ARGUMENT;
use crate::fault;
use crate::name::Name;
use std::path::Path;

/// The simulations so far, each result file once, in order.
#[derive(Default)]
struct Simulations(Vec<Simulation>);

/// A simulation under the names that paths such as `Name[end].variable` have for it.
struct Simulation {
    /// Of the model, and of the file.
    names: [String; 2],
    file: String,
    /// Why it has no results.
    failure: Option<String>,
}

impl Simulation {
    fn of(problem: &str, file: &str) -> Simulation {
        let model = problem.split('(').next().unwrap_or_default().trim().to_owned();
        let stem = Path::new(file).file_stem().unwrap_or_default().to_string_lossy().into_owned();
        Simulation { names: [model, stem], file: file.to_owned(), failure: None }
    }

    fn file(&self) -> Result<String, Fault> {
        let Some(reason) = &self.failure else { return Ok(self.file.clone()) };
        let model = &self.names[0];
        Err(fault!(BAD_ARGUMENT, "the last simulation of `{model}` has no results: {reason}";
            help: "correct the first error, or name a result file"))
    }
}

/// A simulation of the model translated last has written its results.
pub(super) fn note_results(session: &mut Session, file: &str) {
    let problem = session.last_model().map(|model| model.problem.clone()).unwrap_or_default();
    // Inputs that follow data come from a class around the model.
    let shown = session.classes.shown_name(&Name::parse(&problem)).map(str::to_owned);
    let problem = shown.unwrap_or(problem);
    keep(session, Simulation::of(&problem, file));
}

/// A simulation of a model that was to write this file has no results.
pub(super) fn note_none(session: &mut Session, problem: &str, file: &str, reason: String) {
    let failure = Some(reason);
    keep(session, Simulation { failure, ..Simulation::of(problem, file) });
}

fn keep(session: &mut Session, simulation: Simulation) {
    let Simulations(all) = session.extension();
    // A file that is written again holds the last results alone.
    all.retain(|known| known.file != simulation.file);
    all.push(simulation);
}

/// The result file of the last simulation; `None` before the first.
///
/// # Errors
/// The last simulation has no results.
pub(super) fn last_results(session: &mut Session) -> Result<Option<String>, Fault> {
    let Simulations(all) = session.extension();
    all.last().map(Simulation::file).transpose()
}

/// The result file of the last simulation of a model, or the last one of this name; `None` if there is
/// none.
///
/// # Errors
/// That simulation has no results.
pub(super) fn results_of(session: &mut Session, name: &str) -> Result<Option<String>, Fault> {
    let Simulations(all) = session.extension();
    let mut known = all.iter().rev();
    let found = known.find(|known| known.names.iter().any(|own| own == name));
    found.map(Simulation::file).transpose()
}
