//! Step control of methods with variable step: where an attempt ends, how long the next one is after
//! an accepted and after a rejected one, and when steps have become too short.
//!
//! The length follows the asymptotic behaviour of the local error, h ∝ err^(-1/(q+1)), within limits.
//!
//! References: [Hairer, Nørsett & Wanner 1993](gapilib_base::bibliography#hairer-norsett-wanner-1993),
//! section II.4; [Hairer & Wanner 1996](gapilib_base::bibliography#hairer-wanner-1996), section IV.8.

use super::Problem;
use crate::elementary;
use crate::sim::SimErrorKind;

/// Predicted steps are shortened by this factor, so that most of them are accepted; the choice of
/// Hairer & Wanner.
pub const SAFETY: f64 = 0.9;
/// A step becomes at most so much shorter for its error: what an estimate says about steps far from
/// its own length is not reliable.
const LEAST_FACTOR: f64 = 0.2;
/// Where a step fails without an estimate of its error, the next attempt has this part of its length.
pub(crate) const FAILURE_FACTOR: f64 = 0.25;
/// A step that ends this near to the limit, relative to its length, is stretched to it: what remained
/// would be of the size of rounding errors in t.
const STRETCH: f64 = 1.0 + 1e-9;
/// After an event the step that was good before it is at most ten times too long.
const AFTER_EVENT: f64 = 0.1;

/// An attempt of a step.
#[derive(Debug, Clone, Copy)]
pub struct Attempt {
    /// Its length, s.
    pub(super) h: f64,
    /// When it ends, s; the limit itself where it reaches that.
    pub(super) end: f64,
    /// Whether it ends at the limit, before which steps may have been cut short.
    pub(super) reaches_limit: bool,
}

impl Attempt {
    /// The step of length h from t, or one or two equal ones to the limit if it comes near.
    pub fn towards(limit: f64, t: f64, h: f64) -> Attempt {
        let remaining = limit - t;
        if h * STRETCH >= remaining {
            return Attempt { h: remaining, end: limit, reaches_limit: true };
        }
        let h = if 2.0 * h > remaining * STRETCH { 0.5 * remaining } else { h };
        Attempt { h, end: t + h, reaches_limit: false }
    }

    /// The step of length h from t, cut at the limit.
    pub fn cut(limit: f64, t: f64, h: f64) -> Attempt {
        let reaches_limit = t + h * STRETCH >= limit;
        let end = if reaches_limit { limit } else { t + h };
        // A step may be too short for the digits of t.
        Attempt { h: if end > t { end - t } else { h }, end, reaches_limit }
    }
}

/// The length of the next step of a one-step method.
#[derive(Debug, Default)]
pub(crate) struct StepControl {
    /// s
    h: f64,
    /// Below this a step does not change the time since the restart noticeably.
    smallest: f64,
    /// Whether the next step may not be longer: an attempt of this one was rejected.
    is_cautious: bool,
    /// The length of the last step if it was cut at a limit, such as the next sample of an input.
    cut: f64,
}

impl StepControl {
    /// Steps of one length, s.
    pub fn fixed(h: f64) -> StepControl {
        StepControl { h, ..StepControl::default() }
    }

    /// The first step from (t, y), where the right-hand side is given; after an event at a time that was
    /// known it is as long as the one before it.
    pub fn start(&mut self, problem: &Problem, t: f64, y: &[f64], rhs: &[f64]) {
        // What follows a sample is as fast as what came before.
        let cut = if t > problem.settings.start { self.cut } else { 0.0 };
        self.h = problem.first_step(t, y, rhs).max(cut);
    }

    /// As [`StepControl::start`], for methods whose steps may be nearly as long after an event as
    /// before it.
    pub fn restart(&mut self, problem: &Problem, t: f64, y: &[f64], rhs: &[f64]) {
        let is_first = self.h == 0.0 || t <= problem.settings.start;
        let first = problem.first_step(t, y, rhs);
        self.h = if is_first { first } else { first.max(AFTER_EVENT * self.h) };
    }

    /// Begins a step.
    pub fn begin(&mut self, problem: &Problem) {
        self.smallest = problem.smallest_step();
        self.is_cautious = false;
    }

    /// Takes the step as one of which an attempt was rejected.
    pub(crate) fn be_cautious(&mut self) {
        self.is_cautious = true;
    }

