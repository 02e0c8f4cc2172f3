//! Making arrays and changing their shape (MLS §10.3.2, §10.3.3, §10.4.2).

use super::Entry;
use crate::bail;
use crate::diag::Fault;
use crate::value::errors::{DOMAIN_ERROR, SIZE_MISMATCH, TYPE_MISMATCH};
use crate::value::{ArrayValue, Elements, FromValue, Value, construct, element_count};

pub(super) const FUNCTIONS: &[Entry] = &[
    Entry::of_values("array", 1, usize::MAX, |values| construct::array(values.to_vec())),
    Entry::of_values("cat", 2, usize::MAX, cat),
    Entry::of_values("diagonal", 1, 1, diagonal),
    Entry::of_values("fill", 1, usize::MAX, fill),
    Entry::of_values("identity", 1, 1, identity),
    Entry::of_values("linspace", 3, 3, linspace),
    Entry::of_values("matrix", 1, 1, matrix),
    Entry::of_values("ones", 1, usize::MAX, |sizes| of_integers(1, sizes)),
    Entry::of_values("promote", 2, 2, promote),
    Entry::of_values("scalar", 1, 1, scalar),
    Entry::of_values("vector", 1, 1, vector),
    Entry::of_values("zeros", 1, usize::MAX, |sizes| of_integers(0, sizes)),
];

fn sizes_of(arguments: &[Value]) -> Result<Vec<usize>, Fault> {
    arguments.iter().map(|size| usize::from_value(size.clone())).collect()
}

/// `fill(s, n1, n2, …)`; `s` may be an array itself.
fn fill(arguments: &[Value]) -> Result<Value, Fault> {
    let dims = sizes_of(&arguments[1..])?;
    match &arguments[0] {
        value if dims.is_empty() => Ok(value.clone()),
        Value::Array(inner) => {
            let whole = [dims.as_slice(), inner.dims.as_slice()].concat();
            let count = element_count(&whole)?;
            let size = inner.elements.len();
            let elements = inner.elements.gathered((0..count).map(|at| at % size.max(1)));
            Ok(Value::Array(ArrayValue { dims: whole, elements }))
        }
        scalar => ArrayValue::filled(dims, scalar).map(Value::Array),
    }
}

fn of_integers(value: i64, sizes: &[Value]) -> Result<Value, Fault> {
    ArrayValue::filled(sizes_of(sizes)?, &Value::Integer(value)).map(Value::Array)
}

/// `identity(n)`: Integer, as the MLS has it.
fn identity(arguments: &[Value]) -> Result<Value, Fault> {
    let size = usize::from_value(arguments[0].clone())?;
    let count = element_count(&[size, size])?;
    let one = |at: usize| i64::from(at / size == at % size);
    let elements = Elements::Integer((0..count).map(one).collect());
    Ok(Value::Array(ArrayValue { dims: vec![size, size], elements }))
}

/// `diagonal(v)`: a square matrix with `v` on its diagonal.
fn diagonal(arguments: &[Value]) -> Result<Value, Fault> {
    let Value::Array(ArrayValue { dims, elements }) = &arguments[0] else {
        return Err(unsuitable("diagonal", "a vector", &arguments[0]));
    };
    let [size] = dims.as_slice() else {
        return Err(unsuitable("diagonal", "a vector", &arguments[0]));
    };
    element_count(&[*size, *size])?;
    let zero = match elements {
        Elements::Integer(_) => Value::Integer(0),
        Elements::Real(_) => Value::Real(0.0),
        _ => return Err(unsuitable("diagonal", "a vector of numbers", &arguments[0])),
    };
    let mut matrix = ArrayValue::filled(vec![*size, *size], &zero)?;
    for at in 0..*size {
        matrix.elements.set(at * (size + 1), elements.get(at))?;
    }
    Ok(Value::Array(matrix))
}

/// `linspace(x1, x2, n)`: `n >= 2` Reals at equal distances, both ends included.
fn linspace(arguments: &[Value]) -> Result<Value, Fault> {
    let first = f64::from_value(arguments[0].clone())?;
    let last = f64::from_value(arguments[1].clone())?;
    let count = i64::from_value(arguments[2].clone())?;
    if count < 2 {
        bail!(DOMAIN_ERROR, "`linspace` needs at least 2 points, not {count}");
    }
    let count = element_count(&[usize::try_from(count).unwrap_or(usize::MAX)])?;
    let point = |at: usize| match at + 1 == count {
        true => last,
        false => first + (last - first) * at as f64 / (count - 1) as f64,
    };
    Ok(Value::reals((0..count).map(point).collect()))
}

/// `matrix(A)`: the first two dimensions, where all others are 1.
fn matrix(arguments: &[Value]) -> Result<Value, Fault> {
    match &arguments[0] {
        Value::Array(array) if array.rank() > 2 => {
            if array.dims[2..].iter().any(|size| *size != 1) {
                return Err(unsuitable(
                    "matrix",
                    "dimensions of size 1 after the first two",
                    &arguments[0],
                ));
            }
            let (dims, elements) = (array.dims[..2].to_vec(), array.elements.clone());
            Ok(Value::Array(ArrayValue { dims, elements }))
        }
        other => construct::promote(other.clone(), 2),
    }
}

/// `vector(A)`: all elements, where at most one dimension is not 1.
fn vector(arguments: &[Value]) -> Result<Value, Fault> {
    match &arguments[0] {
        Value::Array(array) if array.dims.iter().filter(|size| **size != 1).count() <= 1 => {
            Ok(Value::Array(ArrayValue::vector(array.elements.clone())))
        }
        Value::Array(_) => {
            Err(unsuitable("vector", "at most one dimension larger than 1", &arguments[0]))
        }
        scalar => construct::promote(scalar.clone(), 1),
    }
}

/// `scalar(A)`: the only element.
fn scalar(arguments: &[Value]) -> Result<Value, Fault> {
    match &arguments[0] {
        Value::Array(array) if array.elements.len() == 1 => Ok(array.elements.get(0)),
        Value::Array(_) => Err(unsuitable("scalar", "a single element", &arguments[0])),
        scalar => Ok(scalar.clone()),
    }
}

fn promote(arguments: &[Value]) -> Result<Value, Fault> {
    let rank = usize::from_value(arguments[1].clone())?;
    if rank > 64 {
        bail!(DOMAIN_ERROR, "an array with {rank} dimensions is not supported");
    }
    construct::promote(arguments[0].clone(), rank)
}

fn cat(arguments: &[Value]) -> Result<Value, Fault> {
    match &arguments[0] {
        Value::Integer(dimension @ 1..) => construct::cat(
            usize::try_from(*dimension).unwrap_or(usize::MAX),
            arguments[1..].to_vec(),
        ),
        other => bail!(
            TYPE_MISMATCH,
            "the first argument of `cat` is a dimension, from 1, not {}",
            crate::value::show::show(other, crate::value::show::Style::Dymola)
        ),
    }
}

fn unsuitable(name: &str, wanted: &str, got: &Value) -> Fault {
    Fault::new(SIZE_MISMATCH, format!("`{name}` needs {wanted}, got {}", got.type_name()))
}
