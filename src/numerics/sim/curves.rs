//! Systems without unknowns and events: the solution is a curve, of which nothing but the output points
//! has to be known.

use super::SimErrorKind;
use super::integrators::Problem;
use super::run::{After, Run};
use super::system::Events;

/// So often, in points, a limit of time and a request to stop are looked for: looking at the clock costs
/// about as much as a point.
const LOOKS: u64 = 64;

impl Run<'_> {
    /// Whether nothing can happen between output points.
    pub(crate) fn is_curve(&self) -> bool {
        let system = &self.problem.system;
        self.y.is_empty()
            && system.n_crossings() == 0
            && system.next_time_event(self.t).is_none()
            && !system.remembers()
            && system.longest_step() == f64::INFINITY
            && !self.problem.settings.counts_effort
    }

    /// Goes from output point to output point, and checks each.
    pub(crate) fn follow_curve(&mut self) -> Result<After, SimErrorKind> {
        let stop = self.problem.settings.stop;
        while self.t < stop {
            if self.problem.statistics.steps.is_multiple_of(LOOKS) {
                let Problem { budget, statistics, .. } = &mut self.problem;
                budget.extend(self.t, stop, statistics.attempts());
                self.problem.may_continue()?;
            }
            self.problem.statistics.steps += 1;
            let begin = self.t;
            self.t = self.recorder.points.next().map_or(stop, |point| point.min(stop));
            self.check_step(begin)?;
            if self.recorder.points.next() == Some(self.t) {
                self.record()?;
                self.advance_output();
            }
        }
        Ok(After::Resume)
    }
}
