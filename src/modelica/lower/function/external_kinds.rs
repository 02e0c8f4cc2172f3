//! Which functions are external, and what their calls need (MLS §12.9).

use crate::eval::{Function, FunctionBody, FunctionComponent, ValueType, c_function};
use crate::external::Effect;
use crate::name::Name;
use crate::syntax::ast;
use crate::syntax::visit::{Visit, walk_reference};
use indexmap::IndexMap;
use rustc_hash::FxHashSet;
use std::sync::Arc;

/// The external name of a function.
fn external_name(function: &Function, clause: &ast::External) -> String {
    c_function::external_name(function, clause).to_string()
}

/// Why a function that is external cannot be compiled, if it cannot.
pub(super) fn refusal(function: &Function) -> Option<String> {
    let FunctionBody::External(clause) = &function.body else { return None };
    let name = external_name(function, clause);
    let takes_strings =
        |i: &FunctionComponent| i.value_type == ValueType::String && !i.dims.is_empty();
    match c_function::in_rust(function, clause) {
        Some(_) if function.inputs.iter().any(takes_strings) => {
            Some(format!("is the external function `{name}`, which takes arrays of Strings"))
        }
        None if c_function::brings_code(clause) => None,
        None => Some(format!(
            "is the external function `{name}`, which this program does not implement"
        )),
        Some(entry) if entry.effect == Effect::Outside => Some(format!(
            "is the external function `{name}`, whose values change without a change of its \
             arguments"
        )),
        Some(_) => None,
    }
}

/// Whether a function is external and needs its Strings: all but one that fails with a message,
/// which may be unknown in parts.
pub(super) fn reads_strings(function: &Function) -> bool {
    matches!(function.body, FunctionBody::External(_)) && !fails(function)
}

/// What calls of a function do besides giving results, itself or by what it calls.
pub(super) fn effect_of(function: &Function, all: &IndexMap<Name, Arc<Function>>) -> Effect {
    let mut search = Effects { all, seen: FxHashSet::default(), effect: Effect::None };
    search.function(function);
    search.effect
}

/// Looks at all functions that a function calls.
struct Effects<'a> {
    all: &'a IndexMap<Name, Arc<Function>>,
    seen: FxHashSet<Name>,
    effect: Effect,
}

impl Effects<'_> {
    fn function(&mut self, function: &Function) {
        let components = function.outputs.iter().chain(&function.locals);
        components.filter_map(|c| c.binding.as_ref()).for_each(|binding| self.expression(binding));
        match &function.body {
            FunctionBody::Algorithm(statements) => {
                statements.iter().for_each(|statement| self.statement(statement));
            }
            FunctionBody::External(clause) => {
                let own = match c_function::in_rust(function, clause) {
                    // What it learns of files is what the simulation has of them.
                    Some(entry) if entry.effect == Effect::Outside => Effect::State,
                    Some(entry) => entry.effect,
                    None if function.outputs.is_empty() => Effect::Writes,
                    None if function.impure => Effect::State,
                    None => Effect::None,
                };
                let rank = |effect| [Effect::None, Effect::State].iter().position(|e| *e == effect);
                if rank(own).unwrap_or(2) > rank(self.effect).unwrap_or(2) {
                    self.effect = own;
                }
            }
            FunctionBody::PartialDerivative { .. } | FunctionBody::RecordConstructor => {}
        }
    }
}

impl Visit for Effects<'_> {
    fn reference(&mut self, reference: &ast::ComponentReference) {
        walk_reference(self, reference);
        let name = reference.name();
        if let Some(function) = self.all.get(&name)
            && self.seen.insert(name)
        {
            self.function(function);
        }
    }
}

/// Whether external objects go in or out: such a call is not the number that it returns.
pub(super) fn handles_objects(function: &Function) -> bool {
    function.inputs.iter().chain(&function.outputs).any(is_object)
}

pub(super) fn is_object(component: &FunctionComponent) -> bool {
    matches!(component.value_type, ValueType::ExternalObject(_))
}

/// Whether a function writes, and its only output says that it has: see [`Entry::confirms`].
///
/// [`Entry::confirms`]: crate::external::Entry::confirms
pub(in crate::lower) fn confirms(function: &Function) -> bool {
    let FunctionBody::External(clause) = &function.body else { return false };
    let is_confirmed = c_function::in_rust(function, clause).is_some_and(|entry| entry.confirms);
    is_confirmed && clause.output.is_some() && function.outputs.len() == 1
}

/// Whether a function does nothing but to end the simulation with its first argument, as
/// `Modelica.Utilities.Streams.error` does.
pub(in crate::lower) fn fails(function: &Function) -> bool {
    match &function.body {
        FunctionBody::External(clause) => external_name(function, clause) == "ModelicaError",
        FunctionBody::Algorithm(statements) => match statements.as_slice() {
            [statement] => asserts_nothing_but(function, &statement.kind),
            _ => false,
        },
        _ => false,
    }
}

/// `assert(false, string)` with the first input.
fn asserts_nothing_but(function: &Function, statement: &ast::StatementKind) -> bool {
    let ast::StatementKind::Call(call) = statement else { return false };
    let ast::ExpressionKind::Call { function: called, arguments } = &call.kind else {
        return false;
    };
    let [condition, message, level @ ..] = arguments.positional.as_slice() else { return false };
    let is_input = |name| function.inputs.first().is_some_and(|input| input.name == name);
    // The second level is the error.
    let is_error = level.iter().all(|level| level.kind == ast::ExpressionKind::Integer(2));
    called.as_ident().is_some_and(|name| name == "assert")
        && arguments.named.is_empty()
        && condition.kind == ast::ExpressionKind::Boolean(false)
        && is_error
        && match &message.kind {
            ast::ExpressionKind::Reference(reference) => reference.as_ident().is_some_and(is_input),
            _ => false,
        }
}

/// Whether a function does nothing but to print its first argument.
pub(in crate::lower) fn prints(function: &Function) -> bool {
    match &function.body {
        FunctionBody::External(clause) => matches!(
            external_name(function, clause).as_str(),
            "ModelicaMessage" | "ModelicaWarning" | "ModelicaInternal_print"
        ),
        _ => false,
    }
}
