//! Values that a model takes only when it is translated again: structural parameters and start
//! values, merged into the modification that the model was asked for with.

use super::modification::merge;
use super::translated::{Declaration, Translated};
use crate::diag::Diagnostic;
use crate::flatten::{BaseType, Variability};
use crate::name::{Ident, Name};
use crate::source::{SourceId, Span};
use crate::syntax::ast::{Expression, ExpressionKind, Modification};
use crate::syntax::{self, print};
use indexmap::IndexMap;
use std::sync::Arc;

/// What scripts changed in a model that has no slot in its program.
#[derive(Debug, Clone, Default)]
pub struct Changes {
    /// Values by the path of what they belong to: `a.n`, or `a.x.start` for a start value.
    values: IndexMap<String, ExpressionKind>,
    /// The model with them, if it has been translated.
    model: Option<Arc<Translated>>,
}

/// What a change concerns.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Changed {
    /// A parameter that shaped the equations.
    Structure,
    /// A start value.
    Start,
}

impl Changes {
    /// Whether nothing was changed.
    pub fn is_empty(&self) -> bool {
        self.values.is_empty()
    }

    /// The model with these changes, if it has been translated.
    pub fn model(&self) -> Option<&Arc<Translated>> {
        self.model.as_ref()
    }

    /// Keeps the model with these changes.
    pub fn keep_model(&mut self, model: Arc<Translated>) {
        self.model = Some(model);
    }

    /// Gives a variable that has no slot a value; `None` if it cannot have one that way: it is final,
    /// an array, a constant, or has no start value.
    pub fn set(&mut self, model: &Translated, name: &str, value: f64) -> Option<Changed> {
        let (name, is_start) = match name.strip_suffix(".start") {
            Some(name) => (name, true),
            None => (name, false),
        };
        let variable = model.declarations.get(name)?;
        if name.contains('[') || variable.is_final || !variable.dims.is_empty() {
            return None;
        }
        if variable.variability == Variability::Parameter && !is_start {
            // Sorting may have taken others for numbers, too: a resistance of zero.
            let is_other = matches!(variable.base, BaseType::String | BaseType::ExternalObject(_));
            let is_number = !is_other && !variable.says_fixed;
            return is_number.then(|| {
                self.insert(name.to_owned(), literal(variable, value));
                Changed::Structure
            });
        }
        if variable.variability <= Variability::Parameter || !may_start(model, name, variable) {
            return None;
        }
        self.insert(format!("{name}.start"), literal(variable, value));
        if is_state(model, name) {
            self.insert(format!("{name}.fixed"), ExpressionKind::Boolean(true));
        }
        Some(Changed::Start)
    }

    /// Gives a String parameter a value; `false` if there is none of this name that may be set.
    pub fn set_text(&mut self, model: &Translated, name: &str, text: &str) -> bool {
        let is_text = model.declarations.get(name).is_some_and(|variable| {
            variable.base == BaseType::String
                && variable.variability == Variability::Parameter
                && variable.dims.is_empty()
                && !variable.is_final
        });
        if is_text {
            self.insert(name.to_owned(), ExpressionKind::String(text.into()));
        }
        is_text
    }

    fn insert(&mut self, path: String, value: ExpressionKind) {
        self.values.insert(path, value);
        self.model = None;
    }

    /// The class of the model with the changes in its modification.
    ///
    /// # Errors
    /// The problem that the model was asked for with is not one class with a modification.
    pub fn problem(&self, model: &Translated) -> Result<String, Vec<Diagnostic>> {
        let parsed = syntax::parse_class_with_modification(SourceId::NONE, &model.problem);
        let (class, mut arguments) = parsed.map_err(|error| vec![error])?;
        for (path, value) in &self.values {
            let parts: Vec<Ident> = Name::parse(path).parts.to_vec();
            merge(&mut arguments, &parts, &Expression::new(value.clone(), Span::NONE));
        }
        let modification = Modification { arguments, binding: None, span: Span::NONE };
        Ok(format!("{class}{}", print::modification(&modification)))
    }
}

/// The value as the type of what it belongs to writes it.
fn literal(variable: &Declaration, value: f64) -> ExpressionKind {
    match &variable.base {
        BaseType::Boolean => ExpressionKind::Boolean(value != 0.0),
        BaseType::Integer => ExpressionKind::Integer(value as i64),
        _ => ExpressionKind::Real(value),
    }
}

fn may_start(model: &Translated, name: &str, variable: &Declaration) -> bool {
    variable.final_start.map_or_else(|| is_state(model, name), |is_final| !is_final)
}

fn is_state(model: &Translated, name: &str) -> bool {
    let sorted = model.program.sorted();
    sorted.states.iter().any(|state| &*sorted.dae.variable(*state).name == name)
}
