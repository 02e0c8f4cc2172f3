//! Making arrays (MLS §10.4): `{…}`, `[… ; …]`, concatenation, ranges.

use super::array::{element_count, sizes};
use super::errors::{DOMAIN_ERROR, SIZE_MISMATCH, TYPE_MISMATCH};
use super::{ArrayValue, Elements, Marks, Value};
use crate::diag::Fault;
use crate::{bail, fault};

/// `{a, b, c}` (MLS §10.4): all of the same sizes, which follow the new first dimension. Without
/// any element it is `Real[0]`.
pub fn array(values: Vec<Value>) -> Result<Value, Fault> {
    let count = values.len();
    shaped(&[count], values)
}

/// The array with the leading sizes `dims` whose entries, all of the same sizes, are `values`.
pub fn shaped(dims: &[usize], values: Vec<Value>) -> Result<Value, Fault> {
    let mut values = values.into_iter();
    let Some(first) = values.next() else {
        return Ok(Value::Array(ArrayValue::new(dims.to_vec(), Elements::Real(Vec::new()))));
    };
    let mut marks: Vec<(Marks, usize)> = marks_of(&first).into_iter().collect();
    let (inner, mut elements) = parts(first)?;
    element_count(&[dims, inner.as_slice()].concat())?;
    for value in values {
        marks.extend(marks_of(&value));
        let (dims, more) = parts(value)?;
        if dims != inner {
            bail!(
                SIZE_MISMATCH,
                "the elements of an array have different sizes: {} and {}",
                shape(&inner),
                shape(&dims)
            );
        }
        elements.append(more)?;
    }
    let marks = Marks::joined(marks.iter().map(|(marks, rows)| (marks, *rows)));
    Ok(Value::Array(ArrayValue { dims: [dims, inner.as_slice()].concat(), elements, marks }))
}

/// The marks of the rows of an array, and how many there are.
fn marks_of(value: &Value) -> Option<(Marks, usize)> {
    match value {
        Value::Array(array) => Some((array.marks.clone(), array.rows().0)),
        _ => None,
    }
}

fn shape(dims: &[usize]) -> String {
    if dims.is_empty() { "a scalar".into() } else { sizes(dims) }
}

fn parts(value: Value) -> Result<(Vec<usize>, Elements), Fault> {
    match value {
        Value::Array(array) => Ok((array.dims, array.elements)),
        scalar => Ok((Vec::new(), Elements::repeated(&scalar, 1)?)),
    }
}

/// The entries of an array with the leading sizes `dims`, row-major: what [`shaped`] put together.
pub fn split(dims: &[usize], value: Value) -> Result<Vec<Value>, Fault> {
    match value {
        Value::Array(array) if array.dims.starts_with(dims) => {
            let inner = &array.dims[dims.len()..];
            let (count, each) = (element_count(dims)?, element_count(inner)?);
            let entry = |at: usize| match inner.is_empty() {
                true => array.elements.get(at),
                false => {
                    let elements = array.elements.slice(at * each, each);
                    Value::Array(ArrayValue::new(inner.to_vec(), elements))
                }
            };
            Ok((0..count).map(entry).collect())
        }
        other => Err(wrong_share(dims, &other)),
    }
}

/// A value that is not one for every record of an array.
fn wrong_share(dims: &[usize], value: &Value) -> Fault {
    fault!(
        SIZE_MISMATCH,
        "cannot distribute a value of type {} over records with the sizes {}",
        value.type_name(),
        sizes(dims)
    )
}

/// `[a, b; c, d]` (MLS §10.4.2.1): rows put together along dimension 2, then along dimension 1.
pub fn matrix(rows: Vec<Vec<Value>>) -> Result<Value, Fault> {
    let rank = rows.iter().flatten().map(Value::rank).max().unwrap_or(0).max(2);
    let mut joined = Vec::with_capacity(rows.len());
    for row in rows {
        let row =
            row.into_iter().map(|value| promote(value, rank)).collect::<Result<Vec<_>, _>>()?;
        joined.push(cat(2, row)?);
    }
    cat(1, joined)
}

