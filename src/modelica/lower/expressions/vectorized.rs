//! Functions applied to arrays element by element (MLS §12.4.6).

use super::records::{arrays, field, string_arrays, string_value};
use super::{Array, Lowered, Lowering, Target, size_fault};
use crate::diag::Diagnostic;
use crate::eval::{Function, FunctionComponent, ValueType};
use crate::lower::string_array::StringArray;
use crate::source::Span;
use std::sync::Arc;

impl<T: Target> Lowering<'_, T> {
    /// One call for every element of the arguments that have more dimensions than their inputs,
    /// which must agree in these; `None` if no argument has.
    pub(super) fn vectorized_call(
        &mut self,
        function: &Arc<Function>,
        arguments: &[Lowered<T::Scalar>],
        span: Span,
    ) -> Result<Option<Vec<Lowered<T::Scalar>>>, Diagnostic> {
        let mut sizes: Option<&[usize]> = None;
        for (input, argument) in function.inputs.iter().zip(arguments) {
            let Some(outer) = surplus(input, argument) else { continue };
            match sizes {
                Some(known) if known != outer => {
                    return super::at(Err(size_fault(known, outer)), span);
                }
                _ => sizes = Some(outer),
            }
        }
        let Some(sizes) = sizes else { return Ok(None) };
        let calls = (0..sizes.iter().product()).map(|at| {
            let pairs = function.inputs.iter().zip(arguments);
            let one = pairs.map(|(input, argument)| part(input, argument, at)).collect();
            self.target.call(function, one, span)
        });
        let calls: Vec<_> = calls.collect::<Result<_, _>>()?;
        let outputs = (0..function.outputs.len()).map(|output| {
            let of_call = |call: &Vec<Lowered<T::Scalar>>| call.get(output).cloned();
            let ones: Option<Vec<_>> = calls.iter().map(of_call).collect();
            gathered(sizes, &ones.unwrap_or_default(), span)
        });
        outputs.collect::<Result<_, _>>().map(Some)
    }
}

/// The results of all calls as one array of these sizes.
fn gathered<S: Copy>(
    sizes: &[usize],
    ones: &[Lowered<S>],
    span: Span,
) -> Result<Lowered<S>, Diagnostic> {
    if let Some(Lowered::Record(fields)) = ones.first() {
        let whole = fields.iter().map(|(name, _)| {
            let of_one = |one: &Lowered<S>| field(one.clone(), *name, span);
            let ones = ones.iter().map(of_one).collect::<Result<Vec<_>, _>>()?;
            Ok((*name, gathered(sizes, &ones, span)?))
        });
        return whole.collect::<Result<_, _>>().map(Lowered::Record);
    }
    if let Some(strings) = string_arrays(ones).as_deref().and_then(StringArray::stacked) {
        let dims = [sizes, &strings.dims[1..]].concat();
        return Ok(Lowered::Strings(StringArray { dims, ..strings }));
    }
    let ones = arrays(ones.to_vec(), span)?;
    let inner = ones.first().map_or(&[][..], |one| &one.dims);
    let dims = [sizes, inner].concat();
    Ok(Lowered::Array(Array {
        dims,
        elements: ones.iter().flat_map(|one| &one.elements).copied().collect(),
    }))
}

/// All sizes of a value for an input: those of the input's own dimensions are the last.
pub(super) fn sizes_for<'a, S>(
    input: &FunctionComponent,
    value: &'a Lowered<S>,
) -> Option<&'a [usize]> {
    match (value, &input.value_type) {
        (Lowered::Array(array), _) => Some(&array.dims),
        (Lowered::Strings(strings), _) => Some(&strings.dims),
        // Arrays of records are records of arrays.
        (Lowered::Record(values), ValueType::Record(_, fields)) => {
            let (name, value) = values.first()?;
            let field = fields.get(name)?;
            let dims = sizes_for(field, value)?;
            Some(&dims[..dims.len().checked_sub(field.dims.len())?])
        }
        _ => None,
    }
}

/// The sizes of the first dimensions, which the input does not have.
fn surplus<'a, S>(input: &FunctionComponent, argument: &'a Lowered<S>) -> Option<&'a [usize]> {
    let dims = sizes_for(input, argument)?;
    let n = dims.len().checked_sub(input.dims.len())?;
    (n > 0).then(|| &dims[..n])
}

/// The argument of the call of this number.
fn part<S: Copy>(input: &FunctionComponent, argument: &Lowered<S>, at: usize) -> Lowered<S> {
    match surplus(input, argument) {
        Some(outer) => element(argument, outer.len(), at),
        None => argument.clone(),
    }
}

/// The element of this number of an array with so many dimensions.
fn element<S: Copy>(array: &Lowered<S>, rank: usize, at: usize) -> Lowered<S> {
    match array {
        Lowered::Array(array) => {
            let dims = array.dims[rank..].to_vec();
            let n: usize = dims.iter().product();
            Lowered::Array(Array { dims, elements: array.elements[at * n..(at + 1) * n].to_vec() })
        }
        Lowered::Record(fields) => {
            let fields = fields.iter().map(|(name, field)| (*name, element(field, rank, at)));
            Lowered::Record(fields.collect())
        }
        Lowered::Strings(strings) => string_value(strings.part(rank, at)),
        other => other.clone(),
    }
}
