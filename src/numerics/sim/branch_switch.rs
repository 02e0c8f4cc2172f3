//! Where no step can be made: the solution of the algebraic equations may continue elsewhere, or on
//! another branch.

use super::run::{After, Run};
use super::{EventOutcome, Events, Failure, Residual, Sensitive, SimErrorKind};

/// How far past the end of a solution of the algebraic equations another one is searched for,
/// relative to the simulated interval.
const LEAPS: [f64; 3] = [1e-10, 1e-9, 1e-8];
/// The next branch switch must be this many times farther away.
const FARTHER: f64 = 1e3;
/// Smaller changes, relative to the magnitude, are not a branch switch.
const SMALLEST_JUMP: f64 = 1e-3;

impl Run<'_> {
    /// Where no step can be made: the solution of the algebraic equations may continue elsewhere,
    /// or on another branch. Fails with `kind` if it does not.
    pub(super) fn jump(&mut self, kind: SimErrorKind) -> Result<After, SimErrorKind> {
        let system = &*self.problem.system;
        // Derivatives do not follow a solution that jumps for no reason of its own.
        if system.n_directions() > 0 || system.is_constrained() {
            return Err(kind);
        }
        let ends = kind == SimErrorKind::StepSize && system.n_algebraic() > 0;
        let is_domain = matches!(kind, SimErrorKind::Evaluation(Failure::Domain { .. }));
        if !ends && !is_domain {
            return Err(kind);
        }
        if let Some(after) = self.solve_again() {
            return Ok(after);
        }
        if ends { self.switch_branch(kind) } else { self.leave_branch(kind) }
    }

    /// The integrator leaves errors in algebraic unknowns that may be too large for any further step,
    /// as near the zero of a root: an event here solves for them. `None` if that was not the reason.
    fn solve_again(&mut self) -> Option<After> {
        let span = self.problem.settings.stop - self.problem.settings.start;
        if self.problem.system.n_algebraic() == 0
            || self.t - self.branch_switches.last_solved <= LEAPS[0] * span
        {
            return None;
        }
        self.branch_switches.last_solved = self.t;
        let before = self.y.to_vec();
        self.problem.system.crossed(None, span);
        let outcome = self.whole_event(self.t);
        let after = match outcome {
            Ok(EventOutcome::Terminate) => Some(After::Terminated),
            Ok(_) if *self.y != before && self.restart().is_ok() => Some(After::Restarted),
            _ => None,
        };
        if after.is_none() {
            self.y.copy_from_slice(&before);
        }
        after
    }

    /// A turning point: the solution of the algebraic equations ends, and they may have another
    /// branch just past it, to which an event leads.
    fn switch_branch(&mut self, kind: SimErrorKind) -> Result<After, SimErrorKind> {
        let span = self.problem.settings.stop - self.problem.settings.start;
        if self.t - self.branch_switches.last_jump <= FARTHER * LEAPS[0] * span {
            return Err(kind);
        }
        let (begin, before) = (self.t, self.y.to_vec());
        let derivatives = self.derivatives().map_err(SimErrorKind::Evaluation)?;
        for ahead in LEAPS.map(|leap| begin + leap * span) {
            if ahead > self.problem.settings.stop {
                break;
            }
            self.move_along(&before, &derivatives, ahead - begin);
            self.branch_switches.last_jump = ahead;
            self.problem.statistics.state_events += 1;
            let after = self.handle_event(ahead, false).map_err(|_| kind)?;
            if self.has_jumped(&before) {
                if after == After::Resume {
                    self.restart_integrator()?;
                }
                return Ok(after);
            }
        }
        self.t = begin;
        Err(kind)
    }

    /// A function has no value beyond, as sqrt(x) past x = 0, within less than the margin of the
    /// relation x >= 0 that chooses another branch there: an event here, or just past it, changes
    /// the relation. Or there is no value for the algebraic unknowns between here and just past it,
    /// where stages of a step would be, as in s + s² = abs(x) with s = sqrt(y) at x = 0.
    fn leave_branch(&mut self, kind: SimErrorKind) -> Result<After, SimErrorKind> {
        let settings = self.problem.settings;
        let span = settings.stop - settings.start;
        let distance = self.t - self.branch_switches.last_jump;
        if distance <= 0.0 {
            return Err(kind);
        }
        let may_leap =
            self.problem.system.n_algebraic() > 0 && distance > FARTHER * LEAPS[0] * span;
        let (begin, before) = (self.t, self.y.to_vec());
        let signs = self.crossings.signs.clone();
        let derivatives = self.derivatives().unwrap_or_else(|_| vec![0.0; before.len()]);
        for ahead in [0.0].into_iter().chain(LEAPS.map(|leap| leap * span)) {
            self.t = begin + ahead;
            if self.t > settings.stop {
                break;
            }
            self.branch_switches.last_jump = self.t;
            self.move_along(&before, &derivatives, ahead);
            self.problem.system.crossed(None, span);
            let Ok(outcome) = self.whole_event(self.t) else { continue };
            if outcome == EventOutcome::Terminate {
                return Ok(After::Terminated);
            }
            let has_switched = self.start_crossings().is_ok() && signs != self.crossings.signs;
            let leaps = may_leap && ahead > 0.0;
            if (has_switched || leaps) && self.restart().is_ok() {
                self.problem.statistics.state_events += 1;
                return Ok(After::Restarted);
            }
        }
        self.t = begin;
        self.y.copy_from_slice(&before);
        Err(kind)
    }

    /// The derivatives of the states here; zero for algebraic unknowns.
    fn derivatives(&mut self) -> Result<Vec<f64>, Failure> {
        let mut derivatives = vec![0.0; self.y.len()];
        self.problem.system.rhs(self.t, self.y, &mut derivatives)?;
        derivatives[self.problem.system.n_differential()..].fill(0.0);
        Ok(derivatives)
    }

    fn move_along(&mut self, before: &[f64], derivatives: &[f64], duration: f64) {
        for ((y, before), derivative) in self.y.iter_mut().zip(before).zip(derivatives) {
            *y = before + duration * derivative;
        }
    }

    /// Whether algebraic unknowns are elsewhere than before.
    fn has_jumped(&self, before: &[f64]) -> bool {
        let n = self.problem.system.n_differential();
        let pairs = self.y[n..].iter().zip(&before[n..]).zip(&self.problem.nominal[n..]);
        let mut moved = pairs.map(|((y, old), nominal)| (y - old).abs() / old.abs().max(*nominal));
        moved.any(|part| part > SMALLEST_JUMP)
    }
}
