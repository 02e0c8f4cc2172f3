//! The models that a session has compiled, and the one that dotted names of scripts refer to.

use super::changes::Changes;
use super::translated::Translated;
use crate::name::Ident;
use crate::source::Span;
use indexmap::IndexMap;
use rustc_hash::{FxHashMap, FxHashSet};
use std::collections::BTreeSet;
use std::sync::Arc;

/// The compiled models of a session.
#[derive(Default)]
pub struct CompiledModels {
    /// By the class with its modification, each with the revision of the classes then.
    known: FxHashMap<String, (u64, Arc<Translated>)>,
    /// The model translated last.
    pub current: Option<Current>,
    /// Where the last simulation ended.
    pub end: Option<End>,
    /// The warnings reported so far.
    reported: FxHashSet<(Span, String)>,
    /// Names of parameters about which a note was reported.
    noted: BTreeSet<Ident>,
}

/// The end of a simulation: what a later one may begin with.
#[derive(Debug, Clone)]
pub struct End {
    /// Start and stop time, seconds.
    pub span: (f64, f64),
    /// The states.
    pub states: IndexMap<Arc<str>, f64>,
}

/// The model translated last, with the values that scripts gave to its parameters.
#[derive(Clone)]
pub struct Current {
    /// The model.
    pub model: Arc<Translated>,
    /// Values by the index of the parameter.
    pub overrides: IndexMap<usize, f64>,
    /// Values that another translation needs.
    pub changes: Changes,
    /// Values that the states have at the start in place of those of the initial equations.
    pub imported: IndexMap<Arc<str>, f64>,
}

impl Current {
    /// The model with the values that it has itself.
    pub fn of(model: Arc<Translated>) -> Current {
        let (overrides, imported) = (IndexMap::new(), IndexMap::new());
        Current { model, overrides, changes: Changes::default(), imported }
    }
}

impl CompiledModels {
    /// A model compiled when the classes had this revision.
    pub fn get(&self, problem: &str, revision: u64) -> Option<Arc<Translated>> {
        let (then, model) = self.known.get(problem)?;
        (*then == revision).then(|| model.clone())
    }

    /// Keeps a model, compiled when the classes had this revision.
    pub fn keep(&mut self, revision: u64, model: &Arc<Translated>) {
        self.known.insert(model.problem.clone(), (revision, model.clone()));
    }

    /// Forgets all models.
    pub fn forget(&mut self) {
        self.known.clear();
        self.reported.clear();
        self.current = None;
    }

    /// The model translated last.
    pub fn last(&self) -> Option<&Arc<Translated>> {
        self.current.as_ref().map(|current| &current.model)
    }

    /// Makes a model the one that dotted names refer to; it keeps its values if it was it already.
    pub fn refer_to(&mut self, model: &Arc<Translated>) {
        if !self.last().is_some_and(|last| Arc::ptr_eq(last, model)) {
            self.refer_anew_to(model);
        }
    }

    /// Makes a model, with the values that it has itself, the one that dotted names refer to.
    pub fn refer_anew_to(&mut self, model: &Arc<Translated>) {
        self.current = Some(Current::of(model.clone()));
    }

    /// Whether a warning about a model is to be reported: it was not yet.
    pub fn is_new_warning(&mut self, span: Span, message: &str) -> bool {
        self.reported.insert((span, message.to_owned()))
    }

    /// Whether a note about a parameter is to be reported: there was none yet.
    pub fn is_new_note(&mut self, name: Ident) -> bool {
        self.noted.insert(name)
    }

    /// The value that a parameter of the model translated last has, or `None` if the model has no
    /// such parameter.
    pub fn parameter_value(&self, name: &str) -> Option<f64> {
        let current = self.current.as_ref()?;
        let index = current.model.program.find_parameter(name).ok()?;
        let default = current.model.program.parameters()[index].default;
        Some(current.overrides.get(&index).copied().unwrap_or(default))
    }
}
