//! `CombiTable2D`: a function of two variables on a grid.
//!
//! The first column holds the abscissae of the first variable, the first row those of the second.
//! Piecewise constant, bilinear, or smooth by Akima's bivariate interpolation.

use super::curve::{Extrapolation, Interval, Near, Smoothness, place};
use super::one::ordered;
use super::source::Source;
use super::spline::Spline;
use super::surface::{Basis, Surface};
use crate::diag::Fault;
use crate::external::call::Call;

/// Values on a grid.
#[derive(Debug)]
struct Table2D {
    x: Vec<f64>,
    y: Vec<f64>,
    /// Row-major over `x`, then `y`.
    z: Vec<f64>,
    shape: Shape,
    extrapolation: Extrapolation,
}

/// What lies between the points.
#[derive(Debug)]
enum Shape {
    Steps,
    Bilinear,
    Smooth(Surface),
}

/// `(tableName, fileName, table, nRow, nColumn, smoothness)`
pub(crate) fn init(call: &mut Call<'_>) -> Result<(), Fault> {
    make(call, Source { name: 0, file: 1, matrix: 2, csv: None }, 2)
}

/// As [`init`], file before table, with extrapolation and verbosity.
pub(crate) fn init2(call: &mut Call<'_>) -> Result<(), Fault> {
    let extrapolation = call.whole(6);
    make(call, Source { name: 1, file: 0, matrix: 2, csv: None }, extrapolation)
}

/// As [`init2`], with delimiter and header lines of CSV files.
pub(crate) fn init3(call: &mut Call<'_>) -> Result<(), Fault> {
    let extrapolation = call.whole(6);
    make(call, Source { name: 1, file: 0, matrix: 2, csv: Some((8, 9)) }, extrapolation)
}

fn make(call: &mut Call<'_>, source: Source, extrapolation: i64) -> Result<(), Fault> {
    let matrix = source.read(call)?;
    let extrapolation = Extrapolation::from_ordinal(extrapolation)
        .ok_or_else(|| call.fault(format!("there is no extrapolation {extrapolation}")))?;
    if matrix.rows < 2 {
        return Err(call.fault("a two-dimensional table needs at least two rows"));
    }
    let x: Vec<f64> = matrix.column(0)[1..].to_vec();
    let y: Vec<f64> = matrix.values[1..matrix.columns].to_vec();
    ordered(call, &x, "the first column", false)?;
    ordered(call, &y, "the first row", false)?;
    let rows = matrix.values.chunks(matrix.columns).skip(1);
    let z: Vec<f64> = rows.flat_map(|row| row[1..].iter().copied()).collect();
    let shape = match Smoothness::from_ordinal(call.whole(5)) {
        Some(Smoothness::Constant) => Shape::Steps,
        Some(Smoothness::Linear) => Shape::Bilinear,
        Some(Smoothness::Spline(Spline::Akima)) => Shape::Smooth(Surface::new(&x, &y, &z)),
        Some(Smoothness::Spline(_)) => {
            return Err(
                call.fault("for a table of two variables, only Akima splines are supported")
            );
        }
        None => return Err(call.fault(format!("there is no smoothness {}", call.whole(5)))),
    };
    call.give_object(Table2D { x, y, z, shape, extrapolation })
}

/// Where one variable stands: an interval, the abscissa in it that is nearest, and how far the
/// variable is beyond.
#[derive(Debug, Clone, Copy)]
struct Position {
    interval: usize,
    u: f64,
    beyond: f64,
    /// Whether it is held at an end.
    held: bool,
}

impl Table2D {
    fn position(&self, call: &Call<'_>, x: &[f64], u: f64) -> Result<Position, Fault> {
        let n = x.len();
        if u.is_nan() {
            return Err(call.fault("an abscissa is not a number"));
        }
        let place = place(x, self.extrapolation, u, &Near::default()).ok_or_else(|| {
            call.fault(format!("{u} is outside the table range {} to {}", x[0], x[n - 1]))
        })?;
        let (interval, end) = match place {
            Interval::Inside(interval, u) => {
                return Ok(Position { interval, u, beyond: 0.0, held: false });
            }
            Interval::Before(_) => (0, x[0]),
            Interval::After(_) => (n.saturating_sub(2), x[n - 1]),
        };
        let held = n == 1 || self.extrapolation == Extrapolation::Hold;
        let beyond = if held { 0.0 } else { u - end };
        Ok(Position { interval, u: end, beyond, held })
    }

    /// Value, both first derivatives, the mixed derivative, both second derivatives.
    fn at(&self, a: Position, b: Position) -> [f64; 6] {
        match &self.shape {
            Shape::Smooth(surface) => self.smooth(surface, a, b),
            // Beyond the ends steps continue as bilinear functions.
            Shape::Steps if a.beyond == 0.0 && b.beyond == 0.0 => {
                let (i, j) = (step(&self.x, a), step(&self.y, b));
                [self.z(i, j), 0.0, 0.0, 0.0, 0.0, 0.0]
            }
            _ => self.bilinear(a, b),
        }
    }

