//! Iterators: loops' ranges, array constructors with iterators `{e for i in r}` (MLS §10.4.1) and
//! reductions `sum(e for i in r)` (MLS §10.3.4).

use super::errors::MISPLACED;
use super::{Evaluator, ValueType};
use crate::diag::{At, Diagnostic, Fault};
use crate::fault;
use crate::functions::{self, Meaning, Reduction};
use crate::inference::{self, subscript_uses};
use crate::name::Ident;
use crate::source::{Span, Spanned};
use crate::syntax::ast::{Expression, ExpressionKind, ForIndex, Statement};
use crate::syntax::visit::Visit;
use crate::value::construct::{self, Range};
use crate::value::{Value, element_count};

/// What a loop repeats.
#[derive(Clone, Copy)]
pub(super) enum Body<'b> {
    /// Of a loop.
    Statements(&'b [Statement]),
    /// Of an array constructor with iterators.
    Expression(&'b Expression),
}

impl Body<'_> {
    fn visit(self, visitor: &mut dyn Visit) {
        match self {
            Body::Statements(list) => list.iter().for_each(|one| visitor.statement(one)),
            Body::Expression(expression) => visitor.expression(expression),
        }
    }
}

impl Evaluator<'_> {
    /// The values that a loop variable takes.
    pub(super) fn iterated(
        &mut self,
        index: &ForIndex,
        body: Body<'_>,
    ) -> Result<Range, Diagnostic> {
        if let (Some(range), Some(script)) = (&index.range, self.host.script()) {
            script.iterates(index.name.node, range);
        }
        match &index.range {
            None => self.deduced(index, body),
            Some(expression) => match &expression.kind {
                ExpressionKind::Range { start, step, stop } => {
                    self.range(start, step.as_deref(), stop, expression.span)
                }
                ExpressionKind::Reference(reference)
                    if reference.as_ident().is_some_and(|name| name == "Boolean") =>
                {
                    Ok(Range::Values(vec![Value::Boolean(false), Value::Boolean(true)]))
                }
                ExpressionKind::Guarded { name, condition, values } => {
                    self.guarded(*name, condition, values)
                }
                _ => {
                    let value = self.expression(expression)?;
                    Range::over(value).at(expression.span)
                }
            },
        }
    }

    /// The values for which a condition holds.
    pub(super) fn guarded(
        &mut self,
        name: Ident,
        condition: &Expression,
        values: &Expression,
    ) -> Result<Range, Diagnostic> {
        let all = ForIndex {
            name: Spanned { node: name, span: condition.span },
            range: Some(values.clone()),
        };
        let range = self.iterated(&all, Body::Expression(condition))?;
        let mut kept = Vec::new();
        self.with_each(&all, &range, |evaluator| {
            if evaluator.condition(condition)? {
                kept.extend(evaluator.scope.get(name).cloned());
            }
            Ok(())
        })?;
        Ok(Range::Values(kept))
    }

    /// The range `1:size(x, d)` of the array `x` that the loop variable is a subscript of
    /// (MLS §11.2.2.1).
    fn deduced(&mut self, index: &ForIndex, body: Body<'_>) -> Result<Range, Diagnostic> {
        let name = index.name.node;
        let uses = subscript_uses(name, &|search| body.visit(search));
        let mut sizes = Vec::new();
        for found in &uses {
            let dims = match self.sizes_of(&found.array)? {
                Some(dims) => dims,
                None => self.reference(&found.array)?.dims().to_vec(),
            };
            if let Some(size) = dims.get(found.dimension) {
                sizes.push((*size, found.array.span));
            }
        }
        // The references looked at are copies: their addresses may be used again.
        self.scope.callees.clear();
        let Some((size, _)) = sizes.first().copied() else {
            let fault = fault!(
                MISPLACED,
                "the range of `{name}` is missing and cannot be deduced";
                help: "write `{name} in 1:n`, or use `{name}` as the subscript of an array"
            );
            return Err(fault.at(index.name.span));
        };
        if let Some((other, span)) = sizes.iter().find(|(other, _)| *other != size) {
            let fault = fault!(
                MISPLACED,
                "the range of `{name}` is ambiguous: it is the subscript of dimensions of \
                 different sizes, {size} and {other}";
                help: "write the range of `{name}`"
            );
            return Err(fault.at(index.name.span).related(*span, "a different size"));
        }
        Range::new(&Value::Integer(1), None, &Value::Integer(size as i64)).at(index.name.span)
    }

    /// `{e for i in r, j in s}`: the last iterator is the first dimension's, as in
    /// `{{e for i in r} for j in s}` (MLS §10.4.1.1).
    pub(super) fn array_iteration(
        &mut self,
        element: &Expression,
        indices: &[ForIndex],
        span: Span,
    ) -> Result<Value, Diagnostic> {
        let Some((outer, inner)) = indices.split_last() else { return self.expression(element) };
        let range = self.iterated(outer, Body::Expression(element))?;
        let mut values = Vec::with_capacity(range.count().min(1 << 16));
        self.with_each(outer, &range, |evaluator| {
            let value = evaluator.array_iteration(element, inner, span)?;
            if values.is_empty() {
                element_count(&[&[range.count()], value.dims()].concat()).at(span)?;
            }
            values.push(value);
            Ok(())
        })?;
        match values.is_empty() && inner.is_empty() {
            true => {
                construct::shaped(&[&[0], &element.written_sizes()[..]].concat(), values).at(span)
            }
            false => construct::array(values).at(span),
        }
    }

    /// `sum`, `product`, `min`, `max`, `array` with iterators; `None` for any other name.
    pub(super) fn reduction(
        &mut self,
        name: &str,
        element: &Expression,
        indices: &[ForIndex],
        span: Span,
    ) -> Result<Option<Value>, Diagnostic> {
        if name == "array" {
            return self.array_iteration(element, indices, span).map(Some);
        }
        let Some(Meaning::Reduction(reduction)) = functions::find(name).map(|entry| entry.meaning)
        else {
            return Ok(None);
        };
        let mut total = None;
        self.reduce(element, indices, &mut |value| {
            total = Some(match total.take() {
                None => reduction.first(value)?,
                Some(before) => reduction.combine(&before, &value)?,
            });
            Ok(())
        })?;
        Ok(Some(total.unwrap_or_else(|| self.reduced_nothing(reduction, element, indices))))
    }

    /// What a reduction makes of no values of an expression, those of iterators among its names: with
    /// the type Real where its text does not show it.
    pub(super) fn reduced_nothing(
        &mut self,
        reduction: Reduction,
        element: &Expression,
        indices: &[ForIndex],
    ) -> Value {
        let kind = ExpressionKind::ArrayIteration {
            element: Box::new(element.clone()),
            indices: indices.to_vec(),
        };
        let all = Expression::new(kind, element.span);
        inference::type_of(self, &all).unwrap_or(ValueType::Real).of_no_elements(reduction)
    }

    fn reduce(
        &mut self,
        element: &Expression,
        indices: &[ForIndex],
        take: &mut dyn FnMut(Value) -> Result<(), Fault>,
    ) -> Result<(), Diagnostic> {
        let Some((outer, inner)) = indices.split_last() else {
            let value = self.expression(element)?;
            return take(value).at(element.span);
        };
        let range = self.iterated(outer, Body::Expression(element))?;
        self.with_each(outer, &range, |evaluator| evaluator.reduce(element, inner, take))
    }

    fn with_each(
        &mut self,
        index: &ForIndex,
        range: &Range,
        mut iteration: impl FnMut(&mut Self) -> Result<(), Diagnostic>,
    ) -> Result<(), Diagnostic> {
        for at in 0..range.count() {
            if at % 4096 == 4095 {
                self.host.check_interrupted(index.name.span)?;
            }
            self.scope.iterators.push((index.name.node, range.get(at)));
            let result = iteration(self);
            self.scope.iterators.pop();
            result?;
        }
        Ok(())
    }
}
