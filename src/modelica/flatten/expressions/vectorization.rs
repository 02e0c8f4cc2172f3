//! Calls of functions with arrays where scalars are expected: one call for each element
//! (MLS §12.4.6).

use crate::diag::Diagnostic;
use crate::eval::{Function, FunctionBody};
use crate::fault;
use crate::flatten::errors::SIZE_MISMATCH;
use crate::flatten::flat_expression::indices_of;
use crate::flatten::flat_expression::subscripted;
use crate::name::Name;
use crate::source::Span;
use crate::syntax::ast::{Arguments, ComponentReference, Expression, ExpressionKind, Subscript};

/// The most calls that one call stands for.
const MAX_CALLS: usize = 100_000;

/// The arguments of a call that are spread over an array of calls.
struct Spread {
    positional: Vec<bool>,
    named: Vec<bool>,
}

impl Spread {
    /// The call of one element, by its indices from 1.
    fn call(&self, name: &Name, arguments: &Arguments, at: &[usize], span: Span) -> Expression {
        let element = |value: &Expression| {
            let literal = |index: &usize| {
                let kind = ExpressionKind::Integer(*index as i64);
                Subscript::Index(Expression::new(kind, span))
            };
            subscripted(value.clone(), at.iter().map(literal).collect(), span)
        };
        let mut one = arguments.clone();
        let positional = one.positional.iter_mut().zip(&self.positional);
        let named = one.named.iter_mut().map(|argument| &mut argument.value).zip(&self.named);
        for (value, _) in positional.chain(named).filter(|(_, is_spread)| **is_spread) {
            *value = element(value);
        }
        let function = ComponentReference::from_name(name, span);
        Expression::new(ExpressionKind::Call { function, arguments: Box::new(one) }, span)
    }
}

/// The sizes that an argument has beyond so many dimensions, if it has more.
pub(crate) type Surplus<'s> = dyn FnMut(&Expression, usize) -> Option<Vec<usize>> + 's;

/// A call with resolved arguments as an array of calls; `None` if it is one call. Functions of several
/// outputs are not called for each element; libraries that need not conform in all do it nevertheless.
pub(crate) fn vectorized(
    function: &Function,
    (name, arguments): (&Name, &Arguments),
    surplus: &mut Surplus<'_>,
    is_strict: bool,
    span: Span,
) -> Result<Option<Expression>, Diagnostic> {
    if !arguments.iterators.is_empty()
        || function.body == FunctionBody::RecordConstructor
        || function.outputs.is_empty()
    {
        return Ok(None);
    }
    let (dims, spread) = spread(function, name, arguments, surplus)?;
    let Some(dims) = dims else { return Ok(None) };
    if function.outputs.len() > 1 {
        return match is_strict {
            true => Err(several_outputs(name, span)),
            false => Ok(None),
        };
    }
    let count: usize = dims.iter().product();
    if count > MAX_CALLS {
        return Err(fault!(
            SIZE_MISMATCH,
            "`{name}` would be called {count} times, which is too many"
        )
        .at(span));
    }
    let calls = (0..count).map(|at| spread.call(name, arguments, &indices_of(at, &dims), span));
    let calls = calls.collect();
    Ok(Some(crate::flatten::connections::arranged(calls, &dims, span)))
}

fn several_outputs(name: &Name, span: Span) -> Diagnostic {
    fault!(SIZE_MISMATCH, "`{name}` is called with an array where it takes a scalar, and \
                               has several outputs";
        help: "call it in a loop: only functions with one output are called for each element")
    .at(span)
}

/// The sizes of the array of calls, and the arguments that are spread over it.
fn spread(
    function: &Function,
    name: &Name,
    arguments: &Arguments,
    surplus: &mut Surplus<'_>,
) -> Result<(Option<Vec<usize>>, Spread), Diagnostic> {
    let mut dims: Option<Vec<usize>> = None;
    let mut spread =
        Spread { positional: vec![false; arguments.positional.len()], named: Vec::new() };
    for (at, argument) in arguments.positional.iter().enumerate() {
        let Some(input) = function.inputs.get(at) else { break };
        if let Some(extra) = surplus(argument, input.dims.len()) {
            merge(&mut dims, extra, name, argument.span)?;
            spread.positional[at] = true;
        }
    }
    for argument in &arguments.named {
        let input = function.inputs.iter().find(|input| input.name == argument.name.node);
        let extra = input.and_then(|input| surplus(&argument.value, input.dims.len()));
        spread.named.push(extra.is_some());
        if let Some(extra) = extra {
            merge(&mut dims, extra, name, argument.value.span)?;
        }
    }
    Ok((dims, spread))
}

fn merge(
    dims: &mut Option<Vec<usize>>,
    extra: Vec<usize>,
    name: &Name,
    span: Span,
) -> Result<(), Diagnostic> {
    match dims {
        Some(known) if *known != extra => Err(fault!(
            SIZE_MISMATCH,
            "`{name}` is called for each element of arrays of different sizes"
        )
        .at(span)),
        _ => {
            *dims = Some(extra);
            Ok(())
        }
    }
}
