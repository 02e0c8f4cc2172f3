//! Operators whose arguments are not simply evaluated, or that take named ones (MLS §3.7).

use super::Evaluator;
use super::errors::{ASSERTION_FAILED, MODEL_ONLY, TERMINATED, WRONG_ARGUMENTS};
use crate::diag::{At, Diagnostic, Fault};
use crate::fault;
use crate::functions::{Builtin, Operator};
use crate::name::Ident;
use crate::source::Span;
use crate::syntax::ast::{Arguments, Expression, ExpressionKind};
use crate::value::errors::{DOMAIN_ERROR, TYPE_MISMATCH};
use crate::value::{FromValue, Value, format};

impl Evaluator<'_> {
    /// The outputs of an operator.
    pub(super) fn operator(
        &mut self,
        entry: &'static Builtin,
        operator: Operator,
        arguments: &Arguments,
        span: Span,
    ) -> Result<Vec<Value>, Diagnostic> {
        let one = |value: Value| vec![value];
        match operator {
            Operator::Size => self.size(entry, arguments, span).map(one),
            Operator::NumberOfDimensions => {
                let [array] = taken(arguments, entry, span)?;
                let array = given(array, span)?;
                Ok(one(Value::Integer(self.dims(array)?.len() as i64)))
            }
            Operator::NoEvent | Operator::Pure => {
                let [value] = taken(arguments, entry, span)?;
                self.expression(given(value, span)?).map(one)
            }
            Operator::Smooth => {
                let [_, value] = taken(arguments, entry, span)?;
                self.expression(given(value, span)?).map(one)
            }
            Operator::Homotopy => {
                let [actual, _] = taken(arguments, entry, span)?;
                self.expression(given(actual, span)?).map(one)
            }
            Operator::Text => self.text(arguments, span).map(one),
            Operator::Assert => self.assertion(entry, arguments, span).map(|()| Vec::new()),
            Operator::Terminate => {
                let [message] = taken(arguments, entry, span)?;
                let text = String::from_value(self.expression(given(message, span)?)?).at(span)?;
                Err(Fault::new(TERMINATED, text).at(span))
            }
            Operator::SemiLinear | Operator::Ordinal => {
                self.call_entry(entry, arguments, span).map(one)
            }
            Operator::InTime(_) => {
                let message = format!("`{}` is allowed only in models", entry.name);
                Err(Fault::new(MODEL_ONLY, message).at(span))
            }
        }
    }

    /// `size(A)` is a vector, `size(A, i)` a number (MLS §10.3.1).
    fn size(
        &mut self,
        entry: &Builtin,
        arguments: &Arguments,
        span: Span,
    ) -> Result<Value, Diagnostic> {
        let [array, dimension] = taken(arguments, entry, span)?;
        let dims = self.dims(given(array, span)?)?;
        let Some(dimension) = dimension else {
            return Ok(dims.into_iter().map(|size| size as i64).collect::<Vec<i64>>().into());
        };
        let dimension_index = i64::from_value(self.expression(dimension)?).at(dimension.span)?;
        let found =
            usize::try_from(dimension_index).ok().and_then(|at| dims.get(at.checked_sub(1)?));
        match found {
            Some(size) => Ok(Value::Integer(*size as i64)),
            None => Err(fault!(
                DOMAIN_ERROR,
                "there is no dimension {dimension_index}: the array has {}",
                dims.len()
            )
            .at(dimension.span)),
        }
    }

    /// The sizes of an expression; a variable is not copied for that, and need not have a value.
    fn dims(&mut self, expression: &Expression) -> Result<Vec<usize>, Diagnostic> {
        if let ExpressionKind::Reference(reference) = &expression.kind
            && let Some(sizes) = self.sizes_of(reference)?
        {
            return Ok(sizes);
        }
        self.expression(expression).map(|value| value.dims().to_vec())
    }

    /// `String(x, …)` (MLS §3.7.1)
    fn text(&mut self, arguments: &Arguments, span: Span) -> Result<Value, Diagnostic> {
        let Some(first) = arguments.positional.first() else {
            return Err(Fault::new(WRONG_ARGUMENTS, "`String` needs a value").at(span));
        };
        let value = self.expression(first)?;
        let is_real = matches!(value, Value::Real(_));
        let names: &[&str] = match is_real {
            true => &["significantDigits", "minimumLength", "leftJustified"],
            false => &["minimumLength", "leftJustified"],
        };
        let mut options = TextOptions::default();
        let positional = arguments.positional[1..].iter();
        let mut listed: Vec<(Ident, &Expression)> = Vec::new();
        for (at, option) in positional.enumerate() {
            let is_format = at == 0 && arguments.positional.len() == 2;
            let name = match names.get(at) {
                Some(_) if is_format && matches!(option.kind, ExpressionKind::String(_)) => {
                    "format"
                }
                Some(name) => name,
                None => {
                    let fault = Fault::new(WRONG_ARGUMENTS, "too many arguments for `String`");
                    return Err(fault.at(option.span));
                }
            };
            listed.push((Ident::new(name), option));
        }
        listed.extend(arguments.named.iter().map(|named| (named.name.node, &named.value)));
        for (name, option) in listed {
            let setting = self.expression(option)?;
            options.set(name, setting).at(option.span)?;
        }
        match options.format {
            Some(pattern) => format::formatted(&value, &pattern).map(Value::String).at(span),
            None => format::text(
                &value,
                options.significant_digits,
                options.minimum_length,
                options.left_justified,
            )
            .map(Value::String)
            .at(span),
        }
    }

    /// `assert(condition, message, level)` (MLS §8.3.7)
    fn assertion(
        &mut self,
        entry: &Builtin,
        arguments: &Arguments,
        span: Span,
    ) -> Result<(), Diagnostic> {
        let [condition, message, level] = taken(arguments, entry, span)?;
        if self.condition(given(condition, span)?)? {
            return Ok(());
        }
        let message = given(message, span)?;
        let text = String::from_value(self.expression(message)?).at(message.span)?;
        let failed = Fault::new(ASSERTION_FAILED, text).at(span);
        let Some(level) = level else { return Err(failed) };
        match self.assertion_level(level)? {
            "warning" => {
                self.host.warn(failed.warning());
                Ok(())
            }
            _ => Err(failed),
        }
    }

    fn assertion_level(&mut self, level: &Expression) -> Result<&'static str, Diagnostic> {
        if let ExpressionKind::Reference(reference) = &level.kind
            && let [enumeration, literal] = reference.parts.as_slice()
            && enumeration.name == "AssertionLevel"
        {
            return Ok(literal.name.as_str());
        }
        match self.expression(level)? {
            Value::Enumeration(value) => Ok(value.literal()),
            // In the functions of loaded classes literals are ordinals (MLS §8.3.7 has two).
            Value::Integer(1) => Ok("warning"),
            Value::Integer(2) => Ok("error"),
            other => {
                Err(fault!(TYPE_MISMATCH, "expected an AssertionLevel, got {}", other.type_name())
                    .at(level.span))
            }
        }
    }
}

