//! A model ready to be simulated.

use super::stored::Answers;
use crate::codegen::Program;
use crate::flatten::{self, BaseType, FlatModel, Variability};
use crate::name::Ident;
use crate::syntax::ast::{CausalityPrefix, ComponentReference, Expression, ExpressionKind};
use crate::syntax::visit::{Visit, walk_expression};
use indexmap::IndexMap;
use serde::{Deserialize, Serialize};
use std::collections::BTreeSet;
use std::sync::{Arc, OnceLock};

/// A model ready to be simulated.
#[derive(Debug)]
pub struct Translated {
    /// The class with its modification, as it was asked for.
    pub problem: String,
    /// What its variables are declared as.
    pub declarations: Declarations,
    /// The compiled model.
    pub program: Arc<Program>,
    /// The top-level names on which it depends.
    pub(crate) roots: BTreeSet<Ident>,
    /// What it read of files and the environment when it was translated: tables above all.
    pub(crate) files: Answers,
    /// The flat model; a model that was kept, or is large, has none until it is requested.
    pub(super) flat: OnceLock<FlatModel>,
}

/// The variables of a model by their names, arrays as one.
pub type Declarations = IndexMap<Arc<str>, Declaration>;

/// What a variable is declared as: see [`flatten::Variable`].
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct Declaration {
    /// Its predefined type.
    pub base: BaseType,
    /// Sizes of its dimensions; empty for a scalar.
    pub dims: Vec<usize>,
    /// When it may change.
    pub variability: Variability,
    /// `input` or `output`, of top-level components only.
    pub causality: Option<CausalityPrefix>,
    /// Whether it is final.
    pub is_final: bool,
    /// Whether its value is used when the model is translated.
    pub is_evaluated: bool,
    /// The other variables on which its binding depends.
    pub computed_from: Vec<String>,
    /// Whether it stands directly in the class.
    pub top_level: bool,
    /// Whether it has the attribute `fixed`.
    pub(crate) says_fixed: bool,
    /// Whether the attribute `start` is final, if it has one.
    pub(crate) final_start: Option<bool>,
}

impl Translated {
    /// A model with its flat model.
    pub fn new(problem: &str, flat: FlatModel, program: Arc<Program>) -> Translated {
        let declarations = declarations(&flat);
        let flat = OnceLock::from(flat);
        Translated { flat, ..Translated::without_flat_model(problem, declarations, program) }
    }

    /// A model that was kept.
    pub(super) fn without_flat_model(
        problem: &str,
        declarations: Declarations,
        program: Arc<Program>,
    ) -> Translated {
        let (roots, files) = (BTreeSet::new(), Answers::new());
        let (problem, flat) = (problem.to_owned(), OnceLock::new());
        Translated { problem, declarations, program, roots, files, flat }
    }

    /// The names of the states, in their order.
    pub fn state_names(&self) -> impl Iterator<Item = &Arc<str>> {
        let sorted = self.program.sorted();
        sorted.states.iter().map(|state| &sorted.dae.variable(*state).name)
    }

    /// Number of scalar unknowns.
    pub fn unknowns(&self) -> usize {
        let is_unknown = |variable: &&Declaration| {
            variable.variability >= Variability::Discrete
                && variable.causality != Some(CausalityPrefix::Input)
        };
        let unknown = self.declarations.values().filter(is_unknown);
        unknown.map(|variable| variable.dims.iter().product::<usize>()).sum()
    }
}

impl Translated {
    /// The states that are declared in the model itself, and of which neither a start value nor any
    /// initial equation says where they begin.
    pub(super) fn states_without_start(&self) -> Vec<&str> {
        let sorted = self.program.sorted();
        if !sorted.dae.initial_equations.is_empty() || sorted.dae.events.initial.is_some() {
            return Vec::new();
        }
        let states = sorted.states.iter().map(|state| sorted.dae.variable(*state));
        let silent = states.filter(|state| {
            let declared = self.declarations.get(&*state.name);
            state.start.is_none() && declared.is_some_and(|own| own.top_level && !own.says_fixed)
        });
        silent.map(|state| &*state.name).collect()
    }
}

/// What the variables of a flat model are declared as.
pub(super) fn declarations(flat: &FlatModel) -> Declarations {
    let declared = |(name, variable): (&Arc<str>, &flatten::Variable)| {
        (name.clone(), Declaration::of(variable))
    };
    flat.variables.iter().map(declared).collect()
}

impl Declaration {
    fn of(variable: &flatten::Variable) -> Declaration {
        Declaration {
            base: variable.base.clone(),
            dims: variable.dims.clone(),
            variability: variable.variability,
            causality: variable.causality,
            is_final: variable.is_final,
            is_evaluated: variable.structural || variable.evaluate,
            computed_from: variable.binding.as_ref().map(references).unwrap_or_default(),
            top_level: variable.top_level,
            says_fixed: variable.attributes.contains_key("fixed"),
            final_start: variable.attributes.get("start").map(|start| start.is_final),
        }
    }
}

/// The variables on which a binding depends, each once.
fn references(binding: &Expression) -> Vec<String> {
    struct References(Vec<String>);
    impl Visit for References {
        fn reference(&mut self, reference: &ComponentReference) {
            let name = reference.name().to_string();
            if !self.0.contains(&name) {
                self.0.push(name);
            }
        }

        fn expression(&mut self, e: &Expression) {
            match &e.kind {
                // The name of a function is a reference as well.
                ExpressionKind::Call { arguments, .. } => {
                    arguments.positional.iter().for_each(|argument| self.expression(argument));
                    arguments.named.iter().for_each(|one| self.expression(&one.value));
                }
                _ => walk_expression(self, e),
            }
        }
    }
    let mut search = References(Vec::new());
    search.expression(binding);
    search.0
}
