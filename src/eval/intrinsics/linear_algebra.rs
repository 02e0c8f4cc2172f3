//! Matrices and vectors (MLS §10.3.5).

use super::Entry;
use crate::diag::Fault;
use crate::fault;
use crate::value::errors::{SIZE_MISMATCH, TYPE_MISMATCH};
use crate::value::{ArrayValue, Elements, Value, element_count, ops};

pub(super) const FUNCTIONS: &[Entry] = &[
    Entry::of_values("cross", 2, 2, cross),
    Entry::of_values("outerProduct", 2, 2, outer_product),
    Entry::of_values("skew", 1, 1, skew),
    Entry::of_values("symmetric", 1, 1, symmetric),
    Entry::of_values("transpose", 1, 1, transpose),
];

/// The first two dimensions exchanged.
fn transpose(arguments: &[Value]) -> Result<Value, Fault> {
    match &arguments[0] {
        Value::Array(array) if array.rank() >= 2 => {
            let (rows, columns) = (array.dims[0], array.dims[1]);
            let each: usize = array.dims[2..].iter().product();
            let offsets = (0..columns).flat_map(move |column| {
                (0..rows).flat_map(move |row| {
                    let start = (row * columns + column) * each;
                    start..start + each
                })
            });
            let elements = array.elements.gathered(offsets);
            let mut dims = array.dims.clone();
            dims.swap(0, 1);
            Ok(Value::Array(ArrayValue { dims, elements }))
        }
        other => Err(unsuitable("transpose", "a matrix", other)),
    }
}

/// The matrix x yᵀ of two vectors.
fn outer_product(arguments: &[Value]) -> Result<Value, Fault> {
    let (x, y) = (vector("outerProduct", &arguments[0])?, vector("outerProduct", &arguments[1])?);
    let (rows, columns) = (x.elements.len(), y.elements.len());
    element_count(&[rows, columns])?;
    let column = Value::Array(ArrayValue { dims: vec![rows, 1], elements: x.elements.clone() });
    let row = Value::Array(ArrayValue { dims: vec![1, columns], elements: y.elements.clone() });
    ops::multiply(&column, &row)
}

/// The upper triangle mirrored at the diagonal.
fn symmetric(arguments: &[Value]) -> Result<Value, Fault> {
    match &arguments[0] {
        Value::Array(array) if array.rank() == 2 && array.dims[0] == array.dims[1] => {
            let size = array.dims[0];
            let mirrored = |at: usize| {
                let (row, column) = (at / size, at % size);
                row.min(column) * size + row.max(column)
            };
            let elements = array.elements.gathered((0..size * size).map(mirrored));
            Ok(Value::Array(ArrayValue { dims: array.dims.clone(), elements }))
        }
        other => Err(unsuitable("symmetric", "a square matrix", other)),
    }
}

/// x × y of two vectors with 3 elements.
fn cross(arguments: &[Value]) -> Result<Value, Fault> {
    let (x, y) = (three("cross", &arguments[0])?, three("cross", &arguments[1])?);
    let difference = |a: usize, b: usize| {
        let left = ops::multiply(&x[a], &y[b])?;
        ops::subtract(&left, &ops::multiply(&x[b], &y[a])?)
    };
    let values = vec![difference(1, 2)?, difference(2, 0)?, difference(0, 1)?];
    crate::value::construct::array(values)
}

/// The matrix S with S y = x × y.
fn skew(arguments: &[Value]) -> Result<Value, Fault> {
    let [x, y, z] = three("skew", &arguments[0])?;
    let zero = ops::subtract(&x, &x)?;
    let row = |a: Value, b: Value, c: Value| crate::value::construct::array(vec![a, b, c]);
    let rows = vec![
        row(zero.clone(), ops::negate(&z)?, y.clone())?,
        row(z, zero.clone(), ops::negate(&x)?)?,
        row(ops::negate(&y)?, x, zero)?,
    ];
    crate::value::construct::array(rows)
}

fn vector<'v>(name: &str, value: &'v Value) -> Result<&'v ArrayValue, Fault> {
    match value {
        Value::Array(array)
            if array.rank() == 1
                && matches!(array.elements, Elements::Real(_) | Elements::Integer(_)) =>
        {
            Ok(array)
        }
        other => Err(fault!(
            TYPE_MISMATCH,
            "`{name}` needs a vector of numbers, got {}",
            other.type_name()
        )),
    }
}

fn three(name: &str, value: &Value) -> Result<[Value; 3], Fault> {
    let array = vector(name, value)?;
    if array.elements.len() != 3 {
        return Err(unsuitable(name, "vectors with 3 elements", value));
    }
    Ok([0, 1, 2].map(|at| array.elements.get(at)))
}

fn unsuitable(name: &str, wanted: &str, got: &Value) -> Fault {
    fault!(SIZE_MISMATCH, "`{name}` needs {wanted}, got {}", got.type_name())
}
