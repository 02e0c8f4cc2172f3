//! Which argument goes to which input (MLS §12.4.1), and how: evaluated, by name, or as a function.

use super::errors::{UNKNOWN_VARIABLE, WRONG_ARGUMENTS};
use super::{Evaluator, Function, FunctionComponent, ValueType};
use crate::diag::{At, Diagnostic, Fault, suggest};
use crate::fault;
use crate::name::{Ident, Name};
use crate::source::Span;
use crate::syntax::ast::{self, Expression, ExpressionKind};
use crate::syntax::print;
use crate::value::{ArrayValue, Elements, FromValue, Value};
use std::sync::Arc;

impl Evaluator<'_> {
    /// Values for the inputs of a function, `None` where nothing is given and a default exists.
    pub(super) fn bound(
        &mut self,
        function: &Arc<Function>,
        arguments: &ast::Arguments,
        given: &[(Ident, Value)],
        span: Span,
    ) -> Result<Vec<Option<Value>>, Diagnostic> {
        let all_positional = given.is_empty() && arguments.named.is_empty();
        if all_positional && arguments.positional.len() == function.inputs.len() {
            let pairs = function.inputs.iter().zip(&arguments.positional);
            return pairs
                .map(|(input, argument)| self.argument(input, argument).map(Some))
                .collect();
        }
        let mut binding = Binding::new(function);
        for (name, value) in given {
            let at = binding.named(*name).at(span)?;
            binding.values[at] = Some(value.clone());
        }
        for argument in &arguments.positional {
            let at = binding.next_positional().at(argument.span)?;
            binding.values[at] = Some(self.argument(&function.inputs[at], argument)?);
        }
        for argument in &arguments.named {
            let at = binding.named(argument.name.node).at(argument.name.span)?;
            binding.values[at] = Some(self.argument(&function.inputs[at], &argument.value)?);
        }
        binding.finish().at(span)
    }

    /// An argument or default as the input expects it: by name, as a function, or evaluated.
    pub(super) fn argument(
        &mut self,
        input: &FunctionComponent,
        argument: &Expression,
    ) -> Result<Value, Diagnostic> {
        match input.value_type {
            ValueType::TypeName | ValueType::VariableName => self.name_argument(input, argument),
            ValueType::Expression => Ok(Value::VariableName(print::expression(argument).into())),
            ValueType::Function => self.function_argument(argument),
            _ => match self.scalar(argument) {
                Some(scalar) => Ok(scalar.into()),
                None => self.expression(argument).map_err(|error| quoted(input, argument, error)),
            },
        }
    }

    /// A name as written, without evaluating it; where a list of names is expected, the vector of
    /// these as Strings.
    fn name_argument(
        &mut self,
        input: &FunctionComponent,
        argument: &Expression,
    ) -> Result<Value, Diagnostic> {
        if !input.dims.is_empty() {
            return self.names(argument);
        }
        if let (ValueType::TypeName, ExpressionKind::Reference(reference)) =
            (&input.value_type, &argument.kind)
            && let Some(name) = reference.as_name()
        {
            return Ok(Value::TypeName(self.type_name_in(&name).unwrap_or(name)));
        }
        let text = self.written(argument)?;
        Ok(match input.value_type {
            ValueType::TypeName => Value::TypeName(Name::parse(&text)),
            _ => Value::VariableName(text),
        })
    }

    /// The name that a variable of a script holds; of an iterator, also as an element of a list of
    /// names, which are Strings.
    fn type_name_in(&self, variable: &Name) -> Option<Name> {
        let ident = variable.is_simple().then(|| variable.first())??;
        let is_iterator = self.scope.iterators.iter().any(|(iterator, _)| *iterator == ident);
        match self.scope.get(ident) {
            Some(Value::TypeName(held)) => Some(held.clone()),
            Some(Value::String(text)) if is_iterator => Some(Name::parse(text)),
            _ => None,
        }
    }

    fn names(&mut self, argument: &Expression) -> Result<Value, Diagnostic> {
        let strings = match &argument.kind {
            ExpressionKind::Array(names) => {
                names.iter().map(|name| self.written(name)).collect::<Result<_, _>>()?
            }
            ExpressionKind::Reference(_) => vec![self.written(argument)?],
            _ => match self.expression(argument)? {
                strings if strings.rank() == 1 => Vec::from_value(strings).at(argument.span)?,
                text => vec![Arc::from_value(text).at(argument.span)?],
            },
        };
        Ok(Value::Array(ArrayValue::vector(Elements::String(strings))))
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

/// The error of an argument that may be meant as Strings, the names that the input expects.
fn quoted(input: &FunctionComponent, argument: &Expression, error: Diagnostic) -> Diagnostic {
    let names = match &argument.kind {
        ExpressionKind::Array(elements) => elements.as_slice(),
        _ => std::slice::from_ref(argument),
    };
    let text = |name: &Expression| match &name.kind {
        ExpressionKind::Reference(_) => Some(format!("\"{}\"", print::expression(name))),
        ExpressionKind::String(_) => Some(print::expression(name)),
        _ => None,
    };
    let strings: Option<Vec<String>> = names.iter().map(text).collect();
    let is_meant = input.value_type == ValueType::String && error.code == UNKNOWN_VARIABLE;
    let Some(strings) = strings.filter(|_| is_meant) else { return error };
    let written = match argument.kind {
        ExpressionKind::Array(_) => format!("{{{}}}", strings.join(", ")),
        _ => strings.join(", "),
    };
    error.help(format!("`{}` expects Strings: write `{written}`", input.name))
}

/// Which value goes to which input.
pub(super) struct Binding<'f> {
    function: &'f Function,
    pub(super) values: Vec<Option<Value>>,
    taken: Vec<bool>,
}

impl<'f> Binding<'f> {
    pub(super) fn new(function: &'f Function) -> Binding<'f> {
        let count = function.inputs.len();
        Binding { function, values: vec![None; count], taken: vec![false; count] }
    }

    /// The input of the next positional argument.
    pub(super) fn next_positional(&mut self) -> Result<usize, Fault> {
        match self.taken.iter().position(|taken| !taken) {
            Some(at) => {
                self.taken[at] = true;
                Ok(at)
            }
            None => Err(fault!(
                WRONG_ARGUMENTS,
                "`{}` takes at most {} arguments", self.function.name, self.taken.len();
                help: "its inputs are {}", self.inputs()
            )),
        }
    }

    pub(super) fn named(&mut self, name: Ident) -> Result<usize, Fault> {
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
                "the input `{name}` of `{}` is specified twice",
                self.function.name
            ));
        }
        self.taken[at] = true;
        Ok(at)
    }

    pub(super) fn finish(self) -> Result<Vec<Option<Value>>, Fault> {
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
                "the input `{}` of `{}` is missing and has no default",
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
