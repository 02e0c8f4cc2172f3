//! Points measured on either side of an event. Of consecutive points with one time stamp the first is
//! the left limit and the others are the right limit, as in result files of Modelica tools and in
//! tables over time.

use crate::sim::Trajectory;
use std::ops::Range;

/// A value that changes by less, relative to itself, has not jumped: ends of segments of a table are
/// events as well, at which a continuous solution differs by rounding.
const SMALLEST_JUMP: f64 = 1e-9;

/// The side of an event on which a point was measured.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Side {
    Before,
    After,
}

/// A point that is a limit at an event.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Limit {
    side: Side,
    /// The neighboring time stamps: between them the simulated event is looked for.
    neighbors: [f64; 2],
}

/// The points that are limits, in the order of the points. Where every stamp repeats, the points are
/// replicates and none is a limit.
pub fn limits(times: &[f64]) -> Vec<Option<Limit>> {
    let groups: Vec<&[f64]> = times.chunk_by(|a, b| a == b).collect();
    if groups.len() == times.len() || groups.iter().all(|group| group.len() > 1) {
        return vec![None; times.len()];
    }
    let mut found = Vec::with_capacity(times.len());
    for (number, group) in groups.iter().enumerate() {
        let stamp = group[0];
        // Without an ordered neighbor, only an event at the stamp itself is meant.
        let before = number.checked_sub(1).map_or(stamp, |at| groups[at][0].min(stamp));
        let after = groups.get(number + 1).map_or(stamp, |next| next[0].max(stamp));
        for place in 0..group.len() {
            let side = if place == 0 { Side::Before } else { Side::After };
            let limit = Limit { side, neighbors: [before, after] };
            found.push((group.len() > 1).then_some(limit));
        }
    }
    found
}

impl Limit {
    /// The value of column `of` on this side of the event that is meant by the stamp `time`; `y` is
    /// the compared column, of which `of` is itself or a derivative by a parameter.
    ///
    /// An event whose time depends on parameters is rarely simulated at the very stamp. Then the
    /// branch on this side of it is continued to the stamp, so that residuals are continuous in the
    /// parameters and the derivatives are those of the branch.
    pub fn value(&self, trajectory: &Trajectory, [y, of]: [usize; 2], time: f64) -> Option<f64> {
        let Some(event) = self.event(trajectory, y, time) else { return trajectory.at(of, time) };
        let (times, values) = (trajectory.time(), trajectory.column(of));
        let (row, beside) = match self.side {
            Side::Before => (event.start, event.start.checked_sub(1)),
            Side::After => (event.end - 1, Some(event.end).filter(|row| *row < times.len())),
        };
        let distance = time - times[row];
        if distance == 0.0 || of != y {
            return Some(values[row]);
        }
        let rate = |beside: usize| (values[row] - values[beside]) / (times[row] - times[beside]);
        Some(values[row] + distance * beside.map_or(0.0, rate))
    }

