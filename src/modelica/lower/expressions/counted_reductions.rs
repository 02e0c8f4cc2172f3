//! Reductions over ranges whose ends are computed: `sum(x[i] for i in 1:n)` (MLS §10.3.4.1). They
//! are loops that are run when a function runs; over ranges that are known, reductions are written
//! out element by element.

use super::{Array, Binary, Lowered, Lowering, Target};
use crate::diag::Diagnostic;
use crate::fault;
use crate::functions::Reduction;
use crate::lower::errors::NO_CONSTANT_VALUE;
use crate::lower::loops::LoopVariable;
use crate::source::Span;
use crate::symbolic::function;
use crate::syntax::ast::{Arguments, Expression, ExpressionKind, ForIndex};

/// A reduction being computed.
struct Counted<'e> {
    reduction: Reduction,
    element: &'e Expression,
    /// Whether the value is an Integer, which is exact after each iteration or fails.
    is_integer: bool,
    span: Span,
}

impl<T: Target> Lowering<'_, T> {
    /// A reduction of which one of the ranges is computed; `None` where all are known, and where no
    /// loops are run.
    pub(super) fn counted_reduction(
        &mut self,
        reduction: Reduction,
        element: &Expression,
        arguments: &Arguments,
        is_integer: bool,
        span: Span,
    ) -> Result<Option<T::Scalar>, Diagnostic> {
        let iterators = arguments.iterators.as_slice();
        if !self.target.runs_loops() || !self.has_computed_range(iterators)? {
            return Ok(None);
        }
        let none = self.of_none(reduction, arguments, span);
        let none = self.target.constant(none);
        let counted = Counted { reduction, element, is_integer, span };
        self.counted(&counted, iterators, none).map(Some)
    }

    /// Whether the ends of a range are computed. An inner range may depend on the iterators around it,
    /// of which the first value stands for all.
    fn has_computed_range(&mut self, iterators: &[ForIndex]) -> Result<bool, Diagnostic> {
        let Some((outer, inner)) = iterators.split_last() else { return Ok(false) };
        let Some(range) = self.ends_of(outer)? else { return Ok(false) };
        if range.iter().any(|end| self.target.as_constant(*end).is_none()) {
            return Ok(true);
        }
        let variable = self.variable_of(outer, range[0]);
        self.loops.push(variable);
        let found = self.has_computed_range(inner);
        self.loops.pop();
        found
    }

    /// Start, step and stop of the range of an iterator; `None` where it is not a range of numbers.
    fn ends_of(&mut self, index: &ForIndex) -> Result<Option<[T::Scalar; 3]>, Diagnostic> {
        let Some(ExpressionKind::Range { start, step, stop }) =
            index.range.as_ref().map(|range| &range.kind)
        else {
            return Ok(None);
        };
        let one = self.target.constant(1.0);
        let step = step.as_ref().map_or(Ok(one), |step| self.scalar(step))?;
        Ok(Some([self.scalar(start)?, step, self.scalar(stop)?]))
    }

    fn variable_of(&mut self, index: &ForIndex, value: T::Scalar) -> LoopVariable<T::Scalar> {
        LoopVariable { name: index.name.node, value, value_type: self.type_of_index(index) }
    }

    /// A value combined with the elements of all iterations.
    fn counted(
        &mut self,
        of: &Counted<'_>,
        iterators: &[ForIndex],
        value: T::Scalar,
    ) -> Result<T::Scalar, Diagnostic> {
        let Some((outer, inner)) = iterators.split_last() else {
            return self.combined(of, value);
        };
        let unknown = || {
            fault!(NO_CONSTANT_VALUE, "the range of `{}` must be known here", outer.name.node)
                .at(of.span)
        };
        let range = self.ends_of(outer)?.ok_or_else(unknown)?;
        let counted = self.target.begin_counted_loop(range, value).ok_or_else(unknown)?;
        let variable = self.variable_of(outer, counted.variable);
        self.loops.push(variable);
        let next = self.counted(of, inner, counted.value);
        self.loops.pop();
        Ok(self.target.end_counted_loop(counted, next?))
    }

    /// A value combined with the element of one iteration.
    fn combined(&mut self, of: &Counted<'_>, value: T::Scalar) -> Result<T::Scalar, Diagnostic> {
        let unsupported = || {
            fault!(NO_CONSTANT_VALUE, "a reduction of arrays over a range that is computed")
                .at(of.span)
        };
        let element = match self.lower(of.element)? {
            Lowered::Array(Array { dims, elements }) if dims.is_empty() => elements[0],
            _ => return Err(unsupported()),
        };
        let combined = match of.reduction {
            Reduction::Sum => self.target.binary(Binary::Add, value, element),
            Reduction::Product => self.target.binary(Binary::Mul, value, element),
            Reduction::Min | Reduction::Max => {
                let id = function::find(of.reduction.name()).ok_or_else(unsupported)?;
                self.target.apply(id, &[value, element], self.live, of.span)?
            }
        };
        match of.is_integer {
            true => Ok(self.exact(Array::scalar(combined), of.span)?.elements[0]),
            false => Ok(combined),
        }
    }
}
