//! Calls: which function a name stands for.

use super::argument::Binding;
use super::errors::{UNKNOWN_FUNCTION, WRONG_ARGUMENTS};
use super::function::Target;
use super::{Callee, Evaluator, Function};
use crate::diag::{At, Diagnostic, Fault, suggest};
use crate::fault;
use crate::functions::{self, Builtin, Meaning};
use crate::name::{Ident, Name};
use crate::source::Span;
use crate::syntax::ast::{self, ComponentReference, ExpressionKind};
use crate::syntax::foreign;
use crate::value::errors::TYPE_MISMATCH;
use crate::value::{Elements, FunctionValue, Value};
use std::sync::Arc;

/// Arguments that have been evaluated.
#[derive(Debug, Clone, Default)]
pub struct Arguments {
    /// Positional arguments.
    pub positional: Vec<Value>,
    /// Named arguments.
    pub named: Vec<(Ident, Value)>,
}

/// Whether a format of C is given, and values after it.
fn has_format(given: &[Option<Value>]) -> bool {
    let Some((Some(Value::String(text)), rest)) = given.split_first() else { return false };
    let letters = text.match_indices('%').map(|(at, _)| {
        text[at + 1..].trim_start_matches(|c: char| c.is_ascii_digit() || ".+-#".contains(c))
    });
    let is_format = |rest: &str| rest.starts_with(['d', 'i', 'f', 'g', 'e', 's', 'G', 'E']);
    letters.into_iter().any(is_format) && rest.iter().any(Option::is_some)
}

impl From<Vec<Value>> for Arguments {
    fn from(positional: Vec<Value>) -> Arguments {
        Arguments { positional, named: Vec::new() }
    }
}

