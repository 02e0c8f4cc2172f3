//! Calls of functions with arrays where scalars are expected: one call for each element
//! (MLS §12.4.6).

use crate::diag::Diagnostic;
use crate::eval::{Function, FunctionBody};
use crate::fault;
use crate::flatten::errors::SIZE_MISMATCH;
use crate::flatten::flat_expression::indices_of;
use crate::flatten::flat_expression::subscripted;
use crate::flatten::instantiate::instantiation::Instantiation;
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

impl Instantiation<'_> {
    /// A call with resolved arguments as an array of calls; `None` if it is one call.
    pub(crate) fn vectorized(
        &mut self,
        name: &Name,
        arguments: &Arguments,
        span: Span,
    ) -> Result<Option<Expression>, Diagnostic> {
        let Some(Some(function)) = self.functions.table.get(name).cloned() else { return Ok(None) };
        if !arguments.iterators.is_empty()
            || function.body == FunctionBody::RecordConstructor
            || function.outputs.is_empty()
        {
            return Ok(None);
        }
        let (dims, spread) = self.spread(&function, name, arguments)?;
        let Some(dims) = dims else { return Ok(None) };
        if function.outputs.len() > 1 {
            return self.several_outputs(name, span);
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

    /// Functions of several outputs are not called for each element; libraries do it nevertheless.
    fn several_outputs(&self, name: &Name, span: Span) -> Result<Option<Expression>, Diagnostic> {
        if !self.classes.library.is_strict() {
            return Ok(None);
        }
        Err(fault!(SIZE_MISMATCH, "`{name}` is called with an array where it takes a scalar, and \
                                   has several outputs";
            help: "call it in a loop: only functions with one output are called for each element")
        .at(span))
    }

    /// The sizes of the array of calls, and the arguments that are spread over it.
    fn spread(
        &mut self,
        function: &Function,
        name: &Name,
        arguments: &Arguments,
    ) -> Result<(Option<Vec<usize>>, Spread), Diagnostic> {
        let mut dims: Option<Vec<usize>> = None;
        let mut spread =
            Spread { positional: vec![false; arguments.positional.len()], named: Vec::new() };
        for (at, argument) in arguments.positional.iter().enumerate() {
            let Some(input) = function.inputs.get(at) else { break };
            if let Some(extra) = self.extra_dims(argument, input.dims.len()) {
                merge(&mut dims, extra, name, argument.span)?;
                spread.positional[at] = true;
            }
        }
        for argument in &arguments.named {
            let input = function.inputs.iter().find(|input| input.name == argument.name.node);
            let extra = input.and_then(|i| self.extra_dims(&argument.value, i.dims.len()));
            spread.named.push(extra.is_some());
            if let Some(extra) = extra {
                merge(&mut dims, extra, name, argument.value.span)?;
            }
        }
        Ok((dims, spread))
    }

    /// The sizes that an argument has beyond those of its input, if it has more.
    fn extra_dims(&mut self, argument: &Expression, expected: usize) -> Option<Vec<usize>> {
        if self.types().rank_of(argument).is_some_and(|rank| rank <= expected) {
            return None;
        }
        let dims = self.shape_of(argument)?;
        (dims.len() > expected).then(|| dims[..dims.len() - expected].to_vec())
    }
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
