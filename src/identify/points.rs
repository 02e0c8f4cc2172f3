//! Where on a simulated trajectory the measured points lie.

use super::errors::{NOT_MONOTONE, POINTS_OUTSIDE};
use crate::diag::Fault;
use crate::table::significant;
use crate::{bail, fault};

/// Where X ends up from a measured value, at the time at which it is nearest, by more than this part
/// of what it changes by in a slice, it jumps there. Times are found to the last bit: a slice of one
/// 500th of a simulation that begins at 1e6 times its length has 2e-7.
const JUMP: f64 = 1e-6;

/// Whether X, this far from a value at the nearest time in a slice in which it changes by `change`,
/// jumps over that value.
pub(crate) fn is_jump(distance: f64, change: f64) -> bool {
    distance.abs() > JUMP * change.abs()
}

/// A simulated trajectory of X: times, not decreasing, and the values there.
#[derive(Debug, Clone, Copy)]
pub struct Path<'a> {
    /// Times.
    pub times: &'a [f64],
    /// X at those times; equal length.
    pub x: &'a [f64],
}

impl Path<'_> {
    /// The slice `k..=k + 1` of the path in which X first takes the value `target`. X may be held at
    /// this value, as after a ramp, and then continue in the direction from which it came.
    ///
    /// # Errors
    ///
    /// `points-outside` when X never takes it, `not-monotone` when it returns to it.
    pub(crate) fn slice_of(&self, name: &str, target: f64) -> Result<usize, Fault> {
        let mut found: Option<usize> = None;
        for k in 0..self.x.len().saturating_sub(1) {
            let (a, b) = (self.x[k], self.x[k + 1]);
            let holds = (a <= target && target <= b) || (b <= target && target <= a);
            if !holds || self.times[k] == self.times[k + 1] {
                continue;
            }
            let returns = |before: usize| {
                let is_held = self.x[before + 1..=k].iter().all(|&x| x == target);
                !is_held || (b != target && !self.turns_on(k, target))
            };
            if let Some(before) = found.filter(|&before| returns(before)) {
                bail!(
                    NOT_MONOTONE,
                    "`{name}` takes the measured value {target} at several times, such as {} s \
                     and {} s",
                    self.times[before],
                    self.times[k + 1];
                    help: "use `time` as X, or an experiment in which `{name}` is monotonic"
                );
            }
            found = found.or(Some(k));
        }
        found.ok_or_else(|| {
            let passes = |k: &usize| (self.x[*k] < target) != (self.x[k + 1] < target);
            match (0..self.x.len().saturating_sub(1)).find(passes) {
                Some(k) => self.jumps_over(name, target, self.times[k]),
                None => self.outside(name, &[target]),
            }
        })
    }

    /// How far into slice `k` X takes the value `target`: from 0, where it is held there, to 1.
    pub(crate) fn share(&self, k: usize, target: f64) -> f64 {
        match self.x[k + 1] - self.x[k] {
            0.0 => 0.0,
            change => (target - self.x[k]) / change,
        }
    }

    /// The fault that says where X jumps over a point.
    pub(crate) fn jumps_over(&self, name: &str, target: f64, time: f64) -> Fault {
        fault!(
            POINTS_OUTSIDE,
            "measured at `{name}` = {target}, but the simulated `{name}` jumps over this value at \
             {} s",
            significant(time, 6);
            help: "remove this point, or use `time` as X"
        )
    }

    /// Whether X continues beyond `target` in slice `k`, which starts there, in the direction from
    /// which it came.
    fn turns_on(&self, k: usize, target: f64) -> bool {
        let came_from = self.x[..k].iter().rev().find(|&&x| x != target);
        came_from.is_none_or(|&before| (before < target) == (target < self.x[k + 1]))
    }

    /// The fault that names the points which X does not reach.
    pub fn outside(&self, name: &str, points: &[f64]) -> Fault {
        let low = self.x.iter().copied().fold(f64::INFINITY, f64::min);
        let high = self.x.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        let named: Vec<String> = points.iter().take(8).map(f64::to_string).collect();
        let more = if points.len() > named.len() { ", …" } else { "" };
        fault!(
            POINTS_OUTSIDE,
            "measured at `{name}` = {}{more}, but simulated only from {low} to {high}",
            named.join(", ");
            help: "extend the simulation of `{name}` to the measured range, or remove those points"
        )
    }

    /// All targets that lie outside the range of X.
    pub(crate) fn targets_outside(&self, targets: &[f64]) -> Vec<f64> {
        let low = self.x.iter().copied().fold(f64::INFINITY, f64::min);
        let high = self.x.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        targets.iter().copied().filter(|target| !(low..=high).contains(target)).collect()
    }

    /// `y`, given at the same times, interpolated linearly in X at the targets.
    ///
    /// # Errors
    ///
    /// As [`Path::slice_of`].
    pub fn interpolate(
        &self,
        name: &str,
        y: &[f64],
        targets: &[f64],
        out: &mut [f64],
    ) -> Result<(), Fault> {
        for (value, &target) in out.iter_mut().zip(targets) {
            let k = self.slice_of(name, target)?;
            let fraction = self.share(k, target);
            *value = y[k] + (y[k + 1] - y[k]) * fraction;
        }
        Ok(())
    }
}