    /// Whether an attempt of this step was rejected.
    pub(crate) fn is_cautious(&self) -> bool {
        self.is_cautious
    }

    /// The length to be tried, s.
    pub fn h(&self) -> f64 {
        self.h
    }

    /// An attempt was accepted; the next step has `factor` times its length, if it may.
    pub fn accept(&mut self, problem: &mut Problem, attempt: Attempt, factor: f64) {
        problem.note_step(attempt.h);
        let next = attempt.h * if self.is_cautious { factor.min(1.0) } else { factor };
        // A step cut short at the limit says little about longer ones.
        let next = if attempt.reaches_limit { next.max(self.h) } else { next };
        self.cut = if attempt.reaches_limit && !self.is_cautious { attempt.h } else { 0.0 };
        self.h = next.min(problem.settings.max_step);
    }

    /// An attempt had too large an error: the next one has `factor` times its length.
    pub(crate) fn reject(
        &mut self,
        problem: &mut Problem,
        attempt: Attempt,
        factor: f64,
    ) -> Result<(), SimErrorKind> {
        problem.statistics.error_failures += 1;
        self.shorten(attempt.h * factor, SimErrorKind::StepSize)
    }

    /// An attempt could not be completed.
    pub fn fail(
        &mut self,
        problem: &mut Problem,
        attempt: Attempt,
        failure: SimErrorKind,
    ) -> Result<(), SimErrorKind> {
        problem.statistics.newton_failures += 1;
        self.shorten(attempt.h * FAILURE_FACTOR, failure)
    }

    fn shorten(&mut self, h: f64, failure: SimErrorKind) -> Result<(), SimErrorKind> {
        self.is_cautious = true;
        self.h = h;
        // A length that is not a number is refused, too.
        if h >= self.smallest { Ok(()) } else { Err(failure) }
    }
}

/// How many times longer a step may be so that its error, relative to the tolerance, becomes one.
/// `order` is that of the estimate. An error that is not a number shortens most.
pub(crate) fn error_factor(error: f64, order: i32, safety: f64, largest: f64) -> f64 {
    let exponent = -1.0 / f64::from(order + 1);
    (safety * elementary::powf(error, exponent)).max(LEAST_FACTOR).min(largest)
}

/// The safety factor after so many of at most `most` iterations of Newton's method: many of them say
/// that a longer step may not converge.
pub(crate) fn newton_safety(iterations: usize, most: usize) -> f64 {
    let budget = 2.0 * most as f64 + 1.0;
    SAFETY * budget / (budget - 1.0 + iterations as f64)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn attempts_end_at_the_limit_in_one_or_two_equal_steps() {
        let far = Attempt::towards(10.0, 0.0, 1.0);
        assert_eq!((far.h, far.end, far.reaches_limit), (1.0, 1.0, false));
        let half = Attempt::towards(1.5, 0.0, 1.0);
        assert_eq!((half.h, half.end, half.reaches_limit), (0.75, 0.75, false));
        let last = Attempt::towards(1.0 + 1e-10, 0.0, 1.0);
        assert_eq!((last.h, last.end, last.reaches_limit), (1.0 + 1e-10, 1.0 + 1e-10, true));
        let cut = Attempt::cut(1.5, 1.0, 1.0);
        assert_eq!((cut.h, cut.end, cut.reaches_limit), (0.5, 1.5, true));
    }

    #[test]
    fn factors_follow_the_order_within_their_limits() {
        assert_eq!(error_factor(16.0, 3, 0.8, 5.0), 0.4);
        assert_eq!(error_factor(0.0, 4, 0.9, 5.0), 5.0);
        assert_eq!(error_factor(f64::INFINITY, 4, 0.9, 5.0), LEAST_FACTOR);
        assert_eq!(error_factor(f64::NAN, 4, 0.9, 5.0), LEAST_FACTOR);
        assert!((newton_safety(4, 4) - 0.675).abs() < 1e-15);
    }

    #[test]
    fn steps_that_become_too_short_end_with_the_failure() {
        let mut control = StepControl { h: 1.0, smallest: 0.1, ..StepControl::default() };
        assert!(control.shorten(0.2, SimErrorKind::Singular).is_ok());
        assert!(control.is_cautious);
        assert!(matches!(
            control.shorten(0.05, SimErrorKind::Singular),
            Err(SimErrorKind::Singular)
        ));
        assert!(control.shorten(f64::NAN, SimErrorKind::StepSize).is_err());
    }
}
