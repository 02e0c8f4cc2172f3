//! Where in a step the first state event is.

use super::run::Run;
use super::{Events, SimErrorKind};

/// Parts of a step that are searched for events of their own, at least.
const PARTS_SEARCHED: f64 = 8.0;
/// Parts of the simulation that are searched so, at least: as many as there are output intervals
/// unless settings say otherwise, so that no events are missed where points are few.
const PARTS_OF_SPAN: f64 = 500.0;
/// Parts of a period of functions that oscillate in time: parabolas through three values find a pulse
/// of a thousandth of the period, as sin(ωt) > 0.99999.
const PARTS_OF_PERIOD: f64 = 32.0;
/// Steps longer than one of so many parts of a period are long for it: what varies with that period may
/// lie in the error of unknowns that functions amplify. `i < 2` in v = e - i/2, v i = 840 (1 + sin(t)/10)
/// with e near 420 lost 46 of 63 events with `radau5` at the tolerance 1e-4.
const STEPS_OF_PERIOD: f64 = 8.0;

impl Run<'_> {
    /// The first state event up to `end`, with y there. In steps that are long for the period of crossing
    /// functions the integrator knows the unknowns of loops too roughly: loops are solved then.
    pub(super) fn first_event(&mut self, end: f64) -> Result<Option<f64>, SimErrorKind> {
        let begin = self.t;
        let is_long = end - begin > self.period(begin) / STEPS_OF_PERIOD;
        let has_parts = is_long || self.problem.system.crossings_vary_in_time();
        let mut part = begin;
        loop {
            let next = if has_parts { self.end_of_part(begin, part, end) } else { end };
            if next < end {
                self.integrator.interpolate(next, self.y);
            } else if part > begin {
                self.y.copy_from_slice(self.integrator.state());
            }
            self.crossings.solves_loops = is_long;
            let found = self
                .crossings
                .first_event(&mut self.problem, self.integrator, (part, next), self.y)
                .map_err(SimErrorKind::Evaluation)?;
            if found.is_some() || next >= end {
                return Ok(found);
            }
            part = next;
        }
    }

    /// The shortest period at `t` with which crossing functions oscillate by themselves; infinite where
    /// none is known.
    fn period(&mut self, t: f64) -> f64 {
        std::f64::consts::TAU / self.problem.system.oscillation(t)
    }

    /// The end of the part of a step that is searched at once: one of several, a small part of the
    /// simulation and of a period, and not beyond an output point.
    fn end_of_part(&mut self, begin: f64, part: f64, end: f64) -> f64 {
        let period = self.period(part);
        let settings = self.problem.settings;
        let span = settings.stop - settings.start;
        let longest = f64::min((end - begin) / PARTS_SEARCHED, span / PARTS_OF_SPAN);
        let shortest = span / settings.max_total_steps as f64;
        let share = part + longest.min((period / PARTS_OF_PERIOD).max(shortest));
        if share <= part {
            return end;
        }
        let mut following = self.recorder.points.following(settings);
        let point = following.find(|point| *point > part).unwrap_or(end);
        share.min(point).min(end)
    }
}
