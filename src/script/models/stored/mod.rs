//! Translated models that are kept from one process to the next.
//!
//! A translation depends on the classes that are loaded, on the files that are read for it, and on
//! the version of this program. The name under which it is kept says what classes were loaded, and
//! from where more would be; beside the model stands every question to the disk that was asked so
//! far, with the answer. A model is taken only where all answers are the same.

mod entry;
mod history;
mod reads;
mod state;

pub use history::History;
pub(crate) use reads::Answers;
pub(super) use reads::{Digest, digest};
pub use reads::{Reads, Watched};

use super::translated::Translated;
use super::uses::Uses;
use super::warnings::warn;
use crate::Session;
use crate::diag::Diagnostic;
use crate::name::Ident;
use crate::world::Store;
use entry::Entry;
use reads::ask;
use std::collections::BTreeSet;
use std::sync::Arc;

impl Session {
    /// What a model with these classes at the top level and these files depends on.
    pub(crate) fn uses_of(&self, roots: &BTreeSet<Ident>, files: &Answers) -> Uses {
        Uses::new(&self.classes.sources, roots, files)
    }

    /// Whether classes and files are still what they were.
    pub(crate) fn is_unchanged(&self, uses: &Uses) -> bool {
        uses.has_classes(&self.classes.sources) && self.would_answer(uses.files())
    }

    /// Whether the disk and the environment would answer the same now.
    pub(crate) fn would_answer(&self, answers: &Answers) -> bool {
        let (files, variable) = (self.world.reader(), |name: &str| self.variable_of_models(name));
        answers.iter().all(|(question, answer)| ask(&*files, &variable, question).0 == *answer)
    }

    /// An environment variable as models read it.
    fn variable_of_models(&self, name: &str) -> Option<String> {
        self.world.environment_variable(name).ok().flatten()
    }
}

/// A translation that is going to be done, or found.
pub struct Request {
    store: Arc<dyn Store>,
    /// What the model is kept under.
    name: String,
}

impl Request {
    /// `None` where nothing is kept.
    pub(super) fn new(session: &mut Session, problem: &str) -> Option<Request> {
        let store = session.storage.clone()?;
        let name = state::name(session, problem);
        session.classes.history.forget_searches();
        session.output.overheard = Some(Vec::new());
        Some(Request { store, name })
    }

    /// The model, if it is kept and would be the same now.
    pub(super) fn find(&self, session: &mut Session, problem: &str) -> Option<Translated> {
        let entry = Entry::read(&self.store.find(&self.name)?)?;
        let sources = entry.sources_if_unchanged(session)?;
        if !entry.repeats_searches(session) {
            return None;
        }
        let (model, warnings) = entry.model(problem, sources)?;
        session.output.overheard = None;
        warn(session, &warnings);
        Some(model)
    }

    /// Keeps a model with what was said about it.
    pub(super) fn keep(self, session: &mut Session, model: &Translated) {
        let warnings: Vec<Diagnostic> = session.output.overheard.take().unwrap_or_default();
        if let Some(bytes) = Entry::of(session, model, &warnings) {
            self.store.keep(&self.name, &bytes);
        }
    }
}
