//! User functions become [`bytecode`](crate::bytecode) where they cannot become expressions: loops,
//! exits and subscripts that depend on variables, recursion, bodies too big to be repeated at every
//! call (MLS ch. 11, 12).
//!
//! A function is compiled once for every combination of sizes of its arguments. Where a size
//! depends on the value of an Integer input, it is compiled for that value, which must be known.
//! Loops stay loops; only a short one, and one whose body needs sizes that change from iteration to
//! iteration, is unrolled. Where sizes are known only when it is called, the interpreter carries out the call.

mod assigned_shape;
mod composer;
mod derivative;
mod dispatch;
mod emitter;
mod external;
mod external_kinds;
mod headers;
mod instances;
mod interpreted;
mod inverse;
mod mark;
mod notices;
mod on_demand;
mod partial_derivative;
mod place;
mod printing;
mod repeated;
mod results;
mod run_time_sizes;
mod single_assignment;
mod statements;
mod target;
mod unrolling;

pub(super) use external_kinds::{confirms, fails, prints};
pub(super) use headers::library_of;
pub(super) use instances::Instances;
use instances::Output;
pub(super) use inverse::{Inverts, inverts};
pub(crate) use notices::warning_of;
pub use on_demand::CompiledFunctions;
pub(super) use on_demand::OnDemand;
pub(super) use repeated::Before;
pub(super) use results::CallResults;

use super::builder::{Builder, MAX_STATEMENTS};
use super::errors::{ARRAY_MISMATCH, NO_CONSTANT_VALUE, NOT_SUPPORTED, UNRESOLVED_REFERENCE};
use super::expressions::{Lowered, field_of};
use super::inline::{MAX_INLINED, inline};
use crate::diag::Diagnostic;
use crate::eval::{Function, FunctionBody, FunctionComponent, ValueType};
use crate::fault;
use crate::name::{Ident, Name};
use crate::source::Span;
use crate::symbolic::Expr;
use crate::syntax::ast::{ComponentReference, Subscript};
use std::borrow::Cow;
use std::sync::Arc;

/// The outputs of a call in an equation: expressions where its statements can be evaluated
/// symbolically, else calls of its code.
pub(super) fn call(
    builder: &mut Builder<'_>,
    function: &Arc<Function>,
    arguments: Vec<Lowered<Expr>>,
    span: Span,
) -> Result<Vec<Lowered<Expr>>, Diagnostic> {
    if let FunctionBody::PartialDerivative { of, by } = &function.body {
        return partial_derivative::call(builder, function, (of, by), arguments, span);
    }
    let needs_string_outputs = std::mem::take(&mut builder.calls.functions.needs_string_outputs);
    if needs_string_outputs && function.outputs.iter().any(instances::is_text) {
        builder.calls.functions.needs_string_outputs = true;
        return compiled_call(builder, function, arguments, span);
    }
    if builder.calls.functions.may_write {
        // Inlined, a function would write in all of its branches.
        return compiled_call(builder, function, arguments, span);
    }
    if builder.calls.depth == 0 {
        builder.calls.inlined = MAX_INLINED;
    }
    if let Some(results) = repeated::repeat(builder, function, &arguments) {
        return Ok(results);
    }
    let before = Before::new(builder);
    let results = inlined_or_compiled(builder, function, arguments.clone(), span)?;
    repeated::remember(builder, function, arguments, &before, &results);
    Ok(results)
}

