//! Values of scripts as the numbers that programs work with, and back: a Boolean is 0 or 1, a literal
//! of an enumeration its number.

use crate::diag::{Fault, suggest};
use crate::errors::BAD_PARAMETER_VALUE;
use crate::flatten::BaseType;
use crate::value::{ArrayValue, Elements, EnumerationValue, Value};
use crate::{bail, fault};

/// The number of a scalar value for a variable of a type.
pub(super) fn number_of(base: &BaseType, name: &str, value: &Value) -> Result<f64, Fault> {
    let number = match (base, value) {
        (BaseType::Real, Value::Real(_) | Value::Integer(_)) => value.as_real(),
        (BaseType::Integer, Value::Integer(_)) => value.as_real(),
        (BaseType::Integer, Value::Real(number)) if number.fract() == 0.0 => Some(*number),
        (BaseType::Integer, Value::Real(number)) => {
            bail!(BAD_PARAMETER_VALUE, "`{name}` needs a whole number, but the value is {number}")
        }
        (BaseType::Boolean, Value::Boolean(value)) => Some(f64::from(*value)),
        (BaseType::Boolean, _) => value.as_real().filter(|number| [0.0, 1.0].contains(number)),
        (BaseType::Enumeration(definition), Value::Enumeration(literal)) => {
            (*definition == literal.definition).then_some(literal.ordinal as f64)
        }
        (BaseType::Enumeration(definition), Value::Integer(number)) => {
            let numbers = 1..=definition.literals.len() as i64;
            numbers.contains(number).then_some(*number as f64)
        }
        _ => None,
    };
    number.ok_or_else(|| {
        let (declared, given) = (base_name(base), value.type_name());
        fault!(BAD_PARAMETER_VALUE, "`{name}` is of type {declared}, and the value of type {given}";
            help: "assign a value of the type of the parameter")
    })
}

/// The value of numbers for variables of a type: a scalar without dimensions, else an array.
pub(super) fn value_of(base: &BaseType, dims: Vec<usize>, numbers: Vec<f64>) -> Option<Value> {
    let elements = match base {
        BaseType::Real => Elements::Real(numbers),
        BaseType::Integer => Elements::Integer(numbers.into_iter().map(|x| x as i64).collect()),
        BaseType::Boolean => Elements::Boolean(numbers.into_iter().map(|x| x != 0.0).collect()),
        BaseType::Enumeration(definition) => Elements::Enumeration(
            numbers
                .into_iter()
                .map(|x| EnumerationValue { definition: definition.clone(), ordinal: x as i64 })
                .collect(),
        ),
        BaseType::String | BaseType::ExternalObject(_) | BaseType::Clock => return None,
    };
    match dims.is_empty() {
        true => (!elements.is_empty()).then(|| elements.get(0)),
        false => Some(Value::Array(ArrayValue::new(dims, elements))),
    }
}

/// A text without the quotes around it.
pub(super) fn unquoted(text: &str) -> &str {
    let inner = text.trim().strip_prefix('"').and_then(|rest| rest.strip_suffix('"'));
    inner.unwrap_or(text)
}

/// The number that stands for a value: of a literal its ordinal.
pub(crate) fn number_in(name: &str, text: &str, base: Option<&BaseType>) -> Result<f64, Fault> {
    if let Some(BaseType::Enumeration(definition)) = base {
        let literal = text.rsplit('.').next().unwrap_or(text);
        if let Some(at) = definition.literals.iter().position(|known| *known == literal) {
            return Ok(at as f64 + 1.0);
        }
        let literals = definition.literals.iter().map(|known| known.as_str());
        return text.parse().map_err(|_| {
            fault!(
                BAD_PARAMETER_VALUE,
                "`{text}` is not a literal of `{}`, the type of `{name}`",
                definition.name
            )
            .help_if(suggest::did_you_mean(literal, literals.clone()))
            .help(format!("its literals are {}", literals.collect::<Vec<_>>().join(", ")))
        });
    }
    match text {
        "true" => Ok(1.0),
        "false" => Ok(0.0),
        number => number.parse().map_err(|_| {
            let help = decimal_comma(number)
                .unwrap_or_else(|| "write a number, `true` or `false`".to_owned());
            fault!(BAD_PARAMETER_VALUE, "`{text}` is not a value of `{name}`").help(help)
        }),
    }
}

/// What to write in place of a number with a decimal comma; `None` for another text.
pub(super) fn decimal_comma(text: &str) -> Option<String> {
    let point = text.replacen(',', ".", 1);
    point.parse::<f64>().ok().map(|_| format!("numbers have a decimal point: write `{point}`"))
}

fn base_name(base: &BaseType) -> String {
    match base {
        BaseType::Real => "Real".to_owned(),
        BaseType::Integer => "Integer".to_owned(),
        BaseType::Boolean => "Boolean".to_owned(),
        BaseType::String => "String".to_owned(),
        BaseType::Enumeration(definition) => definition.name.to_string(),
        BaseType::ExternalObject(name) => name.to_string(),
        BaseType::Clock => "Clock".to_owned(),
    }
}
