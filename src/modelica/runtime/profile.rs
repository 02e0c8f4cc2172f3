//! A quantity over a coordinate: what a variable `delay` has recorded over time, or what lies in the
//! pipe of `spatialDistribution` over the coordinate of the fluid (MLS §3.7.4.1, §3.7.4.2).
//!
//! It is a chain of pieces with jumps between them. Points are added at both ends. Within a piece the
//! value is that of the cubic through the four points around; an initial profile is linear between
//! its points. The piece that is read changes at events only, so that a step never sees both sides
//! of a jump.

use super::delay_buffer::{cubic, differ};
use super::instants::AT_ONCE;
use serde::{Deserialize, Serialize};
use std::cmp::Ordering;
use std::collections::VecDeque;

/// Smallest distance of two points, relative to the next distance: nearer ones would amplify
/// rounding.
const NEAR: f64 = 0.05;
/// How near to a border, relative to the scale, a place is at the border: crossings are located so.
const AT_BORDER: f64 = 1e-10;
/// The point, counted from the end, to which a straight line from the end leads: further ones amplify
/// less.
const LINE: usize = 4;

/// The smooth part of a profile between two jumps.
#[derive(Debug, Clone, Default, Serialize, Deserialize)]
struct Piece {
    /// Coordinates, ascending.
    at: VecDeque<f64>,
    values: VecDeque<f64>,
    /// Whether the values between the points are on straight lines.
    linear: bool,
}

/// The profile, and the piece of it that is read.
#[derive(Debug, Clone, Default, Serialize, Deserialize)]
pub(super) struct Profile {
    /// With ascending coordinates; the end of one is the begin of the next.
    pieces: VecDeque<Piece>,
    reading: usize,
    /// A length of its coordinate that matters.
    scale: f64,
}

/// An end of a profile.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum End {
    /// Where the coordinate is smallest.
    Low,
    /// Where it is largest.
    High,
}

impl Piece {
    fn value(&self, s: f64) -> f64 {
        let n = self.at.len();
        let after = self.at.partition_point(|at| *at <= s);
        if self.linear {
            let start = after.saturating_sub(1).min(n.saturating_sub(2));
            return cubic(&self.at, &self.values, start..n.min(start + 2), s);
        }
        let width = n.min(4);
        let start = after.saturating_sub(width / 2).min(n - width);
        cubic(&self.at, &self.values, start..start + width, s)
    }

    fn end(&self, end: End) -> f64 {
        let end = if end == End::Low { self.at.front() } else { self.at.back() };
        end.copied().unwrap_or(0.0)
    }

    fn value_at(&self, end: End) -> f64 {
        let end = if end == End::Low { self.values.front() } else { self.values.back() };
        end.copied().unwrap_or(0.0)
    }

    fn push(&mut self, end: End, s: f64, value: f64) {
        match end {
            End::Low => {
                self.at.push_front(s);
                self.values.push_front(value);
            }
            End::High => {
                self.at.push_back(s);
                self.values.push_back(value);
            }
        }
    }

    /// Drops the point at an end if it is nearer to the next one than `s` allows.
    fn thin(&mut self, end: End, s: f64) {
        let n = self.at.len();
        if n < 2 {
            return;
        }
        let (last, before) = match end {
            End::Low => (self.at[0], self.at[1]),
            End::High => (self.at[n - 1], self.at[n - 2]),
        };
        if (last - before).abs() < NEAR * (s - last).abs() {
            match end {
                End::Low => (self.at.pop_front(), self.values.pop_front()),
                End::High => (self.at.pop_back(), self.values.pop_back()),
            };
        }
    }
}

impl Profile {
    /// A profile with straight lines between its points; two points at one place are a jump.
    pub(super) fn of_points(points: &[f64], values: &[f64], scale: f64) -> Profile {
        let mut pieces = VecDeque::new();
        let mut piece = Piece { linear: true, ..Piece::default() };
        for (s, value) in points.iter().zip(values) {
            if piece.at.back() == Some(s) {
                pieces.push_back(std::mem::replace(
                    &mut piece,
                    Piece { linear: true, ..Piece::default() },
                ));
            }
            piece.push(End::High, *s, *value);
        }
        pieces.push_back(piece);
        Profile { pieces, reading: 0, scale }
    }