fn inlined_or_compiled(
    builder: &mut Builder<'_>,
    function: &Arc<Function>,
    mut arguments: Vec<Lowered<Expr>>,
    span: Span,
) -> Result<Vec<Lowered<Expr>>, Diagnostic> {
    if inverse::is_kept(function)
        && let Ok(outputs) = compiled_call(builder, function, arguments.clone(), span)
    {
        return Ok(outputs);
    }
    let before = Before::new(builder);
    let error = match inline(builder, function, arguments.clone(), span) {
        Err(e) if [NOT_SUPPORTED, NO_CONSTANT_VALUE, ARRAY_MISMATCH].contains(&e.code) => e,
        result => return result,
    };
    let too_big = builder.calls.inlined == 0;
    if too_big && builder.calls.depth > 0 {
        return Err(error);
    }
    before.restore(builder);
    let mut result = compiled_call(builder, function, arguments.clone(), span);
    if matches!(&result, Err(e) if e.code == NO_CONSTANT_VALUE)
        && evaluate_whole_numbers(builder, function, &mut arguments)
    {
        result = compiled_call(builder, function, arguments.clone(), span);
    }
    if matches!(&result, Err(e) if e.code == NO_CONSTANT_VALUE)
        && let Some(dispatched) = dispatch::dispatched(builder, function, &arguments, span)
    {
        result = dispatched;
    }
    if matches!(&result, Err(e) if [NO_CONSTANT_VALUE, NOT_SUPPORTED].contains(&e.code)) {
        result = call_of_any_size(builder, function, arguments.clone(), span);
    }
    match result {
        // What does not fit may be in a branch that is never taken.
        Err(_) if error.code == ARRAY_MISMATCH => Err(error),
        Err(_) if too_big => {
            builder.calls.inlined = MAX_STATEMENTS;
            inline(builder, function, arguments, span)
        }
        result => result,
    }
}

/// Gives Integer and Boolean arguments, which sizes may depend on, the values that parameters have
/// when compiling; whether there are any.
fn evaluate_whole_numbers(
    builder: &mut Builder<'_>,
    function: &Function,
    arguments: &mut [Lowered<Expr>],
) -> bool {
    let mut any = false;
    for (input, argument) in function.inputs.iter().zip(arguments) {
        any |= evaluate_whole(builder, &input.value_type, argument);
    }
    any
}

/// As [`evaluate_whole_numbers`], of one argument and the components of a record.
fn evaluate_whole(
    builder: &mut Builder<'_>,
    expected: &ValueType,
    value: &mut Lowered<Expr>,
) -> bool {
    let mut any = false;
    if let (Lowered::Record(fields), ValueType::Record(_, types)) = (&mut *value, expected) {
        for (name, field) in fields {
            if let Some(component) = types.get(name) {
                any |= evaluate_whole(builder, &component.value_type, field);
            }
        }
        return any;
    }
    let is_whole = matches!(expected, ValueType::Integer | ValueType::Boolean);
    let Lowered::Array(array) = &*value else { return false };
    let ([element], true) = (array.elements.as_slice(), array.dims.is_empty()) else {
        return false;
    };
    if !is_whole || builder.dae.pool.as_constant(*element).is_some() {
        return false;
    }
    if let Ok(Some(known)) = builder.evaluate_structural(*element) {
        *value = Lowered::scalar(builder.dae.pool.constant(known));
        any = true;
    }
    any
}

/// As [`compiled_call`], with sizes in statements that computed Integers decide.
pub(super) fn call_of_any_size(
    builder: &mut Builder<'_>,
    function: &Arc<Function>,
    arguments: Vec<Lowered<Expr>>,
    span: Span,
) -> Result<Vec<Lowered<Expr>>, Diagnostic> {
    let outer = std::mem::replace(&mut builder.calls.functions.sizes_at_run_time, true);
    let result = compiled_call(builder, function, arguments, span);
    builder.calls.functions.sizes_at_run_time = outer;
    result
}

/// What becomes of the output of a function that is called where the builder is.
fn output(builder: &Builder<'_>) -> Output {
    match builder.place.in_when || builder.place.initial {
        false => Output::LeftOut,
        true if builder.calls.depth == 0 => Output::Written,
        true => Output::Refused,
    }
}

