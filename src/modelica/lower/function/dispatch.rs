//! Sizes inside a function that an Integer decides which varies at run time.
//!
//! The function is compiled for every value that the Integer may take, and the call becomes a chain
//! of `if n == 0 then … elseif n == 1 then …`. The Integer takes values between 0 and
//! [`MOST`]; for another one the interpreter carries out the call, or an assertion fails.

use super::{compiled_call, interpreted_call};
use crate::diag::Diagnostic;
use crate::eval::{Function, ValueType};
use crate::fault;
use crate::lower::builder::Builder;
use crate::lower::equation::{Assertion, Level};
use crate::lower::errors::{NO_CONSTANT_VALUE, NOT_SUPPORTED};
use crate::lower::expressions::Lowered;
use crate::lower::string_part::StringPart;
use crate::source::Span;
use crate::symbolic::{Expr, RelationOperator};
use std::sync::Arc;

/// The largest size for which a function is compiled that varies at run time: each is an instance of
/// its own.
const MOST: u32 = 32;

/// The results of a call of which a size depends on an argument that varies; `None` if no Integer
/// argument decides.
pub(super) fn dispatched(
    builder: &mut Builder<'_>,
    function: &Arc<Function>,
    arguments: &[Lowered<Expr>],
    span: Span,
) -> Option<Result<Vec<Lowered<Expr>>, Diagnostic>> {
    let candidates = function.inputs.iter().zip(arguments).enumerate();
    let candidates: Vec<(usize, Expr)> = candidates
        .filter(|(_, (input, _))| input.value_type == ValueType::Integer)
        .filter_map(|(at, (_, argument))| match argument {
            Lowered::Array(array) if array.dims.is_empty() => Some((at, *array.elements.first()?)),
            _ => None,
        })
        .filter(|(_, e)| builder.dae.pool.as_constant(*e).is_none())
        .collect();
    for (at, value) in candidates {
        let decides = !matches!(
            with_value(builder, function, arguments, (at, 1), span),
            Err(e) if e.code == NO_CONSTANT_VALUE
        );
        if decides {
            return Some(chain(builder, function, arguments, (at, value), span));
        }
    }
    None
}

/// The call with a number in the place of an argument.
fn with_value(
    builder: &mut Builder<'_>,
    function: &Arc<Function>,
    arguments: &[Lowered<Expr>],
    (at, number): (usize, u32),
    span: Span,
) -> Result<Vec<Lowered<Expr>>, Diagnostic> {
    let mut arguments = arguments.to_vec();
    arguments[at] = Lowered::scalar(builder.dae.pool.constant(f64::from(number)));
    compiled_call(builder, function, arguments, span)
}

/// `if n == 0 then f(0) elseif n == 1 then f(1) …`, element by element.
fn chain(
    builder: &mut Builder<'_>,
    function: &Arc<Function>,
    arguments: &[Lowered<Expr>],
    (at, value): (usize, Expr),
    span: Span,
) -> Result<Vec<Lowered<Expr>>, Diagnostic> {
    let scalars_of = |outputs: &[Lowered<Expr>]| {
        let mut scalars = Vec::new();
        outputs.iter().for_each(|output| output.append_scalars(&mut scalars));
        scalars
    };
    let others = interpreted_call(builder, function, arguments, span);
    let is_complete = others.is_some();
    let mut results: Option<Vec<Expr>> = others.as_deref().map(scalars_of);
    let mut shapes: Option<Vec<_>> = others.map(|o| o.iter().map(Lowered::shape).collect());
    let mut known = builder.dae.pool.constant(0.0);
    for number in (0..=MOST).rev() {
        // A size that the function cannot have is refused where it is compiled for it.
        let Ok(outputs) = with_value(builder, function, arguments, (at, number), span) else {
            continue;
        };
        let own: Vec<_> = outputs.iter().map(Lowered::shape).collect();
        if shapes.as_ref().is_some_and(|others| *others != own) {
            return Err(fault!(NOT_SUPPORTED,
                "the sizes of what `{}` returns depend on `{}`, which varies during the simulation",
                function.name, function.inputs[at].name;
                help: "give it a value that is known at translation")
            .at(span));
        }
        let scalars = scalars_of(&outputs);
        let pool = &mut builder.dae.pool;
        let constant = pool.constant(f64::from(number));
        let is_it = pool.relation(RelationOperator::Equal, value, constant);
        known = pool.or(is_it, known);
        results = Some(match results {
            None => scalars,
            Some(others) => {
                let pairs = scalars.into_iter().zip(others);
                pairs.map(|(own, other)| pool.if_then_else(is_it, own, other)).collect()
            }
        });
        shapes = Some(own);
    }
    let (Some(shapes), Some(results)) = (shapes, results) else {
        return with_value(builder, function, arguments, (at, 1), span);
    };
    if !is_complete {
        let text = format!(
            "`{}` of `{}`, on which sizes depend, varies and lies outside 0 to {MOST}, or does not \
             fit the sizes of the other arguments",
            function.inputs[at].name, function.name
        );
        let parts = vec![StringPart::Text(text.into())];
        builder.dae.assertions.push(Assertion::new(known, parts, Level::Error, span));
    }
    let mut results = results.into_iter();
    let shapes = shapes.into_iter().flatten();
    Ok(shapes.map(|shape| Lowered::from_scalars(&shape, &mut results)).collect())
}