    fn smooth(&self, surface: &Surface, a: Position, b: Position) -> [f64; 6] {
        let p = Basis::new(&self.x, a.interval, a.u);
        let q = Basis::new(&self.y, b.interval, b.u);
        let d = |i: usize, j: usize| surface.derivative(self.y.len(), &p, &q, i, j);
        let (s, t) = (a.beyond, b.beyond);
        let mixed = d(1, 1);
        let free = |held: bool, value: f64| if held { 0.0 } else { value };
        let curved = |position: Position, value: f64| match position.beyond == 0.0 {
            true => free(position.held, value),
            false => 0.0,
        };
        [
            d(0, 0) + d(1, 0) * s + d(0, 1) * t + mixed * s * t,
            free(a.held, d(1, 0) + mixed * t),
            free(b.held, d(0, 1) + mixed * s),
            free(a.held || b.held, mixed),
            curved(a, d(2, 0) + d(2, 1) * t),
            curved(b, d(0, 2) + d(1, 2) * s),
        ]
    }

    fn bilinear(&self, a: Position, b: Position) -> [f64; 6] {
        let (a, b) = (Axis::new(&self.x, a), Axis::new(&self.y, b));
        let [z00, z10] = [self.z(a.low, b.low), self.z(a.high, b.low)];
        let [z01, z11] = [self.z(a.low, b.high), self.z(a.high, b.high)];
        let along = |p: f64, q: f64, share: f64| if share == 1.0 { q } else { p + share * (q - p) };
        let (near, far) = (along(z00, z10, a.share), along(z01, z11, a.share));
        [
            along(near, far, b.share),
            along(z10 - z00, z11 - z01, b.share) * a.share_rate,
            (far - near) * b.share_rate,
            (z11 - z01 - z10 + z00) * a.share_rate * b.share_rate,
            0.0,
            0.0,
        ]
    }

    fn z(&self, i: usize, j: usize) -> f64 {
        self.z[i * self.y.len() + j]
    }
}

/// The point whose value holds at a position; the last one has a value of its own.
fn step(x: &[f64], position: Position) -> usize {
    if position.u >= x[x.len() - 1] { x.len() - 1 } else { position.interval }
}

/// One variable's interval, its share of it (beyond 0 and 1 where extrapolated) and the derivative
/// of the share.
#[derive(Debug, Clone, Copy)]
struct Axis {
    low: usize,
    high: usize,
    share: f64,
    share_rate: f64,
}

impl Axis {
    fn new(x: &[f64], position: Position) -> Axis {
        if x.len() == 1 {
            return Axis { low: 0, high: 0, share: 0.0, share_rate: 0.0 };
        }
        let low = position.interval;
        let share_rate = 1.0 / (x[low + 1] - x[low]);
        let share = (position.u + position.beyond - x[low]) * share_rate;
        let share_rate = if position.held { 0.0 } else { share_rate };
        Axis { low, high: low + 1, share, share_rate }
    }
}

/// At `(table, u1, u2)`.
fn evaluated(call: &Call<'_>) -> Result<[f64; 6], Fault> {
    let table: &Table2D = call.object(0)?;
    let a = table.position(call, &table.x, call.number(1))?;
    let b = table.position(call, &table.y, call.number(2))?;
    Ok(table.at(a, b))
}

/// `f(u₁, u₂)`
pub(crate) fn value(call: &mut Call<'_>) -> Result<(), Fault> {
    let [z, ..] = evaluated(call)?;
    call.give(z)
}

/// `f₁ u₁′ + f₂ u₂′`
pub(crate) fn derivative(call: &mut Call<'_>) -> Result<(), Fault> {
    let [_, first, second, ..] = evaluated(call)?;
    call.give(first * call.number(3) + second * call.number(4))
}

/// `f₁₁ u₁′² + 2 f₁₂ u₁′ u₂′ + f₂₂ u₂′² + f₁ u₁″ + f₂ u₂″`
pub(crate) fn second(call: &mut Call<'_>) -> Result<(), Fault> {
    let [_, first, second, mixed, along, across] = evaluated(call)?;
    let (p, q) = (call.number(3), call.number(4));
    let quadratic = along * p * p + 2.0 * mixed * p * q + across * q * q;
    call.give(quadratic + first * call.number(5) + second * call.number(6))
}

/// The first abscissae.
pub(crate) fn minimum(call: &mut Call<'_>) -> Result<(), Fault> {
    let table: &Table2D = call.object(0)?;
    let ends = [table.x[0], table.y[0]];
    write_ends(call, ends)
}

/// The last abscissae.
pub(crate) fn maximum(call: &mut Call<'_>) -> Result<(), Fault> {
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
