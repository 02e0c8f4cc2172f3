//! `delay(e, d)` (MLS §3.7.4.1): the past values of an expression.
//!
//! The past is a chain of smooth pieces with jumps between them; within a piece the value is that of
//! the cubic through the four points around. Before the start it is the first value. The piece that
//! is read changes at events only, so that a step never sees both sides of a jump.

use super::instants::same_time;
use serde::{Deserialize, Serialize};
use std::collections::VecDeque;

/// Points of one interpolation.
const POINTS: usize = 4;
/// Values whose relative difference is not larger are the same.
const SAME: f64 = 1e-9;
/// Smallest distance of two points, relative to the next distance.
const NEAR: f64 = 0.05;

/// The past of one expression.
#[derive(Debug, Clone, Default, Serialize, Deserialize)]
pub(super) struct History {
    /// Times, not descending; equal ones at a jump.
    times: VecDeque<f64>,
    pub(super) values: VecDeque<f64>,
    /// Positions of the first points of the pieces after the one that is read.
    jumps: VecDeque<usize>,
    /// Position of the first point of the piece that is read; `None` before the start.
    first: Option<usize>,
}

impl History {
    /// Forgets everything and starts with a value.
    pub(super) fn start(&mut self, t: f64, value: f64) {
        self.times.clear();
        self.values.clear();
        self.jumps.clear();
        self.first = None;
        self.times.push_back(t);
        self.values.push_back(value);
        self.jumps.push_back(0);
    }

    /// Adds the value at a time that is not before the last one; at the same time another value is
    /// a jump.
    pub(super) fn push(&mut self, t: f64, value: f64) {
        let (Some(last), Some(old)) = (self.times.back(), self.values.back()) else { return };
        if t < *last || (t == *last && !differ(value, *old)) {
            return;
        }
        if t == *last {
            self.jumps.push_back(self.times.len());
        } else {
            self.thin(t);
        }
        self.times.push_back(t);
        self.values.push_back(value);
    }

    /// Drops the last point if it is so near to the one before it, compared with `t`, that the
    /// cubic would amplify its rounding.
    fn thin(&mut self, t: f64) {
        let n = self.times.len();
        let piece = self.jumps.back().copied().or(self.first).unwrap_or(0);
        if n >= piece + 2 {
            let (a, b) = (self.times[n - 2], self.times[n - 1]);
            if b - a < NEAR * (t - b) {
                self.times.pop_back();
                self.values.pop_back();
            }
        }
    }

    /// The value at a past time, in the piece that is read.
    pub(super) fn value(&self, t: f64) -> f64 {
        let Some(first) = self.first else { return self.values.front().copied().unwrap_or(0.0) };
        let end = self.jumps.front().copied().unwrap_or(self.times.len());
        let n = (end - first).min(POINTS);
        let after = self.times.partition_point(|time| *time <= t);
        let start = after.saturating_sub(n / 2).clamp(first, end - n);
        cubic(&self.times, &self.values, start..start + n, t)
    }

    /// Whether the value at this time has been recorded, or lies before the start.
    pub(super) fn reaches(&self, t: f64) -> bool {
        self.times.back().is_none_or(|last| t <= *last || same_time(t, *last))
    }

    /// Whether it can be read: it may come from another process.
    pub(super) fn is_valid(&self) -> bool {
        let n = self.times.len();
        n > 0
            && self.values.len() == n
            && self.times.iter().is_sorted()
            && self.first.into_iter().chain(self.jumps.iter().copied()).is_sorted_by(|a, b| a < b)
            && self.jumps.back().copied().or(self.first).is_none_or(|last| last < n)
    }

    /// When the piece that is read ends, if the next one is known.
    pub(super) fn next_jump(&self) -> Option<f64> {
        self.jumps.front().map(|at| self.times[*at])
    }

    /// Advances to the pieces that begin up to `t` and forgets what lies far before it.
    pub(super) fn advance(&mut self, t: f64) {
        while let Some(at) = self.jumps.front().copied()
            && (self.times[at] <= t || same_time(self.times[at], t))
        {
            self.first = Some(at);
            self.jumps.pop_front();
        }
        self.forget(t);
    }

