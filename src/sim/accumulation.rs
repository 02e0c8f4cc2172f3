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

use super::chattering::ROW;
use super::simulator::Run;
use super::sliding::Contact;
use super::{DaeSystem, SimErrorKind, Treatment};

/// Half the length of the difference that gives w, relative to the time in which y changes.
const DIFFERENCE: f64 = 1e-4;
/// The length of the one that gives the rate of w, relative to that.
const SECOND_DIFFERENCE: f64 = 10.0;
/// A flight is over if it would be so high, relative to the uncertainty of z.
const HEIGHT: f64 = 1.0;
/// ω relative to the rate that makes z as large as its uncertainty in the whole simulation, where
/// the tolerance is tighter than this: differences of differences are as inexact.
const COARSEST: f64 = 1e-6;
/// Intervals, each shorter than the one before, after which events accumulate. Those of damped
/// oscillations around a crossing get shorter, too, but z is larger than its uncertainty then.
const SHRINKING: u32 = 6;
/// By then they have become shorter by this factor. Noise and switching that merely becomes faster make
/// some shorter intervals in a row, too, and go on.
const SHRUNK: f64 = 1e-3;

/// When a crossing function changed its sign last.
#[derive(Debug, Clone, Copy)]
pub(super) struct Switches {
    last: f64,
    before: f64,
    /// Between changes in the same direction: from one but the last to the last, and the one before.
    intervals: [f64; 2],
    /// How many intervals in a row were shorter than the one before.
    shrinking: u32,
    /// The interval before these.
    longest: f64,
    /// Whether it was positive before the last change.
    pub(super) was_above: bool,
}

impl Default for Switches {
    fn default() -> Switches {
        let never = f64::NEG_INFINITY;
        let intervals = [f64::INFINITY; 2];
        Switches {
            last: never,
            before: never,
            intervals,
            shrinking: 0,
            longest: f64::INFINITY,
            was_above: false,
        }
    }
}

impl Switches {
    /// Whether the intervals tend to zero.
    fn accumulate(&self) -> bool {
        self.shrinking >= SHRINKING && self.intervals[0] <= SHRUNK * self.longest
    }

    pub(super) fn note(&mut self, t: f64, was_above: bool) {
        let interval = t - self.before;
        let [last, before] = self.intervals;
        if interval < before && before.is_finite() {
            self.shrinking += 1;
        } else {
            (self.shrinking, self.longest) = (0, interval);
        }
        self.intervals = [interval, last];
        (self.before, self.last) = (self.last, t);
        self.was_above = was_above;
    }
}

impl Run<'_> {
    /// Lets the solution rest if the event just handled was the last impact that can be told from
    /// rest; whether the integrator was restarted for it.
    pub(super) fn rest_after_impact(&mut self) -> Result<bool, SimErrorKind> {
        let Some(crossing) = self.crossings.switched.first().copied() else { return Ok(false) };
        let states = self.y.iter().zip(&self.watch.before).enumerate();
        let jump: Vec<(usize, f64)> =
            states.map(|(at, (y, before))| (at, y - before)).filter(|(_, d)| *d != 0.0).collect();
        if jump.is_empty() || !self.can_slide() {
            return Ok(false);
        }
        let (surfaces, mut contacts) = self.end_slide();
        let was_constrained = !surfaces.is_empty() || !contacts.is_empty();
        let found = self.contact(crossing, jump);
        if let Some(contact) = found {
            self.refuse_with_directions()?;
            contacts.push(contact);
            self.problem.statistics.accumulations += 1;
            self.watch.rows[crossing] = 0;
            self.problem.system.note_treatment(self.t, crossing, Treatment::Rests);
        } else if !was_constrained {
            return Ok(false);
        }
        self.go_on_constrained(&surfaces, contacts)?;
        Ok(true)
    }

    /// The contact at a crossing function at which the states just jumped; they are moved to where
    /// it rests. `None` if the solution does not stay there.
    fn contact(&mut self, crossing: usize, jump: Vec<(usize, f64)>) -> Option<Contact> {
        let settings = self.problem.settings;
        let span = settings.stop - settings.start;
        let uncertainty = self.crossings.uncertainty[crossing];
        let mut contact = Contact {
            crossing,
            is_free_above: self.watch.switches[crossing].was_above,
            direction: jump,
            force: 1.0,
            width: uncertainty / span * (COARSEST / settings.tolerance).max(1.0),
            ahead: DIFFERENCE / self.fastest_rate(1.0 / span)?,
        };
        let t = self.t;
        let system = &mut *self.problem.system;
        let along = |y: &[f64], contact: &Contact, share: f64| {
            let mut moved = y.to_vec();
            contact.direction.iter().for_each(|(at, d)| moved[*at] += share * d);
            moved
        };
        let speed = system.speed(&contact, t, self.y).ok()?;
        let effect = system.speed(&contact, t, &along(self.y, &contact, 1.0)).ok()? - speed;
        let rest = along(self.y, &contact, -speed / effect);
        let mut f = vec![0.0; rest.len()];
        system.rhs(t, &rest, &mut f).ok()?;
        let ahead = SECOND_DIFFERENCE * contact.ahead;
        let mut moved = rest.clone();
        let n = system.n_differential();
        moved.iter_mut().zip(&f).take(n).for_each(|(y, f)| *y += ahead * f);
        let at_rest = system.speed(&contact, t, &rest).ok()?;
        let acceleration = (system.speed(&contact, t + ahead, &moved).ok()? - at_rest) / ahead;
        let height = speed * speed / (2.0 * acceleration.abs());
        let stays = effect > 0.0 && acceleration < 0.0 && uncertainty > 0.0;
        if !stays || height > HEIGHT * uncertainty {
            return None;
        }
        let force = -acceleration / effect;
        contact.direction.iter_mut().for_each(|(_, d)| *d *= force);
        self.y.copy_from_slice(&rest);
        Some(contact)
    }

    /// An error if events at a crossing function accumulate and nothing could be done about it.
    pub(super) fn watch_for_accumulation(&self) -> Result<(), SimErrorKind> {
        let accumulates = |at: &usize| {
            let is_row = self.watch.rows[*at] >= ROW;
            is_row && self.watch.switches[*at].accumulate()
        };
        match self.crossings.switched.iter().any(accumulates) {
            true => Err(SimErrorKind::Accumulation),
            false => Ok(()),
        }
    }
}
