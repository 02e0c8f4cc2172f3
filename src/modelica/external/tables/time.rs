//! `CombiTimeTable`: a table over time with its events.
//!
//! At an event the value before it holds until the event has been handled: while `time` has
//! reached the next event, the segment that ends there continues.

use super::curve::{Extrapolation, Smoothness};
use super::one::Table1D;
use super::source::Source;
use crate::diag::Fault;
use crate::elementary;
use crate::external::call::Call;

/// A table over time.
#[derive(Debug)]
struct TimeTable {
    table: Table1D,
    /// Before this time the values are zero.
    start: f64,
    /// The time at which the abscissa is zero.
    shift: f64,
    events: TimeEvents,
}

/// The order of `Modelica.Blocks.Types.TimeEvents`.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum TimeEvents {
    Always,
    AtDiscontinuities,
    Never,
}

/// What stands for "no more events".
const NEVER: f64 = f64::MAX;

/// `(tableName, fileName, table, nRow, nColumn, startTime, columns, nCols, smoothness,
/// extrapolation)`
pub(crate) fn init(call: &mut Call<'_>) -> Result<(), Fault> {
    let start = call.number(5);
    make(call, Source { name: 0, file: 1, matrix: 2, csv: None }, start, TimeEvents::Always)
}

/// As [`init`], file before table, with shift, time events and verbosity.
pub(crate) fn init2(call: &mut Call<'_>) -> Result<(), Fault> {
    let (shift, events) = (call.number(10), events(call)?);
    make(call, Source { name: 1, file: 0, matrix: 2, csv: None }, shift, events)
}

/// As [`init2`], with delimiter and header lines of CSV files.
pub(crate) fn init3(call: &mut Call<'_>) -> Result<(), Fault> {
    let (shift, events) = (call.number(10), events(call)?);
    make(call, Source { name: 1, file: 0, matrix: 2, csv: Some((13, 14)) }, shift, events)
}

fn events(call: &Call<'_>) -> Result<TimeEvents, Fault> {
    match call.whole(11) {
        1 => Ok(TimeEvents::Always),
        2 => Ok(TimeEvents::AtDiscontinuities),
        3 => Ok(TimeEvents::Never),
        other => Err(call.fault(format!("there is no time event option {other}"))),
    }
}

fn make(call: &mut Call<'_>, source: Source, shift: f64, events: TimeEvents) -> Result<(), Fault> {
    let matrix = source.read(call)?;
    let table = Table1D::new(call, &matrix, 6, call.whole(8), call.whole(9), true)?;
    let start = call.number(5);
    call.give_object(TimeTable { table, start, shift, events })
}

/// Value, first and second derivative at `(table, column, time, nextTimeEvent,
/// pre(nextTimeEvent))`.
fn evaluated(call: &Call<'_>) -> Result<[f64; 3], Fault> {
    let TimeTable { table, start, shift, .. } = call.object(0)?;
    let (time, next) = (call.number(2), call.number(3));
    let curve = table.curve(call, call.whole(1))?;
    let x = &table.x;
    if time < *start || time >= next && next <= *start {
        return Ok([0.0; 3]);
    }
    if x.len() > 1 && time >= next {
        // The event at `next` is yet to be handled.
        let period = x[x.len() - 1] - x[0];
        let mut u = next - shift;
        let mut s = time - shift;
        if table.extrapolation == Extrapolation::Periodic && period > 0.0 {
            let periods = ((u - x[0]) / period).ceil() - 1.0;
            u -= periods * period;
            s -= periods * period;
        }
        // Abscissae go through a sum: the last one before `u` but for rounding.
        let slack = 1e-12 * u.abs().max(s.abs()).max(period);
        let before = x.partition_point(|x| *x < u - slack);
        if (1..x.len()).contains(&before) {
            return Ok(curve.inside(x, before - 1, s));
        }
    }
    let mut u = time - shift;
    let period = x[x.len() - 1] - x[0];
    if table.extrapolation == Extrapolation::Periodic && period > 0.0 {
        // The end of a period, but for rounding, is the beginning of the next.
        let periods = ((u - x[0]) / period + 1e-12).floor();
        u = (u - periods * period).max(x[0]);
    }
    let place = table.place(call, u)?;
    Ok(curve.at(x, table.extrapolation, place))
}