    /// Drops points that no interpolation from `t` on needs.
    fn forget(&mut self, t: f64) {
        let Some(first) = self.first else { return };
        let unused = self.times.partition_point(|time| *time <= t).saturating_sub(2 * POINTS);
        if unused < 64 {
            return;
        }
        self.times.drain(..unused);
        self.values.drain(..unused);
        self.first = Some(first.saturating_sub(unused));
        self.jumps.iter_mut().for_each(|at| *at -= unused);
    }
}

/// Whether two values are a jump rather than rounding.
pub(super) fn differ(a: f64, b: f64) -> bool {
    (a - b).abs() > SAME * a.abs().max(b.abs())
}

/// The polynomial through a range of points at `t`, in the form of Lagrange.
pub(super) fn cubic(
    at: &VecDeque<f64>,
    values: &VecDeque<f64>,
    range: std::ops::Range<usize>,
    t: f64,
) -> f64 {
    // Differences to one of the values: a constant stays what it is, to the last bit.
    let one = values[range.start];
    let mut value = one;
    for i in range.start + 1..range.end {
        let mut weight = 1.0;
        for j in range.clone() {
            if j != i {
                weight *= (t - at[j]) / (at[i] - at[j]);
            }
        }
        value += weight * (values[i] - one);
    }
    value
}

#[cfg(test)]
mod tests {
    use super::*;

    fn recorded(step: f64, count: usize, value: impl Fn(f64) -> f64) -> History {
        let mut history = History::default();
        history.start(0.0, value(0.0));
        (1..=count).for_each(|i| history.push(step * i as f64, value(step * i as f64)));
        history
    }

    #[test]
    fn before_the_start_everything_was_as_at_the_start() {
        let history = recorded(0.1, 10, |t| 3.0 + t);
        assert_eq!(history.value(-1.0), 3.0);
        assert_eq!(history.next_jump(), Some(0.0));
    }

    #[test]
    fn cubics_are_exact_within_a_piece() {
        let cubic = |t: f64| 1.0 - 2.0 * t + 0.5 * t * t - t * t * t;
        let mut history = recorded(0.3, 20, cubic);
        history.advance(0.0);
        for t in [0.0, 0.05, 1.234, 5.99, 6.0] {
            assert!((history.value(t) - cubic(t)).abs() < 1e-11, "at {t}");
        }
    }

    #[test]
    fn constants_stay_what_they_are() {
        let history = recorded(0.1 / 3.0, 30, |_| 3.0);
        let mut passed = history.clone();
        passed.advance(0.0);
        for i in 0..1000 {
            assert_eq!(passed.value(1e-3 * f64::from(i) - 1e-12), 3.0);
        }
    }

    #[test]
    fn a_jump_is_passed_when_time_comes_to_it() {
        let mut history = recorded(0.1, 10, |_| 1.0);
        let at = 0.1 * 10.0;
        history.push(at, 5.0);
        history.push(at, 5.0);
        history.push(2.0, 5.0);
        history.advance(0.0);
        assert_eq!(history.next_jump(), Some(at));
        assert_eq!(history.value(at), 1.0);
        history.advance(at);
        assert_eq!(history.next_jump(), None);
        assert_eq!(history.value(at), 5.0);
    }

    #[test]
    fn old_values_are_forgotten() {
        let mut history = recorded(0.01, 10_000, f64::sin);
        for i in 0..99 {
            history.advance(f64::from(i));
        }
        assert!(history.times.len() < 400, "{}", history.times.len());
        assert!((history.value(98.5) - 98.5f64.sin()).abs() < 1e-8);
    }

    #[test]
    fn points_close_together_do_not_spoil_the_cubic() {
        let mut history = History::default();
        history.start(0.0, 0.0);
        for t in [1e-9, 2e-9, 3e-9, 0.1, 0.2, 0.3f64] {
            history.push(t, t.sin());
        }
        history.advance(0.0);
        assert!((history.value(0.05) - 0.05f64.sin()).abs() < 1e-4);
    }
}
