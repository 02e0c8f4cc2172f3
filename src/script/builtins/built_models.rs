//! The models that `buildModel` has built, and their init files; both exist in the session alone.

use super::simflags::SimulationFlags;
use crate::Session;
use crate::bail;
use crate::diag::{Diagnostic, Fault};
use crate::errors::BAD_ARGUMENT;
use crate::fault;
use crate::models::simulation::{self, SimulationOptions, Translated};
use crate::models::uses::Uses;
use regex::Regex;
use std::collections::BTreeMap;
use std::sync::Arc;

/// A model as it was built.
#[derive(Clone)]
pub(super) struct Executable {
    /// The model, whatever becomes of its class afterwards.
    pub model: Arc<Translated>,
    /// What its classes were.
    pub classes: Uses,
    /// The settings of the simulation.
    pub options: SimulationOptions,
    /// The ending of its result file.
    pub format: String,
    /// The names that are stored.
    pub filter: Regex,
    /// Flags that every run has.
    pub flags: String,
}

impl Executable {
    /// The model, with what is in the files now that it reads.
    ///
    /// # Errors
    /// The files have changed, and so have its classes.
    pub(super) fn model(&self, session: &mut Session) -> Result<Arc<Translated>, Vec<Diagnostic>> {
        if session.would_answer(&self.model.files) {
            return Ok(self.model.clone());
        }
        let problem = &self.model.problem;
        if session.is_unchanged(&self.classes) {
            return simulation::translated(session, problem);
        }
        let fault = fault!(BAD_ARGUMENT, "files that `{problem}` reads have changed since it was built, \
                                          and its classes as well"; help: "build it again");
        Err(vec![fault.at(session.call_site())])
    }
}

/// The models that were built, by the names of their programs, and what scripts wrote into their
/// init files.
#[derive(Default)]
struct Built {
    programs: BTreeMap<String, Executable>,
    init_files: BTreeMap<String, Vec<(String, String)>>,
    /// The classes that could not be built, by the names that their programs were to have.
    refused: BTreeMap<String, String>,
}

/// Notes a model that was built, and returns the name of its init file.
pub(super) fn keep(session: &mut Session, prefix: &str, program: Executable) -> String {
    let built = session.extension::<Built>();
    let init_file = init_file(prefix);
    built.init_files.insert(init_file.clone(), Vec::new());
    built.programs.insert(prefix.to_owned(), program);
    built.refused.remove(prefix);
    init_file
}

/// A class could not be built: an older program of the name does not stand for it.
pub(super) fn refuse(session: &mut Session, prefix: &str, class: String) {
    let built = session.extension::<Built>();
    built.programs.remove(prefix);
    built.refused.insert(prefix.to_owned(), class);
}

/// The class whose program was to have this name, if it could not be built.
pub(super) fn refused(session: &mut Session, name: &str) -> Option<String> {
    session.extension::<Built>().refused.get(name).cloned()
}

/// The name of the init file of a program.
pub(super) fn init_file(prefix: &str) -> String {
    format!("{prefix}_init.xml")
}

/// Puts the values of the init file that flags name among them.
///
/// # Errors
/// No script has made such a file.
pub(super) fn preset(session: &mut Session, flags: &mut SimulationFlags) -> Result<(), Fault> {
    let Some(file) = flags.init_file.clone() else { return Ok(()) };
    let Some(values) = session.extension::<Built>().init_files.get(&file) else {
        bail!(
            BAD_ARGUMENT,
            "the init file `{file}` does not exist; create it with `setInitXmlStartValue`"
        );
    };
    flags.preset(values);
    Ok(())
}

/// The program of this name.
pub(super) fn program(session: &mut Session, name: &str) -> Option<Executable> {
    session.extension::<Built>().programs.get(name).cloned()
}

/// What an init file holds, if there is one.
pub(super) fn init_file_values(session: &mut Session, file: &str) -> Option<Vec<(String, String)>> {
    session.extension::<Built>().init_files.get(file).cloned()
}

/// Writes an init file.
pub(super) fn keep_init_file(session: &mut Session, file: String, values: Vec<(String, String)>) {
    session.extension::<Built>().init_files.insert(file, values);
}
