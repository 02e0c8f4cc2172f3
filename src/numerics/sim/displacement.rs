//! Which slides and contacts persist after an event.
//!
//! An event may displace the states (`reinit`), a surface (a set point that jumps), or the fields. A
//! surface from which the solution is farther away than errors explain is left: the relation has the
//! value of its sides, and the integration continues beside it. A contact is looked at as
//! `sliding::contact` says. Where one ends, the states are moved off the surface first, by less
//! than their uncertainty: the relation of a solution that rests has the value of the last impact,
//! and only one that does not hold beside the surface can notice the next.

use super::run::Run;
use super::sliding::Contact;
use super::{EventOutcome, Events, Failure, SimErrorKind};

/// How far from a surface a solution may be that is on it, relative to the uncertainty: layers are as
/// wide as that, and begin where it arrived.
const DISPLACED: f64 = 2.0;

/// A flight is over if it would be so high, relative to the uncertainty of z.
pub(crate) const HEIGHT: f64 = 1.0;
/// How far a solution that rests may be from where it began to without being moved, relative to the
/// uncertainty.
const MOVED: f64 = 0.1;
/// How far a solution is moved off a surface, relative to the uncertainty: more than the margin of
/// events.
const LIFT: f64 = 1e-2;

impl Run<'_> {
    /// An event at which relations of contacts keep their values as long as their sides do not
    /// differ: where the solution rests, their signs are made of rounding.
    pub(crate) fn event_with_contacts(
        &mut self,
        contacts: &[Contact],
    ) -> Result<EventOutcome, SimErrorKind> {
        if contacts.is_empty() {
            return self.whole_event(self.t);
        }
        let limit = |contact: &Contact| (contact.crossing, DISPLACED * contact.uncertainty);
        let kept: Vec<(usize, f64)> = contacts.iter().map(limit).collect();
        self.problem.system.keep_relations(&kept);
        let outcome = self.whole_event(self.t);
        self.problem.system.keep_relations(&[]);
        outcome
    }

    /// Continues with the surfaces and contacts that persist after an event.
    pub(crate) fn continue_after_event(
        &mut self,
        mut surfaces: Vec<usize>,
        contacts: Vec<Contact>,
    ) -> Result<EventOutcome, SimErrorKind> {
        self.start_crossings()?;
        let search = &*self.crossings;
        let widen = self.widening();
        surfaces.retain(|at| search.left[*at].abs() <= DISPLACED * widen * search.uncertainty[*at]);
        let failed = SimErrorKind::Evaluation;
        let (mut kept, mut over) = (Vec::new(), Vec::new());
        for at in 0..contacts.len() {
            match self.hold(&contacts, at).map_err(failed)? {
                Some(contact) => kept.push(contact),
                None => over.push(&contacts[at]),
            }
        }
        let mut outcome = EventOutcome::Continue { y_changed: true };
        if !over.is_empty() {
            over.iter().try_for_each(|contact| self.lift_off(contact)).map_err(failed)?;
            outcome = self.event_with_contacts(&kept)?;
        }
        self.go_on_constrained(&surfaces, kept)?;
        Ok(outcome)
    }

    fn is_displaced(&self, contact: &Contact) -> bool {
        self.crossings.left[contact.crossing].abs() > DISPLACED * contact.uncertainty
    }

    /// The contact with its force from here on, and y where it rests; `None` if it is over.
    fn hold(&mut self, contacts: &[Contact], at: usize) -> Result<Option<Contact>, Failure> {
        let mut contact = contacts[at].clone();
        if self.is_displaced(&contact) || contact.force <= 0.0 {
            return Ok(None);
        }
        let [before, after] = [&contacts[..at], &contacts[at + 1..]];
        let others = [before, after].concat();
        let system = &mut *self.problem.system;
        let moved = (self.crossings.left[contact.crossing] - contact.value).abs();
        if moved > MOVED * contact.uncertainty {
            // The surface was moved by less than errors: back to it, without a flight.
            system.within.lift(&contact, contact.gap(contact.value), self.t, self.y)?;
        }
        let (gap, rest) = system.within.look_at_gap(&contact, &others, self.t, self.y)?;
        if !gap.is_held() || gap.height() > HEIGHT * contact.uncertainty {
            return Ok(None);
        }
        contact.force = -gap.acceleration / gap.effect;
        self.y.copy_from_slice(&rest);
        Ok(Some(contact))
    }

    fn lift_off(&mut self, contact: &Contact) -> Result<(), Failure> {
        if self.is_displaced(contact) {
            return Ok(());
        }
        self.problem.system.within.lift(contact, LIFT * contact.uncertainty, self.t, self.y)
    }
}
