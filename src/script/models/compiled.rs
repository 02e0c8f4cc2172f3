//! The models that a session has compiled, and the one that dotted names of scripts refer to.

use super::changes::{Changes, Given, literal};
use super::final_state::FinalState;
use super::translated::Translated;
use super::uses::Uses;
use crate::diag::Fault;
use crate::errors::BAD_PARAMETER_VALUE;
use crate::fault;
use crate::flatten::BaseType;
use crate::name::Ident;
use crate::source::Span;
use crate::syntax::ast::ComponentReference;
use crate::syntax::print;
use indexmap::IndexMap;
use rustc_hash::{FxHashMap, FxHashSet};
use std::collections::BTreeSet;
use std::sync::Arc;

/// The compiled models of a session.
#[derive(Default)]
pub(crate) struct CompiledModels {
    /// By the class with its modification, each with what it depends on.
    known: FxHashMap<String, (Uses, Arc<Translated>)>,
    /// The model translated last.
    pub current: Option<Current>,
    /// Where the last simulation ended.
    pub end: Option<FinalState>,
    /// The warnings reported so far.
    reported: FxHashSet<(Span, String)>,
    /// Whether models are translated for others, who give their inputs values.
    pub inputs_come_later: bool,
    /// Names of parameters about which a note was reported.
    noted: BTreeSet<Ident>,
    /// What was set by hand on models whose place another one has taken.
    left: FxHashMap<String, Vec<String>>,
    /// Variables that are the scripts' own, whatever parameter has the same name.
    own: FxHashSet<Ident>,
}

/// The model translated last, with the values that scripts gave to its parameters.
#[derive(Clone)]
pub(crate) struct Current {
    /// The model.
    pub model: Arc<Translated>,
    /// Values of parameters by their names.
    pub overrides: IndexMap<Arc<str>, f64>,
    /// Values that another translation needs.
    pub changes: Changes,
    /// Values that states and discrete variables have at the start in place of those of the initial equations.
    pub imported: IndexMap<Arc<str>, f64>,
    /// Names that scripts could not give a value: the one before does not stand for it.
    pub(crate) unset: BTreeSet<String>,
}

impl Current {
    /// The model with the values that it has itself.
    pub(crate) fn of(model: Arc<Translated>) -> Current {
        let (overrides, imported) = (IndexMap::new(), IndexMap::new());
        Current { model, overrides, changes: Changes::default(), imported, unset: BTreeSet::new() }
    }

    /// # Errors
    /// An assignment to a parameter failed, and none has given it a value since.
    pub(crate) fn check_set(&self) -> Result<(), Fault> {
        let Some(name) = self.unset.first() else { return Ok(()) };
        let problem = &self.model.problem;
        Err(
            fault!(BAD_PARAMETER_VALUE, "`{name}` of `{problem}` has no value: the assignment to it \
                                         failed";
            help: "correct the assignment, or translate the model again"),
        )
    }

    /// What scripts set by hand, as they could write it.
    pub(crate) fn set_by_hand(&self) -> Vec<String> {
        let changes = self.changes.shown();
        let number = |(name, value): (&Arc<str>, &f64)| {
            format!("{name} = {}", shown(&self.model, name, *value))
        };
        changes.chain(self.overrides.iter().map(number)).collect()
    }
}

/// The value of a parameter as Modelica writes it.
fn shown(model: &Translated, name: &str, value: f64) -> String {
    let mut parameters = model.program.parameters().iter();
    let base = parameters.find(|known| &*known.name == name).map(|known| &known.base);
    print::expression(&literal(base.unwrap_or(&BaseType::Real), Given::Number(value)))
}

impl CompiledModels {
    /// A model, and what it depends on.
    pub(crate) fn get(&self, problem: &str) -> Option<&(Uses, Arc<Translated>)> {
        self.known.get(problem)
    }