/// The value at a time.
pub(crate) fn value(call: &mut Call<'_>) -> Result<(), Fault> {
    let [y, ..] = evaluated(call)?;
    call.give(y)
}

/// `f′(t) t′`
pub(crate) fn derivative(call: &mut Call<'_>) -> Result<(), Fault> {
    let [_, derivative, _] = evaluated(call)?;
    call.give(derivative * call.number(5))
}

/// `f″(t) t′² + f′(t) t″`
pub(crate) fn second(call: &mut Call<'_>) -> Result<(), Fault> {
    let [_, derivative, curvature] = evaluated(call)?;
    call.give(curvature * elementary::powi(call.number(5), 2) + derivative * call.number(6))
}

/// The first abscissa.
pub(crate) fn minimum(call: &mut Call<'_>) -> Result<(), Fault> {
    let first = call.object::<TimeTable>(0)?.table.x[0];
    call.give(first)
}

/// The last abscissa.
pub(crate) fn maximum(call: &mut Call<'_>) -> Result<(), Fault> {
    let x = &call.object::<TimeTable>(0)?.table.x;
    let last = x[x.len() - 1];
    call.give(last)
}

/// The first event after a time.
pub(crate) fn next_event(call: &mut Call<'_>) -> Result<(), Fault> {
    let next = call.object::<TimeTable>(0)?.next_event(call.number(1));
    call.give(next)
}

impl TimeTable {
    fn next_event(&self, time: f64) -> f64 {
        if time < self.start {
            return self.start;
        }
        let x = &self.table.x;
        let (first, last) = (x[0], x[x.len() - 1]);
        let period = last - first;
        let periodic = self.table.extrapolation == Extrapolation::Periodic && period > 0.0;
        if self.events == TimeEvents::Never {
            return NEVER;
        }
        let mut u = time - self.shift;
        let mut offset = self.shift;
        if periodic {
            let periods = ((u - first) / period).floor();
            u -= periods * period;
            offset += periods * period;
        }
        // Instants that differ by rounding are one.
        let slack = 1e-12 * u.abs().max(time.abs()).max(period);
        let after = x.partition_point(|abscissa| *abscissa <= u + slack);
        let later = (after..x.len()).find(|at| self.has_event(*at));
        match later {
            Some(at) => x[at] + offset,
            None if periodic => {
                let at = (0..x.len()).find(|at| self.has_event(*at) && x[*at] > first);
                at.map_or(NEVER, |at| x[at] + offset + period)
            }
            None => NEVER,
        }
    }

    /// Whether the value or a derivative jumps at a point.
    fn has_event(&self, at: usize) -> bool {
        let x = &self.table.x;
        let is_end = at == 0 || at + 1 == x.len();
        let repeated = at > 0 && x[at - 1] == x[at] || at + 1 < x.len() && x[at + 1] == x[at];
        let end_jumps = match self.table.extrapolation {
            Extrapolation::LastTwoPoints => self.table.smoothness == Smoothness::Constant,
            _ => true,
        };
        match self.events {
            TimeEvents::Never => false,
            TimeEvents::AtDiscontinuities => {
                repeated
                    || self.table.smoothness == Smoothness::Constant
                    || is_end && self.table.extrapolation == Extrapolation::Periodic
            }
            TimeEvents::Always => match self.table.smoothness {
                Smoothness::Linear | Smoothness::Constant if !is_end => true,
                _ => repeated || is_end && end_jumps,
            },
        }
    }
}
