//! A function of one variable through the points of a table.

use super::spline::Spline;
use std::sync::atomic::{AtomicUsize, Ordering};

/// How points are connected; the order of `Modelica.Blocks.Types.Smoothness`.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Smoothness {
    Linear,
    Constant,
    Spline(Spline),
}

impl Smoothness {
    pub(crate) fn from_ordinal(ordinal: i64) -> Option<Smoothness> {
        Some(match ordinal {
            1 => Smoothness::Linear,
            2 => Smoothness::Spline(Spline::Akima),
            3 => Smoothness::Constant,
            4 => Smoothness::Spline(Spline::FritschButland),
            5 => Smoothness::Spline(Spline::Steffen),
            6 => Smoothness::Spline(Spline::ModifiedAkima),
            _ => return None,
        })
    }
}

/// What lies beyond the points; the order of `Modelica.Blocks.Types.Extrapolation`.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Extrapolation {
    Hold,
    LastTwoPoints,
    Periodic,
    Refused,
}

impl Extrapolation {
    pub(crate) fn from_ordinal(ordinal: i64) -> Option<Extrapolation> {
        Some(match ordinal {
            1 => Extrapolation::Hold,
            2 => Extrapolation::LastTwoPoints,
            3 => Extrapolation::Periodic,
            4 => Extrapolation::Refused,
            _ => return None,
        })
    }
}

/// Where a number stands among abscissae.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Interval {
    /// In the interval of this number, at this abscissa (which differs from the number asked for
    /// in periodic tables).
    Inside(usize, f64),
    /// Before the first point.
    Before(f64),
    /// After the last point.
    After(f64),
}

/// Places `u` among abscissae that do not decrease; `None` where extrapolation is refused. An
/// abscissa belongs to the interval that it begins; the last one to the last interval.
pub(crate) fn place(
    x: &[f64],
    extrapolation: Extrapolation,
    u: f64,
    near: &Near,
) -> Option<Interval> {
    let (Some(first), Some(last)) = (x.first().copied(), x.last().copied()) else { return None };
    let inside = |u: f64| {
        let interval = near.last_up_to(x, u);
        Interval::Inside(interval.min(x.len().saturating_sub(2)), u)
    };
    if (first..=last).contains(&u) {
        return Some(inside(u));
    }
    match extrapolation {
        Extrapolation::Periodic if last > first && u.is_finite() => {
            let period = last - first;
            let within = u - ((u - first) / period).floor() * period;
            Some(inside(within.clamp(first, last)))
        }
        Extrapolation::Refused => None,
        _ if u < first => Some(Interval::Before(u)),
        _ => Some(Interval::After(u)),
    }
}

/// The interval that was asked for last: in simulations the next one is mostly the same or the one
/// after it, and no search is needed.
#[derive(Debug, Default)]
pub(super) struct Near(AtomicUsize);

impl Near {
    /// The position of the last of ascending abscissas that is not beyond `u`, 0 if all are.
    fn last_up_to(&self, x: &[f64], u: f64) -> usize {
        let is_it = |at: usize| {
            x.get(at).is_some_and(|x| *x <= u) && x.get(at + 1).is_none_or(|next| u < *next)
        };
        let known = self.0.load(Ordering::Relaxed);
        if is_it(known) {
            return known;
        }
        let found = match is_it(known + 1) {
            true => known + 1,
            false => x.partition_point(|x| *x <= u).saturating_sub(1),
        };
        self.0.store(found, Ordering::Relaxed);
        found
    }
}

/// One column of a table over its first.
#[derive(Debug, Clone)]
pub(crate) struct Curve {
    y: Vec<f64>,
    smoothness: Smoothness,
    derivatives: Vec<f64>,
}

impl Curve {
    /// Through points whose abscissae do not decrease; for splines they increase strictly.
    pub(crate) fn new(x: &[f64], y: Vec<f64>, smoothness: Smoothness) -> Curve {
        let derivatives = match smoothness {
            Smoothness::Spline(spline) if x.len() > 1 => spline.derivatives(x, &y),
            _ => Vec::new(),
        };
        Curve { y, smoothness, derivatives }
    }

    /// Value, first and second derivative.
    pub(crate) fn at(&self, x: &[f64], extrapolation: Extrapolation, place: Interval) -> [f64; 3] {
        let n = x.len();
        if n == 1 {
            return [self.y[0], 0.0, 0.0];
        }
        let (interval, end, u) = match place {
            Interval::Inside(interval, u) => return self.inside(x, interval, u),
            Interval::Before(u) => (0, 0, u),
            Interval::After(u) => (n - 2, n - 1, u),
        };
        if extrapolation == Extrapolation::Hold {
            return [self.y[end], 0.0, 0.0];
        }
        // Steps continue as a line through the last two points.
        let derivative = match self.smoothness {
            Smoothness::Constant if x[interval] < x[interval + 1] => {
                (self.y[interval + 1] - self.y[interval]) / (x[interval + 1] - x[interval])
            }
            _ => self.inside(x, interval, x[end])[1],
        };
        [self.y[end] + derivative * (u - x[end]), derivative, 0.0]
    }

    /// The segment of an interval, continued where `u` is not in it.
    pub(crate) fn inside(&self, x: &[f64], interval: usize, u: f64) -> [f64; 3] {
        let i = interval;
        let (h, s) = (x[i + 1] - x[i], u - x[i]);
        let (y0, y1) = (self.y[i], self.y[i + 1]);
        match self.smoothness {
            // The last point has a value of its own.
            Smoothness::Constant if i + 2 == x.len() && u >= x[i + 1] => [y1, 0.0, 0.0],
            Smoothness::Constant => [y0, 0.0, 0.0],
            _ if h == 0.0 => [y1, 0.0, 0.0],
            Smoothness::Linear => {
                let derivative = (y1 - y0) / h;
                let value = if u == x[i + 1] { y1 } else { y0 + derivative * s };
                [value, derivative, 0.0]
            }
            Smoothness::Spline(_) => {
                let (d0, d1) = (self.derivatives[i], self.derivatives[i + 1]);
                let m = (y1 - y0) / h;
                let (c2, c3) = ((3.0 * m - 2.0 * d0 - d1) / h, (d0 + d1 - 2.0 * m) / (h * h));
                [
                    y0 + s * (d0 + s * (c2 + s * c3)),
                    d0 + s * (2.0 * c2 + 3.0 * s * c3),
                    2.0 * c2 + 6.0 * s * c3,
                ]
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        /// Whatever was asked for before, the interval is the one that a search finds.
        #[test]
        fn the_interval_does_not_depend_on_the_one_before(
            mut x in proptest::collection::vec(-5i8..5, 1..12),
            asked in proptest::collection::vec(-12i8..12, 1..40),
        ) {
            x.sort_unstable();
            let x: Vec<f64> = x.into_iter().map(f64::from).collect();
            let near = Near::default();
            for u in asked.into_iter().map(|u| f64::from(u) / 2.0) {
                let found = x.partition_point(|x| *x <= u).saturating_sub(1);
                prop_assert_eq!(near.last_up_to(&x, u), found);
            }
        }
    }
}
