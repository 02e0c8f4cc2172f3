//! Functions applied to arrays element by element (MLS §12.4.6).

use super::{Array, Lowered, Lowering, Target, size_fault};
use crate::dae::errors::NOT_SUPPORTED;
use crate::diag::Diagnostic;
use crate::eval::{Function, FunctionComponent};
use crate::fault;
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
            let mut whole = Array { dims: sizes.to_vec(), elements: Vec::new() };
            for (at, call) in calls.iter().enumerate() {
                let Some(Lowered::Array(one)) = call.get(output) else {
                    return Err(fault!(
                        NOT_SUPPORTED,
                        "`{}` applied to every element of an array has a record as output",
                        function.name
                    )
                    .at(span));
                };
                if at == 0 {
                    whole.dims.extend(&one.dims);
                }
                whole.elements.extend(&one.elements);
            }
            Ok(Lowered::Array(whole))
        });
        outputs.collect::<Result<_, _>>().map(Some)
    }
}

/// The sizes of the first dimensions, which the input does not have.
fn surplus<'a, S>(input: &FunctionComponent, argument: &'a Lowered<S>) -> Option<&'a [usize]> {
    let Lowered::Array(array) = argument else { return None };
    let n = array.dims.len().checked_sub(input.dims.len())?;
    (n > 0).then(|| &array.dims[..n])
}

/// The argument of the call of this number.
fn part<S: Copy>(input: &FunctionComponent, argument: &Lowered<S>, at: usize) -> Lowered<S> {
    match (argument, surplus(input, argument)) {
        (Lowered::Array(array), Some(outer)) => {
            let dims = array.dims[outer.len()..].to_vec();
            let n: usize = dims.iter().product();
            Lowered::Array(Array { dims, elements: array.elements[at * n..(at + 1) * n].to_vec() })
        }
        _ => argument.clone(),
    }
}