/// `promote(A, n)` (MLS §10.3.1): dimensions of size 1 appended up to rank `rank`.
pub(crate) fn promote(value: Value, rank: usize) -> Result<Value, Fault> {
    if value.rank() > rank {
        bail!(
            DOMAIN_ERROR,
            "cannot promote {} to {rank} dimensions: it has {}",
            value.type_name(),
            value.rank()
        );
    }
    if rank == value.rank() {
        return Ok(value);
    }
    let (mut dims, elements) = parts(value)?;
    dims.resize(rank, 1);
    Ok(Value::Array(ArrayValue::new(dims, elements)))
}

/// That these sizes do not fit together along dimension `axis`, from 0.
pub(crate) fn do_not_fit([first, other]: [&[usize]; 2], axis: usize) -> Fault {
    let dimension = axis + 1;
    let are_columns =
        axis == 1 && [first, other].iter().all(|dims| dims.len() == 2 && dims[1] == 1);
    let help = are_columns.then(|| {
        "vectors are columns in `[a, b]`; `cat(1, a, b)` puts one after the other".to_owned()
    });
    fault!(
        SIZE_MISMATCH,
        "cannot concatenate arrays with the sizes {} and {} along dimension {dimension}",
        sizes(first),
        sizes(other)
    )
    .help_if(help)
}

/// `cat(k, A, B, …)` (MLS §10.4.2): `dimension` counted from 1; the other sizes agree.
pub fn cat(dimension: usize, values: Vec<Value>) -> Result<Value, Fault> {
    let mut arrays = Vec::with_capacity(values.len());
    for value in values {
        match value {
            Value::Array(array) if (1..=array.rank()).contains(&dimension) => arrays.push(array),
            other => bail!(
                SIZE_MISMATCH,
                "cannot concatenate {} along dimension {dimension}",
                other.type_name()
            ),
        }
    }
    let Some(first) = arrays.first() else { bail!(SIZE_MISMATCH, "nothing to concatenate") };
    let axis = dimension - 1;
    let mut dims = first.dims.clone();
    for array in &arrays[1..] {
        let fits = array.rank() == dims.len()
            && (0..dims.len()).all(|d| d == axis || array.dims[d] == dims[d]);
        if !fits {
            return Err(do_not_fit([&first.dims[..], &array.dims[..]], axis));
        }
        dims[axis] += array.dims[axis];
    }
    element_count(&dims)?;
    let outer: usize = dims[..axis].iter().product();
    let inner: usize = dims[axis + 1..].iter().product();
    let mut elements = first.elements.none_of_type();
    for row in 0..outer {
        for array in &arrays {
            let length = array.dims[axis] * inner;
            elements.append(array.elements.slice(row * length, length))?;
        }
    }
    if outer == 0 && arrays.iter().any(|a| matches!(a.elements, Elements::Real(_))) {
        elements = elements.promoted();
    }
    let marks = match arrays.as_slice() {
        [only] => only.marks.clone(),
        _ if axis == 0 && dims.len() > 1 => {
            Marks::joined(arrays.iter().map(|array| (&array.marks, array.rows().0)))
        }
        _ => Marks::default(),
    };
    Ok(Value::Array(ArrayValue { dims, elements, marks }))
}

/// The values of `start : step : stop` (MLS §10.4.3), not yet built.
#[derive(Debug, Clone, PartialEq)]
pub enum Range {
    /// Of Integers.
    Integer {
        /// First value.
        start: i64,
        /// Step, not zero.
        step: i64,
        /// Number of values.
        count: usize,
    },
    /// Of Reals.
    Real {
        /// First value.
        start: f64,
        /// Step, not zero.
        step: f64,
        /// Bound: no value lies beyond it.
        stop: f64,
        /// Number of values.
        count: usize,
    },
    /// Of Booleans or of literals of an enumeration, or the elements of an array.
    Values(Vec<Value>),
}

