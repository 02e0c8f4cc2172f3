//! Strings that change at events: discrete variables whose values are the numbers of Strings.

use super::builder::Builder;
use super::dae::VariableKind;
use super::equation::Equation;
use super::expressions::{Lowered, Lowering};
use super::shape::UNKNOWN_TEXT;
use crate::diag::Diagnostic;
use crate::flatten::{BaseType, Variability};
use crate::symbolic::Expr;
use crate::syntax::ast::Expression;
use std::sync::Arc;

impl Builder<'_> {
    /// Finds the Strings whose values are not known when compiling.
    pub(super) fn find_varying_strings(&mut self) {
        let flat = self.flat;
        for (position, variable) in flat.variables.values().enumerate() {
            if variable.base != BaseType::String || variable.variability <= Variability::Parameter {
                continue;
            }
            let varies = match variable.dims.is_empty() {
                true => self.text(position).contains(UNKNOWN_TEXT),
                false => variable.binding.is_none(),
            };
            if varies {
                let first = self.scalars.first[position].0 as usize;
                let scalars = &mut self.dae.variables[first..first + variable.len()];
                scalars.iter_mut().for_each(|scalar| scalar.kind = VariableKind::Discrete);
            }
        }
    }

    /// Whether a flat variable is a String, or an array of Strings, that changes.
    pub(super) fn is_varying_text(&self, position: usize) -> bool {
        let variable = &self.flat.variables[position];
        variable.base == BaseType::String
            && !variable.is_empty()
            && self.dae.variable(self.scalars.first[position]).kind == VariableKind::Discrete
    }

    /// Binding equation and start value of a text that changes.
    pub(super) fn varying_text(&mut self, position: usize) -> Result<(), Diagnostic> {
        let variable = &self.flat.variables[position];
        let first = self.scalars.first[position];
        if !self.is_varying_text(position) {
            return Ok(());
        }
        if let Some(binding) = &variable.binding {
            let text = Lowering::new(self).run_time_string(binding)?;
            let right = Lowering::new(self).number_of_text(text, binding.span)?;
            let left = self.dae.pool.variable(first);
            self.dae.equations.push(Equation::new(left, right, binding.span));
        }
        // The default is the empty text (MLS §4.9.4).
        let mut starts = vec![self.number_of(&Arc::from("")); variable.len()];
        if let Some(attribute) = variable.attributes.get("start") {
            starts = self.numbers_of_start(&attribute.value, variable.len())?;
        }
        let fixed = variable.attributes.get("fixed").map(|attribute| &attribute.value);
        let fixed = fixed.map(|e| self.sized(e, &variable.dims)).transpose()?;
        for (at, start) in starts.into_iter().enumerate() {
            let known = fixed.as_ref().and_then(|f| self.dae.pool.as_constant(f.elements[at]));
            let scalar = &mut self.dae.variables[first.0 as usize + at];
            scalar.start = Some(start);
            scalar.fixed = known == Some(1.0);
        }
        Ok(())
    }

    /// The numbers of the start values of a String, or of an array of `len` Strings.
    fn numbers_of_start(
        &mut self,
        start: &Expression,
        len: usize,
    ) -> Result<Vec<Expr>, Diagnostic> {
        let strings = match Lowering::new(self).lower(start)? {
            Lowered::Strings(strings) if strings.strings.len() == len => strings.strings,
            text => {
                let number = Lowering::new(self).number_of_text(text, start.span)?;
                return Ok(vec![number; len]);
            }
        };
        let number = |text: &Arc<str>| {
            Lowering::new(self).number_of_text(Lowered::Text(text.clone()), start.span)
        };
        strings.iter().map(number).collect()
    }

    /// The number of a text, counted from 0 as they occur.
    pub(super) fn number_of(&mut self, text: &Arc<str>) -> Expr {
        let number = self.calls.functions.number_of(text);
        self.dae.pool.constant(number)
    }
}
