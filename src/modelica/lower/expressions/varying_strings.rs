//! Strings that change at events, as the numbers of a table: two are the same if their numbers are.

use super::target::computed_string;
use super::{Lowered, Lowering, Target};
use crate::diag::Diagnostic;
use crate::fault;
use crate::lower::errors::{ARRAY_MISMATCH, NO_CONSTANT_VALUE, NOT_SUPPORTED};
use crate::lower::shape::UNKNOWN_TEXT;
use crate::source::Span;
use crate::symbolic::RelationOperator;
use crate::syntax::ast::{BinaryOperator, Expression};

impl<T: Target> Lowering<'_, T> {
    /// The number of a text.
    pub(crate) fn number_of_text(
        &mut self,
        text: Lowered<T::Scalar>,
        span: Span,
    ) -> Result<T::Scalar, Diagnostic> {
        match text {
            Lowered::Numbered(number) => Ok(number),
            Lowered::Text(text) if text.contains(UNKNOWN_TEXT) => {
                self.target.misses_text();
                Err(computed_string(span))
            }
            Lowered::Text(text) => self.target.string_number(&text).ok_or_else(|| {
                self.target.misses_text();
                depends_on_conditions(span)
            }),
            Lowered::Array(_) | Lowered::Record(_) | Lowered::Strings(_) => {
                Err(fault!(ARRAY_MISMATCH, "expected a scalar String").at(span))
            }
        }
    }

    /// What a text is, made at run time if it is not known now.
    pub(crate) fn run_time_string(
        &mut self,
        e: &Expression,
    ) -> Result<Lowered<T::Scalar>, Diagnostic> {
        let is_unknown = |text: &Result<Lowered<T::Scalar>, Diagnostic>| match text {
            Ok(Lowered::Text(text)) => text.contains(UNKNOWN_TEXT),
            Ok(_) => false,
            Err(_) => true,
        };
        let known = self.lower(e);
        if !is_unknown(&known) {
            return known;
        }
        let made = self.composing(|own| own.lower(e));
        if !is_unknown(&made) {
            return made;
        }
        match self.with_string_parameters(|own| own.lower(e)) {
            Some(found) if !is_unknown(&found) => found,
            _ => made,
        }
    }

    /// What is made of Strings whose parameters are evaluated for it; `None` where none can be.
    pub(super) fn with_string_parameters<R>(
        &mut self,
        lower: impl FnOnce(&mut Self) -> R,
    ) -> Option<R> {
        let before = std::mem::replace(self.target.evaluates_string_parameters()?, true);
        let result = lower(self);
        *self.target.evaluates_string_parameters()? = before;
        Some(result)
    }

    /// What is made of Strings that are made at run time, where they can be.
    pub(super) fn composing<R>(&mut self, lower: impl FnOnce(&mut Self) -> R) -> R {
        let composes = self.target.composes();
        if !composes {
            self.target.misses_text();
        }
        let outer = std::mem::replace(&mut self.composes, composes);
        let result = lower(self);
        self.composes = outer;
        result
    }

    /// `if condition then first else second`
    pub(super) fn string_choice(
        &mut self,
        condition: T::Scalar,
        [first, second]: [T::Scalar; 2],
    ) -> Lowered<T::Scalar> {
        let mut branch = self.target.begin_if(condition);
        self.target.begin_else(&mut branch, &[first]);
        Lowered::Numbered(self.target.end_if(branch, &[second])[0])
    }

    /// A relation of a text that changes and another one.
    pub(super) fn varying_strings(
        &mut self,
        operator: BinaryOperator,
        a: T::Scalar,
        right: &Expression,
        span: Span,
    ) -> Result<Lowered<T::Scalar>, Diagnostic> {
        let b = match operator {
            BinaryOperator::Add => self.lower(right)?,
            _ => self.run_time_string(right)?,
        };
        if operator == BinaryOperator::Add && matches!(b, Lowered::Text(_) | Lowered::Numbered(_)) {
            return match self.composes {
                true => self.composed_sum([Lowered::Numbered(a), b], span),
                false => Ok(Lowered::Text(UNKNOWN_TEXT.into())),
            };
        }
        let b = self.number_of_text(b, span)?;
        self.compare_strings(operator, a, b, span)
    }

    /// Whether two Strings are the same, by their numbers.
    pub(super) fn compare_strings(
        &mut self,
        operator: BinaryOperator,
        a: T::Scalar,
        b: T::Scalar,
        span: Span,
    ) -> Result<Lowered<T::Scalar>, Diagnostic> {
        let relation = match operator {
            BinaryOperator::Equal => RelationOperator::Equal,
            BinaryOperator::NotEqual => RelationOperator::NotEqual,
            _ => {
                return Err(fault!(
                    NOT_SUPPORTED,
                    "this operator does not support Strings that change during the simulation"
                )
                .at(span));
            }
        };
        Ok(Lowered::scalar(self.target.relation(relation, a, b, self.live, span)))
    }
}

/// In a function whose Strings have no numbers: it is compiled again for the known values of its
/// arguments, which may decide the condition.
pub(super) fn depends_on_conditions(span: Span) -> Diagnostic {
    fault!(NO_CONSTANT_VALUE, "a String in a function depends on a condition that is not known at \
                               translation";
        help: "choose among calls with Strings that are known at translation")
    .at(span)
}