impl Range {
    /// `start : step : stop`; a step of one where none is written. The number of Reals is
    /// ⌊(stop − start)/step⌋ + 1, where a quotient that misses the next whole number by rounding
    /// alone counts as that number: `0:0.1:1` has 11 values.
    pub fn new(start: &Value, step: Option<&Value>, stop: &Value) -> Result<Range, Fault> {
        match (start, step, stop) {
            (Value::Integer(start), None, Value::Integer(stop)) => {
                Range::integers(*start, 1, *stop)
            }
            (Value::Integer(start), Some(Value::Integer(step)), Value::Integer(stop)) => {
                Range::integers(*start, *step, *stop)
            }
            (Value::Boolean(start), None, Value::Boolean(stop)) => {
                let all = [false, true];
                let within = all.into_iter().filter(|b| start <= b && b <= stop);
                Ok(Range::Values(within.map(Value::Boolean).collect()))
            }
            (Value::Enumeration(start), None, Value::Enumeration(stop))
                if start.definition == stop.definition =>
            {
                let literal = |ordinal| {
                    let definition = start.definition.clone();
                    Value::Enumeration(super::EnumerationValue { definition, ordinal })
                };
                Ok(Range::Values((start.ordinal..=stop.ordinal).map(literal).collect()))
            }
            _ => {
                let real = |value: &Value| match value {
                    Value::Real(value) => Ok(*value),
                    Value::Integer(value) => Ok(*value as f64),
                    other => bail!(
                        TYPE_MISMATCH,
                        "a range needs numbers, not a value of type {}",
                        other.type_name()
                    ),
                };
                Range::reals(real(start)?, step.map_or(Ok(1.0), real)?, real(stop)?)
            }
        }
    }

    fn integers(start: i64, step: i64, stop: i64) -> Result<Range, Fault> {
        if step == 0 {
            return Err(zero_step());
        }
        let span = i128::from(stop) - i128::from(start);
        let count = if span.signum() * i128::from(step.signum()) < 0 {
            0
        } else {
            span / i128::from(step) + 1
        };
        let count = usize::try_from(count).unwrap_or(usize::MAX);
        Ok(Range::Integer { start, step, count })
    }

    fn reals(start: f64, step: f64, stop: f64) -> Result<Range, Fault> {
        if step == 0.0 {
            return Err(zero_step());
        }
        if !(start.is_finite() && step.is_finite() && stop.is_finite()) {
            bail!(
                DOMAIN_ERROR,
                "the range {start:?}:{step:?}:{stop:?} does not have a finite length"
            );
        }
        let quotient = (stop - start) / step;
        let rounding = 4.0 * f64::EPSILON * ((start.abs() + stop.abs()) / step.abs() + 1.0);
        let last = (quotient + rounding.min(0.5)).floor();
        let count = if last < 0.0 { 0 } else { (last as usize).saturating_add(1) };
        Ok(Range::Real { start, step, stop, count })
    }

    /// The values that a `for` loop over this value takes (MLS §11.2.2): the elements of a vector.
    pub fn over(value: Value) -> Result<Range, Fault> {
        match value {
            Value::Array(array) if array.rank() == 1 => {
                let count = array.elements.len();
                Ok(Range::Values((0..count).map(|at| array.elements.get(at)).collect()))
            }
            other => bail!(
                TYPE_MISMATCH,
                "a loop needs a vector as its range, not a value of type {}", other.type_name();
                help: "use `1:n` to count from 1 to n"
            ),
        }
    }

    /// Number of values.
    pub fn count(&self) -> usize {
        match self {
            Range::Integer { count, .. } | Range::Real { count, .. } => *count,
            Range::Values(values) => values.len(),
        }
    }

    /// The value number `at`, counted from 0; `at` must be less than [`Range::count`].
    pub fn get(&self, at: usize) -> Value {
        match self {
            Range::Integer { start, step, .. } => {
                Value::Integer(start.wrapping_add((at as i64).wrapping_mul(*step)))
            }
            Range::Real { start, step, stop, .. } => Value::Real(real_at(*start, *step, *stop, at)),
            Range::Values(values) => values[at].clone(),
        }
    }

    /// The vector of the values.
    pub(crate) fn into_value(self) -> Result<Value, Fault> {
        let count = element_count(&[self.count()])?;
        let elements = match self {
            Range::Integer { start, step, .. } => Elements::Integer(
                (0..count as i64).map(|at| start.wrapping_add(at.wrapping_mul(step))).collect(),
            ),
            Range::Real { start, step, stop, .. } => {
                Elements::Real((0..count).map(|at| real_at(start, step, stop, at)).collect())
            }
            Range::Values(values) => return array(values),
        };
        Ok(Value::Array(ArrayValue::vector(elements)))
    }
}

fn real_at(start: f64, step: f64, stop: f64, at: usize) -> f64 {
    let value = start + at as f64 * step;
    if step > 0.0 { value.min(stop) } else { value.max(stop) }
}

fn zero_step() -> Fault {
    Fault::new(DOMAIN_ERROR, "the step of a range is zero")
}
