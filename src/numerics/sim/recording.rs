//! What a simulation records: rows at output points and at events, and what systems with a memory are
//! shown.

use super::run::Run;
use super::{Events, Failure, Residual, SimErrorKind};

/// Points of every step that a system with a memory is shown.
const POINTS_REMEMBERED: u32 = 4;
/// Halvings of a step within which an assertion has failed: to a millionth of a millionth of it.
const ASSERTION_TRIALS: u32 = 40;

impl Run<'_> {
    /// Records the output points before `end`; y is y(`end`) afterwards as before.
    pub(super) fn record_before(&mut self, end: f64) -> Result<(), SimErrorKind> {
        let mut moved = false;
        while let Some(point) = self.recorder.points.next().filter(|point| *point < end) {
            self.integrator.interpolate(point, self.y);
            self.t = point;
            self.record()?;
            self.advance_output();
            moved = true;
        }
        if moved {
            self.integrator.interpolate(end, self.y);
        }
        Ok(())
    }

    /// Shows the part of the step from `begin` to `end` to a system that remembers; y is y(`end`)
    /// before and afterwards.
    pub(super) fn remember(&mut self, begin: f64, end: f64) -> Result<(), SimErrorKind> {
        if !self.problem.system.remembers() {
            return Ok(());
        }
        for point in 1..=POINTS_REMEMBERED {
            let share = f64::from(point) / f64::from(POINTS_REMEMBERED);
            let t = if point == POINTS_REMEMBERED { end } else { begin + share * (end - begin) };
            self.integrator.interpolate(t, self.y);
            self.remember_now(t)?;
        }
        Ok(())
    }

    pub(super) fn remember_now(&mut self, t: f64) -> Result<(), SimErrorKind> {
        self.problem.system.remember(t, self.y).map_err(SimErrorKind::Evaluation)
    }

    pub(super) fn check(&mut self) -> Result<(), SimErrorKind> {
        self.problem.system.check(self.t, self.y).map_err(SimErrorKind::Evaluation)
    }

    /// Checks the end of a step that began at `begin`. An assertion that has failed within the step
    /// fails at the time when it began to, and there are no rows after that.
    pub(crate) fn check_step(&mut self, begin: f64) -> Result<(), SimErrorKind> {
        let Err(mut failed) = self.check() else { return Ok(()) };
        let is_assertion = |kind: &SimErrorKind| {
            matches!(kind, SimErrorKind::Evaluation(Failure::Assertion { .. }))
        };
        let mut holds = begin;
        for _ in 0..ASSERTION_TRIALS {
            let middle = 0.5 * (holds + self.t);
            if !is_assertion(&failed) || middle <= holds || middle >= self.t {
                break;
            }
            self.integrator.interpolate(middle, self.y);
            match self.problem.system.check(middle, self.y).map_err(SimErrorKind::Evaluation) {
                Err(kind) if is_assertion(&kind) => (self.t, failed) = (middle, kind),
                _ => holds = middle,
            }
        }
        self.recorder.rows.end_at(self.t);
        Err(failed)
    }

    pub(crate) fn advance_output(&mut self) {
        self.recorder.points.advance(self.problem.settings);
    }

    pub fn record(&mut self) -> Result<(), SimErrorKind> {
        let recorded = self.recorder.record(&mut self.problem, self.t, self.y);
        recorded.map_err(SimErrorKind::Evaluation)
    }
}
