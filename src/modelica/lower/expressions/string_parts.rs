//! Strings that are made when what is translated runs: of Strings, and of numbers as `String` writes them
//! (MLS §3.7.1).

use super::target::computed_string;
use super::{Array, Choice, Lowered, Lowering, StringPart, Target};
use crate::diag::{At, Diagnostic};
use crate::eval::ValueType;
use crate::fault;
use crate::inference::{self, TypesOfNames};
use crate::lower::errors::NOT_SUPPORTED;
use crate::lower::shape::UNKNOWN_TEXT;
use crate::name::Ident;
use crate::source::Span;
use crate::syntax::ast::{Arguments, ComponentReference, Expression};
use crate::value::Value;
use crate::value::format::text;

/// As `String` writes numbers.
const DEFAULTS: [(&str, f64); 3] =
    [("significantDigits", 6.0), ("minimumLength", 0.0), ("leftJustified", 1.0)];

impl<T: Target> Lowering<'_, T> {
    /// `String(x, …)` of what is not known yet.
    pub(super) fn composed_string(
        &mut self,
        arguments: &Arguments,
        span: Span,
    ) -> Result<Lowered<T::Scalar>, Diagnostic> {
        let Some(part) = self.number_part(arguments)? else {
            return Err(
                fault!(NOT_SUPPORTED, "`String` of this type during the simulation").at(span)
            );
        };
        self.target.compose(&[part], span).map(Lowered::Numbered)
    }

    /// `a + b` of Strings, one of which is not known yet.
    pub(super) fn composed_sum(
        &mut self,
        sides: [Lowered<T::Scalar>; 2],
        span: Span,
    ) -> Result<Lowered<T::Scalar>, Diagnostic> {
        let mut parts = Vec::with_capacity(sides.len());
        for side in sides {
            parts.push(match side {
                Lowered::Text(text) if !text.contains(UNKNOWN_TEXT) => StringPart::Text(text),
                Lowered::Numbered(number) => StringPart::Numbered(number),
                _ => return Err(computed_string(span)),
            });
        }
        self.target.compose(&parts, span).map(Lowered::Numbered)
    }

    /// `String(x, …)` of a value that is not known yet; `None` if it has no such form.
    pub(crate) fn number_part(
        &mut self,
        arguments: &Arguments,
    ) -> Result<Option<StringPart<T::Scalar>>, Diagnostic> {
        let named = |name: &str| arguments.named.iter().find(|a| a.name.node == name);
        let Some(argument) = arguments.positional.first() else { return Ok(None) };
        let which = match self.type_of(argument) {
            ValueType::Real => 0.0,
            ValueType::Integer => 1.0,
            ValueType::Boolean => 2.0,
            ValueType::Enumeration(definition) => {
                return self.literal_part(argument, &definition.literals, arguments);
            }
            _ => return Ok(None),
        };
        let Ok(number) = self.scalar(argument) else { return Ok(None) };
        let mut row = vec![number, self.target.constant(which)];
        let format = arguments.positional.get(1).or(named("format").map(|a| &a.value));
        if let Some(format) = format {
            let Lowered::Text(format) = self.lower(format)? else { return Ok(None) };
            let is_known = !format.contains(UNKNOWN_TEXT);
            return Ok(is_known.then_some(StringPart::Written(row, Some(format))));
        }
        for (name, default) in DEFAULTS {
            row.push(match named(name) {
                Some(given) => self.scalar(&given.value)?,
                None => self.target.constant(default),
            });
        }
        Ok(Some(StringPart::Written(row, None)))
    }

    /// `String(e, …)` of an enumeration: the text of one of its literals.
    fn literal_part(
        &mut self,
        argument: &Expression,
        literals: &[Ident],
        arguments: &Arguments,
    ) -> Result<Option<StringPart<T::Scalar>>, Diagnostic> {
        let Ok(ordinal) = self.scalar(argument) else { return Ok(None) };
        let mut layout = [0.0, 1.0];
        for (value, name) in layout.iter_mut().zip(["minimumLength", "leftJustified"]) {
            if let Some(given) = arguments.named.iter().find(|a| a.name.node == name) {
                *value = self.shaping(&given.value)?;
            }
        }
        let mut numbers = Vec::with_capacity(literals.len());
        for literal in literals {
            let literal = Value::String(literal.as_str().trim_matches('\'').into());
            let text = text(&literal, 0, layout[0] as i64, layout[1] != 0.0).at(argument.span)?;
            let Some(number) = self.target.string_number(&text) else { return Ok(None) };
            numbers.push(number);
        }
        let numbers = Array { dims: vec![numbers.len()], elements: numbers };
        let chosen = self.chosen_by(numbers, vec![Choice::Computed(ordinal)], argument.span)?;
        Ok(chosen.elements.first().copied().map(StringPart::Numbered))
    }

    /// The type of a scalar or of the elements of an array; Real where it is not known.
    pub(super) fn type_of(&mut self, e: &Expression) -> ValueType {
        inference::type_of(self, e).unwrap_or(ValueType::Real)
    }
}

impl<T: Target> TypesOfNames for Lowering<'_, T> {
    type Type = ValueType;

    fn of_reference(&mut self, reference: &ComponentReference) -> Option<ValueType> {
        let variable = reference.as_ident().and_then(|name| self.loop_variable(name));
        if let Some(variable) = variable {
            return Some(variable.value_type.clone());
        }
        let path = self.path(reference).ok()?;
        self.target.value_type(&path)
    }

    fn of_function(
        &mut self,
        function: &ComponentReference,
        _: &Arguments,
    ) -> Option<Option<ValueType>> {
        let declared = self.target.function(&function.name())?;
        Some(declared.outputs.first().map(|output| output.value_type.clone()))
    }

    fn of_component(&mut self, record: &ValueType, name: Ident) -> Option<ValueType> {
        record.component(name)
    }
}
