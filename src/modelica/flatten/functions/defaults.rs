//! Inputs that a call leaves out and whose defaults refer to other inputs or, in a function with a
//! modifier, to variables of the model (MLS §12.4.1): the default with the call's own arguments in
//! place of the inputs is written into the call. So is the name of the instance that calls, for
//! defaults that ask for it (MLS §3.7.4.4).

use crate::eval::Function;
use crate::flatten::flat_expression::subscripted;
use crate::flatten::functions::table::FunctionTable;
use crate::name::{Ident, Name};
use crate::source::{Span, Spanned};
use crate::syntax::ast::{Arguments, Expression, ExpressionKind, NamedArgument};
use crate::syntax::visit::{Rewrite, Visit, rewrite_expression, walk_expression};
use std::sync::Arc;

impl FunctionTable {
    /// The arguments of a call with such defaults added.
    pub(crate) fn with_defaults(
        &self,
        function: &Name,
        mut arguments: Arguments,
        instance: Option<&str>,
        span: Span,
    ) -> Arguments {
        let Some(Some(function)) = self.table.get(function) else { return arguments };
        if !arguments.iterators.is_empty() {
            return arguments;
        }
        for input in &function.inputs {
            let Some(default) = &input.binding else { continue };
            if given(function, &arguments, input.name).is_some() || !has_references(default) {
                continue;
            }
            let mut value = default.clone();
            let within = vec![input.name];
            let arguments_given = &arguments;
            Substitution { function, arguments: arguments_given, instance, within }
                .expression(&mut value);
            let name = Spanned { node: input.name, span };
            arguments.named.push(NamedArgument { name, value });
        }
        arguments
    }
}

/// The argument that a call gives to an input.
fn given<'e>(function: &Function, arguments: &'e Arguments, name: Ident) -> Option<&'e Expression> {
    let at = function.inputs.iter().position(|input| input.name == name)?;
    let named = || arguments.named.iter().find(|argument| argument.name.node == name);
    arguments.positional.get(at).or_else(|| named().map(|argument| &argument.value))
}

/// Whether a default needs other inputs, or variables of the model from which a modifier of the
/// function took it; constants are values by now.
fn has_references(default: &Expression) -> bool {
    struct References(bool);
    impl Visit for References {
        fn expression(&mut self, e: &Expression) {
            self.0 |= matches!(e.kind, ExpressionKind::Reference(_)) || asks_for_instance(e);
            walk_expression(self, e);
        }
    }
    let mut search = References(false);
    search.expression(default);
    search.0
}

/// `getInstanceName()`
fn asks_for_instance(e: &Expression) -> bool {
    match &e.kind {
        ExpressionKind::Call { function, .. } => {
            function.as_ident().is_some_and(|name| name == "getInstanceName")
        }
        _ => false,
    }
}

/// Puts the arguments of a call in place of the inputs; an input that the call leaves out as well
/// stands for its default, in which the same is done.
struct Substitution<'f> {
    function: &'f Function,
    arguments: &'f Arguments,
    /// The instance that calls, if that is known.
    instance: Option<&'f str>,
    /// The inputs whose defaults led here: one that needs itself stays.
    within: Vec<Ident>,
}

impl Substitution<'_> {
    /// What an input stands for in this call.
    fn meaning(&self, name: Ident) -> Option<Expression> {
        if let Some(argument) = given(self.function, self.arguments, name) {
            return Some(argument.clone());
        }
        let input = self.function.inputs.iter().find(|input| input.name == name)?;
        let mut default = input.binding.clone()?;
        if has_references(&default) {
            if self.within.contains(&name) {
                return None;
            }
            let within = self.within.iter().copied().chain([name]).collect();
            Substitution { within, ..*self }.expression(&mut default);
        }
        Some(default)
    }
}

impl Rewrite for Substitution<'_> {
    fn expression(&mut self, e: &mut Expression) {
        if let (Some(instance), true) = (self.instance, asks_for_instance(e)) {
            e.kind = ExpressionKind::String(instance.into());
            return;
        }
        rewrite_expression(self, e);
        let ExpressionKind::Reference(reference) = &e.kind else { return };
        let Some((first, rest)) = reference.parts.split_first() else { return };
        let Some(meaning) = self.meaning(first.name) else { return };
        let mut value = subscripted(meaning, first.subscripts.clone(), e.span);
        for part in rest {
            let kind = ExpressionKind::Field { base: Arc::new(value), name: part.name };
            value = subscripted(Expression::new(kind, e.span), part.subscripts.clone(), e.span);
        }
        *e = value;
    }
}
