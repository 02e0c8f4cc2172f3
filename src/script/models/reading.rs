//! Values of the model translated last as scripts read them, each of the type of its declaration.

use super::addressing::addressed;
use super::simulation::flat_model_of;
use super::translated::Translated;
use super::typed::value_of;
use crate::Session;
use crate::diag::Diagnostic;
use crate::flatten::{BaseType, Variability};
use crate::syntax::ast::{ComponentReference, ExpressionKind};
use crate::value::Value;
use std::sync::Arc;

impl Session {
    /// The value that a parameter of the model translated last has, an array of them, or a part of
    /// one.
    ///
    /// # Errors
    /// What scripts changed cannot be translated.
    pub(crate) fn model_value(
        &mut self,
        reference: &ComponentReference,
    ) -> Result<Option<Value>, Diagnostic> {
        let Some(last) = self.models.last().cloned() else { return Ok(None) };
        let known = |model: &Translated| {
            let found = addressed(model, reference);
            found.filter(|found| found.declaration.variability <= Variability::Parameter)
        };
        let is_changed = self.models.current.as_ref().is_some_and(|now| !now.changes.is_empty());
        // A change may give the model what it did not have.
        if known(&last).is_none() && !is_changed {
            return Ok(None);
        }
        let model = if is_changed { self.shaped_model(&last)? } else { last };
        let Some(found) = known(&model) else { return Ok(None) };
        if found.declaration.base == BaseType::String {
            let [name] = found.names.as_slice() else { return Ok(None) };
            return self.text_of(&model, name);
        }
        let numbers = self.numbers_of(&model, &found.names)?;
        Ok(numbers.and_then(|numbers| value_of(&found.declaration.base, found.dims, numbers)))
    }

    /// A String of the model, where it is written as one.
    fn text_of(&mut self, model: &Translated, name: &str) -> Result<Option<Value>, Diagnostic> {
        let first = |mut errors: Vec<Diagnostic>| errors.swap_remove(0);
        let flat = flat_model_of(self, model).map_err(first)?;
        let binding = flat.variables.get(name).and_then(|variable| variable.binding.as_ref());
        Ok(match binding.map(|binding| &binding.kind) {
            Some(ExpressionKind::String(text)) => Some(Value::String(text.clone())),
            _ => None,
        })
    }

    /// The values of parameters and constants; `None` where one has none before a simulation.
    pub(super) fn numbers_of(
        &mut self,
        model: &Arc<Translated>,
        names: &[String],
    ) -> Result<Option<Vec<f64>>, Diagnostic> {
        let set = self.models.current.as_ref().map(|current| current.overrides.clone());
        let set = set.unwrap_or_default();
        let parameters = model.program.parameters();
        let slot = |name: &String| {
            let own = parameters.iter().find(|parameter| &*parameter.name == name.as_str())?;
            let given = set.get(name.as_str()).copied();
            given.or_else(|| set.is_empty().then_some(own.default))
        };
        if let Some(numbers) = names.iter().map(slot).collect() {
            return Ok(Some(numbers));
        }
        // A parameter may depend on one that was set.
        let system = self.parameters_of(model)?;
        let variables = model.program.variables();
        let value = |name: &String| {
            let at = variables.iter().position(|variable| &*variable.name == name.as_str())?;
            system.value(at)
        };
        Ok(names.iter().map(value).collect())
    }
}
