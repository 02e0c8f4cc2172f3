//! The tube around a reference trajectory: the area that a rectangle sweeps whose centre moves along
//! it. A result agrees where it stays inside. This is the criterion that the Modelica Association
//! publishes with its comparison of results (`csv-compare`): both sides of the rectangle are the
//! tolerance times the extent of the reference, in time and in value. Jumps may so happen a little
//! earlier or later, and a steep flank counts no more than a flat one.

/// The tolerance that the Modelica Association compares with, relative to the reference's extent.
pub const TUBE_TOLERANCE: f64 = 0.002;

/// What the value's extent is at least, relative to the largest magnitude: what varies less is as
/// good as constant, and its own extent is rounding.
const LEAST_EXTENT: f64 = 0.01;

/// Times that differ by less than this part of themselves are one instant.
const SAME_INSTANT: f64 = 1e-12;

/// Half height of a tube around values that are all zero.
const LEAST_HEIGHT: f64 = 1e-12;

/// The tube around a reference trajectory, which is linear between its points.
#[derive(Debug, Clone)]
pub struct Tube<'a> {
    time: &'a [f64],
    values: &'a [f64],
    half_width: f64,
    half_height: f64,
}

/// A point outside of a tube.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Deviation {
    /// Time, seconds.
    pub time: f64,
    /// The value of the result.
    pub value: f64,
    /// The least value inside the tube.
    pub lower: f64,
    /// The greatest value inside the tube.
    pub upper: f64,
}

