//! The rules of the entries against the values of calls.

use super::{ArgumentShapes, Builtin, Meaning, Operator, TypeRule, find, names};
use crate::value::{ArrayValue, Elements, Value};

/// Arguments that are values.
struct Values<'a>(&'a [Value]);

impl ArgumentShapes for Values<'_> {
    fn count(&self) -> usize {
        self.0.len()
    }

    fn dims(&mut self, at: usize) -> Option<Vec<usize>> {
        Some(self.0.get(at)?.dims().to_vec())
    }

    fn number(&mut self, at: usize) -> Option<i64> {
        match self.0.get(at)? {
            Value::Integer(value) => Some(*value),
            _ => None,
        }
    }
}

fn integers(dims: &[usize]) -> Value {
    let count: i64 = dims.iter().product::<usize>() as i64;
    let elements = Elements::Integer((1..=count).collect());
    Value::Array(ArrayValue::new(dims.to_vec(), elements))
}

fn real(value: Value) -> Value {
    match value {
        Value::Array(ArrayValue { dims, elements, .. }) => {
            Value::Array(ArrayValue::new(dims, elements.promoted()))
        }
        other => other.promoted(),
    }
}

/// Arguments for every function that has a value without an interpreter.
fn examples(name: &str) -> Vec<Vec<Value>> {
    let n = |value: i64| Value::Integer(value);
    match name {
        "array" => vec![vec![n(1), n(2)], vec![integers(&[2]), real(integers(&[2]))]],
        "cat" => vec![
            vec![n(1), integers(&[2]), integers(&[3])],
            vec![n(2), integers(&[2, 1]), integers(&[2, 3])],
        ],
        "fill" => vec![vec![n(3), n(2)], vec![real(integers(&[2])), n(4), n(3)]],
        "identity" => vec![vec![n(3)], vec![n(0)]],
        "linspace" => vec![vec![n(0), n(1), n(5)]],
        "zeros" | "ones" => vec![vec![n(2), n(3)], vec![n(0)]],
        "promote" => vec![vec![integers(&[2]), n(3)]],
        "scalar" => vec![vec![integers(&[1, 1])]],
        "vector" => vec![vec![integers(&[1, 3])], vec![n(1)]],
        "matrix" => vec![vec![integers(&[3])], vec![integers(&[2, 2, 1])]],
        "diagonal" => vec![vec![integers(&[2])], vec![real(integers(&[2]))]],
        "cross" | "outerProduct" => {
            vec![vec![integers(&[3]), real(integers(&[3]))], vec![integers(&[3]), integers(&[3])]]
        }
        "skew" => vec![vec![integers(&[3])], vec![real(integers(&[3]))]],
        "symmetric" => vec![vec![integers(&[3, 3])]],
        "transpose" => vec![vec![integers(&[2, 3])], vec![integers(&[2, 3, 2])]],
        "sum" | "product" => vec![vec![integers(&[2, 2])], vec![real(integers(&[3]))]],
        "min" | "max" => vec![vec![integers(&[2])], vec![n(1), Value::Real(2.0)], vec![n(1), n(2)]],
        "semiLinear" => vec![vec![Value::Real(1.0), Value::Real(2.0), Value::Real(3.0)]],
        _ => Vec::new(),
    }
}

fn all_examples(entry: &Builtin) -> Vec<Vec<Value>> {
    match entry.meaning {
        Meaning::Mathematical(_) => {
            let real = vec![Value::Real(0.5); entry.least];
            let array = real.iter().map(|_| Value::reals(vec![0.25, 0.5])).collect();
            let integers = vec![Value::Integer(1); entry.least];
            vec![real, array, integers]
        }
        Meaning::Operator(operator) if operator != Operator::SemiLinear => Vec::new(),
        _ => examples(entry.name),
    }
}

fn type_of(value: &Value) -> TypeRule {
    match value {
        Value::Real(_) | Value::Array(ArrayValue { elements: Elements::Real(_), .. }) => {
            TypeRule::Real
        }
        Value::Integer(_) | Value::Array(ArrayValue { elements: Elements::Integer(_), .. }) => {
            TypeRule::Integer
        }
        other => panic!("{}", other.type_name()),
    }
}

fn expected_type(entry: &Builtin, arguments: &[Value]) -> Option<TypeRule> {
    match entry.value_type {
        TypeRule::As(at) => Some(type_of(&arguments[at])),
        TypeRule::Joined => {
            let is_real = arguments.iter().any(|a| type_of(a) == TypeRule::Real);
            Some(if is_real { TypeRule::Real } else { TypeRule::Integer })
        }
        TypeRule::Unknown => None,
        rule => Some(rule),
    }
}

#[test]
fn values_have_the_types_and_sizes_that_the_rules_say() {
    let mut seen = 0;
    for name in names() {
        let entry = find(name).unwrap();
        let examples = all_examples(entry);
        let is_operator =
            matches!(entry.meaning, Meaning::Operator(o) if o != Operator::SemiLinear);
        assert!(is_operator || !examples.is_empty(), "`{name}` has no example");
        for arguments in examples {
            let value = entry.value(&arguments).unwrap_or_else(|e| panic!("{name}: {e}"));
            if let Some(expected) = expected_type(entry, &arguments) {
                assert_eq!(type_of(&value), expected, "{name}({arguments:?})");
            }
            let shape = entry.shape_of(&mut Values(&arguments));
            assert_eq!(shape.as_deref(), Some(value.dims()), "{name}({arguments:?})");
            seen += 1;
        }
    }
    assert!(seen > 80, "{seen}");
}

#[test]
fn elements_stand_where_the_specification_puts_them() {
    let call = |name: &str, arguments: &[Value]| match super::call(name, arguments).unwrap() {
        Value::Array(ArrayValue { dims, elements: Elements::Integer(values), .. }) => {
            (dims, values)
        }
        other => panic!("{}", other.type_name()),
    };
    let turned = call("transpose", &[integers(&[2, 3])]);
    assert_eq!(turned, (vec![3, 2], vec![1, 4, 2, 5, 3, 6]));
    let joined = call("cat", &[Value::Integer(2), integers(&[2, 1]), integers(&[2, 2])]);
    assert_eq!(joined, (vec![2, 3], vec![1, 1, 2, 2, 3, 4]));
    let skew = call("skew", &[integers(&[3])]);
    assert_eq!(skew, (vec![3, 3], vec![0, -3, 2, 3, 0, -1, -2, 1, 0]));
    let mirrored = call("symmetric", &[integers(&[2, 2])]);
    assert_eq!(mirrored, (vec![2, 2], vec![1, 2, 2, 4]));
}