    /// A profile that has one value up to `s`, after which others follow.
    pub(super) fn constant_before(s: f64, value: f64, scale: f64) -> Profile {
        let mut profile = Profile::of_points(&[s, s], &[value, value], scale);
        profile.pieces[1].linear = false;
        profile
    }

    /// Adds the value at a place that is not nearer than the last one; at the same place another
    /// value is a jump.
    pub(super) fn push(&mut self, end: End, s: f64, value: f64) {
        let Some(piece) = self.piece_at(end) else { return };
        let last = piece.end(end);
        let outside = if end == End::Low { s < last } else { s > last };
        if outside && !piece.linear {
            piece.thin(end, s);
            piece.push(end, s, value);
            return;
        }
        let beginning = piece.value_at(end);
        if s == last && piece.at.len() == 1 && !piece.linear {
            piece.values[0] = value;
            return;
        }
        if outside || (s == last && differ(value, beginning)) {
            let mut next = Piece::default();
            if outside {
                next.push(End::High, last, beginning);
            }
            next.push(end, s, value);
            match end {
                End::Low => {
                    self.pieces.push_front(next);
                    self.reading += 1;
                }
                End::High => self.pieces.push_back(next),
            }
        }
    }

    fn piece_at(&mut self, end: End) -> Option<&mut Piece> {
        if end == End::Low { self.pieces.front_mut() } else { self.pieces.back_mut() }
    }

    /// Forgets what lies beyond `s` at an end, which becomes the end; what follows is a new piece.
    pub(super) fn cut(&mut self, end: End, s: f64) {
        let beyond = |at: f64| if end == End::Low { at < s } else { at > s };
        while self.pieces.len() > 1
            && self.piece_at(end).is_some_and(|p| beyond(p.end(opposite(end))))
        {
            match end {
                End::Low => {
                    self.pieces.pop_front();
                    self.reading = self.reading.saturating_sub(1);
                }
                End::High => {
                    self.pieces.pop_back();
                }
            }
        }
        self.reading = self.reading.min(self.pieces.len() - 1);
        let Some(piece) = self.piece_at(end) else { return };
        if beyond(piece.end(end)) {
            let value = piece.value(s);
            while piece.at.len() > 1 && beyond(piece.end(end)) {
                match end {
                    End::Low => (piece.at.pop_front(), piece.values.pop_front()),
                    End::High => (piece.at.pop_back(), piece.values.pop_back()),
                };
            }
            if piece.end(end) != s {
                piece.push(end, s, value);
            }
        }
    }

    /// Forgets whole pieces, and points, that no interpolation above `s` needs; they lie at the low
    /// end.
    pub(super) fn forget_below(&mut self, s: f64) {
        while self.reading > 0 && self.pieces[0].end(End::High) < s {
            self.pieces.pop_front();
            self.reading -= 1;
        }
        if let Some(piece) = self.pieces.front_mut() {
            let unused = piece.at.partition_point(|at| *at <= s).saturating_sub(8);
            if unused >= 64 {
                piece.at.drain(..unused);
                piece.values.drain(..unused);
            }
        }
    }

    /// The same at the high end.
    pub(super) fn forget_above(&mut self, s: f64) {
        while self.reading + 1 < self.pieces.len()
            && self.pieces.back().is_some_and(|piece| piece.end(End::Low) > s)
        {
            self.pieces.pop_back();
        }
        if let Some(piece) = self.pieces.back_mut() {
            let used = (piece.at.partition_point(|at| *at <= s) + 8).min(piece.at.len());
            if piece.at.len() - used >= 64 {
                piece.at.truncate(used);
                piece.values.truncate(used);
            }
        }
    }

    /// The value at a place, in the piece that is read.
    pub(super) fn value(&self, s: f64) -> f64 {
        self.pieces.get(self.reading).map_or(0.0, |piece| piece.value(s))
    }

    /// The value near an end; a little beyond it on a straight line in the piece there.
    pub(super) fn near_end(&self, end: End, s: f64) -> f64 {
        let piece = if end == End::Low { self.pieces.front() } else { self.pieces.back() };
        let Some(piece) = piece else { return 0.0 };
        let recorded = if end == End::Low { s >= piece.end(end) } else { s <= piece.end(end) };
        let (last, far) = match end {
            _ if recorded => return piece.value(s),
            End::Low => (0, LINE.min(piece.at.len() - 1)),
            End::High => (piece.at.len() - 1, piece.at.len().saturating_sub(LINE + 1)),
        };
        match last == far || piece.linear {
            true => piece.value_at(end),
            false => {
                let (a, b) = (piece.values[last], piece.values[far]);
                a + (b - a) * (s - piece.at[last]) / (piece.at[far] - piece.at[last])
            }
        }
    }

