//! Texts that change at events: discrete variables whose values are the numbers of texts.

use super::builder::Builder;
use super::dae::Kind;
use super::equation::Equation;
use super::expressions::Lowering;
use super::shape::UNKNOWN_TEXT;
use crate::diag::Diagnostic;
use crate::flatten::{BaseType, Variability};
use crate::symbolic::Expr;
use std::sync::Arc;

impl Builder<'_> {
    /// Finds the texts whose values are not known when compiling.
    pub(super) fn find_varying_texts(&mut self) {
        let flat = self.flat;
        for (position, variable) in flat.variables.values().enumerate() {
            if variable.base == BaseType::String
                && variable.variability > Variability::Parameter
                && variable.dims.is_empty()
                && self.text(position).contains(UNKNOWN_TEXT)
            {
                self.dae.variables[self.scalars.first[position].0 as usize].kind = Kind::Discrete;
            }
        }
    }

    /// Binding equation and start value of a text that changes.
    pub(super) fn varying_text(&mut self, position: usize) -> Result<(), Diagnostic> {
        let variable = &self.flat.variables[position];
        let first = self.scalars.first[position];
        if self.dae.variable(first).kind != Kind::Discrete {
            return Ok(());
        }
        if let Some(binding) = &variable.binding {
            let text = Lowering::new(self).lower(binding)?;
            let right = Lowering::new(self).number_of_text(text, binding.span)?;
            let left = self.dae.pool.variable(first);
            self.dae.equations.push(Equation::new(left, right, binding.span));
        }
        // The default is the empty text (MLS §4.9.4).
        let mut start = self.number_of(&Arc::from(""));
        if let Some(attribute) = variable.attributes.get("start") {
            let text = Lowering::new(self).lower(&attribute.value)?;
            start = Lowering::new(self).number_of_text(text, attribute.value.span)?;
        }
        let fixed = variable.attributes.get("fixed").map(|attribute| &attribute.value);
        let fixed = fixed.map(|e| Lowering::new(self).known(e)).transpose()?;
        let scalar = &mut self.dae.variables[first.0 as usize];
        scalar.start = Some(start);
        scalar.fixed = fixed == Some(1.0);
        Ok(())
    }

    /// The number of a text, counted from 0 as they occur.
    pub(super) fn number_of(&mut self, text: &Arc<str>) -> Expr {
        let (number, _) = self.texts.insert_full(text.clone());
        self.dae.pool.constant(number as f64)
    }
}
