//! Values that a model takes only when it is translated again: structural parameters and start
//! values, merged into the modification that the model was asked for with.

use super::modification::merge;
use super::translated::{Declaration, Translated};
use crate::causalize::CausalizedDae;
use crate::diag::Diagnostic;
use crate::flatten::{BaseType, Variability};
use crate::name::{Ident, Name};
use crate::source::{SourceId, Span};
use crate::symbolic::VarId;
use crate::syntax::ast::{ComponentReference, Expression, ExpressionKind, Modification};
use crate::syntax::{self, print};
use indexmap::IndexMap;
use std::sync::Arc;

/// What scripts changed in a model that has no slot in its program.
#[derive(Debug, Clone, Default)]
pub struct Changes {
    /// Values by the path of what they belong to: `a.n`, or `a.x.start` for a start value.
    values: IndexMap<String, Expression>,
    /// The model with them, if it has been translated.
    model: Option<Arc<Translated>>,
}

/// Numbers, as what they are given to counts them (Boolean 0 or 1, enumerations by ordinal), or a
/// text.
#[derive(Debug, Clone, Copy)]
pub enum Given<'a> {
    /// One number.
    Number(f64),
    /// An array of these sizes, the last dimension fastest.
    Array(&'a [usize], &'a [f64]),
    /// A text.
    Text(&'a str),
}

/// What a change concerns.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Changed {
    /// A structural parameter of the equations.
    Structure,
    /// A start value.
    Start,
    /// A start value of a state that begins with another value.
    Guess,
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
    pub(crate) fn keep_model(&mut self, model: Arc<Translated>) {
        self.model = Some(model);
    }

    /// From here on the model with these changes is another one.
    pub(crate) fn forget_model(&mut self) {
        self.model = None;
    }

    /// What was changed, as the script could write it.
    pub fn shown(&self) -> impl Iterator<Item = String> {
        let is_own = |(path, _): &(&String, _)| !path.ends_with(".fixed");
        let values = self.values.iter().filter(is_own);
        values.map(|(path, value)| format!("{path} = {}", print::expression(value)))
    }

    /// Gives a variable that has no slot a value; `None` if it cannot have one that way: it is final,
    /// a constant, of another size, an element of an array, or has no start value.
    pub fn set(&mut self, model: &Translated, name: &str, value: Given<'_>) -> Option<Changed> {
        let (name, is_start) = match name.strip_suffix(".start") {
            Some(name) => (name, true),
            None => (name, false),
        };
        let variable = model.declarations.get(name)?;
        let dims = match value {
            Given::Array(dims, _) => dims,
            Given::Number(_) | Given::Text(_) => &[],
        };
        // Changes before this one may have given it another size.
        let has_size = match self.is_empty() {
            true => variable.dims == dims,
            false => variable.dims.len() == dims.len(),
        };
        if name.contains('[') || variable.is_final || !has_size {
            return None;
        }
        if variable.variability == Variability::Parameter && !is_start {
            // Sorting may have taken others for numbers, too: a resistance of zero.
            let fits = match &variable.base {
                BaseType::String => matches!(value, Given::Text(_)),
                BaseType::ExternalObject(_) | BaseType::Clock => false,
                _ => !matches!(value, Given::Text(_)),
            };
            return (fits && !variable.says_fixed).then(|| {
                self.insert(name.to_owned(), literal(&variable.base, value));
                Changed::Structure
            });
        }
        let may_start = dims.is_empty() && may_start(model, name, variable);
        if variable.variability <= Variability::Parameter || !may_start {
            return None;
        }
        self.insert(format!("{name}.start"), literal(&variable.base, value));
        let sorted = model.program.sorted();
        let Some(state) = state(sorted, name) else { return Some(Changed::Start) };
        if !sorted.begins_with_start(state) {
            return Some(Changed::Guess);
        }
        let fixed = Expression::new(ExpressionKind::Boolean(true), Span::NONE);
        self.insert(format!("{name}.fixed"), fixed);
        Some(Changed::Start)
    }

    fn insert(&mut self, path: String, value: Expression) {
        self.values.insert(path, value);
        self.model = None;
    }

    /// The class of the model with the changes and further values in its modification.
    ///
    /// # Errors
    /// The problem that the model was asked for with is not one class with a modification.
    pub fn problem(
        &self,
        model: &Translated,
        further: &IndexMap<String, Expression>,
    ) -> Result<String, Vec<Diagnostic>> {
        let parsed = syntax::parse_class_with_modification(SourceId::NONE, &model.problem);
        let (class, mut arguments) = parsed.map_err(|error| vec![error])?;
        for (path, value) in self.values.iter().chain(further) {
            let parts: Vec<Ident> = Name::parse(path).parts.to_vec();
            merge(&mut arguments, &parts, value);
        }
        let modification = Modification { arguments, binding: None, span: Span::NONE };
        Ok(format!("{class}{}", print::modification(&modification)))
    }
}

/// The value as the type of what it belongs to writes it.
pub(super) fn literal(base: &BaseType, value: Given<'_>) -> Expression {
    let kind = match value {
        Given::Number(number) => return number_literal(base, number),
        Given::Text(text) => ExpressionKind::String(text.into()),
        Given::Array([], numbers) => {
            return number_literal(base, numbers.first().copied().unwrap_or(f64::NAN));
        }
        Given::Array([size, inner @ ..], numbers) => {
            let length = inner.iter().product::<usize>();
            let part = |at: usize| &numbers[at * length..(at + 1) * length];
            let parts = (0..*size).map(|at| literal(base, Given::Array(inner, part(at))));
            ExpressionKind::Array(parts.collect())
        }
    };
    Expression::new(kind, Span::NONE)
}

fn number_literal(base: &BaseType, number: f64) -> Expression {
    let kind = match base {
        BaseType::Boolean => ExpressionKind::Boolean(number != 0.0),
        BaseType::Integer => ExpressionKind::Integer(number as i64),
        BaseType::Enumeration(definition) => {
            let at = (number as usize).saturating_sub(1);
            let literal = definition.literals.get(at).copied();
            let name = literal.map_or(definition.name.clone(), |own| definition.name.child(own));
            let name = Name { global: true, ..name };
            ExpressionKind::Reference(ComponentReference::from_name(&name, Span::NONE))
        }
        _ => ExpressionKind::Real(number),
    };
    Expression::new(kind, Span::NONE)
}

fn may_start(model: &Translated, name: &str, variable: &Declaration) -> bool {
    variable
        .final_start
        .map_or_else(|| state(model.program.sorted(), name).is_some(), |is_final| !is_final)
}

fn state(sorted: &CausalizedDae, name: &str) -> Option<VarId> {
    sorted.states.iter().copied().find(|state| &*sorted.dae.variable(*state).name == name)
}
