//! Strings that variables are bound to, as far as they are known when compiling.

use super::builder::{Builder, Folding};
use super::errors::{NO_CONSTANT_VALUE, NOT_SUPPORTED};
use super::expressions::{Lowered, Lowering};
use super::shape::UNKNOWN_TEXT;
use super::string_array::StringArray;
use crate::diag::Diagnostic;
use crate::flatten::Variability;
use crate::symbolic::Expr;
use std::sync::Arc;

impl Builder<'_> {
    /// The text that a variable is bound to, [`UNKNOWN_TEXT`] if that is not known.
    pub(super) fn text(&mut self, position: usize) -> Arc<str> {
        match self.bound_strings(position) {
            Some(Lowered::Text(text)) => text,
            _ => UNKNOWN_TEXT.into(),
        }
    }

    /// The Strings that an array is bound to, as far as they are known.
    pub(super) fn string_array(&mut self, position: usize) -> StringArray {
        let dims = self.flat.variables[position].dims.clone();
        match self.bound_strings(position) {
            Some(Lowered::Strings(strings)) if strings.dims == dims => strings,
            Some(Lowered::Text(text)) => StringArray::filled(dims, text),
            _ => StringArray::unknown(dims),
        }
    }

    /// The value that a String variable is bound to; `None` if it depends on itself or is not to
    /// be had.
    fn bound_strings(&mut self, position: usize) -> Option<Lowered<Expr>> {
        let flat = self.flat;
        let variable = &flat.variables[position];
        let binding = match &variable.binding {
            Some(binding) => binding,
            // A parameter without a value has its start value (MLS §8.6).
            None if variable.variability <= Variability::Parameter => {
                &variable.attributes.get("start")?.value
            }
            None => return None,
        };
        if self.scalars.folding[position] == Folding::InProgress {
            return None;
        }
        let before = std::mem::replace(&mut self.scalars.folding[position], Folding::InProgress);
        let lowered = Lowering::new(self).lower(binding);
        self.scalars.folding[position] = before;
        lowered.map_err(|why| self.warn_of_missing_string(position, why)).ok()
    }

    fn warn_of_missing_string(&mut self, position: usize, why: Diagnostic) {
        let Some((name, variable)) = self.flat.variables.get_index(position) else { return };
        let is_run_later = [NOT_SUPPORTED, NO_CONSTANT_VALUE].contains(&why.code);
        if is_run_later || variable.variability > Variability::Parameter {
            return;
        }
        let message = format!("`{name}` has no value: {}", why.message);
        let warning = why.reworded(message).warning();
        if !self.scalars.missing_strings.contains(&warning) {
            self.scalars.missing_strings.push(warning);
        }
    }
}