impl<'a> Tube<'a> {
    /// The tube around values at ascending times, one value a time and at least one of them.
    pub fn around(time: &'a [f64], values: &'a [f64], tolerance: f64) -> Tube<'a> {
        let extent = |all: &[f64]| {
            let (least, greatest) = bounds(all.iter().copied());
            greatest - least
        };
        let magnitude = values.iter().fold(0.0f64, |most, value| most.max(value.abs()));
        let height = extent(values).max(LEAST_EXTENT * magnitude);
        Tube {
            time,
            values,
            half_width: tolerance * extent(time),
            half_height: (tolerance * height).max(LEAST_HEIGHT),
        }
    }

    /// Least and greatest value inside the tube at a time; beyond the ends of the reference those
    /// at its ends.
    pub fn bounds(&self, time: f64) -> (f64, f64) {
        let end = self.time[self.time.len() - 1];
        let early = (time - self.half_width).clamp(self.time[0], end);
        let late = (time + self.half_width).clamp(self.time[0], end);
        let first = self.time.partition_point(|t| *t < early);
        let after = self.time.partition_point(|t| *t <= late);
        let inside = self.values[first..after].iter().copied();
        let at_sides = [self.at(early), self.at(late)];
        let (least, greatest) = bounds(inside.chain(at_sides));
        (least - self.half_height, greatest + self.half_height)
    }

    /// The point of a result farthest outside, if one is. Looked at are the result's own points
    /// between the ends of the reference, and the points that it has at the times of the reference.
    /// Of several points at one instant, the first and the last are the limits from both sides, and
    /// those between are steps of an event; at the end of the reference the limit from the left
    /// counts, for that is where it may end.
    pub(crate) fn worst_deviation(&self, time: &[f64], values: &[f64]) -> Option<Deviation> {
        let (start, stop) = (self.time[0], self.time[self.time.len() - 1]);
        let is_within = |at: usize, other: Option<usize>| {
            other.and_then(|other| time.get(other)).is_some_and(|t| same_instant(*t, time[at]))
        };
        let counts = |at: &usize| {
            let (follows, precedes) =
                (is_within(*at, at.checked_sub(1)), is_within(*at, Some(at + 1)));
            let is_end = same_instant(time[*at], stop);
            (start..=stop).contains(&time[*at]) && !(follows && (precedes || is_end))
        };
        let own = (0..time.len()).filter(counts).map(|at| (time[at], values[at]));
        let is_own = |t: f64| {
            let at = time.partition_point(|own| *own < t && !same_instant(*own, t));
            time.get(at).is_some_and(|own| same_instant(*own, t))
        };
        let inner = self.time.iter().filter(|t| !is_own(**t));
        let between = inner.filter_map(|t| Some((*t, interpolated(time, values, *t)?)));
        own.chain(between)
            .filter_map(|(time, value)| self.deviation(time, value))
            .max_by(|a, b| self.distance(a).total_cmp(&self.distance(b)))
    }

    /// The tube with sides of the same lengths around another trajectory.
    pub(super) fn around_other<'b>(&self, time: &'b [f64], values: &'b [f64]) -> Tube<'b> {
        Tube { time, values, half_width: self.half_width, half_height: self.half_height }
    }

    /// The sample farthest outside of all tubes, if one is, and how far outside the nearest: with the
    /// value of its trajectory at that time, and the bounds that the sample sets.
    pub(super) fn worst_sample(
        tubes: &[Tube],
        time: &[f64],
        samples: &[f64],
    ) -> Option<(Deviation, f64)> {
        let outside = time.iter().zip(samples).filter_map(|(time, sample)| {
            let found = tubes.iter().map(|tube| tube.sample_outside(*time, *sample));
            let found = found.collect::<Option<Vec<_>>>()?;
            found.into_iter().min_by(|(_, a), (_, b)| a.total_cmp(b))
        });
        outside.max_by(|(_, a), (_, b)| a.total_cmp(b))
    }

    fn sample_outside(&self, time: f64, sample: f64) -> Option<(Deviation, f64)> {
        let found = self.deviation(time, sample)?;
        let (lower, upper) = (sample - self.half_height, sample + self.half_height);
        let deviation = Deviation { time, value: self.at(time), lower, upper };
        Some((deviation, self.distance(&found)))
    }

    fn deviation(&self, time: f64, value: f64) -> Option<Deviation> {
        let (lower, upper) = self.bounds(time);
        let is_inside = lower <= value && value <= upper;
        (!is_inside).then_some(Deviation { time, value, lower, upper })
    }

    /// How far outside, in half heights of the tube; infinite for what is not a number.
    pub fn distance(&self, deviation: &Deviation) -> f64 {
        let outside = (deviation.lower - deviation.value).max(deviation.value - deviation.upper);
        if outside.is_nan() { f64::INFINITY } else { outside / self.half_height }
    }

    /// How far the tube reaches before and after a point, seconds.
    pub(crate) fn half_width(&self) -> f64 {
        self.half_width
    }

    fn at(&self, time: f64) -> f64 {
        interpolated(self.time, self.values, time).unwrap_or(f64::NAN)
    }
}

fn same_instant(a: f64, b: f64) -> bool {
    (a - b).abs() <= SAME_INSTANT * a.abs().max(b.abs())
}

/// Least and greatest; numbers that are none are passed over.
fn bounds(values: impl Iterator<Item = f64>) -> (f64, f64) {
    values.fold((f64::INFINITY, f64::NEG_INFINITY), |(least, greatest), value| {
        (least.min(value), greatest.max(value))
    })
}

