//! Where slides and rests at contacts begin and end.

use super::run::Run;
use super::sliding::{Contact, MOST_SURFACES, Surface, attract, balanced};
use super::{Events, Modes, Residual, Sensitive, Side, SimErrorKind, Treatment};

/// Width of a layer relative to z where the tolerance is tighter: what rounding makes of z must be
/// a small part of it.
const NARROWEST: f64 = 1e-9;
/// Length of the difference that gives the rate of z, relative to the time in which y changes.
const DIFFERENCE: f64 = 1e-7;
/// Rounding of z relative to the error that a change of y by its own size makes.
const ROUNDING: f64 = 1e-13;

impl Run<'_> {
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

    /// Derivatives follow no solution that slides, rests, or crosses surfaces without events:
    /// callers use difference quotients then.
    pub(crate) fn refuse_with_directions(&self) -> Result<(), SimErrorKind> {
        match self.problem.system.n_directions() {
            0 => Ok(()),
            _ => Err(SimErrorKind::Chattering),
        }
    }

    /// The width of layers relative to the uncertainty of z.
    pub(crate) fn widening(&self) -> f64 {
        (NARROWEST / self.problem.settings.tolerance).max(1.0)
    }

    /// Whether two crossing functions differ by their sign at most: so they do here and where y has
    /// errors.
    pub(super) fn is_same_surface(&self, a: usize, b: usize) -> bool {
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

    /// The shares of the positive sides with which the solution stays on these surfaces; `None` if
    /// there are none between 0 and 1, or the solution would leave the surfaces with them.
    pub(super) fn shares(&mut self, crossings: &[usize]) -> Option<Vec<f64>> {
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
