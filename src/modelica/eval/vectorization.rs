//! Calls of functions of scalars with arrays, element by element (MLS §12.4.6).

use super::{Evaluator, Function, ValueType};
use crate::diag::{At, Diagnostic, Fault};
use crate::fault;
use crate::name::Ident;
use crate::source::Span;
use crate::syntax::foreign;
use crate::value::errors::{SIZE_MISMATCH, TYPE_MISMATCH};
use crate::value::{Value, construct, sizes};
use std::sync::Arc;

impl Evaluator<'_> {
    /// Calls a function: once, or for each element where arguments have more dimensions than the
    /// inputs they are for.
    pub(super) fn call_bound(
        &mut self,
        function: &Arc<Function>,
        given: Vec<Option<Value>>,
        span: Span,
    ) -> Result<Vec<Value>, Diagnostic> {
        let Some(outer) = outer_sizes(function, &given).at(span)? else {
            return self.run(function, given, span);
        };
        self.call_each(function, given, (&outer, span), Evaluator::run)
    }

    /// The same for a command of the host. Only its scalar inputs take vectors: what else it is given
    /// it reads in its own ways.
    pub(super) fn call_builtin(
        &mut self,
        header: &Arc<Function>,
        mut given: Vec<Option<Value>>,
        span: Span,
    ) -> Result<Vec<Value>, Diagnostic> {
        let vectors = given.iter().zip(&header.inputs).filter_map(|(value, input)| {
            let is_scalar = input.dims.is_empty() && is_vectorized(&input.value_type);
            value.as_ref().filter(|value| is_scalar && value.rank() == 1).map(Value::dims)
        });
        let mut vectors = vectors.collect::<Vec<&[usize]>>();
        vectors.dedup();
        let [outer] = vectors.as_slice() else { return self.run_builtin(header, given, span) };
        let outer = outer.to_vec();
        // Other arguments are not to be taken apart.
        let kept: Vec<Option<Value>> = header
            .inputs
            .iter()
            .zip(&mut given)
            .map(|(input, value)| if input.dims.is_empty() { None } else { value.take() })
            .collect();
        let run = |evaluator: &mut Self,
                   header: &Arc<Function>,
                   mut given: Vec<Option<Value>>,
                   span: Span| {
            for (value, kept) in given.iter_mut().zip(&kept) {
                if kept.is_some() {
                    value.clone_from(kept);
                }
            }
            evaluator.run_builtin(header, given, span)
        };
        let done = self.call_each(header, given, (&outer, span), run);
        done.map_err(|error| {
            let name = header.name.last().map_or("", Ident::as_str);
            match foreign::array_function(name).filter(|_| error.code == TYPE_MISMATCH) {
                Some(help) => error.with_only_help(help),
                None => error,
            }
        })
    }

    /// Calls a function for each element of the dimensions `outer` that arguments have beyond those
    /// of the inputs.
    fn call_each(
        &mut self,
        function: &Arc<Function>,
        given: Vec<Option<Value>>,
        (outer, span): (&[usize], Span),
        run: impl Fn(
            &mut Self,
            &Arc<Function>,
            Vec<Option<Value>>,
            Span,
        ) -> Result<Vec<Value>, Diagnostic>,
    ) -> Result<Vec<Value>, Diagnostic> {
        let mut arguments = Vec::with_capacity(given.len());
        for (value, input) in given.into_iter().zip(&function.inputs) {
            arguments.push(match value {
                Some(value) if value.rank() > input.dims.len() => {
                    Argument::Each(construct::split(outer, value).at(span)?)
                }
                other => Argument::Same(other),
            });
        }
        let count = outer.iter().product();
        let mut outputs: Vec<Vec<Value>> = vec![Vec::with_capacity(count); function.outputs.len()];
        for at in 0..count {
            let given = arguments.iter().map(|argument| argument.get(at)).collect();
            let results = run(self, function, given, span)?;
            for (output, result) in outputs.iter_mut().zip(results) {
                output.push(result);
            }
        }
        outputs.into_iter().map(|values| construct::shaped(outer, values).at(span)).collect()
    }
}

enum Argument {
    Same(Option<Value>),
    Each(Vec<Value>),
}

impl Argument {
    fn get(&self, at: usize) -> Option<Value> {
        match self {
            Argument::Same(value) => value.clone(),
            Argument::Each(values) => values.get(at).cloned(),
        }
    }
}

/// The sizes of the dimensions that the arguments have beyond those of the inputs; `None` if no
/// argument has any.
fn outer_sizes(function: &Function, given: &[Option<Value>]) -> Result<Option<Vec<usize>>, Fault> {
    let mut found: Option<Vec<usize>> = None;
    for (value, input) in given.iter().zip(&function.inputs) {
        let (Some(value), true) = (value, is_vectorized(&input.value_type)) else { continue };
        let extra = value.rank().saturating_sub(input.dims.len());
        if extra == 0 {
            continue;
        }
        let outer = &value.dims()[..extra];
        match &found {
            None => found = Some(outer.to_vec()),
            Some(before) if before == outer => {}
            Some(before) => {
                return Err(fault!(
                    SIZE_MISMATCH,
                    "`{}` is called for arrays of different sizes, {} and {}",
                    function.name,
                    sizes(before),
                    sizes(outer)
                ));
            }
        }
    }
    Ok(found)
}

fn is_vectorized(value_type: &ValueType) -> bool {
    !matches!(
        value_type,
        ValueType::Any
            | ValueType::Expression
            | ValueType::Function
            | ValueType::TypeName
            | ValueType::VariableName
    )
}
