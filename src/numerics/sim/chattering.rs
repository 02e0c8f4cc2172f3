//! Chattering: relations that switch again and again although their sides hardly differ.
//!
//! A switch counts as one more of a row if the crossing function has not been larger than its
//! uncertainty since the one before. Where a row has become long, the fields on both sides decide:
//!
//! ```text
//! both point at the surface             the solution slides (`sliding`)
//! they lead into a corner of surfaces   the solution slides along all of them
//! else                                  the relation is followed: it is evaluated between steps,
//!                                       without events, until it has been quiet
//! values of events remember the side    events continue; an error if the sequence does not end;
//!                                       where its events change nothing it is followed instead
//! ```
//!
//! Where both sides are the same but for rounding, a function may be larger than its uncertainty at every
//! switch: a rush of events counts as a row, too.
//!
//! An event ends a slide that it has displaced (`displacement`). Following is exact up to the
//! tolerance: a function that is larger than its uncertainty has events as every other one.

use super::event::sign;
use super::run::Run;
use super::switches::ROW;
use super::{Events, Modes, Residual, SimErrorKind, Treatment};

/// Steps without a switch after which a relation is not followed any more.
const QUIET: u32 = 20;

impl Run<'_> {
    /// Counts the switches of the event at `event` in a step that was searched from `begin`.
    pub(crate) fn count_switches(&mut self, begin: f64, event: f64) -> Result<(), SimErrorKind> {
        if self.watch.is_alert {
            // A function may have been large within the step.
            self.watch.y.resize(self.y.len(), 0.0);
            self.integrator.interpolate(0.5 * (begin + event), &mut self.watch.y);
            let middle = 0.5 * (begin + event);
            let crossings = self.problem.system.crossings(middle, &self.watch.y, &mut self.watch.z);
            crossings.map_err(SimErrorKind::Evaluation)?;
            for (at, z) in self.watch.z.iter().enumerate() {
                if z.abs() > self.crossings.uncertainty[at] {
                    self.watch.rows[at].end();
                }
            }
        }
        let n = self.problem.system.n_differential();
        self.watch.before.clear();
        self.watch.before.extend_from_slice(&self.y[..n]);
        self.watch.impacts.clear();
        for (at, z) in self.crossings.at_event().iter().enumerate() {
            if self.problem.system.rests_at(at) {
                continue;
            }
            if self.crossings.switched.contains(&at) {
                self.watch.rows[at].lengthen(event);
                self.watch.impacts.push(at);
                self.watch.is_alert = true;
                let was_above = match self.crossings.signs[at] {
                    0 => *z < 0.0,
                    side => side > 0,
                };
                self.watch.switches[at].note(event, was_above);
            } else if z.abs() > self.crossings.uncertainty[at] {
                self.watch.rows[at].end();
            }
        }
        Ok(())
    }

    /// Checks the relations after a step without event; y is at its end.
    pub(crate) fn look_between_steps(&mut self) -> Result<(), SimErrorKind> {
        if !self.watch.is_alert {
            return Ok(());
        }
        let (search, watch) = (&mut *self.crossings, &mut *self.watch);
        watch.is_alert = false;
        watch.sides.clear();
        for (at, z) in search.left.iter().enumerate() {
            if z.abs() > search.uncertainty[at] {
                watch.rows[at].end();
            }
            if search.followed[at] {
                let side = sign(*z);
                let switches = side != 0 && side != search.signs[at];
                watch.quiet[at] = if switches { 0 } else { watch.quiet[at] + 1 };
                if switches {
                    search.signs[at] = side;
                    watch.sides.push((at, side > 0));
                }
                search.followed[at] = watch.quiet[at] < QUIET || side != search.signs[at];
            }
            watch.is_alert |= watch.rows[at].length > 0 || search.followed[at];
        }
        if watch.sides.is_empty() {
            return Ok(());
        }
        self.integrator.branches_changed();
        let followed = self.problem.system.follow(self.t, self.y, &watch.sides);
        if !followed.map_err(SimErrorKind::Evaluation)? {
            for (at, is_positive) in watch.sides.drain(..) {
                search.followed[at] = false;
                search.signs[at] = if is_positive { -1 } else { 1 };
            }
        }
        Ok(())
    }

    /// Does something about the rows that have become long at the event just handled; whether the
    /// integrator was restarted for it.
    pub(crate) fn treat_chattering(&mut self) -> Result<bool, SimErrorKind> {
        let settings = self.problem.settings;
        let span = settings.stop - settings.start;
        if !settings.treats_chattering {
            let is_endless = |at: &usize| self.watch.rows[*at].is_endless(span);
            return match self.crossings.switched.iter().any(is_endless) {
                true => Err(SimErrorKind::Chattering),
                false => Ok(false),
            };
        }
        if self.rest_after_impact()? {
            return Ok(true);
        }
        let (rows, switched) = (&self.watch.rows, &self.crossings.switched);
        let is_rush = self.rush.is_rush();
        if !is_rush && !switched.iter().any(|at| rows[*at].is_due()) {
            return Ok(false);
        }
        let system = &self.problem.system;
        let is_endless = |at: &usize| rows[*at].is_endless(span) && !system.can_follow_now(*at);
        if switched.iter().any(is_endless) {
            return Err(SimErrorKind::Chattering);
        }
        let is_row = |at: &usize| rows[*at].length + 1 >= ROW || is_rush && switched.contains(at);
        let is_chattering = |at: &usize| is_row(at) && system.can_follow_now(*at);
        let chattering: Vec<usize> = (0..rows.len()).filter(is_chattering).collect();
        if chattering.is_empty() {
            self.watch_for_accumulation()?;
            return Ok(false);
        }
        self.slide_or_follow(&chattering)
    }

    /// Slides along the surfaces of relations that chatter, or else follows them; whether the
    /// integrator was restarted for it.
    fn slide_or_follow(&mut self, chattering: &[usize]) -> Result<bool, SimErrorKind> {
        self.refuse_with_directions()?;
        let (sliding, contacts) = self.end_slide();
        let was_constrained = !sliding.is_empty() || !contacts.is_empty();
        if was_constrained {
            self.start_crossings()?;
        }
        let system = &self.problem.system;
        let may_slide = chattering.iter().copied().filter(|at| system.can_follow(*at));
        let distinct = self.distinct(&may_slide.collect::<Vec<_>>());
        let opposing = match distinct.len() + sliding.len() {
            1 => distinct.clone(),
            _ => self.opposing(&distinct),
        };
        let mut surfaces = sliding.clone();
        surfaces.extend(opposing.iter().filter(|at| !sliding.contains(at)));
        let is_larger = surfaces.len() > sliding.len();
        let mut slides = is_larger && self.slide(&surfaces, contacts.clone())?
            || !sliding.is_empty()
                && !opposing.is_empty()
                && self.slide(&opposing, contacts.clone())?;
        let others = distinct.iter().filter(|at| !surfaces.contains(at));
        let others: Vec<usize> = others.copied().collect();
        if !slides && !others.is_empty() {
            // No surface attracts by itself, but all of them may together.
            surfaces.extend(others);
            slides = self.slide(&surfaces, contacts.clone())?;
        }
        if slides {
            self.problem.statistics.slides += 1;
            return Ok(true);
        }
        for at in chattering.iter().copied() {
            if std::mem::replace(&mut self.crossings.followed[at], true) {
                continue;
            }
            self.watch.quiet[at] = 0;
            self.problem.statistics.followed += 1;
            self.problem.system.note_treatment(self.t, at, Treatment::Followed);
        }
        if was_constrained {
            self.go_on_constrained(&sliding, contacts)?;
        }
        Ok(was_constrained)
    }

    /// One crossing function for each surface.
    fn distinct(&self, crossings: &[usize]) -> Vec<usize> {
        let mut found: Vec<usize> = Vec::new();
        for at in crossings {
            if !found.iter().any(|known| self.is_same_surface(*known, *at)) {
                found.push(*at);
            }
        }
        found
    }

    /// Of these crossing functions those with fields on both sides that point at their surface.
    fn opposing(&mut self, crossings: &[usize]) -> Vec<usize> {
        crossings.iter().copied().filter(|at| self.shares(&[*at]).is_some()).collect()
    }
}