/// Linear between points; the last of those with this time; `None` outside.
fn interpolated(times: &[f64], values: &[f64], time: f64) -> Option<f64> {
    let after = times.partition_point(|t| *t <= time);
    let last = after.checked_sub(1)?;
    if times[last] == time {
        return Some(values[last]);
    }
    let share = (time - times[last]) / (times.get(after)? - times[last]);
    Some(values[last] + share * (values[after] - values[last]))
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    const TIME: [f64; 5] = [0.0, 1.0, 1.0, 2.0, 10.0];
    /// A jump from 1 to 5 at time 1.
    const JUMP: [f64; 5] = [1.0, 1.0, 5.0, 5.0, 5.0];

    #[test]
    fn sides_are_the_tolerance_times_the_extents() {
        let tube = Tube::around(&TIME, &JUMP, 0.05);
        assert_eq!(tube.half_width(), 0.5);
        assert_eq!(tube.bounds(0.25), (0.8, 1.2));
        assert_eq!(tube.bounds(0.75), (0.8, 5.2));
        assert_eq!(tube.bounds(1.25), (0.8, 5.2));
        assert_eq!(tube.bounds(8.0), (4.8, 5.2));
        assert_eq!(tube.bounds(-1.0), (0.8, 1.2));
    }

    #[test]
    fn jumps_may_come_early_but_not_too_early() {
        let tube = Tube::around(&TIME, &JUMP, 0.05);
        assert_eq!(tube.worst_deviation(&[0.0, 0.6, 0.6, 10.0], &[1.0, 1.0, 5.0, 5.0]), None);
        let early = tube.worst_deviation(&[0.0, 0.4, 0.4, 10.0], &[1.0, 1.0, 5.0, 5.0]);
        let Deviation { time, value, upper, .. } = early.expect("outside");
        assert_eq!((time, value, upper), (0.4, 5.0, 1.2));
    }

    #[test]
    fn results_with_few_points_are_looked_at_between_them() {
        let (time, values) = ([0.0, 1.0, 2.0], [0.0, 1.0, 0.0]);
        let tube = Tube::around(&time, &values, 0.01);
        let flat = tube.worst_deviation(&[0.0, 2.0], &[0.0, 0.0]).expect("outside");
        assert_eq!((flat.time, flat.value), (1.0, 0.0));
    }

    #[test]
    fn steps_within_an_instant_do_not_count() {
        let (time, values) = ([0.0, 1.0, 2.0], [0.0, 0.0, 0.0]);
        let tube = Tube::around(&time, &values, 0.01);
        let ending_at = |last: f64| {
            let later = 1.0 + 4.0 * f64::EPSILON;
            let time = [0.0, 1.0, 1.0, later, later, 2.0, 2.0];
            tube.worst_deviation(&time, &[0.0, 0.0, 1.0, 1.0, last, 0.0, 3.0])
        };
        assert_eq!(ending_at(0.0), None);
        assert_eq!(ending_at(1.0).expect("outside").value, 1.0);
        assert!(tube.worst_deviation(&[0.0, 1.0, 1.1, 2.0], &[0.0, 1.0, 1.0, 0.0]).is_some());
        assert!(tube.worst_deviation(&[0.0, 2.0], &[0.0, 3.0]).is_some());
    }

    #[test]
    fn what_is_no_number_is_outside() {
        let tube = Tube::around(&TIME, &JUMP, 0.05);
        let found = tube.worst_deviation(&[0.0, 3.0, 10.0], &[1.0, f64::NAN, 5.0]);
        assert!(found.expect("outside").value.is_nan());
    }

    #[test]
    fn constants_get_a_tube_of_their_magnitude() {
        let tube = Tube::around(&[0.0, 1.0], &[300.0, 300.0], 0.002);
        let (lower, upper) = tube.bounds(0.5);
        assert!((upper - 300.006).abs() < 1e-12 && (lower - 299.994).abs() < 1e-12);
        assert_eq!(Tube::around(&[0.0], &[0.0], 0.002).bounds(0.0), (-1e-12, 1e-12));
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(64))]

        /// A reference lies in its own tube, shifted by less than a side too.
        #[test]
        fn shifted_references_agree(
            values in prop::collection::vec(-5.0..5.0f64, 2..30),
            (x, y) in (-0.9..0.9f64, -0.9..0.9f64),
        ) {
            let time: Vec<f64> = (0..values.len()).map(|t| t as f64).collect();
            let tube = Tube::around(&time, &values, 0.01);
            let shifted: Vec<f64> = values.iter().map(|v| v + y * tube.half_height).collect();
            prop_assert_eq!(tube.worst_deviation(&time, &shifted), None);
            let later: Vec<f64> = time.iter().map(|t| t + x * tube.half_width).collect();
            prop_assert_eq!(tube.worst_deviation(&later, &values), None);
        }
    }
}
