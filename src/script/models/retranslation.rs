//! Values that a model takes only when it is translated again: structural parameters and start
//! values, merged into the modification that the model was asked for with.

use super::simulation::{self, Translated};
use crate::diag::Diagnostic;
use crate::flatten::{BaseType, Variability, Variable};
use crate::name::{Ident, Name};
use crate::script::Session;
use crate::script::errors::TRANSLATED_AGAIN;
use crate::source::{SourceId, Span, Spanned};
use crate::syntax::ast::{
    Argument, Binding, ElementModification, Expression, ExpressionKind, Modification,
};
use crate::syntax::{self, print};
use indexmap::IndexMap;
use std::sync::Arc;

/// What scripts changed in a model that has no slot in its program.
#[derive(Debug, Clone, Default)]
pub(super) struct Changes {
    /// Values by the path of what they belong to: `a.n`, or `a.x.start` for a start value.
    values: IndexMap<String, f64>,
    /// The model with them, if it has been translated.
    model: Option<Arc<Translated>>,
}

impl Changes {
    /// Whether nothing was changed.
    pub(super) fn is_empty(&self) -> bool {
        self.values.is_empty()
    }

    fn set(&mut self, path: String, value: f64) {
        self.values.insert(path, value);
        self.model = None;
    }
}

/// Gives a variable that has no slot a value; `false` if it cannot have one that way: it is final,
/// an array, a constant, or has no start value.
pub(super) fn change(
    changes: &mut Changes,
    model: &Translated,
    name: &str,
    value: f64,
) -> Option<Changed> {
    let (name, is_start) = match name.strip_suffix(".start") {
        Some(name) => (name, true),
        None => (name, false),
    };
    let variable = model.flat.variables.get(name)?;
    if name.contains('[') || variable.is_final || !variable.dims.is_empty() {
        return None;
    }
    if variable.variability == Variability::Parameter && !is_start {
        // Sorting may have taken others for numbers, too: a resistance of zero.
        let is_other = matches!(variable.base, BaseType::String | BaseType::ExternalObject(_));
        let is_number = !is_other && !variable.attributes.contains_key("fixed");
        return is_number.then(|| {
            changes.set(name.to_owned(), value);
            Changed::Structure
        });
    }
    if variable.variability <= Variability::Parameter || !may_start(model, variable) {
        return None;
    }
    changes.set(format!("{name}.start"), value);
    if is_state(model, name) {
        changes.set(format!("{name}.fixed"), 1.0);
    }
    Some(Changed::Start)
}

/// What a change concerns.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Changed {
    /// A parameter that shaped the equations.
    Structure,
    /// A start value.
    Start,
}

fn may_start(model: &Translated, variable: &Variable) -> bool {
    let start = variable.attributes.get("start");
    start.map_or_else(|| is_state(model, &variable.name), |start| !start.is_final)
}

fn is_state(model: &Translated, name: &str) -> bool {
    let sorted = model.program.sorted();
    sorted.states.iter().any(|state| &*sorted.dae.variable(*state).name == name)
}

impl Session {
    /// The model with these changes, translated again if need be.
    pub(super) fn changed_model(
        &mut self,
        model: &Arc<Translated>,
        changes: &mut Changes,
    ) -> Result<Arc<Translated>, Vec<Diagnostic>> {
        if let Some(known) = &changes.model {
            return Ok(known.clone());
        }
        let problem = changed_problem(model, changes)?;
        let changed = Arc::new(simulation::compiled(self, &problem)?);
        changes.model = Some(changed.clone());
        Ok(changed)
    }

    /// Says once for each name that a parameter shapes the equations.
    pub(super) fn note_structural(&mut self, name: &str, problem: &str) {
        if self.shared.insert(Ident::new(&format!("{problem}.{name}"))) {
            let message = format!(
                "`{name}` is a structural parameter of `{problem}`: the model is translated again"
            );
            self.note(TRANSLATED_AGAIN, message);
        }
    }
}

/// The problem with the changes in its modification.
fn changed_problem(model: &Translated, changes: &Changes) -> Result<String, Vec<Diagnostic>> {
    let parsed = syntax::parse_class_with_modification(SourceId::NONE, &model.problem);
    let (class, mut arguments) = parsed.map_err(|error| vec![error])?;
    for (path, value) in &changes.values {
        let parts: Vec<Ident> = Name::parse(path).parts.to_vec();
        merge(&mut arguments, &parts, &literal(model, path, *value));
    }
    let modification = Modification { arguments, binding: None, span: Span::NONE };
    Ok(format!("{class}{}", print::modification(&modification)))
}

/// The value as the type of what it belongs to writes it.
fn literal(model: &Translated, path: &str, value: f64) -> Expression {
    use crate::flatten::BaseType;
    let owner = path.strip_suffix(".start").unwrap_or(path);
    let base = model.flat.variables.get(owner).map(|variable| &variable.base);
    let kind = match base {
        Some(BaseType::Boolean) => ExpressionKind::Boolean(value != 0.0),
        Some(BaseType::Integer) => ExpressionKind::Integer(value as i64),
        None if path.ends_with(".fixed") => ExpressionKind::Boolean(value != 0.0),
        _ => ExpressionKind::Real(value),
    };
    Expression::new(kind, Span::NONE)
}

/// Gives the element at a path a value, within what is there already.
pub(super) fn merge(arguments: &mut Vec<Argument>, path: &[Ident], value: &Expression) {
    if let Some(modification) = modification_at(arguments, path) {
        modification.binding = Some(Binding::Expression(value.clone()));
    }
}

/// The modification of the element at a path, which is made where it is missing; `None` for the
/// empty path and behind a redeclaration.
pub(in crate::script) fn modification_at<'a>(
    arguments: &'a mut Vec<Argument>,
    path: &[Ident],
) -> Option<&'a mut Modification> {
    let (first, rest) = path.split_first()?;
    let position = arguments.iter().position(|argument| match argument {
        Argument::Element(element) => element.name.node == Name::from(*first),
        Argument::Redeclaration(_) => false,
    });
    let at = position.unwrap_or_else(|| {
        arguments.push(Argument::Element(element(*first)));
        arguments.len() - 1
    });
    let Argument::Element(element) = &mut arguments[at] else { return None };
    let modification = element.modification.get_or_insert_with(no_modification);
    if rest.is_empty() {
        Some(modification)
    } else {
        modification_at(&mut modification.arguments, rest)
    }
}

/// A modification that says nothing.
pub(in crate::script) fn no_modification() -> Modification {
    Modification { arguments: Vec::new(), binding: None, span: Span::NONE }
}

fn element(name: Ident) -> ElementModification {
    ElementModification {
        each: false,
        is_final: false,
        name: Spanned { node: Name::from(name), span: Span::NONE },
        modification: None,
        description: None,
        span: Span::NONE,
    }
}