    /// The largest place with a value.
    pub(super) fn end(&self, end: End) -> f64 {
        let piece = if end == End::Low { self.pieces.front() } else { self.pieces.back() };
        piece.map_or(0.0, |piece| piece.end(end))
    }

    /// Where the piece that is read begins and ends; infinite at the ends of the profile.
    pub(super) fn borders(&self) -> (f64, f64) {
        let below = self.reading.checked_sub(1).map(|_| self.pieces[self.reading].end(End::Low));
        let above = self.pieces.get(self.reading + 1).map(|piece| piece.end(End::Low));
        (below.unwrap_or(f64::NEG_INFINITY), above.unwrap_or(f64::INFINITY))
    }

    /// Advances to the piece at `s`, of two the one towards `to`; whether it is another.
    pub(super) fn locate(&mut self, s: f64, to: End) -> bool {
        let before = self.reading;
        loop {
            match self.direction(s, to) {
                Ordering::Greater => self.reading += 1,
                Ordering::Less => self.reading -= 1,
                Ordering::Equal => return self.reading != before,
            }
        }
    }

    /// Where the piece at `s` lies as seen from the one that is read, of two the one towards `to`.
    pub(super) fn direction(&self, s: f64, to: End) -> Ordering {
        let (below, above) = self.borders();
        let rounding = AT_BORDER * self.scale + AT_ONCE * s.abs();
        let margin = if to == End::High { -rounding } else { rounding };
        if s > above + margin {
            Ordering::Greater
        } else if s < below + margin {
            Ordering::Less
        } else {
            Ordering::Equal
        }
    }

    /// Whether it can be read: it may come from another process.
    pub(super) fn is_valid(&self) -> bool {
        let is_filled = |piece: &Piece| {
            !piece.at.is_empty()
                && piece.at.len() == piece.values.len()
                && piece.at.iter().is_sorted()
        };
        self.reading < self.pieces.len() && self.pieces.iter().all(is_filled)
    }
}

fn opposite(end: End) -> End {
    if end == End::Low { End::High } else { End::Low }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_initial_profile_is_linear_between_its_points_and_jumps_at_double_ones() {
        let mut profile = Profile::of_points(&[0.0, 0.4, 0.4, 1.0], &[1.0, 2.0, 5.0, 2.0], 1.0);
        profile.locate(0.2, End::High);
        assert!((profile.value(0.2) - 1.5).abs() < 1e-15);
        assert_eq!(profile.borders(), (f64::NEG_INFINITY, 0.4));
        assert!(profile.locate(0.4, End::High));
        assert!((profile.value(0.7) - 3.5).abs() < 1e-15);
        assert!(profile.locate(0.4, End::Low));
        assert!((profile.value(0.4) - 2.0).abs() < 1e-15);
    }

    #[test]
    fn cubics_are_exact_past_the_initial_profile_at_both_ends() {
        let cubic = |s: f64| 1.0 - 2.0 * s + 0.5 * s * s - s * s * s;
        let mut profile = Profile::of_points(&[0.0, 1.0], &[cubic(0.0), cubic(1.0)], 1.0);
        for i in 1..20 {
            let step = 0.1 * f64::from(i);
            profile.push(End::High, 1.0 + step, cubic(1.0 + step));
            profile.push(End::Low, -step, cubic(-step));
        }
        for s in [-1.83, -0.04, 1.01, 2.4] {
            profile.locate(s, End::High);
            assert!((profile.value(s) - cubic(s)).abs() < 1e-10, "at {s}");
        }
    }

    #[test]
    fn what_is_cut_comes_back_with_new_values() {
        let mut profile = Profile::of_points(&[0.0, 1.0], &[0.0, 1.0], 1.0);
        profile.cut(End::High, 0.25);
        profile.push(End::High, 0.25, 7.0);
        profile.push(End::High, 1.0, 7.0);
        profile.locate(0.2, End::High);
        assert!((profile.value(0.2) - 0.2).abs() < 1e-15);
        profile.locate(0.5, End::High);
        assert_eq!(profile.value(0.5), 7.0);
    }
}