    /// The rows of the event: one at the stamp, first of all one at which the compared column jumps; else
    /// the nearest one between the neighboring stamps at which it jumps.
    fn event(&self, trajectory: &Trajectory, y: usize, time: f64) -> Option<Range<usize>> {
        let (times, values) = (trajectory.time(), trajectory.column(y));
        let [low, high] = self.neighbors;
        // Result files often hold time in single precision; not those that tell stamps apart which are
        // nearer: a ball that bounces has two events at once, of which one is the jump.
        let gaps = self.neighbors.map(|own| (own - time).abs()).into_iter();
        let gap = gaps.filter(|gap| *gap > 0.0).fold(f64::INFINITY, f64::min);
        let single = f64::from(f32::EPSILON) * time.abs();
        let rounding = single.min(0.5 * gap);
        let mut nearest: Option<((bool, bool, f64), Range<usize>)> = None;
        let mut row = times.partition_point(|t| *t < low.min(time - rounding));
        while row < times.len() && times[row] <= high.max(time + rounding) {
            let end = times.partition_point(|t| *t <= times[row]);
            let distance = (times[row] - time).abs();
            let is_between = low < times[row] && times[row] < high;
            let [before, after] = [values[row], values[end - 1]];
            let jumps = (after - before).abs() > SMALLEST_JUMP * before.abs().max(after.abs());
            let is_meant = distance <= rounding || is_between && jumps;
            let rank = (distance > single, !jumps, distance);
            let is_nearest = nearest.as_ref().is_none_or(|(least, _)| rank < *least);
            if end - row > 1 && is_meant && is_nearest {
                nearest = Some((rank, row..end));
            }
            row = end;
        }
        nearest.map(|(_, rows)| rows)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// y = t until 1, then 10 - 2 (t - 1); its derivative by a parameter is 3, then 5.
    fn jump() -> Trajectory {
        let mut trajectory = Trajectory::new(2);
        for (t, y, derivative) in
            [(0.0, 0.0, 3.0), (0.5, 0.5, 3.0), (1.0, 1.0, 3.0), (1.0, 10.0, 5.0), (2.0, 8.0, 5.0)]
        {
            trajectory.push(t, &[y, derivative]);
        }
        trajectory
    }

    fn at(times: &[f64], of: usize) -> Vec<f64> {
        let limits = limits(times);
        let value = |(limit, t): (&Option<Limit>, &f64)| match limit {
            Some(limit) => limit.value(&jump(), [0, of], *t),
            None => jump().at(of, *t),
        };
        limits.iter().zip(times).map(|pair| value(pair).unwrap_or(f64::NAN)).collect()
    }

    #[test]
    fn the_first_of_equal_stamps_is_the_left_limit() {
        assert_eq!(at(&[0.5, 1.0, 1.0, 2.0], 0), [0.5, 1.0, 10.0, 8.0]);
        assert_eq!(at(&[0.5, 1.0, 1.0, 1.0], 0), [0.5, 1.0, 10.0, 10.0]);
        assert_eq!(at(&[0.5, 1.0, 1.0, 2.0], 1), [3.0, 3.0, 5.0, 5.0]);
        assert_eq!(at(&[0.5, 1.0, 2.0], 0), [0.5, 10.0, 8.0], "a single row is the right limit");
    }

    /// Two events a rounding apart, at the first of which y jumps, simulated a little too early.
    #[test]
    fn of_two_events_at_once_the_jump_is_meant() {
        let mut trajectory = Trajectory::new(1);
        for (t, y) in [(0.0, 0.0), (1.0, 1.0), (1.0, 10.0)] {
            trajectory.push(t, &[y]);
        }
        for t in [1.0 + 3e-11, 1.0 + 3e-11, 2.0] {
            trajectory.push(t, &[10.0]);
        }
        let times = [0.5, 1.0 + 2e-11, 1.0 + 2e-11, 1.0 + 5e-11, 1.0 + 5e-11, 1.5];
        let limits = limits(&times);
        let found = |at: usize| limits[at].unwrap().value(&trajectory, [0, 0], times[at]).unwrap();
        for (at, expected) in [(1, 1.0), (2, 10.0), (3, 10.0), (4, 10.0)] {
            assert!((found(at) - expected).abs() < 1e-9, "{at}: {}", found(at));
        }
    }

    #[test]
    fn an_event_at_the_stamp_is_meant_whatever_else_jumps() {
        let mut trajectory = Trajectory::new(1);
        for (t, y) in [(0.0, 0.0), (0.9, 0.9), (0.9, 9.0), (1.0, 10.0), (1.0, 10.0), (2.0, 11.0)] {
            trajectory.push(t, &[y]);
        }
        let times = [0.5, 1.0, 1.0, 1.5];
        let found = limits(&times)[1].unwrap().value(&trajectory, [0, 0], 1.0);
        assert_eq!(found, Some(10.0));
    }

    #[test]
    fn a_branch_is_continued_to_the_stamp() {
        let found = at(&[0.5, 1.25, 1.25, 2.0], 0);
        assert_eq!(found, [0.5, 1.25, 9.5, 8.0]);
        assert_eq!(at(&[0.5, 1.25, 1.25, 2.0], 1), [3.0, 3.0, 5.0, 5.0]);
        // Beyond the neighboring stamp, the event is another one.
        assert_eq!(at(&[1.1, 1.25, 1.25, 2.0], 0)[1..3], [9.5, 9.5]);
    }

    #[test]
    fn replicates_are_no_limits() {
        assert!(limits(&[0.0, 0.0, 1.0, 1.0, 1.0]).iter().all(Option::is_none));
        assert!(limits(&[0.0, 1.0, 0.0, 1.0]).iter().all(Option::is_none));
        assert_eq!(limits(&[0.0, 0.0, 1.0]).iter().flatten().count(), 2);
    }
}
