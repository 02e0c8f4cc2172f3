//! Functions that rearrange elements whatever these are, numbers or records (MLS §10.3.3, §10.3.5,
//! §10.4.2).

use super::arrays::concatenate;
use super::expression::field;
use super::records::{arrays, common_text};
use super::{Array, Lowered, Lowering, Target};
use crate::diag::Diagnostic;
use crate::fault;
use crate::lower::errors::ARRAY_MISMATCH;
use crate::source::Span;
use crate::syntax::ast::Expression;

impl<T: Target> Lowering<'_, T> {
    /// The call of a function that rearranges; `None` for another function.
    pub(super) fn rearrangement(
        &mut self,
        name: &str,
        arguments: &[Expression],
        span: Span,
    ) -> Result<Option<Lowered<T::Scalar>>, Diagnostic> {
        let value = match (name, arguments) {
            ("fill", [value, sizes @ ..]) => {
                let value = self.lower(value)?;
                self.by_fields(&[value], span, &mut |lowering, value| {
                    lowering.repeated(&value[0], sizes, span)
                })?
            }
            ("transpose", [matrix]) => {
                let matrix = self.lower(matrix)?;
                self.by_fields(&[matrix], span, &mut |_, matrix| transposed(&matrix[0], span))?
            }
            ("cat", [dimension, parts @ ..]) => {
                let dimension = self.known_size(dimension)?.wrapping_sub(1);
                let parts =
                    parts.iter().map(|part| self.lower(part)).collect::<Result<Vec<_>, _>>()?;
                self.by_fields(&parts, span, &mut |_, parts| concatenate(dimension, parts, span))?
            }
            ("fill" | "transpose" | "cat", _) => {
                return Err(
                    fault!(ARRAY_MISMATCH, "the arguments of `{name}` are invalid").at(span)
                );
            }
            _ => return Ok(None),
        };
        Ok(Some(value))
    }

    /// Rearranges arrays; those of records, which are records of arrays, field by field.
    fn by_fields(
        &mut self,
        values: &[Lowered<T::Scalar>],
        span: Span,
        rearrange: &mut Rearrange<'_, Self, T::Scalar>,
    ) -> Result<Lowered<T::Scalar>, Diagnostic> {
        if let Some(Lowered::Record(first)) = values.first() {
            let mut fields = Vec::with_capacity(first.len());
            for (name, _) in first {
                let of_all = values.iter().map(|value| field(value.clone(), *name, span));
                let of_all = of_all.collect::<Result<Vec<_>, _>>()?;
                fields.push((*name, self.by_fields(&of_all, span, rearrange)?));
            }
            return Ok(Lowered::Record(fields));
        }
        if let Some(text) = common_text(values) {
            return Ok(Lowered::Text(text));
        }
        let arrays = arrays(values.to_vec(), span)?;
        rearrange(self, arrays).map(Lowered::Array)
    }

    pub(super) fn repeated(
        &mut self,
        value: &Array<T::Scalar>,
        sizes: &[Expression],
        span: Span,
    ) -> Result<Array<T::Scalar>, Diagnostic> {
        let mut dims = sizes.iter().map(|n| self.known_size(n)).collect::<Result<Vec<_>, _>>()?;
        let count = dims.iter().try_fold(1usize, |product, n| product.checked_mul(*n));
        match count.and_then(|count| count.checked_mul(value.elements.len().max(1))) {
            Some(total) if total <= super::MAX_SCALARS => {}
            _ => return Err(fault!(ARRAY_MISMATCH, "an array of too many elements").at(span)),
        }
        let elements = value.elements.repeat(count.unwrap_or(0));
        dims.extend(&value.dims);
        Ok(Array { dims, elements })
    }
}

/// What [`Lowering::by_fields`] does with arrays of numbers.
type Rearrange<'a, L, S> = dyn FnMut(&mut L, Vec<Array<S>>) -> Result<Array<S>, Diagnostic> + 'a;

fn transposed<S: Copy>(a: &Array<S>, span: Span) -> Result<Array<S>, Diagnostic> {
    let &[rows, columns, ref rest @ ..] = a.dims.as_slice() else {
        return Err(fault!(ARRAY_MISMATCH, "`transpose` takes a matrix").at(span));
    };
    let each: usize = rest.iter().product();
    let blocks = (0..columns).flat_map(|column| (0..rows).map(move |row| row * columns + column));
    let elements = blocks.flat_map(|block| block * each..(block + 1) * each);
    let elements = elements.map(|at| a.elements[at]).collect();
    Ok(Array { dims: [&[columns, rows], rest].concat(), elements })
}
