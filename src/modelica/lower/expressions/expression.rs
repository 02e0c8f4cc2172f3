//! The forms of expressions.

use super::records::{field, stacked};
use super::{Array, Lowered, Lowering, MAX_DEPTH, MAX_SCALARS, Target};
use crate::diag::Diagnostic;
use crate::eval::ValueType;
use crate::fault;
use crate::lower::errors::{ARRAY_MISMATCH, NO_CONSTANT_VALUE, NOT_SUPPORTED};
use crate::lower::loops::{LoopVariable, Loops};
use crate::lower::shape::UNKNOWN_TEXT;
use crate::name::Ident;
use crate::source::Span;
use crate::syntax::ast::{
    ComponentReference, Expression, ExpressionKind, ForIndex, Subscript, UnaryOperator,
};
use crate::value::Value;
use crate::value::construct::Range;

impl<T: Target> Lowering<'_, T> {
    /// Any expression.
    pub(crate) fn lower(&mut self, e: &Expression) -> Result<Lowered<T::Scalar>, Diagnostic> {
        if self.depth >= MAX_DEPTH {
            return Err(
                fault!(NOT_SUPPORTED, "expressions nested deeper than {MAX_DEPTH}").at(e.span)
            );
        }
        self.depth += 1;
        let result = self.lower_kind(e);
        self.depth -= 1;
        result
    }

    fn lower_kind(&mut self, e: &Expression) -> Result<Lowered<T::Scalar>, Diagnostic> {
        let array = match &e.kind {
            ExpressionKind::Real(value) => Array::scalar(self.target.constant(*value)),
            ExpressionKind::Integer(value) => self.integer(*value, e.span)?,
            ExpressionKind::Boolean(value) => {
                Array::scalar(self.target.constant(f64::from(u8::from(*value))))
            }
            ExpressionKind::String(text) => return Ok(Lowered::Text(text.clone())),
            ExpressionKind::Reference(reference) => return self.reference(reference),
            ExpressionKind::Call { function, arguments } => {
                return self.call(function, arguments, e.span);
            }
            ExpressionKind::Unary { operator, operand } => match operator {
                UnaryOperator::Plus | UnaryOperator::ElementwisePlus => self.array(operand)?,
                UnaryOperator::Minus | UnaryOperator::ElementwiseMinus => {
                    let numbers = self.array(operand)?;
                    self.negated(numbers, operand)
                }
                UnaryOperator::Not => {
                    let operand = self.array(operand)?;
                    self.map_unary(super::Unary::Not, operand)
                }
            },
            ExpressionKind::Binary { .. } => return self.binary(e),
            ExpressionKind::If { branches, otherwise } => {
                return self.if_expression(branches, otherwise, e.span);
            }
            ExpressionKind::Range { start, step, stop } => {
                let values = self.range(start, step.as_deref(), stop, e.span)?;
                Array::vector(values.into_iter().map(|v| self.target.constant(v)).collect())
            }
            ExpressionKind::Array(elements) => return self.constructor(elements, e.span),
            ExpressionKind::ArrayIteration { element, indices } => {
                return self.array_iteration(element, indices, e.span);
            }
            ExpressionKind::Matrix(rows) => self.matrix(rows, e.span)?,
            ExpressionKind::End => match self.ends.last() {
                Some(size) => Array::scalar(self.target.constant(*size as f64)),
                None => {
                    return Err(
                        fault!(ARRAY_MISMATCH, "`end` is used outside a subscript").at(e.span)
                    );
                }
            },
            ExpressionKind::TypeName(_) | ExpressionKind::Code(_) => {
                return Err(fault!(
                    NOT_SUPPORTED,
                    "a class or code as a value is allowed only in scripts"
                )
                .at(e.span));
            }
            ExpressionKind::Subscripted { base, subscripts } => {
                let base = self.lower(base)?;
                return self.elements_of(base, subscripts, e.span);
            }
            ExpressionKind::Field { base, name } => {
                let base = self.lower(base)?;
                return field(base, *name, e.span);
            }
            ExpressionKind::Tuple(elements) => match elements.as_slice() {
                [Some(only)] => return self.lower(only),
                _ => {
                    return Err(fault!(NOT_SUPPORTED, "an output list is not a value").at(e.span));
                }
            },
            ExpressionKind::Guarded { .. } => {
                return Err(fault!(NOT_SUPPORTED, "`guard` in models").at(e.span));
            }
            ExpressionKind::PartialApplication { function, .. } => {
                return Err(fault!(
                    NOT_SUPPORTED,
                    "the function `{function}` as an argument is not supported in models"
                )
                .at(e.span));
            }
        };
        Ok(Lowered::Array(array))
    }

    fn reference(
        &mut self,
        reference: &ComponentReference,
    ) -> Result<Lowered<T::Scalar>, Diagnostic> {
        if let Some(ident) = reference.as_ident()
            && let Some(variable) = self.loop_variable(ident)
        {
            return Ok(Lowered::scalar(variable.value));
        }
        if let Some(value) = self.part_of_own(reference)? {
            return Ok(value);
        }
        let path = self.path(reference)?;
        if let Some(chosen) = self.element_of_variable(&path, reference)? {
            return Ok(chosen);
        }
        let value = self.target.reference(&path, reference)?;
        let value = self.made_of_binding(&path, value);
        let subscripts = &reference.parts[reference.parts.len() - 1].subscripts;
        self.elements_of(value, subscripts, reference.span)
    }

    /// A String parameter that is not known is made of its binding where Strings are made.
    fn made_of_binding(&mut self, path: &str, value: Lowered<T::Scalar>) -> Lowered<T::Scalar> {
        let is_unknown = matches!(&value, Lowered::Text(text) if text.contains(UNKNOWN_TEXT));
        if !self.composes || !is_unknown {
            return value;
        }
        let Some(binding) = self.target.string_binding(path) else { return value };
        let loops = std::mem::take(&mut self.loops);
        let made = self.lower(&binding);
        self.loops = loops;
        match made {
            Ok(made @ Lowered::Numbered(_)) => made,
            _ => value,
        }
    }

    /// The flat name without the last part's subscripts: `c[2].x`.
    pub(crate) fn path(&mut self, reference: &ComponentReference) -> Result<String, Diagnostic> {
        let mut path = String::new();
        for (position, part) in reference.parts.iter().enumerate() {
            if position > 0 {
                path.push('.');
            }
            path.push_str(part.name.as_str());
            if part.subscripts.is_empty() || position + 1 == reference.parts.len() {
                continue;
            }
            let mut strings = Vec::new();
            for subscript in &part.subscripts {
                match subscript {
                    Subscript::Index(index) => strings.push(self.known_size(index)?.to_string()),
                    Subscript::All(span) => {
                        return Err(
                            fault!(NOT_SUPPORTED, "a slice of an array of components").at(*span)
                        );
                    }
                }
            }
            path.push_str(&format!("[{}]", strings.join(",")));
        }
        Ok(path)
    }

    fn if_expression(
        &mut self,
        branches: &[(Expression, Expression)],
        otherwise: &Expression,
        span: Span,
    ) -> Result<Lowered<T::Scalar>, Diagnostic> {
        let Some(((condition, value), rest)) = branches.split_first() else {
            return self.lower(otherwise);
        };
        let condition = self.scalar(condition)?;
        if let Some(known) = self.target.as_constant(condition) {
            return match known != 0.0 {
                true => self.lower(value),
                false => self.if_expression(rest, otherwise, span),
            };
        }
        if self.target.is_clock(otherwise)
            && let Some(known) = self.target.structural_value(condition)
        {
            return match known != 0.0 {
                true => self.lower(value),
                false => self.if_expression(rest, otherwise, span),
            };
        }
        let mut branch = self.target.begin_if(condition);
        let first = self.branch(condition, true, |own| own.lower(value))?;
        let mut scalars = Vec::new();
        first.append_scalars(&mut scalars);
        self.target.begin_else(&mut branch, &scalars);
        let second =
            self.branch(condition, false, |own| own.if_expression(rest, otherwise, span))?;
        if matches!(first, Lowered::Text(_) | Lowered::Numbered(_))
            || matches!(second, Lowered::Text(_) | Lowered::Numbered(_))
        {
            self.target.end_if(branch, &[]);
            return self.choice_of_strings(condition, first, second, span);
        }
        let (Some(a), Some(b)) = (first.shape(), second.shape()) else {
            return Err(super::varying_strings::depends_on_conditions(span));
        };
        let Some(shape) = a.joined(&b) else {
            self.target.end_if(branch, &[]);
            return match self.target.structural_value(condition) {
                Some(holds) => Ok(if holds != 0.0 { first } else { second }),
                None => Err(fault!(
                    NO_CONSTANT_VALUE,
                    "the branches have different sizes, and \
                    which of them holds is not known at translation"
                )
                .at(span)),
            };
        };
        scalars.clear();
        second.append_scalars(&mut scalars);
        let values = self.target.end_if(branch, &scalars);
        Ok(Lowered::from_scalars(&shape, &mut values.into_iter()))
    }

    /// What is evaluated only where a condition holds, or does not.
    pub(super) fn branch<R>(
        &mut self,
        condition: T::Scalar,
        holds: bool,
        lower: impl FnOnce(&mut Self) -> R,
    ) -> R {
        self.target.enter(condition, holds);
        let result = lower(self);
        self.target.leave();
        result
    }

    /// One of two Strings.
    fn choice_of_strings(
        &mut self,
        condition: T::Scalar,
        first: Lowered<T::Scalar>,
        second: Lowered<T::Scalar>,
        span: Span,
    ) -> Result<Lowered<T::Scalar>, Diagnostic> {
        if let (Lowered::Text(a), Lowered::Text(b)) = (&first, &second) {
            if a == b {
                return Ok(first);
            }
            if let Some(holds) = self.target.structural_value(condition) {
                return Ok(if holds != 0.0 { first } else { second });
            }
        }
        let numbers = [self.number_of_text(first, span)?, self.number_of_text(second, span)?];
        Ok(self.string_choice(condition, numbers))
    }

    /// The numbers of a range (MLS §10.4.3).
    pub(crate) fn range(
        &mut self,
        start: &Expression,
        step: Option<&Expression>,
        stop: &Expression,
        span: Span,
    ) -> Result<Vec<f64>, Diagnostic> {
        let start = self.shaping(start)?;
        let step = step.map_or(Ok(1.0), |step| self.shaping(step))?;
        let stop = self.shaping(stop)?;
        let [first, by, last] = [start, step, stop].map(Value::Real);
        match Range::new(&first, Some(&by), &last) {
            Ok(range) if range.count() <= MAX_SCALARS => {
                Ok((0..range.count()).filter_map(|at| range.get(at).as_real()).collect())
            }
            _ => {
                Err(fault!(ARRAY_MISMATCH, "the range {start}:{step}:{stop} never reaches its end")
                    .at(span))
            }
        }
    }

    fn array_iteration(
        &mut self,
        element: &Expression,
        indices: &[ForIndex],
        span: Span,
    ) -> Result<Lowered<T::Scalar>, Diagnostic> {
        let Some((last, outer)) = indices.split_last() else {
            return self.lower(element);
        };
        let mut inner = Vec::new();
        for variable in self.loop_variables(last)? {
            self.loops.push(variable);
            let element = self.array_iteration(element, outer, span);
            self.loops.pop();
            inner.push(element?);
        }
        if inner.is_empty() && outer.is_empty() {
            let dims = [&[0], &element.written_sizes()[..]].concat();
            return Ok(Lowered::Array(Array { dims, elements: Vec::new() }));
        }
        stacked(inner, span)
    }

    /// The variable of a loop of this name, the innermost.
    pub(super) fn loop_variable(&self, name: Ident) -> Option<&LoopVariable<T::Scalar>> {
        self.loops.iter().rev().find(|variable| variable.name == name)
    }

    /// A loop variable with each of its values.
    pub(crate) fn loop_variables(
        &mut self,
        index: &ForIndex,
    ) -> Result<Loops<T::Scalar>, Diagnostic> {
        let Some(range) = &index.range else {
            return Err(fault!(NOT_SUPPORTED,
                "the range of `{}` is missing and cannot be deduced", index.name.node;
                help: "write the range")
            .at(index.name.span));
        };
        let values = self.array(range)?;
        if values.dims.len() != 1 {
            return Err(fault!(ARRAY_MISMATCH, "a loop needs a vector as its range").at(range.span));
        }
        let (name, value_type) = (index.name.node, self.type_of_index(index));
        let variable = |value| LoopVariable { name, value, value_type: value_type.clone() };
        Ok(values.elements.into_iter().map(variable).collect())
    }

    /// The type of a loop variable.
    pub(crate) fn type_of_index(&mut self, index: &ForIndex) -> ValueType {
        let range = index.range.as_ref();
        range.map_or(ValueType::Integer, |range| self.type_of(range))
    }

    /// Every element of `f(e for i in …)`, the last iterator outermost. An inner range may have another
    /// length for each value of an iterator around it.
    pub(crate) fn reduction_elements(
        &mut self,
        element: &Expression,
        indices: &[ForIndex],
    ) -> Result<Vec<Array<T::Scalar>>, Diagnostic> {
        let Some((last, outer)) = indices.split_last() else {
            return match self.lower(element)? {
                Lowered::Array(array) => Ok(vec![array]),
                _ => Err(fault!(ARRAY_MISMATCH, "a reduction over elements that are not numbers")
                    .at(element.span)),
            };
        };
        let mut elements = Vec::new();
        for variable in self.loop_variables(last)? {
            self.loops.push(variable);
            let inner = self.reduction_elements(element, outer);
            self.loops.pop();
            elements.extend(inner?);
        }
        Ok(elements)
    }

    fn constructor(
        &mut self,
        elements: &[Expression],
        span: Span,
    ) -> Result<Lowered<T::Scalar>, Diagnostic> {
        let values = elements.iter().map(|e| self.lower(e)).collect::<Result<Vec<_>, _>>()?;
        stacked(values, span)
    }
}
