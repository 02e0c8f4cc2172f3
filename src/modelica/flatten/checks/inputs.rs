//! The inputs of a function, as its class declares them, and the arguments that a call gives to them
//! (MLS §12.4.1).

use super::scope::{Component, Scope};
use super::usage;
use crate::diag::Diagnostic;
use crate::fault;
use crate::flatten::lookup::types::Predefined;
use crate::flatten::unknown;
use crate::functions::errors::WRONG_ARGUMENTS;
use crate::name::Ident;
use crate::source::{Span, Spanned};
use crate::syntax::ast::{
    CausalityPrefix, ClassSpecifier, NamedArgument, Restriction, Visibility,
};

/// What a call may give to a function.
pub(super) struct Inputs<'a> {
    function: Scope<'a>,
    inputs: Vec<Component<'a>>,
    /// Whether modifications may give inputs a default.
    is_modified: bool,
}

impl<'a> Inputs<'a> {
    /// The inputs of a function or of the constructor of an external object.
    pub(super) fn of(class: Scope<'a>) -> Option<Inputs<'a>> {
        let function = match class.predefined() {
            Some(Predefined::ExternalObject) => class.own_class(Ident::new("constructor"))?,
            Some(_) => return None,
            None => class,
        };
        if !matches!(function.restriction(), Restriction::Function { .. }) {
            return None;
        }
        let mut inputs: Vec<Component<'a>> = Vec::new();
        let mut is_modified = false;
        let mut lineage: Vec<Scope<'a>> = function.lineage().collect();
        // Inherited inputs come first.
        lineage.rotate_left(1);
        for class in lineage {
            is_modified |= match &class.definition().specifier {
                ClassSpecifier::Short(short) => !short.modification.is_empty(),
                ClassSpecifier::Derivative(_) => return None,
                _ => {
                    let mut extends = class.library.class(class.class).extends.iter();
                    extends.any(|one| !one.modification.is_empty() || !one.excluded.is_empty())
                }
            };
            for component in class.components() {
                let is_new = inputs.iter().all(|known| known.name() != component.name());
                if is_input(&component) && is_new {
                    inputs.push(component);
                }
            }
        }
        Some(Inputs { function, inputs, is_modified })
    }

    /// More positional arguments than inputs.
    pub(super) fn excess(&self, count: usize, span: Span) -> Option<Diagnostic> {
        let most = self.inputs.len();
        (count > most).then(|| {
            fault!(WRONG_ARGUMENTS, "`{}` takes at most {most} arguments", self.function.name();
                help: "its inputs are {}", self.names())
            .at(span)
        })
    }

    /// The first named argument that is not an input.
    pub(super) fn unknown(&self, named: &[NamedArgument]) -> Option<Diagnostic> {
        self.unknown_name(named.iter().map(|argument| argument.name))
    }

    /// The first name that is not one of an input.
    pub(super) fn unknown_name(&self, mut names: impl Iterator<Item = Spanned<Ident>>) -> Option<Diagnostic> {
        let known: Vec<Ident> = self.inputs.iter().map(Component::name).collect();
        let name = names.find(|name| !known.contains(&name.node))?;
        Some(unknown::input(self.function.name(), name.node, &known, name.span))
    }

    /// An input of a predefined type that no argument and no default gives.
    pub(super) fn missing(&self, count: usize, named: &[NamedArgument], span: Span) -> Option<Diagnostic> {
        if self.is_modified || !self.function.library.declared_bases(self.function.class).is_empty()
        {
            // Which input is which depends on the order of inherited ones.
            return None;
        }
        let is_given = |name: Ident| named.iter().any(|argument| argument.name.node == name);
        let has_default = |input: &Component<'_>| {
            let binding = input.declaration.modification.as_ref().map(|one| one.binding.is_some());
            binding == Some(true) || usage::predefined(input).is_none()
        };
        let rest = self.inputs.iter().skip(count);
        let mut open = rest.filter(|input| !is_given(input.name()) && !has_default(input));
        let input = open.next()?.name();
        Some(
            fault!(WRONG_ARGUMENTS, "the input `{input}` of `{}` is missing and has no default",
                self.function.name();
                help: "its inputs are {}", self.names())
            .at(span),
        )
    }

    fn names(&self) -> String {
        let names: Vec<String> =
            self.inputs.iter().map(|input| format!("`{}`", input.name())).collect();
        if names.is_empty() { "none".into() } else { names.join(", ") }
    }
}

/// Whether a component of a function is an input by itself or by its type.
fn is_input(component: &Component<'_>) -> bool {
    let input = Some(CausalityPrefix::Input);
    let of_type = || {
        let class = component.class();
        class.is_some_and(|class| class.unaliased().1.iter().any(|one| one.causality == input))
    };
    component.visibility == Visibility::Public
        && (component.clause.type_prefixes.causality == input || of_type())
}
