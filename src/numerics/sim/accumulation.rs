//! Accumulation of events (Zeno behaviour): infinitely many within a finite time.
//!
//! Impacts that change states and follow each other faster and faster, such as those of a ball on
//! the ground, come to an end: where the next flight would stay within the uncertainty of its
//! crossing function z, the solution rests at z = 0. With w = dz/dt and the direction d in which the
//! impact changed the states
//!
//! ```text
//! the states are moved along d until w = 0
//! from then on a force along d keeps w at zero (`sliding`), as long as it need not pull
//! ```
//!
//! Where nothing can hold the solution, the simulation ends with an error: there is none beyond.

use super::displacement::HEIGHT;
use super::run::Run;
use super::sliding::Contact;
use super::switches::ROW;
use super::{Modes, Residual, SimErrorKind, Treatment};

/// Half the length of the difference that gives w, relative to the time in which y changes.
const DIFFERENCE: f64 = 1e-4;
/// ω relative to the rate that makes z as large as its uncertainty in the whole simulation, where
/// the tolerance is tighter than this: differences of differences are as inexact.
const COARSEST: f64 = 1e-6;
/// τ relative to the simulated interval. A force μ keeps the solution ω τ μ away from where it rested
/// first. Errors of z are errors of the force, divided by ω τ: with 1e-4 a ball on a plate that shakes
/// takes 18,952 steps at the tolerance 1e-6 instead of 406.
const RETURN: f64 = 1e-2;
/// The limit of the series is within reach: so near relative to the simulated interval. Events
/// continue before that, as they do for a clock whose ticks merely become shorter for a while.
const REACH: f64 = 1e-6;

impl Run<'_> {
    /// Lets the solution rest if the event just handled was the last impact distinguishable from
    /// rest; whether the integrator was restarted for it.
    pub(crate) fn rest_after_impact(&mut self) -> Result<bool, SimErrorKind> {
        let Some(crossing) = self.watch.impacts.first().copied() else { return Ok(false) };
        if self.watch.jump.is_empty() {
            return Ok(false);
        }
        let (surfaces, mut contacts) = self.end_slide();
        let was_constrained = !surfaces.is_empty() || !contacts.is_empty();
        let found = self.contact(crossing, &contacts);
        let rests = found.is_some();
        if let Some(contact) = found {
            self.refuse_with_directions()?;
            contacts.push(contact);
            self.watch.rows[crossing].end();
        } else if !was_constrained {
            return Ok(false);
        }
        self.go_on_constrained(&surfaces, contacts)?;
        if rests && !self.problem.system.is_constrained() {
            // Too many surfaces, or no method that knows forces: rebounds too low to be seen would
            // carry the solution through the surface.
            return Err(SimErrorKind::Accumulation);
        }
        if rests {
            self.problem.statistics.accumulations += 1;
            self.problem.system.note_treatment(self.t, crossing, Treatment::Rests);
        }
        Ok(true)
    }

    /// The contact at a crossing function at which the states just jumped; they are moved to where
    /// it rests. `None` if the solution does not stay there.
    fn contact(&mut self, crossing: usize, others: &[Contact]) -> Option<Contact> {
        let settings = self.problem.settings;
        let span = settings.stop - settings.start;
        let uncertainty = self.crossings.uncertainty[crossing];
        let mut contact = Contact {
            crossing,
            is_free_above: self.watch.switches[crossing].was_above,
            direction: self.watch.jump.clone(),
            force: 1.0,
            width: uncertainty / span * (COARSEST / settings.tolerance).max(1.0),
            value: self.crossings.left[crossing],
            return_time: RETURN * span,
            uncertainty,
            ahead: DIFFERENCE / self.fastest_rate(1.0 / span)?,
        };
        let gap = self.problem.system.within.look_at_gap(&contact, others, self.t, self.y);
        let (gap, rest) = gap.ok()?;
        if !gap.is_held() || uncertainty <= 0.0 || gap.height() > HEIGHT * uncertainty {
            return None;
        }
        let force = -gap.acceleration / gap.effect;
        contact.direction.iter_mut().for_each(|(_, d)| *d *= force);
        self.y.copy_from_slice(&rest);
        Some(contact)
    }

    /// An error if events at a crossing function accumulate and nothing could be done about it.
    pub(crate) fn watch_for_accumulation(&self) -> Result<(), SimErrorKind> {
        let settings = self.problem.settings;
        let reach = REACH * (settings.stop - settings.start);
        let accumulates = |at: &usize| {
            let is_row = self.watch.rows[*at].length >= ROW;
            is_row && self.watch.switches[*at].accumulate(reach)
        };
        match self.crossings.switched.iter().any(accumulates) {
            true => Err(SimErrorKind::Accumulation),
            false => Ok(()),
        }
    }

    /// How fast y changes relative to its size, per second; at least so fast.
    fn fastest_rate(&mut self, least: f64) -> Option<f64> {
        let n = self.problem.system.n_differential();
        let mut f = vec![0.0; self.y.len()];
        self.problem.system.rhs(self.t, self.y, &mut f).ok()?;
        let speed = |at: usize| f[at].abs() / self.y[at].abs().max(self.problem.nominal[at]);
        Some((0..n).map(speed).fold(least, f64::max))
    }
}