/// Says, once for each function, that nothing is printed.
fn warn_silenced(builder: &mut Builder<'_>, function: &Function, span: Span) {
    let warning =
        fault!(NOT_SUPPORTED, "what `{}` prints is left out here, where it is called at every \
        step",
        function.name;
        help: "to see it, call it in a when-clause")
        .at(span)
        .warning();
    if builder.dae.warnings.iter().all(|known| known.message != warning.message) {
        builder.dae.warnings.push(warning);
    }
}

/// Expressions that call the code of a function.
pub(super) fn compiled_call(
    builder: &mut Builder<'_>,
    function: &Arc<Function>,
    arguments: Vec<Lowered<Expr>>,
    span: Span,
) -> Result<Vec<Lowered<Expr>>, Diagnostic> {
    let pool = &builder.dae.pool;
    let known: Vec<Lowered<Option<f64>>> =
        arguments.iter().map(|a| a.map(&mut |e| pool.as_constant(e))).collect();
    builder.calls.functions.output = output(builder);
    let instance = builder.calls.functions.instance(builder.flat, function, &known, span)?;
    if instance.silenced {
        warn_silenced(builder, function, span);
    }
    call_of(builder, (function, instance), arguments, span)
}

/// Expressions that call a function which the interpreter carries out; `None` where it cannot, or
/// where a call that writes is not in an event.
pub(super) fn interpreted_call(
    builder: &mut Builder<'_>,
    function: &Arc<Function>,
    arguments: &[Lowered<Expr>],
    span: Span,
) -> Option<Vec<Lowered<Expr>>> {
    if builder.calls.depth > 0 {
        return None;
    }
    let mut arguments = arguments.to_vec();
    let mut found = interpreted_instance(builder, function, &arguments, span);
    if matches!(&found, Err(e) if e.code == NO_CONSTANT_VALUE)
        && evaluate_whole_numbers(builder, function, &mut arguments)
    {
        found = interpreted_instance(builder, function, &arguments, span);
    }
    let instance = found.ok()?;
    let may_write = builder.calls.functions.may_write
        || builder.place.at_start
        || output(builder) == Output::Written;
    if instance.writes && !may_write {
        return None;
    }
    call_of(builder, (function, instance), arguments, span).ok()
}

fn interpreted_instance(
    builder: &mut Builder<'_>,
    function: &Arc<Function>,
    arguments: &[Lowered<Expr>],
    span: Span,
) -> Result<instances::Instance, Diagnostic> {
    let pool = &builder.dae.pool;
    let known: Vec<Lowered<Option<f64>>> =
        arguments.iter().map(|a| a.map(&mut |e| pool.as_constant(e))).collect();
    builder.calls.functions.interpreted_instance(builder.flat, function, &known, span)
}

/// Expressions that call a compiled function.
fn call_of(
    builder: &mut Builder<'_>,
    (function, instance): (&Arc<Function>, instances::Instance),
    arguments: Vec<Lowered<Expr>>,
    span: Span,
) -> Result<Vec<Lowered<Expr>>, Diagnostic> {
    let mut scalars = instance.passed_of(&arguments);
    if instance.impure {
        // Calls in different places are different calls, though their arguments are the same.
        let site = builder.calls.impure;
        builder.calls.impure += 1;
        scalars.push(builder.dae.pool.constant(f64::from(site)));
    }
    let numbers: Option<Vec<f64>> = match instance.folds {
        true => scalars.iter().map(|e| builder.dae.pool.as_constant(*e)).collect(),
        false => None,
    };
    let folded = numbers.and_then(|numbers| builder.calls.functions.evaluate(&instance, &numbers));
    let pool = &mut builder.dae.pool;
    let mut results = Vec::new();
    match folded {
        Some(values) => results.extend(values.into_iter().map(|value| pool.constant(value))),
        None => {
            let n: usize = instance.outputs.iter().map(|shape| shape.len()).sum();
            results.extend((0..n as u32).map(|at| pool.call(instance.code, at, &scalars)));
            if instance.writes && builder.calls.functions.may_write {
                builder.calls.written.push(pool.call(instance.code, 0, &scalars));
            } else if n == 0 && instance.impure {
                return Err(fault!(
                    NOT_SUPPORTED,
                    "the impure function `{}` is called in a statement that does not use its \
                     values",
                    function.name
                )
                .at(span));
            } else if n == 0 {
                let call = pool.call(instance.code, 0, &scalars);
                builder.assert_call(call, span);
            }
        }
    }
    let mut results = results.into_iter();
    Ok(instance.outputs.iter().map(|s| Lowered::from_scalars(s, &mut results)).collect())
}

