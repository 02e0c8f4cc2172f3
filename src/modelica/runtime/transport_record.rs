//! Variable `delay` and `spatialDistribution` in a running system (MLS §3.7.4.1, §3.7.4.2).
//!
//! A delay is recorded over time t and read at t - T. The content of a pipe is recorded over the
//! coordinate s = x - y of the fluid, x being how far it has moved and y the place in the pipe: what
//! enters at y = 0 is recorded at s = x, what enters at y = 1 at s = x - 1, and the other end is
//! read. Where the fluid enters, the specification gives back the value of the last accepted step,
//! to avoid an algebraic loop; here the straight line through the last ones leads on from it.

use super::profile::{End, Profile};
use serde::{Deserialize, Serialize};

/// The part of the longest delay that steps may be long, however short the delay is: so far the last
/// values are extrapolated.
const SHORTEST_DELAY: f64 = 1e-3;
/// The part of a pipe that the content moves about at most in one step: with a half, the cubics of
/// `a_profile_is_transported_at_constant_velocity` are off by 4e-5.
const LONGEST_MOVE: f64 = 0.1;

/// What has been recorded of one of them.
#[derive(Debug, Clone, Default, Serialize, Deserialize)]
pub(super) struct Record {
    pub profile: Profile,
    /// The longest delay, or the length of the pipe.
    longest: f64,
    /// Whether the velocity was positive when it was recorded last.
    positive: bool,
    /// Time and position then, and the velocity between the last two.
    last: (f64, f64),
    velocity: f64,
    /// The delay time then.
    delay: f64,
    /// What went in at the start.
    pub first: Vec<f64>,
}

/// Where a profile is read.
#[derive(Debug, Clone, Copy)]
pub(super) struct ReadPoint {
    pub at: f64,
    /// The end from which the values come.
    pub from: End,
    /// How far the content of a pipe has moved.
    pub position: f64,
}

impl Record {
    /// Before anything has gone in but `inputs`.
    pub fn start(start: &[f64], place: ReadPoint, inputs: &[f64], t: f64) -> Record {
        let positive = place.from == End::High;
        let mut record = Record { positive, last: (t, place.position), ..Record::default() };
        record.first = inputs.to_vec();
        record.delay = t - place.at;
        match *start {
            [longest] => {
                record.longest = longest;
                record.profile = Profile::constant_before(t, inputs[0], longest);
            }
            _ => {
                let (points, values) = start.split_at(start.len() / 2);
                let points: Vec<f64> = points.iter().rev().map(|y| place.position - y).collect();
                let values: Vec<f64> = values.iter().rev().copied().collect();
                record.longest = 1.0;
                record.profile = Profile::of_points(&points, &values, 1.0);
                record.enter(place, inputs);
            }
        }
        record.profile.locate(place.at, place.from);
        record
    }

    /// What goes into a pipe.
    fn enter(&mut self, place: ReadPoint, inputs: &[f64]) {
        match place.from {
            End::High => self.profile.push(End::High, place.position, inputs[0]),
            End::Low => self.profile.push(End::Low, place.position - 1.0, inputs[1]),
        }
    }

    pub fn push(&mut self, is_pipe: bool, place: ReadPoint, inputs: &[f64], t: f64) {
        if !is_pipe {
            self.delay = t - place.at;
            self.profile.push(End::High, t, inputs[0]);
            self.profile.forget_below(t - 2.0 * self.longest);
            return;
        }
        // What is forgotten is not even needed at the begin of the step at hand.
        let positive = place.from == End::High;
        if positive != self.positive {
            match place.from {
                End::High => self.profile.cut(End::High, place.position),
                End::Low => self.profile.cut(End::Low, place.position - 1.0),
            }
            self.positive = positive;
            self.profile.locate(place.at, place.from);
        }
        self.enter(place, inputs);
        match place.from {
            End::High => self.profile.forget_below(place.at - 1.0),
            End::Low => self.profile.forget_above(place.at + 1.0),
        }
        if t > self.last.0 {
            self.velocity = (place.position - self.last.1) / (t - self.last.0);
            self.last = (t, place.position);
        }
    }

    /// The values at a place; not a number where the step is too long for what is recorded.
    pub fn read(&self, is_pipe: bool, place: ReadPoint) -> [f64; 2] {
        let end = self.profile.end(place.from);
        let margin = if is_pipe { 0.0 } else { SHORTEST_DELAY * self.longest * 1.01 };
        let unknown = match place.from {
            End::High => place.at > end + margin,
            End::Low => place.at < end,
        };
        let out = if unknown { f64::NAN } else { self.profile.value(place.at) };
        match place.from {
            End::High if is_pipe => [self.profile.near_end(End::High, place.position), out],
            End::Low => [out, self.profile.near_end(End::Low, place.position - 1.0)],
            End::High => [out, out],
        }
    }

    pub fn longest_step(&self, is_pipe: bool) -> f64 {
        match is_pipe {
            true => LONGEST_MOVE / self.velocity.abs(),
            false => self.delay.max(SHORTEST_DELAY * self.longest),
        }
    }
}
