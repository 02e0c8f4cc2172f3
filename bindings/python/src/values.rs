//! Values of scripts as Python's, and back.

use gapilib::Value;
use gapilib::internals::value::{ArrayValue, Elements, EnumerationValue};
use numpy::{Element, PyArray1, PyArrayMethods, PyReadonlyArrayDyn, PyUntypedArrayMethods};
use pyo3::exceptions::{PyTypeError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::{PyBool, PyDict, PyFloat, PyInt, PyList, PyString, PyTuple};
use std::sync::Arc;

/// A value as Python's: numbers, strings, NumPy arrays, lists of strings, dicts for records, the name
/// of the literal for an enumeration.
pub(crate) fn to_python<'py>(py: Python<'py>, value: Value) -> PyResult<Bound<'py, PyAny>> {
    Ok(match value {
        Value::Real(number) => number.into_pyobject(py)?.into_any(),
        Value::Integer(number) => number.into_pyobject(py)?.into_any(),
        Value::Boolean(truth) => truth.into_pyobject(py)?.to_owned().into_any(),
        Value::String(text) => PyString::new(py, &text).into_any(),
        Value::VariableName(text) => PyString::new(py, &text).into_any(),
        Value::Enumeration(literal) => PyString::new(py, literal.literal()).into_any(),
        Value::TypeName(name) => PyString::new(py, &name.to_string()).into_any(),
        Value::Function(function) => PyString::new(py, &function.name.to_string()).into_any(),
        Value::Array(array) => of_array(py, array)?,
        Value::Record(record) => {
            let dict = PyDict::new(py);
            for (name, value) in record.fields {
                dict.set_item(name.as_str(), to_python(py, value)?)?;
            }
            dict.into_any()
        }
        Value::Tuple(values) if values.is_empty() => py.None().into_bound(py),
        Value::Tuple(values) => {
            let values = values.into_iter().map(|value| to_python(py, value));
            PyTuple::new(py, values.collect::<PyResult<Vec<_>>>()?)?.into_any()
        }
        Value::External(_) => {
            return Err(PyTypeError::new_err("an external object has no value in Python"));
        }
    })
}

fn of_array<'py>(py: Python<'py>, array: ArrayValue) -> PyResult<Bound<'py, PyAny>> {
    let ArrayValue { dims, elements, .. } = array;
    match elements {
        Elements::Real(values) => Ok(PyArray1::from_vec(py, values).reshape(dims)?.into_any()),
        Elements::Integer(values) => Ok(PyArray1::from_vec(py, values).reshape(dims)?.into_any()),
        Elements::Boolean(values) => Ok(PyArray1::from_vec(py, values).reshape(dims)?.into_any()),
        Elements::String(values) => nested(py, &dims, &mut values.into_iter().map(Value::String)),
        Elements::Enumeration(values) => {
            let literal = |value: EnumerationValue| Value::string(value.literal());
            nested(py, &dims, &mut values.into_iter().map(literal))
        }
        Elements::Record(values) => nested(py, &dims, &mut values.into_iter().map(Value::Record)),
    }
}

/// Lists in lists, last dimension innermost.
fn nested<'py>(
    py: Python<'py>,
    dims: &[usize],
    values: &mut dyn Iterator<Item = Value>,
) -> PyResult<Bound<'py, PyAny>> {
    let Some((first, inner)) = dims.split_first() else {
        return match values.next() {
            Some(value) => to_python(py, value),
            None => Ok(py.None().into_bound(py)),
        };
    };
    let list = PyList::empty(py);
    for _ in 0..*first {
        list.append(nested(py, inner, values)?)?;
    }
    Ok(list.into_any())
}

/// A Python value as a script's: booleans, numbers, strings, arrays, and (nested) lists of them.
///
/// # Errors
///
/// `TypeError` for another type, `ValueError` for an array without elements whose type is not
/// known, or of lists of unequal lengths.
pub(crate) fn from_python(value: &Bound<'_, PyAny>) -> PyResult<Value> {
    if value.is_instance_of::<PyBool>() {
        return Ok(Value::Boolean(value.extract()?));
    }
    if value.is_instance_of::<PyInt>() {
        return Ok(Value::Integer(value.extract()?));
    }
    if value.is_instance_of::<PyFloat>() {
        return Ok(Value::Real(value.extract()?));
    }
    if let Ok(text) = value.cast::<PyString>() {
        return Ok(Value::string(&*text.to_cow()?));
    }
    let py = value.py();
    let array = py.import("numpy")?.call_method1("asarray", (value,))?;
    let kind: String = array.getattr("dtype")?.getattr("kind")?.extract()?;
    let dims: Vec<usize> = array.getattr("shape")?.extract()?;
    let elements = elements(py, &array, &kind, value)?;
    if dims.is_empty() {
        return scalar(elements).ok_or_else(|| unknown(value));
    }
    Ok(Value::Array(ArrayValue::new(dims, elements)))
}

