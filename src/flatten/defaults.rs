//! Inputs that a call leaves out and whose defaults refer to other inputs (MLS §12.4.1): the
//! default with the call's own arguments in place of the inputs is written into the call.

use super::instantiation::Instantiation;
use super::resolve::subscripted;
use crate::eval::Function;
use crate::name::{Ident, Name};
use crate::source::{Span, Spanned};
use crate::syntax::ast::{
    Arguments, ComponentReference, Expression, ExpressionKind, NamedArgument,
};
use crate::syntax::visit::{Rewrite, Visit, rewrite_expression, walk_reference};

impl Instantiation<'_> {
    /// The arguments of a call with such defaults added.
    pub(super) fn with_defaults(
        &self,
        function: &Name,
        mut arguments: Arguments,
        span: Span,
    ) -> Arguments {
        let Some(Some(function)) = self.functions.get(function) else { return arguments };
        if !arguments.iterators.is_empty() {
            return arguments;
        }
        for input in &function.inputs {
            let Some(default) = &input.binding else { continue };
            if given(function, &arguments, input.name).is_some() || !mentions(default, function) {
                continue;
            }
            let mut value = default.clone();
            Substitution { function, arguments: &arguments }.expression(&mut value);
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

fn mentions(default: &Expression, function: &Function) -> bool {
    struct Mentions<'f>(&'f Function, bool);
    impl Visit for Mentions<'_> {
        fn reference(&mut self, reference: &ComponentReference) {
            self.1 |= self.0.inputs.iter().any(|input| reference.parts[0].name == input.name);
            walk_reference(self, reference);
        }
    }
    let mut search = Mentions(function, false);
    search.expression(default);
    search.1
}

/// Puts the arguments of a call in place of the inputs.
struct Substitution<'f> {
    function: &'f Function,
    arguments: &'f Arguments,
}

impl Rewrite for Substitution<'_> {
    fn expression(&mut self, e: &mut Expression) {
        rewrite_expression(self, e);
        let ExpressionKind::Reference(reference) = &e.kind else { return };
        let Some((first, rest)) = reference.parts.split_first() else { return };
        let default = || {
            let input = self.function.inputs.iter().find(|input| input.name == first.name)?;
            input.binding.as_ref().filter(|default| !mentions(default, self.function))
        };
        let argument = given(self.function, self.arguments, first.name).or_else(default);
        let Some(argument) = argument else { return };
        let mut value = subscripted(argument.clone(), first.subscripts.clone(), e.span);
        for part in rest {
            let kind = ExpressionKind::Field { base: Box::new(value), name: part.name };
            value = subscripted(Expression::new(kind, e.span), part.subscripts.clone(), e.span);
        }
        *e = value;
    }
}