impl Evaluator<'_> {
    /// Calls what the name stands for and returns its outputs.
    pub(super) fn call(
        &mut self,
        function: &ComponentReference,
        arguments: &ast::Arguments,
        span: Span,
    ) -> Result<Vec<Value>, Diagnostic> {
        if !arguments.iterators.is_empty() {
            return self.call_with_iterators(function, arguments, span);
        }
        if let Some(name) = function.as_ident()
            && let Some(Value::Function(value)) = self.scope.get(name)
        {
            let value = value.clone();
            return self.call_value(&value, arguments, span);
        }
        let target = self.target(function)?;
        self.call_target(target, function, arguments, span).map_err(|error| {
            let is_own =
                error.trace.iter().all(|frame| frame.span == span) && span.contains(error.span());
            let is_about_arguments = [WRONG_ARGUMENTS, TYPE_MISMATCH].contains(&error.code);
            let commas = foreign::decimal_commas(&arguments.positional);
            match commas.filter(|_| is_own && is_about_arguments) {
                Some(help) => error.help(help),
                None => error,
            }
        })
    }

    fn call_target(
        &mut self,
        target: Target,
        function: &ComponentReference,
        arguments: &ast::Arguments,
        span: Span,
    ) -> Result<Vec<Value>, Diagnostic> {
        match target {
            Target::Function(function) => {
                let given = self.bound(&function, arguments, &[], span)?;
                self.call_bound(&function, given, span)
            }
            Target::Builtin(header) if header.is_variadic() => {
                self.call_builtin(&header, Vec::new(), span)
            }
            Target::Builtin(header) => {
                let given = self.bound(&header, arguments, &[], span);
                let given = given.inspect_err(|error| self.refuse(&header, arguments, error))?;
                self.call_builtin(&header, given, span)
            }
            Target::Language(entry) => match entry.meaning {
                Meaning::Operator(operator) => self.operator(entry, operator, arguments, span),
                _ => self.call_entry(entry, arguments, span).map(|value| vec![value]),
            },
            Target::Unknown => self.call_type(function, arguments),
        }
    }

    /// Calls with values in place of expressions.
    pub(super) fn call_with(
        &mut self,
        function: &Arc<Function>,
        arguments: Arguments,
        span: Span,
    ) -> Result<Vec<Value>, Diagnostic> {
        let mut binding = Binding::new(function);
        for value in arguments.positional {
            let at = binding.next_positional().at(span)?;
            binding.values[at] = Some(value);
        }
        for (name, value) in arguments.named {
            let at = binding.named(name).at(span)?;
            binding.values[at] = Some(value);
        }
        let given = binding.finish().at(span)?;
        self.call_bound(function, given, span)
    }

    pub(super) fn target(&mut self, reference: &ComponentReference) -> Result<Target, Diagnostic> {
        let address = std::ptr::from_ref(reference).addr();
        if let Some(target) = self.scope.callees.get(&address) {
            return Ok(target.clone());
        }
        let target = match reference.as_ident() {
            Some(name) => {
                let callee = self.host.simple_callee(name);
                self.known_or_of_language(callee, &[name], reference.span)?
            }
            None => self.look_up(&reference.name(), reference.span)?,
        };
        if !self.scope.is_script() {
            self.scope.callees.insert(address, target.clone());
        }
        Ok(target)
    }

    fn look_up(&mut self, name: &Name, span: Span) -> Result<Target, Diagnostic> {
        let callee = self.host.callee(name);
        self.known_or_of_language(callee, &name.parts, span)
    }

    /// What the host says a name stands for, else the function of the language.
    fn known_or_of_language(
        &mut self,
        callee: Result<Option<Callee>, Diagnostic>,
        name: &[Ident],
        span: Span,
    ) -> Result<Target, Diagnostic> {
        let callee = callee.map_err(|error| {
            let name = Name::new(name.iter().copied());
            error.called_from(span, format!("function `{name}`"))
        });
        Ok(match callee? {
            Some(Callee::Function(function)) => Target::Function(function),
            Some(Callee::Builtin(header)) => Target::Builtin(header),
            None => match name {
                [ident] => {
                    functions::find(ident.as_str()).map_or(Target::Unknown, Target::Language)
                }
                _ => Target::Unknown,
            },
        })
    }

    fn call_with_iterators(
        &mut self,
        function: &ComponentReference,
        arguments: &ast::Arguments,
        span: Span,
    ) -> Result<Vec<Value>, Diagnostic> {
        if let (Some(name), [element]) = (function.as_ident(), arguments.positional.as_slice())
            && let Some(value) =
                self.reduction(name.as_str(), element, &arguments.iterators, span)?
        {
            return Ok(vec![value]);
        }
        Err(fault!(
            UNKNOWN_FUNCTION,
            "`{}` does not accept iterators", function.name();
            help: "iterators are accepted by `sum`, `product`, `min`, `max` and `array`"
        )
        .at(span))
    }

    /// Calls a function that was given as an argument.
    fn call_value(
        &mut self,
        value: &FunctionValue,
        arguments: &ast::Arguments,
        span: Span,
    ) -> Result<Vec<Value>, Diagnostic> {
        match self.look_up(&value.name, span)? {
            Target::Function(function) => {
                let given = self.bound(&function, arguments, &value.named, span)?;
                self.call_bound(&function, given, span)
            }
            Target::Builtin(header) => {
                let given = self.bound(&header, arguments, &value.named, span)?;
                self.call_builtin(&header, given, span)
            }
            Target::Language(entry)
                if value.named.is_empty() && !matches!(entry.meaning, Meaning::Operator(_)) =>
            {
                self.call_entry(entry, arguments, span).map(|value| vec![value])
            }
            _ => Err(self.unknown_function(&value.name).at(span)),
        }
    }

    /// `E(i)` for an enumeration `E`: the literal number `i` (MLS §4.9.5.3).
    fn call_type(
        &mut self,
        function: &ComponentReference,
        arguments: &ast::Arguments,
    ) -> Result<Vec<Value>, Diagnostic> {
        if let [argument] = arguments.positional.as_slice()
            && arguments.named.is_empty()
            && let Some(Value::Array(literals)) = self.host.variable(function)?
            && matches!(literals.elements, Elements::Enumeration(_))
        {
            let ordinal = self.expression(argument)?;
            let index = crate::value::Index::from_value(ordinal).at(argument.span)?;
            return literals.select(&[index]).map(|value| vec![value]).at(argument.span);
        }
        Err(self.unknown_function(&function.name()).at(function.span))
    }

    fn unknown_function(&mut self, name: &Name) -> Fault {
        let called = name.to_string();
        let is_variable =
            name.is_simple() && name.first().is_some_and(|first| self.scope.contains(first));
        let subscripts = is_variable.then(|| {
            format!("`{called}` is a variable: write a product as `{called}*(...)`, a subscript as `{called}[1]`")
        });
        let mut known = self.host.function_names();
        known.extend(functions::names().map(str::to_owned));
        fault!(UNKNOWN_FUNCTION, "there is no function `{called}`").help_if(
            subscripts
                .or_else(|| foreign::function_help(&called))
                .or_else(|| foreign::command_help(&called).filter(|_| self.scope.is_script()))
                .or_else(|| suggest::did_you_mean(&called, known.iter().map(String::as_str))),
        )
    }

    /// A function of the values of its arguments.
    pub(super) fn call_entry(
        &mut self,
        entry: &'static Builtin,
        arguments: &ast::Arguments,
        span: Span,
    ) -> Result<Value, Diagnostic> {
        if let Some(named) = arguments.named.first() {
            let fault = fault!(
                WRONG_ARGUMENTS,
                "`{}` accepts only positional arguments", entry.name;
                help: "remove `{} =`", named.name.node
            );
            return Err(fault.at(named.name.span));
        }
        match arguments.positional.as_slice() {
            [only] => {
                let value = self.expression(only)?;
                if let (Meaning::Reduction(reduction), Value::Array(array)) =
                    (entry.meaning, &value)
                    && array.elements.is_empty()
                    && reduction.of_none().is_none()
                {
                    return Ok(self.reduced_nothing(reduction, only, &[]));
                }
                match entry.value(std::slice::from_ref(&value)) {
                    Err(fault) if self.host.overflows() => {
                        infinite(entry, &value).ok_or_else(|| fault.at(span))
                    }
                    result => result.at(span),
                }
            }
            [first, second] => {
                let values = [self.expression(first)?, self.expression(second)?];
                entry.value(&values).at(span)
            }
            all => {
                let values = self.expressions(all)?;
                entry.value(&values).at(span)
            }
        }
    }

    pub(super) fn run_builtin(
        &mut self,
        header: &Arc<Function>,
        mut given: Vec<Option<Value>>,
        span: Span,
    ) -> Result<Vec<Value>, Diagnostic> {
        for (input, value) in header.inputs.iter().zip(&mut given) {
            if let Some(actual) = value.take() {
                *value = Some(reshaped(actual, &input.dims));
            }
        }
        let script = self.host.script();
        let is_followed = script.is_some_and(|script| script.begin_command(header, &given));
        let formatted = has_format(&given);
        let done = self.complete(header, given, span).map_err(|error| match formatted {
            true if error.code == TYPE_MISMATCH => error.help(format!(
                "`{}` has no formats: join Strings with `+`, as in `\"x = \" + String(3)`",
                header.name
            )),
            _ => error,
        });
        let Some(script) = self.host.script() else {
            return Err(
                fault!(UNKNOWN_FUNCTION, "`{}` is a command of scripts", header.name).at(span)
            );
        };
        let done = done.and_then(|values| script.call_builtin(header, values, span, self.scope));
        if is_followed {
            script.end_command(done.as_ref().err());
        }
        done
    }

    /// A builtin is not called because of its arguments: the host learns what can be known of them.
    pub(super) fn refuse(
        &mut self,
        header: &Arc<Function>,
        arguments: &ast::Arguments,
        error: &Diagnostic,
    ) {
        let script = self.host.script();
        let names = script.map_or(&[][..], |script| script.inputs_looked_at(header));
        if names.is_empty() {
            return;
        }
        let positional = header.inputs.iter().zip(&arguments.positional);
        let named = arguments.named.iter().filter_map(|argument| {
            let input = header.inputs.iter().find(|input| input.name == argument.name.node)?;
            Some((input, &argument.value))
        });
        let mut given = vec![None; header.inputs.len()];
        for (input, argument) in positional.chain(named) {
            let at = header.inputs.iter().position(|own| own.name == input.name);
            if let Some(at) = at.filter(|_| names.contains(&input.name.as_str())) {
                let value = self.argument(input, argument);
                given[at] = Some(value.unwrap_or(Value::nothing()));
            }
        }
        if let Some(script) = self.host.script()
            && script.begin_command(header, &given)
        {
            script.end_command(Some(error));
        }
    }
}

/// The value of a function beyond the largest Real.
fn infinite(entry: &Builtin, argument: &Value) -> Option<Value> {
    let (Meaning::Mathematical(function), Value::Real(x)) = (entry.meaning, argument) else {
        return None;
    };
    let function = function.get();
    let value = function.value.of(&[*x]);
    (function.accepts(&[*x]) && value.is_infinite()).then_some(Value::Real(value))
}

/// A row `[1, n]` or column `[n, 1]` as a vector where the built-in expects a vector, and a vector
/// as a row where it expects `[1, n]`.
fn reshaped(value: Value, expected: &[ast::Subscript]) -> Value {
    let is_one = |subscript: &ast::Subscript| match subscript {
        ast::Subscript::Index(size) => size.kind == ExpressionKind::Integer(1),
        ast::Subscript::All(_) => false,
    };
    match value {
        Value::Array(mut array) => {
            match (array.dims.as_slice(), expected) {
                (&[1, size] | &[size, 1], [_]) => array.dims = vec![size],
                (&[size], [first, _]) if is_one(first) => array.dims = vec![1, size],
                _ => {}
            }
            Value::Array(array)
        }
        other => other,
    }
}