fn scalar(elements: Elements) -> Option<Value> {
    match elements {
        Elements::Real(values) => values.first().copied().map(Value::Real),
        Elements::Integer(values) => values.first().copied().map(Value::Integer),
        Elements::Boolean(values) => values.first().copied().map(Value::Boolean),
        Elements::String(values) => values.first().cloned().map(Value::String),
        _ => None,
    }
}

/// The elements of an array, row by row.
fn elements(
    py: Python<'_>,
    array: &Bound<'_, PyAny>,
    kind: &str,
    given: &Bound<'_, PyAny>,
) -> PyResult<Elements> {
    let typed = |name: &str| {
        let numpy = py.import("numpy")?;
        numpy.call_method1("ascontiguousarray", (array, numpy.getattr(name)?))
    };
    Ok(match kind {
        "f" => {
            let array = typed("float64")?;
            Elements::Real(owned(&array)?.0)
        }
        "i" | "u" => {
            let array = typed("int64")?;
            Elements::Integer(owned(&array)?.0)
        }
        "b" => {
            let array = typed("bool_")?;
            Elements::Boolean(owned(&array)?.0)
        }
        "U" => {
            let values: Vec<String> = array.call_method0("ravel")?.extract()?;
            Elements::String(values.into_iter().map(Arc::from).collect())
        }
        _ => return Err(unknown(given)),
    })
}

fn unknown(value: &Bound<'_, PyAny>) -> PyErr {
    let of = value.get_type().name().map_or_else(|_| String::new(), |name| name.to_string());
    PyTypeError::new_err(format!(
        "a value of type {of} cannot be a variable of a script: give a number, a string, or an \
         array of them"
    ))
}

/// The elements of an array in C order, and its shape.
fn owned<T: Element + Clone>(array: &Bound<'_, PyAny>) -> PyResult<(Vec<T>, Vec<usize>)> {
    let values: PyReadonlyArrayDyn<'_, T> = array.extract()?;
    let shape = PyUntypedArrayMethods::shape(&*values).to_vec();
    if let Ok(slice) = values.as_slice() {
        return Ok((slice.to_vec(), shape));
    }
    // Not aligned, as arrays are that another process has sent.
    let copy = array.call_method0("copy")?;
    let copy: PyReadonlyArrayDyn<'_, T> = copy.extract()?;
    Ok((copy.as_slice()?.to_vec(), shape))
}

/// An array of Real in one dimension, or a list or tuple of `float`: read without NumPy's help, which takes
/// longer than a short simulation. `None` for anything else.
fn plain_row(value: &Bound<'_, PyAny>) -> Option<Vec<f64>> {
    fn floats<'py>(items: impl Iterator<Item = Bound<'py, PyAny>>) -> Option<Vec<f64>> {
        items.map(|item| item.cast::<PyFloat>().ok().map(|float| float.value())).collect()
    }
    if let Ok(array) = value.cast::<PyArray1<f64>>() {
        return array.try_readonly().ok()?.as_slice().ok().map(<[f64]>::to_vec);
    }
    if let Ok(list) = value.cast_exact::<PyList>() {
        return floats(list.iter());
    }
    floats(value.cast_exact::<PyTuple>().ok()?.iter())
}

/// Rows of numbers: an array of one or two dimensions with so many columns.
pub(crate) fn rows(
    value: &Bound<'_, PyAny>,
    columns: usize,
    what: &str,
) -> PyResult<(Vec<f64>, usize)> {
    if let Some(row) = plain_row(value).filter(|row| row.len() == columns) {
        return Ok((row, 1));
    }
    let numpy = value.py().import("numpy")?;
    let array = numpy.call_method1("ascontiguousarray", (value, numpy.getattr("float64")?))?;
    let (values, shape) = owned(&array)?;
    match shape[..] {
        [n] if n == columns => Ok((values, 1)),
        [n, m] if m == columns => Ok((values, n)),
        _ => Err(PyValueError::new_err(format!(
            "{what} must have {columns} columns, but the shape is {shape:?}"
        ))),
    }
}
