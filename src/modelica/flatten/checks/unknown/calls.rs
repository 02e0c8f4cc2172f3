//! Called functions and the names and numbers of their arguments (MLS §12.4.1).

use super::NameCheck;
use super::certainty::is_certain;
use super::modified::Modified;
use crate::diag::Diagnostic;
use crate::flatten::checks::inputs::Inputs;
use crate::flatten::checks::scope::Scope;
use crate::flatten::declared::Declared;
use crate::flatten::functions::declared::is_intrinsic;
use crate::flatten::functions::printing::PRINT;
use crate::flatten::unknown;
use crate::functions;
use crate::name::{Ident, Name};
use crate::source::{Span, Spanned};
use crate::syntax::ast::{Arguments, ComponentReference, NamedArgument, Restriction};
use crate::syntax::foreign;

/// The operators of overconstrained connections are functions of this name (MLS §9.4).
const CONNECTIONS: &str = "Connections";

impl<'a> NameCheck<'a, '_> {
    pub(super) fn call(&mut self, function: &ComponentReference, arguments: &Arguments) {
        let name = function.name();
        let Some(called) = self.function(&name, function.span) else {
            self.builtin_call(function, arguments);
            return;
        };
        let is_reduction = !arguments.iterators.is_empty();
        if called.is_open() || is_reduction {
            return;
        }
        if is_record(called) {
            self.errors.extend(unknown_component(called, &arguments.named));
        } else if let Some(inputs) = Inputs::of(called) {
            let count = arguments.positional.len();
            let commas = foreign::decimal_commas(&arguments.positional);
            let wrong = inputs.excess(count, function.span);
            let wrong = wrong.map(|error| commas.into_iter().fold(error, Diagnostic::help));
            let wrong = wrong.or_else(|| inputs.unknown(&arguments.named));
            let wrong = wrong.or_else(|| inputs.missing(count, &arguments.named, function.span));
            self.errors.extend(wrong);
        }
    }

    pub(super) fn partial_application(
        &mut self,
        function: &Name,
        named: &[NamedArgument],
        span: Span,
    ) {
        if let Some(called) = self.function(function, span)
            && !called.is_open()
            && let Some(inputs) = Inputs::of(called)
        {
            self.errors.extend(inputs.unknown(named));
        }
    }

    /// The inputs by which a function is differentiated (MLS §12.7.2).
    pub(super) fn derivative_by(&mut self, of: &Modified<'a>, variables: &[Spanned<Ident>]) {
        if let Modified::Class { class, is_certain: true } = of
            && let Some(inputs) = Inputs::of(*class)
        {
            self.errors.extend(inputs.unknown_name(variables.iter().copied()));
        }
    }

    /// The class that a call means, if nothing replaces it; says so if it means nothing.
    pub(super) fn function(&mut self, name: &Name, span: Span) -> Option<Scope<'a>> {
        let first = name.first()?;
        if self.is_loop_variable(name, first) {
            return None;
        }
        let scope = self.scope.map(|scope| scope.class);
        let parts = self.library.parts_of_reference(scope, name);
        let Some(at) = parts.iter().position(Option::is_none) else {
            return match parts.last().copied().flatten()? {
                Declared::Class(class) if is_certain(self.library, &parts) => {
                    Some(Scope { library: self.library, class })
                }
                _ => None,
            };
        };
        let is_predefined = matches!(parts[0], Some(Declared::Predefined(_)));
        let is_known = at == 0 && self.is_of_language(name) || is_predefined;
        if !is_known && !self.may_be_undeclared(&parts, at) && self.is_first_of_package(name, at) {
            let suggestion = self.library.suggestion(scope, name);
            let known = scope.map_or(Vec::new(), |scope| self.library.component_names(scope));
            self.errors.push(unknown::function(name, &known, suggestion, span));
        }
        None
    }

    /// Whether a name that no class declares is one of a function or an operator of the language, or of
    /// one that other tools have.
    fn is_of_language(&self, name: &Name) -> bool {
        let first = name.first().map_or("", Ident::as_str);
        if name.parts.len() > 1 {
            return first == CONNECTIONS || is_intrinsic(name);
        }
        let is_of_tools = first == PRINT || first == "classDirectory" && !self.library.is_strict();
        functions::is_builtin(first) || first == "rooted" || is_of_tools
    }

    /// A call of a function of the language with another number of arguments than it takes.
    fn builtin_call(&mut self, function: &ComponentReference, arguments: &Arguments) {
        let Some(name) = function.as_ident() else { return };
        let is_declared = || {
            let scope = self.scope.map(|scope| scope.class);
            self.library.parts_of_reference(scope, &name.into())[0].is_some()
        };
        let Some(builtin) = functions::find(name.as_str()) else { return };
        if !arguments.iterators.is_empty() || is_declared() {
            return;
        }
        let is_input = |name: Ident| builtin.inputs.contains(&name.as_str());
        let mut named = arguments.named.iter().map(|argument| argument.name);
        if arguments.named.is_empty() {
            let count = builtin.check_count(arguments.positional.len());
            self.errors.extend(count.err().map(|fault| fault.at(function.span)));
        } else if !builtin.inputs.is_empty()
            && let Some(wrong) = named.find(|name| !is_input(name.node))
        {
            let known: Vec<Ident> = builtin.inputs.iter().map(|input| Ident::new(input)).collect();
            self.errors.push(unknown::input(&name.into(), wrong.node, &known, wrong.span));
        }
    }
}

/// Whether a call is of the constructor of a record without constructors of its own.
fn is_record(class: Scope<'_>) -> bool {
    class.restriction() == Restriction::Record
        && class.lineage().all(|class| class.restriction() != Restriction::OperatorRecord)
}

/// A named argument of a constructor that is not a component of the record.
fn unknown_component(record: Scope<'_>, named: &[NamedArgument]) -> Option<Diagnostic> {
    let argument = named.iter().find(|one| record.component(one.name.node).is_none())?;
    let known = record.library.component_names(record.class);
    Some(unknown::component(record.name(), argument.name.node, &known, argument.name.span))
}
