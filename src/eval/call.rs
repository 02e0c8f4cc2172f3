//! Calls: which function a name stands for, and which argument goes to which input (MLS §12.4.1) —
//! for built-ins and user functions alike.

use super::errors::{UNKNOWN_FUNCTION, WRONG_ARGUMENTS};
use super::{Callee, Evaluator, Function, ValueType, intrinsics, special};
use crate::diag::{At, Diagnostic, Fault, suggest};
use crate::fault;
use crate::name::{Ident, Name};
use crate::source::Span;
use crate::syntax::ast::{self, ComponentReference, Expression, ExpressionKind};
use crate::syntax::print;
use crate::value::{ArrayValue, Elements, FunctionValue, Value};
use std::sync::Arc;

/// Arguments that have been evaluated.
#[derive(Debug, Clone, Default)]
pub struct Arguments {
    /// Positional arguments.
    pub positional: Vec<Value>,
    /// Named arguments.
    pub named: Vec<(Ident, Value)>,
}

impl From<Vec<Value>> for Arguments {
    fn from(positional: Vec<Value>) -> Arguments {
        Arguments { positional, named: Vec::new() }
    }
}

/// What a called name stands for.
#[derive(Clone)]
pub(super) enum Target {
    Function(Arc<Function>),
    Builtin(Arc<Function>),
    /// An operator whose arguments are not simply evaluated.
    Special(special::Special),
    Intrinsic(&'static intrinsics::Entry),
    Unknown,
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
        match self.target(function)? {
            Target::Function(function) => {
                let given = self.bound(&function, arguments, &[], span)?;
                self.call_bound(&function, given, span)
            }
            Target::Builtin(header) if header.is_variadic() => {
                self.expressions(&arguments.positional)?;
                for argument in &arguments.named {
                    self.expression(&argument.value)?;
                }
                self.call_builtin(&header, Vec::new(), span)
            }
            Target::Builtin(header) => {
                let given = self.bound(&header, arguments, &[], span)?;
                self.call_builtin(&header, given, span)
            }
            Target::Special(special) => self.special(special, arguments, span),
            Target::Intrinsic(entry) => {
                self.call_entry(entry, arguments, span).map(|value| vec![value])
            }
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

    fn target(&mut self, reference: &ComponentReference) -> Result<Target, Diagnostic> {
        let address = std::ptr::from_ref(reference).addr();
        if let Some(target) = self.scope.callees.get(&address) {
            return Ok(target.clone());
        }
        let target = self.look_up(&reference.name(), reference.span)?;
        if !self.scope.is_script() {
            self.scope.callees.insert(address, target.clone());
        }
        Ok(target)
    }

    fn look_up(&mut self, name: &Name, span: Span) -> Result<Target, Diagnostic> {
        Ok(match self.host.callee(name).at(span)? {
            Some(Callee::Function(function)) => Target::Function(function),
            Some(Callee::Builtin(header)) => Target::Builtin(header),
            None => match name.parts.as_slice() {
                [ident] => special::find(ident.as_str())
                    .map(Target::Special)
                    .or_else(|| intrinsics::find(ident.as_str()).map(Target::Intrinsic))
                    .unwrap_or(Target::Unknown),
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
            "`{}` takes no iterators", function.name();
            help: "`sum`, `product`, `min`, `max` and `array` do"
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
            Target::Intrinsic(entry) if value.named.is_empty() => {
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
        let wanted = name.to_string();
        let mut known = self.host.function_names();
        known.extend(intrinsics::intrinsic_names().map(str::to_owned));
        fault!(UNKNOWN_FUNCTION, "there is no function `{wanted}`")
            .help_if(suggest::did_you_mean(&wanted, known.iter().map(String::as_str)))
    }

    fn call_entry(
        &mut self,
        entry: &'static intrinsics::Entry,
        arguments: &ast::Arguments,
        span: Span,
    ) -> Result<Value, Diagnostic> {
        if let Some(named) = arguments.named.first() {
            let fault = fault!(
                WRONG_ARGUMENTS,
                "`{}` takes positional arguments only", entry.name;
                help: "leave out `{} =`", named.name.node
            );
            return Err(fault.at(named.name.span));
        }
        match arguments.positional.as_slice() {
            [only] => {
                let value = self.expression(only)?;
                entry.call(std::slice::from_ref(&value)).at(span)
            }
            [first, second] => {
                let values = [self.expression(first)?, self.expression(second)?];
                entry.call(&values).at(span)
            }
            all => {
                let values = self.expressions(all)?;
                entry.call(&values).at(span)
            }
        }
    }

    fn call_builtin(
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
        let values = self.complete(header, given, span)?;
        self.host.call_builtin_among(header, values, span, self.scope)
    }

    /// Values for the inputs of a function, `None` where nothing is given and a default exists.
    fn bound(
        &mut self,
        function: &Arc<Function>,
        arguments: &ast::Arguments,
        given: &[(Ident, Value)],
        span: Span,
    ) -> Result<Vec<Option<Value>>, Diagnostic> {
        let mut binding = Binding::new(function);
        for (name, value) in given {
            let at = binding.named(*name).at(span)?;
            binding.values[at] = Some(value.clone());
        }
        for argument in &arguments.positional {
            let at = binding.next_positional().at(argument.span)?;
            binding.values[at] = Some(self.argument(function, at, argument)?);
        }
        for argument in &arguments.named {
            let at = binding.named(argument.name.node).at(argument.name.span)?;
            binding.values[at] = Some(self.argument(function, at, &argument.value)?);
        }
        binding.finish().at(span)
    }

    /// An argument as the input wants it: by name, as a function, or evaluated.
    fn argument(
        &mut self,
        function: &Function,
        at: usize,
        argument: &Expression,
    ) -> Result<Value, Diagnostic> {
        let input = &function.inputs[at];
        match input.value_type {
            ValueType::TypeName | ValueType::VariableName => {
                self.name_argument(&input.value_type, argument)
            }
            ValueType::Function => self.function_argument(argument),
            _ => self.expression(argument),
        }
    }

    /// A name as written, without looking at what it stands for; of a list of names the array of
    /// their texts.
    fn name_argument(
        &mut self,
        wanted: &ValueType,
        argument: &Expression,
    ) -> Result<Value, Diagnostic> {
        if let ExpressionKind::Array(names) = &argument.kind {
            let texts = names.iter().map(|name| self.written(name)).collect::<Result<_, _>>()?;
            return Ok(Value::Array(ArrayValue::vector(Elements::String(texts))));
        }
        if let (ValueType::TypeName, ExpressionKind::Reference(reference)) =
            (wanted, &argument.kind)
            && let Some(name) = reference.as_name()
        {
            return Ok(Value::TypeName(name));
        }
        match (wanted, self.written(argument)?) {
            (ValueType::TypeName, text) => Ok(Value::TypeName(Name::parse(&text))),
            (_, text) => Ok(Value::VariableName(text)),
        }
    }

    /// `x`, `a.b[2]`, `der(x)` as written; the text of a String; the name in the value of anything
    /// else.
    fn written(&mut self, argument: &Expression) -> Result<Arc<str>, Diagnostic> {
        match &argument.kind {
            ExpressionKind::Reference(_) => Ok(print::expression(argument).into()),
            ExpressionKind::Call { function, .. }
                if function.as_ident().is_some_and(|name| name == "der") =>
            {
                Ok(print::expression(argument).into())
            }
            _ => match self.expression(argument)? {
                Value::String(text) | Value::VariableName(text) => Ok(text),
                Value::TypeName(name) => Ok(name.to_string().into()),
                other => Err(fault!(
                    WRONG_ARGUMENTS,
                    "expected a name, got a value of type {}",
                    other.type_name()
                )
                .at(argument.span)),
            },
        }
    }

    fn function_argument(&mut self, argument: &Expression) -> Result<Value, Diagnostic> {
        if let ExpressionKind::Reference(reference) = &argument.kind
            && let Some(name) = reference.as_name()
        {
            return self.partial_application(&name, &[]);
        }
        self.expression(argument)
    }
}

/// Which value goes to which input.
struct Binding<'f> {
    function: &'f Function,
    values: Vec<Option<Value>>,
    taken: Vec<bool>,
}

impl<'f> Binding<'f> {
    fn new(function: &'f Function) -> Binding<'f> {
        let count = function.inputs.len();
        Binding { function, values: vec![None; count], taken: vec![false; count] }
    }

    /// The input of the next positional argument.
    fn next_positional(&mut self) -> Result<usize, Fault> {
        match self.taken.iter().position(|taken| !taken) {
            Some(at) => {
                self.taken[at] = true;
                Ok(at)
            }
            None => Err(fault!(
                WRONG_ARGUMENTS,
                "`{}` takes {} arguments at most", self.function.name, self.taken.len();
                help: "its inputs are {}", self.inputs()
            )),
        }
    }

    fn named(&mut self, name: Ident) -> Result<usize, Fault> {
        let inputs = &self.function.inputs;
        let Some(at) = inputs.iter().position(|input| input.name == name) else {
            let names = inputs.iter().map(|input| input.name.as_str());
            return Err(fault!(WRONG_ARGUMENTS, "`{}` has no input `{name}`", self.function.name)
                .help_if(suggest::did_you_mean(name.as_str(), names))
                .help(format!("its inputs are {}", self.inputs())));
        };
        if self.taken[at] {
            return Err(fault!(
                WRONG_ARGUMENTS,
                "the input `{name}` of `{}` is given twice",
                self.function.name
            ));
        }
        self.taken[at] = true;
        Ok(at)
    }

    fn finish(self) -> Result<Vec<Option<Value>>, Fault> {
        let missing = self
            .function
            .inputs
            .iter()
            .zip(&self.taken)
            .find(|(input, taken)| !**taken && input.binding.is_none());
        match missing {
            None => Ok(self.values),
            Some((input, _)) => Err(fault!(
                WRONG_ARGUMENTS,
                "the input `{}` of `{}` is not given and has no default",
                input.name, self.function.name;
                help: "its inputs are {}", self.inputs()
            )),
        }
    }

    fn inputs(&self) -> String {
        let names: Vec<String> =
            self.function.inputs.iter().map(|input| format!("`{}`", input.name)).collect();
        if names.is_empty() { "none".into() } else { names.join(", ") }
    }
}

/// A row `[1, n]` or column `[n, 1]` as a vector where the built-in wants a vector, and a vector as
/// a row where it wants `[1, n]`.
fn reshaped(value: Value, wanted: &[ast::Subscript]) -> Value {
    let is_one = |subscript: &ast::Subscript| match subscript {
        ast::Subscript::Index(size) => size.kind == ExpressionKind::Integer(1),
        ast::Subscript::All(_) => false,
    };
    match value {
        Value::Array(mut array) => {
            match (array.dims.as_slice(), wanted) {
                (&[1, size] | &[size, 1], [_]) => array.dims = vec![size],
                (&[size], [first, _]) if is_one(first) => array.dims = vec![1, size],
                _ => {}
            }
            Value::Array(array)
        }
        other => other,
    }
}
