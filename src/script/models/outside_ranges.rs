//! Variables that leave the interval of their `min` and `max` during a simulation (MLS §4.9): the
//! simulation continues with these values, and says so.

use super::translated::Translated;
use crate::Session;
use crate::codegen::Access;
use crate::lower::{Beyond, OutsideRanges};
use crate::runtime::System;
use crate::sim::Trajectory;

/// Warns of each variable that was outside at a row, by more than the errors of the integration and of
/// rounding: once for all elements of an array and all simulations.
///
/// Measured on 150 examples of the standard library: one is warned of, and what is 0 but for
/// rounding (2.6e-34 of a mass fraction) is not.
pub(super) fn warn_outside(
    session: &mut Session,
    model: &Translated,
    system: &System,
    trajectory: &Trajectory,
    tolerance: f64,
) {
    let mut found = OutsideRanges::default();
    for range in system.declared_ranges() {
        let variable = &model.program.variables()[range.variable];
        let Access::Observed { column, negated } = variable.access else { continue };
        // Of a column that is not kept there is the last value alone.
        if column >= trajectory.n_columns() || trajectory.column(column).len() != trajectory.len() {
            continue;
        }
        let sign = if negated { -1.0 } else { 1.0 };
        let values = || trajectory.column(column).iter().map(|value| sign * value);
        let largest = values().fold(0.0, |largest: f64, value| largest.max(value.abs()));
        let slack = f64::max(tolerance * largest, f64::EPSILON * range.nominal);
        for outside in Outside::both(values, trajectory.time(), range.limits, slack) {
            let name = &variable.name;
            if session.models.is_new_warning(range.span, &outside.beyond.subject(name)) {
                let attribute = outside.beyond.attribute;
                let help =
                    format!("see whether the model holds there; else correct the `{attribute}`");
                found.add(name, range.span, outside.sentence(name), help);
            }
        }
    }
    let call = session.call_site();
    found.warnings(Some(call)).for_each(|warning| session.report(warning));
}

/// How a variable leaves its interval.
#[derive(Debug, PartialEq)]
struct Outside {
    beyond: Beyond,
    /// When it is outside first.
    time: f64,
    /// The value farthest outside, and when it has it.
    farthest: (f64, f64),
}

impl Outside {
    /// How it does so on either side.
    fn both<I: Iterator<Item = f64>>(
        values: impl Fn() -> I,
        time: &[f64],
        [min, max]: [f64; 2],
        slack: f64,
    ) -> impl Iterator<Item = Outside> {
        let side = |attribute, limit: f64, beyond: &dyn Fn(f64) -> f64| {
            let mut rows = values().zip(time).filter(|(value, _)| beyond(*value) > slack);
            let (value, first) = rows.next()?;
            let farther = |one: (f64, f64), (value, time): (f64, &f64)| {
                if beyond(value) > beyond(one.0) { (value, *time) } else { one }
            };
            let farthest = rows.fold((value, *first), farther);
            Some(Outside { beyond: Beyond { attribute, limit }, time: *first, farthest })
        };
        let below = side("min", min, &|value| min - value);
        let above = side("max", max, &|value| value - max);
        below.into_iter().chain(above)
    }

    fn sentence(&self, name: &str) -> String {
        let Outside { beyond, time, farthest: (value, at) } = self;
        let beyond = beyond.words();
        if at == time {
            return format!("`{name}` is {value} at t = {at}, {beyond}");
        }
        format!("`{name}` is {beyond} from t = {time}; it is {value} at t = {at}")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn outside(values: &[f64], limits: [f64; 2], slack: f64) -> Vec<String> {
        let time: Vec<f64> = (0..values.len()).map(|row| row as f64).collect();
        let found = Outside::both(|| values.iter().copied(), &time, limits, slack);
        found.map(|outside| outside.sentence("x")).collect()
    }

    #[test]
    fn the_first_and_the_farthest_row_are_named() {
        let said = outside(&[1.0, -0.5, -2.0, 3.0], [0.0, f64::INFINITY], 1e-6);
        assert_eq!(said, ["`x` is below its `min` of 0 from t = 1; it is -2 at t = 2"]);
        let said = outside(&[1.0, 7.0, -3.0], [0.0, 4.0], 1e-6);
        let below = "`x` is -3 at t = 2, below its `min` of 0";
        assert_eq!(said, [below, "`x` is 7 at t = 1, above its `max` of 4"]);
    }

    #[test]
    fn errors_of_the_integration_are_not_said() {
        assert_eq!(outside(&[10.0, -9e-6, 5.0], [0.0, f64::INFINITY], 1e-5), [""; 0]);
        assert!(!outside(&[10.0, -11e-6, 5.0], [0.0, f64::INFINITY], 1e-5).is_empty());
        assert_eq!(outside(&[1.0, 2.0], [f64::NEG_INFINITY, f64::INFINITY], 1e-6), [""; 0]);
        assert_eq!(outside(&[f64::NAN, 2.0], [0.0, 3.0], 1e-6), [""; 0]);
    }
}
