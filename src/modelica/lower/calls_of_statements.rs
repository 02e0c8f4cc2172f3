//! Calls in statements: `(a, , b) := f(x)`, `assert(…)` and calls of functions without use of their
//! values.

use super::errors::{ARRAY_MISMATCH, NOT_SUPPORTED, UNRESOLVED_REFERENCE};
use super::expressions::{Lowered, Lowering, Target, nth};
use super::function::fails;
use crate::diag::Diagnostic;
use crate::eval::Function;
use crate::execute::Targets;
use crate::fault;
use crate::source::Span;
use crate::syntax::ast::{Arguments, ComponentReference, Expression, ExpressionKind};
use std::sync::Arc;

/// The arguments of `assert`.
pub(super) struct AssertArguments<'s> {
    pub(super) condition: &'s Expression,
    pub(super) message: Option<&'s Expression>,
    pub(super) level: Option<&'s Expression>,
}

impl<'s> AssertArguments<'s> {
    pub(super) fn new(
        arguments: &'s Arguments,
        span: Span,
    ) -> Result<AssertArguments<'s>, Diagnostic> {
        let Some(condition) = nth(arguments, 0, "condition") else {
            return Err(fault!(ARRAY_MISMATCH, "`assert` needs a condition").at(span));
        };
        let (message, level) = (nth(arguments, 1, "message"), nth(arguments, 2, "level"));
        Ok(AssertArguments { condition, message, level })
    }
}

/// What a call as a statement of a function does.
pub(super) enum CallStatement<'s> {
    /// It checks a condition.
    Assert(AssertArguments<'s>),
    /// It fails with a message.
    Fail(Option<&'s Expression>),
    /// It calls a function whose outputs are not used.
    Call(Arc<Function>, &'s Arguments),
}

impl<'s> CallStatement<'s> {
    /// What a call does where functions have these names.
    pub(super) fn new(
        target: &impl Target,
        call: &'s Expression,
    ) -> Result<CallStatement<'s>, Diagnostic> {
        let ExpressionKind::Call { function, arguments } = &call.kind else {
            return Err(fault!(NOT_SUPPORTED, "this is not a statement").at(call.span));
        };
        if function.as_ident().is_some_and(|name| name == "assert") {
            return AssertArguments::new(arguments, call.span).map(CallStatement::Assert);
        }
        let user = called(target, function)?;
        Ok(match fails(&user) {
            true => CallStatement::Fail(nth(arguments, 0, "string")),
            false => CallStatement::Call(user, arguments),
        })
    }
}

fn called(
    target: &impl Target,
    function: &ComponentReference,
) -> Result<Arc<Function>, Diagnostic> {
    let name = function.name();
    target.function(&name).ok_or_else(|| {
        fault!(UNRESOLVED_REFERENCE, "there is no function `{name}`").at(function.span)
    })
}

/// Variables with the outputs that are assigned to them.
type AssignedOutputs<'t, S> = Vec<(&'t ComponentReference, Lowered<S>)>;

/// The outputs that a `call` gives, with the variables that they are assigned to.
pub(super) fn assigned_outputs<'t, T: Target>(
    lowering: &mut Lowering<'_, T>,
    targets: &'t Targets,
    value: &Expression,
    call: impl FnOnce(
        &mut Lowering<'_, T>,
        &Arc<Function>,
        &Arguments,
    ) -> Result<Vec<Lowered<T::Scalar>>, Diagnostic>,
) -> Result<AssignedOutputs<'t, T::Scalar>, Diagnostic> {
    let ExpressionKind::Call { function, arguments } = &value.kind else {
        return Err(fault!(
            NOT_SUPPORTED,
            "a list of variables on the left side needs a function call on the right side"
        )
        .at(value.span));
    };
    let user = called(lowering.target, function)?;
    let outputs = call(lowering, &user, arguments)?;
    if targets.len() > outputs.len() {
        let (name, n) = (function.name(), outputs.len());
        return Err(fault!(ARRAY_MISMATCH, "`{name}` has {n} outputs").at(value.span));
    }
    let pairs = targets.iter().zip(outputs);
    Ok(pairs.filter_map(|(target, output)| Some((target.as_ref()?, output))).collect())
}
