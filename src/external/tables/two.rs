//! `CombiTable2D`: a function of two variables on a grid.
//!
//! The first column holds the abscissae of the first variable, the first row those of the second.
//! Piecewise constant and bilinear; splines on grids are refused.

use super::curve::{Extrapolation, Place, Smoothness, place};
use super::one::ordered;
use super::source::Source;
use crate::diag::Fault;
use crate::external::call::Call;

/// Values on a grid.
#[derive(Debug)]
struct Table2D {
    x: Vec<f64>,
    y: Vec<f64>,
    /// Row-major over `x`, then `y`.
    z: Vec<f64>,
    constant: bool,
    extrapolation: Extrapolation,
}

/// `(tableName, fileName, table, nRow, nColumn, smoothness)`
pub(super) fn init(call: &mut Call<'_>) -> Result<(), Fault> {
    make(call, Source { name: 0, file: 1, matrix: 2, csv: None }, 2)
}

/// As [`init`], with extrapolation and verbosity.
pub(super) fn init2(call: &mut Call<'_>) -> Result<(), Fault> {
    let extrapolation = call.whole(6);
    make(call, Source { name: 0, file: 1, matrix: 2, csv: None }, extrapolation)
}

/// As [`init2`], file before table, with delimiter and header lines of CSV files.
pub(super) fn init3(call: &mut Call<'_>) -> Result<(), Fault> {
    let extrapolation = call.whole(6);
    make(call, Source { name: 1, file: 0, matrix: 2, csv: Some((8, 9)) }, extrapolation)
}

fn make(call: &mut Call<'_>, source: Source, extrapolation: i64) -> Result<(), Fault> {
    let matrix = source.read(call)?;
    let extrapolation = Extrapolation::from_ordinal(extrapolation)
        .ok_or_else(|| call.fault(format!("there is no extrapolation {extrapolation}")))?;
    if matrix.rows < 2 {
        return Err(call.fault("a table of two variables needs at least two rows"));
    }
    let x: Vec<f64> = matrix.column(0)[1..].to_vec();
    let y: Vec<f64> = matrix.values[1..matrix.columns].to_vec();
    ordered(call, &x, "the first column", false)?;
    ordered(call, &y, "the first row", false)?;
    let constant = match Smoothness::from_ordinal(call.whole(5)) {
        Some(Smoothness::Constant) => true,
        Some(Smoothness::Linear) => false,
        // Two points have one connection.
        Some(Smoothness::Spline(_)) if x.len() <= 2 && y.len() <= 2 => false,
        Some(Smoothness::Spline(_)) => {
            return Err(call.fault("splines on a grid are not supported"));
        }
        None => return Err(call.fault(format!("there is no smoothness {}", call.whole(5)))),
    };
    let rows = matrix.values.chunks(matrix.columns).skip(1);
    let z = rows.flat_map(|row| row[1..].iter().copied()).collect();
    call.give_object(Table2D { x, y, z, constant, extrapolation })
}

/// One variable's interval, its share of it (beyond 0 and 1 where extrapolated) and the slope of
/// the share.
#[derive(Debug, Clone, Copy)]
struct Axis {
    low: usize,
    high: usize,
    share: f64,
    slope: f64,
}

impl Table2D {
    fn axis(&self, call: &Call<'_>, x: &[f64], u: f64) -> Result<Axis, Fault> {
        let n = x.len();
        let still = |at: usize| Axis { low: at, high: at, share: 0.0, slope: 0.0 };
        if u.is_nan() {
            return Err(call.fault("an abscissa is not a number"));
        }
        let place = place(x, self.extrapolation, u).ok_or_else(|| {
            call.fault(format!("{u} lies outside {} to {}, where the table ends", x[0], x[n - 1]))
        })?;
        if n == 1 {
            return Ok(still(0));
        }
        let (interval, u) = match place {
            Place::Inside(interval, u) => (interval, u),
            Place::Before(_) if self.extrapolation == Extrapolation::Hold => return Ok(still(0)),
            Place::Behind(_) if self.extrapolation == Extrapolation::Hold => {
                return Ok(still(n - 1));
            }
            Place::Before(_) if self.constant => return Ok(still(0)),
            Place::Behind(_) if self.constant => return Ok(still(n - 1)),
            Place::Before(u) => (0, u),
            Place::Behind(u) => (n - 2, u),
        };
        if self.constant {
            return Ok(still(if u >= x[n - 1] { n - 1 } else { interval }));
        }
        let slope = 1.0 / (x[interval + 1] - x[interval]);
        Ok(Axis { low: interval, high: interval + 1, share: (u - x[interval]) * slope, slope })
    }

    fn z(&self, i: usize, j: usize) -> f64 {
        self.z[i * self.y.len() + j]
    }
}

/// Value, both slopes and the mixed derivative at `(table, u1, u2)`.
fn evaluated(call: &Call<'_>) -> Result<[f64; 4], Fault> {
    let table: &Table2D = call.object(0)?;
    let a = table.axis(call, &table.x, call.number(1))?;
    let b = table.axis(call, &table.y, call.number(2))?;
    let [z00, z10] = [table.z(a.low, b.low), table.z(a.high, b.low)];
    let [z01, z11] = [table.z(a.low, b.high), table.z(a.high, b.high)];
    let along = |p: f64, q: f64, share: f64| if share == 1.0 { q } else { p + share * (q - p) };
    let (near, far) = (along(z00, z10, a.share), along(z01, z11, a.share));
    let mixed = (z11 - z01 - z10 + z00) * a.slope * b.slope;
    Ok([
        along(near, far, b.share),
        along(z10 - z00, z11 - z01, b.share) * a.slope,
        (far - near) * b.slope,
        mixed,
    ])
}

/// `f(u₁, u₂)`
pub(super) fn value(call: &mut Call<'_>) -> Result<(), Fault> {
    let [z, ..] = evaluated(call)?;
    call.give(z)
}

/// `f₁ u₁′ + f₂ u₂′`
pub(super) fn derivative(call: &mut Call<'_>) -> Result<(), Fault> {
    let [_, first, second, _] = evaluated(call)?;
    call.give(first * call.number(3) + second * call.number(4))
}

/// `2 f₁₂ u₁′ u₂′ + f₁ u₁″ + f₂ u₂″`
pub(super) fn second(call: &mut Call<'_>) -> Result<(), Fault> {
    let [_, first, second, mixed] = evaluated(call)?;
    let quadratic = 2.0 * mixed * call.number(3) * call.number(4);
    call.give(quadratic + first * call.number(5) + second * call.number(6))
}

/// The first abscissae.
pub(super) fn minimum(call: &mut Call<'_>) -> Result<(), Fault> {
    let table: &Table2D = call.object(0)?;
    let ends = [table.x[0], table.y[0]];
    write_ends(call, ends)
}

/// The last abscissae.
pub(super) fn maximum(call: &mut Call<'_>) -> Result<(), Fault> {
    let table: &Table2D = call.object(0)?;
    let ends = [table.x[table.x.len() - 1], table.y[table.y.len() - 1]];
    write_ends(call, ends)
}

fn write_ends(call: &mut Call<'_>, ends: [f64; 2]) -> Result<(), Fault> {
    match call.array_mut(1) {
        [first, second] => [*first, *second] = ends,
        _ => return Err(call.fault("the abscissae are written to a vector of two elements")),
    }
    Ok(())
}
