//! The inputs of a function, as its class declares them, and the arguments that a call gives to them
//! (MLS §12.4.1).

use super::scope::{Component, Scope};
use crate::diag::Diagnostic;
use crate::fault;
use crate::flatten::lookup::types::Predefined;
use crate::flatten::unknown;
use crate::functions::errors::WRONG_ARGUMENTS;
use crate::name::Ident;
use crate::source::{Span, Spanned};
use crate::syntax::ast::{
    Arguments, CausalityPrefix, ClassSpecifier, Expression, NamedArgument, Restriction,
    VariabilityPrefix, Visibility,
};

/// What a call may give to a function.
pub(super) struct Inputs<'a> {
    function: Scope<'a>,
    inputs: Vec<Component<'a>>,
    /// Whether modifications may give inputs a default.
    is_modified: bool,
    /// Whether one class declares all of them, so that their order is the one written.
    is_ordered: bool,
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
        let mut declaring = 0;
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
            let own = class.components().filter(is_input).count();
            declaring += usize::from(own > 0 || is_redeclared(class));
            for component in class.components() {
                let is_new = inputs.iter().all(|known| known.name() != component.name());
                if is_input(&component) && is_new {
                    inputs.push(component);
                }
            }
        }
        Some(Inputs { function, inputs, is_modified, is_ordered: declaring < 2 })
    }

    /// The components of a record, which its constructor takes (MLS §12.6).
    pub(super) fn of_record(record: Scope<'a>) -> Inputs<'a> {
        let mut inputs = Vec::new();
        let mut declaring = 0;
        for class in record.lineage() {
            let own: Vec<Component<'a>> = class.components().collect();
            declaring += usize::from(!own.is_empty());
            inputs.extend(own);
        }
        // Constants and what is final or protected are not given.
        let is_given = |one: &Component<'_>| {
            let variability = one.clause.type_prefixes.variability;
            one.visibility == Visibility::Public
                && variability != Some(VariabilityPrefix::Constant)
                && !one.clause.prefixes.is_final
                && !one.clause.prefixes.outer
        };
        let is_ordered = declaring < 2 && inputs.iter().all(is_given);
        Inputs { function: record, inputs, is_modified: false, is_ordered }
    }

    /// The arguments of a call with the inputs that they are given to, where this is known.
    pub(super) fn given<'e>(
        &self,
        arguments: &'e Arguments,
    ) -> Vec<(Component<'a>, &'e Expression)> {
        let positional = self.inputs.iter().zip(&arguments.positional);
        let mut given: Vec<_> = positional
            .filter(|_| self.is_ordered)
            .map(|(input, argument)| (*input, argument))
            .collect();
        for argument in &arguments.named {
            let mut inputs = self.inputs.iter();
            let input = inputs.find(|input| input.name() == argument.name.node);
            given.extend(input.map(|input| (*input, &argument.value)));
        }
        given
    }

    /// The first named argument of an input that a positional one gives already.
    pub(super) fn twice<'e>(&self, arguments: &'e Arguments) -> Option<&'e NamedArgument> {
        let count = if self.is_ordered { arguments.positional.len() } else { 0 };
        let is_given =
            |name: Ident| self.inputs.iter().take(count).any(|input| input.name() == name);
        arguments.named.iter().find(|argument| is_given(argument.name.node))
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
    pub(super) fn unknown_name(
        &self,
        mut names: impl Iterator<Item = Spanned<Ident>>,
    ) -> Option<Diagnostic> {
        let known: Vec<Ident> = self.inputs.iter().map(Component::name).collect();
        let name = names.find(|name| !known.contains(&name.node))?;
        Some(unknown::input(self.function.name(), name.node, &known, name.span))
    }

    /// An input of a predefined type that no argument and no default gives.
    pub(super) fn missing(
        &self,
        count: usize,
        named: &[NamedArgument],
        span: Span,
    ) -> Option<Diagnostic> {
        if self.is_modified || !self.function.library.declared_bases(self.function.class).is_empty()
        {
            // Which input is which depends on the order of inherited ones.
            return None;
        }
        let is_given = |name: Ident| named.iter().any(|argument| argument.name.node == name);
        let has_default = |input: &Component<'_>| {
            let binding = input.declaration.modification.as_ref().map(|one| one.binding.is_some());
            binding == Some(true) || input.predefined().is_none()
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

/// Whether a class is `redeclare function extends f`, which has the inputs of another one as well.
fn is_redeclared(class: Scope<'_>) -> bool {
    match &class.definition().specifier {
        ClassSpecifier::Long(long) => long.class_extends.is_some(),
        _ => false,
    }
}

/// The outputs of a function, in order; `None` where this is not known.
pub(super) fn outputs(function: Scope<'_>) -> Option<Vec<Component<'_>>> {
    if !matches!(function.restriction(), Restriction::Function { .. }) || function.is_open() {
        return None;
    }
    let output = Some(CausalityPrefix::Output);
    let mut found = Vec::new();
    for class in function.lineage() {
        let own = class.components().filter(|one| one.clause.type_prefixes.causality == output);
        let own: Vec<Component<'_>> = own.collect();
        let is_derivative = matches!(class.definition().specifier, ClassSpecifier::Derivative(_));
        if is_derivative || is_redeclared(class) || !own.is_empty() && !found.is_empty() {
            return None;
        }
        found.extend(own);
    }
    Some(found)
}
