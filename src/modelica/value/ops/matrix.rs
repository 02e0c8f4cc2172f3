//! Products of vectors and matrices (MLS §10.6.4) and powers of square matrices (MLS §10.6.8).

use super::scalar::overflow;
use crate::diag::Fault;
use crate::value::array::{element_count, sizes};
use crate::value::errors::{
    DOMAIN_ERROR, INTEGER_OVERFLOW, REAL_OVERFLOW, SIZE_MISMATCH, TYPE_MISMATCH,
};
use crate::value::{ArrayValue, Elements, Value};
use crate::{bail, fault};
use nalgebra::DMatrixView;

/// The sizes of `a * b` (MLS §10.6.4): the two that must be the same, and those of the product;
/// `None` if arrays of so many dimensions have no product.
pub(crate) fn product_sizes<S: Copy>(a: &[S], b: &[S]) -> Option<((S, S), Vec<S>)> {
    let (rows, inner) = match a {
        [n] => (None, *n),
        [m, n] => (Some(*m), *n),
        _ => return None,
    };
    let (other, columns) = match b {
        [n] => (*n, None),
        [n, p] => (*n, Some(*p)),
        _ => return None,
    };
    Some(((inner, other), rows.into_iter().chain(columns).collect()))
}

/// `a * b`: vector · vector is a scalar, matrix · vector and vector · matrix are vectors,
/// matrix · matrix is a matrix.
pub(crate) fn product(a: &ArrayValue, b: &ArrayValue) -> Result<Value, Fault> {
    let sizes = product_sizes(&a.dims, &b.dims).filter(|((inner, other), _)| inner == other);
    let ((inner, _), dims) = sizes.ok_or_else(|| no_product(a, b))?;
    let rows = a.dims[..a.dims.len() - 1].iter().product();
    let columns = b.dims[1..].iter().product();
    element_count(&dims)?;
    let elements = match (&a.elements, &b.elements) {
        (Elements::Integer(a), Elements::Integer(b)) => {
            Elements::Integer(integer_product(a, b, rows, inner, columns)?)
        }
        _ => match (a.elements.as_reals(), b.elements.as_reals()) {
            (Some(a), Some(b)) => {
                let product = real_product(&a, &b, rows, inner, columns);
                Elements::Real(representable(product, &a, &b)?)
            }
            _ => bail!(
                TYPE_MISMATCH,
                "`*` is not defined for {} and {}",
                a.type_name(),
                b.type_name()
            ),
        },
    };
    Ok(match dims.is_empty() {
        true => elements.get(0),
        false => Value::Array(ArrayValue::new(dims, elements)),
    })
}

/// `a ^ n` by repeated squaring; `n = 0` gives the identity.
pub(crate) fn power(base: &ArrayValue, exponent: i64) -> Result<Value, Fault> {
    let size = match base.dims.as_slice() {
        [n, m] if n == m => *n,
        _ => bail!(
            SIZE_MISMATCH,
            "`^` needs a square matrix, not {}", base.type_name();
            help: "use `.^` to raise each element to a power"
        ),
    };
    let Ok(mut left) = u64::try_from(exponent) else {
        bail!(DOMAIN_ERROR, "a matrix cannot be raised to the negative power {exponent}")
    };
    let mut result = identity_like(base, size)?;
    let mut square = base.clone();
    while left > 0 {
        if left & 1 == 1 {
            result = matrix_product(&result, &square)?;
        }
        left >>= 1;
        if left > 0 {
            square = matrix_product(&square, &square)?;
        }
    }
    Ok(Value::Array(result))
}

/// The product, a fault if an element is not finite although all factors are.
fn representable(product: Vec<f64>, a: &[f64], b: &[f64]) -> Result<Vec<f64>, Fault> {
    let finite = |values: &[f64]| values.iter().all(|value| value.is_finite());
    if !finite(&product) && finite(a) && finite(b) {
        bail!(REAL_OVERFLOW, "a sum of products exceeds the largest Real, 1.8e308");
    }
    Ok(product)
}

fn matrix_product(a: &ArrayValue, b: &ArrayValue) -> Result<ArrayValue, Fault> {
    match product(a, b)? {
        Value::Array(array) => Ok(array),
        _ => Err(no_product(a, b)),
    }
}

fn identity_like(base: &ArrayValue, size: usize) -> Result<ArrayValue, Fault> {
    let one = |at: usize| at / size == at % size;
    let elements = match &base.elements {
        Elements::Real(_) => {
            Elements::Real((0..size * size).map(|at| f64::from(u8::from(one(at)))).collect())
        }
        Elements::Integer(_) => {
            Elements::Integer((0..size * size).map(|at| i64::from(one(at))).collect())
        }
        other => bail!(TYPE_MISMATCH, "`^` is not defined for an array of {}", other.type_name()),
    };
    Ok(ArrayValue::new(vec![size, size], elements))
}

/// Multiplications from which on nalgebra's blocked product is worth its setting up.
const BLOCKED: usize = 1 << 15;

/// Row-major all three: read as columns they are the transposed matrices, so Bᵀ Aᵀ is the product.
fn real_product(a: &[f64], b: &[f64], rows: usize, inner: usize, columns: usize) -> Vec<f64> {
    if rows.saturating_mul(inner).saturating_mul(columns) >= BLOCKED {
        let a = DMatrixView::from_slice(a, inner, rows);
        let b = DMatrixView::from_slice(b, columns, inner);
        return (b * a).data.into();
    }
    let mut result = vec![0.0; rows * columns];
    for row in 0..rows {
        for k in 0..inner {
            let factor = a[row * inner + k];
            for column in 0..columns {
                result[row * columns + column] += factor * b[k * columns + column];
            }
        }
    }
    result
}

fn integer_product(
    a: &[i64],
    b: &[i64],
    rows: usize,
    inner: usize,
    columns: usize,
) -> Result<Vec<i64>, Fault> {
    let mut result = vec![0i64; rows * columns];
    for row in 0..rows {
        for k in 0..inner {
            let factor = a[row * inner + k];
            for column in 0..columns {
                let other = b[k * columns + column];
                let term = factor.checked_mul(other).ok_or_else(|| overflow("*", factor, other))?;
                let sum = &mut result[row * columns + column];
                *sum = sum.checked_add(term).ok_or_else(|| {
                    fault!(INTEGER_OVERFLOW, "a sum of products does not fit in an Integer")
                })?;
            }
        }
    }
    Ok(result)
}

fn no_product(a: &ArrayValue, b: &ArrayValue) -> Fault {
    fault!(
        SIZE_MISMATCH,
        "the sizes {} and {} cannot be multiplied", sizes(&a.dims), sizes(&b.dims);
        help: "use `.*` for element-wise multiplication"
    )
}
