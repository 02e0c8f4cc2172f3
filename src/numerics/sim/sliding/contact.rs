//! The forces at contacts.
//!
//! After an event, a contact is examined again with the gap z, positive on the free side, and its
//! rates w = dz/dt and dw/dt, the latter without the force of the contact itself:
//!
//! ```text
//! |z| beyond its limit             the surface or the states were displaced: it is over
//! dw/dt > 0                        nothing presses any more: it is over
//! a flight with w would be seen    the states were thrown away from the surface, or at it: it is over
//! else                             it continues; the states are moved along d until w = 0
//! ```

use super::slide::Contact;
use super::within::SystemWithin;
use crate::sim::Failure;

/// Length of the difference that gives the rate of w, relative to that of the one that gives w.
const SECOND_DIFFERENCE: f64 = 10.0;

/// What is known of a gap.
#[derive(Debug, Clone, Copy)]
pub(in crate::sim) struct Gap {
    /// w = dz/dt, positive away from the surface.
    pub(in crate::sim) speed: f64,
    /// What moving the states along d does to w.
    pub(in crate::sim) effect: f64,
    /// dw/dt at w = 0, without the force of the contact.
    pub(in crate::sim) acceleration: f64,
}

impl Gap {
    /// How high a flight with this speed is.
    pub(in crate::sim) fn height(&self) -> f64 {
        self.speed * self.speed / (2.0 * self.acceleration.abs())
    }

    /// Whether the surface can hold the solution.
    pub(in crate::sim) fn is_held(&self) -> bool {
        self.effect > 0.0 && self.acceleration < 0.0
    }
}

impl Contact {
    /// Moves states along d.
    pub(in crate::sim) fn move_along(&self, share: f64, y: &mut [f64]) {
        self.direction.iter().for_each(|(at, d)| y[*at] += share * d);
    }

    /// The value of a crossing function, positive on the free side.
    pub(in crate::sim) fn gap(&self, z: f64) -> f64 {
        if self.is_free_above { z } else { -z }
    }
}

impl SystemWithin<'_> {
    /// The rate of change of the crossing function of a contact without its force, at (t, y) of the
    /// system within, positive away from the surface.
    pub(in crate::sim) fn speed(
        &mut self,
        contact: &Contact,
        t: f64,
        y: &[f64],
    ) -> Result<f64, Failure> {
        let n = self.system.n_differential();
        let mut f = vec![0.0; y.len()];
        let mut z = vec![0.0; self.system.n_crossings()];
        self.system.rhs(t, y, &mut f)?;
        let mut moved = y.to_vec();
        let mut ends = [0.0; 2];
        for (end, sign) in ends.iter_mut().zip([1.0, -1.0]) {
            let ahead = sign * contact.ahead;
            let points = moved.iter_mut().zip(y).zip(&f).take(n);
            points.for_each(|((moved, y), f)| *moved = y + ahead * f);
            self.system.crossings(t + ahead, &moved, &mut z)?;
            *end = z[contact.crossing];
        }
        Ok(contact.gap((ends[0] - ends[1]) / (2.0 * contact.ahead)))
    }

    /// w, and what brings z slowly back to its value at the beginning: speeds as small as ω would
    /// add up otherwise.
    pub(super) fn speed_towards_rest(
        &mut self,
        contact: &Contact,
        t: f64,
        y: &[f64],
    ) -> Result<f64, Failure> {
        let mut z = vec![0.0; self.system.n_crossings()];
        self.system.crossings(t, y, &mut z)?;
        let distance = contact.gap(z[contact.crossing] - contact.value);
        Ok(self.speed(contact, t, y)? + distance / contact.return_time)
    }

    /// The gap of a contact at (t, y) of the system within, and y moved along d to where w = 0.
    /// `others` press meanwhile.
    pub(in crate::sim) fn look_at_gap(
        &mut self,
        contact: &Contact,
        others: &[Contact],
        t: f64,
        y: &[f64],
    ) -> Result<(Gap, Vec<f64>), Failure> {
        let n = self.system.n_differential();
        let speed = self.speed(contact, t, y)?;
        let mut rest = y.to_vec();
        contact.move_along(1.0, &mut rest);
        let effect = self.speed(contact, t, &rest)? - speed;
        rest.copy_from_slice(y);
        contact.move_along(-speed / effect, &mut rest);
        let mut f = vec![0.0; y.len()];
        self.system.rhs(t, &rest, &mut f)?;
        others.iter().for_each(|other| other.move_along(other.force, &mut f));
        let ahead = SECOND_DIFFERENCE * contact.ahead;
        let mut moved = rest.clone();
        moved.iter_mut().zip(&f).take(n).for_each(|(y, f)| *y += ahead * f);
        let at_rest = self.speed(contact, t, &rest)?;
        let acceleration = (self.speed(contact, t + ahead, &moved)? - at_rest) / ahead;
        Ok((Gap { speed, effect, acceleration }, rest))
    }

    /// Moves y to where the gap of a contact is as large as this: in the direction in which a speed
    /// along d would carry it.
    pub(in crate::sim) fn lift(
        &mut self,
        contact: &Contact,
        gap: f64,
        t: f64,
        y: &mut [f64],
    ) -> Result<(), Failure> {
        let n = self.system.n_differential();
        let mut z = vec![0.0; self.system.n_crossings()];
        self.system.crossings(t, y, &mut z)?;
        let way = gap - contact.gap(z[contact.crossing]);
        let [mut before, mut after] = [vec![0.0; y.len()], vec![0.0; y.len()]];
        let mut moved = y.to_vec();
        contact.move_along(1.0, &mut moved);
        self.system.rhs(t, y, &mut before)?;
        self.system.rhs(t, &moved, &mut after)?;
        let effect = self.speed(contact, t, &moved)? - self.speed(contact, t, y)?;
        let directions = after.iter().zip(&before).take(n);
        for (y, (after, before)) in y.iter_mut().zip(directions) {
            *y += way / effect * (after - before);
        }
        Ok(())
    }
}