/// What a variable of a function holds, or a field of it.
pub(super) fn local_value<T: Copy>(
    locals: &[(Ident, Lowered<T>)],
    path: &str,
    reference: &ComponentReference,
) -> Result<Lowered<T>, Diagnostic> {
    let mut parts = Name::parse(path).parts.into_iter();
    let first = parts.next();
    let found = locals.iter().find(|(name, _)| Some(*name) == first);
    let value = found.map(|(_, value)| value).ok_or_else(|| {
        fault!(UNRESOLVED_REFERENCE, "there is no variable `{path}` in this function")
            .at(reference.span)
    })?;
    parts.try_fold(value, |value, part| field_of(value, part, reference.span)).cloned()
}

/// The type of a variable of a function, or of a field of it.
pub(super) fn component_type(function: &Function, path: &str) -> Option<ValueType> {
    component_of(function, path).map(|component| component.value_type.clone())
}

/// The subscripts of all parts of `v[i].x[j]`, for the array that `v.x` of an array of records is: a part
/// with fewer subscripts than dimensions keeps the others whole (MLS §10.5, §10.6.1).
///
/// # Errors
/// A part before the last one has more subscripts than dimensions.
pub(super) fn subscripts_of<'r>(
    function: &Function,
    reference: &'r ComponentReference,
) -> Result<Cow<'r, [Subscript]>, Diagnostic> {
    let Some((last, _)) = reference.parts.split_last() else { return Ok(Cow::Borrowed(&[])) };
    let mut ranks = Vec::with_capacity(reference.parts.len());
    let mut component: Option<&FunctionComponent> = None;
    for (at, part) in reference.parts.iter().enumerate() {
        component = match component.map(|component| &component.value_type) {
            None if at == 0 => function.variable(part.name),
            Some(ValueType::Record(_, fields)) => fields.get(&part.name),
            _ => None,
        };
        ranks.push(component.map_or(part.subscripts.len(), |component| component.dims.len()));
    }
    let before = &ranks[..ranks.len() - 1];
    if before.iter().all(|rank| *rank == 0) {
        return Ok(Cow::Borrowed(&last.subscripts));
    }
    let mut subscripts = Vec::new();
    for (part, rank) in reference.parts.iter().zip(&ranks) {
        let given = part.subscripts.len();
        if given > *rank {
            let name = part.name;
            return Err(fault!(
                ARRAY_MISMATCH,
                "{given} subscripts for {rank} dimensions of `{name}`"
            )
            .at(reference.span));
        }
        subscripts.extend(part.subscripts.iter().cloned());
        subscripts.extend((given..*rank).map(|_| Subscript::All(reference.span)));
    }
    let is_whole = |subscript: &Subscript| matches!(subscript, Subscript::All(_));
    let needed = subscripts.iter().rposition(|subscript| !is_whole(subscript));
    subscripts.truncate(needed.map_or(0, |last| last + 1));
    Ok(Cow::Owned(subscripts))
}

/// The declaration of a variable of a function, or of a field of it.
fn component_of<'f>(function: &'f Function, path: &str) -> Option<&'f FunctionComponent> {
    let mut parts = Name::parse(path).parts.into_iter();
    let first = parts.next();
    let component = function.variable(first?)?;
    parts.try_fold(component, |component, part| match &component.value_type {
        ValueType::Record(_, fields) => fields.get(&part),
        _ => None,
    })
}
