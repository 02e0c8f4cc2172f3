//! `CombiTable1D`: several functions of one variable.

use super::curve::{Curve, Extrapolation, Interval, Near, Smoothness, place};
use super::source::{Matrix, Source};
use crate::diag::Fault;
use crate::elementary;
use crate::external::call::Call;

/// Columns of a table over its first column.
#[derive(Debug)]
pub(crate) struct Table1D {
    pub(super) x: Vec<f64>,
    curves: Vec<Curve>,
    pub(super) smoothness: Smoothness,
    pub(super) extrapolation: Extrapolation,
    near: Near,
}

impl Table1D {
    /// From a matrix and arguments of the call: the requested columns, smoothness, extrapolation.
    /// Abscissae may repeat if `jumps`, but not for splines.
    pub(crate) fn new(
        call: &Call<'_>,
        matrix: &Matrix,
        columns: usize,
        smoothness: i64,
        extrapolation: i64,
        jumps: bool,
    ) -> Result<Table1D, Fault> {
        let smoothness = Smoothness::from_ordinal(smoothness)
            .ok_or_else(|| call.fault(format!("there is no smoothness {smoothness}")))?;
        let extrapolation = Extrapolation::from_ordinal(extrapolation)
            .ok_or_else(|| call.fault(format!("there is no extrapolation {extrapolation}")))?;
        let x = matrix.column(0);
        // Two points have one connection.
        let smoothness = match smoothness {
            Smoothness::Spline(_) if x.len() <= 2 => Smoothness::Linear,
            other => other,
        };
        let jumps = jumps && !matches!(smoothness, Smoothness::Spline(_));
        ordered(call, &x, "the first column", jumps)?;
        let mut curves = Vec::new();
        for column in call.array(columns) {
            if *column < 1.0 || *column > matrix.columns as f64 {
                return Err(call.fault(format!(
                    "there is no column {column} in a table with {} columns",
                    matrix.columns
                )));
            }
            curves.push(Curve::new(&x, matrix.column(*column as usize - 1), smoothness));
        }
        Ok(Table1D { x, curves, smoothness, extrapolation, near: Near::default() })
    }

    /// The curve of a column, from 1.
    pub(crate) fn curve(&self, call: &Call<'_>, column: i64) -> Result<&Curve, Fault> {
        let position = usize::try_from(column - 1).ok();
        position
            .and_then(|position| self.curves.get(position))
            .ok_or_else(|| call.fault(format!("there is no column {column}")))
    }

    pub(crate) fn place(&self, call: &Call<'_>, u: f64) -> Result<Interval, Fault> {
        if u.is_nan() {
            return Err(call.fault("the abscissa is not a number"));
        }
        place(&self.x, self.extrapolation, u, &self.near).ok_or_else(|| {
            let (first, last) = (self.x[0], self.x[self.x.len() - 1]);
            call.fault(format!("{u} is outside the table range {first} to {last}"))
        })
    }
}

/// Whether abscissae increase, strictly unless `jumps`.
pub(crate) fn ordered(call: &Call<'_>, x: &[f64], what: &str, jumps: bool) -> Result<(), Fault> {
    let wrong = x.windows(2).find(|x| if jumps { x[1] < x[0] } else { x[1] <= x[0] });
    match wrong {
        Some(x) => Err(call.fault(format!(
            "{what} of the table must increase{}, but {} follows {}",
            if jumps { "" } else { " strictly" },
            x[1],
            x[0]
        ))),
        None => Ok(()),
    }
}

/// `(tableName, fileName, table, nRow, nColumn, columns, nCols, smoothness)`
pub(crate) fn init(call: &mut Call<'_>) -> Result<(), Fault> {
    make(call, Source { name: 0, file: 1, matrix: 2, csv: None }, 2)
}

/// As [`init`], file before table, with extrapolation and verbosity.
pub(crate) fn init2(call: &mut Call<'_>) -> Result<(), Fault> {
    let extrapolation = call.whole(8);
    make(call, Source { name: 1, file: 0, matrix: 2, csv: None }, extrapolation)
}

/// As [`init2`], with delimiter and header lines of CSV files.
pub(crate) fn init3(call: &mut Call<'_>) -> Result<(), Fault> {
    let extrapolation = call.whole(8);
    make(call, Source { name: 1, file: 0, matrix: 2, csv: Some((10, 11)) }, extrapolation)
}

fn make(call: &mut Call<'_>, source: Source, extrapolation: i64) -> Result<(), Fault> {
    let matrix = source.read(call)?;
    let table = Table1D::new(call, &matrix, 5, call.whole(7), extrapolation, false)?;
    call.give_object(table)
}

/// Value, first and second derivative at `(table, column, u)`.
fn evaluated(call: &Call<'_>) -> Result<[f64; 3], Fault> {
    let table: &Table1D = call.object(0)?;
    let curve = table.curve(call, call.whole(1))?;
    let place = table.place(call, call.number(2))?;
    Ok(curve.at(&table.x, table.extrapolation, place))
}

/// `y = f(u)`
pub(crate) fn value(call: &mut Call<'_>) -> Result<(), Fault> {
    let [y, ..] = evaluated(call)?;
    call.give(y)
}

/// `f′(u) u′`
pub(crate) fn derivative(call: &mut Call<'_>) -> Result<(), Fault> {
    let [_, derivative, _] = evaluated(call)?;
    call.give(derivative * call.number(3))
}

/// `f″(u) u′² + f′(u) u″`
pub(crate) fn second(call: &mut Call<'_>) -> Result<(), Fault> {
    let [_, derivative, curvature] = evaluated(call)?;
    call.give(curvature * elementary::powi(call.number(3), 2) + derivative * call.number(4))
}

/// The first abscissa.
pub(crate) fn minimum(call: &mut Call<'_>) -> Result<(), Fault> {
    let first = call.object::<Table1D>(0)?.x[0];
    call.give(first)
}

/// The last abscissa.
pub(crate) fn maximum(call: &mut Call<'_>) -> Result<(), Fault> {
    let x = &call.object::<Table1D>(0)?.x;
    let last = x[x.len() - 1];
    call.give(last)
}