/// Where X has the same value at a time and this part of a slice before or after it, it is held: its
/// first time is looked for. X that changes by more than 1e-9 of its value in a slice differs by then.
const HELD: f64 = 1e-6;

/// The first time in `low..=high` at which `x_at` takes the value `target`, which lies between its
/// values at the ends: halves the interval until no number lies between its ends.
pub fn time_of<E>(
    mut low: f64,
    mut high: f64,
    target: f64,
    mut x_at: impl FnMut(f64) -> Result<f64, E>,
) -> Result<f64, E> {
    let (x_low, x_high) = (x_at(low)?, x_at(high)?);
    if x_low == target {
        return Ok(low);
    }
    let (earlier, end) = (HELD * (high - low), high);
    if x_high == target && x_at(high - earlier)? != target {
        return Ok(high);
    }
    let rises = x_low < x_high;
    loop {
        let middle = low + (high - low) / 2.0;
        if middle <= low || middle >= high {
            let nearer = (x_at(low)? - target).abs() <= (x_at(high)? - target).abs();
            return Ok(if nearer { low } else { high });
        }
        let x = x_at(middle)?;
        if x == target {
            let (before, after) = (middle - earlier, (middle + earlier).min(end));
            if x_at(before)? != target && x_at(after)? != target {
                return Ok(middle);
            }
        }
        if x != target && (x < target) == rises {
            low = middle;
        } else {
            high = middle;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    const TIMES: [f64; 4] = [0.0, 1.0, 2.0, 3.0];

    #[test]
    fn interpolates_in_x_rising_and_falling() {
        let mut out = [0.0; 4];
        let rising = Path { times: &TIMES, x: &[0.0, 1.0, 4.0, 9.0] };
        let y = [0.0, 10.0, 20.0, 30.0];
        rising.interpolate("x", &y, &[0.5, 1.0, 9.0, 0.0], &mut out).unwrap();
        assert_eq!(out, [5.0, 10.0, 30.0, 0.0]);
        let falling = Path { times: &TIMES, x: &[3.0, 2.0, 1.0, 0.0] };
        falling.interpolate("x", &y, &[2.5, 1.0, 0.0, 3.0], &mut out).unwrap();
        assert_eq!(out, [5.0, 20.0, 30.0, 0.0]);
    }

    #[test]
    fn points_outside_are_named() {
        let path = Path { times: &TIMES, x: &[0.0, 1.0, 2.0, 3.0] };
        let fault = path.slice_of("i", 3.5).unwrap_err();
        assert_eq!(fault.code, POINTS_OUTSIDE);
        assert!(fault.message.contains("`i` = 3.5") && fault.message.contains("0 to 3"));
        assert_eq!(path.targets_outside(&[-1.0, 0.0, 3.0, 4.0]), [-1.0, 4.0]);
    }

    #[test]
    fn turning_back_is_refused_and_standing_still_is_not() {
        let back = Path { times: &TIMES, x: &[0.0, 2.0, 1.0, 3.0] };
        assert_eq!(back.slice_of("x", 1.5).unwrap_err().code, NOT_MONOTONE);
        assert_eq!(back.slice_of("x", 0.5), Ok(0), "not used where it turns back");
        let peak = Path { times: &TIMES, x: &[0.0, 2.0, 0.0, -1.0] };
        assert_eq!(peak.slice_of("x", 0.0).unwrap_err().code, NOT_MONOTONE);
        assert_eq!(peak.slice_of("x", 2.0).unwrap_err().code, NOT_MONOTONE, "touches the peak");
        let still = Path { times: &TIMES, x: &[0.0, 1.0, 1.0, 2.0] };
        assert_eq!(still.slice_of("x", 1.0), Ok(0), "where it is reached first");
        let mut held = [0.0; 3];
        let y = [0.0, 10.0, 20.0, 30.0];
        let begins = Path { times: &TIMES, x: &[1.0, 1.0, 2.0, 2.0] };
        begins.interpolate("x", &y, &[1.0, 1.5, 2.0], &mut held).unwrap();
        assert_eq!(held, [0.0, 15.0, 20.0], "held at both ends");
        let trapezoid = Path { times: &TIMES, x: &[0.0, 1.0, 1.0, 0.0] };
        assert_eq!(trapezoid.slice_of("x", 1.0).unwrap_err().code, NOT_MONOTONE);
        let again = Path { times: &[0.0, 1.0, 2.0, 2.0, 3.0], x: &[1.0, 1.0, 2.0, 1.0, 1.0] };
        assert_eq!(again.slice_of("x", 1.0).unwrap_err().code, NOT_MONOTONE, "left and back");
        let event = Path { times: &[0.0, 1.0, 1.0, 2.0], x: &[0.0, 1.0, 1.0, 2.0] };
        assert_eq!(event.slice_of("x", 1.0), Ok(0), "two rows at an event are one time");
    }

    #[test]
    fn a_value_that_is_jumped_over_is_named_with_the_time() {
        let event = Path { times: &[0.0, 1.0, 1.0, 2.0], x: &[0.0, 1.0, 2.0, 3.0] };
        let fault = event.slice_of("x", 1.5).unwrap_err();
        assert_eq!(fault.code, POINTS_OUTSIDE);
        assert!(fault.message.ends_with("jumps over this value at 1 s"), "{}", fault.message);
        assert_eq!(event.slice_of("x", 2.0), Ok(2), "reached after the jump");
    }

    #[test]
    fn time_of_a_ramp_is_exact() {
        let time = time_of(0.0, 1.0, 0.107, |t| Ok::<f64, ()>(1.46 * t)).unwrap();
        assert!((1.46 * time - 0.107).abs() <= 1.4e-17, "{}", 1.46 * time - 0.107);
        assert_eq!(time_of(0.0, 1.0, 1.46, |t| Ok::<f64, ()>(1.46 * t)), Ok(1.0));
        assert_eq!(time_of(0.0, 4.0, 7.0, |t| Ok::<f64, ()>(10.0 - t)), Ok(3.0));
    }

    #[test]
    fn the_first_time_of_a_held_value_is_found() {
        for end in [0.1, 0.5, 0.703, 0.999, 1.0] {
            let held = |t: f64| Ok::<f64, ()>(t.min(end));
            assert_eq!(time_of(0.0, 1.0, end, held), Ok(end));
            let falls = |t: f64| Ok::<f64, ()>(-t.min(end));
            assert_eq!(time_of(0.0, 1.0, -end, falls), Ok(end));
            // In the middle, and then on.
            let rests = |t: f64| Ok::<f64, ()>(t.min(end).max(t - 0.05));
            let time = time_of(0.0, 1.2, end, rests).unwrap();
            assert!((time - end).abs() < 1e-15, "{time} {end}");
        }
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(64))]
        #[test]
        fn time_of_inverts_a_monotone_function(t in 0.0..2.0_f64) {
            let time = time_of(0.0, 2.0, t.exp(), |t| Ok::<f64, ()>(t.exp())).unwrap();
            prop_assert!((time - t).abs() < 1e-14);
        }
    }
}
