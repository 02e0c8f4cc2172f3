//! Subscripts and matrix construction (MLS §10.4, §10.5).

use super::builtins::mismatch;
use super::{Array, Binary, Choice, Lowered, Lowering, Target};
use crate::diag::Diagnostic;
use crate::eval::ValueType;
use crate::fault;
use crate::functions;
use crate::lower::errors::ARRAY_MISMATCH;
use crate::source::Span;
use crate::syntax::ast::{ComponentReference, Expression, Subscript};

impl<T: Target> Lowering<'_, T> {
    /// `a[i, :]`
    pub(super) fn subscripted(
        &mut self,
        a: Array<T::Scalar>,
        subscripts: &[Subscript],
        span: Span,
    ) -> Result<Array<T::Scalar>, Diagnostic> {
        let choices = self.choices(&a.dims, subscripts, span)?;
        self.chosen_by(a, choices, span)
    }

    pub(super) fn chosen_by(
        &mut self,
        a: Array<T::Scalar>,
        choices: Vec<Choice<T::Scalar>>,
        span: Span,
    ) -> Result<Array<T::Scalar>, Diagnostic> {
        let is_computed = |choice: &Choice<_>| matches!(choice, Choice::Computed(_));
        let is_vector = |choice: &Choice<_>| matches!(choice, Choice::ComputedVector(_));
        if self.target.chooses()
            && choices.iter().any(is_computed)
            && !choices.iter().any(is_vector)
        {
            return self.target.subscripted(&a, choices, span);
        }
        let mut current = a;
        // From the last dimension to the first, so that positions of the others stay.
        for (dimension, choice) in choices.into_iter().enumerate().rev() {
            current = self.chosen(current, dimension, choice, span)?;
        }
        Ok(current)
    }

    /// `x[i]` of a variable; of known subscripts without the other elements of `x`: a loop over a
    /// large array would take the square of its size. `None` if it is not an array of numbers.
    pub(super) fn element_of_variable(
        &mut self,
        path: &str,
        reference: &ComponentReference,
    ) -> Result<Option<Lowered<T::Scalar>>, Diagnostic> {
        let subscripts = &reference.parts[reference.parts.len() - 1].subscripts;
        if subscripts.is_empty() {
            return Ok(None);
        }
        let Some(dims) = self.target.sizes(path) else { return Ok(None) };
        let choices = self.choices(&dims, subscripts, reference.span)?;
        if let Some(position) = position(&dims, &choices)
            && let Some(element) = self.target.element_of(path, position)?
        {
            let is_text = self.target.value_type(path) == Some(ValueType::String);
            return Ok(Some(match is_text {
                true => Lowered::Numbered(element),
                false => Lowered::scalar(element),
            }));
        }
        let Lowered::Array(whole) = self.target.reference(path, reference)? else {
            return Ok(None);
        };
        self.chosen_by(whole, choices, reference.span).map(|chosen| Some(Lowered::Array(chosen)))
    }

    /// What every subscript chooses; subscripts left away choose everything.
    pub(crate) fn choices(
        &mut self,
        dims: &[usize],
        subscripts: &[Subscript],
        span: Span,
    ) -> Result<Vec<Choice<T::Scalar>>, Diagnostic> {
        if subscripts.len() > dims.len() {
            return Err(fault!(
                ARRAY_MISMATCH,
                "{} subscripts for an array of {} dimensions",
                subscripts.len(),
                dims.len()
            )
            .at(span));
        }
        let mut choices = Vec::with_capacity(subscripts.len());
        for (subscript, size) in subscripts.iter().zip(dims) {
            self.ends.push(*size);
            let choice = self.choice(subscript, *size);
            self.ends.pop();
            choices.push(choice?);
        }
        Ok(choices)
    }

    fn choice(
        &mut self,
        subscript: &Subscript,
        size: usize,
    ) -> Result<Choice<T::Scalar>, Diagnostic> {
        let index = match subscript {
            Subscript::All(_) => {
                return Ok(Choice::Known { positions: (0..size).collect(), keeps: true });
            }
            Subscript::Index(index) => index,
        };
        let values = self.array(index)?;
        let keeps = !values.dims.is_empty();
        let mut positions = Vec::with_capacity(values.elements.len());
        for value in &values.elements {
            let known = self.target.as_constant(*value);
            let known =
                known.or_else(|| if keeps { self.target.structural_value(*value) } else { None });
            match known {
                Some(known) if known >= 1.0 && known <= size as f64 && known.fract() == 0.0 => {
                    positions.push(known as usize - 1);
                }
                // In a function the statement may never be executed.
                Some(_) if self.target.chooses() && !keeps => return Ok(Choice::Computed(*value)),
                Some(known) => {
                    return Err(fault!(ARRAY_MISMATCH, "subscript {known} is outside 1:{size}")
                        .help_if((known < 1.0).then(|| "the first subscript is 1".to_owned()))
                        .at(index.span));
                }
                None if !keeps => return Ok(Choice::Computed(*value)),
                None => return Ok(Choice::ComputedVector(values.elements)),
            }
        }
        Ok(Choice::Known { positions, keeps })
    }

    fn chosen(
        &mut self,
        a: Array<T::Scalar>,
        dimension: usize,
        choice: Choice<T::Scalar>,
        span: Span,
    ) -> Result<Array<T::Scalar>, Diagnostic> {
        let size = a.dims[dimension];
        let inner: usize = a.dims[dimension + 1..].iter().product();
        let outer: usize = a.dims[..dimension].iter().product();
        let at = |o: usize, position: usize, i: usize| (o * size + position) * inner + i;
        let mut dims = a.dims.clone();
        let mut elements = Vec::new();
        match choice {
            Choice::Known { positions, keeps } => {
                for o in 0..outer {
                    for position in &positions {
                        elements.extend((0..inner).map(|i| a.elements[at(o, *position, i)]));
                    }
                }
                dims[dimension] = positions.len();
                if !keeps {
                    dims.remove(dimension);
                }
            }
            Choice::Computed(index) => {
                let one = self.target.constant(1.0);
                let position = self.target.binary(Binary::Sub, index, one);
                for o in 0..outer {
                    for i in 0..inner {
                        let candidates: Vec<T::Scalar> =
                            (0..size).map(|p| a.elements[at(o, p, i)]).collect();
                        elements.push(self.target.element(&candidates, position, span)?);
                    }
                }
                dims.remove(dimension);
            }
            Choice::ComputedVector(indices) => {
                let one = self.target.constant(1.0);
                let positions: Vec<T::Scalar> = indices
                    .into_iter()
                    .map(|index| self.target.binary(Binary::Sub, index, one))
                    .collect();
                for o in 0..outer {
                    for position in &positions {
                        for i in 0..inner {
                            let candidates: Vec<T::Scalar> =
                                (0..size).map(|p| a.elements[at(o, p, i)]).collect();
                            elements.push(self.target.element(&candidates, *position, span)?);
                        }
                    }
                }
                dims[dimension] = positions.len();
            }
        }
        Ok(Array { dims, elements })
    }

    /// `[a, b; c, d]` (MLS §10.4.2)
    pub(super) fn matrix(
        &mut self,
        rows: &[Vec<Expression>],
        span: Span,
    ) -> Result<Array<T::Scalar>, Diagnostic> {
        let mut lines = Vec::new();
        for row in rows {
            let mut parts = Vec::new();
            for element in row {
                parts.push(as_matrix(self.array(element)?, element.span)?);
            }
            lines.push(self.concatenated(1, &parts, span)?);
        }
        self.concatenated(0, &lines, span)
    }

    /// Arrays put together along a dimension, from 0.
    fn concatenated(
        &mut self,
        axis: usize,
        parts: &[Array<T::Scalar>],
        span: Span,
    ) -> Result<Array<T::Scalar>, Diagnostic> {
        let dims: Vec<&[usize]> = parts.iter().map(|part| part.dims.as_slice()).collect();
        let plan = functions::concatenation(axis, &dims).map_err(|fault| mismatch(fault, span))?;
        let values: Vec<Option<&Array<T::Scalar>>> = parts.iter().map(Some).collect();
        self.elements_of_plan(plan, &values, false, span)
    }
}

/// Where the only element that known subscripts choose stands, the last dimension fastest.
fn position<S>(dims: &[usize], choices: &[Choice<S>]) -> Option<usize> {
    if dims.len() != choices.len() {
        return None;
    }
    choices.iter().zip(dims).try_fold(0, |position, (choice, size)| match choice {
        Choice::Known { positions, keeps: false } => Some(position * size + positions.first()?),
        _ => None,
    })
}

/// A scalar or vector as a matrix of one column.
fn as_matrix<S: Copy>(mut a: Array<S>, span: Span) -> Result<Array<S>, Diagnostic> {
    if a.dims.len() > 2 {
        return Err(
            fault!(ARRAY_MISMATCH, "an element of a matrix has more than two dimensions").at(span)
        );
    }
    while a.dims.len() < 2 {
        a.dims.push(1);
    }
    Ok(a)
}
