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
use super::simulator::Run;
use super::sliding::{Contact, MOST_SURFACES, Surface, attract, balanced};
use super::switches::ROW;
use super::{Events, Modes, Residual, Sensitive, Side, SimErrorKind, Treatment};

/// Steps without a switch after which a relation is not followed any more.
const QUIET: u32 = 20;
/// Width of a layer relative to z where the tolerance is tighter: what rounding makes of z must be
/// a small part of it.
const NARROWEST: f64 = 1e-9;
/// Length of the difference that gives the rate of z, relative to the time in which y changes.
const DIFFERENCE: f64 = 1e-7;
/// Rounding of z relative to the error that a change of y by its own size makes.
const ROUNDING: f64 = 1e-13;

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
        let is_rush = self.has_rush_of_events();
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

    /// Whether two crossing functions differ by their sign at most: so they do here and where y has
    /// errors.
    fn is_same_surface(&self, a: usize, b: usize) -> bool {
        let search = &*self.crossings;
        search.left[a].abs() == search.left[b].abs()
            && search.uncertainty[a] == search.uncertainty[b]
            && search.uncertainty[a] > 0.0
    }

    /// All relations that switch at these surfaces.
    fn sides(&self, crossings: &[usize]) -> Vec<Side> {
        let search = &*self.crossings;
        let mut sides = Vec::new();
        for (surface, first) in crossings.iter().enumerate() {
            for crossing in 0..search.left.len() {
                let is_same = crossing == *first || self.is_same_surface(*first, crossing);
                if is_same && self.problem.system.can_follow(crossing) {
                    let is_reversed = search.is_rising[crossing] != search.is_rising[*first];
                    sides.push(Side { crossing, surface, is_reversed });
                }
            }
        }
        sides
    }

    /// Of these crossing functions those with fields on both sides that point at their surface.
    fn opposing(&mut self, crossings: &[usize]) -> Vec<usize> {
        crossings.iter().copied().filter(|at| self.shares(&[*at]).is_some()).collect()
    }

    /// Slides along what of these surfaces is left, and rests at contacts; without any it restarts.
    pub(crate) fn go_on_constrained(
        &mut self,
        surfaces: &[usize],
        contacts: Vec<Contact>,
    ) -> Result<(), SimErrorKind> {
        self.start_crossings()?;
        if self.slide(surfaces, contacts.clone())? || self.slide(&[], contacts)? {
            return Ok(());
        }
        self.restart()
    }

    /// Derivatives follow no solution that slides, rests, or crosses surfaces without events:
    /// callers use difference quotients then.
    pub(crate) fn refuse_with_directions(&self) -> Result<(), SimErrorKind> {
        match self.problem.system.n_directions() {
            0 => Ok(()),
            _ => Err(SimErrorKind::Chattering),
        }
    }

    /// Begins to slide along surfaces, if the fields around them point at them, and to rest at
    /// contacts.
    pub fn slide(
        &mut self,
        crossings: &[usize],
        contacts: Vec<Contact>,
    ) -> Result<bool, SimErrorKind> {
        if (crossings.is_empty() && contacts.is_empty()) || !self.can_slide() {
            return Ok(false);
        }
        self.refuse_with_directions()?;
        let shares = match crossings {
            [] => Some(Vec::new()),
            _ => self.shares(crossings),
        };
        let Some(shares) = shares.filter(|s| s.len() + contacts.len() <= MOST_SURFACES) else {
            return Ok(false);
        };
        let sides = self.sides(crossings);
        let system = &mut *self.problem.system;
        system.crossings(self.t, self.y, &mut self.watch.z).map_err(SimErrorKind::Evaluation)?;
        let widen = self.widening();
        let system = &mut *self.problem.system;
        let surfaces = crossings.iter().zip(&shares).map(|(crossing, share)| Surface {
            crossing: *crossing,
            share: *share,
            value: self.watch.z[*crossing],
            width: self.crossings.uncertainty[*crossing] * widen,
            companions: sides
                .iter()
                .filter(|side| crossings[side.surface] == *crossing && side.crossing != *crossing)
                .map(|side| side.crossing)
                .collect(),
        });
        let surfaces: Vec<Surface> = surfaces.collect();
        let place = system.place_of_shares();
        let forces = contacts.iter().map(|contact| contact.force);
        let inserted: Vec<f64> = shares.iter().copied().chain(forces).collect();
        let span = self.problem.settings.stop - self.problem.settings.start;
        system.begin(surfaces, contacts, self.nominals.plain(), span);
        self.y.splice(place..place, inserted.iter().copied());
        self.problem.nominal = self.nominals.with_shares(place, inserted.len());
        if self.is_explicit {
            std::mem::swap(&mut self.integrator, &mut self.implicit);
        }
        for at in crossings {
            self.watch.rows[*at].end();
            self.problem.system.note_treatment(self.t, *at, Treatment::Slides);
        }
        self.record()?;
        self.restart()?;
        Ok(true)
    }

    /// The width of layers relative to the uncertainty of z.
    pub(crate) fn widening(&self) -> f64 {
        (NARROWEST / self.problem.settings.tolerance).max(1.0)
    }

    /// Implicit methods alone know shares; where an explicit one was asked for, one of them takes
    /// over if the system has no loops that it solves itself.
    pub(crate) fn can_slide(&mut self) -> bool {
        let system = &mut *self.problem.system;
        if !self.is_explicit {
            return system.n_differential() > 0;
        }
        system.solve_loops(false);
        let has_loops = system.n_algebraic() > 0;
        system.solve_loops(true);
        !has_loops && system.n_differential() > 0
    }

    /// Ends sliding; the surfaces and contacts that the solution has not left.
    pub(crate) fn end_slide(&mut self) -> (Vec<usize>, Vec<Contact>) {
        if !self.problem.system.is_constrained() {
            return Default::default();
        }
        let left = self.problem.system.end(self.t, self.y);
        self.problem.nominal = self.nominals.plain();
        if self.is_explicit {
            std::mem::swap(&mut self.integrator, &mut self.implicit);
        }
        left
    }

    /// How fast y changes relative to its size, per second; at least so fast.
    pub(crate) fn fastest_rate(&mut self, least: f64) -> Option<f64> {
        let n = self.problem.system.n_differential();
        let mut f = vec![0.0; self.y.len()];
        self.problem.system.rhs(self.t, self.y, &mut f).ok()?;
        let speed = |at: usize| f[at].abs() / self.y[at].abs().max(self.problem.nominal[at]);
        Some((0..n).map(speed).fold(least, f64::max))
    }

    /// The shares of the positive sides with which the solution stays on these surfaces; `None` if
    /// there are none between 0 and 1, or the solution would leave the surfaces with them.
    fn shares(&mut self, crossings: &[usize]) -> Option<Vec<f64>> {
        if crossings.len() > MOST_SURFACES {
            return None;
        }
        let rates = self.rates_of_modes(crossings)?;
        let shares = balanced(&rates, crossings.len())?;
        let widths: Vec<f64> = crossings.iter().map(|at| self.crossings.uncertainty[*at]).collect();
        let is_inside = shares.iter().all(|share| *share > 0.0 && *share < 1.0);
        (is_inside && attract(&rates, &shares, &widths)).then_some(shares)
    }

    /// The rates of change of crossing functions in every mode, one mode after the other; `None`
    /// where they are within rounding errors, or the system has no modes.
    fn rates_of_modes(&mut self, crossings: &[usize]) -> Option<Vec<f64>> {
        let sides = self.sides(crossings);
        let system = &mut *self.problem.system;
        if !system.prepare_modes(self.t, self.y, &sides).ok()? {
            return None;
        }
        let nearest = self.mode_of(crossings);
        self.problem.system.solve_loops(true);
        let mut rates = Vec::new();
        let all = (0..1 << crossings.len()).all(|mode| {
            self.problem.system.enter_mode(mode);
            self.rates(crossings, &mut rates).is_some()
        });
        self.problem.system.solve_loops(self.solves_loops);
        self.problem.system.enter_mode(nearest);
        all.then_some(rates)
    }

    /// The mode of the signs at hand.
    fn mode_of(&self, crossings: &[usize]) -> usize {
        let sides = crossings.iter().enumerate();
        sides.filter(|(_, at)| self.crossings.signs[**at] > 0).map(|(bit, _)| 1 << bit).sum()
    }

    /// Appends the rates of change of crossing functions in the mode at hand.
    fn rates(&mut self, crossings: &[usize], rates: &mut Vec<f64>) -> Option<()> {
        let system = &mut *self.problem.system;
        let settings = self.problem.settings;
        let span = settings.stop - settings.start;
        let n = system.n_differential();
        let mut f = vec![0.0; self.y.len()];
        system.rhs(self.t, self.y, &mut f).ok()?;
        let speed = |at: usize| f[at].abs() / self.y[at].abs().max(self.problem.nominal[at]);
        let fastest = (0..n).map(speed).fold(1.0 / span, f64::max);
        let ahead = DIFFERENCE / fastest;
        let mut moved = self.y.to_vec();
        moved.iter_mut().zip(&f).take(n).for_each(|(y, f)| *y += ahead * f);
        system.crossings(self.t, self.y, &mut self.watch.z).ok()?;
        let before: Vec<f64> = crossings.iter().map(|at| self.watch.z[*at]).collect();
        system.crossings(self.t + ahead, &moved, &mut self.watch.z).ok()?;
        for (at, before) in crossings.iter().zip(before) {
            let rate = (self.watch.z[*at] - before) / ahead;
            let uncertainty = self.crossings.uncertainty[*at];
            let rounding = ROUNDING * uncertainty / settings.tolerance / ahead;
            let is_known = rate.is_finite() && rate.abs() > rounding.max(uncertainty / span);
            if uncertainty == 0.0 || (crossings.len() == 1 && !is_known) {
                return None;
            }
            rates.push(rate);
        }
        Some(())
    }
}
