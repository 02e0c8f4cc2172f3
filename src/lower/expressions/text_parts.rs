//! Strings that are made when what is translated runs: of Strings, and of numbers as `String` writes them
//! (MLS §3.7.1).

use super::varying_strings::computed;
use super::{Lowered, Lowering, Target};
use crate::diag::Diagnostic;
use crate::eval::ValueType;
use crate::fault;
use crate::lower::errors::NOT_SUPPORTED;
use crate::lower::shape::UNKNOWN_TEXT;
use crate::source::Span;
use crate::syntax::ast::{Arguments, BinaryOperator, Expression, ExpressionKind, UnaryOperator};
use std::sync::Arc;

/// As `String` writes numbers.
const DEFAULTS: [(&str, f64); 3] =
    [("significantDigits", 6.0), ("minimumLength", 0.0), ("leftJustified", 1.0)];

/// A part of a text.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum TextPart<S> {
    /// A text.
    Text(Arc<str>),
    /// The number of a text.
    Numbered(S),
    /// A number and its type, and how it is written; or with a format.
    Number(Vec<S>, Option<Arc<str>>),
}

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
                Lowered::Text(text) if !text.contains(UNKNOWN_TEXT) => TextPart::Text(text),
                Lowered::Numbered(number) => TextPart::Numbered(number),
                _ => return Err(computed(span)),
            });
        }
        self.target.compose(&parts, span).map(Lowered::Numbered)
    }

    /// `String(x, …)` of a number that is not known yet; `None` if it is none.
    pub(crate) fn number_part(
        &mut self,
        arguments: &Arguments,
    ) -> Result<Option<TextPart<T::Scalar>>, Diagnostic> {
        let named = |name: &str| arguments.named.iter().find(|a| a.name.node == name);
        let Some(argument) = arguments.positional.first() else { return Ok(None) };
        let which = match self.type_of(argument) {
            Some(ValueType::Real) => 0.0,
            Some(ValueType::Integer) => 1.0,
            Some(ValueType::Boolean) => 2.0,
            _ => return Ok(None),
        };
        let Ok(number) = self.scalar(argument) else { return Ok(None) };
        let mut row = vec![number, self.target.constant(which)];
        let format = arguments.positional.get(1).or(named("format").map(|a| &a.value));
        if let Some(format) = format {
            let Lowered::Text(format) = self.lower(format)? else { return Ok(None) };
            return Ok(Some(TextPart::Number(row, Some(format))));
        }
        for (name, default) in DEFAULTS {
            row.push(match named(name) {
                Some(given) => self.scalar(&given.value)?,
                None => self.target.constant(default),
            });
        }
        Ok(Some(TextPart::Number(row, None)))
    }

    /// The type of a scalar or of the elements of an array; Real where it is not known.
    pub(super) fn type_of(&mut self, e: &Expression) -> Option<ValueType> {
        let both = |own: &mut Self, a: &Expression, b: &Expression| {
            let types = [own.type_of(a)?, own.type_of(b)?];
            let is_whole = types.iter().all(|t| matches!(t, ValueType::Integer));
            Some(if is_whole { ValueType::Integer } else { ValueType::Real })
        };
        match &e.kind {
            ExpressionKind::Integer(_) => Some(ValueType::Integer),
            ExpressionKind::Boolean(_) => Some(ValueType::Boolean),
            ExpressionKind::Reference(reference) => {
                let is_index = |name| self.loops.iter().any(|(own, _)| *own == name);
                if reference.as_ident().is_some_and(is_index) {
                    return Some(ValueType::Integer);
                }
                let Ok(path) = self.path(reference) else { return Some(ValueType::Real) };
                Some(self.target.value_type(&path).unwrap_or(ValueType::Real))
            }
            ExpressionKind::Array(elements) => self.type_of(elements.first()?),
            ExpressionKind::Call { function, arguments } => match function.as_ident() {
                Some(name) if name == "fill" => self.type_of(arguments.positional.first()?),
                Some(name) if name == "integer" || name == "Integer" || name == "size" => {
                    Some(ValueType::Integer)
                }
                _ => {
                    let output = self.target.function(&function.name());
                    let output =
                        output.and_then(|f| f.outputs.first().map(|o| o.value_type.clone()));
                    Some(output.unwrap_or(ValueType::Real))
                }
            },
            ExpressionKind::Unary { operator: UnaryOperator::Not, .. } => Some(ValueType::Boolean),
            ExpressionKind::Unary { operand, .. } => self.type_of(operand),
            ExpressionKind::Binary { operator, left, right } => match operator {
                BinaryOperator::Add | BinaryOperator::Subtract | BinaryOperator::Multiply => {
                    both(self, left, right)
                }
                BinaryOperator::Less
                | BinaryOperator::LessEqual
                | BinaryOperator::Greater
                | BinaryOperator::GreaterEqual
                | BinaryOperator::Equal
                | BinaryOperator::NotEqual
                | BinaryOperator::And
                | BinaryOperator::Or => Some(ValueType::Boolean),
                _ => Some(ValueType::Real),
            },
            ExpressionKind::If { branches, otherwise } => match branches.first() {
                Some((_, value)) if self.type_of(value)? == ValueType::Boolean => {
                    Some(ValueType::Boolean)
                }
                Some((_, value)) => both(self, value, otherwise),
                None => self.type_of(otherwise),
            },
            _ => Some(ValueType::Real),
        }
    }
}
