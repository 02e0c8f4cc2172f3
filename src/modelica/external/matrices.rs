//! Matrices as arguments of LAPACK's routines, row-major; leading dimensions are not looked at.

use super::call::Call;
use crate::budget::has_memory;
use crate::diag::Fault;
use nalgebra::DMatrix;

/// Rows or columns from which the memory is asked for: below, a square matrix takes 128 MiB at most.
const LARGE: usize = 1 << 12;

/// A vector or matrix argument; a vector is a column. Its orthogonal factors are square matrices with
/// as many rows as it has rows or columns: one without elements may have billions.
pub(crate) fn matrix(call: &Call<'_>, argument: usize) -> Result<DMatrix<f64>, Fault> {
    let (rows, columns) = match *call.dims(argument) {
        [rows] => (rows as usize, 1),
        [rows, columns] => (rows as usize, columns as usize),
        _ => return Err(call.fault("an argument is neither vector nor matrix")),
    };
    let side = rows.max(columns);
    let bytes = side.saturating_mul(side).saturating_mul(size_of::<f64>());
    if side > LARGE && !has_memory(bytes) {
        return Err(call.fault(format!("there is no memory for {side} rows and columns")));
    }
    let values = call.array(argument);
    match values.iter().all(|value| value.is_finite()) {
        true => Ok(DMatrix::from_row_slice(rows, columns, values)),
        false => Err(call.fault("a matrix contains a number that is not finite")),
    }
}

/// A square matrix argument.
pub(crate) fn square(call: &Call<'_>, argument: usize) -> Result<DMatrix<f64>, Fault> {
    let matrix = matrix(call, argument)?;
    match matrix.is_square() {
        true => Ok(matrix),
        false => Err(call.fault("a matrix is not square")),
    }
}

/// Writes the upper left part that fits.
pub(crate) fn write(call: &mut Call<'_>, argument: usize, matrix: &DMatrix<f64>) {
    let columns = call.dims(argument).get(1).map_or(1, |columns| *columns as usize);
    for (at, element) in call.array_mut(argument).iter_mut().enumerate() {
        let (row, column) = (at / columns, at % columns);
        if row < matrix.nrows() && column < matrix.ncols() {
            *element = matrix[(row, column)];
        }
    }
}

/// The power of two at or below a size: division by it rounds nothing. 1 for nothing and for what is
/// below normal numbers.
pub(crate) fn power_of_two(size: f64) -> f64 {
    const EXPONENT: u64 = 0x7ff << 52;
    if size.is_normal() { f64::from_bits(size.to_bits() & EXPONENT) } else { 1.0 }
}

/// A matrix of one column.
pub(crate) fn column(values: &[f64]) -> DMatrix<f64> {
    DMatrix::from_column_slice(values.len(), 1, values)
}

/// Whether a job is asked for: its letter is not `N`.
pub(crate) fn is_requested(call: &Call<'_>, argument: usize) -> bool {
    !call.text(argument).eq_ignore_ascii_case("N")
}

/// Whether the letter for op(A) is not `N`.
pub(crate) fn is_transposed(call: &Call<'_>, argument: usize) -> bool {
    is_requested(call, argument)
}

/// The norm that a letter names: greatest element, columns, rows, Frobenius.
pub(crate) fn norm(call: &Call<'_>, letter: &str, a: &DMatrix<f64>) -> Result<f64, Fault> {
    let greatest = |values: &mut dyn Iterator<Item = f64>| values.fold(0.0, f64::max);
    let size = |values: &[f64]| values.iter().map(|value| value.abs()).sum::<f64>();
    Ok(match letter.to_ascii_uppercase().as_str() {
        "M" => greatest(&mut a.iter().map(|value| value.abs())),
        "1" | "O" => greatest(&mut a.column_iter().map(|c| size(c.clone_owned().as_slice()))),
        "I" => greatest(&mut a.row_iter().map(|r| size(r.clone_owned().as_slice()))),
        "F" | "E" => a.norm(),
        _ => return Err(call.fault(format!("there is no norm `{letter}`"))),
    })
}
