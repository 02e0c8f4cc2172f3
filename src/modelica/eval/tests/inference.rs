//! Types and sizes that the text shows are those of the values.

use crate::diag::Diagnostic;
use crate::eval::{Callee, Function, Host, Scope, ValueType, evaluate};
use crate::functions;
use crate::inference::{Sizes, SizesOfNames, TypesOfNames, all_known, sizes_of, type_of};
use crate::name::Name;
use crate::source::SourceId;
use crate::syntax::ast::{Arguments, ComponentReference, Expression};
use crate::syntax::parse_expression;
use crate::value::{Elements, Value};
use std::sync::Arc;

/// Expressions of all types with none, one and two dimensions.
const OPERANDS: [&str; 16] = [
    "2",
    "1.5",
    "true",
    "\"a\"",
    "{1, 2}",
    "{1.5, 2.5}",
    "{1, 2.5}",
    "{true, false}",
    "{\"a\", \"b\"}",
    "[1, 2; 3, 4]",
    "{{1.5, 2}, {3, 4}}",
    "1:2",
    "0:0.5:1",
    "{i*2 for i in 1:2}",
    "{i + 0.5*j for i in 1:2, j in 1:3}",
    "sum({i, 2*i} for i in 1:3)",
];

const OPERATORS: [&str; 18] = [
    "+", "-", "*", "/", "^", ".+", ".-", ".*", "./", ".^", "<", "<=", ">", ">=", "==", "<>", "and",
    "or",
];

/// No names at all.
struct Nothing;

impl TypesOfNames for Nothing {
    type Type = ValueType;

    fn of_reference(&mut self, _: &ComponentReference) -> Option<ValueType> {
        None
    }

    fn of_function(&mut self, _: &ComponentReference, _: &Arguments) -> Option<Option<ValueType>> {
        None
    }

    fn rank(&mut self, e: &Expression) -> Option<usize> {
        sizes_of(self, e).map(|sizes| sizes.len())
    }
}

impl SizesOfNames for Nothing {
    type Function = Function;

    fn of_reference(&mut self, _: &ComponentReference) -> Option<Sizes> {
        None
    }

    fn function(&mut self, _: &ComponentReference) -> Option<Option<Arc<Function>>> {
        None
    }
}

impl Host for Nothing {
    fn callee(&mut self, _: &Name) -> Result<Option<Callee>, Diagnostic> {
        Ok(None)
    }

    fn variable(&mut self, _: &ComponentReference) -> Result<Option<Value>, Diagnostic> {
        Ok(None)
    }
}

/// The type of the elements of a value; `None` if there are none, or of other types.
fn type_of_value(value: &Value) -> Option<ValueType> {
    match value {
        Value::Real(_) => Some(ValueType::Real),
        Value::Integer(_) => Some(ValueType::Integer),
        Value::Boolean(_) => Some(ValueType::Boolean),
        Value::String(_) => Some(ValueType::String),
        Value::Array(array) if array.elements.is_empty() => None,
        Value::Array(array) => match array.elements {
            Elements::Real(_) => Some(ValueType::Real),
            Elements::Integer(_) => Some(ValueType::Integer),
            Elements::Boolean(_) => Some(ValueType::Boolean),
            Elements::String(_) => Some(ValueType::String),
            _ => None,
        },
        _ => None,
    }
}

/// What differs between the text of an expression and its value, if it has one.
fn difference(text: &str) -> Result<Option<String>, Diagnostic> {
    let e = parse_expression(SourceId::NONE, text)?;
    let value = value_of(&e)?;
    if matches!(value, Value::Tuple(_)) {
        return Ok(None);
    }
    let (shown, found) = (type_of(&mut Nothing, &e), type_of_value(&value));
    if let (Some(shown), Some(found)) = (&shown, &found)
        && shown != found
    {
        return Ok(Some(format!("{text}: {} is shown, {} found", shown.name(), found.name())));
    }
    let shown = sizes_of(&mut Nothing, &e).and_then(all_known);
    let differs = shown.as_ref().is_some_and(|shown| shown.as_slice() != value.dims());
    Ok(differs.then(|| format!("{text}: {shown:?} is shown, {:?} found", value.dims())))
}

/// Operators and functions of the language with operands of all types.
pub(crate) fn expressions() -> Vec<String> {
    let mut written: Vec<String> = OPERANDS.iter().map(|one| (*one).to_owned()).collect();
    for a in OPERANDS {
        written.extend(["-", "not ", "+"].map(|operator| format!("{operator}({a})")));
        written.push(format!("if true then {a} else {a}"));
        written.extend(["[1]", "[1, 2]", "[:, 1]", "[end]"].map(|index| format!("({a}){index}")));
        for b in OPERANDS {
            written.extend(OPERATORS.map(|operator| format!("({a}) {operator} ({b})")));
            written.push(format!("{{{a}, {b}}}"));
            written.push(format!("[{a}, {b}]"));
            written.push(format!("[{a}; {b}]"));
            written.push(format!("({a}):({b})"));
        }
    }
    for name in functions::names() {
        written.push(format!("{name}()"));
        for a in OPERANDS {
            written.push(format!("{name}({a})"));
            written.extend(OPERANDS.map(|b| format!("{name}({a}, {b})")));
            written.push(format!("{name}({a}, {a}, 2)"));
            written.push(format!("{name}(2, {a}, {a})"));
            written.push(format!("{name}(1, {a}, 2)"));
        }
        written.push(format!("{name}(i*0.5 for i in 1:3)"));
        written.push(format!("{name}({{i, j}} for i in j:j + 1, j in 1:2)"));
    }
    written
}

/// The value of an expression without names.
pub(crate) fn value_of(e: &Expression) -> Result<Value, Diagnostic> {
    evaluate(e, &mut Scope::script(), &mut Nothing)
}

#[test]
fn the_text_shows_what_the_value_has() {
    let written = expressions();
    let results: Vec<_> = written.iter().map(|text| difference(text)).collect();
    let evaluated = results.iter().filter(|result| result.is_ok()).count();
    assert!(evaluated > 1500, "{evaluated} of {} have values", written.len());
    let wrong: Vec<String> = results.into_iter().filter_map(|one| one.ok().flatten()).collect();
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}
