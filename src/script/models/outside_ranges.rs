//! Variables that leave the interval of their `min` and `max` during a simulation (MLS §4.9): the
//! simulation continues with these values, and says so.

use super::translated::Translated;
use crate::Session;
use crate::codegen::Access;
use crate::diag::Fault;
use crate::lower::errors::OUTSIDE_RANGE;
use crate::runtime::System;
use crate::sim::Trajectory;

/// So many variables are named after a simulation; of the others the number is said.
const MOST_NAMED: usize = 5;

/// Warns of each declaration whose variables were outside at a row, by more than the errors of the
/// integration and of rounding: once for all elements of an array and all simulations.
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
    let mut named = 0;
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
        let Some(outside) = Outside::of(values, trajectory.time(), range.limits, slack) else {
            continue;
        };
        let attribute = outside.attribute;
        if !session.models.is_new_warning(range.span, attribute) {
            continue;
        }
        named += 1;
        if named <= MOST_NAMED {
            let message = outside.sentence(&variable.name);
            let help = format!("see whether the model holds there; else correct the `{attribute}`");
            session.report(Fault::new(OUTSIDE_RANGE, message).help(help).at(range.span).warning());
        }
    }
    if named > MOST_NAMED {
        let message = format!("{} more variables leave their intervals", named - MOST_NAMED);
        session.report(Fault::new(OUTSIDE_RANGE, message).at(session.call_site()).warning());
    }
}

/// How a variable leaves its interval.
#[derive(Debug, PartialEq)]
struct Outside {
    /// `min` or `max`.
    attribute: &'static str,
    limit: f64,
    /// When it is outside first.
    time: f64,
    /// The value farthest outside, and when it has it.
    farthest: (f64, f64),
}

impl Outside {
    /// `None`: it does not.
    fn of<I: Iterator<Item = f64>>(
        values: impl Fn() -> I,
        time: &[f64],
        [min, max]: [f64; 2],
        slack: f64,
    ) -> Option<Outside> {
        let first = |attribute, limit: f64, beyond: &dyn Fn(f64) -> f64| {
            let mut rows = values().zip(time).filter(|(value, _)| beyond(*value) > slack);
            let (value, first) = rows.next()?;
            let farther = |one: (f64, f64), (value, time): (f64, &f64)| {
                if beyond(value) > beyond(one.0) { (value, *time) } else { one }
            };
            let farthest = rows.fold((value, *first), farther);
            Some(Outside { attribute, limit, time: *first, farthest })
        };
        first("min", min, &|value| min - value).or_else(|| first("max", max, &|value| value - max))
    }

    fn sentence(&self, name: &str) -> String {
        let Outside { attribute, limit, time, farthest: (value, at) } = self;
        let side = if *attribute == "min" { "below" } else { "above" };
        if at == time {
            return format!("`{name}` is {value} at t = {at}, {side} its `{attribute}` of {limit}");
        }
        format!(
            "`{name}` is {side} its `{attribute}` of {limit} from t = {time}; it is {value} at t = {at}"
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn outside(values: &[f64], limits: [f64; 2], slack: f64) -> Option<String> {
        let time: Vec<f64> = (0..values.len()).map(|row| row as f64).collect();
        let found = Outside::of(|| values.iter().copied(), &time, limits, slack);
        found.map(|outside| outside.sentence("x"))
    }

    #[test]
    fn the_first_and_the_farthest_row_are_named() {
        let said = outside(&[1.0, -0.5, -2.0, 3.0], [0.0, f64::INFINITY], 1e-6);
        assert_eq!(
            said.as_deref(),
            Some("`x` is below its `min` of 0 from t = 1; it is -2 at t = 2")
        );
        let said = outside(&[1.0, 7.0, 3.0], [f64::NEG_INFINITY, 4.0], 1e-6);
        assert_eq!(said.as_deref(), Some("`x` is 7 at t = 1, above its `max` of 4"));
    }

    #[test]
    fn errors_of_the_integration_are_not_said() {
        assert_eq!(outside(&[10.0, -9e-6, 5.0], [0.0, f64::INFINITY], 1e-5), None);
        assert!(outside(&[10.0, -11e-6, 5.0], [0.0, f64::INFINITY], 1e-5).is_some());
        assert_eq!(outside(&[1.0, 2.0], [f64::NEG_INFINITY, f64::INFINITY], 1e-6), None);
        assert_eq!(outside(&[f64::NAN, 2.0], [0.0, 3.0], 1e-6), None);
    }
}