    /// Keeps a model that depends on these classes.
    pub(crate) fn keep(&mut self, uses: Uses, model: &Arc<Translated>) {
        self.known.insert(model.problem.clone(), (uses, model.clone()));
    }

    /// Forgets all models.
    pub(crate) fn forget(&mut self) {
        self.known.clear();
        self.reported.clear();
        self.left.clear();
        self.current = None;
    }

    /// The model translated last.
    pub(crate) fn last(&self) -> Option<&Arc<Translated>> {
        self.current.as_ref().map(|current| &current.model)
    }

    /// Makes a model, with the values that it has itself, the one that dotted names refer to.
    pub(crate) fn refer_anew_to(&mut self, model: &Arc<Translated>) {
        self.current = Some(Current::of(model.clone()));
    }

    /// An assignment to something in the current model failed.
    pub(crate) fn note_unset(&mut self, target: &ComponentReference) {
        if let Some(current) = &mut self.current {
            current.unset.insert(target.name().to_string());
        }
    }

    /// Something in the current model has got a value.
    pub(crate) fn note_set(&mut self, target: &ComponentReference) {
        if let Some(current) = &mut self.current {
            current.unset.remove(&target.name().to_string());
        }
    }

    /// Whether a warning about a model is to be reported: it was not yet.
    pub(crate) fn is_new_warning(&mut self, span: Span, message: &str) -> bool {
        self.reported.insert((span, message.to_owned()))
    }

    /// Another model takes the place of the current one.
    pub(crate) fn leave(&mut self, before: &Current) {
        let values = before.set_by_hand();
        if !values.is_empty() {
            self.left.insert(before.model.problem.clone(), values);
        }
    }

    /// What was set by hand on a model before another one took its place.
    pub(crate) fn take_left(&mut self, problem: &str) -> Option<Vec<String>> {
        self.left.remove(problem)
    }

    /// A script has a variable of this name that has nothing to do with a model.
    pub(crate) fn note_own(&mut self, name: Ident) {
        self.own.insert(name);
    }

    /// Whether a variable is the scripts' own, whatever parameter has the same name.
    pub(crate) fn is_own(&self, name: Ident) -> bool {
        self.own.contains(&name)
    }

    /// The scripts' variables are gone.
    pub(crate) fn forget_variables(&mut self) {
        self.own.clear();
    }

    /// Whether a note about a parameter is to be reported: there was none yet.
    pub(crate) fn is_new_note(&mut self, name: Ident) -> bool {
        self.noted.insert(name)
    }

    /// What scripts changed the model translated last to, and the model itself.
    pub(super) fn shaped(&self) -> impl Iterator<Item = Arc<Translated>> + use<> {
        let current = self.current.as_ref();
        let changed = current.and_then(|current| current.changes.model()).cloned();
        changed.into_iter().chain(current.map(|current| current.model.clone()))
    }

    /// How a script reads a variable of the model translated last, which its own names do not reach.
    pub(crate) fn trajectory_help(&self, name: &str) -> Option<String> {
        let model = self.last().filter(|model| model.declarations.contains_key(name))?;
        Some(format!(
            "`{name}` is a variable of `{}`, not of the script: read its values from the result file, \
             `readTrajectory(\"dsres.mat\", {{\"{name}\"}}, readTrajectorySize(\"dsres.mat\"))`",
            model.problem
        ))
    }

    /// Values of parameters that were set by hand, by their names.
    pub(super) fn values_set_by_hand(&self) -> Vec<(Arc<str>, f64)> {
        let current = self.current.iter();
        current.flat_map(|current| current.overrides.clone()).collect()
    }

    /// Gives states and discrete variables of the model translated last values at the start of its next simulations,
    /// whatever its initial equations say; none to take them back.
    pub(crate) fn import_states(&mut self, states: IndexMap<Arc<str>, f64>) {
        if let Some(current) = &mut self.current {
            current.imported = states;
        }
    }
}