/// The arguments in the order of the entry's inputs, of which it may have fewer than `N` needed.
fn taken<'a, const N: usize>(
    arguments: &'a Arguments,
    entry: &Builtin,
    span: Span,
) -> Result<[Option<&'a Expression>; N], Diagnostic> {
    let (names, required) = (entry.inputs, entry.least.min(N));
    let mut found = [None; N];
    if arguments.positional.len() > N {
        let fault = fault!(WRONG_ARGUMENTS, "expected at most {N} arguments");
        return Err(fault.at(arguments.positional[N].span));
    }
    for (slot, argument) in found.iter_mut().zip(&arguments.positional) {
        *slot = Some(argument);
    }
    for argument in &arguments.named {
        let slot = names.iter().position(|name| argument.name.node == *name);
        match slot.map(|at| &mut found[at]) {
            Some(slot @ None) => *slot = Some(&argument.value),
            _ => {
                let name = argument.name.node;
                let fault =
                    fault!(WRONG_ARGUMENTS, "the argument `{name}` is unknown or specified twice");
                return Err(fault.at(argument.name.span));
            }
        }
    }
    if found[..required].iter().any(Option::is_none) {
        return Err(fault!(WRONG_ARGUMENTS, "expected {required} arguments").at(span));
    }
    Ok(found)
}

fn given(argument: Option<&Expression>, span: Span) -> Result<&Expression, Diagnostic> {
    argument.ok_or_else(|| Fault::new(WRONG_ARGUMENTS, "an argument is missing").at(span))
}

/// The options of `String`.
struct TextOptions {
    significant_digits: i64,
    minimum_length: i64,
    left_justified: bool,
    format: Option<String>,
}

impl Default for TextOptions {
    fn default() -> TextOptions {
        TextOptions { significant_digits: 6, minimum_length: 0, left_justified: true, format: None }
    }
}

impl TextOptions {
    fn set(&mut self, name: Ident, value: Value) -> Result<(), Fault> {
        match name.as_str() {
            "significantDigits" => self.significant_digits = i64::from_value(value)?,
            "minimumLength" => self.minimum_length = i64::from_value(value)?,
            "leftJustified" => self.left_justified = bool::from_value(value)?,
            "format" => self.format = Some(String::from_value(value)?),
            other => {
                return Err(fault!(
                    WRONG_ARGUMENTS,
                    "`String` has no input `{other}`";
                    help: "its inputs are `significantDigits`, `minimumLength`, `leftJustified`, `format`"
                ));
            }
        }
        Ok(())
    }
}
