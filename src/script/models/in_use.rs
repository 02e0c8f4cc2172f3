//! A model as it is in use: with what scripts set by hand, where it is the one translated last.

use super::addressing::{addressed, flat_name};
use super::changes::{Given, literal};
use super::simulation::translate;
use super::translated::Translated;
use crate::Session;
use crate::diag::{At, Diagnostic};
use crate::errors::START_VALUES_MISSING;
use crate::flatten::flat_reference;
use crate::source::Span;
use crate::syntax::ast::{ComponentReference, Expression};
use indexmap::IndexMap;
use std::sync::Arc;

/// A model with what was set by hand.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct InUse {
    /// The class with its modification, and with what needs another translation.
    pub problem: String,
    /// The same with all that was set by hand.
    pub shown: String,
    /// Values of parameters, as bits.
    values: Vec<(Arc<str>, u64)>,
}

impl InUse {
    /// Values of parameters by their names.
    pub(crate) fn values(&self) -> impl Iterator<Item = (&str, f64)> {
        self.values.iter().map(|(name, bits)| (&**name, f64::from_bits(*bits)))
    }
}

impl Session {
    /// The model of a problem as it is in use; the parameters in `varied`, or without them all at the
    /// top level, have values of their own.
    ///
    /// # Errors
    /// Its classes have changed, and it cannot be translated again.
    pub(crate) fn in_use(
        &mut self,
        problem: &str,
        varied: &[String],
    ) -> Result<InUse, Vec<Diagnostic>> {
        let problem = problem.trim();
        let plain = InUse { problem: problem.into(), shown: problem.into(), values: Vec::new() };
        let Some(last) = self.last_model().filter(|last| last.problem == problem) else {
            return Ok(plain);
        };
        translate(self, &last.problem)?;
        let Some(current) = self.models.current.clone() else { return Ok(plain) };
        current.check_set().at(self.call_site()).map_err(|error| vec![error])?;
        if !current.imported.is_empty() {
            self.note_not_continued(problem);
        }
        let parameters = current.model.program.parameters();
        let is_top_level =
            |name: &str| parameters.iter().any(|known| &*known.name == name && known.top_level);
        let is_set = |name: &str| match varied {
            [] => !is_top_level(name),
            varied => !varied.iter().any(|own| own == name),
        };
        let set: IndexMap<Arc<str>, f64> = current
            .overrides
            .iter()
            .filter(|(name, _)| is_set(name))
            .map(|(n, v)| (n.clone(), *v))
            .collect();
        if set.is_empty() && current.changes.is_empty() {
            return Ok(plain);
        }
        let shaped = self.shaped_model(&current.model).map_err(|error| vec![error])?;
        let mut paths = IndexMap::new();
        for name in set.keys() {
            if let Some((path, value)) = self.written(&shaped, name).map_err(|error| vec![error])? {
                paths.insert(path, value);
            }
        }
        Ok(InUse {
            problem: current.changes.problem(&current.model, &IndexMap::new())?,
            shown: current.changes.problem(&current.model, &paths)?,
            values: set.into_iter().map(|(name, value)| (name, value.to_bits())).collect(),
        })
    }

    /// The modification that gives a parameter the value that it has, with the whole array that it is an
    /// element of.
    fn written(
        &mut self,
        model: &Arc<Translated>,
        name: &str,
    ) -> Result<Option<(String, Expression)>, Diagnostic> {
        let mut whole: ComponentReference = flat_reference(name, Span::NONE);
        whole.parts.iter_mut().for_each(|part| part.subscripts.clear());
        let Some(found) = addressed(model, &whole) else { return Ok(None) };
        let Some(numbers) = self.numbers_of(model, &found.names)? else { return Ok(None) };
        let value = literal(&found.declaration.base, Given::Array(&found.dims, &numbers));
        Ok(flat_name(&whole).map(|path| (path, value)))
    }

    /// Says once that what was imported does not hold for individuals.
    fn note_not_continued(&mut self, problem: &str) {
        if self.models.is_new_note(format!("{problem} continued").as_str().into()) {
            let text = format!(
                "the start values imported for `{problem}` hold for simulations only: individuals \
                 start as the model says"
            );
            self.note(START_VALUES_MISSING, text);
        }
    }
}
