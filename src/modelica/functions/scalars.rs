//! The mathematical functions of scalars (MLS §3.7.1–3.7.3) applied to values.

use crate::diag::Fault;
use crate::symbolic::function::{Function, FunctionId, ResultType};
use crate::value::errors::{
    DIVISION_BY_ZERO, DOMAIN_ERROR, INTEGER_OVERFLOW, REAL_OVERFLOW, SIZE_MISMATCH, TYPE_MISMATCH,
};
use crate::value::{ArrayValue, Elements, Value, construct, ops, sizes};
use crate::{bail, fault};

/// A function of the mathematical table, element by element where arguments are arrays.
pub(super) fn call(function: FunctionId, arguments: &[Value]) -> Result<Value, Fault> {
    let function = function.get();
    match arguments {
        [Value::Real(x)] => real(function, &[*x]).and_then(|y| typed(function, arguments, y)),
        [Value::Real(x), Value::Real(y)] => {
            real(function, &[*x, *y]).and_then(|z| typed(function, arguments, z))
        }
        [Value::Array(ArrayValue { dims, elements: Elements::Real(values), .. })]
            if function.result != ResultType::Integer =>
        {
            let values = values.iter().map(|x| real(function, &[*x])).collect::<Result<_, _>>()?;
            let elements = Elements::Real(values);
            Ok(Value::Array(ArrayValue::new(dims.clone(), elements)))
        }
        _ => each(function.name, arguments, &|scalars: &[Value]| scalar(function, scalars)),
    }
}

fn scalar(function: &Function, arguments: &[Value]) -> Result<Value, Fault> {
    if function.result == ResultType::AsArguments
        && let Some(value) = of_integers(function.name, arguments)?
    {
        return Ok(Value::Integer(value));
    }
    let mut reals = [0.0; 2];
    let reals = &mut reals[..arguments.len().min(2)];
    for (real, argument) in reals.iter_mut().zip(arguments) {
        *real = number(function.name, argument)?;
    }
    real(function, reals).and_then(|value| typed(function, arguments, value))
}

fn real(function: &Function, arguments: &[f64]) -> Result<f64, Fault> {
    let is_nan = arguments.iter().any(|argument| argument.is_nan());
    if !is_nan && !function.accepts(arguments) {
        let words = function.domain.map_or("", |domain| domain.words);
        let code = match function.name {
            "div" | "mod" | "rem" => DIVISION_BY_ZERO,
            _ => DOMAIN_ERROR,
        };
        bail!(code, "`{}({})`: {words}", function.name, shown(arguments));
    }
    let value = function.value.of(arguments);
    if value.is_infinite() && arguments.iter().all(|argument| argument.is_finite()) {
        bail!(
            REAL_OVERFLOW,
            "`{}({})` exceeds the largest Real, 1.8e308",
            function.name,
            shown(arguments)
        );
    }
    Ok(value)
}

fn shown(arguments: &[f64]) -> String {
    let shown: Vec<String> = arguments.iter().map(|x| crate::value::show::real(*x)).collect();
    shown.join(", ")
}

fn typed(function: &Function, arguments: &[Value], value: f64) -> Result<Value, Fault> {
    let is_integer = match function.result {
        ResultType::Real => false,
        ResultType::Integer => true,
        ResultType::AsArguments => arguments.iter().all(|a| matches!(a, Value::Integer(_))),
    };
    if !is_integer {
        return Ok(Value::Real(value));
    }
    // The bounds are powers of two, which Reals hold exactly.
    if (-9_223_372_036_854_775_808.0..9_223_372_036_854_775_808.0).contains(&value) {
        return Ok(Value::Integer(value as i64));
    }
    bail!(INTEGER_OVERFLOW, "`{}` of {value:?} does not fit in an Integer", function.name)
}

fn number(name: &str, value: &Value) -> Result<f64, Fault> {
    value
        .as_real()
        .ok_or_else(|| fault!(TYPE_MISMATCH, "`{name}` is not defined for {}", value.type_name()))
}

/// Applies a function of scalars; arrays must have equal sizes and are gone through together,
/// scalars stay the same (MLS §12.4.6).
pub fn each(
    name: &str,
    arguments: &[Value],
    function: &dyn Fn(&[Value]) -> Result<Value, Fault>,
) -> Result<Value, Fault> {
    let mut dims: Option<&[usize]> = None;
    for argument in arguments {
        let Value::Array(array) = argument else { continue };
        match dims {
            Some(before) if before != array.dims => bail!(
                SIZE_MISMATCH,
                "`{name}` is called for arrays of different sizes, {} and {}",
                sizes(before),
                sizes(&array.dims)
            ),
            _ => dims = Some(&array.dims),
        }
    }
    let Some(dims) = dims else { return function(arguments) };
    let count = dims.iter().product();
    let mut scalars = arguments.to_vec();
    let mut values = Vec::with_capacity(count);
    for at in 0..count {
        for (scalar, argument) in scalars.iter_mut().zip(arguments) {
            if let Value::Array(array) = argument {
                *scalar = array.elements.get(at);
            }
        }
        values.push(function(&scalars)?);
    }
    construct::shaped(dims, values)
}

/// Exactly, because Integers may exceed what a Real holds; `None` for other functions and types.
fn of_integers(name: &str, arguments: &[Value]) -> Result<Option<i64>, Fault> {
    let value = match (name, arguments) {
        ("abs", [Value::Integer(x)]) => x.checked_abs(),
        ("div" | "mod" | "rem", [Value::Integer(_), Value::Integer(0)]) => {
            bail!(DIVISION_BY_ZERO, "`{name}` by zero")
        }
        ("div", [Value::Integer(x), Value::Integer(y)]) => x.checked_div(*y),
        ("mod", [Value::Integer(x), Value::Integer(y)]) => modulo(*x, *y),
        ("rem", [Value::Integer(x), Value::Integer(y)]) => x.checked_rem(*y),
        _ => return Ok(None),
    };
    match value {
        Some(value) => Ok(Some(value)),
        None => bail!(INTEGER_OVERFLOW, "the value of `{name}` does not fit in an Integer"),
    }
}

/// x − ⌊x/y⌋ y: has the sign of `y`.
fn modulo(x: i64, y: i64) -> Option<i64> {
    let remainder = x.checked_rem(y)?;
    let differs = remainder != 0 && (remainder < 0) != (y < 0);
    Some(if differs { remainder + y } else { remainder })
}

/// `semiLinear(x, k⁺, k⁻)` (MLS §3.7.2.5)
pub(super) fn semi_linear(arguments: &[Value]) -> Result<Value, Fault> {
    let x = number("semiLinear", &arguments[0])?;
    ops::multiply(&arguments[0].clone().promoted(), &arguments[if x >= 0.0 { 1 } else { 2 }])
}

/// `Integer(e)`: which literal of its enumeration, from 1.
pub(super) fn ordinal(arguments: &[Value]) -> Result<Value, Fault> {
    match &arguments[0] {
        Value::Enumeration(value) => Ok(Value::Integer(value.ordinal)),
        Value::Integer(value) => Ok(Value::Integer(*value)),
        other => bail!(
            TYPE_MISMATCH,
            "`Integer` is not defined for {}", other.type_name();
            help: "use `integer(x)` for the largest Integer not above `x`"
        ),
    }
}
