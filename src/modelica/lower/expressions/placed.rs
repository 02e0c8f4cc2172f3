//! Arguments in the places that an operator or a function of the language has for them.

use crate::eval::{Function, FunctionBody};
use crate::functions::{self, Builtin};
use crate::syntax::ast::{Arguments, Expression, ExpressionKind};
use std::borrow::Cow;

/// The arguments in the order of the entry's inputs: `homotopy(actual = a, simplified = b)`.
/// Arguments by name that it does not have are left out.
pub(super) fn of_operator<'a>(entry: &Builtin, arguments: &'a Arguments) -> Cow<'a, [Expression]> {
    if entry.inputs.is_empty() || arguments.named.is_empty() {
        return Cow::Borrowed(&arguments.positional);
    }
    let after = entry.inputs.iter().skip(arguments.positional.len());
    let named = after.map_while(|input| {
        let named = arguments.named.iter().find(|argument| argument.name.node == *input)?;
        Some(named.value.clone())
    });
    Cow::Owned(arguments.positional.iter().cloned().chain(named).collect())
}

/// The function of the language that a function with `external "builtin"` stands for (MLS §12.9),
/// and the arguments of the call in the order of that function's.
pub(super) fn of_builtin(
    user: &Function,
    arguments: &Arguments,
) -> Option<(&'static Builtin, Vec<Expression>)> {
    let FunctionBody::External(external) = &user.body else { return None };
    if external.language.as_deref() != Some("builtin") {
        return None;
    }
    let called = external.function.as_ref()?.node;
    let known = functions::find(called.as_str())?;
    let given = |argument: &Expression| {
        let ExpressionKind::Reference(reference) = &argument.kind else { return None };
        let name = reference.as_ident()?;
        let at = user.inputs.iter().position(|input| input.name == name)?;
        let named = arguments.named.iter().find(|argument| argument.name.node == name);
        arguments.positional.get(at).or(named.map(|named| &named.value)).cloned()
    };
    let placed: Option<Vec<Expression>> = external.arguments.iter().map(given).collect();
    Some((known, placed?))
}
